"""Reading of a parsed machine file by the declared tables, with defaults for missing values.

The reason for each default is given at its rule. A file is rejected if it lacks a value that has no safe
default. Units are those of the model.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from core.key_declaration import Schema
from core.machine import axis_tables, machine_tables
from core.machine.driver_tables import children_of
from core.machine.machine_model import InputModel, OutputModel
from core.message import Message
from core.table_schema import Driver, Finding, Values, joined, missing, read_table, unknown_keys, written

_NONE = "none"  # terminal of an output that the machine does not have, such as a manual collet
HAND_RAPID = 100 * 25.4 / 60  # mm/s: jog and manual rapid of an OmniTurn, 100 in/min
_DRIVE = 40.0  # Hz, position loop of a slow servo drive, which lags its command by 2 / (2 pi f) s
_LAG = 2.0 / (2.0 * math.pi * _DRIVE)
_C_STARTS = 3.0  # 1/s; 1/3 s to full speed, which a spindle drive without a C ramp can do
_C_SPEED, _C_COUNT = 200 * 6.0, 0.02  # degrees/s and degrees: the C option of a GT-75
_STILL, _STILL_DEGREES = 0.2, 1.0  # mm and degrees, permitted position error at rest
_CLOSES = 0.5  # s; such collets take 0.2 to 0.4 s, and the switch decides
_SLIDES = ("X", "Y", "Z")
Derived = float | None  # None: cannot be derived
TO_BE_SAID = frozenset(("collet.close_s", "axis.C.vmax", "axis.C.count"))


class Reading:
    """Values and findings of one file, and the names of its signals and M codes."""

    def __init__(self, data: Mapping[str, object], drivers: Sequence[Driver]) -> None:
        self.data = data
        self._drivers = drivers
        self.values = Values(_inch(data))
        self.kind = _kind(data)
        self.outputs: list[str] = []
        self.absent: list[str] = []  # outputs that the machine does not have
        self.inputs: list[str] = []
        self.m_codes: list[str] = []
        self.findings = _unknown_tables(data, machine_tables.top_tables(drivers))
        self._read()

    def _read(self) -> None:
        self._table("machine", machine_tables.machine_fields(self._drivers))
        for path, keys in machine_tables.plain_tables(self._drivers):
            if path in machine_tables.TABLES_OF_A_LATHE and self.kind != "lathe":
                self._of_a_lathe(path)
            else:
                self._table(path, keys)
        self._axes()
        io = self._parent("io", ("in", "out", "analog"))
        self.absent, wired = _absent(io.get("out"))
        self.outputs = self._named(wired, "io.out", OutputModel)
        self.inputs = self._named(io.get("in"), "io.in", InputModel)
        self.m_codes = self._m_codes(self.data.get("m_codes", {}))
        self._language()

    def _language(self) -> None:
        """Check the MDI language, whose permitted values depend on the kind of machine."""
        spoken = machine_tables.LANGUAGES[self.kind]
        said = self.values.found.get("machine.language") or spoken[0]
        self.values.found["machine.language"] = said
        if said not in spoken:
            expected = Message(
                "the language must be {spoken} for a {kind}", kind=self.kind, spoken=" or ".join(spoken)
            )
            self.findings.append(Finding("machine.language", written(said), expected, "broken-rule"))

    def _table(self, path: str, keys: Schema) -> None:
        table = self.data.get(path, {} if path in machine_tables.MAY_BE_MISSING else None)
        self._keys(table, path, keys, children_of(self._drivers, path))

    def _keys(self, table: object, path: str, keys: Schema, children: tuple[str, ...] = ()) -> None:
        if table is None:
            self.findings.append(
                Finding(f"[{path}]", "", "this table is missing but required by TurnDesk", "missing")
            )
        else:
            self.findings += read_table(table, keys, path, self.values, children)

    def _parent(self, path: str, known: tuple[str, ...]) -> Mapping[str, object]:
        """Return a table that contains tables, or an empty one if the entry is not a table."""
        table = self.data.get(path, {})
        if not isinstance(table, dict):
            self.findings.append(
                Finding(
                    path,
                    written(table),
                    Message("this entry must be a table, [{path}]", path=path),
                    "not-a-table",
                )
            )
            return {}
        self.findings += unknown_keys(table, list(known), path)
        return table

    def _axes(self) -> None:
        lathe, rotary = self.kind == "lathe", machine_tables.ROTARY[self.kind]
        axes = self._parent("axis", (*machine_tables.SLIDES[self.kind], *(("C",) if lathe else rotary)))
        for name in machine_tables.SLIDES[self.kind]:
            self._homed(axes.get(name), f"axis.{name}", axis_tables.Slide, axis_tables.Home)
        if lathe:
            third = axes.get("C", {})  # most lathes have no C axis and no table for it
            linear = isinstance(third, dict) and third.get("linear") is True
            self._keys(third, "axis.C", axis_tables.ThirdSlide if linear else axis_tables.LatheC)
        for name in rotary:
            if name in axes:
                self._homed(axes[name], f"axis.{name}", axis_tables.RotaryAxis, axis_tables.RotaryHome)

    def _homed(self, table: object, path: str, keys: Schema, home: Schema) -> None:
        """Read the table of an axis and its ``home`` table."""
        self._keys(table, path, keys, ("home",))
        if isinstance(table, dict) and "home" in table:
            self._keys(table["home"], f"{path}.home", home)

    def _of_a_lathe(self, path: str) -> None:
        if path in self.data:
            self.findings.append(
                Finding(f"[{path}]", "", "only a lathe can have this table; remove the table", "lathe-only")
            )
        else:  # the control needs these values for every machine
            self._keys({}, path, machine_tables.TABLES_OF_A_LATHE[path])

    def _m_codes(self, table: object) -> list[str]:
        """Read the M codes that switch an output and those that are ignored; return their names."""
        ignored, switching = _ignored(table)
        names = {*self._named(ignored, "m_codes", machine_tables.IgnoredMCode)}
        names |= {*self._named(switching, "m_codes", machine_tables.MCode)}
        return [name for name in table if name in names] if isinstance(table, dict) else []

    def _named(self, table: object, path: str, keys: Schema) -> list[str]:
        """Read tables with names chosen in the file; return the names."""
        if not isinstance(table, dict):
            self._keys(table, path, ())
            return []
        for name, entry in table.items():
            self._keys(entry, joined(path, name), keys)
        return list(table)


def _inch(data: Mapping[str, object]) -> bool | None:
    """Return whether the file uses inches, or None if its unit is missing or invalid."""
    machine = data.get("machine")
    units = machine.get("units") if isinstance(machine, dict) else None
    return units == "inch" if units in ("inch", "mm") else None


def _kind(data: Mapping[str, object]) -> str:
    """Return the kind of machine; "lathe" if it is missing or invalid."""
    machine = data.get("machine")
    kind = machine.get("kind") if isinstance(machine, dict) else None
    return kind if isinstance(kind, str) and kind in machine_tables.KINDS else "lathe"


def _unknown_tables(data: Mapping[str, object], top: Sequence[str]) -> list[Finding]:
    findings = []
    for found in unknown_keys(data, list(top), ""):
        known = Message(
            "this version of TurnDesk supports the tables {name}",
            name=", ".join(f"[{name}]" for name in top),
        )
        guess = found.expected.removeprefix("unknown key; ")
        near = Message("{guess} ", guess=guess) if guess.startswith("did") else ""
        findings.append(
            Finding(
                Message("[{path}]", path=found.path),
                "",
                Message("unknown table; {nearest}{known}", nearest=near, known=known),
                "unknown-table",
            )
        )
    return findings


def _ignored(table: object) -> tuple[dict[str, object], object]:
    """Return the entries of ignored M codes, and the table without them."""
    if not isinstance(table, dict):
        return {}, table
    ignored: dict[str, object] = {}
    switching: dict[str, object] = {}
    for name, entry in table.items():
        (ignored if isinstance(entry, dict) and "ignored" in entry else switching)[name] = entry
    return ignored, switching


def _absent(outputs: object) -> tuple[list[str], object]:
    """Return the names of outputs that the machine does not have, and the table without them."""
    if not isinstance(outputs, dict):
        return [], outputs
    absent = [name for name, entry in outputs.items() if isinstance(entry, dict) and entry.get("at") == _NONE]
    return absent, {name: entry for name, entry in outputs.items() if name not in absent}


def fill(reading: Reading) -> Iterator[Finding]:
    """Fill in the missing values; yield a finding for each value that has no default.

    A default that depends on an invalid value gives no second finding.
    """
    values = reading.values
    for place, field in values.left_out.items():
        if not _filled(place, reading) and place in TO_BE_SAID:
            yield missing(place, field, values.inch)


def _filled(place: str, reading: Reading) -> bool:
    _, _, key = place.rpartition(".")
    rule = RULES.get(place) or OF_AN_AXIS[key]
    value = rule(reading, place)
    if value is not None:
        reading.values.found[place] = value
    return value is not None


def _of_slides(values: Values, key: str) -> list[float]:
    paths = [f"axis.{name}.{key}" for name in _SLIDES]
    return [values.number(path) for path in paths if values.has(path)]


def _slowest(reading: Reading, _place: str) -> Derived:
    """Return the speed of the slowest linear axis, because a feed may be in any direction."""
    return min(_of_slides(reading.values, "vmax"), default=None)


def _by_hand(reading: Reading, _place: str) -> Derived:
    return min((HAND_RAPID, *_of_slides(reading.values, "vmax")))


def _coarsest(reading: Reading, _place: str) -> Derived:
    """Return the largest count, because a programmed step must be at least one count on every axis."""
    return max(_of_slides(reading.values, "count"), default=None)


def _brakes(reading: Reading, _place: str) -> Derived:
    """Return the acceleration of the spindle.

    Most spindles brake faster, and too long a time only adds a wait.
    """
    return _number(reading.values, "spindle.accel_rpm_s")


def _closes(reading: Reading, _place: str) -> Derived:
    """Return the closing time of the collet.

    It is 0.5 s if a switch confirms a closed collet. Otherwise, the file must specify it.
    """
    return _CLOSES if "collet_closed" in reading.inputs or reading.kind != "lathe" else None


def _neighbour(values: Values, place: str) -> Derived:
    """Return the same key of the first linear axis that has it, because axes usually have equal drives."""
    _, name, key = place.split(".")
    said = [f"axis.{other}.{key}" for other in _SLIDES if name in _SLIDES]
    return next((values.number(p) for p in said if values.has(p) and p not in values.left_out), None)


def _window(reading: Reading, place: str) -> Derived:
    """Return the value of another axis, or twice the lag of a slow drive at full speed."""
    values = reading.values
    vmax = _number(values, place.replace("fe_window", "vmax"))
    return _neighbour(values, place) or (2.0 * _LAG * vmax if vmax else None)


def _arrived(reading: Reading, place: str) -> Derived:
    """Return the value of another axis, or four counts, because a drive at rest moves by one or two.

    For a coarse C, five counts are used.
    """
    values = reading.values
    count = _number(values, place.replace("in_pos", "count"))
    counts = 4.0 if place.split(".")[1] in _SLIDES else 5.0
    return _neighbour(values, place) or (counts * count if count else None)


def _stands(reading: Reading, place: str) -> Derived:
    """Return the standstill tolerance of another axis, or 0.2 mm (1 degree).

    Cutting forces do not move an axis that far.

    The result is at least four in-position windows and at most the following error window.
    """
    values = reading.values
    window = _number(values, place.replace("still_window", "fe_window"))
    arrived = _number(values, place.replace("still_window", "in_pos"))
    if window is None or arrived is None:
        return None
    usual = _STILL if place.split(".")[1] in _SLIDES else _STILL_DEGREES
    return _neighbour(values, place) or min(max(usual, 4.0 * arrived), window)


def _c_speed(reading: Reading, _place: str) -> Derived:
    return None if _c_is_used(reading) else _C_SPEED


def _c_count(reading: Reading, _place: str) -> Derived:
    return None if _c_is_used(reading) else _C_COUNT


def _c_starts(reading: Reading, _place: str) -> Derived:
    """Return an acceleration to full speed in 1/3 s, limited by that of the spindle, which is C."""
    values = reading.values
    spindle, vmax = _number(values, "spindle.accel_rpm_s"), _number(values, "axis.C.vmax")
    return min(6.0 * spindle, _C_STARTS * vmax) if spindle and vmax else None


def _c_is_used(reading: Reading) -> bool:
    return reading.values.has("axis.C.enabled") and reading.values.flag("axis.C.enabled")


def _number(values: Values, path: str) -> Derived:
    return values.number(path) if values.has(path) else None


Rule = Callable[[Reading, str], Derived]
OF_AN_AXIS: dict[str, Rule] = {"fe_window": _window, "in_pos": _arrived, "still_window": _stands}
RULES: dict[str, Rule] = {
    "limits.max_feed": _slowest,
    "limits.manual_rapid": _by_hand,
    "limits.resolution": _coarsest,
    "spindle.decel_rpm_s": _brakes,
    "collet.close_s": _closes,
    "axis.C.vmax": _c_speed,
    "axis.C.count": _c_count,
    "axis.C.amax": _c_starts,
}
