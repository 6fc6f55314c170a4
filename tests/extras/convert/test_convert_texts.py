"""Texts of conversions are collected and translated."""

from __future__ import annotations

from functools import cache

import pytest

from app.extras.convert import convert_function
from core.extras.convert.conversion_messages import ERRORS, NOTES, PROOF_ERRORS, WARNINGS
from resources.translations.collect import (
    PLACEHOLDER_PATTERN,
    _is_read,
    collect_screen_texts,
    read_translations,
)

every_text = cache(collect_screen_texts)


def test_every_text_of_a_finding_is_collected() -> None:
    pairs = [pair for table in (ERRORS, WARNINGS, NOTES, PROOF_ERRORS) for pair in table.values()]
    texts = {text for pair in pairs for text in pair if PLACEHOLDER_PATTERN.sub("", text)}
    assert sorted(texts - {*every_text()}) == []


def test_every_value_of_a_setting_is_translated() -> None:
    tables = (convert_function._UNITS, convert_function._X_VALUES, convert_function._POINTS)
    values = {value for table in tables for value in table.values()}
    assert sorted(values - {*read_translations("es")}) == []


@pytest.mark.parametrize("text", ["Correct R.", "Add Z.", "1000 UNITS"])
def test_text_with_one_word_is_collected(text: str) -> None:
    assert _is_read(text, True)


@pytest.mark.parametrize("text", ["Qt A.", "At 1.", "R5 X.", "1000 mm", "1000", "X Z.", "correct r."])
def test_values_and_codes_are_not_collected(text: str) -> None:
    assert not _is_read(text, True)
