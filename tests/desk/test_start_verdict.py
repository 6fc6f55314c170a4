"""The verdict on a start of a sample program: from home, in the stock, after an E-stop, and of a line."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.program_proving import create_loading_steps, get_samples_folder
from app.compose.stored_offsets import read_offsets_file
from app.desk.background_work import WorkAbandonedError
from app.desk.programs.program_loading import ProvedJob
from app.desk.programs.start_watch import (
    FirstMoveChecker,
    FirstMoveQuery,
    PreviousPart,
    add_first_move_verdict,
)
from core.executor.commands import FIRST_MOVE_CROSSES, TOOL_IN_PART
from core.executor.job import Proof
from core.executor.snapshot import ESTOP_REASON, InterruptedJob, StartAction
from core.language.source import ProgramSource, load_source
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.part_history import PartHistory
from core.proving.tip_moves import TipMove

HOME = (0.0, 0.0, 0.0)
TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.4, insert="DCMT11T304")


def watch(_reached: float = 0.0) -> None:
    """Nothing gives the work up."""


def part_of(source: ProgramSource) -> PreviousPart:
    """A program and its part, with stock and tools as assumed."""
    steps = create_loading_steps(
        load_machine(None), lambda: read_offsets_file(get_samples_folder() / "offsets.toml")
    )
    job = steps.make_job(source, False)
    steps.prove_job(job, watch)
    return PreviousPart(job, steps.draw_path(job, watch))


@cache
def known(name: str, *, described: bool = False) -> PreviousPart:
    """A sample program and its part; ``described``: its stock and T1 are specified."""
    part = part_of(load_source(get_samples_folder() / name))
    job, picture = part.job, part.picture
    assert picture.part is not None
    if described:
        stock = PartHistory(picture.part).stock
        setting = replace(picture.part.part_settings, stock=stock, shapes={1: TURNING})
        picture = replace(picture, part=replace(picture.part, part_settings=setting))
    return PreviousPart(job, picture)


def tip_at(part: PreviousPart, x: float, z: float) -> tuple[float, ...]:
    """Return machine X, Z and C with the tip of T1 there in the part, mm, X a radius."""
    offset = part.job.setup.tools[1]
    return offset.x + x, offset.z + z, 0.0


def question(
    part: PreviousPart, at: tuple[float, ...], starts: StartAction = StartAction.PROGRAM
) -> FirstMoveQuery:
    return FirstMoveQuery(part.job, starts, at, 0, 1, part)


def broken_in(part: PreviousPart, line: int) -> PreviousPart:
    """Return the program after an E-stop at the end of a line."""
    moves = part.picture.part
    assert moves is not None
    step = next(s for s in PartHistory(moves).steps if isinstance(s, TipMove) and s.line == line)
    z, r = step.points[-1]
    where = (r + step.part_zero[0], z + step.part_zero[1], 0.0)
    job, tool = part.job, step.modal.tool
    found = InterruptedJob(
        job.source.name, job.digest, job.text_digest, line, step.n, step.n, tool, 1, ("X", "Z", "C"), where,
        ESTOP_REASON, "",
    )  # fmt: skip
    return part._replace(interrupted_job=found)


def code(asked: FirstMoveQuery) -> tuple[str, bool]:
    """The code of the refusal, and whether the start is announced instead."""
    found = FirstMoveChecker().check_first_move(asked, watch).start_clearance
    return found.code, bool(found.warned)


@pytest.mark.parametrize("name", ["bushing.nc", "grooves.nc", "knob.nc", "pin.nc"])
@pytest.mark.parametrize("described", [False, True])
def test_a_sample_starts_from_home_and_repeats(name: str, *, described: bool) -> None:
    part = known(name, described=described)
    seen = FirstMoveChecker().check_first_move(question(part, HOME)._replace(active_tool_number=0), watch)
    assert [(each.code, each.warned, each.is_for_repeat) for each in seen.clearances] == [
        ("", "", False),
        ("", "", True),
    ]
    assert len(seen.approach_legs) >= 2


def test_start_with_the_tool_inside_specified_stock_is_refused() -> None:
    part = known("knob.nc", described=True)
    assert code(question(part, tip_at(part, 10.0, -10.0))) == (TOOL_IN_PART, False)


def test_start_with_the_tool_inside_assumed_stock_is_only_announced() -> None:
    part = known("knob.nc")
    assert code(question(part, tip_at(part, 10.0, -10.0))) == ("", True)


def test_position_is_not_checked_without_an_active_tool() -> None:
    part = part_of(ProgramSource("NO TOOL", "G90G94\nM03S600\nM08\nG01X.4Z-.4F30\nX0.Z0.\nM30\n"))
    assert code(question(part, HOME)._replace(active_tool_number=0)) == ("", False)


def test_first_move_out_of_a_groove_is_refused_with_jog_advice() -> None:
    part = broken_in(known("grooves.nc"), 16)
    assert part.interrupted_job is not None
    asked = question(part, part.interrupted_job.where)._replace(active_tool_number=3)
    found = FirstMoveChecker().check_first_move(asked, watch).start_clearance
    assert found.code == FIRST_MOVE_CROSSES
    assert all(key in found.why for key in ("F6", "F4", "X+"))


def test_unknown_part_is_announced_at_start() -> None:
    part = known("knob.nc")
    asked = question(part, HOME)._replace(previous_part=None, is_part_unknown=True)
    assert code(asked) == ("", True)
    assert code(asked._replace(is_part_unknown=False)) == ("", False)


def test_mdi_line_may_start_inside_the_part() -> None:
    part = known("knob.nc", described=True)
    assert code(question(part, tip_at(part, 10.0, -10.0), StartAction.MDI_LINE))[0] != TOOL_IN_PART


def test_refused_mdi_line_has_an_error_and_a_clear_one_does_not() -> None:
    part = known("knob.nc", described=True)
    proved = ProvedJob(Proof(part.job.digest, ()))
    inside = question(part, tip_at(part, 10.0, -10.0))
    refused = add_first_move_verdict(proved, FirstMoveChecker().check_first_move(inside, watch))
    assert [each.code for each in refused.diagnostics] == [TOOL_IN_PART]
    assert refused.proof.errors
    clear = add_first_move_verdict(proved, FirstMoveChecker().check_first_move(question(part, HOME), watch))
    assert (clear.diagnostics, clear.proof.errors) == ((), ())
    assert clear.first_move_clearance is not None


def test_canceled_first_move_check_ends() -> None:
    def given_up(_reached: float = 0.0) -> None:
        raise WorkAbandonedError

    part = broken_in(known("knob.nc"), 21)
    with pytest.raises(WorkAbandonedError):
        FirstMoveChecker().check_first_move(question(part, HOME), given_up)
