"""Lazy sequence of the lines of a long text.

A list of a million lines would take 70 MB and 0.1 s.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import overload

import numpy as np

_CHUNK_SIZE = 20_000  # lines
_NEW_LINE = ord("\n")


class LazyLines(Sequence[str]):
    """The lines of an ASCII text, without line ends. Lines are split only when they are accessed.

    An empty line after the final line end does not count.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        ends = np.flatnonzero(np.frombuffer(text.encode("ascii"), np.uint8) == _NEW_LINE)
        if not text.endswith("\n"):
            ends = np.append(ends, len(text))
        self._starts = np.concatenate([[0], ends + 1])  # includes the start of the line after the last line

    def __len__(self) -> int:
        return len(self._starts) - 1

    @overload
    def __getitem__(self, at: int) -> str: ...
    @overload
    def __getitem__(self, at: slice) -> Sequence[str]: ...
    def __getitem__(self, at: int | slice) -> str | Sequence[str]:
        if not isinstance(at, slice):
            at = range(len(self))[at]
            return self._text[self._starts[at] : self._starts[at + 1] - 1]
        there = range(len(self))[at]
        if there.step != 1:
            return [self[k] for k in there]
        return self.join_lines(there).split("\n") if there else []

    def join_lines(self, lines: range) -> str:
        """Return one or more lines as one text with line ends.

        This is faster than joining individual lines.
        """
        return self._text[self._starts[lines.start] : self._starts[lines.stop] - 1]

    def __iter__(self) -> Iterator[str]:
        for first in range(0, len(self), _CHUNK_SIZE):
            yield from self[first : first + _CHUNK_SIZE]
