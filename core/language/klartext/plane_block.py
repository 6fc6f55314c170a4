"""Parser of PLANE blocks, which define the plane and the positioning of the rotary axes."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable

from core.language.klartext.klartext_faults import make_syntax_error
from core.language.klartext.klartext_nodes import PlaneBlock, RotaryPositioning
from core.language.klartext.klartext_words import AxisWord
from core.language.klartext.line_cursor import (
    LineCursor,
    check_word_not_repeated,
    read_axis_words,
    read_feed,
    read_retract,
    read_words_by_name,
)
from core.message import Message

POINT_WORDS = tuple(f"P{point}{axis}" for point in "123" for axis in "XYZ")
SPATIAL_WORDS = ("SPA", "SPB", "SPC")
EULER_WORDS = ("EULPR", "EULNU", "EULROT")
VECTOR_WORDS = ("BX", "BY", "BZ", "NX", "NY", "NZ")
PROJECTED_WORDS = ("PROPR", "PROMIN", "ROT")
PLANE_FORMS = ("AXIAL", "POINTS", "SPATIAL", "RELATIV", "EULER", "VECTOR", "PROJECTED", "RESET")
_POSITIONING_MODES = ("MOVE", "TURN", "STAY")
_POINT, _SPATIAL, _EULER, _VECTOR, _PROJECTED = (
    re.compile(rf"({names})(?=[\s+\-0-9.,Q]|$)")
    for names in ("P[123][XYZ]", "SP[ABC]", "EULPR|EULNU|EULROT", "[BN][XYZ]", "PROPR|PROMIN|ROT")
)
_SIDE = re.compile(r"(SYM|SEQ)\s*([+-])")
_ROTATION = re.compile(r"(COORD|TABLE)\s+ROT(?![A-Z])")


def plane(cursor: LineCursor, column: int) -> PlaneBlock:
    """Read the block after ``PLANE``.

    Raises ProgramError if a word is missing, unknown, repeated or not supported.
    """
    form = cursor.read_keyword(*PLANE_FORMS)
    if form is None:
        raise cursor.make_expected_error(
            Message(
                "PLANE needs {forms} or {forms2}", forms=", ".join(PLANE_FORMS[:-1]), forms2=PLANE_FORMS[-1]
            )
        )
    words = _WORDS[form](cursor) if form in _WORDS else ()
    return PlaneBlock(form, words, _positioning(cursor, form), column)


def _axial(cursor: LineCursor) -> tuple[AxisWord, ...]:
    words = read_axis_words(cursor, "ABC")
    if not words:
        raise cursor.make_expected_error("PLANE AXIAL needs an axis angle", "Write A, B or C with an angle.")
    return words


def _relative(cursor: LineCursor) -> tuple[AxisWord, ...]:
    words = tuple(read_words_by_name(cursor, _SPATIAL).values())
    if len(words) != 1:
        column = words[1].column if words else cursor.column
        text = "PLANE RELATIV needs exactly one of SPA, SPB and SPC."
        raise make_syntax_error(cursor.line_number, column, text, "Write only one angle.")
    return words


_WORDS: dict[str, Callable[[LineCursor], tuple[AxisWord, ...]]] = {
    "AXIAL": _axial,
    "POINTS": lambda cursor: _read_all_words(cursor, POINT_WORDS, _POINT),
    "SPATIAL": lambda cursor: _read_all_words(cursor, SPATIAL_WORDS, _SPATIAL),
    "RELATIV": _relative,
    "EULER": lambda cursor: _read_all_words(cursor, EULER_WORDS, _EULER),
    "VECTOR": lambda cursor: _read_all_words(cursor, VECTOR_WORDS, _VECTOR),
    "PROJECTED": lambda cursor: _read_all_words(cursor, PROJECTED_WORDS, _PROJECTED),
}


def _read_all_words(
    cursor: LineCursor, names: tuple[str, ...], pattern: re.Pattern[str]
) -> tuple[AxisWord, ...]:
    """Read the words that a PLANE block requires, and return them in the order of the manual.

    Raises ProgramError if a word is missing.
    """
    found = read_words_by_name(cursor, pattern)
    missing = [name for name in names if name not in found]
    if missing:
        template = "{missing} are missing" if len(missing) > 1 else "{missing} is missing"
        raise cursor.make_expected_error(
            Message(template, missing=", ".join(missing)),
            "Write all the words named in the message, even if a value is 0.",
        )
    return tuple(found[name] for name in names)


def _positioning(cursor: LineCursor, form: str) -> RotaryPositioning:
    mode = cursor.read_keyword(*_POSITIONING_MODES)
    if mode is None:
        if form == "RESET" and cursor.is_at_end:
            return RotaryPositioning()
        raise cursor.make_expected_error(
            "MOVE, TURN or STAY is missing",
            "Write MOVE, TURN or STAY to set how the rotary axes are positioned.",
        )
    made = RotaryPositioning(mode)
    while not cursor.is_at_end:
        made = _with_word(cursor, form, made)
    return made


def _with_word(cursor: LineCursor, form: str, positioning: RotaryPositioning) -> RotaryPositioning:
    """Read the next word at the cursor, and return the positioning mode with this word added."""
    column = cursor.column
    if form != "RESET" and (side := cursor.match_pattern(_SIDE)):
        check_word_not_repeated(cursor, column, positioning.solution, "SYM or SEQ")
        return dataclasses.replace(positioning, solution="".join(side.groups()))
    if form != "RESET" and (rotation := cursor.match_pattern(_ROTATION)):
        check_word_not_repeated(cursor, column, positioning.rotation_mode, "COORD ROT or TABLE ROT")
        return dataclasses.replace(positioning, rotation_mode=Message("{word} ROT", word=rotation.group(1)))
    if cursor.read_keyword("DIST", "ABST", "SETUP"):  # ABST is the German word.
        if positioning.mode != "MOVE":
            text = Message("DIST is allowed only with MOVE, not with {word}.", word=positioning.mode)
            raise make_syntax_error(cursor.line_number, column, text, "Remove this text from the program.")
        check_word_not_repeated(cursor, column, positioning.rotation_center_distance, "DIST")
        return dataclasses.replace(positioning, rotation_center_distance=cursor.read_number("DIST"))
    return _with_motion(cursor, positioning, column)


def _with_motion(cursor: LineCursor, made: RotaryPositioning, column: int) -> RotaryPositioning:
    if retract := read_retract(cursor):
        _demand_motion(cursor, made, column, "MB")
        check_word_not_repeated(cursor, column, made.retract, "MB")
        return dataclasses.replace(made, retract=retract)
    if speed := read_feed(cursor):
        _demand_motion(cursor, made, column, "F")
        check_word_not_repeated(cursor, column, made.feed, "F")
        return dataclasses.replace(made, feed=speed)
    if second := cursor.read_keyword(*_POSITIONING_MODES):
        text = Message(
            "A PLANE block cannot contain both {first} and {second}.", first=made.mode, second=second
        )
        raise make_syntax_error(cursor.line_number, column, text, "Remove one of the two words.")
    raise cursor.make_expected_error("Unexpected word in a PLANE block")


def _demand_motion(cursor: LineCursor, made: RotaryPositioning, column: int, what: str) -> None:
    if made.mode == "STAY":
        raise make_syntax_error(
            cursor.line_number,
            column,
            Message("STAY does not move any axis, so {what} is not allowed.", what=what),
            "Remove this text from the program.",
        )
