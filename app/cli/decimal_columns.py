"""Long columns of numbers, rounded and as text: all at once, to the letter as Python does each by itself."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from core.interpreter.shared.elementary_blocks import Floats, Ints

_SURE = 1e12  # a number of steps up to which it is a whole one, with digits to spare
_HALF = 1e-3  # nearer than that to the half of a step it is rounded by its decimals
_DIGITS = 12  # of a whole number below _SURE
_SHORT = 1e-4  # below it ``repr`` has an exponent
_ZERO, _POINT, _MINUS, _LINE_END, _NOTHING = *b"0.-\n", 0


def rounded(values: Floats, places: int) -> Floats:
    """As ``round(value, places) + 0.0`` rounds each of them, (m,)."""
    steps = values * 10.0**places
    whole = np.rint(steps)
    found: Floats = whole / 10.0**places + 0.0
    halves = np.abs(np.abs(steps - whole) - 0.5) < _HALF
    for at in np.flatnonzero(halves | ~(np.abs(steps) < _SURE)).tolist():
        found[at] = round(float(values[at]), places) + 0.0
    return found


def decimals(values: Floats, places: int) -> list[str]:
    """The shortest text of each of the ``rounded`` values, (m,), as ``repr`` has it; at most 11 places.

    A decimal fraction of twelve digits is the shortest of its double: what is left to do is to write digits
    and to leave out the noughts at both ends.
    """
    found = rounded(values, places)
    size = np.abs(found)
    count = np.rint(size * 10.0**places)
    plain = (count < _SURE) & ((size >= _SHORT) | (count == 0.0))
    texts = _written(np.where(plain, count, 0.0).astype(np.int64), found < 0.0, places)
    for at in np.flatnonzero(~plain).tolist():
        texts[at] = repr(float(found[at]))
    return texts


def _written(count: Ints, negative: npt.NDArray[np.bool_], places: int) -> list[str]:
    """So many (m,) steps of as many ``places``, with one digit at least on either side of the point."""
    digits, point = _digits(count), _DIGITS - places
    for at in range(point - 1):
        digits[at] *= count >= 10 ** (_DIGITS - 1 - at)
    nought = np.ones(len(count), bool)
    for at in range(_DIGITS - 1, point, -1):
        nought &= digits[at] == _ZERO
        digits[at] *= ~nought
    text = np.empty((_DIGITS + 3, len(count)), np.uint8)
    text[0] = np.where(negative, _MINUS, _NOTHING)
    text[1 : point + 1], text[point + 1], text[point + 2 : -1], text[-1] = (
        digits[:point], _POINT, digits[point:], _LINE_END
    )  # fmt: skip
    lines = np.ascontiguousarray(text.T)
    characters: bytes = lines[lines != _NOTHING].tobytes()
    return characters.decode("ascii").split("\n")[:-1]


def _digits(count: Ints) -> npt.NDArray[np.uint8]:
    """The twelve digits of each number, as characters: (12, m), the first ones first."""
    groups = np.stack([count // 10**8, count // 10**4 % 10**4, count % 10**4])
    fours = _fours()[groups].view(np.uint8)
    return fours.reshape(3, len(count), 4).transpose(0, 2, 1).reshape(_DIGITS, len(count))


@cache
def _fours() -> npt.NDArray[np.uint32]:
    """The four digits of 0 to 9999, as characters in one number (10000,)."""
    return np.frombuffer("".join([f"{each:04d}" for each in range(10_000)]).encode(), np.uint32)
