"""Binary records that the key watcher, the control and the screen exchange about stop keys.

The records are sent over ``SOCK_SEQPACKET`` sockets, which preserve record boundaries. The module imports
few modules, because the key watcher is a small process.
"""

from __future__ import annotations

import struct
from enum import IntEnum
from typing import NamedTuple

SOURCE_SCREEN = "a key or a touch on the screen"
SOURCE_ESC = "Esc key at the screen"
_STOP = struct.Struct("=BQ")
MAX_RECORD_BYTES = 4096  # Maximum size of a record in bytes.


class StopKind(IntEnum):
    """Kind of stop that a key requests."""

    HOLD = 1
    ESTOP = 2
    ESC = 3  # A feed hold by Esc, if Esc has no other function on the page.

    @property
    def source_text(self) -> str:
        """Return the origin of the feed hold as text for the log."""
        return SOURCE_ESC if self is StopKind.ESC else SOURCE_SCREEN


def make_press_number(key_code: int, time_ms: int) -> int:
    """Return a number that identifies a key press by its X key code and the server's time in ms.

    An event without a time stamp has the number 0, which does not identify a press.
    """
    return key_code << 32 | time_ms & 0xFFFFFFFF if time_ms else 0


class StopKeyPress(NamedTuple):
    """One press of a stop key, with its kind of stop and its press number."""

    stop_kind: StopKind
    press_number: int

    def to_bytes(self) -> bytes:
        """Return the stop as a binary record."""
        return _STOP.pack(self.stop_kind, self.press_number)

    @classmethod
    def from_bytes(cls, record: bytes) -> StopKeyPress:
        """Return the stop that a record contains. Raises ValueError if the record is invalid."""
        if len(record) != _STOP.size:
            raise ValueError(f"{len(record)} bytes are not a stop")
        kind, press = _STOP.unpack(record)
        return cls(StopKind(kind), press)


class FocusRecord(NamedTuple):
    """X window IDs of TurnDesk's windows, and whether Esc currently starts feed hold."""

    window_ids: frozenset[int]
    is_esc_stop_key: bool

    def to_bytes(self) -> bytes:
        """Return the focus record in binary form, with at most 1000 windows."""
        windows = sorted(self.window_ids)[:1000]
        return struct.pack(f"=?{len(windows)}I", self.is_esc_stop_key, *windows)

    @classmethod
    def from_bytes(cls, record: bytes) -> FocusRecord:
        """Return the focus record from its binary form. Raises ValueError if the data is invalid."""
        count, rest = divmod(len(record) - 1, 4)
        if rest or count < 0:
            raise ValueError(f"{len(record)} bytes are not a focus")
        esc_holds, *windows = struct.unpack(f"=?{count}I", record)
        return cls(frozenset(windows), esc_holds)


NO_FOCUS = FocusRecord(frozenset(), is_esc_stop_key=False)
