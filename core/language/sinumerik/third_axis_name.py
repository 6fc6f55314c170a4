"""The third axis by the name that the machine's builder has given it: B, Y or Q1 in the place of C.

Inside it is C all the same: its words are read as those of C, and told as they are written.
"""

from __future__ import annotations

import re
from functools import lru_cache

OWN = "C"


def words_as_c(text: str, name: str) -> tuple[str, int]:
    """A line's code, in capitals, with the words of the axis ``name`` as words of C at the same columns.

    Beside it the index of a word of C, which this machine has not; -1 without one.
    """
    own = _pattern(OWN).search(text)
    pieces = text.split('"')  # every other one is a text in quotes
    pieces[::2] = [_pattern(name).sub(OWN.ljust(len(name)), piece) for piece in pieces[::2]]
    return '"'.join(pieces), own.start() if own and text.count('"', 0, own.start()) % 2 == 0 else -1


@lru_cache(maxsize=16)
def _pattern(name: str) -> re.Pattern[str]:
    """A word of the axis: with = behind it, or for a single letter a number."""
    behind = r"\s*=(?!=)" if len(name) > 1 else r"(?:\s*=(?!=)|[-+]?\.?[0-9]+(?![0-9]*\s*=))"
    return re.compile(rf"(?<![A-Z_$]){name}(?={behind})")
