"""Reader of key presses directly from the X server, even while the focused program hangs.

XInput 2.0 sends raw events to every client that requests them, and the other clients still receive their
events. While another client has grabbed the keyboard, for example a screen lock, a client of version 2.0
receives no raw events.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from typing import NamedTuple

_GENERIC_EVENT = 35
_RAW_PRESS = 13
_POINTER_ROOT = 1  # Focus value: the window under the pointer has the keyboard.
_ALL_MASTERS = 1
_ESCAPE = 0xFF1B  # Key symbol.


class _Cookie(ctypes.Structure):
    _fields_ = (
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("extension", ctypes.c_int),
        ("evtype", ctypes.c_int),
        ("cookie", ctypes.c_uint),
        ("data", ctypes.c_void_p),
    )


class _RawEvent(ctypes.Structure):
    """First members of the C structure XIRawEvent."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("extension", ctypes.c_int),
        ("evtype", ctypes.c_int),
        ("time", ctypes.c_ulong),
        ("deviceid", ctypes.c_int),
        ("sourceid", ctypes.c_int),
        ("detail", ctypes.c_int),
    )


class _Event(ctypes.Union):
    _fields_ = (("cookie", _Cookie), ("pad", ctypes.c_long * 24))


class _Mask(ctypes.Structure):
    _fields_ = (("deviceid", ctypes.c_int), ("length", ctypes.c_int), ("mask", ctypes.c_char_p))


class RawKey(NamedTuple):
    """A pressed key. ``key_code`` is its X key code, and ``time_ms`` is the X server's time in ms."""

    key_code: int
    time_ms: int


class RawKeyReader:
    """Connection to the X server of ``DISPLAY`` that receives raw key events. Use it only on one thread.

    The constructor raises OSError without libX11, libXi, an X server or the XInput extension.
    """

    def __init__(self) -> None:
        self._x, self._xi = ctypes.CDLL("libX11.so.6"), ctypes.CDLL("libXi.so.6")
        self._x.XOpenDisplay.restype = ctypes.c_void_p
        self._x.XDefaultRootWindow.restype = ctypes.c_ulong
        display = self._x.XOpenDisplay(None)
        if not display:
            raise OSError
        self._display = ctypes.c_void_p(display)
        self._root = ctypes.c_ulong(self._x.XDefaultRootWindow(self._display))
        self._opcode = self._extension()
        self._select()

    def fileno(self) -> int:
        """Return the file descriptor, which becomes readable when an event arrives."""
        return int(self._x.XConnectionNumber(self._display))

    def _extension(self) -> int:
        opcode, event, error = ctypes.c_int(), ctypes.c_int(), ctypes.c_int()
        found = [ctypes.byref(each) for each in (opcode, event, error)]
        if not self._x.XQueryExtension(self._display, b"XInputExtension", *found):
            raise OSError
        # From version 2.1 on, raw events also arrive during a grab.
        major, minor = ctypes.c_int(2), ctypes.c_int(0)
        if (
            self._xi.XIQueryVersion(self._display, ctypes.byref(major), ctypes.byref(minor))
            or major.value < 2
        ):
            raise OSError
        return opcode.value

    def _select(self) -> None:
        bits = (1 << _RAW_PRESS).to_bytes(2, "little")
        mask = _Mask(_ALL_MASTERS, len(bits), bits)
        if self._xi.XISelectEvents(self._display, self._root, ctypes.byref(mask), 1):
            raise OSError
        self._x.XSync(self._display, 0)

    def read_key_presses(self) -> Iterator[RawKey]:
        """Yield the key presses that have arrived, without waiting."""
        event = _Event()
        while self._x.XPending(self._display):
            self._x.XNextEvent(self._display, ctypes.byref(event))
            key = self._key(event.cookie)
            if key is not None:
                yield key

    def _key(self, cookie: _Cookie) -> RawKey | None:
        if cookie.type != _GENERIC_EVENT:
            self._x.XRefreshKeyboardMapping(ctypes.byref(cookie))
            return None
        if cookie.extension != self._opcode or not self._x.XGetEventData(self._display, ctypes.byref(cookie)):
            return None
        raw = ctypes.cast(cookie.data, ctypes.POINTER(_RawEvent)).contents
        key = RawKey(raw.detail, raw.time)
        self._x.XFreeEventData(self._display, ctypes.byref(cookie))
        return key

    def find_escape_code(self) -> int:
        """Return the key code of Esc in the current keyboard layout, or 0 if the layout has no Esc key."""
        return int(self._x.XKeysymToKeycode(self._display, ctypes.c_ulong(_ESCAPE)))

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
