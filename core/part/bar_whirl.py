"""The speed at which a bar that nothing supports begins to whirl."""

from __future__ import annotations

import math

from core.part.stock import Stock

_FIRST_MODE = 1.8751**2  # of a beam clamped at one end
_SOUND = 3.5e6  # mm/s, √(E/ρ) of brass; in steel and aluminium it is 5.0e6


def whirling_rpm(stock: Stock, stick_out: float) -> float:
    """The first critical speed of a bar that stands ``stick_out`` mm out of its chuck up to Z0, rpm; 0: none.

    That of a beam clamped at one end: 1.8751² · √(E·I / (ρ·A)) / L², with brass for E and ρ, the slowest of
    what is turned in metal. A bar that bends by itself whirls below it.
    """
    length = stick_out + stock.front
    if length <= 0.0:
        return 0.0
    bore = max((r for _, r in stock.bore), default=0.0)
    gyration = math.hypot(stock.radius, bore) / 2.0
    return _FIRST_MODE * _SOUND * gyration / length**2 * 60.0 / math.tau
