"""One line of Klartext: number, skip sign, block and comment."""

from __future__ import annotations

import re
from collections.abc import Callable

from core.language.diagnostics import ProgramError
from core.language.klartext import faults, headers, moves, others, planes
from core.language.klartext.cursor import Cursor
from core.language.klartext.nodes import Heading, KlartextLine, Node, Stop
from core.language.klartext.plain import read_plain

LONGEST_LINE = 8192
_HEAD = re.compile(r"\s*(/?)\s*([0-9]+)?\s*(/?)\s*")
_L = re.compile(r"L(?![A-Z0-9])")
_M = re.compile(r"M(?=\s*[0-9])")
_Q = re.compile(r"Q(?=\s*[0-9])")
_FN = re.compile(r"FN\s*([0-9]+)\s*:?")
_FN_0 = re.compile(r"FN\s*0\s*:\s*Q(?=\s*[0-9])")

# Blocks of the control that are outside the subset: the longest name first where one begins another.
_OUTSIDE = (
    *("CYCL CALL", "CALL PGM", "CALL SELECTED", "SEL PGM", "SEL TABLE", "SEL PATTERN", "SEL CONTOUR"),
    *("CONTOUR DEF", "PATTERN DEF", "TOOL DEF", "TCH PROBE", "FUNCTION", "POLARKIN", "DECLARE", "STRING"),
    *("TRANS MIRROR", "TRANS ROTATION", "TRANS SCALE", "APPR", "DEP", "CHF", "RND", "CTP", "CP", "CR", "CT"),
    *("CC", "LP", "LN", "LT", "FPOL", "FSELECT", "FLT", "FCT", "FL", "FC", "C", "SPL", "QL", "QR", "QS"),
    *("WHILE", "IF", "STRAIGHT"),
)
_OUTSIDE_PATTERNS = tuple((name, re.compile(r"\s+".join(name.split()) + r"(?![A-Z])")) for name in _OUTSIDE)


def read_line(number: int, text: str) -> KlartextLine:
    """What line ``number`` says. Never raises: an error is in the line."""
    if (plain := read_plain(number, text)) is not None:
        return plain
    if len(text) > LONGEST_LINE:
        problem = faults.syntax(number, 1, f"The line has {len(text)} characters.", "Break it into lines.")
        return KlartextLine(number, error=problem.diagnostic)
    code, comment = _without_comment(text)
    head = _HEAD.match(code)
    assert head is not None  # every part of it may be missing
    block, skip = head.group(2), bool(head.group(1) or head.group(3))
    number_of_block = int(block) if block is not None and len(block) <= 9 else None
    try:
        node = _node(Cursor(number, code.rstrip(), head.end()))
    except ProgramError as problem:
        return KlartextLine(number, None, number_of_block, skip, comment, problem.diagnostic)
    return KlartextLine(number, node, number_of_block, skip, comment)


def _without_comment(text: str) -> tuple[str, str | None]:
    """Code and comment; a semicolon in a quoted name begins none."""
    if ";" not in text:
        return text, None
    quoted = False
    for at, sign in enumerate(text):
        if sign == '"':
            quoted = not quoted
        elif sign == ";" and not quoted:
            return text[:at], text[at + 1 :].strip()
    return text, None


def _node(cursor: Cursor) -> Node | None:
    if cursor.done:
        return None
    if cursor.text[-1] != "~" and cursor.take(_L):
        return moves.move(cursor)
    if cursor.text[cursor.at] == "*":
        return Heading(cursor.rest()[1:].strip().removeprefix("-").strip())
    if cursor.text[-1] == "~":
        raise faults.unsupported(cursor.line, len(cursor.text), "A block over several lines (~)")
    return _by_keyword(cursor) or _by_letter(cursor)


def _by_keyword(cursor: Cursor) -> Node | None:
    column = cursor.column
    for words, read in _KEYWORDS.items():
        if cursor.keyword(words):
            return read(cursor, column)
    return None


def _stop(cursor: Cursor, _column: int) -> Node:
    if not cursor.done:
        raise cursor.expected("STOP stands alone")
    return Stop()


_KEYWORDS: dict[str, Callable[[Cursor, int], Node]] = {
    "BEGIN PGM": lambda cursor, _: headers.begin(cursor),
    "END PGM": lambda cursor, _: headers.end(cursor),
    "BLK FORM": lambda cursor, _: headers.blank_form(cursor),
    "TOOL CALL": lambda cursor, _: headers.tool_call(cursor),
    "PLANE": planes.plane,
    "TRANS DATUM": others.datum,
    "CYCL DEF": others.cycle,
    "CALL LBL": lambda cursor, _: others.call(cursor),
    "LBL": lambda cursor, _: others.label(cursor),
    "STOP": _stop,
}


def _by_letter(cursor: Cursor) -> Node:
    if _M.match(cursor.upper, cursor.at):
        return moves.codes_alone(cursor)
    if cursor.take(_FN_0):
        return others.assign(cursor, spelled=True)
    if cursor.take(_Q):
        return others.assign(cursor, spelled=False)
    raise _no_block(cursor)


def _no_block(cursor: Cursor) -> ProgramError:
    """What begins no block of the subset, by its name where the control knows it."""
    column = cursor.column
    if function := _FN.match(cursor.upper, cursor.at):
        return faults.unsupported(cursor.line, column, f"FN {int(function.group(1)[:4])}")
    for name, pattern in _OUTSIDE_PATTERNS:
        if pattern.match(cursor.upper, cursor.at):
            return faults.unsupported(cursor.line, column, name)
    text = f"'{cursor.next_word}' begins no block."
    hint = cursor.advice("A block begins with L, PLANE, TOOL CALL, LBL or the like.")
    return faults.syntax(cursor.line, column, text, hint)
