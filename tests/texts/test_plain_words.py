"""Texts that a person reads contain none of the words that the glossary replaces."""

from __future__ import annotations

import re

import pytest

from resources.translations.message_list import read_list
from tests.glossary import avoided

ACCEPTED = {
    "FEED HOLD BEHIND THE TAP": "reported to other programs as it is",
    "CENTRE LINE {found_count}": "stored in programs that exist",
    "{place} IS NO LONGER CONNECTED. PLUG IT IN AGAIN AND PRESS F2": "no longer",
}
"""Texts with such a word, and why they keep it."""


def test_the_glossary_names_words_to_avoid() -> None:
    assert {"anew", "nought", "whoever", "beside", "goes on"} <= set(avoided())


@pytest.mark.parametrize("word", avoided())
def test_texts_contain_no_avoided_word(word: str) -> None:
    found = re.compile(rf"(?<!--)\b{re.escape(word)}\b", re.IGNORECASE)
    assert [text for text in read_list().values() if found.search(text) and text not in ACCEPTED] == []


def test_every_accepted_text_exists() -> None:
    assert [text for text in ACCEPTED if text not in read_list().values()] == []
