"""Wake-ups: how a driver tells its control at once that something has changed, so that a machine at rest is
looked at less often.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from types import TracebackType


class Wakeup:
    """``core.ports.Wakeup`` within one process.

    ``settled`` is the driver's: whether nothing of it changes any more without a ring.
    """

    def __init__(self, settled: Callable[[], bool]) -> None:
        self.settled = settled
        self._rung = threading.Event()

    def ring(self) -> None:
        """Something was asked for, or has changed; from any thread."""
        self._rung.set()

    def wait(self, seconds: float) -> bool:
        """Until it rings, so long at most; whether it has."""
        rung = self._rung.wait(seconds)
        self._rung.clear()
        return rung


class Touch:
    """The lock of a machine in somebody's hand: when it is let go, the control hears of it."""

    def __init__(self, lock: AbstractContextManager[object], ring: Callable[[], None]) -> None:
        self._lock, self._ring = lock, ring

    def __enter__(self) -> None:
        self._lock.__enter__()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lock.__exit__(kind, error, trace)
        self._ring()
