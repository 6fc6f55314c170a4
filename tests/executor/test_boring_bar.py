"""Cycle 202 draws a boring bar out of its bore: never before the spindle stands, and not before a hand has
turned the edge where Q214 frees it.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.commands import CycleStart
from core.executor.snapshot import MachineState
from core.interpreter.dialects import interpret_program
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.prove_program import prove
from tests.executor.rig import Rig
from tests.texts import text

ORIENTED = load_shipped_machine("ac-table-mill")
MILL = replace(ORIENTED, spindle=replace(ORIENTED.spindle, oriented=False))  # whose spindle stops anywhere
PROGRAM = (
    "BEGIN PGM T MM\nTOOL CALL 1 Z S3000 F500\nL X+0 Y+0 Z+5 R0 FMAX M3\n"
    "CYCL DEF 202 BORING Q200=+2 Q201=-6 Q206=+300 Q211=+0 Q208=+300 Q203=+0 Q204=+2 Q214={} Q336=+0\n"
    "CYCL CALL\nL Z+5 FMAX\nM30\nEND PGM T MM\n"
)
X, Z = 0, 2
BOTTOM = -356.0  # mm from home: Z0 lies at -350 without a preset


def boring(direction: int) -> Rig:
    """The program begun, and played until the bar stands on the ground of its bore."""
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    blocks: list[Block] = list(
        interpret_program(ProgramSource("T.H", PROGRAM.format(direction)), setup).generate_blocks()
    )
    rig = Rig(machine=MILL, made=blocks)
    rig.start("anything")
    rig.until_true(lambda shot: shot.actual[Z] < BOTTOM + 0.01)
    return rig


@pytest.mark.parametrize("direction", [0, 1, 4])
def test_bar_moves_in_the_bore_only_while_the_spindle_is_stopped(direction: int) -> None:
    rig = boring(direction)
    assert abs(rig.shot.rpm_actual) > 2900.0
    waited, bore = set(), rig.shot.actual[X]

    def watch(shot: object, rig: Rig = rig) -> None:
        waited.add(rig.shot.waiting_for)
        still = abs(rig.shot.actual[Z] - BOTTOM) < 0.02 and abs(rig.shot.actual[X] - bore) < 0.02
        assert still or abs(rig.shot.rpm_actual) < MILL.spindle.stop_below

    rig.watch.append(watch)
    if direction:
        rig.until(MachineState.PROGRAM_STOP)
        assert rig.shot.rpm_actual == 0.0
        rig.run(0.4)
        rig.post(CycleStart())
    rig.until_true(lambda shot: shot.actual[Z] > BOTTOM + 5.0)
    assert text("executor.spindle-stop-wait") in waited


@pytest.mark.parametrize(
    ("direction", "message"),
    [
        (1, ("TURN THE CUTTING EDGE TOWARD X+")),
        (2, ("TURN THE CUTTING EDGE TOWARD Y+")),
        (3, ("TURN THE CUTTING EDGE TOWARD X-")),
    ],
)
def test_operator_message_states_the_required_edge_position(direction: int, message: str) -> None:
    rig = boring(direction)
    rig.until(MachineState.PROGRAM_STOP)
    assert rig.shot.message == message


def test_proof_includes_the_spindle_deceleration_time() -> None:
    """From 3000 rpm, at the deceleration of the machine file, down to the speed that counts as rest."""
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    whole = prove(ProgramSource("T.H", PROGRAM.format(0)), setup, MILL)
    without = PROGRAM.format(0).replace("CYCL DEF 202 BORING", "CYCL DEF 201 REAMING")
    reamed = prove(ProgramSource("T.H", without), setup, MILL)
    down = (3000.0 - MILL.spindle.stop_below) / MILL.spindle.deceleration_rpm_s
    assert whole.program_times.cycle_time_s - reamed.program_times.cycle_time_s >= down - 0.01
