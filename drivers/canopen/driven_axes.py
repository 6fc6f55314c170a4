"""Position, velocity and time (PVT) as records for the queues of EPOS2 (20C1h) and of Copley (2010h)."""

from __future__ import annotations

import struct
from collections.abc import Callable

from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_config import AxisConfig
from drivers.canopen.canopen_setup import Setup
from drivers.canopen.drive_profiles import Queue, Records

_RECORD = struct.Struct("<i")
_TOP = 2**23 - 1  # of 24 bits with a sign
_CLEAR, _COUNT_ANEW = 0x80, 0x83  # orders to a queue of Copley: empty and stop, count segments from 0
_TENTHS = 10.0  # its velocities are in 0.1 counts/s
_SEGMENTS = 8  # its integrity counter goes round


def packed(ms: int, velocity: float, position: float) -> bytes:
    """One record of EPOS2: position in the low 32 bits, then velocity in 24, then the time in 8.

    Raises ValueError for what does not fit.
    """
    speed, place = round(velocity), round(position)
    if abs(speed) > _TOP or not 0 <= ms <= 255:
        raise ValueError(f"a record of {ms} ms and {speed} counts/s does not fit the drive")
    return _RECORD.pack(place) + (speed & 0xFFFFFF).to_bytes(3, "little") + bytes([ms])


def unpacked(data: bytes) -> tuple[int, int, int]:
    """Milliseconds, velocity and position of a record of EPOS2."""
    return data[7], _signed(data[4:7]), _RECORD.unpack(data[:4])[0]


def segment(number: int, ms: int, velocity: float, position: float) -> bytes:
    """One segment of Copley, format 0: its count, time, place, velocity in 0.1 counts/s.

    Raises ValueError for what does not fit in 24 bits.
    """
    speed, place = round(_TENTHS * velocity), round(position)
    if abs(speed) > _TOP or abs(place) > _TOP or not 0 <= ms <= 255:
        raise ValueError(f"a segment of {ms} ms, {place} counts and {velocity:.0f} counts/s does not fit")
    return bytes([number % _SEGMENTS, ms]) + _low(place) + _low(speed)


def unpacked_segment(data: bytes) -> tuple[int, int, float, int]:
    """Count, milliseconds, velocity in counts/s and position of a segment of Copley."""
    return data[0] & 0x07, data[1], _signed(data[5:8]) / _TENTHS, _signed(data[2:5])


class RecordQueue:
    """The queue of one drive. ``push`` raises ValueError for what its records cannot carry."""

    def __init__(self, config: AxisConfig, queue: Queue, setup: Setup, send: Callable[[bytes], None]) -> None:
        """``send`` brings a record to the drive at once."""
        self._config, self._setup, self._send = config, setup, send
        self.queue = queue
        self._pushed = 0

    def clear(self) -> None:
        """Nothing old is played. Raises DriverError."""
        self._pushed = 0
        if self.queue.records is Records.COPLEY:
            for order in (_CLEAR, _COUNT_ANEW):
                self._setup.write_bytes(self.queue.object, 0, bytes([order]) + bytes(7))
        else:
            for clear in (0, 1):
                self._setup.write(od.BUFFER, 6, clear)

    def push(self, ms: int, velocity: float, position: float) -> None:
        """One more record; mm or degrees, and their speed."""
        config = self._config
        place = position / config.count
        if self.queue.records is Records.COPLEY:
            self._send(segment(self._pushed, ms, velocity / config.count, place))
        else:
            self._send(packed(ms, config.velocity(velocity), place))
        self._pushed += 1


def _low(value: int) -> bytes:
    return (value & 0xFFFFFF).to_bytes(3, "little")


def _signed(data: bytes) -> int:
    return int.from_bytes(data, "little", signed=True)
