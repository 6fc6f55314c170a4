"""The way to a line: out of the work by the tool that stands there, Z clear, X over, and in by the line."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.interpreter.restart.restart_approach import (
    Choices,
    MachineNow,
    approach_steps,
    begin_at,
    retract_from_work,
    starting,
    way_out,
)
from core.interpreter.restart.restart_point import Interruption, RestartPoint
from core.interpreter.restart.restart_retract import Retract, RetractLeg, ToolPlace
from core.interpreter.restart.state_rebuild import StateRebuild
from core.interpreter.shared.actions import Coolant, Output, SpindleRun, SpindleStop
from core.interpreter.shared.checkpoint import ApproachStep, Checkpoint, CTurn, FunctionStep, Leg
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import Modal
from core.language.source import Source
from tests.interpreter.programs import INCH, setup
from tests.texts import text

MODAL = Modal(tool=1, tool_x=-10.0, tool_z=-50.0)
AT = Checkpoint(MODAL._replace(spindle=1, rpm=800.0, coolant=True), x=8.0, z=-12.0)
BACK = Retract(ToolPlace.WORK, (RetractLeg(15.0, -12.0), RetractLeg(15.0, 2.0)), (1, 0))
FOUND = RestartPoint(9, AT, BACK)
STANDS = MachineNow((30.0, -48.0, 0.0), MODAL)


def legs(steps: tuple[ApproachStep, ...]) -> list[tuple[float | None, float | None, bool]]:
    return [(step.x, step.z, step.rapid) for step in steps if isinstance(step, Leg)]


def order(steps: tuple[ApproachStep, ...]) -> list[str]:
    return [step.text for step in steps]


def test_the_way_in_is_the_way_back_the_other_way_round() -> None:
    steps = approach_steps(FOUND, STANDS, Choices())
    assert legs(steps) == [(5.0, None, True), (None, -62.0, False), (-2.0, None, False)]
    assert order(steps) == ["X", "M03", "M08", "Z", "X"]
    last = steps[-1]
    assert isinstance(last, Leg)
    assert last.feed < Choices().rapid  # a feed waits for the spindle's speed


def test_a_line_that_begins_clear_of_the_work_is_gone_to_by_rapid() -> None:
    found = replace(FOUND, back=Retract(ToolPlace.CLEAR))
    assert legs(approach_steps(found, STANDS, Choices())) == [(-2.0, None, True), (None, -62.0, True)]


def test_what_must_not_run_is_stopped_before_anything_moves() -> None:
    now = MachineNow(STANDS.at, MODAL._replace(spindle=-1, coolant=True, outputs=frozenset({"live1"})))
    found = replace(FOUND, checkpoint=AT._replace(modal=AT.modal._replace(coolant=False)))
    steps = approach_steps(found, now, Choices())
    assert order(steps)[:3] == ["M05", "M09", "LIVE1 OFF"]
    actions = [step.action for step in steps if isinstance(step, FunctionStep)]
    assert actions[:3] == [SpindleStop(), Coolant(False), Output("live1", False)]


def test_what_starts_is_told_and_coolant_only_as_chosen() -> None:
    told = [step.action for step in starting(FOUND, STANDS, Choices()) if isinstance(step, FunctionStep)]
    assert told == [SpindleRun(800.0, None), Coolant(True)]
    without = begin_at(FOUND, STANDS, Choices(coolant=False))
    assert not without.checkpoint.modal.coolant
    assert "M08" not in order(without.approach)


def test_c_is_locked_and_turned_to_its_angle_by_the_short_way_clear_of_the_part() -> None:
    modal = AT.modal._replace(spindle=0, c_locked=True, coolant=False, offset_c=720.0)
    found = replace(FOUND, checkpoint=AT._replace(modal=modal, c=90.0))
    begin = begin_at(found, MachineNow((30.0, -48.0, 1000.0), MODAL), Choices())
    turn = next(step for step in begin.approach if isinstance(step, CTurn))
    assert turn.c == pytest.approx(1170.0)  # 90 degrees and three turns: the nearest to 1000
    assert begin.checkpoint.modal.offset_c == pytest.approx(1080.0)
    assert order(begin.approach) == ["X", "M89", "C", "Z", "X"]


TWO = (
    "G90G94F300\nT1\nX.5Z.1\nM03S900\nZ-.3\nG95F.002X.4\nG94F300X.5\nZ2\n"
    "T2\nX.2Z.1\nG95F.003Z-.5\nG94F300Z2\nM30\n"
)
TOOLS = {1: ToolOffset(-10.0, -50.0), 2: ToolOffset(90.0, -20.0)}


def two(line: int, broken: Interruption | None = None) -> RestartPoint:
    """T1 cuts a groove at Z-.3 from X.5 (a radius), then T2, whose offset is another, bores at X.2."""
    found = StateRebuild(Source("PART", TWO), setup(tools=TOOLS), lambda _count: None).find(line, 0, broken)
    assert isinstance(found, RestartPoint), found
    return found


def spots(steps: tuple[ApproachStep, ...], tool: int) -> list[tuple[float | None, float | None, bool]]:
    """Ends of the legs as this tool would read them, inches."""
    off = TOOLS[tool]
    return [
        (
            None if x is None else round((x - off.x) / INCH, 4),
            None if z is None else round((z - off.z) / INCH, 4),
            rapid,
        )
        for x, z, rapid in legs(steps)
    ]


def in_the_groove(x: float = 0.42) -> tuple[MachineNow, Interruption]:
    """T1 was stopped on line 6, in its groove; the fifth elementary block is that cut."""
    at = (-10.0 + x * INCH, -50.0 - 0.3 * INCH, 0.0)
    broken = Interruption(5, 1, at, 5)
    return MachineNow(at, MODAL, broken), broken


def test_the_way_out_is_that_of_the_tool_that_was_interrupted_whatever_the_line_works_with() -> None:
    now, broken = in_the_groove()
    back = approach_steps(two(6, broken), now, Choices())
    # X out of the groove at a feed; Z to the Z2 of T2, at machine -20 + 50.8; down again over the bar.
    assert spots(back, 1) == [(0.5, None, False), (None, 3.1811, True), (None, -0.3, True)]
    other = approach_steps(two(11, broken._replace(block=99, begun=99)), now, Choices())
    assert spots(other, 1)[:2] == [(0.5, None, False), (None, 3.1811, True)]


def test_a_tool_called_by_hand_in_mdi_does_not_take_the_place_of_the_one_in_the_groove() -> None:
    now, _ = in_the_groove()
    by_hand = replace(now, modal=now.modal._replace(tool=2, tool_x=90.0, tool_z=-20.0))
    cut = two(6).cut
    assert cut is not None
    assert way_out(cut, by_hand, Choices()) == way_out(cut, now, Choices())


def test_a_tool_that_was_jogged_along_its_way_out_goes_on_with_the_rest_of_it() -> None:
    now, _ = in_the_groove()
    cut = two(6).cut
    assert cut is not None
    moved = replace(now, at=(-10.0 + 0.47 * INCH, now.at[1], 0.0))
    assert spots(way_out(cut, moved, Choices()), 1)[0] == (0.5, None, False)


def test_a_tool_that_was_jogged_elsewhere_in_the_part_is_asked_to_be_jogged_on() -> None:
    now, _ = in_the_groove()
    cut = two(6).cut
    assert cut is not None
    moved = replace(now, at=(now.at[0], now.at[1] + 3.0, 0.0))
    found, tool = retract_from_work(cut, moved)
    assert not found.known
    assert tool == 1
    assert found.away == (1, 0)  # X, and not Z


def test_a_tool_jogged_clear_needs_no_way_out_but_z() -> None:
    now, _ = in_the_groove()
    cut = two(6).cut
    assert cut is not None
    clear = replace(now, at=(-10.0 + 0.8 * INCH, now.at[1], 0.0))
    assert retract_from_work(cut, clear)[0].tool_place is ToolPlace.CLEAR
    assert all(rapid for _, _, rapid in legs(way_out(cut, clear, Choices())))


def test_where_nothing_is_known_to_be_interrupted_every_tool_has_to_stand_clear() -> None:
    cut = two(6).cut
    assert cut is not None
    unknown = MachineNow((-10.0 + 0.2 * INCH, -50.0 - 0.3 * INCH, 0.0), Modal())
    assert not retract_from_work(cut, unknown)[0].known
    assert retract_from_work(cut, MachineNow((40.0, cut.clear_z, 0.0), Modal()))[0].known


def test_a_control_that_was_cut_off_may_stand_a_little_farther_on() -> None:
    now, _ = in_the_groove()
    noted = Interruption(4, 1, (-10.0 + 0.5 * INCH, -50.0 + 0.05 * INCH, 0.0), 4, stale=True)
    cut = two(6).cut
    assert cut is not None
    assert spots(way_out(cut, replace(now, broken=noted), Choices()), 1)[0] == (0.5, None, False)
    known = replace(now, broken=noted._replace(stale=False))
    assert way_out(cut, known, Choices()) == ()  # it was moved by hand, nobody knows whither


def test_a_tool_that_the_program_has_not_named_yet_is_brought_in_clear_of_the_whole_program() -> None:
    now, broken = in_the_groove()
    found = two(10, broken._replace(block=99, begun=99))
    steps = approach_steps(found, replace(now, broken=None, at=(40.0, 90.0, 0.0)), Choices())
    assert all(rapid for _, _, rapid in legs(steps))


def test_a_line_behind_what_was_cut_is_refused_where_it_begins_in_metal() -> None:
    _, broken = in_the_groove()
    answer = StateRebuild(Source("PART", TWO), setup(tools=TOOLS), lambda _count: None).find(12, 0, broken)
    assert not isinstance(answer, RestartPoint)
    uncut = text("search.uncut-lines", first=6, last=11)
    assert answer.why == text("search.in-uncut-material", line=12, uncut=uncut)
    assert two(9, broken).left_out == (6, 6)  # the groove is begun, but not complete


def test_the_rest_of_an_interrupted_cut_is_left_out_unless_the_tool_is_at_its_end() -> None:
    _, broken = in_the_groove()
    rebuild = StateRebuild(Source("PART", TWO), setup(tools=TOOLS), lambda _count: None)
    answer = rebuild.find(7, 0, broken)
    assert not isinstance(answer, RestartPoint)
    uncut = text("search.uncut-line", line=6)
    assert answer.why == text("search.in-uncut-material", line=7, uncut=uncut)
    now, complete = in_the_groove(0.4)
    assert two(7, complete).left_out == (0, 0)
    assert two(6, broken).left_out == (0, 0)
    later = two(9, broken)
    assert later.left_out == (6, 6)
    assert begin_at(later, now, Choices()).skips_cuts
    assert not begin_at(two(9, complete), now, Choices()).skips_cuts
