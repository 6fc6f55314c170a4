"""Programmed speeds, and speed and acceleration limits of path elements, corners and chord chains.

A path element is called a piece, and the junction of two pieces is called a joint. Program words are
rounded to the resolution. With chords of 0.01 mm, this rounding changes the direction at each joint far
more than the curve does. An axis follows only the sum of the direction changes between two setpoints. Its
demand is the second difference of the setpoints, |P(s+r) - 2·P(s) + P(s-r)| / interval², where r is the
distance traveled in one interval. This module compares the demand with the acceleration limit of the axis.

The formulas are explained in docs/decisions/0014-time-law.md. No value here depends on an override, so a
plan that starts in motion has the same limits as the plan that it replaces.
"""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from typing import NamedTuple

import numpy as np

from core.message import Message
from core.motion.axis_limits import (
    CENTRIPETAL_SHARE,
    OVERRIDE_MAX,
    BoolArray,
    FloatArray,
    IntArray,
    MotionError,
    MotionLimits,
)
from core.motion.block_table import BlockTable
from core.motion.path_pieces import PathPieces

# --- chords over an interval ----------------------------------------------------------------------------


_HALVINGS = 6  # number of lower speeds at which the same joint is checked too
_MIN_DEMAND_FRACTION = 0.2  # fraction of amax; joints of chords that need less remain unchanged
MAX_RPM_RATIO = 1.02  # largest factor of the spindle speed within a piece
ARC_SAMPLE_COUNT = 65  # points at which the radius of an arc is sampled for the split


class PathJointLimits(NamedTuple):
    """Speed limits and acceleration demands at k junctions (joints) of path elements.

    ``squared_speeds`` (k,) are in mm²/s², and ``required_accelerations`` (k, axes) is in mm/s².
    """

    joint_numbers: IntArray
    squared_speeds: FloatArray
    required_accelerations: FloatArray


def find_path_joint_limits(
    pieces: PathPieces,
    single_limits: PathJointLimits,
    max_speeds: FloatArray,
    limits: MotionLimits,
    *,
    has_more_pieces: bool,
) -> PathJointLimits:
    """Return the limits at the joints of ``single_limits``, considering the path around each joint.

    Joint i is the junction of pieces i and i+1, passed at ``max_speeds`` (k,) mm/s or slower.
    ``single_limits`` contains the limit of each joint considered separately; the returned limits are never
    lower. The path is assumed to continue straight at both ends. If ``has_more_pieces`` is True, joints
    within one interval of the end are considered separately and reserve the full acceleration. Later pieces
    can then only increase the limits.
    """
    if not len(single_limits.joint_numbers):
        return single_limits
    share = CENTRIPETAL_SHARE * limits.max_acceleration_array
    s = np.concatenate([[0.0], np.cumsum(pieces.length)])
    at = s[single_limits.joint_numbers + 1]
    mean = 0.5 * (pieces.length[single_limits.joint_numbers] + pieces.length[single_limits.joint_numbers + 1])
    speeds = max_speeds / 2.0 ** np.arange(_HALVINGS)[:, None]
    asked = np.zeros((_HALVINGS, len(at), len(share)))
    for i, speed in enumerate(speeds):
        asked[i] = _second_difference(pieces, s, at, speed * limits.interval) / limits.interval**2
    asked[speeds * limits.interval < mean] = 0.0  # one joint per interval is covered by its own limit
    ratio = (asked / share).max(axis=2)
    over = ratio > 1.0
    squared = np.where(over, (speeds / np.where(over, ratio, 1.0)) ** 2, np.inf).min(axis=0)
    if has_more_pieces:
        squared[at + max_speeds * limits.interval > s[-1]] = 0.0
    better = np.maximum(squared, single_limits.squared_speeds)
    taken = np.where((speeds**2 <= better)[:, :, None], asked, 0.0).max(axis=0, initial=0.0)
    taken[squared < max_speeds**2] = share
    kept = (squared <= single_limits.squared_speeds) & (squared > 0.0)
    taken[kept] = single_limits.required_accelerations[kept]
    return PathJointLimits(single_limits.joint_numbers, better, taken)


def _second_difference(pieces: PathPieces, s: FloatArray, at: FloatArray, reach: FloatArray) -> FloatArray:
    """Return the second difference |P(s+r) - 2·P(s) + P(s-r)| of each axis (k, axes)."""
    before, here, after = (_points(pieces, s, where) for where in (at - reach, at, at + reach))
    difference: FloatArray = np.abs(after - 2.0 * here + before)
    return difference


def _points(pieces: PathPieces, s: FloatArray, where: FloatArray) -> FloatArray:
    index = np.clip(np.searchsorted(s, where, side="right") - 1, 0, len(pieces) - 1)
    return pieces[index].point(where - s[index])


def find_piece_limits(
    pieces: PathPieces, limits: MotionLimits, *, has_more_pieces: bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the speed caps (n,), accelerations (n,) and joint limits (n+1,) of the path pieces.

    The joint limits are squared speeds, and are infinite at both ends of the path. ``has_more_pieces`` is
    True if more pieces will follow.
    """
    cap = find_speed_caps(pieces, limits)
    speeds = find_expected_speeds(pieces, cap)
    corner = np.full(len(pieces) + 1, np.inf)
    if not len(pieces):
        return cap, cap, corner
    turns, along = find_direction_changes(pieces), find_accelerations(pieces, speeds, limits)
    steps = limit_velocity_steps(turns, np.maximum(along[:-1], along[1:]), limits)
    single = np.minimum(steps, limit_curve_speeds(pieces, turns, limits))
    asked = _chord_demand(pieces, speeds, turns, single, limits, more=has_more_pieces)
    corner[1:-1] = single
    # A velocity step at one joint is at most amax·interval, because the drives' queue accepts no more.
    corner[1:-1][asked.joint_numbers] = np.minimum(asked.squared_speeds, steps[asked.joint_numbers])
    spare = find_spare_acceleration(
        pieces, speeds, turns, single, limits, asked, has_more_pieces=has_more_pieces
    )
    return cap, np.minimum(along, spare), corner


def find_speed_caps(pieces: PathPieces, limits: MotionLimits) -> FloatArray:
    """Return the highest permitted speed (n,) of each path piece in mm/s.

    The speed is limited by the axis limits and by the centripetal acceleration.
    """
    caps = find_min_ratio(limits.speeds, np.abs(pieces.direction))
    arc = pieces.curvatures != 0.0
    centripetal = np.sqrt(CENTRIPETAL_SHARE * limits.max_plane_acceleration * pieces.radius[arc])
    caps[arc] = np.minimum(caps[arc], np.minimum(limits.max_plane_speed, centripetal))
    return caps


def find_expected_speeds(pieces: PathPieces, caps: FloatArray) -> FloatArray:
    """Return the speeds (n,) of the path pieces at the maximum override, within ``caps``, in mm/s.

    Arcs are planned for these speeds.
    """
    return np.minimum(caps, OVERRIDE_MAX * pieces.rate)


def find_accelerations(pieces: PathPieces, speeds: FloatArray, limits: MotionLimits) -> FloatArray:
    """Return the permitted acceleration (n,) along each path piece in mm/s².

    On an arc, this is the tangential acceleration that remains after the centripetal acceleration at
    ``speeds``.
    """
    along = find_min_ratio(limits.max_acceleration_array, np.abs(pieces.direction))
    arc = pieces.curvatures != 0.0
    centripetal = speeds[arc] ** 2 * np.abs(pieces.curvatures[arc])
    along[arc] = np.minimum(along[arc], np.sqrt(limits.max_plane_acceleration**2 - centripetal**2))
    return along


def find_min_ratio(limits: FloatArray, demands: FloatArray) -> FloatArray:
    """Return the smallest ratio of ``limits`` to ``demands`` over the axes (n,).

    ``limits``, (axes,) or (n, axes), is greater than 0. The ratio of an axis is inf if its ``demands`` (n,
    axes) is 0.
    """
    with np.errstate(divide="ignore"):
        ratios = limits / demands
    return reduce(np.minimum, ratios.T)  # three long columns are compared faster than a million short rows


def find_direction_changes(pieces: PathPieces) -> FloatArray:
    """Return the absolute change of direction of each axis at the joints (n-1, axes).

    Values below 1e-9 become 0.
    """
    leaving = pieces.tangent(pieces.length)[:-1]
    entering = pieces.tangent(np.zeros(len(pieces)))[1:]
    turns: FloatArray = np.abs(entering - leaving)
    turns[turns < 1e-9] = 0.0
    return turns


def limit_velocity_steps(
    direction_changes: FloatArray, accelerations: FloatArray, limits: MotionLimits
) -> FloatArray:
    """Return the squared speeds (n-1,) in mm²/s² at which all velocity steps are within the limit.

    A corner changes the velocity by v·|Δu|. The motion may brake before the corner and accelerate after it
    at ``accelerations`` (n-1,) mm/s². The condition is therefore (v + a·interval/2)·|Δu| ≤ amax·interval. A
    full reversal requires a stop. At a setpoint half an interval from the corner, the acceleration may
    exceed amax by at most an eighth. Without a change of direction, the result is infinite.
    """
    sharp = find_min_ratio(limits.max_acceleration_array * limits.interval, direction_changes)
    caps: FloatArray = np.maximum(sharp - 0.5 * limits.interval * accelerations, 0.0) ** 2
    return caps


def limit_curve_speeds(pieces: PathPieces, direction_changes: FloatArray, limits: MotionLimits) -> FloatArray:
    """Return the squared speed limits (n-1,) in mm²/s² of joints that are close to other joints.

    Each joint is considered separately. ℓ is a length of the neighboring pieces:

    - Short chords: v²·|Δu|/ℓ ≤ share·amax, where ℓ is the mean length of the neighbors. For chords of a
      circle, this equals the centripetal limit of the circle, whatever the chord length.
    - A second corner within the interval: v²·|Δu|/ℓ ≤ amax, where ℓ is the length of the shorter
      neighbor. Two such corners together use the fraction (2 - ℓ/vT)·ℓ/vT of amax, which is never more
      than 1.
    """
    mean = 0.5 * (pieces.length[:-1] + pieces.length[1:])
    shorter = np.minimum(pieces.length[:-1], pieces.length[1:])
    share = limits.max_acceleration_array * np.minimum(CENTRIPETAL_SHARE * mean, shorter)[:, None]
    return find_min_ratio(share, direction_changes)


def _chord_demand(
    pieces: PathPieces,
    speeds: FloatArray,
    turns: FloatArray,
    single: FloatArray,
    limits: MotionLimits,
    *,
    more: bool,
) -> PathJointLimits:
    """Return the limits of short chords, calculated over one setpoint interval.

    These limits apply at joints where the limits of the single corners would force a low speed.
    """
    fastest = np.minimum(speeds[:-1], speeds[1:])
    mean = 0.5 * (pieces.length[:-1] + pieces.length[1:])
    alone = turns * (np.minimum(fastest**2, single) / mean)[:, None]
    much = (alone > _MIN_DEMAND_FRACTION * limits.max_acceleration_array).any(axis=1) | (single < fastest**2)
    joints = np.flatnonzero(much & (mean < fastest * limits.interval))
    given = PathJointLimits(joints, single[joints], alone[joints])
    return find_path_joint_limits(pieces, given, fastest[joints], limits, has_more_pieces=more)


def find_spare_acceleration(
    pieces: PathPieces,
    speeds: FloatArray,
    direction_changes: FloatArray,
    single_limits: FloatArray,
    limits: MotionLimits,
    joint_limits: PathJointLimits,
    *,
    has_more_pieces: bool,
) -> FloatArray:
    """Return the tangential acceleration (n,) that remains while short chords follow a curve.

    Chords that are passed within one setpoint interval act as a curve. The curve uses v²·|Δu|/ℓ of each
    axis, or the demand over the whole interval (``PathJointLimits``). The remainder is (amax - used)/|u|. The
    corner limits ensure that at least a fifth of amax remains. If ``has_more_pieces`` is True, the last
    chord gets exactly this fifth, so that a later corner cannot reduce it. For longer lines and for arcs,
    the result is infinite.
    """
    amax = limits.max_acceleration_array
    spare = np.full(len(pieces), np.inf)
    short = (pieces.length < speeds * limits.interval) & (pieces.curvatures == 0.0)
    if not short.any():
        return spare
    bend = direction_changes / (0.5 * (pieces.length[:-1] + pieces.length[1:]))[:, None]
    before = bend * np.minimum(speeds[1:] ** 2, single_limits)[:, None]
    after = bend * np.minimum(speeds[:-1] ** 2, single_limits)[:, None]
    before[joint_limits.joint_numbers] = after[joint_limits.joint_numbers] = (
        joint_limits.required_accelerations
    )
    taken = np.zeros(pieces.direction.shape)
    taken[1:] = before
    np.maximum(taken[:-1], after, out=taken[:-1])
    if has_more_pieces:
        taken[-1] = CENTRIPETAL_SHARE * amax
    left = amax - np.minimum(taken[short], CENTRIPETAL_SHARE * amax)
    spare[short] = find_min_ratio(left, np.abs(pieces.direction[short]))
    return spare


def find_block_speeds(table: BlockTable) -> FloatArray:
    """Return the speed (m,) of each block in mm/s.

    A block with constant surface speed has the speed at the middle of its radii. Raises MotionError for:

    - a feed that is not positive
    - a feed per revolution while the spindle is stopped
    - a surface speed at the spindle centerline without an upper limit of the spindle speed
    - a thread that does not advance along Z
    """
    _refuse(table, ~(table.feed > 0.0), "the feed must be greater than 0; program an F word", "no-feed")
    surface = depends_on_radius(table)
    middle = 0.5 * (table.start[:, 0] + table.end[:, 0]) - table.axis
    rpm = np.where(surface, find_surface_rpms(table, middle), table.rpm)
    _refuse(
        table,
        table.per_rev & ~(rpm > 0.0),
        "the feed is per revolution, but the spindle is stopped; start the spindle first",
        "spindle-stopped",
    )
    on_axis = (table.start[:, 0] - table.axis) * (table.end[:, 0] - table.axis) <= 0.0
    endless = surface & on_axis & np.isinf(table.max_rpm)
    _refuse(
        table,
        endless,
        "the spindle speed has no upper limit at the spindle centerline; program a "
        "speed limit, or set rpm_max",
        "no-speed-limit",
    )
    rate = np.where(table.per_rev, table.feed * rpm / 60.0, table.feed)
    return rate * _per_lead(table) if table.thread.any() else rate


def _per_lead(table: BlockTable) -> FloatArray:
    """Return the path length per mm of travel along Z (m,) for thread blocks, and 1 for other blocks.

    The lead of a screw thread is measured along the axis of the thread.
    """
    _refuse(
        table,
        table.thread & (table.start[:, 1] == table.end[:, 1]),
        "the thread does not advance along Z",
        "no-lead",
    )
    path_length_mm = np.hypot(table.end[:, 0] - table.start[:, 0], table.end[:, 1] - table.start[:, 1])
    along = np.where(table.thread, np.abs(table.end[:, 1] - table.start[:, 1]), 1.0)
    return np.where(table.thread, path_length_mm / along, 1.0)


def depends_on_radius(table: BlockTable) -> BoolArray:
    """Return a mask (m,) of the blocks whose speed depends on the radius."""
    return table.per_rev & np.isfinite(table.surface)


def find_surface_rpms(table: BlockTable, radius: FloatArray) -> FloatArray:
    """Return the spindle speeds in rpm that constant surface speed requires at the given radii.

    This is the array version of ``find_surface_rpm`` of ``core.geometry``. The result is NaN for a block
    without constant surface speed, and for a surface speed of 0 at the centerline.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        rpm = 60.0 * table.surface / (2.0 * np.pi * np.abs(radius))
    return np.clip(rpm, table.min_rpm, table.max_rpm)


def _refuse(table: BlockTable, wrong: BoolArray, why: str, code: str) -> None:
    if wrong.any():
        raise MotionError(
            Message("Block {number}: {why}.", number=f"{table.n[wrong.argmax()]:.0f}", why=why), code
        )


def split_piece_by_radius(pieces: PathPieces, table: BlockTable, index: int) -> PathPieces:
    """Return path piece ``index`` divided into parts within which the rpm changes by at most 2 %.

    Each part has the speed at its middle. On a line across the spindle axis, the time of a part is exact,
    because 1/v is linear in the radius. The piece is not divided where the rpm is at its limit. While the
    radius increases or decreases, there are at most ln(max/min rpm)/ln 1.02 parts.
    """
    piece, owner = pieces[index : index + 1], _table_row(table, index)
    length = float(piece.length[0])
    at = _find_radius_cuts(piece, owner, length)
    middle = _radii(piece, owner, 0.5 * (at[1:] + at[:-1]))
    rate = owner.feed * find_surface_rpms(owner, middle) / 60.0
    return split_piece(piece, at, rate)


def split_piece(piece: PathPieces, distances: FloatArray, speeds: FloatArray) -> PathPieces:
    """Return one piece divided at ``distances`` (k+1,), including both ends, with ``speeds`` (k,)."""
    parts = piece[np.zeros(len(distances) - 1, dtype=np.int64)]
    return replace(
        parts,
        start=parts.point(distances[:-1]),
        angle=parts.angle + parts.curvatures * distances[:-1],
        length=np.diff(distances),
        rate=speeds,
    )


def _table_row(table: BlockTable, index: int) -> BlockTable:
    """Return a table with only the block ``index``."""
    row = slice(index, index + 1)
    return BlockTable(*(getattr(table, name)[row] for name in table.__dataclass_fields__))


def _radii(piece: PathPieces, owner: BlockTable, at: FloatArray) -> FloatArray:
    many = piece[np.zeros(len(at), dtype=np.int64)]
    radii: FloatArray = np.abs(many.point(at)[:, 0] - owner.axis[0])
    return radii


def _find_radius_cuts(piece: PathPieces, owner: BlockTable, length: float) -> FloatArray:
    """Return the distances along the piece at which it is divided into steps of spindle speed.

    The spindle speed depends on the radius. The speeds at the divisions form a geometric series.
    """
    if piece.curvatures[0] == 0.0:
        x0, x1 = owner.start[0, 0] - owner.axis[0], owner.end[0, 0] - owner.axis[0]
        crossing = [length * x0 / (x0 - x1)] if x0 * x1 < 0.0 else []
        grid = np.array([0.0, *crossing, length])
    else:
        grid = np.linspace(0.0, length, ARC_SAMPLE_COUNT)
    radii = _radii(piece, owner, grid)
    pairs = zip(grid[:-1], grid[1:], radii[:-1], radii[1:], strict=True)
    cuts = np.unique(np.concatenate([_linear_radius_cuts(owner, *pair) for pair in pairs]))
    inside = cuts[(cuts > 1e-9 * length) & (cuts < length * (1.0 - 1e-9))]
    return np.concatenate([[0.0], inside, [length]])


def _linear_radius_cuts(owner: BlockTable, s0: float, s1: float, r0: float, r1: float) -> FloatArray:
    """Return the distances at which the rpm reaches a dividing level while the radius changes linearly.

    The radius changes from ``r0`` to ``r1`` between the distances ``s0`` and ``s1``.
    """
    unclamped = 60.0 * owner.surface[0] / (2.0 * np.pi)  # rpm times radius
    low, high = min(r0, r1), max(r0, r1)
    bottom = max(low, unclamped / owner.max_rpm[0])
    top = min(high, unclamped / owner.min_rpm[0]) if owner.min_rpm[0] > 0.0 else high
    if not bottom < top or bottom == 0.0:
        return np.empty(0)
    steps = int(np.ceil(np.log(top / bottom) / np.log(MAX_RPM_RATIO)))
    levels = bottom * (top / bottom) ** (np.arange(steps + 1) / steps)
    fraction = (levels - r0) / (r1 - r0)
    return np.asarray(s0 + fraction * (s1 - s0), dtype=np.float64)
