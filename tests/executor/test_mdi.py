"""A line of MDI runs like a line of a program, from the state that stands, and leaves its own behind."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.program_proving import create_proof
from core.executor.commands import CycleStart, FeedHold, PrepareCycleStart, Reset, SetSwitch
from core.executor.snapshot import MachineState, StartAction
from core.interpreter.shared.job_setup import ToolOffset
from core.proving.prove_program import prove
from tests.executor.lines import errors, line_job, mdi, press
from tests.executor.rig import INCH, Rig
from tests.texts import text


def test_modes_feed_and_tool_carry_over_between_mdi_lines() -> None:
    rig = Rig()
    mdi(rig, "G90G72", "T1", "X1Z.5F100", "X.5")
    # the tip of T1 stands on X0 Z0 at machine -12.7, -50.8; X.5 is a diameter
    assert rig.shot.actual[:2] == pytest.approx((-12.7 + 0.25 * INCH, -50.8 + 0.5 * INCH), abs=0.006)
    assert (rig.shot.modal.absolute, rig.shot.modal.diameter, rig.shot.modal.tool) == (True, True, 1)
    assert rig.shot.modal.feed == pytest.approx(100 * INCH / 60)
    assert rig.shot.parts == 0
    assert rig.shot.state is MachineState.IDLE


def test_spindle_stays_on_for_the_next_mdi_line() -> None:
    rig = Rig()
    mdi(rig, "M03S900")
    rig.run(2.0)
    assert rig.shot.rpm_actual == pytest.approx(900, rel=0.05)
    rig.post(PrepareCycleStart(StartAction.PROGRAM))  # MDI is left
    rig.run(1.0)
    assert rig.shot.rpm_command == 900
    mdi(rig, "G90", "G95F.005X.1")
    assert rig.shot.actual[0] == pytest.approx(0.1 * INCH, abs=0.006)
    mdi(rig, "M05")
    assert rig.shot.rpm_command == 0.0


def test_mdi_line_without_a_motion_block_changes_modes() -> None:
    rig = Rig()
    mdi(rig, "G71", "G91", "X5F500", "X5")
    assert rig.shot.actual[0] == pytest.approx(10.0, abs=0.006)
    assert rig.shot.modal.metric
    assert not rig.shot.modal.absolute


def test_first_mdi_move_after_a_tool_call_needs_both_axes() -> None:
    rig = Rig()
    mdi(rig, "G90F100", "T1")
    assert rig.shot.is_tool_move_pending
    (found,) = errors(rig, "X1")
    assert found.code == "tool-first-move"
    assert "Z" in found.message
    mdi(rig, "X1Z1")
    assert not rig.shot.is_tool_move_pending
    assert errors(rig, "X.9") == []


@pytest.mark.parametrize(
    ("line", "code", "named"),
    [
        ("X5F100", "soft-limit", "X"),
        ("X1", "feed-missing", ""),
        ("G95F.01X1", "spindle-stopped", ""),
        ("M03S9000", "speed-range", "3500 rpm"),
        ("M03", "speed-missing", "M03"),
        ("LS3", "not-alone-mdi", "LS"),
        ("M98P1", "not-alone-mdi", "M98"),
        ("P1", "not-alone-mdi", "P"),
        ("M99", "not-alone-mdi", "M99"),
        ("}1", "not-alone-mdi", "}"),
        ("G75I.1U.01", "not-alone-mdi", "G75"),
        ("G78U.01", "not-alone-mdi", "G78"),
        ("G41", "not-alone-mdi", "G41"),
        ("G40", "not-alone-mdi", "G40"),
        ("G35", "not-alone-mdi", "G92"),
        ("(~PLXC)", "not-alone-mdi", "(~PLXC)"),
        ("X1R.05F100", "not-alone-mdi", "R.05"),
        ("X1C.05F100", "corner-next", "C"),
        ("/X1", "not-alone-mdi", "/"),
        ("G2X1", "g-digits", "G2"),
        ("X1X2", "word-twice", "X"),
    ],
)
def test_invalid_mdi_line_is_rejected(line: str, code: str, named: str) -> None:
    rig = Rig()
    mdi(rig, "G90")
    found = errors(rig, line)
    assert any(each.code == code and named in each.message for each in found), found


def test_cycle_start_in_mdi_without_a_line_is_rejected() -> None:
    rig = Rig()
    rig.ready()
    rig.load("G90G94F300\nX1\nM30\n")
    rig.post(PrepareCycleStart(StartAction.MDI_LINE))
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.no-line")
    assert rig.state is MachineState.IDLE


def test_mdi_line_runs_once() -> None:
    rig = Rig()
    mdi(rig, "G91", "X.1F100")
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason.startswith(text("executor.no-line"))
    assert rig.shot.actual[0] == pytest.approx(0.1 * INCH, abs=0.006)


def test_mdi_line_proved_for_another_state_does_not_start() -> None:
    rig = Rig()
    mdi(rig, "G91", "X.1F100")
    old = line_job(rig, "X.1")
    proof = create_proof(old, prove(old.source, old.setup, rig.machine))
    mdi(rig, "Z-.1")
    rig.run(0.4)
    rig.post(PrepareCycleStart(StartAction.MDI_LINE, old, proof))
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.moved-since", remedy=text("executor.ask-again"))
    fresh = line_job(rig, "X.1")
    proof = create_proof(fresh, prove(fresh.source, fresh.setup, rig.machine))
    mdi(rig, "G90")
    rig.run(0.4)
    rig.post(PrepareCycleStart(StartAction.MDI_LINE, fresh, proof))
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.state-changed", remedy=text("executor.ask-again"))


def test_tool_without_an_offset_is_not_called() -> None:
    rig = Rig()
    mdi(rig, "G90")
    job = line_job(rig, "T9")
    rig.run(0.4)
    rig.post(
        PrepareCycleStart(
            StartAction.MDI_LINE, job, create_proof(job, prove(job.source, job.setup, rig.machine))
        )
    )
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.tool-offset-unset", tools="T9")


def test_hold_resume_and_reset_retain_the_modes() -> None:
    rig = Rig()
    mdi(rig, "G90G72", "M08")
    press(rig, "X1F10")
    rig.run(0.5)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.run(0.4)
    rig.post(CycleStart())
    rig.run(0.5)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    rig.tick()
    assert (rig.shot.modal.absolute, rig.shot.modal.diameter, rig.shot.modal.coolant) == (True, True, False)
    assert 0.0 < rig.shot.actual[0] < 0.5 * INCH
    assert text("executor.line-given-up") in rig.said("mdi")


def test_single_block_and_optional_stop_work_in_mdi() -> None:
    rig = Rig()
    mdi(rig, "G90G94F300")
    rig.post(SetSwitch("optional_stop", True))
    press(rig, "X.1M01")
    rig.until(MachineState.PROGRAM_STOP)
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    rig.post(SetSwitch("single_block", True))
    press(rig, "G81Z-.1F50")
    rig.until(MachineState.SINGLE_BLOCK_STOP)
    assert rig.shot.actual[1] == pytest.approx(-0.1 * INCH, abs=0.02)
    rig.run(0.4)
    rig.post(CycleStart())
    rig.until(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE)
    assert rig.shot.actual[1] == pytest.approx(0.0, abs=0.006)


def test_m30_in_mdi_resets_the_modes_and_counts_no_part() -> None:
    rig = Rig()
    rig.post(SetSwitch("cycle_repeat", True))
    mdi(rig, "G90G72F100", "M08", "T2", "M30")
    assert rig.shot.parts == 0
    assert (rig.shot.modal.absolute, rig.shot.modal.diameter, rig.shot.modal.feed) == (None, False, None)
    assert (rig.shot.modal.tool, rig.shot.modal.coolant) == (2, False)


def test_work_shift_and_preset_apply_to_the_next_mdi_line() -> None:
    rig = Rig()
    tools = {1: ToolOffset(-12.7, -50.8)}
    mdi(rig, "G90F100", "G10Z.1", "T1", "G92X1Z1")
    assert rig.shot.modal.shift_z == pytest.approx(0.1 * INCH)
    # the slides have not moved: machine 0 is now program X1 Z1
    assert rig.shot.offset == pytest.approx((-INCH, -INCH))
    assert line_job(rig, "X1", tools).setup.begin is not None
    mdi(rig, "X1Z.9")
    assert rig.shot.actual[1] == pytest.approx(-0.1 * INCH, abs=0.006)


def test_program_after_mdi_starts_at_its_first_line_with_its_own_modes() -> None:
    rig = Rig()
    mdi(rig, "G91G72F100", "X.2")
    rig.post(PrepareCycleStart(StartAction.PROGRAM))
    rig.start("G90G94F300\nX.3\nM30\n")
    rig.until(MachineState.IDLE)
    assert rig.shot.actual[0] == pytest.approx(0.3 * INCH, abs=0.006)  # a radius again
    assert rig.shot.parts == 1


@pytest.mark.parametrize("line", ["X.1F50", "G00Z1", "G92X0Z0"])
def test_mdi_move_before_g90_or_g91_is_rejected(line: str) -> None:
    rig = Rig()
    rig.ready()
    assert errors(rig, line)[0].code == "first-line"
    assert errors(rig, "M08") == []
    assert errors(rig, "T1") == []
    mdi(rig, "G91" + line if not line.startswith("G92") else "G90" + line)
    mdi(rig, "M30")
    assert errors(rig, line)


def test_running_live_tool_is_known_to_the_next_mdi_line() -> None:
    """It is switched by M2=3, and so stands beside no M code of the machine file."""
    rig = Rig(load_shipped_machine("sinumerik-live"))
    mdi(rig, "S2=900 M2=3", "G4 F0.1")
    assert rig.shot.modal.outputs == {"live"}
    mdi(rig, "M2=5", "G4 F0.1")
    assert rig.shot.modal.outputs == frozenset()
