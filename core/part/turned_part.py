"""The material of a turned part: intervals of r in columns along Z.

A column usually has one interval of r, more with a face groove or a ring. The intervals are stored in layers
from the axis outward. Radii are exact in the middle of a column, so cylinders, cones and arcs are as exact as
the cutting outline. A shoulder is within half a column of its position.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.part.stock import Stock
from core.part.swept_edge import Columns, FloatArray, Point

STEP = 0.008
"""Width of a column, mm, up to ``_FINE`` of them: a shoulder is off by .004 mm (.00016 in) at most."""
_FINE = 40_000  # columns; 320 mm
_TOUCH = 1e-6  # mm; thinner material counts as none
_FIT = 0.004  # mm of tolerance of a reported profile
_STEEP = 8.0  # column widths; a larger step between two columns is a shoulder
Profile = list[tuple[float, float]]
"""Z and r, mm, Z falling: from the face towards the chuck."""


def simplified(points: FloatArray, tolerance: float) -> FloatArray:
    """Return a subset (k, 2) of points (n, 2), including the ends, within ``tolerance`` of their polyline."""
    kept = np.zeros(len(points), dtype=bool)
    kept[[0, -1]] = True
    todo = [(0, len(points) - 1)]
    while todo:
        first, last = todo.pop()
        if last - first < 2:
            continue
        off = _distances(points[first + 1 : last], points[first], points[last])
        worst = int(off.argmax())
        if off[worst] > tolerance:
            middle = first + 1 + worst
            kept[middle] = True
            todo += [(first, middle), (middle, last)]
    return points[kept]


def _distances(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the distance of each point (n, 2) from the straight line between two points."""
    way: FloatArray = end - start
    length = float(np.hypot(*way))
    away = points - start
    if length == 0.0:
        return np.hypot(away[:, 0], away[:, 1])
    off: FloatArray = np.abs(way[0] * away[:, 1] - way[1] * away[:, 0]) / length
    return off


class Cut(NamedTuple):
    """The material that one move cuts. Lengths are in mm, the area of the half section in mm², volume in mm³.

    ``depth`` is the greatest thickness along r. ``width`` is the length of Z that is cut, from ``back`` to
    ``front``.
    """

    area: float = 0.0
    volume: float = 0.0
    depth: float = 0.0
    width: float = 0.0
    back: float = 0.0
    front: float = 0.0
    parts: bool = False  # a column has lost all its material

    def __bool__(self) -> bool:
        return self.area > 0.0

    def joined(self, other: Cut) -> Cut:
        """Return both cuts together."""
        if not self or not other:
            return self or other
        return Cut(
            self.area + other.area,
            self.volume + other.volume,
            self.depth + other.depth,
            max(self.width, other.width),
            min(self.back, other.back),
            max(self.front, other.front),
            self.parts or other.parts,
        )

    def followed(self, other: Cut) -> Cut:
        """Return this cut followed by another one of the same move, with the greater of both depths."""
        return self.joined(other)._replace(depth=max(self.depth, other.depth))


NOTHING = Cut()


class Piece(NamedTuple):
    """A piece that was parted off: volume in mm³, outside profile, and bore (None if it is solid)."""

    volume: float
    outside: Profile
    bore: Profile | None
    min_wall: float | None


def _span(r0: float, r1: float) -> tuple[float, float]:
    """Return the least and the greatest distance from the axis on a straight move from ``r0`` to ``r1``."""
    nearest = 0.0 if r0 * r1 < 0.0 else min(abs(r0), abs(r1))
    return nearest, max(abs(r0), abs(r1))


class TurnedPart:
    """A part in the lathe: material from ``low`` to ``high`` (layers, columns), as radii in mm."""

    def __init__(self, stock: Stock, step: float = STEP) -> None:
        length = stock.front - stock.back
        count = max(math.ceil(length / step - 1e-9), 1)
        step = length / count if count <= _FINE else length / _FINE
        count = min(count, _FINE)
        self.columns = Columns(stock.back + step / 2, step, count)
        middles = self.columns.middles
        self.high = stock.outside_at(middles)[np.newaxis, :].copy()
        self.low = np.minimum(stock.bore_at(middles), self.high[0])[np.newaxis, :].copy()
        self.largest = stock.radius
        self.whole = self.volume  # volume of the stock, mm³
        self.pieces: list[Piece] = []
        self.holds = False  # parted material remains in place until ``let_fall``
        self._parted = False
        self.removed = 0.0  # mm³ removed by cuts only

    # --- present material

    @property
    def volume(self) -> float:
        """Volume in mm³ of all the material in the chuck."""
        return self._volume(slice(None))

    @property
    def outermost(self) -> FloatArray:
        """The greatest radius of each column (columns,); 0 if it contains no material."""
        there = self.high > self.low
        radii: FloatArray = np.max(np.where(there, self.high, 0.0), axis=0)
        return radii

    @property
    def innermost(self) -> FloatArray:
        """The least radius of the material in each column (columns,); 0 if it contains none."""
        there = self.high > self.low
        inner = np.min(np.where(there, self.low, np.inf), axis=0)
        return np.where(np.isfinite(inner), inner, 0.0)

    def highest(self, back: float, front: float) -> float:
        """Return the greatest radius of the columns from Z ``back`` to ``front``; 0 without columns."""
        there = slice(self.columns.at(back), self.columns.at(front))
        return float(self.high[:, there].max(initial=0.0))

    def _volume(self, there: slice) -> float:
        low, high = self.low[:, there], self.high[:, there]
        return math.pi * self.columns.step * float(np.sum(high * high - low * low))

    def contains(self, points: Sequence[Point], depth: float) -> bool:
        """Return whether a path of Z and r in mm is more than ``depth`` inside the material anywhere."""
        return any(self._crossed(start, end, depth) for start, end in pairwise(points))

    def _crossed(self, start: Point, end: Point, depth: float) -> bool:
        (z0, r0), (z1, r1) = (start, end) if start[0] <= end[0] else (end, start)
        first, last = self.columns.at(z0), self.columns.at(z1)
        if first == last:  # perpendicular to the axis, within one column
            if not 0 < first < self.columns.number:
                return False
            nearest, farthest = _span(r0, r1)
            low, high = self.low[:, first], self.high[:, first]
            return bool(
                np.any((high - low > 2 * depth) & (farthest > low + depth) & (nearest < high - depth))
            )
        z = self.columns.first + self.columns.step * np.arange(first, last)
        r = np.abs(r0 + (r1 - r0) * (z - z0) / (z1 - z0))
        low, high = self.low[:, first:last], self.high[:, first:last]
        return bool(np.any((r > low + depth) & (r < high - depth)))

    # --- cuts

    def outwards(self, first: int, reach: FloatArray, *, cut: bool = True) -> Cut:
        """Return all material further out than ``reach`` (m,) from column ``first`` on.

        The material is removed if ``cut`` is True.
        """
        there = slice(first, first + len(reach))
        met = NOTHING
        for low, high in zip(self.low[:, there], self.high[:, there], strict=True):
            left = np.minimum(np.maximum(reach, low), high)
            met = met.joined(self._met(first, low, high, left, high))
            if cut:
                high[:] = left
        return self._taken(met, cut=cut)

    def inwards(self, first: int, reach: FloatArray, *, cut: bool = True) -> Cut:
        """Return all material closer to the axis than ``reach`` (m,); remove it if ``cut``."""
        there = slice(first, first + len(reach))
        met = NOTHING
        for low, high in zip(self.low[:, there], self.high[:, there], strict=True):
            left = np.maximum(np.minimum(reach, high), low)
            met = met.joined(self._met(first, low, high, low, left))
            if cut:
                low[:] = left
        return self._taken(met, cut=cut)

    def between(self, first: int, near: FloatArray, far: FloatArray, *, cut: bool = True) -> Cut:
        """Return all material between the radii ``near`` and ``far`` (m,); remove it if ``cut``."""
        there = slice(first, first + len(near))
        met = NOTHING
        for layer in range(len(self.low)):
            low, high = self.low[layer, there], self.high[layer, there]
            start, end = np.clip(near, low, high), np.clip(far, low, high)
            end = np.maximum(start, end)
            met = met.joined(self._met(first, low, high, start, end))
            if cut:
                self._split(layer, there, start, end)
        return self._taken(met, cut=cut)

    def _split(self, layer: int, there: slice, start: FloatArray, end: FloatArray) -> None:
        """Remove [start, end] from one layer, and move the material further out to a separate layer."""
        low, high = self.low[layer, there].copy(), self.high[layer, there].copy()
        taken = end > start
        outer = taken & (high > end)
        inner = taken & (start > low)
        both = outer & inner
        self.high[layer, there] = np.where(inner, start, np.where(taken & ~outer, low, high))
        self.low[layer, there] = np.where(outer & ~inner, end, low)
        if both.any():
            self._layer_for(there, np.where(both, end, 0.0), np.where(both, high, 0.0), both)

    def _layer_for(
        self, there: slice, low: FloatArray, high: FloatArray, wanted: npt.NDArray[np.bool_]
    ) -> None:
        for layer in range(len(self.low)):
            free = self.high[layer, there] <= self.low[layer, there]
            if free[wanted].all():
                self.low[layer, there] = np.where(wanted, low, self.low[layer, there])
                self.high[layer, there] = np.where(wanted, high, self.high[layer, there])
                return
        empty = np.zeros((1, self.columns.number))
        self.low, self.high = np.vstack((self.low, empty)), np.vstack((self.high, empty))
        self._layer_for(there, low, high, wanted)

    def _met(self, first: int, low: FloatArray, high: FloatArray, start: FloatArray, end: FloatArray) -> Cut:
        """Return the material between ``start`` and ``end`` of a layer, both within its interval."""
        thick = end - start
        touched = (thick > _TOUCH).nonzero()[0]
        if not len(touched):
            return NOTHING
        step, begin = self.columns.step, self.columns.first + self.columns.step * (first - 0.5)
        whole = (start[touched] <= low[touched] + _TOUCH) & (end[touched] >= high[touched] - _TOUCH)
        return Cut(
            area=step * float(thick.sum()),
            volume=math.pi * step * float(end @ end - start @ start),
            depth=float(thick.max()),
            width=step * len(touched),
            back=begin + step * int(touched[0]),
            front=begin + step * (int(touched[-1]) + 1),
            parts=bool(whole.any()),
        )

    def _taken(self, met: Cut, *, cut: bool) -> Cut:
        if cut and met:
            self.removed += met.volume
            self._parted = self._parted or met.parts
            if not self.holds:
                self.let_fall()
        return met

    def let_fall(self) -> None:
        """Drop the pieces that were parted off while they were supported."""
        self.holds = False
        if self._parted:
            self._parted = False
            self._part_off()

    # --- parting off

    def _part_off(self) -> None:
        """Drop the material that is not connected to the end in the chuck. Chips are not counted."""
        metal = np.any(self.high > self.low + _TOUCH, axis=0)
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
            self.pieces.append(self._piece(there, volume))
        self.low[:, there] = self.high[:, there] = 0.0

    def rest(self) -> Piece:
        """Return the material in the chuck as a piece."""
        return self._piece(slice(None), self.volume)

    def _piece(self, there: slice, volume: float) -> Piece:
        z = self.columns.middles[there]
        high, low = self.outermost[there], self.innermost[there]
        metal = high > low + _TOUCH
        if not metal.any():
            return Piece(0.0, [], None, None)
        z, high, low = z[metal], high[metal], low[metal]
        bored = low > _TOUCH
        wall = float(np.min(high[bored] - low[bored])) if bored.any() else None
        bore = self._profile(z, low) if bored.any() else None
        return Piece(volume, self._profile(z, high), bore, wall)

    def _profile(self, z: FloatArray, r: FloatArray) -> Profile:
        """Return the points from the face toward the chuck, with vertical shoulders between columns."""
        half = self.columns.step / 2
        rise = np.abs(np.diff(r))
        beside = np.maximum(np.append(rise[1:], 0.0), np.insert(rise[:-1], 0, 0.0))
        steps = np.flatnonzero(rise > _STEEP * np.maximum(self.columns.step, beside))
        points = np.column_stack((z, r))
        upright = np.column_stack(
            (np.repeat(z[steps] + half, 2), np.column_stack((r[steps], r[steps + 1])).ravel())
        )
        points = np.insert(points, np.repeat(steps + 1, 2), upright, axis=0)
        ends = np.array([[z[0] - half, r[0]]]), np.array([[z[-1] + half, r[-1]]])
        fitted = simplified(np.vstack((ends[0], points, ends[1]))[::-1], _FIT)
        return [(float(a), float(b)) for a, b in fitted]
