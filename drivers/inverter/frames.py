"""Frames of Modbus RTU (Modbus over Serial Line V1.02): unit, function, data, CRC-16 low byte first."""

from __future__ import annotations

import struct
from collections.abc import Sequence

READ_COILS, READ_INPUTS, READ_REGISTERS, READ_INPUT_REGISTERS = 1, 2, 3, 4
WRITE_COIL, WRITE_REGISTER, LOOPBACK, WRITE_COILS, WRITE_REGISTERS = 5, 6, 8, 15, 16
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


def write_coils(address: int, on: Sequence[bool]) -> bytes:
    """0F: the first coil is the lowest bit of the first byte."""
    packed = sum(1 << number for number, state in enumerate(on) if state)
    size = (len(on) + 7) // 8
    return struct.pack(">BHHB", WRITE_COILS, address, len(on), size) + packed.to_bytes(size, "little")


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
    return 5 + frame[2] if frame[1] <= READ_INPUT_REGISTERS else 8


def registers_of(frame: bytes) -> list[int]:
    """The words of an answer to 03 or 04."""
    return [word for (word,) in struct.iter_unpack(">H", frame[3:-2])]


def bits_of(frame: bytes, count: int) -> list[bool]:
    """The bits of an answer to 01 or 02."""
    packed = int.from_bytes(frame[3:-2], "little")
    return [bool(packed >> number & 1) for number in range(count)]
