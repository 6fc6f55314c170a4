"""Find and replace: where a text stands, how often, and what taking its place would leave."""

from __future__ import annotations

import re
from bisect import bisect_left
from dataclasses import dataclass

from core.message import Message


@dataclass(frozen=True, slots=True)
class Search:
    """``needle`` in any case of letters.

    ``whole`` leaves out what goes on beyond it: F100 is then not found in F1000 nor in F100.5, since whoever
    replaces F100 by F300 does not mean those.
    """

    needle: str
    whole: bool = True

    def places(self, text: str) -> tuple[int, ...]:
        """Where it begins, from 0, none overlapping another."""
        if not self.needle:
            return ()
        return tuple(match.start() for match in re.finditer(self._pattern, text))

    @property
    def _pattern(self) -> str:
        pattern = "(?i)" + re.escape(self.needle)
        if not self.whole:
            return pattern
        if self.needle[0] in "0123456789.":
            pattern = "(?i)(?<![0-9.])" + re.escape(self.needle)
        elif self.needle[0].isalpha():
            pattern = "(?i)(?<![A-Za-z])" + re.escape(self.needle)
        if self.needle[-1] in "0123456789.":
            return pattern + r"(?![0-9]|\.[0-9])"
        return pattern + "(?![A-Za-z])" if self.needle[-1].isalpha() else pattern

    def inside(self, text: str) -> int:
        """How many more there are inside longer words and numbers."""
        return len(Search(self.needle, whole=False).places(text)) - len(self.places(text))

    def words(self, text: str) -> str:
        """The count as the screen tells it."""
        count = len(self.places(text))
        found = Message("{count} FOUND", count=count) if count else "NOT FOUND"
        if not self.whole:
            return Message("{value}, INCLUDING PARTS OF WORDS", value=found)
        more = self.inside(text)
        return (
            Message("{value}; {more} MORE ARE PARTS OF LONGER WORDS", value=found, more=more)
            if more
            else found
        )


def following(places: tuple[int, ...], at: int) -> int | None:
    """The first place from ``at`` on, going on at the top; None when there is none."""
    if not places:
        return None
    return places[bisect_left(places, at) % len(places)]


def preceding(places: tuple[int, ...], at: int) -> int | None:
    """The last place before ``at``, going on at the end; None when there is none."""
    return places[bisect_left(places, at) - 1] if places else None
