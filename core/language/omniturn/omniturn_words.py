"""What an OmniTurn line is made of: words, each a letter and a number, and what a number may be."""

from __future__ import annotations

from typing import NamedTuple

from core.language.diagnostics import Diagnostic

COUNTING = frozenset({"T", "D", "P", "LS", "}"})
"""Words whose number counts something: whole and unsigned."""

BARE = frozenset({"LF", "RF", "P", "C", "O"})
"""Words that may stand without a number."""

RANGES: dict[str, tuple[float, float]] = {
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
"""Words of the language, and between what their numbers must lie in any unit."""


class Word(NamedTuple):
    """One word. ``letter`` is upper case (``LS LF RF CA CI`` and ``}`` count as letters), ``value`` its
    number or None where it has none, ``column`` of its letter from 1, ``text`` as written without blanks."""

    letter: str
    value: float | None
    column: int
    text: str


class Line(NamedTuple):
    """One line of source. ``text`` is its code as written, without blanks and comment; ``number`` from 1.

    ``comment`` is None where there is no parenthesis, ``comment_column`` that of the parenthesis.
    ``errors`` tells what could not be read; such a line must not run.
    """

    number: int
    words: tuple[Word, ...] = ()
    comment: str | None = None
    comment_column: int = 0
    block_delete: bool = False
    text: str = ""
    errors: tuple[Diagnostic, ...] = ()
