"""A spindle that its drive stops at an angle: nothing moves before it is held there."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.commands import CycleStart, FeedHold, Reset
from core.executor.job import Proof
from core.executor.snapshot import MachineState
from core.executor.start_conditions import describe_missing_function
from core.interpreter.dialects import interpret_program
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.machine_requirements import (
    SPINDLE_ORIENTATION,
    list_requirements,
    remove_repeated_requirements,
)
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.executor.rig import Rig
from tests.texts import pattern, text

MILL = load_shipped_machine("ac-table-mill")
ANGLE = 90.0
BACK = (
    "CYCL DEF 204 BACK BORING Q200=+2 Q249=+5 Q250=+20 Q251=+3.5 Q252=+15 Q253=+3000 Q254=+900 Q255=+0 "
    "Q203=+0 Q204=+2 Q214=+1 Q336=+90\nCYCL CALL\n"
)
PROGRAM = (
    "BEGIN PGM T MM\nTOOL CALL 1 Z S3000 F500\nL X+0 Y+0 Z+5 R0 FMAX M3\n" + BACK + "M30\nEND PGM T MM\n"
)
X, Z = 0, 2
LOW = -350.0 - 37.0  # Z0 lies at -350 without a preset; the tip 2 below the part, the edge 15 above it


def blocks_of(program: str = PROGRAM) -> list[Block]:
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    return list(interpret_program(ProgramSource("T.H", program), setup).generate_blocks())


def begun() -> Rig:
    rig = Rig(machine=MILL, made=blocks_of())
    rig.start("anything")
    return rig


def orienting() -> Rig:
    """The spindle turns to its angle, above the part."""
    rig = begun()
    rig.until_true(lambda shot: shot.waiting_for == text("executor.spindle-orient"))
    return rig


def angle(rig: Rig) -> float:
    return rig.sim.machine.spindle_turns() % 1.0 * 360.0


def held(rig: Rig) -> bool:
    return rig.sim.machine.get_spindle_rpm() == 0.0 and abs(angle(rig) - ANGLE) < 1e-6


def test_bar_moves_off_center_only_while_the_spindle_is_oriented() -> None:
    rig = begun()
    rig.until_true(lambda shot: shot.rpm_actual > 2000.0)
    rig.until_true(lambda shot: shot.waiting_for == text("executor.spindle-stop-wait"))
    waited: list[str] = []
    beside: list[bool] = []
    centre = rig.shot.actual[X]

    def watch(shot: object) -> None:
        waited.append(rig.shot.waiting_for)
        if rig.shot.actual[Z] < -351.0 and abs(rig.shot.actual[X] - centre) > 0.02:
            beside.append(held(rig))

    rig.watch.append(watch)
    rig.until(MachineState.IDLE)
    assert text("executor.spindle-orient") in waited
    assert len(beside) > 20
    assert all(beside)


@pytest.mark.parametrize("how", ["hold", "reset", "estop"])
def test_every_stop_ends_an_orientation_in_progress(how: str) -> None:
    rig = orienting()
    rig.until_true(lambda _: rig.sim.machine.get_spindle_rpm() != 0.0)
    at = rig.shot.actual
    if how == "estop":
        rig.sim.machine.press_estop()
        rig.run(0.1)
    else:
        rig.post(FeedHold() if how == "hold" else Reset())
    rig.run(0.1)
    turns = rig.sim.machine.spindle_turns()
    rig.run(2.0)
    assert rig.sim.machine.spindle_turns() == turns
    assert rig.shot.actual == pytest.approx(at, abs=0.01)
    assert rig.state in {MachineState.HOLD, MachineState.IDLE, MachineState.ESTOP}


def test_resume_after_hold_repeats_the_orientation_and_completes_the_part() -> None:
    rig = orienting()
    rig.post(FeedHold())
    rig.run(1.0)
    assert rig.state is MachineState.HOLD
    rig.post(CycleStart())
    rig.until_true(lambda shot: shot.actual[Z] < -352.0)
    assert held(rig)
    rig.until(MachineState.IDLE)
    assert rig.shot.alarms == ()


def test_hold_in_the_hole_leaves_the_spindle_oriented() -> None:
    rig = begun()
    rig.until_true(lambda shot: shot.actual[Z] < -360.0)
    rig.post(FeedHold())
    rig.run(1.0)
    assert (rig.state, held(rig)) == (MachineState.HOLD, True)
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.shot.alarms == ()


def test_orientation_timeout_raises_one_alarm_before_any_motion() -> None:
    rig = begun()
    rig.sim.machine.spindle_never_oriented()
    rig.until_true(lambda shot: shot.waiting_for == text("executor.spindle-orient"))
    at = rig.shot.actual
    took = rig.until(MachineState.FAULT)
    assert took == pytest.approx(MILL.spindle.timeout_s + 3.0 * 60.0 / MILL.spindle.orient_rpm, abs=3.0)
    assert [alarm.code for alarm in rig.shot.alarms] == ["spindle-orient"]
    assert rig.shot.actual == pytest.approx(at, abs=0.01)


def test_lost_orientation_stops_the_bar_in_the_hole() -> None:
    rig = begun()
    rig.until_true(lambda shot: shot.actual[Z] < -360.0)
    rig.sim.machine.spindle_never_oriented()
    rig.until(MachineState.FAULT, limit=1.0)
    assert [alarm.code for alarm in rig.shot.alarms] == ["spindle-orient"]
    rig.run(0.3)
    assert rig.shot.actual[Z] > LOW + 5.0


def test_spindle_switch_prevents_orientation() -> None:
    rig = begun()
    rig.until_true(lambda shot: shot.waiting_for == text("executor.spindle-stop-wait"))
    rig.sim.machine.set_spindle_auto(False)
    rig.run(3.0)
    turns = rig.sim.machine.spindle_turns()
    rig.run(10.0)
    assert rig.sim.machine.spindle_turns() == turns
    assert rig.shot.waiting_for == text("executor.spindle-switch-off")
    rig.sim.machine.set_spindle_auto(True)
    rig.until_true(lambda shot: shot.actual[Z] < -352.0)
    assert held(rig)


def test_spindle_is_not_oriented_with_an_open_chuck() -> None:
    lathe = load_shipped_machine("sinumerik-modulo")
    setup = create_power_up_setup(lathe, tool_offsets={}, secondary_offsets={})
    source = ProgramSource("T.MPF", "G4 F2\nSPOS=90\nG4 F1\nM30\n")
    rig = Rig(machine=lathe, made=list(interpret_program(source, setup).generate_blocks()))
    rig.start("anything")
    rig.until_true(lambda shot: shot.waiting_for == "DWELL")
    rig.sim.machine.collet_sensor_stuck()
    rig.sim.machine.set_input("collet_closed", False)
    rig.until(MachineState.FAULT, limit=4.0)
    assert [alarm.code for alarm in rig.shot.alarms] == ["collet-open"]
    rig.run(5.0)
    assert rig.shot.oriented is None
    assert rig.sim.machine.get_spindle_rpm() == 0.0


def test_driver_without_orientation_is_rejected_before_the_start() -> None:
    needs = remove_repeated_requirements(list_requirements(blocks_of()))
    assert SPINDLE_ORIENTATION in {need.required_function for need in needs}
    rig = Rig(machine=replace(MILL, spindle=replace(MILL.spindle, oriented=False)))
    context = rig.executor._context
    assert re.fullmatch(
        pattern("executor.no-orient"),
        describe_missing_function(context, Proof("x", (), required_functions=needs)),
    )
    able = Rig(machine=MILL).executor._context
    assert describe_missing_function(able, Proof("x", (), required_functions=needs)) == ""


def test_proof_includes_spindle_stop_and_longest_orientation_time() -> None:
    """M19 at 3000 rpm: down to the speed that counts as rest, .08 s of the drive, half a turn at 100 rpm."""
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    head = "BEGIN PGM T MM\nTOOL CALL 1 Z S3000 F500\nL Z+5 R0 FMAX M3\n"
    whole = head + "CYCL DEF 9.0 D\nCYCL DEF 9.1 D 5\n{}M30\nEND PGM T MM\n"
    with_it = prove(ProgramSource("T.H", whole.format("M19\n")), setup, MILL)
    without = prove(ProgramSource("T.H", whole.format("")), setup, MILL)
    down = 0.08 + (3000.0 - MILL.spindle.stop_below) / MILL.spindle.deceleration_rpm_s
    assert with_it.errors == ()
    assert with_it.program_times.cycle_time_s - without.program_times.cycle_time_s == pytest.approx(
        down + 0.08 + 0.3, abs=0.01
    )
