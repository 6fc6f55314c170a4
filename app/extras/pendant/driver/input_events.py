"""Input events as the kernel writes them: ``struct input_event``, its packets, and what gets lost."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

from app.extras.pendant.driver.input_codes import SYN, SYN_DROPPED, SYN_REPORT

# Two C longs of time, then type, code and value: 24 bytes where a long has 8. It is part of the kernel's
# promise to programs (Documentation/input/event-codes.rst), and does not change.
EVENT = struct.Struct("@llHHi")


class InputEvent(NamedTuple):
    """``t`` is when the kernel had it, seconds of the clock that the device was told to use."""

    t: float
    kind: int
    code: int
    value: int


class Packet(NamedTuple):
    """What changed at once; ``lost``: events before it were thrown away, so nothing in it can be counted."""

    events: tuple[InputEvent, ...]
    lost: bool = False


class Packets:
    """Bytes in, whole packets out. From SYN_DROPPED to the next SYN_REPORT everything is worth nothing."""

    def __init__(self) -> None:
        self._bytes = b""
        self._events: list[InputEvent] = []
        self._lost = False

    def feed(self, data: bytes) -> Iterator[Packet]:
        """Every packet that is whole now."""
        self._bytes += data
        whole = len(self._bytes) // EVENT.size * EVENT.size
        read, self._bytes = self._bytes[:whole], self._bytes[whole:]
        for seconds, micro, kind, code, value in EVENT.iter_unpack(read):
            event = InputEvent(seconds + 1e-6 * micro, kind, code, value)
            if kind != SYN:
                self._events.append(event)
            elif code == SYN_DROPPED:
                self._lost = True
            elif code == SYN_REPORT:
                packet = Packet(() if self._lost else tuple(self._events), self._lost)
                self._events, self._lost = [], False
                yield packet
