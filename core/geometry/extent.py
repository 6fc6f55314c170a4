"""How far lines and arcs reach: the box around a path, exact at the quadrants of an arc."""

from __future__ import annotations

import math

TURN = 2 * math.pi

# Two ends closer than this on a circle are one point: a full turn. Well under the control's step of 1.27 µm.
SAME_POINT = 1e-6


def arc_sweep(
    x0: float, z0: float, x: float, z: float, cx: float, cz: float, clockwise: bool
) -> tuple[float, float]:
    """(start angle, signed sweep) of an arc in radians, measured from Z+ towards X+.

    Seen from above (X+ down, Z+ right) that is the clockwise sense, so a G02 has a positive sweep.
    Start and end in one point make a full circle.
    """
    start = math.atan2(x0 - cx, z0 - cz)
    if math.hypot(x - x0, z - z0) < SAME_POINT:
        return start, TURN if clockwise else -TURN
    turned = (math.atan2(x - cx, z - cz) - start) % TURN
    return start, turned if clockwise else turned - TURN


def arc_extent(
    x0: float, z0: float, x: float, z: float, cx: float, cz: float, clockwise: bool
) -> tuple[float, float, float, float]:
    """(least x, greatest x, least z, greatest z) of an arc, mm."""
    start, sweep = arc_sweep(x0, z0, x, z, cx, cz, clockwise)
    radius = math.hypot(x0 - cx, z0 - cz)
    low, high = sorted((start, start + sweep))
    xs, zs = [x0, x], [z0, z]
    quarter = math.pi / 2
    for k in range(math.ceil(low / quarter), math.floor(high / quarter) + 1):
        xs.append(cx + radius * math.sin(k * quarter))
        zs.append(cz + radius * math.cos(k * quarter))
    return min(xs), max(xs), min(zs), max(zs)
