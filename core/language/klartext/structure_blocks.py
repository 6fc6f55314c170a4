"""Blocks besides L and PLANE: program frame, blank form, TOOL CALL, datum, labels, calls, Q parameters."""

from __future__ import annotations

import re

from core.language.klartext.klartext_faults import syntax, unsupported
from core.language.klartext.klartext_nodes import (
    Assign,
    AxisWord,
    Begin,
    BlankForm,
    Call,
    Datum,
    End,
    Label,
    ToolCall,
    Value,
)
from core.language.klartext.line_cursor import Cursor, axis_words, doubled

_PROGRAM = re.compile(r"(\S.*?)\s+(MM|INCH)\s*$")
_PART = re.compile(r"0\.([12])(?![0-9])")
_AXIS = re.compile(r"([XYZUVW])(?![A-Z0-9+\-])")
_TOOL_WORD = re.compile(r"(DL|DR|S|F)(?=\s*[+\-0-9.,Q])")
_TOOL = re.compile(r'(?=[0-9"])')
MOST_TOOL = 32767


def begin(cursor: Cursor) -> Begin:
    """The words behind ``BEGIN PGM``: name and unit."""
    return Begin(*_named(cursor, "BEGIN PGM"))


def end(cursor: Cursor) -> End:
    """The words behind ``END PGM``: name and unit."""
    return End(*_named(cursor, "END PGM"))


def _named(cursor: Cursor, what: str) -> tuple[str, bool]:
    match = _PROGRAM.match(cursor.text[cursor.at :].upper())
    if match is None:
        raise syntax(
            cursor.line, cursor.column, f"{what} needs a name and MM or INCH.", "Write both behind it."
        )
    name = cursor.text[cursor.at : cursor.at + len(match.group(1))]
    cursor.rest()
    return name, match.group(2) == "INCH"


def blank_form(cursor: Cursor) -> BlankForm:
    """Behind ``BLK FORM``: two corners of a block. Raises ProgramError for other forms."""
    part = cursor.take(_PART)
    if part is None:
        raise unsupported(cursor.line, cursor.column, f"BLK FORM {cursor.rest()}".strip())
    axis = ""
    if part.group(1) == "1":
        found = cursor.take(_AXIS)
        if found is None or found.group(1) not in "XYZ":
            raise cursor.expected("BLK FORM 0.1 needs the tool axis", "Write Z behind 0.1.")
        axis = found.group(1)
    corner = axis_words(cursor, "XYZ", incremental=False)
    _demand_all(cursor, corner)
    return BlankForm(int(part.group(1)), corner, axis)


def _demand_all(cursor: Cursor, corner: tuple[AxisWord, ...]) -> None:
    missing = [axis for axis in "XYZ" if axis not in {word.axis for word in corner}]
    if missing:
        raise cursor.expected(f"{', '.join(missing)} is missing", "A corner needs X, Y and Z.")
    if not cursor.done:
        raise cursor.expected("No word of BLK FORM")


def tool_call(cursor: Cursor) -> ToolCall:
    """The words behind ``TOOL CALL``: tool, axis, S, F, DL and DR."""
    column = cursor.column
    tool = cursor.name("TOOL CALL", MOST_TOOL) if cursor.take(_TOOL) else None
    found = cursor.take(_AXIS)
    axis = "" if found is None else found.group(1)
    words: dict[str, Value] = {}
    while not cursor.done:
        at = cursor.column
        match = cursor.take(_TOOL_WORD)
        if match is None:
            raise cursor.expected("No word of TOOL CALL", "It takes a tool, its axis, S, F, DL and DR.")
        name = match.group(1)
        if name in words:
            raise doubled(cursor, at, name)
        words[name] = cursor.value(name)
    return ToolCall(tool, axis, words.get("S"), words.get("F"), words.get("DL"), words.get("DR"), column)


# --- datum shifts, labels, calls and Q parameters


MOST_LABEL = 65535
MOST_REPEATS = 65534
_CYCLE = re.compile(r"([0-9]+)(?:\.([0-9]+))?")
_EQUALS = re.compile(r"=")


def datum(cursor: Cursor, column: int) -> Datum:
    """The words behind ``TRANS DATUM``: AXIS with its axes, or RESET."""
    if cursor.keyword("RESET"):
        made = Datum(reset=True)
    elif cursor.keyword("AXIS"):
        made = Datum(axis_words(cursor, "XYZ"))
        if not made.axes:
            raise cursor.expected("TRANS DATUM AXIS needs X, Y or Z")
    elif cursor.keyword("TABLE"):
        raise unsupported(cursor.line, column, "TRANS DATUM TABLE")
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
        raise unsupported(cursor.line, column, f"CYCL DEF {name}".strip())
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
    """The number or name behind ``LBL``."""
    column = cursor.column
    made = Label(cursor.name("LBL", MOST_LABEL), column)
    if not cursor.done:
        raise cursor.expected("No word of LBL")
    return made


def call(cursor: Cursor) -> Call:
    """The label behind ``CALL LBL``, and its repeats."""
    column = cursor.column
    name = cursor.name("CALL LBL", MOST_LABEL)
    if name == 0:
        text = "LBL 0 ends a subprogram; it cannot be called."
        raise syntax(cursor.line, column, text, "Call another label.")
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
        raise unsupported(cursor.line, cursor.column, f"The formula '{cursor.rest()}'")
    return Assign(q, value, spelled, column)
