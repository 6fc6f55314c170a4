"""Measuring in the path view: snap points, the nearest point, and the distance between two points.

Each function scans the points only once, so a key press remains fast with a million points.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from app.desk.status import formats
from app.desk.translation import tr
from app.path.polyline import SAME, Bounds, Floats, Polyline, Stroke
from core.message import Message

# --- points -------------------------------------------------------------------------------------------


class PointKind(IntEnum):
    """Kind of a snap point, in order of priority where several points coincide."""

    END = 0
    CENTRE = 1
    CROSSING = 2
    FREE = 3  # anywhere


class Point(NamedTuple):
    """Point of a polyline in the plane of the view, in millimeters."""

    z: float
    x: float
    kind: PointKind = PointKind.FREE


def kind_words(kind: PointKind) -> str:
    """Return the display text for the kind of point under the cursor."""
    return {
        PointKind.END: tr("END"),
        PointKind.CENTRE: tr("CENTER"),
        PointKind.CROSSING: tr("INTERSECTION"),
        PointKind.FREE: tr("FREE"),
    }[kind]


def measuring_words() -> str:
    """Return the prompt that is shown during measuring."""
    return tr("ARROWS, TAB: NEXT POINT   ENTER: MEASURE FROM IT   ESC: BACK")


MOST_CROSSED = 300  # number of visible chords above which intersections are not searched
APART = 1e-6  # mm; points that are nearer than this count as one point
# largest sideways offset of a point found with an arrow key, as a ratio of its distance along the direction
WIDE = 1.2


class Features:
    """Snap points of one path. ``update`` refreshes the intersections for the visible area."""

    def __init__(self, polyline: Polyline) -> None:
        self._polyline = polyline
        self._ends = _ends(polyline)
        self._box: Bounds | None = None
        self._crossings = np.zeros((0, 2))

    def look(self, box: Bounds) -> None:
        """Find the intersections in the visible area (minimum z, maximum z, minimum x, maximum x)."""
        if box != self._box:
            self._box, self._crossings = box, crossings(self._polyline, box)

    def nearest(self, z: float, x: float) -> Point | None:
        """Return the snap point nearest to a position, or None if the path has no snap points."""
        best: tuple[float, Point] | None = None
        for kind, table in self._tables():
            if len(table):
                off = (table[:, 0] - z) ** 2 + (table[:, 1] - x) ** 2
                at = int(np.argmin(off))
                if best is None or off[at] < best[0] - APART**2:
                    best = float(off[at]), Point(float(table[at, 0]), float(table[at, 1]), kind)
        return best[1] if best else None

    def towards(self, z: float, x: float, way: tuple[int, int]) -> Point | None:
        """Return the next snap point in a direction: (1, 0) is Z+, (0, 1) is X+.

        Points that are close to the direction line are preferred. Returns None if no point is in that
        direction.
        """
        best: tuple[float, Point] | None = None
        for kind, table in self._tables():
            dz, dx = table[:, 0] - z, table[:, 1] - x
            along, aside = dz * way[0] + dx * way[1], np.abs(dz * way[1] + dx * way[0])
            fits = np.flatnonzero((along > APART) & (aside <= WIDE * along))
            if len(fits):
                cost = along[fits] + aside[fits]
                at = int(np.argmin(cost))
                if best is None or cost[at] < best[0] - APART:
                    there = fits[at]
                    best = float(cost[at]), Point(float(table[there, 0]), float(table[there, 1]), kind)
        return best[1] if best else None

    def following(self, z: float, x: float, steps: int) -> Point | None:
        """Return the end point that is ``steps`` points further along the path.

        After the last end point, the search continues with the first. Returns None if the path has no points.
        """
        ends = self._ends
        if not len(ends):
            return None
        at = int(np.argmin((ends[:, 0] - z) ** 2 + (ends[:, 1] - x) ** 2))
        for _ in range(len(ends)):
            at = (at + steps) % len(ends)
            if abs(ends[at, 0] - z) > APART or abs(ends[at, 1] - x) > APART:
                break
        return Point(float(ends[at, 0]), float(ends[at, 1]), PointKind.END)

    def _tables(self) -> tuple[tuple[PointKind, Floats], ...]:
        return (
            (PointKind.END, self._ends),
            (PointKind.CENTRE, self._polyline.centres),
            (PointKind.CROSSING, self._crossings),
        )


def _ends(polyline: Polyline) -> Floats:
    """Return the ends of blocks and the starts after jumps, in path order, shape (n, 2)."""
    told = polyline.stroke == Stroke.JUMP
    told[polyline.first[1:][np.diff(polyline.first) > 0] - 1] = True
    index = np.flatnonzero(told)
    return np.column_stack((polyline.z[index], polyline.x[index]))


def crossings(polyline: Polyline, box: Bounds) -> Floats:
    """Return the intersections of the chords within a box, shape (n, 2).

    The result is empty if more than ``MOST_CROSSED`` chords are in the box.
    """
    z0, x0, z1, x1 = polyline.z[:-1], polyline.x[:-1], polyline.z[1:], polyline.x[1:]
    seen = polyline.stroke[1:] != Stroke.JUMP
    seen &= (np.maximum(z0, z1) >= box[0]) & (np.minimum(z0, z1) <= box[1])
    seen &= (np.maximum(x0, x1) >= box[2]) & (np.minimum(x0, x1) <= box[3])
    index = np.flatnonzero(seen)
    if len(index) > MOST_CROSSED:
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


def point_at(polyline: Polyline, z: float, x: float, within: float) -> int | None:
    """Return the index of the end point of the chord nearest to a position.

    Returns None if no chord is within ``within`` millimeters.
    """
    z0, x0, z1, x1 = polyline.z[:-1], polyline.x[:-1], polyline.z[1:], polyline.x[1:]
    near = polyline.stroke[1:] != Stroke.JUMP
    near &= (np.maximum(z0, z1) >= z - within) & (np.minimum(z0, z1) <= z + within)
    near &= (np.maximum(x0, x1) >= x - within) & (np.minimum(x0, x1) <= x + within)
    index = np.flatnonzero(near)
    if not len(index):
        return None
    z0, x0, dz, dx = z0[index], x0[index], (z1 - z0)[index], (x1 - x0)[index]
    size = np.maximum(dz * dz + dx * dx, 1e-18)
    share = np.clip(((z - z0) * dz + (x - x0) * dx) / size, 0.0, 1.0)
    off = np.hypot(z0 + share * dz - z, x0 + share * dx - x)
    at = int(np.argmin(off))
    return int(index[at]) + 1 if off[at] <= within else None


# --- between two points -------------------------------------------------------------------------------


Row = tuple[str, str]


def between_on_path(start: Point, end: Point, metric: bool) -> list[Row]:
    """Return the rows for two points on the path seen from above.

    The rows are X as a diameter and as a radius, Z, the distance and the angle to the axis (0 to 90 degrees).
    """
    dz, dx = end.z - start.z, end.x - start.x
    return [
        ("ΔX Ø", formats.length(2 * dx, metric)),
        ("ΔX R", formats.length(dx, metric)),
        ("ΔZ", formats.length(dz, metric)),
        *_straight(dz, dx, metric, tr("TO Z")),
    ]


def between_on_face(start: Point, end: Point, metric: bool) -> list[Row]:
    """Return the rows for two points on the face of the part, in face X and Y, with Y up."""
    dx, dy = end.z - start.z, start.x - end.x
    return [
        ("ΔX", formats.length(dx, metric)),
        ("ΔY", formats.length(dy, metric)),
        *_straight(dx, dy, metric, tr("TO X")),
    ]


def between_on_side(start: Point, end: Point, metric: bool, scale: float) -> list[Row]:
    """Return the rows for two points on the unrolled side.

    ``scale`` is the circumferential length per degree of C, in millimeters.
    """
    dz, way = end.z - start.z, start.x - end.x
    return [
        ("ΔZ", formats.length(dz, metric)),
        ("ΔC", f"{formats.angle(way / scale)}°"),
        (tr("ARC LENGTH"), formats.length(way, metric)),
        *_straight(dz, way, metric, tr("TO Z")),
    ]


def place_on_path(spot: Point, metric: bool) -> list[Row]:
    """Return the rows for the position of a point: X as a diameter, and Z."""
    return [("X Ø", formats.length(2 * spot.x, metric)), ("Z", formats.length(spot.z, metric))]


def place_on_face(spot: Point, metric: bool) -> list[Row]:
    """Return the rows for the position of a point on the face: X, Y and the distance from the axis."""
    radius = math.hypot(spot.z, spot.x)
    return [
        ("X", formats.length(spot.z, metric)),
        ("Y", formats.length(-spot.x, metric)),
        ("R", formats.length(radius, metric)),
    ]


def place_on_side(spot: Point, metric: bool, scale: float) -> list[Row]:
    """Return the rows for the position of a point on the unrolled side: Z, and C in degrees."""
    return [("Z", formats.length(spot.z, metric)), ("C", f"{formats.angle(-spot.x / scale)}°")]


def _straight(right: float, across: float, metric: bool, to: str) -> list[Row]:
    angle = math.degrees(math.atan2(abs(across), abs(right)))
    return [
        (tr("DISTANCE"), formats.length(math.hypot(right, across), metric)),
        (tr(Message("ANGLE {axis}", axis=to)), f"{formats.angle(angle)}°"),
    ]


# --- comparison of two pictures -----------------------------------------------------------------------


class Apart(NamedTuple):
    """Largest distance between corresponding cutting points of two pictures, with its position, in mm."""

    distance: float
    z: float
    x: float


def farthest(before: Polyline, after: Polyline) -> Apart | None:
    """Return the largest distance between corresponding cutting points of two pictures.

    Returns None if the pictures do not consist of the same strokes, or if nothing is cut.
    """
    if len(before.z) != len(after.z) or not np.array_equal(before.stroke, after.stroke):
        return None
    cut = np.flatnonzero(after.stroke >= Stroke.TURN)
    if not len(cut):
        return None
    way = np.hypot(after.z[cut] - before.z[cut], after.x[cut] - before.x[cut])
    at = int(np.argmax(way))
    distance = float(way[at]) if way[at] > SAME else 0.0
    return Apart(distance, float(after.z[cut[at]]), float(after.x[cut[at]]))
