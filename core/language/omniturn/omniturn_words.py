"""Words and lines of OmniTurn programs, with the ranges of their numbers."""

from __future__ import annotations

from typing import NamedTuple

from core.language.diagnostics import Diagnostic

WHOLE_NUMBER_LETTERS = frozenset({"T", "D", "P", "LS", "}"})
"""Words whose value is a count, which must be whole and unsigned."""

LETTERS_WITHOUT_NUMBER = frozenset({"LF", "RF", "P", "C", "O"})
"""Words that can have no number."""

VALUE_RANGES: dict[str, tuple[float, float]] = {
    **dict.fromkeys(("X", "Z", "I", "K", "U", "A", "R", "C"), (-10_000.0, 10_000.0)),
    **dict.fromkeys(("CA", "CI"), (-1_000_000.0, 1_000_000.0)),
    "F": (0.000001, 100_000.0),
    "S": (-100_000.0, 100_000.0),
    "L": (0.0, 100_000.0),
    "T": (0.0, 32.0),
    "D": (0.0, 32.0),
    "P": (1.0, 9_999.0),
    "}": (1.0, 9_999.0),
    "LS": (1.0, 1_000_000_000.0),
    "G": (0.0, 99.0),
    "M": (0.0, 99.0),
}
"""Words of the OmniTurn language, with the lowest and highest value in any unit."""


class Word(NamedTuple):
    """One word of a line.

    ``letter`` is in upper case; LS, LF, RF, CA, CI and } count as letters. ``value`` is the number of the
    word, or None without a number. ``column`` is the column of the letter, from 1. ``text`` is the word as
    written, without blanks.
    """

    letter: str
    value: float | None
    column: int
    text: str


class LexedLine(NamedTuple):
    """One line of a program, split into words.

    ``text`` is the code as written, without blanks and comment. ``line_number`` counts from 1. ``comment`` is
    None if the line has no parenthesis, and ``comment_column`` is the column of the parenthesis. A line
    with ``errors`` must not be executed.
    """

    line_number: int
    words: tuple[Word, ...] = ()
    comment: str | None = None
    comment_column: int = 0
    has_block_delete: bool = False
    text: str = ""
    errors: tuple[Diagnostic, ...] = ()
