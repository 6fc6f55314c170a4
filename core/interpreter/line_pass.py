"""A pass that takes one line after the other from its flow, and can stop before any: Klartext, SINUMERIK."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from typing import Generic, Protocol, TypeVar

from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block
from core.interpreter.interpretation import MOST_BLOCKS, MOST_LINES, MOST_LINES_WITHOUT_BLOCK, Interpretation


class Numbered(Protocol):
    """A line of a program; ``number`` from 1."""

    @property
    def number(self) -> int: ...


Line = TypeVar("Line", bound=Numbered)


class LinePass(Interpretation, Generic[Line]):
    """The lines of a program in the order in which they are executed, up to the limits of a program."""

    def __init__(self, log: Log) -> None:
        super().__init__(log)
        self._approach: Iterator[Block] = iter(())
        self._taken: Line | None = None  # a line at which block search has stopped
        self._left = MOST_LINES
        self._made = 0  # blocks so far

    @abstractmethod
    def _can_stop(self, line: Line) -> bool:
        """Whether block search may stop before this line: one of the main file that does something."""

    @abstractmethod
    def _never_ends(self, line: Line) -> None:
        """Tell that more has been executed than any program is meant to."""

    def _lines(self, take: Callable[[], Line | None]) -> Iterator[Line]:
        """The lines as ``take`` gives them, until a stop of block search or more than anybody runs."""
        idle = blocks = 0
        while True:
            line, self._taken = self._taken or take(), None
            if line is None:
                return
            if self.stop_before is not None and self._can_stop(line) and self.stop_before(line.number):
                self._taken, self.stopped_before = line, True
                return
            self._left -= 1
            idle, blocks = (idle + 1, blocks) if self._made == blocks else (0, self._made)
            if self._left < 0 or idle > MOST_LINES_WITHOUT_BLOCK or blocks >= MOST_BLOCKS:
                self._never_ends(line)
                self._left = -1
                return
            yield line
