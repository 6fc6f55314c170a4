"""What the system grants the process of the control: a real-time class, or a better nice value."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from core.message import Message

PRIORITY = 40  # of SCHED_RR: below the driver host, whose bus has the shorter period
NICE = -10
_AUTOGROUP = Path("/proc/sys/kernel/sched_autogroup_enabled")


class Right(NamedTuple):
    """One right. ``lacks`` is what it costs to be without it, empty where it is granted."""

    name: str
    value: str
    lacks: str = ""


def acquire_rights() -> tuple[Right, ...]:
    """Ask the system for what a control needs, and return what was granted. Raises nothing."""
    scheduling = _scheduling()
    rights = [scheduling]
    if scheduling.lacks:
        rights.append(_nice())
        rights += _autogroup()
    return tuple(rights)


def _scheduling() -> Right:
    try:
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(PRIORITY))
    except (OSError, AttributeError) as error:
        return Right(
            "real-time priority",
            "no",
            Message(
                "other programs can delay the control ({cause}); to grant it, add the line "
                "'{user} - rtprio {priority}' to /etc/security/limits.d/turndesk.conf, then sign in again",
                cause=getattr(error, "strerror", None) or str(error),
                user=_user(),
                priority=PRIORITY + 20,
            ),
        )
    return Right("real-time priority", f"SCHED_RR {PRIORITY}")


def _nice() -> Right:
    with suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, 0, NICE)
        return Right("nice value", str(NICE))
    return Right(
        "nice value",
        "0",
        Message(
            "the control has the same priority as other programs; to grant a better one, add the line "
            "'{user} - nice {nice}' to /etc/security/limits.d/turndesk.conf, then sign in again",
            user=_user(),
            nice=NICE,
        ),
    )


def _autogroup() -> Iterator[Right]:
    """A kernel that groups processes by their session makes nice values count within a session only."""
    with suppress(OSError):
        if _AUTOGROUP.read_text().strip() == "1":
            yield Right("automatic groups", "on")


def _user() -> str:
    import getpass

    with suppress(OSError, KeyError):
        return getpass.getuser()
    return "USER"
