"""Syntax coloring of Klartext lines. The reader of the interpreter marks the errors."""

from __future__ import annotations

import re

from core.language.klartext.klartext_line import CONTINUED, read_line
from core.language.line_reading import comment_start
from core.language.syntax_colours import PLAIN, Ink, Span

_VALUE = r"\s*[+-]?\s*(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+|Q[LR]?\s*[0-9]+)"
_PATTERNS = (
    (Ink.COMMENT, r"\*.*"),
    (Ink.CALL, r'(?:(?:CALL|GOTO)\s+)?LBL\s*(?:[0-9]+|"[^"]*")|REP\s*[0-9]+(?:/[0-9]+)?|CALL\s+PGM\s.*'),
    (Ink.CALL, r'TOOL\s+(?:CALL|DEF)(?:\s*(?:[0-9]+|"[^"]*"))?|CYCL\s+CALL(?:\s+POS)?'),
    (Ink.CODE, r"(?:BEGIN|END)\s+PGM|PLANE(?:\s+(?:AXIAL|POINTS|SPATIAL|RELATIV|RESET))?|STOP|M\s*[0-9]+"),
    (Ink.CODE, r"TRANS\s+(?:DATUM|MIRROR|ROTATION|SCALE)(?:\s+(?:AXIS|RESET))?|BLK\s+FORM\s*[0-9.]*"),
    (Ink.CODE, r"CYCL\s+DEF\s*[0-9.]*|FN\s*[0-9]+\s*:?|FUNCTION(?:\s+RESET)?\s+TCPM"),
    (Ink.CODE, r"(?:APPR|DEP)\s+P?L?[CLNT]+(?![A-Z])|(?:CTP|CC|CR|CT|CP|LP|C|L|RND|CHF)(?![A-Z0-9+\-])"),
    (Ink.RUN, rf"F\s*(?:MAX|AUTO)|F{_VALUE}|S{_VALUE}"),
    (Ink.KEY, rf"MOVE|TURN|STAY|MB\s*MAX|(?:MB|DIST){_VALUE}|(?:SYM|SEQ)\s*[+-]|(?:COORD|TABLE)\s+ROT"),
    (Ink.CODE, r"R[0LR](?![A-Z0-9])"),
    (Ink.KEY, r"DR\s*[+-](?![0-9Q])|Q[LR]?\s*[0-9]+"),
    (
        Ink.POSITION,
        rf"(?:P[123][XYZ]|SP[ABC]|D[LR]2?|I?P[RA]|I?[XYZABC]|CCA|LEN|ROT|SCL|R|L|RND|CHF){_VALUE}",
    ),
)
_WORDS = [(ink, re.compile(pattern, re.IGNORECASE)) for ink, pattern in _PATTERNS]
_HEAD = re.compile(r"\s*(/?\s*[0-9]*\s*/?)")
_TO_BLANK = re.compile(r"\S*")


BLOCK_GOES_ON, COMMENT_GOES_ON = 1, 2
"""What a line that ends with ~ hands on to the next."""


def spans(text: str, before: int = PLAIN) -> tuple[list[Span], int]:
    """Return the colored spans of a line, with an error last, and the state for the next line.

    Lines that end with ~ belong to one block, so a single line of this block is not marked as an error.
    Errors in such a block are reported when the program is checked.
    """
    goes_on = text.rstrip().endswith(CONTINUED)
    end = comment_start(text)
    if before == COMMENT_GOES_ON:
        return ([Span(0, len(text), Ink.COMMENT)] if text else []), COMMENT_GOES_ON if goes_on else PLAIN
    found = [*_words(text, end, numbered=before == PLAIN)]
    if end < len(text):
        found.append(Span(end, len(text) - end, Ink.COMMENT))
    if goes_on:
        bare = before == PLAIN and not text[:end].strip(" \t/0123456789")
        return found, COMMENT_GOES_ON if bare and end < len(text) else BLOCK_GOES_ON
    if before == PLAIN:
        found += _fault(text)
    return found, PLAIN


def _fault(text: str) -> list[Span]:
    line, found = read_line(1, text), []
    if line.error is not None:
        at = min(line.error.column, len(text)) - 1
        word = _TO_BLANK.match(text, max(at, 0))
        size = len(word.group()) if word is not None else 0
        found.append(Span(max(at, 0), max(size, 1), Ink.FAULT))
    return found


def _words(text: str, end: int, *, numbered: bool) -> list[Span]:
    found = []
    head = _HEAD.match(text, 0, end) if numbered else None
    at = head.end() if head is not None else 0
    if head is not None and head.group(1).strip():
        found.append(Span(head.start(1), len(head.group(1).rstrip()), Ink.NUMBER))
    while at < end:
        match = next(((ink, m) for ink, each in _WORDS if (m := each.match(text, at, end))), None)
        if match is not None and match[1].end() > at:
            found.append(Span(at, match[1].end() - at, match[0]))
            at = match[1].end()
        else:
            at += 1
    return found
