"""Material of a turned part: intervals of r in columns along Z.

A column usually has one interval of r. It has more where a face groove or a ring divides the material. The
intervals are stored in layers from the axis outward. Radii are exact in the middle of a column, so
cylinders, cones and arcs are as exact as the outline of the tool. A shoulder is within half a column of its
position.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.stock import Stock
from core.part.swept_edge import AxisFacingEdge, ColumnGrid, FloatArray, Point

DEFAULT_COLUMN_WIDTH_MM = 0.008
"""Default column width in mm, for up to ``_MAX_COLUMNS`` columns.

A shoulder is off by at most 0.004 mm (.00016 in).
"""
_MAX_COLUMNS = 40_000  # columns; 320 mm
_TOUCH = 1e-6  # mm; thinner material counts as none
_PROFILE_TOLERANCE_MM = 0.004  # mm of tolerance of a reported profile
_STEEP_RATIO = 8.0  # column widths; a larger step between two columns is a shoulder
ProfilePoints = list[tuple[float, float]]
"""Points of Z and radius in mm, with Z falling from the face toward the chuck."""


def simplify_polyline(points: FloatArray, tolerance: float) -> FloatArray:
    """Return those of the points (n, 2) that are needed to stay within ``tolerance`` of all points.

    The result (k, 2) includes both ends.
    """
    kept = np.zeros(len(points), dtype=bool)
    kept[[0, -1]] = True
    todo = [(0, len(points) - 1)]
    while todo:
        first, last = todo.pop()
        if last - first < 2:
            continue
        off = _distances_from_line(points[first + 1 : last], points[first], points[last])
        worst = int(off.argmax())
        if off[worst] > tolerance:
            middle = first + 1 + worst
            kept[middle] = True
            todo += [(first, middle), (middle, last)]
    return points[kept]


def _distances_from_line(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the distance of each point (n, 2) from the straight line between two points."""
    line_vector: FloatArray = end - start
    length = float(np.hypot(*line_vector))
    away = points - start
    if length == 0.0:
        return np.hypot(away[:, 0], away[:, 1])
    off: FloatArray = np.abs(line_vector[0] * away[:, 1] - line_vector[1] * away[:, 0]) / length
    return off


class Cut(NamedTuple):
    """The dimensions of the material that one move removes.

    Lengths are in mm, the area of the half section is in mm², and the volume is in mm³. ``depth_mm`` is the
    greatest thickness along r. ``width_mm`` is the cut length along Z, from ``back_z_mm`` to
    ``front_z_mm``.
    """

    area: float = 0.0
    volume_mm3: float = 0.0
    depth_mm: float = 0.0
    width_mm: float = 0.0
    back_z_mm: float = 0.0
    front_z_mm: float = 0.0
    is_parted_off: bool = False  # a column has lost all its material

    def __bool__(self) -> bool:
        return self.area > 0.0

    def combine_with(self, other: Cut) -> Cut:
        """Return the total of this cut and another cut."""
        if not self or not other:
            return self or other
        return Cut(
            self.area + other.area,
            self.volume_mm3 + other.volume_mm3,
            self.depth_mm + other.depth_mm,
            max(self.width_mm, other.width_mm),
            min(self.back_z_mm, other.back_z_mm),
            max(self.front_z_mm, other.front_z_mm),
            self.is_parted_off or other.is_parted_off,
        )

    def combine_with_later(self, other: Cut) -> Cut:
        """Return the total of this cut and a later cut of the same move, with the greater of both depths."""
        if not self or not other:
            return self or other
        return self.combine_with(other)._replace(depth_mm=max(self.depth_mm, other.depth_mm))


NO_CUT = Cut()


class PartedPiece(NamedTuple):
    """A piece that was parted off, with its volume in mm³ and its profiles.

    ``bore_profile`` is None if the piece is solid.
    """

    volume_mm3: float
    outside_profile: ProfilePoints
    bore_profile: ProfilePoints | None
    min_wall_mm: float | None


def _radius_range(r0: float, r1: float) -> tuple[float, float]:
    """Return the least and the greatest distance from the axis on a straight move from ``r0`` to ``r1``."""
    nearest = 0.0 if r0 * r1 < 0.0 else min(abs(r0), abs(r1))
    return nearest, max(abs(r0), abs(r1))


class TurnedPart:
    """A part in the lathe, with its material as radii in mm.

    The material in each column extends from ``inner_radii`` to ``outer_radii`` (layers, columns).
    """

    def __init__(self, stock: Stock, column_width: float = DEFAULT_COLUMN_WIDTH_MM) -> None:
        length = stock.front_z_mm - stock.back_z_mm
        count = max(math.ceil(length / column_width - 1e-9), 1)
        column_width = length / count if count <= _MAX_COLUMNS else length / _MAX_COLUMNS
        count = min(count, _MAX_COLUMNS)
        self.columns = ColumnGrid(stock.back_z_mm + column_width / 2, column_width, count)
        middles = self.columns.column_centers
        self.outer_radii = stock.find_outside_radii(middles)[np.newaxis, :].copy()
        self.inner_radii = np.minimum(stock.find_bore_radii(middles), self.outer_radii[0])[
            np.newaxis, :
        ].copy()
        self.max_stock_radius_mm = stock.max_radius_mm
        self.stock_volume_mm3 = self.volume_mm3  # volume of the stock, mm³
        self.parted_pieces: list[PartedPiece] = []
        self.holds_parted_pieces = False  # parted material remains in place until ``drop_parted_pieces``
        self._parted = False
        self.removed_volume_mm3 = 0.0  # mm³ removed by cuts only

    # --- present material

    @property
    def volume_mm3(self) -> float:
        """Return the volume in mm³ of all material in the chuck."""
        return self._volume(slice(None))

    @property
    def max_radii(self) -> FloatArray:
        """Return the greatest radius of each column (columns,), or 0 for a column without material."""
        there = self.outer_radii > self.inner_radii
        radii: FloatArray = np.max(np.where(there, self.outer_radii, 0.0), axis=0)
        return radii

    @property
    def min_radii(self) -> FloatArray:
        """Return the least radius of the material in each column (columns,).

        The radius is 0 for a column without material.
        """
        there = self.outer_radii > self.inner_radii
        inner = np.min(np.where(there, self.inner_radii, np.inf), axis=0)
        return np.where(np.isfinite(inner), inner, 0.0)

    def find_max_radius(self, back_z_mm: float, front_z_mm: float) -> float:
        """Return the greatest radius of the columns from Z ``back_z_mm`` to ``front_z_mm``.

        The result is 0 if there are no columns in this range.
        """
        there = slice(self.columns.find_column(back_z_mm), self.columns.find_column(front_z_mm))
        return float(np.maximum.reduce(self.outer_radii[:, there], axis=None, initial=0.0))

    def _volume(self, there: slice) -> float:
        low, high = self.inner_radii[:, there], self.outer_radii[:, there]
        return math.pi * self.columns.step_mm * float(np.sum(high * high - low * low))

    def enters_material(self, points: Sequence[Point], min_depth: float) -> bool:
        """Return whether any point of a path is more than ``min_depth`` inside the material.

        The path consists of Z and r in mm.
        """
        return any(self._crossed(start, end, min_depth) for start, end in pairwise(points))

    def is_cut_at_nose(self, edge: AxisFacingEdge, place: Point) -> bool:
        """Return whether an edge at ``place`` would cut the first column in front of its lowest point.

        The edge may cut other columns although it does not cut this column.
        """
        lowest = int(edge.r.argmin())
        if lowest + 1 == len(edge.z):
            return False
        (z0, z1), (r0, r1) = edge.z[lowest : lowest + 2].tolist(), edge.r[lowest : lowest + 2].tolist()
        column = self.columns.find_column(place[0] + z0)
        ahead = self.columns.first_z_mm + self.columns.step_mm * column - (place[0] + z0)
        if column == self.columns.column_count or not 0.0 <= ahead < z1 - z0:
            return False
        radius = place[1] + r0 + (r1 - r0) * ahead / (z1 - z0)
        low, high = self.inner_radii[:, column].tolist(), self.outer_radii[:, column].tolist()
        return any(b - max(a, radius) > 2.0 * _TOUCH for a, b in zip(low, high, strict=True))

    def _crossed(self, start: Point, end: Point, depth: float) -> bool:
        (z0, r0), (z1, r1) = (start, end) if start[0] <= end[0] else (end, start)
        first, last = self.columns.find_column(z0), self.columns.find_column(z1)
        if first == last:  # perpendicular to the axis, within one column
            if not 0 < first < self.columns.column_count:
                return False
            nearest, farthest = _radius_range(r0, r1)
            low, high = self.inner_radii[:, first], self.outer_radii[:, first]
            return bool(
                np.any((high - low > 2 * depth) & (farthest > low + depth) & (nearest < high - depth))
            )
        z = self.columns.column_centers[first:last]
        r = np.abs(r0 + (r1 - r0) * (z - z0) / (z1 - z0))
        low, high = self.inner_radii[:, first:last], self.outer_radii[:, first:last]
        return bool(np.any((r > low + depth) & (r < high - depth)))

    # --- cuts

    def cut_outside(self, first_column: int, radii: FloatArray, *, remove: bool = True) -> Cut:
        """Return the material outside ``radii``, one for each column from ``first_column`` on.

        If ``remove`` is True, this material is also removed.
        """
        there = slice(first_column, first_column + len(radii))
        met = NO_CUT
        for low, high in zip(self.inner_radii[:, there], self.outer_radii[:, there], strict=True):
            left = np.maximum(radii, low)
            np.minimum(left, high, out=left)
            met = met.combine_with(self._measure_cut(first_column, low, high, left, high))
            if remove:
                high[:] = left
        return self._taken(met, cut=remove)

    def cut_inside(self, first_column: int, radii: FloatArray, *, remove: bool = True) -> Cut:
        """Return all material closer to the axis than ``radii`` (m,) from column ``first_column`` on.

        The material is removed if ``remove`` is True.
        """
        there = slice(first_column, first_column + len(radii))
        met = NO_CUT
        for low, high in zip(self.inner_radii[:, there], self.outer_radii[:, there], strict=True):
            left = np.maximum(np.minimum(radii, high), low)
            met = met.combine_with(self._measure_cut(first_column, low, high, low, left))
            if remove:
                low[:] = left
        return self._taken(met, cut=remove)

    def cut_between(
        self, first_column: int, inner_radii: FloatArray, outer_radii: FloatArray, *, remove: bool = True
    ) -> Cut:
        """Return all material between ``inner_radii`` and ``outer_radii`` (m,), from ``first_column`` on.

        The material is removed if ``remove`` is True.
        """
        there = slice(first_column, first_column + len(inner_radii))
        met = NO_CUT
        for layer in range(len(self.inner_radii)):
            low, high = self.inner_radii[layer, there], self.outer_radii[layer, there]
            start, end = np.clip(inner_radii, low, high), np.clip(outer_radii, low, high)
            end = np.maximum(start, end)
            met = met.combine_with(self._measure_cut(first_column, low, high, start, end))
            if remove:
                self._split_layer(layer, there, start, end)
        return self._taken(met, cut=remove)

    def _split_layer(self, layer: int, there: slice, start: FloatArray, end: FloatArray) -> None:
        """Remove the radii from ``start`` to ``end`` from one layer.

        Material of the layer outside ``end`` is moved to a separate layer.
        """
        low, high = self.inner_radii[layer, there].copy(), self.outer_radii[layer, there].copy()
        taken = end > start
        outer = taken & (high > end)
        inner = taken & (start > low)
        both = outer & inner
        self.outer_radii[layer, there] = np.where(inner, start, np.where(taken & ~outer, low, high))
        self.inner_radii[layer, there] = np.where(outer & ~inner, end, low)
        if both.any():
            self._layer_for(there, np.where(both, end, 0.0), np.where(both, high, 0.0), both)

    def _layer_for(
        self, there: slice, low: FloatArray, high: FloatArray, wanted: npt.NDArray[np.bool_]
    ) -> None:
        for layer in range(len(self.inner_radii)):
            free = self.outer_radii[layer, there] <= self.inner_radii[layer, there]
            if free[wanted].all():
                self.inner_radii[layer, there] = np.where(wanted, low, self.inner_radii[layer, there])
                self.outer_radii[layer, there] = np.where(wanted, high, self.outer_radii[layer, there])
                return
        empty = np.zeros((1, self.columns.column_count))
        self.inner_radii, self.outer_radii = (
            np.vstack((self.inner_radii, empty)),
            np.vstack((self.outer_radii, empty)),
        )
        self._layer_for(there, low, high, wanted)

    def _measure_cut(
        self, first: int, low: FloatArray, high: FloatArray, start: FloatArray, end: FloatArray
    ) -> Cut:
        """Return the cut from ``start`` to ``end``, both within the intervals of one layer.

        Pass ``high`` as ``end`` if all material outside ``start`` is cut.
        """
        thick = end - start
        touched = (thick > _TOUCH).nonzero()[0]
        if not len(touched):
            return NO_CUT
        step, begin = self.columns.step_mm, self.columns.first_z_mm + self.columns.step_mm * (first - 0.5)
        whole = start[touched] <= low[touched] + _TOUCH
        if end is not high:
            whole &= end[touched] >= high[touched] - _TOUCH
        return Cut(
            area=step * float(np.add.reduce(thick)),
            volume_mm3=math.pi * step * float(end @ end - start @ start),
            depth_mm=float(np.maximum.reduce(thick)),
            width_mm=step * len(touched),
            back_z_mm=begin + step * int(touched[0]),
            front_z_mm=begin + step * (int(touched[-1]) + 1),
            is_parted_off=bool(whole.any()),
        )

    def _taken(self, met: Cut, *, cut: bool) -> Cut:
        if cut and met:
            self.removed_volume_mm3 += met.volume_mm3
            self._parted = self._parted or met.is_parted_off
            if not self.holds_parted_pieces:
                self.drop_parted_pieces()
        return met

    def drop_parted_pieces(self) -> None:
        """Drop parted-off pieces that stayed in place for the collision check of the holder."""
        self.holds_parted_pieces = False
        if self._parted:
            self._parted = False
            self._drop_unconnected()

    # --- parting off

    def _drop_unconnected(self) -> None:
        """Drop the material that is no longer connected to the end in the chuck.

        Pieces as small as chips are not counted as parted pieces.
        """
        metal = np.any(self.outer_radii > self.inner_radii + _TOUCH, axis=0)
        there = np.flatnonzero(metal)
        if not len(there):
            return
        gaps = np.flatnonzero(np.diff(there) > 1)
        if not len(gaps):
            return
        starts, ends = there[gaps + 1], np.append(there[gaps[1:]], there[-1]) + 1
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
            self._fall(slice(start, end))

    def _fall(self, there: slice) -> None:
        volume = self._volume(there)
        if volume > 0.01:  # mm³
            self.parted_pieces.append(self._piece(there, volume))
        self.inner_radii[:, there] = self.outer_radii[:, there] = 0.0

    def make_remaining_piece(self) -> PartedPiece:
        """Return the remaining material in the chuck as a piece."""
        return self._piece(slice(None), self.volume_mm3)

    def _piece(self, there: slice, volume: float) -> PartedPiece:
        z = self.columns.column_centers[there]
        high, low = self.max_radii[there], self.min_radii[there]
        metal = high > low + _TOUCH
        if not metal.any():
            return PartedPiece(0.0, [], None, None)
        z, high, low = z[metal], high[metal], low[metal]
        bored = low > _TOUCH
        wall = float(np.min(high[bored] - low[bored])) if bored.any() else None
        bore = self._make_profile(z, low) if bored.any() else None
        return PartedPiece(volume, self._make_profile(z, high), bore, wall)

    def _make_profile(self, z: FloatArray, r: FloatArray) -> ProfilePoints:
        """Return the profile points from the face toward the chuck.

        The profile has vertical shoulders between columns.
        """
        half = self.columns.step_mm / 2
        rise = np.abs(np.diff(r))
        neighbor_rise = np.maximum(np.append(rise[1:], 0.0), np.insert(rise[:-1], 0, 0.0))
        steps = np.flatnonzero(rise > _STEEP_RATIO * np.maximum(self.columns.step_mm, neighbor_rise))
        points = np.column_stack((z, r))
        upright = np.column_stack(
            (np.repeat(z[steps] + half, 2), np.column_stack((r[steps], r[steps + 1])).ravel())
        )
        points = np.insert(points, np.repeat(steps + 1, 2), upright, axis=0)
        ends = np.array([[z[0] - half, r[0]]]), np.array([[z[-1] + half, r[-1]]])
        fitted = simplify_polyline(np.vstack((ends[0], points, ends[1]))[::-1], _PROFILE_TOLERANCE_MM)
        return [(float(a), float(b)) for a, b in fitted]
