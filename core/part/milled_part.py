"""A milled part: flats, slots, cross holes and pockets that are cut out of a turned part.

The part's frame rotates with the part. Its X and Y are those of the face as seen from a tool that faces the
end of the part with C at 0. Polar angles are measured from X toward Y. The live tool is on the negative X
side of the lathe (see ``core.geometry.virtual_mill``). With C at 30°, the tool is at the angle -30° of the
part.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from core.part.polar_field import NO_MATERIAL, IntArray, PolarField, RemovedMaterial
from core.part.ray_cuts import (
    FloatArray,
    clip_interval,
    find_capsule_intervals,
    find_nearest_angles,
    find_radial_mill_intervals,
    unite_intervals,
)
from core.part.tool_polygons import PartError

_SCALLOP = 0.001  # mm of scallop that a mill may leave between steps
_RAMP = 0.005  # mm of depth per step
_MAX_STEPS = 2000
_NEAR_DISTANCE_MM = 0.001  # mm; a mill that enters the material by less does not hit it
_LEVELS = 8  # exact floors of one path; a surface with more levels has no floor


class RayCut(NamedTuple):
    """A cut on rays from the part's axis: its columns, its rays and the interval of r."""

    column_range: slice
    ray_indices: IntArray
    start_radii: FloatArray
    end_radii: FloatArray


class RadialMillMove(NamedTuple):
    """Move of a radial mill along Z or around the part's axis.

    The axis of the mill is parallel to a radius of the part. The end of the mill is at the radius
    ``end_radius_mm``. The mill moves between Z ``back_z_mm`` and ``front_z_mm``, and around the part's axis
    by ``rotation_rad``, starting at ``angle_rad``. If these moves are both 0, the mill is at one position.
    Angles are in radians in the part's frame.
    """

    end_radius_mm: float
    back_z_mm: float
    front_z_mm: float
    angle_rad: float
    rotation_rad: float = 0.0


class MilledPart:
    """The material of a part as a polar field in mm, which mills and turning tools can cut."""

    def __init__(self, field: PolarField) -> None:
        self.field = field

    # --- turning

    def remove_turned_material(
        self, first_column: int, start: FloatArray, end: FloatArray
    ) -> RemovedMaterial:
        """Remove the material between two radii (m,) in each column, from column ``first_column`` on.

        ``start`` and ``end`` are the inner and outer radii.
        """
        columns = slice(first_column, first_column + len(start))
        return self.field.find_removed_material(columns, slice(None), start[:, None], end[:, None])

    # --- a mill parallel to the axis

    def mill_axial_path(
        self, path: FloatArray, radius: float, cutting_length: float = math.inf, cone_height: float = 0.0
    ) -> RemovedMaterial:
        """Mill along ``path`` (m, 3) with the tool parallel to Z.

        The path contains x and y of the tool axis and z of the tool end, in the part's frame.
        ``cutting_length`` is the cutting length from the end, and ``cone_height`` is the height of the cone
        at the end, 0 for a flat end. A straight line is exact, even if its z changes.
        """
        path = _path_lines(path)
        met = NO_MATERIAL
        for rise, r in _iter_cone_steps(radius, cone_height):
            lifted = path + np.array([0.0, 0.0, rise])
            if not cone_height:
                self.field.divide_columns(_floor_levels(lifted, cutting_length))
            met = self._take(
                self._axial_cuts(lifted, r, cutting_length - rise, self.field.column_centers), met
            )
        return met

    def has_axial_collision(
        self, path: FloatArray, radius: float, length: float = math.inf, point: float = 0.0
    ) -> bool:
        """Return whether the mill would hit material on its path, without removing the material.

        See ``mill_axial_path`` for the arguments.
        """
        path, radius = _path_lines(path) + np.array([0.0, 0.0, _NEAR_DISTANCE_MM]), radius - _NEAR_DISTANCE_MM

        def hits_material(levels: FloatArray) -> bool:
            return any(
                self._met(self._axial_cuts(path + np.array([0.0, 0.0, rise]), r, length - rise, levels))
                for rise, r in _iter_cone_steps(radius, point)
            )

        # Columns are divided only if the mill may hit material, because a mill that enters a column is
        # checked twice.
        if not hits_material(self.field.column_edges[1:]):
            return False
        self.field.divide_columns(_floor_levels(path, length))
        return hits_material(self.field.column_centers)

    def _axial_cuts(
        self, path: FloatArray, radius: float, length: float, levels: FloatArray
    ) -> Iterator[RayCut]:
        """Yield the cut of an axial mill in each column.

        ``levels`` are the depths that the end of the mill must reach to cut a column.
        """
        first = int(np.searchsorted(levels, path[:, 2].min(), side="right"))
        begin, stop = _level_fractions(path, levels[first:], length)
        if not len(begin):
            return
        new = np.any((begin[1:] != begin[:-1]) | (stop[1:] != stop[:-1]), axis=1)
        bounds = [0, *(np.flatnonzero(new) + 1).tolist(), len(begin)]
        sweep = _DiscSweep(path, radius, self.field.ray_angles)
        for a, b in itertools.pairwise(bounds):
            for low, high in zip(*sweep.find_covered_area(begin[a], stop[a]), strict=True):
                rays = np.flatnonzero(high > low)
                if len(rays):
                    yield RayCut(slice(first + a, first + b), rays, low[rays], high[rays])

    # --- a mill on a radius

    def mill_radial_path(
        self,
        path: FloatArray,
        radius: float,
        cutting_length: float = math.inf,
        axis_offset: float = 0.0,
        cone_height: float = 0.0,
    ) -> RemovedMaterial:
        """Mill along ``path`` (m, 3) with the tool on a radius of the part.

        The path contains r of the tool end, z, and the polar angle in degrees. ``axis_offset`` is the
        offset of the tool's axis from the part's axis, positive toward increasing angles. See
        ``mill_axial_path`` for ``cutting_length`` and ``cone_height``.

        A move in only r or only Z is exact. A move in only the angle is exact if ``axis_offset`` is 0. Any
        other move is divided into steps with an error of at most 0.001 mm.
        """
        met = NO_MATERIAL
        runs = list(self._group_strokes(path, radius, axis_offset))
        if not runs:
            return met
        self._divide_at_ends(runs, radius)
        for rise, r in _iter_cone_steps(radius, cone_height):
            for run in runs:
                met = self._take(
                    self._radial_cuts(_lifted(run, rise), r, cutting_length - rise, axis_offset), met
                )
        return met

    def has_radial_collision(
        self,
        path: FloatArray,
        radius: float,
        length: float = math.inf,
        height: float = 0.0,
        point: float = 0.0,
    ) -> bool:
        """Return whether the mill would hit material on its path, without removing the material.

        See ``mill_radial_path`` for the arguments.
        """
        runs = [_lifted(run, _NEAR_DISTANCE_MM) for run in self._group_strokes(path, radius, height)]

        def hits_material(wide: bool) -> bool:
            return any(
                self._met(
                    self._radial_cuts(_lifted(run, rise), r, length - rise, height, covers_whole_columns=wide)
                )
                for rise, r in _iter_cone_steps(radius - _NEAR_DISTANCE_MM, point)
                for run in runs
            )

        if not hits_material(wide=True):
            return False
        self._divide_at_ends(runs, radius - _NEAR_DISTANCE_MM)
        return hits_material(wide=False)

    def _radial_cuts(
        self,
        run: list[RadialMillMove],
        radius: float,
        length: float,
        height: float,
        *,
        covers_whole_columns: bool = False,
    ) -> Iterator[RayCut]:
        """Yield the cut of consecutive radial mill moves, calculated at the middles of the columns.

        If ``covers_whole_columns`` is True, the cut covers every column that it touches.
        """
        field = self.field
        columns = field.find_columns_between(
            min(s.back_z_mm for s in run) - radius, max(s.front_z_mm for s in run) + radius
        )
        turned = [find_nearest_angles(field.ray_angles - s.angle_rad, s.rotation_rad) for s in run]
        widest = _half_angle(min(s.end_radius_mm for s in run), radius + abs(height))
        rays = np.flatnonzero(np.min(np.abs(turned), axis=0) <= widest)
        if columns.stop <= columns.start or not len(rays):
            return
        back, front = field.column_edges[columns], field.column_edges[columns.start + 1 : columns.stop + 1]
        if not covers_whole_columns:
            back = front = 0.5 * (back + front)
        low, high = np.full((len(back), len(rays)), np.inf), np.full((len(back), len(rays)), -np.inf)
        for stroke, angles in zip(run, turned, strict=True):
            off = np.maximum(np.maximum(stroke.back_z_mm - front, back - stroke.front_z_mm), 0.0)
            half = np.sqrt(np.maximum(radius * radius - off * off, 0.0))
            near, far = find_radial_mill_intervals(angles[rays], half, stroke.end_radius_mm, length, height)
            # Strokes of a run overlap, so they cover one interval of each ray.
            np.minimum(low, near, out=low)
            np.maximum(high, far, out=high)
        yield RayCut(columns, rays, low, high)

    def _group_strokes(
        self, path: FloatArray, radius: float, height: float
    ) -> Iterator[list[RadialMillMove]]:
        """Yield consecutive mill moves in groups that extend over at most the radius of the mill."""
        outside = float(self.field.outer_radii.max(initial=radius))
        run: list[RadialMillMove] = []
        for stroke in self._strokes(path, radius, height, outside):
            if run and not _is_overlapped(run, stroke, radius, outside):
                yield run
                run = []
            run.append(stroke)
        if run:
            yield run

    def _strokes(
        self, path: FloatArray, radius: float, height: float, outside: float
    ) -> Iterator[RadialMillMove]:
        path = _path_lines(path) * np.array([1.0, 1.0, math.pi / 180.0])
        spacing = math.sqrt(8.0 * radius * _SCALLOP)
        reach = np.array([self.field.column_edges[0] - radius, self.field.column_edges[-1] + radius])
        for start, end in _parts_inside(path, outside, reach):
            dr, dz, dc = (end - start).tolist()
            exact_turn = height == 0.0 and min(start[0], end[0]) >= 0.0
            if dc and (dz or not exact_turn):
                count = max(math.hypot(dz, outside * dc) / spacing, abs(dr) / _RAMP)
                yield from _spots(start, end, count)
            elif dr and (dz or dc):
                yield from _iter_ramp_steps(start, end, abs(dr) / _RAMP)
            else:
                back, front = sorted((float(start[1]), float(end[1])))
                yield RadialMillMove(float(min(start[0], end[0])), back, front, float(start[2]), dc)

    def _divide_at_ends(self, runs: list[list[RadialMillMove]], radius: float) -> None:
        """Divide the columns at both ends of a radial path, where the mill's round edge crosses them."""
        back, front = (
            min(s.back_z_mm for run in runs for s in run),
            max(s.front_z_mm for run in runs for s in run),
        )
        round_ = radius * np.sin(np.linspace(0.0, 0.5 * math.pi, 25))
        self.field.divide_columns(np.concatenate((back - round_, front + round_)))

    # --- common methods

    def _take(self, reaches: Iterator[RayCut], met: RemovedMaterial) -> RemovedMaterial:
        for reach in reaches:
            met = met.combine_with(self.field.find_removed_material(*reach))
        return met

    def _met(self, reaches: Iterator[RayCut]) -> bool:
        return any(self.field.find_removed_material(*reach, remove=False) for reach in reaches)


class _DiscSweep:
    """The area that a moving disc (the end of a mill) covers along the lines of a path.

    The area can be limited to fractions of the lines. The area of whole lines is cached.
    """

    def __init__(self, path: FloatArray, radius: float, angles: FloatArray) -> None:
        self._start, self._way = path[:-1, :2], np.diff(path[:, :2], axis=0)
        self._radius, self._angles = radius, angles
        self._whole, self._covered = np.zeros(len(self._start), dtype=np.bool_), self._layers([], 0.0, 0.0)

    def find_covered_area(self, begin: FloatArray, stop: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the area covered between two fractions of each line (m,), as r intervals (k, rays)."""
        whole = (begin == 0.0) & (stop == 1.0)
        if np.any(whole != self._whole):
            self._whole, self._covered = whole, self._layers(np.flatnonzero(whole), 0.0, 1.0)
        some = np.flatnonzero((begin <= stop) & ~whole)
        if not len(some):
            return self._covered
        low, high = self._layers(some, begin[some, None], stop[some, None])
        return unite_intervals(
            np.concatenate((self._covered[0], low)), np.concatenate((self._covered[1], high))
        )

    def _layers(
        self, lines: IntArray | list[int], begin: FloatArray | float, stop: FloatArray | float
    ) -> tuple[FloatArray, FloatArray]:
        if not len(lines):
            return np.zeros((1, len(self._angles))), np.zeros((1, len(self._angles)))
        start, delta_mm = self._start[lines], self._way[lines]
        return unite_intervals(
            *find_capsule_intervals(
                start + begin * delta_mm, start + stop * delta_mm, self._radius, self._angles
            )
        )


def _level_fractions(path: FloatArray, levels: FloatArray, length: float) -> tuple[FloatArray, FloatArray]:
    """Return the fractions (levels, lines) of each path line between which the mill is at each Z level.

    If the mill does not reach a level, the first fraction is greater than the second.
    """
    deltas_mm = np.diff(path, axis=0)
    depth = levels[:, None] - path[:-1, 2]
    begin, stop = clip_interval(np.broadcast_to(deltas_mm[:, 2], depth.shape), depth - length, depth)
    stop = np.minimum(stop, 1.0)
    plunges = (begin <= stop) & np.all(deltas_mm[:, :2] == 0.0, axis=1)
    return np.where(plunges, 0.0, begin), np.where(plunges, 1.0, stop)


def _path_lines(path: FloatArray) -> FloatArray:
    """Return the path with a single point repeated, so that it has at least one line.

    Raises PartError if the path is empty or does not have three columns.
    """
    if path.ndim != 2 or path.shape[1] != 3 or not len(path):
        raise PartError("A mill's path has three figures a point.", "points-not-xyz")
    return path if len(path) > 1 else np.repeat(path, 2, axis=0)


def _floor_levels(path: FloatArray, length: float) -> FloatArray:
    """Return the Z values of the floors that the end of the mill cuts, and of the ends of its flutes.

    The lowest floor is always included.
    """
    z = path[:, 2]
    flat = np.unique(z[:-1][np.diff(z) == 0.0])
    floors = np.append(flat, z.min()) if len(flat) <= _LEVELS else np.array([z.min()])
    return floors if math.isinf(length) else np.append(floors, floors + length)


def _iter_cone_steps(radius: float, point: float) -> Iterator[tuple[float, float]]:
    """Yield the flat-ended mills that together approximate a mill with a cone of height ``point``.

    Each flat-ended mill is given by the offset of its end and by its radius.
    """
    count = min(max(math.ceil(point / 0.05), 8), 24) if point else 0
    for k in range(count):
        yield point * k / count, radius * (k + 0.5) / count
    yield point, radius


def _parts_inside(
    path: FloatArray, outside: float, reach: FloatArray
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Yield the parts of a radial mill path with r less than ``outside`` and Z within ``reach``."""
    deltas_mm = np.diff(path, axis=0)
    first, last = np.zeros(len(deltas_mm)), np.ones(len(deltas_mm))
    for axis, least, most in ((0, -math.inf, outside), (1, *reach.tolist())):
        low, high = clip_interval(deltas_mm[:, axis], least - path[:-1, axis], most - path[:-1, axis])
        first, last = np.maximum(first, low), np.minimum(last, high)
    for line in np.flatnonzero(first <= last).tolist():
        start = path[line]
        yield start + first[line] * deltas_mm[line], start + last[line] * deltas_mm[line]


def _lifted(run: list[RadialMillMove], rise: float) -> list[RadialMillMove]:
    return [stroke._replace(end_radius_mm=stroke.end_radius_mm + rise) for stroke in run] if rise else run


def _is_overlapped(run: list[RadialMillMove], stroke: RadialMillMove, radius: float, outside: float) -> bool:
    """Return whether a mill move and the first of its group together span at most the mill's radius."""
    first = run[0]
    along = max(stroke.front_z_mm, first.front_z_mm) - min(stroke.back_z_mm, first.back_z_mm)
    turned = outside * (
        abs(stroke.angle_rad - first.angle_rad) + max(abs(stroke.rotation_rad), abs(first.rotation_rad))
    )
    return max(along, turned, abs(stroke.end_radius_mm - first.end_radius_mm)) <= radius


def _spots(start: FloatArray, end: FloatArray, count: float) -> Iterator[RadialMillMove]:
    for r, z, angle in np.linspace(start, end, min(math.ceil(count), _MAX_STEPS) + 1).tolist():
        yield RadialMillMove(r, z, z, angle)


def _iter_ramp_steps(start: FloatArray, end: FloatArray, count: float) -> Iterator[RadialMillMove]:
    """Yield steps of a move whose depth changes, each at its mean depth."""
    points = np.linspace(start, end, min(math.ceil(count), _MAX_STEPS) + 1)
    for (r0, z0, c0), (r1, z1, c1) in zip(points[:-1].tolist(), points[1:].tolist(), strict=True):
        yield RadialMillMove(0.5 * (r0 + r1), min(z0, z1), max(z0, z1), c0, c1 - c0)


def _half_angle(end: float, half: float) -> float:
    """Return the angle in radians from the tool's axis within which all rays of the tool are."""
    return math.atan2(half, end) + 1e-9 if end > 0.0 else math.pi
