"""Serial line as drivers use it: settings, transfer, parity, and reasons for failures."""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass
from typing import Protocol

from core.ports import DriverError


class SerialLineError(DriverError):
    """Failure of the line itself, such as a missing port or a disconnected adapter."""


@dataclass(frozen=True, slots=True)
class LineSettings:
    """Settings of a serial line; ``flow`` is xonxoff, rtscts or none."""

    port: str
    baud: int = 9600
    bits: int = 8
    parity: str = "N"
    stop: int = 1
    flow: str = "none"

    @property
    def character_s(self) -> float:
        """The duration of one character in seconds, with start, parity and stop bits."""
        return (1 + self.bits + (self.parity != "N") + self.stop) / self.baud

    @property
    def description(self) -> str:
        """The settings as text, such as ``9600 7E1``."""
        return f"{self.baud} {self.bits}{self.parity}{self.stop}"


class SerialTransport(Protocol):
    """Serial line for requests and responses. Every method raises WireError if the line has failed."""

    def send(self, data: bytes) -> None:
        """Send bytes; wait only briefly."""
        ...

    def receive(self, timeout_s: float) -> bytes:
        """Return received bytes; wait at most ``timeout_s`` seconds for the first one."""
        ...

    def discard_input(self) -> None:
        """Discard received bytes that have not been read."""
        ...

    def close(self) -> None: ...


class FlowControlTransport(SerialTransport, Protocol):
    """Serial line with flow control and a count of damaged characters."""

    @property
    def damaged_count(self) -> int:
        """The number of characters with a parity or framing error since the line was opened."""
        ...

    def send_available(self, data: bytes) -> int:
        """Send the bytes that the line accepts now and return their number, which may be 0."""
        ...

    def enable_xon_xoff(self) -> None:
        """Let DC3 and DC1 (XOFF, XON) of the other side stop and resume the output.

        A line that cannot do so leaves these characters in its input.
        """
        ...

    def count_unsent(self) -> int:
        """Return the number of accepted bytes that have not been transmitted."""
        ...

    def discard_output(self) -> None:
        """Discard accepted bytes that have not been transmitted."""
        ...


# --- Parity of seven-bit characters on a line of eight bits.


PARITY_VALUES = {"E": 0, "O": 1}  # Number of ones in a character, modulo 2.
_PARITY_BIT = 0x80


def calculate_parity(character: int) -> int:
    """Return the number of ones in a character, modulo 2."""
    return character.bit_count() & 1


def create_parity_table(parity: str) -> bytes:
    """Return a table for ``bytes.translate`` that adds the parity bit to seven-bit characters."""
    odd = PARITY_VALUES[parity]
    return bytes(
        c & ~_PARITY_BIT | (_PARITY_BIT if calculate_parity(c & ~_PARITY_BIT) != odd else 0)
        for c in range(256)
    )


# --- Reasons for a failed serial port, as texts for the operator.


_REMEDIES = {
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
    """Return a remedy for an error of a serial port, or the text of the operating system."""
    number = _error_number(error)
    if number is None and error.__context__ is not None:  # The library hides the cause in its own text.
        number = _error_number(error.__context__)
    if number is not None:
        return _REMEDIES.get(number) or os.strerror(number)
    return str(error).splitlines()[0] if str(error) else type(error).__name__


def _error_number(error: BaseException) -> int | None:
    """Return the error number of the operating system; for termios errors, it is the first argument."""
    number = error.errno if isinstance(error, OSError) else error.args[0] if error.args else None
    return number if isinstance(number, int) else None
