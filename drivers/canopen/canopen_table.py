"""Tables [canopen] and [spindle.encoder] of the machine file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import KW_ONLY

from core.key_declaration import FileUnit, KeyRange, declare_key, make_key_table
from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import DriverDeclaration, DriverTable, FileFinding, FileValues, MachineFileReading
from drivers.canopen.canopen_nodes import (
    DRIVE,
    ENCODER_PROFILE,
    MODULE,
    NODE_REFERENCE,
    NODES,
    SDO_REFERENCE,
    CanNode,
    build_node,
    generate_input_addresses,
    get_slow_reply_divisor,
    parse_sdo_address,
    read_node_profile,
    read_nodes,
    resolve_terminal,
)
from drivers.canopen.canopen_rules import check_bus_settings
from drivers.canopen.drive_profiles import PROFILES

_ANSWERS, _ANSWER_TIME = 3, 0.02  # SYNCs, s
# Name of the table, and the position object of a CiA 406 node.
ENCODER, POSITION = "spindle.encoder", "6004:0"
_MIN_COUNTS = 16  # Minimum counts per revolution.
MOTION_MODE_NAMES = ("pvt", "csp", "ip", "pp")


@make_key_table
class CanopenTable:
    """Settings of the CAN bus and its nodes, with times in seconds."""

    _: KW_ONLY
    interface: str = declare_key(
        default="socketcan",
        meaning="Interface of python-can, such as `socketcan`, or `virtual` for a bus within one process.",
    )
    channel: str = declare_key(meaning="Channel of the interface, such as `can0`.")
    bitrate: int = declare_key(
        KeyRange(10_000, 1_000_000), default=1_000_000, meaning="Bit rate of the bus in bit/s."
    )
    sync: float = declare_key(
        KeyRange(0.001, 0.1, FileUnit.MILLISECONDS),
        name="sync_ms",
        default=0.01,
        meaning='Time from one SYNC to the next; with "csp" and "ip", the time from setpoint to setpoint.',
    )
    host_id: int = declare_key(
        KeyRange(1, 127), default=127, meaning="Node number of TurnDesk, under which it sends its heartbeat."
    )
    heartbeat: float = declare_key(
        KeyRange(0.02, 2.0, FileUnit.MILLISECONDS),
        name="heartbeat_ms",
        default=0.1,
        meaning="Interval of the heartbeats. A drive or module stops if it misses three of them.",
    )
    mode: str = declare_key(
        choices=MOTION_MODE_NAMES,
        meaning='How the drives receive motion. "pvt": queued in the drive; "csp" and "ip": one setpoint '
        'at each SYNC; "pp": single moves only, no programs.',
    )
    drive: str = declare_key(
        default="",
        choices=tuple(PROFILES),
        meaning="Family of all drives. Default: the family that the EDS file names, or plain CiA 402.",
    )
    record: float = declare_key(
        KeyRange(0.002, 0.05, FileUnit.MILLISECONDS),
        name="record_ms",
        default=0.02,
        meaning='Longest PVT record; only for mode "pvt". `commit_ms` must cover three records and 40 ms.',
    )
    nodes: tuple[CanNode, ...] = ()

    @property
    def slow_reply_divisor(self) -> int:
        """Return after how many SYNCs a drive sends slow values, which is about every 10 ms."""
        return get_slow_reply_divisor(self.sync)

    @property
    def max_missing_reply_count(self) -> int:
        """Return the number of missing replies after which an axis drive is treated as silent.

        The number is 3, or the number of replies in 20 ms if that is larger.
        """
        return max(_ANSWERS, round(_ANSWER_TIME / self.sync))

    @property
    def supports_separate_process(self) -> bool:
        """Return whether a separate process can own the bus.

        The virtual bus of python-can exists only within one process.
        """
        return self.interface != "virtual"


@make_key_table
class EncoderTable:
    """Settings of a spindle encoder on the bus, which is a separate node or the second input of a drive."""

    _: KW_ONLY
    node: str = declare_key(
        meaning="Name of the node in [canopen.nodes] that supplies the counts: an encoder, or a drive with "
        "a second encoder input."
    )
    object: str = declare_key(
        default="",
        meaning='Object of the position as index:sub-index, such as "60E4:1". Default: "6004:0" of an '
        "encoder; required for a drive.",
    )
    counts_per_rev: int = declare_key(
        KeyRange(-100_000_000, 100_000_000),
        meaning="Counts per spindle revolution, at least 16; negative if the encoder counts down with M03.",
    )

    @property
    def object_address(self) -> tuple[int, int]:
        """Return the index and sub-index of the position object."""
        return parse_sdo_address(self.object or POSITION) or (0, 0)


def _encoder_rules(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    if ENCODER in file.tables:
        yield from _beside(values)
        yield from _counts(file)
    used = values.text(f"{ENCODER}.node") if values.has_values(f"{ENCODER}.node") else ""
    for name in file.list_table_keys(NODES):
        path = f"{NODES}.{name}.profile"
        number = values.read_integer(path) if values.has_values(path) else MODULE
        if number not in {MODULE, DRIVE, ENCODER_PROFILE}:
            yield FileFinding(
                path, str(number), "the profile must be 401 (terminals), 402 (drive) or 406 (encoder)"
            )
        elif number == ENCODER_PROFILE and name != used:
            why = Message(
                "this encoder is not used; {encoder} names the encoder that is used", encoder=ENCODER
            )
            yield FileFinding(path, str(number), why)


def _beside(values: FileValues) -> Iterator[FileFinding]:
    if values.has_values("machine.backend") and values.text("machine.backend") != "canopen":
        backend = format_toml_value(values.text("machine.backend"))
        yield FileFinding(
            ENCODER,
            "",
            Message(
                "backend {backend} does not support an encoder on a bus; remove this entry", backend=backend
            ),
        )
    if values.has_values("spindle.driver") and values.text("spindle.driver") != "vfd":
        expected = (
            'spindle.driver must be "vfd"; a drive on the bus has its own encoder, set by '
            "counts_per_rev of its node"
        )
        yield FileFinding(ENCODER, "", expected)
    path = f"{ENCODER}.counts_per_rev"
    if values.has_values(path) and abs(values.read_number(path)) < _MIN_COUNTS:
        expected = Message(
            "enter at least {minimum} counts; if the encoder counts down with M03, put a "
            "minus sign before the number",
            minimum=_MIN_COUNTS,
        )
        yield FileFinding(path, f"{values.read_number(path):g}", expected)


def _counts(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    if not values.has_values(f"{ENCODER}.node", f"{ENCODER}.object"):
        return
    node, counted = values.text(f"{ENCODER}.node"), values.text(f"{ENCODER}.object")
    if node not in file.list_table_keys(NODES):
        yield FileFinding(
            f"{ENCODER}.node",
            format_toml_value(node),
            "the encoder node must be a node of [canopen.nodes] with profile = 406",
        )
    elif read_node_profile(file, node) == MODULE:
        yield FileFinding(
            f"{ENCODER}.node",
            format_toml_value(node),
            "an I/O module does not count revolutions; use a node with profile 406 or a drive",
        )
    elif read_node_profile(file, node) == DRIVE and not counted:
        expected = (
            "this entry is missing; enter the object of the second encoder from the "
            'drive\'s manual, such as "60E4:1"'
        )
        yield FileFinding(f"{ENCODER}.object", "", expected)
    if counted and parse_sdo_address(counted) is None:
        yield FileFinding(
            f"{ENCODER}.object",
            format_toml_value(counted),
            Message(
                'the encoder object must be an index and sub-index, such as "{position}"', position=POSITION
            ),
        )


_ENCODER_TABLE = DriverTable(
    ENCODER,
    EncoderTable,
    check_rules=_encoder_rules,
    purpose="An encoder on the CANopen bus for a spindle that an inverter drives.",
)

DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "canopen",
            CanopenTable,
            lambda file: {"nodes": tuple(build_node(file, name) for name in file.list_table_keys(NODES))},
            ("nodes", "sdo"),
            read_nodes,
            check_bus_settings,
            purpose='The CANopen bus and its drives (`backend = "canopen"`).',
            sub_tables=(NODE_REFERENCE, SDO_REFERENCE),
        ),
        _ENCODER_TABLE,
    ),
    backend_name="canopen",
    spindle="cia402",
    max_count_rate=2.0**23,
    normalize_terminal=resolve_terminal,
    inputs=generate_input_addresses,
)
