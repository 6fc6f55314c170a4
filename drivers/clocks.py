"""Clocks: the real one, and one that tests and runs without a screen move on themselves."""

from __future__ import annotations

import threading
import time


class RealClock:
    """Seconds of the monotonic clock since it was made, or since ``zero`` of that clock.

    The monotonic clock is one for all processes, so two of these with the same zero agree.
    """

    def __init__(self, zero: float | None = None) -> None:
        self.zero = time.monotonic() if zero is None else zero

    def now(self) -> float:
        """Seconds since this clock was made."""
        return time.monotonic() - self.zero

    def sleep_until(self, t: float) -> None:
        """Wait until ``t``; returns at once when that is past."""
        left = t - self.now()
        if left > 0:
            time.sleep(left)


class StepClock:
    """Time that stands still until somebody moves it; sleeping moves it. Thread-safe."""

    def __init__(self, start: float = 0.0) -> None:
        self._t = start
        self._lock = threading.Lock()

    def now(self) -> float:
        """The time it was moved to."""
        return self._t

    def sleep_until(self, t: float) -> None:
        """Move to ``t`` at once; never back."""
        with self._lock:
            self._t = max(self._t, t)

    def advance(self, dt: float) -> None:
        """Move on by ``dt`` seconds."""
        with self._lock:
            self._t += dt
