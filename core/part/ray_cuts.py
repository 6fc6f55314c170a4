"""Paths of a mill on the part, and the intervals of r in which the mill covers the rays of a part.

The part's frame is fixed to the part. Its X and Y are those of XC entered with C at 0, and polar angles are
measured from X toward Y. The spindle rotates the part in the same direction. A tool on the negative X side
of the lathe is at the angle -C of the part.

A ray extends from the axis outward at a polar angle. A convex cross section of the swept volume covers one
interval of the ray, so a move is represented by a few intervals instead of a grid of points.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from core.geometry.virtual_mill import PlaneMove, SidePlane

FloatArray = npt.NDArray[np.float64]

_TINY = 1e-12
MAX_CHORD_ERROR_MM = 0.002
"""Maximum distance in mm between a chord and its curve."""
_AXIS_TOLERANCE_MM = 1e-6  # mm


def find_capsule_intervals(
    start: FloatArray, end: FloatArray, radius: float, angles: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the intervals of r in which moving discs cover rays from the part's axis.

    The discs move from ``start`` to ``end`` (m, 2). The rays are at ``angles`` (n,), and both results have
    the shape (m, n). If a ray is not covered, the first result is not less than the second. Units are mm
    and radians.
    """
    cos, sin = np.cos(angles), np.sin(angles)
    low0, high0 = _discs(start, radius, cos, sin)
    low1, high1 = _discs(end, radius, cos, sin)
    low2, high2 = _rectangle_intervals(start, end, radius, cos, sin)
    # The swept area is convex, so the three intervals of a ray overlap or touch.
    return np.minimum(np.minimum(low0, low1), low2), np.maximum(np.maximum(high0, high1), high2)


def _discs(
    centre: FloatArray, radius: float, cos: FloatArray, sin: FloatArray
) -> tuple[FloatArray, FloatArray]:
    x, y = centre[:, :1], centre[:, 1:]
    along = x * cos + y * sin
    across = x * sin - y * cos
    square = radius * radius - across * across
    half = np.sqrt(np.maximum(square, 0.0))
    return _cleaned(np.maximum(along - half, 0.0), along + half, square > 0.0)


def _rectangle_intervals(
    start: FloatArray, end: FloatArray, radius: float, cos: FloatArray, sin: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the intervals of r that are covered by the rectangle between the start and end discs."""
    displacement = end - start
    length = np.hypot(displacement[:, :1], displacement[:, 1:])
    unit = displacement / np.maximum(length, _TINY)
    ux, uy = unit[:, :1], unit[:, 1:]
    along, across = start[:, :1] * ux + start[:, 1:] * uy, start[:, 1:] * ux - start[:, :1] * uy
    low, high = clip_interval(ux * cos + uy * sin, along, along + length)
    low1, high1 = clip_interval(ux * sin - uy * cos, across - radius, across + radius)
    low, high = np.maximum(low, low1), np.minimum(high, high1)
    return _cleaned(low, high, (length > _TINY) & (high > low))


def clip_interval(
    factor: FloatArray, lower_bound: FloatArray | float, upper_bound: FloatArray | float
) -> tuple[FloatArray, FloatArray]:
    """Return the interval of r ≥ 0 in which ``factor`` · r is between two bounds.

    If the interval is empty, the first result is not less than the second.
    """
    upright = np.abs(factor) < _TINY
    safe = np.where(upright, 1.0, factor)
    one, other = lower_bound / safe, upper_bound / safe
    within = (np.less_equal(lower_bound, 0.0)) & (np.greater_equal(upper_bound, 0.0))
    low = np.where(upright, np.where(within, 0.0, np.inf), np.maximum(np.minimum(one, other), 0.0))
    high = np.where(upright, np.where(within, np.inf, 0.0), np.maximum(one, other))
    return low, high


def _cleaned(
    low: FloatArray, high: FloatArray, there: npt.NDArray[np.bool_]
) -> tuple[FloatArray, FloatArray]:
    there = there & (high > low)
    return np.where(there, low, np.inf), np.where(there, high, -np.inf)


def unite_intervals(starts: FloatArray, ends: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the union of intervals (m, n) along the first axis, as ascending intervals (k, n).

    The resulting intervals do not overlap, and k is as small as possible. An interval is empty if its end
    is not greater than its start. Empty intervals of the result are at infinity.
    """
    there = ends > starts
    starts, ends = np.where(there, starts, np.inf), np.where(there, ends, -np.inf)
    order = np.argsort(starts, axis=0)
    starts, ends = np.take_along_axis(starts, order, axis=0), np.take_along_axis(ends, order, axis=0)
    reach = np.maximum.accumulate(ends, axis=0)
    begins = starts < np.inf
    begins[1:] &= starts[1:] > reach[:-1]
    layer = np.cumsum(begins, axis=0) - 1
    count = max(int(layer[-1].max()) + 1, 1)
    first, last = np.full((count, starts.shape[1]), np.inf), np.full((count, starts.shape[1]), -np.inf)
    rows, columns = np.nonzero(begins)
    first[layer[rows, columns], columns] = starts[rows, columns]
    rows, columns = np.nonzero(starts < np.inf)
    np.maximum.at(last, (layer[rows, columns], columns), ends[rows, columns])
    return first, last


def find_radial_mill_intervals(
    ray_angles_rad: FloatArray, half_widths: FloatArray, end_radius: float, length: float, axis_offset: float
) -> tuple[FloatArray, FloatArray]:
    """Return the intervals of r (columns, rays) that a mill on a radius of the part covers.

    ``ray_angles_rad`` (rays,) is the angle from the tool's axis to each ray in radians. ``half_widths``
    (columns,) is half the width of the mill at each column, or 0 where the mill does not reach. The mill
    extends from ``end_radius`` outward by ``length``. ``axis_offset`` is the offset of its axis from the
    part's axis. Lengths are in mm.
    """
    low, high = clip_interval(np.cos(ray_angles_rad), end_radius, end_radius + length)
    if axis_offset:
        low1, high1 = clip_interval(
            np.sin(ray_angles_rad), axis_offset - half_widths[:, None], axis_offset + half_widths[:, None]
        )
        low, high = np.maximum(low, low1), np.minimum(high, high1)
    else:
        low = np.broadcast_to(low, (len(half_widths), len(ray_angles_rad)))
        high = np.minimum(high, half_widths[:, None] / np.maximum(np.abs(np.sin(ray_angles_rad)), _TINY))
    return _cleaned(low, high, half_widths[:, None] > 0.0)


def find_nearest_angles(ray_angles_rad: FloatArray, rotation_rad: float) -> FloatArray:
    """Return the smallest signed angle between each ray and a rotating tool axis, in radians.

    The tool axis rotates by ``rotation_rad``. ``ray_angles_rad`` (rays,) is the angle from the start
    position of the tool axis to each ray.
    """
    middle = np.remainder(ray_angles_rad - 0.5 * rotation_rad + np.pi, 2.0 * np.pi) - np.pi
    left = np.maximum(np.abs(middle) - 0.5 * abs(rotation_rad), 0.0)
    return np.asarray(np.copysign(left, middle), dtype=np.float64)


def make_plane_path(
    move: PlaneMove, z_offset: float = 0.0, max_chord_error: float = MAX_CHORD_ERROR_MM
) -> FloatArray:
    """Return the path (n, 3) of a move in a working plane; ``z_offset`` (mm) is added to the program Z.

    On the face, the path contains x, y and z of the mill's end, as for ``MilledPart.mill_axial_path``. On the
    side, it contains r, z and the polar angle in degrees, as for ``MilledPart.mill_radial_path``.
    """
    shares = np.linspace(0.0, 1.0, _count_chords(move, max_chord_error) + 1)
    if isinstance(move.frame, SidePlane):
        return make_radial_path(
            move.compute_machine_positions(shares) + np.array([0.0, z_offset, 0.0]),
            is_far_side=move.frame.is_far_side,
        )
    points = move.compute_workpiece_points(move.compute_machine_positions(shares))
    turn = math.radians(move.frame.heading_deg)
    return _turned(points, np.full(len(points), turn), z_offset)


def make_axial_path(positions: FloatArray, height: float = 0.0, z_offset: float = 0.0) -> FloatArray:
    """Return the path x, y, z (n, 3) in the part's frame of a tool parallel to Z.

    ``positions`` (n, 3) are X (radius), Z and C of the lathe. ``height`` is the height of the tool above
    the axis. Units are mm and degrees.
    """
    spot = np.column_stack([-positions[:, 0], np.full(len(positions), height), positions[:, 1]])
    return _turned(spot, -np.radians(positions[:, 2]), z_offset)


def make_radial_path(positions: FloatArray, *, is_far_side: bool = False) -> FloatArray:
    """Return the path of a tool on a radius: r, z and the polar angle in degrees (n, 3).

    ``positions`` (n, 3) are X (radius), Z and C of the lathe. The tool is on the negative X side of the
    lathe, or on the positive side if ``is_far_side`` is True.
    """
    x, z, c = positions.T
    return np.column_stack([x, z, 180.0 - c]) if is_far_side else np.column_stack([-x, z, -c])


def make_c_axis_path(
    start: FloatArray, end: FloatArray, max_chord_error: float = MAX_CHORD_ERROR_MM
) -> FloatArray:
    """Return lathe positions X, Z, C (n, 3) along a straight move of a tool parallel to Z.

    The points are so close together that the chord error is at most ``max_chord_error`` mm.
    """
    turn = math.radians(abs(float(end[2] - start[2])))
    far = max(abs(float(start[0])), abs(float(end[0])), _AXIS_TOLERANCE_MM)
    count = max(math.ceil(turn / math.sqrt(8.0 * max_chord_error / far)), 1)
    return np.linspace(start, end, count + 1)


def _count_chords(move: PlaneMove, chord: float) -> int:
    """Return the number of straight pieces that represent a move."""
    if move.center is None:
        return 1 if move.is_straight or not _is_too_close_to_axis(move) else 360
    half = 2.0 * math.acos(max(1.0 - chord / max(move.radius, chord), -1.0))
    turns = max(move.length / max(move.radius, chord) / half, 1.0)
    return max(math.ceil(turns), 360 if _is_too_close_to_axis(move) else 1)


def _is_too_close_to_axis(move: PlaneMove) -> bool:
    """Return whether a face mill must pass closer to the axis than its height above the axis allows."""
    return (
        not isinstance(move.frame, SidePlane)
        and move.compute_distance_from_axis(move.get_fastest_rotation_fraction())
        < abs(move.frame.tool_height_mm) - _AXIS_TOLERANCE_MM
    )


def _turned(points: FloatArray, angles: FloatArray, lift: float) -> FloatArray:
    cos, sin = np.cos(angles), np.sin(angles)
    x, y, z = points.T
    return np.column_stack([x * cos - y * sin, x * sin + y * cos, z + lift])
