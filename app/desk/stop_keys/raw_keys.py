"""Reader of key presses directly from the X server, even while the focused program hangs.

While another client has grabbed the keyboard, for example a screen lock, the reader receives nothing.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from typing import NamedTuple

from app.desk.stop_keys.key_codes import LETTERS_BY_CODE
from app.desk.stop_keys.raw_events import RawEventConnection, RawEventKind

_POINTER_ROOT = 1  # Focus value: the window under the pointer has the keyboard.
_ESCAPE = 0xFF1B  # Key symbol.
_SPECIAL_KEYS = range(0xFE00, 0x10000)  # Key symbols of keys that enter no character.
_CORE_KEYBOARD = 0x100
_STATE_SIZE = 64  # Bytes, more than the C structure XkbStateRec has.
_GROUP_INDEX, _MODIFIERS_INDEX = 0, 6  # Members of XkbStateRec, by their byte.
_SHORTCUT_MODIFIERS = 0x4C  # Ctrl, Alt and the logo key.


class RawKey(NamedTuple):
    """A pressed key. ``key_code`` is its X key code, and ``time_ms`` is the X server's time in ms."""

    key_code: int
    time_ms: int


class RawKeyReader(RawEventConnection):
    """Connection to the X server of ``DISPLAY`` that receives raw key events. Use it only on one thread.

    The constructor raises OSError without libX11, libXi, an X server or the XInput extension.
    """

    def __init__(self) -> None:
        super().__init__((RawEventKind.KEY_PRESS,), minor_version=0)
        self._x.XkbKeycodeToKeysym.restype = ctypes.c_ulong

    def read_key_presses(self) -> Iterator[RawKey]:
        """Yield the key presses that have arrived, without waiting."""
        for event in self.read_events():
            yield RawKey(event.detail, event.time_ms)

    def find_escape_code(self) -> int:
        """Return the key code of Esc in the current keyboard layout, or 0 if the layout has no Esc key."""
        return int(self._x.XKeysymToKeycode(self._display, ctypes.c_ulong(_ESCAPE)))

    def find_character(self, key_code: int) -> str:
        """Return the capital letter of a key in the current keyboard layout, or a space for the space bar.

        In a layout without Latin letters, return the letter at the same position of a PC keyboard. Return an
        empty string for any other key, and while Ctrl, Alt or the logo key is down, because a window manager
        may use the key.
        """
        state = (ctypes.c_ubyte * _STATE_SIZE)()
        if self._x.XkbGetState(self._display, _CORE_KEYBOARD, state):
            return ""
        if state[_MODIFIERS_INDEX] & _SHORTCUT_MODIFIERS:
            return ""
        symbol = int(self._x.XkbKeycodeToKeysym(self._display, key_code, int(state[_GROUP_INDEX]), 0))
        if symbol < 0x80:
            character = chr(symbol).upper()
            return character if character == " " or "A" <= character <= "Z" else ""
        return "" if symbol in _SPECIAL_KEYS else LETTERS_BY_CODE.get(key_code, "")

    def find_focus_window(self) -> int:
        """Return the X window ID of the window that has the keyboard focus.

        Without a window manager, keys may go to the window under the pointer.
        """
        window, revert = ctypes.c_ulong(), ctypes.c_int()
        self._x.XGetInputFocus(self._display, ctypes.byref(window), ctypes.byref(revert))
        return self._under_pointer() if window.value == _POINTER_ROOT else window.value

    def _under_pointer(self) -> int:
        root, child = ctypes.c_ulong(), ctypes.c_ulong()
        places, mask = [ctypes.c_int() for _ in range(4)], ctypes.c_uint()
        answers = [ctypes.byref(each) for each in (root, child, *places, mask)]
        self._x.XQueryPointer(self._display, self._root, *answers)
        return child.value
