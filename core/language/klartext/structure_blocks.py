"""Blocks besides paths, cycles and PLANE: program frame, blank form, tools, datum, labels and calls."""

from __future__ import annotations

import re

from core.language.klartext.cycle_blocks import mirrored_axes, rotation, scale
from core.language.klartext.klartext_faults import syntax, unsupported
from core.language.klartext.klartext_nodes import (
    AxisWord,
    Begin,
    BlankForm,
    Call,
    Datum,
    End,
    Label,
    ProgramCall,
    TipControl,
    ToolCall,
    ToolDef,
    Transform,
    Unheeded,
    Value,
)
from core.language.klartext.line_cursor import Cursor, axis_words, doubled

_PROGRAM = re.compile(r"(?:(\S.*?)\s+)?(MM|INCH)\s*$")
_PART = re.compile(r"0\.([12])(?![0-9])")
_AXIS = re.compile(r"([XYZUVW])(?![A-Z0-9+\-])")
_TOOL_WORD = re.compile(r"(DL|DR2|DR|S|F)(?=\s*[+\-0-9.,Q])")
_TOOL = re.compile(r'(?=[0-9"])')
MOST_TOOL = 32767


def begin(cursor: Cursor) -> Begin:
    """The words behind ``BEGIN PGM``: name and unit."""
    return Begin(*_named(cursor, "BEGIN PGM"))


def end(cursor: Cursor) -> End:
    """The words behind ``END PGM``: name and unit."""
    return End(*_named(cursor, "END PGM"))


def _named(cursor: Cursor, what: str) -> tuple[str, bool]:
    """Name, which may be missing, and whether the unit is INCH; END PGM without a unit is read as MM."""
    match = _PROGRAM.match(cursor.text[cursor.at :].upper())
    if match is None and what == "END PGM":
        return cursor.rest(), False
    if match is None:
        raise syntax(
            cursor.line, cursor.column, f"{what} needs MM or INCH.", "Write the unit behind the name."
        )
    name = cursor.text[cursor.at : cursor.at + len(match.group(1) or "")]
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
            raise cursor.expected("No word of TOOL CALL", "It takes a tool, its axis, S, F, DL, DR and DR2.")
        name = match.group(1)
        if name in words:
            raise doubled(cursor, at, name)
        words[name] = cursor.value(name)
    return ToolCall(tool, axis, words.get("S"), words.get("F"), words.get("DL"), words.get("DR"), column)


# --- datum shifts, labels, calls and Q parameters


_LENGTHS = re.compile(r"([LR])(?=\s*[+\-0-9.,Q])")


def tool_def(cursor: Cursor, column: int) -> ToolDef:
    """The words behind ``TOOL DEF``: the tool, and its length and radius where the program tells them."""
    tool = cursor.name("TOOL DEF", MOST_TOOL)
    words: dict[str, Value] = {}
    while not cursor.done:
        at, match = cursor.column, cursor.take(_LENGTHS)
        if match is None:
            raise cursor.expected("No word of TOOL DEF", "It takes a tool, L and R.")
        if match.group(1) in words:
            raise doubled(cursor, at, match.group(1))
        words[match.group(1)] = cursor.value(match.group(1))
    return ToolDef(tool, words.get("L"), words.get("R"), column)


# --- datum shifts and other transformations, labels, calls


MOST_LABEL = 65535
MOST_REPEATS = 65534
_OF_REPEATS = re.compile(r"/\s*[0-9]+")


def transformation(cursor: Cursor, column: int) -> Datum | Transform:
    """The words behind ``TRANS``."""
    if cursor.keyword("DATUM"):
        return _datum(cursor, column)
    if cursor.keyword("MIRROR"):
        axes = "" if cursor.keyword("RESET") else _mirrored(cursor)
        return Transform("MIRROR", axes=axes, column=column)
    for word, read in (("ROTATION", rotation), ("SCALE", scale)):
        if cursor.keyword(word):
            return Transform(word, column=column) if cursor.keyword("RESET") else read(cursor, column)
    raise cursor.expected("TRANS needs DATUM, MIRROR, ROTATION or SCALE")


def _mirrored(cursor: Cursor) -> str:
    if not cursor.keyword("AXIS"):
        raise cursor.expected("TRANS MIRROR needs AXIS or RESET")
    return mirrored_axes(cursor)


def _datum(cursor: Cursor, column: int) -> Datum:
    if cursor.keyword("RESET"):
        made = Datum(reset=True)
    elif cursor.keyword("AXIS"):
        made = Datum(axis_words(cursor, "XYZABC"))
        if not made.axes:
            raise cursor.expected("TRANS DATUM AXIS needs X, Y or Z")
    elif cursor.keyword("TABLE"):
        raise unsupported(cursor.line, column, "TRANS DATUM TABLE")
    else:
        raise cursor.expected("TRANS DATUM needs AXIS or RESET")
    if not cursor.done:
        raise cursor.expected("No word of TRANS DATUM")
    return made


def label(cursor: Cursor) -> Label:
    """The number or name behind ``LBL``."""
    column = cursor.column
    made = Label(cursor.name("LBL", MOST_LABEL), column)
    if not cursor.done:
        raise cursor.expected("No word of LBL")
    return made


def call(cursor: Cursor) -> Call:
    """The label behind ``CALL LBL``, and its repeats; ``REP 3/3`` is how older controls write three."""
    column = cursor.column
    name = cursor.name("CALL LBL", MOST_LABEL)
    if name == 0:
        text = "LBL 0 ends a subprogram; it cannot be called."
        raise syntax(cursor.line, column, text, "Call another label.")
    repeat = None
    if cursor.keyword("REP"):
        repeat = _repeats(cursor)
        cursor.take(_OF_REPEATS)
    if not cursor.done:
        raise cursor.expected("No word of CALL LBL")
    return Call(name, repeat, column)


def _repeats(cursor: Cursor) -> Value:
    """A whole number of repeats, or a Q parameter."""
    column = cursor.column
    if cursor.upper[cursor.at : cursor.at + 1] == "Q":
        return cursor.value("REP")
    return Value(float(cursor.whole("REP", MOST_REPEATS)), column=column)


def call_program(cursor: Cursor, column: int) -> ProgramCall:
    """The file behind ``CALL PGM``, in quotes or not."""
    name = cursor.rest().strip('"')
    if not name:
        raise cursor.expected("CALL PGM needs the name of a program")
    return ProgramCall(name, column)


def function(cursor: Cursor, column: int) -> TipControl | Unheeded:
    """Behind ``FUNCTION``: TCPM on and off; MODE MILL steers nothing here.

    Raises ProgramError for AXIS SPAT and PATHCTRL VECTOR, by which the same words mean other ways.
    """
    if cursor.keyword("TCPM"):
        while not cursor.done:
            if cursor.keyword("AXIS SPAT", "PATHCTRL VECTOR"):
                raise unsupported(cursor.line, column, "FUNCTION TCPM with AXIS SPAT or PATHCTRL VECTOR")
            if not cursor.keyword("F TCP", "F CONT", "AXIS POS", "PATHCTRL AXIS"):
                raise cursor.expected("No word of FUNCTION TCPM", "It takes F TCP, AXIS POS, PATHCTRL AXIS.")
        return TipControl(on=True, column=column)
    if cursor.keyword("RESET TCPM"):
        return TipControl(on=False, column=column)
    if cursor.keyword("MODE MILL"):
        return Unheeded("FUNCTION MODE MILL", column)
    raise unsupported(cursor.line, column, f"FUNCTION {cursor.rest()}".strip())
