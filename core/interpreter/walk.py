"""Going through a program up to a line: what SEARCHTO rebuilds the state with. The same interpreter."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.blocks import Block
from core.interpreter.run import Interpreter
from core.interpreter.setup import Setup


class Walk(Interpreter):
    """A pass that stops before any line, in each pass of a loop and each call, and goes on from there."""

    def before(self, line: int) -> Iterator[Block]:
        """The blocks until this line is about to be executed, counted from 1; ``there`` tells whether it is.

        May be called again with a later line. At the first error they end; ``failed`` tells.
        """
        self._flow.until(line)
        return self._until_stop()

    def again(self, line: int) -> Iterator[Block]:
        """The same line executed, and on until it is about to be executed once more."""
        self._flow.until(line)
        self._flow.pass_stop()
        return self._until_stop()

    def _until_stop(self) -> Iterator[Block]:
        for each in self._lines():
            if self._stopped:
                return
            assert isinstance(each, Block)  # series are made for ``series`` alone
            yield each

    @property
    def there(self) -> bool:
        """Whether the line that was asked for comes next."""
        return self._flow.stopped and not self._stopped

    @property
    def setup(self) -> Setup:
        """Its circumstances."""
        return self._state.setup

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
