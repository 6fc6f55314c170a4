"""Syntax coloring of Klartext lines. Errors come from the parser that the interpreter also uses."""

from __future__ import annotations

import re

from core.language.klartext.klartext_line import CONTINUATION_SIGN, parse_line
from core.language.line_reading import find_comment_start
from core.language.syntax_colors import PLAIN_STATE, ColoredSpan, SyntaxKind

_VALUE = r"\s*[+-]?\s*(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+|Q[LR]?\s*[0-9]+)"
_PATTERNS = (
    (SyntaxKind.COMMENT, r"\*.*"),
    (
        SyntaxKind.CALL,
        r'(?:(?:CALL|GOTO)\s+)?LBL\s*(?:[0-9]+|"[^"]*")|REP\s*[0-9]+(?:/[0-9]+)?|CALL\s+PGM\s.*',
    ),
    (SyntaxKind.CALL, r'TOOL\s+(?:CALL|DEF)(?:\s*(?:[0-9]+|"[^"]*"))?|CYCL\s+CALL(?:\s+POS)?'),
    (
        SyntaxKind.CODE,
        r"(?:BEGIN|END)\s+PGM|PLANE(?:\s+(?:AXIAL|POINTS|SPATIAL|RELATIV|RESET))?|STOP|M\s*[0-9]+",
    ),
    (SyntaxKind.CODE, r"TRANS\s+(?:DATUM|MIRROR|ROTATION|SCALE)(?:\s+(?:AXIS|RESET))?|BLK\s+FORM\s*[0-9.]*"),
    (SyntaxKind.CODE, r"CYCL\s+DEF\s*[0-9.]*|FN\s*[0-9]+\s*:?|FUNCTION(?:\s+RESET)?\s+TCPM"),
    (
        SyntaxKind.CODE,
        r"(?:APPR|DEP)\s+P?L?[CLNT]+(?![A-Z])|(?:CTP|CC|CR|CT|CP|LP|C|L|RND|CHF)(?![A-Z0-9+\-])",
    ),
    (SyntaxKind.FEED_AND_SPEED, rf"F\s*(?:MAX|AUTO)|F{_VALUE}|S{_VALUE}"),
    (
        SyntaxKind.KEYWORD,
        rf"MOVE|TURN|STAY|MB\s*MAX|(?:MB|DIST){_VALUE}|(?:SYM|SEQ)\s*[+-]|(?:COORD|TABLE)\s+ROT",
    ),
    (SyntaxKind.CODE, r"R[0LR](?![A-Z0-9])"),
    (SyntaxKind.KEYWORD, r"DR\s*[+-](?![0-9Q])|Q[LR]?\s*[0-9]+"),
    (
        SyntaxKind.POSITION,
        rf"(?:P[123][XYZ]|SP[ABC]|D[LR]2?|I?P[RA]|I?[XYZABC]|CCA|LEN|ROT|SCL|R|L|RND|CHF){_VALUE}",
    ),
)
_WORDS = [(ink, re.compile(pattern, re.IGNORECASE)) for ink, pattern in _PATTERNS]
_HEAD = re.compile(r"\s*(/?\s*[0-9]*\s*/?)")
_TO_BLANK = re.compile(r"\S*")


BLOCK_GOES_ON, COMMENT_GOES_ON = 1, 2
"""States that a line ending with ~ passes to the next line, for a block or a comment that continues."""


def color_line(text: str, state_before: int = PLAIN_STATE) -> tuple[list[ColoredSpan], int]:
    """Return the colored spans of a line, with any error last, and the state for the next line.

    A block can continue over several lines that end with ~. Because a line of such a block cannot be parsed
    alone, its errors are not marked here. They are reported when the program is checked.
    """
    goes_on = text.rstrip().endswith(CONTINUATION_SIGN)
    end = find_comment_start(text)
    if state_before == COMMENT_GOES_ON:
        return (
            [ColoredSpan(0, len(text), SyntaxKind.COMMENT)] if text else []
        ), COMMENT_GOES_ON if goes_on else PLAIN_STATE
    found = [*_words(text, end, numbered=state_before == PLAIN_STATE)]
    if end < len(text):
        found.append(ColoredSpan(end, len(text) - end, SyntaxKind.COMMENT))
    if goes_on:
        bare = state_before == PLAIN_STATE and not text[:end].strip(" \t/0123456789")
        return found, COMMENT_GOES_ON if bare and end < len(text) else BLOCK_GOES_ON
    if state_before == PLAIN_STATE:
        found += _fault(text)
    return found, PLAIN_STATE


def _fault(text: str) -> list[ColoredSpan]:
    line, found = parse_line(1, text), []
    if line.error is not None:
        at = min(line.error.column, len(text)) - 1
        word = _TO_BLANK.match(text, max(at, 0))
        size = len(word.group()) if word is not None else 0
        found.append(ColoredSpan(max(at, 0), max(size, 1), SyntaxKind.ERROR))
    return found


def _words(text: str, end: int, *, numbered: bool) -> list[ColoredSpan]:
    found = []
    head = _HEAD.match(text, 0, end) if numbered else None
    at = head.end() if head is not None else 0
    if head is not None and head.group(1).strip():
        found.append(ColoredSpan(head.start(1), len(head.group(1).rstrip()), SyntaxKind.NUMBER))
    while at < end:
        match = next(((ink, m) for ink, each in _WORDS if (m := each.match(text, at, end))), None)
        if match is not None and match[1].end() > at:
            found.append(ColoredSpan(at, match[1].end() - at, match[0]))
            at = match[1].end()
        else:
            at += 1
    return found
