"""Shapes of the view in space, in the machine's millimetres: the blank, the table under it, outlines."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from app.desk.swivel.camera import Camera, FloatArray
from app.desk.swivel.scene import Scene

if TYPE_CHECKING:
    from core.geometry.mill_kinematics import Kinematics, Place

_ROUND = 48  # corners of what is round


def outline(camera: Camera, points: FloatArray) -> FloatArray:
    """The convex outline of points (n, 3) as the camera sees them (monotone chain of Andrew)."""
    flat = points @ camera.axes[:2].T
    order = np.lexsort((flat[:, 1], flat[:, 0])).tolist()
    half: list[list[int]] = []
    for run in (order, order[::-1]):
        hull: list[int] = []
        for each in run:
            while len(hull) > 1 and _turns_back(flat, hull[-2], hull[-1], each):
                hull.pop()
            hull.append(each)
        half.append(hull[:-1])
    return np.asarray(points[half[0] + half[1]])


def _turns_back(flat: FloatArray, a: int, b: int, c: int) -> bool:
    u, v = flat[b] - flat[a], flat[c] - flat[a]
    return float(u[0] * v[1] - u[1] * v[0]) <= 0.0


def carried(place: Place, points: FloatArray) -> FloatArray:
    """Machine positions (n, 3) of points (n, 3) of the system that the place is of, mm."""
    return np.asarray(points @ np.array(place.turn).T + np.array(place.shift))


def corners_of(scene: Scene) -> FloatArray:
    """The blank's eight corners (8, 3) in the workpiece's system: x fastest, then y, then z."""
    (x0, y0, z0), (x1, y1, z1) = scene.corners
    return np.array([(x, y, z) for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)])


def middle_of(scene: Scene) -> tuple[float, float, float]:
    """The middle of the blank in the workpiece's system."""
    low, high = scene.corners
    x, y, z = (0.5 * (a + b) for a, b in zip(low, high, strict=True))
    return x, y, z


def diagonal_of(scene: Scene) -> float:
    """The blank's diagonal, mm: what sizes are measured by."""
    low, high = scene.corners
    return max(1.0, math.dist(low, high))


def table_rim(scene: Scene) -> FloatArray:
    """The rim of the table (n, 3) in the machine with all axes at 0: round the first table's line, under the
    blank and wide enough for it.
    """
    place = scene.kinematics.place({}, scene.kinematics.basic)
    corners = carried(place, corners_of(scene))
    centre = _foot(scene.kinematics, corners.mean(axis=0))
    radius = 1.12 * float(np.hypot(*(corners[:, :2] - centre[:2]).T).max())
    turn = np.linspace(0.0, 2.0 * math.pi, _ROUND, endpoint=False)
    low = np.full(_ROUND, corners[:, 2].min())
    return np.column_stack((centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn), low))


def _foot(kinematics: Kinematics, middle: FloatArray) -> FloatArray:
    """The point of a table's line along Z; the middle of the blank where no table turns so."""
    for axis in kinematics.rotaries:
        if axis.table and abs(axis.direction[2]) > 0.5:
            return np.array(axis.point)
    return middle


def spot(row: FloatArray) -> tuple[float, float, float]:
    """One row as a point."""
    x, y, z = row.tolist()
    return x, y, z
