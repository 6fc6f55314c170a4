"""Table [hal] of the machine file: LinuxCNC's HAL file, and the pins that TurnDesk uses.

The HAL file alone defines the hardware at these pins (step and direction, ±10 V with a pid, EtherCAT, a
parallel port). The pins of inputs, outputs and pots are the values ``at`` of [io.in], [io.out] and
[io.analog].
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import field, fields
from typing import Any

from core.key_declaration import Range, Unit, file_key, key_table
from core.message import Message
from core.table_schema import (
    Driver,
    DriverTable,
    FileReading,
    Finding,
    TableReference,
    read_axes_and_spindle,
    written,
)

_AXES, _SPINDLE = "hal.axes", "hal.spindle"
_PIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.\-]*")
_COLUMNS = 20  # Maximum columns of a HAL stream, one of which is the row number.
HERE = frozenset((35, 37))  # Methods of CiA 402 that use the present position as home.
# Axis pins that a homing method of CiA 402 needs, by its number.
NEEDS: Mapping[int, tuple[str, ...]] = {
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
    **dict.fromkeys(HERE, ()),
}
_OFF_LIMIT = {17: 1.0, 18: -1.0}  # Homing methods with only a limit switch, and the direction off the switch.
_OFF_SWITCH = {
    19: -1.0,
    21: 1.0,
}  # Homing methods with the edge of a home switch, and the direction off the switch.


def _optional(*, meaning: str) -> Any:
    """Declare an optional pin."""
    return file_key(default="", meaning=meaning)


@key_table
class HalAxisPins:
    """Pins of one axis, in mm (X as a radius) or degrees; an empty name means that the pin does not exist."""

    command: str = file_key(meaning="Float in: commanded position.")
    feedback: str = file_key(meaning="Float out: measured position.")
    enable: str = _optional(meaning="Bit in: on while power to the axis drive is allowed.")
    fault: str = _optional(meaning="Bit out: on while the drive reports a fault.")
    home: str = _optional(meaning="Bit out: on while the axis is on its home switch.")
    limit_low: str = _optional(
        meaning="Bit out: on at the lower limit switch. The axis stops with an alarm, except during homing."
    )
    limit_high: str = _optional(
        meaning="Bit out: on at the upper limit switch. The axis stops with an alarm, except during homing."
    )
    index_enable: str = _optional(meaning="Bit I/O: index enable of the encoder that supplies `feedback`.")


@key_table
class HalSpindlePins:
    """Pins of the spindle; an empty name means that the pin does not exist."""

    speed: str = _optional(meaning="Float in: commanded speed in rpm, negative with M04.")
    speed_abs: str = _optional(
        meaning="Float in: unsigned commanded speed in rpm; requires `on` or `forward`."
    )
    on: str = _optional(meaning="Bit in: on while the spindle is commanded to turn.")
    forward: str = _optional(meaning="Bit in: on with M03.")
    reverse: str = _optional(meaning="Bit in: on with M04.")
    position: str = _optional(
        meaning="Float out: position in revolutions, increasing with M03. Required with `encoder_ppr`."
    )
    velocity: str = _optional(meaning="Float out: measured speed in rev/s.")
    at_speed: str = _optional(meaning="Bit out: on while the drive reports that the spindle is at speed.")
    fault: str = _optional(meaning="Bit out: on while the drive reports a fault.")
    index_enable: str = _optional(
        meaning="Bit I/O: index enable of the encoder that supplies `position`. Threading and M19 wait "
        "for this signal."
    )
    position_mode: str = _optional(meaning="Bit in: switches the spindle drive to position mode for C.")
    in_position_mode: str = _optional(
        meaning="Bit out: on while the drive is in position mode. Default: the drive does not report the "
        "mode."
    )
    orient: str = _optional(meaning="Bit in: on while the spindle must hold the commanded angle.")
    orient_angle: str = _optional(meaning="Float in: commanded angle in degrees.")
    orient_mode: str = _optional(
        meaning="s32 in: orientation direction: 0 shortest path, 1 as with M03, 2 as with M04."
    )
    is_oriented: str = _optional(meaning="Bit out: on while the spindle is at the commanded angle.")


@key_table
class HalTable:
    """Settings of a machine on LinuxCNC's HAL; times are in seconds.

    ``ahead`` is the duration of the setpoints that HAL buffers.
    """

    file: str = file_key(meaning="HAL file, in the folder of the machine file.")
    thread: str = file_key(default="servo-thread", meaning="Name of the servo thread in the HAL file.")
    period: float = file_key(
        Range(0.0002, 0.004, Unit.MILLISECONDS),
        name="period_ms",
        default=0.001,
        meaning="Period of the servo thread.",
    )
    ahead: float = file_key(
        Range(0.01, 0.5, Unit.MILLISECONDS),
        name="ahead_ms",
        default=0.1,
        meaning="Time for which HAL buffers setpoints. If the computer is late for longer, the axes stop.",
    )
    watchdog: float = file_key(
        Range(0.05, 1.0, Unit.MILLISECONDS),
        name="watchdog_ms",
        default=0.25,
        meaning="Time without a sign of life from TurnDesk after which HAL removes drive power.",
    )
    machine_on: str = file_key(default="", meaning="Bit in: on while the drives may have power.")
    charge_pump: str = file_key(
        default="",
        meaning="Bit in: changes in every period while TurnDesk, the bridge and HAL run; for a charge pump "
        "or watchdog relay.",
    )
    link_fault: str = file_key(
        default="",
        meaning="Bit out: on while the inputs of the board are not up to date. It opens the E-stop chain. "
        "Required for a board on a cable.",
    )
    axes: Mapping[str, HalAxisPins] = field(default_factory=dict)
    spindle: HalSpindlePins = field(default_factory=HalSpindlePins)


def _read(file: FileReading) -> Iterator[Finding]:
    yield from read_axes_and_spindle(file, (_AXES, HalAxisPins), (_SPINDLE, HalSpindlePins))


def _pin_tables(file: FileReading) -> dict[str, object]:
    """Return the nested tables of the axes and the spindle."""
    axes = {name: file.values.model(HalAxisPins, f"{_AXES}.{name}") for name in file.names(_AXES)}
    return {"axes": axes, "spindle": file.values.model(HalSpindlePins, _SPINDLE)}


def _rules(file: FileReading) -> Iterator[Finding]:
    if "hal" not in file.tables:
        return
    yield from _names(file)
    if not file.values.says("machine.backend", "hal"):
        return
    yield from _shared_inputs(file)
    yield from _link(file)
    yield from _all_axes(file)
    yield from _turns(file)
    yield from _orients(file)
    yield from _homes(file)
    columns = 1 + 2 * len(file.names(_AXES))
    if columns > _COLUMNS:
        yield Finding(
            _AXES,
            "",
            Message(
                "expected at most {columns} axes, which is the maximum for a HAL stream",
                columns=(_COLUMNS - 1) // 2,
            ),
        )


def _pins(file: FileReading) -> Iterator[tuple[str, str]]:
    """Yield every pin that the file names, with its path."""
    values = file.values
    places = ["hal.machine_on", "hal.charge_pump", "hal.link_fault"]
    places += [f"{_AXES}.{axis}.{each.name}" for axis in file.names(_AXES) for each in fields(HalAxisPins)]
    places += [f"{_SPINDLE}.{each.name}" for each in fields(HalSpindlePins)]
    yield from ((path, values.text(path)) for path in places if values.has(path) and values.text(path))
    yield from ((f"{path}.at", terminal) for path, terminal in file.terminals.items())
    for name in file.names("io.analog"):
        if values.has(f"io.analog.{name}.at"):
            yield f"io.analog.{name}.at", values.text(f"io.analog.{name}.at")


_DRIVEN = re.compile(
    r"hal\.axes\.\w+\.(command|enable)|hal\.(machine_on|charge_pump)|io\.out\..*"
    r"|hal\.spindle\.(speed|speed_abs|on|forward|reverse|position_mode|orient|orient_angle|orient_mode)"
)


def _names(file: FileReading) -> Iterator[Finding]:
    """Yield findings about invalid pin names and pins with two sources."""
    driven: dict[str, str] = {}
    for path, pin in _pins(file):
        ours = path.startswith("hal.") or file.values.says("machine.backend", "hal")
        if ours and not _PIN.fullmatch(pin):
            yield Finding(path, written(pin), 'expected the name of a HAL pin, for example "pid.x.command"')
        elif ours and _DRIVEN.fullmatch(path.removesuffix(".at")):
            first = driven.setdefault(pin, path)
            if first != path:
                yield Finding(
                    path,
                    written(pin),
                    Message("expected an unused pin; {first} already drives this pin", first=first),
                )


def _shared_inputs(file: FileReading) -> Iterator[Finding]:
    """Reject an input of [io.in] that is also a pin of an axis or the spindle: homing could start a cycle."""
    axes = (
        (path, pin)
        for path, pin in _pins(file)
        if path.startswith((_AXES, _SPINDLE)) and not _DRIVEN.fullmatch(path)
    )
    used = {pin.removesuffix(_INVERTED): path for path, pin in axes}
    for path, terminal in file.terminals.items():
        other = used.get(terminal.removesuffix(_INVERTED))
        if path.startswith("io.in.") and other:
            expected = Message("expected an unused input; {other} already uses this input", other=other)
            yield Finding(f"{path}.at", written(terminal), expected)


_INVERTED = "-not"  # Suffix of the pin that shows the same input inverted.
_OVER_A_CABLE = re.compile(r"(hm2_|lcec\.).*")


def _link(file: FileReading) -> Iterator[Finding]:
    """Require hal.link_fault if an input comes over a cable, because its value freezes without the cable."""
    if not file.values.has("hal.link_fault") or file.values.text("hal.link_fault"):
        return
    read = (pin for path, pin in _pins(file) if not _DRIVEN.fullmatch(path.removesuffix(".at")))
    frozen = next((pin for pin in read if _OVER_A_CABLE.fullmatch(pin)), "")
    board = any(file.values.says("board.kind", kind) for kind in _ON_A_CABLE)
    if frozen or board:
        why = Message(
            "the last value from {frozen} is retained while the board's cable is disconnected",
            frozen=frozen or "this board",
        )
        yield Finding(
            "hal.link_fault",
            "",
            Message('missing; {why}; expected "link-fault" or the pin that reports a link fault', why=why),
        )


_ON_A_CABLE = ("mesa-7i76e", "mesa-7i97", "ethercat")


def _all_axes(file: FileReading) -> Iterator[Finding]:
    values = file.values
    for axis in file.axes:
        on = axis != "C" or (values.has("axis.C.enabled") and values.flag("axis.C.enabled"))
        there = axis in file.names(_AXES) or f"{_AXES}.{axis}" in values.wrong
        if on and axis == "C" and there:
            yield from _spindle_as_c(file)
        if on and not there and not isinstance(file.raw(_AXES), str):
            yield Finding(
                f"{_AXES}.{axis}",
                "",
                Message("missing; axis {axis} needs {{ command, feedback }}", axis=axis),
            )


def _spindle_as_c(file: FileReading) -> Iterator[Finding]:
    """Yield findings about missing pins for C on the spindle drive."""
    values = file.values
    own = values.has("axis.C.own_drive") and values.flag("axis.C.own_drive")
    if own or not values.says("spindle.driver", "hal") or not values.has(f"{_SPINDLE}.position_mode"):
        return
    why = {
        "position_mode": "C uses the spindle drive, which must be switched to position mode",
        "position": "C uses the spindle, so the spindle position must be reported",
    }
    for key, words in why.items():
        if not values.text(f"{_SPINDLE}.{key}"):
            own_drive = "; otherwise set own_drive = true in [axis.C]"
            yield Finding(f"{_SPINDLE}.{key}", "", f"missing; {words}{own_drive}")


def _turns(file: FileReading) -> Iterator[Finding]:
    """Yield findings about missing command or feedback pins of a spindle that HAL drives."""
    values = file.values
    paths = {each.name: f"{_SPINDLE}.{each.name}" for each in fields(HalSpindlePins)}
    if not values.has(*paths.values()):
        return
    said = {key: values.text(path) for key, path in paths.items()}
    if values.says("spindle.driver", "hal") and not (said["speed"] or said["speed_abs"] or said["on"]):
        yield Finding(f"{_SPINDLE}.speed", "", "missing; expected speed, speed_abs or on to turn the spindle")
    if said["speed_abs"] and not (said["forward"] or said["on"]):
        yield Finding(f"{_SPINDLE}.forward", "", "missing; an unsigned speed also requires a direction")
    told = said["position"] or said["velocity"] or said["at_speed"]
    if values.says("spindle.driver", "hal") and not told:
        yield Finding(
            f"{_SPINDLE}.velocity", "", "missing; expected position, velocity or at_speed as spindle feedback"
        )
    if values.has("spindle.encoder_ppr") and values.number("spindle.encoder_ppr") and not said["position"]:
        yield Finding(
            f"{_SPINDLE}.position",
            "",
            "missing; spindle.encoder_ppr specifies an encoder, so the spindle position is required",
        )


def _orients(file: FileReading) -> Iterator[Finding]:
    """Yield findings about missing pins of a spindle that HAL orients."""
    values = file.values
    if not values.has("spindle.oriented") or not values.flag("spindle.oriented"):
        return
    if not values.says("spindle.driver", "hal"):
        return
    for key in ("orient", "orient_angle", "orient_mode", "is_oriented"):
        path = f"{_SPINDLE}.{key}"
        if values.has(path) and not values.text(path):
            yield Finding(
                path,
                "",
                "missing; this pin is required because spindle.oriented specifies that HAL "
                "orients the spindle",
            )


def _homes(file: FileReading) -> Iterator[Finding]:
    """Yield findings about the homing method, offset and pins of each axis."""
    values = file.values
    for axis in file.names(_AXES):
        path, pins = f"axis.{axis}.home.method", f"{_AXES}.{axis}"
        if not values.has(path):
            continue
        method = values.whole(path)
        if method not in NEEDS:
            known = ", ".join(str(each) for each in sorted(NEEDS))
            yield Finding(
                path,
                str(method),
                Message("expected a homing method that this backend supports: {known}", known=known),
            )
            continue
        offset = f"axis.{axis}.home.offset"
        if method in _OFF_LIMIT and values.has(offset) and values.number(offset) * _OFF_LIMIT[method] <= 0.0:
            expected = (
                "expected a home offset above 0, because at home the axis must be clear of the limit switch"
                if _OFF_LIMIT[method] > 0
                else "expected a home offset below 0, because at home the axis must be clear of the limit "
                "switch"
            )
            yield Finding(offset, "", expected)
        other = _same_switch(file, axis)
        off = _OFF_SWITCH.get(method, 0.0)
        if other and off and values.has(offset) and values.number(offset) * off <= 0.0:
            expected = Message(
                "expected a home offset {side} 0, because {other} uses the same switch, so the axis "
                "must be clear of the switch at home",
                side="above" if off > 0 else "below",
                other=other,
            )
            yield Finding(offset, "", expected)
        for key in NEEDS[method]:
            if values.has(f"{pins}.{key}") and not values.text(f"{pins}.{key}"):
                yield Finding(
                    f"{pins}.{key}",
                    "",
                    Message("missing; required by {path} = {method}", path=path, method=method),
                )


def _same_switch(file: FileReading, axis: str) -> str:
    """Return the key of another axis whose home switch is on the same input; empty for none."""
    values = file.values
    homes = {each: f"{_AXES}.{each}.home" for each in file.names(_AXES)}
    pins = {each: values.text(path) for each, path in homes.items() if values.has(path)}
    own = pins.get(axis)
    return next((homes[each] for each, pin in pins.items() if own and each != axis and pin == own), "")


def _pin(file: FileReading, text: str) -> object:
    """Return a pin name unchanged, without surrounding spaces."""
    return text.strip() if file.values.says("machine.backend", "hal") else None


DRIVER = Driver(
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
            parts=(
                TableReference(
                    "hal.axes.…",
                    "HAL pins of one axis; the last word of the heading is the axis name. "
                    "Positions are in mm (X: a radius) or degrees. The homing method decides which "
                    "switches are required.",
                    HalAxisPins,
                ),
                TableReference("hal.spindle", "HAL pins of the spindle.", HalSpindlePins),
            ),
        ),
    ),
    backend="hal",
    spindle="hal",
    orients=True,
    terminal=_pin,
)
