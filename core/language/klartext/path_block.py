"""Readers of the path functions L, C, CR, CT, LP, CP, CTP, CC, RND, CHF, APPR and DEP, and of M functions."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import syntax
from core.language.klartext.klartext_nodes import AxisWord, Codes, Corner, Feed, MCode, Move, Pole
from core.language.klartext.line_cursor import Cursor, axis_words, demand_once, doubled, feed, retract
from core.message import Message

MOST_CODES = 4
AXES = "XYZABCUVW"
# older controls write R, F and M without values
_NOT_PROGRAMMED = re.compile(r"F(?=\s+M\s*(?:[0-9]|$))|M(?=\s*$)")
_COMPENSATION = re.compile(
    r"R(?:([0LR]?)(?![A-Z0-9]|\s*[+\-.,0-9])|([+-])(?!\s*[0-9.,Q]))"
)  # R without a letter leaves the compensation unchanged
_M = re.compile(r"M(?=\s*[0-9])")
_AXIS_ALONE = re.compile(r"I?[XYZABCUVW](?=\s*$)")
TURN = re.compile(r"DR\s*([+-])(?![0-9Q])")


class _Form(NamedTuple):
    """Words of a path function other than axes, compensation, feed and M functions.

    The words ``needs`` are required.
    """

    takes: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    turn: bool = False  # DR is required


_POLAR = ("PR", "PA")
_FORMS = {
    "L": _Form(),
    "LP": _Form(_POLAR),
    "C": _Form(turn=True),
    "CR": _Form(("R",), ("R",), turn=True),
    "CT": _Form(),
    "LN": _Form(("NX", "NY", "NZ", "TX", "TY", "TZ")),
    "CP": _Form(("PA",), turn=True),
    "CTP": _Form(_POLAR),
    "APPR LT": _Form(("LEN",), ("LEN",)),
    "APPR LN": _Form(("LEN",), ("LEN",)),
    "APPR CT": _Form(("CCA", "R"), ("CCA", "R")),
    "APPR LCT": _Form(("R",), ("R",)),
    "APPR PLT": _Form((*_POLAR, "LEN"), ("LEN",)),
    "APPR PLN": _Form((*_POLAR, "LEN"), ("LEN",)),
    "APPR PCT": _Form((*_POLAR, "CCA", "R"), ("CCA", "R")),
    "APPR PLCT": _Form((*_POLAR, "R"), ("R",)),
    "DEP LT": _Form(("LEN",), ("LEN",)),
    "DEP LN": _Form(("LEN",), ("LEN",)),
    "DEP CT": _Form(("CCA", "R"), ("CCA", "R")),
    "DEP LCT": _Form(("R",), ("R",)),
    "DEP PLCT": _Form((*_POLAR, "R"), ("R",)),
}
FORMS = tuple(_FORMS)
"""Every path function by the words that it begins with."""

_KNOWN_WORDS = re.compile(r"(I?P[RA]|LEN|CCA|[NT][XYZ]|R)(?=\s*[+\-0-9.,Q])")


def move(cursor: Cursor, form: str, column: int) -> Move:
    """Read the words of a path function. Raises ProgramError for an unexpected or missing word."""
    axes: tuple[AxisWord, ...] = ()
    words: dict[str, AxisWord] = {}
    compensation, turn, speed = "", "", None
    codes: list[MCode] = []
    while not cursor.done:
        at = cursor.column
        found = axis_words(cursor, AXES)
        if found:
            axes = _joined(cursor, axes, found)
        elif radius := cursor.take(_COMPENSATION):
            kind = radius.group(1) or radius.group(2) or ""
            _demand_paraxial(cursor, at, kind, axes)
            if compensation:
                raise doubled(cursor, at, f"R{kind}")
            compensation = kind
        elif direction := cursor.take(TURN):
            demand_once(cursor, at, turn, "DR")
            turn = direction.group(1)
        elif word := _word(cursor, form):
            demand_once(cursor, word.column, word.axis in words, word.axis)
            words[word.axis] = word
        elif cursor.take(_NOT_PROGRAMMED):
            continue
        elif read := feed(cursor):
            demand_once(cursor, read.column, speed, "F")
            speed = read
        elif code := m_code(cursor):
            codes.append(code)
            _demand_few(cursor, codes)
        else:
            raise _strange(cursor, form)
    made = Move(axes, compensation, speed, tuple(codes), form, tuple(words.values()), turn, column)
    _demand_whole(cursor, made)
    return made


def paraxial(cursor: Cursor, column: int) -> Move:
    """Read a block with one axis and without L, such as ``Z+100 R0 FMAX M3``. Raises ProgramError."""
    made = move(cursor, "L", column)
    if len(made.axes) > 1:
        text = "A block without L can move only one axis."
        raise syntax(cursor.line, made.axes[1].column, text, "Write L at the start of the block.")
    return made


def _demand_paraxial(cursor: Cursor, column: int, kind: str, axes: tuple[AxisWord, ...]) -> None:
    """Raise ProgramError if a block with R+ or R- does not have exactly one axis.

    R+ and R- change the length of a move along one axis by the tool radius.
    """
    if kind in {"+", "-"} and len(axes) != 1:
        text = Message("R{kind} is allowed only in a block that moves one axis.", kind=kind)
        raise syntax(cursor.line, column, text, "For a contour, write RL or RR.")


def _word(cursor: Cursor, form: str) -> AxisWord | None:
    at, match = cursor.at, _KNOWN_WORDS.match(cursor.upper, cursor.at)
    if match is None or match.group(1).removeprefix("I") not in _FORMS[form].takes:
        return None
    cursor.take(_KNOWN_WORDS)
    name = match.group(1).removeprefix("I")
    return AxisWord(name, cursor.value(match.group(1)), match.group(1)[0] == "I", at + 1)


def _demand_whole(cursor: Cursor, made: Move) -> None:
    form = _FORMS[made.form]
    missing = [name for name in form.needs if made.word(name) is None]
    if missing:
        raise cursor.expected(
            Message("{form} needs {missing}", form=made.form, missing=" and ".join(missing))
        )
    if made.turn and not form.turn and made.form not in {"CT", "CTP"}:
        raise syntax(
            cursor.line,
            made.column,
            Message("{form} does not accept DR.", form=made.form),
            "Remove this text from the program.",
        )


def pole(cursor: Cursor, column: int) -> Pole:
    """Read the axes after ``CC``."""
    made = Pole(axis_words(cursor, "XYZ"), column)
    cursor.demand_end("CC accepts only two axes")
    return made


_SIZE = re.compile(r"R(?=\s*[+\-0-9.,Q])")


def corner(cursor: Cursor, form: str, column: int) -> Corner:
    """Read the size and optional feed after ``RND`` or ``CHF``."""
    cursor.take(_SIZE)
    size = cursor.value(form)
    speed = feed(cursor)
    cursor.demand_end(Message("{form} accepts only a radius or length, and a feed rate", form=form))
    return Corner(form, size, speed, column)


def codes_alone(cursor: Cursor) -> Codes:
    """Read a block of M functions."""
    return Codes(codes_to_the_end(cursor))


def codes_to_the_end(cursor: Cursor) -> tuple[MCode, ...]:
    """Read M functions to the end of the line. Raises ProgramError for any other word."""
    codes: list[MCode] = []
    while not cursor.done:
        code = m_code(cursor)
        if code is None:
            raise cursor.expected("Expected an M function")
        codes.append(code)
        _demand_few(cursor, codes)
    return tuple(codes)


_WITH_WORDS = {
    94: re.compile(r"[ABC](?![A-Z0-9+\-])"),
    120: re.compile(r"LA\s*[0-9]+"),
    118: re.compile(r"(?:[XYZABC]\s*[0-9.,]+\s*)+"),
}


def m_code(cursor: Cursor) -> MCode | None:
    """Read one M function; return None if the cursor is not at an M function."""
    column = cursor.column
    if cursor.take(_M) is None:
        return None
    number = cursor.whole("M", 999)
    if number == 128:
        return MCode(number, column, feed=_plain_feed(cursor))
    if number == 103:
        return MCode(number, column, feed=_factor(cursor))
    if number == 140:
        way = retract(cursor)
        if way is None:
            raise cursor.expected("M140 needs MB", "Write MB and a length, or MB MAX.")
        return MCode(number, column, way, feed(cursor))
    if number in _WITH_WORDS:
        cursor.take(_WITH_WORDS[number])
    return MCode(number, column)


def _factor(cursor: Cursor) -> Feed | None:
    """Read the factor of M103, in percent and written as F; without it, M103 is canceled."""
    found = feed(cursor)
    if found is not None and (found.kind != "value" or found.per):
        text = "M103 accepts its factor only as F with a number."
        raise syntax(cursor.line, found.column, text, "Write M103 F20 for a fifth of the feed.")
    return found


def _plain_feed(cursor: Cursor) -> Feed | None:
    found = feed(cursor)
    if found is not None and (found.kind == "auto" or found.per):
        raise syntax(
            cursor.line, found.column, "M128 accepts only a numeric feed or FMAX.", "Write F and a number."
        )
    return found


def _joined(cursor: Cursor, axes: tuple[AxisWord, ...], words: tuple[AxisWord, ...]) -> tuple[AxisWord, ...]:
    for word in words:
        if any(word.axis == known.axis for known in axes):
            raise doubled(cursor, word.column, word.axis)
    return axes + words


def _demand_few(cursor: Cursor, codes: list[MCode]) -> None:
    if len(codes) > MOST_CODES:
        text = Message("There are more than {most_codes} M functions in the block.", most_codes=MOST_CODES)
        raise syntax(cursor.line, codes[-1].column, text, "Split the block into two or more blocks.")


def _strange(cursor: Cursor, form: str) -> ProgramError:
    if cursor.take(_AXIS_ALONE):
        return cursor.expected("No value is programmed for the axis", "Write a number such as +10.")
    takes = ", ".join(("axes", *_FORMS[form].takes, *(("DR",) if _FORMS[form].turn else ())))
    return cursor.expected(
        Message("Unexpected word in this {form} block", form=form),
        Message("Use only {takes}, R0, RL or RR, a feed and M functions.", takes=takes),
    )
