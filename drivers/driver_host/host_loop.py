"""The driver host's process: one loop, real-time where the system permits, awake every few milliseconds."""

from __future__ import annotations

import ctypes
import gc
import os
import select
import socket
from collections.abc import Mapping
from contextlib import suppress
from functools import partial

from core.message import Message
from core.ports import Clock, DriverError
from drivers.driver_host.host_messages import Inbox, packed
from drivers.driver_host.host_server import Driven, DriverHost
from drivers.waiting import RealClock

PRIORITY = 50
_CURRENT, _FUTURE = 1, 2  # MCL_CURRENT and MCL_FUTURE of mlockall(2)
_CHUNK = 1 << 16
TRIAL = 0.3  # s
_LAST = 30.0  # s that an orphaned driver host has to bring the slides to rest; no queue is longer


def real_time(priority: int = PRIORITY) -> list[str]:
    """Ask for SCHED_FIFO; what was refused, in words for the operator."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except (OSError, AttributeError) as error:
        return [
            Message(
                "the driver host runs without real-time priority ({cause}); see docs/integrator/computer.md",
                cause=_why(error),
            )
        ]
    return []


def late_at_trial(period: float) -> float:
    """Seconds by which a process that only waits, once each period, wakes up too late at most; takes .3 s."""
    clock = RealClock()
    due, most = 0.0, 0.0
    while due < TRIAL:
        due += period
        clock.sleep_until(due)
        most = max(most, clock.now() - due)
    return most


def keep_memory() -> list[str]:
    """Lock what is there once the drivers stand, and what comes, and collect garbage no more than needed.

    Returns what was refused, in words for the operator. Under a limit only what is there is locked: with
    ``MCL_FUTURE`` the first allocation beyond the limit would fail, in the middle of a cut.
    """
    gc.collect()
    gc.freeze()
    limit = _memory_limit()
    try:
        libc = ctypes.CDLL(None, use_errno=True)
        if libc.mlockall(_CURRENT if limit else _CURRENT | _FUTURE) != 0:
            return [_not_locked(os.strerror(ctypes.get_errno()))]
    except (OSError, AttributeError) as error:
        return [_not_locked(_why(error))]
    if not limit:
        return []
    return [
        Message(
            "only the driver host's present memory is locked; memory allocated later is not locked "
            "(memlock limit {limit} MB)",
            limit=limit >> 20,
        )
    ]


def _not_locked(cause: str) -> str:
    return Message("the driver host's memory is not locked ({cause})", cause=cause)


def _memory_limit() -> int:
    """Bytes that may be locked; 0: as many as there are, which an administrator always may."""
    if not hasattr(os, "geteuid") or os.geteuid() == 0:
        return 0
    import resource  # noqa: PLC0415  not on every system

    limit, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    return 0 if limit == resource.RLIM_INFINITY else limit


def serve(
    sock: socket.socket,
    driven: Driven,
    warnings: list[str],
    refresh: Mapping[str, float] | None = None,
    bell: socket.socket | None = None,
) -> None:
    """Until the control has gone and the slides are at rest; ``bell`` wakes a control that sleeps."""
    host = DriverHost(driven, warnings, refresh, partial(_ring, bell))
    try:
        _rounds(sock, host, driven)
    finally:  # whatever happens here: slides stopped, power off, bus closed
        driven.close()


def _ring(bell: socket.socket | None) -> None:
    if bell is not None:
        with suppress(OSError):
            bell.send(b"!")


def _rounds(sock: socket.socket, host: DriverHost, driven: Driven) -> None:
    clock = driven.ports.clock
    ear = Ear(sock, host, clock)
    due = clock.now()
    gone: float | None = None  # since when the control has been
    while not host.done:
        host.late(clock.now() - due)
        host.tick()
        due = ear.listen(host.next_round(due), punctual=driven.wake() is not None)
        if host.orphaned:
            sock.close()
            gone = clock.now() if gone is None else gone
            if clock.now() - gone > _LAST:
                break


_TALK = 0.0003  # s that an answer takes
EARLY = 0.03  # s by which a round may come before its time with a look of a control that sleeps: one wake-up
_DEAF = 0.005  # s after which a control is listened to, however late the drivers are


class Ear:
    """Listens to the control between two rounds."""

    def __init__(self, sock: socket.socket, host: DriverHost, clock: Clock) -> None:
        self._sock, self._host, self._clock = sock, host, clock
        self._inbox = Inbox()
        self._listened = clock.now()
        sock.setblocking(False)

    def listen(self, due: float, *, punctual: bool) -> float:
        """Answer until the next round is due, and say when that is: at once where a control wakes up.

        ``punctual``: nothing is begun that would be over behind that time.
        """
        host, clock = self._host, self._clock
        keep = _TALK if punctual else 0.0
        while True:
            now = clock.now()
            left = due - now
            if left <= keep and now - self._listened < _DEAF:
                clock.sleep_until(due)
                return due
            slept, self._listened = host.asleep, now
            if host.orphaned:
                clock.sleep_until(due)
            elif select.select([self._sock], [], [], max(left - keep, 0.0))[0]:
                host.orphaned = not _talk(self._sock, self._inbox, host)
                if host.asleep and not punctual and 0.0 < due - clock.now() < EARLY:
                    return clock.now()
            if slept and not host.asleep:
                return clock.now()


def _talk(sock: socket.socket, inbox: Inbox, host: DriverHost) -> bool:
    """Answer what has come; False when the other side has gone."""
    try:
        data = sock.recv(_CHUNK)
        if not data:
            return False
        for message in inbox.feed(data):
            _send(sock, packed(host.handle(message)))
    except BlockingIOError:
        return True
    except (OSError, DriverError):
        return False
    return True


def _send(sock: socket.socket, data: bytes) -> None:
    """Whole or not at all: a control that does not read its answers has gone."""
    sock.settimeout(0.05)
    try:
        sock.sendall(data)
    finally:
        sock.setblocking(False)


def _why(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
