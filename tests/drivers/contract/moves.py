"""Setpoints of one straight move for any driver."""

from __future__ import annotations

import numpy as np

from core.ports import Segments
from tests.drivers.contract.rigs import Rig


def start(rig: Rig, speed: float, cruise: float) -> Segments:
    """X from where it rests, as soon as the driver takes it; 3000 mm/s²."""
    axes = rig.ports.axes
    at = axes.now() + axes.commit + 0.005
    rest, _ = axes.demand_at(1e9)
    up = abs(speed) / 3000.0
    a = 3000.0 if speed > 0 else -3000.0
    dt = np.array([up, cruise, up])
    p = np.tile(np.array(rest), (3, 1))
    v, acc = np.zeros_like(p), np.zeros_like(p)
    p[:, 0] += np.array([0.0, 0.5 * speed * up, 0.5 * speed * up + speed * cruise])
    v[:, 0] = [0.0, speed, speed]
    acc[:, 0] = [a, 0.0, -a]
    return Segments(at + np.array([0.0, up, up + cruise]), dt, p, v, acc)
