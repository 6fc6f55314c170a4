"""The editor without an optional feature that writes lines: no key opens a panel."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt

from app.editor.editor_modes import EditorMode
from app.screen import page_table
from app.screen.page_base import EditorPanel
from tests.screen.editor.writer import Writer
from tests.screen.hands import Key

SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def no_panel(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page_table, "_PANELS", ())


@pytest.mark.parametrize("key", [Key.Key_F3, Key.Key_F4])
def test_typed_letters_open_no_panel(no_panel: None, writer: Writer, key: Key) -> None:
    writer.new("plain")
    assert type(writer.editor.editor_panel) is EditorPanel
    writer.key(key, SHIFT)
    writer.editor.head_line.grab()
    assert (writer.editor.mode, len(writer.editor.head_line._places)) == (
        EditorMode.TEXT,
        1,
    )  # the drawn keyboard
    writer.type("g04")
    assert writer.text() == "g04"
