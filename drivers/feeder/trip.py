"""What the feeder has switched off by itself, and that nothing goes on before the control knows it."""

from __future__ import annotations

from collections.abc import Sequence

from core.ports import Trip, TrippedError
from drivers.feeder.wire import Message, number, text

_MOVES = frozenset(("splice", "mesh"))


class TripGuard:
    """Between the requests of the control and the drivers."""

    def __init__(self) -> None:
        self.tripped: Trip | None = None
        self._count = 0
        self._turns = False  # the control wants the spindle to turn

    def demand_allowed(self, message: Message) -> None:
        """Raises TrippedError for what would move, turn or switch on, while a trip is not acknowledged."""
        what = text(message.head, "what")
        turns = what == "run" and number(message.head, "rpm") != 0.0
        switches = what == "write" and message.head.get("on") is True
        if self.tripped is not None and (
            text(message.head, "do") in _MOVES or what == "home" or turns or switches
        ):
            raise TrippedError(f"the feeder has heard nothing for {self.tripped.away:.2f} s and stopped")
        if what in {"run", "coast"}:
            self._turns = turns

    def trip(self, away: float, outputs: Sequence[str], *, spindle: bool) -> None:
        """Outputs were switched off, and the spindle; that nothing was on is no trip."""
        turned = self._turns and spindle
        self._turns = self._turns and not spindle
        if turned or outputs:
            self._tripped(away, turned, outputs)

    def fell(self, away: float, output: str) -> None:
        """One output that nobody renewed."""
        self._tripped(away, False, [output])

    def back_after(self, away: float) -> None:
        """The control speaks again."""
        if self.tripped is not None:
            self.tripped = self.tripped._replace(away=max(away, self.tripped.away))

    def acknowledge(self, count: float) -> None:
        """The control has taken note of this trip, and of no later one."""
        if self.tripped is not None and self.tripped.number == count:
            self.tripped = None

    def _tripped(self, away: float, spindle: bool, outputs: Sequence[str]) -> None:
        self._count += 1
        before = self.tripped or Trip(0, 0.0, False, ())
        on = tuple(dict.fromkeys((*before.outputs, *outputs)))
        self.tripped = Trip(self._count, max(away, before.away), spindle or before.spindle, on)
