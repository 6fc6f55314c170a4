"""Lines by the rules of the C++ agent's tokenizer and mapper, letter by letter."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest

from app.extras.mtconnect.driver.agent_links import (
    MAX_VALUE_LENGTH,
    ActiveCondition,
    format_utc_time,
    format_value,
    make_active_condition_line,
    make_cleared_condition_line,
    make_pong_reply,
    make_unknown_condition_line,
    make_values_line,
    replace_separators,
)
from app.extras.mtconnect.driver.mtconnect_items import DataItem, DataItemCategory
from tests.extras.mtconnect.agent import tokens

AT = "2026-11-21T22:17:39.000Z"
PLACE = DataItem("Xabs", DataItemCategory.SAMPLE, "POSITION", units="MILLIMETER", decimal_places=4)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("N10 G01 X.5", "N10 G01 X.5"),
        ("(A|B)", "(A/B)"),
        ("ONE\tTWO\r\nTHREE", "ONE TWO THREE"),
        ("  BLANKS  ", "BLANKS"),
        ("\x00\x07BELL\x1b[2J", "BELL [2J"),
        ('"QUOTED" | REST', "'QUOTED\" / REST"),  # an opening quotation mark would end the value at the next
        ('MSG "INSIDE"', 'MSG "INSIDE"'),
        ("--multiline--7", "- multiline -7"),  # the agent would wait for that word to come again
        ("----multiline----", "--- multiline ---"),
        ("DREHTEIL Ø12", "DREHTEIL Ø12"),
        ("BAD \udc80 BYTE \ufffe", "BAD ? BYTE"),
        ("", ""),
        ("|", "/"),
        ("\n", ""),
    ],
)
def test_separators_in_a_value_are_replaced(text: str, told: str) -> None:
    assert replace_separators(text) == told
    assert tokens(f"{AT}|block|{replace_separators(text)}|line|7") == [AT, "block", told, "line", "7"]


def test_value_without_line_ends_is_truncated() -> None:
    assert len(replace_separators("X" * 100_000)) == MAX_VALUE_LENGTH


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (None, "UNAVAILABLE"),
        (-12.34567, "-12.3457"),
        (-0.00001, "0.0000"),
        (-0.0, "0.0000"),
        (0, "0.0000"),
        (1e6, "1000000.0000"),
        ("CLOSED", "CLOSED"),
    ],
)
def test_values_are_formatted_as_text(value: str | float | None, told: str) -> None:
    assert format_value(PLACE, value) == told


def test_lines_have_the_shdr_format() -> None:
    assert make_values_line(AT, {"execution": "ACTIVE", "line": "12"}) == f"{AT}|execution|ACTIVE|line|12\n"
    fault = ActiveCondition("FAULT", "102", "X lags | 0.2\nmm")
    assert make_active_condition_line(AT, "Xservo", fault) == f"{AT}|Xservo|FAULT|102|||X lags / 0.2 mm\n"
    assert make_cleared_condition_line(AT, "Xservo", "102") == f"{AT}|Xservo|NORMAL|102|||\n"
    assert make_cleared_condition_line(AT, "Xservo") == f"{AT}|Xservo|NORMAL||||\n"
    assert make_unknown_condition_line(AT, "Xservo") == f"{AT}|Xservo|UNAVAILABLE||||\n"


def test_times_are_utc_with_z() -> None:
    assert format_utc_time(datetime(2026, 3, 4, 5, 6, 7, 89_999, UTC)) == "2026-03-04T05:06:07.089Z"


@pytest.mark.parametrize(
    ("seconds", "said"),
    [
        (10.0, b"* PONG 10000\n"),
        (0.001, b"* PONG 1\n"),
        (0.0001, b"* PONG 1\n"),
        (1800.0, b"* PONG 1799999\n"),
    ],
)
def test_pong_interval_is_accepted_by_the_agent(seconds: float, said: bytes) -> None:
    """It refuses 0, and half an hour itself."""
    assert make_pong_reply(seconds) == said
