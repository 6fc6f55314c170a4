"""Calculation of the spindle speed for a surface speed."""

from __future__ import annotations

import math


def find_surface_rpm(speed: float, radius: float, min_rpm: float, max_rpm: float) -> float:
    """Return the unsigned rpm for the surface speed ``speed`` (mm/s) at ``radius`` mm from the centerline.

    The formula is rpm = 60·speed / (2·pi·|radius|), limited to at least ``min_rpm`` and at most
    ``max_rpm``. On the centerline the result is ``max_rpm``.
    """
    path = 2.0 * math.pi * abs(radius)
    rpm = math.inf if path == 0.0 else 60.0 * speed / path
    return min(max(rpm, min_rpm), max_rpm)
