"""Words of a line: letter, number, column; and everything that is none."""

from __future__ import annotations

import pytest

from core.language.omniturn import Word, lex_line


def words(text: str) -> list[tuple[str, float | None, int]]:
    line = lex_line(1, text)
    assert line.errors == ()
    return [(word.letter, word.value, word.column) for word in line.words]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("G90G94F300", [("G", 90, 1), ("G", 94, 4), ("F", 300, 7)]),
        ("x-.5z+1.", [("X", -0.5, 1), ("Z", 1.0, 5)]),
        ("X.5Z0", [("X", 0.5, 1), ("Z", 0, 4)]),
        (" X 1 . 5  z - 2", [("X", 1.5, 2), ("Z", -2, 11)]),
        ("\tM03 S2000", [("M", 3, 2), ("S", 2000, 6)]),
        ("T01D2", [("T", 1, 1), ("D", 2, 4)]),
        ("LS16", [("LS", 16, 1)]),
        ("LF", [("LF", None, 1)]),
        ("ls4", [("LS", 4, 1)]),
        ("RF", [("RF", None, 1)]),
        ("}12", [("}", 12, 1)]),
        ("P1", [("P", 1, 1)]),
        ("CA-45.1Z-.3S3.5", [("CA", -45.1, 1), ("Z", -0.3, 8), ("S", 3.5, 12)]),
        ("CI90", [("CI", 90, 1)]),
        ("X.27C.03", [("X", 0.27, 1), ("C", 0.03, 5)]),
        ("G83Z-.5K.1R.5L300", [("G", 83, 1), ("Z", -0.5, 4), ("K", 0.1, 8), ("R", 0.5, 11), ("L", 300, 14)]),
        ("G33K.05PCO", [("G", 33, 1), ("K", 0.05, 4), ("P", None, 8), ("C", None, 9), ("O", None, 10)]),
        ("G33K.05CA.03", [("G", 33, 1), ("K", 0.05, 4), ("C", None, 8), ("A", 0.03, 9)]),
        ("G33K.05CI.01", [("G", 33, 1), ("K", 0.05, 4), ("C", None, 8), ("I", 0.01, 9)]),
        ("G33K.05 P O", [("G", 33, 1), ("K", 0.05, 4), ("P", None, 9), ("O", None, 11)]),
        ("X1(a)Z2", [("X", 1, 1), ("Z", 2, 6)]),
        ("", []),
    ],
)  # fmt: skip
def test_lexer_splits_line_into_words(text: str, expected: list[tuple[str, float | None, int]]) -> None:
    assert words(text) == expected


def test_words_retain_their_original_text() -> None:
    assert lex_line(1, "x -.50 F.003").words == (Word("X", -0.5, 1, "x-.50"), Word("F", 0.003, 8, "F.003"))


@pytest.mark.parametrize(
    ("text", "comment", "column", "code"),
    [
        ("T1(Drehmeißel, 8°)", "Drehmeißel, 8°", 3, "T1"),
        ("(title)", "title", 1, ""),
        ("M00 ( turn part ) ", " turn part ", 5, "M00"),
        ("X1(a)Z2(b)", "a b", 3, "X1Z2"),
        ("X1()", "", 3, "X1"),
        ("X 1 ( X 2 )", " X 2 ", 5, "X1"),
    ],
)
def test_comments_are_preserved(text: str, comment: str, column: int, code: str) -> None:
    line = lex_line(1, text)
    assert (line.comment, line.comment_column, line.text, line.errors) == (comment, column, code, ())


def test_line_without_parenthesis_has_no_comment() -> None:
    assert lex_line(1, "X1").comment is None


def test_slash_sets_block_delete() -> None:
    line = lex_line(3, " /G00X1")
    assert line.has_block_delete
    assert [word.column for word in line.words] == [3, 6]
    assert not lex_line(3, "G00X1").has_block_delete


REFUSED = [
    ("GO2X1", 2, "letter-o"),
    ("MO5", 2, "letter-o"),
    ("XO", 2, "letter-o"),
    ("X1O", 3, "letter-o"),
    ("X.O5", 1, "lone-point"),
    ("TO1", 2, "letter-o"),
    ("G33K.05O5", 8, "letter-o"),
    ("G33XO", 5, "letter-o"),
    ("G2X1", 1, "g-digits"),
    ("G002", 1, "g-digits"),
    ("G1.", 1, "g-digits"),
    ("G-1", 1, "g-digits"),
    ("G90.", 1, "g-digits"),
    ("X1M4", 3, "m-digits"),
    ("M003", 1, "m-digits"),
    ("X1e999", 3, "exponent"),
    ("F.003E005", 6, "exponent"),
    ("E.005", 1, "unknown-letter"),
    ("Y1", 1, "unknown-letter"),
    ("W", 1, "unknown-letter"),
    ("N10G90", 1, "n-word"),
    ("X1,5", 3, "comma"),
    ("X,5", 2, "comma"),
    ("G01Z,125F2", 5, "comma"),
    (",", 1, "comma"),
    ("X1.2.3", 5, "two-points"),
    ("X..5", 1, "lone-point"),
    ("X1-2", 3, "sign-inside"),
    ("X--1", 1, "lone-sign"),
    ("X-", 1, "lone-sign"),
    ("X.", 1, "lone-point"),
    ("P-", 1, "lone-sign"),
    ("X", 1, "number-missing"),
    ("XZ1", 1, "number-missing"),
    ("X1F", 3, "number-missing"),
    ("LS", 1, "number-missing"),
    ("}", 1, "number-missing"),
    ("CI", 1, "number-missing"),
    ("LF3", 1, "number-unwanted"),
    ("RF2", 1, "number-unwanted"),
    ("123", 1, "letter-missing"),
    ("-.5X1", 1, "letter-missing"),
    ("T33", 1, "tool-number"),
    ("T1.5", 1, "whole-number"),
    ("T-1", 1, "whole-number"),
    ("D33", 1, "offset-number"),
    ("D1.", 1, "whole-number"),
    ("LS0", 1, "loop-count"),
    ("LS2.5", 1, "whole-number"),
    ("}0", 1, "out-of-range"),
    ("M98P0", 4, "out-of-range"),
    ("X10001", 1, "out-of-range"),
    ("Z-99999", 1, "out-of-range"),
    ("F0", 1, "out-of-range"),
    ("F-3", 1, "out-of-range"),
    ("S999999", 1, "out-of-range"),
    ("X" + "9" * 400, 1, "number-too-long"),
    ("X.1234567890123456789", 1, "number-too-long"),
    ("(title", 1, "comment-open"),
    ("X1 (a", 4, "comment-open"),
    ("X1)", 3, "comment-close"),
    ("X1/", 3, "block-delete-place"),
    ("%", 1, "transfer-line"),
    ("X1;end", 3, "character"),
    ("X1=2", 3, "character"),
    ("ſ1", 1, "character"),
    ("X１", 1, "number-missing"),  # a full-width digit
    ("x1ß", 3, "character"),
    ("X1\x07", 3, "character"),
]


@pytest.mark.parametrize(("text", "column", "code"), REFUSED, ids=[text[:20] for text, _, _ in REFUSED])
def test_invalid_line_gives_error_with_message_and_hint(text: str, column: int, code: str) -> None:
    errors = lex_line(7, text).errors
    assert (errors[0].line, errors[0].column, errors[0].code) == (7, column, code)
    assert errors[0].severity == "error"
    assert errors[0].message.endswith(".")
    assert errors[0].hint


def test_lexer_errors_have_at_least_20_codes() -> None:
    assert len({code for _, _, code in REFUSED}) >= 20


def test_all_errors_of_line_are_reported() -> None:
    assert [(e.column, e.code) for e in lex_line(1, "N1GO2X1.2.3").errors] == [
        (1, "n-word"),
        (4, "letter-o"),
        (10, "two-points"),
    ]


def test_hint_for_one_digit_g_code_names_two_digits() -> None:
    assert lex_line(1, "G2").errors[0].hint == "Write G02."


def test_overlong_line_is_rejected_without_lexing() -> None:
    line = lex_line(1, "X1" * 500_000)
    assert [error.code for error in line.errors] == ["line-too-long"]
    assert line.words == ()
