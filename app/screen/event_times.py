"""Event times: when a key, button or finger went down, by the stamp of its event; and stalls of the screen.

A stamp counts milliseconds of somebody's clock: of the X server, of the compositor, of Qt. Its offset to our
own clock is the least that was ever seen between the two, as a message can only be late. Fingers have an
offset of their own: a touch screen may be read by another than the keyboard.
"""

from __future__ import annotations

import time
from collections.abc import Callable

STALL = 0.3  # s without a frame: whatever waited behind it starts nothing
FRAMES = 2  # that must have been shown since, before anything starts
PAUSE = 1.0  # s without a press that end a burst of which a press was dropped
_WRAPPED = 1e5  # s: further off than this the 32 bits of the stamps have run over
_DRIFT = 1e-3  # of the time passed: how much two clocks may go apart


class EventTimes:
    """``clock`` is monotonic, seconds."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self.clock = clock
        self.touched = self.clock()  # when somebody last did something, a key or a finger
        self.woken: Callable[[], None] = lambda: None  # called then
        self.stalled = 0.0  # s that the last stall took
        self._alive: float | None = None
        self._behind = float("-inf")  # the end of the last stall
        self._dropped = float("-inf")  # when the last press that was dropped was made
        self._frames = FRAMES  # shown since
        self._offsets: dict[str, tuple[float, float]] = {}  # of whose clock: offset, and when it was seen

    @property
    def known(self) -> bool:
        """Whether what is to be seen has been shown since the last stall."""
        return self._frames >= FRAMES

    def frame(self) -> None:
        """A frame is shown."""
        self._lives(self.clock())
        self._frames += 1

    def alive(self) -> None:
        """The screen does something; called before an event is judged."""
        self.touched = self.clock()
        self._lives(self.touched)
        self.woken()

    def _lives(self, now: float) -> None:
        if self._alive is not None and now - self._alive > STALL:
            self.stalled, self._behind, self._frames = now - self._alive, now, 0
        self._alive = now

    def at(self, stamp: int, whose: str = "") -> float:
        """When it happened, seconds of our clock; an event without a stamp happens now.

        ``whose`` clock counts the stamps: events of one clock alone are compared.
        """
        now = self.clock()
        if not stamp:
            return now
        apart = now - stamp / 1000
        offset, seen = self._offsets.get(whose, (apart, now))
        if apart - offset > _WRAPPED:
            offset = apart
        offset = min(apart, offset + _DRIFT * (now - seen))
        self._offsets[whose] = offset, now
        return min(now, stamp / 1000 + offset)

    def late(self, stamp: int, whose: str = "") -> bool:
        """Whether it waited behind a stall, of the screen or on its way here."""
        if not stamp:
            return False
        at = self.at(stamp, whose)
        return at <= self._behind or not self.known or self.clock() - at > STALL

    def drop(self, stamp: int, whose: str = "") -> None:
        """Note that a press was dropped: what follows without a pause relies on it."""
        self._dropped = max(self._dropped, self.at(stamp, whose))

    def in_burst(self, stamp: int, whose: str = "") -> bool:
        """Return whether a press follows one that was dropped without a pause of ``PAUSE`` seconds."""
        return self.at(stamp, whose) - self._dropped < PAUSE
