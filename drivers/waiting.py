"""Clocks, wake-ups, and openings of what was lost: how drivers wait, and keep nobody waiting.

A wake-up lets a driver tell its control at once that something has changed, so that a machine at rest is
looked at less often. What was lost is opened in a thread of its own: nobody waits for a port or process that
is not there.
"""

from __future__ import annotations

import queue
import select
import socket
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, suppress
from types import TracebackType
from typing import Generic, TypeVar

from core.ports import DriverError

# --- Wake-ups.


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


# --- Clocks: the real one, and one that tests and runs without a screen move on themselves.


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


# --- Openings of what was lost.


T = TypeVar("T")


class Opening(Generic[T]):
    """One attempt. ``at_once``: in this thread, where it cannot wait."""

    def __init__(self, open_: Callable[[], T], *, at_once: bool = False) -> None:
        self._open = open_
        self._found: queue.SimpleQueue[T | DriverError] = queue.SimpleQueue()
        if at_once:
            self._run()
        else:
            threading.Thread(target=self._run, name="reopening", daemon=True).start()

    def take(self) -> T | None:
        """What was opened, None until then. Raises DriverError when it cannot be."""
        try:
            found = self._found.get_nowait()
        except queue.Empty:
            return None
        if isinstance(found, DriverError):
            raise found
        return found

    def _run(self) -> None:
        try:
            self._found.put(self._open())
        except DriverError as error:
            self._found.put(error)
