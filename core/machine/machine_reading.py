"""Evaluation of a parsed machine file by the declared tables, with defaults for missing values.

The reason for each default is given at its rule. A file is rejected if it lacks a value that has no safe
default. All values are in the units of the model.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from core.key_declaration import KeySchema
from core.machine import axis_tables, machine_tables
from core.machine.driver_tables import list_driver_subtables
from core.machine.machine_model import InputModel, OutputModel
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import (
    DriverDeclaration,
    FileFinding,
    FileValues,
    find_unknown_keys,
    join_path,
    make_missing_finding,
    read_table_values,
)

_NONE = "none"  # terminal of an output that the machine does not have, such as a manual collet
MANUAL_RAPID_MM_S = 100 * 25.4 / 60  # mm/s: jog and manual rapid of an OmniTurn, 100 in/min
_DRIVE = 40.0  # Hz, position loop of a slow servo drive, which lags its command by 2 / (2 pi f) s
_DRIVE_LAG_S = 2.0 / (2.0 * math.pi * _DRIVE)
_C_ACCELERATION_RATE = 3.0  # 1/s; 1/3 s to full speed, which a spindle drive without a C ramp can do
_C_SPEED, _C_COUNT = 200 * 6.0, 0.02  # degrees/s and degrees: the C option of a GT-75
_STILL, _STILL_DEGREES = 0.2, 1.0  # mm and degrees, permitted position error at rest
_COLLET_CLOSE_S = 0.5  # s; such collets take 0.2 to 0.4 s, and the switch decides
_LINEAR_AXIS_NAMES = ("X", "Y", "Z")
DerivedValue = float | None  # None: cannot be derived
REQUIRED_KEYS = frozenset(("collet.close_s", "axis.C.vmax", "axis.C.count"))


class MachineReading:
    """The values and findings of one machine file, and the names of its signals and M codes."""

    def __init__(self, data: Mapping[str, object], drivers: Sequence[DriverDeclaration]) -> None:
        self.data = data
        self._drivers = drivers
        self.values = FileValues(_read_unit(data))
        self.kind = _read_kind(data)
        self.outputs: list[str] = []
        self.missing_outputs: list[str] = []  # outputs that the machine does not have
        self.inputs: list[str] = []
        self.m_codes: list[str] = []
        self.findings = _unknown_tables(data, machine_tables.list_top_level_tables(drivers))
        self._read()

    def _read(self) -> None:
        self._table("machine", machine_tables.get_machine_table_keys(self._drivers))
        for path, keys in machine_tables.list_tables_without_subtables(self._drivers):
            if path in machine_tables.LATHE_TABLES and self.kind != "lathe":
                self._of_a_lathe(path)
            else:
                self._table(path, keys)
        self._axes()
        io = self._read_parent_table("io", ("in", "out", "analog"))
        self.missing_outputs, wired = _split_missing_outputs(io.get("out"))
        self.outputs = self._read_named_tables(wired, "io.out", OutputModel)
        self.inputs = self._read_named_tables(io.get("in"), "io.in", InputModel)
        self.m_codes = self._read_m_codes(self.data.get("m_codes", {}))
        self._check_language()

    def _check_language(self) -> None:
        """Check the MDI language; each kind of machine permits certain languages."""
        spoken = machine_tables.LANGUAGES[self.kind]
        said = self.values.values_by_path.get("machine.language") or spoken[0]
        self.values.values_by_path["machine.language"] = said
        if said not in spoken:
            expected = Message(
                "the language must be {spoken} for a {kind}", kind=self.kind, spoken=" or ".join(spoken)
            )
            self.findings.append(
                FileFinding("machine.language", format_toml_value(said), expected, "broken-rule")
            )

    def _table(self, path: str, keys: KeySchema) -> None:
        table = self.data.get(path, {} if path in machine_tables.OPTIONAL_TABLES else None)
        self._keys(table, path, keys, list_driver_subtables(self._drivers, path))

    def _keys(self, table: object, path: str, keys: KeySchema, children: tuple[str, ...] = ()) -> None:
        if table is None:
            self.findings.append(
                FileFinding(f"[{path}]", "", "this table is missing but required by TurnDesk", "missing")
            )
        else:
            self.findings += read_table_values(table, keys, path, self.values, children)

    def _read_parent_table(self, path: str, known: tuple[str, ...]) -> Mapping[str, object]:
        """Return a table that contains other tables, or an empty table if the entry is not a table."""
        table = self.data.get(path, {})
        if not isinstance(table, dict):
            self.findings.append(
                FileFinding(
                    path,
                    format_toml_value(table),
                    Message("this entry must be a table, [{path}]", path=path),
                    "not-a-table",
                )
            )
            return {}
        self.findings += find_unknown_keys(table, list(known), path)
        return table

    def _axes(self) -> None:
        lathe, rotary = self.kind == "lathe", machine_tables.ROTARY_AXES[self.kind]
        axes = self._read_parent_table(
            "axis", (*machine_tables.LINEAR_AXES[self.kind], *(("C",) if lathe else rotary))
        )
        for name in machine_tables.LINEAR_AXES[self.kind]:
            self._read_axis_with_home(
                axes.get(name), f"axis.{name}", axis_tables.LinearAxisKeys, axis_tables.HomingKeys
            )
        if lathe:
            third = axes.get("C", {})  # most lathes have no C axis and no table for it
            linear = isinstance(third, dict) and third.get("linear") is True
            self._keys(
                third, "axis.C", axis_tables.LinearThirdAxisKeys if linear else axis_tables.LatheCAxisKeys
            )
        for name in rotary:
            if name in axes:
                self._read_axis_with_home(
                    axes[name], f"axis.{name}", axis_tables.RotaryAxisKeys, axis_tables.RotaryHomingKeys
                )

    def _read_axis_with_home(self, table: object, path: str, keys: KeySchema, home: KeySchema) -> None:
        """Read the table of an axis and its ``home`` table."""
        self._keys(table, path, keys, ("home",))
        if isinstance(table, dict) and "home" in table:
            self._keys(table["home"], f"{path}.home", home)

    def _of_a_lathe(self, path: str) -> None:
        if path in self.data:
            self.findings.append(
                FileFinding(
                    f"[{path}]", "", "only a lathe can have this table; remove the table", "lathe-only"
                )
            )
        else:  # the control needs these values for every machine
            self._keys({}, path, machine_tables.LATHE_TABLES[path])

    def _read_m_codes(self, table: object) -> list[str]:
        """Read the M codes that switch an output and the ignored M codes, and return their names."""
        ignored, switching = _split_ignored_codes(table)
        names = {*self._read_named_tables(ignored, "m_codes", machine_tables.IgnoredMCodeKeys)}
        names |= {*self._read_named_tables(switching, "m_codes", machine_tables.MCodeKeys)}
        return [name for name in table if name in names] if isinstance(table, dict) else []

    def _read_named_tables(self, table: object, path: str, keys: KeySchema) -> list[str]:
        """Read tables whose names are chosen in the file, and return these names."""
        if not isinstance(table, dict):
            self._keys(table, path, ())
            return []
        for name, entry in table.items():
            self._keys(entry, join_path(path, name), keys)
        return list(table)


def _read_unit(data: Mapping[str, object]) -> bool | None:
    """Return whether the file uses inches, or None if its unit is missing or invalid."""
    machine = data.get("machine")
    units = machine.get("units") if isinstance(machine, dict) else None
    return units == "inch" if units in ("inch", "mm") else None


def _read_kind(data: Mapping[str, object]) -> str:
    """Return the kind of machine, or "lathe" if it is missing or invalid."""
    machine = data.get("machine")
    kind = machine.get("kind") if isinstance(machine, dict) else None
    return kind if isinstance(kind, str) and kind in machine_tables.MACHINE_KINDS else "lathe"


def _unknown_tables(data: Mapping[str, object], top: Sequence[str]) -> list[FileFinding]:
    findings = []
    for found in find_unknown_keys(data, list(top), ""):
        known = Message(
            "this version of TurnDesk supports the tables {name}",
            name=", ".join(f"[{name}]" for name in top),
        )
        guess = found.expected_value.removeprefix("unknown key; ")
        near = Message("{guess} ", guess=guess) if guess.startswith("did") else ""
        findings.append(
            FileFinding(
                Message("[{path}]", path=found.path),
                "",
                Message("unknown table; {nearest}{known}", nearest=near, known=known),
                "unknown-table",
            )
        )
    return findings


def _split_ignored_codes(table: object) -> tuple[dict[str, object], object]:
    """Return the entries of ignored M codes, and the table without these entries."""
    if not isinstance(table, dict):
        return {}, table
    ignored: dict[str, object] = {}
    switching: dict[str, object] = {}
    for name, entry in table.items():
        (ignored if isinstance(entry, dict) and "ignored" in entry else switching)[name] = entry
    return ignored, switching


def _split_missing_outputs(outputs: object) -> tuple[list[str], object]:
    """Return the names of outputs that the machine lacks, and the table without these outputs."""
    if not isinstance(outputs, dict):
        return [], outputs
    absent = [name for name, entry in outputs.items() if isinstance(entry, dict) and entry.get("at") == _NONE]
    return absent, {name: entry for name, entry in outputs.items() if name not in absent}


def fill_missing_values(reading: MachineReading) -> Iterator[FileFinding]:
    """Fill in the missing values, and yield a finding for each value that has no default.

    A default that depends on an invalid value does not cause a second finding.
    """
    values = reading.values
    for place, field in values.omitted_fields.items():
        if not _filled(place, reading) and place in REQUIRED_KEYS:
            yield make_missing_finding(place, field, values.is_inch)


def _filled(place: str, reading: MachineReading) -> bool:
    _, _, key = place.rpartition(".")
    rule = DEFAULT_RULES.get(place) or AXIS_RULES[key]
    value = rule(reading, place)
    if value is not None:
        reading.values.values_by_path[place] = value
    return value is not None


def _of_slides(values: FileValues, key: str) -> list[float]:
    paths = [f"axis.{name}.{key}" for name in _LINEAR_AXIS_NAMES]
    return [values.read_number(path) for path in paths if values.has_values(path)]


def _slowest_axis_speed(reading: MachineReading, _place: str) -> DerivedValue:
    """Return the maximum speed of the slowest linear axis as the default limit of the feed.

    A feed may be in any direction, so each axis must reach it.
    """
    return min(_of_slides(reading.values, "vmax"), default=None)


def _by_hand(reading: MachineReading, _place: str) -> DerivedValue:
    return min((MANUAL_RAPID_MM_S, *_of_slides(reading.values, "vmax")))


def _coarsest_count(reading: MachineReading, _place: str) -> DerivedValue:
    """Return the largest count size of the linear axes as the default resolution.

    A programmed step must be at least one count on every axis.
    """
    return max(_of_slides(reading.values, "count"), default=None)


def _spindle_acceleration(reading: MachineReading, _place: str) -> DerivedValue:
    """Return the acceleration of the spindle as the default for its deceleration.

    Most spindles decelerate faster than they accelerate. A deceleration time that is too long only makes
    the control wait longer than necessary.
    """
    return _number(reading.values, "spindle.accel_rpm_s")


def _collet_close_time(reading: MachineReading, _place: str) -> DerivedValue:
    """Return the default closing time of the collet: 0.5 s if a switch confirms that it is closed.

    Without such a switch, the file must specify the time.
    """
    return _COLLET_CLOSE_S if "collet_closed" in reading.inputs or reading.kind != "lathe" else None


def _similar_axis_value(values: FileValues, place: str) -> DerivedValue:
    """Return the value of the same key of another linear axis, as the default.

    The first linear axis that specifies the key is used, because axes usually have equal drives.
    """
    _, name, key = place.split(".")
    said = [f"axis.{other}.{key}" for other in _LINEAR_AXIS_NAMES if name in _LINEAR_AXIS_NAMES]
    return next(
        (values.read_number(p) for p in said if values.has_values(p) and p not in values.omitted_fields), None
    )


def _following_error_window(reading: MachineReading, place: str) -> DerivedValue:
    """Return the default following error window, which is that of another axis if specified.

    Otherwise, it is twice the following error of a slow drive at full speed.
    """
    values = reading.values
    vmax = _number(values, place.replace("fe_window", "vmax"))
    return _similar_axis_value(values, place) or (2.0 * _DRIVE_LAG_S * vmax if vmax else None)


def _in_position_window(reading: MachineReading, place: str) -> DerivedValue:
    """Return the default in-position window: that of another axis, or four counts (rotary: five).

    A drive at rest moves by one or two counts. The counts of a rotary axis such as C are coarser.
    """
    values = reading.values
    count = _number(values, place.replace("in_pos", "count"))
    counts = 4.0 if place.split(".")[1] in _LINEAR_AXIS_NAMES else 5.0
    return _similar_axis_value(values, place) or (counts * count if count else None)


def _standstill_tolerance(reading: MachineReading, place: str) -> DerivedValue:
    """Return the default standstill tolerance: that of another axis, or 0.2 mm (1 degree).

    Cutting forces do not move an axis by this distance. The result is at least four in-position windows and
    at most the following error window.
    """
    values = reading.values
    window = _number(values, place.replace("still_window", "fe_window"))
    arrived = _number(values, place.replace("still_window", "in_pos"))
    if window is None or arrived is None:
        return None
    usual = _STILL if place.split(".")[1] in _LINEAR_AXIS_NAMES else _STILL_DEGREES
    return _similar_axis_value(values, place) or min(max(usual, 4.0 * arrived), window)


def _c_speed(reading: MachineReading, _place: str) -> DerivedValue:
    return None if _c_is_used(reading) else _C_SPEED


def _c_count(reading: MachineReading, _place: str) -> DerivedValue:
    return None if _c_is_used(reading) else _C_COUNT


def _c_acceleration(reading: MachineReading, _place: str) -> DerivedValue:
    """Return the default acceleration of the C axis, which reaches full speed in 1/3 s.

    It is limited to the acceleration of the spindle, because the spindle is also the C axis.
    """
    values = reading.values
    spindle, vmax = _number(values, "spindle.accel_rpm_s"), _number(values, "axis.C.vmax")
    return min(6.0 * spindle, _C_ACCELERATION_RATE * vmax) if spindle and vmax else None


def _c_is_used(reading: MachineReading) -> bool:
    return reading.values.has_values("axis.C.enabled") and reading.values.read_flag("axis.C.enabled")


def _number(values: FileValues, path: str) -> DerivedValue:
    return values.read_number(path) if values.has_values(path) else None


DeriveValue = Callable[[MachineReading, str], DerivedValue]
AXIS_RULES: dict[str, DeriveValue] = {
    "fe_window": _following_error_window,
    "in_pos": _in_position_window,
    "still_window": _standstill_tolerance,
}
DEFAULT_RULES: dict[str, DeriveValue] = {
    "limits.max_feed": _slowest_axis_speed,
    "limits.manual_rapid": _by_hand,
    "limits.resolution": _coarsest_count,
    "spindle.decel_rpm_s": _spindle_acceleration,
    "collet.close_s": _collet_close_time,
    "axis.C.vmax": _c_speed,
    "axis.C.count": _c_count,
    "axis.C.amax": _c_acceleration,
}
