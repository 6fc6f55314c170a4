"""Convex polygons of tools: rounded corners, insert shapes, mirror images, and convex pieces of outlines.

A polygon is a float array (k, 2) of (z, r) in mm, in counterclockwise order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from core.message import CodedError

FloatArray = NDArray[np.float64]
MAX_NOSE_CHORD_ERROR_MM = 0.0005  # mm of deviation between a nose and its chords
MAX_BODY_CHORD_ERROR_MM = 0.02  # mm of deviation for corners that do not cut
_RIGHT_ANGLE = math.pi / 2.0


class PartError(CodedError, ValueError):
    """Error raised if points, edges or outlines do not define a valid part, cut or tool."""


def make_polygon(points: Iterable[tuple[float, float]]) -> FloatArray:
    """Return the points as a polygon in counterclockwise order."""
    return orient_counterclockwise(np.array(tuple(points), dtype=np.float64))


def make_rectangle(z: tuple[float, float], r: tuple[float, float]) -> FloatArray:
    """Return the rectangle between two values of z and two values of r."""
    (left, right), (low, high) = sorted(z), sorted(r)
    return make_polygon([(left, low), (right, low), (right, high), (left, high)])


def calculate_signed_area(points: FloatArray) -> float:
    """Return the area of a polygon by the shoelace formula.

    The area of a clockwise polygon is negative.
    """
    z, r = points[:, 0], points[:, 1]
    return 0.5 * float(np.dot(z, np.roll(r, -1)) - np.dot(r, np.roll(z, -1)))


def orient_counterclockwise(points: FloatArray) -> FloatArray:
    """Return the polygon in counterclockwise order."""
    return points if calculate_signed_area(points) >= 0.0 else points[::-1].copy()


def make_arc_points(
    start_rad: float, sweep_rad: float, radius: float, max_chord_error: float = MAX_NOSE_CHORD_ERROR_MM
) -> FloatArray:
    """Return points (k, 2) on an arc about the origin, including its extremes in z and r.

    ``start_rad`` and ``sweep_rad`` are in radians. The error of a chord with the half angle t is radius·(1
    - cos t). Because the extremes are included, a diameter that is cut by an extreme of the nose is exact.
    """
    most = (
        2.0 * math.acos(max(0.0, 1.0 - max_chord_error / radius))
        if radius > max_chord_error
        else _RIGHT_ANGLE
    )
    first = math.floor(start_rad / _RIGHT_ANGLE + 1e-9) + 1
    quarters = [
        k * _RIGHT_ANGLE for k in range(first, first + 5) if k * _RIGHT_ANGLE < start_rad + sweep_rad - 1e-9
    ]
    angles = [start_rad]
    for left, right in pairwise([start_rad, *quarters, start_rad + sweep_rad]):
        count = max(1, math.ceil((right - left) / most))
        angles += [left + (right - left) * step / count for step in range(1, count + 1)]
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def make_circle(radius: float) -> FloatArray:
    """Return a circle about the origin as a polygon."""
    return make_arc_points(0.0, 2.0 * math.pi, radius)[:-1]


def make_polygon_from_edges(
    corner_angles: Sequence[float], edge_lengths: Sequence[float], heading_deg: float
) -> FloatArray:
    """Return the polygon with the given interior angles and edge lengths, starting at the origin.

    ``corner_angles`` are in degrees. ``heading_deg`` is the direction of the first edge in degrees,
    measured from +z toward +r.
    """
    points, at, angle = [], np.zeros(2), math.radians(heading_deg)
    for corner, edge in zip((*corner_angles[1:], corner_angles[0]), edge_lengths, strict=True):
        points.append(at)
        at = at + edge * np.array([math.cos(angle), math.sin(angle)])
        angle += math.pi - math.radians(corner)
    return np.array(points)


def find_nose_center(points: FloatArray, radius: float, corner_index: int = 0) -> FloatArray:
    """Return the center of a circle of the given radius that is tangent to both edges of a corner."""
    before, corner, after = (
        points[corner_index - 1],
        points[corner_index],
        points[(corner_index + 1) % len(points)],
    )
    one, other = _unit(before - corner), _unit(after - corner)
    half = math.acos(float(np.clip(np.dot(one, other), -1.0, 1.0))) / 2.0
    return np.asarray(corner + _unit(one + other) * radius / math.sin(half))


def round_corners(
    points: FloatArray, radii: Sequence[float], max_chord_errors: Sequence[float]
) -> FloatArray:
    """Return the convex polygon with rounded corners.

    ``radii`` and ``max_chord_errors`` contain one value for each corner.
    """
    parts = []
    for at, (radius, chord) in enumerate(zip(radii, max_chord_errors, strict=True)):
        if radius <= 0.0:
            parts.append(points[at : at + 1])
            continue
        into, out = points[at] - points[at - 1], points[(at + 1) % len(points)] - points[at]
        start = math.atan2(into[1], into[0]) - _RIGHT_ANGLE
        turn = math.atan2(into[0] * out[1] - into[1] * out[0], float(np.dot(into, out)))
        parts.append(find_nose_center(points, radius, at) + make_arc_points(start, turn, radius, chord))
    return np.concatenate(parts)


def find_max_corner_radius(points: FloatArray) -> float:
    """Return the largest radius to which all corners can be rounded at the same time."""
    fits = []
    for at in range(len(points)):
        one, other = points[at - 1] - points[at], points[(at + 1) % len(points)] - points[at]
        half = math.acos(float(np.clip(np.dot(_unit(one), _unit(other)), -1.0, 1.0))) / 2.0
        fits.append(math.tan(half) * min(float(np.hypot(*one)), float(np.hypot(*other))) / 2.0)
    return min(fits)


def find_convex_hull(points: FloatArray) -> FloatArray:
    """Return the convex hull of the points in counterclockwise order (Andrew's monotone chain)."""
    ordered = [tuple(point) for point in points[np.lexsort((points[:, 1], points[:, 0]))]]
    return np.array(_chain(ordered)[:-1] + _chain(ordered[::-1])[:-1], dtype=np.float64)


def _chain(ordered: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    chain: list[tuple[float, ...]] = []
    for point in ordered:
        while len(chain) > 1 and _turn_value(chain[-2], chain[-1], point) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain


def split_into_convex_pieces(points: Sequence[tuple[float, float]]) -> tuple[FloatArray, ...]:
    """Return a simple polygon as convex pieces.

    The pieces are the polygon itself if it is convex, or triangles by ear clipping. Raises PartError if the
    outline crosses itself, or if it touches itself so that it cannot be divided. Other outlines that touch
    themselves are divided without an error.
    """
    left = [(float(z), float(r)) for z, r in orient_counterclockwise(np.array(points, dtype=np.float64))]
    if _has_crossing_edges(left):
        raise PartError("the outline crosses itself", "crosses-itself")
    if _convex(left):
        return (np.array(left),) if calculate_signed_area(np.array(left)) > 0.0 else ()
    pieces = []
    while len(left) > 3:
        ear = next((at for at in range(len(left)) if _is_ear(left, at)), None)
        if ear is None:
            raise PartError("the outline touches itself", "touches-itself")
        pieces.append(np.array([left[ear - 1], left[ear], left[(ear + 1) % len(left)]]))
        del left[ear]
    return tuple(piece for piece in (*pieces, np.array(left)) if calculate_signed_area(piece) > 0.0)


def _convex(points: list[tuple[float, float]]) -> bool:
    around = [*points, *points[:2]]
    return all(_turn_value(*around[at : at + 3]) >= 0.0 for at in range(len(points)))


def _has_crossing_edges(points: list[tuple[float, float]]) -> bool:
    """Return whether two edges that are not adjacent cross each other."""
    edges = list(pairwise([*points, points[0]]))
    return any(
        _turn_value(*edges[one], edges[other][0]) * _turn_value(*edges[one], edges[other][1]) < 0.0
        and _turn_value(*edges[other], edges[one][0]) * _turn_value(*edges[other], edges[one][1]) < 0.0
        for other in range(len(edges))
        for one in range(other - 1)
    )


def _is_ear(points: list[tuple[float, float]], at: int) -> bool:
    before, corner, after = points[at - 1], points[at], points[(at + 1) % len(points)]
    if _turn_value(before, corner, after) < 0.0:
        return False
    others = (point for point in points if point not in (before, corner, after))
    return not any(
        _turn_value(before, corner, point) >= 0.0
        and _turn_value(corner, after, point) >= 0.0
        and _turn_value(after, before, point) >= 0.0
        for point in others
    )


def _turn_value(first: Sequence[float], second: Sequence[float], third: Sequence[float]) -> float:
    """Return a value that is positive if the path through three points turns left."""
    return (second[0] - first[0]) * (third[1] - first[1]) - (second[1] - first[1]) * (third[0] - first[0])


def _unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.hypot(*vector))
