"""[canopen] and [spindle.encoder] of the machine file: bus, nodes, objects and addresses, and their rules."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeGuard

from core.table_schema import (
    Driver,
    DriverTable,
    Field,
    FileReading,
    Finding,
    Kind,
    Unit,
    Values,
    expected_table,
    read_named,
    unknown_keys,
    written,
)
from drivers.canopen.bus_load import cyclic_load
from drivers.canopen.drive_profiles import IN_RPM, PROFILES, QUEUED

PLAIN_MODULE = "401"  # means the first I/O module
ENCODER, POSITION = "spindle.encoder", "6004:0"  # the table, and where a node of CiA 406 has its counts
_DRIVE, _MODULE, _ENCODER = 402, 401, 406  # profiles of CiA
_NODES, _SDO, _SPINDLE = "canopen.nodes", "canopen.sdo", "spindle"
_ADDRESS = re.compile(r"([A-Za-z0-9_]+)\.([0-9A-Fa-f]{4})\.(\d{1,3})(?:\.(\d{1,2}))?")
_OBJECT = re.compile(r"([0-9A-Fa-f]{4}):(\d{1,3})")
_ANALOG, _INPUT, _OUTPUT, _DRIVE_INPUT = 0x6401, 0x6000, 0x6200, 0x60FD
_LIMITS, _WATCH, _WINDOW, _OFF = 0x607D, 0x1016, 0x6065, 0xFFFFFFFF
_BYTES, _WORDS, _BITS = 8, 4, 8  # of a module: what one PDO of each kind carries; bits of a byte
_LOW, _HIGH, _MOST = -(2**31), 2**32 - 1, 2**31 - 1  # of an object, of a count of 32 bits with a sign
_CYCLES, _CYCLIC_LEAST = 4, 0.02  # SYNCs, and s, that setpoints of a cyclic mode are on their way
_RESTART = 0.04  # s that a drive needs between the end of one PVT motion and the start of the next
_RECORDS = 3  # a FIFO with fewer than two records is empty to the drive
_SELDOM = 0.01  # s
_ANSWERS, _ANSWER_TIME = 3, 0.02  # SYNCs, s
_LEAST = 16  # counts a turn of an encoder

MODES = ("pvt", "csp", "ip", "pp")
CYCLIC = ("csp", "ip")  # a setpoint each SYNC
EVENED_OUT = 0.25  # of a period that a SYNC may be late
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
_NODE = (
    Field("id", Kind.WHOLE, low=1, high=127),
    Field("profile", Kind.WHOLE, low=401, high=406, default=402),
    Field("drive", Kind.CHOICE, choices=tuple(PROFILES), default=""),
    Field("eds", Kind.TEXT, default=""),
    Field("counts_per_rev", Kind.WHOLE, low=0, high=100_000_000, default=0),
)
_SPINDLE_ENCODER = (
    Field("node", Kind.TEXT),
    Field("object", Kind.TEXT, default=""),
    Field("counts_per_rev", Kind.WHOLE, low=-100_000_000, high=100_000_000),
)

Objects = tuple[tuple[int, int, int], ...]  # index, sub-index, value: written at every start and read back


@dataclass(frozen=True, slots=True)
class BusConfig:
    """The wire. Times in seconds."""

    interface: str  # python-can's name: socketcan, virtual, udp_multicast …
    channel: str
    bitrate: int = 1_000_000
    host_id: int = 127
    sync: float = 0.01
    heartbeat: float = 0.1

    @property
    def seldom(self) -> int:
        """SYNCs from one answer to the next of what need not be known at each: about 10 ms."""
        return max(1, round(_SELDOM / self.sync))

    @property
    def patience(self) -> int:
        """Answers to SYNC that a slide may leave out before it counts as silent: 3, or 20 ms."""
        return max(_ANSWERS, round(_ANSWER_TIME / self.sync))

    @property
    def own_process(self) -> bool:
        """Whether another process can own it; python-can's virtual bus lives in one."""
        return self.interface != "virtual"


@dataclass(frozen=True, slots=True)
class CanNode:
    """One node of the bus: ``name`` is an axis, ``spindle`` or the name of an I/O module."""

    name: str
    id: int
    profile: int  # 402, 401 or 406
    drive: str = ""  # family as it is sold, of drive_profiles; empty: as its EDS file says, or CiA 402 alone
    eds: str = ""  # file of the object dictionary, beside the machine file; empty: the standard objects
    counts_per_rev: int = 0  # the drive counts velocities in rpm of this many counts; 0: in counts/s
    sdo: Objects = ()  # those for all nodes of its profile, then its own


@dataclass(frozen=True, slots=True)
class CanopenTable:
    """The CAN bus and what hangs on it."""

    bus: BusConfig
    mode: str  # one of MODES
    record: float  # s, length of a PVT record
    nodes: tuple[CanNode, ...]


@dataclass(frozen=True, slots=True)
class EncoderTable:
    """An encoder on the spindle, on the bus: a node of its own, or a drive's second input."""

    node: str  # name in [canopen.nodes]
    index: int
    sub: int
    counts_per_rev: int  # negative: it counts down with M03


@dataclass(frozen=True, slots=True)
class CanTerminal:
    """One bit (``bit`` from 0) or one whole number (``bit`` -1) of an object of a module or an axis."""

    node: str
    index: int
    sub: int
    bit: int = -1
    active_low: bool = False


# --- addresses -------------------------------------------------------------------------------------------


def can_terminal(text: str) -> CanTerminal | None:
    """``401.6200.1.0`` as node, object, sub-index and bit; None where it is no address."""
    found = _ADDRESS.fullmatch(text)
    if found is None:
        return None
    node, index, sub, bit = found.groups()
    return CanTerminal(node, int(index, 16), int(sub), int(bit) if bit else -1)


def sdo_address(text: str) -> tuple[int, int] | None:
    """``6007:0`` as index and sub-index, or None."""
    found = _OBJECT.fullmatch(text)
    if found is None or int(found[2]) > 255:
        return None
    return int(found[1], 16), int(found[2])


def _terminal(file: FileReading, text: str) -> object:
    """401 is the first module, and hexadecimal has two cases."""
    found = can_terminal(text)
    if found is None or found.node != PLAIN_MODULE:
        return found
    return replace(found, node=next(iter(_modules(file)), PLAIN_MODULE))


def _input_addresses() -> Iterator[str]:
    """Of the first module, bit by bit."""
    return (f"{PLAIN_MODULE}.{_INPUT:04X}.{n // _BITS + 1}.{n % _BITS}" for n in itertools.count())


# --- reading ---------------------------------------------------------------------------------------------


def _read(file: FileReading) -> Iterator[Finding]:
    nodes, objects = file.raw(_NODES), file.raw(_SDO)
    yield from read_named({} if nodes is None else nodes, _NODE, _NODES, file.values)
    if objects is None:
        return
    if not isinstance(objects, dict):
        yield expected_table(_SDO, objects)
        return
    yield from unknown_keys(objects, ["all", *file.names(_NODES)], _SDO)
    for node, entries in objects.items():
        path = f"{_SDO}.{node}"
        if not isinstance(entries, dict):
            yield expected_table(path, entries)
            continue
        for key, value in entries.items():
            if why := _wrong_object(key, value):
                yield Finding(f'{path}."{key}"', written(value), why)


def _wrong_object(key: str, value: object) -> str:
    """What was expected instead; empty where the entry is good."""
    address = sdo_address(key)
    if address is None:
        return 'expected the address of an object as the key: "6007:0", index in hexadecimal'
    if not _whole(value) or not _LOW <= value <= _HIGH:
        return "expected a whole number of 32 bits"
    if address[0] == _WINDOW and value % 2**32 == _OFF:
        return "expected a window: this value switches the drive's following error monitoring off"
    return ""


def _whole(value: object) -> TypeGuard[int]:
    return isinstance(value, int) and not isinstance(value, bool)


def _objects(file: FileReading, node: str) -> Objects:
    """The good entries of one node's objects, or of ``all``."""
    entries = file.raw(f"{_SDO}.{node}")
    found = entries.items() if isinstance(entries, dict) else ()
    return tuple(
        (*address, value)
        for key, value in found
        if (address := sdo_address(key)) and _whole(value) and not _wrong_object(key, value)
    )


def _place(node: str, index: int, sub: int) -> str:
    """The path of an object of a node, as the machine file writes it."""
    return f'{_SDO}.{node}."{index:04X}:{sub}"'


def _bus_table(file: FileReading) -> CanopenTable:
    values = file.values
    return CanopenTable(
        bus=values.model(BusConfig, "canopen", {"sync": "sync_ms", "heartbeat": "heartbeat_ms"}),
        mode=values.text("canopen.mode"),
        record=values.number("canopen.record_ms"),
        nodes=tuple(_node(file, name) for name in file.names(_NODES)),
    )


def _node(file: FileReading, name: str) -> CanNode:
    shared = _objects(file, "all") if _profile(file, name) == _DRIVE else ()
    return file.values.model(
        CanNode,
        f"{_NODES}.{name}",
        name=name,
        drive=_family(file, name),
        sdo=(*shared, *_objects(file, name)),
    )


def _family(file: FileReading, name: str) -> str:
    """Of the node, or that of all drives."""
    if _profile(file, name) != _DRIVE:
        return ""
    paths = (f"{_NODES}.{name}.drive", "canopen.drive")
    return next((found for path in paths if (found := _said(file, path))), "")


def _said(file: FileReading, path: str) -> str:
    return file.values.text(path) if file.values.has(path) else ""


def _encoder_table(file: FileReading) -> EncoderTable:
    values = file.values
    index, sub = sdo_address(values.text(f"{ENCODER}.object") or POSITION) or (0, 0)
    counts = values.whole(f"{ENCODER}.counts_per_rev")
    return EncoderTable(values.text(f"{ENCODER}.node"), index, sub, counts)


# --- rules of the bus ------------------------------------------------------------------------------------


def _bus_rules(file: FileReading) -> Iterator[Finding]:
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
            yield Finding("canopen.heartbeat_ms", f"{1000 * beat:g}", "expected two times sync_ms or more")
    if values.says("canopen.mode", "pvt") and values.has("canopen.record_ms", "machine.commit_ms"):
        yield from _queue(values.number("canopen.record_ms"), values.number("machine.commit_ms"), values)


def _queue(record: float, commit: float, values: Values) -> Iterator[Finding]:
    if abs(1000 * record - round(1000 * record)) > 1e-6:
        yield Finding(
            "canopen.record_ms", f"{1000 * record:g}", "expected whole milliseconds: PVT counts in them"
        )
    least = _RECORDS * record + _RESTART
    if values.says("machine.backend", "canopen") and commit < least - 1e-9:
        expected = f"expected {1000 * least:g} or more: {_RECORDS} records in the drives and a restart"
        yield Finding("machine.commit_ms", f"{1000 * commit:g}", expected)


def _families(file: FileReading) -> Iterator[Finding]:
    """Queues and counts a turn that the families of the drives need."""
    values, moved = file.values, file.axes
    queued = " or ".join(written(name) for name in QUEUED)
    for name in file.names(_NODES):
        family, path = _family(file, name), f"{_NODES}.{name}"
        unknown = {f"{path}.drive", "canopen.drive"} & values.wrong
        if name not in moved or _profile(file, name) != _DRIVE or unknown:
            continue
        known = family or _said(file, f"{path}.eds")
        if values.says("canopen.mode", "pvt") and (not known or (family and family not in QUEUED)):
            why = f'expected {queued}: mode "pvt" needs a queue in the drive; others take "csp", "ip" or "pp"'
            yield Finding(f"{path}.drive", written(family) if family else "", why)
        counts = f"{path}.counts_per_rev"
        if family in IN_RPM and values.has(counts) and values.number(counts) == 0:
            title = PROFILES[family].title
            why = f"missing; {title} counts speeds in rpm: 4 × the pulses a turn of its encoder"
            yield Finding(counts, "", why)


def _cyclic(file: FileReading) -> Iterator[Finding]:
    """Setpoints at each SYNC: whole milliseconds, ahead in time, and with room on the bus."""
    values = file.values
    if _said(file, "canopen.mode") not in CYCLIC or not values.has("canopen.sync_ms", "canopen.bitrate"):
        return
    sync, bitrate = values.number("canopen.sync_ms"), values.whole("canopen.bitrate")
    if abs(1000 * sync - round(1000 * sync)) > 1e-6:
        yield Finding(
            "canopen.sync_ms", f"{1000 * sync:g}", "expected whole milliseconds: 60C2 counts in them"
        )
    if values.has("machine.commit_ms"):
        commit, least = values.number("machine.commit_ms"), max(_CYCLES * sync, _CYCLIC_LEAST)
        if commit < least - 1e-9:
            expected = f"expected {1000 * least:g} or more: what is on its way to the drives"
            yield Finding("machine.commit_ms", f"{1000 * commit:g}", expected)
    nodes = file.names(_NODES)
    slides = sum(name in file.axes for name in nodes)
    seldom = BusConfig("", "", sync=sync).seldom
    load = cyclic_load(slides, len(nodes) - slides, bitrate, sync, seldom)
    if not load.fits:
        fits = next((ms for ms in range(1, 101) if _fits(slides, len(nodes) - slides, bitrate, ms)), 0)
        expected = f"{slides} drives take {load.share:.0%} of {bitrate:g} bit/s, more than has room"
        best = f"; expected {fits} or more" if fits else ""
        yield Finding("canopen.sync_ms", f"{1000 * sync:g}", expected + best)


def _fits(slides: int, others: int, bitrate: int, ms: int) -> bool:
    seldom = BusConfig("", "", sync=0.001 * ms).seldom
    return cyclic_load(slides, others, bitrate, 0.001 * ms, seldom).fits


def _numbers(file: FileReading) -> Iterator[Finding]:
    """Numbers, names and profiles of the nodes."""
    values, moved = file.values, (*file.axes, _SPINDLE)
    taken: dict[int, str] = {}
    if values.has("canopen.host_id"):
        taken[values.whole("canopen.host_id")] = "canopen.host_id"
    for name in file.names(_NODES):
        path = f"{_NODES}.{name}"
        if not values.has(f"{path}.id", f"{path}.profile"):
            continue
        number, profile = values.whole(f"{path}.id"), values.whole(f"{path}.profile")
        first = taken.setdefault(number, path)
        if first != path:
            yield Finding(f"{path}.id", str(number), f"expected a number of its own; {first} has it")
        if profile == _DRIVE and name not in moved:
            why = f"a drive is named after what it moves: {', '.join(moved)}; I/O has profile = 401"
            yield Finding(path, "", why)
        if profile != _DRIVE and name in moved:
            yield Finding(f"{path}.profile", str(profile), "expected 402, a drive")


def _heartbeat(file: FileReading) -> Iterator[Finding]:
    """0x1016 must watch this computer, and not less patiently than it speaks."""
    values = file.values
    if not values.has("canopen.host_id", "canopen.heartbeat_ms"):
        return
    host, beat = values.whole("canopen.host_id"), values.number("canopen.heartbeat_ms")
    for node in file.names(_SDO):
        for index, sub, value in _objects(file, node):
            if index != _WATCH or sub == 0:
                continue
            watched, patience = value >> 16 & 0x7F, (value & 0xFFFF) / 1000.0
            if watched != host or patience < 2 * beat:
                best = host << 16 | round(3000 * beat)
                expected = (
                    f"watches node {watched} for {1000 * patience:g} ms; expected {best}: the host, 3 beats"
                )
                yield Finding(_place(node, index, sub), str(value), expected)


_C_WITHOUT = (
    ', or counts_per_rev of the spindle\'s drive, which is C as well with canopen mode = "pvt"'
    " and without axis.C.own_drive"
)


def _drives(file: FileReading) -> Iterator[Finding]:
    """A drive for every axis, and how each looks for home."""
    values, nodes = file.values, file.names(_NODES)
    for axis in file.axes:
        if axis == "C" and not (values.has("axis.C.enabled") and values.flag("axis.C.enabled")):
            continue
        method = f"axis.{axis}.home.method"
        if axis not in nodes and not (axis == "C" and _turned_by_spindle(file)):
            own = _C_WITHOUT if axis == "C" and values.says("spindle.driver", "cia402") else ""
            yield Finding(f"{_NODES}.{axis}", "", f"missing; axis {axis} needs a drive{own}")
        if values.has(method) and values.number(method) == 0:
            yield Finding(method, "", "missing; expected the drive's method, 1 or 2 for a limit switch")
    if values.says("spindle.driver", "cia402") and _SPINDLE not in nodes:
        yield Finding(f"{_NODES}.spindle", "", 'missing; spindle.driver = "cia402" needs a drive')


def _turned_by_spindle(file: FileReading) -> bool:
    """Whether C of a lathe can be the spindle's own drive: one that counts, and queues positions."""
    values, counts = file.values, f"{_NODES}.{_SPINDLE}.counts_per_rev"
    own = values.has("axis.C.own_drive") and values.flag("axis.C.own_drive")
    drives = values.says("spindle.driver", "cia402") and values.says("canopen.mode", "pvt")
    return drives and not own and values.has(counts) and values.number(counts) > 0


def _outside(file: FileReading) -> Iterator[Finding]:
    """Axes that could be sent where their drives do not go, by what the file tells these."""
    values = file.values
    for axis in file.axes:
        path, counted = f"axis.{axis}.travel", f"axis.{axis}.count"
        if axis not in file.names(_NODES) or not values.has(path, counted):
            continue
        count, ends = values.number(counted), values.pair(path)
        if math.inf in map(abs, ends):
            continue  # a rotary axis without an end
        if max(map(abs, ends)) / count > _MOST:
            yield Finding(path, "", f"is more than a drive can count: {_MOST} counts of {count:g}")
        for node in ("all", axis):
            for index, sub, value in _objects(file, node):
                if index != _LIMITS or sub not in {1, 2}:
                    continue
                signed = value - 2**32 if value > _MOST else value
                needed = round(ends[sub - 1] / count)
                if signed > needed if sub == 1 else signed < needed:
                    why = f"cuts {path}, which needs {needed} counts"
                    yield Finding(_place(node, index, sub), str(value), why)


# --- terminals: bits and words that the modules can have ---------------------------------------------------


def _wired(file: FileReading) -> Iterator[Finding]:
    """A finding for every signal and pot whose terminal is no address on the bus."""
    if any(path.endswith(".profile") for path in file.values.wrong):
        return  # which of the nodes are modules is not known
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
        return f'expected node, object, sub-index{"" if analog else " and bit"}: "{sample}"'
    modules = _modules(file)
    plain = terminal.node == PLAIN_MODULE
    profile = (_MODULE if modules else 0) if plain else _profile(file, terminal.node)
    if not profile:
        return f"expected an I/O module of [canopen.nodes]: {', '.join(modules) or 'none is there'}"
    if profile == _DRIVE:
        right = terminal.index == _DRIVE_INPUT and not output and not analog and terminal.bit < 32
        return "" if right else "a drive has inputs only: 60FD.0 and bits 0…31"
    wanted = _ANALOG if analog else _OUTPUT if output else _INPUT
    most = _WORDS if analog else _BYTES
    if terminal.index != wanted or not 1 <= terminal.sub <= most:
        return f"expected object {wanted:04X}, sub-index 1…{most}"
    return "" if terminal.bit < _BITS else "expected a bit, 0…7"


def _modules(file: FileReading) -> list[str]:
    """Names of the I/O modules, in the order of the file."""
    return [name for name in file.names(_NODES) if _profile(file, name) == _MODULE]


def _profile(file: FileReading, node: str) -> int:
    path = f"{_NODES}.{node}.profile"
    return file.values.whole(path) if file.values.has(path) else 0


# --- rules of an encoder of its own on the spindle, beside an inverter --------------------------------------


def _encoder_rules(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if ENCODER in file.tables:
        yield from _encoder_place(values)
        yield from _encoder_node(file)
    used = values.text(f"{ENCODER}.node") if values.has(f"{ENCODER}.node") else ""
    for name in file.names(_NODES):
        path = f"{_NODES}.{name}.profile"
        profile = values.whole(path) if values.has(path) else _MODULE
        if profile not in {_MODULE, _DRIVE, _ENCODER}:
            yield Finding(path, str(profile), "expected 401 (terminals), 402 (a drive) or 406 (an encoder)")
        elif profile == _ENCODER and name != used:
            why = f"nobody reads this encoder; {ENCODER} names the one that is read"
            yield Finding(path, str(profile), why)


def _encoder_place(values: Values) -> Iterator[Finding]:
    if values.has("machine.backend") and values.text("machine.backend") != "canopen":
        backend = written(values.text("machine.backend"))
        yield Finding(ENCODER, "", f"backend {backend} reads no encoder on a bus; take it out")
    if values.has("spindle.driver") and values.text("spindle.driver") != "vfd":
        expected = (
            'expected spindle.driver = "vfd": a drive on the bus has its own, counts_per_rev of its node'
        )
        yield Finding(ENCODER, "", expected)
    path = f"{ENCODER}.counts_per_rev"
    if values.has(path) and abs(values.number(path)) < _LEAST:
        expected = f"expected {_LEAST} or more; negative where it counts down with M03"
        yield Finding(path, f"{values.number(path):g}", expected)


def _encoder_node(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if not values.has(f"{ENCODER}.node", f"{ENCODER}.object"):
        return
    node, place = values.text(f"{ENCODER}.node"), values.text(f"{ENCODER}.object")
    if node not in file.names(_NODES):
        yield Finding(
            f"{ENCODER}.node", written(node), "expected a node of [canopen.nodes] with profile = 406"
        )
    elif _profile(file, node) == _MODULE:
        yield Finding(
            f"{ENCODER}.node", written(node), "terminals do not count turns: expected 406 or a drive"
        )
    elif _profile(file, node) == _DRIVE and not place:
        expected = 'missing; a drive has its second encoder where its manual says: "60E4:1"'
        yield Finding(f"{ENCODER}.object", "", expected)
    if place and sdo_address(place) is None:
        yield Finding(f"{ENCODER}.object", written(place), f'expected index and sub-index: "{POSITION}"')


DRIVER = Driver(
    tables=(
        DriverTable("canopen", _BUS, _bus_table, ("nodes", "sdo"), _read, _bus_rules),
        DriverTable(ENCODER, _SPINDLE_ENCODER, _encoder_table, rules=_encoder_rules),
    ),
    backend="canopen",
    spindle="cia402",
    count_rate=2.0**23,
    terminal=_terminal,
    inputs=_input_addresses,
)
