"""Measuring in the path view: snap points, nearest points and distances.

Each function scans the points only once, so that a key press is handled fast even with a million points.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from app.desk.status import formats
from app.desk.translation import tr
from app.path.polyline import SAME_POINT_MM, Bounds, FloatArray, Polyline, StrokeKind
from core.message import Message

# --- points -------------------------------------------------------------------------------------------


class SnapPointKind(IntEnum):
    """The kinds of snap point, in order of priority where several points coincide."""

    END = 0
    CENTER = 1
    INTERSECTION = 2
    FREE = 3  # anywhere


class SnapPoint(NamedTuple):
    """Point to which the measuring cursor snaps, in the plane of the view, in millimeters."""

    z: float
    x: float
    kind: SnapPointKind = SnapPointKind.FREE


def describe_snap_point_kind(kind: SnapPointKind) -> str:
    """Return the display text for the kind of point under the cursor."""
    return {
        SnapPointKind.END: tr("END"),
        SnapPointKind.CENTER: tr("CENTER"),
        SnapPointKind.INTERSECTION: tr("INTERSECTION"),
        SnapPointKind.FREE: tr("FREE"),
    }[kind]


def make_measuring_prompt() -> str:
    """Return the prompt that is shown during measuring."""
    return tr("ARROWS, TAB: NEXT POINT   ENTER: MEASURE FROM IT   ESC: BACK")


MAX_CROSSING_CHORDS = 300  # number of visible chords above which intersections are not searched
MIN_POINT_DISTANCE = 1e-6  # mm; points that are nearer than this count as one point
# largest sideways offset of a point found with an arrow key, as a ratio of its distance along the direction
MAX_SLOPE = 1.2


class SnapPoints:
    """Snap points of one path.

    ``update_intersections`` finds the intersections in the visible area.
    """

    def __init__(self, polyline: Polyline) -> None:
        self._polyline = polyline
        self._ends = _find_end_points(polyline)
        self._box: Bounds | None = None
        self._crossings = np.zeros((0, 2))

    def update_intersections(self, bounds: Bounds) -> None:
        """Find the intersections in the visible area.

        The area is given as minimum z, maximum z, minimum x and maximum x.
        """
        if bounds != self._box:
            self._box, self._crossings = bounds, find_intersections(self._polyline, bounds)

    def find_nearest_point(self, z: float, x: float) -> SnapPoint | None:
        """Return the snap point nearest to a position, or None if the path has no snap points."""
        best: tuple[float, SnapPoint] | None = None
        for kind, table in self._tables():
            if len(table):
                off = (table[:, 0] - z) ** 2 + (table[:, 1] - x) ** 2
                at = int(np.argmin(off))
                if best is None or off[at] < best[0] - MIN_POINT_DISTANCE**2:
                    best = float(off[at]), SnapPoint(float(table[at, 0]), float(table[at, 1]), kind)
        return best[1] if best else None

    def find_point_in_direction(self, z: float, x: float, direction: tuple[int, int]) -> SnapPoint | None:
        """Return the next snap point in a direction, or None if no point is in that direction.

        The direction (1, 0) is Z+, and (0, 1) is X+. Points close to the line in this direction are
        preferred.
        """
        best: tuple[float, SnapPoint] | None = None
        for kind, table in self._tables():
            dz, dx = table[:, 0] - z, table[:, 1] - x
            along, aside = (
                dz * direction[0] + dx * direction[1],
                np.abs(dz * direction[1] + dx * direction[0]),
            )
            fits = np.flatnonzero((along > MIN_POINT_DISTANCE) & (aside <= MAX_SLOPE * along))
            if len(fits):
                cost = along[fits] + aside[fits]
                at = int(np.argmin(cost))
                if best is None or cost[at] < best[0] - MIN_POINT_DISTANCE:
                    there = fits[at]
                    best = float(cost[at]), SnapPoint(float(table[there, 0]), float(table[there, 1]), kind)
        return best[1] if best else None

    def find_next_path_point(self, z: float, x: float, steps: int) -> SnapPoint | None:
        """Return the end point that is ``steps`` end points further along the path.

        End points are the block ends and the points after jumps. After the last end point, the search
        continues with the first. Return None if the path has no points.
        """
        ends = self._ends
        if not len(ends):
            return None
        at = int(np.argmin((ends[:, 0] - z) ** 2 + (ends[:, 1] - x) ** 2))
        for _ in range(len(ends)):
            at = (at + steps) % len(ends)
            if abs(ends[at, 0] - z) > MIN_POINT_DISTANCE or abs(ends[at, 1] - x) > MIN_POINT_DISTANCE:
                break
        return SnapPoint(float(ends[at, 0]), float(ends[at, 1]), SnapPointKind.END)

    def _tables(self) -> tuple[tuple[SnapPointKind, FloatArray], ...]:
        return (
            (SnapPointKind.END, self._ends),
            (SnapPointKind.CENTER, self._polyline.arc_centers),
            (SnapPointKind.INTERSECTION, self._crossings),
        )


def _find_end_points(polyline: Polyline) -> FloatArray:
    """Return the block ends and the points after jumps, in path order, as an array of shape (n, 2)."""
    is_end_point = polyline.stroke == StrokeKind.JUMP
    is_end_point[polyline.first[1:][np.diff(polyline.first) > 0] - 1] = True
    index = np.flatnonzero(is_end_point)
    return np.column_stack((polyline.z[index], polyline.x[index]))


def find_intersections(polyline: Polyline, box: Bounds) -> FloatArray:
    """Return the points where lines of the path intersect within a box, as an array of shape (n, 2).

    The result is empty if more than ``MAX_CROSSING_CHORDS`` lines are in the box.
    """
    z0, x0, z1, x1 = polyline.z[:-1], polyline.x[:-1], polyline.z[1:], polyline.x[1:]
    seen = polyline.stroke[1:] != StrokeKind.JUMP
    seen &= (np.maximum(z0, z1) >= box[0]) & (np.minimum(z0, z1) <= box[1])
    seen &= (np.maximum(x0, x1) >= box[2]) & (np.minimum(x0, x1) <= box[3])
    index = np.flatnonzero(seen)
    if len(index) > MAX_CROSSING_CHORDS:
        return np.zeros((0, 2))
    a, b = np.triu_indices(len(index), 2)
    a, b = index[a], index[b]
    ax, az, bx, bz = x1[a] - x0[a], z1[a] - z0[a], x1[b] - x0[b], z1[b] - z0[b]
    cross = az * bx - ax * bz
    dz, dx = z0[b] - z0[a], x0[b] - x0[a]
    safe = np.where(np.abs(cross) > 1e-12, cross, np.inf)
    s, t = (dz * bx - dx * bz) / safe, (dz * ax - dx * az) / safe
    met = (np.abs(cross) > 1e-12) & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    return np.column_stack((z0[a] + s * az, x0[a] + s * ax))[met]


def find_nearest_chord(polyline: Polyline, z: float, x: float, max_distance_mm: float) -> int | None:
    """Return the index of the nearest chord (line between two path points) to a position.

    The index is that of the chord's end point. Return None if no chord is within ``max_distance_mm``
    millimeters.
    """
    z0, x0, z1, x1 = polyline.z[:-1], polyline.x[:-1], polyline.z[1:], polyline.x[1:]
    near = polyline.stroke[1:] != StrokeKind.JUMP
    near &= (np.maximum(z0, z1) >= z - max_distance_mm) & (np.minimum(z0, z1) <= z + max_distance_mm)
    near &= (np.maximum(x0, x1) >= x - max_distance_mm) & (np.minimum(x0, x1) <= x + max_distance_mm)
    index = np.flatnonzero(near)
    if not len(index):
        return None
    z0, x0, dz, dx = z0[index], x0[index], (z1 - z0)[index], (x1 - x0)[index]
    size = np.maximum(dz * dz + dx * dx, 1e-18)
    share = np.clip(((z - z0) * dz + (x - x0) * dx) / size, 0.0, 1.0)
    off = np.hypot(z0 + share * dz - z, x0 + share * dx - x)
    at = int(np.argmin(off))
    return int(index[at]) + 1 if off[at] <= max_distance_mm else None


# --- between two points -------------------------------------------------------------------------------


MeasurementRow = tuple[str, str]


def make_path_distance_rows(start: SnapPoint, end: SnapPoint, is_metric: bool) -> list[MeasurementRow]:
    """Return the table rows for the distance between two points on the path seen from above.

    The rows are X as a diameter and as a radius, Z, the distance, and the angle to the axis (0 to 90
    degrees).
    """
    dz, dx = end.z - start.z, end.x - start.x
    return [
        ("ΔX Ø", formats.format_length(2 * dx, is_metric)),
        ("ΔX R", formats.format_length(dx, is_metric)),
        ("ΔZ", formats.format_length(dz, is_metric)),
        *_straight(dz, dx, is_metric, tr("TO Z")),
    ]


def make_face_distance_rows(start: SnapPoint, end: SnapPoint, is_metric: bool) -> list[MeasurementRow]:
    """Return the table rows for the distance between two points on the face of the part.

    The rows are X and Y of the face, with Y up.
    """
    dx, dy = end.z - start.z, start.x - end.x
    return [
        ("ΔX", formats.format_length(dx, is_metric)),
        ("ΔY", formats.format_length(dy, is_metric)),
        *_straight(dx, dy, is_metric, tr("TO X")),
    ]


def make_side_distance_rows(
    start: SnapPoint, end: SnapPoint, is_metric: bool, mm_per_degree: float
) -> list[MeasurementRow]:
    """Return the table rows for the distance between two points on the unrolled side of the part.

    ``mm_per_degree`` is the circumferential length per degree of C, in millimeters.
    """
    dz, arc_length_mm = end.z - start.z, start.x - end.x
    return [
        ("ΔZ", formats.format_length(dz, is_metric)),
        ("ΔC", f"{formats.format_angle(arc_length_mm / mm_per_degree)}°"),
        (tr("ARC LENGTH"), formats.format_length(arc_length_mm, is_metric)),
        *_straight(dz, arc_length_mm, is_metric, tr("TO Z")),
    ]


def make_path_position_rows(point: SnapPoint, is_metric: bool) -> list[MeasurementRow]:
    """Return the table rows for the position of a point, with X as a diameter and Z."""
    return [
        ("X Ø", formats.format_length(2 * point.x, is_metric)),
        ("Z", formats.format_length(point.z, is_metric)),
    ]


def make_face_position_rows(point: SnapPoint, is_metric: bool) -> list[MeasurementRow]:
    """Return the table rows for the position of a point on the face.

    The rows are X, Y and the distance from the axis.
    """
    radius = math.hypot(point.z, point.x)
    return [
        ("X", formats.format_length(point.z, is_metric)),
        ("Y", formats.format_length(-point.x, is_metric)),
        ("R", formats.format_length(radius, is_metric)),
    ]


def make_side_position_rows(point: SnapPoint, is_metric: bool, mm_per_degree: float) -> list[MeasurementRow]:
    """Return the table rows for Z and C (degrees) of a point on the unrolled side of the part."""
    return [
        ("Z", formats.format_length(point.z, is_metric)),
        ("C", f"{formats.format_angle(-point.x / mm_per_degree)}°"),
    ]


def _straight(right: float, across: float, metric: bool, to: str) -> list[MeasurementRow]:
    angle = math.degrees(math.atan2(abs(across), abs(right)))
    return [
        (tr("DISTANCE"), formats.format_length(math.hypot(right, across), metric)),
        (tr(Message("ANGLE {axis}", axis=to)), f"{formats.format_angle(angle)}°"),
    ]


# --- comparison of two pictures -----------------------------------------------------------------------


class LargestDistance(NamedTuple):
    """Largest distance in mm between corresponding points of the cuts in two paths, and its position."""

    distance_mm: float
    z: float
    x: float


def find_largest_distance(before: Polyline, after: Polyline) -> LargestDistance | None:
    """Return the largest distance between corresponding points of the cuts in two paths.

    Return None if the two paths have different sequences of strokes, or if they contain no cuts.
    """
    if len(before.z) != len(after.z) or not np.array_equal(before.stroke, after.stroke):
        return None
    cut = np.flatnonzero(after.stroke >= StrokeKind.TURN)
    if not len(cut):
        return None
    distances_mm = np.hypot(after.z[cut] - before.z[cut], after.x[cut] - before.x[cut])
    at = int(np.argmax(distances_mm))
    distance = float(distances_mm[at]) if distances_mm[at] > SAME_POINT_MM else 0.0
    return LargestDistance(distance, float(after.z[cut[at]]), float(after.x[cut[at]]))
