"""The first move of a start against the part as it is: through a wall, out of a bore, from a usual place."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.job import Job, make_job, start_program_pass
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.source import ProgramSource
from core.part.stock import Clamping, make_bar_stock
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.part_history import PartHistory, StepCollector
from core.proving.program_tools import PartSettings
from core.proving.prove_program import prove
from core.proving.start_check import CollisionBody, FirstMove, IterStartBlocks, StartCheck, StartState

INCH = 25.4
TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.0, insert="DCMT11T304")
BORING = ToolShape(ToolKind.BORING, tip=2, diameter=8.0, stick_out=40.0)
DRILL = ToolShape(ToolKind.DRILL, tip=7, diameter=12.7, stick_out=60.0)
SETTING = PartSettings(make_bar_stock(1.5 * INCH, 0.0, -2.0 * INCH), {1: TURNING, 2: BORING, 3: DRILL})
TOOLS = {1: ToolOffset(-12.7, -50.8), 2: ToolOffset(-25.4, -63.5), 3: ToolOffset(-38.1, -76.2)}

# A drill of Ø.5 goes 1 in deep, a boring bar opens the bore to Ø.8; then the outside is turned to Ø1.2.
BORE = (
    "G90G94F300G73\nT1\nX.9Z-.3\nX.9Z.2\nT3\nX0Z.2\nM03S900\nG95F.005Z-1\nG94F300Z.2\n"
    "T2\nX.3Z.2\nG95F.003Z-.8\nX.28\nG94F300Z.2\nX.4\nG95F.003Z-.8\nX.38\nG94F300Z.2\n"
    "T1\nX.6Z.2\nG95F.004Z-.5\nX.8\nG94F300Z.2\nX2Z2\nM30\n"
)
IN_THE_BORE = (2, 0.4, -0.5)  # T, X (radius) and Z of its tip in the part, inches, in line 16
DEEPER = 16


def job_of(text: str) -> Job:
    return make_job(
        ProgramSource("PART", text),
        create_power_up_setup(load_machine(None), tool_offsets=TOOLS, secondary_offsets={}),
    )


def passes(job: Job) -> IterStartBlocks:
    def blocks(at: tuple[float, ...]) -> Iterable[Block]:
        return start_program_pass(job, replace(job.setup, start=at)).block_iterator

    return blocks


def check_of(job: Job, setting: PartSettings = SETTING) -> StartCheck:
    gathered = StepCollector(setting)
    prove(job.source, job.setup, load_machine(None), on_span=gathered.add_span)
    moves = gathered.make_program_steps()
    assert moves is not None
    return StartCheck(PartHistory(moves), dict(TOOLS), is_stock_specified=setting.stock is not None)


def axes(tool: int, x: float, z: float) -> tuple[float, float]:
    """Return machine X and Z with the tip of a tool there in the part, given in inches."""
    return TOOLS[tool].x + x * INCH, TOOLS[tool].z + z * INCH


def block_in(job: Job, line: int) -> int:
    return next(
        block.n for block in job.shared_program.start_pass(job.setup).generate_blocks() if block.line == line
    )


def interrupted(
    job: Job, place: tuple[int, float, float] = IN_THE_BORE, line: int = DEEPER, *, jogged: float = 0.0
) -> StartState:
    """Return the machine after an E-stop in a line, jogged in Z+ by so many inches since."""
    tool, x, z = place
    where = axes(tool, x, z)
    now = axes(tool, x, z + jogged)
    return StartState((*now, 0.0), tool, (block_in(job, line), where))


def line_of(text: str, at: tuple[float, ...], tool: int) -> Job:
    """Return a line of MDI from these axis positions."""
    offset = TOOLS[tool]
    modal = ModalState(tool=tool, tool_offset_x=offset.x, tool_offset_z=offset.z, rapid_rate=100.0, rpm=900.0)
    setup = create_power_up_setup(load_machine(None), tool_offsets=TOOLS, secondary_offsets={})
    begin = PassStart(Checkpoint(modal), is_mdi_line=True)
    return make_job(ProgramSource("MDI", text), replace(setup, start=at, begin=begin))


def met(found: FirstMove) -> tuple[CollisionBody | None, int, bool]:
    return found.hit_body, found.tool_number, found.is_inside_at_start


def test_start_at_line_1_from_inside_bore_hits_bore_wall() -> None:
    job = job_of(BORE)
    found = check_of(job).check_start(passes(job), interrupted(job))
    assert met(found) == (CollisionBody.PART, 2, False)
    assert not found.has_assumed_data
    assert found.safe_jog_direction == "Z+"
    assert [leg[:2] for leg in found.path] == [
        pytest.approx(axes(*IN_THE_BORE)),
        pytest.approx(axes(1, 0.9, -0.3)),
    ]


@pytest.mark.parametrize(
    ("place", "line", "jogged", "inside"),
    [
        (IN_THE_BORE, DEEPER, 0.0, True),
        (IN_THE_BORE, DEEPER, 0.2, True),
        (IN_THE_BORE, DEEPER, 0.3, False),  # before the face, which the first line cut
        ((1, 0.6, -0.3), 21, 0.0, False),  # on the outer diameter, uncut metal behind it
        ((1, 0.6, -0.5), 21, 0.0, False),  # at the shoulder
    ],
)
def test_tool_stopped_in_bore_is_inside_part_even_if_first_move_is_clear(
    place: tuple[int, float, float], line: int, jogged: float, inside: bool
) -> None:
    """The next tools would take the boring bar along through the wall."""
    job = job_of(BORE)
    found = check_of(job).check_start(lambda _at: (), interrupted(job, place, line, jogged=jogged))
    assert (found.hit_body is CollisionBody.PART, found.is_inside_at_start) == (inside, inside)


def test_start_is_clear_after_jog_out_of_bore() -> None:
    job = job_of(BORE.replace("X.9Z-.3\n", ""))
    assert check_of(job).check_start(passes(job), interrupted(job, jogged=0.8)).hit_body is None


def test_stopped_tool_is_inside_part_without_specified_stock() -> None:
    job = job_of(BORE)
    found = check_of(job, replace(SETTING, stock=None)).check_start(passes(job), interrupted(job))
    assert met(found) == (CollisionBody.PART, 2, False)
    assert not found.has_assumed_data


def test_a_tool_that_was_jogged_into_the_wall_is_inside_the_part() -> None:
    job = job_of(BORE)
    now = interrupted(job)
    found = check_of(job).check_start(
        passes(job), replace(now, axis_positions=(now.axis_positions[0] + 2.0, *now.axis_positions[1:]))
    )
    assert met(found) == (CollisionBody.PART, 2, True)


def test_first_move_through_assumed_stock_is_marked_as_assumed() -> None:
    job = job_of(BORE)
    now = StartState((*axes(1, 0.9, -1.2), 0.0), 1, starts_at_first_line=False)
    through = job_of("G90G94F300G73\nT1\nX.2Z-1.2\nX.9\n" + BORE)
    assert check_of(job).check_start(passes(through), now).has_assumed_data is False
    found = check_of(job, replace(SETTING, stock=None)).check_start(passes(through), now)
    assert (found.hit_body, found.has_assumed_data) == (CollisionBody.PART, True)


@pytest.mark.parametrize(("text", "crosses"), [("X1.2Z.5", True), ("Z.5", False), ("G95F.003X.42", False)])
def test_mdi_line_in_bore_is_checked_against_bore_wall(text: str, crosses: bool) -> None:
    job = job_of(BORE)
    now = interrupted(job)
    line = line_of(f"G90G94F300{text}" if "G95" not in text else text, now.axis_positions, 2)
    found = check_of(job).check_start(passes(line), replace(now, starts_at_first_line=False))
    assert (found.hit_body is not None) is crosses


def test_first_move_into_chuck_or_tailstock_is_a_hit() -> None:
    job = job_of(BORE)
    held = Clamping(80.0, 30.0, jaw_length=10.0, jaw_diameter=60.0, quill_diameter=20.0, center_z_mm=1.0)
    check = check_of(job, replace(SETTING, clamping=held))
    low = job_of(BORE.replace("X.9Z-.3\n", "X.9Z-1.3\n"))
    assert (
        check.check_start(passes(low), StartState((*axes(1, 2.0, 0.0), 0.0), 1)).hit_body
        is CollisionBody.CHUCK
    )
    across = StartState((*axes(1, -2.0, 1.0), 0.0), 1)
    assert (
        check.check_start(passes(job_of("G90G94F300G73\nT1\nX2Z1\n" + BORE)), across).hit_body
        is CollisionBody.TAILSTOCK
    )


def test_start_at_usual_position_away_from_part_is_clear() -> None:
    job = job_of(BORE)
    end = check_of(job).part_history.end_position
    assert end is not None
    found = check_of(job).check_start(passes(job), StartState((*end, 0.0), 1, starts_at_first_line=False))
    assert (found.hit_body, found.is_part_known) == (None, True)


def test_tool_jogged_into_specified_stock_is_inside_part() -> None:
    job = job_of(BORE)
    now = StartState((*axes(1, 0.5, -0.5), 0.0), 1)
    assert met(check_of(job).check_start(passes(job), now)) == (CollisionBody.PART, 1, True)
    assert check_of(job, replace(SETTING, stock=None)).check_start(passes(job), now).has_assumed_data


def test_safe_jog_direction_is_for_active_tool_when_other_tool_hits_part() -> None:
    job = job_of(BORE)
    found = check_of(job).check_start(passes(job), interrupted(job, (3, 1.0, 0.2), line=9))
    assert (found.hit_body, found.tool_number, found.safe_jog_direction) == (CollisionBody.PART, 1, "Z+")


def test_first_move_path_is_drawn_for_incoming_tool() -> None:
    job = job_of(BORE)
    found = check_of(job).check_start(passes(job), StartState((0.0, 0.0, 0.0), 0))
    assert found.hit_body is None
    assert found.part_zero == pytest.approx((TOOLS[1].x, TOOLS[1].z))
