"""Codes of the language that this control does not execute yet: refused, never skipped.

This table is the only place that knows; a code that learns to run is taken out of it.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.language.diagnostics import Diagnostic, Severity
from core.language.omniturn.words import Word

G_CODES: dict[int, str] = {
    **dict.fromkeys((40, 41, 42), "nose radius compensation"),
    **dict.fromkeys((75, 78), "cycles"),
}
WORDS: dict[str, str] = {"RF": "cycles"}
CORNERS: dict[str, str] = {"R": "corners"}
"""Words on a line without a one-shot code; C too, where it does not turn a locked spindle."""


def not_yet(number: int, words: Sequence[Word]) -> Diagnostic | None:
    """The refusal for a line with these words, or None where all of them can run."""
    corner: tuple[int, str, str] | None = None
    for letter, value, column, text in words:
        if letter == "G":
            what = G_CODES.get(int(value or 0))
        elif letter in CORNERS:
            corner = corner or (column, text, CORNERS[letter])
            continue
        else:
            what = WORDS.get(letter)
        if what is not None:
            return _refusal(number, column, text, what)
    if corner is not None and not any(_takes_corner_letters(word) for word in words):
        return _refusal(number, *corner)
    return None


def _takes_corner_letters(word: Word) -> bool:
    """G02, G03 and G83 have an R of their own, G33, G83 and M97 a C."""
    return (word.letter == "G" and word.value in {2, 3, 33, 83}) or (word.letter == "M" and word.value == 97)


def corner_not_yet(made_line: int, word: Word) -> Diagnostic:
    """The refusal for a C that is a corner: the spindle is not locked."""
    return _refusal(made_line, word.column, word.text, "corners")


def _refusal(line: int, column: int, text: str, what: str) -> Diagnostic:
    message = f"{text} belongs to {what}, which this version does not execute yet."
    return Diagnostic(line, column, Severity.ERROR, "not-yet", message, "Take the line out.")
