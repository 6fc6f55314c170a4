"""One axis from rest to rest: what a drive does on its own when it homes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from core.ports import Segments


def straight(
    start: float, rest: Sequence[float], axis: int, *, to: float, speed: float, accel: float
) -> Segments:
    """Ramp up, run at ``speed``, ramp down: axis number ``axis`` goes to ``to``, the others stay."""
    way = to - rest[axis]
    sign = math.copysign(1.0, way)
    top = min(speed, math.sqrt(abs(way) * accel))
    ramp = top / accel
    cruise = (abs(way) - top * ramp) / top if top > 0.0 else 0.0
    dt = np.array([ramp, max(cruise, 0.0), ramp])
    p, v = np.tile(np.asarray(rest, dtype=np.float64), (3, 1)), np.zeros((3, len(rest)))
    a = np.zeros_like(v)
    v[:, axis] = [0.0, sign * top, sign * top]
    a[:, axis] = [sign * accel, 0.0, -sign * accel]
    p[1, axis] += sign * 0.5 * top * ramp
    p[2, axis] = to - sign * 0.5 * top * ramp
    return Segments(start + np.array([0.0, dt[0], dt[0] + dt[1]]), dt, p, v, a)
