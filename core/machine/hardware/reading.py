"""Reads the tables about wires; values go where the other values of the file are, by path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeGuard

from core.machine.errors import Finding
from core.machine.hardware import fields
from core.machine.hardware.addresses import sdo_address
from core.machine.hardware.model import SdoValue
from core.machine.schema import Field, Values, joined, read_table, unknown_keys, written

_SDO_LOW, _SDO_HIGH = -(2**31), 2**32 - 1
_WINDOW = 0x6065
_OFF = 0xFFFFFFFF


class HardwareReading:
    """Findings, and the names and raw entries that a file's owner chose: nodes, objects, settings, faults."""

    def __init__(self, data: Mapping[str, object], values: Values) -> None:
        self.data = data
        self.values = values
        self.findings: list[Finding] = []
        self.tables: list[str] = []  # which of the optional tables are there
        self.nodes: list[str] = []
        self.sdo: dict[str, list[SdoValue]] = {}  # by node's name, or "all"
        self.settings: dict[int, float | str] = {}
        self.faults: list[str] = []  # paths
        self.analog: list[str] = []
        self._read()

    def _read(self) -> None:
        for path, keys, children in fields.TABLES:
            if path in self.data:
                self.tables.append(path)
                self.findings += read_table(self.data[path], keys, path, self.values, children)
        bus = _table(self.data.get("canopen"))
        self.nodes = self._named(bus.get("nodes", {}), "canopen.nodes", fields.NODE)
        self._read_sdo(bus.get("sdo", {}))
        self._read_settings(_table(self.data.get("grblhal")).get("settings", {}))
        self._read_vfd(_table(self.data.get("spindle")).get("vfd"))
        self._read_encoder(_table(self.data.get("spindle")).get("encoder"))
        self.analog = self._read_analog(_table(self.data.get("io")).get("analog", {}))
        self._read_faults(_table(self.data.get("sim")).get("faults", []))

    def _named(self, table: object, path: str, keys: tuple[Field, ...]) -> list[str]:
        if not isinstance(table, dict):
            self._expected_table(path, table)
            return []
        for name, entry in table.items():
            self.findings += read_table(entry, keys, joined(path, name), self.values)
        return list(table)

    def _expected_table(self, path: str, raw: object) -> None:
        self.findings.append(Finding(path, written(raw), f"expected a table, [{path}]"))

    def _read_vfd(self, table: object) -> None:
        if table is not None:
            self.tables.append("spindle.vfd")
            self.findings += read_table(table, fields.VFD, "spindle.vfd", self.values)

    def _read_encoder(self, table: object) -> None:
        if table is not None:
            self.tables.append("spindle.encoder")
            self.findings += read_table(table, fields.ENCODER, "spindle.encoder", self.values)

    def _read_analog(self, table: object) -> list[str]:
        if isinstance(table, dict):
            self.findings += unknown_keys(table, list(fields.ANALOG_NAMES), "io.analog")
            table = {name: entry for name, entry in table.items() if name in fields.ANALOG_NAMES}
        return self._named(table, "io.analog", fields.ANALOG)

    def _read_sdo(self, table: object) -> None:
        if not isinstance(table, dict):
            self._expected_table("canopen.sdo", table)
            return
        self.findings += unknown_keys(table, ["all", *self.nodes], "canopen.sdo")
        for node, entries in table.items():
            path = f"canopen.sdo.{node}"
            if isinstance(entries, dict):
                self.sdo[node] = list(self._objects(entries, path))
            else:
                self._expected_table(path, entries)

    def _objects(self, entries: Mapping[str, object], path: str) -> Iterator[SdoValue]:
        for key, value in entries.items():
            place, address = f'{path}."{key}"', sdo_address(key)
            if address is None:
                expected = 'expected the address of an object as the key: "6007:0", index in hexadecimal'
                self.findings.append(Finding(place, written(value), expected))
            elif not _whole(value) or not _SDO_LOW <= value <= _SDO_HIGH:
                self.findings.append(Finding(place, written(value), "expected a whole number of 32 bits"))
            elif address[0] == _WINDOW and value % 2**32 == _OFF:
                why = "expected a window: this value switches the drive's following error monitoring off"
                self.findings.append(Finding(place, written(value), why))
            else:
                yield SdoValue(*address, value)

    def _read_settings(self, table: object) -> None:
        if not isinstance(table, dict):
            self._expected_table("grblhal.settings", table)
            return
        for key, value in table.items():
            place = f"grblhal.settings.{key}"
            if not key.isdecimal():
                self.findings.append(
                    Finding(place, written(value), "expected the number of a setting: 13 for $13")
                )
            elif isinstance(value, bool) or not isinstance(value, int | float | str):
                self.findings.append(Finding(place, written(value), "expected a number or a text"))
            else:
                self.settings[int(key)] = value

    def _read_faults(self, entries: object) -> None:
        if not isinstance(entries, list):
            self.findings.append(
                Finding("sim.faults", written(entries), "expected a list of tables, [{...}]")
            )
            return
        for number, entry in enumerate(entries, 1):
            path = f"sim.faults.{number}"
            self.findings += read_table(entry, fields.FAULT, path, self.values)
            self.faults.append(path)


def _whole(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool)


def _table(value: object) -> Mapping[str, object]:
    """A table, or an empty one where the file has none there: somebody else tells what is wrong."""
    return value if isinstance(value, dict) else {}
