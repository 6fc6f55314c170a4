"""A clock for two threads: one that sleeps on it goes on at its time, and nothing else moves meanwhile."""

from __future__ import annotations

import threading

from drivers.wakeups import ManualClock

_LOOK = 0.02  # s of real time between two looks whether the other thread still lives


class LockstepClock(ManualClock):
    """Moved by the thread that has made it. ``attend`` the other one; ``release`` it for good at the end."""

    def __init__(self) -> None:
        super().__init__()
        self._owner = threading.get_ident()
        self._turn = threading.Condition()
        self._other: threading.Thread | None = None
        self._due: float | None = None  # when the other one, which sleeps, goes on; None: it does not sleep
        self._free = False

    def attend(self, other: threading.Thread) -> None:
        """Wait until it sleeps for the first time."""
        self._other = other
        self._await_sleep()

    def release(self) -> None:
        """From now on its sleeps move the clock by themselves."""
        with self._turn:
            self._free = True
            self._turn.notify_all()

    def sleep_until(self, time_s: float) -> None:
        """The owner moves the clock; the other one waits until the clock is there."""
        if threading.get_ident() == self._owner or self._free:
            super().sleep_until(time_s)
            return
        if time_s <= self.now():
            return
        with self._turn:
            self._due = time_s
            self._turn.notify_all()
            self._turn.wait_for(lambda: self._due is None or self._free)

    def advance(self, seconds: float) -> None:
        """On by ``seconds``, with a stop wherever the other one wants to be woken."""
        end = self.now() + seconds
        while self._due is not None and self._due <= end:
            super().sleep_until(self._due)
            self._wake()
        super().sleep_until(end)

    def _wake(self) -> None:
        with self._turn:
            self._due = None
            self._turn.notify_all()
        self._await_sleep()

    def _await_sleep(self) -> None:
        assert self._other is not None
        with self._turn:
            while self._due is None and self._other.is_alive():
                self._turn.wait_for(lambda: self._due is not None, _LOOK)
