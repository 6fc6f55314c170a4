"""Fast parsing of plain moves, which are lines with only G00 or G01, X, Z and F.

Most lines of long programs are plain moves. Parsing a line as a statement takes 1 kB and 10 µs, and as a
plain move a hundredth of this memory and time. Lines that differ only in their digits have the same words
at the same columns, so each column of digits becomes an array. Lines of a rare form are parsed
individually.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple, overload

import numpy as np
import numpy.typing as npt

from core.interpreter.omniturn.omniturn_statement import ExecutableLine, PlainMove
from core.language.long_lines import LazyLines

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
IntArray = npt.NDArray[np.int64]
DigitArray = npt.NDArray[np.uint8]

NO_G_CODE = -1
MAX_RUN_LENGTH = 20_000
"""Maximum number of lines that are read and passed on at once."""

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


def parse_plain_move(text: str) -> PlainMove | None:
    """Return the numbers of a line with only G00 or G01, X, Z and F, or None for any other line."""
    match = _words(text)
    if match is None:
        return None
    g, *numbers = match.groups()
    x, z, f = (None if number is None else float(number) for number in numbers)
    if f is not None and f <= 0:
        return None
    return x, z, f, NO_G_CODE if g is None else int(g), _is_fine(text)


def _words(text: str) -> re.Match[str] | None:
    """Return the match of a plain move with the groups ``g_codes x z feeds``, or None for any other line.

    A plain move has X or Z.
    """
    match = _MOVE.fullmatch(text)
    return None if match is None or match["x"] is match["z"] is None else match


def _is_fine(text: str) -> bool:
    """Return whether a number in program text has a fifth decimal place."""
    return _FIVE_PLACES.search(text) is not None


class LineColumns(NamedTuple):
    """Arrays with the words of m lines.

    X, Z and F are stored as written, with NaN for a missing word. G is 0, 1 or NO_G_CODE.
    ``has_fifth_decimal`` is True for lines with a fifth decimal place. ``is_plain_move`` is True for plain
    moves.
    """

    x: FloatArray
    z: FloatArray
    feeds: FloatArray
    g_codes: npt.NDArray[np.int8]
    has_fifth_decimal: BoolArray
    is_plain_move: BoolArray

    @staticmethod
    def make_empty(line_count: int) -> LineColumns:
        """Return the columns for ``line_count`` lines, none of which is a plain move yet."""
        x, z, f = (np.full(line_count, np.nan) for _ in range(3))
        return LineColumns(
            x,
            z,
            f,
            np.full(line_count, NO_G_CODE, np.int8),
            np.zeros(line_count, bool),
            np.zeros(line_count, bool),
        )

    def store_line(self, index: int, move: PlainMove) -> None:
        """Store a plain move that was parsed individually."""
        x, z, f, g, fine = move
        self.x[index], self.z[index], self.feeds[index] = (np.nan if v is None else v for v in (x, z, f))
        self.g_codes[index], self.has_fifth_decimal[index], self.is_plain_move[index] = g, fine, True

    def list_moves(self) -> list[PlainMove | None]:
        """Return the lines as a list of plain moves, in the format of ``parse_plain_move``.

        The entry is None for a line that is not a plain move.
        """
        x, z, f = (_column_values(column) for column in self[:3])
        rows = zip(x, z, f, self.g_codes.tolist(), self.has_fifth_decimal.tolist(), strict=True)
        return [row if known else None for row, known in zip(rows, self.is_plain_move.tolist(), strict=True)]

    def select_lines(self, indices: slice | IntArray) -> LineColumns:
        """Return the lines with these indices or in this slice."""
        return LineColumns(
            self.x[indices],
            self.z[indices],
            self.feeds[indices],
            self.g_codes[indices],
            self.has_fifth_decimal[indices],
            self.is_plain_move[indices],
        )


def _column_values(column: FloatArray) -> list[float | None]:
    """Return the numbers of a column, with None for NaN."""
    numbers: list[float | None] = column.tolist()
    for at in np.isnan(column).nonzero()[0].tolist():
        numbers[at] = None
    return numbers


def parse_columns(text: str, columns: LineColumns) -> None:
    """Parse the plain moves in the text and store them in the columns.

    ``is_plain_move`` remains False for other lines and for lines of a rare form.
    """
    raw = text.encode("ascii", "replace")  # one byte per character
    digits, shapes = np.frombuffer(raw, np.uint8), np.frombuffer(raw.translate(_SHAPE), np.uint8)
    ends = np.append(np.flatnonzero(digits == _NEW_LINE), len(digits))
    starts = np.concatenate([[0], ends[:-1] + 1])
    lengths = np.minimum(ends - starts, _LONGEST)
    for length in np.flatnonzero(np.bincount(lengths)[:_LONGEST] >= _FEW).tolist():
        _read_length(columns, np.flatnonzero(lengths == length), starts, length, digits, shapes)


def _read_length(
    columns: LineColumns,
    rows: IntArray,
    starts: IntArray,
    length: int,
    digits: DigitArray,
    shapes: DigitArray,
) -> None:
    """Parse the lines ``rows``, which all have the same length, into the columns.

    Lines of the same form are parsed together, starting with the form of the first line.
    """
    rare = 0
    while len(rows) >= _FEW and rare < _FEW:
        lines, begin = _Lines.make_lines(starts[rows]), starts[rows[0]]
        form = shapes[begin : begin + length]
        same = np.ones(len(rows), bool)
        for at, character in enumerate(form.tolist()):
            same &= lines.get_characters(shapes, at) == character
        alike = rows if same.all() else rows[same]
        match = _words(form.tobytes().decode()) if len(alike) >= _FEW else None
        if match is not None:
            _read_shape(
                columns,
                alike,
                match,
                digits,
                lines if alike is rows else _Lines.make_lines(starts[alike]),
            )
        rare += len(alike) < _FEW
        rows = rows[~same]


class _Lines(NamedTuple):
    """Positions of lines in a text, as the indices of their first characters.

    ``characters_per_line`` is the distance between lines in characters, or 0 if the distance varies.
    """

    first: IntArray
    characters_per_line: int

    @classmethod
    def make_lines(cls, first: IntArray) -> _Lines:
        """Return the lines that start at these characters, in ascending order."""
        steps = np.diff(first)
        return cls(first, int(steps[0]) if len(steps) and (steps == steps[0]).all() else 0)

    def get_characters(self, text: DigitArray, at: int) -> DigitArray:
        """Return the character at column index ``at`` of each line."""
        if not self.characters_per_line:
            return text.take(self.first + at)
        return text[self.first[0] + at : self.first[-1] + at + 1 : self.characters_per_line]


def _read_shape(
    columns: LineColumns, rows: IntArray, match: re.Match[str], digits: DigitArray, lines: _Lines
) -> None:
    """Parse the lines ``rows``, which all have the form of ``match``, into the columns."""
    known = np.ones(len(rows), bool)
    for name, column in (("x", columns.x), ("z", columns.z), ("f", columns.feeds)):
        if match[name] is not None:
            column[rows] = _numbers(match, name, lines, digits)
    if match["f"] is not None:
        known &= columns.feeds[rows] > 0.0
    if match["g"] is not None:
        at = match.start("g")
        columns.g_codes[rows] = lines.get_characters(digits, at) - ord("0")
        known &= (lines.get_characters(digits, at - 1) == ord("0")) & (columns.g_codes[rows] <= 1)
    columns.has_fifth_decimal[rows] = _is_fine(match.string)
    columns.is_plain_move[rows] = known


def _numbers(match: re.Match[str], name: str, lines: _Lines, digits: DigitArray) -> FloatArray:
    """Return the numbers of one word in these lines, rounded like the results of ``float``.

    A number is the quotient of its digits, as a whole number, and a power of ten. Both are exact, so the
    quotient equals the result of ``float``.
    """
    text, start = match[name], match.start(name)
    whole = np.zeros(len(lines.first), np.int32)  # at most nine digits
    for at, character in enumerate(text, start=start):
        if character.isdigit():
            whole *= 10
            whole += lines.get_characters(digits, at)
            whole -= ord("0")
    decimals = len(text) - text.index(".") - 1 if "." in text else 0
    value: FloatArray = whole / 10.0**decimals
    return -value if text.startswith("-") else value


class ExecutableLines(Sequence[ExecutableLine]):
    """The lines of a program, indexed from 0.

    Plain moves are in ``columns``, and all other lines are statements.
    """

    def __init__(self, columns: LineColumns, statements: dict[int, ExecutableLine]) -> None:
        self.columns = columns
        self._others = statements
        self._pages: dict[int, list[ExecutableLine]] = {}

    def copy_lines(self) -> ExecutableLines:
        """Return a copy with independent lines and shared arrays of numbers."""
        return ExecutableLines(
            self.columns._replace(is_plain_move=self.columns.is_plain_move.copy()), self._others.copy()
        )

    def __len__(self) -> int:
        return len(self.columns.is_plain_move)

    @overload
    def __getitem__(self, at: int) -> ExecutableLine: ...
    @overload
    def __getitem__(self, at: slice) -> list[ExecutableLine]: ...
    def __getitem__(self, at: int | slice) -> ExecutableLine | list[ExecutableLine]:
        if isinstance(at, slice):
            return [self[k] for k in range(len(self))[at]]
        page = self._pages.get(at // _PAGE) or self._page(at // _PAGE)
        return page[at % _PAGE]

    def __setitem__(self, at: int, line: ExecutableLine) -> None:
        """Replace a line, which is then no longer stored in the columns."""
        self._others[at] = self._page(at // _PAGE)[at % _PAGE] = line
        self.columns.is_plain_move[at] = False

    def __iter__(self) -> Iterator[ExecutableLine]:
        for number in range(-(-len(self) // _PAGE)):
            yield from self._page(number)

    def find_next_statement(self, index: int) -> int:
        """Return the index of the next line that is not a plain move.

        The search ends after MAX_RUN_LENGTH lines.
        """
        known = self.columns.is_plain_move[index : index + MAX_RUN_LENGTH]
        first = int(known.argmin()) if len(known) else 0
        return index + (len(known) if len(known) and known[first] else first)

    def _page(self, number: int) -> list[ExecutableLine]:
        if number not in self._pages:
            if len(self._pages) >= _PAGES:
                del self._pages[next(iter(self._pages))]
            self._pages[number] = self._made(number)
        return self._pages[number]

    def _made(self, number: int) -> list[ExecutableLine]:
        lines = range(number * _PAGE, min((number + 1) * _PAGE, len(self)))
        moves = self.columns.select_lines(slice(lines.start, lines.stop)).list_moves()
        return [self._others[at] if move is None else move for at, move in zip(lines, moves, strict=True)]


def _joined(lines: Sequence[str], these: range) -> str:
    return (
        lines.join_lines(these)
        if isinstance(lines, LazyLines)
        else "\n".join(lines[these.start : these.stop])
    )


def parse_lines(
    lines: Sequence[str], parse_line: Callable[[int, str], ExecutableLine], *, reads_every_line: bool
) -> ExecutableLines:
    """Parse the lines of a program, and return them ready for execution.

    Plain moves are parsed together. ``parse_line`` parses each other line from its number, counted from 1,
    and its text. If ``reads_every_line`` is True, ``parse_line`` parses every line, because the meaning of
    a line depends on earlier lines.
    """
    columns = LineColumns.make_empty(len(lines))
    others: dict[int, ExecutableLine] = {}
    for first in range(0, len(lines), MAX_RUN_LENGTH):
        part = columns.select_lines(slice(first, first + MAX_RUN_LENGTH))
        if not reads_every_line:
            parse_columns(_joined(lines, range(first, min(first + MAX_RUN_LENGTH, len(lines)))), part)
        for at in np.flatnonzero(~part.is_plain_move).tolist():
            line = parse_line(first + at + 1, lines[first + at])
            if isinstance(line, tuple):
                part.store_line(at, line)
            else:
                others[first + at] = line
    return ExecutableLines(columns, others)
