"""Datum shifts, labels, calls and Q parameters."""

from __future__ import annotations

import re

from core.language.klartext import faults
from core.language.klartext.cursor import Cursor
from core.language.klartext.feeds import axis_words
from core.language.klartext.nodes import Assign, Call, Datum, Label

MOST_LABEL = 65535
MOST_REPEATS = 65534
_CYCLE = re.compile(r"([0-9]+)(?:\.([0-9]+))?")
_EQUALS = re.compile(r"=")


def datum(cursor: Cursor, column: int) -> Datum:
    """Behind ``TRANS DATUM``."""
    if cursor.keyword("RESET"):
        made = Datum(reset=True)
    elif cursor.keyword("AXIS"):
        made = Datum(axis_words(cursor, "XYZ"))
        if not made.axes:
            raise cursor.expected("TRANS DATUM AXIS needs X, Y or Z")
    elif cursor.keyword("TABLE"):
        raise faults.unsupported(cursor.line, column, "TRANS DATUM TABLE")
    else:
        raise cursor.expected("TRANS DATUM needs AXIS or RESET")
    if not cursor.done:
        raise cursor.expected("No word of TRANS DATUM")
    return made


def cycle(cursor: Cursor, column: int) -> Datum:
    """Behind ``CYCL DEF``: cycle 7 only. Raises ProgramError for every other one."""
    match = cursor.take(_CYCLE)
    if match is None or match.group(1) != "7" or match.group(2) is None:
        name = match.group(1) if match else cursor.next_word
        raise faults.unsupported(cursor.line, column, f"CYCL DEF {name}".strip())
    part = int(match.group(2)[:4])
    if part == 0:
        return Datum(cycle=0, text=cursor.rest())
    axes = axis_words(cursor, "XYZ")
    if len(axes) != 1:
        raise cursor.expected(f"CYCL DEF 7.{part} takes one of X, Y and Z")
    if not cursor.done:
        raise cursor.expected("No word of cycle 7")
    return Datum(axes, cycle=part)


def label(cursor: Cursor) -> Label:
    """Behind ``LBL``."""
    column = cursor.column
    made = Label(cursor.name("LBL", MOST_LABEL), column)
    if not cursor.done:
        raise cursor.expected("No word of LBL")
    return made


def call(cursor: Cursor) -> Call:
    """Behind ``CALL LBL``."""
    column = cursor.column
    name = cursor.name("CALL LBL", MOST_LABEL)
    if name == 0:
        text = "LBL 0 ends a subprogram; it cannot be called."
        raise faults.syntax(cursor.line, column, text, "Call another label.")
    repeat = cursor.whole("REP", MOST_REPEATS) if cursor.keyword("REP") else None
    if not cursor.done:
        raise cursor.expected("No word of CALL LBL")
    return Call(name, repeat, column)


def assign(cursor: Cursor, *, spelled: bool) -> Assign:
    """Behind ``Q``, with ``spelled`` behind ``FN 0: Q``. Raises ProgramError for a formula."""
    column = cursor.column
    q = cursor.parameter()
    if cursor.take(_EQUALS) is None:
        raise cursor.expected(f"'=' was expected behind Q{q}")
    value = cursor.value(f"Q{q}")
    if not cursor.done:
        raise faults.unsupported(cursor.line, cursor.column, f"The formula '{cursor.rest()}'")
    return Assign(q, value, spelled, column)
