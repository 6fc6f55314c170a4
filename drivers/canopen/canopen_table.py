"""[canopen] of the machine file: the keys of the bus, and the driver's entry."""

from __future__ import annotations

from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, FileReading, Kind, Unit
from drivers.canopen import encoder_table
from drivers.canopen.canopen_nodes import (
    NODES,
    BusConfig,
    CanNode,
    input_addresses,
    node_of,
    read_nodes,
    terminal,
)
from drivers.canopen.canopen_rules import bus_rules
from drivers.canopen.drive_profiles import PROFILES

MODES = ("pvt", "csp", "ip", "pp")
_BUS = (
    Field("interface", Kind.TEXT, default="socketcan"),
    Field("channel", Kind.TEXT),
    Field("bitrate", Kind.WHOLE, low=10_000, high=1_000_000, default=1_000_000),
    Field("sync_ms", Kind.NUMBER, Unit.MILLISECONDS, 0.001, 0.1, default=0.01),
    Field("host_id", Kind.WHOLE, low=1, high=127, default=127),
    Field("heartbeat_ms", Kind.NUMBER, Unit.MILLISECONDS, 0.02, 2.0, default=0.1),
    Field("mode", Kind.CHOICE, choices=MODES),
    Field("drive", Kind.CHOICE, choices=tuple(PROFILES), default=""),
    Field("record_ms", Kind.NUMBER, Unit.MILLISECONDS, 0.002, 0.05, default=0.02),
)


@dataclass(frozen=True, slots=True)
class CanopenTable:
    """The CAN bus and what hangs on it."""

    bus: BusConfig
    mode: str  # one of MODES
    record: float  # s, length of a PVT record
    nodes: tuple[CanNode, ...]


def _bus_table(file: FileReading) -> CanopenTable:
    values = file.values
    return CanopenTable(
        bus=values.model(BusConfig, "canopen", {"sync": "sync_ms", "heartbeat": "heartbeat_ms"}),
        mode=values.text("canopen.mode"),
        record=values.number("canopen.record_ms"),
        nodes=tuple(node_of(file, name) for name in file.names(NODES)),
    )


DRIVER = Driver(
    tables=(
        DriverTable("canopen", _BUS, _bus_table, ("nodes", "sdo"), read_nodes, bus_rules),
        encoder_table.TABLE,
    ),
    backend="canopen",
    spindle="cia402",
    count_rate=2.0**23,
    terminal=terminal,
    inputs=input_addresses,
)
