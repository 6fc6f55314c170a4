"""What a program takes over from the job before it: unit and rapid rate, unless its first line says them."""

from __future__ import annotations

import re

from core.language.dialect import Dialect
from core.language.source import Source

UNITS, RAPID = "units", "rapid"

_COMMENT = re.compile(r"\([^)]*\)?")
_UNIT = re.compile(r"G7[01](?![0-9])")
_RATE = re.compile(r"F[0-9.]")
_PER_REV = re.compile(r"G95(?![0-9])")


def carried(source: Source) -> frozenset[str]:
    """``units`` and ``rapid``, as far as they come from before; other dialects say all themselves."""
    if source.dialect is not Dialect.OMNITURN:
        return frozenset()
    first = next((words for words in map(_words, source.lines) if words), "")
    found = set()
    if not _UNIT.search(first):
        found.add(UNITS)
    if not _RATE.search(first) or _PER_REV.search(first):
        found.add(RAPID)
    return frozenset(found)


def _words(line: str) -> str:
    return _COMMENT.sub("", line).replace(" ", "").upper()
