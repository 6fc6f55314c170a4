"""State of the keys and mouse buttons in the X server.

Call these functions only from Qt's thread.
"""

from __future__ import annotations

import ctypes

from PySide6.QtGui import QGuiApplication, QNativeInterface

_BUTTONS = 0x1F00  # Five buttons in the pointer's mask.
_KEYS_HELD_KEYS = 32  # Bytes, with one bit per key.


class XServer:
    """The X server on whose display Qt shows the windows.

    Use this class only from Qt's thread.
    """

    def __init__(self, display_address: int) -> None:
        self._x = ctypes.CDLL("libX11.so.6")
        self._display = ctypes.c_void_p(display_address)
        self._x.XDefaultRootWindow.restype = ctypes.c_ulong
        self._root = ctypes.c_ulong(self._x.XDefaultRootWindow(self._display))
        supported = ctypes.c_int(0)
        self._x.XkbSetDetectableAutoRepeat(self._display, 1, ctypes.byref(supported))
        self.reports_repeats = bool(supported.value)

    def read_pressed_keys(self) -> frozenset[int]:
        """Return the key codes of the keys that are down now."""
        bits = (ctypes.c_ubyte * _KEYS_HELD_KEYS)()
        self._x.XQueryKeymap(self._display, bits)
        return frozenset(8 * n + bit for n, byte in enumerate(bits) for bit in range(8) if byte >> bit & 1)

    def is_mouse_button_down(self) -> bool:
        """Return whether a mouse button is down now."""
        windows = [ctypes.c_ulong(), ctypes.c_ulong()]
        places = [ctypes.c_int() for _ in range(4)]
        mask = ctypes.c_uint(0)
        answers = [ctypes.byref(each) for each in (*windows, *places, mask)]
        self._x.XQueryPointer(self._display, self._root, *answers)
        return bool(mask.value & _BUTTONS)


def open_x_server() -> XServer | None:
    """Return the X server that displays the windows, or None if Qt does not use X."""
    if QGuiApplication.platformName() != "xcb":
        return None
    app = QGuiApplication.instance()
    native = app.nativeInterface() if isinstance(app, QGuiApplication) else None
    if not isinstance(native, QNativeInterface.QX11Application) or not native.display():
        return None
    try:
        return XServer(native.display())
    except OSError:
        return None
