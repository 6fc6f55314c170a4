"""How a busy computer deepens the setpoint queue, and what it says of a later hold."""

from __future__ import annotations

import pytest

from core.executor.tick_lateness import CALM_PERIOD_S, LATE_THRESHOLD_S, QUEUE_DEPTH_STEPS_S, TickLateness


def test_a_punctual_computer_keeps_the_queue_of_the_machine_file() -> None:
    lateness = TickLateness(0.5)
    assert not any(lateness.record_tick(0.02, 0.01 * n) for n in range(10_000))
    assert (lateness.lookahead_s, lateness.hold_delay_s) == (0.5, 0.0)


# The queue is 0.5 s deep and 0.25 s ahead; a tick later than half of 0.5 s deepens it by 0.5 s.
@pytest.mark.parametrize(("late", "later"), [(0.1, 0.1), (0.11, 0.2), (0.3, 0.3), (1.04, 1.1), (9.0, 1.3)])
def test_a_late_tick_is_told_rounded_up_and_bounded(late: float, later: float) -> None:
    lateness = TickLateness(0.5)
    assert lateness.record_tick(late, 1.0)
    assert lateness.hold_delay_s == pytest.approx(later)


def test_less_than_before_is_not_told_again() -> None:
    lateness = TickLateness(0.5)
    lateness.record_tick(0.4, 1.0)
    assert not lateness.record_tick(0.2, 1.1)
    assert lateness.hold_delay_s == pytest.approx(0.4)


def test_the_queue_deepens_step_by_step_and_no_further_than_its_limit() -> None:
    lateness = TickLateness(0.5)
    depths = []
    for n in range(6):
        lateness.record_tick(2.0, float(n))
        depths.append(lateness.lookahead_s)
    assert depths == [0.5 + step for step in (*QUEUE_DEPTH_STEPS_S[1:], *QUEUE_DEPTH_STEPS_S[-1:] * 3)]


def test_a_tick_that_uses_less_than_half_of_the_queue_does_not_deepen_it() -> None:
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


def test_a_late_tick_in_the_calm_time_begins_it_anew() -> None:
    lateness = TickLateness(0.5)
    lateness.record_tick(2.0, 0.0)
    lateness.record_tick(LATE_THRESHOLD_S, CALM_PERIOD_S - 1.0)
    lateness.record_tick(0.0, CALM_PERIOD_S + 1.0)
    assert lateness.lookahead_s == 0.5 + QUEUE_DEPTH_STEPS_S[1]
