"""Where the slides are along a chain of thread blocks: X and Z over s, the turns of the spindle times a lead.

A thread of one block has Z in proportion to s. In a chain the lead changes from block to block, and with G34
and G35 within one. A slide cannot change its speed at once: round the end of a block both slides go over into
the next lead in so many turns as half of their acceleration takes at the speed that is commanded.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits

Floats = npt.NDArray[np.float64]

_CHORDS = 16  # a turn, of a lead that changes: .1 mm more a turn lies 5e-5 mm beside its chord
_BLEND = 8  # chords of a change of lead
_SHARE = 0.5  # of the acceleration
_SAME = 1e-9


class ThreadCurve(NamedTuple):
    """Machine X and Z, mm, at the knots ``s``, mm from 0 on; straight between them and behind the last."""

    s: Floats
    x: Floats
    z: Floats

    @property
    def length(self) -> float:
        """s of the end."""
        return float(self.s[-1])

    def at(self, s: float) -> tuple[float, float, float, float]:
        """X and Z at ``s``, and their change per mm of it."""
        i = int(np.clip(np.searchsorted(self.s, s, side="right") - 1, 0, len(self.s) - 2))
        step = float(self.s[i + 1] - self.s[i])
        dx, dz = float(self.x[i + 1] - self.x[i]) / step, float(self.z[i + 1] - self.z[i]) / step
        ahead = s - float(self.s[i])
        return float(self.x[i]) + dx * ahead, float(self.z[i]) + dz * ahead, dx, dz

    def place(self, z: float) -> float:
        """s at which Z stands at ``z``; before the start and behind the end as the next piece goes."""
        sign = math.copysign(1.0, float(self.z[-1] - self.z[0]))
        i = int(np.clip(np.searchsorted(sign * self.z, sign * z, side="right") - 1, 0, len(self.s) - 2))
        return float(self.s[i] + (z - self.z[i]) * (self.s[i + 1] - self.s[i]) / (self.z[i + 1] - self.z[i]))

    def acceleration(self, ax: float, az: float) -> float:
        """Along s, of what the slides have: mm/s²."""
        dx, dz = np.abs(np.diff(self.x) / np.diff(self.s)), np.abs(np.diff(self.z) / np.diff(self.s))
        return float(min(az / dz.max(), ax / dx.max() if dx.max() else math.inf))


def turns_of(block: Block) -> float:
    """Turns of the spindle that a thread block takes; its feed is its mean lead."""
    return abs(block.z - block.z0) / block.feed


def curve_of(blocks: Sequence[Block], limits: MotionLimits) -> ThreadCurve:
    """The curve of a chain of threads, the first lead taken as that of s."""
    first = blocks[0]
    unit = first.feed - 0.5 * first.growth * turns_of(first)
    s, x, z = [0.0], [first.x0 + first.offset_x], [first.z0 + first.offset_z]
    joints: list[float] = []
    for block in blocks:
        if block is not first:
            joints.append(s[-1])
        for share, turns in _chords(block):
            x.append(block.x0 + block.offset_x + (block.x - block.x0) * share)
            z.append(block.z0 + block.offset_z + (block.z - block.z0) * share)
            s.append(s[-1] + turns * unit)
    raw = ThreadCurve(np.array(s), np.array(x), np.array(z))
    return _blended(raw, joints, abs(first.rpm) / 60.0 * unit, limits)


def _chords(block: Block) -> list[tuple[float, float]]:
    """Shares of the way and the turns from one to the next, along a block."""
    whole = turns_of(block)
    if not block.growth:
        return [(1.0, whole)]
    count = max(math.ceil(whole * _CHORDS), 2)
    lead = block.feed - 0.5 * block.growth * whole
    q = np.linspace(0.0, whole, count + 1)[1:]
    way = (lead + 0.5 * block.growth * q) * q
    return [(float(each) / float(way[-1]), whole / count) for each in way]


def _blended(raw: ThreadCurve, joints: Sequence[float], speed: float, limits: MotionLimits) -> ThreadCurve:
    """The same with its joints rounded off, where the slides could not follow; ``speed`` along s, mm/s."""
    s, points = list(raw.s), {float(k): (float(a), float(b)) for k, a, b in zip(*raw, strict=True)}
    for joint in joints:
        x0, z0, dx1, dz1 = raw.at(joint)
        _, _, dx0, dz0 = raw.at(joint - 1e-6)
        ax, az = limits.amax[:2]
        half = 0.5 * speed * speed * max(abs(dx1 - dx0) / ax, abs(dz1 - dz0) / az) / _SHARE
        at = s.index(joint)
        half = min(half, 0.45 * (s[at] - s[at - 1]), 0.45 * (s[at + 1] - s[at]))
        if half <= _SAME:
            continue
        del points[joint]
        for u in np.linspace(-half, half, _BLEND + 1).tolist():
            bend = (u + half) ** 2 / (4.0 * half)
            points[joint + u] = (x0 + dx0 * u + (dx1 - dx0) * bend, z0 + dz0 * u + (dz1 - dz0) * bend)
    knots = sorted(points)
    return ThreadCurve(
        np.array(knots), np.array([points[k][0] for k in knots]), np.array([points[k][1] for k in knots])
    )
