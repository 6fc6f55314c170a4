"""What Cycle Start refuses, with a reason and without any movement."""

from __future__ import annotations

import dataclasses
import re

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import (
    Command,
    ConfirmStart,
    CycleStart,
    EnableDrives,
    FeedHold,
    Jog,
    LoadJob,
    Reset,
    SetSpindleLimit,
    SupplyJobProof,
)
from core.executor.job import Proof, make_job
from core.executor.snapshot import STATE_TRANSITIONS, MachineState, TransitionError, require_transition
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.interpreter.shared.machine_requirements import THREADING, MachineRequirement
from core.language.source import Dialect, ProgramSource
from tests.executor.rig import Rig, unhomed_machine
from tests.texts import pattern, text

TEXT = "G90G94F300\nX1\nM30\n"


def nothing_moved(rig: Rig) -> bool:
    rig.run(1.0)
    return (
        rig.sim.machine.get_true_positions() == (0.0, 0.0, 0.0) and rig.sim.machine.get_spindle_rpm() == 0.0
    )


def refused(rig: Rig) -> str:
    rig.run(0.4)
    rig.post(CycleStart())
    assert rig.state not in {MachineState.RUN, MachineState.WAIT}
    assert rig.said("refused")[-1] == rig.shot.start_refusal_reason
    assert nothing_moved(rig)
    return rig.shot.start_refusal_reason


def test_start_without_a_program_is_rejected() -> None:
    rig = Rig()
    rig.ready()
    assert refused(rig) == text("executor.no-program")


def test_start_is_rejected_until_the_proof_arrives() -> None:
    rig = Rig()
    rig.ready()
    job = make_job(ProgramSource("PART", TEXT), rig.load(TEXT).setup)
    rig.post(LoadJob(job))
    assert rig.shot.needs_proof
    assert text("executor.not-proved") in refused(rig)
    rig.post(SupplyJobProof(Proof(job.digest, ())))
    assert not rig.shot.needs_proof
    rig.post(CycleStart())
    assert rig.state is MachineState.RUN


def test_start_with_a_proof_of_another_program_is_rejected() -> None:
    rig = Rig()
    rig.ready()
    job = rig.load(TEXT)
    other = make_job(ProgramSource("PART", TEXT.replace("X1", "X2")), job.setup)
    rig.post(LoadJob(other, Proof(job.digest, ())))
    assert text("executor.other-proof") in refused(rig)


def test_start_with_offsets_changed_since_the_proof_is_rejected() -> None:
    rig = Rig()
    rig.ready()
    job = rig.load(TEXT)
    other = make_job(job.source, dataclasses.replace(job.setup, block_delete=True))
    assert other.digest != job.digest
    rig.post(LoadJob(other, Proof(job.digest, ())))
    assert text("executor.other-proof") in refused(rig)


def test_start_with_errors_in_the_proof_is_rejected() -> None:
    rig = Rig()
    rig.ready()
    job = rig.load(TEXT)
    rig.post(SupplyJobProof(Proof(job.digest, ("line 2: no",))))
    assert refused(rig) == text("executor.program-errors", errors="line 2: no")


def test_start_with_an_unset_tool_is_rejected() -> None:
    rig = Rig()
    rig.ready()
    job = rig.load(TEXT)
    rig.post(SupplyJobProof(Proof(job.digest, (), tool_numbers=(3, 4))))
    assert refused(rig) == text("executor.tool-offset-unset", tools="T3, T4")


def test_tool_measured_by_the_program_needs_no_offset() -> None:
    rig = Rig()
    rig.ready()
    job = rig.load(TEXT)
    rig.post(SupplyJobProof(Proof(job.digest, (), tool_numbers=(3, 4), measured_tools=(4,))))
    assert refused(rig) == text("executor.tool-offset-unset", tools="T3")


def test_start_with_drives_off_is_rejected() -> None:
    rig = Rig()
    rig.load(TEXT)
    assert text("executor.drives-off") in refused(rig)


def test_start_is_rejected_in_estop_and_until_drives_are_enabled() -> None:
    rig = Rig()
    rig.ready()
    rig.load(TEXT)
    rig.sim.machine.press_estop()
    assert "E-stop" in refused(rig)
    rig.post(EnableDrives())
    assert rig.state is MachineState.ESTOP
    rig.sim.machine.release_estop()
    rig.run(0.5)
    assert rig.state is MachineState.DISABLED
    assert text("executor.drives-off") in refused(rig)
    rig.post(EnableDrives())
    rig.post(CycleStart())
    assert rig.state is MachineState.RUN


def test_start_with_an_alarm_is_rejected_until_reset() -> None:
    rig = Rig()
    rig.ready()
    rig.load(TEXT)
    rig.sim.machine.drive_fault("Z")
    rig.run(0.2)
    assert rig.state is MachineState.FAULT
    assert "alarm" in refused(rig)
    rig.post(EnableDrives())
    assert rig.state is MachineState.FAULT
    rig.post(Reset())
    assert rig.state is MachineState.DISABLED
    assert rig.shot.alarms == ()


def test_start_with_an_unhomed_axis_is_rejected() -> None:
    rig = Rig(unhomed_machine())
    rig.ready()
    rig.load(TEXT)
    assert refused(rig) == text("executor.not-homed", axes="Z")


def test_start_with_a_silent_station_is_rejected() -> None:
    rig = Rig()
    rig.ready()
    rig.load(TEXT)
    rig.sim.machine.station_silent()
    assert refused(rig) == text("executor.station-silent-refused")


def test_screen_start_is_rejected_on_a_real_machine() -> None:
    rig = Rig(dataclasses.replace(load_machine(), backend="canopen"))
    rig.ready()
    rig.load(TEXT)
    assert refused(rig) == text("executor.press-palms")
    rig.sim.machine.press_start()
    rig.tick()
    assert rig.state is MachineState.RUN


def test_two_starts_within_a_bounce_are_one_cycle() -> None:
    rig = Rig()
    rig.ready()
    rig.load("G90G94F300\nX.01\nM30\n")
    rig.run(0.4)
    rig.sim.machine.press_start()
    rig.run(0.12)
    rig.sim.machine.press_start()
    rig.run(1.0)
    assert rig.shot.parts == 1
    assert rig.said("start") == ["PART"]


def test_start_while_running_has_no_effect() -> None:
    rig = Rig()
    rig.start("G90G94F300\nX3\nX0\nM30\n")
    for _ in range(3):
        rig.run(0.35)
        rig.sim.machine.press_start()
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1
    assert rig.said("refused") == []


def test_loading_another_program_during_a_cycle_is_rejected() -> None:
    rig = Rig()
    rig.start("G90G94F300\nX3\nM00\nM30\n")
    digest = rig.shot.program
    rig.load("G90G94F300\nX-3\nM30\n")
    assert text("executor.program-keeps-others-out") in rig.said("refused")[-1]
    rig.until(MachineState.PROGRAM_STOP)
    rig.load("G90G94F300\nX-3\nM30\n")
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[0] == pytest.approx(3 * 25.4)
    assert rig.shot.program == digest


@pytest.mark.parametrize("state", [MachineState.ESTOP, MachineState.DISABLED, MachineState.FAULT])
@pytest.mark.parametrize("command", [CycleStart(), SetSpindleLimit(1000.0)])
def test_commands_in_stopped_states_move_nothing(state: MachineState, command: Command) -> None:
    rig = Rig()
    rig.load(TEXT)
    if state is MachineState.ESTOP:
        rig.sim.machine.press_estop()
    if state is MachineState.FAULT:
        rig.sim.machine.drive_fault("X")
    rig.run(0.4)
    assert rig.state is state
    rig.post(command)
    assert rig.state is state
    assert nothing_moved(rig)


@pytest.mark.parametrize("rpm", [-1.0, 0.0, 3501.0])
def test_a_spindle_limit_out_of_range_is_refused(rpm: float) -> None:
    rig = Rig()
    rig.post(SetSpindleLimit(rpm))
    assert text("executor.spindle-limit-range", rpm=f"{rpm:g}", limit=3500) in rig.said("refused")[0]
    rig.start("G90G94F300\nM03S3000\nG04F1\nM30\n")
    rig.run(0.5)
    assert rig.shot.rpm_command == 3000


def test_spindle_limit_applies_until_it_is_removed() -> None:
    rig = Rig()
    rig.post(SetSpindleLimit(1200.0))
    rig.start("G90G94F300\nM03S3000\nG04F3\nM05\nG04F3\nM03S3000\nG04F9\nM30\n")
    rig.run(3.0)
    assert rig.shot.rpm_actual == 1200
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)
    rig.post(SetSpindleLimit(None))
    rig.until_true(lambda shot: shot.rpm_actual == 3000)


@pytest.mark.parametrize("command", [CycleStart(), Jog("X", 10.0, 0.2)])
def test_late_press_after_a_host_stall_moves_nothing(command: Command) -> None:
    rig = Rig()
    rig.ready()
    rig.load(TEXT)
    rig.executor.post(command)
    rig.clock.advance(2.0)
    rig.tick()
    assert rig.state is MachineState.IDLE
    assert text("executor.came-too-late", command=type(command).__name__) in rig.said("refused")[-1]
    assert nothing_moved(rig)


def test_late_feed_hold_is_always_accepted() -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01F5Z-5\nM30\n")
    rig.executor.post(FeedHold())
    rig.clock.advance(0.8)
    rig.tick()
    assert rig.state is MachineState.STOPPING


ALLOWED = sorted((old, new) for old, after in STATE_TRANSITIONS.items() for new in after)
FORBIDDEN = sorted(
    (old, new) for old in MachineState for new in MachineState if new not in STATE_TRANSITIONS[old]
)


@pytest.mark.parametrize(("old", "new"), ALLOWED)
def test_allowed_transitions_are_accepted(old: MachineState, new: MachineState) -> None:
    require_transition(old, new)


@pytest.mark.parametrize(("old", "new"), FORBIDDEN)
def test_forbidden_transitions_raise_an_error(old: MachineState, new: MachineState) -> None:
    with pytest.raises(TransitionError, match=f"{old.value} .* {new.value}$"):
        require_transition(old, new)


def test_stopped_states_have_no_transition_to_motion() -> None:
    moving = {
        MachineState.RUN,
        MachineState.WAIT,
        MachineState.STOPPING,
        MachineState.JOG,
        MachineState.HOMING,
    }
    for dead in (MachineState.ESTOP, MachineState.DISABLED, MachineState.FAULT):
        assert not STATE_TRANSITIONS[dead] & moving
    assert STATE_TRANSITIONS[MachineState.ESTOP] == {MachineState.DISABLED}


def test_forbidden_internal_transition_raises_an_alarm(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = Rig()
    rig.start("G90G94F300\nX3\nM30\n")
    rig.run(0.3)
    monkeypatch.setitem(STATE_TRANSITIONS, MachineState.RUN, frozenset())
    rig.until(MachineState.FAULT)
    assert rig.shot.alarms[0].code == "internal"
    rig.run(0.5)
    assert not rig.sim.ports.axes.sample().enabled


def test_start_of_a_thread_without_an_encoder_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = Rig()
    rig.ready()
    program = "G90G94F300\nT1\nM03S500\nX.5Z.2\nG33X.45Z-.5K.05\nM30\n"
    job = make_job(
        ProgramSource("thread.nc", program), InterpreterSetup(tools={1: ToolOffset(0.0, 0.0, 0.0)})
    )
    monkeypatch.setattr(rig.sim.ports.spindle, "read_angle", lambda: None)
    rig.post(
        LoadJob(
            job,
            Proof(job.digest, (), tool_numbers=(1,), required_functions=(MachineRequirement(THREADING, 5),)),
        )
    )
    assert refused(rig) == text("executor.thread-no-encoder", line=5)


def test_unassigned_m_function_refusal_shows_the_machine_file_lines() -> None:
    rig = Rig()
    rig.ready()
    job = make_job(ProgramSource("part.mpf", "M80\nG0 X30\nM30\n", Dialect.SINUMERIK), InterpreterSetup())
    rig.post(LoadJob(job, Proof(job.digest, (), required_functions=(MachineRequirement("M80", 1),))))
    said = refused(rig)
    assert re.match(pattern("executor.no-m-code", line=1, code="M80"), said)
    for written in ("80 = { output =", "80 = { ignored = true }", "[m_codes]"):
        assert written in said


def slapped(rig: Rig, seconds: float) -> None:
    """Both palms come down so long after what the hands have just done."""
    rig.run(seconds)
    rig.sim.machine.press_start()
    rig.run(0.1)


@pytest.mark.parametrize(("seconds", "starts"), [(0.0, False), (0.3, False), (0.7, False), (0.9, True)])
def test_confirmation_and_two_hand_start_together_start_nothing(seconds: float, starts: bool) -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S900\nG01X.5Z.5F5\nM30\n")
    rig.run(3.0)
    rig.sim.machine.press_estop()
    rig.run(0.1)
    rig.sim.machine.release_estop()
    rig.run(0.1)
    rig.ready()
    rig.run(2.0)
    assert rig.shot.interrupted is not None
    rig.post(ConfirmStart(rig.shot.interrupted.at))
    slapped(rig, seconds)
    assert (rig.state is not MachineState.IDLE) is starts
    assert bool(rig.shot.start_refusal_reason) is not starts


@pytest.mark.parametrize(("seconds", "starts"), [(0.0, False), (0.7, False), (0.9, True)])
def test_confirmation_and_single_start_button_together_start_nothing(seconds: float, starts: bool) -> None:
    machine = load_machine()
    rig = Rig(
        machine=dataclasses.replace(
            machine, interlocks=dataclasses.replace(machine.interlocks, two_hand_start=False)
        )
    )
    rig.start("G90G94F300\nM03S900\nG01X.5Z.5F5\nM30\n")
    rig.run(3.0)
    rig.post(FeedHold())
    rig.run(2.0)
    rig.post(Reset())
    rig.run(3.0)
    assert rig.shot.interrupted is not None
    rig.post(ConfirmStart(rig.shot.interrupted.at))
    rig.run(seconds)
    rig.post(CycleStart())
    assert (rig.state is not MachineState.IDLE) is starts
