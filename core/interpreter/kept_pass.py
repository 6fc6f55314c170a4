"""A pass as it stands between two blocks, kept so that another one goes on from it: MDI, block search.

What a language has in force lies in the parts of its interpreter. They are copied whole, so that nothing that
a family of codes adds can be forgotten here.
"""

from __future__ import annotations

from copy import deepcopy
from itertools import count
from typing import Generic, NamedTuple, TypeVar

Parts = TypeVar("Parts")
_numbers = count(1)


class StateLine(NamedTuple):
    """One group of what is in force, in the words of the control; ``key`` names it for whoever shows it."""

    key: str
    value: str


class KeptPass(Generic[Parts]):
    """The parts of an interpreter between two blocks. Equal to itself alone; its text tells it from others.

    ``shared`` are objects that are not copied: the circumstances, the log, texts that have been read.
    """

    def __init__(self, parts: Parts, shared: tuple[object, ...], lines: tuple[StateLine, ...] = ()) -> None:
        self._shared = shared
        self._parts = deepcopy(parts, {id(each): each for each in self._shared})
        self._number = next(_numbers)
        self.lines = lines

    def __repr__(self) -> str:
        return f"KeptPass {self._number}"

    def parts(self, *instead: object) -> Parts:
        """A copy to go on with, in which ``instead`` take the places of the first shared objects."""
        places = (*instead, *self._shared[len(instead) :])
        return deepcopy(self._parts, {id(old): new for old, new in zip(self._shared, places, strict=True)})
