"""Every stop has its reason in the snapshot and in the log: who held, what stood still, where."""

from __future__ import annotations

import ast
from collections.abc import Callable
from pathlib import Path

import pytest

from core.alarms import CATALOG, AlarmReaction
from core.executor.commands import CycleStart, FeedHold, Jog, Reset, SetSwitch
from core.executor.raised_alarm import HOLD_CODES, find_hold_code
from core.executor.snapshot import MachineState
from core.ports import DriverError, MotionSegments
from tests.executor.rig import Rig
from tests.texts import text

CUT = "G90G94F300\nM03S1000\nX0Z0\nG01F20\nX.5Z-.5\nM00\nX0Z0\nM01\nM30\n"
ROOM = Path(__file__).parents[2] / "core" / "executor"


def cutting() -> Rig:
    rig = Rig()
    rig.start(CUT)
    rig.until_true(lambda shot: shot.velocity > 1.0 and not shot.rapid)
    return rig


def stop_of(rig: Rig) -> tuple[str, str]:
    assert rig.shot.stop is not None
    return rig.shot.stop.code, rig.shot.stop.cause


def test_hold_reports_its_source() -> None:
    rig = cutting()
    rig.post(FeedHold("Esc at the screen"))
    rig.until(MachineState.HOLD)
    assert stop_of(rig) == ("feed-hold", text("executor.asked-by", source="Esc at the screen"))
    assert rig.numbers("stop") == [702]
    rig.post(CycleStart())
    rig.until(MachineState.RUN, MachineState.WAIT)
    assert rig.shot.stop is None


def test_repeated_press_does_not_hold_a_cycle_started_since() -> None:
    rig = cutting()
    rig.post(FeedHold(press=7))
    rig.until(MachineState.HOLD)
    rig.post(CycleStart())
    rig.until(MachineState.RUN, MachineState.WAIT)
    rig.post(FeedHold(press=7))
    rig.run(0.3)
    assert rig.shot.state in {MachineState.RUN, MachineState.WAIT}
    assert rig.numbers("stop") == [702]
    rig.post(FeedHold(press=8))
    rig.until(MachineState.HOLD)


def test_presses_without_a_number_always_hold() -> None:
    rig = cutting()
    for _ in range(2):
        rig.post(FeedHold())
        rig.until(MachineState.HOLD)
        rig.run(0.5)  # longer than a bounce
        rig.post(CycleStart())
        rig.until(MachineState.RUN, MachineState.WAIT)
    assert rig.numbers("stop") == [702, 702]


def test_hold_by_the_station_reports_the_hold_button() -> None:
    rig = cutting()
    rig.sim.machine.press_hold()
    rig.until(MachineState.HOLD)
    rig.sim.machine.release_hold()
    assert stop_of(rig) == (
        "feed-hold",
        text("executor.asked-by", source="the feed hold button on the operator station"),
    )


def test_estop_has_a_stop_entry() -> None:
    rig = cutting()
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    assert stop_of(rig)[0] == "estop"
    assert rig.numbers("estop") == [701]
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    assert rig.shot.stop is None


def test_program_stops_and_single_block_stops_are_distinguished() -> None:
    rig = Rig()
    rig.post(SetSwitch("optional_stop", True))
    rig.start(CUT)
    rig.until(MachineState.PROGRAM_STOP)
    assert stop_of(rig)[0] == "program-stop"
    rig.post(SetSwitch("single_block", True))
    rig.post(CycleStart())
    rig.until(MachineState.SINGLE_BLOCK_STOP)
    assert stop_of(rig)[0] == "single-block"
    rig.post(SetSwitch("single_block", False))
    rig.run(0.5)
    rig.post(CycleStart())
    rig.until(MachineState.PROGRAM_STOP)
    assert stop_of(rig)[0] == "optional-stop"


def test_single_steps_share_one_log_line_and_are_all_shown() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start("G90G94F300\nX0Z0\nG01F20X.1\nX.2\nX.3\nX.4\nM30\n")
    lines = []
    for _ in range(4):
        rig.until(MachineState.SINGLE_BLOCK_STOP)
        assert rig.shot.stop is not None
        lines.append((rig.shot.stop.code, rig.shot.stop.line))
        rig.run(0.5)
        rig.post(CycleStart())
        rig.tick()
    assert [code for code, _ in lines] == ["single-block"] * 4
    assert len({line for _, line in lines}) == 4
    assert len(rig.said("stop")) == 1


def test_reset_that_ends_the_program_is_logged() -> None:
    rig = cutting()
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert rig.numbers("stop") == [702, 703]
    assert rig.shot.stop is None


def test_silent_station_causes_its_own_kind_of_hold() -> None:
    rig = cutting()
    rig.sim.machine.station_silent()
    rig.until(MachineState.HOLD)
    assert stop_of(rig)[0] == "station-silent"
    assert rig.shot.waiting_for == text("executor.station-silent")


@pytest.fixture
def too_late(monkeypatch: pytest.MonkeyPatch) -> Callable[[Rig, bool], None]:
    """Every setpoint comes too late, as on a computer that is busy with something else."""

    def refuse(_segments: MotionSegments) -> None:
        raise DriverError("setpoints start 349.4 ms too early to be changed any more; splice later", "late")

    def turn(rig: Rig, late: bool) -> None:
        if late:
            monkeypatch.setattr(rig.sim.ports.axes, "splice", refuse)
        else:
            monkeypatch.undo()

    return turn


def test_late_computer_in_a_cut_holds_and_the_part_is_completed(
    too_late: Callable[[Rig, bool], None],
) -> None:
    rig = cutting()
    too_late(rig, True)
    rig.until(MachineState.HOLD)
    assert stop_of(rig)[0] == "late"
    assert rig.shot.alarms == ()
    assert "349.4" not in rig.shot.waiting_for + stop_of(rig)[1]
    assert rig.shot.rpm_command == 1000.0
    too_late(rig, False)
    rig.run(0.5)
    rig.post(CycleStart())
    rig.until(MachineState.PROGRAM_STOP)
    assert rig.shot.demand[:2] == pytest.approx((0.5 * 25.4, -0.5 * 25.4))


def test_late_computer_within_a_tick_does_not_resume_automatically(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The queue runs dry between two looks of one tick: the slides rest, and only the palms go on."""
    rig = cutting()
    cycle = rig.executor._control.cycle
    assert cycle is not None
    step = cycle.advance_one_tick

    def late() -> None:
        monkeypatch.setattr(cycle, "advance_one_tick", step)
        rig.clock.advance(3.0)
        step()

    monkeypatch.setattr(cycle, "advance_one_tick", late)
    rig.tick()
    stood = rig.sim.machine.get_true_positions()
    rig.until(MachineState.HOLD, limit=0.1)
    rig.run(1.0)
    assert rig.state is MachineState.HOLD
    assert rig.sim.machine.get_true_positions() == pytest.approx(stood, abs=1e-4)
    rig.post(CycleStart())
    rig.until(MachineState.PROGRAM_STOP)
    assert rig.shot.demand[:2] == pytest.approx((0.5 * 25.4, -0.5 * 25.4))


def test_late_computer_before_the_first_move_also_holds(
    too_late: Callable[[Rig, bool], None],
) -> None:
    rig = Rig()
    too_late(rig, True)
    rig.start(CUT)
    stood = rig.shot.demand
    rig.until(MachineState.HOLD)
    assert stop_of(rig)[0] == "late"
    assert rig.shot.demand == stood
    too_late(rig, False)
    rig.run(0.5)
    rig.post(CycleStart())
    rig.until(MachineState.PROGRAM_STOP)


def test_a_late_computer_in_a_jog_ends_the_jog_and_is_in_the_log(
    too_late: Callable[[Rig, bool], None],
) -> None:
    rig = Rig()
    rig.ready()
    too_late(rig, True)
    rig.post(Jog("X", 5.0, 0.2))
    rig.run(1.0)
    assert rig.state is MachineState.IDLE
    assert rig.shot.alarms == ()
    assert rig.said("refused")[0] == text("executor.computer-late")


def test_hold_reason_without_a_catalog_entry_is_shown_as_text() -> None:
    assert find_hold_code("SOMETHING NEW", "") == ("held", "something new")
    assert find_hold_code("", "") == ("feed-hold", "")


def reasons() -> list[str]:
    """Every reason that the executor gives to a hold, and to a spindle that waits."""
    calls = [
        node
        for path in ROOM.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)
    ]
    given = [arg for call in calls if call.func.attr == "start_feed_hold" for arg in call.args]  # type: ignore[attr-defined]
    words = [part.value for arg in given for part in ast.walk(arg) if isinstance(part, ast.Constant)]
    return [word for word in words if isinstance(word, str) and word.isupper()]


def test_every_hold_reason_has_a_hold_code() -> None:
    found = reasons()
    assert len(found) >= 3
    assert [reason for reason in found if reason not in HOLD_CODES] == []


def test_number_of_hold_codes_equals_number_of_catalog_holds() -> None:
    holds = [entry for entry in CATALOG.values() if entry.reaction is AlarmReaction.HOLD]
    assert len(HOLD_CODES) == len(holds)
