"""Text field with syntax colors, and a margin with line numbers and finding marks."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import (
    QFont,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPaintEvent,
    QResizeEvent,
    QSyntaxHighlighter,
    QTextBlock,
    QTextCharFormat,
    QTextCursor,
    QTextDocument,
    QTextFormat,
)
from PySide6.QtWidgets import QPlainTextEdit, QTextEdit, QWidget

from app.desk.translation import tr
from app.editor.editor_model import EditorModel, EditorStage
from app.screen.screen_theme import (
    ALIGN_CENTER,
    ALIGN_LEFT,
    ALIGN_RIGHT,
    ScreenTheme,
    ThemedPainter,
    draw_text,
)
from app.screen.window_layout import FINGERTIP_PX
from core.language.diagnostics import Diagnostic, Severity
from core.language.program_colors import color_program_line
from core.language.source import Dialect, guess_dialect
from core.language.syntax_colors import PLAIN_STATE, SyntaxKind

# Palette color of each kind; bold type distinguishes codes from coordinates without color.
_TOKEN_COLORS = {
    SyntaxKind.NUMBER: ("soft", False),
    SyntaxKind.CODE: ("accent", True),
    SyntaxKind.POSITION: ("text", False),
    SyntaxKind.FEED_AND_SPEED: ("run", False),
    SyntaxKind.KEYWORD: ("accent", False),
    SyntaxKind.CALL: ("pause", True),
    SyntaxKind.COMMENT: ("soft", False),
    SyntaxKind.ERROR: ("alarm", True),
}


class SyntaxHighlighter(QSyntaxHighlighter):
    """Syntax highlighter for a program text.

    The state that each line passes to the next line depends on the program language.
    """

    def __init__(self, theme: ScreenTheme, document: QTextDocument) -> None:
        super().__init__(document)
        self._look = theme
        self._dressed = theme.palette
        self._formats: dict[tuple[str, bool], QTextCharFormat] = {}
        self._dialect = Dialect.OMNITURN

    def set_dialect(self, dialect: Dialect) -> None:
        """Set the language of the text.

        If the language changes, the whole text is highlighted again.
        """
        if dialect is not self._dialect:
            self._dialect = dialect
            self.rehighlight()

    def apply_theme(self) -> None:
        """Apply the current colors.

        The text is highlighted again only if the colors have changed.
        """
        if self._dressed is not self._look.palette:
            self._dressed = self._look.palette
            self._formats.clear()
            self.rehighlight()

    def highlightBlock(self, text: str) -> None:
        """Highlight one line of the text.

        Qt calls this method when the text of the line or the highlighting state of the preceding line
        changes.
        """
        found, state = color_program_line(self._dialect, text, max(self.previousBlockState(), PLAIN_STATE))
        self.setCurrentBlockState(state)
        for start, length, ink in found:
            self.setFormat(start, length, self._format(*_TOKEN_COLORS[ink]))

    def _format(self, colour: str, bold: bool) -> QTextCharFormat:
        key = (colour, bold)
        if key not in self._formats:
            made = QTextCharFormat()
            made.setForeground(self._look.get_color(colour))
            if bold:
                made.setFontWeight(QFont.Weight.Bold)
            if colour == "alarm":
                made.setFontUnderline(True)
            self._formats[key] = made
        return self._formats[key]


TEXT_SIZE = 2.3  # text size in units
SEVERITY_COLORS = {Severity.ERROR: "alarm", Severity.WARNING: "pause", Severity.NOTE: "wait"}
SEVERITY_NAMES = {Severity.ERROR: "ERROR", Severity.WARNING: "WARNING", Severity.NOTE: "NOTE"}


class ProgramTextField(QPlainTextEdit):
    """Text field for a program, with the undo history, selection and clipboard of Qt.

    Function keys are passed to the page.
    """

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(parent)
        self.theme = theme
        self._found: Mapping[int, Diagnostic] = {}
        self.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.setTabChangesFocus(False)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)  # A menu would block every other key.
        self.setAcceptDrops(False)
        self.setUndoRedoEnabled(True)
        self.line_margin = LineMargin(self)
        self.highlighter = SyntaxHighlighter(theme, self.document())
        self.updateRequest.connect(self._scrolled)
        self.blockCountChanged.connect(lambda _count: self._make_room())
        self.cursorPositionChanged.connect(self._mark_line)

    @property
    def cursor_line(self) -> int:
        """Return the line number of the cursor, counted from 1."""
        return self.textCursor().blockNumber() + 1

    def replace_text(self, text: str, *, as_new: bool) -> None:
        """Replace the text of the field.

        ``as_new`` clears the undo history. Otherwise one undo reverses the change.
        """
        if as_new:
            self.setPlainText(text)
            return
        cursor = self.textCursor()
        cursor.select(QTextCursor.SelectionType.Document)
        cursor.insertText(text)
        cursor.movePosition(QTextCursor.MoveOperation.Start)
        self.setTextCursor(cursor)

    def move_cursor_to(self, line: int, column: int = 0) -> None:
        """Move the cursor to a line and column, and scroll so that the line is vertically centered."""
        block = self.document().findBlockByNumber(max(0, min(self.blockCount(), line) - 1))
        cursor = QTextCursor(block)
        cursor.setPosition(block.position() + max(0, min(column - 1, block.length() - 1)))
        self.setTextCursor(cursor)
        self.centerCursor()

    def select_range(self, start: int, length: int) -> None:
        """Select a range of the text and scroll to it."""
        cursor = self.textCursor()
        cursor.setPosition(start)
        cursor.setPosition(start + length, QTextCursor.MoveMode.KeepAnchor)
        self.setTextCursor(cursor)
        self.ensureCursorVisible()

    @property
    def cursor_column(self) -> int:
        """Return the column of the cursor, counted from 1."""
        return self.textCursor().positionInBlock() + 1

    def insert_text(self, text: str, start: int = 0) -> None:
        """Insert text at the cursor.

        If ``start`` is not 0, the inserted text replaces the text from the column ``start`` to the cursor.
        """
        cursor = self.textCursor()
        cursor.beginEditBlock()
        if start:
            cursor.setPosition(cursor.block().position() + start - 1, QTextCursor.MoveMode.KeepAnchor)
        cursor.insertText(text)
        cursor.endEditBlock()
        self.setTextCursor(cursor)

    def replace_text_ranges(self, positions: tuple[int, ...], length: int, replacement: str) -> None:
        """Replace several ranges with ``replacement``, as one step of the undo history.

        The ranges start at ``positions`` and have the same ``length``.
        """
        cursor = QTextCursor(self.document())
        cursor.beginEditBlock()
        for start in reversed(positions):
            cursor.setPosition(start)
            cursor.setPosition(start + length, QTextCursor.MoveMode.KeepAnchor)
            cursor.insertText(replacement)
        cursor.endEditBlock()

    def show_findings(self, line_findings: Mapping[int, Diagnostic]) -> None:
        """Show each finding next to the line that it concerns."""
        if line_findings != self._found:
            self._found = line_findings
            self.line_margin.update()
            self.viewport().update()

    def find_finding(self, line: int) -> Diagnostic | None:
        """Return the finding in a line, or None if the line has no finding."""
        return self._found.get(line)

    def apply_theme(self) -> None:
        """Apply the font and the colors of the theme."""
        colours = self.theme.palette
        self.setFont(self.theme.make_font(self.theme.find_table_size(TEXT_SIZE)))
        self.setStyleSheet(
            f"QPlainTextEdit {{ background: {colours.panel}; color: {colours.text};"
            f" border: {max(1, round(0.16 * self.theme.unit_px))}px solid {colours.frame};"
            f" selection-background-color: {colours.lit}; selection-color: {colours.on_lit}; }}"
            f"QScrollBar:vertical {{ width: {max(FINGERTIP_PX, round(3.4 * self.theme.unit_px))}px; }}"
            f"QScrollBar:horizontal {{ height: {round(2.4 * self.theme.unit_px)}px; }}"
        )
        for part in (self, self.verticalScrollBar(), self.horizontalScrollBar()):
            part.setAccessibleName(tr("PROGRAM"))
        self.setCursorWidth(max(2, round(0.3 * self.theme.unit_px)))
        self.setTabStopDistance(4 * QFontMetricsF(self.font()).horizontalAdvance("0"))
        self.highlighter.apply_theme()
        self._make_room()
        self._mark_line()

    # --- Qt's calls ----------------------------------------------------------------------------------

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

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Clear the selection before handling a mouse press, so that selected text cannot be dragged.

        Dragging text with the mouse would block all keys, including the stop keys.
        """
        shift = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if self.textCursor().hasSelection() and event.button() is Qt.MouseButton.LeftButton and not shift:
            self.setTextCursor(self.cursorForPosition(event.position().toPoint()))
        super().mousePressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Place the margin after the size of the field has changed."""
        super().resizeEvent(event)
        room = self.contentsRect()
        self.line_margin.setGeometry(room.left(), room.top(), self.line_margin.width_px, room.height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the text and, after each line with a finding, the message of the finding."""
        super().paintEvent(event)
        if not self._found:
            return
        with ThemedPainter(self.viewport(), self.theme) as painter:
            painter.setFont(self.theme.make_font(1.7))
            for block, box in self.find_visible_blocks():
                found = self._found.get(block.blockNumber() + 1)
                if found is not None:
                    self._message(painter, block, box, found)

    def _message(self, painter: ThemedPainter, block: QTextBlock, box: QRectF, found: Diagnostic) -> None:
        u = self.theme.unit_px
        wide = QFontMetricsF(self.font()).horizontalAdvance(block.text().expandtabs(4))
        room = QRectF(
            box.x() + wide + 3 * u, box.y(), self.viewport().width() - box.x() - wide - 4 * u, box.height()
        )
        if room.width() > 12 * u:
            painter.setPen(self.theme.get_color(SEVERITY_COLORS[found.severity]))
            draw_text(painter, room, ALIGN_LEFT, found.text)

    def find_visible_blocks(self) -> list[tuple[QTextBlock, QRectF]]:
        """Return the visible text blocks with their rectangles."""
        rows = []
        block = self.firstVisibleBlock()
        box = self.blockBoundingGeometry(block).translated(self.contentOffset())
        while block.isValid() and box.top() <= self.viewport().height():
            rows.append((block, QRectF(box)))
            block = block.next()
            box.translate(0, box.height())
        return rows

    def _scrolled(self, _rect: object, _by: int) -> None:
        self.line_margin.update()

    def _make_room(self) -> None:
        self.setViewportMargins(self.line_margin.width_px, 0, 0, 0)
        room = self.contentsRect()
        self.line_margin.setGeometry(room.left(), room.top(), self.line_margin.width_px, room.height())

    def _mark_line(self) -> None:
        mark = QTextEdit.ExtraSelection()
        mark.format.setBackground(self.theme.get_color("here"))
        mark.format.setProperty(QTextFormat.Property.FullWidthSelection, True)
        mark.cursor = self.textCursor()
        mark.cursor.clearSelection()
        self.setExtraSelections([mark])
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
        with ThemedPainter(self, look) as painter:
            painter.fill_rect(QRectF(self.rect()), "ground")
            for block, box in field.find_visible_blocks():
                number = block.blockNumber() + 1
                here = number == field.cursor_line
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
        for block, box in self._field.find_visible_blocks():
            if box.top() <= event.position().y() < box.bottom():
                self._field.move_cursor_to(block.blockNumber() + 1)
                self._field.setFocus()


_PAGE_KEYS = frozenset({Qt.Key.Key_Escape, *(Qt.Key(Qt.Key.Key_F1 + n) for n in range(12))})
_CHORD_KEYS = frozenset(
    {Qt.Key.Key_Space, Qt.Key.Key_S, Qt.Key.Key_F, Qt.Key.Key_H, Qt.Key.Key_G, Qt.Key.Key_M}
)

# --- between the field and the editor ----------------------------------------------------------------------


class TextSynchronizer:
    """Synchronizer between the text field and the editor model, which acts at most once per frame."""

    def __init__(self, text_field: ProgramTextField, editor_model: EditorModel) -> None:
        self._field, self._editor = text_field, editor_model
        # revision of the field and document of the last comparison
        self._seen: tuple[int, object] = (-1, None)
        self._dirty = False
        self._taken = 0  # number of the editor's text that is in the field
        self.is_stale = False  # the text has changed since it was passed to the editor
        self._taking = False  # the field is being changed by this object
        self._text = ""
        text_field.textChanged.connect(self._changed)

    def _changed(self) -> None:
        self.is_stale = True
        if not self._taking:
            self._editor.clear_message()  # Typing clears the message and cancels a question.

    def read_text(self) -> str:
        """Return the current text of the field."""
        return self._field.toPlainText()

    @property
    def is_dirty(self) -> bool:
        """Return whether the text has unsaved changes.

        The comparison is cached until the text changes.
        """
        seen = (self._field.document().revision(), self._editor.document)
        if seen != self._seen:
            self._seen, self._dirty = seen, self._editor.is_dirty(self.read_text())
        return self._dirty

    def synchronize(self) -> None:
        """Copy a new text of the editor model into the field, or submit typed text to the live proof.

        This method is called once per frame.
        """
        editor, field = self._editor, self._field
        self._update_dialect()
        if editor.loaded_text_count != self._taken:
            self._taken = editor.loaded_text_count
            self._taking = True
            field.replace_text(editor.text, as_new=not editor.is_replacement_undoable)
            self._taking = False
            field.setFocus()
            self.is_stale = True
        if self.is_stale:
            self.is_stale = False
            self._text = self.read_text()
            editor.update_text(self._text)
        field.setReadOnly(editor.stage is not EditorStage.OPEN)

    def _update_dialect(self) -> None:
        """Set the program language that the file name indicates.

        The resulting change of colors does not count as a change of the text.
        """
        document = self._editor.document
        if document is not None:
            before, self._taking = self.is_stale, True
            self._field.highlighter.set_dialect(guess_dialect(document.name))
            self._taking, self.is_stale = False, before

    @property
    def mark(self) -> str:
        """Return the label for the state of the text: CHANGED, SAMPLE, NEW, or empty if unchanged."""
        document = self._editor.document
        if document is None:
            return ""
        dirty = self._editor.is_dirty(self._text)
        if document.is_read_only:
            return "SAMPLE, CHANGED" if dirty else "SAMPLE"
        if document.is_new:
            return "NEW"
        return "CHANGED" if dirty else ""
