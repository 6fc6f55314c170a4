"""Accessible interface of the text area, for screen readers."""

from __future__ import annotations

from functools import partial
from typing import Any

from PySide6.QtCore import QPoint, QPointF, QRect
from PySide6.QtGui import (
    QAccessible,
    QAccessibleTextCursorEvent,
    QAccessibleTextInterface,
)
from PySide6.QtWidgets import QAccessibleWidget
from shiboken6 import VoidPtr

from app.screen.text_area.text_area import TextArea


class AccessibleTextArea(QAccessibleWidget):
    """Accessible interface of a text area, with its text, cursor and selection."""

    def __init__(self, text_area: TextArea) -> None:
        super().__init__(text_area, QAccessible.Role.EditableText)
        self._area = text_area
        self._text = _AccessibleText(text_area)
        text_area.cursor_moved.connect(partial(_report_cursor, text_area))

    def text(self, kind: QAccessible.Text) -> str:
        """Return the name of the text area, or its text as the accessible value."""
        return self._area.toPlainText() if kind is QAccessible.Text.Value else super().text(kind)

    def state(self) -> QAccessible.State:
        """Return the state of the text area."""
        state = super().state()
        state.multiLine = state.selectableText = True
        state.editable = not self._area.isReadOnly()
        state.readOnly = self._area.isReadOnly()
        return state

    def interface_cast(self, kind: QAccessible.InterfaceType) -> Any:
        """Return the text interface, or another interface of the widget."""
        if kind is QAccessible.InterfaceType.TextInterface:
            return self._text
        return super().interface_cast(kind) or VoidPtr(0)


class _AccessibleText(QAccessibleTextInterface):
    """Text interface of a text area."""

    def __init__(self, text_area: TextArea) -> None:
        super().__init__()
        self._area = text_area

    def characterCount(self) -> int:
        """Return the number of characters."""
        return self._area.buffer.length

    def text(self, start: int, end: int) -> str:
        """Return the text between two positions."""
        return self._area.buffer.read_range(max(0, start), min(self._area.buffer.length, end))

    def cursorPosition(self) -> int:
        """Return the position of the cursor."""
        return self._area.selection.position

    def setCursorPosition(self, position: int) -> None:
        """Move the cursor."""
        self._area.select(position, position)

    def selectionCount(self) -> int:
        """Return 1 if text is selected, and otherwise 0."""
        return int(self._area.has_selection)

    def selection(self, _index: int) -> tuple[int, int]:
        """Return the start and the end of the selected text."""
        return self._area.selection.start, self._area.selection.end

    def attributes(self, _offset: int) -> tuple[str, int, int]:
        """Return no attributes, with the range of the text to which this applies."""
        return "", 0, self.characterCount()

    def addSelection(self, start: int, end: int) -> None:
        """Select a range of the text."""
        self._area.select(start, end)

    def setSelection(self, _index: int, start: int, end: int) -> None:
        """Select a range of the text."""
        self._area.select(start, end)

    def removeSelection(self, _index: int) -> None:
        """Clear the selection."""
        self.setCursorPosition(self._area.selection.position)

    def characterRect(self, offset: int) -> QRect:
        """Return the rectangle of a character on the screen."""
        area, buffer = self._area, self._area.buffer
        line = buffer.find_line(offset)
        box = area.find_row_rect(line)
        box.setLeft(area.find_column_x(line, buffer.find_column(offset)))
        box.setWidth(area.fontMetrics().averageCharWidth())
        return box.toRect().translated(area.viewport().mapToGlobal(QPoint()))

    def offsetAtPoint(self, point: QPoint) -> int:
        """Return the position of the character at a point of the screen."""
        return self._area.find_position_at(QPointF(self._area.viewport().mapFromGlobal(point)))

    def scrollToSubstring(self, start: int, end: int) -> None:
        """Scroll to a range of the text, and select it."""
        self._area.select(start, end)


def _report_cursor(text_area: TextArea) -> None:
    """Report a moved cursor to screen readers."""
    if QAccessible.isActive():
        event = QAccessibleTextCursorEvent(text_area, text_area.selection.position)
        QAccessible.updateAccessibility(event)
