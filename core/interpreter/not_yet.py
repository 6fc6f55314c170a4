"""Codes of the language that this control does not execute yet: refused, never skipped.

This table is the only place that knows; a code that learns to run is taken out of it.
"""

from __future__ import annotations

from collections.abc import Sequence

from core.language.diagnostics import Diagnostic, Severity
from core.language.omniturn.words import Word

G_CODES: dict[int, str] = {}
WORDS: dict[str, str] = {}


def not_yet(number: int, words: Sequence[Word]) -> Diagnostic | None:
    """The refusal for a line with these words, or None where all of them can run."""
    for letter, value, column, text in words:
        what = G_CODES.get(int(value or 0)) if letter == "G" else WORDS.get(letter)
        if what is not None:
            return _refusal(number, column, text, what)
    return None


def _refusal(line: int, column: int, text: str, what: str) -> Diagnostic:
    message = f"{text} belongs to {what}, which this version does not execute yet."
    return Diagnostic(line, column, Severity.ERROR, "not-yet", message, "Take the line out.")
