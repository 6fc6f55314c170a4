"""Reader of mouse presses and touches directly from the X server, even while the focused program hangs.

The reader uses XInput 2.2, so that it also receives presses while a menu or another program has grabbed the
pointer.
"""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Iterator
from typing import NamedTuple

from app.desk.stop_keys.raw_events import RawEvent, RawEventConnection, RawEventKind
from app.desk.stop_keys.stop_records import TOUCH_CODE, make_button_code

_WHEEL_BUTTONS = frozenset({4, 5, 6, 7})
_MAX_DEPTH = 32  # Number of nested windows.


def _ignore_error(_display: int, _event: int) -> int:
    """Ignore an error of Xlib, which otherwise ends the process. A window may close during a query."""
    return 0


# Xlib calls the handler later, so that it must not be deleted.
_ERROR_HANDLER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)(_ignore_error)


class PointerPress(NamedTuple):
    """A pressed mouse button or the begin of a touch.

    ``press_code`` is the code for press numbers, and ``time_ms`` is the X server's time in ms. ``x_px`` and
    ``y_px`` are the position on the X screen.
    """

    press_code: int
    time_ms: int
    x_px: int
    y_px: int


class RawPointerReader(RawEventConnection):
    """Connection to the X server of ``DISPLAY`` that receives mouse presses and touches.

    Use it only on one thread. The constructor raises OSError without libX11, libXi, an X server or XInput
    2.2.
    """

    def __init__(self) -> None:
        super().__init__((RawEventKind.BUTTON_PRESS, RawEventKind.TOUCH_BEGIN), minor_version=2)
        self._x.XSetErrorHandler(_ERROR_HANDLER)

    def read_presses(self) -> Iterator[PointerPress]:
        """Yield all presses that the X server has received. Turns of the mouse wheel are no presses."""
        self._x.XSync(self._display, 0)
        for event in self.read_events():
            if event.kind is RawEventKind.TOUCH_BEGIN:
                yield PointerPress(TOUCH_CODE, event.time_ms, *self._find_touch_position(event))
            elif event.detail not in _WHEEL_BUTTONS:
                yield PointerPress(make_button_code(event.detail), event.time_ms, *self._find_pointer())

    def _find_touch_position(self, event: RawEvent) -> tuple[int, int]:
        if event.position is None:
            return self._find_pointer()
        root, sizes = ctypes.c_ulong(), [ctypes.c_uint() for _ in range(6)]
        answers = [ctypes.byref(each) for each in (root, *sizes)]
        self._x.XGetGeometry(self._display, self._root, *answers)
        x, y = event.position
        return int(x * (sizes[2].value - 1) + 0.5), int(y * (sizes[3].value - 1) + 0.5)

    def _find_pointer(self) -> tuple[int, int]:
        """Return the position of the pointer on the X screen in pixels."""
        root, child = ctypes.c_ulong(), ctypes.c_ulong()
        places, mask = [ctypes.c_int() for _ in range(4)], ctypes.c_uint()
        answers = [ctypes.byref(each) for each in (root, child, *places, mask)]
        self._x.XQueryPointer(self._display, self._root, *answers)
        return places[0].value, places[1].value

    def find_window_at(
        self, x_px: int, y_px: int, window_ids: Collection[int]
    ) -> tuple[int, int, int] | None:
        """Return which of these windows is visible at a position of the X screen.

        The result is the window ID and the position in this window in pixels, or None if another window or
        no window is visible there.
        """
        window = self._root
        x, y, child = ctypes.c_int(), ctypes.c_int(), ctypes.c_ulong()
        answers = [ctypes.byref(each) for each in (x, y, child)]
        for _ in range(_MAX_DEPTH):
            found = self._x.XTranslateCoordinates(self._display, self._root, window, x_px, y_px, *answers)
            if not found:
                return None
            if window.value in window_ids:
                return window.value, x.value, y.value
            if not child.value:
                return None
            window = ctypes.c_ulong(child.value)
        return None
