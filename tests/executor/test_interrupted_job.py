"""A program that breaks off is an interrupted job: noted beforehand, kept, and never begun anew unasked."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import pytest

from core.executor.commands import (
    ConfirmStart,
    CycleStart,
    FeedHold,
    JogByStep,
    PrepareCycleStart,
    ReportInterruptedJob,
    Reset,
    SetPartCount,
    SetSwitch,
)
from core.executor.snapshot import (
    CLOSED_REASON,
    ESTOP_REASON,
    POWER_LOST_REASON,
    RESET_REASON,
    MachineState,
    StartAction,
    convert_interrupted_job_to_json,
    parse_interrupted_job,
)
from tests.executor.lines import TOOLS, mdi, press
from tests.executor.rig import INCH, Rig
from tests.executor.test_restart import PART, broken_off, restart
from tests.interrupted import broken_off as made
from tests.texts import pattern, text

pytestmark = pytest.mark.long

CUT = -50.8 - 0.3 * INCH  # machine Z in the middle of line 8


def in_the_cut(rig: Rig) -> None:
    rig.start(PART, TOOLS)
    rig.until_true(lambda shot: shot.line == 8 and shot.actual[1] < CUT)


def begins(rig: Rig) -> bool:
    """Both palms now: whether something starts."""
    rig.run(0.4)
    rig.post(CycleStart())
    return rig.state is not MachineState.IDLE


# --- what interrupts ----------------------------------------------------------------------------------------


def test_estop_in_the_cut_records_line_tool_part_and_position() -> None:
    rig = Rig()
    rig.post(SetPartCount(11))
    broken_off(rig)
    rig.run(0.5)
    found = rig.shot.interrupted
    assert found is not None
    assert (found.program, found.line, found.tool, found.part, found.why) == ("PART", 8, 1, 12, ESTOP_REASON)
    assert found.axes == ("X", "Z", "C")
    assert found.where == pytest.approx(rig.shot.actual, abs=1e-3)  # not where the braking began
    assert found.job == rig.shot.job
    assert rig.said("interrupted") == [
        text("executor.interrupted-job", program="PART", line=8, tool="T1", part=12, why="E-STOP")
    ]


def test_recorded_position_is_where_the_tool_came_to_rest() -> None:
    rig = Rig()
    rig.start("G90G94F300\nT1\nX1Z.2\nM30\n", TOOLS)
    rig.until_true(lambda shot: shot.velocity > 100.0)
    seen = rig.shot.actual
    rig.sim.machine.press_estop()
    rig.run(1.0)
    found = rig.shot.interrupted
    assert found is not None
    assert max(abs(a - b) for a, b in zip(found.where, seen, strict=True)) > 1.0  # it braked over that
    assert found.where == pytest.approx(rig.shot.actual, abs=0.01)
    assert rig.notes[-1] == found


def test_second_reset_records_an_interrupted_job() -> None:
    rig = Rig()
    in_the_cut(rig)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    assert rig.shot.interrupted is None  # a hold goes on with Cycle Start
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert rig.shot.interrupted is not None
    assert (rig.shot.interrupted.line, rig.shot.interrupted.why) == (8, RESET_REASON)


def test_alarm_is_recorded_as_the_cause() -> None:
    rig = Rig()
    in_the_cut(rig)
    rig.sim.machine.jam("Z")
    rig.until(MachineState.FAULT)
    assert rig.shot.interrupted is not None
    assert rig.shot.interrupted.why == text(
        "executor.alarm-number", number=rig.shot.alarms[0].number, text=rig.shot.alarms[0].text
    )


def test_closing_turndesk_in_the_cut_records_an_interrupted_job() -> None:
    rig = Rig()
    in_the_cut(rig)
    rig.executor.shut_down()
    assert rig.shot.interrupted is not None
    assert (rig.shot.interrupted.line, rig.shot.interrupted.why) == (8, CLOSED_REASON)
    assert rig.notes[-1] == rig.shot.interrupted


def test_completed_program_clears_the_interrupted_job() -> None:
    rig = Rig()
    rig.start(PART, TOOLS)
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.shot.interrupted is None
    assert rig.notes[-1] is None
    assert begins(rig)


def test_mdi_line_is_not_an_interrupted_job() -> None:
    rig = Rig()
    rig.load(PART, TOOLS)
    rig.ready()
    press(rig, "G90G94F10X1Z1")
    rig.run(0.3)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    assert rig.shot.interrupted is None
    assert rig.notes == []


# --- the next start -----------------------------------------------------------------------------------------


def test_cycle_start_after_an_interrupted_job_needs_confirmation() -> None:
    rig = Rig()
    broken_off(rig)
    stood = rig.shot.demand
    for _ in range(3):
        assert not begins(rig)
        assert re.fullmatch(
            pattern("executor.interrupted-in-part", line=8, program="PART", tool="T1"),
            rig.shot.start_refusal_reason,
        )
    rig.run(2.0)
    assert rig.shot.demand == stood


def test_confirmed_start_applies_once_and_next_interruption_asks_again() -> None:
    rig = Rig()
    broken_off(rig)
    rig.confirm()
    assert rig.shot.confirmed
    assert begins(rig)
    rig.until_true(lambda shot: shot.line == 8)
    assert not rig.shot.confirmed
    assert [said for said in rig.said("cleared") if re.fullmatch(pattern("executor.begins-anew"), said)]
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert not begins(rig)


def test_confirmation_of_another_job_is_rejected() -> None:
    rig = Rig()
    broken_off(rig)
    rig.post(ConfirmStart("2020-01-01T00:00:00Z"))
    assert not rig.shot.confirmed
    assert rig.said("refused")[-1] == text("executor.no-interrupted-job")
    assert not begins(rig)


def test_confirmation_can_be_withdrawn() -> None:
    rig = Rig()
    broken_off(rig)
    rig.confirm()
    rig.post(ConfirmStart(""))
    assert not rig.shot.confirmed
    assert rig.said("refused") == []
    assert not begins(rig)


def test_confirmation_expires_after_a_minute() -> None:
    rig = Rig()
    broken_off(rig)
    rig.confirm()
    rig.run(61.0)
    assert not rig.shot.confirmed
    assert not begins(rig)


def test_jog_withdraws_the_confirmation() -> None:
    rig = Rig()
    broken_off(rig)
    rig.confirm()
    rig.post(JogByStep("X", 1.0, 5.0))
    rig.until(MachineState.IDLE)
    assert not rig.shot.confirmed
    assert not begins(rig)


def test_searchto_and_mdi_withdraw_the_confirmation() -> None:
    for starts in (StartAction.RESTART, StartAction.MDI_LINE):
        rig = Rig()
        broken_off(rig)
        rig.confirm()
        rig.post(PrepareCycleStart(starts))
        rig.post(PrepareCycleStart(StartAction.PROGRAM))
        assert not rig.shot.confirmed
        assert not begins(rig)


def test_confirmation_with_drives_off_is_ignored() -> None:
    rig = Rig()
    in_the_cut(rig)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.confirm()
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    rig.confirm()
    rig.ready()
    assert not begins(rig)


# --- what it outlives, and what ends it ---------------------------------------------------------------------


def test_interrupted_job_survives_reset_drives_off_mdi_and_jog() -> None:
    rig = Rig()
    broken_off(rig)
    rig.run(0.5)
    first = rig.shot.interrupted
    rig.post(Reset())
    mdi(rig, "G90", "G94F100X1.4")
    rig.post(JogByStep("Z", 2.0, 5.0))
    rig.until(MachineState.IDLE)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.sim.machine.release_estop()
    rig.until(MachineState.DISABLED)
    rig.ready()
    assert rig.shot.interrupted == first  # where it stood; where it stands now the readouts tell
    assert rig.shot.actual != first.where if first else False


def test_reloading_the_program_retains_the_job_and_another_clears_it() -> None:
    rig = Rig()
    broken_off(rig)
    rig.load(PART, TOOLS)
    assert rig.shot.interrupted_line == 8
    rig.load("G90G94F300\nX1\nM30\n", name="OTHER")
    assert rig.shot.interrupted is None
    assert rig.notes[-1] is None
    assert rig.said("cleared") == [
        text(
            "executor.loaded-in-place",
            job=text("executor.interrupted-job", program="PART", line=8, tool="T1", part=1, why="E-STOP"),
            program="OTHER",
        )
    ]
    assert begins(rig)


def test_completed_restart_clears_the_interrupted_job() -> None:
    rig = Rig()
    broken_off(rig)
    restart(rig, 8)
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.shot.interrupted is None
    assert rig.notes[-1] is None


def test_restart_interrupted_on_approach_retains_the_line() -> None:
    rig = Rig()
    broken_off(rig)
    first = rig.shot.interrupted
    assert first is not None
    restart(rig, 6)
    rig.until_true(lambda shot: shot.actual[0] > first.where[0] + 1.0)
    rig.sim.machine.press_estop()
    rig.until(MachineState.ESTOP)
    rig.run(0.5)
    again = rig.shot.interrupted
    assert again is not None
    assert (again.line, again.block, again.tool, again.begun) == (8, first.block, 1, first.begun)
    assert again.where[0] > first.where[0] + 1.0


def test_restart_interrupted_in_the_program_records_the_new_line() -> None:
    rig = Rig()
    broken_off(rig)
    restart(rig, 8)
    rig.until_true(lambda shot: shot.line == 10)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert rig.shot.interrupted_line == 10


# --- a power cut --------------------------------------------------------------------------------------------


def test_note_with_the_power_lost_reason_is_written_before_the_first_move() -> None:
    rig = Rig()
    rig.post(SetPartCount(11))
    rig.load(PART, TOOLS)
    rig.ready()
    rig.run(0.4)
    stood = rig.shot.demand
    rig.post(CycleStart())
    note = rig.notes[0]
    assert note is not None
    assert rig.shot.demand == stood
    assert (note.program, note.line, note.part, note.why) == ("PART", 1, 12, POWER_LOST_REASON)


def test_notes_record_tool_changes_at_once_and_lines_every_second() -> None:
    text = "G90G94F300\nT1\n" + "".join(f"X1Z{n % 2}.{n % 10}\n" for n in range(200)) + "T2\nX2Z2\nM30\n"
    rig = Rig()
    rig.start(text, TOOLS)
    began = rig.clock.now()
    rig.until_true(lambda shot: shot.modal.tool == 2)
    rig.run(0.05)
    note = rig.notes[-1]
    assert note is not None
    assert note.tool == 2
    assert len(rig.notes) <= rig.clock.now() - began + 4  # start, first block, and the tools
    assert len(rig.notes) >= 0.8 * (rig.clock.now() - began)


def test_note_after_a_hold_has_the_rest_position() -> None:
    rig = Rig()
    in_the_cut(rig)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.tick()
    note = rig.notes[-1]
    assert note is not None
    assert note.where == pytest.approx(rig.shot.actual, abs=0.05)


def test_job_interrupted_by_a_power_cut_needs_confirmation() -> None:
    before = Rig()
    in_the_cut(before)
    kept = (
        json.loads(json.dumps(convert_interrupted_job_to_json(before.notes[-1])))
        if before.notes[-1]
        else None
    )
    rig = Rig(left=parse_interrupted_job(kept))
    assert rig.shot.interrupted is not None
    assert rig.shot.interrupted.why == POWER_LOST_REASON
    rig.load(PART, TOOLS)
    rig.ready()
    assert rig.shot.interrupted_line in {6, 7, 8}
    assert not begins(rig)
    restart(rig, rig.shot.interrupted_line)
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1  # nothing was left out, so it is a part
    assert rig.shot.interrupted is None


def test_job_restored_late_also_needs_confirmation() -> None:
    """The store was away at the start."""
    rig = Rig()
    rig.load(PART, TOOLS)
    rig.ready()
    rig.post(ReportInterruptedJob(made()))
    rig.post(ReportInterruptedJob(made()))
    rig.run(0.1)
    assert rig.shot.interrupted == made()
    assert rig.said("interrupted") == [made().words]
    assert not begins(rig)


def test_job_already_in_the_log_is_not_logged_again() -> None:
    rig = Rig()
    rig.post(ReportInterruptedJob(made(), logged=True))
    assert rig.shot.interrupted == made()
    assert rig.said("interrupted") == []


def test_program_started_meanwhile_replaces_the_restored_job() -> None:
    rig = Rig()
    in_the_cut(rig)
    rig.post(ReportInterruptedJob(made()))
    rig.run(0.1)
    assert rig.shot.interrupted is None
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert rig.shot.interrupted is not None
    assert rig.shot.interrupted.program == "PART"


def test_interrupted_job_in_cycle_repeat_has_its_part_number() -> None:
    rig = Rig()
    rig.post(SetSwitch("cycle_repeat", True))
    rig.post(SetPartCount(3))
    rig.start(PART, TOOLS)
    rig.until_true(lambda shot: shot.parts == 1 and shot.line == 8)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    assert rig.shot.interrupted is not None
    assert rig.shot.interrupted.part == 5


@pytest.mark.parametrize(
    "change",
    [
        {"where": [1.0, "x", 0.0]},
        {"where": [1.0, 2.0]},
        {"where": [1.0, float("nan"), 0.0]},
        {"line": None},
        {"program": ""},
        {"axes": 3},
    ],
)
def test_invalid_stored_job_is_ignored(change: dict[str, object]) -> None:
    good = convert_interrupted_job_to_json(made())
    assert parse_interrupted_job(good) == made()
    assert parse_interrupted_job(good | change) is None
    assert parse_interrupted_job([good]) is None
    assert parse_interrupted_job(None) is None


def test_log_entry_identifies_the_interrupted_job() -> None:
    assert made().words == text(
        "executor.interrupted-job", program="PIN.NC", line=8, tool="T3", part=5, why="E-STOP"
    )
    assert replace(made(), line=9) == made(line=9)
