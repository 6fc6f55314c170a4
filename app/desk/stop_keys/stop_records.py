"""Binary records of the stop keys between the key watcher, the control and the screen.

They travel over ``SOCK_SEQPACKET`` sockets, which preserve record boundaries. The module imports little,
because the key watcher is a small process.
"""

from __future__ import annotations

import struct
from enum import IntEnum
from typing import NamedTuple

BY_SCREEN = "a key or a touch on the screen"
BY_ESC = "Esc key at the screen"
_STOP = struct.Struct("=BQ")
LONGEST = 4096  # Maximum size of a record in bytes.


class StopKind(IntEnum):
    """The stop that a key requests."""

    HOLD = 1
    ESTOP = 2
    ESC = 3  # A feed hold by Esc, if Esc has no other function on the page.

    @property
    def by(self) -> str:
        """The origin of the feed hold, for the log."""
        return BY_ESC if self is StopKind.ESC else BY_SCREEN


def press_number(code: int, stamp: int) -> int:
    """Return the number of a key press, from its X key code and the server's time in ms.

    An event without a time stamp has the number 0, which never equals another press.
    """
    return code << 32 | stamp & 0xFFFFFFFF if stamp else 0


class Stop(NamedTuple):
    """One press of a stop key; ``press`` is the number of the press."""

    kind: StopKind
    press: int

    def packed(self) -> bytes:
        """Return the stop as a binary record."""
        return _STOP.pack(self.kind, self.press)

    @classmethod
    def unpacked(cls, record: bytes) -> Stop:
        """Return the stop in a record. Raises ValueError for an invalid record."""
        if len(record) != _STOP.size:
            raise ValueError(f"{len(record)} bytes are not a stop")
        kind, press = _STOP.unpack(record)
        return cls(StopKind(kind), press)


class Focus(NamedTuple):
    """The X window numbers of TurnDesk, and whether Esc starts feed hold now."""

    windows: frozenset[int]
    esc_holds: bool

    def packed(self) -> bytes:
        """Return the focus as a binary record with 1000 windows at most."""
        windows = sorted(self.windows)[:1000]
        return struct.pack(f"=?{len(windows)}I", self.esc_holds, *windows)

    @classmethod
    def unpacked(cls, record: bytes) -> Focus:
        """Return the focus in a record. Raises ValueError for an invalid record."""
        count, rest = divmod(len(record) - 1, 4)
        if rest or count < 0:
            raise ValueError(f"{len(record)} bytes are not a focus")
        esc_holds, *windows = struct.unpack(f"=?{count}I", record)
        return cls(frozenset(windows), esc_holds)


NOWHERE = Focus(frozenset(), esc_holds=False)
