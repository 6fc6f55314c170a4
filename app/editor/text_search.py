"""Search for a text in a program of any length. It does not use Qt."""

from __future__ import annotations

import re
from bisect import bisect_left
from dataclasses import dataclass

from core.message import Message

LONG_TEXT_LENGTH = 1_000_000  # characters of a text that is proved and searched only after a pause in typing
_LONG_TEXT = 100_000  # characters; longer texts are searched with numpy


@dataclass(frozen=True, slots=True)
class TextSearch:
    """Case-insensitive search for ``search_text``.

    ``matches_whole_words`` excludes matches inside longer words and numbers. A search for F100 then skips
    F1000 and F100.5, and replacing F100 does not change them.
    """

    search_text: str
    matches_whole_words: bool = True

    def find_matches(self, text: str) -> tuple[int, ...]:
        """Return the start positions of the matches in the text.

        Positions count from 0, and matches do not overlap.
        """
        return self.find_and_count_matches(text)[0]

    def find_and_count_matches(self, text: str) -> tuple[tuple[int, ...], int]:
        """Return the start positions of the matches, and the number including parts of words.

        In a long text, characters that are not Latin-1 are compared as question marks.
        """
        if not self.search_text:
            return (), 0
        if len(text) >= _LONG_TEXT and self.search_text.isascii() and "?" not in self.search_text:
            from app.editor.byte_search import find_byte_matches  # noqa: PLC0415  with numpy

            data, word = text.encode("latin-1", "replace"), self.search_text.encode("ascii")
            return find_byte_matches(data, word, matches_whole_words=self.matches_whole_words)
        plain = len(re.findall("(?i)" + re.escape(self.search_text), text))
        return tuple(match.start() for match in re.finditer(self._pattern, text)), plain

    @property
    def _pattern(self) -> str:
        pattern = "(?i)" + re.escape(self.search_text)
        if not self.matches_whole_words:
            return pattern
        if self.search_text[0] in "0123456789.":
            pattern = "(?i)(?<![0-9.])" + re.escape(self.search_text)
        elif self.search_text[0].isalpha():
            pattern = "(?i)(?<![A-Za-z])" + re.escape(self.search_text)
        if self.search_text[-1] in "0123456789.":
            return pattern + r"(?![0-9]|\.[0-9])"
        return pattern + "(?![A-Za-z])" if self.search_text[-1].isalpha() else pattern

    def words(self, text: str) -> str:
        """Return a message for the operator with the number of matches in the text."""
        places, count_with_parts = self.find_and_count_matches(text)
        return self.describe_count(len(places), count_with_parts)

    def describe_count(self, count: int, count_with_parts: int) -> str:
        """Return a message for the operator with the numbers of matches without and with parts of words."""
        found = Message("{count} FOUND", count=count) if count else "NOT FOUND"
        if not self.matches_whole_words:
            return Message("{value}, INCLUDING PARTS OF WORDS", value=found)
        more = count_with_parts - count
        return (
            Message("{value}; {more} MORE ARE PARTS OF LONGER WORDS", value=found, more=more)
            if more
            else found
        )


def following(positions: tuple[int, ...], start: int) -> int | None:
    """Return the first match position at or after ``start``, wrapping to the first position.

    Returns None if there are no positions.
    """
    if not positions:
        return None
    return positions[bisect_left(positions, start) % len(positions)]


def find_preceding_position(positions: tuple[int, ...], start: int) -> int | None:
    """Return the last match position before ``start``, wrapping to the last position.

    Returns None if there are no positions.
    """
    return positions[bisect_left(positions, start) - 1] if positions else None
