"""The feeder's process: one loop, real-time where the system permits, awake every few milliseconds."""

from __future__ import annotations

import ctypes
import gc
import os
import resource
import select
import socket
from collections.abc import Mapping

from core.ports import DriverError
from drivers.feeder.feeder_messages import Inbox, packed
from drivers.feeder.feeder_server import Driven, Feeder

PERIOD = 0.005  # s
PRIORITY = 50
_CURRENT, _FUTURE = 1, 2  # MCL_CURRENT and MCL_FUTURE of mlockall(2)
_CHUNK = 1 << 16
_LAST = 30.0  # s that an orphaned feeder has to bring the slides to rest; no queue is longer


def real_time(priority: int = PRIORITY) -> list[str]:
    """Ask for SCHED_FIFO; what was refused, in words for the operator."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except (OSError, AttributeError) as error:
        return [f"the feeder runs without real-time priority ({_why(error)}); see docs/hardware.md"]
    return []


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
            return [f"the feeder's memory is not locked ({os.strerror(ctypes.get_errno())})"]
    except (OSError, AttributeError) as error:
        return [f"the feeder's memory is not locked ({_why(error)})"]
    told = f"the feeder's memory is locked as it is, later memory not (memlock limit {limit >> 20} MB)"
    return [told] if limit else []


def _memory_limit() -> int:
    """Bytes that may be locked; 0: as many as there are, which an administrator always may."""
    if os.geteuid() == 0:
        return 0
    limit, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    return 0 if limit == resource.RLIM_INFINITY else limit


def serve(
    sock: socket.socket, driven: Driven, warnings: list[str], refresh: Mapping[str, float] | None = None
) -> None:
    """Until the control has gone and the slides are at rest."""
    feeder = Feeder(driven, warnings, refresh)
    try:
        _rounds(sock, feeder, driven)
    finally:  # whatever happens here: slides stopped, power off, bus closed
        driven.close()


def _rounds(sock: socket.socket, feeder: Feeder, driven: Driven) -> None:
    clock = driven.ports.clock
    inbox = Inbox()
    sock.setblocking(False)
    due = clock.now()
    gone: float | None = None  # since when the control has been
    while not feeder.done:
        feeder.late(clock.now() - due)
        feeder.tick()
        set_by_driver = driven.wake()
        due = max(due + PERIOD, clock.now()) if set_by_driver is None else set_by_driver
        heard = False  # who is always late still listens, once a round
        while (left := due - clock.now()) > 0.0 or not heard:
            heard = True
            if feeder.orphaned:
                clock.sleep_until(due)
            elif select.select([sock], [], [], max(left, 0.0))[0]:
                feeder.orphaned = not _talk(sock, inbox, feeder)
        if feeder.orphaned:
            sock.close()
            gone = clock.now() if gone is None else gone
            if clock.now() - gone > _LAST:
                break


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
