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
    number = _number(error)
    if number is None and error.__context__ is not None:  # the library puts its cause into its own words
        number = _number(error.__context__)
    if number is not None:
        return _TO_DO.get(number) or os.strerror(number)
    return str(error).splitlines()[0] if str(error) else type(error).__name__


def _number(error: BaseException) -> int | None:
    """The operating system's; that of termios stands in its first word."""
    number = error.errno if isinstance(error, OSError) else error.args[0] if error.args else None
    return number if isinstance(number, int) else None
