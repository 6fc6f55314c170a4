"""Wake-ups, clocks and background connection attempts for drivers.

With a wake-up, a driver reports a change to the control at once, so the control can poll a machine at rest
less often. A separate thread reopens lost connections, so the control never waits for a missing port or
process.
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


class LocalWakeup:
    """Wake-up signal (``core.ports.WakeupSignal``) within one process.

    The driver supplies ``is_settled``, which returns whether the machine state will not change before the
    next wake-up.
    """

    def __init__(self, is_settled: Callable[[], bool]) -> None:
        self.can_rely_on_wakeups = is_settled
        self._rung = threading.Event()

    def request_poll(self) -> None:
        """Wake up the control after a command or change; any thread may call this method."""
        self._rung.set()

    def wait_for_wakeup(self, seconds: float) -> bool:
        """Wait at most ``seconds`` for a wake-up, and return whether a wake-up occurred."""
        rung = self._rung.wait(seconds)
        self._rung.clear()
        return rung


class ProcessWakeup:
    """Wake-up between two processes through a socket pair.

    Both processes and all their threads may send a wake-up.
    """

    def __init__(self) -> None:
        self._near, self.remote_socket = socket.socketpair()
        self._near.setblocking(False)
        self.remote_socket.setblocking(False)

    def send_wakeup(self) -> None:
        """Wake up the waiting process; the call has no effect if the socket is full or closed."""
        with suppress(OSError):
            self.remote_socket.send(b"!")

    def wait_for_wakeup(self, seconds: float, file_handles: Sequence[int] = ()) -> bool:
        """Wait at most ``seconds`` for a wake-up or a readable file, and return whether either occurred.

        A wake-up that was sent before the call also ends the wait.
        """
        try:
            if not select.select([self._near.fileno(), *file_handles], [], [], seconds)[0]:
                return False
        except (OSError, ValueError):  # Closed by another thread.
            return True
        with suppress(OSError):
            while self._near.recv(_CHUNK):
                pass
        return True

    def close(self) -> None:
        """Close both sockets."""
        self._near.close()
        self.remote_socket.close()


class ActionLock:
    """Lock for actions on a machine; releasing the lock wakes up the control."""

    def __init__(self, lock: AbstractContextManager[object], wake: Callable[[], None]) -> None:
        self._lock, self._ring = lock, wake
        self.action_count = 0  # Number of times the lock was acquired.

    def __enter__(self) -> None:
        self._lock.__enter__()
        self.action_count += 1

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lock.__exit__(kind, error, trace)
        self._ring()


# --- Clocks: the real one, and one that tests and runs without a screen advance.


class RealClock:
    """Monotonic clock that starts at its creation, or at ``origin_s`` of the system's monotonic clock.

    All processes share the system's clock, so two instances with the same origin show the same time.
    """

    def __init__(self, origin_s: float | None = None) -> None:
        self.origin_s = time.monotonic() if origin_s is None else origin_s

    def now(self) -> float:
        """Return the seconds since the start of this clock."""
        return time.monotonic() - self.origin_s

    def sleep_until(self, time_s: float) -> None:
        """Wait until time ``time_s``, or return at once if that time has passed."""
        left = time_s - self.now()
        if left > 0:
            time.sleep(left)


class ManualClock:
    """Thread-safe clock that advances only when ``advance`` or ``sleep_until`` is called."""

    def __init__(self, start: float = 0.0) -> None:
        self._t = start
        self._lock = threading.Lock()

    def now(self) -> float:
        """Return the current time in seconds."""
        return self._t

    def sleep_until(self, time_s: float) -> None:
        """Set the clock to ``time_s`` without waiting, but never backward."""
        with self._lock:
            self._t = max(self._t, time_s)

    def advance(self, seconds: float) -> None:
        """Advance the clock by ``seconds`` seconds."""
        with self._lock:
            self._t += seconds


# --- Openings of lost connections.


T = TypeVar("T")


class ConnectionAttempt(Generic[T]):
    """Attempt to reopen a lost connection in a separate thread.

    If ``synchronous`` is true, the connection is opened in the calling thread instead.
    """

    def __init__(self, open_connection: Callable[[], T], *, synchronous: bool = False) -> None:
        self._open = open_connection
        self._found: queue.SimpleQueue[T | DriverError] = queue.SimpleQueue()
        if synchronous:
            self._run()
        else:
            threading.Thread(target=self._run, name="reopening", daemon=True).start()

    def take_connection(self) -> T | None:
        """Return the opened connection, or None while the connection is still being opened.

        Raises DriverError if the connection could not be opened.
        """
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
        except OSError as error:  # for example no memory for a new process
            self._found.put(DriverError("the connection cannot be opened: {error}", error=error))
