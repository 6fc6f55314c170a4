"""Lines that are good for going on, lines that are not and why, and what a good one inherits."""

from __future__ import annotations

import pytest

from core.interpreter.restart.restart_point import Interruption, RestartPoint, RestartRejection
from core.interpreter.restart.state_rebuild import OmniturnRestartSearch
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from tests.interpreter.programs import INCH, setup
from tests.texts import text as text_of


def find(text: str, line: int, visit: int = 0, **given: object) -> RestartPoint | RestartRejection:
    found_setup = setup(**given)  # type: ignore[arg-type]
    return OmniturnRestartSearch(
        ProgramSource("PART", text), found_setup, lambda _count: None
    ).find_restart_point(line, visit)


PLAIN = "G90G94F300G72\nT1\nX1Z.1\nM03S900\nM08\nG95F.005Z-.5\nX1.1\nM30\n"
NOSE = "G90G94F300\nX1Z1\nG41\nX.5Z.2D1\nZ-.5\nX1\nG40\nZ1\nM30\n"
CONTOUR = "G90G94F300\nX1Z.1\nG75I.1U.01F10\nX.5Z0\nZ-.5\nX.9\nRF\nZ1\nM30\n"
CORNER = "G90G94F100\nX1Z1\nX.5C.05\nM08\nZ-.5\nX1\nM30\n"
CALLED = "G90G94F300\nX1Z1\nM98P1\nX2\nM30\n}1\nZ.5\nZ1\nM99\n"
NEVER = "G90G94F300\nX1Z1\nX2\nM30\n}1\nZ.5\nZ1\nM99\n"
BEHIND = "G90G94F300\nX1Z1\nX2\nM30\n\n}1\nZ.5\nM99\n"
PLANE = "G90G94F300\nX-.5Z.1\nM19\n(~PLXC)\n(X.5Y.1)\n(END)\nM05\nM30\n"


def test_line_inherits_the_complete_state() -> None:
    found = find(PLAIN, 7, tools={1: ToolOffset(-10.0, -20.0)})
    assert isinstance(found, RestartPoint)
    point, modal = found.checkpoint, found.checkpoint.modal
    assert point.machine == pytest.approx((-10.0 + 0.5 * INCH, -20.0 - 0.5 * INCH))
    assert (modal.diameter, modal.tool, modal.spindle, modal.rpm, modal.coolant) == (True, 1, 1, 900.0, True)
    assert (modal.per_rev, modal.feed) == (True, pytest.approx(0.005 * INCH))
    assert point.first_feed == pytest.approx(300 * INCH / 60)  # it goes on to count as a rapid
    assert found.cut_record is not None
    assert found.cut_record.max_feed_radius == pytest.approx(0.55 * INCH)  # it feeds to X1.1, a diameter
    assert found.cut_record.max_machine_z == pytest.approx(-20.0 + 0.1 * INCH)


@pytest.mark.parametrize(
    ("text", "line", "why", "before", "after"),
    [
        (NOSE, 5, "Line 5 uses the nose compensation that begins on line 3.", 3, 8),
        (NOSE, 7, "Line 7 uses the nose compensation that begins on line 3.", 3, 8),
        (CONTOUR, 5, text_of("search.in-contour", line=5, begin=3), 3, 8),
        (CORNER, 4, text_of("search.in-corner", line=4, begin=3), 3, 6),
        (CORNER, 5, text_of("search.in-corner", line=5, begin=3), 3, 6),
        (CALLED, 6, "The program never reaches line 6.", 3, 0),  # its call
        (NEVER, 6, "The program never reaches line 6.", 4, 0),
        (BEHIND, 5, "Line 5 is after the end of the program.", 4, 0),
        (PLANE, 5, text_of("search.in-plane", line=5, begin=4), 4, 7),
        (PLAIN, 99, "Line 99 does not exist; the last line of the program is 8.", 8, 0),
        ("G90G94F300\nX1Z1\n\nX2\nM30\n", 3, "Line 3 is empty.", 2 + 0, 4),
    ],
)
def test_invalid_lines_are_rejected_with_the_nearest_valid_ones(
    text: str, line: int, why: str, before: int, after: int
) -> None:
    answer = find(text, line, secondary={1: (-0.015, -0.015, 0.015)})
    assert isinstance(answer, RestartRejection)
    assert answer.why == why
    assert (answer.nearest_line_before, answer.nearest_line_after) == ((0 if before == 2 else before), after)


@pytest.mark.parametrize("line", [1, 2])
def test_line_before_any_axis_motion_is_rejected(line: int) -> None:
    answer = find("G90G94F300\nT1\nX1Z1\nX2\nM30\n", line)
    assert isinstance(answer, RestartRejection)
    assert answer.why.startswith(f"No axis has moved before line {line}")
    assert (answer.nearest_line_before, answer.nearest_line_after) == (0, 4)


IN_A_LOOP = "G90G94F300\nT1\nLS3\nX1Z.1\nX.5\nG91Z-.1\nG90X1\nLF\nM30\n"


@pytest.mark.parametrize(("visit", "expected"), [(0, 1), (1, 1), (2, 2), (3, 3)])
def test_loop_with_the_first_move_is_entered_in_every_pass(visit: int, expected: int) -> None:
    answer = find(IN_A_LOOP, 5, visit=visit)
    assert isinstance(answer, RestartPoint)
    assert (answer.visit.visit_number, answer.visit.visit_count) == (expected, 3)
    assert answer.checkpoint.machine == pytest.approx((INCH, 0.1 * INCH))


def test_first_move_in_a_loop_is_valid_only_from_the_second_pass() -> None:
    first, second = find(IN_A_LOOP, 4, visit=1), find(IN_A_LOOP, 4, visit=2)
    assert isinstance(first, RestartRejection)
    assert isinstance(second, RestartPoint)


def test_loop_of_only_incremental_moves_is_rejected() -> None:
    text = "G91G94F300\nT1\nLS3\nX.1Z-.1\nX-.1\nLF\nM30\n"
    assert all(isinstance(find(text, 5, visit=each), RestartRejection) for each in (1, 2, 3))


def test_incremental_moves_are_rejected_until_both_axes_are_known() -> None:
    text = "G91G94F300\nX.1Z.1\nX.1\nG90X1\nG91Z.1\nG90Z1\nG91X.1\nX.2\nM30\n"
    said = {line: find(text, line) for line in range(3, 9)}
    for line in (3, 4, 5, 6):
        answer = said[line]
        assert isinstance(answer, RestartRejection)
        assert "depend on the axis positions at Cycle Start" in answer.why
        assert answer.nearest_line_after == 7
    assert isinstance(said[7], RestartPoint)
    assert isinstance(said[8], RestartPoint)  # incremental, from a place that is known


def test_preset_at_an_unknown_position_remains_unknown() -> None:
    text = "G90G94F300\nG92X0Z0\nX1Z1\nX2\nT1\nX1Z1\nX2\nM30\n"
    answer = find(text, 4)
    assert isinstance(answer, RestartRejection)
    assert answer.nearest_line_after == 7
    assert isinstance(find(text, 7), RestartPoint)


def test_result_of_an_input_is_not_assumed() -> None:
    sub = "}1\nZ.5\nM99\n"
    text = f"G90G94F300\nX1Z1\nM97I3C1P1\nX2\nZ2\nX1\nM30\n{sub}"
    answer = find(text, 4)
    assert isinstance(answer, RestartRejection)
    assert answer.why == text_of("search.input-read", line=4, asked=3)
    assert (answer.nearest_line_before, answer.nearest_line_after) == (
        3,
        6,
    )  # behind Z2 both answers lead to one place
    assert isinstance(find(text, 3), RestartPoint)
    assert isinstance(find(text, 6), RestartPoint)


def test_second_unknown_input_result_is_rejected() -> None:
    text = "G90G94F300\nX1Z1\nM97I3C1P1\nM97I4C1P1\nX2Z2\nX1\nM30\n}1\nG91Z.5\nG90\nM99\n"
    answer = find(text, 6)
    assert isinstance(answer, RestartRejection)
    assert text_of("search.unknown-input", asked=4) in answer.why


def test_line_after_an_input_test_in_a_loop_or_subroutine_is_rejected() -> None:
    text = "G90G94F300\nX1Z1\nLS2\nM97I3C1P1\nLF\nX1Z1\nX2\nM30\n}1\nZ.5\nM99\n"
    answer = find(text, 7)
    assert isinstance(answer, RestartRejection)
    assert text_of("search.unknown-terminal", asked=4, terminal=3) in answer.why


def test_line_after_the_program_end_or_an_error_is_rejected() -> None:
    answer = find("G90G94F300\nX1Z1\nM97I3C0P1\nX2\nM30\n}1\nM30\nM99\n", 4)
    assert isinstance(answer, RestartRejection)
    broken = find("G90G94F300\nX1Z1\nX1R9\nX2\nX3\nM30\n", 5)
    assert isinstance(broken, RestartRejection)
    assert broken.why == "The program has errors before line 5."


def test_restart_search_works_after_a_loop_and_for_an_earlier_line() -> None:
    text = "G90G94F300\nX1Z1\nLS50\nG91X-.01\nZ-.01\nLF\nG90\nX1Z1\nM30\n"
    rebuild = OmniturnRestartSearch(ProgramSource("PART", text), setup(), lambda _count: None)
    first, later, earlier = (
        rebuild.find_restart_point(3),
        rebuild.find_restart_point(7),
        rebuild.find_restart_point(3),
    )
    assert isinstance(first, RestartPoint)
    assert isinstance(later, RestartPoint)
    assert later.checkpoint.x == pytest.approx(0.5 * INCH)
    assert later.checkpoint.blocks == 101
    assert earlier == first


def test_outdated_search_is_canceled() -> None:
    class GivenUpError(Exception):
        pass

    def watch(count: float) -> None:
        if count > 5000:
            raise GivenUpError

    text = "G90G94F300\nX1Z1\nLS90000\nX1\nX2\nLF\nX1\nM30\n"
    with pytest.raises(GivenUpError):
        OmniturnRestartSearch(ProgramSource("PART", text), setup(), watch).find_restart_point(7)


NESTED = "G90G94F300\nX1Z1\nLS2\nG91X-.1\nLS3\nZ-.1\nLF\nM98P1\nLF\nG90\nX1Z1\nM30\n}1\nX.05\nM99\n"


def visit(text: str, line: int, number: int, broken: Interruption | None = None) -> RestartPoint:
    found = OmniturnRestartSearch(
        ProgramSource("PART", text), setup(), lambda _count: None
    ).find_restart_point(line, number, broken)
    assert isinstance(found, RestartPoint), found
    return found


@pytest.mark.parametrize(
    ("line", "number", "of", "x", "z", "within"),
    [
        # Worked out by hand: each outer pass takes X .1 in, three times Z .1 in, and X .05 out again.
        (3, 1, 1, 1.0, 1.0, ()),
        (4, 1, 2, 1.0, 1.0, ((3, 9, 1, 2),)),
        (4, 2, 2, 0.95, 0.7, ((3, 9, 2, 2),)),
        (6, 1, 6, 0.9, 1.0, ((3, 9, 1, 2), (5, 7, 1, 3))),
        (6, 3, 6, 0.9, 0.8, ((3, 9, 1, 2), (5, 7, 3, 3))),
        (6, 5, 6, 0.85, 0.6, ((3, 9, 2, 2), (5, 7, 2, 3))),
        (8, 2, 2, 0.85, 0.4, ((3, 9, 2, 2),)),
        (14, 2, 2, 0.85, 0.4, ((3, 9, 2, 2), (8, 1))),
        (9, 2, 2, 0.9, 0.4, ((3, 9, 2, 2),)),
    ],
)
def test_passes_of_nested_loops_and_calls_are_counted(
    line: int, number: int, of: int, x: float, z: float, within: tuple[tuple[int, ...], ...]
) -> None:
    found = visit(NESTED, line, number)
    assert (found.visit.visit_number, found.visit.visit_count) == (number, of)
    assert tuple(tuple(each) for each in found.visit.enclosing_levels) == within
    assert (found.checkpoint.x / INCH, found.checkpoint.z / INCH) == pytest.approx((x, z))


def test_work_shift_of_a_pass_accumulates_over_previous_passes() -> None:
    bar = "G90G94F300\nX1Z1\nLS4\nT1\nX1Z1\nG94F10X.5\nF300X1\nG10X0Z-.35\nLF\nM30\n"
    third = visit(bar, 6, 3).checkpoint.modal
    assert third.shift_z == pytest.approx(-0.7 * INCH)
    assert third.pending_shift_z == pytest.approx(-0.7 * INCH)


def test_interrupted_pass_is_the_default() -> None:
    # X1Z1 is block 1, the first outer pass 2 to 6, the second 7 to 11: in that line 6 is 8, 9, 10.
    found = visit(NESTED, 6, 0, Interruption(9, 0, (0.0, 0.0, 0.0), 9))
    assert found.visit.visit_number == 5
    assert found.interrupted_visit == found.visit
    other = visit(NESTED, 6, 2, Interruption(9, 0, (0.0, 0.0, 0.0), 9))
    assert (other.visit.visit_number, other.interrupted_visit) == (2, found.visit)


@pytest.mark.parametrize(
    ("text", "line", "number", "why"),
    [
        (NESTED, 6, 7, text_of("search.no-such-pass", line=6, count=6, wanted=7)),
        (NESTED, 13, 1, "The program never reaches line 13."),
        (
            "G90G94F300\nX1Z1\nLS3\nX1\nM97I3C1P1\nX2\nLF\nM30\n}1\nZ.5\nM99\n", 6, 2,
            f"The program cannot resume at line 6: {text_of('search.unknown-terminal', asked=5, terminal=3)}",
        ),
        (
            "G91G94F300\nX.1\nLS3\nX.1\nLF\nM30\n", 4, 2,
            "The program cannot resume at line 4, because the axis positions there depend on the "
            "axis positions "
            "at Cycle Start.",
        ),
        (
            "G90G94F300\nX1Z1\nLS30000\nX1\nX2\nLF\nX1\nM30\n", 5, 2,
            text_of("search.too-many-passes", line=5, most="20,000"),
        ),
    ],
)  # fmt: skip
def test_invalid_passes_are_rejected(text: str, line: int, number: int, why: str) -> None:
    answer = OmniturnRestartSearch(
        ProgramSource("PART", text), setup(), lambda _count: None
    ).find_restart_point(line, number)
    assert isinstance(answer, RestartRejection)
    assert answer.why == why
