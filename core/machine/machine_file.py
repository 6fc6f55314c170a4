"""Reading of a machine file with all its errors in one pass, and comparison of two machine files."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from core.input_file import TooLargeError, input_text, toml_tables
from core.machine import driver_tables, machine_reading, machine_rules, machine_tables, signal_rules
from core.machine.driver_tables import DriverReading, tables_there
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
from core.machine.machine_reading import Reading
from core.machine.mill_kinematics import KinematicsReading
from core.machine.station_rules import wrong_jog, wrong_palms, wrong_wheel
from core.message import Message
from core.table_schema import Driver, FileReading, Finding, MachineFileError, joined, written_openly

_MOST_BYTES = 16 * 1024 * 1024
_NONE = (-math.inf, math.inf)
_ONE_TURN = (-360.0, 360.0)  # degrees, travel of a C axis that is not modulo
# Keys of the file whose names differ from those of the model's fields.
_AXIS_KEYS = {
    "following_window": "fe_window",
    "following_time": "fe_time_ms",
    "in_position": "in_pos",
    "still_time": "still_ms",
}
ABSENT = "—"


def text_of(path: Path) -> str:
    """Return the text of a machine file. Raises MachineFileError if it cannot be read."""
    try:
        return input_text(path, _MOST_BYTES)
    except OSError as error:
        reason = error.strerror or "unreadable"
        code = "too-large" if isinstance(error, TooLargeError) else "unreadable"
        raise MachineFileError(
            [
                Finding(
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
            [Finding("file", "", "this file is not UTF-8 text; save the file as UTF-8", "not-utf8")],
            str(path),
        ) from error


def parse_machine(text: str, source: str, drivers: Sequence[Driver]) -> Machine:
    """Return the machine described by the TOML ``text`` and the given drivers; ``source`` is its file name.

    Raises MachineFileError with all findings if the text has errors.
    """
    return machine_of(parse_tables(text, source), text, source, drivers)


def parse_tables(text: str, source: str) -> dict[str, object]:
    """Return the tables of a machine file. Raises MachineFileError if ``text`` is not TOML."""
    try:
        return toml_tables(text)
    except ValueError as error:
        raise MachineFileError([Finding("TOML", "", str(error), "not-toml")], source) from error


def machine_of(data: Mapping[str, object], text: str, source: str, drivers: Sequence[Driver]) -> Machine:
    """Return the machine described by parsed tables, as ``parse_machine`` does."""
    reading = Reading(data, drivers)
    untold = [*machine_reading.fill(reading)]
    axes, said = _axis_names(reading), signal_rules.terminals(reading)
    prefixes = tuple(driver.prefix for driver in drivers if driver.prefix)
    elsewhere = {path: at for path, at in said.items() if at.startswith(prefixes)}
    wired = {path: at for path, at in said.items() if path not in elsewhere}
    file = FileReading(data, reading.values, axes, wired, tables_there(data, drivers), elsewhere, prefixes)
    added = DriverReading(file, drivers)
    rotary = [name for name in axes if name not in machine_tables.SLIDES[reading.kind]]
    kinematics = KinematicsReading(data, reading.values, reading.kind, rotary)
    findings = [
        *reading.findings,
        *untold,
        *added.findings,
        *kinematics.findings,
        *machine_rules.broken(reading.values),
        *signal_rules.broken(reading),
        *signal_rules.shared(file, drivers),
        *signal_rules.pots(file, drivers),
        *signal_rules.absent_devices(file),
        *wrong_wheel(file),
        *wrong_jog(file),
        *wrong_palms(file),
        *driver_tables.broken(file, drivers),
    ]
    if findings:
        raise MachineFileError(findings, source)
    return replace(_machine(reading, added, kinematics, source), text=text)


def _machine(reading: Reading, added: DriverReading, kinematics: KinematicsReading, source: str) -> Machine:
    values = reading.values
    return Machine(
        name=values.text("machine.name"),
        backend=values.text("machine.backend"),
        axes=_axes(reading),
        c_enabled=reading.kind == "lathe" and values.flag("axis.C.enabled"),
        c_feedback=values.flag("c_axis.feedback"),
        spindle=values.model(SpindleModel, "spindle"),
        timing=values.model(Timing, "machine"),
        limits=values.model(LimitsModel, "limits"),
        collet=values.model(ColletModel, "collet"),
        interlocks=values.model(Interlocks, "interlocks"),
        clamping=values.model(ClampingModel, "clamping"),
        tooling=values.text("tooling.kind"),
        silenced=tuple(values.text("checks.silenced").split()),
        outputs={name: values.model(OutputModel, f"io.out.{name}", name=name) for name in reading.outputs},
        absent=frozenset(reading.absent),
        inputs={name: values.model(InputModel, f"io.in.{name}", name=name) for name in reading.inputs},
        m_codes={code: (output, on) for code, output, on in signal_rules.enabled_codes(reading)},
        m_disabled=frozenset(signal_rules.disabled_codes(reading)),
        m_ignored=frozenset(signal_rules.ignored_codes(reading)),
        source=source,
        inch=bool(values.inch),
        kind=reading.kind,
        language=values.text("machine.language"),
        control=values.text("machine.control"),
        third_axis=values.text("axis.C.name") if reading.kind == "lathe" else "C",
        c_modulo=_of_c(reading, "modulo") and not _of_c(reading, "linear"),
        c_own_drive=_of_c(reading, "own_drive") or _of_c(reading, "linear"),
        c_linear=_of_c(reading, "linear"),
        hardware=added.hardware(reading.outputs),
        kinematics=kinematics.model(),
    )


def _axis_names(reading: Reading) -> tuple[str, ...]:
    rotary = ("C",) if reading.kind == "lathe" else machine_tables.ROTARY[reading.kind]
    return (
        *machine_tables.SLIDES[reading.kind],
        *(name for name in rotary if reading.values.stated(f"axis.{name}.vmax")),
    )


def _of_c(reading: Reading, key: str) -> bool:
    """Return a flag of the C axis of a lathe; False for a mill."""
    return reading.kind == "lathe" and reading.values.flag(f"axis.C.{key}")


def _axes(reading: Reading) -> tuple[Axis, ...]:
    return tuple(_axis(reading, name) for name in _axis_names(reading))


def _axis(reading: Reading, name: str) -> Axis:
    values, path = reading.values, f"axis.{name}"
    homed = values.has(f"{path}.home.order")
    of_lathe = name == "C" and reading.kind == "lathe"
    whole = _ONE_TURN if of_lathe and not _of_c(reading, "modulo") else _NONE
    travel = values.pair(f"{path}.travel") if values.has(f"{path}.travel") else whole
    slide = name in machine_tables.SLIDES[reading.kind]
    return values.model(
        Axis,
        path,
        _AXIS_KEYS,
        name=name,
        fixed_points=values.numbers(f"{path}.fixed_points") if slide else (),
        travel=travel if math.isfinite(travel[0]) else None,
        home_order=values.whole(f"{path}.home.order") if homed else 0,
        home_speed=values.number(f"{path}.home.speed") if homed else 0.0,
        rotary=not slide and not (of_lathe and _of_c(reading, "linear")),
    )


class Change(NamedTuple):
    """A changed key with its old and new value; ``ABSENT`` if the key is missing on that side."""

    path: str
    old: str
    new: str

    def __str__(self) -> str:
        return Message("{path}: {old} → {new}", path=self.path, old=self.old, new=self.new)


def changes(old: str, new: str) -> tuple[Change, ...]:
    """Return every key whose value differs, in the order of the new file, then the removed keys.

    Raises ValueError if a text is not valid TOML.
    """
    before, after = dict(_leaves(toml_tables(old))), dict(_leaves(toml_tables(new)))
    places = [*after, *(place for place in before if place not in after)]
    return tuple(
        Change(place, _shown(before, place), _shown(after, place))
        for place in places
        if place not in before or place not in after or _differ(before[place], after[place])
    )


def _differ(old: object, new: object) -> bool:
    """Return whether two values differ. 1 and 1.0 are equal, but true is not equal to 1."""
    return old != new or isinstance(old, bool) is not isinstance(new, bool)


def _shown(values: Mapping[str, object], place: str) -> str:
    return written_openly(place, values[place]) if place in values else ABSENT


def _leaves(table: Mapping[str, object], path: str = "") -> Iterator[tuple[str, object]]:
    for key, value in table.items():
        place = joined(path, key)
        if isinstance(value, dict) and value:
            yield from _leaves(value, place)
        else:
            yield place, value
