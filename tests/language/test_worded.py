"""Texts with values, as refusals of a program put them together."""

from __future__ import annotations

import pytest

from core.message import Message, fill_template


def test_floats_have_at_most_six_digits_and_other_values_are_unchanged() -> None:
    text = fill_template("{name} is {value} of {count}", {"name": "DP", "value": 1.0 / 3.0, "count": 1234567})
    assert isinstance(text, Message)
    assert text == "DP is 0.333333 of 1234567"
    assert text.values == {"name": "DP", "value": "0.333333", "count": 1234567}


def test_message_retains_its_own_values() -> None:
    made = Message("line {line}", line=3)
    assert fill_template(made, {"line": 4}) is made


def test_a_text_without_values_stays_as_it_is() -> None:
    assert fill_template("Write {name}.", {}) == "Write {name}."


def test_missing_template_value_raises_key_error() -> None:
    with pytest.raises(KeyError):
        fill_template("{name} is {value}", {"name": "DP"})
