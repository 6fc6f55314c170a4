"""Syntax coloring of SINUMERIK lines with the lexer of the interpreter."""

from __future__ import annotations

import re

from core.language.line_reading import after_signs
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import CORNERS, KEYS
from core.language.sinumerik.subprogram_files import HEADER
from core.language.syntax_colours import Ink, Span

_WORD = re.compile(r"[A-Za-z]+")
_OF_NAME = {
    "G": Ink.CODE,
    "M": Ink.CODE,
    "F": Ink.RUN,
    "S": Ink.RUN,
    "LIMS": Ink.RUN,
    "T": Ink.CALL,
    "D": Ink.CALL,
}


def spans(text: str) -> list[Span]:
    """Return the colored spans of a line, with errors last."""
    if HEADER.fullmatch(text):
        return [Span(0, len(text), Ink.CALL)]
    line = lex_line(1, text)
    code = text[: line.comment_column - 1] if line.comment_column else text
    found = []
    if not line.block.startswith("in line"):
        at = code.upper().find(line.block)
        found.append(Span(at, len(line.block), Ink.NUMBER))
    for word in line.words:
        ink = Ink.KEY if word.name in KEYS | CORNERS else _OF_NAME.get(word.name, Ink.POSITION)
        at = word.column - 1
        found.append(Span(at, after_signs(code, at, len(word.text)) - at, ink))
    if line.jump is not None:
        size = _WORD.match(code, line.jump.column - 1)
        found.append(Span(line.jump.column - 1, len(size.group()) if size else 1, Ink.CALL))
    if line.call:
        found.append(Span(line.call_column - 1, len(line.call), Ink.CALL))
    if line.comment_column:
        found.append(Span(line.comment_column - 1, len(text) - line.comment_column + 1, Ink.COMMENT))
    faults = (error.column for error in line.errors if error.column)
    return found + [Span(min(column, len(text)) - 1, 1, Ink.FAULT) for column in faults if text]
