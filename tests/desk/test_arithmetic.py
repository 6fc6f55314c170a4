"""What an operator types into a number field."""

from __future__ import annotations

from math import isfinite

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.desk.arithmetic import InvalidEntryError, evaluate_expression, evaluate_line_number
from tests.texts import pattern


@pytest.mark.parametrize(
    ("entry", "value"),
    [
        (".5-.002", 0.498),
        ("1.", 1.0),
        (" 1.25 ", 1.25),
        ("-.0005", -0.0005),
        ("−.0005", -0.0005),  # the minus sign that the screen shows
        ("--1", 1.0),
        ("2-3-4", -5.0),
        ("8/4/2", 1.0),
        ("1+2*3", 7.0),
        ("(1+2)*3", 9.0),
        ("-(1+2)", -3.0),
        ("3*-2", -6.0),
    ],
)
def test_expression_is_evaluated(entry: str, value: float) -> None:
    assert evaluate_expression(entry) == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        ("", pattern("screen.nothing-entered")),
        ("   ", pattern("screen.nothing-entered")),
        ("1,5", pattern("screen.decimal-point")),
        ("1e5", pattern("desk.only-numbers")),
        ("٣", pattern("desk.only-numbers")),  # a digit, but none of ours
        ("1\n+", "^" + pattern("desk.stops-short", entry="1 +")),  # one line, whatever was pasted
        ("nan", pattern("desk.only-numbers")),
        ("2**3", pattern("desk.unexpected", what="*", place=3)),
        ("1 2", pattern("desk.unexpected", what=2, place=3)),
        (" 1  2", pattern("desk.unexpected", what=2, place=3, entry="1 2")),
        ("1+", pattern("desk.stops-short", entry="1+")),
        ("(1", pattern("desk.closing-bracket")),
        ("1)", pattern("desk.unexpected", what=")", place=2)),
        (".", pattern("desk.only-numbers")),
        ("1/(2-2)", pattern("desk.divides-by-zero")),
        ("1" * 81, pattern("desk.entry-too-long", most=80)),
    ],
)
def test_invalid_expression_is_rejected(entry: str, told: str) -> None:
    with pytest.raises(InvalidEntryError, match=told):
        evaluate_expression(entry)


def test_deeply_nested_expression_is_evaluated_or_rejected() -> None:
    assert evaluate_expression("(" * 39 + "1" + ")" * 39) == 1.0
    with pytest.raises(InvalidEntryError, match=pattern("desk.stops-short")):
        evaluate_expression("(" * 80)


@given(st.floats(-1000, 1000), st.floats(-1000, 1000))
def test_difference_of_two_numbers_is_exact(a: float, b: float) -> None:
    assert evaluate_expression(f"{a:.6f}-{b:.6f}") == float(f"{a:.6f}") - float(f"{b:.6f}")


@given(st.text(max_size=30))
def test_any_text_gives_a_number_or_a_one_line_error(text: str) -> None:
    try:
        assert isfinite(evaluate_expression(text))
    except InvalidEntryError as error:
        sentence = str(error)
    else:
        sentence = "a number"
    assert sentence
    assert "\n" not in sentence


@pytest.mark.parametrize(
    ("entry", "line"),
    [
        ("7", 7),
        ("20+5", 25),
        (" 3*4 ", 12),
        ("1.5", None),
        ("0", None),
        ("-3", None),
        ("X1", None),
        ("", None),
    ],
)
def test_line_number_is_a_positive_integer(entry: str, line: int | None) -> None:
    assert evaluate_line_number(entry) == line
