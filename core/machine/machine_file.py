"""Parsing of a machine file with all errors in one report, and comparison of machine files."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from core.input_file import TooLargeError, parse_toml, read_input_text
from core.machine import driver_tables, machine_reading, machine_rules, machine_tables, signal_rules
from core.machine.driver_tables import DriverTableReader, list_existing_tables
from core.machine.machine_model import (
    Axis,
    ClampingModel,
    ColletModel,
    InputModel,
    Interlocks,
    LimitsModel,
    Machine,
    OutputModel,
    SpindleModel,
    Timing,
)
from core.machine.machine_reading import MachineReading
from core.machine.mill_kinematics import KinematicsTableReader
from core.machine.station_rules import check_handwheel, check_jog_buttons, check_palm_buttons
from core.message import Message
from core.secret_values import format_without_secrets
from core.table_schema import DriverDeclaration, FileFinding, MachineFileError, MachineFileReading, join_path

_MAX_BYTES = 16 * 1024 * 1024
_NONE = (-math.inf, math.inf)
_ONE_TURN = (-360.0, 360.0)  # degrees, travel of a C axis that is not modulo
# Keys of the file whose names differ from those of the model's fields.
_AXIS_KEYS = {
    "max_speed": "vmax",
    "max_acceleration": "amax",
    "count_size": "count",
    "following_error_window": "fe_window",
    "following_error_time_s": "fe_time_ms",
    "in_position_tolerance": "in_pos",
    "is_position_absolute": "absolute",
    "standstill_tolerance": "still_window",
    "standstill_time_s": "still_ms",
}
MISSING_VALUE = "—"


def read_machine_text(path: Path) -> str:
    """Return the text of a machine file. Raises MachineFileError if the file cannot be read."""
    try:
        return read_input_text(path, _MAX_BYTES)
    except OSError as error:
        reason = error.strerror or "unreadable"
        code = "too-large" if isinstance(error, TooLargeError) else "unreadable"
        raise MachineFileError(
            [
                FileFinding(
                    "file",
                    "",
                    Message("{reason}; check the file name and its permissions", reason=reason),
                    code,
                )
            ],
            str(path),
        ) from error
    except UnicodeDecodeError as error:
        raise MachineFileError(
            [FileFinding("file", "", "this file is not UTF-8 text; save the file as UTF-8", "not-utf8")],
            str(path),
        ) from error


def parse_machine(text: str, source: str, drivers: Sequence[DriverDeclaration]) -> Machine:
    """Return the machine that the TOML ``text`` and the drivers describe; ``source`` is the file name.

    Raises MachineFileError with all findings if the text has errors.
    """
    return build_machine(parse_tables(text, source), text, source, drivers)


def parse_tables(text: str, source: str) -> dict[str, object]:
    """Return the tables of a machine file. Raises MachineFileError if ``text`` is not valid TOML."""
    try:
        return parse_toml(text)
    except ValueError as error:
        raise MachineFileError([FileFinding("TOML", "", str(error), "not-toml")], source) from error


def build_machine(
    data: Mapping[str, object], text: str, source: str, drivers: Sequence[DriverDeclaration]
) -> Machine:
    """Return the machine that parsed tables describe; ``parse_machine`` does the same for a text."""
    reading = MachineReading(data, drivers)
    untold = [*machine_reading.fill_missing_values(reading)]
    axes, said = _axis_names(reading), signal_rules.map_terminals_by_signal(reading)
    prefixes = tuple(driver.address_prefix for driver in drivers if driver.address_prefix)
    elsewhere = {path: at for path, at in said.items() if at.startswith(prefixes)}
    wired = {path: at for path, at in said.items() if path not in elsewhere}
    file = MachineFileReading(
        data, reading.values, axes, wired, list_existing_tables(data, drivers), elsewhere, prefixes
    )
    added = DriverTableReader(file, drivers)
    rotary = [name for name in axes if name not in machine_tables.LINEAR_AXES[reading.kind]]
    kinematics = KinematicsTableReader(data, reading.values, reading.kind, rotary)
    findings = [
        *reading.findings,
        *untold,
        *added.findings,
        *kinematics.findings,
        *machine_rules.check_rules(reading.values),
        *signal_rules.check_signals(reading),
        *signal_rules.check_shared_terminals(file, drivers),
        *signal_rules.check_potentiometers(file, drivers),
        *signal_rules.check_missing_devices(file),
        *check_handwheel(file),
        *check_jog_buttons(file),
        *check_palm_buttons(file),
        *driver_tables.check_driver_tables(file, drivers),
    ]
    if findings:
        raise MachineFileError(findings, source)
    return replace(_machine(reading, added, kinematics, source), text=text)


def _machine(
    reading: MachineReading, added: DriverTableReader, kinematics: KinematicsTableReader, source: str
) -> Machine:
    values = reading.values
    return Machine(
        name=values.text("machine.name"),
        backend=values.text("machine.backend"),
        axes=_axes(reading),
        is_c_enabled=reading.kind == "lathe" and values.read_flag("axis.C.enabled"),
        has_c_feedback=values.read_flag("c_axis.feedback"),
        spindle=values.make_model(SpindleModel, "spindle"),
        timing=values.make_model(Timing, "machine"),
        limits=values.make_model(LimitsModel, "limits"),
        collet=values.make_model(ColletModel, "collet"),
        interlocks=values.make_model(Interlocks, "interlocks"),
        clamping=values.make_model(ClampingModel, "clamping"),
        tooling_kind=values.text("tooling.kind"),
        silenced_checks=tuple(values.text("checks.silenced").split()),
        outputs={
            name: values.make_model(OutputModel, f"io.out.{name}", name=name) for name in reading.outputs
        },
        missing_outputs=frozenset(reading.missing_outputs),
        inputs={name: values.make_model(InputModel, f"io.in.{name}", name=name) for name in reading.inputs},
        m_code_outputs={
            code: (output, on) for code, output, on in signal_rules.list_enabled_m_codes(reading)
        },
        disabled_m_codes=frozenset(signal_rules.list_disabled_m_codes(reading)),
        ignored_m_codes=frozenset(signal_rules.list_ignored_m_codes(reading)),
        source=source,
        is_inch=bool(values.is_inch),
        kind=reading.kind,
        mdi_language=values.text("machine.language"),
        control_model=values.text("machine.control"),
        third_axis_name=values.text("axis.C.name") if reading.kind == "lathe" else "C",
        is_c_axis_modulo=_c_axis_flag(reading, "modulo") and not _c_axis_flag(reading, "linear"),
        has_separate_c_drive=_c_axis_flag(reading, "own_drive") or _c_axis_flag(reading, "linear"),
        is_third_axis_linear=_c_axis_flag(reading, "linear"),
        hardware=added.build_hardware(reading.outputs),
        kinematics=kinematics.build_model(),
    )


def _axis_names(reading: MachineReading) -> tuple[str, ...]:
    rotary = ("C",) if reading.kind == "lathe" else machine_tables.ROTARY_AXES[reading.kind]
    return (
        *machine_tables.LINEAR_AXES[reading.kind],
        *(name for name in rotary if reading.values.is_specified(f"axis.{name}.vmax")),
    )


def _c_axis_flag(reading: MachineReading, key: str) -> bool:
    """Return a flag of the C axis of a lathe, or False for a mill."""
    return reading.kind == "lathe" and reading.values.read_flag(f"axis.C.{key}")


def _axes(reading: MachineReading) -> tuple[Axis, ...]:
    return tuple(_axis(reading, name) for name in _axis_names(reading))


def _axis(reading: MachineReading, name: str) -> Axis:
    values, path = reading.values, f"axis.{name}"
    homed = values.has_values(f"{path}.home.order")
    of_lathe = name == "C" and reading.kind == "lathe"
    whole = _ONE_TURN if of_lathe and not _c_axis_flag(reading, "modulo") else _NONE
    travel = values.read_pair(f"{path}.travel") if values.has_values(f"{path}.travel") else whole
    slide = name in machine_tables.LINEAR_AXES[reading.kind]
    return values.make_model(
        Axis,
        path,
        _AXIS_KEYS,
        name=name,
        fixed_points=values.read_numbers(f"{path}.fixed_points") if slide else (),
        travel=travel if math.isfinite(travel[0]) else None,
        home_order=values.read_integer(f"{path}.home.order") if homed else 0,
        home_speed=values.read_number(f"{path}.home.speed") if homed else 0.0,
        is_rotary=not slide and not (of_lathe and _c_axis_flag(reading, "linear")),
    )


class KeyChange(NamedTuple):
    """A changed key with its old and new value.

    A value is ``MISSING_VALUE`` if the key is missing in that file.
    """

    path: str
    old: str
    new: str

    def __str__(self) -> str:
        return Message("{path}: {old} → {new}", path=self.path, old=self.old, new=self.new)


def compare_machine_files(old_text: str, new_text: str) -> tuple[KeyChange, ...]:
    """Return every key whose value differs, in the order of the new file, followed by the removed keys.

    Raises ValueError if a text is not valid TOML.
    """
    before, after = dict(_leaves(parse_toml(old_text))), dict(_leaves(parse_toml(new_text)))
    places = [*after, *(place for place in before if place not in after)]
    return tuple(
        KeyChange(place, _shown(before, place), _shown(after, place))
        for place in places
        if place not in before or place not in after or _differ(before[place], after[place])
    )


def _differ(old: object, new: object) -> bool:
    """Return whether two values differ.

    1 and 1.0 are equal, but true is not equal to 1.
    """
    return old != new or isinstance(old, bool) is not isinstance(new, bool)


def _shown(values: Mapping[str, object], place: str) -> str:
    return format_without_secrets(place, values[place]) if place in values else MISSING_VALUE


def _leaves(table: Mapping[str, object], path: str = "") -> Iterator[tuple[str, object]]:
    for key, value in table.items():
        place = join_path(path, key)
        if isinstance(value, dict) and value:
            yield from _leaves(value, place)
        else:
            yield place, value
