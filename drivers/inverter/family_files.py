"""Reader and checker of TOML files that describe inverter families.

The folder ``families`` contains the families that are shipped. The machine file may name another file,
relative to its own folder.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from core.input_file import MB, input_text, toml_tables
from core.key_declaration import keys_of
from core.message import Message, join_messages
from core.ports import DriverError
from core.table_schema import Finding, Values, expected_table, joined, read_table, written
from drivers.inverter import family_rules
from drivers.inverter.family_table import (
    COMMANDS,
    MODBUS,
    STATES,
    CodeKeys,
    CommandKeys,
    CurrentKeys,
    FamilyKeys,
    FamilyTable,
    FrequencyKeys,
    LimitKeys,
    LineKeys,
    ParameterKeys,
    ReadKeys,
    RegisterTable,
    StateKeys,
    TopKeys,
    WriteKeys,
)
from drivers.inverter.inverter_table import FAMILIES, FOLDER

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_Keys = TypeVar("_Keys", bound="DataclassInstance")
_OPTIONAL = {"highest": TopKeys, "limits": LimitKeys}
_REPORT: Mapping[str, type] = {
    "output": FrequencyKeys,
    "setpoint": FrequencyKeys,
    "current": CurrentKeys,
    **dict.fromkeys(STATES, StateKeys),
    "fault_code": CodeKeys,
}
_OF_MODBUS = ("frequency", "command", "read", "report", "faults")


def family_table(name: str, folder: Path) -> FamilyTable:
    """Return a shipped family by its name, or that of a file in ``folder``.

    Raises DriverError as ``read_family`` does.
    """
    return read_family(FOLDER / f"{name}.toml" if name in FAMILIES else folder / name)


def read_family(path: Path) -> FamilyTable:
    """Return the family of a TOML file.

    Raises DriverError, reason ``bad-family``, with file, line, key and remedy for each finding.
    """
    try:
        text = input_text(path, MB)
        reading = _Reading(toml_tables(text))
    except (OSError, ValueError) as error:
        cause = error.strerror if isinstance(error, OSError) else error
        raise DriverError(
            "{file} cannot be read: {cause}", reason="bad-family", file=path, cause=cause
        ) from error
    if not reading.findings:
        table = reading.family()
        reading.findings += family_rules.broken(table)
    if reading.findings:
        raise _refusal(path, text, reading.findings)
    return table


def _refusal(path: Path, text: str, findings: Iterable[Finding]) -> DriverError:
    lines = _lines_of(text)
    parts = [
        Message("{file}, line {line}: {finding}", file=path, line=_line(lines, each.path), finding=str(each))
        for each in findings
    ]
    return DriverError(join_messages("; ", parts), reason="bad-family")


# --- Line numbers of keys.


_HEAD = re.compile(r"\s*(\[\[?)\s*([\w.-]+)\s*\]")
_KEY = re.compile(r"""\s*["']?([\w.-]+)["']?\s*=""")
_LAST = re.compile(r"(\.?[^.\[\]]+|\[\d+\])$")


def _lines_of(text: str) -> dict[str, int]:
    """Return the line of each table and key by its path, such as ``read[2].count``."""
    lines: dict[str, int] = {}
    times = Counter[str]()
    table = ""
    for number, line in enumerate(text.splitlines(), 1):
        if head := _HEAD.match(line):
            table = head[2]
            if head[1] == "[[":
                times[table] += 1
                table = f"{table}[{times[table]}]"
            lines.setdefault(table, number)
        elif key := _KEY.match(line):
            lines.setdefault(joined(table, key[1]), number)
    return lines


def _line(lines: Mapping[str, int], path: str) -> int:
    """Return the line of a key, or of the innermost enclosing table that exists."""
    while path and path not in lines:
        path = _LAST.sub("", path)
    return lines.get(path, 1)


# --- Keys and values.


class _Reading:
    """Reader of one file that collects the findings about its keys and values."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._data = data
        self._values = Values(False)
        self._faults: dict[int, str] = {}
        self.findings: list[Finding] = []
        self._modbus = data.get("protocol") != "huanyang"
        children = ("line", "parameter", *_OPTIONAL, *(_OF_MODBUS if self._modbus else ()))
        self.findings += read_table(data, FamilyKeys, "", self._values, children)
        self._table("line", LineKeys)
        self._rows("parameter", ParameterKeys)
        for path, keys in _OPTIONAL.items():
            if path in data:
                self._table(path, keys)
        if self._modbus:
            self._read_registers()

    def _read_registers(self) -> None:
        self._table("frequency", FrequencyKeys)
        self._table("command", CommandKeys, COMMANDS)
        for name in COMMANDS if self._is_table("command") else ():
            self._rows(f"command.{name}", WriteKeys, self._data["command"].get(name), needed=True)
        self._rows("read", ReadKeys, needed=True)
        self._table("report", (), tuple(_REPORT))
        for name, keys in _REPORT.items() if self._is_table("report") else ():
            if name != "fault" or name in self._data["report"]:
                self._table(f"report.{name}", keys, raw=self._data["report"].get(name))
        if self._is_table("faults"):
            self._read_faults(self._data["faults"])
        elif "faults" in self._data:
            self.findings.append(expected_table("faults", self._data["faults"]))

    def _is_table(self, path: str) -> bool:
        return isinstance(self._data.get(path), dict)

    def _table(
        self, path: str, keys: type | tuple[()], children: tuple[str, ...] = (), raw: object = None
    ) -> None:
        raw = self._data.get(path) if raw is None else raw
        if raw is None:
            self.findings.append(Finding(path, "", "this table is missing; add the table", "missing"))
        else:
            self.findings += read_table(raw, keys, path, self._values, children)

    def _rows(self, path: str, keys: type, raw: object = None, *, needed: bool = False) -> None:
        """Read a list of tables; with ``needed``, the list must have at least one entry."""
        raw = (self._data.get(path) if raw is None else raw) or []
        if not isinstance(raw, list) or (needed and not raw):
            text = "expected a list of tables, such as [{ register = 0x2000, value = 1 }]"
            self.findings.append(Finding(path, written(raw) if raw else "", text, "wrong-value"))
            return
        for number, row in enumerate(raw, 1):
            self.findings += read_table(row, keys, f"{path}[{number}]", self._values)

    def _read_faults(self, raw: Mapping[str, Any]) -> None:
        for key, text in raw.items():
            place = f"faults.{key}"
            code = _whole(key)
            if code is None or not 0 < code <= 0xFFFF:
                why = "the key must be a fault code, 1…65535 or 0x1…0xFFFF"
                self.findings.append(Finding(place, "", why, "wrong-value"))
            elif code in self._faults:
                why = "this fault code appears twice; remove one of them"
                self.findings.append(Finding(place, "", why, "broken-rule"))
            elif not isinstance(text, str) or not text.strip():
                why = "expected nonblank text in quotation marks"
                self.findings.append(Finding(place, written(text), why, "wrong-value"))
            else:
                self._faults[code] = text

    def family(self) -> FamilyTable:
        """Return the family, if its keys have no findings."""
        return FamilyTable(
            name=self._values.text("name"),
            protocol=self._values.text("protocol"),
            line=self._values.model(LineKeys, "line"),
            parameters=self._models("parameter", ParameterKeys),
            top=self._optional("highest", TopKeys),
            limits=self._optional("limits", LimitKeys) or LimitKeys(),
            registers=self._registers() if self._values.says("protocol", MODBUS) else None,
        )

    def _registers(self) -> RegisterTable:
        values, states = self._values, [name for name in STATES if name in self._data["report"]]
        return RegisterTable(
            frequency=values.model(FrequencyKeys, "frequency"),
            sending=values.model(CommandKeys, "command"),
            commands={name: self._models(f"command.{name}", WriteKeys) for name in COMMANDS},
            reads=self._models("read", ReadKeys),
            output=values.model(FrequencyKeys, "report.output"),
            setpoint=values.model(FrequencyKeys, "report.setpoint"),
            current=values.model(CurrentKeys, "report.current"),
            states={name: values.model(StateKeys, f"report.{name}") for name in states},
            code=values.model(CodeKeys, "report.fault_code"),
            faults=self._faults,
        )

    def _optional(self, path: str, keys: type[_Keys]) -> _Keys | None:
        return self._values.model(keys, path) if path in self._data else None

    def _models(self, path: str, keys: type[_Keys]) -> tuple[_Keys, ...]:
        first = keys_of(keys)[0].key
        places: list[str] = []
        while f"{path}[{len(places) + 1}].{first}" in self._values.found:
            places.append(f"{path}[{len(places) + 1}]")
        return tuple(self._values.model(keys, place) for place in places)


def _whole(text: str) -> int | None:
    try:
        return int(text, 0)
    except ValueError:
        return None
