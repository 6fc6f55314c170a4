"""A reader and checker of TOML files that describe inverter families.

The folder ``families`` contains the families that are shipped with TurnDesk. The machine file may name
another file, relative to its own folder.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from core.input_file import BYTES_PER_MB, parse_toml, read_input_text
from core.key_declaration import get_declared_keys
from core.message import Message, join_messages
from core.ports import DriverError
from core.secret_values import format_toml_value
from core.table_schema import FileFinding, FileValues, join_path, make_table_finding, read_table_values
from drivers.inverter import family_rules
from drivers.inverter.family_table import (
    COMMAND_NAMES,
    MODBUS,
    STATE_NAMES,
    CommandKeys,
    FamilyKeys,
    FamilyTable,
    FaultCodeKeys,
    FrequencyKeys,
    LimitKeys,
    MaxFrequencyKeys,
    OutputCurrentKeys,
    ParameterKeys,
    ReadRequestKeys,
    RegisterTable,
    SerialLineKeys,
    StateKeys,
    WriteRequestKeys,
)
from drivers.inverter.inverter_table import FAMILY_FOLDER, FAMILY_NAMES

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_KeyClass = TypeVar("_KeyClass", bound="DataclassInstance")
_OPTIONAL_TABLES = {"highest": MaxFrequencyKeys, "limits": LimitKeys}
_REPORT_TABLES: Mapping[str, type] = {
    "output": FrequencyKeys,
    "setpoint": FrequencyKeys,
    "current": OutputCurrentKeys,
    **dict.fromkeys(STATE_NAMES, StateKeys),
    "fault_code": FaultCodeKeys,
}
_MODBUS_TABLES = ("frequency", "command", "read", "report", "faults")


def load_inverter_family(name: str, folder: Path) -> FamilyTable:
    """Return a shipped family by its name, or the family in a file in ``folder``.

    Raises DriverError in the same cases as ``read_family_file``.
    """
    return read_family_file(FAMILY_FOLDER / f"{name}.toml" if name in FAMILY_NAMES else folder / name)


def read_family_file(path: Path) -> FamilyTable:
    """Return the family that a TOML file describes.

    Raises DriverError with the reason ``bad-family`` if the file cannot be read, is not valid TOML, or has
    errors in its keys, values or rules. For such errors, the message contains the file, line, key and
    remedy of each finding.
    """
    try:
        text = read_input_text(path, BYTES_PER_MB)
        reading = _FamilyReader(parse_toml(text))
    except (OSError, ValueError) as error:
        cause = error.strerror if isinstance(error, OSError) else error
        raise DriverError(
            "{file} cannot be read: {cause}", reason="bad-family", file=path, cause=cause
        ) from error
    if not reading.findings:
        table = reading.build_family()
        reading.findings += family_rules.check_family(table)
    if reading.findings:
        raise _refusal(path, text, reading.findings)
    return table


def _refusal(path: Path, text: str, findings: Iterable[FileFinding]) -> DriverError:
    lines = _index_lines(text)
    parts = [
        Message(
            "{file}, line {line}: {finding}", file=path, line=_find_line(lines, each.path), finding=str(each)
        )
        for each in findings
    ]
    return DriverError(join_messages("; ", parts), reason="bad-family")


# --- Line numbers of keys.


_HEAD_PATTERN = re.compile(r"\s*(\[\[?)\s*([\w.-]+)\s*\]")
_KEY_PATTERN = re.compile(r"""\s*["']?([\w.-]+)["']?\s*=""")
_LAST_PART_PATTERN = re.compile(r"(\.?[^.\[\]]+|\[\d+\])$")


def _index_lines(text: str) -> dict[str, int]:
    """Return the line number of each table and key, by its path, such as ``read[2].count``."""
    lines: dict[str, int] = {}
    times = Counter[str]()
    table = ""
    for number, line in enumerate(text.splitlines(), 1):
        if head := _HEAD_PATTERN.match(line):
            table = head[2]
            if head[1] == "[[":
                times[table] += 1
                table = f"{table}[{times[table]}]"
            lines.setdefault(table, number)
        elif key := _KEY_PATTERN.match(line):
            lines.setdefault(join_path(table, key[1]), number)
    return lines


def _find_line(lines: Mapping[str, int], path: str) -> int:
    """Return the line number of a key, or of the innermost enclosing table that exists."""
    while path and path not in lines:
        path = _LAST_PART_PATTERN.sub("", path)
    return lines.get(path, 1)


# --- Keys and values.


class _FamilyReader:
    """A reader of one file, which collects the findings about its keys and values."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._data = data
        self._values = FileValues(False)
        self._faults: dict[int, str] = {}
        self.findings: list[FileFinding] = []
        self._modbus = data.get("protocol") != "huanyang"
        children = ("line", "parameter", *_OPTIONAL_TABLES, *(_MODBUS_TABLES if self._modbus else ()))
        self.findings += read_table_values(data, FamilyKeys, "", self._values, children)
        self._table("line", SerialLineKeys)
        self._read_rows("parameter", ParameterKeys)
        for path, keys in _OPTIONAL_TABLES.items():
            if path in data:
                self._table(path, keys)
        if self._modbus:
            self._read_registers()

    def _read_registers(self) -> None:
        self._table("frequency", FrequencyKeys)
        self._table("command", CommandKeys, COMMAND_NAMES)
        for name in COMMAND_NAMES if self._is_table("command") else ():
            self._read_rows(
                f"command.{name}", WriteRequestKeys, self._data["command"].get(name), is_required=True
            )
        self._read_rows("read", ReadRequestKeys, is_required=True)
        self._table("report", (), tuple(_REPORT_TABLES))
        for name, keys in _REPORT_TABLES.items() if self._is_table("report") else ():
            if name != "fault" or name in self._data["report"]:
                self._table(f"report.{name}", keys, raw=self._data["report"].get(name))
        if self._is_table("faults"):
            self._read_faults(self._data["faults"])
        elif "faults" in self._data:
            self.findings.append(make_table_finding("faults", self._data["faults"]))

    def _is_table(self, path: str) -> bool:
        return isinstance(self._data.get(path), dict)

    def _table(
        self, path: str, keys: type | tuple[()], children: tuple[str, ...] = (), raw: object = None
    ) -> None:
        raw = self._data.get(path) if raw is None else raw
        if raw is None:
            self.findings.append(FileFinding(path, "", "this table is missing; add the table", "missing"))
        else:
            self.findings += read_table_values(raw, keys, path, self._values, children)

    def _read_rows(self, path: str, keys: type, raw: object = None, *, is_required: bool = False) -> None:
        """Read a list of tables.

        If ``is_required`` is True, the list must have at least one entry.
        """
        raw = (self._data.get(path) if raw is None else raw) or []
        if not isinstance(raw, list) or (is_required and not raw):
            text = "expected a list of tables, such as [{ register = 0x2000, value = 1 }]"
            self.findings.append(
                FileFinding(path, format_toml_value(raw) if raw else "", text, "wrong-value")
            )
            return
        for number, row in enumerate(raw, 1):
            self.findings += read_table_values(row, keys, f"{path}[{number}]", self._values)

    def _read_faults(self, raw: Mapping[str, Any]) -> None:
        for key, text in raw.items():
            place = f"faults.{key}"
            code = _whole(key)
            if code is None or not 0 < code <= 0xFFFF:
                why = "the key must be a fault code, 1…65535 or 0x1…0xFFFF"
                self.findings.append(FileFinding(place, "", why, "wrong-value"))
            elif code in self._faults:
                why = "this fault code appears twice; remove one of them"
                self.findings.append(FileFinding(place, "", why, "broken-rule"))
            elif not isinstance(text, str) or not text.strip():
                why = "expected nonblank text in quotation marks"
                self.findings.append(FileFinding(place, format_toml_value(text), why, "wrong-value"))
            else:
                self._faults[code] = text

    def build_family(self) -> FamilyTable:
        """Return the family.

        Call this method only if the keys have no findings.
        """
        return FamilyTable(
            name=self._values.text("name"),
            protocol=self._values.text("protocol"),
            serial_line=self._values.make_model(SerialLineKeys, "line"),
            parameters=self._models("parameter", ParameterKeys),
            max_frequency_parameter=self._optional("highest", MaxFrequencyKeys),
            inverter_limits=self._optional("limits", LimitKeys) or LimitKeys(),
            register_table=self._registers() if self._values.has_text("protocol", MODBUS) else None,
        )

    def _registers(self) -> RegisterTable:
        values, states = self._values, [name for name in STATE_NAMES if name in self._data["report"]]
        return RegisterTable(
            commanded_frequency=values.make_model(FrequencyKeys, "frequency"),
            command_settings=values.make_model(CommandKeys, "command"),
            command_writes={
                name: self._models(f"command.{name}", WriteRequestKeys) for name in COMMAND_NAMES
            },
            read_requests=self._models("read", ReadRequestKeys),
            output_frequency=values.make_model(FrequencyKeys, "report.output"),
            reported_setpoint=values.make_model(FrequencyKeys, "report.setpoint"),
            output_current=values.make_model(OutputCurrentKeys, "report.current"),
            state_conditions={name: values.make_model(StateKeys, f"report.{name}") for name in states},
            fault_code=values.make_model(FaultCodeKeys, "report.fault_code"),
            fault_texts=self._faults,
        )

    def _optional(self, path: str, keys: type[_KeyClass]) -> _KeyClass | None:
        return self._values.make_model(keys, path) if path in self._data else None

    def _models(self, path: str, keys: type[_KeyClass]) -> tuple[_KeyClass, ...]:
        first = get_declared_keys(keys)[0].key
        places: list[str] = []
        while f"{path}[{len(places) + 1}].{first}" in self._values.values_by_path:
            places.append(f"{path}[{len(places) + 1}]")
        return tuple(self._values.make_model(keys, place) for place in places)


def _whole(text: str) -> int | None:
    try:
        return int(text, 0)
    except ValueError:
        return None
