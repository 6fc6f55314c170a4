"""L moves of plain numbers, which nearly all lines of a long program are: read by two patterns.

Everything else, and everything that is wrong, is left to the reader that tells faults by their columns.
"""

from __future__ import annotations

import re

from core.language.klartext.nodes import AxisWord, Feed, KlartextLine, Move, Value

_NUMBER = r"[+-]?[0-9]{1,6}(?:\.[0-9]{1,9})?"
_MOVE = re.compile(
    rf"([0-9]{{1,9}} )?L((?: I?[XYZABC]{_NUMBER}){{1,6}})( R0)?(?: F(MAX|[0-9]{{1,6}}(?:\.[0-9]{{1,6}})?))?"
)
_WORD = re.compile(rf"(I?)([XYZABC])({_NUMBER})")


def read_plain(number: int, text: str) -> KlartextLine | None:
    """The move of a line that holds nothing else; None for every other line."""
    match = _MOVE.fullmatch(text)
    if match is None:
        return None
    block, _, r0, speed = match.groups()
    axes = []
    seen = set()
    for word in _WORD.finditer(text, match.start(2), match.end(2)):
        sign, axis, digits = word.groups()
        seen.add(axis)
        value = Value(float(digits) + 0.0, column=word.start(3) + 1)
        axes.append(AxisWord(axis, value, sign == "I", word.start() + 1))
    if len(seen) < len(axes):
        return None
    feed = None if speed is None else _feed(speed, match.start(4))
    move = Move(tuple(axes), r0 is not None, feed)
    return KlartextLine(number, move, None if block is None else int(block))


def _feed(speed: str, at: int) -> Feed:
    if speed == "MAX":
        return Feed("max", None, at)
    return Feed("value", Value(float(speed), column=at + 1), at)
