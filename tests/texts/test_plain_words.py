"""Texts that a person reads contain none of the words that the glossary replaces."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from resources.translations.collect import texts

GLOSSARY = Path(__file__).parents[2] / "docs" / "glossary.md"
ACCEPTED = {
    "HOLD {way}": "a hole",
    "tool setter {way} ±{error}": "a hole",
    "FEED HOLD BEHIND THE TAP": "reported to other programs as it is",
    "CENTRE LINE %1": "stored in programs that exist",
}
"""Texts with such a word, and why they keep it."""


def avoided() -> list[str]:
    """Return the words of the glossary's table of words to avoid."""
    table = GLOSSARY.read_text(encoding="utf-8").partition("## Words we do not use")[2]
    cells = re.findall(r"^\| ([^|]+) \|", table, re.MULTILINE)
    return [word.strip() for cell in cells[2:] for word in cell.split(",")]


def test_the_glossary_names_words_to_avoid() -> None:
    assert {"anew", "nought", "whoever", "beside", "goes on"} <= set(avoided())


@pytest.mark.parametrize("word", avoided())
def test_no_text_contains(word: str) -> None:
    found = re.compile(rf"\b{re.escape(word)}\b", re.IGNORECASE)
    assert [text for text in texts() if found.search(text) and text not in ACCEPTED] == []


def test_what_is_accepted_is_there() -> None:
    assert [text for text in ACCEPTED if text not in texts()] == []
