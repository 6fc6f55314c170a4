"""The table [sim] of the machine file: real-time option, random seed, faults and tool tips."""

from __future__ import annotations

from collections.abc import Iterator

from core.key_declaration import FileUnit, KeyRange, declare_key, make_key_table
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import (
    DriverDeclaration,
    DriverTable,
    FileFinding,
    MachineFileReading,
    TableDescription,
    read_table_values,
)

FAULT_KINDS = (
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
_AXIS_FAULTS = frozenset(
    ("jam", "encoder_stuck", "runaway", "drive_fault", "loose_gib", "encoder_ripple", "encoder_missed")
)


@make_key_table
class PlannedFault:
    """A scheduled fault, which starts at time ``at`` and lasts ``seconds``.

    A duration of 0 makes the fault permanent. Times are in seconds.
    """

    at: float = declare_key(
        KeyRange(0.0, 1e6, FileUnit.SECONDS), meaning="Time after the start at which the fault occurs."
    )
    what: str = declare_key(choices=FAULT_KINDS, meaning="Fault that occurs.")
    axis: str = declare_key(default="", meaning="Axis that has the fault; only for faults of an axis.")
    value: float = declare_key(
        KeyRange(-1e6, 1e6),
        default=0.0,
        meaning="Size of the fault: mm/s of a runaway, mm of play or encoder error, a fraction for faults "
        "of the spindle, belt and pots.",
    )
    seconds: float = declare_key(
        KeyRange(0.0, 1e6, FileUnit.SECONDS), default=0.0, meaning="Duration of the fault. 0: it remains."
    )
    text: str = declare_key(default="", meaning="Text that the drive reports with the fault.")
    turn: float = declare_key(
        KeyRange(0.1, 1000.0),
        default=5.0,
        meaning="Travel in mm or degrees after which an encoder error repeats.",
    )


class _TipPosition:
    """The axis positions in mm at which a tool tip is at part zero."""

    x: float = declare_key(
        KeyRange(-5000.0, 5000.0, FileUnit.LENGTH),
        meaning="X position of the axis when this tool tip is at part zero (a radius).",
    )
    z: float = declare_key(
        KeyRange(-5000.0, 5000.0, FileUnit.LENGTH),
        meaning="Z position of the axis when this tool tip is at part zero.",
    )


@make_key_table
class SimulatedTable:
    """The settings of the simulated machine."""

    seed: int = declare_key(
        KeyRange(0, 2**31),
        default=1,
        meaning="Seed of the random variation of times; the same seed produces the same run.",
    )
    realtime: bool = declare_key(
        default=False,
        meaning="true: a run without a screen also takes real time. false: it runs as fast as possible.",
    )
    faults: tuple[PlannedFault, ...] = ()
    tips: tuple[tuple[float, float], ...] = ()  # Axis positions when a tip is at part zero, in mm.


def _read(file: MachineFileReading) -> Iterator[FileFinding]:
    for name, kind in (("sim.faults", PlannedFault), ("sim.tips", _TipPosition)):
        entries = file.raw(name)
        if entries is not None and not isinstance(entries, list):
            yield FileFinding(name, format_toml_value(entries), "expected a list of tables, [{...}]")
            continue
        for path, entry in zip(_list_paths(file, name), entries or (), strict=True):
            yield from read_table_values(entry, kind, path, file.file_values)


def _list_paths(file: MachineFileReading, name: str = "sim.faults") -> list[str]:
    """Return the machine-file paths of the entries of a list, numbered from 1."""
    entries = file.raw(name)
    return [f"{name}.{n}" for n in range(1, len(entries) + 1)] if isinstance(entries, list) else []


def _rules(file: MachineFileReading) -> Iterator[FileFinding]:
    values, axes = file.file_values, file.axes
    for path in _list_paths(file):
        if not values.has_values(f"{path}.what", f"{path}.axis"):
            continue
        what, axis = values.text(f"{path}.what"), values.text(f"{path}.axis")
        if what in _AXIS_FAULTS and axis not in axes:
            expected = Message(
                "{what} is an axis fault signal; assign it to one of these axes: {axes}",
                what=what,
                axes=", ".join(axes),
            )
            yield FileFinding(f"{path}.axis", format_toml_value(axis), expected)
        if what not in _AXIS_FAULTS and axis:
            yield FileFinding(
                f"{path}.axis",
                format_toml_value(axis),
                Message("{what} is not an axis fault; remove this key", what=what),
            )


def _read_faults(file: MachineFileReading) -> dict[str, object]:
    """Return the entries of the lists ``faults`` and ``tips`` of the table."""
    values = file.file_values
    tips = (
        (values.read_number(f"{path}.x"), values.read_number(f"{path}.z"))
        for path in _list_paths(file, "sim.tips")
    )
    return {
        "faults": tuple(values.make_model(PlannedFault, path) for path in _list_paths(file)),
        "tips": tuple(tips),
    }


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "sim",
            SimulatedTable,
            _read_faults,
            ("faults", "tips"),
            _read,
            _rules,
            is_always_read=True,
            purpose='The simulated machine (`backend = "sim"`).',
            sub_tables=(
                TableDescription(
                    "[sim.faults]",
                    "A fault of the simulated machine. Write the heading in double square brackets; this "
                    "table may occur any number of times.",
                    PlannedFault,
                ),
                TableDescription(
                    "[sim.tips]",
                    "A tool tip of the simulated machine, for testing a tool setter. The heading may "
                    "occur any number of times.",
                    _TipPosition,
                ),
            ),
        ),
    ),
    backend_name="sim",
    spindle="sim",
    can_orient_spindle=True,
    max_count_rate=1e6,
)
