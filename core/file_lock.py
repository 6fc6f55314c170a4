"""An exclusive lock on an open file, as the system has it: flock, or that of Windows."""

from __future__ import annotations

import os
import struct
import sys
from contextlib import suppress

_RECORD = "hhqqi4x"  # type, whence, start, length, process
_FAR = 1 << 30  # where Windows locks a byte: none that is read or written


def lock(file: int) -> None:
    """Take it at once, for as long as the file is open. Raises OSError while somebody else has it.

    A system that has neither lock goes without.
    """
    if sys.platform == "win32":
        import msvcrt  # noqa: PLC0415

        os.lseek(file, _FAR, os.SEEK_SET)
        msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        os.lseek(file, 0, os.SEEK_SET)
        return
    try:
        import fcntl  # noqa: PLC0415  not on every system
    except ImportError:
        return
    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def mark_locked(file: int) -> None:
    """Let ``is_locked`` see the lock of ``file``; never for a file of SQLite, which locks the same byte."""
    if sys.platform == "win32":
        return
    try:
        import fcntl  # noqa: PLC0415  not on every system
    except ImportError:
        return
    if hasattr(fcntl, "F_OFD_SETLK"):
        with suppress(OSError):  # a network drive may not have it
            fcntl.fcntl(file, fcntl.F_OFD_SETLK, _record(fcntl.F_WRLCK))


def is_locked(file: int) -> bool:
    """Return whether another open file holds the lock of ``file``; do not take it if the system can tell.

    Linux reports a record lock that belongs to the open file; flock has no such query. Elsewhere the lock is
    taken for an instant: who wants it at that instant tries again.
    """
    found = _asked(file)
    if found is not None:
        return found
    try:
        lock(file)
    except OSError:
        return True
    return False


def _asked(file: int) -> bool | None:
    """The answer of the system; None where it has none."""
    if sys.platform == "win32":
        return None
    try:
        import fcntl  # noqa: PLC0415  not on every system
    except ImportError:
        return False
    if not hasattr(fcntl, "F_OFD_GETLK"):
        return None
    try:
        answer = fcntl.fcntl(file, fcntl.F_OFD_GETLK, _record(fcntl.F_WRLCK))
    except OSError:
        return None
    return bool(struct.unpack(_RECORD, answer)[0] != fcntl.F_UNLCK)


def _record(kind: int) -> bytes:
    """A record lock on one byte far from what is written, as the system's ``struct flock``."""
    return struct.pack(_RECORD, kind, os.SEEK_SET, _FAR, 1, 0)
