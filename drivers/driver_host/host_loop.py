"""The driver host's process: one loop, real-time where the system permits, awake every few milliseconds."""

from __future__ import annotations

import select
import socket
from collections.abc import Mapping
from contextlib import suppress
from functools import partial

from core.message import Message
from core.ports import Clock, DriverError
from drivers.driver_host.host_messages import Inbox, packed
from drivers.driver_host.host_server import Driven, DriverHost
from drivers.process_rights import ask_real_time, lock_memory
from drivers.waiting import RealClock

PRIORITY = 50
_CHUNK = 1 << 16
TRIAL = 0.3  # s
_LAST = 30.0  # s that an orphaned driver host has to bring the slides to rest; no queue is longer


def real_time(priority: int = PRIORITY) -> list[str]:
    """Ask for SCHED_FIFO; what was refused, in words for the operator."""
    cause = ask_real_time("SCHED_FIFO", priority)
    words = "the driver host runs without real-time priority ({cause}); see docs/integrator/computer.md"
    return [Message(words, cause=cause)] if cause else []


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
    """Lock the memory once the drivers stand; what was refused, in words for the operator."""
    cause, limit = lock_memory()
    if cause:
        return [Message("the driver host's memory is not locked ({cause})", cause=cause)]
    if not limit:
        return []
    return [
        Message(
            "only the driver host's present memory is locked; memory allocated later is not locked "
            "(memlock limit {limit} MB)",
            limit=limit >> 20,
        )
    ]


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
