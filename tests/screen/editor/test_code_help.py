"""Code help by keys and fingers: completed while typing, looked up at the cursor, written into the text."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.editor.editor_modes import EditorMode
from app.screen.panel import Panel
from core.language.code_book import CodeBookEntry
from tests.screen.editor.writer import Writer

Key = Qt.Key
CTRL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def proved(writer: Writer) -> Writer:
    """In front of a program that is proved: the book of its language is at hand."""
    writer.new("coded")
    writer.write("G90G94G72F100\nG0")
    writer.sees(lambda: writer.proved() and writer.editor.finding_list.findings.code_book is not None)
    return writer


def head_of(entry: CodeBookEntry | None) -> str:
    return "" if entry is None else entry.head


def marked(writer: Writer) -> str:
    return head_of(writer.editor.code_list._help.selected_entry)


def look_up(writer: Writer) -> None:
    writer.key(Key.Key_Space, CTRL)
    writer.sees(lambda: writer.editor.mode is EditorMode.CODES)


def test_code_strip_explains_code_at_cursor(proved: Writer) -> None:
    proved.editor.move_cursor_to(1, 5)
    proved.sees(lambda: head_of(proved.editor.code_strip.code_entry) == "G94")
    proved.editor.move_cursor_to(1, 8)
    proved.sees(lambda: head_of(proved.editor.code_strip.code_entry) == "G72")


def test_typed_code_is_completed_from_list(proved: Writer) -> None:
    look_up(proved)
    assert marked(proved) == "G00"
    proved.key(Key.Key_Down)
    proved.key(Key.Key_Down)
    assert marked(proved) == "G02"
    proved.key(Key.Key_Return)
    assert proved.text() == "G90G94G72F100\nG02"
    assert proved.editor.mode is EditorMode.TEXT
    proved.write("X.5")
    assert proved.text().endswith("G02X.5")
    proved.key(Key.Key_Z, CTRL)


def test_inserted_code_is_undone_in_one_step(proved: Writer) -> None:
    look_up(proved)
    proved.key(Key.Key_F2)
    assert proved.text() == "G90G94G72F100\nG00"
    proved.key(Key.Key_F8)
    assert proved.text() == "G90G94G72F100\nG0"


def test_help_chapters_are_paged_and_closed_without_changing_text(proved: Writer) -> None:
    look_up(proved)
    before = proved.text()
    proved.key(Key.Key_Right)
    other = proved.editor.code_list._help.title
    proved.key(Key.Key_Left)
    assert proved.editor.code_list._help.title != other
    proved.key(Key.Key_Escape)
    assert proved.editor.mode is EditorMode.TEXT
    assert proved.text() == before


def test_touch_opens_selects_and_inserts_code(proved: Writer) -> None:
    def touch(panel: Panel, place: int) -> None:
        proved.sees(lambda: len(panel._places) > place)
        at = panel._places[place][0].center().toPoint()
        QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=at)

    touch(proved.editor.code_strip, 0)
    proved.sees(lambda: proved.editor.mode is EditorMode.CODES)
    touch(proved.editor.code_list, 1)
    proved.sees(lambda: marked(proved) == "G01")
    touch(proved.editor.code_list, 1)
    assert proved.text() == "G90G94G72F100\nG01"


def test_code_help_is_unavailable_before_first_proof(writer: Writer) -> None:
    writer.new("early")
    writer.editor.code_list._help._book = None
    assert not writer.editor.code_list._help.open_choices()
