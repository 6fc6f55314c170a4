"""Connection to the X server that receives raw input events, even while the focused program hangs.

XInput 2 sends raw events to every client that requests them, and the other clients still receive their
events.
"""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Iterator
from enum import IntEnum
from typing import NamedTuple

_GENERIC_EVENT = 35
_ALL_MASTERS = 1
_VALUATOR_CLASS = 2


class RawEventKind(IntEnum):
    """Kind of raw event, by its number in XInput 2."""

    KEY_PRESS = 13
    BUTTON_PRESS = 15
    TOUCH_BEGIN = 22  # From version 2.2 on.


class RawEvent(NamedTuple):
    """A pressed key or button, or the begin of a touch.

    ``detail`` is the X key code, the number of the button, or the number of the touch. ``time_ms`` is the X
    server's time in ms. ``position`` is the place of a touch, as fractions of the width and height of the
    whole X screen.
    """

    kind: RawEventKind
    detail: int
    time_ms: int
    position: tuple[float, float] | None = None


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
    """The C structure XIRawEvent."""

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
        ("flags", ctypes.c_int),
        ("mask_len", ctypes.c_int),
        ("mask", ctypes.POINTER(ctypes.c_ubyte)),
        ("values", ctypes.POINTER(ctypes.c_double)),
        ("raw_values", ctypes.POINTER(ctypes.c_double)),
    )


class _Event(ctypes.Union):
    _fields_ = (("cookie", _Cookie), ("pad", ctypes.c_long * 24))


class _Mask(ctypes.Structure):
    _fields_ = (("deviceid", ctypes.c_int), ("length", ctypes.c_int), ("mask", ctypes.c_char_p))


class _Valuator(ctypes.Structure):
    """First members of the C structure XIValuatorClassInfo."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("sourceid", ctypes.c_int),
        ("number", ctypes.c_int),
        ("label", ctypes.c_ulong),
        ("min", ctypes.c_double),
        ("max", ctypes.c_double),
    )


class _Device(ctypes.Structure):
    """The C structure XIDeviceInfo."""

    _fields_ = (
        ("deviceid", ctypes.c_int),
        ("name", ctypes.c_char_p),
        ("use", ctypes.c_int),
        ("attachment", ctypes.c_int),
        ("enabled", ctypes.c_int),
        ("num_classes", ctypes.c_int),
        ("classes", ctypes.POINTER(ctypes.POINTER(_Valuator))),
    )


class RawEventConnection:
    """Connection to the X server of ``DISPLAY`` that receives raw events. Use it only on one thread.

    ``minor_version`` is n of the requested version 2.n of XInput. While another client has grabbed the
    device, a client of version 2.0 receives no raw events of it, and a client of version 2.1 does. The
    constructor raises OSError without libX11, libXi, an X server or the version.
    """

    def __init__(self, event_kinds: Collection[RawEventKind], minor_version: int) -> None:
        self._x, self._xi = ctypes.CDLL("libX11.so.6"), ctypes.CDLL("libXi.so.6")
        self._x.XOpenDisplay.restype = ctypes.c_void_p
        self._x.XDefaultRootWindow.restype = ctypes.c_ulong
        self._xi.XIQueryDevice.restype = ctypes.POINTER(_Device)
        display = self._x.XOpenDisplay(None)
        if not display:
            raise OSError
        self._display = ctypes.c_void_p(display)
        self._root = ctypes.c_ulong(self._x.XDefaultRootWindow(self._display))
        self._opcode = self._find_extension(minor_version)
        self._select_events(event_kinds)

    def fileno(self) -> int:
        """Return the file descriptor, which becomes readable when an event arrives."""
        return int(self._x.XConnectionNumber(self._display))

    def _find_extension(self, minor_version: int) -> int:
        opcode, event, error = ctypes.c_int(), ctypes.c_int(), ctypes.c_int()
        found = [ctypes.byref(each) for each in (opcode, event, error)]
        if not self._x.XQueryExtension(self._display, b"XInputExtension", *found):
            raise OSError
        major, minor = ctypes.c_int(2), ctypes.c_int(minor_version)
        if self._xi.XIQueryVersion(self._display, ctypes.byref(major), ctypes.byref(minor)):
            raise OSError
        if (major.value, minor.value) < (2, minor_version):
            raise OSError
        return opcode.value

    def _select_events(self, event_kinds: Collection[RawEventKind]) -> None:
        bits = sum(1 << kind for kind in event_kinds).to_bytes(4, "little")
        mask = _Mask(_ALL_MASTERS, len(bits), bits)
        if self._xi.XISelectEvents(self._display, self._root, ctypes.byref(mask), 1):
            raise OSError
        self._x.XSync(self._display, 0)

    def read_events(self) -> Iterator[RawEvent]:
        """Yield the raw events that have arrived, without waiting."""
        event = _Event()
        while self._x.XPending(self._display):
            self._x.XNextEvent(self._display, ctypes.byref(event))
            found = self._read_event(event.cookie)
            if found is not None:
                yield found

    def _read_event(self, cookie: _Cookie) -> RawEvent | None:
        if cookie.type != _GENERIC_EVENT:
            self._x.XRefreshKeyboardMapping(ctypes.byref(cookie))
            return None
        if cookie.extension != self._opcode or not self._x.XGetEventData(self._display, ctypes.byref(cookie)):
            return None
        raw = ctypes.cast(cookie.data, ctypes.POINTER(_RawEvent)).contents
        kind = RawEventKind(raw.evtype)
        position = self._find_position(raw) if kind is RawEventKind.TOUCH_BEGIN else None
        found = RawEvent(kind, raw.detail, raw.time, position)
        self._x.XFreeEventData(self._display, ctypes.byref(cookie))
        return found

    def _find_position(self, raw: _RawEvent) -> tuple[float, float] | None:
        """Return the position of a touch from its first two axes, which are X and Y."""
        if raw.mask_len < 1 or raw.mask[0] & 3 != 3:
            return None
        ranges = self._read_axis_ranges(raw.sourceid)
        if not {0, 1} <= ranges.keys():
            return None
        x, y = ((raw.values[n] - ranges[n][0]) / (ranges[n][1] - ranges[n][0]) for n in (0, 1))
        return x, y

    def _read_axis_ranges(self, device_id: int) -> dict[int, tuple[float, float]]:
        """Return the least and the greatest value of each axis of a device, by the number of the axis."""
        count = ctypes.c_int()
        devices = self._xi.XIQueryDevice(self._display, device_id, ctypes.byref(count))
        if not devices:
            return {}
        found = {}
        for device in devices[: count.value]:
            for each in device.classes[: device.num_classes]:
                axis = each.contents
                if axis.type == _VALUATOR_CLASS and axis.max > axis.min:
                    found[axis.number] = axis.min, axis.max
        self._xi.XIFreeDeviceInfo(devices)
        return found
