"""Text field with syntax colors and a margin of line numbers and finding marks."""

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
from app.editor.editor import Editor, Stage
from app.screen.look import CENTRE, LEFT, RIGHT, Look, Painter, put
from app.screen.window_layout import FINGER
from core.language.diagnostics import Diagnostic, Severity
from core.language.program_colours import spans
from core.language.source import Dialect, dialect_of
from core.language.syntax_colours import PLAIN, Ink

# Palette color of each kind; bold type distinguishes codes from coordinates without color.
_OF_INK = {
    Ink.NUMBER: ("soft", False),
    Ink.CODE: ("accent", True),
    Ink.POSITION: ("text", False),
    Ink.RUN: ("run", False),
    Ink.KEY: ("accent", False),
    Ink.CALL: ("pause", True),
    Ink.COMMENT: ("soft", False),
    Ink.FAULT: ("alarm", True),
}


class Highlighter(QSyntaxHighlighter):
    """Syntax highlighter. The state passed from line to line depends on the language."""

    def __init__(self, look: Look, document: QTextDocument) -> None:
        super().__init__(document)
        self._look = look
        self._dressed = look.palette
        self._formats: dict[tuple[str, bool], QTextCharFormat] = {}
        self._dialect = Dialect.OMNITURN

    def speak(self, dialect: Dialect) -> None:
        """Set the language of the text. A changed language highlights the whole text again."""
        if dialect is not self._dialect:
            self._dialect = dialect
            self.rehighlight()

    def dress(self) -> None:
        """Apply the present colors. The text is highlighted again only after a change."""
        if self._dressed is not self._look.palette:
            self._dressed = self._look.palette
            self._formats.clear()
            self.rehighlight()

    def highlightBlock(self, text: str) -> None:
        """Highlight a line, as Qt requests after a change of the line or of its start state."""
        found, state = spans(self._dialect, text, max(self.previousBlockState(), PLAIN))
        self.setCurrentBlockState(state)
        for start, length, ink in found:
            self.setFormat(start, length, self._format(*_OF_INK[ink]))

    def _format(self, colour: str, bold: bool) -> QTextCharFormat:
        key = (colour, bold)
        if key not in self._formats:
            made = QTextCharFormat()
            made.setForeground(self._look.colour(colour))
            if bold:
                made.setFontWeight(QFont.Weight.Bold)
            if colour == "alarm":
                made.setFontUnderline(True)
            self._formats[key] = made
        return self._formats[key]


SIZE = 2.3  # text size in units
TONES = {Severity.ERROR: "alarm", Severity.WARNING: "pause", Severity.NOTE: "wait"}
WORDS = {Severity.ERROR: "ERROR", Severity.WARNING: "WARNING", Severity.NOTE: "NOTE"}


class TextField(QPlainTextEdit):
    """Text field with Qt's undo, selection and clipboard.

    Function keys pass through to the page.
    """

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self.look = look
        self._found: Mapping[int, Diagnostic] = {}
        self.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.setTabChangesFocus(False)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.NoContextMenu)  # A menu would block every other key.
        self.setAcceptDrops(False)
        self.setUndoRedoEnabled(True)
        self.margin = Margin(self)
        self.highlighter = Highlighter(look, self.document())
        self.updateRequest.connect(self._scrolled)
        self.blockCountChanged.connect(lambda _count: self._make_room())
        self.cursorPositionChanged.connect(self._mark_line)

    @property
    def line(self) -> int:
        """Line of the cursor, from 1."""
        return self.textCursor().blockNumber() + 1

    def put_text(self, text: str, *, afresh: bool) -> None:
        """Put a text into the field.

        ``afresh`` clears the undo history. Otherwise the change can be undone as one step.
        """
        if afresh:
            self.setPlainText(text)
            return
        cursor = self.textCursor()
        cursor.select(QTextCursor.SelectionType.Document)
        cursor.insertText(text)
        cursor.movePosition(QTextCursor.MoveOperation.Start)
        self.setTextCursor(cursor)

    def go_to(self, line: int, column: int = 0) -> None:
        """Move the cursor to a line and column, and center the line."""
        block = self.document().findBlockByNumber(max(0, min(self.blockCount(), line) - 1))
        cursor = QTextCursor(block)
        cursor.setPosition(block.position() + max(0, min(column - 1, block.length() - 1)))
        self.setTextCursor(cursor)
        self.centerCursor()

    def select(self, start: int, length: int) -> None:
        """Select a range of the text and scroll to it."""
        cursor = self.textCursor()
        cursor.setPosition(start)
        cursor.setPosition(start + length, QTextCursor.MoveMode.KeepAnchor)
        self.setTextCursor(cursor)
        self.ensureCursorVisible()

    @property
    def column(self) -> int:
        """Column of the cursor, from 1."""
        return self.textCursor().positionInBlock() + 1

    def write(self, text: str, begin: int = 0) -> None:
        """Insert text at the cursor.

        ``begin`` is the column from which text of the line is replaced.
        """
        cursor = self.textCursor()
        cursor.beginEditBlock()
        if begin:
            cursor.setPosition(cursor.block().position() + begin - 1, QTextCursor.MoveMode.KeepAnchor)
        cursor.insertText(text)
        cursor.endEditBlock()
        self.setTextCursor(cursor)

    def replace_at(self, places: tuple[int, ...], length: int, by: str) -> None:
        """Replace the ranges with ``by`` as one step that can be undone."""
        cursor = QTextCursor(self.document())
        cursor.beginEditBlock()
        for start in reversed(places):
            cursor.setPosition(start)
            cursor.setPosition(start + length, QTextCursor.MoveMode.KeepAnchor)
            cursor.insertText(by)
        cursor.endEditBlock()

    def show_findings(self, found: Mapping[int, Diagnostic]) -> None:
        """Show the findings by line."""
        if found != self._found:
            self._found = found
            self.margin.update()
            self.viewport().update()

    def finding_at(self, line: int) -> Diagnostic | None:
        """Return the finding in a line, or None."""
        return self._found.get(line)

    def dress(self) -> None:
        """Apply font and colors of the look."""
        colours = self.look.palette
        self.setFont(self.look.font(SIZE))
        self.setStyleSheet(
            f"QPlainTextEdit {{ background: {colours.panel}; color: {colours.text};"
            f" border: {max(1, round(0.16 * self.look.u))}px solid {colours.frame};"
            f" selection-background-color: {colours.lit}; selection-color: {colours.on_lit}; }}"
            f"QScrollBar:vertical {{ width: {max(FINGER, round(3.4 * self.look.u))}px; }}"
            f"QScrollBar:horizontal {{ height: {round(2.4 * self.look.u)}px; }}"
        )
        for part in (self, self.verticalScrollBar(), self.horizontalScrollBar()):
            part.setAccessibleName(tr("PROGRAM"))
        self.setCursorWidth(max(2, round(0.3 * self.look.u)))
        self.setTabStopDistance(4 * QFontMetricsF(self.font()).horizontalAdvance("0"))
        self.highlighter.dress()
        self._make_room()
        self._mark_line()

    # --- Qt's calls ----------------------------------------------------------------------------------

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Handle keys that edit.

        Function keys, Esc and the page's key combinations go to the page.
        """
        chord = event.modifiers() & Qt.KeyboardModifier.ControlModifier
        page = event.key() in _PAGE or (bool(chord) and event.key() in _CHORDS)
        if page:
            event.ignore()
        else:
            super().keyPressEvent(event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Clear the selection before a press.

        A drag of selected text would block all keys, including the stop keys.
        """
        shift = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if self.textCursor().hasSelection() and event.button() is Qt.MouseButton.LeftButton and not shift:
            self.setTextCursor(self.cursorForPosition(event.position().toPoint()))
        super().mousePressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Place the margin after a change of size."""
        super().resizeEvent(event)
        room = self.contentsRect()
        self.margin.setGeometry(room.left(), room.top(), self.margin.wide, room.height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the text, and the message after each line with a finding."""
        super().paintEvent(event)
        if not self._found:
            return
        with Painter(self.viewport(), self.look) as painter:
            painter.setFont(self.look.font(1.7))
            for block, box in self.shown():
                found = self._found.get(block.blockNumber() + 1)
                if found is not None:
                    self._message(painter, block, box, found)

    def _message(self, painter: Painter, block: QTextBlock, box: QRectF, found: Diagnostic) -> None:
        u = self.look.u
        wide = QFontMetricsF(self.font()).horizontalAdvance(block.text().expandtabs(4))
        room = QRectF(
            box.x() + wide + 3 * u, box.y(), self.viewport().width() - box.x() - wide - 4 * u, box.height()
        )
        if room.width() > 12 * u:
            painter.setPen(self.look.colour(TONES[found.severity]))
            put(painter, room, LEFT, found.text)

    def shown(self) -> list[tuple[QTextBlock, QRectF]]:
        """Return the visible blocks with their boxes."""
        rows = []
        block = self.firstVisibleBlock()
        box = self.blockBoundingGeometry(block).translated(self.contentOffset())
        while block.isValid() and box.top() <= self.viewport().height():
            rows.append((block, QRectF(box)))
            block = block.next()
            box.translate(0, box.height())
        return rows

    def _scrolled(self, _rect: object, _by: int) -> None:
        self.margin.update()

    def _make_room(self) -> None:
        self.setViewportMargins(self.margin.wide, 0, 0, 0)
        room = self.contentsRect()
        self.margin.setGeometry(room.left(), room.top(), self.margin.wide, room.height())

    def _mark_line(self) -> None:
        mark = QTextEdit.ExtraSelection()
        mark.format.setBackground(self.look.colour("here"))
        mark.format.setProperty(QTextFormat.Property.FullWidthSelection, True)
        mark.cursor = self.textCursor()
        mark.cursor.clearSelection()
        self.setExtraSelections([mark])
        self.margin.update()


class Margin(QWidget):
    """Margin with line numbers and a colored letter for each finding."""

    def __init__(self, field: TextField) -> None:
        super().__init__(field)
        self._field = field

    @property
    def wide(self) -> int:
        """Width in pixels for the present number of digits."""
        digits = max(3, len(str(self._field.blockCount())))
        return round((3.4 + 1.35 * digits) * self._field.look.u)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the visible line numbers and findings."""
        look, u, field = self._field.look, self._field.look.u, self._field
        with Painter(self, look) as painter:
            painter.fill(QRectF(self.rect()), "ground")
            for block, box in field.shown():
                number = block.blockNumber() + 1
                here = number == field.line
                row = QRectF(0, box.y(), self.width(), box.height())
                found = field.finding_at(number)
                if found is not None:
                    patch = row.adjusted(0.2 * u, 0.1 * u, -(row.width() - 2.2 * u), -0.1 * u)
                    painter.fill(patch, TONES[found.severity])
                    painter.write(patch, tr(WORDS[found.severity])[0], 1.8, "on_state", at=CENTRE)
                room, ink = row.adjusted(2.4 * u, 0, -0.8 * u, 0), "text" if here else "soft"
                painter.write(room, str(number), 1.8, ink, at=RIGHT, bold=here)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Move the cursor to the touched line."""
        for block, box in self._field.shown():
            if box.top() <= event.position().y() < box.bottom():
                self._field.go_to(block.blockNumber() + 1)
                self._field.setFocus()


_PAGE = frozenset({Qt.Key.Key_Escape, *(Qt.Key(Qt.Key.Key_F1 + n) for n in range(12))})
_CHORDS = frozenset({Qt.Key.Key_Space, Qt.Key.Key_S, Qt.Key.Key_F, Qt.Key.Key_H, Qt.Key.Key_G, Qt.Key.Key_M})

# --- between the field and the editor ----------------------------------------------------------------------


class TypedText:
    """Link between the text field and the editor, updated at most once per frame."""

    def __init__(self, field: TextField, editor: Editor) -> None:
        self._field, self._editor = field, editor
        # revision of the field and document of the last comparison
        self._seen: tuple[int, object] = (-1, None)
        self._dirty = False
        self._taken = 0  # number of the editor's text that is in the field
        self.stale = False  # the text has changed since it was passed to the editor
        self._taking = False  # the field is being changed by this object
        self._text = ""
        field.textChanged.connect(self._changed)

    def _changed(self) -> None:
        self.stale = True
        if not self._taking:
            self._editor.clear()  # Typing clears the message and cancels a question.

    def now(self) -> str:
        """Return the present text of the field."""
        return self._field.toPlainText()

    @property
    def dirty(self) -> bool:
        """Whether the text has unsaved changes; compared again only after a change."""
        seen = (self._field.document().revision(), self._editor.document)
        if seen != self._seen:
            self._seen, self._dirty = seen, self._editor.is_dirty(self.now())
        return self._dirty

    def refresh(self) -> None:
        """Put a new text of the editor into the field, or pass typed text to the proof.

        Called once per frame.
        """
        editor, field = self._editor, self._field
        self._colour()
        if editor.text_number != self._taken:
            self._taken = editor.text_number
            self._taking = True
            field.put_text(editor.text, afresh=not editor.restored)
            self._taking = False
            field.setFocus()
            self.stale = True
        if self.stale:
            self.stale = False
            self._text = self.now()
            editor.changed(self._text)
        field.setReadOnly(editor.stage is not Stage.OPEN)

    def _colour(self) -> None:
        """Set the language of the file name. New colors do not count as changed text."""
        document = self._editor.document
        if document is not None:
            before, self._taking = self.stale, True
            self._field.highlighter.speak(dialect_of(document.name))
            self._taking, self.stale = False, before

    @property
    def mark(self) -> str:
        """State of the text relative to its file, as a word."""
        document = self._editor.document
        if document is None:
            return ""
        dirty = self._editor.is_dirty(self._text)
        if document.protected:
            return "SAMPLE, CHANGED" if dirty else "SAMPLE"
        if document.fresh:
            return "NEW"
        return "CHANGED" if dirty else ""
