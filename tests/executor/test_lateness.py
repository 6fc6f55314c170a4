"""How a busy computer deepens the setpoint queue, and what it says of a later hold."""

from __future__ import annotations

import pytest

from core.executor.snapshot import MachineState
from core.executor.tick_lateness import CALM_PERIOD_S, LATE_THRESHOLD_S, QUEUE_DEPTH_STEPS_S, TickLateness
from tests.executor.rig import Rig
from tests.texts import text


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


# --- in the executor --------------------------------------------------------------------------------------

CUT = "G90G94F300\nG01Z-3.F20\nM30\n"  # 9 s at 20 in/min = 8.467 mm/s; the machine file queues 1 s
SPEED_MM_S = 20 * 25.4 / 60


def travel_without_ticks(rig: Rig) -> float:
    """How far Z moves when the executor does not tick again, mm: the queue is played to its end."""
    before = rig.sim.machine.get_true_positions()[1]
    rig.clock.advance(10.0)
    return abs(float(rig.sim.machine.get_true_positions()[1] - before))


@pytest.fixture
def cutting() -> Rig:
    rig = Rig()
    rig.start(CUT)
    rig.until(MachineState.RUN)
    rig.run(2.0)
    return rig


def test_late_tick_deepens_the_queue_and_is_in_the_log_and_the_snapshot(cutting: Rig) -> None:
    cutting.tick(0.62)  # the executor pauses for 0.01 s, so this tick is 0.61 s late: more than half of 1 s
    assert cutting.shot.hold_delay_s == pytest.approx(0.7)
    assert cutting.said("late") == [text("executor.busy-computer", seconds="0.7")]
    cutting.run(0.1)
    assert cutting.state is MachineState.RUN
    # 1.5 s to 1.75 s are queued, and a tick of 0.02 s of them may be over
    assert 1.48 * SPEED_MM_S <= travel_without_ticks(cutting) <= 1.80 * SPEED_MM_S


def test_punctual_ticks_change_neither_queue_nor_snapshot(cutting: Rig) -> None:
    assert cutting.shot.hold_delay_s == 0.0
    assert cutting.said("late") == []
    assert 0.98 * SPEED_MM_S <= travel_without_ticks(cutting) <= 1.30 * SPEED_MM_S


def test_the_snapshot_shows_no_delay_after_a_calm_time(cutting: Rig) -> None:
    cutting.tick(0.62)
    cutting.run(1.0)
    assert cutting.shot.hold_delay_s == pytest.approx(0.7)
    cutting.run(CALM_PERIOD_S)
    assert cutting.shot.hold_delay_s == 0.0
    assert len(cutting.said("late")) == 1
