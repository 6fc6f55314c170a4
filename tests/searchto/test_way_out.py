"""What the operator is asked to do by hand: in the direction that is out, and never along Z in a groove."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.searchto.restart_plan import describe_manual_retract, plan_retract
from core.executor.job import make_job
from core.executor.snapshot import POWER_LOST_REASON, InterruptedJob, Snapshot
from core.interpreter.restart.restart_approach import (
    CurrentMachineState,
    OperatorChoices,
    plan_retract_from_part,
)
from core.interpreter.restart.restart_point import Interruption
from core.interpreter.restart.state_rebuild import OmniturnRestartSearch
from core.interpreter.restart.tool_retract import Retract, RetractLeg, ToolSituation
from core.interpreter.shared.modal_state import ModalState
from core.language.source import ProgramSource
from tests.interpreter.programs import INCH, setup
from tests.interrupted import broken_off
from tests.texts import begins, text


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (Retract(ToolSituation.CLEAR), ""),
        (Retract(ToolSituation.IN_PART, (RetractLeg(1.0, 0.0),), (1, 0)), ""),
        (Retract(ToolSituation.UNKNOWN, direction=(1, 0)), text("search.jog-out-first", tool=3, x="X+")),
        (Retract(ToolSituation.UNKNOWN, direction=(-1, 0)), text("search.jog-out-first", tool=3, x="X-")),
        (Retract(ToolSituation.UNKNOWN, direction=(0, 1)), text("search.jog-z-out-first", tool=3)),
        (
            Retract(ToolSituation.UNKNOWN, direction=(1, 1)),
            text("search.jog-out-together", tool=3, x="X+"),
        ),
        (
            Retract(ToolSituation.UNKNOWN),
            text("search.way-in-unknown", tool=3),
        ),
        (Retract(ToolSituation.IN_THREAD), text("search.in-thread", tool=3)),
        (
            Retract(ToolSituation.IN_TAPPED_HOLE),
            text("search.tap-in-thread", tool=3),
        ),
        (
            Retract(ToolSituation.PART_TURNED, direction=(1, 0)),
            text("search.c-has-turned", tool=3),
        ),
    ],
)
def test_manual_retract_is_described_for_each_case(found: Retract, words: str) -> None:
    assert describe_manual_retract(found, 3) == words


PART = ProgramSource("PART", "G90G94F300\nT1\nX.75Z1\nZ-.3\nM19\nCA30\nG94F5X.5\nF300X.75\nZ1\nM05\nM30\n")


def test_cross_hole_retract_is_known_only_at_unchanged_c_angle() -> None:
    cut = OmniturnRestartSearch(PART, setup(), lambda _count: None).cut_record
    row = next(
        n for n, line in zip(cut.block_numbers.tolist(), cut.line_numbers.tolist(), strict=True) if line == 7
    )
    at = (0.6 * INCH, -0.3 * INCH, 30.0)
    broken = Interruption(row, 1, at, row)
    assert plan_retract_from_part(cut, CurrentMachineState(at, ModalState(), broken))[0].is_known
    assert plan_retract_from_part(cut, CurrentMachineState((*at[:2], 390.2), ModalState(), broken))[
        0
    ].is_known  # a whole turn, as C counts
    found, tool = plan_retract_from_part(cut, CurrentMachineState((*at[:2], 35.0), ModalState(), broken))
    assert not found.is_known
    assert begins(describe_manual_retract(found, tool), "search.c-has-turned", tool=1)


def interrupted(block: int, **changes: object) -> tuple[Snapshot, InterruptedJob]:
    job = make_job(PART, setup())
    found = broken_off(
        program="PART", text=job.text_digest, line=7, block=block, begun=block, tool=1,
        where=(0.6 * INCH, -0.3 * INCH, 30.0),
    )  # fmt: skip
    found = replace(found, **changes)  # type: ignore[arg-type]
    return Snapshot(program="PART", demand=(0.6 * INCH, -0.3 * INCH, 30.0), interrupted=found), found


def test_retract_states_feed_and_uses_frame_of_active_tool() -> None:
    cut = OmniturnRestartSearch(PART, setup(), lambda _count: None).cut_record
    row = next(
        n for n, line in zip(cut.block_numbers.tolist(), cut.line_numbers.tolist(), strict=True) if line == 7
    )
    snapshot, _ = interrupted(row)
    out = plan_retract(cut, snapshot, make_job(PART, setup()), OperatorChoices())
    assert (out.error_text, out.feed_text) == ("", "20.00 in/min")
    assert [(leg.label, round(leg.x / INCH, 3), round(leg.z / INCH, 3)) for leg in out.drawn_legs] == [
        ("", 0.6, -0.3),
        ("1 X", 0.75, -0.3),
        ("2 Z", 0.75, 1.0),
    ]
    assert out.start_state.is_mdi_line


def test_changed_axis_position_is_tolerated_only_after_power_loss() -> None:
    cut = OmniturnRestartSearch(PART, setup(), lambda _count: None).cut_record
    before, _ = interrupted(3, why=POWER_LOST_REASON, where=(0.75 * INCH, -0.1 * INCH, 30.0))
    assert plan_retract(cut, before, make_job(PART, setup()), OperatorChoices()).error_text == ""
    moved, _ = interrupted(3, where=(0.75 * INCH, -0.1 * INCH, 30.0))
    assert plan_retract(cut, moved, make_job(PART, setup()), OperatorChoices()).error_text
