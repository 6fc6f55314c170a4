"""The verdict on a start of a sample program: from home, in the stock, after an E-stop, and of a line."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.stored_offsets import read_offsets
from app.compose.workshop import samples, workshop
from app.desk.background_work import AbandonedError
from app.desk.programs.program_loading import Proved
from app.desk.programs.start_watch import KnownPart, StartJudge, StartQuestion, with_verdict
from core.executor.commands import CROSSES, INSIDE
from core.executor.job import Proof
from core.executor.snapshot import ESTOP, InterruptedJob, Starts
from core.language.source import Source, load_source
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.part_history import PartHistory
from core.proving.tip_moves import TipMove

HOME = (0.0, 0.0, 0.0)
TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.4, insert="DCMT11T304")


def watch(_reached: float = 0.0) -> None:
    """Nothing gives the work up."""


def part_of(source: Source) -> KnownPart:
    """A program and its part, with stock and tools as assumed."""
    steps = workshop(load_machine(None), lambda: read_offsets(samples() / "offsets.toml"))
    job = steps.make_job(source, False)
    steps.prove(job, watch)
    return KnownPart(job, steps.draw(job, watch))


@cache
def known(name: str, *, described: bool = False) -> KnownPart:
    """A sample program and its part; ``described``: its stock and T1 are specified."""
    part = part_of(load_source(samples() / name))
    job, picture = part.job, part.picture
    assert picture.part is not None
    if described:
        stock = PartHistory(picture.part).stock
        setting = replace(picture.part.setting, stock=stock, shapes={1: TURNING})
        picture = replace(picture, part=replace(picture.part, setting=setting))
    return KnownPart(job, picture)


def tip_at(part: KnownPart, x: float, z: float) -> tuple[float, ...]:
    """Return machine X, Z and C with the tip of T1 there in the part, mm, X a radius."""
    offset = part.job.setup.tools[1]
    return offset.x + x, offset.z + z, 0.0


def question(part: KnownPart, at: tuple[float, ...], starts: Starts = Starts.PROGRAM) -> StartQuestion:
    return StartQuestion(part.job, starts, at, 0, 1, part)


def broken_in(part: KnownPart, line: int) -> KnownPart:
    """Return the program after an E-stop at the end of a line."""
    moves = part.picture.part
    assert moves is not None
    step = next(s for s in PartHistory(moves).steps if isinstance(s, TipMove) and s.line == line)
    z, r = step.points[-1]
    where = (r + step.zero[0], z + step.zero[1], 0.0)
    job, tool = part.job, step.modal.tool
    found = InterruptedJob(
        job.source.name, job.digest, job.text_digest, line, step.n, step.n, tool, 1, ("X", "Z", "C"), where,
        ESTOP, "",
    )  # fmt: skip
    return part._replace(broken=found)


def code(asked: StartQuestion) -> tuple[str, bool]:
    """The code of the refusal, and whether the start is announced instead."""
    found = StartJudge().judge(asked, watch).clearance
    return found.code, bool(found.warned)


@pytest.mark.parametrize("name", ["bushing.nc", "grooves.nc", "knob.nc", "pin.nc"])
@pytest.mark.parametrize("described", [False, True])
def test_a_sample_starts_from_home_and_repeats(name: str, *, described: bool) -> None:
    part = known(name, described=described)
    seen = StartJudge().judge(question(part, HOME)._replace(tool=0), watch)
    assert [(each.code, each.warned, each.repeats) for each in seen.verdicts] == [
        ("", "", False),
        ("", "", True),
    ]
    assert len(seen.legs) >= 2


def test_a_tool_inside_specified_stock_is_refused_without_any_interruption() -> None:
    part = known("knob.nc", described=True)
    assert code(question(part, tip_at(part, 10.0, -10.0))) == (INSIDE, False)


def test_what_rests_on_assumed_stock_is_only_announced() -> None:
    part = known("knob.nc")
    assert code(question(part, tip_at(part, 10.0, -10.0))) == ("", True)


def test_without_a_tool_in_work_its_place_says_nothing() -> None:
    part = part_of(Source("NO TOOL", "G90G94\nM03S600\nM08\nG01X.4Z-.4F30\nX0.Z0.\nM30\n"))
    assert code(question(part, HOME)._replace(tool=0)) == ("", False)


def test_after_an_estop_in_a_groove_the_way_to_line_1_is_refused_and_a_jog_is_named() -> None:
    part = broken_in(known("grooves.nc"), 16)
    assert part.broken is not None
    asked = question(part, part.broken.where)._replace(tool=3)
    found = StartJudge().judge(asked, watch).clearance
    assert found.code == CROSSES
    assert all(key in found.why for key in ("F6", "F4", "X+"))


def test_a_part_that_is_not_known_is_announced() -> None:
    part = known("knob.nc")
    asked = question(part, HOME)._replace(part=None, unknown=True)
    assert code(asked) == ("", True)
    assert code(asked._replace(unknown=False)) == ("", False)


def test_a_line_may_cut_where_a_program_may_not_begin() -> None:
    part = known("knob.nc", described=True)
    assert code(question(part, tip_at(part, 10.0, -10.0), Starts.LINE))[0] != INSIDE


def test_a_refused_line_has_an_error_and_a_clear_one_none() -> None:
    part = known("knob.nc", described=True)
    proved = Proved(Proof(part.job.digest, ()))
    inside = question(part, tip_at(part, 10.0, -10.0))
    refused = with_verdict(proved, StartJudge().judge(inside, watch))
    assert [each.code for each in refused.diagnostics] == [INSIDE]
    assert refused.proof.errors
    clear = with_verdict(proved, StartJudge().judge(question(part, HOME), watch))
    assert (clear.diagnostics, clear.proof.errors) == ((), ())
    assert clear.clearance is not None


def test_a_check_that_nobody_wants_any_more_ends() -> None:
    def given_up(_reached: float = 0.0) -> None:
        raise AbandonedError

    part = broken_in(known("knob.nc"), 21)
    with pytest.raises(AbandonedError):
        StartJudge().judge(question(part, HOME), given_up)
