"""Curve of X and Z along a chain of thread blocks, over the parameter s.

s is the number of spindle revolutions times the lead. In a thread of one block, Z is proportional to s. In
a chain, the lead changes between blocks, and with G34 and G35 also within a block. No axis can change its
speed instantly. Where two blocks meet, both axes therefore change to the next lead over several
revolutions. At the commanded speed, this takes half of their permitted acceleration.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits

FloatArray = npt.NDArray[np.float64]

_CHORDS_PER_REVOLUTION = (
    16  # chords per revolution; a lead that grows by 0.1 mm per revolution deviates by 5e-5 mm
)
_BLEND = 8  # chords per change of lead
_SHARE = 0.5  # fraction of the acceleration used for a change of lead
_SAME_POINT_TOLERANCE = 1e-9


class ThreadCurve(NamedTuple):
    """Table of X and Z in machine coordinates at values of the curve parameter s, all in mm.

    ``curve_positions_mm`` are the values of s, of which the first is 0. The curve is linear between the
    points and continues linearly after the last one.
    """

    curve_positions_mm: FloatArray
    x_mm: FloatArray
    z_mm: FloatArray

    @property
    def length_mm(self) -> float:
        """Return the value of the curve parameter s at the end of the curve, in mm."""
        return float(self.curve_positions_mm[-1])

    def evaluate_curve(self, s: float) -> tuple[float, float, float, float]:
        """Return X and Z at ``s``, and their derivatives with respect to s."""
        i = int(
            np.clip(
                np.searchsorted(self.curve_positions_mm, s, side="right") - 1,
                0,
                len(self.curve_positions_mm) - 2,
            )
        )
        step = float(self.curve_positions_mm[i + 1] - self.curve_positions_mm[i])
        dx, dz = float(self.x_mm[i + 1] - self.x_mm[i]) / step, float(self.z_mm[i + 1] - self.z_mm[i]) / step
        ahead = s - float(self.curve_positions_mm[i])
        return float(self.x_mm[i]) + dx * ahead, float(self.z_mm[i]) + dz * ahead, dx, dz

    def find_curve_position(self, z: float) -> float:
        """Return the s at which Z equals ``z``.

        The curve is extrapolated before its start and after its end.
        """
        sign = math.copysign(1.0, float(self.z_mm[-1] - self.z_mm[0]))
        i = int(
            np.clip(
                np.searchsorted(sign * self.z_mm, sign * z, side="right") - 1,
                0,
                len(self.curve_positions_mm) - 2,
            )
        )
        return float(
            self.curve_positions_mm[i]
            + (z - self.z_mm[i])
            * (self.curve_positions_mm[i + 1] - self.curve_positions_mm[i])
            / (self.z_mm[i + 1] - self.z_mm[i])
        )

    def compute_max_acceleration(self, x_max_acceleration: float, z_max_acceleration: float) -> float:
        """Return the highest acceleration along s that X and Z permit, in mm/s².

        ``x_max_acceleration`` and ``z_max_acceleration`` are the limits of the axes.
        """
        dx, dz = (
            np.abs(np.diff(self.x_mm) / np.diff(self.curve_positions_mm)),
            np.abs(np.diff(self.z_mm) / np.diff(self.curve_positions_mm)),
        )
        return float(
            min(z_max_acceleration / dz.max(), x_max_acceleration / dx.max() if dx.max() else math.inf)
        )


def calculate_spindle_revolutions(block: Block) -> float:
    """Return the number of spindle revolutions of a thread block.

    The feed of the block is its mean lead.
    """
    return abs(block.z - block.z0) / block.feed


def build_thread_curve(blocks: Sequence[Block], limits: MotionLimits) -> ThreadCurve:
    """Return the curve of a chain of thread blocks; s is scaled by the lead of the first block."""
    first = blocks[0]
    unit = first.feed - 0.5 * first.growth * calculate_spindle_revolutions(first)
    s, x, z = [0.0], [first.x0 + first.offset_x], [first.z0 + first.offset_z]
    joints: list[float] = []
    for block in blocks:
        if block is not first:
            joints.append(s[-1])
        for share, turns in _chord_points(block):
            x.append(block.x0 + block.offset_x + (block.x - block.x0) * share)
            z.append(block.z0 + block.offset_z + (block.z - block.z0) * share)
            s.append(s[-1] + turns * unit)
    raw = ThreadCurve(np.array(s), np.array(x), np.array(z))
    return _round_joints(raw, joints, abs(first.rpm) / 60.0 * unit, limits)


def _chord_points(block: Block) -> list[tuple[float, float]]:
    """Return points of a thread block as (fraction of its length, revolutions since the last point)."""
    whole = calculate_spindle_revolutions(block)
    if not block.growth:
        return [(1.0, whole)]
    count = max(math.ceil(whole * _CHORDS_PER_REVOLUTION), 2)
    lead = block.feed - 0.5 * block.growth * whole
    q = np.linspace(0.0, whole, count + 1)[1:]
    distances_mm = (lead + 0.5 * block.growth * q) * q
    return [(float(each) / float(distances_mm[-1]), whole / count) for each in distances_mm]


def _round_joints(
    raw: ThreadCurve, joints: Sequence[float], speed: float, limits: MotionLimits
) -> ThreadCurve:
    """Return the curve with rounded transitions between blocks where the axes could not follow it.

    ``speed`` is the speed along s, in mm/s.
    """
    s, points = (
        list(raw.curve_positions_mm),
        {float(k): (float(a), float(b)) for k, a, b in zip(*raw, strict=True)},
    )
    for joint in joints:
        x0, z0, dx1, dz1 = raw.evaluate_curve(joint)
        _, _, dx0, dz0 = raw.evaluate_curve(joint - 1e-6)
        ax, az = limits.amax[:2]
        half = 0.5 * speed * speed * max(abs(dx1 - dx0) / ax, abs(dz1 - dz0) / az) / _SHARE
        at = s.index(joint)
        half = min(half, 0.45 * (s[at] - s[at - 1]), 0.45 * (s[at + 1] - s[at]))
        if half <= _SAME_POINT_TOLERANCE:
            continue
        del points[joint]
        for u in np.linspace(-half, half, _BLEND + 1).tolist():
            bend = (u + half) ** 2 / (4.0 * half)
            points[joint + u] = (x0 + dx0 * u + (dx1 - dx0) * bend, z0 + dz0 * u + (dz1 - dz0) * bend)
    knots = sorted(points)
    return ThreadCurve(
        np.array(knots), np.array([points[k][0] for k in knots]), np.array([points[k][1] for k in knots])
    )
