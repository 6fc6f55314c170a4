"""Random keys in the text area and in Qt's own text field: both must contain the same text.

Qt's field is an independent implementation of the same keys.
"""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPlainTextEdit, QWidget
from pytestqt.qtbot import QtBot

from app.screen.text_area.text_area import TextArea

Key, Modifier = Qt.Key, Qt.KeyboardModifier
NONE, SHIFT, CTRL = Modifier.NoModifier, Modifier.ShiftModifier, Modifier.ControlModifier
TEXT = "G90G94F300\n\n  X1.5 Z-2 (comment é)\nG01X.5\nT1\nX 𝄞 abc\nlast"
ARROWS = [Key.Key_Left, Key.Key_Right, Key.Key_Up, Key.Key_Down, Key.Key_Home, Key.Key_End]
STROKES = [
    *((key, modifier) for key in ARROWS for modifier in (NONE, SHIFT)),
    *((key, modifier) for key in (*ARROWS[:2], *ARROWS[4:]) for modifier in (CTRL, CTRL | SHIFT)),
    *((key, NONE) for key in (Key.Key_Backspace, Key.Key_Delete, Key.Key_Return)),
    *((key, CTRL) for key in (Key.Key_Delete, Key.Key_X, Key.Key_C, Key.Key_V, Key.Key_A)),
    *[(key, NONE) for key in (Key.Key_G, Key.Key_1, Key.Key_Space, Key.Key_Period)] * 4,
]


@pytest.fixture
def fields(qtbot: QtBot) -> Iterator[tuple[TextArea, QPlainTextEdit]]:
    """Our text area and Qt's text field in one window, with the same text."""
    window = QWidget()
    qtbot.addWidget(window)
    ours, peer = TextArea(window), QPlainTextEdit(window)
    for each in (ours, peer):
        each.resize(500, 300)
        each.setPlainText(TEXT)
    peer.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
    window.show()
    yield ours, peer
    window.close()


def find_peer_selection(peer: QPlainTextEdit) -> tuple[int, int]:
    """Return anchor and position of Qt's cursor in characters. Qt counts in units of UTF-16."""
    units, cursor = peer.toPlainText().encode("utf-16-le"), peer.textCursor()
    anchor, position = (
        len(units[: 2 * each].decode("utf-16-le")) for each in (cursor.anchor(), cursor.position())
    )
    return anchor, position


@pytest.mark.parametrize("seed", range(12))
def test_keys_have_the_same_effect_as_in_the_text_field_of_qt(
    fields: tuple[TextArea, QPlainTextEdit], seed: int
) -> None:
    ours, peer = fields
    clipboard, pick, pressed = QGuiApplication.clipboard(), random.Random(seed), list[str]()
    clipboard.setText("P\nQ")
    for _ in range(60):
        key, modifier = pick.choice(STROKES)
        pressed.append(f"{key.name} {modifier.value:x}")
        before = clipboard.text()
        QTest.keyClick(ours, key, modifier)
        copied = clipboard.text()
        clipboard.setText(before)
        QTest.keyClick(peer, key, modifier)
        now = (ours.toPlainText(), tuple(ours.selection), copied)
        assert now == (peer.toPlainText(), find_peer_selection(peer), clipboard.text()), pressed


@pytest.mark.parametrize("seed", range(3))
def test_undo_restores_the_text_and_redo_the_edits(
    fields: tuple[TextArea, QPlainTextEdit], seed: int
) -> None:
    ours, pick = fields[0], random.Random(seed)
    QGuiApplication.clipboard().setText("P\nQ")
    for _ in range(60):
        QTest.keyClick(ours, *pick.choice(STROKES))
    edited = ours.toPlainText()
    assert edited != TEXT
    for _ in range(60):
        ours.undo()
    assert ours.toPlainText() == TEXT
    for _ in range(60):
        ours.redo()
    assert ours.toPlainText() == edited
