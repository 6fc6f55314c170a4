"""A milled part: flats, slots, cross holes and pockets that are cut out of a turned part.

The part's frame rotates with the part. Its X and Y are those of the face as seen by a tool that looks at the
end of the part with C at 0. Polar angles are measured from X toward Y. The live tool is on the negative X
side of the lathe (see ``core.geometry.virtual_mill``). With C at 30°, it is at the angle -30° of the part.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from core.part.polar_field import NOTHING, IntArray, PolarField, Taken
from core.part.ray_cuts import FloatArray, capsules, clipped, joined, nearest_turn, radial_mill
from core.part.tool_polygons import PartError

_SCALLOP = 0.001  # mm of scallop that a mill may leave between steps
_RAMP = 0.005  # mm of depth per step
_MOST_STEPS = 2000
_NEAR = 0.001  # mm; a mill that enters the material by less does not hit it
_LEVELS = 8  # exact floors of one path; a surface with more levels has no floor


class Reach(NamedTuple):
    """A cut on rays: columns, rays, and the interval of r that is covered."""

    columns: slice
    rays: IntArray
    start: FloatArray
    end: FloatArray


class Stroke(NamedTuple):
    """A position or a straight move of a mill that is parallel to a radius of the part.

    The end of the mill is at r ``end``. The mill moves from Z ``back`` to ``front``, or around the axis by
    ``way``. ``angle`` and ``way`` are in radians of the part, the others in mm.
    """

    end: float
    back: float
    front: float
    angle: float
    way: float = 0.0


class MilledPart:
    """A polar field of material, from which mills and turning tools remove material. Lengths are in mm."""

    def __init__(self, field: PolarField) -> None:
        self.field = field

    # --- turning

    def turn(self, first: int, start: FloatArray, end: FloatArray) -> Taken:
        """Remove the material between the radii ``start`` and ``end`` (m,) from column ``first`` on."""
        columns = slice(first, first + len(start))
        return self.field.take(columns, slice(None), start[:, None], end[:, None])

    # --- a mill parallel to the axis

    def mill_axial(
        self, path: FloatArray, radius: float, length: float = math.inf, point: float = 0.0
    ) -> Taken:
        """Mill with the tool parallel to Z along ``path`` (m, 3): x, y of its axis and z of its end.

        The path is in the part's frame. ``length`` is the cutting length from the end, and ``point`` is the
        height of its cone, 0 for a flat end. A straight line is exact, even if it rises or falls.
        """
        path = _lines(path)
        met = NOTHING
        for rise, r in _cone(radius, point):
            lifted = path + np.array([0.0, 0.0, rise])
            if not point:
                self.field.divide(_floors(lifted, length))
            met = self._take(self._axial(lifted, r, length - rise, self.field.middles), met)
        return met

    def meets_axial(
        self, path: FloatArray, radius: float, length: float = math.inf, point: float = 0.0
    ) -> bool:
        """Return whether this mill would hit material on its path, without removing any."""
        path, radius = _lines(path) + np.array([0.0, 0.0, _NEAR]), radius - _NEAR

        def met(levels: FloatArray) -> bool:
            return any(
                self._met(self._axial(path + np.array([0.0, 0.0, rise]), r, length - rise, levels))
                for rise, r in _cone(radius, point)
            )

        # Columns are divided only if the mill may hit material, because a mill that enters a column is
        # checked twice.
        if not met(self.field.edges[1:]):
            return False
        self.field.divide(_floors(path, length))
        return met(self.field.middles)

    def _axial(self, path: FloatArray, radius: float, length: float, levels: FloatArray) -> Iterator[Reach]:
        """Yield the cut of each column; ``levels`` are the depths that the end must reach for it."""
        first = int(np.searchsorted(levels, path[:, 2].min(), side="right"))
        begin, stop = _shares(path, levels[first:], length)
        if not len(begin):
            return
        new = np.any((begin[1:] != begin[:-1]) | (stop[1:] != stop[:-1]), axis=1)
        bounds = [0, *(np.flatnonzero(new) + 1).tolist(), len(begin)]
        sweep = _Sweep(path, radius, self.field.angles)
        for a, b in itertools.pairwise(bounds):
            for low, high in zip(*sweep.covered(begin[a], stop[a]), strict=True):
                rays = np.flatnonzero(high > low)
                if len(rays):
                    yield Reach(slice(first + a, first + b), rays, low[rays], high[rays])

    # --- a mill on a radius

    def mill_radial(
        self,
        path: FloatArray,
        radius: float,
        length: float = math.inf,
        height: float = 0.0,
        point: float = 0.0,
    ) -> Taken:
        """Mill with the tool on a radius of the part along ``path`` (m, 3): r of its end, z, polar angle.

        The angle is in degrees. ``height`` is the offset of the tool's axis from the part's axis, positive
        toward increasing angles. ``length`` and ``point`` are described in ``mill_axial``. Moves in r only,
        in Z only and, through the axis, in the angle only are exact. Other moves are divided into steps that
        leave 0.001 mm.
        """
        met = NOTHING
        runs = list(self._runs(path, radius, height))
        if not runs:
            return met
        self._refine(runs, radius)
        for rise, r in _cone(radius, point):
            for run in runs:
                met = self._take(self._radial(_lifted(run, rise), r, length - rise, height), met)
        return met

    def meets_radial(
        self,
        path: FloatArray,
        radius: float,
        length: float = math.inf,
        height: float = 0.0,
        point: float = 0.0,
    ) -> bool:
        """Return whether this mill would hit material on its path, without removing any."""
        runs = [_lifted(run, _NEAR) for run in self._runs(path, radius, height)]

        def met(wide: bool) -> bool:
            return any(
                self._met(self._radial(_lifted(run, rise), r, length - rise, height, wide=wide))
                for rise, r in _cone(radius - _NEAR, point)
                for run in runs
            )

        if not met(wide=True):
            return False
        self._refine(runs, radius - _NEAR)
        return met(wide=False)

    def _radial(
        self, run: list[Stroke], radius: float, length: float, height: float, *, wide: bool = False
    ) -> Iterator[Reach]:
        """Yield the cut of a run of strokes at the middles of the columns, or anywhere if ``wide``."""
        field = self.field
        columns = field.between(min(s.back for s in run) - radius, max(s.front for s in run) + radius)
        turned = [nearest_turn(field.angles - s.angle, s.way) for s in run]
        widest = _widest(min(s.end for s in run), radius + abs(height))
        rays = np.flatnonzero(np.min(np.abs(turned), axis=0) <= widest)
        if columns.stop <= columns.start or not len(rays):
            return
        back, front = field.edges[columns], field.edges[columns.start + 1 : columns.stop + 1]
        if not wide:
            back = front = 0.5 * (back + front)
        low, high = np.full((len(back), len(rays)), np.inf), np.full((len(back), len(rays)), -np.inf)
        for stroke, angles in zip(run, turned, strict=True):
            off = np.maximum(np.maximum(stroke.back - front, back - stroke.front), 0.0)
            half = np.sqrt(np.maximum(radius * radius - off * off, 0.0))
            near, far = radial_mill(angles[rays], half, stroke.end, length, height)
            # Strokes of a run overlap, so they cover one interval of each ray.
            np.minimum(low, near, out=low)
            np.maximum(high, far, out=high)
        yield Reach(columns, rays, low, high)

    def _runs(self, path: FloatArray, radius: float, height: float) -> Iterator[list[Stroke]]:
        """Yield groups of consecutive strokes whose extent is at most the mill's radius."""
        outside = float(self.field.high.max(initial=radius))
        run: list[Stroke] = []
        for stroke in self._strokes(path, radius, height, outside):
            if run and not _overlap(run, stroke, radius, outside):
                yield run
                run = []
            run.append(stroke)
        if run:
            yield run

    def _strokes(self, path: FloatArray, radius: float, height: float, outside: float) -> Iterator[Stroke]:
        path = _lines(path) * np.array([1.0, 1.0, math.pi / 180.0])
        spacing = math.sqrt(8.0 * radius * _SCALLOP)
        reach = np.array([self.field.edges[0] - radius, self.field.edges[-1] + radius])
        for start, end in _inside(path, outside, reach):
            dr, dz, dc = (end - start).tolist()
            exact_turn = height == 0.0 and min(start[0], end[0]) >= 0.0
            if dc and (dz or not exact_turn):
                count = max(math.hypot(dz, outside * dc) / spacing, abs(dr) / _RAMP)
                yield from _spots(start, end, count)
            elif dr and (dz or dc):
                yield from _ramp(start, end, abs(dr) / _RAMP)
            else:
                back, front = sorted((float(start[1]), float(end[1])))
                yield Stroke(float(min(start[0], end[0])), back, front, float(start[2]), dc)

    def _refine(self, runs: list[list[Stroke]], radius: float) -> None:
        """Divide the columns at both ends of a radial path, where the round edge of the mill crosses them."""
        back, front = min(s.back for run in runs for s in run), max(s.front for run in runs for s in run)
        round_ = radius * np.sin(np.linspace(0.0, 0.5 * math.pi, 25))
        self.field.divide(np.concatenate((back - round_, front + round_)))

    # --- common methods

    def _take(self, reaches: Iterator[Reach], met: Taken) -> Taken:
        for reach in reaches:
            met = met.joined(self.field.take(*reach))
        return met

    def _met(self, reaches: Iterator[Reach]) -> bool:
        return any(self.field.take(*reach, cut=False) for reach in reaches)


class _Sweep:
    """The area that a disc covers along a path, for shares of its lines; whole lines are cached."""

    def __init__(self, path: FloatArray, radius: float, angles: FloatArray) -> None:
        self._start, self._way = path[:-1, :2], np.diff(path[:, :2], axis=0)
        self._radius, self._angles = radius, angles
        self._whole, self._covered = np.zeros(len(self._start), dtype=np.bool_), self._layers([], 0.0, 0.0)

    def covered(self, begin: FloatArray, stop: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return layers (k, rays) of the area that is covered between two shares of each line (m,)."""
        whole = (begin == 0.0) & (stop == 1.0)
        if np.any(whole != self._whole):
            self._whole, self._covered = whole, self._layers(np.flatnonzero(whole), 0.0, 1.0)
        some = np.flatnonzero((begin <= stop) & ~whole)
        if not len(some):
            return self._covered
        low, high = self._layers(some, begin[some, None], stop[some, None])
        return joined(np.concatenate((self._covered[0], low)), np.concatenate((self._covered[1], high)))

    def _layers(
        self, lines: IntArray | list[int], begin: FloatArray | float, stop: FloatArray | float
    ) -> tuple[FloatArray, FloatArray]:
        if not len(lines):
            return np.zeros((1, len(self._angles))), np.zeros((1, len(self._angles)))
        start, way = self._start[lines], self._way[lines]
        return joined(*capsules(start + begin * way, start + stop * way, self._radius, self._angles))


def _shares(path: FloatArray, levels: FloatArray, length: float) -> tuple[FloatArray, FloatArray]:
    """Return the shares (levels, lines) between which the mill is at each level.

    If the mill does not reach a level, the first share is greater than the second.
    """
    way = np.diff(path, axis=0)
    depth = levels[:, None] - path[:-1, 2]
    begin, stop = clipped(np.broadcast_to(way[:, 2], depth.shape), depth - length, depth)
    stop = np.minimum(stop, 1.0)
    plunges = (begin <= stop) & np.all(way[:, :2] == 0.0, axis=1)
    return np.where(plunges, 0.0, begin), np.where(plunges, 1.0, stop)


def _lines(path: FloatArray) -> FloatArray:
    """Return a path of at least two points. Raises PartError if it does not have three columns."""
    if path.ndim != 2 or path.shape[1] != 3 or not len(path):
        raise PartError("A mill's path has three figures a point.", "points-not-xyz")
    return path if len(path) > 1 else np.repeat(path, 2, axis=0)


def _floors(path: FloatArray, length: float) -> FloatArray:
    """Return the Z of the floors that a path leaves, including its lowest, and of the ends of the flutes."""
    z = path[:, 2]
    flat = np.unique(z[:-1][np.diff(z) == 0.0])
    floors = np.append(flat, z.min()) if len(flat) <= _LEVELS else np.array([z.min()])
    return floors if math.isinf(length) else np.append(floors, floors + length)


def _cone(radius: float, point: float) -> Iterator[tuple[float, float]]:
    """Yield flat mills that approximate a mill with a cone of height ``point``: end offset and radius."""
    count = min(max(math.ceil(point / 0.05), 8), 24) if point else 0
    for k in range(count):
        yield point * k / count, radius * (k + 0.5) / count
    yield point, radius


def _inside(path: FloatArray, outside: float, reach: FloatArray) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield the parts of a radial path with r less than ``outside`` and Z within ``reach``."""
    way = np.diff(path, axis=0)
    first, last = np.zeros(len(way)), np.ones(len(way))
    for axis, least, most in ((0, -math.inf, outside), (1, *reach.tolist())):
        low, high = clipped(way[:, axis], least - path[:-1, axis], most - path[:-1, axis])
        first, last = np.maximum(first, low), np.minimum(last, high)
    for line in np.flatnonzero(first <= last).tolist():
        start = path[line]
        yield start + first[line] * way[line], start + last[line] * way[line]


def _lifted(run: list[Stroke], rise: float) -> list[Stroke]:
    return [stroke._replace(end=stroke.end + rise) for stroke in run] if rise else run


def _overlap(run: list[Stroke], stroke: Stroke, radius: float, outside: float) -> bool:
    """Return whether a stroke is completely within the mill's radius of the first stroke of a run."""
    first = run[0]
    along = max(stroke.front, first.front) - min(stroke.back, first.back)
    turned = outside * (abs(stroke.angle - first.angle) + max(abs(stroke.way), abs(first.way)))
    return max(along, turned, abs(stroke.end - first.end)) <= radius


def _spots(start: FloatArray, end: FloatArray, count: float) -> Iterator[Stroke]:
    for r, z, angle in np.linspace(start, end, min(math.ceil(count), _MOST_STEPS) + 1).tolist():
        yield Stroke(r, z, z, angle)


def _ramp(start: FloatArray, end: FloatArray, count: float) -> Iterator[Stroke]:
    """Yield steps of a move whose depth changes, each at its mean depth."""
    points = np.linspace(start, end, min(math.ceil(count), _MOST_STEPS) + 1)
    for (r0, z0, c0), (r1, z1, c1) in zip(points[:-1].tolist(), points[1:].tolist(), strict=True):
        yield Stroke(0.5 * (r0 + r1), min(z0, z1), max(z0, z1), c0, c1 - c0)


def _widest(end: float, half: float) -> float:
    """Return the angle in radians from the tool's axis within which all its rays are."""
    return math.atan2(half, end) + 1e-9 if end > 0.0 else math.pi
