"""Rights that the system grants to the control process: real-time priority, locked memory, nice value."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from core.message import Message
from drivers.process_rights import ask_real_time, lock_memory

OWN_PROCESS = sys.platform == "linux"  # on other systems the control runs in a thread of the screen's process
PRIORITY = 40  # priority of SCHED_RR, below that of the driver host, whose bus has a shorter period
READING = 1  # priority of the thread that reads programs, below that of the executor
NICE = -10
_AUTOGROUP = Path("/proc/sys/kernel/sched_autogroup_enabled")


class Right(NamedTuple):
    """A right: the granted value, and the consequence if it was refused, or empty."""

    name: str
    granted: str
    missing: str = ""


def acquire_rights() -> tuple[Right, ...]:
    """Request all rights for this process. Raises no exception."""
    scheduling = _scheduling()
    others = (_nice(), *_autogroup()) if scheduling.missing else ()
    return scheduling, _memory(), *others


def check_rights() -> tuple[Right, ...]:
    """Return the rights that a control would get; this process returns them afterwards."""
    policy, priority, nice = (
        os.sched_getscheduler(0),
        os.sched_getparam(0),
        os.getpriority(os.PRIO_PROCESS, 0),
    )
    rights = (_scheduling(), _nice(), *_autogroup())
    os.sched_setscheduler(0, policy, priority)
    with suppress(OSError):
        os.setpriority(os.PRIO_PROCESS, 0, nice)
    return rights


def _scheduling() -> Right:
    cause = ask_real_time("SCHED_RR", PRIORITY)
    if not cause:
        return Right("real-time priority", Message("SCHED_RR {priority}", priority=PRIORITY))
    words = (
        "other programs can delay the control ({cause}). To prevent this, add the line "
        "'@machine - rtprio 60' to /etc/security/limits.d/turndesk.conf and log in again"
    )
    return Right("real-time priority", "no", Message(words, cause=cause))


def _memory() -> Right:
    cause, limit = lock_memory(only_used=True)
    words = (
        "the system can move memory of the control to the disk ({cause}). To prevent this, add the line "
        "'@machine - memlock unlimited' to /etc/security/limits.d/turndesk.conf and log in again"
    )
    if cause:
        return Right("locked memory", "no", Message(words, cause=cause))
    return Right("locked memory", Message("{limit} MB", limit=limit >> 20) if limit else "all")


def _nice() -> Right:
    with suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, 0, NICE)
        return Right("nice value", str(NICE))
    words = (
        "the control has the priority of any other program. To improve it, add the line "
        "'@machine - nice -10' to /etc/security/limits.d/turndesk.conf and log in again"
    )
    return Right("nice value", "0", words)


def _autogroup() -> tuple[Right, ...]:
    """Return a warning row if the kernel groups processes by session.

    Nice values then apply only within one session.
    """
    with suppress(OSError):
        if _AUTOGROUP.read_text().strip() == "1":
            return (Right("automatic groups", "on"),)
    return ()
