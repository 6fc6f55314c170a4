"""Shops' files as they are: they load and run with one note a kind, and strictly each is an error."""

from __future__ import annotations

import pytest

from tests.interpreter.programs import lines, passed

CASES = [
    (lines("G90F300", "", "X1", " ", "M30"), "blank-line", [(2, 0), (4, 0)]),
    (lines("(PART 7)", "G90F300", "(SIDE B)", "X1", "M30"), "title-line", [(1, 1), (3, 1)]),
    (lines("G90F300", "X1(R.5 - ROUGH)", "X2(A/B)", "M30"), "comment-character", [(2, 3), (3, 3)]),
    (lines("G90F300", "T01", "X1Z1T02", "M30"), "tool-zero", [(2, 1), (3, 5)]),
    (lines("G90F300", "M30", "}1(SUB)", "M99", "}2 (SUB)", "M99"), "subroutine-comment", [(3, 3), (5, 4)]),
    ("G90F300\r\nX1\r\nM30\r\n", "line-ends", [(1, 0)]),
    ("G90F300\nX1\nM30", "last-newline", [(3, 0)]),
]


@pytest.mark.parametrize(("text", "kind", "places"), CASES, ids=[kind for _, kind, _ in CASES])
def test_each_kind_of_deviation_gets_one_note(text: str, kind: str, places: list[tuple[int, int]]) -> None:
    result = passed(text)
    assert result.notes == [(*places[0], kind)]
    assert result.errors == []
    assert result.blocks[-1].text == "M30"


@pytest.mark.parametrize(("text", "kind", "places"), CASES, ids=[kind for _, kind, _ in CASES])
def test_strict_mode_makes_each_deviation_an_error(
    text: str, kind: str, places: list[tuple[int, int]]
) -> None:
    result = passed(text, strict=True)
    assert result.errors == [(*place, kind) for place in places]
    assert result.notes == []


def test_clean_program_has_no_notes_in_strict_mode() -> None:
    result = passed(lines("G90G94F300", "T1(LH TURN TOOL)", "X1Z1", "M30"), strict=True)
    assert result.interpreter.diagnostics == []


def test_archive_file_runs_with_one_note_per_kind() -> None:
    text = "(PART-7.NC)\r\n\r\n\r\nG90G94F300\r\n(T1 = TURN)\r\nT01\r\nX1Z1\r\n\r\nM30"
    result = passed(text)
    assert result.errors == []
    assert result.warnings == []
    assert sorted(code for _, _, code in result.notes) == [
        "blank-line",
        "comment-character",
        "last-newline",
        "line-ends",
        "title-line",
        "tool-zero",
    ]
    assert [block.text for block in result.blocks] == ["T01", "X1Z1", "M30"]


@pytest.mark.parametrize(
    ("line", "column", "code"),
    [("N5X1", 1, "n-word"), ("X1,2", 3, "comma"), ("G2X1", 1, "g-digits"), ("(A", 1, "comment-open")],
)
def test_some_deviations_are_always_rejected(line: str, column: int, code: str) -> None:
    assert passed(lines("G90F300", line, "M30")).errors == [(2, column, code)]


def test_source_blocks_are_counted_without_comments_and_blanks() -> None:
    assert (
        passed(lines("(A)", "G90F300", "", "X1", "X1.23456", "T1(B)", "LS2", "LF", "M30")).program.block_count
        == 7
    )
