"""What stands behind a letter, behind = or in brackets: a number or an R parameter, and what it may be."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.sinumerik import vocabulary as known
from core.language.sinumerik.words import Word

NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
PARAMETER = re.compile(r"R([0-9]+)")
_LONGEST_CODE = 4  # digits


class Value(NamedTuple):
    """A number, or the number of the R parameter that gives it; and where it ends."""

    number: float | None
    r: int | None
    end: int


def value_at(text: str, at: int) -> Value | None:
    """The value that begins at this place; None where none does."""
    r = PARAMETER.match(text, at)
    if r is not None:
        number = int(r[1][:9])
        return Value(None, number, r.end()) if number <= known.MOST_R else None
    match = NUMBER.match(text, at)
    return None if match is None else Value(float(match[0]), None, match.end())


def beyond(word: Word) -> tuple[str, str] | None:
    """What is wrong with the number of a word, and what to do; None where nothing is."""
    if word.value is None:
        return None
    if word.name in {"G", "M"}:
        digits = word.text[1:]
        if digits.isdigit() and len(digits) <= _LONGEST_CODE:
            return None
        return f"{word.text} is no code", "Codes are whole numbers of up to four digits."
    low, high = known.REACH["R" if PARAMETER.fullmatch(word.name) else word.name]
    if low <= word.value <= high:
        return None
    return f"{word.text} is out of range", f"{word.name} lies between {low:g} and {high:g}."
