"""[canopen] of the machine file: the keys of the bus, and the driver's entry."""

from __future__ import annotations

from dataclasses import KW_ONLY

from core.key_declaration import Range, Unit, file_key, key_table
from core.table_schema import Driver, DriverTable
from drivers.canopen import encoder_table
from drivers.canopen.canopen_nodes import (
    NODE_REFERENCE,
    NODES,
    SDO_REFERENCE,
    CanNode,
    input_addresses,
    node_of,
    read_nodes,
    seldom,
    terminal,
)
from drivers.canopen.canopen_rules import bus_rules
from drivers.canopen.drive_profiles import PROFILES

_ANSWERS, _ANSWER_TIME = 3, 0.02  # SYNCs, s
MODES = ("pvt", "csp", "ip", "pp")


@key_table
class CanopenTable:
    """The CAN bus and what hangs on it. Times in seconds."""

    _: KW_ONLY
    interface: str = file_key(
        default="socketcan",
        meaning="Interface of python-can, such as `socketcan`, or `virtual` for a bus within one process.",
    )
    channel: str = file_key(meaning="Channel of the interface, such as `can0`.")
    bitrate: int = file_key(
        Range(10_000, 1_000_000), default=1_000_000, meaning="Bit rate of the bus in bit/s."
    )
    sync: float = file_key(
        Range(0.001, 0.1, Unit.MILLISECONDS),
        name="sync_ms",
        default=0.01,
        meaning='Time from one SYNC to the next; with "csp" and "ip", the time from setpoint to setpoint.',
    )
    host_id: int = file_key(
        Range(1, 127), default=127, meaning="Node number of TurnDesk, under which it sends its heartbeat."
    )
    heartbeat: float = file_key(
        Range(0.02, 2.0, Unit.MILLISECONDS),
        name="heartbeat_ms",
        default=0.1,
        meaning="Interval of the heartbeats. A drive or module stops if it misses three of them.",
    )
    mode: str = file_key(
        choices=MODES,
        meaning='How the drives receive motion. "pvt": queued in the drive; "csp" and "ip": one setpoint '
        'at each SYNC; "pp": single moves only, no programs.',
    )
    drive: str = file_key(
        default="",
        choices=tuple(PROFILES),
        meaning="Family of all drives. Default: the family that the EDS file names, or plain CiA 402.",
    )
    record: float = file_key(
        Range(0.002, 0.05, Unit.MILLISECONDS),
        name="record_ms",
        default=0.02,
        meaning='Longest PVT record; only for mode "pvt". `commit_ms` must cover three records and 40 ms.',
    )
    nodes: tuple[CanNode, ...] = ()

    @property
    def seldom(self) -> int:
        """SYNCs from one answer to the next of what need not be known at each: about 10 ms."""
        return seldom(self.sync)

    @property
    def patience(self) -> int:
        """Answers to SYNC that a slide may leave out before it counts as silent: 3, or 20 ms."""
        return max(_ANSWERS, round(_ANSWER_TIME / self.sync))

    @property
    def own_process(self) -> bool:
        """Whether another process can own it; python-can's virtual bus lives in one."""
        return self.interface != "virtual"


DRIVER = Driver(
    tables=(
        DriverTable(
            "canopen",
            CanopenTable,
            lambda file: {"nodes": tuple(node_of(file, name) for name in file.names(NODES))},
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
