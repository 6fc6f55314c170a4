"""Syntax coloring of OmniTurn lines with the lexer of the interpreter.

Lines of a coordinate transformation (plane switching) are also colored.
"""

from __future__ import annotations

from core.language.diagnostics import ProgramError
from core.language.line_reading import skip_characters
from core.language.omniturn.omniturn_lexer import lex_line
from core.language.omniturn.omniturn_words import LexedLine, Word
from core.language.omniturn.plane_switching_lines import (
    is_program_end,
    lex_plane_switching_line,
    parse_plane_switching_start,
)
from core.language.syntax_colors import PLAIN_STATE, ColoredSpan, SyntaxKind

PLANE_STATE = 1
"""State that a line within a switched plane passes to the next line."""

_KIND_BY_LETTER = {
    **dict.fromkeys(("G", "M"), SyntaxKind.CODE),
    **dict.fromkeys(("F", "S"), SyntaxKind.FEED_AND_SPEED),
    **dict.fromkeys(("T", "D", "P", "LS", "L", "}"), SyntaxKind.CALL),
}


def color_line(text: str, state_before: int) -> tuple[list[ColoredSpan], int]:
    """Return the colored spans of a line, with errors last, and the state for the next line.

    ``state_before`` is the state that was returned for the previous line.
    """
    inside = state_before == PLANE_STATE and not is_program_end(text)
    if not inside and parse_plane_switching_start(text) is not None:
        return [ColoredSpan(0, len(text), SyntaxKind.CODE)], PLANE_STATE
    return _in_plane(text) if inside else (_plain(text), PLAIN_STATE)


def _in_plane(text: str) -> tuple[list[ColoredSpan], int]:
    try:
        line = lex_plane_switching_line(1, text)
    except ProgramError as fault:
        return [ColoredSpan(max(0, fault.diagnostic.column - 1), 1, SyntaxKind.ERROR)], PLANE_STATE
    words = [_span(text, word) for word in line.words.values()]
    if line.name == "END":
        return [ColoredSpan(0, len(text), SyntaxKind.CODE), *words], PLAIN_STATE
    return words, PLANE_STATE


def _plain(text: str) -> list[ColoredSpan]:
    line = lex_line(1, text)
    faults = [ColoredSpan(error.column - 1, 1, SyntaxKind.ERROR) for error in line.errors if error.column]
    return [*(_span(text, word) for word in line.words), *_comments(text, line), *faults]


def _comments(text: str, line: LexedLine) -> list[ColoredSpan]:
    found = []
    at = line.comment_column - 1
    while 0 <= at < len(text):
        end = text.find(")", at)
        end = len(text) if end < 0 else end + 1
        found.append(ColoredSpan(at, end - at, SyntaxKind.COMMENT))
        at = text.find("(", end)
    return found


def _span(text: str, word: Word) -> ColoredSpan:
    """Return the span of a word in the line as written, including its blanks."""
    at = word.column - 1
    end = skip_characters(text, at, len(word.text))
    return ColoredSpan(at, end - at, _KIND_BY_LETTER.get(word.letter, SyntaxKind.POSITION))
