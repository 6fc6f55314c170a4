"""The serial ports of this computer, by pyserial; every failure is one sentence."""

from __future__ import annotations

import errno
import os
import sys
import time
from contextlib import suppress
from typing import NamedTuple

import serial
from serial.tools.list_ports import comports

from drivers.serial_line import PARITIES, LineSettings, WireError, table_of, why

# --- What a POSIX terminal makes of damaged characters when told to mark them (PARMRK).


class Unmarker:
    """Takes the marks out and counts them: FF 00 c is a damaged c, FF FF a good FF."""

    def __init__(self) -> None:
        self.damaged = 0
        self._rest = b""

    def feed(self, come: bytes) -> bytes:
        """The characters as they were meant; a damaged one as it came."""
        data, out = self._rest + come, bytearray()
        at = 0
        while at < len(data):
            if data[at] != 0xFF:
                out.append(data[at])
                at += 1
            elif data[at + 1 : at + 2] == b"\xff":
                out.append(0xFF)
                at += 2
            elif len(data) - at >= 3:
                self.damaged += 1
                out.append(data[at + 2])
                at += 3
            else:
                break
        self._rest = data[at:]
        return bytes(out)


_POSIX = sys.platform != "win32"
_ENDING, _GLANCE = 20, 0.05  # looks, s: a second for the last characters at 110 baud
# termios' own error is no OSError; a TypeError is what pyserial makes of a port that was closed meanwhile.
_FAILURES: tuple[type[Exception], ...] = (serial.SerialException, OSError, TypeError)
if sys.platform != "win32":
    import select
    import termios

    _FAILURES += (termios.error,)
_NOT_OPENED: tuple[type[Exception], ...] = (*_FAILURES, ValueError)


class PortInfo(NamedTuple):
    """A serial port of this computer."""

    device: str
    what: str


def list_ports() -> list[PortInfo]:
    """The serial ports of this computer, by name."""
    return sorted(
        PortInfo(port.device, "" if port.description in {None, "n/a"} else port.description)
        for port in comports()
    )


class SerialWire:
    """A port of this computer, opened for us alone. ``watch``: damaged characters are told from good ones.

    Seven bits and parity on a port that does not do them are done here; XOFF and XON then come to the reader.
    """

    def __init__(self, settings: LineSettings, *, watch: bool = False) -> None:
        """Raises WireError."""
        self.settings = settings
        self._marks = Unmarker() if watch and _POSIX else None
        self._parities: bytes | None = None
        try:
            self._port = _opened(settings)
        except _NOT_OPENED as error:
            raise WireError(
                "{port} cannot be opened: {error}", reason="not-opened", port=settings.port, error=why(error)
            ) from error
        try:
            self._set_up(settings)
        except _NOT_OPENED as error:
            self._port.close()
            raise WireError(
                "{port} cannot be set to {settings}: {error}",
                port=settings.port,
                settings=settings.words,
                error=why(error),
            ) from error

    def _set_up(self, settings: LineSettings) -> None:
        if sys.platform == "win32":
            return
        handle = self._port.fileno()
        kept = frame(handle, settings.bits, settings.parity)
        if settings.bits == 7 and settings.parity in PARITIES and not kept:
            self._parities = table_of(settings.parity)
        if settings.flow == "xonxoff":
            self.obey_codes()
        if self._marks is not None:
            mark_damage(handle, parity=settings.parity != "N")

    @property
    def damaged(self) -> int:
        """Parity and framing errors, where they are watched for."""
        return self._marks.damaged if self._marks is not None else 0

    def send(self, data: bytes) -> None:
        """Raises WireError; also when the other side holds the line for more than a second."""
        try:
            self._port.write(self._coded(data))
        except _FAILURES as error:
            raise self._cut(error) from error

    def offer(self, data: bytes) -> int:
        """What the kernel takes at once."""
        try:
            data = self._coded(data)
            if sys.platform == "win32":
                self._port.write(data)
                return len(data)
            _, free, _ = select.select((), (self._port.fileno(),), (), 0)
            return os.write(self._port.fileno(), data) if free else 0
        except BlockingIOError:
            return 0
        except _FAILURES as error:
            raise self._cut(error) from error

    def obey_codes(self) -> None:
        """Flow control by XON and XOFF, in the kernel; not where they carry a parity bit it does not know."""
        try:
            if sys.platform == "win32":
                self._port.xonxoff = True
            elif self._parities is None:
                obey_codes(self._port.fileno())
        except _FAILURES as error:
            raise self._cut(error) from error

    def receive(self, limit: float) -> bytes:
        """What has come."""
        try:
            come = self._come(max(limit, 0.0))
        except _FAILURES as error:
            raise self._cut(error) from error
        return self._marks.feed(come) if self._marks is not None else come

    def _come(self, limit: float) -> bytes:
        """Waiting by ``select``: pyserial would set the whole line up again for each other time-out."""
        if sys.platform == "win32":
            self._port.timeout = limit
            first = self._port.read(1)
            return first + self._port.read(self._port.in_waiting)
        ready, _, _ = select.select((self._port.fileno(),), (), (), limit)
        return self._port.read(max(self._port.in_waiting, 1)) if ready else b""

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
        """Let the port go; what the other side holds is dropped, or it would keep us here.

        Only what is held: dropping also empties the transmitter of some UARTs, and of a pseudo terminal, and
        with it the end of what was sent.
        """
        with suppress(*_FAILURES):  # a cable that has gone holds nothing
            if not self._goes_out():
                self._port.reset_output_buffer()
        with suppress(*_FAILURES):
            self._port.close()

    def _goes_out(self) -> bool:
        """Whether the kernel has handed all of it to the line, within the time that takes."""
        for _ in range(_ENDING):
            if not (left := self._port.out_waiting):
                return True
            time.sleep(min(left * self.settings.character, _GLANCE))
        return not self._port.out_waiting

    def _coded(self, data: bytes) -> bytes:
        return data if self._parities is None else data.translate(self._parities)

    def _cut(self, error: Exception) -> WireError:
        return WireError(
            "{port} has failed: {error}", reason="failed", port=self.settings.port, error=why(error)
        )


def _opened(settings: LineSettings) -> serial.Serial:
    """On POSIX bits, parity and XON/XOFF are set afterwards: pyserial does not look whether they are kept."""
    return serial.Serial(
        settings.port,
        settings.baud,
        bytesize=8 if _POSIX else settings.bits,
        parity="N" if _POSIX else settings.parity,
        stopbits=settings.stop,
        xonxoff=not _POSIX and settings.flow == "xonxoff",
        rtscts=settings.flow == "rtscts",
        timeout=0,
        write_timeout=1.0,
        exclusive=True,
    )


# --- Settings of a line that a POSIX terminal does itself; some adapters, and ptys, drop them silently.


if sys.platform != "win32":
    import termios

    _SIZES = {7: termios.CS7, 8: termios.CS8}
    _PARITIES = {"N": 0, "E": termios.PARENB, "O": termios.PARENB | termios.PARODD}
    _FRAME = termios.CSIZE | termios.PARENB | termios.PARODD

    def frame(handle: int, bits: int, parity: str) -> bool:
        """Set bits and parity; whether the port keeps them. Raises termios.error."""
        wanted = _SIZES[bits] | _PARITIES[parity]
        attributes = termios.tcgetattr(handle)
        attributes[2] = attributes[2] & ~_FRAME | wanted
        try:
            termios.tcsetattr(handle, termios.TCSANOW, attributes)
        except termios.error as error:
            if error.args[0] != errno.EINVAL:  # the C library, of a port that keeps none of it
                raise
        return bool(termios.tcgetattr(handle)[2] & _FRAME == wanted)

    def obey_codes(handle: int) -> None:
        """XOFF and XON hold and release what is sent, in the kernel. Raises termios.error."""
        attributes = termios.tcgetattr(handle)
        attributes[0] |= termios.IXON | termios.IXOFF
        termios.tcsetattr(handle, termios.TCSANOW, attributes)

    def mark_damage(handle: int, *, parity: bool) -> None:
        """Damaged characters come as FF 00 and the character, FF as FF FF. Raises termios.error."""
        attributes = termios.tcgetattr(handle)
        attributes[0] |= termios.PARMRK | (termios.INPCK if parity else 0)
        attributes[0] &= ~(termios.IGNPAR | termios.ISTRIP)
        termios.tcsetattr(handle, termios.TCSANOW, attributes)
