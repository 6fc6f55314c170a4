"""Velocity, acceleration and ripple out of recorded positions and speeds, and over what time each is taken.

Nothing here looks smoother than it is: each figure is a plain difference over a span that is told beside the
curve. The span lies half before and half behind its instant, so nothing comes late; where it would reach
beyond the samples there is no figure (nan).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

VELOCITY_SPAN = 0.008  # s
ACCELERATION_SPAN = 0.032  # s
RIPPLE_SPAN = 0.5  # s: ripple is the speed less its mean over this


def velocity(times: FloatArray, position: FloatArray, span: float = VELOCITY_SPAN) -> FloatArray:
    """Way over time across ``span`` s, or two samples where they lie farther apart; units a second.

    Exact where the acceleration is constant. A sine of ω rad/s comes out smaller by sin(ω·span/2)/(ω·span/2).
    """
    k = _half(times, span)
    found = np.full(len(times), np.nan)
    if len(times) > 2 * k:
        way, took = position[2 * k :] - position[: -2 * k], times[2 * k :] - times[: -2 * k]
        found[k:-k] = way / took
    return found


def acceleration(times: FloatArray, position: FloatArray, span: float = ACCELERATION_SPAN) -> FloatArray:
    """Change of the mean velocity from the first to the second half of ``span`` s; units a second squared.

    With h = span/2 it is (p(t+h) − 2p(t) + p(t−h))/h² of even samples: exact where the acceleration is
    constant, and smaller by (sin(ωh/2)/(ωh/2))² of a sine.
    """
    k = _half(times, span)
    found = np.full(len(times), np.nan)
    if len(times) > 2 * k:
        ahead, behind = times[2 * k :] - times[k:-k], times[k:-k] - times[: -2 * k]
        after = (position[2 * k :] - position[k:-k]) / ahead
        before = (position[k:-k] - position[: -2 * k]) / behind
        found[k:-k] = 2.0 * (after - before) / (ahead + behind)
    return found


def ripple(times: FloatArray, speed: FloatArray, span: float = RIPPLE_SPAN) -> FloatArray:
    """Speed less its mean over ``span`` s. Ripple of which whole waves fit into it cancels in the mean."""
    k = _half(times, span)
    found = np.full(len(times), np.nan)
    known = np.isfinite(speed)
    if len(times) > 2 * k:
        total = np.concatenate([[0.0], np.cumsum(np.where(known, speed, 0.0))])
        count = np.concatenate([[0], np.cumsum(known)])
        n = count[2 * k + 1 :] - count[: -2 * k - 1]
        mean = (total[2 * k + 1 :] - total[: -2 * k - 1]) / np.maximum(n, 1)
        found[k:-k] = np.where(n == 2 * k + 1, speed[k:-k] - mean, np.nan)
    return found


def _half(times: FloatArray, span: float) -> int:
    """Samples in half the span, one at least; of the commonest distance of samples."""
    if len(times) < 2:
        return 1
    step = float(np.median(np.diff(times)))
    return max(1, round(0.5 * span / step)) if step > 0.0 else 1
