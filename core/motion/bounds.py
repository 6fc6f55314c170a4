"""Speed and acceleration limits of pieces and of the corners between them.

The formulas and their reasons: docs/decisions/0003-time-law.md. Nothing here depends on an override, so that
a plan made from a moving state meets the same limits as the plan it replaces.
"""

from __future__ import annotations

import numpy as np

from core.motion.limits import CENTRIPETAL_SHARE, OVERRIDE_MAX, FloatArray, MotionLimits
from core.motion.pieces import Pieces


def speed_caps(pieces: Pieces, limits: MotionLimits) -> FloatArray:
    """Speed (n,) no override may exceed, mm/s: axes, centripetal acceleration, OVERRIDE_MAX × rate."""
    caps = _least_ratio(limits.speeds, pieces.direction)
    arc = pieces.curvature != 0.0
    centripetal = np.sqrt(CENTRIPETAL_SHARE * limits.plane_acceleration * pieces.radius[arc])
    caps[arc] = np.minimum(caps[arc], np.minimum(limits.plane_speed, centripetal))
    return np.minimum(caps, OVERRIDE_MAX * pieces.rate)


def accelerations(pieces: Pieces, caps: FloatArray, limits: MotionLimits) -> FloatArray:
    """Acceleration (n,) along each piece, mm/s²; on arcs what the vector sum leaves at the speed cap."""
    along = _least_ratio(limits.accelerations, pieces.direction)
    arc = pieces.curvature != 0.0
    centripetal = caps[arc] ** 2 * np.abs(pieces.curvature[arc])
    along[arc] = np.minimum(along[arc], np.sqrt(limits.plane_acceleration**2 - centripetal**2))
    return along


def _least_ratio(limit: FloatArray, direction: FloatArray) -> FloatArray:
    """Smallest of limit / |direction| over the axes; endless for an axis that does not move."""
    share = np.abs(direction)
    ratios = np.divide(limit, share, out=np.full(share.shape, np.inf), where=share > 0.0)
    least: FloatArray = ratios.min(axis=1)
    return least


def corner_turns(pieces: Pieces) -> FloatArray:
    """|change of direction| per axis (n-1, 3) at the joints between pieces; below 1e-9 it is none."""
    leaving = pieces.tangent(pieces.length)[:-1]
    entering = pieces.tangent(np.zeros(len(pieces)))[1:]
    turns: FloatArray = np.abs(entering - leaving)
    turns[turns < 1e-9] = 0.0
    return turns


def corner_caps(pieces: Pieces, turns: FloatArray, limits: MotionLimits) -> FloatArray:
    """Square of the speed (n-1,) at each joint, mm²/s², endless where the direction does not change.

    One interval: v·|Δu| ≤ amax·interval. Short chords: v²·|Δu|/ℓ ≤ share·amax, ℓ the neighbours' mean
    length, which for chords of a circle is its centripetal limit whatever the length of the chords.
    """
    amax = limits.accelerations
    mean = 0.5 * (pieces.length[:-1] + pieces.length[1:])[:, None]
    sharp = np.full(turns.shape, np.inf)
    np.divide(amax * limits.interval, turns, out=sharp, where=turns > 0.0)
    curved = np.full(turns.shape, np.inf)
    np.divide(CENTRIPETAL_SHARE * amax * mean, turns, out=curved, where=turns > 0.0)
    caps: FloatArray = np.minimum(sharp**2, curved).min(axis=1)
    return caps


def spare_for_chords(
    pieces: Pieces, caps: FloatArray, turns: FloatArray, corners: FloatArray, limits: MotionLimits
) -> FloatArray:
    """Acceleration (n,) that chords shorter than one interval may use besides following their curve.

    Chords passed within one setpoint interval are a curve to the machine: v²·|Δu|/ℓ of each axis is spoken
    for, and (amax - that)/|u| remains. At least a fifth of amax does, by the limit on corners. Endless for
    longer lines and for arcs.
    """
    spare = np.full(len(pieces), np.inf)
    short = (pieces.length < caps * limits.interval) & (pieces.curvature == 0.0)
    if len(pieces) < 2 or not short.any():
        return spare
    bend = turns / (0.5 * (pieces.length[:-1] + pieces.length[1:]))[:, None]
    taken = np.zeros((len(pieces), 3))
    taken[1:] = bend * np.minimum(caps[1:] ** 2, corners)[:, None]
    np.maximum(taken[:-1], bend * np.minimum(caps[:-1] ** 2, corners)[:, None], out=taken[:-1])
    left = limits.accelerations - taken[short]
    share = np.abs(pieces.direction[short])
    ratio = np.divide(left, share, out=np.full(share.shape, np.inf), where=share > 0.0)
    spare[short] = ratio.min(axis=1)
    return spare
