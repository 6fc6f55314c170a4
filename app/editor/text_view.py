"""Text field with syntax colors, and a margin with line numbers and finding marks."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QKeyEvent, QMouseEvent, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.translation import tr
from app.editor.syntax_highlighter_view import SyntaxHighlighter
from app.screen.screen_theme import (
    ALIGN_CENTER,
    ALIGN_LEFT,
    ALIGN_RIGHT,
    ScreenTheme,
    ThemedPainter,
    draw_text,
)
from app.screen.text_area.line_view import MARGIN_PX, LineColors, TextAreaColors
from app.screen.text_area.text_area import TextArea
from app.screen.text_area.text_buffer import TextSelection
from app.screen.window_layout import FINGERTIP_PX
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect

TEXT_SIZE = 2.3  # text size in units
SEVERITY_COLORS = {Severity.ERROR: "alarm", Severity.WARNING: "pause", Severity.NOTE: "wait"}
SEVERITY_NAMES = {Severity.ERROR: "ERROR", Severity.WARNING: "WARNING", Severity.NOTE: "NOTE"}


class ProgramTextField(TextArea):
    """Text field for a program. Function keys are passed to the page."""

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(parent)
        self.theme = theme
        self._found: Mapping[int, Diagnostic] = {}
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)  # A menu would block every other key.
        self.setAcceptDrops(False)
        self.viewport().setAcceptDrops(False)
        self.line_margin = LineMargin(self)
        self.highlighter = SyntaxHighlighter(theme, self.buffer)
        self.verticalScrollBar().valueChanged.connect(lambda _value: self.line_margin.update())
        self.cursor_moved.connect(self.line_margin.update)
        self.text_changed.connect(self._make_room)

    def replace_text(self, text: str, *, as_new: bool) -> None:
        """Replace the text of the field.

        ``as_new`` clears the undo history. Otherwise one undo reverses the change.
        """
        if as_new:
            self.setPlainText(text)
            return
        self.replace_range(0, self.buffer.length, text)
        self.select(0, 0)

    def move_cursor_to(self, line: int, column: int = 0) -> None:
        """Move the cursor to a line and column, and scroll so that the line is vertically centered."""
        position = self.buffer.find_position(line - 1, column - 1)
        self.select(position, position)
        self.center_cursor()

    def select_range(self, start: int, length: int) -> None:
        """Select a range of the text and scroll to it."""
        self.select(start, start + length)

    def insert_text(self, text: str, start: int = 0) -> None:
        """Insert text at the cursor.

        If ``start`` is not 0, the inserted text replaces the text from the column ``start`` to the cursor.
        """
        position = self.selection.position
        first = position - self.cursor_column + start if start else self.selection.start
        self.replace_range(first, position if start else self.selection.end, text)

    def replace_text_ranges(self, positions: tuple[int, ...], length: int, replacement: str) -> None:
        """Replace several ranges with ``replacement``, as one step of the undo history.

        The ranges start at ``positions`` and have the same ``length``.
        """
        before = self.selection
        self.buffer.replace_matches(positions, length, replacement, before)
        end = min(before.position, self.buffer.length)
        self._after_edit(TextSelection(end, end))

    def set_dialect(self, dialect: Dialect) -> None:
        """Set the program language, which determines the colors."""
        if self.highlighter.set_dialect(dialect):
            self.forget_layouts()

    def find_line_errors(self, first: int, count: int) -> list[Diagnostic]:
        """Return the syntax errors of ``count`` lines, beginning with ``first``, which counts from 0."""
        return [
            error
            for line, text in enumerate(self.buffer.read_lines(first, count), first)
            for error in self.highlighter.find_line_errors(line, text)
        ]

    def show_findings(self, line_findings: Mapping[int, Diagnostic]) -> None:
        """Show each finding next to the line that it concerns."""
        if line_findings is not self._found:
            self._found = line_findings
            self.line_margin.update()
            self.viewport().update()

    def find_finding(self, line: int) -> Diagnostic | None:
        """Return the finding in a line, or None if the line has no finding."""
        return self._found.get(line)

    def apply_theme(self) -> None:
        """Apply the font and the colors of the theme."""
        theme, colours = self.theme, self.theme.palette
        font = theme.make_font(theme.find_table_size(TEXT_SIZE))
        is_other_font = font != self.font()
        self.setFont(font)
        self.setStyleSheet(
            f"QAbstractScrollArea {{ background: {colours.panel};"
            f" border: {max(1, round(0.16 * theme.unit_px))}px solid {colours.frame}; }}"
            f"QScrollBar:vertical {{ width: {max(FINGERTIP_PX, round(3.4 * theme.unit_px))}px; }}"
            f"QScrollBar:horizontal {{ height: {round(2.4 * theme.unit_px)}px; }}"
        )
        for part in (self, self.verticalScrollBar(), self.horizontalScrollBar()):
            part.setAccessibleName(tr("PROGRAM"))
        self.cursor_width_px = max(2, round(0.3 * theme.unit_px))
        self.colors = TextAreaColors(
            *(theme.get_color(name) for name in ("panel", "text", "here", "lit", "on_lit"))
        )
        self.set_tab_width(4 * QFontMetricsF(self.font()).horizontalAdvance("0"))
        if self.highlighter.apply_theme() or is_other_font:
            self.forget_layouts()
        self._make_room()
        self.update_scroll_bars()
        self.viewport().update()

    # --- Colors, painting and Qt's calls -------------------------------------------------------------

    def find_line_colors(self, line: int, text: str) -> LineColors:
        """Return the syntax colors of a line."""
        return self.highlighter.find_line_colors(line, text)

    def find_layout_key(self, line: int, text: str) -> object:
        """Return the text of the line and the state that the preceding lines pass to it."""
        return text, self.highlighter.find_state_before(line)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle the editing keys.

        Function keys, Esc and the key combinations of the page are passed to the page.
        """
        chord = event.modifiers() & Qt.KeyboardModifier.ControlModifier
        page = event.key() in _PAGE_KEYS or (bool(chord) and event.key() in _CHORD_KEYS)
        if page:
            event.ignore()
        else:
            super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Place the margin after the size of the field has changed."""
        super().resizeEvent(event)
        self._make_room()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the text and, after each line with a finding, the message of the finding."""
        super().paintEvent(event)
        if not self._found:
            return
        with ThemedPainter(self.viewport(), self.theme) as painter:
            painter.setFont(self.theme.make_font(1.7))
            for line in self.find_visible_lines():
                found = self._found.get(line + 1)
                if found is not None:
                    self._draw_message(painter, line, found)

    def _draw_message(self, painter: ThemedPainter, line: int, found: Diagnostic) -> None:
        u, box, text = self.theme.unit_px, self.find_row_rect(line), self.buffer.read_line(line)
        left = MARGIN_PX - self.horizontalScrollBar().value() + self.find_column_x(line, len(text)) + 3 * u
        room = QRectF(left, box.y(), self.viewport().width() - left - u, box.height())
        if room.width() > 12 * u:
            painter.setPen(self.theme.get_color(SEVERITY_COLORS[found.severity]))
            draw_text(painter, room, ALIGN_LEFT, found.text)

    def _make_room(self) -> None:
        width = self.line_margin.width_px
        if self.viewportMargins().left() != width:
            self.setViewportMargins(width, 0, 0, 0)
        room = self.contentsRect()
        self.line_margin.setGeometry(room.left(), room.top(), width, room.height())
        self.line_margin.update()


class LineMargin(QWidget):
    """Margin with line numbers and a colored letter for each line with a finding."""

    def __init__(self, text_field: ProgramTextField) -> None:
        super().__init__(text_field)
        self._field = text_field

    @property
    def width_px(self) -> int:
        """Return the width of the margin in pixels, which depends on the number of digits."""
        digits = max(3, len(str(self._field.blockCount())))
        return round((3.4 + 1.35 * digits) * self._field.theme.unit_px)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the visible line numbers and findings."""
        look, u, field = self._field.theme, self._field.theme.unit_px, self._field
        cursor_line = field.cursor_line
        with ThemedPainter(self, look) as painter:
            painter.fill_rect(QRectF(self.rect()), "ground")
            for line in field.find_visible_lines():
                number, box = line + 1, field.find_row_rect(line)
                here = number == cursor_line
                row = QRectF(0, box.y(), self.width(), box.height())
                found = field.find_finding(number)
                if found is not None:
                    patch = row.adjusted(0.2 * u, 0.1 * u, -(row.width() - 2.2 * u), -0.1 * u)
                    painter.fill_rect(patch, SEVERITY_COLORS[found.severity])
                    painter.draw_text_line(
                        patch, tr(SEVERITY_NAMES[found.severity])[0], 1.8, "on_state", at=ALIGN_CENTER
                    )
                room, ink = row.adjusted(2.4 * u, 0, -0.8 * u, 0), "text" if here else "soft"
                painter.draw_text_line(room, str(number), 1.8, ink, at=ALIGN_RIGHT, bold=here)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Move the cursor to the touched line."""
        self._field.move_cursor_to(self._field.find_line_at(event.position().y()) + 1)
        self._field.setFocus()


_PAGE_KEYS = frozenset({Qt.Key.Key_Escape, *(Qt.Key(Qt.Key.Key_F1 + n) for n in range(12))})
_CHORD_KEYS = frozenset(
    {Qt.Key.Key_Space, Qt.Key.Key_S, Qt.Key.Key_F, Qt.Key.Key_H, Qt.Key.Key_G, Qt.Key.Key_M}
)
