"""Reads the tables about wires; values go where the other values of the file are, by path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TypeGuard

from core.machine.can_addresses import sdo_address
from core.machine.hardware_model import SdoValue
from core.table_schema import Field, Finding, Kind, Unit, Values, joined, read_table, unknown_keys, written

# --- Every key of the tables about wires, with its range.


BAUDS = 110, 1_000_000
PARITIES = ("N", "E", "O")
VFD_FAMILIES = ("delta-vfdb", "hitachi-wj200", "huanyang")
SPINDLE_DRIVERS = ("sim", "cia402", "vfd", "grblhal")
SIM_FAULTS = (
    "jam",
    "encoder_stuck",
    "runaway",
    "drive_fault",
    "spindle_bog",
    "spindle_wander",
    "spindle_ignores_stop",
    "spindle_fault",
    "collet_sensor_stuck",
    "station_silent",
    "pot_noise",
    "estop",
)
AXIS_FAULTS = frozenset(("jam", "encoder_stuck", "runaway", "drive_fault"))

_NUMBER, _WHOLE, _FLAG, _TEXT, _CHOICE = Kind.NUMBER, Kind.WHOLE, Kind.FLAG, Kind.TEXT, Kind.CHOICE

CANOPEN = (
    Field("interface", _TEXT, default="socketcan"),
    Field("channel", _TEXT),
    Field("bitrate", _WHOLE, low=10_000, high=1_000_000, default=1_000_000),
    Field("sync_ms", _NUMBER, Unit.MILLISECONDS, 0.001, 0.1, default=0.01),
    Field("host_id", _WHOLE, low=1, high=127, default=127),
    Field("heartbeat_ms", _NUMBER, Unit.MILLISECONDS, 0.02, 2.0, default=0.1),
    Field("mode", _CHOICE, choices=("pvt", "pp", "csp")),
    Field("experimental", _FLAG, default=False),
    Field("record_ms", _NUMBER, Unit.MILLISECONDS, 0.002, 0.05, default=0.02),
)
NODE = (
    Field("id", _WHOLE, low=1, high=127),
    Field("profile", _WHOLE, low=401, high=406, default=402),
    Field("eds", _TEXT, default=""),
    Field("counts_per_rev", _WHOLE, low=0, high=100_000_000, default=0),
)
VFD = (
    Field("family", _CHOICE, choices=VFD_FAMILIES),
    Field("port", _TEXT),
    Field("baud", _WHOLE, low=BAUDS[0], high=BAUDS[1], default=9600),
    Field("parity", _CHOICE, choices=PARITIES, default="N"),
    Field("stop", _WHOLE, low=1, high=2, default=1),
    Field("id", _WHOLE, low=1, high=247, default=1),
    Field("comm_loss_s", _NUMBER, Unit.SECONDS, 0.2, 10.0, default=1.5),
    Field("hz_per_rpm", _NUMBER, Unit.PLAIN, 0.001, 1.0),
    Field("disagree_pct", _NUMBER, Unit.PERCENT, 0.05, 0.5, default=0.15),
)
ENCODER = (
    Field("node", _TEXT),
    Field("object", _TEXT, default=""),
    Field("counts_per_rev", _WHOLE, low=-100_000_000, high=100_000_000),
)
GRBLHAL = (
    Field("port", _TEXT),
    Field("baud", _WHOLE, low=BAUDS[0], high=4_000_000, default=115_200),
    Field("x_mode", _CHOICE, choices=("G7", "G8"), default="G8"),
)
DNC = (
    Field("port", _TEXT),
    Field("baud", _WHOLE, low=BAUDS[0], high=BAUDS[1], default=9600),
    Field("bits", _WHOLE, low=7, high=8, default=8),
    Field("parity", _CHOICE, choices=PARITIES, default="N"),
    Field("stop", _WHOLE, low=1, high=2, default=1),
    Field("flow", _CHOICE, choices=("xonxoff", "rtscts", "none"), default="xonxoff"),
    Field("wrap", _CHOICE, choices=("%", ""), default="%"),
    Field("eol", _CHOICE, choices=("\r\n", "\n", "\r"), default="\r\n"),
    Field("dc_codes", _FLAG, default=False),
    Field("wait", _FLAG, default=False),
    Field("leader", _WHOLE, low=0, high=2000, default=0),
)
MTCONNECT = (
    Field("enabled", _FLAG, default=False),
    Field("bind", _TEXT, default="127.0.0.1"),
    Field("port", _WHOLE, low=1, high=65535, default=7878),
    Field("heartbeat_ms", _NUMBER, Unit.MILLISECONDS, 0.001, 1800.0, default=10.0),
    Field("device", _TEXT, default="TurnDesk"),
)
ANALOG = (
    Field("at", _TEXT),
    Field("range", Kind.PAIR, Unit.PLAIN, -1000.0, 1000.0, default=(0.0, 1.0)),
    Field("switch", _TEXT, default=""),
    Field("counts_per_click", _WHOLE, low=-1000, high=1000, default=1),
)
FAULT = (
    Field("at", _NUMBER, Unit.SECONDS, 0.0, 1e6),
    Field("what", _CHOICE, choices=SIM_FAULTS),
    Field("axis", _TEXT, default=""),
    Field("value", _NUMBER, Unit.PLAIN, -1e6, 1e6, default=0.0),
    Field("seconds", _NUMBER, Unit.SECONDS, 0.0, 1e6, default=0.0),
    Field("text", _TEXT, default=""),
)
ANALOG_NAMES = ("feed_pot", "spindle_pot", "handwheel")

# Tables that a file may have or not, and their keys.
TABLES = (
    ("canopen", CANOPEN, ("nodes", "sdo")),
    ("grblhal", GRBLHAL, ("settings",)),
    ("dnc", DNC, ()),
    ("mtconnect", MTCONNECT, ()),
)
TOP = tuple(path for path, _, _ in TABLES)

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
        for path, keys, children in TABLES:
            if path in self.data:
                self.tables.append(path)
                self.findings += read_table(self.data[path], keys, path, self.values, children)
        bus = _table(self.data.get("canopen"))
        self.nodes = self._named(bus.get("nodes", {}), "canopen.nodes", NODE)
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
            self.findings += read_table(table, VFD, "spindle.vfd", self.values)

    def _read_encoder(self, table: object) -> None:
        if table is not None:
            self.tables.append("spindle.encoder")
            self.findings += read_table(table, ENCODER, "spindle.encoder", self.values)

    def _read_analog(self, table: object) -> list[str]:
        if isinstance(table, dict):
            self.findings += unknown_keys(table, list(ANALOG_NAMES), "io.analog")
            table = {name: entry for name, entry in table.items() if name in ANALOG_NAMES}
        return self._named(table, "io.analog", ANALOG)

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
            self.findings += read_table(entry, FAULT, path, self.values)
            self.faults.append(path)


def _whole(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool)


def _table(value: object) -> Mapping[str, object]:
    """A table, or an empty one where the file has none there: somebody else tells what is wrong."""
    return value if isinstance(value, dict) else {}
