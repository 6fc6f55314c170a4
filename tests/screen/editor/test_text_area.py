"""The text area with a long program: what is laid out, what keys select, what read-only refuses."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAccessible, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.editor.text_view import ProgramTextField
from app.screen.accessible import register_accessibility
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme

Key, SHIFT = Qt.Key, Qt.KeyboardModifier.ShiftModifier
CTRL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def field(qtbot: QtBot) -> Iterator[ProgramTextField]:
    window = QWidget()
    qtbot.addWidget(window)
    made = ProgramTextField(ScreenTheme(DARK_PALETTE), window)
    made.resize(400, 300)
    made.apply_theme()
    window.show()
    made.setFocus()
    yield made
    window.close()


def test_only_visible_lines_of_a_long_text_are_laid_out(
    field: ProgramTextField, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: set[int] = set()
    original = field.find_line_colors

    def record_line(line: int, text: str) -> object:
        read.add(line)
        return original(line, text)

    monkeypatch.setattr(field, "find_line_colors", record_line)
    field.setPlainText("".join(f"X{n}\n" for n in range(100_000)))
    field.move_cursor_to(50_000, 3)
    field.grab()
    # the first screen and the screen around line 50 000
    assert len(read) <= 2 * (field.row_count + 2)
    assert 49_999 in read
    assert (field.cursor_line, field.cursor_column, field.cursor_line_text) == (50_000, 3, "X49999")


def test_keys_select_copy_and_replace_text(field: ProgramTextField) -> None:
    field.setPlainText("G1 X5\nF20\n")
    QTest.keyClick(field, Key.Key_Right, CTRL)
    QTest.keyClick(field, Key.Key_End, SHIFT)
    assert field.selected_text == "X5"
    QTest.keyClick(field, Key.Key_C, CTRL)
    assert QGuiApplication.clipboard().text() == "X5"
    QTest.keyClicks(field, "Z")
    QTest.keyClick(field, Key.Key_End, CTRL)
    QTest.keyClick(field, Key.Key_V, CTRL)
    assert field.toPlainText() == "G1 Z\nF20\nX5"
    QTest.keyClick(field, Key.Key_Z, CTRL)
    QTest.keyClick(field, Key.Key_Z, CTRL)
    assert field.toPlainText() == "G1 X5\nF20\n"


def test_vertical_moves_retain_the_column_over_a_short_line(field: ProgramTextField) -> None:
    field.setPlainText("G1X100\nM5\nG1X200\n")
    field.move_cursor_to(1, 6)
    for line, column in ((2, 3), (3, 6)):
        QTest.keyClick(field, Key.Key_Down)
        assert (field.cursor_line, field.cursor_column) == (line, column)


def test_read_only_text_cannot_be_changed(field: ProgramTextField) -> None:
    field.setPlainText("G1")
    QTest.keyClicks(field, "X")
    field.setReadOnly(True)
    for key, modifiers in (
        (Key.Key_Backspace, SHIFT),
        (Key.Key_V, CTRL),
        (Key.Key_Z, CTRL),
        (Key.Key_A, SHIFT),
    ):
        QTest.keyClick(field, key, modifiers)
    QTest.keyClick(field, Key.Key_Return)
    assert field.toPlainText() == "XG1"


def test_mouse_selects_text_and_a_new_press_clears_the_selection(field: ProgramTextField) -> None:
    field.setPlainText("G1X5\nF20\n")
    view, high = field.viewport(), field.row_height_px
    QTest.mouseDClick(view, Qt.MouseButton.LeftButton, pos=QPoint(8, high + 2))
    assert field.selected_text == "F20"
    QTest.mousePress(view, Qt.MouseButton.LeftButton, pos=QPoint(399, high // 2))
    QTest.mouseRelease(view, Qt.MouseButton.LeftButton, pos=QPoint(399, high // 2))
    assert not field.has_selection
    assert (field.cursor_line, field.cursor_column) == (1, 5)


def test_screen_reader_reads_the_text_and_the_role(field: ProgramTextField) -> None:
    register_accessibility()
    field.setPlainText("G1X5")
    shown = QAccessible.queryAccessibleInterface(field)
    assert shown.role() is QAccessible.Role.EditableText
    assert shown.text(QAccessible.Text.Value) == "G1X5"
    assert shown.state().multiLine
    assert not shown.state().readOnly
