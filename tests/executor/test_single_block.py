"""Single block: every block is one step, with way or without; every program there is, stepped to its end."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_machine, load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.stored_offsets import read_offsets_file
from core.executor.commands import CycleStart, FeedHold, SetSwitch
from core.executor.snapshot import MachineState
from core.interpreter.shared.job_setup import InterpreterSetup, SecondaryOffset, ToolOffset
from core.language.called_files import load_called_files
from core.language.source import ProgramSource, load_source
from core.machine.machine_model import Machine
from tests.executor.rig import INCH, Rig
from tests.executor.stepping import has_errors, stepped_through, steps_of
from tests.interpreter.restart.test_everything import golden_setup
from tests.worked import FOLDER

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[2]
SAMPLES = ROOT / "resources" / "programs"
LATHE = load_machine()
GOLDEN = sorted(
    path
    for path in (ROOT / "tests" / "programs").glob("*.nc")
    if "\nerror" not in "\n" + path.with_suffix(".expected").read_text("utf-8")
    # Of a contour in four ways of writing: both units, radius and diameter; the blocks are the same.
    and not path.stem.endswith(("_inch_rad", "_mm_dia"))
)
WORKED = sorted(FOLDER.glob("*.nc")) if FOLDER.is_dir() else [Path("absent")]
RADIUS = 0.015 * INCH  # of the tool nose in the worked examples
TOOLS = {number: ToolOffset() for number in range(1, 33)}


def check(source: ProgramSource, setup: InterpreterSetup, machine: Machine = LATHE) -> None:
    """Every block once, in order; then the place where the program ends, and one part."""
    rig, stops = stepped_through(source, setup, machine)
    assert rig.shot.alarms == ()
    assert (rig.state, rig.shot.parts) == (MachineState.IDLE, 1)
    assert stops == steps_of(rig.blocks)
    moves = [block for block in rig.blocks if block.moves]
    if moves:
        assert rig.shot.demand == pytest.approx(moves[-1].machine_end, abs=1e-6)


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.stem)
def test_golden_program_runs_to_its_end_in_single_block(path: Path) -> None:
    check(ProgramSource(path.stem, path.read_text("utf-8")), golden_setup(path))


@pytest.mark.parametrize("path", WORKED, ids=lambda path: path.stem)
def test_worked_example_runs_to_its_end_in_single_block(path: Path) -> None:
    if not path.exists():
        pytest.skip(f"the worked examples are not here: {FOLDER}")
    nose = {1: SecondaryOffset(-RADIUS, -RADIUS, RADIUS)}
    source, setup = (
        load_source(path),
        create_power_up_setup(LATHE, tool_offsets=TOOLS, secondary_offsets=nose),
    )
    if has_errors(source, setup):
        assert path.stem == "caxis-too-little-turn"
        return
    check(source, setup)


@pytest.mark.parametrize("name", ["pinbar", "bushing", "grooves", "knob", "pin"])
def test_sample_runs_to_its_end_in_single_block(name: str) -> None:
    tools, secondary, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    check(
        load_source(SAMPLES / f"{name}.nc"),
        create_power_up_setup(LATHE, tool_offsets=tools, secondary_offsets=secondary),
    )


@pytest.mark.parametrize(
    ("name", "machine"),
    [("roof.h", "ac-table-mill"), ("ring.mpf", "sinumerik-modulo"), ("ring.mpf", "sinumerik-linear")],
)
def test_sample_of_another_dialect_runs_to_its_end_in_single_block(name: str, machine: str) -> None:
    tools, secondary, *_ = read_offsets_file(SAMPLES / "offsets.toml")
    model = load_shipped_machine(machine)
    source = load_called_files(load_source(SAMPLES / name), [SAMPLES])
    check(source, create_power_up_setup(model, tool_offsets=tools, secondary_offsets=secondary), model)


# --- blocks that go nowhere


NOWHERE = "G90G94F300\nX.3Z.3\nX.3\nG00X.3\nG01X.4F10\nX.4\nZ.3\nM08\nX.4\nG00X.4\nM30\n"


def stops_of(rig: Rig, most: int = 40) -> list[int]:
    """Start after start: the line of each stop."""
    lines: list[int] = []
    while rig.state not in {MachineState.IDLE, MachineState.FAULT}:
        rig.until(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE, MachineState.FAULT, limit=20.0)
        if rig.state is MachineState.SINGLE_BLOCK_STOP:
            lines.append(rig.shot.line)
            assert len(lines) < most, lines
            rig.run(0.4)
            rig.post(CycleStart())
    return lines


def test_zero_length_blocks_are_single_block_steps() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start(NOWHERE)
    assert stops_of(rig) == [2, 3, 4, 5, 6, 7, 8, 9, 10]
    assert rig.shot.parts == 1


def test_program_of_zero_length_moves_can_be_single_stepped() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start("G90G94F300\nX0Z0\nX0\nG01Z0F10\nZ0\nM30\n")
    assert stops_of(rig) == [2, 3, 4, 5]


def test_zero_length_moves_are_shown_one_by_one_without_motion() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start("G90G94F300\nX.3Z.3\nX.3\nX.3\nX.3\nG01X.4F10\nM30\n")
    for line in (2, 3, 4, 5):
        rig.until(MachineState.SINGLE_BLOCK_STOP)
        assert rig.shot.line == line
        assert rig.shot.demand[:2] == pytest.approx((0.3 * INCH, 0.3 * INCH))
        rig.run(0.4)
        rig.post(CycleStart())


def test_a_hold_in_a_step_ends_at_the_end_of_its_block() -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start("G90G94F300\nG01X1F60\nX1\nX1.5\nM30\n")
    rig.run(0.4)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    assert rig.shot.line == 2
    rig.run(0.4)
    rig.post(CycleStart())
    assert stops_of(rig) == [2, 3, 4]


def test_final_zero_length_block_is_shown_without_single_block() -> None:
    """What is shown at the end of a stretch, and where a reset says it was, is the block that was done."""
    rig = Rig()
    rig.start("G90G94F300\nX.3Z.3\nX.3\nG04F5\nM30\n")
    rig.until_true(lambda shot: shot.waiting_for == "DWELL")
    assert rig.shot.line == 4
    assert rig.shot.block == 3


@pytest.mark.parametrize("off", range(9))
def test_single_block_is_switched_off_and_on_again_at_any_block(off: int) -> None:
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start(NOWHERE)
    for _ in range(off):
        rig.until(MachineState.SINGLE_BLOCK_STOP)
        rig.run(0.4)
        rig.post(CycleStart())
    rig.until(MachineState.SINGLE_BLOCK_STOP)
    rig.run(0.4)
    rig.post(SetSwitch("single_block", False), CycleStart(), SetSwitch("single_block", True))
    stops_of(rig)
    assert rig.shot.alarms == ()
    assert rig.shot.parts == 1
    assert rig.shot.demand[:2] == pytest.approx((0.4 * INCH, 0.3 * INCH), abs=1e-6)


@pytest.mark.parametrize("on", range(1, 18))
def test_single_block_switched_on_at_any_moment_stops_at_the_end_of_a_block(on: int) -> None:
    rig = Rig()
    rig.start("G90G94F300\nG01X.1F60\nX.1\nX.2\nX.2\nX.3\nZ.1\nZ.1\nM30\n")
    rig.run(0.06 * on)
    rig.post(SetSwitch("single_block", True))
    if rig.state is not MachineState.IDLE:
        stops_of(rig)
    assert rig.shot.alarms == ()
    assert rig.shot.demand[:2] == pytest.approx((0.3 * INCH, 0.1 * INCH), abs=1e-6)


def test_thread_waits_for_the_encoder_after_the_host_was_away() -> None:
    """Its encoder was not read meanwhile: that is waited for, and is no alarm."""
    rig = Rig()
    rig.post(SetSwitch("single_block", True))
    rig.start("G90G94F300\nM03S600\nX.5Z.1\nG33X.49Z-.2I.05K.05\nG00X1\nM30\n")
    while rig.state is not MachineState.IDLE:
        rig.until(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE, MachineState.FAULT)
        assert rig.state is not MachineState.FAULT, rig.shot.alarms
        rig.run(0.4)
        rig.tick(0.9)
        rig.post(CycleStart())
    assert rig.shot.parts == 1
