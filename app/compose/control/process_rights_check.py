"""Check of the control process's rights: real-time priority, locked memory and nice value."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from core.executor.raised_alarm import format_log_line, make_alarm
from core.executor.snapshot import LogEvent
from core.message import Message
from drivers.process_rights import (
    lock_process_memory,
    request_scheduling_policy,
    unlock_process_memory,
)

USES_OWN_PROCESS = (
    sys.platform == "linux"
)  # on other systems the control runs in a thread of the screen's process
REAL_TIME_PRIORITY = 40  # priority of SCHED_RR, below that of the driver host, whose bus has a shorter period
READING_PRIORITY = 1  # priority of the thread that reads programs, below that of the executor
NICE_VALUE = -10
_REAL_TIME = "real-time priority"  # name of the right
_AUTOGROUP = Path("/proc/sys/kernel/sched_autogroup_enabled")


class ProcessRight(NamedTuple):
    """A right that the process requested, with the granted value, or the consequence if refused."""

    name: str
    granted: str
    missing: str = ""


def acquire_rights() -> tuple[ProcessRight, ...]:
    """Request the rights for this process, and return the result of each request.

    A refused request does not raise an exception. The nice value is requested only if real-time priority is
    refused.
    """
    scheduling = _scheduling()
    others = (_nice(), *_check_autogroup()) if scheduling.missing else ()
    return scheduling, _memory(), *others


def check_rights() -> tuple[ProcessRight, ...]:
    """Return the rights that a control would receive. They are released again after the check."""
    policy, priority, nice = (
        os.sched_getscheduler(0),
        os.sched_getparam(0),
        os.getpriority(os.PRIO_PROCESS, 0),
    )
    try:
        return acquire_rights()
    finally:
        os.sched_setscheduler(0, policy, priority)
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, 0, nice)
        unlock_process_memory()


def has_real_time_priority(rights: tuple[ProcessRight, ...]) -> bool:
    """Return whether the system has granted real-time priority. Without any rights, return True."""
    return not any(right.name == _REAL_TIME and right.missing for right in rights)


def make_rights_events(
    rights: tuple[ProcessRight, ...], time_s: float, *, is_simulated: bool
) -> list[LogEvent]:
    """Return the events for the event log about the rights of a control that was started.

    On a machine that is not simulated, missing real-time priority is a notice of the alarm catalog, which
    the list of F7 shows.
    """
    events = [
        LogEvent(
            time_s,
            "rights",
            right.missing
            or Message("control process: {name}: {granted}", name=right.name, granted=right.granted),
        )
        for right in rights
    ]
    if not is_simulated and not has_real_time_priority(rights):
        alarm = make_alarm("no-real-time", "", 0, time_s)
        events.append(LogEvent(time_s, "notice", format_log_line(alarm), alarm=alarm))
    return events


def _scheduling() -> ProcessRight:
    cause = request_scheduling_policy("SCHED_RR", REAL_TIME_PRIORITY)
    if not cause:
        return ProcessRight(_REAL_TIME, Message("SCHED_RR {priority}", priority=REAL_TIME_PRIORITY))
    words = (
        "other programs can delay the control ({cause}). To prevent this, add the line "
        "'@machine - rtprio 60' to /etc/security/limits.d/turndesk.conf and log in again"
    )
    return ProcessRight(_REAL_TIME, "no", Message(words, cause=cause))


def _memory() -> ProcessRight:
    cause, limit = lock_process_memory(only_used=True)
    words = (
        "the system can move memory of the control to the disk ({cause}). To prevent this, add the line "
        "'@machine - memlock unlimited' to /etc/security/limits.d/turndesk.conf and log in again"
    )
    if cause:
        return ProcessRight("locked memory", "no", Message(words, cause=cause))
    return ProcessRight("locked memory", Message("{limit} MB", limit=limit >> 20) if limit else "all")


def _nice() -> ProcessRight:
    with suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, 0, NICE_VALUE)
        return ProcessRight("nice value", str(NICE_VALUE))
    words = (
        "the control has the priority of any other program. To improve it, add the line "
        "'@machine - nice -10' to /etc/security/limits.d/turndesk.conf and log in again"
    )
    return ProcessRight("nice value", "0", words)


def _check_autogroup() -> tuple[ProcessRight, ...]:
    """Return a missing right if the kernel groups processes by session (autogroup), and otherwise ().

    With autogroup, a nice value applies only among the programs of one login session.
    """
    words = (
        "the nice value has no effect on programs of other login sessions. To change this, add the line "
        "'kernel.sched_autogroup_enabled = 0' to /etc/sysctl.d/turndesk.conf and restart the computer"
    )
    with suppress(OSError):
        if _AUTOGROUP.read_text().strip() == "1":
            return (ProcessRight("process groups by session", "on", words),)
    return ()
