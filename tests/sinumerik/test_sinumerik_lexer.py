"""Blocks as text: words, numbers, labels, skips and comments; and the coloured parts of a line."""

from __future__ import annotations

import pytest

from core.language.formulas import Parameter
from core.language.sinumerik import PositionMode, lex_line
from core.language.sinumerik.sinumerik_colors import color_line
from core.language.syntax_colors import SyntaxKind


def words(text: str) -> list[tuple[str, float | None]]:
    line = lex_line(1, text)
    assert line.errors == ()
    return [(word.name, word.value) for word in line.words]


def test_single_letter_words_need_no_blanks_or_equal_signs() -> None:
    assert words("G1X10Z-2.5F.4") == [("G", 1), ("X", 10), ("Z", -2.5), ("F", 0.4)]
    assert words("G1 X=10 Z = -2.5 F=.4") == [("G", 1), ("X", 10), ("Z", -2.5), ("F", 0.4)]
    assert words("S270") == words("S270.0") == words("S=270.") == [("S", 270)]


def test_words_of_several_letters_require_equal_signs() -> None:
    assert words("X10CR=5 LIMS=2500") == [("X", 10), ("CR", 5), ("LIMS", 2500)]
    assert lex_line(1, "CR5").errors[0].code == "12080"


def test_words_are_case_insensitive() -> None:
    assert words("g1 x=ic(3) diamon") == words("G1 X=IC(3) DIAMON")


@pytest.mark.parametrize("text", ["TRANS=3", "NORM = -R1", "NORM[1]=3", "G1 SETMS=(1)", "WAITS[R1]=SET(1)"])
def test_words_without_value_do_not_accept_equal_signs(text: str) -> None:
    line = lex_line(1, text)
    assert [error.code for error in line.errors] == ["12080"]
    assert all(word.name == "G" for word in line.words)


@pytest.mark.parametrize("form", ["AC", "IC", "DC", "ACP", "ACN"])
def test_target_forms_are_read(form: str) -> None:
    (word,) = lex_line(1, f"C = {form}( -7.25 )").words
    assert (word.position_mode, word.value, word.text) == (PositionMode(form), -7.25, f"C={form}(-7.25)")


def test_r_parameters_are_accepted_as_values() -> None:
    (word,) = lex_line(1, "C=DC(R12)").words
    assert (word.position_mode, word.value, word.formula) == (PositionMode.DC, None, Parameter("R", 12, 6))
    assert lex_line(1, "X=R3").words[0].formula == Parameter("R", 3, 3)
    assert lex_line(1, "X=-2.5").words[0].value == -2.5
    assert words("R3=17.5 R4=-2") == [("R3", 17.5), ("R4", -2)]
    assert lex_line(1, "X=R300").errors


@pytest.mark.parametrize(
    ("text", "block", "label", "skip"),
    [
        ("N10 X1", "N10", "", None),
        (":20 X1", ":20", "", None),
        ("/N10 X1", "N10", "", 0),
        ("/3 N10 X1", "N10", "", 3),
        ("N10 START: X1", "N10", "START", None),
        ("START: X1", "START", "START", None),
        ("X1", "in line 1", "", None),
    ],
)
def test_prefix_before_words_is_read(text: str, block: str, label: str, skip: int | None) -> None:
    line = lex_line(1, text)
    assert (line.block_name, line.label, line.skip_level, len(line.words)) == (block, label, skip, 1)


def test_comment_is_not_a_word_and_brackets_are_not_a_comment() -> None:
    line = lex_line(1, "X1 ; Y5 (T1)")
    assert (len(line.words), line.comment_column, line.errors) == (1, 4, ())
    assert lex_line(1, "X1 (here)").errors
    assert not lex_line(1, "   ; only this").is_executable


def test_subprogram_calls_are_read() -> None:
    line = lex_line(1, "N5 NUT_1 P3 ; three times")
    assert (line.called_name, line.execution_count, line.errors) == ("NUT_1", 3, ())
    assert lex_line(1, "L100").called_name == "L100"
    assert lex_line(1, "POS1").called_name == "POS1"
    assert lex_line(1, "CYCLE95").called_name == "CYCLE95"
    assert lex_line(1, "NUT_1 X5").errors
    assert lex_line(1, "X5 NUT_1").errors
    assert lex_line(1, "NUT_1(5").errors
    assert lex_line(1, "NUT P0").errors


def test_first_error_of_block_is_reported_with_its_column() -> None:
    (error,) = lex_line(4, "N5 G1 X=DC( Z?").errors
    assert (error.line, error.column) == (4, 7)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\x00",
        "ß=5",
        "=5",
        "X==5",
        "C=DC((5))",
        "N",
        "/",
        "C=AC",
        "X=+",
        "(" * 500,
        "G" + "9" * 400,
        "X" + "9" * 400,
        "R" + "9" * 400 + "=1",
    ],
)
def test_lexer_survives_any_text(text: str) -> None:
    lex_line(1, text)
    color_line(text)


def test_line_parts_are_colored_by_kind() -> None:
    text = "N5 G1 C = DC(5) F100 DIAMON ; turn"
    found = {text[start : start + length]: ink for start, length, ink in color_line(text)}
    assert found == {
        "N5": SyntaxKind.NUMBER,
        "G1": SyntaxKind.CODE,
        "C = DC(5)": SyntaxKind.POSITION,
        "F100": SyntaxKind.FEED_AND_SPEED,
        "DIAMON": SyntaxKind.KEYWORD,
        "; turn": SyntaxKind.COMMENT,
    }


def test_headers_calls_and_errors_are_colored_by_kind() -> None:
    assert color_line("%_N_NUT_SPF")[0].kind is SyntaxKind.CALL
    assert color_line("NUT P2")[0] == (0, 3, SyntaxKind.CALL)
    assert color_line("X5 B1")[-1] == (3, 1, SyntaxKind.ERROR)


def test_numbers_with_too_many_digits_are_rejected() -> None:
    for letter in "GMXFS":
        assert lex_line(1, letter + "9" * 400).errors[0].code == "12080"
