"""Readers of CYCL DEF, CYCL CALL, CONTOUR DEF and PATTERN DEF.

Cycles from 200 on have Q parameters. Older cycles have numbered lines. Contours and machining points are the
data that cycles use.
"""

from __future__ import annotations

import re

from core.language.formulas import Parameter
from core.language.klartext import q_parameters
from core.language.klartext.klartext_faults import CONTOUR_FORMULA, unsupported
from core.language.klartext.klartext_nodes import (
    AxisWord,
    ContourDef,
    ContourPart,
    Cycle,
    CycleCall,
    CycleLine,
    CycleValue,
    Datum,
    Feed,
    GlobalDef,
    Node,
    PatternDef,
    PatternPart,
    Transform,
)
from core.language.klartext.line_cursor import Cursor, axis_words, feed, words_once
from core.language.klartext.path_block import TURN, codes_to_the_end
from core.message import Message

_NUMBER = re.compile(r"([0-9]{1,3})(?:\s*\.([0-9]{1,2}))?(?![0-9.])")
_TEXT_VALUE = re.compile(r"QS\s*[0-9]+\s*=")
_Q_VALUE = re.compile(r"Q\s*[0-9]+\s*=")
_NEW = 200  # cycles from this number on have Q parameters
_OF_CONTOURS = frozenset(range(20, 30)) | {39}  # contour cycles, which also have Q parameters
_BY_TEXT = frozenset({12, 14})  # cycles whose lines name a program or labels
_PRESET, _PRESET_NUMBER = 247, 339
PREDEFINED = "PREDEF"
"""What a parameter of a cycle holds that GLOBAL DEF has told."""
_DATUM, _MIRROR, _ROTATION, _SCALE = 7, 8, 10, 11


def cycle(cursor: Cursor, column: int) -> Node:
    """Read the block after ``CYCL DEF``. Raises ProgramError for a syntax error.

    Whether the control supports the cycle is checked when the cycle is called.
    """
    match = cursor.take(_NUMBER)
    if match is None:
        raise cursor.expected("CYCL DEF needs a cycle number")
    number, part = int(match.group(1)), match.group(2)
    if number >= _NEW or (number in _OF_CONTOURS and part in {None, "0"}):
        return Cycle(number, _values(cursor, Message("CYCL DEF {number}", number=number)), column)
    if part is None:
        raise cursor.expected(
            Message("CYCL DEF {number} needs a decimal point and a line number", number=number),
            Message("Write CYCL DEF {number}.0.", number=number),
        )
    if number == _DATUM:
        return _datum(cursor, int(part))
    if number in {_MIRROR, _ROTATION, _SCALE} and int(part) > 0:
        return _transform(cursor, number, column)
    return _line(cursor, number, int(part), column)


def call(cursor: Cursor, column: int) -> CycleCall:
    """Read the block after ``CYCL CALL``. Raises ProgramError for a syntax error."""
    if cursor.keyword("PAT"):
        speed = feed(cursor)
        return CycleCall((), speed, codes_to_the_end(cursor), column, pattern=True)
    if not cursor.keyword("POS"):
        return CycleCall(codes=codes_to_the_end(cursor), column=column)
    axes = axis_words(cursor, "XYZ")
    return CycleCall(axes, feed(cursor), codes_to_the_end(cursor), column)


_SELECTED = re.compile(r"#")


def global_definition(cursor: Cursor, column: int) -> GlobalDef:
    """Read the block after ``GLOBAL DEF``: a group number without effect, and the parameters."""
    match = cursor.take(_NUMBER)
    if match is None:
        raise cursor.expected("GLOBAL DEF needs a number")
    return GlobalDef(_values(cursor, Message("GLOBAL DEF {word}", word=match.group(1))), column)


def preset(cursor: Cursor, column: int) -> Cycle:
    """Read ``PRESET SELECT #3``, which is cycle 247. Raises ProgramError for other options."""
    if cursor.take(_SELECTED) is None:
        raise unsupported(cursor.line, column, "PRESET SELECT with a name")
    at, row = cursor.column, cursor.value("#")
    if not cursor.done:
        raise unsupported(
            cursor.line, cursor.column, Message("PRESET SELECT with {rest}", rest=cursor.rest())
        )
    return Cycle(_PRESET, (CycleValue(_PRESET_NUMBER, row.formula, at),), column)


def _values(cursor: Cursor, of: str) -> tuple[CycleValue, ...]:
    """Read the Q parameters that follow the cycle name. The name itself has no effect."""
    if text := _TEXT_VALUE.search(cursor.upper, cursor.at):
        raise unsupported(
            cursor.line, text.start() + 1, Message("{total} with a string parameter (QS)", total=of)
        )
    first = _Q_VALUE.search(cursor.upper, cursor.at)
    if first is None:
        cursor.rest()
        return ()
    cursor.at = first.start()
    found = []
    while not cursor.done:
        column = cursor.column
        if not _Q_VALUE.match(cursor.upper, cursor.at):
            raise cursor.expected("Expected a Q parameter of the cycle", "Write parameters such as Q200=+2.")
        _, number = q_parameters.parameter(cursor)
        cursor.take(re.compile(r"="))
        if cursor.keyword(PREDEFINED):
            found.append(CycleValue(number, Parameter(PREDEFINED, number, column), column))
        else:
            found.append(CycleValue(number, q_parameters.formula(cursor, f"Q{number}"), column))
    return tuple(found)


_FROM_TABLE = re.compile(r"#")


def _datum(cursor: Cursor, part: int) -> Datum:
    if part == 0:
        return Datum(cycle=0, text=cursor.rest())
    column = cursor.column
    if cursor.take(_FROM_TABLE):
        made = Datum(cycle=part, row=cursor.value("#"), column=column)
        cursor.demand_end("Unexpected word in cycle 7")
        return made
    axes = axis_words(cursor, "XYZABC")
    if not axes:
        raise cursor.expected(Message("CYCL DEF 7.{part} needs a value for X, Y or Z", part=part))
    cursor.demand_end("Unexpected word in cycle 7")
    return Datum(axes, cycle=part)


_LETTERS = re.compile(r"[XYZ](?![A-Z0-9])")
_ROT = re.compile(r"(I?)ROT(?![A-Z])")
_SCL = re.compile(r"SCL(?![A-Z])")


def _transform(cursor: Cursor, number: int, column: int) -> Transform:
    """Read a line of the cycles 8, 10 and 11, such as ``8.1 X Y`` or ``10.1 ROT+35``."""
    if number == _MIRROR:
        return Transform("MIRROR", axes=mirrored_axes(cursor), column=column)
    if number == _ROTATION:
        return rotation(cursor, column)
    return scale(cursor, column)


def mirrored_axes(cursor: Cursor) -> str:
    """Read the letters of mirrored axes to the end of the line. An empty result cancels mirroring."""
    axes = ""
    while match := cursor.take(_LETTERS):
        axes += match.group()
    cursor.demand_end("Mirroring accepts only the axes X, Y and Z")
    return axes


def rotation(cursor: Cursor, column: int) -> Transform:
    """Read ``ROT+35`` or ``IROT+5``. Raises ProgramError for a syntax error."""
    match = cursor.take(_ROT)
    if match is None:
        raise cursor.expected("A rotation needs ROT and an angle")
    made = Transform("ROTATION", cursor.value("ROT"), incremental=bool(match.group(1)), column=column)
    cursor.demand_end("Unexpected word in a rotation")
    return made


def scale(cursor: Cursor, column: int) -> Transform:
    """Read ``SCL0.95``. Raises ProgramError for a syntax error."""
    if cursor.take(_SCL) is None:
        raise cursor.expected("Scaling needs SCL and its factor")
    made = Transform("SCALE", cursor.value("SCL"), column=column)
    cursor.demand_end("Unexpected word in scaling")
    return made


_AXIS = re.compile(r"(I?[XYZABC]|RADIUS|R)(?=\s*[+\-0-9.,Q])")
_PLAIN = re.compile(r"(?=[+-]?\s*(?:[0-9.]|Q[LR]?\s*[0-9]))")
_TEXT = re.compile(r"[^\s+\-0-9]+|[+-](?!\s*[0-9.Q])")


def _line(cursor: Cursor, number: int, part: int, column: int) -> CycleLine:
    """Read one line of a cycle below 200, in which the order of the numbers determines their meaning."""
    words: list[AxisWord] = []
    text: list[str] = []
    speed: Feed | None = None
    turn = ""
    if part == 0 or number in _BY_TEXT:
        return CycleLine(number, part, text=cursor.rest(), column=column)
    while not cursor.done:
        at = cursor.column
        if match := cursor.take(_AXIS):
            words.append(
                AxisWord(
                    "R" if match.group(1)[0] == "R" else match.group(1)[-1],
                    cursor.value("It"),
                    match.group(1)[0] == "I",
                    at,
                )
            )
        elif match := cursor.take(TURN):
            turn = match.group(1)
        elif read := _feed(cursor):
            speed = read
        elif _PLAIN.match(cursor.upper, cursor.at):
            words.append(AxisWord("", cursor.value("It"), column=at))
        elif match := cursor.take(_TEXT):
            text.append(match.group())
        else:
            raise cursor.expected(Message("Unexpected word in cycle {number}", number=number))
    return CycleLine(number, part, tuple(words), speed, turn, " ".join(text), column)


_FEED = re.compile(r"F(?=\s*(?:[0-9.,Q]|MAX|AUTO))")


def _feed(cursor: Cursor) -> Feed | None:
    return feed(cursor) if _FEED.match(cursor.upper, cursor.at) else None


_LABEL = re.compile(r'/?\s*(?:([0-9]+)|"([^"]*)")\s*')


def contour_labels(text: str) -> tuple[int | str, ...]:
    """Return the labels in a line of cycle 14, without the text that precedes them."""
    first = re.search(r'[0-9"]', text)
    return tuple(
        int(match.group(1)) if match.group(1) else match.group(2)
        for match in _LABEL.finditer(text[first.start() :] if first else "")
    )


_CONTOUR = re.compile(r"([PI])\s*[0-9]+\s*=?\s*")
_DEPTH = re.compile(r"DEPTH|V(?=[0-9])")
_QC = re.compile(r"QC\s*[0-9]")


def contour_definition(cursor: Cursor, column: int) -> ContourDef:
    """Read the block after ``CONTOUR DEF``, such as ``P1 = LBL 1 I2 = "ISLE.H"``.

    Raises ProgramError for a syntax error and for contours with separate depths.
    """
    parts: list[ContourPart] = []
    while not cursor.done:
        match = cursor.take(_CONTOUR)
        if match is None:
            if cursor.keyword("VOID") or cursor.take(_DEPTH):
                raise unsupported(
                    cursor.line, cursor.column, "CONTOUR DEF with a separate depth for one contour"
                )
            raise cursor.expected(
                "CONTOUR DEF accepts only pockets (P) and islands (I)",
                "Write, for example, P1 = LBL 1 I2 = LBL 2.",
            )
        parts.append(_where(cursor)._replace(pocket=match.group(1) == "P"))
    if not parts:
        raise cursor.expected("CONTOUR DEF does not name a contour", "Write, for example, P1 = LBL 1.")
    return ContourDef(tuple(parts), column)


def _where(cursor: Cursor) -> ContourPart:
    """Read the source of a contour: a subprogram label or a separate program."""
    if cursor.keyword("LBL"):
        return ContourPart(cursor.name("LBL", q_parameters.MOST_LABEL), None)
    if file := cursor.quoted():
        return ContourPart(0, None, file)
    if _QC.match(cursor.upper, cursor.at):
        raise CONTOUR_FORMULA.error(cursor.line, cursor.column)
    raise cursor.expected("Expected a contour: LBL n, or a program name in quotes")


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
    """Read the block after ``PATTERN DEF``. Raises ProgramError if a word is missing, unknown or repeated."""
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
