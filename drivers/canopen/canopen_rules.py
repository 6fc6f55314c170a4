"""Rules of [canopen]: bus load, times, node numbers, drives with their families, and terminals.

A frame with an 11-bit identifier and n bytes has at most 47 + 8 n + (34 + 8 n - 1) / 4 bits. This includes
bit stuffing and the three bits between frames.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from core.message import Message
from core.table_schema import FileReading, Finding, Values, written
from drivers.canopen.canopen_nodes import (
    BITS,
    CYCLIC,
    DRIVE,
    INPUT,
    MODULE,
    NODES,
    PLAIN_MODULE,
    SDO,
    SPINDLE,
    can_terminal,
    family_of,
    module_names,
    object_path,
    objects_of,
    profile_of,
    said,
    seldom,
)
from drivers.canopen.drive_profiles import IN_RPM, PROFILES, QUEUED

_COMMAND, _ANSWER, _MORE = 7, 7, 8  # Bytes of RPDO1, of TPDO1, and of PDOs that are sent less often.
_MOST_USED = 0.75  # Fraction of the time; the rest is for SDO, heartbeats, EMCY and a frame in transit.


class Load(NamedTuple):
    """Bus load in bits per SYNC period, split into frames at each SYNC and the mean of rarer frames."""

    each: float
    seldom: float
    room: float  # Bits that fit between two SYNCs.

    @property
    def share(self) -> float:
        """The fraction of the bus capacity that is used."""
        return (self.each + self.seldom) / self.room

    @property
    def fits(self) -> bool:
        """Whether the load leaves the required reserve."""
        return self.share <= _MOST_USED


def frame_bits(size: int) -> int:
    """Return the maximum length in bits of a frame with ``size`` bytes."""
    return 47 + 8 * size + (34 + 8 * size - 1) // 4


def cyclic_load(slides: int, others: int, bitrate: int, sync: float, seldom: int) -> Load:
    """Return the bus load of cyclic modes.

    Each of the ``slides`` axis drives receives a command and replies at every SYNC. The ``others`` and second
    replies are sent every ``seldom`` SYNCs.
    """
    told = frame_bits(_COMMAND) + frame_bits(_ANSWER)
    each = frame_bits(0) + slides * told
    rare = slides * frame_bits(_MORE) + others * 2 * frame_bits(_MORE)
    return Load(each, rare / seldom, bitrate * sync)


_ANALOG, _OUTPUT, _DRIVE_INPUT = 0x6401, 0x6200, 0x60FD
_LIMITS, _WATCH = 0x607D, 0x1016
_BYTES, _WORDS = 8, 4  # Contents of one PDO of each kind of a module.
_MOST = 2**31 - 1  # Maximum of a signed 32-bit count.
_CYCLES, _CYCLIC_LEAST = 4, 0.02  # SYNCs and seconds for the transfer of cyclic setpoints.
_RESTART = 0.04  # Seconds that a drive needs between two PVT motions.
_RECORDS = 3  # A drive treats a queue with fewer than two records as empty.


def bus_rules(file: FileReading) -> Iterator[Finding]:
    """Yield findings about [canopen] and about the axes and terminals on the bus."""
    yield from _outside(file)
    if "canopen" not in file.tables:
        return
    yield from _times(file.values)
    yield from _numbers(file)
    yield from _heartbeat(file)
    if file.values.says("machine.backend", "canopen"):
        yield from _drives(file)
        yield from _families(file)
        yield from _cyclic(file)
        yield from _wired(file)


def _times(values: Values) -> Iterator[Finding]:
    if values.has("canopen.heartbeat_ms", "canopen.sync_ms"):
        beat, sync = values.number("canopen.heartbeat_ms"), values.number("canopen.sync_ms")
        if beat < 2 * sync:
            yield Finding(
                "canopen.heartbeat_ms",
                f"{1000 * beat:g}",
                "the heartbeat time must be at least twice sync_ms",
            )
    if values.says("canopen.mode", "pvt") and values.has("canopen.record_ms", "machine.commit_ms"):
        yield from _queue(values.number("canopen.record_ms"), values.number("machine.commit_ms"), values)


def _queue(record: float, commit: float, values: Values) -> Iterator[Finding]:
    if abs(1000 * record - round(1000 * record)) > 1e-6:
        yield Finding(
            "canopen.record_ms",
            f"{1000 * record:g}",
            "the record time must be a whole number of milliseconds, the time unit of PVT",
        )
    least = _RECORDS * record + _RESTART
    if values.says("machine.backend", "canopen") and commit < least - 1e-9:
        expected = Message(
            "the time must be at least {minimum} ms to cover a restart and the {records} "
            "PVT records queued in the drives",
            minimum=f"{1000 * least:g}",
            records=_RECORDS,
        )
        yield Finding("machine.commit_ms", f"{1000 * commit:g}", expected)


def _families(file: FileReading) -> Iterator[Finding]:
    """Yield findings about queues and counts per revolution that the drive families need."""
    values, moved = file.values, file.axes
    queued = " or ".join(written(name) for name in QUEUED)
    for name in file.names(NODES):
        family, path = family_of(file, name), f"{NODES}.{name}"
        unknown = {f"{path}.drive", "canopen.drive"} & values.wrong
        if name not in moved or profile_of(file, name) != DRIVE or unknown:
            continue
        known = family or said(file, f"{path}.eds")
        if values.says("canopen.mode", "pvt") and (not known or (family and family not in QUEUED)):
            why = Message(
                'the drive must be {queued}, because mode "pvt" needs a drive with a queue; '
                'with other drives, use "csp", "ip" or "pp"',
                queued=queued,
            )
            yield Finding(f"{path}.drive", written(family) if family else "", why)
        counts = f"{path}.counts_per_rev"
        if family in IN_RPM and values.has(counts) and values.number(counts) == 0:
            title = PROFILES[family].title
            why = Message(
                "this entry is missing; {title} reports speeds in rpm, so enter 4 × the "
                "encoder pulses per revolution",
                title=title,
            )
            yield Finding(counts, "", why)


def _cyclic(file: FileReading) -> Iterator[Finding]:
    """Yield findings about cyclic setpoints: whole milliseconds, commit time and bus load."""
    values = file.values
    if said(file, "canopen.mode") not in CYCLIC or not values.has("canopen.sync_ms", "canopen.bitrate"):
        return
    sync, bitrate = values.number("canopen.sync_ms"), values.whole("canopen.bitrate")
    if abs(1000 * sync - round(1000 * sync)) > 1e-6:
        yield Finding(
            "canopen.sync_ms",
            f"{1000 * sync:g}",
            "the time must be a whole number of milliseconds, the time unit of object 60C2",
        )
    if values.has("machine.commit_ms"):
        commit, least = values.number("machine.commit_ms"), max(_CYCLES * sync, _CYCLIC_LEAST)
        if commit < least - 1e-9:
            expected = Message(
                "the time must be at least {minimum} ms to cover the setpoints in transit to the drives",
                minimum=f"{1000 * least:g}",
            )
            yield Finding("machine.commit_ms", f"{1000 * commit:g}", expected)
    nodes = file.names(NODES)
    slides = sum(name in file.axes for name in nodes)
    load = cyclic_load(slides, len(nodes) - slides, bitrate, sync, seldom(sync))
    if not load.fits:
        fits = next((ms for ms in range(1, 101) if _fits(slides, len(nodes) - slides, bitrate, ms)), 0)
        expected = Message(
            "{axes} axis drives use {share} of the bus capacity of {bitrate} bit/s, which is too much",
            axes=slides,
            share=f"{load.share:.0%}",
            bitrate=f"{bitrate:g}",
        )
        best = Message("; set sync_ms to at least {fits}", fits=fits) if fits else ""
        yield Finding("canopen.sync_ms", f"{1000 * sync:g}", expected + best)


def _fits(slides: int, others: int, bitrate: int, ms: int) -> bool:
    return cyclic_load(slides, others, bitrate, 0.001 * ms, seldom(0.001 * ms)).fits


def _numbers(file: FileReading) -> Iterator[Finding]:
    """Yield findings about numbers, names and profiles of the nodes."""
    values, moved = file.values, (*file.axes, SPINDLE)
    taken: dict[int, str] = {}
    if values.has("canopen.host_id"):
        taken[values.whole("canopen.host_id")] = "canopen.host_id"
    for name in file.names(NODES):
        path = f"{NODES}.{name}"
        if not values.has(f"{path}.id", f"{path}.profile"):
            continue
        number, profile = values.whole(f"{path}.id"), values.whole(f"{path}.profile")
        first = taken.setdefault(number, path)
        if first != path:
            yield Finding(
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
            yield Finding(path, "", why)
        if profile != DRIVE and name in moved:
            yield Finding(f"{path}.profile", str(profile), "the profile must be 402 (drive)")


def _heartbeat(file: FileReading) -> Iterator[Finding]:
    """Yield findings if 0x1016 does not monitor this computer, or has too short a timeout."""
    values = file.values
    if not values.has("canopen.host_id", "canopen.heartbeat_ms"):
        return
    host, beat = values.whole("canopen.host_id"), values.number("canopen.heartbeat_ms")
    for node in file.names(SDO):
        for index, sub, value in objects_of(file, node):
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
                yield Finding(object_path(node, index, sub), str(value), expected)


_C_WITHOUT = (
    "; the spindle drive can also serve as the C axis: set its counts_per_rev, set "
    '[canopen] mode = "pvt" and omit axis.C.own_drive'
)


def _drives(file: FileReading) -> Iterator[Finding]:
    """Yield findings about axes without a drive or without a homing method."""
    values, nodes = file.values, file.names(NODES)
    for axis in file.axes:
        if axis == "C" and not (values.has("axis.C.enabled") and values.flag("axis.C.enabled")):
            continue
        method = f"axis.{axis}.home.method"
        if axis not in nodes and not (axis == "C" and _turned_by_spindle(file)):
            own = _C_WITHOUT if axis == "C" and values.says("spindle.driver", "cia402") else ""
            yield Finding(
                f"{NODES}.{axis}",
                "",
                Message("this entry is missing; axis {axis} needs a drive{own}", axis=axis, own=own),
            )
        if values.has(method) and values.number(method) == 0:
            yield Finding(
                method,
                "",
                "this entry is missing; enter the number of the drive's homing method (1 or 2 for "
                "homing on a limit switch)",
            )
    if values.says("spindle.driver", "cia402") and SPINDLE not in nodes:
        yield Finding(
            f"{NODES}.spindle", "", 'this entry is missing; spindle.driver = "cia402" needs a drive'
        )


def _turned_by_spindle(file: FileReading) -> bool:
    """Return whether C of a lathe can be the spindle drive, which needs counts and a position queue."""
    values, counts = file.values, f"{NODES}.{SPINDLE}.counts_per_rev"
    own = values.has("axis.C.own_drive") and values.flag("axis.C.own_drive")
    drives = values.says("spindle.driver", "cia402") and values.says("canopen.mode", "pvt")
    return drives and not own and values.has(counts) and values.number(counts) > 0


def _outside(file: FileReading) -> Iterator[Finding]:
    """Yield findings about axes whose travel exceeds the range or the software limits of their drives."""
    values = file.values
    for axis in file.axes:
        path, counted = f"axis.{axis}.travel", f"axis.{axis}.count"
        if axis not in file.names(NODES) or not values.has(path, counted):
            continue
        count, ends = values.number(counted), values.pair(path)
        if math.inf in map(abs, ends):
            continue  # A rotary axis without limits.
        if max(map(abs, ends)) / count > _MOST:
            yield Finding(
                path,
                "",
                Message(
                    "the travel exceeds the counting range of a drive, {maximum} counts (resolution: "
                    "{count} per count)",
                    maximum=_MOST,
                    count=f"{count:g}",
                ),
            )
        for node in ("all", axis):
            for index, sub, value in objects_of(file, node):
                if index != _LIMITS or sub not in {1, 2}:
                    continue
                signed = value - 2**32 if value > _MOST else value
                needed = round(ends[sub - 1] / count)
                if signed > needed if sub == 1 else signed < needed:
                    why = Message(
                        "this software limit allows less travel than {path}, which needs a limit of "
                        "{needed} counts",
                        path=path,
                        needed=needed,
                    )
                    yield Finding(object_path(node, index, sub), str(value), why)


# --- terminals: bits and words of the modules --------------------------------------------------------------


def _wired(file: FileReading) -> Iterator[Finding]:
    """Yield a finding for every signal and pot whose terminal is not an address on the bus."""
    if any(path.endswith(".profile") for path in file.values.wrong):
        return  # The nodes that are modules are not known.
    for path, terminal in file.terminals.items():
        if why := _wrong_terminal(file, terminal, output=path.startswith("io.out."), analog=False):
            yield Finding(f"{path}.at", written(terminal), why)
    for path, terminal in file.pots().items():
        if why := _wrong_terminal(file, terminal, output=False, analog=True):
            yield Finding(f"{path}.at", written(terminal), why)


def _wrong_terminal(file: FileReading, text: str, *, output: bool, analog: bool) -> str:
    terminal = can_terminal(text)
    sample = "401.6401.1" if analog else "401.6200.1.0" if output else "401.6000.1.0"
    if terminal is None or (terminal.bit < 0) != analog:
        template = (
            'the address must consist of node, object and sub-index, such as "{sample}"'
            if analog
            else 'the address must consist of node, object, sub-index and bit, such as "{sample}"'
        )
        return Message(template, sample=sample)
    modules = module_names(file)
    plain = terminal.node == PLAIN_MODULE
    profile = (MODULE if modules else 0) if plain else profile_of(file, terminal.node)
    if not profile:
        return Message(
            "the address must name an I/O module of [canopen.nodes]: {modules}",
            modules=", ".join(modules) or "none defined",
        )
    if profile == DRIVE:
        right = terminal.index == _DRIVE_INPUT and not output and not analog and terminal.bit < 32
        return (
            ""
            if right
            else ("a drive can provide only digital inputs; specify object 60FD.0 and a bit from 0 to 31")
        )
    wanted = _ANALOG if analog else _OUTPUT if output else INPUT
    most = _WORDS if analog else _BYTES
    if terminal.index != wanted or not 1 <= terminal.sub <= most:
        return Message(
            "the address must contain object {expected} with sub-index 1…{maximum}",
            expected=f"{wanted:04X}",
            maximum=most,
        )
    return "" if terminal.bit < BITS else "the bit number must be from 0 to 7"
