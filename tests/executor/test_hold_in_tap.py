"""Feed hold and single block in a tap: it comes out of its hole first, for the spindle turns on in it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.commands import CycleStart, FeedHold, Reset, SetSwitch
from core.executor.snapshot import MachineState
from core.interpreter.dialects import interpret_program
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from tests.executor.rig import Rig
from tests.texts import text

MILL = load_shipped_machine("ac-table-mill")
Z = [axis.name for axis in MILL.axes].index("Z")
ZERO = -350.0  # mm, where Z0 of the program lies in the machine without a preset
CLEAR = 2.0  # mm above it
HEAD = "BEGIN PGM T MM\nTOOL CALL 1 Z S600 F500\nL X+0 Y+0 Z+5 R0 FMAX M3\n"
TAIL = "\nCYCL CALL\nL Z+5 FMAX\nM30\nEND PGM T MM\n"
RIGID = "CYCL DEF 207 TAPPING Q200=+2 Q201=-10 Q239=+1.5 Q203=+0"
CHIPS = "CYCL DEF 209 TAPPING Q200=+2 Q201=-10 Q239=+1.5 Q203=+0 Q257=+4 Q256=+1"
FLOATING = "CYCL DEF 206 TAPPING Q200=+2 Q201=-10 Q206=+900 Q211=+1 Q203=+0"
OLD = (
    "CYCL DEF 17.0 TAPPING\nCYCL DEF 17.1 SET UP2\nCYCL DEF 17.2 DEPTH-10\nCYCL DEF 17.3 PITCH+1.5\n"
    "L Z+2 FMAX M99"
)


def tapping(cycle: str) -> Rig:
    """The program begun, from where the machine stands."""
    text = HEAD + cycle + (TAIL if "M99" not in cycle else TAIL.replace("\nCYCL CALL", ""))
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    blocks: list[Block] = list(interpret_program(ProgramSource("T.H", text), setup).generate_blocks())
    rig = Rig(machine=MILL, made=blocks)
    rig.start("anything")
    return rig


def deep(rig: Rig, z: float) -> None:
    """Until the tap is below this, on its way in."""
    rig.until_true(lambda _: height(rig) < z)


def height(rig: Rig) -> float:
    """Where the tip is above Z0, mm."""
    return rig.shot.actual[Z] - ZERO


@pytest.mark.parametrize("cycle", [RIGID, CHIPS, FLOATING, OLD])
@pytest.mark.parametrize("z", [1.0, -3.0, -9.5])
def test_a_hold_waits_until_the_tap_is_out(cycle: str, z: float) -> None:
    rig = tapping(cycle)
    deep(rig, z)
    rig.post(FeedHold())
    assert rig.shot.waiting_for == text("executor.hold-after-tap")
    rig.until(MachineState.HOLD)
    assert height(rig) >= CLEAR - 0.01
    rig.post(CycleStart())
    rig.until(MachineState.IDLE)
    assert rig.said("alarm") == []


@pytest.mark.parametrize("cycle", [RIGID, CHIPS, FLOATING, OLD])
def test_single_block_stops_nowhere_in_the_hole(cycle: str) -> None:
    rig = tapping(cycle)
    rig.post(SetSwitch("single_block", True))
    stops: list[float] = []
    for _ in range(40):
        rig.until(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE)
        if rig.state is MachineState.IDLE:
            break
        stops.append(height(rig))
        rig.run(0.5)
        rig.post(CycleStart())
    assert rig.state is MachineState.IDLE
    assert min(stops) >= CLEAR - 0.01
    assert len(stops) >= 3


def test_second_hold_press_has_no_effect() -> None:
    rig = tapping(RIGID)
    deep(rig, -3.0)
    rig.post(FeedHold())
    rig.run(0.1)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    assert height(rig) >= CLEAR - 0.01
    assert rig.numbers("stop") == [702]


def test_hold_before_the_tap_acts_immediately() -> None:
    rig = tapping(RIGID)
    rig.run(0.05)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD, limit=1.0)
    assert height(rig) > CLEAR


def test_reset_and_estop_do_not_wait_for_the_tap() -> None:
    presses: tuple[Callable[[Rig], None], ...] = (
        lambda rig: rig.post(Reset()),
        lambda rig: rig.sim.machine.press_estop(),
    )
    for press in presses:
        rig = tapping(RIGID)
        deep(rig, -3.0)
        rig.post(FeedHold())
        press(rig)
        rig.until_true(lambda shot: shot.velocity < 0.01, limit=1.0)
        assert height(rig) < 0.0


def test_a_tap_that_loses_its_spindle_stops_in_the_hole() -> None:
    """Fed on into a hole by a spindle that stands, it would be pushed through."""
    rig = tapping(RIGID)
    deep(rig, -3.0)
    rig.post(FeedHold())
    rig.sim.machine.set_spindle_auto(False)
    rig.until(MachineState.HOLD)
    assert height(rig) < 0.0


LATHE = load_shipped_machine("sinumerik-live")
COMPENSATING = "S600 M3 G95 F.1 G17\nG0 X0 Z5\nCYCLE840(5,0,2,-10,,0,0,5,0,,1.5)\nG0 Z5\nM30\n"


@pytest.mark.parametrize("feeds", ["G95 F.1", "G94 F100"])
def test_hold_with_a_compensating_chuck_waits_until_the_tap_is_out(feeds: str) -> None:
    setup = replace(
        create_power_up_setup(LATHE, tool_offsets={}, secondary_offsets={}), start=(0.0, 0.0, 0.0)
    )
    made = interpret_program(ProgramSource("T.MPF", COMPENSATING.replace("G95 F.1", feeds)), setup)
    blocks = list(made.generate_blocks())
    taps = [block for block in blocks if block.follows_spindle]
    assert [(b.z, b.in_hole) for b in taps] == [(-10.0, True), (2.0, False)]
    rig = Rig(machine=LATHE, made=blocks)
    rig.start("anything")
    z = [axis.name for axis in LATHE.axes].index("Z")
    rig.until_true(lambda shot: shot.block_text.startswith("CYCLE840") and shot.actual[z] < -3.0)
    rig.post(SetSwitch("single_block", True), FeedHold())
    rig.until(MachineState.HOLD)
    assert rig.shot.actual[z] >= CLEAR - 0.01
