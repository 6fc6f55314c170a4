"""From any speed to any place, at rest there: the arithmetic under the handwheel, for all values."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from core.executor.hand_motion.jog_line import Ramp
from core.executor.hand_motion.jog_ramps import plan_stop_at_distance

A = 3048.0
SPEEDS = st.floats(-42.0, 42.0)
WAYS = st.floats(-30.0, 30.0)
TOPS = st.floats(0.01, 42.0)


def ridden(pieces: list[Ramp], v0: float) -> tuple[float, float, float]:
    """Way, speed at the end, and the highest speed on it; the pieces have to fit together."""
    way, v, most = 0.0, v0, abs(v0)
    for dt, begins, a in pieces:
        assert dt > 0.0
        assert begins == pytest.approx(v, abs=1e-6)
        assert a == 0.0 or abs(a) == pytest.approx(A)
        way += (begins + 0.5 * a * dt) * dt
        v = begins + a * dt
        most = max(most, abs(v))
    return way, v, most


@given(SPEEDS, WAYS, TOPS)
@example(0.001953125, 0.0, 1.0)  # its braking distance is below the tolerance of positions
def test_plan_ends_exactly_at_the_distance_and_at_rest(v0: float, way: float, top: float) -> None:
    pieces = plan_stop_at_distance(v0, way, top, A)
    gone, v, most = ridden(pieces, v0)
    assert gone == pytest.approx(way, abs=1e-6)
    assert v == pytest.approx(0.0, abs=1e-6)
    assert most <= max(top, abs(v0)) + 1e-6


@given(st.floats(0.0, 42.0), WAYS, TOPS)
def test_plan_never_overshoots_a_reachable_target(v0: float, way: float, top: float) -> None:
    stop = v0 * v0 / (2.0 * A)
    at, furthest = 0.0, 0.0
    for dt, begins, a in plan_stop_at_distance(v0, way, top, A):
        turns = -begins / a if a and 0.0 < -begins / a < dt else dt
        furthest = max(furthest, at + (begins + 0.5 * a * turns) * turns)
        at += (begins + 0.5 * a * dt) * dt
    assert furthest <= max(way, stop, 0.0) + 1e-6


@pytest.mark.parametrize(
    ("v0", "way", "top", "seconds"),
    [
        (0.0, 0.0, 10.0, 0.0),
        (10.0, 10.0**2 / (2 * A), 42.0, 10.0 / A),  # just its braking
        (0.0, 1.0, 10.0, 1.0 / 10.0 + 10.0 / A),  # way/v + v/a
        (10.0, 0.0, 10.0, 10.0 / A + 2 * math.sqrt(10.0**2 / (2 * A) / A)),  # past it, and back
    ],
)
def test_plan_durations_match_hand_calculation(v0: float, way: float, top: float, seconds: float) -> None:
    assert sum(piece[0] for piece in plan_stop_at_distance(v0, way, top, A)) == pytest.approx(
        seconds, abs=1e-9
    )
