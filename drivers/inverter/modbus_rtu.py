"""A Modbus RTU master with one request at a time, retries, and resynchronization after an error."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence

from core.ports import Clock, DriverError
from drivers.serial_line import SerialTransport

# --- Frames of Modbus RTU (Modbus over Serial Line V1.02): unit, function, data, CRC-16 low byte first.


READ_COILS, READ_REGISTERS = 1, 3
WRITE_COIL, WRITE_REGISTER, LOOPBACK, WRITE_REGISTERS = 5, 6, 8, 16
EXCEPTION_BIT = 0x80
_MIN_FRAME_BYTES = 5


def calculate_crc16(data: bytes) -> int:
    """Return the CRC-16 of Modbus.

    The reflected polynomial is x¹⁶+x¹⁵+x²+1 (A001), and the initial value is FFFF.
    """
    crc = 0xFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0xA001 if crc & 1 else crc >> 1
    return crc


def append_crc(body: bytes) -> bytes:
    """Return a frame that consists of ``body`` and its CRC."""
    return body + struct.pack("<H", calculate_crc16(body))


def has_valid_crc(frame: bytes) -> bool:
    """Return whether the CRC at the end of a frame is correct."""
    return len(frame) >= _MIN_FRAME_BYTES - 1 and calculate_crc16(frame[:-2]) == int.from_bytes(
        frame[-2:], "little"
    )


def encode_read_request(function: int, address: int, count: int) -> bytes:
    """Return the function code and the data of a read request."""
    return struct.pack(">BHH", function, address, count)


def encode_write_coil(address: int, on: bool) -> bytes:
    """Return the function code and the data of a request to write one coil (05)."""
    return struct.pack(">BHH", WRITE_COIL, address, 0xFF00 if on else 0)


def encode_write_register(address: int, value: int) -> bytes:
    """Return the function code and the data of a request to write one register (06)."""
    return struct.pack(">BHH", WRITE_REGISTER, address, value)


def encode_write_registers(address: int, values: Sequence[int]) -> bytes:
    """Return the function code and the data of a request to write several registers (10 hex)."""
    head = struct.pack(">BHHB", WRITE_REGISTERS, address, len(values), 2 * len(values))
    return head + struct.pack(f">{len(values)}H", *values)


def encode_echo_request(value: int) -> bytes:
    """Return the function code and the data of an echo request (08, subfunction 0)."""
    return struct.pack(">BHH", LOOPBACK, 0, value)


def find_response(buffer: bytes, unit: int, function: int) -> bytes | None:
    """Return the first complete response to ``function`` in the received bytes, or None.

    Noise before and after the response is ignored.
    """
    for start in range(len(buffer) - _MIN_FRAME_BYTES + 1):
        if buffer[start] != unit or buffer[start + 1] & ~EXCEPTION_BIT != function:
            continue
        frame = buffer[start : start + _length(buffer[start:])]
        if has_valid_crc(frame) and len(frame) == _length(buffer[start:]):
            return frame
    return None


def _length(frame: bytes) -> int:
    if frame[1] & EXCEPTION_BIT:
        return 5
    return 5 + frame[2] if frame[1] <= READ_REGISTERS else 8


# --- Errors between a request and its response.


class NoResponseError(DriverError):
    """Error raised if no readable response is received from the device."""


class RequestRejectedError(DriverError):
    """Error raised if the device rejects a request."""


class RequestWithheldError(Exception):
    """Error raised if a request is not sent because a stop is pending."""


REQUEST_INTERVAL_S = (
    0.03  # Seconds between the starts of two requests; inverters lose more frequent requests.
)
REPLY_TIMEOUT_S = 0.2  # Seconds for a response.
MAX_TRIES = 3
_EXCEPTION_TEXTS = {
    1: "illegal function",
    2: "illegal data address",
    3: "illegal data value",
    4: "device failure",
    5: "request accepted, not yet completed",
    6: "busy",
}


def report_no_pending_stop() -> bool:
    """Return False; this default function is used if a stop can never be pending."""
    return False


class ModbusMaster:
    """Modbus RTU master.

    ``is_stop_pending`` returns whether a stop is pending. A pending stop ends the retries of a read. It
    also cancels a write with ``is_canceled_by_stop``, which then raises RequestWithheldError.
    """

    def __init__(
        self,
        wire: SerialTransport,
        clock: Clock,
        unit_address: int,
        character_s: float,
        request_interval_s: float = REQUEST_INTERVAL_S,
    ) -> None:
        self.wire, self._clock, self._unit, self._pace = wire, clock, unit_address, request_interval_s
        self._gap = max(3.5 * character_s, 0.00175)  # A fixed 1.75 ms above 19200 baud.
        self._free = clock.now()
        self._doubt = False  # A late response may still arrive.
        self._echo = 0
        self.is_stop_pending: Callable[[], bool] = report_no_pending_stop
        self.valid_response_count = 0  # Consecutive responses.
        self.failure_count = 0  # Failures since the start.

    def read_registers(self, address: int, count: int = 1) -> list[int]:
        """Read holding registers (03).

        All methods raise NoResponseError, RequestRejectedError or SerialLineError if the exchange fails.
        """
        frame = self._send_read(encode_read_request(READ_REGISTERS, address, count), 2 * count)
        return [word for (word,) in struct.iter_unpack(">H", frame[3:-2])]

    def read_coils(self, address: int, count: int = 1) -> list[bool]:
        """Read coils (01), and return their states."""
        packed = self._send_read(encode_read_request(READ_COILS, address, count), (count + 7) // 8)[3:-2]
        return [bool(int.from_bytes(packed, "little") >> number & 1) for number in range(count)]

    def write_coil(
        self, address: int, on: bool, max_tries: int = MAX_TRIES, *, is_canceled_by_stop: bool = False
    ) -> None:
        """Write one coil (05)."""
        self._send_write(encode_write_coil(address, on), max_tries, is_canceled_by_stop)

    def write_register(
        self, address: int, value: int, max_tries: int = MAX_TRIES, *, is_canceled_by_stop: bool = False
    ) -> None:
        """Write one register (06).

        With ``max_tries`` = 1, the command is not repeated.
        """
        self._send_write(encode_write_register(address, value), max_tries, is_canceled_by_stop)

    def write_registers(
        self,
        address: int,
        values: Sequence[int],
        max_tries: int = MAX_TRIES,
        *,
        is_canceled_by_stop: bool = False,
    ) -> None:
        """Write several registers (10 hex)."""
        self._send_write(encode_write_registers(address, values), max_tries, is_canceled_by_stop)

    def _send_read(self, pdu: bytes, size: int) -> bytes:
        """Send a read request, and return its response.

        A response does not identify its request. After an error, an echo request is therefore sent first.
        """
        for left in reversed(range(MAX_TRIES)):
            try:
                if self._doubt:
                    self._resynchronize()
                frame = self._once(pdu)
                if frame[2] == size:
                    return frame
                self._failed()
            except NoResponseError:
                if not left or self.is_stop_pending():
                    raise
        raise NoResponseError("the inverter's responses do not match the requests")

    def _send_write(self, pdu: bytes, tries: int, is_canceled_by_stop: bool) -> None:
        """Send a write request, and check its response.

        The response must repeat the address and the value or count of the request.
        """
        for left in reversed(range(tries)):
            try:
                if self._once(pdu, is_canceled_by_stop)[1:6] == pdu[:5]:
                    return
                self._failed()
            except NoResponseError:
                if not left:
                    raise
        raise NoResponseError("the inverter's response does not match the write request")

    def _resynchronize(self) -> None:
        """Exchange an echo with a new value, so that late responses are detected."""
        self._echo = self._echo % 0xFFFF + 1
        pdu = encode_echo_request(self._echo)
        try:
            frame = self._once(pdu)
        except RequestRejectedError:
            self._doubt = False  # The device has rejected the echo, so it is synchronized.
            return
        if frame[1:6] != pdu:
            self._failed()
            raise NoResponseError("the inverter responds too late", reason="late")
        self._doubt = False

    def _once(self, pdu: bytes, gives_way: bool = False) -> bytes:
        self._clock.sleep_until(self._free)
        if gives_way and self.is_stop_pending():
            raise RequestWithheldError
        self.wire.discard_input()
        began = self._clock.now()
        self.wire.send(append_crc(bytes((self._unit,)) + pdu))
        frame = self._answer(pdu[0], began + REPLY_TIMEOUT_S)
        self._free = max(self._clock.now() + self._gap, began + self._pace)
        self.valid_response_count += 1
        if frame[1] & EXCEPTION_BIT:
            why = _EXCEPTION_TEXTS.get(frame[2], f"exception {frame[2]}")
            raise RequestRejectedError(
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
            frame = find_response(come, self._unit, function)
            if frame is not None:
                return frame
        self._free = self._clock.now() + self._gap
        self._failed()
        if come:
            raise NoResponseError(
                "the inverter sent {come_count} bytes but not a valid response; check the line "
                "settings and id",
                reason="garbled",
                come_count=len(come),
            )
        raise NoResponseError(
            "the inverter does not respond; check the cable, id and line settings", reason="silent"
        )

    def _failed(self) -> None:
        self._doubt = True
        self.valid_response_count = 0
        self.failure_count += 1
