"""Parsers of CYCL DEF, CYCL CALL, CONTOUR DEF and PATTERN DEF.

Cycles numbered 200 or higher have Q parameters. Older cycles consist of numbered lines, such as CYCL DEF
1.2. CONTOUR DEF and PATTERN DEF define the contours and points that cycles machine.
"""

from __future__ import annotations

import re

from core.language.formulas import Parameter
from core.language.klartext import q_parameters
from core.language.klartext.klartext_faults import CONTOUR_FORMULAS, make_unsupported_error
from core.language.klartext.klartext_nodes import (
    ContourDefinition,
    ContourPart,
    CoordinateTransform,
    CycleCall,
    CycleDefinition,
    CycleLine,
    CycleParameter,
    DatumShift,
    GlobalDefinition,
    Node,
    PatternDefinition,
    PatternPart,
)
from core.language.klartext.klartext_words import AxisWord, FeedWord
from core.language.klartext.line_cursor import LineCursor, read_axis_words, read_feed, read_words_by_name
from core.language.klartext.path_block import ROTATION_PATTERN, read_remaining_m_functions
from core.message import Message

_NUMBER = re.compile(r"([0-9]{1,3})(?:\s*\.([0-9]{1,2}))?(?![0-9.])")
_TEXT_VALUE = re.compile(r"QS\s*[0-9]+\s*=")
_Q_VALUE = re.compile(r"Q\s*[0-9]+\s*=")
_NEW = 200  # cycles from this number on have Q parameters
_CONTOUR_CYCLES = frozenset(range(20, 30)) | {39}  # contour cycles, which also have Q parameters
_TEXT_CYCLES = frozenset({12, 14})  # cycles whose lines name a program or labels
_PRESET, _PRESET_NUMBER = 247, 339
PREDEFINED_WORD = "PREDEF"
"""Value of a cycle parameter that GLOBAL DEF defines."""
_DATUM, _MIRROR, _ROTATION, _SCALE = 7, 8, 10, 11


def read_cycle_definition(cursor: LineCursor, column: int) -> Node:
    """Read the block after ``CYCL DEF``.

    Whether TurnDesk supports the cycle is checked only when the cycle is called. Raises ProgramError for a
    syntax error and for a string parameter (QS).
    """
    match = cursor.match_pattern(_NUMBER)
    if match is None:
        raise cursor.make_expected_error("CYCL DEF needs a cycle number")
    number, part = int(match.group(1)), match.group(2)
    if number >= _NEW or (number in _CONTOUR_CYCLES and part in {None, "0"}):
        return CycleDefinition(number, _values(cursor, Message("CYCL DEF {number}", number=number)), column)
    if part is None:
        raise cursor.make_expected_error(
            Message("CYCL DEF {number} needs a decimal point and a line number", number=number),
            Message("Write CYCL DEF {number}.0.", number=number),
        )
    if number == _DATUM:
        return _datum(cursor, int(part))
    if number in {_MIRROR, _ROTATION, _SCALE} and int(part) > 0:
        return _transform(cursor, number, column)
    return _line(cursor, number, int(part), column)


def call(cursor: LineCursor, column: int) -> CycleCall:
    """Read the block after ``CYCL CALL``. Raises ProgramError for a syntax error."""
    if cursor.read_keyword("PAT"):
        speed = read_feed(cursor)
        return CycleCall((), speed, read_remaining_m_functions(cursor), column, is_pattern_call=True)
    if not cursor.read_keyword("POS"):
        return CycleCall(m_functions=read_remaining_m_functions(cursor), column=column)
    axes = read_axis_words(cursor, "XYZ")
    return CycleCall(axes, read_feed(cursor), read_remaining_m_functions(cursor), column)


_SELECTED = re.compile(r"#")


def read_global_definition(cursor: LineCursor, column: int) -> GlobalDefinition:
    """Read the block after ``GLOBAL DEF``.

    The block consists of a group number, which has no effect, and the parameters.
    """
    match = cursor.match_pattern(_NUMBER)
    if match is None:
        raise cursor.make_expected_error("GLOBAL DEF needs a number")
    return GlobalDefinition(_values(cursor, Message("GLOBAL DEF {word}", word=match.group(1))), column)


def read_preset_selection(cursor: LineCursor, column: int) -> CycleDefinition:
    """Read ``PRESET SELECT #3``, which is cycle 247. Raises ProgramError for other options."""
    if cursor.match_pattern(_SELECTED) is None:
        raise make_unsupported_error(cursor.line_number, column, "PRESET SELECT with a name")
    at, row = cursor.column, cursor.read_value("#")
    if not cursor.is_at_end:
        raise make_unsupported_error(
            cursor.line_number,
            cursor.column,
            Message("PRESET SELECT with {rest}", rest=cursor.read_remaining_text()),
        )
    return CycleDefinition(_PRESET, (CycleParameter(_PRESET_NUMBER, row.as_formula, at),), column)


def _values(cursor: LineCursor, owner: str) -> tuple[CycleParameter, ...]:
    """Skip the cycle name, which has no effect, and read the Q parameters that follow the name."""
    if text := _TEXT_VALUE.search(cursor.uppercase_text, cursor.index):
        raise make_unsupported_error(
            cursor.line_number, text.start() + 1, Message("{total} with a string parameter (QS)", total=owner)
        )
    first = _Q_VALUE.search(cursor.uppercase_text, cursor.index)
    if first is None:
        cursor.read_remaining_text()
        return ()
    cursor.index = first.start()
    found = []
    while not cursor.is_at_end:
        column = cursor.column
        if not _Q_VALUE.match(cursor.uppercase_text, cursor.index):
            raise cursor.make_expected_error(
                "Expected a Q parameter of the cycle", "Write parameters such as Q200=+2."
            )
        _, number = q_parameters.read_parameter(cursor)
        cursor.match_pattern(re.compile(r"="))
        if cursor.read_keyword(PREDEFINED_WORD):
            found.append(CycleParameter(number, Parameter(PREDEFINED_WORD, number, column), column))
        else:
            found.append(CycleParameter(number, q_parameters.read_full_formula(cursor, f"Q{number}"), column))
    return tuple(found)


_FROM_TABLE = re.compile(r"#")


def _datum(cursor: LineCursor, part: int) -> DatumShift:
    if part == 0:
        return DatumShift(cycle_number=0, text=cursor.read_remaining_text())
    column = cursor.column
    if cursor.match_pattern(_FROM_TABLE):
        made = DatumShift(cycle_number=part, table_row=cursor.read_value("#"), column=column)
        cursor.check_at_end("Unexpected word in cycle 7")
        return made
    axes = read_axis_words(cursor, "XYZABC")
    if not axes:
        raise cursor.make_expected_error(Message("CYCL DEF 7.{part} needs a value for X, Y or Z", part=part))
    cursor.check_at_end("Unexpected word in cycle 7")
    return DatumShift(axes, cycle_number=part)


_LETTERS = re.compile(r"[XYZ](?![A-Z0-9])")
_ROT = re.compile(r"(I?)ROT(?![A-Z])")
_SCL = re.compile(r"SCL(?![A-Z])")


def _transform(cursor: LineCursor, number: int, column: int) -> CoordinateTransform:
    """Read a line of cycle 8, 10 or 11, such as ``8.1 X Y`` or ``10.1 ROT+35``."""
    if number == _MIRROR:
        return CoordinateTransform("MIRROR", mirrored_axes=read_mirrored_axes(cursor), column=column)
    if number == _ROTATION:
        return read_rotation(cursor, column)
    return read_scale(cursor, column)


def read_mirrored_axes(cursor: LineCursor) -> str:
    """Read the letters of the mirrored axes up to the end of the line.

    An empty result cancels mirroring.
    """
    axes = ""
    while match := cursor.match_pattern(_LETTERS):
        axes += match.group()
    cursor.check_at_end("Mirroring accepts only the axes X, Y and Z")
    return axes


def read_rotation(cursor: LineCursor, column: int) -> CoordinateTransform:
    """Read ``ROT+35`` or ``IROT+5``. Raises ProgramError for a syntax error."""
    match = cursor.match_pattern(_ROT)
    if match is None:
        raise cursor.make_expected_error("A rotation needs ROT and an angle")
    made = CoordinateTransform(
        "ROTATION", cursor.read_value("ROT"), is_incremental=bool(match.group(1)), column=column
    )
    cursor.check_at_end("Unexpected word in a rotation")
    return made


def read_scale(cursor: LineCursor, column: int) -> CoordinateTransform:
    """Read ``SCL0.95``. Raises ProgramError for a syntax error."""
    if cursor.match_pattern(_SCL) is None:
        raise cursor.make_expected_error("Scaling needs SCL and its factor")
    made = CoordinateTransform("SCALE", cursor.read_value("SCL"), column=column)
    cursor.check_at_end("Unexpected word in scaling")
    return made


_AXIS = re.compile(r"(I?[XYZABC]|RADIUS|R)(?=\s*[+\-0-9.,Q])")
_PLAIN = re.compile(r"(?=[+-]?\s*(?:[0-9.]|Q[LR]?\s*[0-9]))")
_TEXT = re.compile(r"[^\s+\-0-9]+|[+-](?!\s*[0-9.Q])")


def _line(cursor: LineCursor, number: int, part: int, column: int) -> CycleLine:
    """Read one line of a cycle numbered below 200.

    In these cycles, the order of the numbers determines their meaning.
    """
    words: list[AxisWord] = []
    text: list[str] = []
    speed: FeedWord | None = None
    turn = ""
    if part == 0 or number in _TEXT_CYCLES:
        return CycleLine(number, part, text=cursor.read_remaining_text(), column=column)
    while not cursor.is_at_end:
        at = cursor.column
        if match := cursor.match_pattern(_AXIS):
            words.append(
                AxisWord(
                    "R" if match.group(1)[0] == "R" else match.group(1)[-1],
                    cursor.read_value("It"),
                    match.group(1)[0] == "I",
                    at,
                )
            )
        elif match := cursor.match_pattern(ROTATION_PATTERN):
            turn = match.group(1)
        elif read := _feed(cursor):
            speed = read
        elif _PLAIN.match(cursor.uppercase_text, cursor.index):
            words.append(AxisWord("", cursor.read_value("It"), column=at))
        elif match := cursor.match_pattern(_TEXT):
            text.append(match.group())
        else:
            raise cursor.make_expected_error(Message("Unexpected word in cycle {number}", number=number))
    return CycleLine(number, part, tuple(words), speed, turn, " ".join(text), column)


_FEED = re.compile(r"F(?=\s*(?:[0-9.,Q]|MAX|AUTO))")


def _feed(cursor: LineCursor) -> FeedWord | None:
    return read_feed(cursor) if _FEED.match(cursor.uppercase_text, cursor.index) else None


_LABEL = re.compile(r'/?\s*(?:([0-9]+)|"([^"]*)")\s*')


def parse_contour_labels(text: str) -> tuple[int | str, ...]:
    """Return the labels in a line of cycle 14, without the text that precedes them."""
    first = re.search(r'[0-9"]', text)
    return tuple(
        int(match.group(1)) if match.group(1) else match.group(2)
        for match in _LABEL.finditer(text[first.start() :] if first else "")
    )


_CONTOUR = re.compile(r"([PI])\s*[0-9]+\s*=?\s*")
_DEPTH = re.compile(r"DEPTH|V(?=[0-9])")
_QC = re.compile(r"QC\s*[0-9]")


def read_contour_definition(cursor: LineCursor, column: int) -> ContourDefinition:
    """Read the block after ``CONTOUR DEF``, such as ``P1 = LBL 1 I2 = "ISLE.H"``.

    Raises ProgramError for a syntax error, for a contour formula (QC), and for contours with separate
    depths.
    """
    parts: list[ContourPart] = []
    while not cursor.is_at_end:
        match = cursor.match_pattern(_CONTOUR)
        if match is None:
            if cursor.read_keyword("VOID") or cursor.match_pattern(_DEPTH):
                raise make_unsupported_error(
                    cursor.line_number, cursor.column, "CONTOUR DEF with a separate depth for one contour"
                )
            raise cursor.make_expected_error(
                "CONTOUR DEF accepts only pockets (P) and islands (I)",
                "Write, for example, P1 = LBL 1 I2 = LBL 2.",
            )
        parts.append(_contour_source(cursor)._replace(is_pocket=match.group(1) == "P"))
    if not parts:
        raise cursor.make_expected_error(
            "CONTOUR DEF does not name a contour", "Write, for example, P1 = LBL 1."
        )
    return ContourDefinition(tuple(parts), column)


def _contour_source(cursor: LineCursor) -> ContourPart:
    """Read the source of a contour, which is a subprogram label or a separate program."""
    if cursor.read_keyword("LBL"):
        return ContourPart(cursor.read_name("LBL", q_parameters.MAX_LABEL_NUMBER), None)
    if file := cursor.read_quoted_text():
        return ContourPart(0, None, file)
    if _QC.match(cursor.uppercase_text, cursor.index):
        raise CONTOUR_FORMULAS.make_error(cursor.line_number, cursor.column)
    raise cursor.make_expected_error("Expected a contour: LBL n, or a program name in quotes")


_KIND = re.compile(r"(PITCHCIRC|CIRC|FRAME|PAT|ROW|POS)\s*[0-9]{1,2}\s*\(")
_WORD = re.compile(r"(NUMX|NUMY|NUM|ROTX|ROTY|ROT|START|STEP|DX|DY|D|X|Y|Z)(?=\s*[+\-0-9.,Q])")
_CLOSED = re.compile(r"\)")
_GRID = ("X", "Y", "DX", "DY", "NUMX", "NUMY")
REQUIRED_PATTERN_WORDS = {
    "POS": ("X", "Y"),
    "ROW": ("X", "Y", "D", "NUM"),
    "PAT": _GRID,
    "FRAME": _GRID,
    "CIRC": ("X", "Y", "D", "NUM"),
    "PITCHCIRC": ("X", "Y", "D", "STEP", "NUM"),
}
"""Words that each pattern form requires."""


def read_pattern_definition(cursor: LineCursor, column: int) -> PatternDefinition:
    """Read the block after ``PATTERN DEF``. Raises ProgramError if a word is missing, unknown or repeated."""
    parts = []
    while not cursor.is_at_end:
        at, match = cursor.column, cursor.match_pattern(_KIND)
        if match is None:
            raise cursor.make_expected_error(
                "PATTERN DEF accepts only POS1 (…), ROW1, PAT1, FRAME1, CIRC1 or PITCHCIRC1"
            )
        parts.append(PatternPart(match.group(1), _words(cursor, match.group(1)), at))
    if not parts:
        raise cursor.make_expected_error(
            "PATTERN DEF has no points", "After PATTERN DEF, write, for example, POS1 (X+0 Y+0 Z+0)."
        )
    return PatternDefinition(tuple(parts), column)


def _words(cursor: LineCursor, form: str) -> tuple[AxisWord, ...]:
    found = read_words_by_name(cursor, _WORD)
    if not cursor.match_pattern(_CLOSED):
        raise cursor.make_expected_error(
            Message("Unexpected word in {form}", form=form), "Close the parenthesis after the last word."
        )
    missing = [name for name in REQUIRED_PATTERN_WORDS[form] if name not in found]
    if missing:
        raise cursor.make_expected_error(
            Message("{form} needs {missing}", form=form, missing=" and ".join(missing))
        )
    return tuple(found.values())
