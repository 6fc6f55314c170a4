"""The lines of a long program: numbers in columns where they are plain moves, tuples where somebody asks."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import overload

import numpy as np

from core.interpreter.columns import Columns, read_columns
from core.interpreter.statement import Step

MOST = 20_000
"""Lines that are read, and handed on, at once."""

_PAGE, _PAGES = 1024, 32


class LongSteps(Sequence[Step]):
    """A list of steps at a tenth of a list's memory while moves are taken from ``columns``.

    ``rare`` are the lines that stand in no column.
    """

    def __init__(self, columns: Columns, rare: dict[int, Step]) -> None:
        self.columns = columns
        self._rare = rare
        self._pages: dict[int, list[Step]] = {}
        index = np.arange(len(columns.known))
        other = np.where(columns.known, len(index), index)
        self._stop = np.minimum.accumulate(other[::-1])[::-1].copy()

    def copy(self) -> LongSteps:
        """Lines of their own, the numbers in them are shared."""
        known = self.columns.known.copy()
        return LongSteps(self.columns._replace(known=known), self._rare.copy())

    def __len__(self) -> int:
        return len(self._stop)

    @overload
    def __getitem__(self, at: int) -> Step: ...
    @overload
    def __getitem__(self, at: slice) -> list[Step]: ...
    def __getitem__(self, at: int | slice) -> Step | list[Step]:
        if isinstance(at, slice):
            return [self[k] for k in range(len(self))[at]]
        page = self._pages.get(at // _PAGE) or self._page(at // _PAGE)
        return page[at % _PAGE]

    def __setitem__(self, at: int, step: Step) -> None:
        """A line that no column holds from now on."""
        self._rare[at] = self._page(at // _PAGE)[at % _PAGE] = step
        self.columns.known[at] = False
        self._stop[max(0, at - MOST) : at + 1].clip(max=at, out=self._stop[max(0, at - MOST) : at + 1])

    def __iter__(self) -> Iterator[Step]:
        for number in range(-(-len(self) // _PAGE)):
            yield from self._pages.get(number) or self._made(number)

    def moves_until(self, at: int) -> int:
        """The next line that is no plain move, or one that is MOST or more away."""
        return int(self._stop[at])

    def _page(self, number: int) -> list[Step]:
        if number not in self._pages:
            if len(self._pages) >= _PAGES:
                del self._pages[next(iter(self._pages))]
            self._pages[number] = self._made(number)
        return self._pages[number]

    def _made(self, number: int) -> list[Step]:
        lines = range(number * _PAGE, min((number + 1) * _PAGE, len(self)))
        moves = self.columns.part(slice(lines.start, lines.stop)).steps()
        return [self._rare[at] if move is None else move for at, move in zip(lines, moves, strict=True)]


Steps = list[Step] | LongSteps
"""The lines of a program, from index 0."""


def read_steps(lines: Sequence[str], read: Callable[[int, str], Step]) -> LongSteps:
    """The lines ready to run; ``read`` is asked, in order, for each that is no regular move."""
    parts: list[Columns] = []
    rare: dict[int, Step] = {}
    for first in range(0, len(lines), MOST):
        texts = lines[first : first + MOST]
        part = read_columns(texts)
        for at in np.flatnonzero(~part.known).tolist():
            rare[first + at] = read(first + at + 1, texts[at])
        parts.append(part)
    return LongSteps(Columns._make(map(np.concatenate, zip(*parts, strict=True))), rare)
