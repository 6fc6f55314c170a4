"""Reads a parsed machine file against the declared tables: every value by its path, every finding at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from core.key_declaration import Schema
from core.machine import axis_tables, machine_tables
from core.machine.driver_tables import children_of
from core.machine.machine_model import InputModel, OutputModel
from core.message import Message
from core.table_schema import Driver, Finding, Values, joined, read_table, unknown_keys, written


class Reading:
    """Values and findings of one file, and the names that its owner gave to signals and M codes."""

    def __init__(self, data: Mapping[str, object], drivers: Sequence[Driver]) -> None:
        self.data = data
        self._drivers = drivers
        self.values = Values(_inch(data))
        self.kind = _kind(data)
        self.outputs: list[str] = []
        self.absent: list[str] = []  # outputs of which the file says that there is none
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
        """In which language MDI is typed: the machine's kind decides which it may be."""
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
        """A table that holds tables; an empty one where it is none."""
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
            third = axes.get("C", {})  # most have none: no table, no C
            linear = isinstance(third, dict) and third.get("linear") is True
            self._keys(third, "axis.C", axis_tables.ThirdSlide if linear else axis_tables.LatheC)
        for name in rotary:
            if name in axes:
                self._homed(axes[name], f"axis.{name}", axis_tables.RotaryAxis, axis_tables.RotaryHome)

    def _homed(self, table: object, path: str, keys: Schema, home: Schema) -> None:
        """The table of an axis, and in it how it is homed."""
        self._keys(table, path, keys, ("home",))
        if isinstance(table, dict) and "home" in table:
            self._keys(table["home"], f"{path}.home", home)

    def _of_a_lathe(self, path: str) -> None:
        if path in self.data:
            self.findings.append(
                Finding(f"[{path}]", "", "only a lathe can have this table; remove the table", "lathe-only")
            )
        else:  # what the control asks of every machine stands still on this one
            self._keys({}, path, machine_tables.TABLES_OF_A_LATHE[path])

    def _m_codes(self, table: object) -> list[str]:
        """M codes that switch an output, and those of which the file says that they do nothing."""
        ignored, switching = _ignored(table)
        names = {*self._named(ignored, "m_codes", machine_tables.IgnoredMCode)}
        names |= {*self._named(switching, "m_codes", machine_tables.MCode)}
        return [name for name in table if name in names] if isinstance(table, dict) else []

    def _named(self, table: object, path: str, keys: Schema) -> list[str]:
        """Reads tables under names of the owner's choice; returns those names."""
        if not isinstance(table, dict):
            self._keys(table, path, ())
            return []
        for name, entry in table.items():
            self._keys(entry, joined(path, name), keys)
        return list(table)


def _inch(data: Mapping[str, object]) -> bool | None:
    """Whether the file counts in inches; None where it does not say so rightly: a finding elsewhere."""
    machine = data.get("machine")
    units = machine.get("units") if isinstance(machine, dict) else None
    return units == "inch" if units in ("inch", "mm") else None


def _kind(data: Mapping[str, object]) -> str:
    """Lathe or mill; where the file says neither rightly, which is a finding elsewhere, a lathe."""
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
    """Entries of M codes that do nothing, and the table without them."""
    if not isinstance(table, dict):
        return {}, table
    ignored: dict[str, object] = {}
    switching: dict[str, object] = {}
    for name, entry in table.items():
        (ignored if isinstance(entry, dict) and "ignored" in entry else switching)[name] = entry
    return ignored, switching


_NONE = "none"  # terminal of an output that this machine has not: a collet that is closed by hand


def _absent(outputs: object) -> tuple[list[str], object]:
    """Names of outputs that are said to be absent, and the table without them."""
    if not isinstance(outputs, dict):
        return [], outputs
    absent = [name for name, entry in outputs.items() if isinstance(entry, dict) and entry.get("at") == _NONE]
    return absent, {name: entry for name, entry in outputs.items() if name not in absent}
