"""Table [sim] of the machine file: pace, random seed and scheduled faults of the simulated machine."""

from __future__ import annotations

from collections.abc import Iterator

from core.key_declaration import Range, Unit, file_key, key_table
from core.message import Message
from core.table_schema import Driver, DriverTable, FileReading, Finding, TableReference, read_table, written

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


@key_table
class PlannedFault:
    """Scheduled fault that starts at ``at`` and lasts ``seconds``; 0 makes it permanent."""

    at: float = file_key(
        Range(0.0, 1e6, Unit.SECONDS), meaning="Time after the start at which the fault occurs."
    )
    what: str = file_key(choices=FAULTS, meaning="Fault that occurs.")
    axis: str = file_key(default="", meaning="Axis that has the fault; only for faults of an axis.")
    value: float = file_key(
        Range(-1e6, 1e6),
        default=0.0,
        meaning="Size of the fault: mm/s of a runaway, mm of play or encoder error, a fraction for faults "
        "of the spindle, belt and pots.",
    )
    seconds: float = file_key(
        Range(0.0, 1e6, Unit.SECONDS), default=0.0, meaning="Duration of the fault. 0: it remains."
    )
    text: str = file_key(default="", meaning="Text that the drive reports with the fault.")
    turn: float = file_key(
        Range(0.1, 1000.0),
        default=5.0,
        meaning="Travel in mm or degrees after which an encoder error repeats.",
    )


class _Tip:
    """Axis positions in mm at which a tool tip is at part zero."""

    x: float = file_key(
        Range(-5000.0, 5000.0, Unit.LENGTH),
        meaning="X position of the axis when this tool tip is at part zero (a radius).",
    )
    z: float = file_key(
        Range(-5000.0, 5000.0, Unit.LENGTH),
        meaning="Z position of the axis when this tool tip is at part zero.",
    )


@key_table
class SimulatedTable:
    """Settings of the simulated machine."""

    seed: int = file_key(
        Range(0, 2**31),
        default=1,
        meaning="Seed of the random variation of times; the same seed produces the same run.",
    )
    realtime: bool = file_key(
        default=False,
        meaning="true: a run without a screen also takes real time. false: it runs as fast as possible.",
    )
    faults: tuple[PlannedFault, ...] = ()
    tips: tuple[tuple[float, float], ...] = ()  # Axis positions when a tip is at part zero, in mm.


def _read(file: FileReading) -> Iterator[Finding]:
    for name, kind in (("sim.faults", PlannedFault), ("sim.tips", _Tip)):
        entries = file.raw(name)
        if entries is not None and not isinstance(entries, list):
            yield Finding(name, written(entries), "expected a list of tables, [{...}]")
            continue
        for path, entry in zip(_paths(file, name), entries or (), strict=True):
            yield from read_table(entry, kind, path, file.values)


def _paths(file: FileReading, name: str = "sim.faults") -> list[str]:
    """Return the paths of the entries of a list, counted from 1."""
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


def _listed(file: FileReading) -> dict[str, object]:
    """Return the entries of the lists ``faults`` and ``tips``."""
    values = file.values
    tips = ((values.number(f"{path}.x"), values.number(f"{path}.z")) for path in _paths(file, "sim.tips"))
    return {
        "faults": tuple(values.model(PlannedFault, path) for path in _paths(file)),
        "tips": tuple(tips),
    }


DRIVER = Driver(
    tables=(
        DriverTable(
            "sim",
            SimulatedTable,
            _listed,
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
                    PlannedFault,
                ),
                TableReference(
                    "[sim.tips]",
                    "A tool tip of the simulated machine, for testing a tool setter. The heading may "
                    "occur any number of times.",
                    _Tip,
                ),
            ),
        ),
    ),
    backend="sim",
    spindle="sim",
    orients=True,
    count_rate=1e6,
)
