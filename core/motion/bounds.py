"""Speed and acceleration limits of pieces and of the corners between them.

The formulas and their reasons: docs/decisions/0003-time-law.md. Nothing here depends on an override, so that
a plan made from a moving state meets the same limits as the plan it replaces.
"""

from __future__ import annotations

import numpy as np

from core.motion.chords import Asked, asked_over_intervals
from core.motion.limits import CENTRIPETAL_SHARE, OVERRIDE_MAX, FloatArray, MotionLimits
from core.motion.pieces import Pieces

_MUCH = 0.2  # of amax: joints of chords that ask less are left as they are


def piece_limits(
    pieces: Pieces, limits: MotionLimits, *, more: bool
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Speed cap (n,) and acceleration (n,) of pieces, squared speed limit (n+1,) of their joints.

    ``more`` says that pieces will follow. The joints at both ends are endless.
    """
    cap = speed_caps(pieces, limits)
    speeds = expected_speeds(pieces, cap)
    corner = np.full(len(pieces) + 1, np.inf)
    if not len(pieces):
        return cap, cap, corner
    turns = corner_turns(pieces)
    single = corner_caps(pieces, turns, limits)
    asked = _asked(pieces, speeds, turns, single, limits, more=more)
    corner[1:-1] = single
    # A step of the velocity at one joint stays within amax·interval: the queue of the drives takes no more.
    corner[1:-1][asked.joint] = np.minimum(asked.squared, step_caps(turns[asked.joint], limits))
    spare = spare_for_chords(pieces, speeds, turns, single, limits, asked, more=more)
    return cap, np.minimum(accelerations(pieces, speeds, limits), spare), corner


def speed_caps(pieces: Pieces, limits: MotionLimits) -> FloatArray:
    """Speed (n,) that axes and centripetal acceleration allow on each piece, mm/s."""
    caps = _least_ratio(limits.speeds, pieces.direction)
    arc = pieces.curvature != 0.0
    centripetal = np.sqrt(CENTRIPETAL_SHARE * limits.plane_acceleration * pieces.radius[arc])
    caps[arc] = np.minimum(caps[arc], np.minimum(limits.plane_speed, centripetal))
    return caps


def expected_speeds(pieces: Pieces, caps: FloatArray) -> FloatArray:
    """The fastest (n,) that a piece will be run with any override, mm/s; acceleration is laid out for it."""
    return np.minimum(caps, OVERRIDE_MAX * pieces.rate)


def accelerations(pieces: Pieces, speeds: FloatArray, limits: MotionLimits) -> FloatArray:
    """Acceleration (n,) along each piece, mm/s²; on arcs what the vector sum leaves at ``speeds``."""
    along = _least_ratio(limits.accelerations, pieces.direction)
    arc = pieces.curvature != 0.0
    centripetal = speeds[arc] ** 2 * np.abs(pieces.curvature[arc])
    along[arc] = np.minimum(along[arc], np.sqrt(limits.plane_acceleration**2 - centripetal**2))
    return along


def _least_ratio(limit: FloatArray, direction: FloatArray) -> FloatArray:
    """Smallest of limit / |direction| over the axes; endless for an axis that does not move."""
    share = np.abs(direction)
    ratios = np.divide(limit, share, out=np.full(share.shape, np.inf), where=share > 0.0)
    least: FloatArray = ratios.min(axis=1)
    return least


def corner_turns(pieces: Pieces) -> FloatArray:
    """|change of direction| per axis (n-1, axes) at the joints between pieces; below 1e-9 it is none."""
    leaving = pieces.tangent(pieces.length)[:-1]
    entering = pieces.tangent(np.zeros(len(pieces)))[1:]
    turns: FloatArray = np.abs(entering - leaving)
    turns[turns < 1e-9] = 0.0
    return turns


def corner_caps(pieces: Pieces, turns: FloatArray, limits: MotionLimits) -> FloatArray:
    """Square of the speed (n-1,) at each joint, standing for itself, mm²/s²; endless where nothing turns.

    One interval: v·|Δu| ≤ amax·interval. Short chords: v²·|Δu|/ℓ ≤ share·amax, ℓ the neighbours' mean
    length, which for chords of a circle is its centripetal limit whatever the length of the chords. A second
    corner within the interval: v²·|Δu|/ℓ ≤ amax, ℓ the shorter neighbour. Two such corners take
    (2 - ℓ/vT)·ℓ/vT of amax together, which is never more than all of it.
    """
    amax = limits.accelerations
    mean = 0.5 * (pieces.length[:-1] + pieces.length[1:])
    shorter = np.minimum(pieces.length[:-1], pieces.length[1:])
    share = amax * np.minimum(CENTRIPETAL_SHARE * mean, shorter)[:, None]
    curved = np.full(turns.shape, np.inf)
    np.divide(share, turns, out=curved, where=turns > 0.0)
    caps: FloatArray = np.minimum(step_caps(turns, limits), curved.min(axis=1))
    return caps


def step_caps(turns: FloatArray, limits: MotionLimits) -> FloatArray:
    """Square of the speed (k,) at which each axis steps by amax·interval at a joint that turns so."""
    sharp = np.full(turns.shape, np.inf)
    np.divide(limits.accelerations * limits.interval, turns, out=sharp, where=turns > 0.0)
    caps: FloatArray = sharp.min(axis=1) ** 2
    return caps


def _asked(
    pieces: Pieces,
    speeds: FloatArray,
    turns: FloatArray,
    single: FloatArray,
    limits: MotionLimits,
    *,
    more: bool,
) -> Asked:
    """What short chords ask over an interval, of the joints that would be slow or ask much by themselves."""
    fastest = np.minimum(speeds[:-1], speeds[1:])
    mean = 0.5 * (pieces.length[:-1] + pieces.length[1:])
    alone = turns * (np.minimum(fastest**2, single) / mean)[:, None]
    much = (alone > _MUCH * limits.accelerations).any(axis=1) | (single < fastest**2)
    joints = np.flatnonzero(much & (mean < fastest * limits.interval))
    given = Asked(joints, single[joints], alone[joints])
    return asked_over_intervals(pieces, given, fastest[joints], limits, more=more)


def spare_for_chords(
    pieces: Pieces,
    speeds: FloatArray,
    turns: FloatArray,
    single: FloatArray,
    limits: MotionLimits,
    asked: Asked,
    *,
    more: bool,
) -> FloatArray:
    """Acceleration (n,) that chords shorter than one interval may use besides following their curve.

    Chords passed within one setpoint interval are a curve to the machine: v²·|Δu|/ℓ of each axis is spoken
    for, or what the interval as a whole asks (core/motion/chords.py), and (amax - that)/|u| remains. At least
    a fifth of amax does, by the limit on corners; where ``more`` pieces will follow, the last one gets that,
    so that no later corner can take what a plan has built on. Endless for longer lines and for arcs.
    """
    amax = limits.accelerations
    spare = np.full(len(pieces), np.inf)
    short = (pieces.length < speeds * limits.interval) & (pieces.curvature == 0.0)
    if not short.any():
        return spare
    bend = turns / (0.5 * (pieces.length[:-1] + pieces.length[1:]))[:, None]
    before = bend * np.minimum(speeds[1:] ** 2, single)[:, None]
    after = bend * np.minimum(speeds[:-1] ** 2, single)[:, None]
    before[asked.joint] = after[asked.joint] = asked.acceleration
    taken = np.zeros(pieces.direction.shape)
    taken[1:] = before
    np.maximum(taken[:-1], after, out=taken[:-1])
    if more:
        taken[-1] = CENTRIPETAL_SHARE * amax
    left = amax - np.minimum(taken[short], CENTRIPETAL_SHARE * amax)
    share = np.abs(pieces.direction[short])
    ratio = np.divide(left, share, out=np.full(share.shape, np.inf), where=share > 0.0)
    spare[short] = ratio.min(axis=1)
    return spare
