"""Table [pendant] of the machine file, which describes the USB device.

Inputs whose addresses begin with ``pendant.`` are buttons of the device. Keys, buttons, wheels and axes
have their Linux names and numbers (linux/input-event-codes.h). A key without a name in this module is
written with its number, such as ``KEY_0x1d3``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from core.key_declaration import declare_key, make_key_table
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import DriverDeclaration, DriverTable, FileFinding, MachineFileReading

SYN, KEY, REL, ABS = 0x00, 0x01, 0x02, 0x03
SYN_REPORT, SYN_DROPPED = 0, 3
KEYS, RELS, AXES = 0x300, 0x10, 0x40  # number of codes of each kind


class PendantControl(NamedTuple):
    """Control of the pendant: a key, a wheel or one end of an axis.

    ``axis_end`` is -1 or +1 for an axis that is used as two buttons.
    """

    event_kind: int
    event_code: int
    axis_end: int = 0


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
    yield from _row(0x130, "A B", button)  # same codes as SOUTH and EAST
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


def parse_button_name(name: str) -> PendantControl | None:
    """Return the control for a button name, or None if the name is not known.

    Button names are, for example, ``BTN_A``, ``KEY_F13`` and ``ABS_HAT0X-``.
    """
    if name in _KEYS:
        return PendantControl(KEY, _KEYS[name])
    if (found := _BY_NUMBER.fullmatch(name)) and int(found[1], 16) < KEYS:
        return PendantControl(KEY, int(found[1], 16))
    if name[-1:] in {"+", "-"} and name[:-1] in _AXES:
        return PendantControl(ABS, _AXES[name[:-1]], 1 if name[-1] == "+" else -1)
    return None


def parse_wheel_name(name: str) -> PendantControl | None:
    """Return the control for a wheel name such as ``REL_DIAL``, or None if the name is not known.

    ``ABS_WHEEL`` reports positions instead of steps.
    """
    if name in _RELS:
        return PendantControl(REL, _RELS[name])
    return PendantControl(ABS, _AXES[name]) if name in _AXES else None


PENDANT_PREFIX = "pendant."  # prefix of the address of a button or wheel
_PATH, _WHEEL = "pendant", "io.analog.handwheel"
STOP_INPUTS = ("hold", "start_inhibit")  # inputs that must not count as present when the device is gone
_MAY = re.compile(r"hold|start_inhibit|wheel_\w+|jog_rapid|jog_[xyzabc]_(plus|minus)")
_STARTS = re.compile(r"(cycle_?)?start.*|.*palms?.*|spindle_auto", re.IGNORECASE)
CANNOT_START_MESSAGE = (
    "a pendant cannot start anything: Cycle Start must come from the output of a "
    "two-hand relay, wired to a terminal; remove this line"
)


@make_key_table
class PendantModel:
    """Settings of the pendant.

    ``device`` is the name of the device or its hexadecimal ``vendor:product``. ``serial`` distinguishes
    identical devices. ``counts`` specifies whether the wheel reports steps (REL) or, as a Shuttle does, a
    position from 0 to 255.
    """

    device: str = declare_key(
        meaning="Name of the USB device or its `vendor:product` in hexadecimal, as "
        "`/proc/bus/input/devices` shows them."
    )
    serial: str = declare_key(
        default="", meaning="Serial number, to distinguish two identical devices. Default: any."
    )
    counts: str = declare_key(
        default="steps",
        choices=("steps", "place"),
        meaning='"steps": the handwheel reports detents; "place": the handwheel reports its position, 0 to '
        "255, as a Contour Shuttle does.",
    )


def _rules(file: MachineFileReading) -> Iterator[FileFinding]:
    buttons = _pendant_inputs(file)
    for path, terminal in buttons.items():
        if why := _wrong_button(path, terminal):
            yield FileFinding(f"{path}.at", format_toml_value(terminal), why)
    yield from _find_double_use(buttons)
    yield from _analog(file)
    used = [*buttons, *([_WHEEL] if _wheel(file) else ())]
    if used and _PATH not in file.tables:
        yield FileFinding(
            f"[{_PATH}]",
            "",
            Message(
                "this section is missing, but {used} uses the pendant. Set device to the name of the pendant",
                used=used[0],
            ),
        )
    if not used and _PATH in file.tables:
        expected = 'nothing is at it; expected an input such as hold = { at = "pendant.BTN_B" }'
        yield FileFinding(f"[{_PATH}]", "", expected)


def _pendant_inputs(file: MachineFileReading) -> Mapping[str, str]:
    """Return the addresses of the pendant inputs, keyed by the input's path in the machine file."""
    return {path: at for path, at in file.separate_device_inputs.items() if at.startswith(PENDANT_PREFIX)}


def _wrong_button(path: str, terminal: str) -> str:
    name = path.rpartition(".")[2]
    if path.startswith("io.out."):
        return "a pendant cannot switch an output; expected a terminal of the machine"
    if _STARTS.fullmatch(name) and name != "start_inhibit":
        return CANNOT_START_MESSAGE
    if not _MAY.fullmatch(name):
        return Message(
            "{name} cannot be assigned to a pendant, because USB is not suitable for this "
            "signal. Expected hold, start_inhibit, wheel_…, jog_rapid, jog_x_plus or a similar "
            "jog input",
            name=name,
        )
    if parse_button_name(terminal.removeprefix(PENDANT_PREFIX)) is None:
        return (
            "expected the Linux name of a button, for example pendant.BTN_A, pendant.KEY_F13 or "
            "pendant.ABS_HAT0X+"
        )
    return ""


def _find_double_use(buttons: Mapping[str, str]) -> Iterator[FileFinding]:
    """Yield a finding for each button to which more than one function is assigned."""
    taken: dict[object, str] = {}
    for path, terminal in buttons.items():
        code = parse_button_name(terminal.removeprefix(PENDANT_PREFIX))
        first = taken.setdefault(code, path)
        if code is not None and first != path:
            expected = Message("expected an unused button; {first} already uses this button", first=first)
            yield FileFinding(f"{path}.at", format_toml_value(terminal), expected)


def _wheel(file: MachineFileReading) -> str:
    """Return the address of the handwheel, or an empty string if it is not on the pendant."""
    path = f"{_WHEEL}.at"
    at = file.file_values.text(path) if file.file_values.has_values(path) else ""
    return at if at.startswith(PENDANT_PREFIX) else ""


def _analog(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    for name in file.list_table_keys("io.analog"):
        path = f"io.analog.{name}.at"
        if name != "handwheel" and values.has_values(path) and values.text(path).startswith(PENDANT_PREFIX):
            expected = "expected a terminal; the handwheel is the only analog input that can be on a pendant"
            yield FileFinding(path, format_toml_value(values.text(path)), expected)
    if (at := _wheel(file)) and parse_wheel_name(at.removeprefix(PENDANT_PREFIX)) is None:
        expected = "expected the Linux name of a handwheel, for example pendant.REL_DIAL or pendant.ABS_WHEEL"
        yield FileFinding(f"{_WHEEL}.at", format_toml_value(at), expected)


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            _PATH,
            PendantModel,
            check_rules=_rules,
            purpose="A pendant, gamepad or jog dial on USB. Its buttons are inputs of [io.in] at "
            "`pendant.…`; no button can start a cycle or switch an output.",
        ),
    ),
    address_prefix=PENDANT_PREFIX,
)
