"""A program as it was read, before anything runs."""

from __future__ import annotations

import pytest

from core.interpreter.omniturn.motion.plain_moves import parse_plain_move
from core.interpreter.omniturn.omniturn_program import read_program
from core.language.source import ProgramSource
from tests.interpreter.programs import lines


def test_any_line_is_available_as_words_and_as_statement() -> None:
    program = read_program(ProgramSource("A", lines("G90F300", "X1Z2", "", "M30")))
    assert [word.text for word in program.get_line(2).words] == ["X1", "Z2"]
    made = program.get_statement(2)
    assert made is not None
    assert (made.get_value("X"), made.get_column("Z"), made.get_value("F"), made.get_column("F")) == (
        1,
        3,
        None,
        0,
    )
    assert program.get_statement(3) is None
    end = program.get_statement(4)
    assert end is not None
    assert end.m_number == 30


@pytest.mark.parametrize(
    ("text", "move"),
    [
        ("X.1234Z-.5678", (0.1234, -0.5678, None, -1, False)),
        ("z+1.", (None, 1.0, None, -1, False)),
        ("X1.00005", (1.00005, None, None, -1, True)),
        ("G01X1F.003", (1.0, None, 0.003, 1, False)),
        ("g00z1", (None, 1.0, None, 0, False)),
        ("X1Z2F3", (1.0, 2.0, 3.0, -1, False)),
    ],
)
def test_plain_moves_are_read_as_numbers(text: str, move: tuple[object, ...]) -> None:
    assert parse_plain_move(text) == move


@pytest.mark.parametrize(
    "text",
    ["", "G00", "F20", "G01F2", "Z1X1", "X 1", "X1.000001", "X12345", "X1F0", "G02X1", "X1.2.3", "X", "X1X1"],
)
def test_other_lines_are_not_read_as_plain_moves(text: str) -> None:
    assert parse_plain_move(text) is None


def test_errors_are_reported_despite_flood_of_warnings() -> None:
    inside = ["(PLXC)"] * 150
    program = read_program(ProgramSource("A", lines("G90F300", *inside, "X1N5", "M30")))
    weighty = [found for found in program.diagnostics if found.severity != "note"]
    assert len(weighty) == 100
    assert weighty[-1].code == "n-word"


def test_errors_are_limited_to_100() -> None:
    program = read_program(ProgramSource("A", lines("G90F300", *["X1Z"] * 300, "M30")))
    assert [found.code for found in program.diagnostics] == ["number-missing"] * 100


@pytest.mark.parametrize(("times", "found"), [(4, [1, 1, 1, 1]), (5, [5]), (300, [300])])
def test_repeated_g_digit_errors_are_one_error_with_count(times: int, found: list[int]) -> None:
    program = read_program(ProgramSource("A", lines("G90F300", *["G2X1"] * times, "M30")))
    assert [each.occurrence_count for each in program.diagnostics if each.code == "g-digits"] == found


def test_finding_repeated_on_every_line_is_reported_once_with_count() -> None:
    program = read_program(ProgramSource("A", lines("G90F300", *["N5X1"] * 300, "M30")))
    assert [(found.line, found.code, found.occurrence_count) for found in program.diagnostics] == [
        (2, "n-word", 300)
    ]
    text = "\r\n".join(("G90F300", "", "X1", "", "", "M30", ""))
    told = [
        (found.code, found.line, found.occurrence_count)
        for found in read_program(ProgramSource("A", text)).diagnostics
    ]
    assert told == [("blank-line", 2, 3), ("line-ends", 1, 6)]


def test_reading_invalid_program_raises_no_exception() -> None:
    program = read_program(ProgramSource("A", "G2\n}1\nLF\n(\n)\nM99\nLS0\n"))
    codes = {found.code for found in program.diagnostics}
    assert {"g-digits", "no-end", "loop-unopened", "comment-open", "comment-close", "loop-count"} <= codes
