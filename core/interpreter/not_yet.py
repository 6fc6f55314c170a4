"""Codes of the language that this control does not execute yet: refused, never skipped.

This table is the only place that knows; a code that learns to run is taken out of it.
"""

from __future__ import annotations

from collections.abc import Iterable

from core.language.diagnostics import Diagnostic, Severity
from core.language.omniturn.words import Word

G_CODES: dict[int, str] = {
    **dict.fromkeys((40, 41, 42), "nose radius compensation"),
    **dict.fromkeys((74, 75, 78, 81, 83), "cycles"),
    **dict.fromkeys((33, 34), "threading"),
    **dict.fromkeys((35, 36), "coarse feeds"),
    89: "spindle positioning",
}
M_CODES: dict[int, str] = dict.fromkeys((19, 89), "spindle positioning")
WORDS: dict[str, str] = {"RF": "cycles", "CA": "spindle positioning", "CI": "spindle positioning"}
CORNERS: dict[str, str] = {"C": "corners and spindle positioning", "R": "corners"}
"""Words on a line without a one-shot code."""
COMMENTS: tuple[str, ...] = ("~PLXC", "~PLZC")


def not_yet(number: int, words: Iterable[Word], comment: str | None) -> Diagnostic | None:
    """The refusal for a line with these words, or None where all of them can run."""
    if comment is not None and comment.strip().upper() in COMMENTS:
        return _refusal(number, 1, f"({comment.strip().upper()})", "plane switching")
    plain_line = not any(_one_shot(word) for word in words)
    for word in words:
        what = _feature(word, plain_line=plain_line)
        if what is not None:
            return _refusal(number, word.column, word.text, what)
    return None


def _one_shot(word: Word) -> bool:
    return (word.letter == "G" and word.value in {2, 3}) or (word.letter == "M" and word.value == 97)


def _feature(word: Word, *, plain_line: bool) -> str | None:
    if word.letter == "G" and word.value is not None:
        return G_CODES.get(int(word.value))
    if word.letter == "M" and word.value is not None:
        return M_CODES.get(int(word.value))
    return WORDS.get(word.letter) or (CORNERS.get(word.letter) if plain_line else None)


def _refusal(line: int, column: int, text: str, what: str) -> Diagnostic:
    message = f"{text} belongs to {what}, which this version does not execute yet."
    return Diagnostic(line, column, Severity.ERROR, "not-yet", message, "Take the line out.")
