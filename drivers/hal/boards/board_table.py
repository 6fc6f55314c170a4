"""The table [board] of the machine file, from which ``turndesk machine hal`` writes the HAL file.

[hal] contains the pins or signals that TurnDesk uses, and [board] describes the hardware that is connected
to them. Scales are calculated from ``axis.….count`` and ``spindle.encoder_ppr``, which are not repeated in
[board].
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Any

from core.key_declaration import FileUnit, KeyRange, declare_key, make_key_table
from core.message import Message
from core.table_schema import (
    DriverDeclaration,
    DriverTable,
    FileFinding,
    MachineFileReading,
    TableDescription,
    read_axes_and_spindle,
)

SIM, PARPORT, MESA_STEP, MESA_SERVO, ETHERCAT = "sim", "parport", "mesa-7i76e", "mesa-7i97", "ethercat"
BOARD_KINDS = (SIM, PARPORT, MESA_STEP, MESA_SERVO, ETHERCAT)
_AXES, _SPINDLE = "board.axis", "board.spindle"
C_AXIS = "C"


def _channel_key(*, meaning: str) -> Any:
    """Return the declaration of a channel of the board, whose default -1 means not specified."""
    return declare_key(KeyRange(0, 63), default=-1, meaning=meaning)


def _pulse_key(default: int, *, meaning: str) -> Any:
    """Return the declaration of a step pulse time in nanoseconds."""
    return declare_key(KeyRange(100, 1_000_000), default=default, meaning=meaning)


def _gain_key(*, meaning: str) -> Any:
    """Return the declaration of a gain of LinuxCNC's ``pid`` component."""
    return declare_key(KeyRange(0.0, 100_000.0), default=0.0, meaning=meaning)


def _pin_key(*, meaning: str) -> Any:
    """Return the declaration of a pin of a parallel port."""
    return declare_key(default="", meaning=f"Parallel port: pin of {meaning}.")


_VENDOR: Any = declare_key(
    default="", meaning="EtherCAT: vendor ID of the drive, 0x…, as `ethercat slaves -v` shows it."
)
_PRODUCT: Any = declare_key(default="", meaning="EtherCAT: product code of the drive, 0x….")


@make_key_table
class BoardAxis:
    """The connection of one axis to a board.

    Speeds are in mm/s, pulse times are in nanoseconds, and gains are those of LinuxCNC's ``pid`` component.
    ``channel`` is the number of the step generator, or of the encoder and analog output, or the position of
    an EtherCAT drive; -1 means not specified. ``full_speed`` is the speed at 10 V, and ``full_rpm`` is that
    of a separate C drive. ``step`` and ``direction`` are pins of a parallel port.
    """

    channel: int = _channel_key(
        meaning="7I76E: step generator, 0 to 4. 7I97: analog output and encoder, 0 to 3. EtherCAT: "
        "position of the drive on the bus."
    )
    reversed: bool = declare_key(
        default=False,
        meaning="true: the sign of the scale of the axis is reversed; on a 7I97 that of its encoder only.",
    )
    mode: str = declare_key(
        default="velocity",
        choices=("velocity", "position"),
        meaning='7I76E: "velocity" closes a position loop around the step generator; "position" sends '
        "positions to it.",
    )
    step_ns: int = _pulse_key(5000, meaning="Length of a step pulse, in ns.")
    space_ns: int = _pulse_key(5000, meaning="7I76E: shortest time between two step pulses, in ns.")
    setup_ns: int = _pulse_key(10_000, meaning="Time from a change of direction to the next step, in ns.")
    hold_ns: int = _pulse_key(10_000, meaning="Time from a step to the next change of direction, in ns.")
    step: str = _pin_key(meaning="the step signal")
    direction: str = _pin_key(meaning="the direction signal")
    fault_input: str = declare_key(
        default="", meaning="7I97: input at which the drive reports a fault. Default: none."
    )
    full_speed: float = declare_key(
        KeyRange(0.1, 10_000.0, FileUnit.FEED),
        default=0.0,
        meaning="7I97: speed of the axis at 10 V, not below `vmax`.",
    )
    full_rpm: float = declare_key(
        KeyRange(0.1, 100_000.0, FileUnit.RPM),
        default=0.0,
        meaning="7I97: speed of the separate C drive at 10 V.",
    )
    p: float = _gain_key(
        meaning="P gain of the position loop, in 1/s. On a 7I76E, 0 means 1 ÷ `period_ms` of [hal]."
    )
    i: float = _gain_key(meaning="I gain of the position loop.")
    d: float = _gain_key(meaning="D gain of the position loop.")
    ff2: float = _gain_key(meaning="Acceleration feedforward (FF2 of the position loop).")
    vendor: str = _VENDOR
    product: str = _PRODUCT


@make_key_table
class BoardSpindle:
    """The connection of the spindle to a board.

    ``full_speed`` is the spindle speed in rpm at 10 V. ``velocity_per_rpm`` is the value of object 60FF of
    an EtherCAT drive for 1 rpm. ``pwm`` and the phases are pins of a parallel port.
    """

    channel: int = _channel_key(
        meaning="7I97: analog output with its own enable, 4 or 5. EtherCAT: position of the drive on the bus."
    )
    encoder: int = _channel_key(meaning="Encoder input of the board: 0 on a 7I76E, 0 to 5 on a 7I97.")
    reversed: bool = declare_key(
        default=False,
        meaning="true: the sign of the scale of the spindle encoder is reversed; on EtherCAT also that of "
        "the speed.",
    )
    full_speed: float = declare_key(
        KeyRange(1.0, 100_000.0, FileUnit.RPM),
        default=0.0,
        meaning="Spindle speed at 10 V, or at the full PWM signal. Default: the board outputs no speed.",
    )
    pwm: str = _pin_key(meaning="the PWM speed signal")
    pwm_hz: int = declare_key(
        KeyRange(10, 50_000), default=1000, meaning="Parallel port: frequency of the PWM signal in Hz."
    )
    phase_a: str = _pin_key(meaning="encoder signal A")
    phase_b: str = _pin_key(meaning="encoder signal B")
    phase_z: str = _pin_key(meaning="encoder signal Z")
    velocity_per_rpm: float = declare_key(
        KeyRange(1e-6, 1e7), default=0.0, meaning="EtherCAT: value of object 60FF at 1 rpm."
    )
    vendor: str = _VENDOR
    product: str = _PRODUCT


@make_key_table
class BoardTable:
    """The settings of the board.

    ``address`` is the address of an Ethernet card or of a parallel port.
    """

    kind: str = declare_key(
        choices=BOARD_KINDS, meaning="Board for which `turndesk machine hal` writes the HAL file."
    )
    address: str = declare_key(
        default="",
        meaning='Address of the board: an IP address for a Mesa card, a port address such as "0x378" for a '
        "parallel port.",
    )
    base_us: int = declare_key(
        KeyRange(10, 500),
        default=50,
        meaning="Period of the base thread of a parallel port, in µs; longer than the worst latency.",
    )
    axes: Mapping[str, BoardAxis] = field(default_factory=dict)
    spindle: BoardSpindle = field(default_factory=BoardSpindle)


def _read(file: MachineFileReading) -> Iterator[FileFinding]:
    yield from read_axes_and_spindle(file, (_AXES, BoardAxis), (_SPINDLE, BoardSpindle))


def _read_parts(file: MachineFileReading) -> dict[str, object]:
    """Return the nested tables of the axes and the spindle."""
    names = file.list_table_keys(_AXES)
    axes = {name: file.file_values.make_model(BoardAxis, f"{_AXES}.{name}") for name in names}
    return {"axes": axes, "spindle": file.file_values.make_model(BoardSpindle, _SPINDLE)}


# --- Required settings of each kind of board.


_ADDRESS = {
    PARPORT: (
        re.compile(r"0x[0-9a-fA-F]{3,4}"),
        'expected the port address, for example "0x378" for the first on-board port',
    ),
    MESA_STEP: (
        re.compile(r"\d{1,3}(\.\d{1,3}){3}"),
        'expected the card\'s address, such as "192.168.1.121"',
    ),
    MESA_SERVO: (re.compile(r"\d{1,3}(\.\d{1,3}){3}"), 'expected the card\'s address, such as "10.10.10.10"'),
}
_CHANNELS = {MESA_STEP: range(5), MESA_SERVO: range(4), ETHERCAT: range(64)}
_CHANNEL_MEANINGS = {
    MESA_STEP: "the number of a 7I76E step generator, from 0 to 4",
    MESA_SERVO: (
        "the number of a 7I97 channel (analog output and encoder) with the common enable, from 0 to 3"
    ),
    ETHERCAT: "the position of the drive on the bus, counted from 0",
}
_NUMBER = re.compile(r"0x[0-9a-fA-F]{1,8}")


def _rules(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    if "board" not in file.tables or not values.has_values("board.kind"):
        return
    kind = values.text("board.kind")
    if "hal" not in file.tables:
        yield FileFinding(
            "hal",
            "",
            "missing; [board] requires the table [hal], because [board] describes the hardware "
            "connected to the pins that [hal] specifies",
        )
    if kind in _ADDRESS and values.has_values("board.address"):
        form, expected = _ADDRESS[kind]
        if not form.fullmatch(values.text("board.address")):
            yield FileFinding("board.address", values.text("board.address"), expected)
    for axis in file.list_table_keys("hal.axes"):
        if kind != SIM and axis in file.axes:
            yield from _axis_rules(file, kind, axis)
    yield from _check_unique_channels(file, kind)
    if kind != SIM and values.has_text("spindle.driver", "hal"):
        yield from _check_spindle(file, kind)
    if kind != SIM:
        yield from _check_encoder(file, kind)


def _axis_rules(file: MachineFileReading, kind: str, axis: str) -> Iterator[FileFinding]:
    values, path = file.file_values, f"{_AXES}.{axis}"
    if axis not in file.list_table_keys(_AXES):
        if path not in values.invalid_paths:
            yield FileFinding(
                path, "", Message("missing; specify the board outputs that move axis {axis}", axis=axis)
            )
        return
    if axis == C_AXIS and _spindle_is_c(file):
        yield from _check_spindle_as_c(file, kind, path)
        return
    yield from _channel_rules(file, kind, path)
    yield from _check_required(file, kind, path, _SEPARATE_C_KEYS if axis == C_AXIS else _REQUIRED_KEYS)
    if kind in (PARPORT, MESA_STEP):
        yield from _check_step_rate(file, kind, axis)
    if kind == MESA_SERVO and axis != C_AXIS:
        yield from _fast_enough(file, axis)


def _channel_rules(file: MachineFileReading, kind: str, path: str) -> Iterator[FileFinding]:
    values = file.file_values
    if kind in _CHANNELS and values.has_values(f"{path}.channel"):
        channel = values.read_integer(f"{path}.channel")
        if channel not in _CHANNELS[kind]:
            yield _number_finding(f"{path}.channel", channel, _CHANNEL_MEANINGS[kind])


def _spindle_is_c(file: MachineFileReading) -> bool:
    """Return whether HAL controls the spindle and the spindle drive also serves as the C axis."""
    values = file.file_values
    own = values.has_values("axis.C.own_drive") and values.read_flag("axis.C.own_drive")
    return not own and values.has_text("spindle.driver", "hal")


def _check_spindle_as_c(file: MachineFileReading, kind: str, path: str) -> Iterator[FileFinding]:
    """Yield findings about wrong gain, step or drive keys when the C axis is the spindle drive."""
    values = file.file_values
    yield from _check_required(file, kind, path, _SPINDLE_C_KEYS)
    if kind in (PARPORT, MESA_STEP):
        yield from _channel_rules(file, kind, path)
        yield from _check_step_rate(file, kind, C_AXIS)
        return
    if values.has_values("hal.spindle.speed") and not values.text("hal.spindle.speed"):
        why = "this entry is missing; C turns in both directions, so its drive needs a signed speed command"
        yield FileFinding("hal.spindle.speed", "", why)
    for key in ("channel", "full_speed", "full_rpm", "vendor", "product"):
        place = f"{path}.{key}"
        if values.has_values(place) and values.values_by_path[place] not in ("", 0.0, -1):
            why = Message(
                "remove this key: C uses the spindle drive, which is configured in {table}", table=_SPINDLE
            )
            yield FileFinding(place, str(values.values_by_path[place]), why)


def _missing(place: str, expected: str) -> FileFinding:
    return FileFinding(place, "", Message("missing; expected {expected}", expected=expected))


def _number_finding(path: str, number: int, expected: str) -> FileFinding:
    """Return the finding for a number that is out of range, or for a missing number, which is negative."""
    if number < 0:
        return _missing(path, expected)
    return FileFinding(path, str(number), Message("expected {expected}", expected=expected))


_KeyStatement = Mapping[str, tuple[tuple[str, str], ...]]
_GAIN = ("p", "the P gain of the axis's pid component in 1/s, as determined on the machine")
_STEPS = (("step", "the pin for the step signal"), ("direction", "the pin for the direction signal"))
_REQUIRED_KEYS: _KeyStatement = {
    PARPORT: _STEPS,
    MESA_SERVO: (("full_speed", "the axis speed at 10 V"), _GAIN),
    ETHERCAT: (("vendor", "the drive's vendor ID, 0x…"), ("product", "the drive's product code, 0x…")),
}
_SEPARATE_C_KEYS: _KeyStatement = {
    **_REQUIRED_KEYS,
    MESA_SERVO: (("full_rpm", "the speed of the C drive at 10 V, in rpm"), _GAIN),
}
_SPINDLE_C_KEYS: _KeyStatement = {
    PARPORT: (*_STEPS, _GAIN),
    **dict.fromkeys((MESA_STEP, MESA_SERVO, ETHERCAT), (_GAIN,)),
}


def _check_required(
    file: MachineFileReading, kind: str, path: str, stated: _KeyStatement = _REQUIRED_KEYS
) -> Iterator[FileFinding]:
    """Yield findings about missing keys that a board of this kind requires."""
    for key, what in stated.get(kind, ()):
        place = f"{path}.{key}"
        if not file.file_values.has_values(place):
            continue
        said = file.file_values.values_by_path[place]
        if not said:
            yield _missing(place, what)
        elif key in ("vendor", "product") and not _NUMBER.fullmatch(str(said)):
            yield FileFinding(
                place,
                str(said),
                'expected a hexadecimal number as shown by `ethercat slaves -v`, for example "0x0000026c"',
            )


def _check_step_rate(file: MachineFileReading, kind: str, axis: str) -> Iterator[FileFinding]:
    """Yield a finding if an axis needs more steps per second than the board can generate."""
    values, path = file.file_values, f"{_AXES}.{axis}"
    needed = (
        f"axis.{axis}.vmax",
        f"axis.{axis}.count",
        "board.base_us",
        f"{path}.step_ns",
        f"{path}.space_ns",
    )
    if not values.has_values(*needed):
        return
    rate = values.read_number(needed[0]) / values.read_number(needed[1])
    if kind == PARPORT:
        most = 1e6 / values.read_number("board.base_us")
        template = (
            "this speed requires {rate} steps/s, but the maximum for a parallel port with "
            "base_us = {base_us} is {maximum} steps/s"
        )
    else:
        most = 1e9 / (values.read_number(needed[3]) + values.read_number(needed[4]))
        template = (
            "this speed requires {rate} steps/s, but the maximum for the specified step_ns and space_ns "
            "is {maximum} steps/s"
        )
    if rate * 1.2 > most:  # The limit of the drive is 20 % above vmax.
        yield FileFinding(
            f"axis.{axis}.vmax",
            "",
            Message(
                template,
                rate=f"{rate:.0f}",
                base_us=values.read_integer("board.base_us"),
                maximum=f"{most / 1.2:.0f}",
            ),
        )


def _fast_enough(file: MachineFileReading, axis: str) -> Iterator[FileFinding]:
    values, path = file.file_values, f"{_AXES}.{axis}.full_speed"
    if values.has_values(path, f"axis.{axis}.vmax") and 0.0 < values.read_number(path) < values.read_number(
        f"axis.{axis}.vmax"
    ):
        yield FileFinding(
            path,
            "",
            Message(
                "expected a value of at least axis.{axis}.vmax, because the board outputs no more than 10 V",
                axis=axis,
            ),
        )


def _check_unique_channels(file: MachineFileReading, kind: str) -> Iterator[FileFinding]:
    """Yield findings about channels that are used twice."""
    values = file.file_values
    paths = [f"{_AXES}.{axis}.channel" for axis in file.list_table_keys(_AXES)]
    if kind in (MESA_SERVO, ETHERCAT):
        paths.append(f"{_SPINDLE}.channel")
    taken: dict[int, str] = {}
    for path in paths:
        channel = values.read_integer(path) if values.has_values(path) else -1
        if channel >= 0 and (first := taken.setdefault(channel, path)) != path:
            yield FileFinding(
                path,
                str(channel),
                Message("expected an unused channel; {first} already uses this channel", first=first),
            )


def _check_spindle(file: MachineFileReading, kind: str) -> Iterator[FileFinding]:
    """Yield findings about a spindle speed without a scale, or a scale without a spindle speed."""
    values = file.file_values
    speeds = ("hal.spindle.speed", "hal.spindle.speed_abs")
    if not values.has_values(
        *speeds, f"{_SPINDLE}.full_speed", f"{_SPINDLE}.velocity_per_rpm", f"{_SPINDLE}.channel"
    ):
        return
    has_speed_pin = any(values.text(path) for path in speeds)
    scale = "velocity_per_rpm" if kind == ETHERCAT else "full_speed"
    scaled = values.read_number(f"{_SPINDLE}.{scale}")
    if has_speed_pin and not scaled:
        what = (
            "the value of object 60FF at 1 rpm" if kind == ETHERCAT else ("the spindle speed at 10 V, in rpm")
        )
        yield _missing(f"{_SPINDLE}.{scale}", what)
    if scaled and not has_speed_pin:
        yield FileFinding(
            speeds[0],
            "",
            Message(
                "missing; this pin is required because {key} specifies an output for the spindle speed",
                key=f"{_SPINDLE}.{scale}",
            ),
        )
    channel = values.read_integer(f"{_SPINDLE}.channel")
    if has_speed_pin and kind == MESA_SERVO and channel not in (4, 5):
        what = "the number of an analog output with a separate enable: 4 or 5"
        yield _number_finding(f"{_SPINDLE}.channel", channel, what)
    if has_speed_pin and kind == ETHERCAT:
        if channel < 0:
            yield _missing(f"{_SPINDLE}.channel", _CHANNEL_MEANINGS[kind])
        yield from _check_required(file, kind, _SPINDLE)


def _check_encoder(file: MachineFileReading, kind: str) -> Iterator[FileFinding]:
    """Yield findings about the line count and the channel of the spindle encoder."""
    values = file.file_values
    if not values.has_values("spindle.encoder_ppr", "hal.spindle.position", f"{_SPINDLE}.encoder"):
        return
    has, read = values.read_number("spindle.encoder_ppr"), values.text("hal.spindle.position")
    if read and not has:
        yield FileFinding(
            "spindle.encoder_ppr",
            "0",
            "expected the line count of the encoder that hal.spindle.position reads",
        )
    most = {MESA_STEP: 0, MESA_SERVO: 5}.get(kind)
    channel = values.read_integer(f"{_SPINDLE}.encoder")
    for axis in file.list_table_keys(_AXES) if kind == MESA_SERVO else ():
        path = f"{_AXES}.{axis}.channel"
        if values.has_values(path) and values.read_integer(path) == channel >= 0:
            why = Message("expected an unused encoder; {path} already uses this encoder", path=path)
            yield FileFinding(f"{_SPINDLE}.encoder", str(channel), why)
    if read and has and most is not None and not 0 <= channel <= most:
        what = (
            ("0, the number of the only encoder on the 7I76E")
            if most == 0
            else ("the number of a 7I97 encoder, from 0 to 5")
        )
        yield _number_finding(f"{_SPINDLE}.encoder", channel, what)
    if read and has and kind == PARPORT:
        for key in ("phase_a", "phase_b"):
            if values.has_values(f"{_SPINDLE}.{key}") and not values.text(f"{_SPINDLE}.{key}"):
                yield FileFinding(
                    f"{_SPINDLE}.{key}", "", "missing; expected the parallel port pin of this encoder signal"
                )


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "board",
            BoardTable,
            _read_parts,
            ("axis", "spindle"),
            _read,
            _rules,
            purpose="The hardware for which `turndesk machine hal` writes the HAL file. Scales follow from "
            "`count` of the axes and `encoder_ppr` of the spindle.",
            sub_tables=(
                TableDescription(
                    "board.axis.…",
                    "Connection of one axis to the board; the last word of the heading is the axis name.",
                    BoardAxis,
                ),
                TableDescription(
                    "board.spindle",
                    "How the spindle and its encoder are connected to the board.",
                    BoardSpindle,
                ),
            ),
        ),
    )
)
