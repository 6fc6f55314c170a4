"""L moves and M functions."""

from __future__ import annotations

import re

from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import syntax, unsupported
from core.language.klartext.klartext_nodes import AxisWord, Codes, Feed, MCode, Move
from core.language.klartext.line_cursor import Cursor, axis_words, doubled, feed, retract

MOST_CODES = 4
_COMPENSATION = re.compile(r"R([0LR])(?![A-Z0-9])")
_M = re.compile(r"M(?=\s*[0-9])")
_AXIS_ALONE = re.compile(r"I?[XYZABC](?=\s*$)")


def move(cursor: Cursor) -> Move:
    """Behind ``L``: axes, R0, feed and M functions."""
    axes: tuple[AxisWord, ...] = ()
    compensated, speed = False, None
    codes: list[MCode] = []
    while not cursor.done:
        column = cursor.column
        words = axis_words(cursor, "XYZABC")
        if words:
            axes = _joined(cursor, axes, words)
        elif radius := cursor.take(_COMPENSATION):
            if radius.group(1) != "0":
                raise unsupported(cursor.line, column, f"Radius compensation R{radius.group(1)}")
            if compensated:
                raise doubled(cursor, column, "R0")
            compensated = True
        elif found := feed(cursor):
            if speed is not None:
                raise doubled(cursor, column, "F")
            speed = found
        elif code := m_code(cursor):
            codes.append(code)
            _demand_few(cursor, codes)
        else:
            raise _strange(cursor)
    return Move(axes, compensated, speed, tuple(codes))


def codes_alone(cursor: Cursor) -> Codes:
    """A block of M functions."""
    codes: list[MCode] = []
    while not cursor.done:
        code = m_code(cursor)
        if code is None:
            raise cursor.expected("An M function was expected")
        codes.append(code)
        _demand_few(cursor, codes)
    return Codes(tuple(codes))


def m_code(cursor: Cursor) -> MCode | None:
    """One M function where it stands here."""
    column = cursor.column
    if cursor.take(_M) is None:
        return None
    number = cursor.whole("M", 999)
    if number == 128:
        return MCode(number, column, feed=_plain_feed(cursor))
    if number == 140:
        way = retract(cursor)
        if way is None:
            raise cursor.expected("M140 needs MB", "Write MB and a length, or MB MAX.")
        return MCode(number, column, way, feed(cursor))
    return MCode(number, column)


def _plain_feed(cursor: Cursor) -> Feed | None:
    found = feed(cursor)
    if found is not None and found.kind != "value":
        raise syntax(cursor.line, found.column, "M128 takes a feed in numbers.", "Write F and a number.")
    return found


def _joined(cursor: Cursor, axes: tuple[AxisWord, ...], words: tuple[AxisWord, ...]) -> tuple[AxisWord, ...]:
    for word in words:
        if any(word.axis == known.axis for known in axes):
            raise doubled(cursor, word.column, word.axis)
    return axes + words


def _demand_few(cursor: Cursor, codes: list[MCode]) -> None:
    if len(codes) > MOST_CODES:
        text = f"There are more than {MOST_CODES} M functions in the block."
        raise syntax(cursor.line, codes[-1].column, text, "Split the block.")


def _strange(cursor: Cursor) -> ProgramError:
    if cursor.take(_AXIS_ALONE):
        return cursor.expected("The axis has no value", "Write a number such as +10.")
    return cursor.expected("No word of an L block", "It takes axes, R0, a feed and M functions.")
