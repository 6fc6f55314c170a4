"""Table [board] of the machine file, from which ``turndesk machine hal`` writes LinuxCNC's HAL file.

[hal] names the pins or signals that TurnDesk uses, and [board] the hardware connected to them. Scales follow
from ``axis.….count`` and ``spindle.encoder_ppr``, which the machine file contains anyway.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Any

from core.key_declaration import Range, Unit, file_key, key_table
from core.message import Message
from core.table_schema import Driver, DriverTable, FileReading, Finding, TableReference, read_axes_and_spindle

SIM, PARPORT, MESA_STEP, MESA_SERVO, ETHERCAT = "sim", "parport", "mesa-7i76e", "mesa-7i97", "ethercat"
KINDS = (SIM, PARPORT, MESA_STEP, MESA_SERVO, ETHERCAT)
_AXES, _SPINDLE = "board.axis", "board.spindle"
C = "C"


def _channel(*, meaning: str) -> Any:
    """Declare a channel of the board; -1 where the file does not specify it."""
    return file_key(Range(0, 63), default=-1, meaning=meaning)


def _pulse(default: int, *, meaning: str) -> Any:
    """Declare a time of a step pulse in nanoseconds."""
    return file_key(Range(100, 1_000_000), default=default, meaning=meaning)


def _gain(*, meaning: str) -> Any:
    """Declare a gain of LinuxCNC's ``pid``."""
    return file_key(Range(0.0, 100_000.0), default=0.0, meaning=meaning)


def _pin(*, meaning: str) -> Any:
    """Declare a pin of a parallel port."""
    return file_key(default="", meaning=f"Parallel port: pin of {meaning}.")


_VENDOR: Any = file_key(
    default="", meaning="EtherCAT: vendor ID of the drive, 0x…, as `ethercat slaves -v` shows it."
)
_PRODUCT: Any = file_key(default="", meaning="EtherCAT: product code of the drive, 0x….")


@key_table
class BoardAxis:
    """Connection of one axis to a board.

    Speeds are in mm/s, pulse times in nanoseconds, and gains are those of LinuxCNC's ``pid``. ``channel`` is
    the step generator, the encoder and analog output, or the position of the drive on EtherCAT; -1 means not
    specified. ``full_speed`` is the speed at 10 V, and ``full_rpm`` that of a separate C drive. ``step`` and
    ``direction`` are pins of a parallel port.
    """

    channel: int = _channel(
        meaning="7I76E: step generator, 0 to 4. 7I97: analog output and encoder, 0 to 3. EtherCAT: "
        "position of the drive on the bus."
    )
    reversed: bool = file_key(
        default=False,
        meaning="true: the sign of the scale of the axis is reversed; on a 7I97 that of its encoder only.",
    )
    mode: str = file_key(
        default="velocity",
        choices=("velocity", "position"),
        meaning='7I76E: "velocity" closes a position loop around the step generator; "position" sends '
        "positions to it.",
    )
    step_ns: int = _pulse(5000, meaning="Length of a step pulse, in ns.")
    space_ns: int = _pulse(5000, meaning="7I76E: shortest time between two step pulses, in ns.")
    setup_ns: int = _pulse(10_000, meaning="Time from a change of direction to the next step, in ns.")
    hold_ns: int = _pulse(10_000, meaning="Time from a step to the next change of direction, in ns.")
    step: str = _pin(meaning="the step signal")
    direction: str = _pin(meaning="the direction signal")
    fault_input: str = file_key(
        default="", meaning="7I97: input at which the drive reports a fault. Default: none."
    )
    full_speed: float = file_key(
        Range(0.1, 10_000.0, Unit.FEED),
        default=0.0,
        meaning="7I97: speed of the axis at 10 V, not below `vmax`.",
    )
    full_rpm: float = file_key(
        Range(0.1, 100_000.0, Unit.RPM), default=0.0, meaning="7I97: speed of the separate C drive at 10 V."
    )
    p: float = _gain(
        meaning="P gain of the position loop, in 1/s. On a 7I76E, 0 means 1 ÷ `period_ms` of [hal]."
    )
    i: float = _gain(meaning="I gain of the position loop.")
    d: float = _gain(meaning="D gain of the position loop.")
    ff2: float = _gain(meaning="Acceleration feedforward (FF2 of the position loop).")
    vendor: str = _VENDOR
    product: str = _PRODUCT


@key_table
class BoardSpindle:
    """Connection of the spindle to a board; ``full_speed`` is its speed in rpm at 10 V.

    ``velocity_per_rpm`` is the value of object 60FF of an EtherCAT drive for 1 rpm. ``pwm`` and the phases
    are pins of a parallel port.
    """

    channel: int = _channel(
        meaning="7I97: analog output with its own enable, 4 or 5. EtherCAT: position of the drive on the bus."
    )
    encoder: int = _channel(meaning="Encoder input of the board: 0 on a 7I76E, 0 to 5 on a 7I97.")
    reversed: bool = file_key(
        default=False,
        meaning="true: the sign of the scale of the spindle encoder is reversed; on EtherCAT also that of "
        "the speed.",
    )
    full_speed: float = file_key(
        Range(1.0, 100_000.0, Unit.RPM),
        default=0.0,
        meaning="Spindle speed at 10 V, or at the full PWM signal. Default: the board outputs no speed.",
    )
    pwm: str = _pin(meaning="the PWM speed signal")
    pwm_hz: int = file_key(
        Range(10, 50_000), default=1000, meaning="Parallel port: frequency of the PWM signal in Hz."
    )
    phase_a: str = _pin(meaning="encoder signal A")
    phase_b: str = _pin(meaning="encoder signal B")
    phase_z: str = _pin(meaning="encoder signal Z")
    velocity_per_rpm: float = file_key(
        Range(1e-6, 1e7), default=0.0, meaning="EtherCAT: value of object 60FF at 1 rpm."
    )
    vendor: str = _VENDOR
    product: str = _PRODUCT


@key_table
class BoardTable:
    """Settings of the board; ``address`` is that of an Ethernet card or a parallel port."""

    kind: str = file_key(choices=KINDS, meaning="Board for which `turndesk machine hal` writes the HAL file.")
    address: str = file_key(
        default="",
        meaning='Address of the board: an IP address for a Mesa card, a port address such as "0x378" for a '
        "parallel port.",
    )
    base_us: int = file_key(
        Range(10, 500),
        default=50,
        meaning="Period of the base thread of a parallel port, in µs; longer than the worst latency.",
    )
    axes: Mapping[str, BoardAxis] = field(default_factory=dict)
    spindle: BoardSpindle = field(default_factory=BoardSpindle)


def _read(file: FileReading) -> Iterator[Finding]:
    yield from read_axes_and_spindle(file, (_AXES, BoardAxis), (_SPINDLE, BoardSpindle))


def _parts(file: FileReading) -> dict[str, object]:
    """Return the nested tables of the axes and the spindle."""
    axes = {name: file.values.model(BoardAxis, f"{_AXES}.{name}") for name in file.names(_AXES)}
    return {"axes": axes, "spindle": file.values.model(BoardSpindle, _SPINDLE)}


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
_WHAT = {
    MESA_STEP: "the number of a 7I76E step generator, from 0 to 4",
    MESA_SERVO: (
        "the number of a 7I97 channel (analog output and encoder) with the common enable, from 0 to 3"
    ),
    ETHERCAT: "the position of the drive on the bus, counted from 0",
}
_NUMBER = re.compile(r"0x[0-9a-fA-F]{1,8}")


def _rules(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if "board" not in file.tables or not values.has("board.kind"):
        return
    kind = values.text("board.kind")
    if "hal" not in file.tables:
        yield Finding(
            "hal",
            "",
            "missing; [board] requires the table [hal], because [board] describes the hardware "
            "connected to the pins that [hal] specifies",
        )
    if kind in _ADDRESS and values.has("board.address"):
        form, expected = _ADDRESS[kind]
        if not form.fullmatch(values.text("board.address")):
            yield Finding("board.address", values.text("board.address"), expected)
    for axis in file.names("hal.axes"):
        if kind != SIM and axis in file.axes:
            yield from _axis_rules(file, kind, axis)
    yield from _channels_apart(file, kind)
    if kind != SIM and values.says("spindle.driver", "hal"):
        yield from _spindle_rules(file, kind)
    if kind != SIM:
        yield from _encoder_rules(file, kind)


def _axis_rules(file: FileReading, kind: str, axis: str) -> Iterator[Finding]:
    values, path = file.values, f"{_AXES}.{axis}"
    if axis not in file.names(_AXES):
        if path not in values.wrong:
            yield Finding(
                path, "", Message("missing; specify the board outputs that move axis {axis}", axis=axis)
            )
        return
    if axis == C and _spindle_is_c(file):
        yield from _spindle_as_c(file, kind, path)
        return
    yield from _channel_rules(file, kind, path)
    yield from _stated(file, kind, path, _OWN_C if axis == C else _STATED)
    if kind in (PARPORT, MESA_STEP):
        yield from _step_rate(file, kind, axis)
    if kind == MESA_SERVO and axis != C:
        yield from _fast_enough(file, axis)


def _channel_rules(file: FileReading, kind: str, path: str) -> Iterator[Finding]:
    values = file.values
    if kind in _CHANNELS and values.has(f"{path}.channel"):
        channel = values.whole(f"{path}.channel")
        if channel not in _CHANNELS[kind]:
            yield _number_expected(f"{path}.channel", channel, _WHAT[kind])


def _spindle_is_c(file: FileReading) -> bool:
    """Return whether C is the spindle drive, driven by HAL."""
    values = file.values
    own = values.has("axis.C.own_drive") and values.flag("axis.C.own_drive")
    return not own and values.says("spindle.driver", "hal")


def _spindle_as_c(file: FileReading, kind: str, path: str) -> Iterator[Finding]:
    """Yield findings about C on the spindle drive: its gain, its own steps, and keys that must be removed."""
    values = file.values
    yield from _stated(file, kind, path, _AS_C)
    if kind in (PARPORT, MESA_STEP):
        yield from _channel_rules(file, kind, path)
        yield from _step_rate(file, kind, C)
        return
    if values.has("hal.spindle.speed") and not values.text("hal.spindle.speed"):
        why = "this entry is missing; C turns in both directions, so its drive needs a signed speed command"
        yield Finding("hal.spindle.speed", "", why)
    for key in ("channel", "full_speed", "full_rpm", "vendor", "product"):
        place = f"{path}.{key}"
        if values.has(place) and values.found[place] not in ("", 0.0, -1):
            why = Message(
                "remove this key: C uses the spindle drive, which is configured in {table}", table=_SPINDLE
            )
            yield Finding(place, str(values.found[place]), why)


def _missing(place: str, expected: str) -> Finding:
    return Finding(place, "", Message("missing; expected {expected}", expected=expected))


def _number_expected(place: str, number: int, expected: str) -> Finding:
    """Return the finding for a number that is missing (negative) or out of range."""
    if number < 0:
        return _missing(place, expected)
    return Finding(place, str(number), Message("expected {expected}", expected=expected))


_Stated = Mapping[str, tuple[tuple[str, str], ...]]
_GAIN = ("p", "the P gain of the axis's pid component in 1/s, as determined on the machine")
_STEPS = (("step", "the pin for the step signal"), ("direction", "the pin for the direction signal"))
_STATED: _Stated = {
    PARPORT: _STEPS,
    MESA_SERVO: (("full_speed", "the axis speed at 10 V"), _GAIN),
    ETHERCAT: (("vendor", "the drive's vendor ID, 0x…"), ("product", "the drive's product code, 0x…")),
}
_OWN_C: _Stated = {**_STATED, MESA_SERVO: (("full_rpm", "the speed of the C drive at 10 V, in rpm"), _GAIN)}
_AS_C: _Stated = {PARPORT: (*_STEPS, _GAIN), **dict.fromkeys((MESA_STEP, MESA_SERVO, ETHERCAT), (_GAIN,))}


def _stated(file: FileReading, kind: str, path: str, stated: _Stated = _STATED) -> Iterator[Finding]:
    """Yield findings about missing keys that this kind of board requires."""
    for key, what in stated.get(kind, ()):
        place = f"{path}.{key}"
        if not file.values.has(place):
            continue
        said = file.values.found[place]
        if not said:
            yield _missing(place, what)
        elif key in ("vendor", "product") and not _NUMBER.fullmatch(str(said)):
            yield Finding(
                place,
                str(said),
                'expected a hexadecimal number as shown by `ethercat slaves -v`, for example "0x0000026c"',
            )


def _step_rate(file: FileReading, kind: str, axis: str) -> Iterator[Finding]:
    """Yield a finding if an axis needs more steps per second than the board can generate."""
    values, path = file.values, f"{_AXES}.{axis}"
    needed = (
        f"axis.{axis}.vmax",
        f"axis.{axis}.count",
        "board.base_us",
        f"{path}.step_ns",
        f"{path}.space_ns",
    )
    if not values.has(*needed):
        return
    rate = values.number(needed[0]) / values.number(needed[1])
    if kind == PARPORT:
        most = 1e6 / values.number("board.base_us")
        template = (
            "this speed requires {rate} steps/s, but the maximum for a parallel port with "
            "base_us = {base_us} is {maximum} steps/s"
        )
    else:
        most = 1e9 / (values.number(needed[3]) + values.number(needed[4]))
        template = (
            "this speed requires {rate} steps/s, but the maximum for the specified step_ns and space_ns "
            "is {maximum} steps/s"
        )
    if rate * 1.2 > most:  # The limit of the drive is 20 % above vmax.
        yield Finding(
            f"axis.{axis}.vmax",
            "",
            Message(
                template,
                rate=f"{rate:.0f}",
                base_us=values.whole("board.base_us"),
                maximum=f"{most / 1.2:.0f}",
            ),
        )


def _fast_enough(file: FileReading, axis: str) -> Iterator[Finding]:
    values, path = file.values, f"{_AXES}.{axis}.full_speed"
    if values.has(path, f"axis.{axis}.vmax") and 0.0 < values.number(path) < values.number(
        f"axis.{axis}.vmax"
    ):
        yield Finding(
            path,
            "",
            Message(
                "expected a value of at least axis.{axis}.vmax, because the board outputs no more than 10 V",
                axis=axis,
            ),
        )


def _channels_apart(file: FileReading, kind: str) -> Iterator[Finding]:
    """Yield findings about channels that are used twice."""
    values = file.values
    paths = [f"{_AXES}.{axis}.channel" for axis in file.names(_AXES)]
    if kind in (MESA_SERVO, ETHERCAT):
        paths.append(f"{_SPINDLE}.channel")
    taken: dict[int, str] = {}
    for path in paths:
        channel = values.whole(path) if values.has(path) else -1
        if channel >= 0 and (first := taken.setdefault(channel, path)) != path:
            yield Finding(
                path,
                str(channel),
                Message("expected an unused channel; {first} already uses this channel", first=first),
            )


def _spindle_rules(file: FileReading, kind: str) -> Iterator[Finding]:
    """Yield findings about a spindle speed without a scale, or a scale without a speed."""
    values = file.values
    speeds = ("hal.spindle.speed", "hal.spindle.speed_abs")
    if not values.has(
        *speeds, f"{_SPINDLE}.full_speed", f"{_SPINDLE}.velocity_per_rpm", f"{_SPINDLE}.channel"
    ):
        return
    told = any(values.text(path) for path in speeds)
    scale = "velocity_per_rpm" if kind == ETHERCAT else "full_speed"
    scaled = values.number(f"{_SPINDLE}.{scale}")
    if told and not scaled:
        what = (
            "the value of object 60FF at 1 rpm" if kind == ETHERCAT else ("the spindle speed at 10 V, in rpm")
        )
        yield _missing(f"{_SPINDLE}.{scale}", what)
    if scaled and not told:
        yield Finding(
            speeds[0],
            "",
            Message(
                "missing; this pin is required because {key} specifies an output for the spindle speed",
                key=f"{_SPINDLE}.{scale}",
            ),
        )
    channel = values.whole(f"{_SPINDLE}.channel")
    if told and kind == MESA_SERVO and channel not in (4, 5):
        what = "the number of an analog output with a separate enable: 4 or 5"
        yield _number_expected(f"{_SPINDLE}.channel", channel, what)
    if told and kind == ETHERCAT:
        if channel < 0:
            yield _missing(f"{_SPINDLE}.channel", _WHAT[kind])
        yield from _stated(file, kind, _SPINDLE)


def _encoder_rules(file: FileReading, kind: str) -> Iterator[Finding]:
    """Yield findings about the lines and the channel of the spindle encoder."""
    values = file.values
    if not values.has("spindle.encoder_ppr", "hal.spindle.position", f"{_SPINDLE}.encoder"):
        return
    has, read = values.number("spindle.encoder_ppr"), values.text("hal.spindle.position")
    if read and not has:
        yield Finding(
            "spindle.encoder_ppr",
            "0",
            "expected the line count of the encoder that hal.spindle.position reads",
        )
    most = {MESA_STEP: 0, MESA_SERVO: 5}.get(kind)
    channel = values.whole(f"{_SPINDLE}.encoder")
    for axis in file.names(_AXES) if kind == MESA_SERVO else ():
        path = f"{_AXES}.{axis}.channel"
        if values.has(path) and values.whole(path) == channel >= 0:
            why = Message("expected an unused encoder; {path} already uses this encoder", path=path)
            yield Finding(f"{_SPINDLE}.encoder", str(channel), why)
    if read and has and most is not None and not 0 <= channel <= most:
        what = (
            ("0, the number of the only encoder on the 7I76E")
            if most == 0
            else ("the number of a 7I97 encoder, from 0 to 5")
        )
        yield _number_expected(f"{_SPINDLE}.encoder", channel, what)
    if read and has and kind == PARPORT:
        for key in ("phase_a", "phase_b"):
            if values.has(f"{_SPINDLE}.{key}") and not values.text(f"{_SPINDLE}.{key}"):
                yield Finding(
                    f"{_SPINDLE}.{key}", "", "missing; expected the parallel port pin of this encoder signal"
                )


DRIVER = Driver(
    tables=(
        DriverTable(
            "board",
            BoardTable,
            _parts,
            ("axis", "spindle"),
            _read,
            _rules,
            purpose="The hardware for which `turndesk machine hal` writes the HAL file. Scales follow from "
            "`count` of the axes and `encoder_ppr` of the spindle.",
            parts=(
                TableReference(
                    "board.axis.…",
                    "Connection of one axis to the board; the last word of the heading is the axis name.",
                    BoardAxis,
                ),
                TableReference(
                    "board.spindle",
                    "How the spindle and its encoder are connected to the board.",
                    BoardSpindle,
                ),
            ),
        ),
    )
)
