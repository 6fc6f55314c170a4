"""Selection with the mouse and scrolling by touch for the text area."""

from __future__ import annotations

import re

from PySide6.QtCore import QPointF, Qt, QTimer
from PySide6.QtGui import QClipboard, QGuiApplication, QInputDevice, QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.screen.text_area.line_view import LineView

_DRAG_INTERVAL_MS = 40  # between two scroll steps while the mouse is outside the view
_WORD = re.compile(r"\w+|[^\w\s]+|\s+")


class PointerInput(LineView):
    """View of a text whose text is selected with the mouse.

    A touch that moves scrolls the text. A touch that does not move places the cursor.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._pressed_at: QPointF | None = None  # while the left button or a touch is down
        self._is_touch = False
        self._is_scrolling = False
        self._scrolled_from = (0, 0)  # values of the vertical and the horizontal scroll bar
        self._last_point = QPointF()
        self._double_clicked_at: QPointF | None = None
        self._triple_click_time = QTimer(self)
        self._triple_click_time.setSingleShot(True)
        self._triple_click_time.timeout.connect(self._forget_double_click)
        self._auto_scroll = QTimer(self)
        self._auto_scroll.setInterval(_DRAG_INTERVAL_MS)
        self._auto_scroll.timeout.connect(self._scroll_to_mouse)

    def select(self, anchor: int, position: int) -> None:
        """Select the text between two positions. ``TextArea`` overrides this method."""
        raise NotImplementedError

    def insert_at_cursor(self, text: str) -> None:
        """Insert a text in place of the selection. ``TextArea`` overrides this method."""
        raise NotImplementedError

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Place the cursor, or begin to select text or to scroll by touch."""
        if event.button() is not Qt.MouseButton.LeftButton:
            event.ignore()
            return
        point = event.position()
        self._pressed_at = self._last_point = point
        self._is_touch = event.device().type() is QInputDevice.DeviceType.TouchScreen
        self._is_scrolling = False
        self._scrolled_from = self.verticalScrollBar().value(), self.horizontalScrollBar().value()
        if not self._is_touch:
            self._press_mouse(point, event.modifiers())

    def _press_mouse(self, point: QPointF, modifiers: Qt.KeyboardModifier) -> None:
        position = self.find_position_at(point)
        if self._is_triple_click(point):
            start = position - self.buffer.find_column(position)
            self.select(start, start + len(self.buffer.read_line(self.buffer.find_line(position))) + 1)
        elif modifiers & Qt.KeyboardModifier.ShiftModifier:
            self.select(self.selection.anchor, position)
        else:
            self.select(position, position)
        self._double_clicked_at = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Select the word at the mouse."""
        if event.button() is not Qt.MouseButton.LeftButton:
            return
        position = self.find_position_at(event.position())
        column = self.buffer.find_column(position)
        line = self.buffer.read_line(self.buffer.find_line(position))
        words = [each.span() for each in _WORD.finditer(line) if each.start() <= column]
        start, end = words[-1] if words else (column, column)
        self.select(position - column + start, position - column + end)
        self._double_clicked_at = event.position()
        self._triple_click_time.start(QApplication.doubleClickInterval())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Extend the selection to the mouse, or scroll the text by touch."""
        if self._pressed_at is None:
            return
        self._last_point = event.position()
        if self._is_touch:
            self._scroll_by_touch(event.position() - self._pressed_at)
            return
        self.select(self.selection.anchor, self.find_position_at(event.position()))
        if self.viewport().rect().contains(event.position().toPoint()):
            self._auto_scroll.stop()
        elif not self._auto_scroll.isActive():
            self._auto_scroll.start()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Finish the selection, or place the cursor at the touched point.

        The middle button inserts the text that was last selected with the mouse.
        """
        clipboard = QGuiApplication.clipboard()
        if event.button() is Qt.MouseButton.MiddleButton and clipboard.supportsSelection():
            position = self.find_position_at(event.position())
            self.select(position, position)
            self.insert_at_cursor(clipboard.text(QClipboard.Mode.Selection))
        if event.button() is not Qt.MouseButton.LeftButton:
            return
        if self._is_touch and self._pressed_at is not None and not self._is_scrolling:
            self._press_mouse(self._pressed_at, event.modifiers())
        elif self.has_selection and not self._is_touch and clipboard.supportsSelection():
            clipboard.setText(self.selected_text, QClipboard.Mode.Selection)
        self._pressed_at = None
        self._auto_scroll.stop()

    def _scroll_by_touch(self, moved: QPointF) -> None:
        if moved.manhattanLength() >= QApplication.startDragDistance():
            self._is_scrolling = True
        if self._is_scrolling:
            down, across = self._scrolled_from
            self.verticalScrollBar().setValue(down - round(moved.y() / self.row_height_px))
            self.horizontalScrollBar().setValue(across - round(moved.x()))

    def _scroll_to_mouse(self) -> None:
        """Extend the selection while the mouse is held outside the view."""
        position = self.find_position_at(self._last_point)
        self.select(self.selection.anchor, position)

    def _is_triple_click(self, point: QPointF) -> bool:
        at = self._double_clicked_at
        return at is not None and (point - at).manhattanLength() < QApplication.startDragDistance()

    def _forget_double_click(self) -> None:
        self._double_clicked_at = None
