"""Search for a word in the bytes of a long program."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
_DIGITS, _DIGITS_AND_DOT = b"0123456789", b"0123456789."
_FEW = 20_000  # matches
_LETTERS = b"ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def find_byte_matches(text: bytes, word: bytes, *, matches_whole_words: bool) -> tuple[tuple[int, ...], int]:
    """Return the start positions of the matches of a word, and the number including parts of words.

    The search does not distinguish upper and lower case. ``matches_whole_words`` excludes the matches inside
    longer words and numbers from the positions. Matches do not overlap.
    """
    text, word = text.upper() + b"\0\0", word.upper()
    count = text.count(word)
    if not count:
        return (), 0
    places = _find_few(text, word) if count <= _FEW else _find_many(np.frombuffer(text, np.uint8), word)
    if matches_whole_words:
        places = _select_whole_words(np.frombuffer(text, np.uint8), places, word)
    return _drop_overlaps(places, len(word)), count


def _find_few(text: bytes, word: bytes) -> NDArray[np.intp]:
    """Return all start positions of a word. This is fast if the text contains few of them."""
    found, at = [], text.find(word)
    while at >= 0:
        found.append(at)
        at = text.find(word, at + 1)
    return np.array(found, np.intp)


def _find_many(data: Bytes, word: bytes) -> NDArray[np.intp]:
    """Return all start positions of a word, beginning with the rarest byte of the word."""
    sample = data[: 1 << 16]
    rare = min(range(len(word)), key=lambda at: np.count_nonzero(sample == word[at]))
    places: NDArray[np.intp] = np.flatnonzero(data[rare : len(data) - len(word) + 1 + rare] == word[rare])
    for at in range(len(word)):
        if at != rare:
            places = places[data[places + at] == word[at]]
    return places


def _select_whole_words(data: Bytes, places: NDArray[np.intp], word: bytes) -> NDArray[np.intp]:
    """Return the positions at which a word is not part of a longer word or number.

    Two zero bytes follow the text in ``data``.
    """
    first, last = word[:1], word[-1:]
    forbidden = _DIGITS_AND_DOT if first in _DIGITS_AND_DOT else _LETTERS if first.isalpha() else b""
    if forbidden:
        preceding = data[np.maximum(places - 1, 0)]
        places = places[(places == 0) | ~_is_any_of(preceding, forbidden)]
    after = places + len(word)
    if last in _DIGITS_AND_DOT:
        decimal = (data[after] == ord(".")) & _is_any_of(data[after + 1], _DIGITS)
        is_longer: NDArray[np.bool_] = _is_any_of(data[after], _DIGITS) | decimal
        return places[~is_longer]
    if last.isalpha():
        return places[~_is_any_of(data[after], _LETTERS)]
    return places


def _is_any_of(data: Bytes, values: bytes) -> NDArray[np.bool_]:
    table = np.zeros(256, np.bool_)
    table[list(values)] = True
    return table[data]


def _drop_overlaps(places: NDArray[np.intp], length: int) -> tuple[int, ...]:
    """Return the positions without those that overlap an earlier match."""
    found: list[int] = places.tolist()
    if len(places) < 2 or int(np.diff(places).min()) >= length:
        return tuple(found)
    free, end = [], -1
    for at in found:
        if at >= end:
            free.append(at)
            end = at + length
    return tuple(free)
