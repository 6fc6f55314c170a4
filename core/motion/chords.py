"""What chords shorter than a setpoint interval ask of the axes, measured over the interval as a whole.

Words are rounded to the step, and on chords of a hundredth the rounding turns the direction to and fro at
every joint far more than the curve does. An axis never sees these turns: between two setpoints it gets their
sum. What it is asked for is the second difference of the setpoints, |P(s+r) - 2·P(s) + P(s-r)| / interval²
with r the way of one interval, and that is what is held against its limit here.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.motion.limits import CENTRIPETAL_SHARE, FloatArray, IntArray, MotionLimits
from core.motion.pieces import Pieces

_HALVINGS = 6  # slower speeds at which the same joint is looked at too


class Asked(NamedTuple):
    """Of k joints: squared speed limit (k,), mm²/s², and acceleration (k, axes) that it takes, mm/s²."""

    joint: IntArray
    squared: FloatArray
    acceleration: FloatArray


def asked_over_intervals(
    pieces: Pieces, alone: Asked, fastest: FloatArray, limits: MotionLimits, *, more: bool
) -> Asked:
    """What the path asks round the joints of ``alone``, which may be run at ``fastest`` (k,) mm/s.

    ``alone`` tells their limits if each stood for itself; no joint gets less. Joint i lies between the pieces
    i and i+1. The path is taken to go straight on at both ends; but where ``more`` pieces will follow, joints
    within an interval of the end stand for themselves and take all they may, so that what a plan builds on
    only grows with the path.
    """
    if not len(alone.joint):
        return alone
    share = CENTRIPETAL_SHARE * limits.accelerations
    s = np.concatenate([[0.0], np.cumsum(pieces.length)])
    at = s[alone.joint + 1]
    mean = 0.5 * (pieces.length[alone.joint] + pieces.length[alone.joint + 1])
    speeds = fastest / 2.0 ** np.arange(_HALVINGS)[:, None]
    asked = np.zeros((_HALVINGS, len(at), len(share)))
    for i, speed in enumerate(speeds):
        asked[i] = _second_difference(pieces, s, at, speed * limits.interval) / limits.interval**2
    asked[speeds * limits.interval < mean] = 0.0  # one joint an interval: its own limit sees to it
    ratio = (asked / share).max(axis=2)
    over = ratio > 1.0
    squared = np.where(over, (speeds / np.where(over, ratio, 1.0)) ** 2, np.inf).min(axis=0)
    if more:
        squared[at + fastest * limits.interval > s[-1]] = 0.0
    better = np.maximum(squared, alone.squared)
    taken = np.where((speeds**2 <= better)[:, :, None], asked, 0.0).max(axis=0, initial=0.0)
    taken[squared < fastest**2] = share
    kept = (squared <= alone.squared) & (squared > 0.0)
    taken[kept] = alone.acceleration[kept]
    return Asked(alone.joint, better, taken)


def _second_difference(pieces: Pieces, s: FloatArray, at: FloatArray, reach: FloatArray) -> FloatArray:
    """|P(s+r) - 2·P(s) + P(s-r)| per axis (k, axes)."""
    before, here, after = (_points(pieces, s, where) for where in (at - reach, at, at + reach))
    difference: FloatArray = np.abs(after - 2.0 * here + before)
    return difference


def _points(pieces: Pieces, s: FloatArray, where: FloatArray) -> FloatArray:
    index = np.clip(np.searchsorted(s, where, side="right") - 1, 0, len(pieces) - 1)
    return pieces[index].point(where - s[index])
