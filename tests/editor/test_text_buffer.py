"""The text of the text area: what an edit leaves, what undo brings back, what one step is."""

from __future__ import annotations

import pytest

from app.screen.text_area import text_buffer
from app.screen.text_area.text_buffer import TextBuffer, TextChange, TextSelection

HERE = TextSelection()


@pytest.fixture
def long_buffer(monkeypatch: pytest.MonkeyPatch) -> TextBuffer:
    """Twenty lines, 0 to 19, of which each block holds only a few."""
    monkeypatch.setattr(text_buffer, "BLOCK_LENGTH", 8)
    return TextBuffer("".join(f"{n}\n" for n in range(20)))


def test_lines_and_positions_agree_across_blocks(long_buffer: TextBuffer) -> None:
    # ten lines of two characters, then ten of three: line 12 starts at 10 * 2 + 2 * 3
    assert long_buffer.find_line_start(12) == 26
    assert (long_buffer.find_line(27), long_buffer.find_column(27)) == (12, 1)
    assert long_buffer.line_count == 21
    assert long_buffer.read_lines(8, 4) == ["8", "9", "10", "11"]
    assert long_buffer.read_lines(20, 5) == [""]
    assert long_buffer.find_position(3, 99) == 7


def test_edit_over_several_blocks_is_one_step(long_buffer: TextBuffer) -> None:
    before = long_buffer.text
    long_buffer.replace_range(1, 45, "", TextSelection(45, 1))
    assert long_buffer.text == "0" + before[45:]
    assert long_buffer.undo() == TextSelection(45, 1)
    assert long_buffer.text == before
    assert long_buffer.undo() is None
    long_buffer.redo()
    assert long_buffer.text == "0" + before[45:]
    assert long_buffer.redo() is None


def test_typed_characters_are_one_step_until_the_cursor_moves() -> None:
    buffer = TextBuffer("G1\n")
    for at, letter in enumerate("X5"):
        buffer.replace_range(2 + at, 2 + at, letter, TextSelection(2 + at, 2 + at), is_typing=True)
    buffer.end_typing()
    buffer.replace_range(4, 4, "F", TextSelection(4, 4), is_typing=True)
    buffer.undo()
    assert buffer.text == "G1X5\n"
    assert buffer.undo() == TextSelection(2, 2)
    assert buffer.text == "G1\n"


def test_edit_after_undo_discards_the_reversed_step() -> None:
    buffer = TextBuffer("a")
    buffer.replace_range(1, 1, "b", HERE)
    buffer.undo()
    buffer.replace_range(1, 1, "c", HERE)
    assert buffer.redo() is None
    assert buffer.text == "ac"


def test_all_matches_are_replaced_as_one_step(long_buffer: TextBuffer) -> None:
    before = long_buffer.text
    places = [at for at, sign in enumerate(before) if sign == "1"]
    long_buffer.replace_matches(places, 1, "xy", HERE)
    assert long_buffer.text == before.replace("1", "xy")
    long_buffer.undo()
    assert long_buffer.text == before


def test_oldest_steps_are_forgotten_but_never_the_last(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_buffer, "MAX_HISTORY_LENGTH", 4)
    buffer = TextBuffer("")
    for at in range(5):
        buffer.replace_range(at, at, "x", HERE)
    assert buffer.undo() is not None
    assert buffer.undo() is None
    assert buffer.text == "xxxx"


def test_changed_lines_are_reported_for_edit_and_undo() -> None:
    buffer = TextBuffer("a\nb\nc\nd\n")
    buffer.replace_range(2, 6, "x\ny\nz\n", HERE)  # lines 1 and 2, up to the start of line 3
    assert buffer.last_change == TextChange(1, 3, 4)
    buffer.undo()
    assert buffer.last_change == TextChange(1, 4, 3)


def test_search_backward_for_a_character_misses_later_lines(long_buffer: TextBuffer) -> None:
    assert long_buffer.find_last_line_with("3", 13) == 3
    assert long_buffer.find_last_line_with("3", 3) == -1
    assert long_buffer.find_last_line_with("~", 20) == -1
