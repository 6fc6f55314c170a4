"""System rights of a real-time process: its scheduling policy and locked memory."""

from __future__ import annotations

import ctypes
import gc
import os
from contextlib import suppress

_CURRENT, _FUTURE, _ON_FAULT = 1, 2, 4  # MCL_CURRENT, MCL_FUTURE and MCL_ONFAULT of mlockall(2)


def request_scheduling_policy(policy: str, priority: int) -> str:
    """Request a scheduling policy of sched(7), such as ``SCHED_FIFO``, for this process.

    Return the reason why the system rejects the request, or an empty string if it grants the policy.
    """
    try:
        os.sched_setscheduler(0, getattr(os, policy), os.sched_param(priority))
    except (OSError, AttributeError) as error:
        return _cause(error)
    return ""


def lower_thread_priority(priority: int) -> None:
    """Lower the real-time priority of the calling thread if the process has a real-time policy.

    If the system rejects the change, the thread continues to run at the priority of its process.
    """
    with suppress(OSError, AttributeError):
        policy = os.sched_getscheduler(0)
        if policy in {os.SCHED_RR, os.SCHED_FIFO}:
            os.sched_setscheduler(0, policy, os.sched_param(priority))


def lock_process_memory(*, only_used: bool = False) -> tuple[str, int]:
    """Lock the current and future memory of the process, and reduce garbage collection.

    Return the reason why locking failed (empty if it succeeded), and the limit of locked memory in bytes (0
    without a limit). With ``only_used``, reserved memory is locked only when it is first used. If there is
    a limit, only current memory is locked. With ``MCL_FUTURE``, the first allocation above the limit would
    fail during a cut.
    """
    gc.collect()
    gc.freeze()
    limit = _memory_limit()
    try:
        libc = ctypes.CDLL(None, use_errno=True)
        wanted = (_CURRENT if limit else _CURRENT | _FUTURE) | (_ON_FAULT if only_used else 0)
        if libc.mlockall(wanted) != 0:
            return os.strerror(ctypes.get_errno()), limit
    except (OSError, AttributeError) as error:
        return _cause(error), limit
    return "", limit


def unlock_process_memory() -> None:
    """Allow the system to move the memory of this process to the disk again."""
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).munlockall()


def _memory_limit() -> int:
    if not hasattr(os, "geteuid") or os.geteuid() == 0:
        return 0
    import resource  # noqa: PLC0415  not on every system

    limit, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    return 0 if limit == resource.RLIM_INFINITY else limit


def _cause(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
