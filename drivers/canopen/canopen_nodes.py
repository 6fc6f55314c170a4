"""CANopen nodes of the machine file: device profiles, drive families, objects and terminal addresses."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeGuard

from core.key_declaration import KeyRange, declare_key, make_key_table
from core.secret_values import format_toml_value
from core.table_schema import (
    FileFinding,
    MachineFileReading,
    TableDescription,
    find_unknown_keys,
    make_table_finding,
    read_named_tables,
)
from drivers.canopen.drive_profiles import PROFILES

FIRST_MODULE_ADDRESS = "401"  # Stands for the first I/O module in addresses.
DRIVE, MODULE, ENCODER_PROFILE = 402, 401, 406  # Profiles of CiA.
NODES, SDO, SPINDLE = "canopen.nodes", "canopen.sdo", "spindle"
_TERMINAL_PATTERN = re.compile(r"([A-Za-z0-9_]+)\.([0-9A-Fa-f]{4})\.(\d{1,3})(?:\.(\d{1,2}))?")
_OBJECT_PATTERN = re.compile(r"([0-9A-Fa-f]{4}):(\d{1,3})")
INPUT, BITS = 0x6000, 8  # The object of a module's inputs, and the bits of a byte.
_WINDOW, _OFF = 0x6065, 0xFFFFFFFF
_LOW, _HIGH = -(2**31), 2**32 - 1  # Range of an object value.
_SLOW_VALUE_PERIOD_S = 0.01  # s

CYCLIC_MODES = ("csp", "ip")  # Modes with one setpoint per SYNC.
MAX_SYNC_DELAY_FRACTION = 0.25  # Fraction of a period by which a SYNC may be late.
SDO_REFERENCE = TableDescription(
    "canopen.sdo.…",
    "Objects that TurnDesk writes to a node at each start and reads back; the last word "
    "of the heading is the node, or `all` for every drive. The key is index:sub-index, "
    'such as `"6007:0"`, with the index in hexadecimal; the value is a 32-bit integer.',
)
# Index, sub-index and value, written at every start and read back.
ObjectValues = tuple[tuple[int, int, int], ...]


@make_key_table
class CanNode:
    """Node of the CAN bus.

    ``name`` is the name of an axis, "spindle", or the name of an I/O module.
    """

    name: str
    id: int = declare_key(KeyRange(1, 127), meaning="Node number set at the device.")
    profile: int = declare_key(
        KeyRange(401, 406),
        default=402,
        meaning="Device profile of CiA: 402 (drive), 401 (input and output module) or 406 (encoder).",
    )
    drive: str = declare_key(
        default="",
        choices=tuple(PROFILES),
        meaning="Family of the drive. Default: `drive` of [canopen]; without it the family that the EDS "
        "file names, or plain CiA 402.",
    )
    eds: str = declare_key(
        default="",
        meaning="EDS file of the device, in the folder of the machine file. Default: the objects of the "
        "family or of the standard.",
    )
    counts_per_rev: int = declare_key(
        KeyRange(0, 100_000_000),
        default=0,
        meaning="Encoder counts per motor revolution, 4 × the lines, for drives that use rpm as their unit "
        "of speed. 0: the drive uses counts/s. For the spindle: counts per spindle revolution, needed for "
        "threads and C.",
    )
    sdo: ObjectValues = ()  # First the objects for all nodes of its profile, then its own.


NODE_REFERENCE = TableDescription(
    "canopen.nodes.…",
    "A device on the bus. A drive must be named after its axis or be named "
    "`spindle`; other devices can have any name.",
    CanNode,
)


@dataclass(frozen=True, slots=True)
class CanTerminal:
    """Terminal on the bus: one bit of an object of an I/O module or axis drive.

    If ``bit_number`` is -1, the terminal is the complete value of the object.
    """

    node_name: str
    index: int
    object_subindex: int
    bit_number: int = -1
    is_active_low: bool = False


def get_slow_reply_divisor(sync_period_s: float) -> int:
    """Return the number of SYNCs per reply with slow values, for replies about 10 ms apart."""
    return max(1, round(_SLOW_VALUE_PERIOD_S / sync_period_s))


# --- addresses -------------------------------------------------------------------------------------------


def parse_terminal(text: str) -> CanTerminal | None:
    """Parse a terminal address such as ``401.6200.1.0`` into node, object, sub-index and bit.

    Return None if the text is not a terminal address.
    """
    found = _TERMINAL_PATTERN.fullmatch(text)
    if found is None:
        return None
    node, index, sub, bit = found.groups()
    return CanTerminal(node, int(index, 16), int(sub), int(bit) if bit else -1)


def parse_sdo_address(text: str) -> tuple[int, int] | None:
    """Parse an object address such as ``6007:0`` into index and sub-index.

    Return None if the text is not an object address.
    """
    found = _OBJECT_PATTERN.fullmatch(text)
    if found is None or int(found[2]) > 255:
        return None
    return int(found[1], 16), int(found[2])


def resolve_terminal(file: MachineFileReading, text: str) -> CanTerminal | None:
    """Parse a terminal address and replace the node 401 by the name of the first I/O module.

    Return None if the text is not a terminal address.
    """
    found = parse_terminal(text)
    if found is None or found.node_name != FIRST_MODULE_ADDRESS:
        return found
    return replace(found, node_name=next(iter(list_module_names(file)), FIRST_MODULE_ADDRESS))


def generate_input_addresses() -> Iterator[str]:
    """Yield addresses for the inputs of the first I/O module, bit by bit and without end.

    The sequence does not depend on the number of inputs of the module.
    """
    return (f"{FIRST_MODULE_ADDRESS}.{INPUT:04X}.{n // BITS + 1}.{n % BITS}" for n in itertools.count())


# --- reading ---------------------------------------------------------------------------------------------


def read_nodes(file: MachineFileReading) -> Iterator[FileFinding]:
    """Read [canopen.nodes], and yield the findings about this table and about [canopen.sdo]."""
    nodes, objects = file.raw(NODES), file.raw(SDO)
    yield from read_named_tables({} if nodes is None else nodes, CanNode, NODES, file.file_values)
    if objects is None:
        return
    if not isinstance(objects, dict):
        yield make_table_finding(SDO, objects)
        return
    yield from find_unknown_keys(objects, ["all", *file.list_table_keys(NODES)], SDO)
    for node, entries in objects.items():
        path = f"{SDO}.{node}"
        if not isinstance(entries, dict):
            yield make_table_finding(path, entries)
            continue
        for key, value in entries.items():
            if why := _describe_bad_object(key, value):
                yield FileFinding(f'{path}."{key}"', format_toml_value(value), why)


def _describe_bad_object(key: str, value: object) -> str:
    """Return the reason why an entry of [canopen.sdo] is invalid, or an empty string if it is valid."""
    address = parse_sdo_address(key)
    if address is None:
        return 'the key must be an object address with the index in hexadecimal, such as "6007:0"'
    if not _whole(value) or not _LOW <= value <= _HIGH:
        return "the value must be a 32-bit integer"
    if address[0] == _WINDOW and value % 2**32 == _OFF:
        return "this value turns off the drive's following error monitoring; enter a following error window"
    return ""


def _whole(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool)


def read_sdo_objects(file: MachineFileReading, node: str) -> ObjectValues:
    """Return the valid entries of [canopen.sdo] for one node, or for all nodes if ``node`` is "all"."""
    entries = file.raw(f"{SDO}.{node}")
    found = entries.items() if isinstance(entries, dict) else ()
    return tuple(
        (*address, value)
        for key, value in found
        if (address := parse_sdo_address(key)) and _whole(value) and not _describe_bad_object(key, value)
    )


def format_object_path(node: str, index: int, subindex: int) -> str:
    """Return the path of an object of a node in the notation of the machine file."""
    return f'{SDO}.{node}."{index:04X}:{subindex}"'


def build_node(file: MachineFileReading, name: str) -> CanNode:
    """Build a node from a valid machine file, including all objects that TurnDesk writes to the node."""
    shared = read_sdo_objects(file, "all") if read_node_profile(file, name) == DRIVE else ()
    return file.file_values.make_model(
        CanNode,
        f"{NODES}.{name}",
        name=name,
        drive=read_drive_family(file, name),
        sdo=(*shared, *read_sdo_objects(file, name)),
    )


def read_drive_family(file: MachineFileReading, name: str) -> str:
    """Return the drive family of a node, or an empty string if the node is not a drive.

    If the node does not specify a family, return the default family of all drives.
    """
    if read_node_profile(file, name) != DRIVE:
        return ""
    paths = (f"{NODES}.{name}.drive", "canopen.drive")
    return next((found for path in paths if (found := read_key_text(file, path))), "")


def read_key_text(file: MachineFileReading, path: str) -> str:
    """Return the text of a key, or an empty string if the key is missing or its value is invalid."""
    return file.file_values.text(path) if file.file_values.has_values(path) else ""


def read_node_profile(file: MachineFileReading, node: str) -> int:
    """Return the CiA profile of a node, or 0 if the machine file does not specify a profile."""
    path = f"{NODES}.{node}.profile"
    return file.file_values.read_integer(path) if file.file_values.has_values(path) else 0


def list_module_names(file: MachineFileReading) -> list[str]:
    """Return the names of the I/O modules, in the same order as in the machine file."""
    return [name for name in file.list_table_keys(NODES) if read_node_profile(file, name) == MODULE]
