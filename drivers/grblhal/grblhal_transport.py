"""Connection to a grblHAL controller, with request lines and scripts of such lines.

The controller answers each line with one reply, and a script waits for these replies. The connection is a
serial device, a pseudo terminal or a TCP connection. Calls do not block, except opening and closing.
"""

from __future__ import annotations

import re
import socket
from collections import deque
from collections.abc import Callable, Generator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from core.ports import DriverError, FaultCode
from drivers.serial_line import why

if TYPE_CHECKING:
    import serial


_TCP_PATTERN = re.compile(r"(?:tcp|socket)://(?P<host>.*):(?P<number>[0-9]{1,9})/?")
_MAX_TCP_PORT = 65535
_OPENING, _CLOSING = 3.0, 0.5  # s


class TransportLostError(Exception):
    """Loss of the connection; the text states how the loss was detected."""


class GrblTransport(Protocol):
    """Byte connection to a controller.

    ``read`` and ``write`` never wait, and raise TransportLostError if the connection is lost.
    """

    def read(self) -> bytes:
        """Return the received bytes without waiting, or empty bytes if none were received.

        Raises TransportLostError if the connection is lost.
        """
        ...

    def write(self, data: bytes) -> None:
        """Send bytes to the controller without waiting.

        Raises TransportLostError if the connection is lost.
        """
        ...

    def close(self) -> None:
        """Close the connection to the controller."""
        ...


def parse_tcp_address(port: str) -> tuple[str, int] | None:
    """Return the host and port of an address such as ``tcp://host:port`` or ``socket://host:port``.

    Return None for the name of a serial device. Raises DriverError if the address is malformed or its port
    number is above 65535.
    """
    if "://" not in port:
        return None
    found = _TCP_PATTERN.fullmatch(port)
    if found is None or not found["host"]:
        raise DriverError("{port} must have the form tcp://host:port", reason="bad-address", port=port)
    number = int(found["number"])
    if number > _MAX_TCP_PORT:
        raise DriverError(
            "{port}: the port number must not exceed {limit}; check [grblhal] port",
            reason="bad-port",
            port=port,
            limit=_MAX_TCP_PORT,
        )
    return found["host"].strip("[]"), number


def open_transport(port: str, baud: int) -> GrblTransport:
    """Open a connection to a serial device or a TCP address.

    Raises DriverError if the connection cannot be opened.
    """
    address = parse_tcp_address(port)
    return GrblSerialTransport(port, baud) if address is None else GrblTcpTransport(*address)


class GrblSerialTransport:
    """Serial port that leaves DTR and RTS off.

    Some boards reset and lose their position when these signals turn on.
    """

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
        """Return the bytes that were received since the last call."""
        try:
            return bytes(self._port.read(4096))
        except (OSError, TypeError) as error:  # pyserial raises TypeError when the device disappears.
            raise TransportLostError(str(error)) from error

    def write(self, data: bytes) -> None:
        """Write all bytes to the output buffer of this computer.

        This buffer is larger than the buffer of the controller.
        """
        try:
            if self._port.write(data) != len(data):
                raise TransportLostError("the serial port does not accept any more bytes")
        except OSError as error:
            raise TransportLostError(str(error)) from error

    def close(self) -> None:
        """Close the serial port."""
        self._port.close()


class GrblTcpTransport:
    """TCP connection with a non-blocking socket."""

    def __init__(self, host: str, port: int) -> None:
        try:
            self._socket = socket.create_connection((host, port), _OPENING)
        except OSError as error:
            raise DriverError(
                "no response from tcp://{host}:{port}: {error}", host=host, port=port, error=error
            ) from error
        except ValueError as error:  # such as a label of more than 63 characters
            raise DriverError(
                "{host} is not a valid host name; check [grblhal] port", reason="bad-host", host=host
            ) from error
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def read(self) -> bytes:
        """Return the bytes that were received since the last call."""
        try:
            data = self._socket.recv(4096)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise TransportLostError(str(error)) from error
        if not data:
            raise TransportLostError("the remote host has closed the connection")
        return data

    def write(self, data: bytes) -> None:
        """Write all bytes to the socket without waiting."""
        try:
            if self._socket.send(data) != len(data):
                raise TransportLostError("the connection does not accept any more bytes")
        except OSError as error:
            raise TransportLostError(str(error)) from error

    def close(self) -> None:
        """Receive the remaining bytes, and then close the connection.

        A simulator at the other end would fail if bytes remained unread.
        """
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_WR)
            self._socket.settimeout(_CLOSING)
            while self._socket.recv(4096):
                continue
        self._socket.close()


# --- Lines with one reply each.


# Bytes of the buffer that are never used. With 100 free bytes or fewer, the firmware's simulator reads
# nothing from its socket, not even a cycle start or a reset.
_RESERVE = 128
_MAX_LINE_BYTES = 256  # bytes of a line


@dataclass(slots=True)
class SentLine:
    """Line that was sent to the controller, with the messages received before its acknowledgment.

    ``error_code`` is 0 if the line was acknowledged by ``ok``.
    """

    line_text: str
    received_lines: list[str] = field(default_factory=list)
    is_acknowledged: bool = False
    error_code: int = 0
    sent_time_s: float = 0.0
    ticket_number: int = 0  # Ticket of a block, 0 for other lines.

    @property
    def size_bytes(self) -> int:
        """Return the number of bytes of the line, including the line end."""
        return len(self.line_text) + 1


class LineSender:
    """Sender that sends lines in order, each as soon as it fits into the buffer of the controller."""

    def __init__(self, write: Callable[[bytes], None]) -> None:
        self._write = write
        self.free_bytes = 100  # Bytes that may be unacknowledged, until the controller reports its buffer.
        self.waiting_lines: deque[SentLine] = deque()
        self.unacknowledged_lines: deque[SentLine] = deque()
        self.has_stale_replies = False  # Replies to discarded lines may still arrive.

    def set_buffer_size(self, buffer_bytes: int) -> None:
        """Set the size of the controller's buffer in bytes."""
        self.free_bytes = buffer_bytes - _RESERVE

    @property
    def is_idle(self) -> bool:
        """Return whether all lines have been sent and acknowledged."""
        return not self.waiting_lines and not self.unacknowledged_lines

    def can_send_now(self, line: str) -> bool:
        """Return whether a line could be sent immediately."""
        return not self.waiting_lines and self._used() + len(line) + 1 <= self.free_bytes

    def send_line(self, line: str, now_s: float, ticket: int = 0) -> SentLine:
        """Send a line, or queue the line until it fits into the buffer of the controller."""
        assert line.isascii(), line
        assert len(line) < _MAX_LINE_BYTES, line
        ask = SentLine(line, sent_time_s=now_s, ticket_number=ticket)
        self.waiting_lines.append(ask)
        self.send_waiting_lines(now_s)
        return ask

    def send_waiting_lines(self, now: float) -> None:
        """Send the queued lines that now fit into the buffer of the controller."""
        while self.waiting_lines and (
            not self.unacknowledged_lines
            or self._used() + self.waiting_lines[0].size_bytes <= self.free_bytes
        ):
            ask = self.waiting_lines.popleft()
            ask.sent_time_s = now
            self.unacknowledged_lines.append(ask)
            self._write(ask.line_text.encode("ascii") + b"\n")

    def assign_reply(self, error_code: int) -> SentLine | None:
        """Assign a reply to the line that caused it.

        Return that line, or None if no line is pending. ``error_code`` is 0 for the reply ``ok``.
        """
        if not self.unacknowledged_lines:
            return None
        ask = self.unacknowledged_lines.popleft()
        ask.is_acknowledged, ask.error_code = True, error_code
        return ask

    def add_received_line(self, line: str) -> None:
        """Add a received message to the line that the controller will acknowledge next."""
        if self.unacknowledged_lines:
            self.unacknowledged_lines[0].received_lines.append(line)

    def discard_lines(self) -> None:
        """Discard all lines, and ignore replies until the reply to ``$G`` arrives."""
        self.waiting_lines.clear()
        self.unacknowledged_lines.clear()
        self.has_stale_replies = True

    def _used(self) -> int:
        return sum(ask.size_bytes for ask in self.unacknowledged_lines)


# --- Scripts: generators that yield conditions and continue when they are met.


ScriptStep = tuple[Callable[[], bool], float, str]  # Condition, limit in s, and error text after the limit.
Script = Generator[ScriptStep, None, None]


class ScriptError(DriverError):
    """Failure of a script, whose text and code become the fault of the controller."""

    def __init__(self, text: str, code: FaultCode = "controller-refuses", **values: object) -> None:
        super().__init__(text, code, reason="", **values)


class ScriptRunner:
    """Runner of one script at a time, which advances when its owner calls ``advance_script``."""

    def __init__(self) -> None:
        self.purpose = ""  # Purpose of the present script.
        self._script: Script | None = None
        self._step: ScriptStep = (lambda: True, 0.0, "")
        self._until = 0.0
        self._inside = False  # The script is executing a step.

    @property
    def is_script_running(self) -> bool:
        """Return whether a script is running."""
        return self._script is not None

    def start_script(self, script: Script, purpose: str, now_s: float) -> None:
        """Start a script, and cancel the script that is running."""
        self.cancel_script()
        self._script, self.purpose = script, purpose
        self._step, self._until = (lambda: True, 0.0, ""), now_s

    def cancel_script(self) -> None:
        """Cancel the script; a step that is being executed is completed first."""
        if self._script is not None and not self._inside:
            self._script.close()
        self._script = None

    def advance_script(self, now: float) -> str:
        """Advance the script as far as possible without waiting.

        Returns the reason for a failure, or an empty string if the script has not failed.
        """
        while self._script is not None:
            until, _, why = self._step
            if not until():
                if now > self._until:
                    self._script = None
                    return why
                return ""
            try:
                self._inside = True
                self._step = next(self._script)
            except StopIteration:
                self._script = None
            except DriverError as error:
                self._script = None
                return error.fault
            else:
                self._until = now + self._step[1]
            finally:
                self._inside = False
        return ""
