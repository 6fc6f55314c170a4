"""The spindle's index on HAL: asked for with the first turn of a session, so that a thread is found again."""

from __future__ import annotations

from core.message import Message
from core.ports import Fault
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_link import HalLink

_PIN = "spindle-index"
_TURNING = 0.1  # turns/s
_TURNS = 3.0  # within which it must come by
_SETTLES = 0.02  # s until what was made up for is told as well


class SpindleIndex:
    """``known`` once it has come by; a spindle without an index begins to count anywhere, and is known."""

    def __init__(self, axes: HalAxes, link: HalLink, *, wired: bool) -> None:
        self._axes, self._link, self._wired = axes, link, wired
        self.forget()

    def forget(self) -> None:
        """HAL counts anew."""
        self.known = not self._wired
        self.trouble: Fault | str = ""
        self._order: int | None = None
        self._from = 0.0  # turns, where it was asked for
        self._fell: float | None = None  # when it was seen to have come by
        self._axes.index_at = 0.0

    def clear(self) -> None:
        """It is asked for again."""
        if self.trouble:
            self.forget()

    def look(self) -> None:
        """Once in a while."""
        reading = self._axes.spindle_at
        if self.known or self.trouble or self._link.blind or reading is None:
            return
        t, turns = reading
        if self._order is None:
            if abs(self._axes.rps) > _TURNING:
                self._from, self._order = turns, self._link.say("index", pin=_PIN, on=True)
        elif self._fell is None:
            self._wait(t, turns)
        elif t > self._fell + _SETTLES:
            self._axes.index_at = self._link.figure(f"{_PIN}-at")
            self.known = True

    def _wait(self, t: float, turns: float) -> None:
        if self._order is not None and self._link.done(self._order) and not self._link.bit(_PIN):
            self._fell = t
        elif abs(turns - self._from) > _TURNS:
            self.trouble = Fault(
                Message(
                    "no spindle index pulse was detected in {revolutions} revolutions; check phase Z of the "
                    "spindle encoder, and check that hal.spindle.index_enable belongs to the same encoder",
                    revolutions=f"{_TURNS:g}",
                ),
                "spindle-encoder",
            )
