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
_FOCUS, _AREA = struct.Struct("=??QQHH"), struct.Struct("=IiiiiB")
MAX_RECORD_BYTES = 4096  # Maximum size of a record in bytes.
_MAX_WINDOWS, _MAX_AREAS = 500, 64  # Number of windows and areas in a record: 3 400 bytes.
# Code of mouse button 0 in press numbers. X key codes are less than 256.
_BUTTON_CODES = 0x100
TOUCH_CODE = 0x200  # Code of a touch in press numbers.


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


def make_button_code(button: int) -> int:
    """Return the code of a mouse button, by its number in X, for press numbers."""
    return _BUTTON_CODES | button & 0xFF


class StopKeyPress(NamedTuple):
    """One press of a stop key or of a drawn stop control, with its kind of stop and its press number."""

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


class StopArea(NamedTuple):
    """Rectangle of a drawn stop control, in pixels of X from the corner of its window.

    The coordinates remain correct when the window is moved.
    """

    window_id: int
    left_px: int
    top_px: int
    width_px: int
    height_px: int
    stop_kind: StopKind

    def contains(self, x_px: int, y_px: int) -> bool:
        """Return whether a position in the window is in the rectangle."""
        return 0 <= x_px - self.left_px < self.width_px and 0 <= y_px - self.top_px < self.height_px


class FocusRecord(NamedTuple):
    """X window IDs of TurnDesk's windows, and the keys and drawn controls that currently stop the machine.

    ``is_esc_stop_key`` is whether Esc currently starts feed hold. ``are_letters_stop_keys`` is whether H, E
    and Space stop the machine, because no text field has the keyboard focus. ``handled_press`` is the number
    of the last press that the screen has handled before it made the record, and ``received_press`` that of
    the last press that it has received.
    """

    window_ids: frozenset[int]
    is_esc_stop_key: bool
    stop_areas: tuple[StopArea, ...] = ()
    are_letters_stop_keys: bool = False
    handled_press: int = 0
    received_press: int = 0

    def to_bytes(self) -> bytes:
        """Return the focus record in binary form, with at most 500 windows and 64 areas."""
        windows, areas = sorted(self.window_ids)[:_MAX_WINDOWS], self.stop_areas[:_MAX_AREAS]
        flags = (self.is_esc_stop_key, self.are_letters_stop_keys)
        presses = (self.handled_press, self.received_press)
        head = _FOCUS.pack(*flags, *presses, len(windows), len(areas))
        return b"".join((head, struct.pack(f"={len(windows)}I", *windows), *(_AREA.pack(*a) for a in areas)))

    @classmethod
    def from_bytes(cls, record: bytes) -> FocusRecord:
        """Return the focus record from its binary form. Raises ValueError if the data is invalid."""
        try:
            esc_holds, letters_stop, handled, received, windows, areas = _FOCUS.unpack_from(record)
        except struct.error:
            windows = areas = -1
        start = _FOCUS.size + 4 * windows
        if windows < 0 or len(record) != start + areas * _AREA.size:
            raise ValueError(f"{len(record)} bytes are not a focus")
        return cls(
            frozenset(struct.unpack_from(f"={windows}I", record, _FOCUS.size)),
            esc_holds,
            tuple(
                StopArea(window, left, top, width, height, StopKind(kind))
                for window, left, top, width, height, kind in _AREA.iter_unpack(record[start:])
            ),
            letters_stop,
            handled,
            received,
        )


NO_FOCUS = FocusRecord(frozenset(), is_esc_stop_key=False)
