"""Serial line interface for drivers: settings, transfer, parity and explanations of errors."""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass
from typing import Protocol

from core.ports import DriverError


class SerialLineError(DriverError):
    """Failure of the serial line itself, such as a missing port or a disconnected adapter."""


@dataclass(frozen=True, slots=True)
class LineSettings:
    """Settings of a serial line; ``flow_control`` is "xonxoff", "rtscts" or "none"."""

    port: str
    baud: int = 9600
    data_bits: int = 8
    parity: str = "N"
    stop_bits: int = 1
    flow_control: str = "none"

    @property
    def character_time_s(self) -> float:
        """Return the duration of one character in seconds, including its start, parity and stop bits."""
        return (1 + self.data_bits + (self.parity != "N") + self.stop_bits) / self.baud

    @property
    def description(self) -> str:
        """Return the settings as text, such as ``9600 7E1``."""
        return f"{self.baud} {self.data_bits}{self.parity}{self.stop_bits}"


class SerialTransport(Protocol):
    """Serial line for requests and responses.

    Every method raises SerialLineError if the line has failed.
    """

    def send(self, data: bytes) -> None:
        """Send bytes; the call blocks for a short time at most."""
        ...

    def receive(self, timeout_s: float) -> bytes:
        """Return the received bytes, after waiting up to ``timeout_s`` seconds for the first byte."""
        ...

    def discard_input(self) -> None:
        """Discard received bytes that have not been read."""
        ...

    def close(self) -> None:
        """Close the serial line."""
        ...


class FlowControlTransport(SerialTransport, Protocol):
    """Serial line with flow control and a count of damaged characters."""

    @property
    def damaged_character_count(self) -> int:
        """Return the number of characters with a parity or framing error since the line was opened."""
        ...

    def send_available_bytes(self, data: bytes) -> int:
        """Send as many bytes as the line accepts now, and return the number of bytes sent, possibly 0."""
        ...

    def enable_xon_xoff(self) -> None:
        """Let the connected device stop and resume the output with XOFF (DC3) and XON (DC1).

        If the line does not support flow control, these characters are returned as received data.
        """
        ...

    def count_unsent_bytes(self) -> int:
        """Return the number of accepted bytes that have not been transmitted yet."""
        ...

    def discard_output(self) -> None:
        """Discard all accepted bytes that have not been transmitted yet."""
        ...


# --- Parity of seven-bit characters on a line of eight bits.


PARITY_VALUES = {"E": 0, "O": 1}  # Number of ones in a character, modulo 2.
_PARITY_BIT = 0x80


def calculate_parity(character: int) -> int:
    """Return the parity of a character: 1 if the number of its one bits is odd, otherwise 0."""
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
    """Return the remedy for a serial port error, or the system's error text if no remedy is known."""
    number = _error_number(error)
    if number is None and error.__context__ is not None:  # The library hides the cause in its own text.
        number = _error_number(error.__context__)
    if number is not None:
        return _REMEDIES.get(number) or os.strerror(number)
    return str(error).splitlines()[0] if str(error) else type(error).__name__


def _error_number(error: BaseException) -> int | None:
    """Return the operating system's error number, or None if the error has no number.

    For termios errors, the number is the first argument.
    """
    number = error.errno if isinstance(error, OSError) else error.args[0] if error.args else None
    return number if isinstance(number, int) else None
