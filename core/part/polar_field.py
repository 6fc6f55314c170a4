"""Material as a polar field: intervals of r on rays from the axis, in columns along Z.

A ray usually has one interval. It has two intervals if a bore or a face groove leaves a ring, and more
across a cross hole. The intervals are stored in layers, ascending in r. An interval is empty if its outer
radius is not greater than its inner radius. Columns may have different widths. They are divided at
shoulders and at the floors of pockets, so that these features remain exactly where they were cut.
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
RealArray = TypeVar("RealArray", FloatArray, npt.NDArray[np.float32])

DEFAULT_COLUMNS = 900
"""Maximum number of columns with which a field begins. It can divide into up to twice as many."""
DEFAULT_RAYS = 720

_TOUCH = 1e-7  # mm; thinner material counts as none
_SHOULDER_HEIGHT_MM = 0.05  # mm; a larger step between two fine columns is a shoulder
_MIN_DIVISION_MM = 0.002  # mm; least distance of a division from the edge of a column
ColumnEnds = tuple[float, float]
"""Start and end Z of a column."""


class RemovedMaterial(NamedTuple):
    """The dimensions of the material that a cut removes.

    ``volume_mm3`` is in mm³, and ``depth_mm`` is the greatest thickness along r. The cut extends from
    ``back_z_mm`` to ``front_z_mm`` in Z and from ``min_radius_mm`` to ``max_radius_mm`` in r, in mm.
    """

    volume_mm3: float = 0.0
    depth_mm: float = 0.0
    back_z_mm: float = math.inf
    front_z_mm: float = -math.inf
    min_radius_mm: float = math.inf
    max_radius_mm: float = -math.inf

    def __bool__(self) -> bool:
        return self.volume_mm3 > 0.0

    def combine_with(self, other: RemovedMaterial) -> RemovedMaterial:
        """Return the total of this cut and another cut."""
        return RemovedMaterial(
            self.volume_mm3 + other.volume_mm3,
            max(self.depth_mm, other.depth_mm),
            min(self.back_z_mm, other.back_z_mm),
            max(self.front_z_mm, other.front_z_mm),
            min(self.min_radius_mm, other.min_radius_mm),
            max(self.max_radius_mm, other.max_radius_mm),
        )


NO_MATERIAL = RemovedMaterial()


class PolarField:
    """The material of a part in polar coordinates, in mm.

    ``column_edges`` (columns + 1,) are the Z positions of the column edges, ascending. ``inner_radii`` and
    ``outer_radii`` (layers, columns, rays) are the limits of the material along r. Ray j is at the angle
    2π·j / rays, measured from the part's X toward its Y.
    """

    def __init__(
        self,
        column_edges: FloatArray,
        inner_radii: FloatArray,
        outer_radii: FloatArray,
        max_columns: int = 2 * DEFAULT_COLUMNS,
    ) -> None:
        if (
            inner_radii.shape != outer_radii.shape
            or inner_radii.ndim != 3
            or inner_radii.shape[1] != len(column_edges) - 1
        ):
            raise PartError(
                "A polar field needs one column of rays between each two edges.", "columns-and-edges"
            )
        if np.any(np.diff(column_edges) <= 0.0):
            raise PartError("The edges of a polar field have to rise.", "edges-not-rising")
        self.column_edges, self.inner_radii, self.outer_radii = column_edges, inner_radii, outer_radii
        self.ray_angles = np.arange(inner_radii.shape[2]) * (2.0 * math.pi / inner_radii.shape[2])
        self.change_count = 0  # increases with every cut, which makes pictures of the field outdated
        self._most = max(max_columns, len(column_edges) - 1)

    @property
    def max_columns(self) -> int:
        """Return the largest permitted number of columns."""
        return self._most

    @property
    def column_centers(self) -> FloatArray:
        """Return the Z of the middle of each column, in mm."""
        return 0.5 * (self.column_edges[1:] + self.column_edges[:-1])

    @property
    def column_widths(self) -> FloatArray:
        """Return the width of each column, in mm."""
        return np.diff(self.column_edges)

    @property
    def volume_mm3(self) -> float:
        """Return the volume of the material in mm³, calculated at the middles of columns and rays."""
        return float(self.column_volumes.sum())

    @property
    def column_volumes(self) -> FloatArray:
        """Return the volume of the material in each column, in mm³."""
        area = np.einsum("lcr,lcr->c", self.outer_radii, self.outer_radii) - np.einsum(
            "lcr,lcr->c", self.inner_radii, self.inner_radii
        )
        return np.asarray(area * self.column_widths * (math.pi / len(self.ray_angles)))

    @property
    def max_radii(self) -> FloatArray:
        """Return the greatest radius of each column, or 0 for a column without material."""
        return np.asarray(
            np.where(self.outer_radii > self.inner_radii, self.outer_radii, 0.0).max(axis=(0, 2))
        )

    def find_columns_between(self, back_z_mm: float, front_z_mm: float) -> slice:
        """Return a slice of the columns that overlap a range of Z."""
        first = int(np.searchsorted(self.column_edges, back_z_mm, side="right")) - 1
        last = int(np.searchsorted(self.column_edges, front_z_mm, side="left"))
        return slice(max(first, 0), min(last, len(self.column_edges) - 1))

    def copy(self) -> PolarField:
        """Return an independent copy of the field."""
        return PolarField(
            self.column_edges.copy(), self.inner_radii.copy(), self.outer_radii.copy(), self._most
        )

    def divide_columns(self, z_positions: FloatArray) -> None:
        """Divide the columns at the given Z positions, as far as the permitted number of columns allows.

        The material is unchanged.
        """
        z_positions = np.unique(
            z_positions[(z_positions > self.column_edges[0]) & (z_positions < self.column_edges[-1])]
        )
        at = np.searchsorted(self.column_edges, z_positions)
        room = (
            np.minimum(z_positions - self.column_edges[at - 1], self.column_edges[at] - z_positions)
            > _MIN_DIVISION_MM
        )
        z_positions = z_positions[room]
        z_positions = z_positions[np.diff(z_positions, prepend=-math.inf) > _MIN_DIVISION_MM]
        spare = self._most - len(self.column_edges) + 1
        if len(z_positions) > spare:
            z_positions = (
                z_positions[np.linspace(0, len(z_positions) - 1, spare).astype(np.intp)]
                if spare > 0
                else z_positions[:0]
            )
        if not len(z_positions):
            return
        edges = np.sort(np.concatenate((self.column_edges, z_positions)))
        column = np.searchsorted(self.column_edges, edges[:-1], side="right") - 1
        self.column_edges, self.inner_radii, self.outer_radii = (
            edges,
            self.inner_radii[:, column],
            self.outer_radii[:, column],
        )

    def find_removed_material(
        self,
        columns: slice,
        rays: IntArray | slice,
        inner_radii: FloatArray,
        outer_radii: FloatArray,
        *,
        remove: bool = True,
    ) -> RemovedMaterial:
        """Return the material between ``inner_radii`` and ``outer_radii`` (columns, rays).

        The material is removed if ``remove`` is True. If the outer radius on a ray is not greater than the
        inner radius, that ray is not cut.
        """
        low, high = self.inner_radii[:, columns][:, :, rays], self.outer_radii[:, columns][:, :, rays]
        there = outer_radii > inner_radii
        inner_radii, outer_radii = np.where(there, inner_radii, np.inf), np.where(there, outer_radii, np.inf)
        near, far = np.clip(inner_radii, low, high), np.clip(outer_radii, low, high)
        thick = far - near
        met = thick > _TOUCH
        touched = np.asarray(met.any(axis=(0, 2)))
        if not touched.any():
            return NO_MATERIAL
        if remove:
            self._store_remaining(
                columns, rays, low, high, np.where(met, near, high), np.where(met, far, high)
            )
            self.change_count += 1
        material = self._told(columns, touched, np.where(met, thick * (far + near), 0.0), float(thick.max()))
        return material._replace(min_radius_mm=float(near[met].min()), max_radius_mm=float(far[met].max()))

    def _told(
        self, columns: slice, touched: npt.NDArray[np.bool_], rings: FloatArray, depth: float
    ) -> RemovedMaterial:
        edges = self.column_edges[columns.start : columns.stop + 1]
        volume = float(rings.sum(axis=(0, 2)) @ np.diff(edges)) * math.pi / len(self.ray_angles)
        index = np.flatnonzero(touched)
        return RemovedMaterial(volume, depth, float(edges[index[0]]), float(edges[index[-1] + 1]))

    def _store_remaining(
        self,
        columns: slice,
        rays: IntArray | slice,
        low: FloatArray,
        high: FloatArray,
        cut_inner: FloatArray,
        cut_outer: FloatArray,
    ) -> None:
        """Store the material that a cut from ``cut_inner`` to ``cut_outer`` leaves in each layer."""
        inner, outer = cut_inner > low + _TOUCH, high > cut_outer + _TOUCH
        both = inner & outer
        new_low = np.where(inner, low, np.where(outer, cut_outer, 0.0))
        new_high = np.where(inner, cut_inner, np.where(outer, high, 0.0))
        if both.any():
            new_low, new_high = self._split_layers(new_low, new_high, cut_outer, high, both)
        index = np.arange(len(self.ray_angles))[rays]
        place = np.ix_(np.arange(len(new_low)), np.arange(columns.start, columns.stop), index)
        if isinstance(rays, slice):
            self.inner_radii[:, columns, rays], self.outer_radii[:, columns, rays] = new_low, new_high
        else:
            self.inner_radii[place], self.outer_radii[place] = new_low, new_high

    def _split_layers(
        self,
        low: FloatArray,
        high: FloatArray,
        cut_outer: FloatArray,
        top: FloatArray,
        both: npt.NDArray[np.bool_],
    ) -> tuple[FloatArray, FloatArray]:
        """Return the layers with one layer added, for rays on which the cut divides the material.

        The added layer contains the material outside the cut, from ``cut_outer`` to ``top``.
        """
        column, ray = np.nonzero(both.any(axis=0))
        split = both[:, column, ray]
        pieces_low = np.concatenate((low[:, column, ray], np.where(split, cut_outer[:, column, ray], 0.0)))
        pieces_high = np.concatenate((high[:, column, ray], np.where(split, top[:, column, ray], 0.0)))
        pieces_low, pieces_high = sort_intervals(pieces_low, pieces_high)
        needed = int((pieces_high > pieces_low).sum(axis=0).max())
        more = needed - len(self.inner_radii)
        if more > 0:
            self.inner_radii, self.outer_radii = (
                _deeper(self.inner_radii, more),
                _deeper(self.outer_radii, more),
            )
            low, high = _deeper(low, more), _deeper(high, more)
        low[:, column, ray], high[:, column, ray] = pieces_low[: len(low)], pieces_high[: len(high)]
        return low, high


def sort_intervals(inner_radii: RealArray, outer_radii: RealArray) -> tuple[RealArray, RealArray]:
    """Return the intervals of r in ascending order along the first axis of the arrays.

    Empty intervals are last, and their radii are 0.
    """
    there = outer_radii > inner_radii
    order = np.argsort(np.where(there, inner_radii, np.inf), axis=0, kind="stable")
    inner_radii, outer_radii = inner_radii * there, outer_radii * there
    return np.take_along_axis(inner_radii, order, axis=0), np.take_along_axis(outer_radii, order, axis=0)


def _deeper(layers: FloatArray, more: int) -> FloatArray:
    return np.concatenate((layers, np.zeros((more, *layers.shape[1:]))))


def make_field_from_section(
    column_edges: FloatArray,
    inner_radii: FloatArray,
    outer_radii: FloatArray,
    max_columns: int = DEFAULT_COLUMNS,
    ray_count: int = DEFAULT_RAYS,
) -> PolarField:
    """Return the polar field of a half section with fine columns.

    ``inner_radii`` and ``outer_radii`` (layers, n) are the radii of the n fine columns between
    ``column_edges`` (n + 1,). Fine columns are combined into at most ``max_columns`` columns, which are
    divided at shoulders. Each column retains its volume.
    """
    inner_radii, outer_radii = sort_intervals(inner_radii, outer_radii)
    metal = np.flatnonzero((outer_radii > inner_radii + _TOUCH).any(axis=0))
    if not len(metal):
        raise PartError("There is no metal to mill.", "no-stock")
    there = slice(int(metal[0]), int(metal[-1]) + 1)
    inner_radii, outer_radii, column_edges = (
        inner_radii[:, there],
        outer_radii[:, there],
        column_edges[there.start : there.stop + 1],
    )
    starts = _column_starts(inner_radii, outer_radii, max_columns)
    count = np.diff(np.append(starts, inner_radii.shape[1]))
    # The mean of squares preserves the volume, because fine columns have equal widths.
    inner_radii, outer_radii = (
        np.sqrt(np.add.reduceat(r * r, starts, axis=1) / count) for r in (inner_radii, outer_radii)
    )
    full = [np.repeat(r[:, :, None], ray_count, axis=2) for r in (inner_radii, outer_radii)]
    return PolarField(np.append(column_edges[starts], column_edges[-1]), full[0], full[1], 2 * max_columns)


def _column_starts(low: FloatArray, high: FloatArray, columns: int) -> IntArray:
    """Return the first fine column of each combined column.

    A column starts at every shoulder, and the other columns are distributed evenly.
    """
    fine = low.shape[1]
    rise = np.maximum(np.abs(np.diff(low)), np.abs(np.diff(high))).max(axis=0)
    steep = np.flatnonzero(rise > _SHOULDER_HEIGHT_MM)
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
    """A compact copy of a polar field.

    ``columns`` maps the ends of each column to its inner and outer radii (2, layers, rays). A round column
    has only one ray.
    """

    radii_by_column: Mapping[ColumnEnds, FloatArray]
    column_edges: FloatArray
    layer_count: int
    ray_count: int
    max_columns: int


def make_compact_copy(field: PolarField, previous: FieldCopy | None) -> FieldCopy:
    """Return a compact copy of a field.

    Columns that are unchanged since ``previous`` share the memory of that copy.
    """
    known = previous.radii_by_column if previous is not None else {}
    ends = zip(field.column_edges[:-1].tolist(), field.column_edges[1:].tolist(), strict=True)
    columns = {
        pair: _share_column(field.inner_radii[:, at], field.outer_radii[:, at], known.get(pair))
        for at, pair in enumerate(ends)
    }
    layers, _, rays = field.inner_radii.shape
    return FieldCopy(columns, field.column_edges.copy(), layers, rays, field.max_columns)


def restore_field(copy: FieldCopy) -> PolarField:
    """Return an independent field that is restored from a copy."""
    shape = copy.layer_count, len(copy.radii_by_column), copy.ray_count
    low, high = np.zeros(shape), np.zeros(shape)
    for at, column in enumerate(copy.radii_by_column.values()):
        low[: column.shape[1], at], high[: column.shape[1], at] = column
    return PolarField(copy.column_edges.copy(), low, high, copy.max_columns)


def _share_column(low: FloatArray, high: FloatArray, known: FloatArray | None) -> FloatArray:
    """Return a column without empty layers, or ``known`` if it is equal, so that copies share memory.

    The column has one ray if all rays are equal.
    """
    filled = np.flatnonzero((high > low).any(axis=1))
    deep = int(filled[-1]) + 1 if len(filled) else 0
    column = np.stack((low[:deep], high[:deep]))
    if deep and (column == column[:, :, :1]).all():
        column = column[:, :, :1].copy()
    return known if known is not None and np.array_equal(known, column) else column
