"""[grblhal] of the machine file: the controller's port, and the settings that are written to it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, FileReading, Finding, Kind, expected_table, written

_SETTINGS, _WHEEL, _GUARD = "grblhal.settings", "io.analog.handwheel", "io.in.guard.at"
_FIELDS = (
    Field("port", Kind.TEXT),
    Field("baud", Kind.WHOLE, low=110, high=4_000_000, default=115_200),
    Field("x_mode", Kind.CHOICE, choices=("G7", "G8"), default="G8"),
)
# What a controller on a lathe has to be told, and nothing else.
_NEEDED = ((13, 0, "reports in mm; in inches they have too few decimals"), (32, 2, "lathe mode"))
_AXES = {"X": 0, "Y": 1, "Z": 2}
# Settings by their first number: what is compared, the factor from the model's unit to the controller's.
_LIMITS = ((110, "vmax", 60.0, "mm/min"), (120, "amax", 1.0, "mm/s²"))
_TRAVEL = 130


@dataclass(frozen=True, slots=True)
class GrblhalTable:
    """A motion controller with its own planner. ``settings`` are written at each connection and read back."""

    port: str  # a serial device, or tcp://host:port
    baud: int
    x_mode: str  # G8, radius
    settings: Mapping[int, float | str]


def _read(file: FileReading) -> Iterator[Finding]:
    table = file.raw(_SETTINGS)
    if table is not None and not isinstance(table, dict):
        yield expected_table(_SETTINGS, table)
        return
    for key, value in (table or {}).items():
        if not key.isdecimal():
            expected = "expected the number of a setting: 13 for $13"
            yield Finding(f"{_SETTINGS}.{key}", written(value), expected)
        elif not _is_setting(value):
            yield Finding(f"{_SETTINGS}.{key}", written(value), "expected a number or a text")


def _is_setting(value: object) -> bool:
    return isinstance(value, int | float | str) and not isinstance(value, bool)


def _settings(file: FileReading) -> dict[int, float | str]:
    """The good ones."""
    table = file.raw(_SETTINGS)
    entries = table.items() if isinstance(table, dict) else ()
    return {int(key): value for key, value in entries if key.isdecimal() and _is_setting(value)}


def _table(file: FileReading) -> GrblhalTable:
    return file.values.model(GrblhalTable, "grblhal", settings=_settings(file))


def _rules(file: FileReading) -> Iterator[Finding]:
    values, settings = file.values, _settings(file)
    if "handwheel" in file.names("io.analog") and values.says("machine.backend", "grblhal"):
        yield Finding(_WHEEL, "", "this backend has no input that counts; take it out")
    if values.says("machine.backend", "grblhal"):
        yield from _guard(file)
    for axis in file.axes:
        if axis in _AXES:
            yield from _outside(file, settings, axis)
    for number, value, why in _NEEDED:
        if settings.get(number, value) != value:
            yield Finding(f"{_SETTINGS}.{number}", written(settings[number]), f"expected {value}: {why}")
    if values.says("grblhal.x_mode", "G7"):
        yield Finding("grblhal.x_mode", '"G7"', 'expected "G8": a reset would change what X means')


def _guard(file: FileReading) -> Iterator[Finding]:
    """A guard that stops the cycle at an input that is not read while the axes move."""
    values, path = file.values, "interlocks.guard_stops"
    stops = values.has(path, _GUARD) and values.flag(path)
    if stops and values.text(_GUARD).startswith("in."):
        expected = 'expected the door input, "pn.D": auxiliary inputs are read at a standstill only'
        yield Finding(_GUARD, written(values.text(_GUARD)), expected, "broken-rule")


def _outside(file: FileReading, settings: Mapping[int, float | str], axis: str) -> Iterator[Finding]:
    """An axis that could be sent where the controller does not go, by the settings that the file gives it."""
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
    expected = f"expected {needed:.6g} {unit} or more, for {path}"
    yield Finding(f"{_SETTINGS}.{number}", f"{setting:g}", expected)


DRIVER = Driver(
    tables=(DriverTable("grblhal", _FIELDS, _table, ("settings",), _read, _rules, port="grblhal.port"),),
    backend="grblhal",
    spindle="grblhal",
    count_rate=3e5,
)
