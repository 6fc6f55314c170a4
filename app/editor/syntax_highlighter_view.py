"""Coloring of the visible lines of a program in the editor."""

from __future__ import annotations

from itertools import groupby

from PySide6.QtGui import QFont, QTextCharFormat

from app.screen.screen_theme import ScreenTheme
from app.screen.text_area.line_view import LineColors
from app.screen.text_area.text_buffer import TextBuffer
from core.language.diagnostics import Diagnostic
from core.language.line_errors import find_line_errors
from core.language.program_colors import color_program_line, find_coloring_start
from core.language.source import Dialect
from core.language.syntax_colors import PLAIN_STATE, ColoredSpan, SyntaxKind

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


_MAX_RESULTS = 2048  # number of stored results of the coloring


class SyntaxHighlighter:
    """Syntax highlighter for the lines of a program text.

    The state that each line passes to the next line depends on the program language. Only the lines that
    are requested are read.
    """

    def __init__(self, theme: ScreenTheme, buffer: TextBuffer) -> None:
        self._theme, self._buffer = theme, buffer
        self._dressed = theme.palette
        self._formats: dict[tuple[str, bool], QTextCharFormat] = {}
        self._dialect = Dialect.OMNITURN
        self._states: dict[int, int] = {}  # state before each line that was read
        self._revision = -1  # of the buffer, to which the states belong
        self._results: dict[tuple[str, int], tuple[list[ColoredSpan], int]] = {}

    def set_dialect(self, dialect: Dialect) -> bool:
        """Set the language of the text, and return whether the language has changed."""
        if dialect is self._dialect:
            return False
        self._dialect = dialect
        self._states.clear()
        self._results.clear()
        return True

    def apply_theme(self) -> bool:
        """Apply the current colors, and return whether the colors have changed."""
        if self._dressed is self._theme.palette:
            return False
        self._dressed = self._theme.palette
        self._formats.clear()
        return True

    def find_state_before(self, line: int) -> int:
        """Return the state that the preceding lines pass to a line. Lines count from 0."""
        self._forget_changed_states()
        if line not in self._states:
            start = line - 1
            if start not in self._states:
                start = find_coloring_start(
                    self._dialect, line, self._buffer.read_line, self._buffer.find_last_line_with
                )
                self._states[start] = PLAIN_STATE
            for number, text in enumerate(self._buffer.read_lines(start, line - start), start):
                self._states[number + 1] = self._color(text, self._states[number])[1]
        return self._states[line]

    def find_line_colors(self, line: int, text: str) -> LineColors:
        """Return the colored spans of a line."""
        kinds: list[SyntaxKind | None] = [None] * len(text)
        for start, length, kind in self._color(text, self.find_state_before(line))[0]:
            end = min(len(text), start + length)
            kinds[start:end] = [kind] * max(0, end - start)  # An error covers the word that contains it.
        found, at = [], 0
        for each, run in groupby(kinds):
            length = len(list(run))
            if each is not None:
                found.append((at, length, self._format(*_TOKEN_COLORS[each])))
            at += length
        return found

    def find_line_errors(self, line: int, text: str) -> tuple[Diagnostic, ...]:
        """Return the syntax errors of a line. The line counts from 0."""
        return find_line_errors(self._dialect, line + 1, text, self.find_state_before(line))

    def _color(self, text: str, state_before: int) -> tuple[list[ColoredSpan], int]:
        key = text, state_before
        if key not in self._results:
            if len(self._results) >= _MAX_RESULTS:
                self._results.clear()
            self._results[key] = color_program_line(self._dialect, text, state_before)
        return self._results[key]

    def _forget_changed_states(self) -> None:
        """Discard the states that depend on changed lines."""
        buffer = self._buffer
        if self._revision != buffer.revision:
            is_next = self._revision == buffer.revision - 1
            first = buffer.last_change.first_line if is_next else -1
            self._states = {line: state for line, state in self._states.items() if line <= first}
            self._revision = buffer.revision

    def _format(self, colour: str, bold: bool) -> QTextCharFormat:
        key = (colour, bold)
        if key not in self._formats:
            made = QTextCharFormat()
            made.setForeground(self._theme.get_color(colour))
            if bold:
                made.setFontWeight(QFont.Weight.Bold)
            if colour == "alarm":
                made.setFontUnderline(True)
            self._formats[key] = made
        return self._formats[key]
