"""Table [grblhal] of the machine file: port and settings of the controller."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field

from core.key_declaration import Range, file_key, key_table
from core.message import Message
from core.table_schema import (
    Driver,
    DriverTable,
    FileReading,
    Finding,
    TableReference,
    expected_table,
    written,
)

_SETTINGS, _WHEEL, _GUARD = "grblhal.settings", "io.analog.handwheel", "io.in.guard.at"
# Required values of settings on a lathe.
_NEEDED = (
    (13, 0, "reports must be in mm, because reports in inches have too few decimals"),
    (32, 2, "lathe mode"),
)
_AXES = {"X": 0, "Y": 1, "Z": 2}
# First number of each group of settings, the compared key, and the factor to the controller's unit.
_LIMITS = ((110, "vmax", 60.0, "mm/min"), (120, "amax", 1.0, "mm/s²"))
_TRAVEL = 130


@key_table
class GrblhalTable:
    """Settings of a motion controller with its own planner, which are written at each connection."""

    port: str = file_key(meaning="Serial port of the controller, or its address as `tcp://host:port`.")
    baud: int = file_key(Range(110, 4_000_000), default=115_200, meaning="Bit rate of the serial port.")
    x_mode: str = file_key(
        default="G8",
        choices=("G7", "G8"),
        meaning='How the controller reads X. "G8": a radius, which is the only accepted value.',
    )
    settings: Mapping[int, float | str] = field(default_factory=dict)


def _read(file: FileReading) -> Iterator[Finding]:
    table = file.raw(_SETTINGS)
    if table is not None and not isinstance(table, dict):
        yield expected_table(_SETTINGS, table)
        return
    for key, value in (table or {}).items():
        if not key.isdecimal():
            expected = "the key must be a setting number, such as 13 for $13"
            yield Finding(f"{_SETTINGS}.{key}", written(value), expected)
        elif not _is_setting(value):
            yield Finding(f"{_SETTINGS}.{key}", written(value), "the setting must be a number or text")


def _is_setting(value: object) -> bool:
    return isinstance(value, int | float | str) and not isinstance(value, bool)


def _settings(file: FileReading) -> dict[int, float | str]:
    """Return the valid entries of the settings table by number."""
    table = file.raw(_SETTINGS)
    entries = table.items() if isinstance(table, dict) else ()
    return {int(key): value for key, value in entries if key.isdecimal() and _is_setting(value)}


def _rules(file: FileReading) -> Iterator[Finding]:
    values, settings = file.values, _settings(file)
    if "handwheel" in file.names("io.analog") and values.says("machine.backend", "grblhal"):
        yield Finding(_WHEEL, "", "this backend does not have a counter input; remove this entry")
    if values.says("machine.backend", "grblhal"):
        yield from _guard(file)
    for axis in file.axes:
        if axis in _AXES:
            yield from _outside(file, settings, axis)
    for number, value, why in _NEEDED:
        if settings.get(number, value) != value:
            yield Finding(
                f"{_SETTINGS}.{number}",
                written(settings[number]),
                Message("this value must be {details}; {why}", details=value, why=why),
            )
    if values.says("grblhal.x_mode", "G7"):
        yield Finding(
            "grblhal.x_mode",
            '"G7"',
            'the X mode must be "G8", because a reset would change the meaning of X',
        )


def _guard(file: FileReading) -> Iterator[Finding]:
    """Yield a finding if a guard that stops the cycle uses an input that is read only at standstill."""
    values, path = file.values, "interlocks.guard_stops"
    stops = values.has(path, _GUARD) and values.flag(path)
    if stops and values.text(_GUARD).startswith("in."):
        expected = (
            'this input must be the door input, "pn.D", because auxiliary inputs are read only at standstill'
        )
        yield Finding(_GUARD, written(values.text(_GUARD)), expected, "broken-rule")


def _outside(file: FileReading, settings: Mapping[int, float | str], axis: str) -> Iterator[Finding]:
    """Yield findings for an axis whose limits exceed those in the controller's settings."""
    values, offset = file.values, _AXES[axis]
    for first, key, factor, unit in _LIMITS:
        path = f"axis.{axis}.{key}"
        if values.has(path):
            yield from _too_small(settings, first + offset, values.number(path) * factor, path, unit)
    path = f"axis.{axis}.travel"
    if values.has(path):
        low, high = values.pair(path)
        yield from _too_small(settings, _TRAVEL + offset, high - low, path, "mm")


def _too_small(
    settings: Mapping[int, float | str], number: int, needed: float, path: str, unit: str
) -> Iterator[Finding]:
    setting = settings.get(number)
    if isinstance(setting, str) or setting is None or setting >= needed * (1 - 1e-6):
        return
    expected = Message(
        "the setting must be at least {needed} {unit} for {path}",
        needed=f"{needed:.6g}",
        unit=unit,
        path=path,
    )
    yield Finding(f"{_SETTINGS}.{number}", f"{setting:g}", expected)


DRIVER = Driver(
    tables=(
        DriverTable(
            "grblhal",
            GrblhalTable,
            lambda file: {"settings": _settings(file)},
            ("settings",),
            _read,
            _rules,
            port="grblhal.port",
            purpose='The connection to a grblHAL controller (`backend = "grblhal"`).',
            parts=(
                TableReference(
                    "grblhal.settings",
                    "Settings of the controller that TurnDesk writes at each connection and reads back: the "
                    "key is the number of the setting (`13` is `$13`), the value is in the controller's "
                    "unit. "
                    "Settings 110 to 132 must cover `vmax`, `amax` and `travel` of their axes.",
                ),
            ),
        ),
    ),
    backend="grblhal",
    spindle="grblhal",
    count_rate=3e5,
)
