"""Lines of G00 or G01, X, Z and F and no more: nearly all of a long program, so they are read as numbers.

A statement takes a kilobyte and ten microseconds; here a move takes a tenth of both.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from math import isnan
from typing import NamedTuple, overload

import numpy as np
import numpy.typing as npt

from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import CodedMove, PlainMove, ReadyLine
from core.interpreter.omniturn.straight_moves import rounded

_NUMBER = r"[-+]?(?:[0-9]{1,4}(?:\.[0-9]{0,5})?|\.[0-9]{1,5})"
_MOVE = re.compile(
    f"(?:[Gg]0(?P<g>[01]))?(?:[Xx](?P<x>{_NUMBER}))?(?:[Zz](?P<z>{_NUMBER}))?(?:[Ff](?P<f>{_NUMBER}))?"
)
_FIVE_PLACES = re.compile(r"\.[0-9]{5}")

NO_CODE = -1


def move_words(text: str) -> re.Match[str] | None:
    """A line of G00 or G01, X, Z and F and no more, with one of X and Z; groups ``g x z f``."""
    match = _MOVE.fullmatch(text)
    return None if match is None or match["x"] is match["z"] is None else match


def is_fine(text: str) -> bool:
    """Whether a number has a fifth decimal."""
    return _FIVE_PLACES.search(text) is not None


def read_move(text: str) -> PlainMove | CodedMove | None:
    """The numbers of a line of G00 or G01, X, Z and F, or None for a line that is more, or no move."""
    match = move_words(text)
    if match is None:
        return None
    g, x, z, f = match.groups()
    to_x, to_z = None if x is None else float(x), None if z is None else float(z)
    fine = is_fine(text)
    if g is None and f is None and not fine:
        return to_x, to_z
    feed = None if f is None else float(f)
    if feed is not None and feed <= 0:
        return None
    return to_x, to_z, fine, NO_CODE if g is None else int(g), feed


def plain(state: State, line: int, text: str, move: CodedMove) -> PlainMove | None:
    """X and Z of a line whose other words say what is in force already; None where they change something."""
    x, z, fine, g, f = move
    if g == 0:
        if f is not None or not state.modal.rapid or state.title_rapid:
            return None
    elif state.steady_feed is None:
        if g == 1 or f is not None:
            return None
    elif f is not None and state.feed_word(f) != state.steady_feed:
        return None
    return rounded(state, line, text, x, z) if fine else (x, z)


# --- Lines read many at once, into columns, as ``read_move`` reads each of them


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


def columns_of(steps: Sequence[ReadyLine]) -> Columns:
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


# --- The lines of a long program: numbers in columns where they are plain moves, tuples where somebody asks.


MOST = 20_000
"""Lines that are read, and handed on, at once."""

_PAGE, _PAGES = 1024, 32


class LongProgram(Sequence[ReadyLine]):
    """A list of steps at a tenth of a list's memory while moves are taken from ``columns``.

    ``rare`` are the lines that stand in no column.
    """

    def __init__(self, columns: Columns, rare: dict[int, ReadyLine]) -> None:
        self.columns = columns
        self._rare = rare
        self._pages: dict[int, list[ReadyLine]] = {}
        index = np.arange(len(columns.known))
        other = np.where(columns.known, len(index), index)
        self._stop = np.minimum.accumulate(other[::-1])[::-1].copy()

    def copy(self) -> LongProgram:
        """Lines of their own, the numbers in them are shared."""
        known = self.columns.known.copy()
        return LongProgram(self.columns._replace(known=known), self._rare.copy())

    def __len__(self) -> int:
        return len(self._stop)

    @overload
    def __getitem__(self, at: int) -> ReadyLine: ...
    @overload
    def __getitem__(self, at: slice) -> list[ReadyLine]: ...
    def __getitem__(self, at: int | slice) -> ReadyLine | list[ReadyLine]:
        if isinstance(at, slice):
            return [self[k] for k in range(len(self))[at]]
        page = self._pages.get(at // _PAGE) or self._page(at // _PAGE)
        return page[at % _PAGE]

    def __setitem__(self, at: int, step: ReadyLine) -> None:
        """A line that no column holds from now on."""
        self._rare[at] = self._page(at // _PAGE)[at % _PAGE] = step
        self.columns.known[at] = False
        self._stop[max(0, at - MOST) : at + 1].clip(max=at, out=self._stop[max(0, at - MOST) : at + 1])

    def __iter__(self) -> Iterator[ReadyLine]:
        for number in range(-(-len(self) // _PAGE)):
            yield from self._pages.get(number) or self._made(number)

    def moves_until(self, at: int) -> int:
        """The next line that is no plain move, or one that is MOST or more away."""
        return int(self._stop[at])

    def _page(self, number: int) -> list[ReadyLine]:
        if number not in self._pages:
            if len(self._pages) >= _PAGES:
                del self._pages[next(iter(self._pages))]
            self._pages[number] = self._made(number)
        return self._pages[number]

    def _made(self, number: int) -> list[ReadyLine]:
        lines = range(number * _PAGE, min((number + 1) * _PAGE, len(self)))
        moves = self.columns.part(slice(lines.start, lines.stop)).steps()
        return [self._rare[at] if move is None else move for at, move in zip(lines, moves, strict=True)]


ReadyLines = list[ReadyLine] | LongProgram
"""The lines of a program, from index 0."""


def read_long_program(lines: Sequence[str], read: Callable[[int, str], ReadyLine]) -> LongProgram:
    """The lines ready to run; ``read`` is asked, in order, for each that is no regular move."""
    parts: list[Columns] = []
    rare: dict[int, ReadyLine] = {}
    for first in range(0, len(lines), MOST):
        texts = lines[first : first + MOST]
        part = read_columns(texts)
        for at in np.flatnonzero(~part.known).tolist():
            rare[first + at] = read(first + at + 1, texts[at])
        parts.append(part)
    return LongProgram(Columns._make(map(np.concatenate, zip(*parts, strict=True))), rare)
