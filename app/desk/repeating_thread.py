"""A thread of its own that looks again and again until it is closed: at the status, for a due backup."""

from __future__ import annotations

import threading
from collections.abc import Callable

ENDS = 2.0  # s that closing waits for a look


class RepeatingThread:
    """Calls ``look`` after ``first`` s, then every ``every`` s; its name is what the watchdog knows."""

    def __init__(self, name: str, look: Callable[[], object], every: float, first: float = 0.0) -> None:
        self._look, self._every, self._first = look, every, first
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._repeat, name=name, daemon=True)

    @property
    def closing(self) -> bool:
        """Whether it was told to end; else its end is a mistake."""
        return self._closing.is_set()

    def start(self) -> None:
        """Once."""
        self._thread.start()

    def close(self) -> None:
        """Wait ``ENDS`` seconds at most for a look that is under way; one that hangs is left running."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(ENDS)

    def _repeat(self) -> None:
        wait = self._first
        while not self._closing.wait(wait):
            self._look()
            wait = self._every
