"""Words that several blocks share: feeds, retracts, axis words."""

from __future__ import annotations

import re
from functools import lru_cache

from core.language.diagnostics import ProgramError
from core.language.klartext import faults
from core.language.klartext.cursor import Cursor
from core.language.klartext.nodes import AxisWord, Feed, Retract

_FEED = re.compile(r"F\s*(MAX|AUTO)(?![A-Z0-9])")
_FEED_VALUE = re.compile(r"F(?=\s*[+-]?\s*[0-9.,Q])")
_FEED_WORD = re.compile(r"F(?![A-Z])")
_RETRACT = re.compile(r"MB(?![A-Z])|MB(?=MAX)")


def feed(cursor: Cursor) -> Feed | None:
    """``F200``, ``FQ5``, ``FMAX``, ``F AUTO`` where one stands here."""
    column = cursor.column
    fixed = cursor.take(_FEED)
    if fixed is not None:
        return Feed(fixed.group(1).lower(), None, column)
    if cursor.take(_FEED_VALUE):
        return Feed("value", cursor.value("F"), column)
    if cursor.take(_FEED_WORD):
        raise cursor.expected("F has no value", "Write a number, Q, MAX or AUTO behind F.")
    return None


def retract(cursor: Cursor) -> Retract | None:
    """``MB50``, ``MB 50``, ``MB MAX`` where one stands here."""
    column = cursor.column
    if cursor.take(_RETRACT) is None:
        return None
    if cursor.keyword("MAX"):
        return Retract(None, column)
    return Retract(cursor.number("MB"), column)


@lru_cache(maxsize=16)
def _axis_word(letters: str, incremental: bool) -> re.Pattern[str]:
    return re.compile(rf"({'I?' if incremental else ''})([{letters}])(?=\s*[+\-0-9.,Q])")


def axis_words(cursor: Cursor, letters: str, *, incremental: bool = True) -> tuple[AxisWord, ...]:
    """All axis words that stand here, each letter once. Raises ProgramError for a doubled one."""
    pattern = _axis_word(letters, incremental)
    found: list[AxisWord] = []
    while True:
        column, match = cursor.column, cursor.take(pattern)
        if match is None:
            return tuple(found)
        sign, axis = match.groups()
        if any(word.axis == axis for word in found):
            raise doubled(cursor, column, f"{sign}{axis}")
        found.append(AxisWord(axis, cursor.value(f"{sign}{axis}"), sign == "I", column))


def doubled(cursor: Cursor, column: int, what: str) -> ProgramError:
    """The error for a word that stands twice."""
    return faults.syntax(cursor.line, column, f"{what} stands twice in the block.", "Take one out.")
