"""The way to a line: out of the work by the tool that stands there, Z clear, X over, and in by the line."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.interpreter.restart.restart_approach import (
    CurrentMachineState,
    OperatorChoices,
    list_starting_functions,
    make_lathe_pass_start,
    plan_exit_moves,
    plan_lathe_approach,
    plan_retract_from_part,
)
from core.interpreter.restart.restart_point import Interruption, RestartPoint
from core.interpreter.restart.state_rebuild import OmniturnRestartSearch
from core.interpreter.restart.tool_retract import Retract, RetractLeg, ToolSituation
from core.interpreter.shared.actions import CoolantSwitch, OutputSwitch, SpindleRun, SpindleStop
from core.interpreter.shared.checkpoint import ApproachStep, CAxisMove, Checkpoint, FunctionStep, StraightLeg
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.source import ProgramSource
from tests.interpreter.programs import INCH, setup
from tests.texts import text

MODAL = ModalState(tool=1, tool_offset_x=-10.0, tool_offset_z=-50.0)
AT = Checkpoint(MODAL._replace(spindle=1, rpm=800.0, coolant=True), x=8.0, z=-12.0)
BACK = Retract(ToolSituation.IN_PART, (RetractLeg(15.0, -12.0), RetractLeg(15.0, 2.0)), (1, 0))
FOUND = RestartPoint(9, AT, BACK)
STANDS = CurrentMachineState((30.0, -48.0, 0.0), MODAL)


def legs(steps: tuple[ApproachStep, ...]) -> list[tuple[float | None, float | None, bool]]:
    return [(step.x, step.z, step.is_rapid) for step in steps if isinstance(step, StraightLeg)]


def order(steps: tuple[ApproachStep, ...]) -> list[str]:
    return [step.text for step in steps]


def test_approach_is_the_retract_path_reversed() -> None:
    steps = plan_lathe_approach(FOUND, STANDS, OperatorChoices())
    assert legs(steps) == [(5.0, None, True), (None, -62.0, False), (-2.0, None, False)]
    assert order(steps) == ["X", "M03", "M08", "Z", "X"]
    last = steps[-1]
    assert isinstance(last, StraightLeg)
    assert (
        last.feed_mm_s < OperatorChoices().approach_speed_outside_mm_s
    )  # a feed waits for the spindle's speed


def test_line_that_starts_clear_of_the_part_is_approached_in_rapid() -> None:
    found = replace(FOUND, retract=Retract(ToolSituation.CLEAR))
    assert legs(plan_lathe_approach(found, STANDS, OperatorChoices())) == [
        (-2.0, None, True),
        (None, -62.0, True),
    ]


def test_unwanted_functions_are_stopped_before_any_move() -> None:
    now = CurrentMachineState(
        STANDS.axis_positions, MODAL._replace(spindle=-1, coolant=True, outputs=frozenset({"live1"}))
    )
    found = replace(FOUND, checkpoint=AT._replace(modal=AT.modal._replace(coolant=False)))
    steps = plan_lathe_approach(found, now, OperatorChoices())
    assert order(steps)[:3] == ["M05", "M09", "LIVE1 OFF"]
    actions = [step.action for step in steps if isinstance(step, FunctionStep)]
    assert actions[:3] == [SpindleStop(), CoolantSwitch(False), OutputSwitch("live1", False)]


def test_starting_functions_are_listed_and_coolant_is_optional() -> None:
    told = [
        step.action
        for step in list_starting_functions(FOUND, STANDS, OperatorChoices())
        if isinstance(step, FunctionStep)
    ]
    assert told == [SpindleRun(800.0, None), CoolantSwitch(True)]
    without = make_lathe_pass_start(FOUND, STANDS, OperatorChoices(uses_coolant=False))
    assert not without.checkpoint.modal.coolant
    assert "M08" not in order(without.approach_steps)


def test_c_is_locked_and_turned_the_short_distance_clear_of_the_part() -> None:
    modal = AT.modal._replace(spindle=0, c_locked=True, coolant=False, offset_c=720.0)
    found = replace(FOUND, checkpoint=AT._replace(modal=modal, c=90.0))
    begin = make_lathe_pass_start(found, CurrentMachineState((30.0, -48.0, 1000.0), MODAL), OperatorChoices())
    turn = next(step for step in begin.approach_steps if isinstance(step, CAxisMove))
    assert turn.angle_deg == pytest.approx(1170.0)  # 90 degrees and three turns: the nearest to 1000
    assert begin.checkpoint.modal.offset_c == pytest.approx(1080.0)
    assert order(begin.approach_steps) == ["X", "M89", "C", "Z", "X"]


TWO = (
    "G90G94F300\nT1\nX.5Z.1\nM03S900\nZ-.3\nG95F.002X.4\nG94F300X.5\nZ2\n"
    "T2\nX.2Z.1\nG95F.003Z-.5\nG94F300Z2\nM30\n"
)
TOOLS = {1: ToolOffset(-10.0, -50.0), 2: ToolOffset(90.0, -20.0)}


def two(line: int, broken: Interruption | None = None) -> RestartPoint:
    """T1 cuts a groove at Z-.3 from X.5 (a radius), then T2, whose offset is another, bores at X.2."""
    found = OmniturnRestartSearch(
        ProgramSource("PART", TWO), setup(tools=TOOLS), lambda _count: None
    ).find_restart_point(line, 0, broken)
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


def in_the_groove(x: float = 0.42) -> tuple[CurrentMachineState, Interruption]:
    """T1 was stopped on line 6, in its groove; the fifth elementary block is that cut."""
    at = (-10.0 + x * INCH, -50.0 - 0.3 * INCH, 0.0)
    broken = Interruption(5, 1, at, 5)
    return CurrentMachineState(at, MODAL, broken), broken


def test_retract_uses_the_interrupted_tool_not_the_tool_of_the_line() -> None:
    now, broken = in_the_groove()
    back = plan_lathe_approach(two(6, broken), now, OperatorChoices())
    # X out of the groove at a feed; Z to the Z2 of T2, at machine -20 + 50.8; down again over the bar.
    assert spots(back, 1) == [(0.5, None, False), (None, 3.1811, True), (None, -0.3, True)]
    other = plan_lathe_approach(
        two(11, broken._replace(block_number=99, last_started_block=99)), now, OperatorChoices()
    )
    assert spots(other, 1)[:2] == [(0.5, None, False), (None, 3.1811, True)]


def test_tool_called_in_mdi_does_not_replace_the_tool_in_the_groove() -> None:
    now, _ = in_the_groove()
    by_hand = replace(now, modal=now.modal._replace(tool=2, tool_offset_x=90.0, tool_offset_z=-20.0))
    cut = two(6).cut_record
    assert cut is not None
    assert plan_exit_moves(cut, by_hand, OperatorChoices()) == plan_exit_moves(cut, now, OperatorChoices())


def test_tool_jogged_along_its_retract_path_completes_the_rest() -> None:
    now, _ = in_the_groove()
    cut = two(6).cut_record
    assert cut is not None
    moved = replace(now, axis_positions=(-10.0 + 0.47 * INCH, now.axis_positions[1], 0.0))
    assert spots(plan_exit_moves(cut, moved, OperatorChoices()), 1)[0] == (0.5, None, False)


def test_tool_jogged_elsewhere_in_the_part_requires_more_jogging() -> None:
    now, _ = in_the_groove()
    cut = two(6).cut_record
    assert cut is not None
    moved = replace(now, axis_positions=(now.axis_positions[0], now.axis_positions[1] + 3.0, 0.0))
    found, tool = plan_retract_from_part(cut, moved)
    assert not found.is_known
    assert tool == 1
    assert found.direction == (1, 0)  # X, and not Z


def test_tool_jogged_clear_retracts_only_along_z() -> None:
    now, _ = in_the_groove()
    cut = two(6).cut_record
    assert cut is not None
    clear = replace(now, axis_positions=(-10.0 + 0.8 * INCH, now.axis_positions[1], 0.0))
    assert plan_retract_from_part(cut, clear)[0].tool_situation is ToolSituation.CLEAR
    assert all(rapid for _, _, rapid in legs(plan_exit_moves(cut, clear, OperatorChoices())))


def test_unknown_interruption_requires_every_tool_to_be_clear() -> None:
    cut = two(6).cut_record
    assert cut is not None
    unknown = CurrentMachineState((-10.0 + 0.2 * INCH, -50.0 - 0.3 * INCH, 0.0), ModalState())
    assert not plan_retract_from_part(cut, unknown)[0].is_known
    assert plan_retract_from_part(cut, CurrentMachineState((40.0, cut.max_machine_z, 0.0), ModalState()))[
        0
    ].is_known


def test_position_after_a_power_cut_may_be_slightly_further_along() -> None:
    now, _ = in_the_groove()
    noted = Interruption(4, 1, (-10.0 + 0.5 * INCH, -50.0 + 0.05 * INCH, 0.0), 4, was_power_lost=True)
    cut = two(6).cut_record
    assert cut is not None
    assert spots(plan_exit_moves(cut, replace(now, interruption=noted), OperatorChoices()), 1)[0] == (
        0.5,
        None,
        False,
    )
    known = replace(now, interruption=noted._replace(was_power_lost=False))
    assert plan_exit_moves(cut, known, OperatorChoices()) == ()  # it was moved by hand, nobody knows whither


def test_tool_not_yet_called_is_brought_in_clear_of_the_whole_program() -> None:
    now, broken = in_the_groove()
    found = two(10, broken._replace(block_number=99, last_started_block=99))
    steps = plan_lathe_approach(
        found, replace(now, interruption=None, axis_positions=(40.0, 90.0, 0.0)), OperatorChoices()
    )
    assert all(rapid for _, _, rapid in legs(steps))


def test_line_that_starts_in_uncut_material_is_rejected() -> None:
    _, broken = in_the_groove()
    answer = OmniturnRestartSearch(
        ProgramSource("PART", TWO), setup(tools=TOOLS), lambda _count: None
    ).find_restart_point(12, 0, broken)
    assert not isinstance(answer, RestartPoint)
    uncut = text("search.uncut-lines", first=6, last=11)
    assert answer.why == text("search.in-uncut-material", line=12, uncut=uncut)
    assert two(9, broken).skipped_lines == (6, 6)  # the groove is begun, but not complete


def test_rest_of_an_interrupted_cut_is_skipped_unless_complete() -> None:
    _, broken = in_the_groove()
    rebuild = OmniturnRestartSearch(ProgramSource("PART", TWO), setup(tools=TOOLS), lambda _count: None)
    answer = rebuild.find_restart_point(7, 0, broken)
    assert not isinstance(answer, RestartPoint)
    uncut = text("search.uncut-line", line=6)
    assert answer.why == text("search.in-uncut-material", line=7, uncut=uncut)
    now, complete = in_the_groove(0.4)
    assert two(7, complete).skipped_lines == (0, 0)
    assert two(6, broken).skipped_lines == (0, 0)
    later = two(9, broken)
    assert later.skipped_lines == (6, 6)
    assert make_lathe_pass_start(later, now, OperatorChoices()).skips_cuts
    assert not make_lathe_pass_start(two(9, complete), now, OperatorChoices()).skips_cuts
