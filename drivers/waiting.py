"""Wake-ups: how a driver tells its control at once that something has changed, so that a machine at rest is
looked at less often.
"""

from __future__ import annotations

import select
import socket
import threading
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, suppress
from types import TracebackType

_CHUNK = 1 << 16


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


class Bell:
    """The same between two processes: whoever has ``far`` rings, and so does this one from any thread."""

    def __init__(self) -> None:
        self._near, self.far = socket.socketpair()
        self._near.setblocking(False)
        self.far.setblocking(False)

    def ring(self) -> None:
        """One that is full rings already; one that is closed wakes nobody."""
        with suppress(OSError):
            self.far.send(b"!")

    def wait(self, seconds: float, files: Sequence[int] = ()) -> bool:
        """Until it rings or one of the files can be read, so long at most; whether it has or can. What rang
        before counts.
        """
        try:
            if not select.select([self._near.fileno(), *files], [], [], seconds)[0]:
                return False
        except (OSError, ValueError):  # closed meanwhile
            return True
        with suppress(OSError):
            while self._near.recv(_CHUNK):
                pass
        return True

    def close(self) -> None:
        """It rings no more."""
        self._near.close()
        self.far.close()


class Touch:
    """The lock of a machine in somebody's hand: when it is let go, the control hears of it."""

    def __init__(self, lock: AbstractContextManager[object], ring: Callable[[], None]) -> None:
        self._lock, self._ring = lock, ring
        self.count = 0  # how many times it was taken

    def __enter__(self) -> None:
        self._lock.__enter__()
        self.count += 1

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lock.__exit__(kind, error, trace)
        self._ring()
