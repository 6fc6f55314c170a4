"""The feeder's process: one loop, real-time where the system permits, awake every few milliseconds."""

from __future__ import annotations

import ctypes
import gc
import os
import select
import socket
from collections.abc import Mapping

from core.ports import DriverError
from drivers.feeder.server import Driven, Feeder
from drivers.feeder.wire import Inbox, packed

PERIOD = 0.005  # s
PRIORITY = 50
_CURRENT_AND_FUTURE = 3  # MCL_CURRENT | MCL_FUTURE of mlockall(2)
_CHUNK = 1 << 16
_LAST = 30.0  # s that an orphaned feeder has to bring the slides to rest; no queue is longer


def real_time() -> list[str]:
    """Ask for SCHED_FIFO and locked memory; what was refused, in words for the operator."""
    refused = []
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    except (OSError, AttributeError) as error:
        refused.append(f"the feeder runs without real-time priority ({_why(error)}); see docs/hardware.md")
    try:
        libc = ctypes.CDLL(None, use_errno=True)
        if libc.mlockall(_CURRENT_AND_FUTURE) != 0:
            refused.append(f"the feeder's memory is not locked ({os.strerror(ctypes.get_errno())})")
    except (OSError, AttributeError) as error:
        refused.append(f"the feeder's memory is not locked ({_why(error)})")
    gc.collect()
    gc.freeze()
    return refused


def serve(
    sock: socket.socket, driven: Driven, warnings: list[str], refresh: Mapping[str, float] | None = None
) -> None:
    """Until the control has gone and the slides are at rest."""
    feeder, inbox, clock = Feeder(driven, warnings, refresh), Inbox(), driven.ports.clock
    sock.setblocking(False)
    due = clock.now()
    gone = 0.0
    while not feeder.done:
        feeder.late(clock.now() - due)
        feeder.tick()
        due = max(due + PERIOD, clock.now())
        while (left := due - clock.now()) > 0.0:
            if feeder.orphaned:
                clock.sleep_until(due)
            elif select.select([sock], [], [], left)[0]:
                feeder.orphaned = not _talk(sock, inbox, feeder)
        if feeder.orphaned:
            sock.close()
            gone += PERIOD
            if gone > _LAST:
                break
    driven.close()


def _talk(sock: socket.socket, inbox: Inbox, feeder: Feeder) -> bool:
    """Answer what has come; False when the other side has gone."""
    try:
        data = sock.recv(_CHUNK)
        if not data:
            return False
        for message in inbox.feed(data):
            _send(sock, packed(feeder.handle(message)))
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
