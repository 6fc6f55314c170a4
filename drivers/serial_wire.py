"""The serial ports of this computer, by pyserial; every failure is one sentence."""

from __future__ import annotations

import os
import sys
from typing import NamedTuple

import serial
from serial.tools.list_ports import comports

from drivers.wire import LineSettings, WireError

# termios' own error is no OSError; a TypeError is what pyserial makes of a port that was closed meanwhile.
_FAILURES: tuple[type[Exception], ...] = (serial.SerialException, OSError, TypeError)
if sys.platform != "win32":
    import termios

    _FAILURES += (termios.error,)


class Found(NamedTuple):
    """A serial port of this computer."""

    device: str
    what: str


def found_ports() -> list[Found]:
    """The serial ports of this computer, by name."""
    return sorted(Found(port.device, port.description or "") for port in comports())


class SerialWire:
    """A port of this computer, opened for us alone."""

    def __init__(self, settings: LineSettings) -> None:
        """Raises WireError."""
        self.settings = settings
        try:
            self._port = serial.Serial(
                settings.port,
                settings.baud,
                bytesize=settings.bits,
                parity=settings.parity,
                stopbits=settings.stop,
                xonxoff=settings.flow == "xonxoff",
                rtscts=settings.flow == "rtscts",
                timeout=0,
                write_timeout=1.0,
                exclusive=True,
            )
        except (*_FAILURES, ValueError) as error:
            raise WireError(f"{settings.port} cannot be opened: {_why(error)}") from error

    def send(self, data: bytes) -> None:
        """Raises WireError; also when the other side holds the line for more than a second."""
        try:
            self._port.write(data)
        except _FAILURES as error:
            raise self._cut(error) from error

    def receive(self, limit: float) -> bytes:
        """What has come."""
        try:
            self._port.timeout = max(limit, 0.0)
            first = self._port.read(1)
            return first + self._port.read(self._port.in_waiting) if first else b""
        except _FAILURES as error:
            raise self._cut(error) from error

    def discard(self) -> None:
        """Forget the input."""
        try:
            self._port.reset_input_buffer()
        except _FAILURES as error:
            raise self._cut(error) from error

    def waiting(self) -> int:
        """Bytes that the kernel still has."""
        try:
            return int(self._port.out_waiting)
        except _FAILURES as error:
            raise self._cut(error) from error

    def drop_output(self) -> None:
        """What the kernel still has is not sent."""
        try:
            self._port.reset_output_buffer()
        except _FAILURES as error:
            raise self._cut(error) from error

    def close(self) -> None:
        """Let the port go; what was not sent is dropped, or a held line would keep us here."""
        try:
            self._port.reset_output_buffer()
            self._port.close()
        except _FAILURES:
            return  # it has gone already

    def _cut(self, error: Exception) -> WireError:
        return WireError(f"{self.settings.port} has failed: {_why(error)}")


def _why(error: Exception) -> str:
    """The operating system's word for it, where there is one."""
    if isinstance(error, OSError) and error.strerror:
        return os.strerror(error.errno) if error.errno else error.strerror
    if error.args and isinstance(error.args[0], int):
        return os.strerror(error.args[0])
    return str(error).splitlines()[0] if str(error) else type(error).__name__
