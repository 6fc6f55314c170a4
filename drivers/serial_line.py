"""A serial line as its drivers see it: settings, both directions, parity, and why it has failed."""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass
from typing import Protocol

from core.ports import DriverError


class WireError(DriverError):
    """The line itself has failed: no such port, cable or adapter out."""


@dataclass(frozen=True, slots=True)
class LineSettings:
    """How the bits go over a line. ``flow``: xonxoff, rtscts or none."""

    port: str
    baud: int = 9600
    bits: int = 8
    parity: str = "N"
    stop: int = 1
    flow: str = "none"

    @property
    def character(self) -> float:
        """Seconds that one character takes, with start, parity and stop bits."""
        return (1 + self.bits + (self.parity != "N") + self.stop) / self.baud

    @property
    def words(self) -> str:
        """``9600 7E1``."""
        return f"{self.baud} {self.bits}{self.parity}{self.stop}"


class Wire(Protocol):
    """Questions and answers. Every method raises WireError when the line is cut."""

    def send(self, data: bytes) -> None:
        """Give bytes to the line; waits at most a moment."""
        ...

    def receive(self, limit: float) -> bytes:
        """What has come; waits ``limit`` seconds at most for the first byte."""
        ...

    def discard(self) -> None:
        """Forget what has come and was not read."""
        ...

    def close(self) -> None: ...


class FlowWire(Wire, Protocol):
    """A line whose other side may hold what is sent, and where damaged characters are counted."""

    @property
    def damaged(self) -> int:
        """Characters with a parity or framing error since the line was opened."""
        ...

    def offer(self, data: bytes) -> int:
        """How many of these bytes the line takes now; none while the other side holds it."""
        ...

    def obey_codes(self) -> None:
        """From now on the other side's DC3 and DC1 (XOFF, XON) hold and release what is sent.

        A line that cannot leaves them in what comes.
        """
        ...

    def waiting(self) -> int:
        """Bytes taken that have not gone out."""
        ...

    def drop_output(self) -> None:
        """What was taken and has not gone out is not sent any more."""
        ...


# --- Parity of seven-bit characters on a line of eight bits.


PARITIES = {"E": 0, "O": 1}  # what the count of ones in a character is, modulo 2
_TOP = 0x80


def parity_of(character: int) -> int:
    """Its ones, modulo 2."""
    return character.bit_count() & 1


def table_of(parity: str) -> bytes:
    """For ``bytes.translate``: the top bit of each seven-bit character is its parity bit."""
    odd = PARITIES[parity]
    return bytes(c & ~_TOP | (_TOP if parity_of(c & ~_TOP) != odd else 0) for c in range(256))


# --- Why a serial port does not open or has failed, in words for who stands before it.


_TO_DO = {
    errno.ENOENT: ("this port does not exist; plug in the adapter. To list the ports: turndesk serial ports"),
    errno.EACCES: (
        "this user has no permission for the port; add this user to the dialout group, then log in again"
    ),
    errno.EAGAIN: "another program is using the port; close that program",
    errno.EBUSY: "another program is using the port; close that program",
    errno.ENOTTY: "this is not a serial port",
    errno.EINVAL: "the port does not support this setting",
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
