"""Phases along the path as axis motion of constant acceleration: what a driver takes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.motion.limits import BoolArray, FloatArray, IntArray
from core.motion.path import Path

SegmentArrays = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]

PART = 0.002  # s, longest part of an arc
ARC_ERROR = 2.5e-4  # mm by which a part may leave the arc between its ends
BRIEF = 1e-6  # s; in shorter parts differences of positions would be rounding, and the arc is its tangent
PART_ANGLE = 0.25  # rad, longest part of an arc


class Phases(NamedTuple):
    """k phases of constant acceleration along a path, each within one piece; arrays (k,)."""

    t: FloatArray  # start, s
    dt: FloatArray  # length, s
    s: FloatArray  # distance along the path at the start, mm
    v: FloatArray  # speed at the start, mm/s
    a: FloatArray  # mm/s²
    piece: IntArray

    def pick(self, part: IntArray | BoolArray | slice) -> Phases:
        """Some of the phases."""
        return Phases(
            t=self.t[part],
            dt=self.dt[part],
            s=self.s[part],
            v=self.v[part],
            a=self.a[part],
            piece=self.piece[part],
        )


def axis_segments(path: Path, phases: Phases, t_origin: float) -> SegmentArrays:
    """Setpoint pieces (t, dt, p, v, a) of k phases; times are those of the phases plus ``t_origin``.

    Lines give one piece each, exact. An arc is cut into equal times of at most 2 ms. Their ends lie on the
    arc, and a = 2·(P1 - P0 - V0·h)/h² joins them, so positions are continuous. With j = v/R·hypot(v²/R, 3a)
    as the jerk of the true motion the position between the ends is off by at most j·h³·2/81 and the velocity
    jumps by at most j·h²/6 at a joint; h keeps the first below 0.25 µm, and the second then stays far below
    amax · interval. The part that ends at rest ends with velocity 0 and takes its jump at its start.
    """
    parts = _part_counts(path, phases)
    owner = np.repeat(np.arange(len(parts)), parts)
    nth = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    h = (phases.dt / np.maximum(parts, 1))[owner]
    p, v, a = _states(path, phases.pick(owner), nth * h)
    arc = np.flatnonzero(path.pieces.curvature[phases.piece[owner]] != 0.0) if len(path) else owner
    if len(arc):
        v[arc], a[arc] = _joined_on_arc(path, phases.pick(owner[arc]), nth[arc], h[arc], (p[arc], v[arc]))
    return t_origin + phases.t[owner] + nth * h, h, p, v, a


def _joined_on_arc(
    path: Path, phases: Phases, nth: IntArray, h: FloatArray, begin: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Velocity and acceleration that lead each part from its start on the arc to its end on the arc."""
    end = (nth + 1) * h
    p1, _, _ = _states(path, phases, end)
    resting = (phases.v + phases.a * end <= 1e-9 * phases.v)[:, None]
    p0, v0 = begin
    short = (h < BRIEF)[:, None]
    chord, span = p1 - p0, np.maximum(h, BRIEF)[:, None]
    v = np.where(resting & ~short, 2.0 * chord / span, v0)
    joining = np.where(resting, -v / span, 2.0 * (chord - v * span) / span**2)
    return v, np.where(short, _curved(path, phases, v0), joining)


def _curved(path: Path, phases: Phases, v: FloatArray) -> FloatArray:
    """The true acceleration (k, 3) at the start of arc phases, where the velocity is ``v`` (k, 3)."""
    pieces = path.pieces[phases.piece]
    tangent = pieces.tangent(np.clip(phases.s - path.s[phases.piece], 0.0, pieces.length))
    curved: FloatArray = tangent * phases.a[:, None]
    turning = pieces.curvature * np.hypot(v[:, 0], v[:, 1])
    curved[:, 0] += turning * v[:, 1]
    curved[:, 1] -= turning * v[:, 0]
    return curved


def _part_counts(path: Path, phases: Phases) -> IntArray:
    counts = np.ones(len(phases.t), dtype=np.int64)
    if not len(path):
        return counts
    bend = np.abs(path.pieces.curvature[phases.piece])
    arc = np.flatnonzero(bend)
    bend, (_, dt, _, v, a, _) = bend[arc], phases.pick(arc)
    fastest = np.maximum(v, v + a * dt)
    jerk = fastest * bend * np.hypot(fastest**2 * bend, 3.0 * a)
    longest = np.minimum(PART, PART_ANGLE / (fastest * bend))
    longest = np.minimum(longest, np.cbrt(ARC_ERROR * 40.5 / jerk))
    counts[arc] = np.maximum(np.ceil(dt / longest * (1.0 - 1e-12)), 1.0).astype(np.int64)
    return counts


def _states(path: Path, phases: Phases, tau: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Axis position, velocity, tangential acceleration (k, axes), ``tau`` (k,) after the start of phases."""
    pieces = path.pieces[phases.piece]
    speed = np.maximum(phases.v + phases.a * tau, 0.0)
    local = phases.s - path.s[phases.piece] + (phases.v + 0.5 * phases.a * tau) * tau
    local = np.clip(local, 0.0, pieces.length)
    tangent = pieces.tangent(local)
    return pieces.point(local), tangent * speed[:, None], tangent * phases.a[:, None]
