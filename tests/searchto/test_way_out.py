"""What the operator is asked to do by hand: in the direction that is out, and never along Z in a groove."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.searchto.searchto_plan import jog_words, way_out_of
from core.executor.job import make_job
from core.executor.snapshot import CONTROL_LOST, InterruptedJob, Snapshot
from core.interpreter.restart.restart_approach import Choices, MachineNow, retract_from_work
from core.interpreter.restart.restart_point import Interruption
from core.interpreter.restart.restart_retract import Retract, RetractLeg, ToolPlace
from core.interpreter.restart.state_rebuild import StateRebuild
from core.interpreter.shared.modal_state import Modal
from core.language.source import Source
from tests.interpreter.programs import INCH, setup
from tests.interrupted import broken_off
from tests.texts import begins, text


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (Retract(ToolPlace.CLEAR), ""),
        (Retract(ToolPlace.WORK, (RetractLeg(1.0, 0.0),), (1, 0)), ""),
        (Retract(ToolPlace.UNKNOWN, away=(1, 0)), text("search.jog-out-first", tool=3, x="X+")),
        (Retract(ToolPlace.UNKNOWN, away=(-1, 0)), text("search.jog-out-first", tool=3, x="X-")),
        (Retract(ToolPlace.UNKNOWN, away=(0, 1)), text("search.jog-z-out-first", tool=3)),
        (
            Retract(ToolPlace.UNKNOWN, away=(1, 1)),
            text("search.jog-out-together", tool=3, x="X+"),
        ),
        (
            Retract(ToolPlace.UNKNOWN),
            text("search.way-in-unknown", tool=3),
        ),
        (Retract(ToolPlace.THREAD), text("search.in-thread", tool=3)),
        (
            Retract(ToolPlace.TAP),
            text("search.tap-in-thread", tool=3),
        ),
        (
            Retract(ToolPlace.TURNED, away=(1, 0)),
            text("search.c-has-turned", tool=3),
        ),
    ],
)
def test_the_words(found: Retract, words: str) -> None:
    assert jog_words(found, 3) == words


PART = Source("PART", "G90G94F300\nT1\nX.75Z1\nZ-.3\nM19\nCA30\nG94F5X.5\nF300X.75\nZ1\nM05\nM30\n")


def test_a_cross_hole_is_left_only_while_c_stands_as_it_stood() -> None:
    cut = StateRebuild(PART, setup(), lambda _count: None).cut
    row = next(n for n, line in zip(cut.n.tolist(), cut.line.tolist(), strict=True) if line == 7)
    at = (0.6 * INCH, -0.3 * INCH, 30.0)
    broken = Interruption(row, 1, at, row)
    assert retract_from_work(cut, MachineNow(at, Modal(), broken))[0].known
    assert retract_from_work(cut, MachineNow((*at[:2], 390.2), Modal(), broken))[
        0
    ].known  # a whole turn, as C counts
    found, tool = retract_from_work(cut, MachineNow((*at[:2], 35.0), Modal(), broken))
    assert not found.known
    assert begins(jog_words(found, tool), "search.c-has-turned", tool=1)


def interrupted(block: int, **changes: object) -> tuple[Snapshot, InterruptedJob]:
    job = make_job(PART, setup())
    found = broken_off(
        program="PART", text=job.text_digest, line=7, block=block, begun=block, tool=1,
        where=(0.6 * INCH, -0.3 * INCH, 30.0),
    )  # fmt: skip
    found = replace(found, **changes)  # type: ignore[arg-type]
    return Snapshot(program="PART", demand=(0.6 * INCH, -0.3 * INCH, 30.0), interrupted=found), found


def test_the_feed_is_told_and_the_legs_are_in_the_frame_of_the_tool_that_stands_there() -> None:
    cut = StateRebuild(PART, setup(), lambda _count: None).cut
    row = next(n for n, line in zip(cut.n.tolist(), cut.line.tolist(), strict=True) if line == 7)
    snapshot, _ = interrupted(row)
    out = way_out_of(cut, snapshot, make_job(PART, setup()), Choices())
    assert (out.trouble, out.feed) == ("", "20.00 in/min")
    assert [(leg.label, round(leg.x / INCH, 3), round(leg.z / INCH, 3)) for leg in out.legs] == [
        ("", 0.6, -0.3),
        ("1 X", 0.75, -0.3),
        ("2 Z", 0.75, 1.0),
    ]
    assert out.begin.single


def test_a_note_of_a_second_ago_is_told_from_a_place_at_rest() -> None:
    cut = StateRebuild(PART, setup(), lambda _count: None).cut
    before, _ = interrupted(3, why=CONTROL_LOST, where=(0.75 * INCH, -0.1 * INCH, 30.0))
    assert way_out_of(cut, before, make_job(PART, setup()), Choices()).trouble == ""
    moved, _ = interrupted(3, where=(0.75 * INCH, -0.1 * INCH, 30.0))
    assert way_out_of(cut, moved, make_job(PART, setup()), Choices()).trouble
