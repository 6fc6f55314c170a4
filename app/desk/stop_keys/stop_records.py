"""Fixed records of the stop keys between the key watcher, the control and the screen.

All three travel over ``SOCK_SEQPACKET`` sockets, which keep records whole. The module imports little, because
the key watcher is a small process.
"""

from __future__ import annotations

import struct
from enum import IntEnum
from typing import NamedTuple

BY_SCREEN = "a key or a touch on the screen"
BY_ESC = "Esc key at the screen"
_STOP = struct.Struct("=BQ")
LONGEST = 4096  # bytes of a record


class StopKind(IntEnum):
    """The stop that a key asks for."""

    HOLD = 1
    ESTOP = 2
    ESC = 3  # a feed hold by Esc, where the page offers nothing else for Esc

    @property
    def by(self) -> str:
        """Return who asked for the feed hold, for the log."""
        return BY_ESC if self is StopKind.ESC else BY_SCREEN


def press_number(code: int, stamp: int) -> int:
    """Return the number of one press of a key: its X key code, and the time of the server in ms.

    An event without a time stamp has the number 0, and is never the same press as another.
    """
    return code << 32 | stamp & 0xFFFFFFFF if stamp else 0


class Stop(NamedTuple):
    """One press of a stop key; ``press`` is the number of the press."""

    kind: StopKind
    press: int

    def packed(self) -> bytes:
        """Return it as a record."""
        return _STOP.pack(self.kind, self.press)

    @classmethod
    def unpacked(cls, record: bytes) -> Stop:
        """Return the stop of a record. Raises ValueError for anything else."""
        if len(record) != _STOP.size:
            raise ValueError(f"{len(record)} bytes are not a stop")
        kind, press = _STOP.unpack(record)
        return cls(StopKind(kind), press)


class Focus(NamedTuple):
    """The windows of TurnDesk by X's numbers, and whether Esc holds the feed now."""

    windows: frozenset[int]
    esc_holds: bool

    def packed(self) -> bytes:
        """Return it as a record, of as many windows as fit."""
        windows = sorted(self.windows)[:1000]
        return struct.pack(f"=?{len(windows)}I", self.esc_holds, *windows)

    @classmethod
    def unpacked(cls, record: bytes) -> Focus:
        """Return the focus of a record. Raises ValueError for anything else."""
        count, rest = divmod(len(record) - 1, 4)
        if rest or count < 0:
            raise ValueError(f"{len(record)} bytes are not a focus")
        esc_holds, *windows = struct.unpack(f"=?{count}I", record)
        return cls(frozenset(windows), esc_holds)


NOWHERE = Focus(frozenset(), esc_holds=False)
