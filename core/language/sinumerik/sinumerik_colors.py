"""Syntax coloring of SINUMERIK lines with the lexer of the interpreter."""

from __future__ import annotations

import re

from core.language.line_reading import skip_characters
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import CORNER_WORDS, NAMED_FUNCTIONS
from core.language.sinumerik.subprogram_files import HEADER_PATTERN
from core.language.syntax_colors import ColoredSpan, SyntaxKind

_WORD = re.compile(r"[A-Za-z]+")
_KIND_BY_NAME = {
    "G": SyntaxKind.CODE,
    "M": SyntaxKind.CODE,
    "F": SyntaxKind.FEED_AND_SPEED,
    "S": SyntaxKind.FEED_AND_SPEED,
    "LIMS": SyntaxKind.FEED_AND_SPEED,
    "T": SyntaxKind.CALL,
    "D": SyntaxKind.CALL,
}


def color_line(text: str) -> list[ColoredSpan]:
    """Return the colored spans of a line, with errors last."""
    if HEADER_PATTERN.fullmatch(text):
        return [ColoredSpan(0, len(text), SyntaxKind.CALL)]
    line = lex_line(1, text)
    code = text[: line.comment_column - 1] if line.comment_column else text
    found = []
    if not line.block_name.startswith("in line"):
        at = code.upper().find(line.block_name)
        found.append(ColoredSpan(at, len(line.block_name), SyntaxKind.NUMBER))
    for word in line.words:
        ink = (
            SyntaxKind.KEYWORD
            if word.name in NAMED_FUNCTIONS | CORNER_WORDS
            else _KIND_BY_NAME.get(word.name, SyntaxKind.POSITION)
        )
        at = word.column - 1
        found.append(ColoredSpan(at, skip_characters(code, at, len(word.text)) - at, ink))
    if line.control_statement is not None:
        size = _WORD.match(code, line.control_statement.column - 1)
        found.append(
            ColoredSpan(line.control_statement.column - 1, len(size.group()) if size else 1, SyntaxKind.CALL)
        )
    if line.called_name:
        found.append(ColoredSpan(line.call_column - 1, len(line.called_name), SyntaxKind.CALL))
    if line.comment_column:
        found.append(
            ColoredSpan(line.comment_column - 1, len(text) - line.comment_column + 1, SyntaxKind.COMMENT)
        )
    faults = (error.column for error in line.errors if error.column)
    return found + [ColoredSpan(min(column, len(text)) - 1, 1, SyntaxKind.ERROR) for column in faults if text]
