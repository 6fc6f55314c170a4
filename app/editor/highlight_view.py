"""Colours of a program's words, from the same lexer that reads them to run."""

from __future__ import annotations

from PySide6.QtGui import QFont, QSyntaxHighlighter, QTextCharFormat, QTextDocument

from app.screen.look import Look
from core.language.program_colours import spans
from core.language.source import Dialect
from core.language.syntax_colours import PLAIN, Ink

# The palette's colour of each kind; weight tells codes from coordinates without colour.
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
    """One line at a time; what a line hands on to the next is a state of its language."""

    def __init__(self, look: Look, document: QTextDocument) -> None:
        super().__init__(document)
        self._look = look
        self._dressed = look.palette
        self._formats: dict[tuple[str, bool], QTextCharFormat] = {}
        self._dialect = Dialect.OMNITURN

    def speak(self, dialect: Dialect) -> None:
        """The language of the text; where it is another one than before all of it is gone through anew."""
        if dialect is not self._dialect:
            self._dialect = dialect
            self.rehighlight()

    def dress(self) -> None:
        """The colours that are in force now; the whole text is gone through only when they have changed."""
        if self._dressed is not self._look.palette:
            self._dressed = self._look.palette
            self._formats.clear()
            self.rehighlight()

    def highlightBlock(self, text: str) -> None:
        """Qt's call for a line that has changed, and for the next where the state it hands on has."""
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
