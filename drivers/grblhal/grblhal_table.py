"""Table [grblhal] of the machine file, which contains the port and the settings of the controller."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field

from core.key_declaration import KeyRange, declare_key, make_key_table
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import (
    DriverDeclaration,
    DriverTable,
    FileFinding,
    MachineFileReading,
    TableDescription,
    make_table_finding,
)

_SETTINGS, _WHEEL, _GUARD = "grblhal.settings", "io.analog.handwheel", "io.in.guard.at"
# Required values of settings on a lathe.
_REQUIRED_SETTINGS = (
    (13, 0, "reports must be in mm, because reports in inches have too few decimals"),
    (32, 2, "lathe mode"),
)
_AXES = {"X": 0, "Y": 1, "Z": 2}
# First number of each group of settings, the compared key, and the factor to the controller's unit.
_LIMITS = ((110, "vmax", 60.0, "mm/min"), (120, "amax", 1.0, "mm/s²"))
_TRAVEL = 130


@make_key_table
class GrblhalTable:
    """Port and settings of a motion controller that plans its own motion.

    The settings are written each time the driver connects.
    """

    port: str = declare_key(meaning="Serial port of the controller, or its address as `tcp://host:port`.")
    baud: int = declare_key(KeyRange(110, 4_000_000), default=115_200, meaning="Bit rate of the serial port.")
    x_mode: str = declare_key(
        default="G8",
        choices=("G7", "G8"),
        meaning='How the controller reads X. "G8": a radius, which is the only accepted value.',
    )
    settings: Mapping[int, float | str] = field(default_factory=dict)


def _read(file: MachineFileReading) -> Iterator[FileFinding]:
    table = file.raw(_SETTINGS)
    if table is not None and not isinstance(table, dict):
        yield make_table_finding(_SETTINGS, table)
        return
    for key, value in (table or {}).items():
        if not key.isdecimal():
            expected = "the key must be a setting number, such as 13 for $13"
            yield FileFinding(f"{_SETTINGS}.{key}", format_toml_value(value), expected)
        elif not _is_setting(value):
            yield FileFinding(
                f"{_SETTINGS}.{key}", format_toml_value(value), "the setting must be a number or text"
            )


def _is_setting(value: object) -> bool:
    return isinstance(value, int | float | str) and not isinstance(value, bool)


def _read_settings(file: MachineFileReading) -> dict[int, float | str]:
    """Return the valid entries of the settings table, with the setting numbers as keys."""
    table = file.raw(_SETTINGS)
    entries = table.items() if isinstance(table, dict) else ()
    return {int(key): value for key, value in entries if key.isdecimal() and _is_setting(value)}


def _rules(file: MachineFileReading) -> Iterator[FileFinding]:
    values, settings = file.file_values, _read_settings(file)
    if "handwheel" in file.list_table_keys("io.analog") and values.has_text("machine.backend", "grblhal"):
        yield FileFinding(_WHEEL, "", "this backend does not have a counter input; remove this entry")
    if values.has_text("machine.backend", "grblhal"):
        yield from _check_guard(file)
    for axis in file.axes:
        if axis in _AXES:
            yield from _check_travel(file, settings, axis)
    for number, value, why in _REQUIRED_SETTINGS:
        if settings.get(number, value) != value:
            yield FileFinding(
                f"{_SETTINGS}.{number}",
                format_toml_value(settings[number]),
                Message("this value must be {details}; {why}", details=value, why=why),
            )
    if values.has_text("grblhal.x_mode", "G7"):
        yield FileFinding(
            "grblhal.x_mode",
            '"G7"',
            'the X mode must be "G8", because a reset would change the meaning of X',
        )


def _check_guard(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield a finding if a cycle-stopping guard uses an input that is readable only at standstill."""
    values, path = file.file_values, "interlocks.guard_stops"
    stops = values.has_values(path, _GUARD) and values.read_flag(path)
    if stops and values.text(_GUARD).startswith("in."):
        expected = (
            'this input must be the door input, "pn.D", because auxiliary inputs are read only at standstill'
        )
        yield FileFinding(_GUARD, format_toml_value(values.text(_GUARD)), expected, "broken-rule")


def _check_travel(
    file: MachineFileReading, settings: Mapping[int, float | str], axis: str
) -> Iterator[FileFinding]:
    """Yield findings about axes whose limits exceed the limits in the controller's settings."""
    values, offset = file.file_values, _AXES[axis]
    for first, key, factor, unit in _LIMITS:
        path = f"axis.{axis}.{key}"
        if values.has_values(path):
            yield from _too_small(settings, first + offset, values.read_number(path) * factor, path, unit)
    path = f"axis.{axis}.travel"
    if values.has_values(path):
        low, high = values.read_pair(path)
        yield from _too_small(settings, _TRAVEL + offset, high - low, path, "mm")


def _too_small(
    settings: Mapping[int, float | str], number: int, needed: float, path: str, unit: str
) -> Iterator[FileFinding]:
    setting = settings.get(number)
    if isinstance(setting, str) or setting is None or setting >= needed * (1 - 1e-6):
        return
    expected = Message(
        "the setting must be at least {needed} {unit} for {path}",
        needed=f"{needed:.6g}",
        unit=unit,
        path=path,
    )
    yield FileFinding(f"{_SETTINGS}.{number}", f"{setting:g}", expected)


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "grblhal",
            GrblhalTable,
            lambda file: {"settings": _read_settings(file)},
            ("settings",),
            _read,
            _rules,
            serial_port_key="grblhal.port",
            purpose='The connection to a grblHAL controller (`backend = "grblhal"`).',
            sub_tables=(
                TableDescription(
                    "grblhal.settings",
                    "Settings of the controller that TurnDesk writes at each connection and reads back: the "
                    "key is the number of the setting (`13` is `$13`), the value is in the controller's "
                    "unit. "
                    "Settings 110 to 132 must cover `vmax`, `amax` and `travel` of their axes.",
                ),
            ),
        ),
    ),
    backend_name="grblhal",
    spindle="grblhal",
    max_count_rate=3e5,
)
