"""Why a serial port does not open or has failed, in words for who stands before it."""

from __future__ import annotations

import errno
import os

_TO_DO = {
    errno.ENOENT: "there is no such port; plug the adapter in. Those there are: turndesk serial ports",
    errno.EACCES: "no permission; add this user to the group dialout, then log in again",
    errno.EAGAIN: "another program has it open; close it there",
    errno.EBUSY: "another program has it open; close it there",
    errno.ENOTTY: "that is no serial port",
    errno.EINVAL: "the port does not do that",
}


def why(error: Exception) -> str:
    """What to do about it, else the operating system's word for it, where there is one."""
    number = error.errno if isinstance(error, OSError) else error.args[0] if error.args else None
    if isinstance(number, int):
        return _TO_DO.get(number) or os.strerror(number)
    return str(error).splitlines()[0] if str(error) else type(error).__name__
