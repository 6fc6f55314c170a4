"""Time at feed by tool, and the bar that keeps the next part from beginning."""

from __future__ import annotations

import pytest

from core.executor.commands import (
    CycleStart,
    FeedHold,
    PrepareCycleStart,
    PreventNextPart,
    Reset,
    SetFeedOverride,
    SetSwitch,
)
from core.executor.snapshot import MachineState, StartAction
from core.interpreter.shared.job_setup import ToolOffset
from tests.executor.lines import mdi
from tests.executor.rig import Rig
from tests.texts import text

TOOLS = {1: ToolOffset(-12.7, -50.8), 2: ToolOffset(-12.7, -50.8)}
# .4 in at 12 in/min is 2 s with T1, .2 in at 6 in/min 2 s with T2; the rest is rapid.
PART = "G90G94F300G73\nT1\nG00X1Z.1\nG01G94F12Z-.3\nG00X1Z1\nT2\nG00X1Z.1\nG01F6Z-.1\nG00Z1\nM30\n"
SPENT = "T1: " + text("executor.life-gone", used="50 of 50 parts")


def cut(rig: Rig) -> list[float]:
    return [rig.shot.cutting.get(number, 0.0) for number in (1, 2)]


def test_feed_time_is_charged_to_the_cutting_tool() -> None:
    rig = Rig()
    rig.start(PART, TOOLS)
    rig.until(MachineState.IDLE)
    assert cut(rig) == pytest.approx([2.0, 2.0], abs=0.06)
    assert set(rig.shot.cutting) == {1, 2}


def test_slower_feed_adds_tool_time_and_hold_adds_none() -> None:
    rig = Rig()
    rig.start(PART, TOOLS)
    rig.post(SetFeedOverride(0.5))
    rig.until_true(lambda shot: shot.line == 4)
    rig.run(0.5)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    before = cut(rig)
    rig.run(5.0)
    assert cut(rig) == before
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert cut(rig) == pytest.approx([4.0, 4.0], abs=0.2)


def test_aborted_part_still_counts_tool_time() -> None:
    rig = Rig()
    rig.start(PART, TOOLS)
    rig.until_true(lambda shot: shot.line == 4)
    rig.run(1.0)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert cut(rig) == pytest.approx([1.0, 0.0], abs=0.1)


def test_dry_run_adds_no_tool_time() -> None:
    rig = Rig()
    rig.post(SetSwitch("no_count", True))
    rig.start(PART, TOOLS)
    rig.until(MachineState.IDLE)
    assert rig.shot.cutting == {}


def test_old_snapshot_retains_its_tool_times() -> None:
    """Whoever looks at an old one finds the old time."""
    rig = Rig()
    rig.start(PART, TOOLS)
    rig.until_true(lambda shot: 1 in shot.cutting)
    before, figure = rig.shot, rig.shot.cutting[1]
    rig.run(0.5)
    assert before.cutting[1] == figure < rig.shot.cutting[1]


def test_worn_tool_lets_the_current_part_finish_and_blocks_the_next() -> None:
    rig = Rig()
    rig.post(SetSwitch("cycle_repeat", True))
    rig.start(PART, TOOLS)
    rig.run(0.5)
    rig.post(PreventNextPart(SPENT))
    assert rig.state is MachineState.RUN
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.said("refused") == [text("executor.no-repeat", why=SPENT)]
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.state is MachineState.IDLE
    assert rig.shot.start_refusal_reason == SPENT


def test_new_insert_allows_the_next_part() -> None:
    rig = Rig()
    rig.ready()
    rig.load(PART, TOOLS)
    rig.post(PreventNextPart(SPENT))
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == SPENT
    rig.post(PreventNextPart(""))
    assert (rig.shot.start_refusal_reason, rig.shot.next_barred) == ("", "")
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.state is MachineState.RUN


def test_blocked_next_part_still_allows_resume_from_hold() -> None:
    """The part in the collet is to be finished."""
    rig = Rig()
    rig.start(PART, TOOLS)
    rig.run(0.5)
    rig.post(PreventNextPart(SPENT), FeedHold())
    rig.until(MachineState.HOLD)
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


def test_mdi_line_runs_while_the_next_part_is_blocked() -> None:
    rig = Rig()
    rig.ready()
    rig.post(PreventNextPart(SPENT))
    mdi(rig, "G90")
    assert rig.shot.lines == 1
    rig.post(PrepareCycleStart(StartAction.PROGRAM))


def test_missing_program_is_reported_before_the_blocked_next_part() -> None:
    """The cause told first is the one to be removed first."""
    rig = Rig()
    rig.post(PreventNextPart(SPENT))
    rig.ready()
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.no-program")


def test_repeated_next_part_block_is_reported_once() -> None:
    rig = Rig()
    rig.post(PreventNextPart(SPENT))
    rig.post(PreventNextPart(SPENT))
    rig.post(PreventNextPart(""))
    assert rig.said("switch") == [text("executor.no-other-part", why=SPENT), text("executor.parts-may-go-on")]


# --- the load of the spindle ------------------------------------------------------------------------------


def recorded(rig: Rig) -> Rig:
    """With somebody who takes what the driver samples, as the product has it."""
    rig.executor._tell = lambda _tick: None
    return rig


def loads(rig: Rig) -> list[float | None]:
    return [event.mean_load_percent for event in rig.events if event.kind in {"part", "uncounted"}]


def test_part_reports_the_mean_spindle_load_at_feed() -> None:
    """500 rpm need their share of 10 % for the bearings, and 30 % more in the cut."""
    rig = recorded(Rig())
    for _ in range(2):
        rig.start(PART.replace("G73\n", "G73\nM03S500\n"), TOOLS)
        rig.until(MachineState.IDLE)
    expected = 30.0 + 10.0 * 500.0 / rig.machine.spindle.max_rpm
    assert loads(rig) == [pytest.approx(expected, rel=0.1)] * 2
    assert rig.shot.spindle_load is not None


def test_mean_load_does_not_carry_over_to_the_next_part() -> None:
    rig = recorded(Rig())
    rig.start(PART.replace("G73\n", "G73\nM03S500\n"), TOOLS)
    rig.until(MachineState.IDLE)
    rig.start("G90G94F300\nG00X1\nM30\n", TOOLS)
    rig.until(MachineState.IDLE)
    assert loads(rig)[1] is None, "nothing was cut"


def test_machine_without_a_load_signal_reports_no_load() -> None:
    rig = Rig()  # nobody takes the samples
    rig.start(PART, TOOLS)
    rig.until(MachineState.IDLE)
    assert (loads(rig), rig.shot.spindle_load) == ([None], None)
