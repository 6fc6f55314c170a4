"""A line that is typed into: a text that is offered is replaced by what is typed, or edited."""

from __future__ import annotations

from app.desk.pages.sheet import Entry


def test_the_first_character_replaces_what_is_offered() -> None:
    entry = Entry(words=True)
    entry.offer("knob")
    for key in "kn2":
        assert entry.type(key)
    assert entry.text == "kn2"


def test_back_edits_what_is_offered() -> None:
    entry = Entry(words=True)
    entry.offer("knob")
    entry.type("Back")
    entry.type("t")
    assert entry.text == "knot"


def test_what_was_typed_is_not_replaced() -> None:
    entry = Entry(words=True)
    for key in "ab":
        entry.type(key)
    assert entry.text == "ab"
    assert not entry.type("Enter")
