"""Parsers of the path functions L, C, CR, CT, LP, CP, CTP, CC, RND, CHF, APPR and DEP, and of M functions."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.diagnostics import ProgramError
from core.language.klartext.klartext_faults import make_syntax_error
from core.language.klartext.klartext_nodes import CornerBlock, MFunctionBlock, PathFunction, Pole
from core.language.klartext.klartext_words import AxisWord, FeedWord, MFunction
from core.language.klartext.line_cursor import (
    LineCursor,
    check_word_not_repeated,
    make_repeated_word_error,
    read_axis_words,
    read_feed,
    read_retract,
)
from core.message import Message

MAX_M_FUNCTION_COUNT = 4
AXIS_LETTERS = "XYZABCUVW"
# older controls write R, F and M without values
_NOT_PROGRAMMED = re.compile(r"F(?=\s+M\s*(?:[0-9]|$))|M(?=\s*$)")
_COMPENSATION = re.compile(
    r"R(?:([0LR]?)(?![A-Z0-9]|\s*[+\-.,0-9])|([+-])(?!\s*[0-9.,Q]))"
)  # R without a letter leaves the compensation unchanged
_M = re.compile(r"M(?=\s*[0-9])")
_SINGLE_AXIS = re.compile(r"I?[XYZABCUVW](?=\s*$)")
ROTATION_PATTERN = re.compile(r"DR\s*([+-])(?![0-9Q])")


class _Form(NamedTuple):
    """The words that a path function allows in addition to axes, compensation, feed and M functions.

    ``required_words`` are the words that must not be missing.
    """

    allowed_words: tuple[str, ...] = ()
    required_words: tuple[str, ...] = ()
    needs_direction: bool = False  # DR is required


_POLAR = ("PR", "PA")
_FORMS = {
    "L": _Form(),
    "LP": _Form(_POLAR),
    "C": _Form(needs_direction=True),
    "CR": _Form(("R",), ("R",), needs_direction=True),
    "CT": _Form(),
    "LN": _Form(("NX", "NY", "NZ", "TX", "TY", "TZ")),
    "CP": _Form(("PA",), needs_direction=True),
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
PATH_FORMS = tuple(_FORMS)
"""All path functions, each as the words at the start of its line."""

_KNOWN_WORDS = re.compile(r"(I?P[RA]|LEN|CCA|[NT][XYZ]|R)(?=\s*[+\-0-9.,Q])")


def read_path_function(cursor: LineCursor, form: str, column: int) -> PathFunction:
    """Read the words of a path function.

    Raises ProgramError for an unexpected, missing or repeated word.
    """
    axes: tuple[AxisWord, ...] = ()
    words: dict[str, AxisWord] = {}
    compensation, turn, speed = "", "", None
    codes: list[MFunction] = []
    while not cursor.is_at_end:
        at = cursor.column
        found = read_axis_words(cursor, AXIS_LETTERS)
        if found:
            axes = _joined(cursor, axes, found)
        elif radius := cursor.match_pattern(_COMPENSATION):
            kind = radius.group(1) or radius.group(2) or ""
            _check_paraxial(cursor, at, kind, axes)
            if compensation:
                raise make_repeated_word_error(cursor, at, f"R{kind}")
            compensation = kind
        elif direction := cursor.match_pattern(ROTATION_PATTERN):
            check_word_not_repeated(cursor, at, turn, "DR")
            turn = direction.group(1)
        elif word := _word(cursor, form):
            check_word_not_repeated(cursor, word.column, word.axis in words, word.axis)
            words[word.axis] = word
        elif cursor.match_pattern(_NOT_PROGRAMMED):
            continue
        elif read := read_feed(cursor):
            check_word_not_repeated(cursor, read.column, speed, "F")
            speed = read
        elif code := read_m_function(cursor):
            codes.append(code)
            _demand_few(cursor, codes)
        else:
            raise _strange(cursor, form)
    made = PathFunction(axes, compensation, speed, tuple(codes), form, tuple(words.values()), turn, column)
    _demand_whole(cursor, made)
    return made


def read_paraxial_move(cursor: LineCursor, column: int) -> PathFunction:
    """Read a block with one axis and without L, such as ``Z+100 R0 FMAX M3``.

    Raises ProgramError for a syntax error.
    """
    made = read_path_function(cursor, "L", column)
    if len(made.axis_words) > 1:
        text = "A block without L can move only one axis."
        raise make_syntax_error(
            cursor.line_number, made.axis_words[1].column, text, "Write L at the start of the block."
        )
    return made


def _check_paraxial(cursor: LineCursor, column: int, kind: str, axes: tuple[AxisWord, ...]) -> None:
    """Raise ProgramError if a block with the compensation R+ or R- does not move exactly one axis.

    R+ and R- lengthen or shorten a move along one axis by the tool radius.
    """
    if kind in {"+", "-"} and len(axes) != 1:
        text = Message("R{kind} is allowed only in a block that moves one axis.", kind=kind)
        raise make_syntax_error(cursor.line_number, column, text, "For a contour, write RL or RR.")


def _word(cursor: LineCursor, form: str) -> AxisWord | None:
    at, match = cursor.index, _KNOWN_WORDS.match(cursor.uppercase_text, cursor.index)
    if match is None or match.group(1).removeprefix("I") not in _FORMS[form].allowed_words:
        return None
    cursor.match_pattern(_KNOWN_WORDS)
    name = match.group(1).removeprefix("I")
    return AxisWord(name, cursor.read_value(match.group(1)), match.group(1)[0] == "I", at + 1)


def _demand_whole(cursor: LineCursor, made: PathFunction) -> None:
    form = _FORMS[made.function_name]
    missing = [name for name in form.required_words if made.find_word(name) is None]
    if missing:
        raise cursor.make_expected_error(
            Message("{form} needs {missing}", form=made.function_name, missing=" and ".join(missing))
        )
    if made.rotation_direction and not form.needs_direction and made.function_name not in {"CT", "CTP"}:
        raise make_syntax_error(
            cursor.line_number,
            made.column,
            Message("{form} does not accept DR.", form=made.function_name),
            "Remove this text from the program.",
        )


def read_pole(cursor: LineCursor, column: int) -> Pole:
    """Read the axes after ``CC``."""
    made = Pole(read_axis_words(cursor, "XYZ"), column)
    cursor.check_at_end("CC accepts only two axes")
    return made


_SIZE = re.compile(r"R(?=\s*[+\-0-9.,Q])")


def read_corner(cursor: LineCursor, form: str, column: int) -> CornerBlock:
    """Read the size and optional feed after ``RND`` or ``CHF``."""
    cursor.match_pattern(_SIZE)
    size = cursor.read_value(form)
    speed = read_feed(cursor)
    cursor.check_at_end(Message("{form} accepts only a radius or length, and a feed rate", form=form))
    return CornerBlock(form, size, speed, column)


def read_m_function_block(cursor: LineCursor) -> MFunctionBlock:
    """Read a block that contains only M functions."""
    return MFunctionBlock(read_remaining_m_functions(cursor))


def read_remaining_m_functions(cursor: LineCursor) -> tuple[MFunction, ...]:
    """Read M functions up to the end of the line.

    Raises ProgramError for any other word, and for more than four M functions.
    """
    codes: list[MFunction] = []
    while not cursor.is_at_end:
        code = read_m_function(cursor)
        if code is None:
            raise cursor.make_expected_error("Expected an M function")
        codes.append(code)
        _demand_few(cursor, codes)
    return tuple(codes)


_WITH_WORDS = {
    94: re.compile(r"[ABC](?![A-Z0-9+\-])"),
    120: re.compile(r"LA\s*[0-9]+"),
    118: re.compile(r"(?:[XYZABC]\s*[0-9.,]+\s*)+"),
}


def read_m_function(cursor: LineCursor) -> MFunction | None:
    """Read one M function, or return None if the cursor is not at an M function."""
    column = cursor.column
    if cursor.match_pattern(_M) is None:
        return None
    number = cursor.read_whole_number("M", 999)
    if number == 128:
        return MFunction(number, column, feed=_plain_feed(cursor))
    if number == 103:
        return MFunction(number, column, feed=_factor(cursor))
    if number == 140:
        retract = read_retract(cursor)
        if retract is None:
            raise cursor.make_expected_error("M140 needs MB", "Write MB and a length, or MB MAX.")
        return MFunction(number, column, retract, read_feed(cursor))
    if number in _WITH_WORDS:
        cursor.match_pattern(_WITH_WORDS[number])
    return MFunction(number, column)


def _factor(cursor: LineCursor) -> FeedWord | None:
    """Read the factor of M103, which is in percent and written as F.

    Without a factor, M103 is canceled.
    """
    found = read_feed(cursor)
    if found is not None and (found.feed_kind != "value" or found.feed_unit_letter):
        text = "M103 accepts its factor only as F with a number."
        raise make_syntax_error(
            cursor.line_number, found.column, text, "Write M103 F20 for a fifth of the feed."
        )
    return found


def _plain_feed(cursor: LineCursor) -> FeedWord | None:
    found = read_feed(cursor)
    if found is not None and (found.feed_kind == "auto" or found.feed_unit_letter):
        raise make_syntax_error(
            cursor.line_number,
            found.column,
            "M128 accepts only a numeric feed or FMAX.",
            "Write F and a number.",
        )
    return found


def _joined(
    cursor: LineCursor, axes: tuple[AxisWord, ...], words: tuple[AxisWord, ...]
) -> tuple[AxisWord, ...]:
    for word in words:
        if any(word.axis == known.axis for known in axes):
            raise make_repeated_word_error(cursor, word.column, word.axis)
    return axes + words


def _demand_few(cursor: LineCursor, codes: list[MFunction]) -> None:
    if len(codes) > MAX_M_FUNCTION_COUNT:
        text = Message(
            "There are more than {most_codes} M functions in the block.", most_codes=MAX_M_FUNCTION_COUNT
        )
        raise make_syntax_error(
            cursor.line_number, codes[-1].column, text, "Split the block into two or more blocks."
        )


def _strange(cursor: LineCursor, form: str) -> ProgramError:
    if cursor.match_pattern(_SINGLE_AXIS):
        return cursor.make_expected_error(
            "No value is programmed for the axis", "Write a number such as +10."
        )
    takes = ", ".join(
        ("axes", *_FORMS[form].allowed_words, *(("DR",) if _FORMS[form].needs_direction else ()))
    )
    return cursor.make_expected_error(
        Message("Unexpected word in this {form} block", form=form),
        Message("Use only {takes}, R0, RL or RR, a feed and M functions.", takes=takes),
    )
