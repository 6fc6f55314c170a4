"""What a start will start is announced before it; a spindle that waits turns for nothing else."""

from __future__ import annotations

import dataclasses
import re

import pytest

from app.compose.machine.machine_files import load_machine
from core.executor.commands import (
    CycleStart,
    FeedHold,
    ForceOutput,
    PrepareCycleStart,
    Reset,
    SetSpindleLimit,
    SupplyJobProof,
)
from core.executor.job import Proof
from core.executor.snapshot import MachineState, StartAction
from core.executor.start_conditions import MIN_READING_TIME_S
from tests.executor.rig import TICK, Rig
from tests.texts import pattern, text

CUT = "G90G94F300\nM03S1500\nG01F10Z-1\nM30\n"
WARNED = "LINE 3: RAPID-INTO-STOCK"
SAID = text("executor.spindle-starts", rpm=1500, direction="FORWARD")


def held(program: str = CUT) -> Rig:
    """In feed hold in the middle of a cut, at rest, the spindle turning."""
    rig = Rig()
    rig.start(program)
    rig.until_true(lambda shot: shot.actual[1] < -0.5)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    rig.run(0.5)
    assert abs(rig.shot.rpm_actual) == pytest.approx(1500.0)
    return rig


def switched_off(rig: Rig) -> None:
    rig.sim.machine.set_spindle_auto(False)
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)


def never_turns(rig: Rig, seconds: float = 3.0) -> None:
    until = rig.clock.now() + seconds
    while rig.clock.now() < until:
        rig.tick()
        assert rig.sim.machine.get_spindle_rpm() == 0.0
        assert rig.shot.rpm_command == 0.0


def test_spindle_switch_in_hold_starts_nothing_but_cycle_start_does() -> None:
    rig = held()
    switched_off(rig)
    assert rig.shot.announced == ()
    rig.sim.machine.set_spindle_auto(True)
    never_turns(rig)
    assert rig.state is MachineState.HOLD
    assert rig.shot.announced == (SAID,)
    rig.sim.machine.press_start()
    rig.until_true(lambda shot: shot.rpm_actual == pytest.approx(1500.0))
    assert rig.shot.announced == ()
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


@pytest.mark.parametrize(("code", "way"), [("M03", "FORWARD"), ("M04", "REVERSE")])
def test_spindle_announcement_states_the_direction(code: str, way: str) -> None:
    rig = held(CUT.replace("M03", code))
    switched_off(rig)
    rig.sim.machine.set_spindle_auto(True)
    rig.run(0.1)
    assert rig.shot.announced == (text("executor.spindle-starts", rpm=1500, direction=way),)


def test_cycle_start_before_the_announcement_is_readable_is_rejected() -> None:
    rig = held()
    switched_off(rig)
    rig.sim.machine.set_spindle_auto(True)
    rig.tick()
    rig.run(MIN_READING_TIME_S - 2 * TICK)
    rig.post(CycleStart())
    assert rig.state is MachineState.HOLD
    assert rig.shot.start_refusal_reason == text("executor.look-first", what=SAID)
    never_turns(rig, 1.0)
    rig.post(CycleStart())
    assert (rig.state, rig.shot.start_refusal_reason) == (MachineState.WAIT, "")


def test_cycle_start_and_spindle_switch_in_one_tick_start_nothing() -> None:
    rig = held()
    switched_off(rig)
    rig.sim.machine.set_spindle_auto(True)
    rig.post(CycleStart())
    assert rig.state is MachineState.HOLD
    assert rig.shot.start_refusal_reason
    never_turns(rig)


def test_raised_spindle_override_renews_the_announcement() -> None:
    rig = held()
    rig.sim.machine.set_spindle_pot(0.0)
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)
    rig.sim.machine.set_spindle_pot(0.1)
    never_turns(rig)
    assert rig.shot.announced == (text("executor.spindle-starts", rpm=150, direction="FORWARD"),)
    rig.sim.machine.set_spindle_pot(1.0)
    rig.until_true(lambda shot: shot.announced == (SAID,))
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.look-first", what=SAID)
    never_turns(rig, 1.0)


def test_spindle_stopped_by_zero_override_needs_cycle_start() -> None:
    rig = Rig()
    rig.start(CUT)
    rig.until_true(lambda shot: shot.actual[1] < -0.5)
    rig.sim.machine.set_spindle_pot(0.0)
    rig.until(MachineState.HOLD)
    assert rig.shot.waiting_for == text("executor.spindle-override-0")
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.spindle-override-0-refused")
    rig.sim.machine.set_spindle_pot(1.0)
    never_turns(rig)
    assert rig.shot.announced == (SAID,)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


def test_switch_turned_while_the_station_was_silent_starts_nothing() -> None:
    rig = held()
    switched_off(rig)
    rig.sim.machine.station_silent(True)
    rig.run(1.0)
    rig.sim.machine.set_spindle_auto(True)
    rig.run(1.0)
    rig.sim.machine.station_silent(False)
    never_turns(rig)


def test_spindle_that_stopped_unexpectedly_does_not_restart_automatically() -> None:
    rig = held()
    rig.sim.machine.spindle_bog(0.0)
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)
    rig.run(2.5)
    assert rig.shot.rpm_command == 0.0
    rig.sim.machine.spindle_bog(1.0)
    never_turns(rig)
    assert rig.shot.announced == (SAID,)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)


def test_spindle_does_not_restart_after_estop_in_a_cut() -> None:
    rig = held()
    rig.sim.machine.press_estop()
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)
    rig.sim.machine.release_estop()
    rig.sim.machine.set_spindle_auto(False)
    rig.run(1.0)
    rig.sim.machine.set_spindle_auto(True)
    never_turns(rig)
    assert rig.shot.announced == ()


def test_spindle_does_not_restart_after_reset() -> None:
    rig = held()
    switched_off(rig)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    rig.sim.machine.set_spindle_auto(True)
    never_turns(rig)
    assert rig.shot.announced == ()


def test_m05_passes_with_the_spindle_switch_off_and_a_cut_does_not() -> None:
    rig = Rig()
    rig.sim.machine.set_spindle_auto(False)
    rig.start("G90G94F300\nM03S1500\nM05\nG01F10Z-.1\nM30\n")
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


def test_turning_spindle_is_not_announced() -> None:
    rig = held()
    assert rig.shot.announced == ()
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)


def test_waiting_spindle_does_not_start_with_an_open_collet() -> None:
    rig = held()
    switched_off(rig)
    rig.sim.machine.collet_sensor_stuck()
    rig.sim.machine.set_input("collet_closed", False)
    rig.sim.machine.set_spindle_auto(True)
    rig.run(1.0)
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.collet-open")
    never_turns(rig)


def test_collet_opened_by_the_program_can_be_closed_after_a_reset() -> None:
    rig = Rig()
    rig.start("G90G94F300\nM03S600\nM13\nG04F5\nM12\nM30\n")
    rig.until_true(lambda shot: shot.waiting_for == "DWELL")
    switched_off(rig)
    rig.until(MachineState.HOLD)
    rig.sim.machine.set_spindle_auto(True)
    rig.run(1.0)
    stop = rig.shot.stop
    assert stop is not None
    assert stop.number == 223
    rig.post(CycleStart())
    assert rig.shot.start_refusal_reason == text("executor.collet-opened-by-program")
    never_turns(rig)
    rig.post(Reset())
    rig.until(MachineState.IDLE)
    rig.post(ForceOutput("collet", True))
    rig.run(1.0)
    rig.post(CycleStart())
    assert re.fullmatch(
        pattern("executor.interrupted-in-part", line=4, program="PART"), rig.shot.start_refusal_reason
    )  # the collet is no reason


# --- between programs: M03 in MDI, then the switch, as the manual has it


def left_turning() -> Rig:
    """M02 leaves the spindle turning."""
    rig = Rig()
    rig.start("G90G94F300\nM03S1500\nG04F1\nM02\n")
    rig.until_true(lambda shot: shot.ends == 1)
    rig.run(0.5)
    assert rig.state is MachineState.IDLE
    assert rig.shot.rpm_actual == pytest.approx(1500.0)
    return rig


def test_spindle_switch_stops_and_restarts_the_spindle_between_programs() -> None:
    rig = left_turning()
    switched_off(rig)
    assert rig.shot.announced == (text("executor.switch-to-auto", what=SAID),)
    rig.sim.machine.set_spindle_auto(True)
    rig.until_true(lambda shot: shot.rpm_actual == pytest.approx(1500.0))
    assert rig.shot.announced == ()


def test_flicker_of_the_spindle_switch_does_not_start_the_spindle() -> None:
    rig = left_turning()
    rig.sim.machine.set_spindle_auto(False)
    rig.run(0.1)
    rig.sim.machine.set_spindle_auto(True)
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)
    never_turns(rig)
    assert any(SAID in said for said in rig.said("refused"))


def test_raising_zero_override_between_programs_does_not_start_spindle() -> None:
    rig = left_turning()
    rig.sim.machine.set_spindle_pot(0.0)
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)
    rig.sim.machine.set_spindle_pot(1.0)
    never_turns(rig)
    switched_off(rig)
    rig.run(MIN_READING_TIME_S)
    rig.sim.machine.set_spindle_auto(True)
    rig.until_true(lambda shot: shot.rpm_actual == pytest.approx(1500.0))


def test_switch_turned_with_silent_station_starts_nothing_between_programs() -> None:
    rig = left_turning()
    switched_off(rig)
    rig.run(MIN_READING_TIME_S)
    rig.sim.machine.station_silent(True)
    rig.run(1.0)
    rig.sim.machine.set_spindle_auto(True)
    rig.run(1.0)
    rig.sim.machine.station_silent(False)
    never_turns(rig)


def test_switch_turned_after_a_stall_starts_nothing() -> None:
    rig = left_turning()
    switched_off(rig)
    rig.run(MIN_READING_TIME_S)
    rig.sim.machine.set_spindle_auto(True)
    rig.tick(0.5)
    never_turns(rig)


def test_switch_does_not_start_the_spindle_with_an_open_collet() -> None:
    rig = left_turning()
    switched_off(rig)
    rig.run(MIN_READING_TIME_S)
    rig.sim.machine.collet_sensor_stuck()
    rig.sim.machine.set_input("collet_closed", False)
    rig.sim.machine.set_spindle_auto(True)
    never_turns(rig)
    assert text("executor.collet-open") in rig.said("refused")


def test_a_limit_is_not_raised_under_a_spindle_that_turns() -> None:
    rig = Rig()
    rig.post(SetSpindleLimit(500.0))
    rig.start("G90G94F300\nM03S1500\nG04F60\nM30\n")
    rig.until_true(lambda shot: shot.rpm_actual == pytest.approx(500.0))
    rig.post(SetSpindleLimit(3000.0))
    rig.run(2.0)
    assert rig.shot.rpm_actual == pytest.approx(500.0)
    assert any(text("executor.limit-while-still") in said for said in rig.said("refused"))
    rig.post(SetSpindleLimit(300.0))
    rig.until_true(lambda shot: shot.rpm_actual == pytest.approx(300.0))


def guarded(program: str = CUT) -> Rig:
    """A lathe whose file says that its guard stops it; the guard is closed, the tool in the cut."""
    machine = load_machine()
    rig = Rig(
        machine=dataclasses.replace(
            machine, interlocks=dataclasses.replace(machine.interlocks, guard_stops=True)
        )
    )
    rig.sim.machine.set_input("guard", True)
    rig.start(program)
    rig.until_true(lambda shot: shot.actual[1] < -0.5)
    return rig


def test_open_guard_stops_feed_and_spindle_and_closing_starts_nothing() -> None:
    rig = guarded()
    rig.sim.machine.set_input("guard", False)
    rig.until(MachineState.HOLD)
    rig.until_true(lambda shot: shot.rpm_actual == 0.0)
    assert rig.shot.stop is not None
    assert (rig.shot.stop.code, rig.shot.stop.number) == ("guard-open", 604)
    rig.post(CycleStart())
    rig.run(0.1)
    assert rig.shot.start_refusal_reason == text("executor.guard-close")
    rig.sim.machine.set_input("guard", True)
    never_turns(rig)
    assert rig.state is MachineState.HOLD
    assert rig.shot.announced == (SAID,)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.parts == 1


def test_open_guard_lets_a_thread_finish_or_retract() -> None:
    rig = guarded("G90G94F300\nM03S600\nX.5Z.2\nG01F40Z.1\nG33X.48Z-.6I.01K.05O\nM30\n")
    rig.until_true(lambda shot: shot.line == 5 and shot.actual[1] < -5.0)
    rig.sim.machine.set_input("guard", False)
    rig.until(MachineState.HOLD, MachineState.FAULT)
    assert rig.shot.actual[0] > 0.48 * 25.4 + 0.05  # out of the thread


def test_start_is_rejected_with_open_guard_and_closing_it_starts_nothing() -> None:
    machine = load_machine()
    interlocks = dataclasses.replace(machine.interlocks, guard_stops=True)
    rig = Rig(machine=dataclasses.replace(machine, interlocks=interlocks))
    rig.sim.machine.set_input("guard", False)
    rig.start(CUT)
    rig.run(0.2)
    assert (rig.state, rig.shot.start_refusal_reason) == (MachineState.IDLE, text("executor.guard-close"))
    rig.sim.machine.set_input("guard", True)
    never_turns(rig, 1.0)
    assert rig.state is MachineState.IDLE


def test_start_refusal_is_cleared_with_its_cause() -> None:
    rig = guarded()
    rig.sim.machine.set_input("guard", False)
    rig.until(MachineState.HOLD)
    rig.post(CycleStart())
    rig.run(0.5)
    assert rig.shot.start_refusal_reason == text("executor.guard-close")
    rig.sim.machine.set_input("guard", True)
    rig.run(0.1)
    assert rig.shot.start_refusal_reason == ""


# --- what the proof has warned of ----------------------------------------------------------------------


def warned(*what: str) -> Rig:
    """A program is loaded, and its proof has warned of something."""
    rig = Rig()
    job = rig.load(CUT)
    rig.ready()
    rig.run(1.0)
    rig.post(SupplyJobProof(Proof(job.digest, (), warnings=what)))
    return rig


def test_warnings_are_announced_before_the_first_start() -> None:
    rig = warned(WARNED, "LINE 4: CUTS-AIR")
    said = text("executor.warning", what=text("executor.more-warnings", what=WARNED, count=1))
    rig.post(CycleStart())
    assert rig.state is MachineState.IDLE
    assert rig.shot.start_refusal_reason == text("executor.look-first", what=said)
    assert rig.shot.announced == (said,)
    rig.run(MIN_READING_TIME_S)
    rig.post(CycleStart())
    assert rig.state in {MachineState.RUN, MachineState.WAIT}
    assert rig.shot.announced == ()


def test_warnings_can_be_acknowledged_while_the_drives_are_off() -> None:
    rig = Rig()
    job = rig.load(CUT)
    rig.post(SupplyJobProof(Proof(job.digest, (), warnings=(WARNED,))))
    assert rig.state is MachineState.DISABLED
    assert rig.shot.announced == (text("executor.warning", what=WARNED),)
    rig.run(1.0)
    rig.ready()
    rig.post(CycleStart())
    assert rig.state in {MachineState.RUN, MachineState.WAIT}


def test_warnings_reappear_between_parts_without_blocking_the_next() -> None:
    rig = warned(WARNED)
    rig.run(MIN_READING_TIME_S)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    rig.run(MIN_READING_TIME_S + TICK)
    assert rig.shot.announced == (text("executor.warning", what=WARNED),)
    rig.post(CycleStart())
    assert rig.state in {MachineState.RUN, MachineState.WAIT}


def test_warnings_do_not_apply_to_mdi_or_another_program() -> None:
    rig = warned(WARNED)
    rig.post(PrepareCycleStart(StartAction.MDI_LINE))
    assert rig.shot.announced == ()
    rig.post(PrepareCycleStart(StartAction.PROGRAM))
    assert rig.shot.announced
    rig.load(CUT.replace("1500", "1200"))
    assert rig.shot.announced == ()


def test_resume_after_a_hold_does_not_repeat_the_warnings() -> None:
    rig = warned(WARNED)
    rig.run(MIN_READING_TIME_S)
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.actual[1] < -0.5)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    assert rig.shot.announced == ()
    rig.post(CycleStart())
    assert rig.state in {MachineState.RUN, MachineState.WAIT}
