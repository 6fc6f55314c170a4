"""Closed-form response of a simulated servo to setpoints of constant acceleration.

``Servo.follow`` steps a linear second-order difference equation. While no limit of the drive acts, its
solution is known: a steady part that follows the setpoint, and two decaying modes. One evaluation therefore
replaces any number of steps; both agree within rounding (1e-9 mm).
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeVar

from core.ports import FloatArray

Number = TypeVar("Number", float, FloatArray)


class Setpoints(NamedTuple):
    """Setpoints of one axis on the model's grid: ``p + dp * k + ddp * k * k`` at grid point ``k``."""

    p: float
    dp: float
    ddp: float


class Response(NamedTuple):
    """Position minus setpoint at grid point ``k``: ``lag + drift * k + slow * slow_mode**k + ...``."""

    lag: float
    drift: float
    slow: float
    fast: float


AT_REST = Response(0.0, 0.0, 0.0, 0.0)


class ServoLoop:
    """Difference equation of a position loop with damping 1.

    ``stiffness`` is the natural frequency times the step; ``feed_forward`` is the fraction of the velocity
    that the drive is given. Raises ValueError where the loop would oscillate (stiffness of 0.5 and more).
    """

    def __init__(self, stiffness: float, feed_forward: float) -> None:
        if not 0.0 < stiffness < 0.5:
            raise ValueError(f"stiffness {stiffness}: must be between 0 and 0.5")
        w = self._w = stiffness
        self._missing = 1.0 - feed_forward
        # The characteristic equation m² - (2 - 2w - w²)m + (1 - 2w) = 0 has two real roots.
        middle, half = 1.0 - w - 0.5 * w * w, 0.5 * w * math.sqrt(w * (4.0 + w))
        self.slow_mode, self.fast_mode = middle + half, middle - half
        self.slow_bend, self.fast_bend = (self.slow_mode - 1.0) ** 2, (self.fast_mode - 1.0) ** 2

    def response(self, position: float, step: float, setpoints: Setpoints) -> Response:
        """Return the response from ``position``, reached by a last move of ``step`` (mm, or degrees)."""
        w, missing, (p, dp, ddp) = self._w, self._missing, setpoints
        drift = -4.0 * ddp * missing / w
        lag = (2.0 * w * (ddp - missing * dp - drift) - 2.0 * ddp) / (w * w)
        now = position - p - lag
        before = position - step - (p - dp + ddp) - (lag - drift)
        after = (2.0 - 2.0 * w - w * w) * now - (1.0 - 2.0 * w) * before
        slow = (after - self.fast_mode * now) / (self.slow_mode - self.fast_mode)
        return Response(lag, drift, slow, now - slow)

    def states(self, setpoints: Setpoints, response: Response, k: Number) -> tuple[Number, Number, Number]:
        """Return the position at grid point ``k``, the move that led there and its change, all in mm
        (or degrees) and intervals of the grid.
        """
        (p, dp, ddp), (lag, drift, slow_part, fast_part) = setpoints, response
        slow, fast = slow_part * self.slow_mode ** (k - 1), fast_part * self.fast_mode ** (k - 1)
        place = p + dp * k + ddp * k * k + lag + drift * k
        place = place + (slow * self.slow_mode + fast * self.fast_mode)
        moved = dp + ddp * (2 * k - 1) + drift
        moved = moved + slow * (self.slow_mode - 1.0) + fast * (self.fast_mode - 1.0)
        bent = 2.0 * ddp + slow * self.slow_bend / self.slow_mode + fast * self.fast_bend / self.fast_mode
        return place, moved, bent
