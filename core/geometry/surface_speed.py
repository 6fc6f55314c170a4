"""Spindle speed from surface speed."""

from __future__ import annotations

import math


def surface_rpm(speed: float, radius: float, lo: float, hi: float) -> float:
    """Rpm, unsigned, at which a point ``radius`` mm off the axis passes the tool with ``speed`` mm/s.

    rpm = 60·speed / (2·pi·|radius|), at least ``lo`` and never above ``hi``; on the axis it is ``hi``.
    """
    path = 2.0 * math.pi * abs(radius)
    rpm = math.inf if path == 0.0 else 60.0 * speed / path
    return min(max(rpm, lo), hi)
