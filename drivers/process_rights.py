"""What a process that keeps its own time asks of the system: a real-time class, and memory that stays."""

from __future__ import annotations

import ctypes
import gc
import os

_CURRENT, _FUTURE, _ON_FAULT = 1, 2, 4  # MCL_CURRENT, MCL_FUTURE and MCL_ONFAULT of mlockall(2)


def ask_real_time(policy: str, priority: int) -> str:
    """Ask for a policy of sched(7), as ``SCHED_FIFO``; returns why it was refused, empty if granted."""
    try:
        os.sched_setscheduler(0, getattr(os, policy), os.sched_param(priority))
    except (OSError, AttributeError) as error:
        return _cause(error)
    return ""


def lock_memory(*, only_used: bool = False) -> tuple[str, int]:
    """Lock the memory that there is, and what comes; collect garbage no more than needed.

    ``only_used``: memory that was reserved and is not used yet is locked when it is used first.

    Returns why it was refused, and the limit in bytes: 0 if there is none. Under a limit only what is there
    is locked: with ``MCL_FUTURE`` the first allocation beyond the limit would fail, in the middle of a cut.
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


def _memory_limit() -> int:
    if not hasattr(os, "geteuid") or os.geteuid() == 0:
        return 0
    import resource  # noqa: PLC0415  not on every system

    limit, _ = resource.getrlimit(resource.RLIMIT_MEMLOCK)
    return 0 if limit == resource.RLIM_INFINITY else limit


def _cause(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
