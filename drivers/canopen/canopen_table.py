"""[canopen] of the machine file: the keys of the bus, and the driver's entry."""

from __future__ import annotations

from dataclasses import dataclass

from core.table_schema import Driver, DriverTable, Field, FileReading, Kind, Unit
from drivers.canopen import encoder_table
from drivers.canopen.canopen_nodes import (
    NODE_REFERENCE,
    NODES,
    SDO_REFERENCE,
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
    Field(
        "interface",
        Kind.TEXT,
        default="socketcan",
        meaning="Interface of python-can, such as `socketcan`, or `virtual` for a bus within one process.",
    ),
    Field("channel", Kind.TEXT, meaning="Channel of the interface, such as `can0`."),
    Field(
        "bitrate",
        Kind.WHOLE,
        low=10_000,
        high=1_000_000,
        default=1_000_000,
        meaning="Bit rate of the bus in bit/s.",
    ),
    Field(
        "sync_ms",
        Kind.NUMBER,
        Unit.MILLISECONDS,
        0.001,
        0.1,
        default=0.01,
        meaning='Time from one SYNC to the next; with "csp" and "ip", the time from setpoint to setpoint.',
    ),
    Field(
        "host_id",
        Kind.WHOLE,
        low=1,
        high=127,
        default=127,
        meaning="Node number of TurnDesk, under which it sends its heartbeat.",
    ),
    Field(
        "heartbeat_ms",
        Kind.NUMBER,
        Unit.MILLISECONDS,
        0.02,
        2.0,
        default=0.1,
        meaning="Interval of the heartbeats. A drive or module stops if it misses three of them.",
    ),
    Field(
        "mode",
        Kind.CHOICE,
        choices=MODES,
        meaning=(
            'How the drives receive motion. "pvt": queued in the drive; "csp" and "ip": one '
            'setpoint at each SYNC; "pp": single moves only, no programs.'
        ),
    ),
    Field(
        "drive",
        Kind.CHOICE,
        choices=tuple(PROFILES),
        default="",
        meaning="Family of all drives. Default: the family that the EDS file names, or plain CiA 402.",
    ),
    Field(
        "record_ms",
        Kind.NUMBER,
        Unit.MILLISECONDS,
        0.002,
        0.05,
        default=0.02,
        meaning='Longest PVT record; only for mode "pvt". `commit_ms` must cover three records and 40 ms.',
    ),
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
        DriverTable(
            "canopen",
            _BUS,
            _bus_table,
            ("nodes", "sdo"),
            read_nodes,
            bus_rules,
            purpose='The CANopen bus and its drives (`backend = "canopen"`).',
            parts=(NODE_REFERENCE, SDO_REFERENCE),
        ),
        encoder_table.TABLE,
    ),
    backend="canopen",
    spindle="cia402",
    count_rate=2.0**23,
    terminal=terminal,
    inputs=input_addresses,
)
