"""Parsers of program start and end, blank form, tool, datum, label and call blocks."""

from __future__ import annotations

import re
from collections.abc import Callable

from core.language.diagnostics import ProgramError
from core.language.klartext.cycle_blocks import read_mirrored_axes, read_rotation, read_scale
from core.language.klartext.klartext_faults import (
    PROBE_MISSING,
    TOOL_UNKNOWN,
    make_klartext_error,
    make_syntax_error,
    make_unsupported_error,
)
from core.language.klartext.klartext_nodes import (
    BeginBlock,
    BlankCorner,
    CoordinateTransform,
    CycleLine,
    CylinderBlank,
    DatumShift,
    EndBlock,
    IgnoredBlock,
    Label,
    LabelCall,
    ProgramCall,
    SelectionBlock,
    TcpmSwitch,
    ToolCall,
    ToolDefinition,
)
from core.language.klartext.klartext_words import AxisWord, Value
from core.language.klartext.line_cursor import (
    LineCursor,
    check_word_not_repeated,
    read_axis_words,
    read_words_by_name,
)
from core.language.klartext.q_parameters import MAX_LABEL_NUMBER
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
MAX_TOOL_NUMBER = 32767


def read_begin(cursor: LineCursor) -> BeginBlock:
    """Read the name and unit after ``BEGIN PGM``."""
    return BeginBlock(*_name_and_unit(cursor, "BEGIN PGM"))


def read_end(cursor: LineCursor) -> EndBlock:
    """Read the name and unit after ``END PGM``."""
    return EndBlock(*_name_and_unit(cursor, "END PGM"))


def _name_and_unit(cursor: LineCursor, what: str) -> tuple[str, bool]:
    """Read the optional program name and the unit; return the name, and True if the unit is INCH.

    END PGM without a unit means MM.
    """
    match = _PROGRAM.match(cursor.text[cursor.index :].upper())
    if match is None and what == "END PGM":
        return cursor.read_remaining_text(), False
    if match is None:
        raise make_syntax_error(
            cursor.line_number,
            cursor.column,
            Message("{what} needs MM or INCH.", what=what),
            "Write the unit after the name.",
        )
    name = cursor.text[cursor.index : cursor.index + len(match.group(1) or "")]
    cursor.read_remaining_text()
    return name, match.group(2) == "INCH"


_ROUND_WORD = re.compile(r"(RI|DI|R|D|L|DIST)(?=\s*[+\-0-9.,Q])")


def _round_blank(cursor: LineCursor) -> CylinderBlank:
    """Read the words after ``BLK FORM CYLINDER``.

    The words are the tool axis, the radius or diameter, the length, and the height above the datum.
    """
    axis = cursor.match_pattern(_AXIS)
    words = {name: word.value for name, word in read_words_by_name(cursor, _ROUND_WORD).items()}
    cursor.check_at_end("Unexpected word in BLK FORM CYLINDER", "Use only R (or D), L, DIST and RI (or DI).")
    if axis is None or not {"R", "D"} & words.keys() or "L" not in words:
        raise cursor.make_expected_error("BLK FORM CYLINDER needs an axis, R or D, and L")
    wide = words.get("R") or words["D"]._replace(number=words["D"].number / 2.0)
    return CylinderBlank(axis.group(1), wide, words["L"], words.get("DIST", Value(0.0)))


def read_blank_form(cursor: LineCursor) -> BlankCorner | CylinderBlank | IgnoredBlock:
    """Read the block after ``BLK FORM``, which defines a cylinder or one corner of a cuboid.

    A blank that is defined by a contour or a file is accepted but not drawn.
    """
    column = cursor.column
    if cursor.read_keyword("CYLINDER"):
        return _round_blank(cursor)
    if form := cursor.read_keyword("ROTATION", "FILE"):
        cursor.read_remaining_text()
        return IgnoredBlock(Message("BLK FORM {rest}", rest=form), column)
    part = cursor.match_pattern(_PART)
    if part is None:
        raise make_unsupported_error(
            cursor.line_number,
            cursor.column,
            Message("BLK FORM {rest}", rest=cursor.read_remaining_text()).strip(),
        )
    axis = ""
    if part.group(1) == "1":
        found = cursor.match_pattern(_AXIS)
        if found is None or found.group(1) not in "XYZ":
            raise cursor.make_expected_error(
                "BLK FORM 0.1 needs the tool axis", "Write Z after BLK FORM 0.1."
            )
        axis = found.group(1)
    corner = read_axis_words(cursor, "XYZ", allows_incremental=part.group(1) == "2")
    _demand_all(cursor, corner)
    return BlankCorner(int(part.group(1)), corner, axis)


def _demand_all(cursor: LineCursor, corner: tuple[AxisWord, ...]) -> None:
    missing = [axis for axis in "XYZ" if axis not in {word.axis for word in corner}]
    if missing:
        raise cursor.make_expected_error(
            Message("{missing} is missing", missing=", ".join(missing)),
            "Write the X, Y and Z coordinates of the corner.",
        )
    cursor.check_at_end("Unexpected word in BLK FORM")


def read_tool_call(cursor: LineCursor) -> ToolCall:
    """Read the words after ``TOOL CALL``: the tool, the tool axis, S, F (FU, FZ), DL, DR and DR2."""
    column = cursor.column
    tool: int | str | Value | None = None
    _check_no_index(cursor)
    if cursor.match_pattern(_TOOL):
        tool = cursor.read_name("TOOL CALL", MAX_TOOL_NUMBER)
    elif cursor.match_pattern(_TOOL_BY_Q):
        tool = cursor.read_value("TOOL CALL")
    found = cursor.match_pattern(_AXIS)
    axis = "" if found is None else found.group(1)
    words: dict[str, Value] = {}
    per = ""
    while not cursor.is_at_end:
        at = cursor.column
        if cursor.match_pattern(_CUTTING_SPEED):
            words["VC"] = cursor.read_value("VC")
            if not cursor.match_pattern(_CLOSED):
                raise cursor.make_expected_error(
                    "The closing parenthesis after VC is missing", "Write, for example, S(VC = 120)."
                )
            continue
        match = cursor.match_pattern(_TOOL_WORD)
        if match is None or (match.group(2) and match.group(1) != "F"):
            raise cursor.make_expected_error(
                "Unexpected word in TOOL CALL", "Use only a tool, its axis, S, F, DL, DR and DR2."
            )
        name, per = match.group(1), match.group(2) or per
        check_word_not_repeated(cursor, at, name in words, name)
        words[name] = cursor.read_value(name)
    deltas = words.get("DL"), words.get("DR"), words.get("DR2")
    return ToolCall(tool, axis, words.get("S"), words.get("F"), *deltas, column, per, words.get("VC"))


def _check_no_index(cursor: LineCursor) -> None:
    """Raise ProgramError for a tool index such as 5.1, because the tool table has only one row per tool."""
    if found := _INDEXED.match(cursor.uppercase_text, cursor.index):
        text = Message(
            "The tool table has one row per tool and does not use an index, so the table does "
            "not contain tool {word}.",
            word=found.group(),
        )
        hint = "Give this cutting edge its own table row and tool number."
        raise make_klartext_error(cursor.line_number, cursor.column, TOOL_UNKNOWN, text, hint)


# --- tool definitions


_LENGTHS = re.compile(r"([LR])(?=\s*[+\-0-9.,Q])")


def read_tool_definition(cursor: LineCursor, column: int) -> ToolDefinition:
    """Read the words after ``TOOL DEF``, which are the tool and optionally its length and radius."""
    _check_no_index(cursor)
    tool = cursor.read_name("TOOL DEF", MAX_TOOL_NUMBER)
    words = {name: word.value for name, word in read_words_by_name(cursor, _LENGTHS).items()}
    cursor.check_at_end("Unexpected word in TOOL DEF", "Use only a tool, L and R.")
    return ToolDefinition(tool, words.get("L"), words.get("R"), column)


# --- datum shifts and other transformations, labels, calls


MAX_REPEAT_COUNT = 65534
_REPEAT_PATTERN = re.compile(r"/\s*[0-9]+")


def read_transformation(cursor: LineCursor, column: int) -> DatumShift | CoordinateTransform:
    """Read the block after ``TRANS``. Raises ProgramError for a syntax error."""
    if cursor.read_keyword("DATUM"):
        return _datum(cursor, column)
    if cursor.read_keyword("MIRROR"):
        axes = "" if cursor.read_keyword("RESET") else _mirrored(cursor)
        return CoordinateTransform("MIRROR", mirrored_axes=axes, column=column)
    for word, read in (("ROTATION", read_rotation), ("SCALE", read_scale)):
        if cursor.read_keyword(word):
            return (
                CoordinateTransform(word, column=column)
                if cursor.read_keyword("RESET")
                else read(cursor, column)
            )
    raise cursor.make_expected_error("TRANS needs DATUM, MIRROR, ROTATION or SCALE")


def _mirrored(cursor: LineCursor) -> str:
    if not cursor.read_keyword("AXIS"):
        raise cursor.make_expected_error("TRANS MIRROR needs AXIS or RESET")
    return read_mirrored_axes(cursor)


def _datum(cursor: LineCursor, column: int) -> DatumShift:
    if cursor.read_keyword("RESET"):
        made = DatumShift(is_reset=True)
    elif cursor.read_keyword("AXIS"):
        made = DatumShift(read_axis_words(cursor, "XYZABC"))
        if not made.axis_words:
            raise cursor.make_expected_error("TRANS DATUM AXIS needs X, Y or Z")
    elif cursor.read_keyword("TABLE"):
        table = cursor.read_quoted_text() or ""
        cursor.read_keyword("TABLINE")
        made = DatumShift(table_row=cursor.read_value("TABLINE"), column=column, table_name=table)
    else:
        raise cursor.make_expected_error("TRANS DATUM needs AXIS or RESET")
    cursor.check_at_end("Unexpected word in TRANS DATUM")
    return made


def read_label(cursor: LineCursor) -> Label:
    """Read the number or name after ``LBL``."""
    column = cursor.column
    made = Label(cursor.read_name("LBL", MAX_LABEL_NUMBER), column)
    cursor.check_at_end("Unexpected word in LBL")
    return made


def call(cursor: LineCursor) -> LabelCall:
    """Read the label and the number of repeats after ``CALL LBL``.

    Older controls write three repeats as ``REP 3/3``.
    """
    column = cursor.column
    name = cursor.read_name("CALL LBL", MAX_LABEL_NUMBER)
    if name == 0:
        text = "LBL 0 ends a subprogram; it cannot be called."
        raise make_syntax_error(cursor.line_number, column, text, "Call another label.")
    repeat = None
    if cursor.read_keyword("REP"):
        repeat = _repeats(cursor)
        cursor.match_pattern(_REPEAT_PATTERN)
    cursor.check_at_end("Unexpected word in CALL LBL")
    return LabelCall(name, repeat, column)


def _repeats(cursor: LineCursor) -> Value:
    """Read the number of repeats, which is a whole number or a Q parameter."""
    column = cursor.column
    if cursor.uppercase_text[cursor.index : cursor.index + 1] == "Q":
        return cursor.read_value("REP")
    return Value(float(cursor.read_whole_number("REP", MAX_REPEAT_COUNT)), column=column)


def read_program_call(cursor: LineCursor, column: int) -> ProgramCall:
    """Read the file name after ``CALL PGM``, with or without quotation marks."""
    name = cursor.read_file_name()
    if not name:
        raise cursor.make_expected_error("CALL PGM needs the name of a program")
    return ProgramCall(name, column)


def read_selected_call(cursor: LineCursor, column: int) -> ProgramCall:
    """Read PGM after ``CALL SELECTED``."""
    cursor.read_keyword("PGM")
    cursor.check_at_end("CALL SELECTED accepts only PGM")
    return ProgramCall("", column)


def make_selection_reader(kind: str) -> Callable[[LineCursor, int], SelectionBlock]:
    """Return the function that reads the file name after ``SEL TABLE``, ``SEL PATTERN`` or ``SEL PGM``."""

    def read_selection(cursor: LineCursor, column: int) -> SelectionBlock:
        name = cursor.read_file_name()
        if not name:
            raise cursor.make_expected_error(Message("SEL {kind} needs a file name", kind=kind))
        return SelectionBlock(kind, name, column)

    return read_selection


_PROBE = re.compile(r"[0-9]+(?:\.[0-9]+)?")


def make_touch_probe_error(cursor: LineCursor, column: int) -> ProgramError:
    """Return the error for ``TCH PROBE``, because TurnDesk does not support touch probes."""
    cursor.read_keyword("TCH PROBE")
    match = cursor.match_pattern(_PROBE)
    what = Message("TCH PROBE {word}", word=match.group()) if match else "TCH PROBE"
    text = Message("{what} needs a touch probe, but this machine does not have one.", what=what)
    hint = "Touch off by hand on the Jog page, and delete this block from the program."
    return make_klartext_error(cursor.line_number, column, PROBE_MISSING, text, hint)


# These functions end or monitor functions that TurnDesk does not have, so they have no effect.
_IGNORED_FUNCTIONS = (
    *("MODE MILL", "FEED RESET", "S-PULSE RESET", "PARAXCOMP DISPLAY", "PARAXCOMP RESET", "PARAXMODE OFF"),
    *("COUNT", "LIFTOFF", "DCM", "AFC", "MONITORING", "PROG PATH", "CORRDATA RESET"),
)
_SECONDS = re.compile(r"TIME(?=\s*[0-9.,Q])")


def _dwell(cursor: LineCursor, column: int) -> CycleLine:
    """Read ``FUNCTION DWELL TIME10``, which is like cycle 9.

    Raises ProgramError for a dwell in revolutions.
    """
    if cursor.match_pattern(_SECONDS) is None:
        raise make_unsupported_error(cursor.line_number, column, "FUNCTION DWELL in revolutions")
    made = CycleLine(9, 1, (AxisWord("", cursor.read_value("TIME")),), column=column)
    cursor.check_at_end("Unexpected word in FUNCTION DWELL")
    return made


def read_material(cursor: LineCursor, column: int) -> IgnoredBlock:
    """Read the material after ``WMAT``, from which older controls calculate cutting data."""
    cursor.read_remaining_text()
    return IgnoredBlock("WMAT", column)


def read_function_block(cursor: LineCursor, column: int) -> TcpmSwitch | IgnoredBlock | CycleLine:
    """Read the block after ``FUNCTION``: TCPM, DWELL, or a function without effect on this control.

    Raises ProgramError for a syntax error and for functions that TurnDesk does not support. It also rejects
    AXIS SPAT, PATHCTRL VECTOR and a REFPNT other than TIP-TIP, because they would program a different
    motion.
    """
    if cursor.read_keyword("TCPM"):
        while not cursor.is_at_end:
            if cursor.read_keyword("AXIS SPAT", "PATHCTRL VECTOR"):
                raise make_unsupported_error(
                    cursor.line_number, column, "FUNCTION TCPM with AXIS SPAT or PATHCTRL VECTOR"
                )
            if cursor.read_keyword("REFPNT TIP-CENTER", "REFPNT CENTER-CENTER"):
                raise make_unsupported_error(
                    cursor.line_number,
                    column,
                    "FUNCTION TCPM with the ball center as reference point (REFPNT)",
                )
            if not cursor.read_keyword("F TCP", "F CONT", "AXIS POS", "PATHCTRL AXIS", "REFPNT TIP-TIP"):
                raise cursor.make_expected_error(
                    "Unexpected word in FUNCTION TCPM", "Use F TCP, AXIS POS or PATHCTRL AXIS."
                )
        return TcpmSwitch(is_on=True, column=column)
    if cursor.read_keyword("RESET TCPM"):
        return TcpmSwitch(is_on=False, column=column)
    if cursor.read_keyword("DWELL"):
        return _dwell(cursor, column)
    for words in _IGNORED_FUNCTIONS:
        if cursor.read_keyword(words):
            cursor.read_remaining_text()
            return IgnoredBlock(Message("FUNCTION {rest}", rest=words), column)
    raise make_unsupported_error(
        cursor.line_number, column, Message("FUNCTION {rest}", rest=cursor.read_remaining_text()).strip()
    )
