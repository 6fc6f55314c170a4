"""What the families on Modbus share: their line, and the settings they are asked for at each connection."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from drivers.inverter.modbus import Modbus
from drivers.inverter.settings import Setting, Top, settled


class OnModbus:
    """The part of ``Family`` that is the line's."""

    warm_up = 1

    def __init__(self, line: Modbus) -> None:
        self._line = line

    @property
    def hurry(self) -> Callable[[], bool]:
        """Whether a stop waits."""
        return self._line.hurry

    @hurry.setter
    def hurry(self, asked: Callable[[], bool]) -> None:
        self._line.hurry = asked

    @property
    def good(self) -> int:
        """Good answers in a row."""
        return self._line.good

    def close(self) -> None:
        """Let the line go."""
        self._line.wire.close()

    def _prepared(
        self, ours: Sequence[Setting], others: Sequence[Setting], top: Top, highest: float
    ) -> list[str]:
        """Write ``ours``, look at the ``others``; what has to be known. Raises NoAnswerError, WireError."""
        known = settled(self._line, *ours)
        known += [text for setting in others if (text := setting.differs(self._line))]
        return [*known, *filter(None, [top.below(self._line, highest)])]
