"""Names of keys, buttons, wheels and axes as Linux has them (evdev), and their numbers.

The names and numbers are the kernel's (linux/input-event-codes.h). A key that has no name here is written by
its number: ``KEY_0x1d3``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

SYN, KEY, REL, ABS = 0x00, 0x01, 0x02, 0x03
SYN_REPORT, SYN_DROPPED = 0, 3
KEYS, RELS, AXES = 0x300, 0x10, 0x40  # so many there are of each


class Control(NamedTuple):
    """A key, a wheel, or one end of an axis. ``end``: -1 or +1 of an axis that is used as two buttons."""

    kind: int
    code: int
    end: int = 0


def _row(first: int, names: str, prefix: str) -> Iterator[tuple[str, int]]:
    return ((prefix + name, first + i) for i, name in enumerate(names.split()))


def _keys() -> Iterator[tuple[str, int]]:
    key = "KEY_"
    yield from _row(1, "ESC 1 2 3 4 5 6 7 8 9 0 MINUS EQUAL BACKSPACE TAB", key)
    yield from _row(16, "Q W E R T Y U I O P LEFTBRACE RIGHTBRACE ENTER LEFTCTRL", key)
    yield from _row(30, "A S D F G H J K L SEMICOLON APOSTROPHE GRAVE LEFTSHIFT BACKSLASH", key)
    yield from _row(44, "Z X C V B N M COMMA DOT SLASH RIGHTSHIFT KPASTERISK LEFTALT SPACE CAPSLOCK", key)
    yield from _row(59, "F1 F2 F3 F4 F5 F6 F7 F8 F9 F10 NUMLOCK SCROLLLOCK", key)
    yield from _row(71, "KP7 KP8 KP9 KPMINUS KP4 KP5 KP6 KPPLUS KP1 KP2 KP3 KP0 KPDOT", key)
    yield from _row(87, "F11 F12", key)
    yield from _row(96, "KPENTER RIGHTCTRL KPSLASH SYSRQ RIGHTALT LINEFEED HOME UP PAGEUP LEFT RIGHT", key)
    yield from _row(107, "END DOWN PAGEDOWN INSERT DELETE MACRO MUTE VOLUMEDOWN VOLUMEUP POWER KPEQUAL", key)
    yield from _row(119, "PAUSE", key)
    yield from _row(163, "NEXTSONG PLAYPAUSE PREVIOUSSONG STOPCD", key)
    yield from _row(183, "F13 F14 F15 F16 F17 F18 F19 F20 F21 F22 F23 F24", key)


def _buttons() -> Iterator[tuple[str, int]]:
    button = "BTN_"
    yield from _row(0x100, "0 1 2 3 4 5 6 7 8 9", button)
    yield from _row(0x110, "LEFT RIGHT MIDDLE SIDE EXTRA FORWARD BACK TASK", button)
    yield from _row(0x120, "TRIGGER THUMB THUMB2 TOP TOP2 PINKIE BASE BASE2 BASE3 BASE4 BASE5 BASE6", button)
    yield from _row(0x130, "SOUTH EAST C NORTH WEST Z TL TR TL2 TR2 SELECT START MODE THUMBL THUMBR", button)
    yield from _row(0x130, "A B", button)  # the same as SOUTH and EAST
    yield from _row(0x133, "X Y", button)
    yield from _row(0x150, "GEAR_DOWN GEAR_UP", button)
    yield from _row(0x220, "DPAD_UP DPAD_DOWN DPAD_LEFT DPAD_RIGHT", button)
    yield from ((f"BTN_TRIGGER_HAPPY{i}", 0x2BF + i) for i in range(1, 41))


_RELS = dict(_row(0, "X Y Z RX RY RZ HWHEEL DIAL WHEEL MISC", "REL_"))
_AXES = dict(
    (
        *_row(0, "X Y Z RX RY RZ THROTTLE RUDDER WHEEL GAS BRAKE", "ABS_"),
        *_row(0x10, "HAT0X HAT0Y HAT1X HAT1Y HAT2X HAT2Y HAT3X HAT3Y", "ABS_"),
        *_row(0x28, "MISC", "ABS_"),
    )
)
_KEYS: Mapping[str, int] = dict((*_keys(), *_buttons()))
_BY_NUMBER = re.compile(r"KEY_0x([0-9a-fA-F]{1,3})")


def button_of(name: str) -> Control | None:
    """The button of a name: ``BTN_A``, ``KEY_F13``, or one end of an axis, ``ABS_HAT0X-``; None: no such."""
    if name in _KEYS:
        return Control(KEY, _KEYS[name])
    if (found := _BY_NUMBER.fullmatch(name)) and int(found[1], 16) < KEYS:
        return Control(KEY, int(found[1], 16))
    if name[-1:] in {"+", "-"} and name[:-1] in _AXES:
        return Control(ABS, _AXES[name[:-1]], 1 if name[-1] == "+" else -1)
    return None


def wheel_of(name: str) -> Control | None:
    """What counts: ``REL_DIAL``, ``REL_WHEEL``, or ``ABS_WHEEL``, which tells its place; None: no such."""
    if name in _RELS:
        return Control(REL, _RELS[name])
    return Control(ABS, _AXES[name]) if name in _AXES else None
