"""Colours of a program's words, from the same lexer that reads them to run."""

from __future__ import annotations

from PySide6.QtGui import QFont, QSyntaxHighlighter, QTextCharFormat, QTextDocument

from app.screen.look import Look
from core.language.omniturn import Line, Word, lex_line

# What a letter is of, and the palette's colour for it; weight tells codes from coordinates without colour.
_CODES = frozenset({"G", "M"})
_RUN = frozenset({"F", "S"})
_TOOLS = frozenset({"T", "D", "P", "LS", "L", "}"})


def ink_of(word: Word) -> tuple[str, bool]:
    """Colour and weight of a word."""
    if word.letter in _CODES:
        return "accent", True
    if word.letter in _RUN:
        return "run", False
    if word.letter in _TOOLS:
        return "pause", True
    return "text", False


class Highlighter(QSyntaxHighlighter):
    """One line at a time: no line of this language depends on another one."""

    def __init__(self, look: Look, document: QTextDocument) -> None:
        super().__init__(document)
        self._look = look
        self._dressed = look.palette
        self._formats: dict[tuple[str, bool], QTextCharFormat] = {}

    def dress(self) -> None:
        """The colours that are in force now; the whole text is gone through only when they have changed."""
        if self._dressed is not self._look.palette:
            self._dressed = self._look.palette
            self._formats.clear()
            self.rehighlight()

    def highlightBlock(self, text: str) -> None:
        """Qt's call for a line that has changed."""
        line = lex_line(1, text)
        for word in line.words:
            self.setFormat(word.column - 1, _length(text, word), self._format(*ink_of(word)))
        self._comments(text, line)
        for error in line.errors:
            if error.column:
                self.setFormat(error.column - 1, 1, self._format("alarm", True))

    def _comments(self, text: str, line: Line) -> None:
        at = line.comment_column - 1
        while 0 <= at < len(text):
            end = text.find(")", at)
            end = len(text) if end < 0 else end + 1
            self.setFormat(at, end - at, self._format("soft", False))
            at = text.find("(", end)

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


def _length(text: str, word: Word) -> int:
    """How far a word reaches in the line as written, blanks inside it counted."""
    at, left = word.column - 1, len(word.text)
    while left and at < len(text):
        left -= not text[at].isspace()
        at += 1
    return at - word.column + 1
