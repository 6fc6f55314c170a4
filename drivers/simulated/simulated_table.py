"""[sim] of the machine file: the simulation's pace and seed, and what breaks in it by itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from core.message import Message
from core.table_schema import (
    Driver,
    DriverTable,
    Field,
    FileReading,
    Finding,
    Kind,
    TableReference,
    Unit,
    read_table,
    written,
)

if TYPE_CHECKING:
    from drivers.simulators.plant_config import PlannedFault

FAULTS = (
    "jam",
    "encoder_stuck",
    "runaway",
    "drive_fault",
    "loose_gib",
    "encoder_ripple",
    "encoder_missed",
    "belt_slip",
    "spindle_bog",
    "spindle_wander",
    "spindle_ignores_stop",
    "spindle_fault",
    "spindle_never_oriented",
    "collet_sensor_stuck",
    "station_silent",
    "pot_noise",
    "estop",
)
_OF_AN_AXIS = frozenset(
    ("jam", "encoder_stuck", "runaway", "drive_fault", "loose_gib", "encoder_ripple", "encoder_missed")
)
_FIELDS = (
    Field(
        "seed",
        Kind.WHOLE,
        low=0,
        high=2**31,
        default=1,
        meaning="Seed of the random variation of times; the same seed produces the same run.",
    ),
    Field(
        "realtime",
        Kind.FLAG,
        default=False,
        meaning="true: a run without a screen also takes real time. false: it runs as fast as possible.",
    ),
)
_FAULT = (
    Field(
        "at", Kind.NUMBER, Unit.SECONDS, 0.0, 1e6, meaning="Time after the start at which the fault occurs."
    ),
    Field("what", Kind.CHOICE, choices=FAULTS, meaning="Fault that occurs."),
    Field("axis", Kind.TEXT, default="", meaning="Axis that has the fault; only for faults of an axis."),
    Field(
        "value",
        Kind.NUMBER,
        Unit.PLAIN,
        -1e6,
        1e6,
        default=0.0,
        meaning=(
            "Size of the fault: mm/s of a runaway, mm of play or encoder error, a fraction for "
            "faults of the spindle, belt and pots."
        ),
    ),
    Field(
        "seconds",
        Kind.NUMBER,
        Unit.SECONDS,
        0.0,
        1e6,
        default=0.0,
        meaning="Duration of the fault. 0: it remains.",
    ),
    Field("text", Kind.TEXT, default="", meaning="Text that the drive reports with the fault."),
    Field(
        "turn",
        Kind.NUMBER,
        Unit.PLAIN,
        0.1,
        1000.0,
        default=5.0,
        meaning="Travel in mm or degrees after which an encoder error repeats.",
    ),
)


@dataclass(frozen=True, slots=True)
class SimulatedTable:
    """The simulated machine's own settings."""

    seed: int = 1
    realtime: bool = False  # a run without a screen keeps the machine's pace too
    faults: tuple[PlannedFault, ...] = ()
    tips: tuple[tuple[float, float], ...] = ()  # where the slides stand when a tip is on part zero, mm


_TIP = (
    Field(
        "x",
        Kind.NUMBER,
        Unit.LENGTH,
        -5000.0,
        5000.0,
        meaning="X position of the axis when this tool tip is at part zero (a radius).",
    ),
    Field(
        "z",
        Kind.NUMBER,
        Unit.LENGTH,
        -5000.0,
        5000.0,
        meaning="Z position of the axis when this tool tip is at part zero.",
    ),
)


def _read(file: FileReading) -> Iterator[Finding]:
    for name, fields in (("sim.faults", _FAULT), ("sim.tips", _TIP)):
        entries = file.raw(name)
        if entries is not None and not isinstance(entries, list):
            yield Finding(name, written(entries), "expected a list of tables, [{...}]")
            continue
        for path, entry in zip(_paths(file, name), entries or (), strict=True):
            yield from read_table(entry, fields, path, file.values)


def _paths(file: FileReading, name: str = "sim.faults") -> list[str]:
    """Of the entries of a list, counted from 1."""
    entries = file.raw(name)
    return [f"{name}.{n}" for n in range(1, len(entries) + 1)] if isinstance(entries, list) else []


def _rules(file: FileReading) -> Iterator[Finding]:
    values, axes = file.values, file.axes
    for path in _paths(file):
        if not values.has(f"{path}.what", f"{path}.axis"):
            continue
        what, axis = values.text(f"{path}.what"), values.text(f"{path}.axis")
        if what in _OF_AN_AXIS and axis not in axes:
            expected = Message(
                "{what} is an axis fault signal; assign it to one of these axes: {axes}",
                what=what,
                axes=", ".join(axes),
            )
            yield Finding(f"{path}.axis", written(axis), expected)
        if what not in _OF_AN_AXIS and axis:
            yield Finding(
                f"{path}.axis",
                written(axis),
                Message("{what} is not an axis fault; remove this key", what=what),
            )


def _table(file: FileReading) -> SimulatedTable:
    number = file.values.number
    tips = tuple((number(f"{path}.x"), number(f"{path}.z")) for path in _paths(file, "sim.tips"))
    return file.values.model(SimulatedTable, "sim", faults=tuple(_faults(file)), tips=tips)


def _faults(file: FileReading) -> Iterator[PlannedFault]:
    for path in _paths(file):
        from drivers.simulators.plant_config import PlannedFault  # noqa: PLC0415  few files plan any

        yield file.values.model(PlannedFault, path)


DRIVER = Driver(
    tables=(
        DriverTable(
            "sim",
            _FIELDS,
            _table,
            ("faults", "tips"),
            _read,
            _rules,
            always=True,
            purpose='The simulated machine (`backend = "sim"`).',
            parts=(
                TableReference(
                    "[sim.faults]",
                    "A fault of the simulated machine. Write the heading in double square brackets; this "
                    "table may occur any number of times.",
                    _FAULT,
                ),
                TableReference(
                    "[sim.tips]",
                    "A tool tip of the simulated machine, for testing a tool setter. The heading may "
                    "occur any number of times.",
                    _TIP,
                ),
            ),
        ),
    ),
    backend="sim",
    spindle="sim",
    orients=True,
    count_rate=1e6,
)
