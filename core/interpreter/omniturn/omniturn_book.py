"""The code book of OmniTurn, from its code table."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from core.interpreter.omniturn.code_entry import HEAD, TAIL, Code, Limit, WordRule
from core.interpreter.omniturn.code_table import CHAPTERS
from core.language.code_book import CodeBook, Entry

_PLAIN = {
    "X": "the point in X",
    "Z": "the point in Z",
    "F": "the feed",
    "S": "rpm",
    "P": "the number of the subroutine",
    "A": "taper: X over the whole way",
    "G02.I": "the centre in X",
    "G02.K": "the centre in Z",
    "G03.I": "the centre in X",
    "G03.K": "the centre in Z",
    "G10.X": "by how much X is shifted",
    "G10.Z": "by how much Z is shifted",
    "G94.F": "the feed a minute",
    "G95.F": "the feed a turn",
    "G83.R": "Z to which the drill comes out",
}
"""Words for whose numbers no entry has a rule."""


def book() -> CodeBook:
    """Every entry of the table by its chapter."""
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
    """Between what its number lies, where the entry says both ends."""
    most = rule.most
    if isinstance(most, Limit) or not (isfinite(most) and isfinite(rule.least)):
        return ""
    return f": {rule.least:g} … {most:g}"
