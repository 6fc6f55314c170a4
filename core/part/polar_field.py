"""Material as a polar field: intervals of r on rays from the axis, in columns along Z.

A ray usually has one interval, two if a bore or a face groove leaves a ring, and more across a cross hole.
The intervals are stored in layers, ascending in r. An empty interval has its high not above its low. Columns
may have different widths. They are divided at shoulders and at the floors of pockets, so that these remain
exactly where they were cut.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from core.part.ray_cuts import FloatArray
from core.part.tool_polygons import PartError

IntArray = npt.NDArray[np.intp]
Real = TypeVar("Real", FloatArray, npt.NDArray[np.float32])

COLUMNS = 900
"""How many columns a field begins with at most; it may divide into twice as many."""
RAYS = 720

_TOUCH = 1e-7  # mm; thinner material counts as none
_JUMP = 0.05  # mm; a larger step between two fine columns is a shoulder
_LEAST = 0.002  # mm; least distance of a division from the edge of a column
Ends = tuple[float, float]
"""Of a column: from and to which Z."""


class Taken(NamedTuple):
    """The material in a cut.

    ``volume`` is in mm³ and ``depth`` is the greatest thickness along r. The cut extends from ``back`` to
    ``front`` in Z and from ``low`` to ``high`` in r, in mm.
    """

    volume: float = 0.0
    depth: float = 0.0
    back: float = math.inf
    front: float = -math.inf
    low: float = math.inf
    high: float = -math.inf

    def __bool__(self) -> bool:
        return self.volume > 0.0

    def joined(self, other: Taken) -> Taken:
        """Return both cuts together."""
        return Taken(
            self.volume + other.volume,
            max(self.depth, other.depth),
            min(self.back, other.back),
            max(self.front, other.front),
            min(self.low, other.low),
            max(self.high, other.high),
        )


NOTHING = Taken()


class PolarField:
    """The material of a part in polar coordinates, in mm.

    ``edges`` (columns + 1,) are ascending Z, and ``low`` and ``high`` (layers, columns, rays) are r. Ray j is
    at the angle 2π·j / rays, measured from the part's X toward its Y.
    """

    def __init__(self, edges: FloatArray, low: FloatArray, high: FloatArray, most: int = 2 * COLUMNS) -> None:
        if low.shape != high.shape or low.ndim != 3 or low.shape[1] != len(edges) - 1:
            raise PartError(
                "A polar field needs one column of rays between each two edges.", "columns-and-edges"
            )
        if np.any(np.diff(edges) <= 0.0):
            raise PartError("The edges of a polar field have to rise.", "edges-not-rising")
        self.edges, self.low, self.high = edges, low, high
        self.angles = np.arange(low.shape[2]) * (2.0 * math.pi / low.shape[2])
        self.changes = 0  # increases with every cut, which makes pictures of the field outdated
        self._most = max(most, len(edges) - 1)

    @property
    def most(self) -> int:
        """The largest permitted number of columns."""
        return self._most

    @property
    def middles(self) -> FloatArray:
        """Z of the middle of each column, in mm."""
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def widths(self) -> FloatArray:
        """Width of each column, in mm."""
        return np.diff(self.edges)

    @property
    def volume(self) -> float:
        """Volume of the material in mm³, calculated at the middles of columns and rays."""
        return float(self.volumes.sum())

    @property
    def volumes(self) -> FloatArray:
        """Volume of the material of each column, in mm³."""
        area = np.einsum("lcr,lcr->c", self.high, self.high) - np.einsum("lcr,lcr->c", self.low, self.low)
        return np.asarray(area * self.widths * (math.pi / len(self.angles)))

    @property
    def outermost(self) -> FloatArray:
        """The greatest radius of each column; 0 if it contains no material."""
        return np.asarray(np.where(self.high > self.low, self.high, 0.0).max(axis=(0, 2)))

    def between(self, back: float, front: float) -> slice:
        """Return the slice of the columns that overlap the range of Z."""
        first = int(np.searchsorted(self.edges, back, side="right")) - 1
        last = int(np.searchsorted(self.edges, front, side="left"))
        return slice(max(first, 0), min(last, len(self.edges) - 1))

    def copied(self) -> PolarField:
        """Return an independent copy of the field."""
        return PolarField(self.edges.copy(), self.low.copy(), self.high.copy(), self._most)

    def divide(self, places: FloatArray) -> None:
        """Divide the columns at these Z, as far as the permitted number of columns allows.

        The material is unchanged.
        """
        places = np.unique(places[(places > self.edges[0]) & (places < self.edges[-1])])
        at = np.searchsorted(self.edges, places)
        room = np.minimum(places - self.edges[at - 1], self.edges[at] - places) > _LEAST
        places = places[room]
        places = places[np.diff(places, prepend=-math.inf) > _LEAST]
        spare = self._most - len(self.edges) + 1
        if len(places) > spare:
            places = (
                places[np.linspace(0, len(places) - 1, spare).astype(np.intp)] if spare > 0 else places[:0]
            )
        if not len(places):
            return
        edges = np.sort(np.concatenate((self.edges, places)))
        column = np.searchsorted(self.edges, edges[:-1], side="right") - 1
        self.edges, self.low, self.high = edges, self.low[:, column], self.high[:, column]

    def take(
        self, columns: slice, rays: IntArray | slice, start: FloatArray, end: FloatArray, *, cut: bool = True
    ) -> Taken:
        """Return the material between ``start`` and ``end`` (columns, rays), and remove it if ``cut``.

        Nothing is taken if ``end`` is not above ``start``.
        """
        low, high = self.low[:, columns][:, :, rays], self.high[:, columns][:, :, rays]
        there = end > start
        start, end = np.where(there, start, np.inf), np.where(there, end, np.inf)
        near, far = np.clip(start, low, high), np.clip(end, low, high)
        thick = far - near
        met = thick > _TOUCH
        touched = np.asarray(met.any(axis=(0, 2)))
        if not touched.any():
            return NOTHING
        if cut:
            self._leave(columns, rays, low, high, np.where(met, near, high), np.where(met, far, high))
            self.changes += 1
        told = self._told(columns, touched, np.where(met, thick * (far + near), 0.0), float(thick.max()))
        return told._replace(low=float(near[met].min()), high=float(far[met].max()))

    def _told(self, columns: slice, touched: npt.NDArray[np.bool_], rings: FloatArray, depth: float) -> Taken:
        edges = self.edges[columns.start : columns.stop + 1]
        volume = float(rings.sum(axis=(0, 2)) @ np.diff(edges)) * math.pi / len(self.angles)
        index = np.flatnonzero(touched)
        return Taken(volume, depth, float(edges[index[0]]), float(edges[index[-1] + 1]))

    def _leave(
        self,
        columns: slice,
        rays: IntArray | slice,
        low: FloatArray,
        high: FloatArray,
        near: FloatArray,
        far: FloatArray,
    ) -> None:
        """Store the material below ``near`` and above ``far`` in each layer."""
        inner, outer = near > low + _TOUCH, high > far + _TOUCH
        both = inner & outer
        new_low = np.where(inner, low, np.where(outer, far, 0.0))
        new_high = np.where(inner, near, np.where(outer, high, 0.0))
        if both.any():
            new_low, new_high = self._split(new_low, new_high, far, high, both)
        index = np.arange(len(self.angles))[rays]
        place = np.ix_(np.arange(len(new_low)), np.arange(columns.start, columns.stop), index)
        if isinstance(rays, slice):
            self.low[:, columns, rays], self.high[:, columns, rays] = new_low, new_high
        else:
            self.low[place], self.high[place] = new_low, new_high

    def _split(
        self, low: FloatArray, high: FloatArray, far: FloatArray, top: FloatArray, both: npt.NDArray[np.bool_]
    ) -> tuple[FloatArray, FloatArray]:
        """Return the layers with the pieces from ``far`` to ``top`` added on the rays that were split."""
        column, ray = np.nonzero(both.any(axis=0))
        split = both[:, column, ray]
        pieces_low = np.concatenate((low[:, column, ray], np.where(split, far[:, column, ray], 0.0)))
        pieces_high = np.concatenate((high[:, column, ray], np.where(split, top[:, column, ray], 0.0)))
        pieces_low, pieces_high = in_order(pieces_low, pieces_high)
        needed = int((pieces_high > pieces_low).sum(axis=0).max())
        more = needed - len(self.low)
        if more > 0:
            self.low, self.high = _deeper(self.low, more), _deeper(self.high, more)
            low, high = _deeper(low, more), _deeper(high, more)
        low[:, column, ray], high[:, column, ray] = pieces_low[: len(low)], pieces_high[: len(high)]
        return low, high


def in_order(low: Real, high: Real) -> tuple[Real, Real]:
    """Return the intervals in ascending order along the first axis, with empty ones last and 0."""
    there = high > low
    order = np.argsort(np.where(there, low, np.inf), axis=0, kind="stable")
    low, high = low * there, high * there
    return np.take_along_axis(low, order, axis=0), np.take_along_axis(high, order, axis=0)


def _deeper(layers: FloatArray, more: int) -> FloatArray:
    return np.concatenate((layers, np.zeros((more, *layers.shape[1:]))))


def turned_field(
    edges: FloatArray, low: FloatArray, high: FloatArray, columns: int = COLUMNS, rays: int = RAYS
) -> PolarField:
    """Return the field of a half section with fine columns.

    ``low`` and ``high`` (layers, n) are between ``edges`` (n + 1,). Fine columns are combined to at most
    ``columns`` columns, divided at shoulders. Each retains its volume.
    """
    low, high = in_order(low, high)
    metal = np.flatnonzero((high > low + _TOUCH).any(axis=0))
    if not len(metal):
        raise PartError("There is no metal to mill.", "no-stock")
    there = slice(int(metal[0]), int(metal[-1]) + 1)
    low, high, edges = low[:, there], high[:, there], edges[there.start : there.stop + 1]
    starts = _starts(low, high, columns)
    count = np.diff(np.append(starts, low.shape[1]))
    # The mean of squares preserves the volume, because fine columns have equal widths.
    low, high = (np.sqrt(np.add.reduceat(r * r, starts, axis=1) / count) for r in (low, high))
    full = [np.repeat(r[:, :, None], rays, axis=2) for r in (low, high)]
    return PolarField(np.append(edges[starts], edges[-1]), full[0], full[1], 2 * columns)


def _starts(low: FloatArray, high: FloatArray, columns: int) -> IntArray:
    """Return the first fine column of each column: one at every shoulder, the rest evenly divided."""
    fine = low.shape[1]
    rise = np.maximum(np.abs(np.diff(low)), np.abs(np.diff(high))).max(axis=0)
    steep = np.flatnonzero(rise > _JUMP)
    if len(steep) > columns // 2:
        steep = steep[np.argsort(rise[steep])[-(columns // 2) :]]
    bounds = np.unique(np.concatenate(([0], steep + 1, [fine])))
    wide = fine / max(columns - len(steep) - 1, 1)
    parts = [
        np.linspace(a, b, math.ceil((b - a) / wide), endpoint=False)
        for a, b in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True)
    ]
    return np.unique(np.concatenate(parts).astype(np.intp))


class FieldCopy(NamedTuple):
    """A compact copy of a field.

    ``columns`` maps the ends of each column to (2, layers, rays) of low and high. A round column has one ray
    only.
    """

    columns: Mapping[Ends, FloatArray]
    edges: FloatArray
    layers: int
    rays: int
    most: int


def copied(field: PolarField, before: FieldCopy | None) -> FieldCopy:
    """Return a copy of a field. Columns that are unchanged since ``before`` share its memory."""
    known = before.columns if before is not None else {}
    ends = zip(field.edges[:-1].tolist(), field.edges[1:].tolist(), strict=True)
    columns = {
        pair: _shared(field.low[:, at], field.high[:, at], known.get(pair)) for at, pair in enumerate(ends)
    }
    layers, _, rays = field.low.shape
    return FieldCopy(columns, field.edges.copy(), layers, rays, field.most)


def restored(copy: FieldCopy) -> PolarField:
    """Return an independent field from a copy."""
    shape = copy.layers, len(copy.columns), copy.rays
    low, high = np.zeros(shape), np.zeros(shape)
    for at, column in enumerate(copy.columns.values()):
        low[: column.shape[1], at], high[: column.shape[1], at] = column
    return PolarField(copy.edges.copy(), low, high, copy.most)


def _shared(low: FloatArray, high: FloatArray, known: FloatArray | None) -> FloatArray:
    """Return a column without empty layers, on one ray if all are equal, or the known equal column."""
    filled = np.flatnonzero((high > low).any(axis=1))
    deep = int(filled[-1]) + 1 if len(filled) else 0
    column = np.stack((low[:deep], high[:deep]))
    if deep and (column == column[:, :, :1]).all():
        column = column[:, :, :1].copy()
    return known if known is not None and np.array_equal(known, column) else column
