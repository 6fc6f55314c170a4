"""Code book of OmniTurn, generated from its code table."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from core.interpreter.omniturn.codes.code_entry import HEAD, TAIL, Code, Limit, WordRule
from core.interpreter.omniturn.codes.code_table import CHAPTERS
from core.language.code_book import CodeBook, Entry

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
"""Words for whose numbers no entry has a rule."""


def book() -> CodeBook:
    """Return the code book with all entries of the table by chapter."""
    chapters = tuple((title, tuple(map(_entry, codes))) for title, codes in CHAPTERS)
    meanings = dict(each for _, codes in CHAPTERS for code in codes for each in _meanings(code))
    return CodeBook(chapters, HEAD, TAIL, "(", _PLAIN | meanings, r"[A-Z](?=n|O|$)")


def _entry(code: Code) -> Entry:
    head = _head(code)
    words = code.form.removeprefix(head) if code.form.startswith(head) else code.form
    return Entry(head, words.strip(), code.what, code.example, behind=code.subroutine)


def _head(code: Code) -> str:
    return code.name.rstrip("()") or code.form


def _meanings(code: Code) -> Iterator[tuple[str, str]]:
    for letter, rule in code.rules.items():
        yield f"{_head(code)}.{letter}", rule.what + _range(rule)


def _range(rule: WordRule) -> str:
    """Return the range of a word as text if the entry has both limits; otherwise an empty text."""
    most = rule.most
    if isinstance(most, Limit) or not (isfinite(most) and isfinite(rule.least)):
        return ""
    return f": {rule.least:g} … {most:g}"
