"""A pass that takes one line after the other from its flow, and can stop before any: Klartext, SINUMERIK."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import Generic, TypeVar

from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block
from core.interpreter.interpretation import MOST_BLOCKS, MOST_LINES, MOST_LINES_WITHOUT_BLOCK, Interpretation

Line = TypeVar("Line")


class LinePass(Interpretation, Generic[Line]):
    """The lines of a program in the order in which they are executed, up to the limits of a program."""

    def __init__(self, log: Log) -> None:
        super().__init__(log)
        self._approach: Iterator[Block] = iter(())
        self._taken: Line | None = None  # a line at which block search has stopped
        self._left = MOST_LINES

    @property
    @abstractmethod
    def _made(self) -> int:
        """Blocks made so far."""

    @abstractmethod
    def _taken_line(self) -> Line | None:
        """The next line of the flow, which is taken; None at the end."""

    @abstractmethod
    def _number(self, line: Line) -> int:
        """The number by which block search asks for a line; 0 for one at which it cannot stop."""

    @abstractmethod
    def _never_ends(self, line: Line) -> None:
        """Tell that more has been executed than any program is meant to."""

    def _lines(self) -> Iterator[Line]:
        """The lines as they come, until a stop of block search or more than anybody runs."""
        idle = made = 0
        while (line := self._next_line()) is not None:
            self._left -= 1
            idle, made = (idle + 1, made) if self._made == made else (0, self._made)
            if self._left < 0 or idle > MOST_LINES_WITHOUT_BLOCK or made >= MOST_BLOCKS:
                self._never_ends(line)
                self._left = -1
                return
            yield line

    def _next_line(self) -> Line | None:
        """The line that comes next, which is taken; None at the end, and where block search stops."""
        taken, self._taken = self._taken, None
        line = taken if taken is not None else self._taken_line()
        asked = self.stop_before
        if line is None or asked is None or not (number := self._number(line)) or not asked(number):
            return line
        self._taken, self.stopped_before = line, True
        return None
