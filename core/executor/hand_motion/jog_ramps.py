"""Ramps of a jog or a step: phases of constant acceleration that end at rest."""

from __future__ import annotations

import math

from core.executor.hand_motion.jog_line import Ramp

_MIN_RAMP_S = 1e-12  # s; shorter ramps are dropped
POSITION_TOLERANCE = 1e-9  # mm or degrees; closer positions count as equal


def plan_jog_ramps(
    start_speed: float, end_speed: float, acceleration: float, duration_s: float, distance: float
) -> list[Ramp]:
    """Return the ramps of a jog: a change to ``end_speed``, a cruise, and braking to rest.

    The first ramp starts at ``start_speed``, and the cruise lasts for the rest of ``duration_s``. If
    ``distance`` (mm) is too short, the jog is slower or ends earlier. ``distance`` must not be shorter than
    the braking distance v0²/2a.
    """
    if start_speed * end_speed < 0.0:
        first = abs(start_speed) / acceleration
        return [
            (first, start_speed, -math.copysign(acceleration, start_speed)),
            *plan_jog_ramps(0.0, end_speed, acceleration, duration_s - first, distance),
        ]
    sign = math.copysign(1.0, end_speed or start_speed)
    here, top = abs(start_speed), abs(end_speed)
    fastest = (
        math.sqrt(max(here * here / 2.0 + acceleration * max(distance, 0.0), 0.0))
        if math.isfinite(distance)
        else math.inf
    )
    top = (
        max(min(top, fastest, here + acceleration * max(duration_s, 0.0)), 0.0)
        if top > here
        else min(top, fastest)
    )
    change = abs(top - here) / acceleration
    least = change * (here + top) / 2.0 + top * top / (2.0 * acceleration)
    cruise = max(duration_s - change, 0.0) if top > 0.0 else 0.0
    if cruise and math.isfinite(distance):
        cruise = min(cruise, max(distance - least, 0.0) / top)
    return _ramps(
        (change, start_speed, sign * math.copysign(acceleration, top - here)),
        (cruise, sign * top, 0.0),
        (top / acceleration, sign * top, -sign * acceleration),
    )


def plan_step_ramps(distance: float, speed: float, acceleration: float) -> list[Ramp]:
    """Return ramps from rest to rest over exactly ``distance``, at no more than ``speed``.

    A short distance has no cruise; its top speed is √(a·|distance|).
    """
    sign, absolute_distance = math.copysign(1.0, distance), abs(distance)
    top = min(speed, math.sqrt(acceleration * absolute_distance))
    change = top / acceleration
    return _ramps(
        (change, 0.0, sign * acceleration),
        ((absolute_distance - top * change) / top, sign * top, 0.0),
        (change, sign * top, -sign * acceleration),
    )


def plan_stop_at_distance(
    start_speed: float, distance: float, max_speed: float, acceleration: float
) -> list[Ramp]:
    """Return ramps from ``start_speed`` to rest at exactly ``distance``.

    The speed does not exceed ``max_speed`` except while the axis slows down to it. If the target is in the
    opposite direction or within the braking distance, the axis stops first and then returns.
    """
    stop = start_speed * abs(start_speed) / (2.0 * acceleration)
    is_within_tolerance = abs(distance) <= POSITION_TOLERANCE
    if start_speed * distance < 0.0 or is_within_tolerance or abs(stop) > abs(distance) + POSITION_TOLERANCE:
        brake = (abs(start_speed) / acceleration, start_speed, -math.copysign(acceleration, start_speed))
        back = distance - stop
        return _ramps(
            brake,
            *(plan_step_ramps(back, max_speed, acceleration) if abs(back) > POSITION_TOLERANCE else ()),
        )
    sign, here, left = math.copysign(1.0, distance), abs(start_speed), abs(distance)
    peak = min(max_speed, math.sqrt(acceleration * left + here * here / 2.0))
    change = abs(peak - here) / acceleration
    cruise = (left - change * (here + peak) / 2.0 - peak * peak / (2.0 * acceleration)) / peak
    return _ramps(
        (change, start_speed, sign * math.copysign(acceleration, peak - here)),
        (cruise, sign * peak, 0.0),
        (peak / acceleration, sign * peak, -sign * acceleration),
    )


def _ramps(*pieces: Ramp) -> list[Ramp]:
    return [piece for piece in pieces if piece[0] > _MIN_RAMP_S]
