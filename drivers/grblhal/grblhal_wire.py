"""The wire to the controller: a serial device, a pseudo terminal or TCP. Only opening and closing wait."""

from __future__ import annotations

import re
import socket
from contextlib import suppress
from typing import TYPE_CHECKING, Protocol

from core.ports import DriverError
from drivers.serial_line import why

if TYPE_CHECKING:
    import serial

_TCP = re.compile(r"(?:tcp|socket)://(?P<host>.*):(?P<number>\d+)/?")
_OPENING, _CLOSING = 3.0, 0.5  # s


class WireLostError(Exception):
    """The other end has gone; the text says how it was noticed."""


class Wire(Protocol):
    """Bytes both ways. ``read`` and ``write`` raise WireLostError and never wait."""

    def read(self) -> bytes: ...

    def write(self, data: bytes) -> None: ...

    def close(self) -> None: ...


def tcp_address(port: str) -> tuple[str, int] | None:
    """Host and number of ``tcp://…:…`` or ``socket://…:…``, None for a device. Raises DriverError."""
    if "://" not in port:
        return None
    found = _TCP.fullmatch(port)
    if found is None or not found["host"]:
        raise DriverError("{port} must have the form tcp://host:port", port=port)
    return found["host"].strip("[]"), int(found["number"])


def open_wire(port: str, baud: int) -> Wire:
    """A serial device by its path, or a TCP port. Raises DriverError."""
    address = tcp_address(port)
    return SerialWire(port, baud) if address is None else TcpWire(*address)


class SerialWire:
    """pyserial without DTR and RTS: raising them resets some boards, and a reset loses the position."""

    def __init__(self, port: str, baud: int) -> None:
        try:
            import serial  # noqa: PLC0415  not everybody has a controller
        except ImportError as error:
            raise DriverError("backend grblhal needs pyserial; run: pip install pyserial") from error
        self._port: serial.Serial = serial.Serial(timeout=0, write_timeout=0, exclusive=True)
        self._port.port, self._port.baudrate = port, baud
        self._port.dtr = self._port.rts = False
        try:
            self._port.open()
        except (OSError, ValueError) as error:
            raise DriverError(
                "{port} cannot be opened: {error}; check [grblhal] port",
                reason="not-opened",
                port=port,
                error=why(error),
            ) from error

    def read(self) -> bytes:
        """What has arrived."""
        try:
            return bytes(self._port.read(4096))
        except (OSError, TypeError) as error:  # TypeError: pyserial's own, when the device vanishes
            raise WireLostError(str(error)) from error

    def write(self, data: bytes) -> None:
        """All of it; less than a controller's buffer fits into the computer's own."""
        try:
            if self._port.write(data) != len(data):
                raise WireLostError("the serial port does not accept any more bytes")
        except OSError as error:
            raise WireLostError(str(error)) from error

    def close(self) -> None:
        """Let the device go."""
        self._port.close()


class TcpWire:
    """A socket that does not wait."""

    def __init__(self, host: str, port: int) -> None:
        try:
            self._socket = socket.create_connection((host, port), _OPENING)
        except OSError as error:
            raise DriverError(
                "no response from tcp://{host}:{port}: {error}", host=host, port=port, error=error
            ) from error
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def read(self) -> bytes:
        """What has arrived."""
        try:
            data = self._socket.recv(4096)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise WireLostError(str(error)) from error
        if not data:
            raise WireLostError("the remote host has closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """All of it."""
        try:
            if self._socket.send(data) != len(data):
                raise WireLostError("the connection does not accept any more bytes")
        except OSError as error:
            raise WireLostError(str(error)) from error

    def close(self) -> None:
        """Hang up when the other end has said what it had to: its simulator ends when it writes to nobody."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_WR)
            self._socket.settimeout(_CLOSING)
            while self._socket.recv(4096):
                continue
        self._socket.close()
