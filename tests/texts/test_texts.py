"""The one place where tests hold wording: every text of the tables is one that the product has."""

from __future__ import annotations

import re

import pytest

from tests.texts import (
    HOLE,
    all_texts,
    begins,
    fragment,
    opening,
    pattern,
    product_texts,
    shows,
    text,
    text_in_spanish,
)


def test_product_contains_every_text_of_the_tables() -> None:
    known = product_texts()
    assert [name for name, each in all_texts().items() if HOLE.sub("{}", each) not in known] == []


def test_unknown_id_and_missing_value_raise_key_error() -> None:
    with pytest.raises(KeyError):
        text("screen.no-such-text")
    assert re.fullmatch(pattern("screen.no-start"), text("screen.no-start", why="AN ALARM"))
    with pytest.raises(KeyError):
        pattern("screen.no-start", reason="AN ALARM")
    with pytest.raises(KeyError):
        text_in_spanish("screen.no-start")


def test_part_of_displayed_text_is_found_by_its_id() -> None:
    shown = text("screen.refused", why=text("search.no-such-pass", line=8, count=5, wanted=9))
    assert begins(shown, "screen.refused")
    assert begins(shown, "screen.refused", why=pattern("search.no-such-pass", line=8))
    assert not begins(shown, "screen.refused", why=pattern("search.no-such-pass", line=9))
    assert not begins(shown, "search.no-such-pass")
    assert shows(shown, "search.no-such-pass", count=5)
    assert not shows(shown, "screen.no-start")
    assert fragment("search.no-such-pass", count=5) in shown
    assert fragment("search.no-such-pass", count=55) not in shown
    assert opening("search.no-such-pass", line=8) == "Line 8 is executed only"


def test_translation_inserts_values_by_name() -> None:
    rest = text_in_spanish("search.pass", number=3, count=5)
    assert rest != text("search.pass", number=3, count=5)
    assert {"3", "5"} <= set(re.findall(r"\d", rest))
