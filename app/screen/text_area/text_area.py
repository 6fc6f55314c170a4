"""Text area for editing texts of any length with keyboard, mouse and touch."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Mapping

from PySide6.QtCore import QEvent, Qt, QTimer
from PySide6.QtGui import (
    QFocusEvent,
    QGuiApplication,
    QInputMethodEvent,
    QKeyEvent,
    QKeySequence,
)
from PySide6.QtWidgets import QApplication, QWidget

from app.screen.text_area.line_view import LineView
from app.screen.text_area.pointer_input import PointerInput
from app.screen.text_area.text_buffer import TextSelection

Keys = QKeySequence.StandardKey
# An arrow key without Shift moves the cursor to this end of a selection.
_ARROW_ENDS: Mapping[QKeySequence.StandardKey, Callable[[TextSelection], int]] = {
    Keys.MoveToNextChar: lambda selection: selection.end,
    Keys.MoveToPreviousChar: lambda selection: selection.start,
}
_WORD = re.compile(r"\w+|[^\w\s]+")
_LINE_BREAKS = re.compile("\r\n|\r|\u2028|\u2029")


class TextArea(PointerInput, LineView):
    """Text area for editing a text.

    The keys have the same meaning as in the text fields of Qt.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._is_read_only = False
        self._wanted_x: float | None = None  # horizontal position of the cursor for vertical moves
        self._blink = QTimer(self)
        self._blink.timeout.connect(self._toggle_cursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_InputMethodEnabled)
        self.viewport().setCursor(Qt.CursorShape.IBeamCursor)
        self._moves = self._make_moves()
        self._commands: dict[QKeySequence.StandardKey, Callable[[], None]] = {
            Keys.SelectAll: self.selectAll,
            Keys.Copy: self.copy,
            Keys.Cut: self.cut,
            Keys.Paste: self.paste,
            Keys.Undo: self.undo,
            Keys.Redo: self.redo,
            Keys.Delete: lambda: self._delete_to(self.selection.position + 1),
            Keys.DeleteEndOfWord: lambda: self._delete_to(self._find_word_end()),
            Keys.DeleteStartOfWord: lambda: self._delete_to(self._find_word_start()),
            Keys.DeleteEndOfLine: lambda: self._delete_to(self._find_line_end()),
            Keys.InsertParagraphSeparator: lambda: self.insert_at_cursor("\n"),
            Keys.InsertLineSeparator: lambda: self.insert_at_cursor("\n"),
        }

    # --- text and cursor -----------------------------------------------------------------------------

    def isReadOnly(self) -> bool:
        """Return whether the operator cannot change the text."""
        return self._is_read_only

    def setReadOnly(self, is_read_only: bool) -> None:
        """Set whether the operator can change the text."""
        if is_read_only != self._is_read_only:
            self._is_read_only = is_read_only
            self.setAttribute(Qt.WidgetAttribute.WA_InputMethodEnabled, not is_read_only)
            self._update_blinking()

    def setPlainText(self, text: str) -> None:
        """Replace the whole text, clear the undo history and move the cursor to the start."""
        self.buffer.set_text(text)
        self.forget_layouts()
        self._after_edit(TextSelection())

    def select(self, anchor: int, position: int) -> None:
        """Select the text between two positions, and move the cursor to ``position``."""
        self._wanted_x = None
        self._set_selection(anchor, position)

    def selectAll(self) -> None:
        """Select the whole text."""
        self.select(0, self.buffer.length)

    def replace_range(self, start: int, end: int, text: str, *, is_typing: bool = False) -> None:
        """Replace the text between two positions as one step of the undo history."""
        self._after_edit(self.buffer.replace_range(start, end, text, self.selection, is_typing=is_typing))

    def insert_at_cursor(self, text: str) -> None:
        """Insert a text in place of the selection."""
        if not self._is_read_only:
            typed = len(text) == 1 and text != "\n" and not self.has_selection
            self.replace_range(self.selection.start, self.selection.end, text, is_typing=typed)

    def undo(self) -> None:
        """Reverse the last step."""
        self._follow_history(None if self._is_read_only else self.buffer.undo())

    def redo(self) -> None:
        """Repeat the last reversed step."""
        self._follow_history(None if self._is_read_only else self.buffer.redo())

    def copy(self) -> None:
        """Copy the selected text to the clipboard."""
        if self.has_selection:
            QGuiApplication.clipboard().setText(self.selected_text)

    def cut(self) -> None:
        """Move the selected text to the clipboard."""
        if self.has_selection and not self._is_read_only:
            self.copy()
            self.insert_at_cursor("")

    def paste(self) -> None:
        """Insert the text of the clipboard in place of the selection."""
        text = QGuiApplication.clipboard().text()
        if text:
            self.insert_at_cursor(_LINE_BREAKS.sub("\n", text))

    def _follow_history(self, selection: TextSelection | None) -> None:
        if selection is not None:
            self._after_edit(selection)

    def _after_edit(self, selection: TextSelection) -> None:
        self._wanted_x = None
        self.selection = selection
        self.scroll_to_cursor()
        self.viewport().update()
        self.text_changed.emit()
        self.cursor_moved.emit()

    def _set_selection(self, anchor: int, position: int) -> None:
        limit = self.buffer.length
        anchor, position = max(0, min(limit, anchor)), max(0, min(limit, position))
        self.buffer.end_typing()
        self.selection = TextSelection(anchor, position)
        self.scroll_to_cursor()
        self._update_blinking()
        self.viewport().update()
        self.cursor_moved.emit()

    def _delete_to(self, position: int) -> None:
        """Delete the selection, or else the text between the cursor and a position."""
        if self._is_read_only:
            return
        start, end = sorted((self.selection.position, max(0, min(self.buffer.length, position))))
        if self.has_selection:
            self.insert_at_cursor("")
        elif start < end:
            typed = end - start == 1 and self.buffer.read_range(start, end) != "\n"
            self.replace_range(start, end, "", is_typing=typed)

    # --- moves of the cursor ---------------------------------------------------------------------------

    def _make_moves(self) -> dict[QKeySequence.StandardKey, tuple[Callable[[], int], bool]]:
        """Return the target function of each move of the cursor, and whether the move selects text."""
        return {
            key: (find, is_selecting)
            for move, select, find in (
                (Keys.MoveToNextChar, Keys.SelectNextChar, lambda: self.selection.position + 1),
                (Keys.MoveToPreviousChar, Keys.SelectPreviousChar, lambda: self.selection.position - 1),
                (Keys.MoveToNextWord, Keys.SelectNextWord, self._find_word_end),
                (Keys.MoveToPreviousWord, Keys.SelectPreviousWord, self._find_word_start),
                (Keys.MoveToStartOfLine, Keys.SelectStartOfLine, self._find_line_start),
                (Keys.MoveToStartOfBlock, Keys.SelectStartOfBlock, self._find_line_start),
                (Keys.MoveToEndOfLine, Keys.SelectEndOfLine, self._find_line_end),
                (Keys.MoveToEndOfBlock, Keys.SelectEndOfBlock, self._find_line_end),
                (Keys.MoveToStartOfDocument, Keys.SelectStartOfDocument, lambda: 0),
                (Keys.MoveToEndOfDocument, Keys.SelectEndOfDocument, lambda: self.buffer.length),
            )
            for key, is_selecting in ((move, False), (select, True))
        }

    def _make_vertical_moves(self) -> dict[QKeySequence.StandardKey, tuple[int, bool]]:
        """Return the number of lines of each vertical move, and whether the move selects text."""
        page = max(1, self.row_count - 1)
        return {
            Keys.MoveToNextLine: (1, False),
            Keys.SelectNextLine: (1, True),
            Keys.MoveToPreviousLine: (-1, False),
            Keys.SelectPreviousLine: (-1, True),
            Keys.MoveToNextPage: (page, False),
            Keys.SelectNextPage: (page, True),
            Keys.MoveToPreviousPage: (-page, False),
            Keys.SelectPreviousPage: (-page, True),
        }

    def _find_line_start(self) -> int:
        return self.selection.position - self.buffer.find_column(self.selection.position)

    def _find_line_end(self) -> int:
        return self._find_line_start() + len(self.cursor_line_text)

    def _find_word_end(self) -> int:
        """Return the start of the next word of the line, the end of the line, or the next line."""
        at, start, end = self.selection.position, self._find_line_start(), self._find_line_end()
        if at >= end:
            return at + 1
        starts = (start + word.start() for word in _WORD.finditer(self.cursor_line_text))
        return next((each for each in starts if each > at), end)

    def _find_word_start(self) -> int:
        """Return the start of the word before the cursor, or the end of the previous line."""
        at, start = self.selection.position, self._find_line_start()
        if at <= start:
            return at - 1
        starts = [start + word.start() for word in _WORD.finditer(self.cursor_line_text)]
        return max((each for each in starts if each < at), default=start)

    def _move_lines(self, count: int, is_selecting: bool) -> None:
        """Move the cursor up or down, and retain its horizontal position."""
        line = self.buffer.find_line(self.selection.position)
        if self._wanted_x is None:
            self._wanted_x = self.find_column_x(line, self.buffer.find_column(self.selection.position))
        target = max(0, min(self.buffer.line_count - 1, line + count))
        if abs(count) > 1:  # A page key also scrolls, so that the cursor remains in the same row.
            bar = self.verticalScrollBar()
            bar.setValue(bar.value() + count)
        if target != line:
            position = self.find_position_in_line(target, self._wanted_x)
        elif is_selecting:  # The first or last line is selected up to its end.
            position = self._find_line_start() if count < 0 else self._find_line_end()
        else:
            return
        self._set_selection(self.selection.anchor if is_selecting else position, position)

    # --- Qt's calls ----------------------------------------------------------------------------------

    def event(self, event: QEvent) -> bool:
        """Claim the editing keys before they act as shortcuts of the window."""
        if event.type() is QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            known = (*self._commands, *self._moves, *self._make_vertical_moves())
            is_erasing = event.key() == Qt.Key.Key_Backspace
            if is_erasing or is_text_key(event) or any(event.matches(key) for key in known):
                event.accept()
                return True
        return bool(super().event(event))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move the cursor or change the text."""
        if not (self._move_by_key(event) or self._edit_by_key(event)):
            event.ignore()
            return
        event.accept()
        self._update_blinking()

    def _move_by_key(self, event: QKeyEvent) -> bool:
        for key, (count, is_selecting) in self._make_vertical_moves().items():
            if event.matches(key):
                self._move_lines(count, is_selecting)
                return True
        for key, (find, is_selecting) in self._moves.items():
            if event.matches(key):
                has_selection = self.selection.start != self.selection.end
                position = (
                    _ARROW_ENDS[key](self.selection) if has_selection and key in _ARROW_ENDS else find()
                )
                self.select(self.selection.anchor if is_selecting else position, position)
                return True
        return False

    def _edit_by_key(self, event: QKeyEvent) -> bool:
        for key, act in self._commands.items():
            if event.matches(key):
                act()
                return True
        if event.key() == Qt.Key.Key_Backspace:
            self._delete_to(self.selection.position - 1)
        elif is_text_key(event) and not self._is_read_only:
            self.insert_at_cursor(event.text())
        else:
            return False
        return True

    def inputMethodEvent(self, event: QInputMethodEvent) -> None:
        """Insert a character that was composed from several keys, such as an accented letter."""
        if event.commitString():
            self.insert_at_cursor(event.commitString())
        event.accept()

    def inputMethodQuery(self, query: Qt.InputMethodQuery) -> object:
        """Return the state of the text area to the input method."""
        if query is Qt.InputMethodQuery.ImEnabled:
            return not self._is_read_only
        if query is Qt.InputMethodQuery.ImCursorRectangle:
            return self.find_cursor_rect().translated(self.viewport().geometry().topLeft())
        return QWidget.inputMethodQuery(self, query)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Show the cursor."""
        super().focusInEvent(event)
        self._update_blinking()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Hide the cursor."""
        super().focusOutEvent(event)
        self._update_blinking()

    def _update_blinking(self) -> None:
        """Show the cursor while the text area has the focus, and restart its blinking."""
        self.is_cursor_shown = self.hasFocus() and not self._is_read_only
        interval = QApplication.cursorFlashTime() // 2
        if self.is_cursor_shown and interval > 0:
            self._blink.start(interval)
        else:
            self._blink.stop()
        self.viewport().update()

    def _toggle_cursor(self) -> None:
        self.is_cursor_shown = not self.is_cursor_shown
        self.viewport().update(self.find_cursor_rect().toAlignedRect())


def is_text_key(event: QKeyEvent) -> bool:
    """Return whether a key event inserts its text."""
    text, modifiers = event.text(), event.modifiers()
    control, shift = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
    if not text or modifiers in {control, control | shift}:
        return False
    return text == "\t" or text[0].isprintable() or unicodedata.category(text[0]) in {"Cf", "Co"}
