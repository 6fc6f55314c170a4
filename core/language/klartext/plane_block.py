"""Reader of PLANE blocks: the definition of the plane and the positioning of the rotary axes."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable

from core.language.klartext.klartext_faults import syntax
from core.language.klartext.klartext_nodes import AxisWord, Plane, Positioning
from core.language.klartext.line_cursor import Cursor, axis_words, demand_once, feed, retract, words_once
from core.message import Message

POINT_WORDS = tuple(f"P{point}{axis}" for point in "123" for axis in "XYZ")
SPATIAL_WORDS = ("SPA", "SPB", "SPC")
EULER_WORDS = ("EULPR", "EULNU", "EULROT")
VECTOR_WORDS = ("BX", "BY", "BZ", "NX", "NY", "NZ")
PROJECTED_WORDS = ("PROPR", "PROMIN", "ROT")
FORMS = ("AXIAL", "POINTS", "SPATIAL", "RELATIV", "EULER", "VECTOR", "PROJECTED", "RESET")
_WAYS = ("MOVE", "TURN", "STAY")
_POINT, _SPATIAL, _EULER, _VECTOR, _PROJECTED = (
    re.compile(rf"({names})(?=[\s+\-0-9.,Q]|$)")
    for names in ("P[123][XYZ]", "SP[ABC]", "EULPR|EULNU|EULROT", "[BN][XYZ]", "PROPR|PROMIN|ROT")
)
_SIDE = re.compile(r"(SYM|SEQ)\s*([+-])")
_ROTATION = re.compile(r"(COORD|TABLE)\s+ROT(?![A-Z])")


def plane(cursor: Cursor, column: int) -> Plane:
    """Read the block after ``PLANE``.

    Raises ProgramError if a word is missing, unknown, repeated or not supported.
    """
    form = cursor.keyword(*FORMS)
    if form is None:
        raise cursor.expected(
            Message("PLANE needs {forms} or {forms2}", forms=", ".join(FORMS[:-1]), forms2=FORMS[-1])
        )
    words = _WORDS[form](cursor) if form in _WORDS else ()
    return Plane(form, words, _positioning(cursor, form), column)


def _axial(cursor: Cursor) -> tuple[AxisWord, ...]:
    words = axis_words(cursor, "ABC")
    if not words:
        raise cursor.expected("PLANE AXIAL needs an axis angle", "Write A, B or C with an angle.")
    return words


def _relative(cursor: Cursor) -> tuple[AxisWord, ...]:
    words = tuple(words_once(cursor, _SPATIAL).values())
    if len(words) != 1:
        column = words[1].column if words else cursor.column
        text = "PLANE RELATIV needs exactly one of SPA, SPB and SPC."
        raise syntax(cursor.line, column, text, "Write only one angle.")
    return words


_WORDS: dict[str, Callable[[Cursor], tuple[AxisWord, ...]]] = {
    "AXIAL": _axial,
    "POINTS": lambda cursor: _all_of(cursor, POINT_WORDS, _POINT),
    "SPATIAL": lambda cursor: _all_of(cursor, SPATIAL_WORDS, _SPATIAL),
    "RELATIV": _relative,
    "EULER": lambda cursor: _all_of(cursor, EULER_WORDS, _EULER),
    "VECTOR": lambda cursor: _all_of(cursor, VECTOR_WORDS, _VECTOR),
    "PROJECTED": lambda cursor: _all_of(cursor, PROJECTED_WORDS, _PROJECTED),
}


def _all_of(cursor: Cursor, names: tuple[str, ...], pattern: re.Pattern[str]) -> tuple[AxisWord, ...]:
    """Return the words in the order of the manual. Raises ProgramError if a word is missing."""
    found = words_once(cursor, pattern)
    missing = [name for name in names if name not in found]
    if missing:
        template = "{missing} are missing" if len(missing) > 1 else "{missing} is missing"
        raise cursor.expected(
            Message(template, missing=", ".join(missing)),
            "Write all the words named in the message, even if a value is 0.",
        )
    return tuple(found[name] for name in names)


def _positioning(cursor: Cursor, form: str) -> Positioning:
    way = cursor.keyword(*_WAYS)
    if way is None:
        if form == "RESET" and cursor.done:
            return Positioning()
        raise cursor.expected(
            "MOVE, TURN or STAY is missing",
            "Write MOVE, TURN or STAY to set how the rotary axes are positioned.",
        )
    made = Positioning(way)
    while not cursor.done:
        made = _with_word(cursor, form, made)
    return made


def _with_word(cursor: Cursor, form: str, made: Positioning) -> Positioning:
    """Read the next word after the kind of positioning."""
    column = cursor.column
    if form != "RESET" and (side := cursor.take(_SIDE)):
        demand_once(cursor, column, made.side, "SYM or SEQ")
        return dataclasses.replace(made, side="".join(side.groups()))
    if form != "RESET" and (rotation := cursor.take(_ROTATION)):
        demand_once(cursor, column, made.rotation, "COORD ROT or TABLE ROT")
        return dataclasses.replace(made, rotation=Message("{word} ROT", word=rotation.group(1)))
    if cursor.keyword("DIST", "ABST", "SETUP"):  # ABST is the German word.
        if made.way != "MOVE":
            text = Message("DIST is allowed only with MOVE, not with {word}.", word=made.way)
            raise syntax(cursor.line, column, text, "Remove this text from the program.")
        demand_once(cursor, column, made.distance, "DIST")
        return dataclasses.replace(made, distance=cursor.number("DIST"))
    return _with_motion(cursor, made, column)


def _with_motion(cursor: Cursor, made: Positioning, column: int) -> Positioning:
    if way := retract(cursor):
        _demand_motion(cursor, made, column, "MB")
        demand_once(cursor, column, made.retract, "MB")
        return dataclasses.replace(made, retract=way)
    if speed := feed(cursor):
        _demand_motion(cursor, made, column, "F")
        demand_once(cursor, column, made.feed, "F")
        return dataclasses.replace(made, feed=speed)
    if second := cursor.keyword(*_WAYS):
        text = Message(
            "A PLANE block cannot contain both {first} and {second}.", first=made.way, second=second
        )
        raise syntax(cursor.line, column, text, "Remove one of the two words.")
    raise cursor.expected("Unexpected word in a PLANE block")


def _demand_motion(cursor: Cursor, made: Positioning, column: int, what: str) -> None:
    if made.way == "STAY":
        raise syntax(
            cursor.line,
            column,
            Message("STAY does not move any axis, so {what} is not allowed.", what=what),
            "Remove this text from the program.",
        )
