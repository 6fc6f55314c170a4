"""Lines with only G00 or G01, X, Z and F, which are nearly all lines of a long program, read as numbers.

A statement takes 1 kB and 10 µs; a move in this form takes a hundredth of both. Lines of a long program
mostly differ only in their digits. Lines with the same other characters have the same words at the same
columns, so that each column of digits is a column of an array. Lines of a rare form are read one by one.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple, overload

import numpy as np
import numpy.typing as npt

from core.interpreter.omniturn.omniturn_statement import PlainMove, ReadyLine
from core.language.long_lines import LongLines

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]
Ints = npt.NDArray[np.int64]
Digits = npt.NDArray[np.uint8]

NO_CODE = -1
MOST = 20_000
"""Lines that are read, and handed on, at once."""

_NUMBER = r"[-+]?(?:[0-9]{1,4}(?:\.[0-9]{0,5})?|\.[0-9]{1,5})"
_MOVE = re.compile(
    f"(?:[Gg]0(?P<g>[01]))?(?:[Xx](?P<x>{_NUMBER}))?(?:[Zz](?P<z>{_NUMBER}))?(?:[Ff](?P<f>{_NUMBER}))?"
)
_FIVE_PLACES = re.compile(r"\.[0-9]{5}")
_SHAPE = bytes.maketrans(b"123456789", b"000000000")
_NEW_LINE = ord("\n")
_FEW = 8  # lines of one form that are read one by one; rare forms of one length after which all are
_LONGEST = 64  # characters; longer lines are no plain moves
_PAGE, _PAGES = 1024, 32


def read_move(text: str) -> PlainMove | None:
    """Return the numbers of a line with only G00 or G01, X, Z and F; None for any other line."""
    match = _words(text)
    if match is None:
        return None
    g, *numbers = match.groups()
    x, z, f = (None if number is None else float(number) for number in numbers)
    if f is not None and f <= 0:
        return None
    return x, z, f, NO_CODE if g is None else int(g), _is_fine(text)


def _words(text: str) -> re.Match[str] | None:
    """Return the match with the groups ``g x z f`` of a plain move, which has X or Z; otherwise None."""
    match = _MOVE.fullmatch(text)
    return None if match is None or match["x"] is match["z"] is None else match


def _is_fine(text: str) -> bool:
    """Return whether a number has a fifth decimal place."""
    return _FIVE_PLACES.search(text) is not None


class Columns(NamedTuple):
    """Arrays of m lines: X, Z and F as written (NaN for none), and G 0, 1 or NO_CODE.

    ``fine`` marks lines with a fifth decimal place, and ``known`` marks plain moves.
    """

    x: Floats
    z: Floats
    f: Floats
    g: npt.NDArray[np.int8]
    fine: Bools
    known: Bools

    @staticmethod
    def empty(m: int) -> Columns:
        """Return the columns of m lines, none of which is known."""
        x, z, f = (np.full(m, np.nan) for _ in range(3))
        return Columns(x, z, f, np.full(m, NO_CODE, np.int8), np.zeros(m, bool), np.zeros(m, bool))

    def put(self, at: int, move: PlainMove) -> None:
        """Store a line that was read separately."""
        x, z, f, g, fine = move
        self.x[at], self.z[at], self.f[at] = (np.nan if v is None else v for v in (x, z, f))
        self.g[at], self.fine[at], self.known[at] = g, fine, True

    def moves(self) -> list[PlainMove | None]:
        """Return each line as ``read_move`` returns it; None for a line that is not a plain move."""
        x, z, f = (_words_of(column) for column in self[:3])
        rows = zip(x, z, f, self.g.tolist(), self.fine.tolist(), strict=True)
        return [row if known else None for row, known in zip(rows, self.known.tolist(), strict=True)]

    def part(self, at: slice | Ints) -> Columns:
        """Return the lines of a slice or with these indices."""
        return Columns(self.x[at], self.z[at], self.f[at], self.g[at], self.fine[at], self.known[at])


def _words_of(column: Floats) -> list[float | None]:
    """Return the numbers of a column, with None for NaN."""
    numbers: list[float | None] = column.tolist()
    for at in np.isnan(column).nonzero()[0].tolist():
        numbers[at] = None
    return numbers


def read_columns(text: str, columns: Columns) -> None:
    """Fill the columns from the text; ``known`` remains False for other lines and lines of a rare form."""
    raw = text.encode("ascii", "replace")  # one byte per character
    digits, shapes = np.frombuffer(raw, np.uint8), np.frombuffer(raw.translate(_SHAPE), np.uint8)
    ends = np.append(np.flatnonzero(digits == _NEW_LINE), len(digits))
    starts = np.concatenate([[0], ends[:-1] + 1])
    lengths = np.minimum(ends - starts, _LONGEST)
    for length in np.flatnonzero(np.bincount(lengths)[:_LONGEST] >= _FEW).tolist():
        _read_length(columns, np.flatnonzero(lengths == length), starts, length, digits, shapes)


def _read_length(
    columns: Columns, rows: Ints, starts: Ints, length: int, digits: Digits, shapes: Digits
) -> None:
    """Fill the lines ``rows``, all of which have this length, form by form; the most in their first line."""
    rare = 0
    while len(rows) >= _FEW and rare < _FEW:
        lines, begin = _Lines.of(starts[rows]), starts[rows[0]]
        form = shapes[begin : begin + length]
        same = np.ones(len(rows), bool)
        for at, character in enumerate(form.tolist()):
            same &= lines.column(shapes, at) == character
        alike = rows if same.all() else rows[same]
        match = _words(form.tobytes().decode()) if len(alike) >= _FEW else None
        if match is not None:
            _read_shape(columns, alike, match, digits, lines if alike is rows else _Lines.of(starts[alike]))
        rare += len(alike) < _FEW
        rows = rows[~same]


class _Lines(NamedTuple):
    """The first characters of lines in a text; ``step`` is the distance between lines, 0 if it varies."""

    first: Ints
    step: int

    @classmethod
    def of(cls, first: Ints) -> _Lines:
        """Return the lines that start at these characters, in ascending order."""
        steps = np.diff(first)
        return cls(first, int(steps[0]) if len(steps) and (steps == steps[0]).all() else 0)

    def column(self, text: Digits, at: int) -> Digits:
        """Return the character ``at`` (from 0) of each line."""
        if not self.step:
            return text.take(self.first + at)
        return text[self.first[0] + at : self.first[-1] + at + 1 : self.step]


def _read_shape(columns: Columns, rows: Ints, match: re.Match[str], digits: Digits, lines: _Lines) -> None:
    """Fill the lines ``rows``, all of which have the form of the match."""
    known = np.ones(len(rows), bool)
    for name, column in (("x", columns.x), ("z", columns.z), ("f", columns.f)):
        if match[name] is not None:
            column[rows] = _numbers(match, name, lines, digits)
    if match["f"] is not None:
        known &= columns.f[rows] > 0.0
    if match["g"] is not None:
        at = match.start("g")
        columns.g[rows] = lines.column(digits, at) - ord("0")
        known &= (lines.column(digits, at - 1) == ord("0")) & (columns.g[rows] <= 1)
    columns.fine[rows] = _is_fine(match.string)
    columns.known[rows] = known


def _numbers(match: re.Match[str], name: str, lines: _Lines, digits: Digits) -> Floats:
    """Return the numbers of a word in these lines.

    Digits as a whole number and powers of ten are exact, so that their quotient equals the result of
    ``float``.
    """
    text, start = match[name], match.start(name)
    whole = np.zeros(len(lines.first), np.int32)  # at most nine digits
    for at, character in enumerate(text, start=start):
        if character.isdigit():
            whole *= 10
            whole += lines.column(digits, at)
            whole -= ord("0")
    decimals = len(text) - text.index(".") - 1 if "." in text else 0
    value: Floats = whole / 10.0**decimals
    return -value if text.startswith("-") else value


class ReadyLines(Sequence[ReadyLine]):
    """The lines of a program from index 0: plain moves in ``columns``, all other lines as statements."""

    def __init__(self, columns: Columns, others: dict[int, ReadyLine]) -> None:
        self.columns = columns
        self._others = others
        self._pages: dict[int, list[ReadyLine]] = {}

    def copy(self) -> ReadyLines:
        """Return a copy with its own lines; the arrays of numbers are shared."""
        return ReadyLines(self.columns._replace(known=self.columns.known.copy()), self._others.copy())

    def __len__(self) -> int:
        return len(self.columns.known)

    @overload
    def __getitem__(self, at: int) -> ReadyLine: ...
    @overload
    def __getitem__(self, at: slice) -> list[ReadyLine]: ...
    def __getitem__(self, at: int | slice) -> ReadyLine | list[ReadyLine]:
        if isinstance(at, slice):
            return [self[k] for k in range(len(self))[at]]
        page = self._pages.get(at // _PAGE) or self._page(at // _PAGE)
        return page[at % _PAGE]

    def __setitem__(self, at: int, line: ReadyLine) -> None:
        """Replace a line, which is then no longer in the columns."""
        self._others[at] = self._page(at // _PAGE)[at % _PAGE] = line
        self.columns.known[at] = False

    def __iter__(self) -> Iterator[ReadyLine]:
        for number in range(-(-len(self) // _PAGE)):
            yield from self._page(number)

    def moves_until(self, at: int) -> int:
        """Return the index of the next line that is not a plain move, at most MOST lines away."""
        known = self.columns.known[at : at + MOST]
        first = int(known.argmin()) if len(known) else 0
        return at + (len(known) if len(known) and known[first] else first)

    def _page(self, number: int) -> list[ReadyLine]:
        if number not in self._pages:
            if len(self._pages) >= _PAGES:
                del self._pages[next(iter(self._pages))]
            self._pages[number] = self._made(number)
        return self._pages[number]

    def _made(self, number: int) -> list[ReadyLine]:
        lines = range(number * _PAGE, min((number + 1) * _PAGE, len(self)))
        moves = self.columns.part(slice(lines.start, lines.stop)).moves()
        return [self._others[at] if move is None else move for at, move in zip(lines, moves, strict=True)]


def _joined(lines: Sequence[str], these: range) -> str:
    return lines.joined(these) if isinstance(lines, LongLines) else "\n".join(lines[these.start : these.stop])


def read_lines(lines: Sequence[str], read: Callable[[int, str], ReadyLine], *, in_order: bool) -> ReadyLines:
    """Return the lines ready for execution.

    ``read`` (number from 1, text) is called for lines not read as arrays.

    With ``in_order``, ``read`` is called for each line, because the meaning depends on earlier lines.
    """
    columns = Columns.empty(len(lines))
    others: dict[int, ReadyLine] = {}
    for first in range(0, len(lines), MOST):
        part = columns.part(slice(first, first + MOST))
        if not in_order:
            read_columns(_joined(lines, range(first, min(first + MOST, len(lines)))), part)
        for at in np.flatnonzero(~part.known).tolist():
            line = read(first + at + 1, lines[first + at])
            if isinstance(line, tuple):
                part.put(at, line)
            else:
                others[first + at] = line
    return ReadyLines(columns, others)
