"""The first move of a start against the part as it is: through a wall, out of a bore, from a usual place."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import setup_for
from core.executor.job import Job, interpret, make_job
from core.interpreter.shared.checkpoint import Begin, Checkpoint
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import Modal
from core.language.source import Source
from core.part.stock import Clamping, bar
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.part_history import PartGathering, PartHistory
from core.proving.program_tools import PartSetting
from core.proving.prove_program import prove
from core.proving.start_check import Body, FirstMove, Passes, StartCheck, StartNow

INCH = 25.4
TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.0, insert="DCMT11T304")
BORING = ToolShape(ToolKind.BORING, tip=2, diameter=8.0, stick_out=40.0)
DRILL = ToolShape(ToolKind.DRILL, tip=7, diameter=12.7, stick_out=60.0)
SETTING = PartSetting(bar(1.5 * INCH, 0.0, -2.0 * INCH), {1: TURNING, 2: BORING, 3: DRILL})
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
    return make_job(Source("PART", text), setup_for(load_machine(None), tools=TOOLS, secondary={}))


def passes(job: Job) -> Passes:
    def blocks(at: tuple[float, ...]) -> Iterable[Block]:
        return interpret(job, replace(job.setup, start=at)).blocks

    return blocks


def check_of(job: Job, setting: PartSetting = SETTING) -> StartCheck:
    gathered = PartGathering(setting)
    prove(job.source, job.setup, load_machine(None), seen=gathered.see)
    moves = gathered.moves()
    assert moves is not None
    return StartCheck(PartHistory(moves), dict(TOOLS), stock_specified=setting.stock is not None)


def axes(tool: int, x: float, z: float) -> tuple[float, float]:
    """Return machine X and Z with the tip of a tool there in the part, given in inches."""
    return TOOLS[tool].x + x * INCH, TOOLS[tool].z + z * INCH


def block_in(job: Job, line: int) -> int:
    return next(block.n for block in job.reading.begin(job.setup).blocks() if block.line == line)


def interrupted(
    job: Job, place: tuple[int, float, float] = IN_THE_BORE, line: int = DEEPER, *, jogged: float = 0.0
) -> StartNow:
    """Return the machine after an E-stop in a line, jogged in Z+ by so many inches since."""
    tool, x, z = place
    where = axes(tool, x, z)
    now = axes(tool, x, z + jogged)
    return StartNow((*now, 0.0), tool, (block_in(job, line), where))


def line_of(text: str, at: tuple[float, ...], tool: int) -> Job:
    """Return a line of MDI from these axis positions."""
    offset = TOOLS[tool]
    modal = Modal(tool=tool, tool_x=offset.x, tool_z=offset.z, rapid_rate=100.0, rpm=900.0)
    setup = setup_for(load_machine(None), tools=TOOLS, secondary={})
    begin = Begin(Checkpoint(modal), single=True)
    return make_job(Source("MDI", text), replace(setup, start=at, begin=begin))


def met(found: FirstMove) -> tuple[Body | None, int, bool]:
    return found.met, found.tool, found.inside


def test_a_start_at_line_1_out_of_the_bore_goes_through_its_wall() -> None:
    job = job_of(BORE)
    found = check_of(job).find(passes(job), interrupted(job))
    assert met(found) == (Body.PART, 2, False)
    assert not found.assumed
    assert found.out == "Z+"
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
def test_a_tool_that_stopped_in_a_bore_is_inside_although_the_first_move_meets_nothing(
    place: tuple[int, float, float], line: int, jogged: float, inside: bool
) -> None:
    """The next tools would take the boring bar along through the wall."""
    job = job_of(BORE)
    found = check_of(job).find(lambda _at: (), interrupted(job, place, line, jogged=jogged))
    assert (found.met is Body.PART, found.inside) == (inside, inside)


def test_jogged_out_of_the_bore_it_is_clear() -> None:
    job = job_of(BORE.replace("X.9Z-.3\n", ""))
    assert check_of(job).find(passes(job), interrupted(job, jogged=0.8)).met is None


def test_the_stock_does_not_have_to_be_specified_for_a_tool_that_was_stopped_in_it() -> None:
    job = job_of(BORE)
    found = check_of(job, replace(SETTING, stock=None)).find(passes(job), interrupted(job))
    assert met(found) == (Body.PART, 2, False)
    assert not found.assumed


def test_a_tool_that_was_jogged_into_the_wall_is_inside_the_part() -> None:
    job = job_of(BORE)
    now = interrupted(job)
    found = check_of(job).find(passes(job), replace(now, at=(now.at[0] + 2.0, *now.at[1:])))
    assert met(found) == (Body.PART, 2, True)


def test_without_an_interruption_a_first_move_through_an_assumed_stock_is_only_assumed() -> None:
    job = job_of(BORE)
    now = StartNow((*axes(1, 0.9, -1.2), 0.0), 1, strict=False)
    through = job_of("G90G94F300G73\nT1\nX.2Z-1.2\nX.9\n" + BORE)
    assert check_of(job).find(passes(through), now).assumed is False
    found = check_of(job, replace(SETTING, stock=None)).find(passes(through), now)
    assert (found.met, found.assumed) == (Body.PART, True)


@pytest.mark.parametrize(("text", "crosses"), [("X1.2Z.5", True), ("Z.5", False), ("G95F.003X.42", False)])
def test_a_line_of_mdi_in_the_bore(text: str, crosses: bool) -> None:
    job = job_of(BORE)
    now = interrupted(job)
    line = line_of(f"G90G94F300{text}" if "G95" not in text else text, now.at, 2)
    found = check_of(job).find(passes(line), replace(now, strict=False))
    assert (found.met is not None) is crosses


def test_a_first_move_into_the_chuck_and_into_the_tailstock() -> None:
    job = job_of(BORE)
    held = Clamping(80.0, 30.0, jaws=10.0, jaw_diameter=60.0, quill=20.0, centre=1.0)
    check = check_of(job, replace(SETTING, clamping=held))
    low = job_of(BORE.replace("X.9Z-.3\n", "X.9Z-1.3\n"))
    assert check.find(passes(low), StartNow((*axes(1, 2.0, 0.0), 0.0), 1)).met is Body.CHUCK
    across = StartNow((*axes(1, -2.0, 1.0), 0.0), 1)
    assert check.find(passes(job_of("G90G94F300G73\nT1\nX2Z1\n" + BORE)), across).met is Body.TAILSTOCK


def test_the_usual_place_away_from_the_part_is_clear() -> None:
    job = job_of(BORE)
    end = check_of(job).history.end
    assert end is not None
    found = check_of(job).find(passes(job), StartNow((*end, 0.0), 1, strict=False))
    assert (found.met, found.known) == (None, True)


def test_a_tool_that_was_jogged_into_specified_stock_is_inside_without_any_interruption() -> None:
    job = job_of(BORE)
    now = StartNow((*axes(1, 0.5, -0.5), 0.0), 1)
    assert met(check_of(job).find(passes(job), now)) == (Body.PART, 1, True)
    assert check_of(job, replace(SETTING, stock=None)).find(passes(job), now).assumed


def test_the_way_out_is_that_of_the_tool_in_work_where_another_tool_meets_the_part() -> None:
    job = job_of(BORE)
    found = check_of(job).find(passes(job), interrupted(job, (3, 1.0, 0.2), line=9))
    assert (found.met, found.tool, found.out) == (Body.PART, 1, "Z+")


def test_the_first_move_is_drawn_for_the_tool_that_arrives() -> None:
    job = job_of(BORE)
    found = check_of(job).find(passes(job), StartNow((0.0, 0.0, 0.0), 0))
    assert found.met is None
    assert found.zero == pytest.approx((TOOLS[1].x, TOOLS[1].z))
