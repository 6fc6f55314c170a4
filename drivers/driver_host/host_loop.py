"""Loop of the driver host process, which runs every few milliseconds with real-time priority if allowed."""

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
_LAST = 30.0  # Seconds for an orphaned driver host to bring the axes to rest; no queue is longer.


def real_time(priority: int = PRIORITY) -> list[str]:
    """Request SCHED_FIFO and return a message for the operator if it was refused."""
    cause = ask_real_time("SCHED_FIFO", priority)
    words = "the driver host runs without real-time priority ({cause}); see docs/integrator/computer.md"
    return [Message(words, cause=cause)] if cause else []


def late_at_trial(period: float) -> float:
    """Return the longest wake-up delay in seconds of a loop that only waits; the trial takes 0.3 s."""
    clock = RealClock()
    due, most = 0.0, 0.0
    while due < TRIAL:
        due += period
        clock.sleep_until(due)
        most = max(most, clock.now() - due)
    return most


def keep_memory() -> list[str]:
    """Lock the memory after the drivers are created; return messages for the operator about limits."""
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
    """Run the driver host until the control has ended and the axes are at rest.

    ``bell`` wakes a control that sleeps.
    """
    host = DriverHost(driven, warnings, refresh, partial(_ring, bell))
    try:
        _rounds(sock, host, driven)
    finally:  # In all cases: stop the axes, switch off, close the bus.
        driven.close()


def _ring(bell: socket.socket | None) -> None:
    if bell is not None:
        with suppress(OSError):
            bell.send(b"!")


def _rounds(sock: socket.socket, host: DriverHost, driven: Driven) -> None:
    clock = driven.ports.clock
    ear = Ear(sock, host, clock)
    due = clock.now()
    gone: float | None = None  # Time since which the control is lost.
    while not host.done:
        host.late(clock.now() - due)
        host.tick()
        due = ear.listen(host.next_round(due), punctual=driven.wake() is not None)
        if host.orphaned:
            sock.close()
            gone = clock.now() if gone is None else gone
            if clock.now() - gone > _LAST:
                break


_TALK = 0.0003  # Duration of a reply in s.
EARLY = 0.03  # Seconds by which a cycle may be early to combine it with a poll in one wake-up.
_DEAF = 0.005  # Seconds after which messages are read even if the drivers are late.


class Ear:
    """Listener for messages of the control between two cycles."""

    def __init__(self, sock: socket.socket, host: DriverHost, clock: Clock) -> None:
        self._sock, self._host, self._clock = sock, host, clock
        self._inbox = Inbox()
        self._listened = clock.now()
        sock.setblocking(False)

    def listen(self, due: float, *, punctual: bool) -> float:
        """Reply to messages until the next cycle is due and return its time, at once if a control wakes up.

        ``punctual`` prevents starting a reply that would end after this time.
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
    """Reply to the received messages; return False if the control has ended."""
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
    """Send all bytes or fail; a control that does not read its replies counts as ended."""
    sock.settimeout(0.05)
    try:
        sock.sendall(data)
    finally:
        sock.setblocking(False)
