"""Tables [canopen] and [spindle.encoder] of the machine file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import KW_ONLY

from core.key_declaration import Range, Unit, file_key, key_table
from core.message import Message
from core.table_schema import Driver, DriverTable, FileReading, Finding, Values, written
from drivers.canopen.canopen_nodes import (
    DRIVE,
    ENCODER_PROFILE,
    MODULE,
    NODE_REFERENCE,
    NODES,
    SDO_REFERENCE,
    CanNode,
    input_addresses,
    node_of,
    profile_of,
    read_nodes,
    sdo_address,
    seldom,
    terminal,
)
from drivers.canopen.canopen_rules import bus_rules
from drivers.canopen.drive_profiles import PROFILES

_ANSWERS, _ANSWER_TIME = 3, 0.02  # SYNCs, s
# Name of the table, and the position object of a CiA 406 node.
ENCODER, POSITION = "spindle.encoder", "6004:0"
_LEAST = 16  # Minimum counts per revolution.
MODES = ("pvt", "csp", "ip", "pp")


@key_table
class CanopenTable:
    """Settings of the CAN bus and its nodes; times in seconds."""

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
        """The number of SYNCs between two replies of slow values, which corresponds to about 10 ms."""
        return seldom(self.sync)

    @property
    def patience(self) -> int:
        """The number of missing replies after which an axis drive counts as silent: 3, or those of 20 ms."""
        return max(_ANSWERS, round(_ANSWER_TIME / self.sync))

    @property
    def own_process(self) -> bool:
        """Whether another process can own the bus.

        The virtual bus of python-can exists in one process only.
        """
        return self.interface != "virtual"


@key_table
class EncoderTable:
    """Settings of a spindle encoder on the bus: a separate node, or the second input of a drive."""

    _: KW_ONLY
    node: str = file_key(
        meaning="Name of the node in [canopen.nodes] that supplies the counts: an encoder, or a drive with "
        "a second encoder input."
    )
    object: str = file_key(
        default="",
        meaning='Object of the position as index:sub-index, such as "60E4:1". Default: "6004:0" of an '
        "encoder; required for a drive.",
    )
    counts_per_rev: int = file_key(
        Range(-100_000_000, 100_000_000),
        meaning="Counts per spindle revolution, at least 16; negative if the encoder counts down with M03.",
    )

    @property
    def address(self) -> tuple[int, int]:
        """The index and sub-index of the position object."""
        return sdo_address(self.object or POSITION) or (0, 0)


def _encoder_rules(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if ENCODER in file.tables:
        yield from _beside(values)
        yield from _counts(file)
    used = values.text(f"{ENCODER}.node") if values.has(f"{ENCODER}.node") else ""
    for name in file.names(NODES):
        path = f"{NODES}.{name}.profile"
        number = values.whole(path) if values.has(path) else MODULE
        if number not in {MODULE, DRIVE, ENCODER_PROFILE}:
            yield Finding(
                path, str(number), "the profile must be 401 (terminals), 402 (drive) or 406 (encoder)"
            )
        elif number == ENCODER_PROFILE and name != used:
            why = Message(
                "this encoder is not used; {encoder} names the encoder that is used", encoder=ENCODER
            )
            yield Finding(path, str(number), why)


def _beside(values: Values) -> Iterator[Finding]:
    if values.has("machine.backend") and values.text("machine.backend") != "canopen":
        backend = written(values.text("machine.backend"))
        yield Finding(
            ENCODER,
            "",
            Message(
                "backend {backend} does not support an encoder on a bus; remove this entry", backend=backend
            ),
        )
    if values.has("spindle.driver") and values.text("spindle.driver") != "vfd":
        expected = (
            'spindle.driver must be "vfd"; a drive on the bus has its own encoder, set by '
            "counts_per_rev of its node"
        )
        yield Finding(ENCODER, "", expected)
    path = f"{ENCODER}.counts_per_rev"
    if values.has(path) and abs(values.number(path)) < _LEAST:
        expected = Message(
            "enter at least {minimum} counts; if the encoder counts down with M03, put a "
            "minus sign before the number",
            minimum=_LEAST,
        )
        yield Finding(path, f"{values.number(path):g}", expected)


def _counts(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if not values.has(f"{ENCODER}.node", f"{ENCODER}.object"):
        return
    node, counted = values.text(f"{ENCODER}.node"), values.text(f"{ENCODER}.object")
    if node not in file.names(NODES):
        yield Finding(
            f"{ENCODER}.node",
            written(node),
            "the encoder node must be a node of [canopen.nodes] with profile = 406",
        )
    elif profile_of(file, node) == MODULE:
        yield Finding(
            f"{ENCODER}.node",
            written(node),
            "an I/O module does not count revolutions; use a node with profile 406 or a drive",
        )
    elif profile_of(file, node) == DRIVE and not counted:
        expected = (
            "this entry is missing; enter the object of the second encoder from the "
            'drive\'s manual, such as "60E4:1"'
        )
        yield Finding(f"{ENCODER}.object", "", expected)
    if counted and sdo_address(counted) is None:
        yield Finding(
            f"{ENCODER}.object",
            written(counted),
            Message(
                'the encoder object must be an index and sub-index, such as "{position}"', position=POSITION
            ),
        )


_ENCODER_TABLE = DriverTable(
    ENCODER,
    EncoderTable,
    rules=_encoder_rules,
    purpose="An encoder on the CANopen bus for a spindle that an inverter drives.",
)

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
        _ENCODER_TABLE,
    ),
    backend="canopen",
    spindle="cia402",
    count_rate=2.0**23,
    terminal=terminal,
    inputs=input_addresses,
)
