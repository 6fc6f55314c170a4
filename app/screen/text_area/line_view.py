"""View of the lines of a text, which lays out and paints only the visible lines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from PySide6.QtCore import QPointF, QRectF, Signal
from PySide6.QtGui import (
    QColor,
    QFontMetricsF,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QTextCharFormat,
    QTextLayout,
    QTextOption,
)
from PySide6.QtWidgets import QAbstractScrollArea, QWidget

from app.screen.text_area.text_buffer import TextBuffer, TextSelection

MARGIN_PX = 4  # left of the text
_MAX_LAYOUTS = 512  # number of stored layouts of lines
LineColors = Sequence[tuple[int, int, QTextCharFormat]]
"""Colored spans of a line: start column, length and format. Columns count from 0."""


class TextAreaColors(NamedTuple):
    """Colors of a text area."""

    background: QColor = QColor("white")
    text: QColor = QColor("black")
    current_line: QColor = QColor("white")  # background of the line of the cursor
    selection: QColor = QColor("navy")  # background of selected text
    selected_text: QColor = QColor("white")


class LineView(QAbstractScrollArea):
    """View of a text with a selection, a text cursor and scroll bars.

    The vertical scroll bar counts lines.
    """

    text_changed = Signal()
    cursor_moved = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.buffer = TextBuffer()
        self.selection = TextSelection()
        self.cursor_width_px = 2
        self.is_cursor_shown = False
        self.colors = TextAreaColors()
        self._tab_width_px = 32.0
        self._widest_px = 0.0  # of the lines painted so far
        self._layouts: dict[object, QTextLayout] = {}
        self.horizontalScrollBar().setSingleStep(20)
        self.verticalScrollBar().valueChanged.connect(lambda _value: self.viewport().update())
        self.horizontalScrollBar().valueChanged.connect(lambda _value: self.viewport().update())

    # --- contents ------------------------------------------------------------------------------------

    def toPlainText(self) -> str:
        """Return the whole text."""
        return self.buffer.text

    def blockCount(self) -> int:
        """Return the number of lines."""
        return self.buffer.line_count

    @property
    def cursor_line(self) -> int:
        """Return the line number of the cursor, counted from 1."""
        return self.buffer.find_line(self.selection.position) + 1

    @property
    def cursor_column(self) -> int:
        """Return the column of the cursor, counted from 1."""
        return self.buffer.find_column(self.selection.position) + 1

    @property
    def cursor_line_text(self) -> str:
        """Return the text of the line of the cursor."""
        return self.buffer.read_line(self.buffer.find_line(self.selection.position))

    @property
    def selected_text(self) -> str:
        """Return the selected text."""
        return self.buffer.read_range(self.selection.start, self.selection.end)

    @property
    def has_selection(self) -> bool:
        """Return whether at least one character is selected."""
        return self.selection.anchor != self.selection.position

    # --- geometry ------------------------------------------------------------------------------------

    @property
    def row_height_px(self) -> int:
        """Return the height of a line in pixels."""
        return max(1, math.ceil(QFontMetricsF(self.font()).height()))

    @property
    def row_count(self) -> int:
        """Return the number of lines that fit completely in the view, but at least 1."""
        return max(1, self.viewport().height() // self.row_height_px)

    @property
    def first_line(self) -> int:
        """Return the first visible line, counted from 0."""
        return min(self.verticalScrollBar().value(), self.buffer.line_count - 1)

    def find_row_rect(self, line: int) -> QRectF:
        """Return the rectangle of a line in the viewport. Lines count from 0."""
        high = self.row_height_px
        return QRectF(0, (line - self.first_line) * high, self.viewport().width(), high)

    def find_visible_lines(self) -> range:
        """Return the visible lines, including a line that is visible only in part."""
        first, rows = self.first_line, math.ceil(self.viewport().height() / self.row_height_px)
        return range(first, min(self.buffer.line_count, first + rows))

    def find_line_at(self, y: float) -> int:
        """Return the line at a vertical pixel position of the viewport, or else the nearest line."""
        return max(0, min(self.buffer.line_count - 1, self.first_line + math.floor(y / self.row_height_px)))

    def find_position_at(self, point: QPointF) -> int:
        """Return the text position nearest to a point of the viewport."""
        return self.find_position_in_line(self.find_line_at(point.y()), point.x() - self._text_left)

    def find_position_in_line(self, line: int, x: float) -> int:
        """Return the text position nearest to a distance in pixels from the start of a line."""
        text = self.buffer.read_line(line)
        units = self.lay_out_line(line, text).lineAt(0).xToCursor(x)
        return self.buffer.find_line_start(line) + _count_characters(text, int(units))

    def find_cursor_rect(self) -> QRectF:
        """Return the rectangle of the text cursor in the viewport."""
        line = self.buffer.find_line(self.selection.position)
        row = self.find_row_rect(line)
        left = self._text_left + self.find_column_x(line, self.buffer.find_column(self.selection.position))
        return QRectF(left, row.y(), self.cursor_width_px, row.height())

    def find_column_x(self, line: int, column: int) -> float:
        """Return the distance in pixels from the start of a line to a column. Both count from 0."""
        text = self.buffer.read_line(line)
        result: Any = self.lay_out_line(line, text).lineAt(0).cursorToX(_count_units(text, column))
        return float(result[0] if isinstance(result, tuple) else result)

    def scroll_to_cursor(self) -> None:
        """Scroll by the smallest distance that makes the cursor visible."""
        line, bar = self.buffer.find_line(self.selection.position), self.verticalScrollBar()
        self.update_scroll_bars()
        if line < bar.value():
            bar.setValue(line)
        elif line >= bar.value() + self.row_count:
            bar.setValue(line - self.row_count + 1)
        box, across = self.find_cursor_rect(), self.horizontalScrollBar()
        self._widest_px = max(self._widest_px, box.right() - self._text_left)
        self.update_scroll_bars()
        if box.left() < MARGIN_PX:
            across.setValue(across.value() + math.floor(box.left()) - MARGIN_PX)
        elif box.right() > self.viewport().width():
            across.setValue(across.value() + math.ceil(box.right()) - self.viewport().width())

    def center_cursor(self) -> None:
        """Scroll so that the line of the cursor is in the middle of the view."""
        self.update_scroll_bars()
        line = self.buffer.find_line(self.selection.position)
        self.verticalScrollBar().setValue(line - self.row_count // 2)
        self.scroll_to_cursor()

    def update_scroll_bars(self) -> None:
        """Update the ranges of the scroll bars for the present text and size."""
        down, across = self.verticalScrollBar(), self.horizontalScrollBar()
        down.setPageStep(self.row_count)
        down.setRange(0, max(0, self.buffer.line_count - self.row_count))
        wide = self.viewport().width()
        across.setPageStep(wide)
        across.setRange(0, max(0, math.ceil(self._widest_px) + 2 * MARGIN_PX - wide))

    @property
    def _text_left(self) -> float:
        return MARGIN_PX - self.horizontalScrollBar().value()

    # --- layout and painting of lines ----------------------------------------------------------------

    def find_line_colors(self, _line: int, _text: str) -> LineColors:
        """Return the colored spans of a line. A subclass overrides this method."""
        return ()

    def find_layout_key(self, _line: int, text: str) -> object:
        """Return a value that determines the layout of a line. A subclass can add the state of its colors."""
        return text

    def forget_layouts(self) -> None:
        """Discard the stored layouts, because the font or the colors have changed."""
        self._layouts.clear()
        self._widest_px = 0.0
        self.viewport().update()

    def set_tab_width(self, width_px: float) -> None:
        """Set the distance between two tab stops in pixels."""
        self._tab_width_px = width_px

    def lay_out_line(self, line: int, text: str) -> QTextLayout:
        """Return the layout of a line."""
        key = self.find_layout_key(line, text)
        found = self._layouts.get(key)
        if found is None:
            if len(self._layouts) >= _MAX_LAYOUTS:
                self._layouts.clear()
            found = self._layouts[key] = self._make_layout(text, self.find_line_colors(line, text))
        return found

    def _make_layout(self, text: str, colors: LineColors) -> QTextLayout:
        layout = QTextLayout(text, self.font())
        option = QTextOption()
        option.setWrapMode(QTextOption.WrapMode.NoWrap)
        option.setTabStopDistance(self._tab_width_px)
        layout.setTextOption(option)
        layout.setCacheEnabled(True)
        layout.setFormats([_make_format_range(text, *span) for span in colors])
        layout.beginLayout()
        layout.createLine()
        layout.endLayout()
        return layout

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Update the scroll bars after the size has changed."""
        super().resizeEvent(event)
        self.update_scroll_bars()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Paint the visible lines, the selection and the cursor."""
        widest = self._widest_px
        painter = QPainter(self.viewport())
        try:
            self._paint_lines(painter)
            if self.is_cursor_shown:
                painter.fillRect(self.find_cursor_rect(), self.colors.text)
        finally:
            painter.end()
        if self._widest_px > widest:
            self.update_scroll_bars()

    def _paint_lines(self, painter: QPainter) -> None:
        lines = self.find_visible_lines()
        cursor_line = self.buffer.find_line(self.selection.position)
        painter.fillRect(self.viewport().rect(), self.colors.background)
        painter.setPen(self.colors.text)
        start = self.buffer.find_line_start(lines.start)
        for line, text in zip(lines, self.buffer.read_lines(lines.start, len(lines)), strict=True):
            row = self.find_row_rect(line)
            if line == cursor_line:
                painter.fillRect(row, self.colors.current_line)
            layout = self.lay_out_line(line, text)
            self._widest_px = max(self._widest_px, layout.lineAt(0).naturalTextWidth())
            layout.draw(painter, QPointF(self._text_left, row.y()), self._find_selected_spans(text, start))
            start += len(text) + 1

    def _find_selected_spans(self, text: str, start: int) -> list[QTextLayout.FormatRange]:
        """Return the selected span of a line that starts at the position ``start``."""
        first, end = self.selection.start - start, self.selection.end - start
        first, last = max(0, first), min(len(text), end)
        if last <= first:
            return []
        selected = QTextCharFormat()
        selected.setBackground(self.colors.selection)
        selected.setForeground(self.colors.selected_text)
        return [_make_format_range(text, first, last - first, selected)]


def _make_format_range(text: str, start: int, length: int, form: QTextCharFormat) -> QTextLayout.FormatRange:
    made = QTextLayout.FormatRange()
    made.start = _count_units(text, start)
    made.length = _count_units(text, start + length) - made.start
    made.format = form
    return made


def _count_units(text: str, column: int) -> int:
    """Return the number of UTF-16 units of the first ``column`` characters. Qt counts UTF-16 units."""
    return column if text.isascii() else len(text[:column].encode("utf-16-le", "surrogatepass")) // 2


def _count_characters(text: str, units: int) -> int:
    """Return the number of characters in the first ``units`` UTF-16 units of a text."""
    if text.isascii():
        return units
    head = text.encode("utf-16-le", "surrogatepass")[: 2 * units]
    return len(head.decode("utf-16-le", "ignore"))
