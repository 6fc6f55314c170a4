"""Syntax coloring of OmniTurn lines with the lexer of the interpreter, including plane switching."""

from __future__ import annotations

from core.language.diagnostics import ProgramError
from core.language.line_reading import after_signs
from core.language.omniturn.omniturn_lexer import lex_line
from core.language.omniturn.omniturn_words import Line, Word
from core.language.omniturn.plane_switching_lines import ends_program, lex_plane, plane_entry
from core.language.syntax_colours import PLAIN, Ink, Span

IN_PLANE = 1
"""The state that a line within a switched plane hands on."""

_OF_LETTER = {
    **dict.fromkeys(("G", "M"), Ink.CODE),
    **dict.fromkeys(("F", "S"), Ink.RUN),
    **dict.fromkeys(("T", "D", "P", "LS", "L", "}"), Ink.CALL),
}


def spans(text: str, before: int) -> tuple[list[Span], int]:
    """Return the colored spans of a line, with errors last, and the state for the next line.

    ``before`` is the state that the previous line returned.
    """
    inside = before == IN_PLANE and not ends_program(text)
    if not inside and plane_entry(text) is not None:
        return [Span(0, len(text), Ink.CODE)], IN_PLANE
    return _in_plane(text) if inside else (_plain(text), PLAIN)


def _in_plane(text: str) -> tuple[list[Span], int]:
    try:
        line = lex_plane(1, text)
    except ProgramError as fault:
        return [Span(max(0, fault.diagnostic.column - 1), 1, Ink.FAULT)], IN_PLANE
    words = [_span(text, word) for word in line.words.values()]
    if line.name == "END":
        return [Span(0, len(text), Ink.CODE), *words], PLAIN
    return words, IN_PLANE


def _plain(text: str) -> list[Span]:
    line = lex_line(1, text)
    faults = [Span(error.column - 1, 1, Ink.FAULT) for error in line.errors if error.column]
    return [*(_span(text, word) for word in line.words), *_comments(text, line), *faults]


def _comments(text: str, line: Line) -> list[Span]:
    found = []
    at = line.comment_column - 1
    while 0 <= at < len(text):
        end = text.find(")", at)
        end = len(text) if end < 0 else end + 1
        found.append(Span(at, end - at, Ink.COMMENT))
        at = text.find("(", end)
    return found


def _span(text: str, word: Word) -> Span:
    """Return the span of a word in the line as written, including its blanks."""
    at = word.column - 1
    end = after_signs(text, at, len(word.text))
    return Span(at, end - at, _OF_LETTER.get(word.letter, Ink.POSITION))
