"""Distances between points, rows of the cut record and paths, and the removal of detours from a path."""

from __future__ import annotations

from math import hypot, isnan

from core.interpreter.restart.cut_record import SAME_POINT_MM, CutRecord
from core.interpreter.restart.tool_retract import RetractLeg

PATH_TOLERANCE_MM = 0.1  # mm; a tool within this distance of a path is on the path


def compute_distance_from_row(cut_record: CutRecord, row: int, x: float, z: float) -> float:
    """Return the distance in mm of a point from the move that a row of the cut record describes."""
    x0, z0, x1, z1 = cut_record.get_end_points(row)
    if isnan(x0) or isnan(z0):
        return hypot(x - x1, z - z1)
    return compute_distance_from_segment(x0, z0, x1, z1, x, z)


def find_nearest_point(cut_record: CutRecord, row: int, x: float, z: float) -> tuple[float, float] | None:
    """Return the point on the move of a cut record row that is nearest to (x, z), in mm.

    Returns None if the start of the move is unknown.
    """
    x0, z0, x1, z1 = cut_record.get_end_points(row)
    length = hypot(x1 - x0, z1 - z0)
    return None if isnan(length) or not length else _foot(x0, z0, x1, z1, x, z)


def compute_distance_from_segment(x0: float, z0: float, x1: float, z1: float, x: float, z: float) -> float:
    """Return the distance of a point from the segment from (x0, z0) to (x1, z1), in mm."""
    foot_x, foot_z = _foot(x0, z0, x1, z1, x, z)
    return hypot(foot_x - x, foot_z - z)


def _foot(x0: float, z0: float, x1: float, z1: float, x: float, z: float) -> tuple[float, float]:
    """Return the point of a segment that is nearest to (x, z)."""
    dx, dz = x1 - x0, z1 - z0
    size = dx * dx + dz * dz
    share = max(0.0, min(1.0, ((x - x0) * dx + (z - z0) * dz) / size)) if size > 0.0 else 0.0
    return x0 + share * dx, z0 + share * dz


def remove_detours(points: list[RetractLeg]) -> list[RetractLeg]:
    """Return the path without detours. A detour leaves the path and later returns to it."""
    kept, at = [points[0]], 0
    while at < len(points) - 1:
        start, end = points[at], points[at + 1]
        reached = at + 1
        for k in range(len(points) - 1, at + 1, -1):
            ends_here = compute_distance_from_segment(*start, *end, *points[k]) <= SAME_POINT_MM
            passes = compute_distance_from_segment(*points[k - 1], *points[k], *start) <= SAME_POINT_MM
            if ends_here or passes:
                reached = k
                break
        kept.append(points[reached])
        at = reached
    return kept
