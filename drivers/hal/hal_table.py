"""The table [hal] of the machine file: LinuxCNC's HAL file, and the pins that TurnDesk uses.

The HAL file alone defines the hardware at these pins (step and direction, ±10 V with a pid component,
EtherCAT, a parallel port). The pins of inputs, outputs and pots are the values ``at`` of [io.in], [io.out]
and [io.analog].
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import field, fields
from typing import Any

from core.key_declaration import FileUnit, KeyRange, declare_key, make_key_table
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import (
    DriverDeclaration,
    DriverTable,
    FileFinding,
    MachineFileReading,
    TableDescription,
    read_axes_and_spindle,
)

_AXES, _SPINDLE = "hal.axes", "hal.spindle"
_PIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.\-]*")
_MAX_COLUMNS = 20  # Maximum columns of a HAL stream, one of which is the row number.
PRESENT_POSITION_METHODS = frozenset((35, 37))  # Methods of CiA 402 that use the present position as home.
# Axis pins that a homing method of CiA 402 needs, by its number.
REQUIRED_PINS_BY_HOMING_METHOD: Mapping[int, tuple[str, ...]] = {
    1: ("limit_low", "index_enable"),
    2: ("limit_high", "index_enable"),
    17: ("limit_low",),
    18: ("limit_high",),
    3: ("home", "index_enable"),
    5: ("home", "index_enable"),
    19: ("home",),
    21: ("home",),
    33: ("index_enable",),
    34: ("index_enable",),
    **dict.fromkeys(PRESENT_POSITION_METHODS, ()),
}
_OFF_LIMIT = {17: 1.0, 18: -1.0}  # Homing methods with only a limit switch, and the direction off the switch.
_OFF_SWITCH = {
    19: -1.0,
    21: 1.0,
}  # Homing methods with the edge of a home switch, and the direction off the switch.


def _optional_key(*, meaning: str) -> Any:
    """Return the declaration of an optional pin."""
    return declare_key(default="", meaning=meaning)


@make_key_table
class HalAxisPins:
    """The pins of one axis, in mm (X as a radius) or degrees.

    An empty name means that the pin does not exist.
    """

    command: str = declare_key(meaning="Float in: commanded position.")
    feedback: str = declare_key(meaning="Float out: measured position.")
    enable: str = _optional_key(meaning="Bit in: on while power to the axis drive is allowed.")
    fault: str = _optional_key(meaning="Bit out: on while the drive reports a fault.")
    home: str = _optional_key(meaning="Bit out: on while the axis is on its home switch.")
    limit_low: str = _optional_key(
        meaning="Bit out: on at the lower limit switch. The axis stops with an alarm, except during homing."
    )
    limit_high: str = _optional_key(
        meaning="Bit out: on at the upper limit switch. The axis stops with an alarm, except during homing."
    )
    index_enable: str = _optional_key(
        meaning="Bit I/O: index enable of the encoder that supplies `feedback`."
    )


@make_key_table
class HalSpindlePins:
    """The pins of the spindle.

    An empty name means that the pin does not exist.
    """

    speed: str = _optional_key(meaning="Float in: commanded speed in rpm, negative with M04.")
    speed_abs: str = _optional_key(
        meaning="Float in: unsigned commanded speed in rpm; requires `on` or `forward`."
    )
    on: str = _optional_key(meaning="Bit in: on while the spindle is commanded to turn.")
    forward: str = _optional_key(meaning="Bit in: on with M03.")
    reverse: str = _optional_key(meaning="Bit in: on with M04.")
    position: str = _optional_key(
        meaning="Float out: position in revolutions, increasing with M03. Required with `encoder_ppr`."
    )
    velocity: str = _optional_key(meaning="Float out: measured speed in rev/s.")
    at_speed: str = _optional_key(meaning="Bit out: on while the drive reports that the spindle is at speed.")
    fault: str = _optional_key(meaning="Bit out: on while the drive reports a fault.")
    index_enable: str = _optional_key(
        meaning="Bit I/O: index enable of the encoder that supplies `position`. Threading and M19 wait "
        "for this signal."
    )
    position_mode: str = _optional_key(meaning="Bit in: switches the spindle drive to position mode for C.")
    in_position_mode: str = _optional_key(
        meaning="Bit out: on while the drive is in position mode. Default: the drive does not report the "
        "mode."
    )
    orient: str = _optional_key(meaning="Bit in: on while the spindle must hold the commanded angle.")
    orient_angle: str = _optional_key(meaning="Float in: commanded angle in degrees.")
    orient_mode: str = _optional_key(
        meaning="s32 in: orientation direction: 0 shortest path, 1 as with M03, 2 as with M04."
    )
    is_oriented: str = _optional_key(meaning="Bit out: on while the spindle is at the commanded angle.")


@make_key_table
class HalTable:
    """Settings of a machine on LinuxCNC's HAL, with times in seconds.

    ``ahead`` is how many seconds of setpoints are buffered in HAL.
    """

    file: str = declare_key(meaning="HAL file, in the folder of the machine file.")
    thread: str = declare_key(default="servo-thread", meaning="Name of the servo thread in the HAL file.")
    period: float = declare_key(
        KeyRange(0.0002, 0.004, FileUnit.MILLISECONDS),
        name="period_ms",
        default=0.001,
        meaning="Period of the servo thread.",
    )
    ahead: float = declare_key(
        KeyRange(0.01, 0.5, FileUnit.MILLISECONDS),
        name="ahead_ms",
        default=0.1,
        meaning="Time for which HAL buffers setpoints. If the computer is late for longer, the axes stop.",
    )
    watchdog: float = declare_key(
        KeyRange(0.05, 1.0, FileUnit.MILLISECONDS),
        name="watchdog_ms",
        default=0.25,
        meaning="Time without a sign of life from TurnDesk after which HAL removes drive power.",
    )
    machine_on: str = declare_key(default="", meaning="Bit in: on while the drives may have power.")
    charge_pump: str = declare_key(
        default="",
        meaning="Bit in: changes in every period while TurnDesk, the bridge and HAL run; for a charge pump "
        "or watchdog relay.",
    )
    link_fault: str = declare_key(
        default="",
        meaning="Bit out: on while the inputs of the board are not up to date. It opens the E-stop chain. "
        "Required for a board on a cable.",
    )
    axes: Mapping[str, HalAxisPins] = field(default_factory=dict)
    spindle: HalSpindlePins = field(default_factory=HalSpindlePins)


def _read(file: MachineFileReading) -> Iterator[FileFinding]:
    yield from read_axes_and_spindle(file, (_AXES, HalAxisPins), (_SPINDLE, HalSpindlePins))


def _pin_tables(file: MachineFileReading) -> dict[str, object]:
    """Return the nested tables of the axes and the spindle."""
    axes = {
        name: file.file_values.make_model(HalAxisPins, f"{_AXES}.{name}")
        for name in file.list_table_keys(_AXES)
    }
    return {"axes": axes, "spindle": file.file_values.make_model(HalSpindlePins, _SPINDLE)}


def _rules(file: MachineFileReading) -> Iterator[FileFinding]:
    if "hal" not in file.tables:
        return
    yield from _check_names(file)
    if not file.file_values.has_text("machine.backend", "hal"):
        return
    yield from _check_shared_inputs(file)
    yield from _check_link(file)
    yield from _all_axes(file)
    yield from _check_spindle_pins(file)
    yield from _check_orientation(file)
    yield from _check_homing(file)
    columns = 1 + 2 * len(file.list_table_keys(_AXES))
    if columns > _MAX_COLUMNS:
        yield FileFinding(
            _AXES,
            "",
            Message(
                "expected at most {columns} axes, which is the maximum for a HAL stream",
                columns=(_MAX_COLUMNS - 1) // 2,
            ),
        )


def _iterate_pins(file: MachineFileReading) -> Iterator[tuple[str, str]]:
    """Yield every pin that the machine file specifies, with the path of its key."""
    values = file.file_values
    places = ["hal.machine_on", "hal.charge_pump", "hal.link_fault"]
    places += [
        f"{_AXES}.{axis}.{each.name}" for axis in file.list_table_keys(_AXES) for each in fields(HalAxisPins)
    ]
    places += [f"{_SPINDLE}.{each.name}" for each in fields(HalSpindlePins)]
    yield from ((path, values.text(path)) for path in places if values.has_values(path) and values.text(path))
    yield from ((f"{path}.at", terminal) for path, terminal in file.terminals.items())
    for name in file.list_table_keys("io.analog"):
        if values.has_values(f"io.analog.{name}.at"):
            yield f"io.analog.{name}.at", values.text(f"io.analog.{name}.at")


_DRIVEN_PATTERN = re.compile(
    r"hal\.axes\.\w+\.(command|enable)|hal\.(machine_on|charge_pump)|io\.out\..*"
    r"|hal\.spindle\.(speed|speed_abs|on|forward|reverse|position_mode|orient|orient_angle|orient_mode)"
)


def _check_names(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about invalid pin names, and about pins that two sources would drive."""
    driven: dict[str, str] = {}
    for path, pin in _iterate_pins(file):
        ours = path.startswith("hal.") or file.file_values.has_text("machine.backend", "hal")
        if ours and not _PIN.fullmatch(pin):
            yield FileFinding(
                path, format_toml_value(pin), 'expected the name of a HAL pin, for example "pid.x.command"'
            )
        elif ours and _DRIVEN_PATTERN.fullmatch(path.removesuffix(".at")):
            first = driven.setdefault(pin, path)
            if first != path:
                yield FileFinding(
                    path,
                    format_toml_value(pin),
                    Message("expected an unused pin; {first} already drives this pin", first=first),
                )


def _check_shared_inputs(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about inputs of [io.in] that are also pins of an axis or of the spindle.

    With a shared input, homing could start a cycle.
    """
    axes = (
        (path, pin)
        for path, pin in _iterate_pins(file)
        if path.startswith((_AXES, _SPINDLE)) and not _DRIVEN_PATTERN.fullmatch(path)
    )
    used = {pin.removesuffix(_INVERTED): path for path, pin in axes}
    for path, terminal in file.terminals.items():
        other = used.get(terminal.removesuffix(_INVERTED))
        if path.startswith("io.in.") and other:
            expected = Message("expected an unused input; {other} already uses this input", other=other)
            yield FileFinding(f"{path}.at", format_toml_value(terminal), expected)


_INVERTED = "-not"  # Suffix of the pin that shows the same input inverted.
_CABLE_PIN_PATTERN = re.compile(r"(hm2_|lcec\.).*")


def _check_link(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield a finding if hal.link_fault is missing although an input is connected over a cable.

    The value of such an input freezes if the cable is disconnected.
    """
    if not file.file_values.has_values("hal.link_fault") or file.file_values.text("hal.link_fault"):
        return
    read = (
        pin for path, pin in _iterate_pins(file) if not _DRIVEN_PATTERN.fullmatch(path.removesuffix(".at"))
    )
    frozen = next((pin for pin in read if _CABLE_PIN_PATTERN.fullmatch(pin)), "")
    board = any(file.file_values.has_text("board.kind", kind) for kind in _CABLE_BOARDS)
    if frozen or board:
        why = Message(
            "the last value from {frozen} is retained while the board's cable is disconnected",
            frozen=frozen or "this board",
        )
        yield FileFinding(
            "hal.link_fault",
            "",
            Message('missing; {why}; expected "link-fault" or the pin that reports a link fault', why=why),
        )


_CABLE_BOARDS = ("mesa-7i76e", "mesa-7i97", "ethercat")


def _all_axes(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    for axis in file.axes:
        on = axis != "C" or (values.has_values("axis.C.enabled") and values.read_flag("axis.C.enabled"))
        there = axis in file.list_table_keys(_AXES) or f"{_AXES}.{axis}" in values.invalid_paths
        if on and axis == "C" and there:
            yield from _check_spindle_as_c(file)
        if on and not there and not isinstance(file.raw(_AXES), str):
            yield FileFinding(
                f"{_AXES}.{axis}",
                "",
                Message("missing; axis {axis} needs {{ command, feedback }}", axis=axis),
            )


def _check_spindle_as_c(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about missing pins for C on the spindle drive."""
    values = file.file_values
    own = values.has_values("axis.C.own_drive") and values.read_flag("axis.C.own_drive")
    if (
        own
        or not values.has_text("spindle.driver", "hal")
        or not values.has_values(f"{_SPINDLE}.position_mode")
    ):
        return
    why = {
        "position_mode": "C uses the spindle drive, which must be switched to position mode",
        "position": "C uses the spindle, so the spindle position must be reported",
    }
    for key, words in why.items():
        if not values.text(f"{_SPINDLE}.{key}"):
            own_drive = "; otherwise set own_drive = true in [axis.C]"
            yield FileFinding(f"{_SPINDLE}.{key}", "", f"missing; {words}{own_drive}")


def _check_spindle_pins(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about missing command or feedback pins of a spindle that HAL drives."""
    values = file.file_values
    paths = {each.name: f"{_SPINDLE}.{each.name}" for each in fields(HalSpindlePins)}
    if not values.has_values(*paths.values()):
        return
    said = {key: values.text(path) for key, path in paths.items()}
    if values.has_text("spindle.driver", "hal") and not (said["speed"] or said["speed_abs"] or said["on"]):
        yield FileFinding(
            f"{_SPINDLE}.speed", "", "missing; expected speed, speed_abs or on to turn the spindle"
        )
    if said["speed_abs"] and not (said["forward"] or said["on"]):
        yield FileFinding(f"{_SPINDLE}.forward", "", "missing; an unsigned speed also requires a direction")
    feedback_pin = said["position"] or said["velocity"] or said["at_speed"]
    if values.has_text("spindle.driver", "hal") and not feedback_pin:
        yield FileFinding(
            f"{_SPINDLE}.velocity", "", "missing; expected position, velocity or at_speed as spindle feedback"
        )
    if (
        values.has_values("spindle.encoder_ppr")
        and values.read_number("spindle.encoder_ppr")
        and not said["position"]
    ):
        yield FileFinding(
            f"{_SPINDLE}.position",
            "",
            "missing; spindle.encoder_ppr specifies an encoder, so the spindle position is required",
        )


def _check_orientation(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about missing pins of a spindle that HAL orients."""
    values = file.file_values
    if not values.has_values("spindle.oriented") or not values.read_flag("spindle.oriented"):
        return
    if not values.has_text("spindle.driver", "hal"):
        return
    for key in ("orient", "orient_angle", "orient_mode", "is_oriented"):
        path = f"{_SPINDLE}.{key}"
        if values.has_values(path) and not values.text(path):
            yield FileFinding(
                path,
                "",
                "missing; this pin is required because spindle.oriented specifies that HAL "
                "orients the spindle",
            )


def _check_homing(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about the homing method, offset and pins of each axis."""
    values = file.file_values
    for axis in file.list_table_keys(_AXES):
        path, pins = f"axis.{axis}.home.method", f"{_AXES}.{axis}"
        if not values.has_values(path):
            continue
        method = values.read_integer(path)
        if method not in REQUIRED_PINS_BY_HOMING_METHOD:
            known = ", ".join(str(each) for each in sorted(REQUIRED_PINS_BY_HOMING_METHOD))
            yield FileFinding(
                path,
                str(method),
                Message("expected a homing method that this backend supports: {known}", known=known),
            )
            continue
        offset = f"axis.{axis}.home.offset"
        if (
            method in _OFF_LIMIT
            and values.has_values(offset)
            and values.read_number(offset) * _OFF_LIMIT[method] <= 0.0
        ):
            expected = (
                "expected a home offset above 0, because at home the axis must be clear of the limit switch"
                if _OFF_LIMIT[method] > 0
                else "expected a home offset below 0, because at home the axis must be clear of the limit "
                "switch"
            )
            yield FileFinding(offset, "", expected)
        other = _axis_with_same_switch(file, axis)
        off = _OFF_SWITCH.get(method, 0.0)
        if other and off and values.has_values(offset) and values.read_number(offset) * off <= 0.0:
            expected = Message(
                "expected a home offset {side} 0, because {other} uses the same switch, so the axis "
                "must be clear of the switch at home",
                side="above" if off > 0 else "below",
                other=other,
            )
            yield FileFinding(offset, "", expected)
        for key in REQUIRED_PINS_BY_HOMING_METHOD[method]:
            if values.has_values(f"{pins}.{key}") and not values.text(f"{pins}.{key}"):
                yield FileFinding(
                    f"{pins}.{key}",
                    "",
                    Message("missing; required by {path} = {method}", path=path, method=method),
                )


def _axis_with_same_switch(file: MachineFileReading, axis: str) -> str:
    """Return the key of another axis whose home switch uses the same input, or an empty string."""
    values = file.file_values
    homes = {each: f"{_AXES}.{each}.home" for each in file.list_table_keys(_AXES)}
    pins = {each: values.text(path) for each, path in homes.items() if values.has_values(path)}
    own = pins.get(axis)
    return next((homes[each] for each, pin in pins.items() if own and each != axis and pin == own), "")


def _read_pin(file: MachineFileReading, text: str) -> object:
    """Return a pin name without surrounding spaces, or None if the backend is not HAL."""
    return text.strip() if file.file_values.has_text("machine.backend", "hal") else None


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "hal",
            HalTable,
            _pin_tables,
            ("axes", "spindle"),
            _read,
            _rules,
            purpose='The connection to LinuxCNC\'s HAL (`backend = "hal"`). "In" and "out" are the '
            "directions of the HAL pin. With [board], a name without a dot is a signal of the "
            "generated HAL file.",
            sub_tables=(
                TableDescription(
                    "hal.axes.…",
                    "HAL pins of one axis; the last word of the heading is the axis name. "
                    "Positions are in mm (X: a radius) or degrees. The homing method decides which "
                    "switches are required.",
                    HalAxisPins,
                ),
                TableDescription("hal.spindle", "HAL pins of the spindle.", HalSpindlePins),
            ),
        ),
    ),
    backend_name="hal",
    spindle="hal",
    can_orient_spindle=True,
    normalize_terminal=_read_pin,
)
