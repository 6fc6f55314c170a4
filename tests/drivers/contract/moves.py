"""One straight move for any driver: as setpoints, or as blocks for a controller that plans by itself."""

from __future__ import annotations

import numpy as np

from core.block_ports import BlockController, LineOperation
from core.ports import AxisSink, MotionSegments

ACCEL = 3000.0  # mm/s²
_PIECE = 0.1  # s of one block


def start(axes: AxisSink, speed: float, cruise: float) -> MotionSegments:
    """X from where it rests, as soon as the driver takes it."""
    at = axes.now() + axes.commit + 0.005
    rest, _ = axes.demand_at(1e9)
    up = abs(speed) / ACCEL
    a = ACCEL if speed > 0 else -ACCEL
    dt = np.array([up, cruise, up])
    p = np.tile(np.array(rest), (3, 1))
    v, acc = np.zeros_like(p), np.zeros_like(p)
    p[:, 0] += np.array([0.0, 0.5 * speed * up, 0.5 * speed * up + speed * cruise])
    v[:, 0] = [0.0, speed, speed]
    acc[:, 0] = [a, 0.0, -a]
    return MotionSegments(at + np.array([0.0, up, up + cruise]), dt, p, v, acc)


def hand_over(blocks: BlockController, axes: AxisSink, speed: float, cruise: float) -> float:
    """The same way in blocks of a tenth of a second; where it ends."""
    x, z = axes.demand_at(1e9)[0][:2]
    way = speed * (cruise + abs(speed) / ACCEL)
    n = max(1, round(cruise / _PIECE))
    for i in range(1, n + 1):
        ticket = blocks.submit_block(LineOperation(x + way * i / n, z, abs(speed)))
        assert ticket is not None, "no room for a second of motion"
    return x + way
