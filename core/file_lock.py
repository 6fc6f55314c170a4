"""An exclusive lock on an open file, as the system has it: flock, or that of Windows."""

from __future__ import annotations

import os
import sys

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
