"""PATTERN DEF: machining points one by one, in a row, as a grid, a frame, on a circle or a part of one."""

from __future__ import annotations

import re

from core.language.klartext.klartext_nodes import AxisWord, PatternDef, PatternPart
from core.language.klartext.line_cursor import Cursor, words_once
from core.message import Message

_KIND = re.compile(r"(PITCHCIRC|CIRC|FRAME|PAT|ROW|POS)\s*[0-9]{1,2}\s*\(")
_WORD = re.compile(r"(NUMX|NUMY|NUM|ROTX|ROTY|ROT|START|STEP|DX|DY|D|X|Y|Z)(?=\s*[+\-0-9.,Q])")
_CLOSED = re.compile(r"\)")
_GRID = ("X", "Y", "DX", "DY", "NUMX", "NUMY")
NEEDS = {
    "POS": ("X", "Y"),
    "ROW": ("X", "Y", "D", "NUM"),
    "PAT": _GRID,
    "FRAME": _GRID,
    "CIRC": ("X", "Y", "D", "NUM"),
    "PITCHCIRC": ("X", "Y", "D", "STEP", "NUM"),
}
"""The words that each form needs."""


def pattern(cursor: Cursor, column: int) -> PatternDef:
    """Behind ``PATTERN DEF``. Raises ProgramError for what is missing, unknown or doubled."""
    parts = []
    while not cursor.done:
        at, match = cursor.column, cursor.take(_KIND)
        if match is None:
            raise cursor.expected(
                "PATTERN DEF accepts only POS1 (…), ROW1, PAT1, FRAME1, CIRC1 or PITCHCIRC1"
            )
        parts.append(PatternPart(match.group(1), _words(cursor, match.group(1)), at))
    if not parts:
        raise cursor.expected(
            "PATTERN DEF has no points", "After PATTERN DEF, write, for example, POS1 (X+0 Y+0 Z+0)."
        )
    return PatternDef(tuple(parts), column)


def _words(cursor: Cursor, form: str) -> tuple[AxisWord, ...]:
    found = words_once(cursor, _WORD)
    if not cursor.take(_CLOSED):
        raise cursor.expected(
            Message("Unexpected word in {form}", form=form), "Close the parenthesis after the last word."
        )
    missing = [name for name in NEEDS[form] if name not in found]
    if missing:
        raise cursor.expected(Message("{form} needs {missing}", form=form, missing=" and ".join(missing)))
    return tuple(found.values())
