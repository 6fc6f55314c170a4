"""A line that is typed into: a text that is offered is replaced by what is typed, or edited."""

from __future__ import annotations

from app.desk.pages.table_content import InputField


def test_first_character_replaces_the_offered_text() -> None:
    entry = InputField(words=True)
    entry.propose("knob")
    for key in "kn2":
        assert entry.handle_key(key)
    assert entry.text == "kn2"


def test_backspace_edits_the_offered_text() -> None:
    entry = InputField(words=True)
    entry.propose("knob")
    entry.handle_key("Back")
    entry.handle_key("t")
    assert entry.text == "knot"


def test_typed_text_is_not_replaced() -> None:
    entry = InputField(words=True)
    for key in "ab":
        entry.handle_key(key)
    assert entry.text == "ab"
    assert not entry.handle_key("Enter")
