"""Colours of a program's words, from the same lexer that reads them to run."""

from __future__ import annotations

from PySide6.QtGui import QFont, QSyntaxHighlighter, QTextCharFormat, QTextDocument

from app.screen.look import Look
from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_colours import spans as klartext_spans
from core.language.omniturn import Line, Word, lex_line
from core.language.omniturn.plane_switching_lines import ends_program, lex_plane, plane_entry
from core.language.sinumerik.sinumerik_colours import spans as sinumerik_spans
from core.language.source import Dialect
from core.language.syntax_colours import Ink

PLAIN, IN_PLANE = 0, 1  # states that lines hand on

# What a letter is of, and the palette's colour for it; weight tells codes from coordinates without colour.
_CODES = frozenset({"G", "M"})
_RUN = frozenset({"F", "S"})
_TOOLS = frozenset({"T", "D", "P", "LS", "L", "}"})


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
    """One line at a time; all that a line hands on to the next is whether it stands in a plane."""

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
        if self._dialect is not Dialect.OMNITURN:
            self.setCurrentBlockState(PLAIN)
            self._spans(text)
            return
        inside = self.previousBlockState() == IN_PLANE and not ends_program(text)
        entry = not inside and plane_entry(text) is not None
        self.setCurrentBlockState(IN_PLANE if inside or entry else PLAIN)
        if entry:
            self.setFormat(0, len(text), self._format("accent", True))
        elif inside:
            self._plane(text)
        else:
            self._plain(text)

    def _spans(self, text: str) -> None:
        """A line of SINUMERIK or Klartext."""
        spans = klartext_spans if self._dialect is Dialect.KLARTEXT else sinumerik_spans
        for start, length, ink in spans(text):
            self.setFormat(start, length, self._format(*_OF_INK[ink]))

    def _plane(self, text: str) -> None:
        try:
            line = lex_plane(1, text)
        except ProgramError as fault:
            self.setFormat(max(0, fault.diagnostic.column - 1), 1, self._format("alarm", True))
            return
        if line.name == "END":
            self.setCurrentBlockState(PLAIN)
            self.setFormat(0, len(text), self._format("accent", True))
        for word in line.words.values():
            self.setFormat(word.column - 1, _length(text, word), self._format(*ink_of(word)))

    def _plain(self, text: str) -> None:
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
