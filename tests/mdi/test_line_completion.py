"""Codes for the line of MDI, in every language: completed, looked up, written in one line."""

from __future__ import annotations

import pytest

from app.mdi.mdi_model import MAX_LINE_LENGTH, LineCompletion, MdiInput
from core.interpreter.dialects import get_code_book
from core.language.source import Dialect


def line(dialect: Dialect, text: str, at: int | None = None) -> LineCompletion:
    typing = MdiInput()
    typing.set_text(text, at)
    return LineCompletion(typing, lambda: get_code_book(dialect))


def press(completion: LineCompletion, *keys: str) -> str:
    for key in keys:
        assert completion.handle_key(key), key
    return completion.mdi_input.text


@pytest.mark.parametrize(
    ("dialect", "typed", "down", "written"),
    [
        (Dialect.OMNITURN, "G90 G0", 0, "G90 G00"),
        (Dialect.OMNITURN, "G90 G0", 2, "G90 G02"),
        (Dialect.KLARTEXT, "TOOL C", 0, "TOOL CALL"),
        (Dialect.KLARTEXT, "PLANE R", 1, "PLANE RESET"),
        (Dialect.KLARTEXT, "L X+10 M", 0, "L X+10 MOVE"),
        (Dialect.SINUMERIK, "SPO", 0, "SPOS"),
        (Dialect.SINUMERIK, "G0 X10 M1", 1, "G0 X10 M17"),
    ],
)
def test_typed_text_is_completed(dialect: Dialect, typed: str, down: int, written: str) -> None:
    completion = line(dialect, typed)
    assert press(completion, "Tab", *(["Down"] * down), "Enter") == written
    assert completion.mdi_input.cursor_index == len(written)
    assert not completion.is_choice_list_open


def test_selected_code_is_inserted_at_cursor() -> None:
    completion = line(Dialect.OMNITURN, "G0 X5", 2)
    assert press(completion, "Tab", "Down", "Tab") == "G01 X5"
    assert completion.mdi_input.cursor_index == 3


def test_code_list_opens_by_chapter_when_no_code_is_typed() -> None:
    """Behind a blank nothing is begun: the chapter of the code before, and the next ones by the arrows."""
    completion = line(Dialect.SINUMERIK, "G0 ")
    press(completion, "Tab")
    assert completion.code_help.selected_entry is not None
    assert completion.code_help.selected_entry.head == "G0"
    first = completion.code_help.title
    press(completion, "Right")
    assert completion.code_help.title != first
    press(completion, "Left")
    assert completion.code_help.title == first


def test_block_of_several_lines_is_inserted_as_one_line() -> None:
    completion = line(Dialect.KLARTEXT, "CYCL DEF 240")
    written = press(completion, "Tab", "Enter")
    assert written.startswith("CYCL DEF 240 CENTERING Q200=2 Q343=+0")
    assert "~" not in written
    assert "\n" not in written


def test_only_head_is_inserted_when_whole_block_does_not_fit() -> None:
    assert press(line(Dialect.KLARTEXT, "CYCL DEF 251"), "Tab", "Enter") == "CYCL DEF 251"
    full = "M" * (MAX_LINE_LENGTH - 2) + " G"
    completion = line(Dialect.OMNITURN, full)
    press(completion, "Tab", "Enter")
    assert completion.mdi_input.text == full
    assert not completion.is_choice_list_open


def test_any_other_key_edits_line_and_closes_choices() -> None:
    completion = line(Dialect.OMNITURN, "G0")
    press(completion, "Tab")
    assert not completion.handle_key("X")
    assert not completion.is_choice_list_open
    assert completion.mdi_input.text == "G0"


def test_closed_completion_handles_only_tab() -> None:
    completion = line(Dialect.OMNITURN, "G0")
    assert not any(completion.handle_key(key) for key in ("Up", "Left", "Enter", "5"))
