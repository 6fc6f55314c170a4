"""The wire to the controller, lines out with one answer each back, and scripts that wait for these.

The wire is a serial device, a pseudo terminal or TCP. Only opening and closing wait.
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


# --- Lines out with one answer each back.


# Bytes of its buffer that are never used. With 100 free ones the firmware's simulator takes nothing more from
# its socket: a cycle start or a reset neither.
_RESERVE = 128
_LONGEST = 256  # bytes of a line


@dataclass(slots=True)
class Ask:
    """A line whose answer matters: what was told before its ``ok``; ``error`` 0 is none."""

    line: str
    lines: list[str] = field(default_factory=list)
    done: bool = False
    error: int = 0
    sent_at: float = 0.0
    ticket: int = 0  # of a block, 0 for everything else

    @property
    def size(self) -> int:
        """Bytes on the wire."""
        return len(self.line) + 1


class Stream:
    """``write`` puts bytes on the wire. Lines leave in order, and only as many as surely fit."""

    def __init__(self, write: Callable[[bytes], None]) -> None:
        self._write = write
        self.room = 100  # bytes that may be unanswered; the controller tells its buffer first
        self.waiting: deque[Ask] = deque()
        self.unanswered: deque[Ask] = deque()
        self.stale = False  # answers to lines that no longer count may still come

    def use(self, buffer: int) -> None:
        """The controller's buffer holds so many bytes."""
        self.room = buffer - _RESERVE

    @property
    def quiet(self) -> bool:
        """Whether every line has been sent and answered."""
        return not self.waiting and not self.unanswered

    def fits(self, line: str) -> bool:
        """Whether this line could leave at once."""
        return not self.waiting and self._used() + len(line) + 1 <= self.room

    def send(self, line: str, now: float, ticket: int = 0) -> Ask:
        """Send a line, or let it wait its turn."""
        assert line.isascii(), line
        assert len(line) < _LONGEST, line
        ask = Ask(line, sent_at=now, ticket=ticket)
        self.waiting.append(ask)
        self.pump(now)
        return ask

    def pump(self, now: float) -> None:
        """Send what has come to fit."""
        while self.waiting and (not self.unanswered or self._used() + self.waiting[0].size <= self.room):
            ask = self.waiting.popleft()
            ask.sent_at = now
            self.unanswered.append(ask)
            self._write(ask.line.encode("ascii") + b"\n")

    def answered(self, error: int) -> Ask | None:
        """``ok`` (0) or an error has come; the line that it belongs to, None when there is none."""
        if not self.unanswered:
            return None
        ask = self.unanswered.popleft()
        ask.done, ask.error = True, error
        return ask

    def message(self, line: str) -> None:
        """Something that the controller says before it answers for a line."""
        if self.unanswered:
            self.unanswered[0].lines.append(line)

    def void(self) -> None:
        """No line counts any more; what is still answered belongs to nothing until ``$G`` has been told."""
        self.waiting.clear()
        self.unanswered.clear()
        self.stale = True

    def _used(self) -> int:
        return sum(ask.size for ask in self.unanswered)


# --- Scripts: generators that ask for something, and go on when it is so.


Step = tuple[Callable[[], bool], float, str]  # until, within s, what is told when it takes longer
Script = Generator[Step, None, None]


class ScriptError(DriverError):
    """What a script was begun for cannot be done; the sentence becomes the fault, with its code."""

    def __init__(self, text: str, code: FaultCode = "controller-refuses", **values: object) -> None:
        super().__init__(text, code, reason="", **values)


class Runner:
    """One script at a time, carried on by whoever looks."""

    def __init__(self) -> None:
        self.doing = ""  # what the present script is for
        self._script: Script | None = None
        self._step: Step = (lambda: True, 0.0, "")
        self._until = 0.0
        self._inside = False  # its step is under way

    @property
    def busy(self) -> bool:
        """Whether a script is under way."""
        return self._script is not None

    def begin(self, script: Script, doing: str, now: float) -> None:
        """A script that is under way is given up."""
        self.drop()
        self._script, self.doing = script, doing
        self._step, self._until = (lambda: True, 0.0, ""), now

    def drop(self) -> None:
        """Nothing is under way any more; a script that finds its wire gone ends with its step."""
        if self._script is not None and not self._inside:
            self._script.close()
        self._script = None

    def go_on(self, now: float) -> str:
        """As far as it can; why it failed, or nothing."""
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
