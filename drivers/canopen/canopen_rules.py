"""Rules for the tables [canopen]: bus load, times, node numbers, drive families and terminals.

A frame with an 11-bit identifier and n bytes has at most 47 + 8 n + (34 + 8 n - 1) / 4 bits. This includes
bit stuffing and the three bits between frames.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from core.message import Message
from core.secret_values import format_toml_value
from core.table_schema import FileFinding, FileValues, MachineFileReading
from drivers.canopen.canopen_nodes import (
    BITS,
    CYCLIC_MODES,
    DRIVE,
    FIRST_MODULE_ADDRESS,
    INPUT,
    MODULE,
    NODES,
    SDO,
    SPINDLE,
    format_object_path,
    get_slow_reply_divisor,
    list_module_names,
    parse_terminal,
    read_drive_family,
    read_key_text,
    read_node_profile,
    read_sdo_objects,
)
from drivers.canopen.drive_profiles import PROFILES, QUEUE_PROFILE_NAMES, RPM_PROFILE_NAMES

_COMMAND, _ANSWER, _MORE = 7, 7, 8  # Bytes of RPDO1, of TPDO1, and of PDOs that are sent less often.
_MAX_BUS_LOAD = 0.75  # Fraction of the time; the rest is for SDO, heartbeats, EMCY and a frame in transit.


class BusLoad(NamedTuple):
    """Bus load in bits per SYNC period.

    It consists of the frames at each SYNC, and the mean load of the frames that are sent less often.
    """

    bits_per_sync: float
    slow_bits_per_sync: float
    capacity_bits: float  # Bits that fit between two SYNCs.

    @property
    def used_fraction(self) -> float:
        """Return the load as a fraction of the bus capacity."""
        return (self.bits_per_sync + self.slow_bits_per_sync) / self.capacity_bits

    @property
    def has_reserve(self) -> bool:
        """Return whether the load leaves the required reserve of bus capacity."""
        return self.used_fraction <= _MAX_BUS_LOAD


def get_max_frame_bits(data_bytes: int) -> int:
    """Return the maximum length in bits of a frame with ``data_bytes`` data bytes."""
    return 47 + 8 * data_bytes + (34 + 8 * data_bytes - 1) // 4


def calculate_cyclic_bus_load(
    axis_count: int, other_count: int, bitrate: int, sync_period_s: float, slow_divisor: int
) -> BusLoad:
    """Return the bus load in cyclic modes.

    Each of the ``axis_count`` axis drives receives a command and sends a reply at every SYNC. Once per
    ``slow_divisor`` SYNCs, each axis drive also sends a second reply, and each of the ``other_count`` other
    devices exchanges two frames.
    """
    exchange_bits = get_max_frame_bits(_COMMAND) + get_max_frame_bits(_ANSWER)
    each = get_max_frame_bits(0) + axis_count * exchange_bits
    rare = axis_count * get_max_frame_bits(_MORE) + other_count * 2 * get_max_frame_bits(_MORE)
    return BusLoad(each, rare / slow_divisor, bitrate * sync_period_s)


_ANALOG, _OUTPUT, _DRIVE_INPUT = 0x6401, 0x6200, 0x60FD
_LIMITS, _WATCH = 0x607D, 0x1016
_BYTES, _WORDS = 8, 4  # Contents of one PDO of each kind of a module.
_MAX_COUNT = 2**31 - 1  # Maximum of a signed 32-bit count.
_CYCLES, _CYCLIC_LEAST = 4, 0.02  # SYNCs and seconds for the transfer of cyclic setpoints.
_PVT_RESTART_S = 0.04  # Seconds that a drive needs between two PVT motions.
_MIN_RECORDS = 3  # A drive treats a queue with fewer than two records as empty.


def check_bus_settings(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield the findings about [canopen], and about the axes and terminals on the bus."""
    yield from _check_travel(file)
    if "canopen" not in file.tables:
        return
    yield from _times(file.file_values)
    yield from _check_node_numbers(file)
    yield from _check_heartbeat(file)
    if file.file_values.has_text("machine.backend", "canopen"):
        yield from _check_drives(file)
        yield from _check_families(file)
        yield from _check_cyclic_load(file)
        yield from _check_terminals(file)


def _times(values: FileValues) -> Iterator[FileFinding]:
    if values.has_values("canopen.heartbeat_ms", "canopen.sync_ms"):
        beat, sync = values.read_number("canopen.heartbeat_ms"), values.read_number("canopen.sync_ms")
        if beat < 2 * sync:
            yield FileFinding(
                "canopen.heartbeat_ms",
                f"{1000 * beat:g}",
                "the heartbeat time must be at least twice sync_ms",
            )
    if values.has_text("canopen.mode", "pvt") and values.has_values("canopen.record_ms", "machine.commit_ms"):
        yield from _queue(
            values.read_number("canopen.record_ms"), values.read_number("machine.commit_ms"), values
        )


def _queue(record: float, commit: float, values: FileValues) -> Iterator[FileFinding]:
    if abs(1000 * record - round(1000 * record)) > 1e-6:
        yield FileFinding(
            "canopen.record_ms",
            f"{1000 * record:g}",
            "the record time must be a whole number of milliseconds, the time unit of PVT",
        )
    least = _MIN_RECORDS * record + _PVT_RESTART_S
    if values.has_text("machine.backend", "canopen") and commit < least - 1e-9:
        expected = Message(
            "the time must be at least {minimum} ms to cover a restart and the {records} "
            "PVT records queued in the drives",
            minimum=f"{1000 * least:g}",
            records=_MIN_RECORDS,
        )
        yield FileFinding("machine.commit_ms", f"{1000 * commit:g}", expected)


def _check_families(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings if drives lack a position queue or counts per revolution that they require."""
    values, moved = file.file_values, file.axes
    queued = " or ".join(format_toml_value(name) for name in QUEUE_PROFILE_NAMES)
    for name in file.list_table_keys(NODES):
        family, path = read_drive_family(file, name), f"{NODES}.{name}"
        unknown = {f"{path}.drive", "canopen.drive"} & values.invalid_paths
        if name not in moved or read_node_profile(file, name) != DRIVE or unknown:
            continue
        known = family or read_key_text(file, f"{path}.eds")
        if values.has_text("canopen.mode", "pvt") and (
            not known or (family and family not in QUEUE_PROFILE_NAMES)
        ):
            why = Message(
                'the drive must be {queued}, because mode "pvt" needs a drive with a queue; '
                'with other drives, use "csp", "ip" or "pp"',
                queued=queued,
            )
            yield FileFinding(f"{path}.drive", format_toml_value(family) if family else "", why)
        counts = f"{path}.counts_per_rev"
        if family in RPM_PROFILE_NAMES and values.has_values(counts) and values.read_number(counts) == 0:
            title = PROFILES[family].display_name
            why = Message(
                "this entry is missing; {title} reports speeds in rpm, so enter 4 × the "
                "encoder pulses per revolution",
                title=title,
            )
            yield FileFinding(counts, "", why)


def _check_cyclic_load(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about the settings for cyclic setpoints.

    The SYNC period must be a whole number of milliseconds. The bus load and the commit time are also
    checked.
    """
    values = file.file_values
    if read_key_text(file, "canopen.mode") not in CYCLIC_MODES or not values.has_values(
        "canopen.sync_ms", "canopen.bitrate"
    ):
        return
    sync, bitrate = values.read_number("canopen.sync_ms"), values.read_integer("canopen.bitrate")
    if abs(1000 * sync - round(1000 * sync)) > 1e-6:
        yield FileFinding(
            "canopen.sync_ms",
            f"{1000 * sync:g}",
            "the time must be a whole number of milliseconds, the time unit of object 60C2",
        )
    if values.has_values("machine.commit_ms"):
        commit, least = values.read_number("machine.commit_ms"), max(_CYCLES * sync, _CYCLIC_LEAST)
        if commit < least - 1e-9:
            expected = Message(
                "the time must be at least {minimum} ms to cover the setpoints in transit to the drives",
                minimum=f"{1000 * least:g}",
            )
            yield FileFinding("machine.commit_ms", f"{1000 * commit:g}", expected)
    nodes = file.list_table_keys(NODES)
    slides = sum(name in file.axes for name in nodes)
    load = calculate_cyclic_bus_load(slides, len(nodes) - slides, bitrate, sync, get_slow_reply_divisor(sync))
    if not load.has_reserve:
        fits = next((ms for ms in range(1, 101) if _fits(slides, len(nodes) - slides, bitrate, ms)), 0)
        expected = Message(
            "{axes} axis drives use {share} of the bus capacity of {bitrate} bit/s, which is too much",
            axes=slides,
            share=f"{load.used_fraction:.0%}",
            bitrate=f"{bitrate:g}",
        )
        best = Message("; set sync_ms to at least {fits}", fits=fits) if fits else ""
        yield FileFinding("canopen.sync_ms", f"{1000 * sync:g}", expected + best)


def _fits(slides: int, others: int, bitrate: int, ms: int) -> bool:
    return calculate_cyclic_bus_load(
        slides, others, bitrate, 0.001 * ms, get_slow_reply_divisor(0.001 * ms)
    ).has_reserve


def _check_node_numbers(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about the numbers, names and profiles of the nodes."""
    values, moved = file.file_values, (*file.axes, SPINDLE)
    taken: dict[int, str] = {}
    if values.has_values("canopen.host_id"):
        taken[values.read_integer("canopen.host_id")] = "canopen.host_id"
    for name in file.list_table_keys(NODES):
        path = f"{NODES}.{name}"
        if not values.has_values(f"{path}.id", f"{path}.profile"):
            continue
        number, profile = values.read_integer(f"{path}.id"), values.read_integer(f"{path}.profile")
        first = taken.setdefault(number, path)
        if first != path:
            yield FileFinding(
                f"{path}.id",
                str(number),
                Message("{first} already uses this node number; choose another number", first=first),
            )
        if profile == DRIVE and name not in moved:
            why = Message(
                "a drive must be named after the axis or spindle that it moves: {moved}; for an I/O "
                "module, set profile = 401",
                moved=", ".join(moved),
            )
            yield FileFinding(path, "", why)
        if profile != DRIVE and name in moved:
            yield FileFinding(f"{path}.profile", str(profile), "the profile must be 402 (drive)")


def _check_heartbeat(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings if object 1016h does not monitor this computer, or if its timeout is too short."""
    values = file.file_values
    if not values.has_values("canopen.host_id", "canopen.heartbeat_ms"):
        return
    host, beat = values.read_integer("canopen.host_id"), values.read_number("canopen.heartbeat_ms")
    for node in file.list_table_keys(SDO):
        for index, sub, value in read_sdo_objects(file, node):
            if index != _WATCH or sub == 0:
                continue
            watched, patience = value >> 16 & 0x7F, (value & 0xFFFF) / 1000.0
            if watched != host or patience < 2 * beat:
                best = host << 16 | round(3000 * beat)
                expected = Message(
                    "this entry monitors node {watched} with a timeout of {patience} ms; enter "
                    "{best} to monitor the host with a timeout of 3 heartbeats",
                    watched=watched,
                    patience=f"{1000 * patience:g}",
                    best=best,
                )
                yield FileFinding(format_object_path(node, index, sub), str(value), expected)


_C_REMEDY_TEXT = (
    "; the spindle drive can also serve as the C axis: set its counts_per_rev, set "
    '[canopen] mode = "pvt" and omit axis.C.own_drive'
)


def _check_drives(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about axes that lack a drive or a homing method."""
    values, nodes = file.file_values, file.list_table_keys(NODES)
    for axis in file.axes:
        if axis == "C" and not (values.has_values("axis.C.enabled") and values.read_flag("axis.C.enabled")):
            continue
        method = f"axis.{axis}.home.method"
        if axis not in nodes and not (axis == "C" and _is_c_on_spindle(file)):
            own = _C_REMEDY_TEXT if axis == "C" and values.has_text("spindle.driver", "cia402") else ""
            yield FileFinding(
                f"{NODES}.{axis}",
                "",
                Message("this entry is missing; axis {axis} needs a drive{own}", axis=axis, own=own),
            )
        if values.has_values(method) and values.read_number(method) == 0:
            yield FileFinding(
                method,
                "",
                "this entry is missing; enter the number of the drive's homing method (1 or 2 for "
                "homing on a limit switch)",
            )
    if values.has_text("spindle.driver", "cia402") and SPINDLE not in nodes:
        yield FileFinding(
            f"{NODES}.spindle", "", 'this entry is missing; spindle.driver = "cia402" needs a drive'
        )


def _is_c_on_spindle(file: MachineFileReading) -> bool:
    """Return whether the spindle drive of a lathe can also serve as the C axis.

    For this, the drive needs counts per revolution and a position queue.
    """
    values, counts = file.file_values, f"{NODES}.{SPINDLE}.counts_per_rev"
    own = values.has_values("axis.C.own_drive") and values.read_flag("axis.C.own_drive")
    drives = values.has_text("spindle.driver", "cia402") and values.has_text("canopen.mode", "pvt")
    return drives and not own and values.has_values(counts) and values.read_number(counts) > 0


def _check_travel(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield findings about axes whose travel is too long for their drives.

    The travel must not exceed the range of the drive's counter or the software limits of the drive.
    """
    values = file.file_values
    for axis in file.axes:
        path, counted = f"axis.{axis}.travel", f"axis.{axis}.count"
        if axis not in file.list_table_keys(NODES) or not values.has_values(path, counted):
            continue
        count, ends = values.read_number(counted), values.read_pair(path)
        if math.inf in map(abs, ends):
            continue  # A rotary axis without limits.
        if max(map(abs, ends)) / count > _MAX_COUNT:
            yield FileFinding(
                path,
                "",
                Message(
                    "the travel exceeds the counting range of a drive, {maximum} counts (resolution: "
                    "{count} per count)",
                    maximum=_MAX_COUNT,
                    count=f"{count:g}",
                ),
            )
        for node in ("all", axis):
            for index, sub, value in read_sdo_objects(file, node):
                if index != _LIMITS or sub not in {1, 2}:
                    continue
                signed = value - 2**32 if value > _MAX_COUNT else value
                needed = round(ends[sub - 1] / count)
                if signed > needed if sub == 1 else signed < needed:
                    why = Message(
                        "this software limit allows less travel than {path}, which needs a limit of "
                        "{needed} counts",
                        path=path,
                        needed=needed,
                    )
                    yield FileFinding(format_object_path(node, index, sub), str(value), why)


# --- terminals: bits and words of the modules --------------------------------------------------------------


def _check_terminals(file: MachineFileReading) -> Iterator[FileFinding]:
    """Yield a finding for every signal or pot whose terminal is not an address on the bus."""
    if any(path.endswith(".profile") for path in file.file_values.invalid_paths):
        return  # The nodes that are modules are not known.
    for path, terminal in file.terminals.items():
        if why := _wrong_terminal(file, terminal, output=path.startswith("io.out."), analog=False):
            yield FileFinding(f"{path}.at", format_toml_value(terminal), why)
    for path, terminal in file.find_wired_pots().items():
        if why := _wrong_terminal(file, terminal, output=False, analog=True):
            yield FileFinding(f"{path}.at", format_toml_value(terminal), why)


def _wrong_terminal(file: MachineFileReading, text: str, *, output: bool, analog: bool) -> str:
    terminal = parse_terminal(text)
    sample = "401.6401.1" if analog else "401.6200.1.0" if output else "401.6000.1.0"
    if terminal is None or (terminal.bit_number < 0) != analog:
        template = (
            'the address must consist of node, object and sub-index, such as "{sample}"'
            if analog
            else 'the address must consist of node, object, sub-index and bit, such as "{sample}"'
        )
        return Message(template, sample=sample)
    modules = list_module_names(file)
    plain = terminal.node_name == FIRST_MODULE_ADDRESS
    profile = (MODULE if modules else 0) if plain else read_node_profile(file, terminal.node_name)
    if not profile:
        return Message(
            "the address must name an I/O module of [canopen.nodes]: {modules}",
            modules=", ".join(modules) or "none defined",
        )
    if profile == DRIVE:
        right = terminal.index == _DRIVE_INPUT and not output and not analog and terminal.bit_number < 32
        return (
            ""
            if right
            else ("a drive can provide only digital inputs; specify object 60FD.0 and a bit from 0 to 31")
        )
    wanted = _ANALOG if analog else _OUTPUT if output else INPUT
    most = _WORDS if analog else _BYTES
    if terminal.index != wanted or not 1 <= terminal.object_subindex <= most:
        return Message(
            "the address must contain object {expected} with sub-index 1…{maximum}",
            expected=f"{wanted:04X}",
            maximum=most,
        )
    return "" if terminal.bit_number < BITS else "the bit number must be from 0 to 7"
