"""The loop of the driver host process, which runs every few milliseconds.

It runs with real-time priority if this is permitted.
"""

from __future__ import annotations

import socket
from collections.abc import Mapping
from contextlib import suppress
from functools import partial

from core.message import Message
from core.ports import Clock, DriverError
from drivers.driver_host.host_messages import convert_messages, encode_message
from drivers.driver_host.host_server import DriverBundle, DriverHost
from drivers.process_messages import MessageSocket
from drivers.process_rights import lock_process_memory, request_scheduling_policy
from drivers.wakeups import RealClock

REAL_TIME_PRIORITY = 50
_SEND_TIMEOUT_S = 0.05  # Seconds for the control to accept a reply.
TRIAL_TIME_S = 0.3  # s
_STOP_TIME_LIMIT_S = (
    30.0  # Seconds for an orphaned driver host to bring the axes to rest; no queue is longer.
)


def request_real_time_scheduling(priority: int = REAL_TIME_PRIORITY) -> list[str]:
    """Request SCHED_FIFO, and return a list with a message if the request is refused."""
    cause = request_scheduling_policy("SCHED_FIFO", priority)
    words = "the driver host runs without real-time priority ({cause}); see docs/integrator/computer.md"
    return [Message(words, cause=cause)] if cause else []


def measure_wakeup_delay(period_s: float) -> float:
    """Return the longest wake-up delay in seconds of a loop that only waits.

    The trial takes 0.3 s.
    """
    clock = RealClock()
    due, most = 0.0, 0.0
    while due < TRIAL_TIME_S:
        due += period_s
        clock.sleep_until(due)
        most = max(most, clock.now() - due)
    return most


def lock_host_memory() -> list[str]:
    """Lock the memory of this process, and return warnings unless it is locked completely.

    Call this function after the drivers have been created.
    """
    cause, limit = lock_process_memory()
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


def run_driver_host(
    control_socket: socket.socket,
    drivers: DriverBundle,
    warnings: list[str],
    refresh_periods: Mapping[str, float] | None = None,
    wakeup_bell: socket.socket | None = None,
) -> None:
    """Run the driver host until the control has ended and the axes are at rest.

    ``wakeup_bell`` wakes a control that sleeps.
    """
    host = DriverHost(drivers, warnings, refresh_periods, partial(_ring, wakeup_bell))
    try:
        _rounds(control_socket, host, drivers)
    finally:  # In all cases: stop the axes, switch off, close the bus.
        drivers.close()


def _ring(bell: socket.socket | None) -> None:
    if bell is not None:
        with suppress(OSError):
            bell.send(b"!")


def _rounds(sock: socket.socket, host: DriverHost, driven: DriverBundle) -> None:
    clock = driven.ports.clock
    ear = MessageListener(sock, host, clock)
    due = clock.now()
    gone: float | None = None  # Time since which the control is lost.
    while not host.is_done:
        host.record_wakeup_delay(clock.now() - due)
        host.run_cycle()
        due = ear.handle_messages_until_due(
            host.get_next_cycle_time(due), is_punctual=driven.get_next_tick_time() is not None
        )
        if host.is_orphaned:
            sock.close()
            gone = clock.now() if gone is None else gone
            if clock.now() - gone > _STOP_TIME_LIMIT_S:
                break


_REPLY_DURATION_S = 0.0003  # Duration of a reply in s.
EARLY_CYCLE_S = 0.03  # Seconds by which a cycle may be early to combine it with a poll in one wake-up.
_MAX_UNREAD_S = 0.005  # Seconds after which messages are read even if the drivers are late.


class MessageListener:
    """Listener that handles messages from the control between two cycles."""

    def __init__(self, sock: socket.socket, host: DriverHost, clock: Clock) -> None:
        self._socket, self._host, self._clock = MessageSocket(sock), host, clock
        self._listened = clock.now()

    def handle_messages_until_due(self, due_time: float, *, is_punctual: bool) -> float:
        """Reply to messages until the next cycle is due, and return the due time of that cycle.

        The method returns immediately if a control wakes up. If ``is_punctual`` is True, no reply is
        started that would end after the due time.
        """
        host, clock = self._host, self._clock
        keep = _REPLY_DURATION_S if is_punctual else 0.0
        while True:
            now = clock.now()
            left = due_time - now
            if left <= keep and now - self._listened < _MAX_UNREAD_S:
                clock.sleep_until(due_time)
                return due_time
            slept, self._listened = host.is_asleep, now
            if host.is_orphaned:
                clock.sleep_until(due_time)
            elif self._socket.wait(max(left - keep, 0.0)):
                host.is_orphaned = not _handle_messages(self._socket, host)
                if host.is_asleep and not is_punctual and 0.0 < due_time - clock.now() < EARLY_CYCLE_S:
                    return clock.now()
            if slept and not host.is_asleep:
                return clock.now()


def _handle_messages(sock: MessageSocket, host: DriverHost) -> bool:
    """Reply to the received messages, and return False if the control has ended.

    A control that does not read its replies is considered to have ended.
    """
    try:
        for message in convert_messages(sock.receive()):
            sock.send(encode_message(host.handle_message(message)), _SEND_TIMEOUT_S)
    except (OSError, EOFError, DriverError):
        return False
    return True
