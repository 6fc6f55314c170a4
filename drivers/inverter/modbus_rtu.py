"""A Modbus RTU master on one line: one request at a time, retried, resynchronised after what went wrong."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence

from core.ports import Clock, DriverError
from drivers.serial_line import Wire

# --- Frames of Modbus RTU (Modbus over Serial Line V1.02): unit, function, data, CRC-16 low byte first.


READ_COILS, READ_REGISTERS = 1, 3
WRITE_COIL, WRITE_REGISTER, LOOPBACK, WRITE_REGISTERS = 5, 6, 8, 16
FAILED = 0x80
_SHORTEST = 5


def crc16(data: bytes) -> int:
    """CRC-16 with the polynomial x¹⁶+x¹⁵+x²+1 reflected (A001), beginning with FFFF."""
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc


def sealed(body: bytes) -> bytes:
    """With its CRC."""
    return body + struct.pack("<H", crc16(body))


def whole(frame: bytes) -> bool:
    """Whether the CRC at its end is right."""
    return len(frame) >= _SHORTEST - 1 and crc16(frame[:-2]) == int.from_bytes(frame[-2:], "little")


def read(function: int, address: int, count: int) -> bytes:
    """Function and data of a read."""
    return struct.pack(">BHH", function, address, count)


def write_coil(address: int, on: bool) -> bytes:
    """05."""
    return struct.pack(">BHH", WRITE_COIL, address, 0xFF00 if on else 0)


def write_register(address: int, value: int) -> bytes:
    """06."""
    return struct.pack(">BHH", WRITE_REGISTER, address, value)


def write_registers(address: int, values: Sequence[int]) -> bytes:
    """10."""
    head = struct.pack(">BHHB", WRITE_REGISTERS, address, len(values), 2 * len(values))
    return head + struct.pack(f">{len(values)}H", *values)


def loopback(value: int) -> bytes:
    """08, sub-function 0: comes back as it is."""
    return struct.pack(">BHH", LOOPBACK, 0, value)


def answer_in(buffer: bytes, unit: int, function: int) -> bytes | None:
    """The first whole answer to ``function`` anywhere in what has come; noise before and behind is skipped.

    None: not yet.
    """
    for start in range(len(buffer) - _SHORTEST + 1):
        if buffer[start] != unit or buffer[start + 1] & ~FAILED != function:
            continue
        frame = buffer[start : start + _length(buffer[start:])]
        if whole(frame) and len(frame) == _length(buffer[start:]):
            return frame
    return None


def _length(frame: bytes) -> int:
    if frame[1] & FAILED:
        return 5
    return 5 + frame[2] if frame[1] <= READ_REGISTERS else 8


# --- What can go wrong between a request and its answer.


class NoAnswerError(DriverError):
    """The device has not answered, or nothing that could be read."""


class RefusedError(DriverError):
    """The device answered that it will not."""


class HeldBackError(Exception):
    """A stop came before the request was sent."""


PACE = 0.03  # s between the beginnings of two requests: inverters lose their line when asked more often
TIMEOUT = 0.2  # s for an answer
TRIES = 3
_EXCEPTIONS = {
    1: "illegal function",
    2: "illegal data address",
    3: "illegal data value",
    4: "device failure",
    5: "request accepted, not yet completed",
    6: "busy",
}


def never() -> bool:
    """Nothing is more urgent."""
    return False


class Modbus:
    """``hurry`` tells that a stop is waiting to go out, which ends retries of a read early.

    A write that ``gives_way`` is then not sent either: it raises HeldBackError, also in place of a retry.
    """

    def __init__(self, wire: Wire, clock: Clock, unit: int, character: float, pace: float = PACE) -> None:
        self.wire, self._clock, self._unit, self._pace = wire, clock, unit, pace
        self._gap = max(3.5 * character, 0.00175)  # a fixed 1.75 ms above 19200 baud
        self._free = clock.now()
        self._doubt = False  # an answer may still be on its way
        self._echo = 0
        self.hurry: Callable[[], bool] = never
        self.good = 0  # answers in a row
        self.bad = 0  # all that failed since the start

    def registers(self, address: int, count: int = 1) -> list[int]:
        """03. Raises NoAnswerError, RefusedError, WireError; so do all others."""
        frame = self._read(read(READ_REGISTERS, address, count), 2 * count)
        return [word for (word,) in struct.iter_unpack(">H", frame[3:-2])]

    def coils(self, address: int, count: int = 1) -> list[bool]:
        """01."""
        packed = self._read(read(READ_COILS, address, count), (count + 7) // 8)[3:-2]
        return [bool(int.from_bytes(packed, "little") >> number & 1) for number in range(count)]

    def write_coil(self, address: int, on: bool, tries: int = TRIES, *, gives_way: bool = False) -> None:
        """05."""
        self._write(write_coil(address, on), tries, gives_way)

    def write_register(
        self, address: int, value: int, tries: int = TRIES, *, gives_way: bool = False
    ) -> None:
        """06; ``tries`` 1: what must not be said twice."""
        self._write(write_register(address, value), tries, gives_way)

    def write_registers(
        self, address: int, values: Sequence[int], tries: int = TRIES, *, gives_way: bool = False
    ) -> None:
        """10."""
        self._write(write_registers(address, values), tries, gives_way)

    def _read(self, pdu: bytes, size: int) -> bytes:
        """An answer says nothing of what was asked: after a doubt an echo comes first."""
        for left in reversed(range(TRIES)):
            try:
                if self._doubt:
                    self._settle()
                frame = self._once(pdu)
                if frame[2] == size:
                    return frame
                self._failed()
            except NoAnswerError:
                if not left or self.hurry():
                    raise
        raise NoAnswerError("the inverter's responses do not match the requests")

    def _write(self, pdu: bytes, tries: int, gives_way: bool) -> None:
        """The answer repeats address and value, or address and count."""
        for left in reversed(range(tries)):
            try:
                if self._once(pdu, gives_way)[1:6] == pdu[:5]:
                    return
                self._failed()
            except NoAnswerError:
                if not left:
                    raise
        raise NoAnswerError("the inverter's response does not match the write request")

    def _settle(self) -> None:
        """Nothing that comes late can be this echo."""
        self._echo = self._echo % 0xFFFF + 1
        pdu = loopback(self._echo)
        try:
            frame = self._once(pdu)
        except RefusedError:
            self._doubt = False  # it knows no loopback, and has said so
            return
        if frame[1:6] != pdu:
            self._failed()
            raise NoAnswerError("the inverter responds too late", reason="late")
        self._doubt = False

    def _once(self, pdu: bytes, gives_way: bool = False) -> bytes:
        self._clock.sleep_until(self._free)
        if gives_way and self.hurry():
            raise HeldBackError
        self.wire.discard()
        began = self._clock.now()
        self.wire.send(sealed(bytes((self._unit,)) + pdu))
        frame = self._answer(pdu[0], began + TIMEOUT)
        self._free = max(self._clock.now() + self._gap, began + self._pace)
        self.good += 1
        if frame[1] & FAILED:
            why = _EXCEPTIONS.get(frame[2], f"exception {frame[2]}")
            raise RefusedError(
                "the inverter rejects Modbus function {pdu}: {why}",
                reason=f"exception-{frame[2]}",
                pdu=f"{pdu[0]:02X}",
                why=why,
            )
        return frame

    def _answer(self, function: int, until: float) -> bytes:
        come = b""
        while (left := until - self._clock.now()) > 0:
            come += self.wire.receive(left)
            frame = answer_in(come, self._unit, function)
            if frame is not None:
                return frame
        self._free = self._clock.now() + self._gap
        self._failed()
        if come:
            raise NoAnswerError(
                "the inverter sent {come_count} bytes but not a valid response; check the line "
                "settings and id",
                reason="garbled",
                come_count=len(come),
            )
        raise NoAnswerError(
            "the inverter does not respond; check the cable, id and line settings", reason="silent"
        )

    def _failed(self) -> None:
        self._doubt = True
        self.good = 0
        self.bad += 1
