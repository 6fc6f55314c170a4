"""Readers of program start and end, blank form, tool, datum, label and call blocks."""

from __future__ import annotations

import re
from collections.abc import Callable

from core.language.diagnostics import ProgramError
from core.language.klartext.cycle_blocks import mirrored_axes, rotation, scale
from core.language.klartext.klartext_faults import NO_PROBE, TOOL_UNKNOWN, fault, syntax, unsupported
from core.language.klartext.klartext_nodes import (
    AxisWord,
    Begin,
    BlankForm,
    Call,
    CycleLine,
    Datum,
    End,
    Label,
    ProgramCall,
    RoundBlank,
    Selection,
    TipControl,
    ToolCall,
    ToolDef,
    Transform,
    Unheeded,
    Value,
)
from core.language.klartext.line_cursor import Cursor, axis_words, demand_once, words_once
from core.language.klartext.q_parameters import MOST_LABEL
from core.message import Message

_PROGRAM = re.compile(r"(?:(\S.*?)\s+)?(MM|INCH)\s*$")
_PART = re.compile(r"0\.([12])(?![0-9])")
_AXIS = re.compile(r"([XYZUVW])(?![A-Z0-9+\-])")
_TOOL_WORD = re.compile(r"(DL|DR2(?=:|\s*[+\-,.Q]|\s+[0-9])|DR|S|F)([UZ]?):?(?=\s*[+\-0-9.,Q])")
_CUTTING_SPEED = re.compile(r"S\s*\(\s*VC\s*=?")
_CLOSED = re.compile(r"\)")
_INDEXED = re.compile(r"[0-9]+\.[0-9]")
_TOOL = re.compile(r'(?=[0-9"]|QS)')
_TOOL_BY_Q = re.compile(r"(?=[+]?Q[LR]?\s*[0-9])")
MOST_TOOL = 32767


def begin(cursor: Cursor) -> Begin:
    """Read the name and unit after ``BEGIN PGM``."""
    return Begin(*_named(cursor, "BEGIN PGM"))


def end(cursor: Cursor) -> End:
    """Read the name and unit after ``END PGM``."""
    return End(*_named(cursor, "END PGM"))


def _named(cursor: Cursor, what: str) -> tuple[str, bool]:
    """Read the optional name and whether the unit is INCH; END PGM without a unit means MM."""
    match = _PROGRAM.match(cursor.text[cursor.at :].upper())
    if match is None and what == "END PGM":
        return cursor.rest(), False
    if match is None:
        raise syntax(
            cursor.line,
            cursor.column,
            Message("{what} needs MM or INCH.", what=what),
            "Write the unit after the name.",
        )
    name = cursor.text[cursor.at : cursor.at + len(match.group(1) or "")]
    cursor.rest()
    return name, match.group(2) == "INCH"


_ROUND_WORD = re.compile(r"(RI|DI|R|D|L|DIST)(?=\s*[+\-0-9.,Q])")


def _round_blank(cursor: Cursor) -> RoundBlank:
    """Read the words after ``BLK FORM CYLINDER``.

    The words are the axis, the radius or diameter, the length and the height above the datum.
    """
    axis = cursor.take(_AXIS)
    words = {name: word.value for name, word in words_once(cursor, _ROUND_WORD).items()}
    cursor.demand_end("Unexpected word in BLK FORM CYLINDER", "Use only R (or D), L, DIST and RI (or DI).")
    if axis is None or not {"R", "D"} & words.keys() or "L" not in words:
        raise cursor.expected("BLK FORM CYLINDER needs an axis, R or D, and L")
    wide = words.get("R") or words["D"]._replace(number=words["D"].number / 2.0)
    return RoundBlank(axis.group(1), wide, words["L"], words.get("DIST", Value(0.0)))


def blank_form(cursor: Cursor) -> BlankForm | RoundBlank | Unheeded:
    """Read the block after ``BLK FORM``: a corner of a block, or a cylinder.

    A blank that is defined by a contour or a file is read but not drawn.
    """
    column = cursor.column
    if cursor.keyword("CYLINDER"):
        return _round_blank(cursor)
    if form := cursor.keyword("ROTATION", "FILE"):
        cursor.rest()
        return Unheeded(Message("BLK FORM {rest}", rest=form), column)
    part = cursor.take(_PART)
    if part is None:
        raise unsupported(cursor.line, cursor.column, Message("BLK FORM {rest}", rest=cursor.rest()).strip())
    axis = ""
    if part.group(1) == "1":
        found = cursor.take(_AXIS)
        if found is None or found.group(1) not in "XYZ":
            raise cursor.expected("BLK FORM 0.1 needs the tool axis", "Write Z after BLK FORM 0.1.")
        axis = found.group(1)
    corner = axis_words(cursor, "XYZ", incremental=part.group(1) == "2")
    _demand_all(cursor, corner)
    return BlankForm(int(part.group(1)), corner, axis)


def _demand_all(cursor: Cursor, corner: tuple[AxisWord, ...]) -> None:
    missing = [axis for axis in "XYZ" if axis not in {word.axis for word in corner}]
    if missing:
        raise cursor.expected(
            Message("{missing} is missing", missing=", ".join(missing)),
            "Write the X, Y and Z coordinates of the corner.",
        )
    cursor.demand_end("Unexpected word in BLK FORM")


def tool_call(cursor: Cursor) -> ToolCall:
    """Read the words after ``TOOL CALL``: tool, axis, S, F (FU, FZ), DL and DR."""
    column = cursor.column
    tool: int | str | Value | None = None
    _demand_no_index(cursor)
    if cursor.take(_TOOL):
        tool = cursor.name("TOOL CALL", MOST_TOOL)
    elif cursor.take(_TOOL_BY_Q):
        tool = cursor.value("TOOL CALL")
    found = cursor.take(_AXIS)
    axis = "" if found is None else found.group(1)
    words: dict[str, Value] = {}
    per = ""
    while not cursor.done:
        at = cursor.column
        if cursor.take(_CUTTING_SPEED):
            words["VC"] = cursor.value("VC")
            if not cursor.take(_CLOSED):
                raise cursor.expected(
                    "The closing parenthesis after VC is missing", "Write, for example, S(VC = 120)."
                )
            continue
        match = cursor.take(_TOOL_WORD)
        if match is None or (match.group(2) and match.group(1) != "F"):
            raise cursor.expected(
                "Unexpected word in TOOL CALL", "Use only a tool, its axis, S, F, DL, DR and DR2."
            )
        name, per = match.group(1), match.group(2) or per
        demand_once(cursor, at, name in words, name)
        words[name] = cursor.value(name)
    length, radius = words.get("DL"), words.get("DR")
    return ToolCall(tool, axis, words.get("S"), words.get("F"), length, radius, column, per, words.get("VC"))


def _demand_no_index(cursor: Cursor) -> None:
    """Raise ProgramError for a tool index such as 5.1, because the tool table has one row per tool."""
    if found := _INDEXED.match(cursor.upper, cursor.at):
        text = Message(
            "The tool table has one row per tool and does not use an index, so the table does "
            "not contain tool {word}.",
            word=found.group(),
        )
        hint = "Give this cutting edge its own table row and tool number."
        raise fault(cursor.line, cursor.column, TOOL_UNKNOWN, text, hint)


# --- tool definitions


_LENGTHS = re.compile(r"([LR])(?=\s*[+\-0-9.,Q])")


def tool_def(cursor: Cursor, column: int) -> ToolDef:
    """Read the words after ``TOOL DEF``: the tool, and its length and radius if the program defines them."""
    _demand_no_index(cursor)
    tool = cursor.name("TOOL DEF", MOST_TOOL)
    words = {name: word.value for name, word in words_once(cursor, _LENGTHS).items()}
    cursor.demand_end("Unexpected word in TOOL DEF", "Use only a tool, L and R.")
    return ToolDef(tool, words.get("L"), words.get("R"), column)


# --- datum shifts and other transformations, labels, calls


MOST_REPEATS = 65534
_OF_REPEATS = re.compile(r"/\s*[0-9]+")


def transformation(cursor: Cursor, column: int) -> Datum | Transform:
    """Read the block after ``TRANS``. Raises ProgramError for a syntax error."""
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
        table = cursor.quoted() or ""
        cursor.keyword("TABLINE")
        made = Datum(row=cursor.value("TABLINE"), column=column, table=table)
    else:
        raise cursor.expected("TRANS DATUM needs AXIS or RESET")
    cursor.demand_end("Unexpected word in TRANS DATUM")
    return made


def label(cursor: Cursor) -> Label:
    """Read the number or name after ``LBL``."""
    column = cursor.column
    made = Label(cursor.name("LBL", MOST_LABEL), column)
    cursor.demand_end("Unexpected word in LBL")
    return made


def call(cursor: Cursor) -> Call:
    """Read the label and the number of repeats after ``CALL LBL``.

    Older controls write three repeats as ``REP 3/3``.
    """
    column = cursor.column
    name = cursor.name("CALL LBL", MOST_LABEL)
    if name == 0:
        text = "LBL 0 ends a subprogram; it cannot be called."
        raise syntax(cursor.line, column, text, "Call another label.")
    repeat = None
    if cursor.keyword("REP"):
        repeat = _repeats(cursor)
        cursor.take(_OF_REPEATS)
    cursor.demand_end("Unexpected word in CALL LBL")
    return Call(name, repeat, column)


def _repeats(cursor: Cursor) -> Value:
    """Read the number of repeats: a whole number or a Q parameter."""
    column = cursor.column
    if cursor.upper[cursor.at : cursor.at + 1] == "Q":
        return cursor.value("REP")
    return Value(float(cursor.whole("REP", MOST_REPEATS)), column=column)


def call_program(cursor: Cursor, column: int) -> ProgramCall:
    """Read the file name after ``CALL PGM``, with or without quotation marks."""
    name = cursor.file()
    if not name:
        raise cursor.expected("CALL PGM needs the name of a program")
    return ProgramCall(name, column)


def call_selected(cursor: Cursor, column: int) -> ProgramCall:
    """Read PGM after ``CALL SELECTED``."""
    cursor.keyword("PGM")
    cursor.demand_end("CALL SELECTED accepts only PGM")
    return ProgramCall("", column)


def selection(kind: str) -> Callable[[Cursor, int], Selection]:
    """Return the function that reads the file name after ``SEL TABLE``, ``SEL PATTERN`` or ``SEL PGM``."""

    def read(cursor: Cursor, column: int) -> Selection:
        name = cursor.file()
        if not name:
            raise cursor.expected(Message("SEL {kind} needs a file name", kind=kind))
        return Selection(kind, name, column)

    return read


_PROBE = re.compile(r"[0-9]+(?:\.[0-9]+)?")


def touch_probe(cursor: Cursor, column: int) -> ProgramError:
    """Return the error for ``TCH PROBE``, because no machine has a touch probe."""
    cursor.keyword("TCH PROBE")
    match = cursor.take(_PROBE)
    what = Message("TCH PROBE {word}", word=match.group()) if match else "TCH PROBE"
    text = Message("{what} needs a touch probe, but this machine does not have one.", what=what)
    hint = "Touch off by hand on the Jog page, and delete this block from the program."
    return fault(cursor.line, column, NO_PROBE, text, hint)


# These functions end or monitor functions that TurnDesk does not have, so they have no effect.
_STEERS_NOTHING = (
    *("MODE MILL", "FEED RESET", "S-PULSE RESET", "PARAXCOMP DISPLAY", "PARAXCOMP RESET", "PARAXMODE OFF"),
    *("COUNT", "LIFTOFF", "DCM", "AFC", "MONITORING", "PROG PATH", "CORRDATA RESET"),
)
_SECONDS = re.compile(r"TIME(?=\s*[0-9.,Q])")


def _dwell(cursor: Cursor, column: int) -> CycleLine:
    """Read ``FUNCTION DWELL TIME10``, which is like cycle 9.

    Raises ProgramError for a dwell in revolutions.
    """
    if cursor.take(_SECONDS) is None:
        raise unsupported(cursor.line, column, "FUNCTION DWELL in revolutions")
    made = CycleLine(9, 1, (AxisWord("", cursor.value("TIME")),), column=column)
    cursor.demand_end("Unexpected word in FUNCTION DWELL")
    return made


def material(cursor: Cursor, column: int) -> Unheeded:
    """Read the material after ``WMAT``, from which older controls calculate cutting data."""
    cursor.rest()
    return Unheeded("WMAT", column)


def function(cursor: Cursor, column: int) -> TipControl | Unheeded | CycleLine:
    """Read the block after ``FUNCTION``: TCPM, DWELL, or a function without effect here.

    Raises ProgramError for AXIS SPAT and PATHCTRL VECTOR, with which the same words mean other motions.
    """
    if cursor.keyword("TCPM"):
        while not cursor.done:
            if cursor.keyword("AXIS SPAT", "PATHCTRL VECTOR"):
                raise unsupported(cursor.line, column, "FUNCTION TCPM with AXIS SPAT or PATHCTRL VECTOR")
            if cursor.keyword("REFPNT TIP-CENTER", "REFPNT CENTER-CENTER"):
                raise unsupported(
                    cursor.line, column, "FUNCTION TCPM with the ball center as reference point (REFPNT)"
                )
            if not cursor.keyword("F TCP", "F CONT", "AXIS POS", "PATHCTRL AXIS", "REFPNT TIP-TIP"):
                raise cursor.expected(
                    "Unexpected word in FUNCTION TCPM", "Use F TCP, AXIS POS or PATHCTRL AXIS."
                )
        return TipControl(on=True, column=column)
    if cursor.keyword("RESET TCPM"):
        return TipControl(on=False, column=column)
    if cursor.keyword("DWELL"):
        return _dwell(cursor, column)
    for words in _STEERS_NOTHING:
        if cursor.keyword(words):
            cursor.rest()
            return Unheeded(Message("FUNCTION {rest}", rest=words), column)
    raise unsupported(cursor.line, column, Message("FUNCTION {rest}", rest=cursor.rest()).strip())
