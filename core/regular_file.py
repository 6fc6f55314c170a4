"""Read a file that somebody else may have put in its place: a regular one only, up to a stated size."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

_HOW = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_BINARY", 0)


def read_regular(path: Path, most: int) -> bytes:
    """Return the bytes of the file, ``most`` of them. Never waits for another process. Raises OSError.

    A pipe, a device or a folder is refused, and so is a longer file.
    """
    handle = os.open(path, _HOW)
    try:
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            raise OSError(errno.EINVAL, f"{path.name} is not a regular file", str(path))
        with open(handle, "rb", closefd=False) as file:
            data = file.read(most + 1)
    finally:
        os.close(handle)
    if len(data) > most:
        raise OSError(errno.EINVAL, f"{path.name} is longer than {most} bytes", str(path))
    return data
