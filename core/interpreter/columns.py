"""Lines of G00 or G01, X, Z and F read many at once: as ``plain.read_move`` reads each of them, into columns.

Few lines of a long program differ in more than their digits. Lines whose other characters are the same
have the same words in the same places, so that a column of digits is a column of an array.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from math import isnan
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.interpreter.plain import NO_CODE, is_fine, move_words
from core.interpreter.statement import CodedMove, PlainMove, Step

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Ints = npt.NDArray[np.int64]
Digits = npt.NDArray[np.uint8]

_SHAPE = bytes.maketrans(b"123456789", b"000000000")
_NEW_LINE = ord("\n")
_FEW = 8  # lines of one shape that are read one by one


class Columns(NamedTuple):
    """m lines: X, Z and F as written (NaN: none), G 0 or 1 (-1: none), whether one of the numbers has a fifth
    decimal; ``known`` where the line is of this kind and holds one of X and Z."""

    x: Floats
    z: Floats
    f: Floats
    g: npt.NDArray[np.int8]
    fine: Bools
    known: Bools

    def steps(self) -> Iterator[PlainMove | CodedMove | None]:
        """Each line as it would have been read alone; None where it is not known."""
        numbers = ([None if isnan(v) else v for v in column.tolist()] for column in self[:3])
        for x, z, f, g, fine, known in zip(*numbers, *(c.tolist() for c in self[3:]), strict=True):
            if not known:
                yield None
            elif g == NO_CODE and f is None and not fine:
                yield x, z
            else:
                yield x, z, fine, g, f

    def part(self, at: slice | Ints) -> Columns:
        """Some of the lines."""
        return Columns(self.x[at], self.z[at], self.f[at], self.g[at], self.fine[at], self.known[at])


def _empty(m: int) -> Columns:
    x, z, f = (np.full(m, np.nan) for _ in range(3))
    return Columns(x, z, f, np.full(m, NO_CODE, np.int8), np.zeros(m, bool), np.zeros(m, bool))


def columns_of(steps: Sequence[Step]) -> Columns:
    """Lines that have been read one by one, side by side."""
    made = _empty(len(steps))
    for at, step in enumerate(steps):
        if isinstance(step, tuple):
            made.known[at] = True
            made.x[at], made.z[at] = (np.nan if v is None else v for v in step[:2])
            if len(step) == 5:
                made.fine[at], made.g[at] = step[2:4]
                made.f[at] = np.nan if step[4] is None else step[4]
    return made


def read_columns(lines: Sequence[str]) -> Columns:
    """The lines as columns; ``known`` is False for any that is another kind of line, or a rare one."""
    made = _empty(len(lines))
    raw = "\n".join(lines).encode("ascii", "replace")  # a character, a byte
    digits = np.frombuffer(raw, np.uint8)
    starts = np.concatenate([[0], np.flatnonzero(digits == _NEW_LINE) + 1])
    shapes = raw.translate(_SHAPE).split(b"\n")
    number = {shape: k for k, shape in enumerate(set(shapes))}
    kinds = np.fromiter(map(number.__getitem__, shapes), np.int64, len(shapes))
    order = np.argsort(kinds, kind="stable")
    bounds = np.searchsorted(kinds[order], np.arange(len(number) + 1))
    for shape, k in number.items():
        rows = order[bounds[k] : bounds[k + 1]]
        match = move_words(shape.decode()) if len(rows) >= _FEW else None
        if match is not None:
            _read_shape(made, rows, match, digits, starts)
    return made


def _read_shape(made: Columns, rows: Ints, match: re.Match[str], digits: Digits, starts: Ints) -> None:
    """Put in the lines ``rows``, all of the shape that has matched."""
    first = starts[rows]
    known = np.ones(len(rows), bool)
    for name, column in (("x", made.x), ("z", made.z), ("f", made.f)):
        if match[name] is not None:
            column[rows] = _numbers(match, name, first, digits)
    if match["f"] is not None:
        known &= made.f[rows] > 0.0
    if match["g"] is not None:
        at = first + match.start("g")
        made.g[rows] = digits[at] - ord("0")
        known &= (digits[at - 1] == ord("0")) & (made.g[rows] <= 1)
    made.fine[rows] = is_fine(match.string)
    made.known[rows] = known


def _numbers(match: re.Match[str], name: str, first: Ints, digits: Digits) -> Floats:
    """A word's numbers. Digits as a whole number and a power of ten are exact, so their quotient is the
    double next to the decimal fraction, as ``float`` gives it."""
    text, start = match[name], match.start(name)
    places = [start + k for k, character in enumerate(text) if character.isdigit()]
    whole = digits[first[:, None] + np.array(places)].astype(np.float64) - ord("0")
    value: Floats = whole @ 10.0 ** np.arange(len(places))[::-1]
    decimals = len(text) - text.index(".") - 1 if "." in text else 0
    value /= 10.0**decimals
    return -value if text.startswith("-") else value
