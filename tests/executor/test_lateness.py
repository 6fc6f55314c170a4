"""How a busy computer deepens the setpoint queue, and what it says of a later hold."""

from __future__ import annotations

import pytest

from core.executor.tick_lateness import CALM_PERIOD_S, LATE_THRESHOLD_S, QUEUE_DEPTH_STEPS_S, TickLateness


def test_punctual_ticks_retain_the_configured_lookahead() -> None:
    lateness = TickLateness(0.5)
    assert not any(lateness.record_tick(0.02, 0.01 * n) for n in range(10_000))
    assert (lateness.lookahead_s, lateness.hold_delay_s) == (0.5, 0.0)


# The queue is 0.5 s deep and 0.25 s ahead; a tick later than half of 0.5 s deepens it by 0.5 s.
@pytest.mark.parametrize(("late", "later"), [(0.1, 0.1), (0.11, 0.2), (0.3, 0.3), (1.04, 1.1), (9.0, 1.3)])
def test_late_tick_is_reported_rounded_up_and_limited(late: float, later: float) -> None:
    lateness = TickLateness(0.5)
    assert lateness.record_tick(late, 1.0)
    assert lateness.hold_delay_s == pytest.approx(later)


def test_smaller_lateness_is_not_reported_again() -> None:
    lateness = TickLateness(0.5)
    lateness.record_tick(0.4, 1.0)
    assert not lateness.record_tick(0.2, 1.1)
    assert lateness.hold_delay_s == pytest.approx(0.4)


def test_lookahead_grows_in_steps_up_to_its_limit() -> None:
    lateness = TickLateness(0.5)
    depths = []
    for n in range(6):
        lateness.record_tick(2.0, float(n))
        depths.append(lateness.lookahead_s)
    assert depths == [0.5 + step for step in (*QUEUE_DEPTH_STEPS_S[1:], *QUEUE_DEPTH_STEPS_S[-1:] * 3)]


def test_lateness_below_half_of_the_lookahead_does_not_increase_it() -> None:
    lateness = TickLateness(0.5)
    lateness.record_tick(0.24, 1.0)
    assert lateness.lookahead_s == 0.5


def test_the_queue_shrinks_by_one_step_after_each_calm_time() -> None:
    lateness = TickLateness(0.5)
    lateness.record_tick(2.0, 0.0)
    lateness.record_tick(2.0, 1.0)
    assert lateness.lookahead_s == 0.5 + QUEUE_DEPTH_STEPS_S[2]
    lateness.record_tick(0.0, 1.0 + CALM_PERIOD_S - 0.1)
    assert lateness.lookahead_s == 0.5 + QUEUE_DEPTH_STEPS_S[2]
    lateness.record_tick(0.0, 1.0 + CALM_PERIOD_S)
    assert (lateness.lookahead_s, lateness.hold_delay_s) == (0.5 + QUEUE_DEPTH_STEPS_S[1], 0.0)
    lateness.record_tick(0.0, 1.0 + 2 * CALM_PERIOD_S)
    assert lateness.lookahead_s == 0.5


def test_late_tick_restarts_the_calm_period() -> None:
    lateness = TickLateness(0.5)
    lateness.record_tick(2.0, 0.0)
    lateness.record_tick(LATE_THRESHOLD_S, CALM_PERIOD_S - 1.0)
    lateness.record_tick(0.0, CALM_PERIOD_S + 1.0)
    assert lateness.lookahead_s == 0.5 + QUEUE_DEPTH_STEPS_S[1]
