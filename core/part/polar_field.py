"""Metal as a polar field: in columns along Z, on rays from the axis outwards, intervals of r.

A ray has one interval as a rule, two where a bore or a face groove leaves a ring, more behind a cross hole:
they lie in layers, ascending in r, an empty one with its high not above its low. Columns need not be equally
wide: they divide at shoulders and at the floors of pockets, so that these stand where they were cut.
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

_TOUCH = 1e-7  # mm; less is no metal
_JUMP = 0.05  # mm: a rise from one fine column to the next that is a shoulder
_LEAST = 0.002  # mm: no column is divided nearer to its edge
Ends = tuple[float, float]
"""Of a column: from and to which Z."""


class Taken(NamedTuple):
    """What was met: volume in mm³, greatest thickness along r, from ``back`` to ``front`` of Z, and from
    ``low`` to ``high`` of r, mm."""

    volume: float = 0.0
    depth: float = 0.0
    back: float = math.inf
    front: float = -math.inf
    low: float = math.inf
    high: float = -math.inf

    def __bool__(self) -> bool:
        return self.volume > 0.0

    def joined(self, other: Taken) -> Taken:
        """Both together."""
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
    """``edges`` (columns + 1,) of Z, rising; ``low`` and ``high`` (layers, columns, rays) of r; mm.

    Ray j lies at j full turns by the number of rays, counted from the part's X towards its Y.
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
        self.changes = 0  # counts on with every cut: what is drawn of the field is stale
        self._most = max(most, len(edges) - 1)

    @property
    def most(self) -> int:
        """How many columns it may have."""
        return self._most

    @property
    def middles(self) -> FloatArray:
        """Z of the middle of each column, mm."""
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def widths(self) -> FloatArray:
        """Width of each column, mm."""
        return np.diff(self.edges)

    @property
    def volume(self) -> float:
        """mm³ of metal, by the middles of columns and rays."""
        return float(self.volumes.sum())

    @property
    def volumes(self) -> FloatArray:
        """mm³ of metal of each column."""
        area = np.einsum("lcr,lcr->c", self.high, self.high) - np.einsum("lcr,lcr->c", self.low, self.low)
        return np.asarray(area * self.widths * (math.pi / len(self.angles)))

    @property
    def outermost(self) -> FloatArray:
        """Greatest radius of each column, 0 where there is no metal."""
        return np.asarray(np.where(self.high > self.low, self.high, 0.0).max(axis=(0, 2)))

    def between(self, back: float, front: float) -> slice:
        """The columns that lie between these Z, or reach there."""
        first = int(np.searchsorted(self.edges, back, side="right")) - 1
        last = int(np.searchsorted(self.edges, front, side="left"))
        return slice(max(first, 0), min(last, len(self.edges) - 1))

    def copied(self) -> PolarField:
        """A field of its own with the same metal."""
        return PolarField(self.edges.copy(), self.low.copy(), self.high.copy(), self._most)

    def divide(self, places: FloatArray) -> None:
        """Divide the columns at these Z, as far as there is room for more; what is there already stays."""
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
        """The metal between ``start`` and ``end``, which fit (columns, rays); taken off unless not ``cut``.

        Where ``end`` is not above ``start`` nothing is taken.
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
        """Write back what lies nearer than ``near`` and further than ``far`` in each layer."""
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
        """Layers with the pieces from ``far`` to ``top`` put in, on the rays that were split in two."""
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
    """The same intervals ascending along the first axis, empty ones last and 0."""
    there = high > low
    order = np.argsort(np.where(there, low, np.inf), axis=0, kind="stable")
    low, high = low * there, high * there
    return np.take_along_axis(low, order, axis=0), np.take_along_axis(high, order, axis=0)


def _deeper(layers: FloatArray, more: int) -> FloatArray:
    return np.concatenate((layers, np.zeros((more, *layers.shape[1:]))))


def turned_field(
    edges: FloatArray, low: FloatArray, high: FloatArray, columns: int = COLUMNS, rays: int = RAYS
) -> PolarField:
    """The field of a half section with fine columns: ``low`` and ``high`` (layers, n) between ``edges`` (n +
    1,).

    Fine columns are put together to ``columns`` at most, divided at shoulders; each keeps its volume.
    """
    low, high = in_order(low, high)
    metal = np.flatnonzero((high > low + _TOUCH).any(axis=0))
    if not len(metal):
        raise PartError("There is no metal to mill.", "no-stock")
    there = slice(int(metal[0]), int(metal[-1]) + 1)
    low, high, edges = low[:, there], high[:, there], edges[there.start : there.stop + 1]
    starts = _starts(low, high, columns)
    count = np.diff(np.append(starts, low.shape[1]))
    # A mean of squares keeps the volume; fine columns are equally wide.
    low, high = (np.sqrt(np.add.reduceat(r * r, starts, axis=1) / count) for r in (low, high))
    full = [np.repeat(r[:, :, None], rays, axis=2) for r in (low, high)]
    return PolarField(np.append(edges[starts], edges[-1]), full[0], full[1], 2 * columns)


def _starts(low: FloatArray, high: FloatArray, columns: int) -> IntArray:
    """First fine column of each column: one begins at every shoulder, the rest is divided evenly."""
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
    """``columns`` by their ends: (2, layers, rays) of low and high; one ray: it is round."""

    columns: Mapping[Ends, FloatArray]
    edges: FloatArray
    layers: int
    rays: int
    most: int


def copied(field: PolarField, before: FieldCopy | None) -> FieldCopy:
    """A copy; what is as it was ``before`` takes no more room."""
    known = before.columns if before is not None else {}
    ends = zip(field.edges[:-1].tolist(), field.edges[1:].tolist(), strict=True)
    columns = {
        pair: _shared(field.low[:, at], field.high[:, at], known.get(pair)) for at, pair in enumerate(ends)
    }
    layers, _, rays = field.low.shape
    return FieldCopy(columns, field.edges.copy(), layers, rays, field.most)


def restored(copy: FieldCopy) -> PolarField:
    """A field of its own, as it was when it was copied."""
    shape = copy.layers, len(copy.columns), copy.rays
    low, high = np.zeros(shape), np.zeros(shape)
    for at, column in enumerate(copy.columns.values()):
        low[: column.shape[1], at], high[: column.shape[1], at] = column
    return PolarField(copy.edges.copy(), low, high, copy.most)


def _shared(low: FloatArray, high: FloatArray, known: FloatArray | None) -> FloatArray:
    """A column without its empty layers, on one ray where all are alike; the known one where that is it."""
    filled = np.flatnonzero((high > low).any(axis=1))
    deep = int(filled[-1]) + 1 if len(filled) else 0
    column = np.stack((low[:deep], high[:deep]))
    if deep and (column == column[:, :, :1]).all():
        column = column[:, :, :1].copy()
    return known if known is not None and np.array_equal(known, column) else column
