"""Going through a program up to a line: what SEARCHTO rebuilds the state with. The same interpreter."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.blocks import Block
from core.interpreter.run import Interpreter


class Walk(Interpreter):
    """A pass that stops before any line of the main program, and goes on from there."""

    def before(self, line: int) -> Iterator[Block]:
        """The blocks until this line is about to be executed for the first time, counted from 1.

        May be called again with a later line. At the first error they end; ``failed`` tells.
        """
        self._flow.until(line)
        for each in self._lines():
            if self._stopped:
                return
            assert isinstance(each, Block)  # series are made for ``series`` alone
            yield each

    @property
    def next_line(self) -> int:
        """The line that would be executed next, counted from 1."""
        return self._flow.at + 1

    @property
    def called(self) -> bool:
        """Whether a subroutine is being executed."""
        return self._flow.called

    @property
    def shaping(self) -> bool:
        """Whether moves are held back, because a corner or nose compensation looks at the lines to come."""
        return self._state.shape.active or self._state.modal.nose_comp != 40
