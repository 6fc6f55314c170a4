"""Loops, subroutines, conditions, block delete."""

from __future__ import annotations

import pytest

from core.interpreter.omniturn.omniturn_interpreter import Interpreter
from core.interpreter.shared.actions import InputRead
from tests.interpreter.programs import body, lines, passed, setup

SUBS = ("}1", "X1", "X2", "M99", "}2", "Z5", "M98P1", "M99")


def path(*program: str) -> list[int]:
    """Lines whose moves are executed, in order."""
    result = passed(lines("G90G94F300", *program))
    assert result.errors == []
    return [block.line for block in result.moves]


@pytest.mark.parametrize(
    ("program", "order"),
    [
        (("LS3", "X1", "LF", "M30"), [3, 3, 3]),
        (("LS1", "X1", "LF", "X2", "M30"), [3, 5]),
        (("LS2", "X1", "LS3", "X2", "LF", "X3", "LF", "M30"), [3, 5, 5, 5, 7, 3, 5, 5, 5, 7]),
        (("LS2", "LF", "X1", "M30"), [4]),
        (("M98P1", "X3", "M30", *SUBS), [6, 7, 3]),
        (("P1", "M30", *SUBS), [5, 6]),
        (("M98P2", "M30", *SUBS), [9, 5, 6]),
        (("LS2", "M98P1", "LF", "M30", *SUBS), [7, 8, 7, 8]),
        (("M98P1", "M30", "}1", "LS2", "X1", "LF", "X2", "M99"), [6, 6, 8]),
        (("M98P1", "X9", "M30", "}1", "X1", "M30", "M99"), [6]),  # M30 inside ends the job too
        (("M98P1", "X9", "M30", "}1", "X1", "M30"), [6]),  # and closes it without an M99
        (("M98P2", "X9", "M30", "}1", "X1", "M02", "}2", "X2", "M99"), [9, 3]),
        (("M30", "}1", "X1", "M99"), []),
    ],
)
def test_loops_and_subroutines_run_lines_in_order(program: tuple[str, ...], order: list[int]) -> None:
    assert path(*program) == order


@pytest.mark.parametrize(
    ("call", "terminal", "on", "taken"),
    [
        ("M95", "TB2-9", True, True),
        ("M95", "TB2-9", False, False),
        ("M97I10C1P1", "10", True, True),
        ("M97I10C1P1", "10", False, False),
        ("M97I10C0P1", "10", False, True),
        ("M97I3C0P1", "3", True, False),
    ],
)
def test_conditional_call_follows_its_input(call: str, terminal: str, on: bool, taken: bool) -> None:
    text = lines("G90F300", call, "M30", "}1", "X1", "M99")
    result = passed(text, setup(inputs=lambda asked: on if asked == terminal else not on))
    assert result.errors == []
    assert result.actions[0] == InputRead(terminal)
    assert [block.line for block in result.moves] == ([5] if taken else [])


def test_input_is_read_only_after_its_block_is_run() -> None:
    state = {"TB2-9": False}
    program = passed(lines("G90F300", "M95", "M30", "}1", "X1", "M99")).program
    blocks = Interpreter(program, setup(inputs=lambda terminal: state[terminal])).generate_blocks()
    assert next(blocks).action == InputRead("TB2-9")
    state["TB2-9"] = True
    assert [block.line for block in blocks] == [5, 3]


@pytest.mark.parametrize(("delete", "order"), [(False, [2, 3, 4]), (True, [3])])
def test_block_delete_skips_lines_with_slash(delete: bool, order: list[int]) -> None:
    text = lines("G90F300", "/X1", "X2", " / Z1", "M30")
    assert [block.line for block in passed(text, setup(block_delete=delete)).moves] == order


def test_first_line_check_applies_to_first_line_that_runs() -> None:
    text = lines("(title)", "/X1", "G90F300", "X2", "M30")
    assert passed(text, setup(block_delete=True)).errors == []
    assert passed(text).errors == [(2, 1, "first-line"), (2, 0, "feed-missing")]


def test_comment_in_loop_causes_one_warning() -> None:
    result = passed(body("LS2", "X1(a)", "LS2", "X2(b)", "LF", "LF(c)", "X3(d)"))
    assert result.warnings == [(4, 0, "comment-in-loop")]
    assert [found.occurrence_count for found in result.interpreter.diagnostics] == [2]  # lines 4 and 6


def test_calls_may_nest_sixteen_deep() -> None:
    subs = [line for n in range(1, 17) for line in (f"}}{n}", f"M98P{n + 1}" if n < 16 else "X1", "M99")]
    assert path("M98P1", "M30", *subs) == [3 + 15 * 3 + 2]


def test_calls_nested_more_than_16_deep_are_rejected() -> None:
    subs = [line for n in range(1, 18) for line in (f"}}{n}", f"M98P{n + 1}" if n < 17 else "X1", "M99")]
    result = passed(lines("G90F300", "M98P1", "M30", *subs))
    assert result.errors == [(3 + 15 * 3 + 2, 4, "recursion")]
    assert result.moves == []
