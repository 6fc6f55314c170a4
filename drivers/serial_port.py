"""Serial ports of this computer, based on pyserial; each error text is a single sentence."""

from __future__ import annotations

import errno
import os
import sys
import time
from contextlib import suppress
from typing import NamedTuple

import serial
from serial.tools.list_ports import comports

from drivers.serial_line import PARITY_VALUES, LineSettings, SerialLineError, create_parity_table, why

# --- Marks of a POSIX terminal for damaged characters (PARMRK).


class ParityMarkDecoder:
    """Decoder of the PARMRK marks of termios, which also counts damaged characters.

    The bytes FF 00 c represent a damaged character c, and the bytes FF FF represent a valid FF.
    """

    def __init__(self) -> None:
        self.damaged_count = 0
        self._rest = b""

    def decode(self, received: bytes) -> bytes:
        """Return the received characters without marks; damaged characters are returned unchanged."""
        data, out = self._rest + received, bytearray()
        at = 0
        while at < len(data):
            if data[at] != 0xFF:
                out.append(data[at])
                at += 1
            elif data[at + 1 : at + 2] == b"\xff":
                out.append(0xFF)
                at += 2
            elif len(data) - at >= 3:
                self.damaged_count += 1
                out.append(data[at + 2])
                at += 3
            else:
                break
        self._rest = data[at:]
        return bytes(out)


_IS_POSIX = sys.platform != "win32"
_ENDING, _GLANCE = 20, 0.05  # Checks and s: one second for the last characters at 110 baud.
# The error of termios is not an OSError. pyserial raises TypeError if the port was closed by another thread.
_FAILURES: tuple[type[Exception], ...] = (serial.SerialException, OSError, TypeError)
if sys.platform != "win32":
    import select
    import termios

    _FAILURES += (termios.error,)
_OPEN_ERRORS: tuple[type[Exception], ...] = (*_FAILURES, ValueError)


class SerialPortInfo(NamedTuple):
    """Device name and description of a serial port of this computer."""

    device_name: str
    description: str


def list_serial_ports() -> list[SerialPortInfo]:
    """Return the serial ports of this computer, sorted by name."""
    return sorted(
        SerialPortInfo(port.device, "" if port.description in {None, "n/a"} else port.description)
        for port in comports()
    )


class SerialPort:
    """Serial port of this computer, opened for exclusive use.

    With ``count_damaged``, damaged characters are counted. If the port does not support seven bits with
    parity, this class adds the parity bit in software. It then ignores XOFF and XON from the connected
    device.
    """

    def __init__(self, settings: LineSettings, *, count_damaged: bool = False) -> None:
        """Open and configure the port.

        Raises SerialLineError if the port cannot be opened or configured.
        """
        self.settings = settings
        self._marks = ParityMarkDecoder() if count_damaged and _IS_POSIX else None
        self._parities: bytes | None = None
        try:
            self._port = _open_port(settings)
        except _OPEN_ERRORS as error:
            raise SerialLineError(
                "{port} cannot be opened: {error}", reason="not-opened", port=settings.port, error=why(error)
            ) from error
        try:
            self._set_up(settings)
        except _OPEN_ERRORS as error:
            self._port.close()
            raise SerialLineError(
                "{port} cannot be set to {settings}: {error}",
                port=settings.port,
                settings=settings.description,
                error=why(error),
            ) from error

    def _set_up(self, settings: LineSettings) -> None:
        if sys.platform == "win32":
            return
        handle = self._port.fileno()
        kept = set_character_format(handle, settings.data_bits, settings.parity)
        if settings.data_bits == 7 and settings.parity in PARITY_VALUES and not kept:
            self._parities = create_parity_table(settings.parity)
        if settings.flow_control == "xonxoff":
            self.enable_xon_xoff()
        if self._marks is not None:
            enable_parity_marks(handle, check_parity=settings.parity != "N")

    @property
    def damaged_character_count(self) -> int:
        """Return the number of parity and framing errors, or 0 if damaged characters are not counted."""
        return self._marks.damaged_count if self._marks is not None else 0

    def send(self, data: bytes) -> None:
        """Send bytes.

        Raises SerialLineError if the line has failed, or if the connected device stops the output for more
        than one second.
        """
        try:
            self._port.write(self._coded(data))
        except _FAILURES as error:
            raise self._cut(error) from error

    def send_available_bytes(self, data: bytes) -> int:
        """Send the bytes that the kernel accepts immediately and return their number."""
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

    def enable_xon_xoff(self) -> None:
        """Enable XON/XOFF in the kernel.

        If this class adds the parity bit, the call has no effect, because the kernel does not recognize XON
        and XOFF with a parity bit.
        """
        try:
            if sys.platform == "win32":
                self._port.xonxoff = True
            elif self._parities is None:
                enable_kernel_flow_control(self._port.fileno())
        except _FAILURES as error:
            raise self._cut(error) from error

    def receive(self, timeout_s: float) -> bytes:
        """Return the received bytes, after waiting up to ``timeout_s`` seconds for the first byte."""
        try:
            come = self._read_available(max(timeout_s, 0.0))
        except _FAILURES as error:
            raise self._cut(error) from error
        return self._marks.decode(come) if self._marks is not None else come

    def _read_available(self, limit: float) -> bytes:
        """Wait at most ``limit`` seconds for the first byte, and return all received bytes.

        The method waits with ``select``, because changing the pyserial timeout would reconfigure the port
        each time.
        """
        if sys.platform == "win32":
            self._port.timeout = limit
            first = self._port.read(1)
            return first + self._port.read(self._port.in_waiting)
        ready, _, _ = select.select((self._port.fileno(),), (), (), limit)
        return self._port.read(max(self._port.in_waiting, 1)) if ready else b""

    def discard_input(self) -> None:
        """Discard received bytes that have not been read."""
        try:
            self._port.reset_input_buffer()
        except _FAILURES as error:
            raise self._cut(error) from error

    def count_unsent_bytes(self) -> int:
        """Return the number of bytes in the kernel's output buffer."""
        try:
            return int(self._port.out_waiting)
        except _FAILURES as error:
            raise self._cut(error) from error

    def discard_output(self) -> None:
        """Discard the bytes in the kernel's output buffer."""
        try:
            self._port.reset_output_buffer()
        except _FAILURES as error:
            raise self._cut(error) from error

    def close(self) -> None:
        """Close the port.

        If the connected device has stopped the output, the remaining output is discarded, because closing
        would block. Otherwise the output is not discarded, because some UARTs and pseudo terminals would
        then also lose the bytes that they are transmitting.
        """
        with suppress(*_FAILURES):  # A disconnected cable does not block.
            if not self._is_sending():
                self._port.reset_output_buffer()
        with suppress(*_FAILURES):
            self._port.close()

    def _is_sending(self) -> bool:
        """Wait briefly, and return whether the kernel has transmitted the remaining output.

        The result is False if the output appears to be stopped.
        """
        for _ in range(_ENDING):
            if not (left := self._port.out_waiting):
                return True
            time.sleep(min(left * self.settings.character_time_s, _GLANCE))
        return not self._port.out_waiting

    def _coded(self, data: bytes) -> bytes:
        return data if self._parities is None else data.translate(self._parities)

    def _cut(self, error: Exception) -> SerialLineError:
        return SerialLineError(
            "{port} has failed: {error}", reason="failed", port=self.settings.port, error=why(error)
        )


def _open_port(settings: LineSettings) -> serial.Serial:
    """Open the port with pyserial.

    On POSIX, the data bits, parity and XON/XOFF are set later, because pyserial does not verify them.
    """
    return serial.Serial(
        settings.port,
        settings.baud,
        bytesize=8 if _IS_POSIX else settings.data_bits,
        parity="N" if _IS_POSIX else settings.parity,
        stopbits=settings.stop_bits,
        xonxoff=not _IS_POSIX and settings.flow_control == "xonxoff",
        rtscts=settings.flow_control == "rtscts",
        timeout=0,
        write_timeout=1.0,
        exclusive=True,
    )


# --- Line settings of a POSIX terminal, which some adapters and ptys ignore silently.


if sys.platform != "win32":
    import termios

    _SIZES = {7: termios.CS7, 8: termios.CS8}
    _PARITIES = {"N": 0, "E": termios.PARENB, "O": termios.PARENB | termios.PARODD}
    _FRAME = termios.CSIZE | termios.PARENB | termios.PARODD

    def set_character_format(handle: int, bits: int, parity: str) -> bool:
        """Set data bits and parity, and return whether the port accepts them.

        Raises termios.error if the port has failed.
        """
        wanted = _SIZES[bits] | _PARITIES[parity]
        attributes = termios.tcgetattr(handle)
        attributes[2] = attributes[2] & ~_FRAME | wanted
        try:
            termios.tcsetattr(handle, termios.TCSANOW, attributes)
        except termios.error as error:
            # The C library reports this for a port that accepts none of the settings.
            if error.args[0] != errno.EINVAL:
                raise
        return bool(termios.tcgetattr(handle)[2] & _FRAME == wanted)

    def enable_kernel_flow_control(handle: int) -> None:
        """Let XOFF and XON from the connected device stop and resume the output in the kernel.

        Raises termios.error if the port has failed.
        """
        attributes = termios.tcgetattr(handle)
        attributes[0] |= termios.IXON | termios.IXOFF
        termios.tcsetattr(handle, termios.TCSANOW, attributes)

    def enable_parity_marks(handle: int, *, check_parity: bool) -> None:
        """Make the kernel mark a damaged character c as FF 00 c, and a valid FF as FF FF.

        With ``check_parity``, parity errors are also marked. Raises termios.error if the port has failed.
        """
        attributes = termios.tcgetattr(handle)
        attributes[0] |= termios.PARMRK | (termios.INPCK if check_parity else 0)
        attributes[0] &= ~(termios.IGNPAR | termios.ISTRIP)
        termios.tcsetattr(handle, termios.TCSANOW, attributes)
