"""Programs written by a finger alone: the drawn keyboard, where it writes and how large its keys are."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.screen import page_table
from app.screen.entry_panel import PROGRAM_KEYS
from app.screen.panel import Panel
from app.screen.window_layout import FINGERTIP_PX
from tests.screen.editor.writer import Writer
from tests.screen.hands import Key

KEYS = [key for row in PROGRAM_KEYS for key in row]


def touch(writer: Writer, panel: Panel, place: int) -> None:
    """A finger in the middle of a place."""
    writer.window.grab()
    box, *_ = panel._places[place]
    assert min(box.width(), box.height()) >= FINGERTIP_PX
    QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=QPoint(*map(int, box.center().toTuple())))


def strike(writer: Writer, *keys: str) -> None:
    for key in keys:
        touch(writer, writer.editor.letter_pad, KEYS.index(key))


def shown(writer: Writer) -> None:
    """KEYBOARD, at the right of the line over the text."""
    touch(writer, writer.editor.head_line, 0)
    assert writer.editor.letter_pad.isVisible()


@pytest.mark.parametrize("size", [(1024, 600), (1920, 1080)])
def test_program_is_typed_and_saved_by_touch_only(
    writer: Writer, tmp_path: Path, size: tuple[int, int]
) -> None:
    writer.window.resize(*size)
    writer.new("touched")
    shown(writer)
    strike(
        writer,
        *"G90G94F300",
        "Enter",
        *"(A",
        " ",
        *"B)",
        "Back",
        *")",
        "Enter",
        *"X-.5Z+1",
        "Enter",
        *"M30",
    )
    assert writer.text() == "G90G94F300\n(A B)\nX-.5Z+1\nM30"
    strike(writer, "Up", "Left", "Left", "Down", "Right", "Back", *"0")
    assert writer.text().endswith("\nM00")
    writer.window.press_key("F2")
    writer.sees((tmp_path / "touched.nc").exists)


def test_every_letter_pad_key_types_its_label(writer: Writer) -> None:
    writer.new("touched")
    shown(writer)
    signs = [key for key in KEYS if len(key) == 1]
    strike(writer, *signs)
    assert writer.text() == "".join(signs)
    assert set("GMXYZIJKRFSTDCPULAHNVBEOQW0123456789.-+/()}=~") <= set(signs)


def test_letter_pad_types_into_open_question(writer: Writer) -> None:
    writer.new("touched")
    shown(writer)
    strike(writer, *"X1", "Enter", *"X2")
    writer.key(Key.Key_F5)
    assert writer.editor.letter_pad.isVisible()
    strike(writer, "1", "Enter")
    assert writer.editor.text_field.cursor_line == 1
    assert writer.text() == "X1\nX2"


def test_letter_pad_closes_and_path_is_visible_again(writer: Writer) -> None:
    writer.new("touched")
    shown(writer)
    assert not writer.editor.path_view.isVisible()
    touch(writer, writer.editor.head_line, 0)
    assert not writer.editor.letter_pad.isVisible()
    assert writer.editor.path_view.isVisible()
    shown(writer)
    writer.key(Key.Key_F7)  # the history writes nothing
    assert not writer.editor.letter_pad.isVisible()
    writer.key(Key.Key_Escape)
    assert writer.editor.letter_pad.isVisible()
    assert writer.front == page_table.EDITOR


def test_text_field_has_minimum_height_above_letter_pad(writer: Writer) -> None:
    writer.new("touched")
    shown(writer)
    writer.window.refresh()
    writer.window.grab()
    assert writer.editor.text_field.height() >= 3 * writer.editor.text_field.fontMetrics().height()
    assert writer.editor.text_field.geometry().bottom() < writer.editor.letter_pad.geometry().top()


def test_touch_on_letter_pad_does_not_move_keyboard_focus(writer: Writer) -> None:
    writer.new("touched")
    shown(writer)
    strike(writer, "X")
    assert writer.editor.text_field.hasFocus()
    writer.type("1")
    writer.key(Key.Key_F4)
    strike(writer, "X")
    writer.key(Key.Key_Tab)
    strike(writer, "Z")
    assert writer.editor.question_line.second_field.hasFocus()
    assert (
        writer.editor.question_line.first_field.text(),
        writer.editor.question_line.second_field.text(),
    ) == ("X", "Z")
    assert writer.text() == "X1"
