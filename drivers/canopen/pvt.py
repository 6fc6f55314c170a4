"""From setpoints to PVT records: points of the path with position and velocity in counts, times in whole ms.

A drive goes from point to point on a cubic. Where the acceleration changes between two points the cubic
leaves the path, so such a stretch is cut until it stays within half a count, down to the shortest record.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import NamedTuple

Demand = Callable[[float], tuple[tuple[float, ...], tuple[float, ...]]]  # t → positions, velocities

SHORTEST = 2  # ms; shorter ones would fill queue and bus
_LOOKS = (0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875)
_RECORD = struct.Struct("<i")
_VELOCITY_TOP = 2**23 - 1


class Span(NamedTuple):
    """How long the stretch from ``t`` on lasts, and how far its cubic leaves the path, in counts."""

    ms: int
    off: float


def span(demand: Demand, t: float, longest: int, counts: Sequence[float]) -> Span:
    """The longest stretch of at most ``longest`` ms whose cubic keeps within half a count of the path.

    ``counts`` is the length of a count by axis. The shortest stretch is taken whatever it costs.
    """
    ms = longest
    while True:
        off = deviation(demand, t, 0.001 * ms, counts)
        if off <= 0.5 or ms <= SHORTEST:
            return Span(ms, off)
        ms = max(ms // 2, SHORTEST)


def deviation(demand: Demand, t: float, dt: float, counts: Sequence[float]) -> float:
    """How far the cubic from ``t`` to ``t + dt`` leaves the path, in counts of the worst axis."""
    p0, v0 = demand(t)
    p1, v1 = demand(t + dt)
    worst = 0.0
    for s in _LOOKS:
        p, _ = demand(t + s * dt)
        for i, count in enumerate(counts):
            cubic = hermite(p0[i], v0[i], p1[i], v1[i], dt, s)
            worst = max(worst, abs(cubic - p[i]) / count)
    return worst


def hermite(p0: float, v0: float, p1: float, v1: float, dt: float, s: float) -> float:
    """The cubic through two points with their velocities, at fraction ``s`` of ``dt``."""
    r = 1.0 - s
    return r * r * (p0 + s * (2.0 * p0 + v0 * dt)) + s * s * (p1 + r * (2.0 * p1 - v1 * dt))


def packed(ms: int, velocity: float, position: float) -> bytes:
    """One record of EPOS2: position in the low 32 bits, then velocity in 24, then the time in 8.

    Raises ValueError for what does not fit.
    """
    speed, place = round(velocity), round(position)
    if abs(speed) > _VELOCITY_TOP or not 0 <= ms <= 255:
        raise ValueError(f"a record of {ms} ms and {speed} counts/s does not fit the drive")
    return _RECORD.pack(place) + (speed & 0xFFFFFF).to_bytes(3, "little") + bytes([ms])


def unpacked(data: bytes) -> tuple[int, int, int]:
    """Milliseconds, velocity and position of a record."""
    speed = int.from_bytes(data[4:7], "little")
    return data[7], speed - 0x1000000 if speed & 0x800000 else speed, _RECORD.unpack(data[:4])[0]
