"""Generator of the OmniTurn code book, which contains all codes of the code table by chapter."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from core.interpreter.omniturn.codes.code_entry import (
    EXAMPLE_HEAD,
    EXAMPLE_TAIL,
    CodeEntry,
    WordLimit,
    WordRule,
)
from core.interpreter.omniturn.codes.code_table import CODE_CHAPTERS
from core.language.code_book import CodeBook, CodeBookEntry

_PLAIN = {
    "X": "the X coordinate",
    "Z": "the Z coordinate",
    "F": "the feed",
    "S": "rpm",
    "P": "the subroutine number",
    "A": "taper: X travel over the thread length",
    "G02.I": "the arc center in X",
    "G02.K": "the arc center in Z",
    "G03.I": "the arc center in X",
    "G03.K": "the arc center in Z",
    "G10.X": "the shift in X",
    "G10.Z": "the shift in Z",
    "G94.F": "the feed per minute",
    "G95.F": "the feed per revolution",
    "G83.R": "the Z position to which the drill retracts",
}
"""Descriptions of words that no code entry describes."""


def build_code_book() -> CodeBook:
    """Return the code book with all entries of the code table, grouped by chapter."""
    chapters = tuple((title, tuple(map(_entry, codes))) for title, codes in CODE_CHAPTERS)
    meanings = dict(each for _, codes in CODE_CHAPTERS for code in codes for each in _meanings(code))
    return CodeBook(chapters, EXAMPLE_HEAD, EXAMPLE_TAIL, "(", _PLAIN | meanings, r"[A-Z](?=n|O|$)")


def _entry(code: CodeEntry) -> CodeBookEntry:
    head = _head(code)
    words = code.syntax.removeprefix(head) if code.syntax.startswith(head) else code.syntax
    return CodeBookEntry(head, words.strip(), code.description, code.example, behind=code.example_subroutine)


def _head(code: CodeEntry) -> str:
    return code.name.rstrip("()") or code.syntax


def _meanings(code: CodeEntry) -> Iterator[tuple[str, str]]:
    for letter, rule in code.word_rules.items():
        yield f"{_head(code)}.{letter}", rule.description + _range(rule)


def _range(rule: WordRule) -> str:
    """Return the range of a word as text.

    The result is an empty string unless the rule has a fixed minimum and a fixed maximum.
    """
    most = rule.maximum
    if isinstance(most, WordLimit) or not (isfinite(most) and isfinite(rule.minimum)):
        return ""
    return f": {rule.minimum:g} … {most:g}"
