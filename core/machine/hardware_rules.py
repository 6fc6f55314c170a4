"""What must hold between buses, drives, terminals and the rest of a machine file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from core.machine import terminal_wiring
from core.machine.can_addresses import sdo_address
from core.machine.hardware_tables import AXIS_FAULTS, HardwareReading
from core.machine.station_rules import wrong_palms, wrong_wheel
from core.machine.terminal_wiring import on_the_bus
from core.table_schema import Finding, Values, written

# --- An encoder of its own on the spindle, beside an inverter: what must hold between it and the rest.


ENCODER = "spindle.encoder"
PROFILE = 406  # of CiA: an encoder that is a node by itself
POSITION = "6004:0"  # where such a node has its counts
_LEAST = 16  # counts a turn


def wrong_encoder(reading: HardwareReading) -> Iterator[Finding]:
    """Every finding."""
    values = reading.values
    if ENCODER in reading.tables:
        yield from _place(reading)
        yield from _counts(values)
        yield from _wired(reading)
    used = values.text(f"{ENCODER}.node") if values.has(f"{ENCODER}.node") else ""
    for name in reading.nodes:
        path = f"canopen.nodes.{name}.profile"
        profile = int(values.number(path)) if values.has(path) else 401
        if profile not in {401, 402, PROFILE}:
            yield Finding(path, str(profile), "expected 401 (terminals), 402 (a drive) or 406 (an encoder)")
        elif profile == PROFILE and name != used:
            yield Finding(
                path, str(profile), f"nobody reads this encoder; {ENCODER} names the one that is read"
            )


def _place(reading: HardwareReading) -> Iterator[Finding]:
    values = reading.values
    if values.has("machine.backend") and values.text("machine.backend") != "canopen":
        backend = written(values.text("machine.backend"))
        yield Finding(ENCODER, "", f"backend {backend} reads no encoder on a bus; take it out")
    if values.has("spindle.driver") and values.text("spindle.driver") != "vfd":
        expected = (
            'expected spindle.driver = "vfd": a drive on the bus has its own, counts_per_rev of its node'
        )
        yield Finding(ENCODER, "", expected)


def _counts(values: Values) -> Iterator[Finding]:
    path = f"{ENCODER}.counts_per_rev"
    if values.has(path) and abs(values.number(path)) < _LEAST:
        expected = f"expected {_LEAST} or more; negative where it counts down with M03"
        yield Finding(path, f"{values.number(path):g}", expected)


def _wired(reading: HardwareReading) -> Iterator[Finding]:
    values = reading.values
    if not values.has(f"{ENCODER}.node", f"{ENCODER}.object"):
        return
    node, place = values.text(f"{ENCODER}.node"), values.text(f"{ENCODER}.object")
    profile = f"canopen.nodes.{node}.profile"
    if node not in reading.nodes:
        yield Finding(
            f"{ENCODER}.node", written(node), "expected a node of [canopen.nodes] with profile = 406"
        )
    elif values.has(profile) and values.number(profile) == 401:
        yield Finding(
            f"{ENCODER}.node", written(node), "terminals do not count turns: expected 406 or a drive"
        )
    elif values.has(profile) and values.number(profile) == 402 and not place:
        expected = 'missing; a drive has its second encoder where its manual says: "60E4:1"'
        yield Finding(f"{ENCODER}.object", "", expected)
    if place and sdo_address(place) is None:
        yield Finding(f"{ENCODER}.object", written(place), f'expected index and sub-index: "{POSITION}"')


# --- Whether an axis stays inside what the file tells its drive or controller to allow.


_LIMITS = 0x607D  # CiA 402: software position limits, sub-index 1 lowest, 2 highest, in counts
_MOST = 2**31 - 1  # counts that an object of 32 bits with a sign can tell
_GRBL_AXES = {"X": 0, "Y": 1, "Z": 2}
# Settings by their first number: what is compared, the factor from the model's unit to the controller's.
_GRBL = ((110, "vmax", 60.0, "mm/min"), (120, "amax", 1.0, "mm/s²"))
_GRBL_TRAVEL = 130


def outside(reading: HardwareReading, axes: tuple[str, ...]) -> Iterator[Finding]:
    """A finding for every axis that could be sent where its drive does not go."""
    for axis in axes:
        if axis in reading.nodes:
            yield from _of_a_drive(reading, axis)
        if axis in _GRBL_AXES:
            yield from _of_the_controller(reading, axis)


def _of_a_drive(reading: HardwareReading, axis: str) -> Iterator[Finding]:
    values, path = reading.values, f"axis.{axis}.travel"
    if not values.has(path, f"axis.{axis}.count"):
        return
    count, ends = values.number(f"axis.{axis}.count"), values.pair(path)
    if math.inf in map(abs, ends):
        return  # a rotary axis without an end
    if max(map(abs, ends)) / count > _MOST:
        expected = f"is more than a drive can count: {_MOST} counts of {count:g}"
        yield Finding(path, "", expected)
    for node in ("all", axis):
        for entry in reading.sdo.get(node, []):
            if entry.index != _LIMITS or entry.sub not in {1, 2}:
                continue
            value = entry.value - 2**32 if entry.value > _MOST else entry.value
            needed = round(ends[entry.sub - 1] / count)
            if value > needed if entry.sub == 1 else value < needed:
                place = f'canopen.sdo.{node}."{entry.address}"'
                yield Finding(place, str(entry.value), f"cuts {path}, which needs {needed} counts")


def _of_the_controller(reading: HardwareReading, axis: str) -> Iterator[Finding]:
    values, offset = reading.values, _GRBL_AXES[axis]
    for first, key, factor, unit in _GRBL:
        path = f"axis.{axis}.{key}"
        if values.has(path):
            yield from _too_small(reading, first + offset, values.number(path) * factor, path, unit)
    path = f"axis.{axis}.travel"
    if values.has(path):
        low, high = values.pair(path)
        yield from _too_small(reading, _GRBL_TRAVEL + offset, high - low, path, "mm")


def _too_small(
    reading: HardwareReading, number: int, needed: float, path: str, unit: str
) -> Iterator[Finding]:
    setting = reading.settings.get(number)
    if isinstance(setting, str) or setting is None or setting >= needed * (1 - 1e-6):
        return
    expected = f"expected {needed:.6g} {unit} or more, for {path}"
    yield Finding(f"grblhal.settings.{number}", f"{setting:g}", expected)


RESTART = 0.04  # s that a drive needs between the end of one PVT motion and the start of the next
_RECORDS = 3  # a FIFO with fewer than two records is empty to the drive
_WATCH = 0x1016
_C_WITHOUT = (
    ', or counts_per_rev of the spindle\'s drive, which is C as well with canopen mode = "pvt"'
    " and without axis.C.own_drive"
)
_SPINDLE, _DRIVE, _MODULE = "spindle", 402, 401


def broken(reading: HardwareReading, axes: tuple[str, ...], signals: Mapping[str, str]) -> Iterator[Finding]:
    """Every finding. ``axes`` are the machine's, ``signals`` the terminals of its inputs and outputs."""
    yield from _backend(reading)
    yield from _spindle(reading)
    yield from terminal_wiring.shared(reading, signals)
    yield from terminal_wiring.pots(reading, signals)
    yield from _faults(reading, axes)
    yield from _renewed(reading.values, signals)
    yield from _guard(reading.values, signals)
    yield from _ports(reading.values)
    yield from wrong_wheel(reading, axes)
    yield from wrong_palms(reading)
    yield from wrong_encoder(reading)
    yield from outside(reading, axes)
    if "canopen" in reading.tables:
        yield from _bus_times(reading.values)
        yield from _nodes(reading, axes)
        yield from _heartbeat(reading)
    if _is(reading.values, "machine.backend", "canopen") and "canopen" in reading.tables:
        yield from _drives(reading, axes)
        yield from on_the_bus(reading, signals)
    yield from _controller(reading)


def _controller(reading: HardwareReading) -> Iterator[Finding]:
    """What a controller on a lathe has to be told, and nothing else."""
    needed = ((13, 0, "reports in mm; in inches they have too few decimals"), (32, 2, "lathe mode"))
    for number, value, why in needed:
        if reading.settings.get(number, value) != value:
            place = f"grblhal.settings.{number}"
            yield Finding(place, written(reading.settings[number]), f"expected {value}: {why}")
    if _is(reading.values, "grblhal.x_mode", "G7"):
        yield Finding("grblhal.x_mode", '"G7"', 'expected "G8": a reset would change what X means')


def _ports(values: Values) -> Iterator[Finding]:
    """A serial port has one owner."""
    taken: dict[str, str] = {}
    for path in ("spindle.vfd.port", "grblhal.port", "dnc.port"):
        if values.has(path):
            port = values.text(path)
            first = taken.setdefault(port, path)
            if first != path:
                yield Finding(path, written(port), f"expected a port of its own; {first} has it")


def _is(values: Values, path: str, text: str) -> bool:
    return values.has(path) and values.text(path) == text


def _backend(reading: HardwareReading) -> Iterator[Finding]:
    for backend in ("canopen", "grblhal"):
        if _is(reading.values, "machine.backend", backend) and backend not in reading.tables:
            yield Finding(f"[{backend}]", "", f'missing; machine.backend = "{backend}" needs it')


def _spindle(reading: HardwareReading) -> Iterator[Finding]:
    values, path = reading.values, "spindle.driver"
    if not values.has(path, "machine.backend"):
        return
    driver, backend = values.text(path), values.text("machine.backend")
    allowed = {"sim": ("sim", "vfd"), "canopen": ("cia402", "vfd"), "grblhal": ("grblhal", "vfd")}[backend]
    if driver not in allowed:
        expected = f"expected {' or '.join(allowed)} with machine.backend = {written(backend)}"
        yield Finding(path, written(driver), expected)
    elif driver == "vfd" and "spindle.vfd" not in reading.tables:
        yield Finding("spindle.vfd", "", 'missing; spindle.driver = "vfd" needs it')


def _faults(reading: HardwareReading, axes: tuple[str, ...]) -> Iterator[Finding]:
    for path in reading.faults:
        if not reading.values.has(f"{path}.what", f"{path}.axis"):
            continue
        what, axis = reading.values.text(f"{path}.what"), reading.values.text(f"{path}.axis")
        if what in AXIS_FAULTS and axis not in axes:
            yield Finding(
                f"{path}.axis", written(axis), f"{what} happens to an axis: one of {', '.join(axes)}"
            )
        if what not in AXIS_FAULTS and axis:
            yield Finding(f"{path}.axis", written(axis), f"{what} happens to no axis; take it out")


def _renewed(values: Values, signals: Mapping[str, str]) -> Iterator[Finding]:
    for path in signals:
        wanted = path.startswith("io.out.") and values.has(f"{path}.refresh_ms", f"{path}.safe")
        if wanted and values.number(f"{path}.refresh_ms") and values.found[f"{path}.safe"] is not False:
            expected = "an output that falls when nobody renews it needs safe = false"
            yield Finding(f"{path}.refresh_ms", f"{1000 * values.number(f'{path}.refresh_ms'):g}", expected)


def _guard(values: Values, signals: Mapping[str, str]) -> Iterator[Finding]:
    path = "interlocks.guard_stops"
    if values.has(path) and values.flag(path) and "io.in.guard" not in signals:
        yield Finding(path, "true", "needs the guard's switch as the input guard, on while it is closed")


def _bus_times(values: Values) -> Iterator[Finding]:
    if values.has("canopen.heartbeat_ms", "canopen.sync_ms"):
        beat, sync = values.number("canopen.heartbeat_ms"), values.number("canopen.sync_ms")
        if beat < 2 * sync:
            yield Finding("canopen.heartbeat_ms", f"{1000 * beat:g}", "expected two times sync_ms or more")
    if _is(values, "canopen.mode", "csp") and not values.flag("canopen.experimental"):
        why = (
            "cyclic setpoints from this computer are not proven on any drive; experimental = true allows them"
        )
        yield Finding("canopen.mode", '"csp"', why)
    if _is(values, "canopen.mode", "pvt") and values.has("canopen.record_ms", "machine.commit_ms"):
        yield from _fifo(values.number("canopen.record_ms"), values.number("machine.commit_ms"), values)


def _fifo(record: float, commit: float, values: Values) -> Iterator[Finding]:
    if abs(1000 * record - round(1000 * record)) > 1e-6:
        yield Finding(
            "canopen.record_ms", f"{1000 * record:g}", "expected whole milliseconds: PVT counts in them"
        )
    least = _RECORDS * record + RESTART
    if _is(values, "machine.backend", "canopen") and commit < least - 1e-9:
        expected = f"expected {1000 * least:g} or more: {_RECORDS} records in the drives and a restart"
        yield Finding("machine.commit_ms", f"{1000 * commit:g}", expected)


def _nodes(reading: HardwareReading, axes: tuple[str, ...]) -> Iterator[Finding]:
    values = reading.values
    taken: dict[int, str] = {}
    if values.has("canopen.host_id"):
        taken[int(values.number("canopen.host_id"))] = "canopen.host_id"
    for name in reading.nodes:
        path = f"canopen.nodes.{name}"
        if not values.has(f"{path}.id", f"{path}.profile"):
            continue
        number, profile = int(values.number(f"{path}.id")), int(values.number(f"{path}.profile"))
        first = taken.setdefault(number, path)
        if first != path:
            yield Finding(f"{path}.id", str(number), f"expected a number of its own; {first} has it")
        if profile == _DRIVE and name not in (*axes, _SPINDLE):
            known = ", ".join((*axes, _SPINDLE))
            yield Finding(path, "", f"a drive is named after what it moves: {known}; I/O has profile = 401")
        if profile != _DRIVE and name in (*axes, _SPINDLE):
            yield Finding(f"{path}.profile", str(profile), "expected 402, a drive")


def _drives(reading: HardwareReading, axes: tuple[str, ...]) -> Iterator[Finding]:
    values = reading.values
    for axis in axes:
        if axis == "C" and not (values.has("axis.C.enabled") and values.flag("axis.C.enabled")):
            continue
        path = f"axis.{axis}"
        if axis not in reading.nodes and not (axis == "C" and _turned_by_spindle(reading)):
            own = _C_WITHOUT if axis == "C" and _is(values, "spindle.driver", "cia402") else ""
            yield Finding(f"canopen.nodes.{axis}", "", f"missing; axis {axis} needs a drive{own}")
        if values.has(f"{path}.home.method") and values.number(f"{path}.home.method") == 0:
            yield Finding(
                f"{path}.home.method", "", "missing; expected the drive's method, 1 or 2 for a limit switch"
            )
    if _is(values, "spindle.driver", "cia402") and _SPINDLE not in reading.nodes:
        yield Finding("canopen.nodes.spindle", "", 'missing; spindle.driver = "cia402" needs a drive')


def _turned_by_spindle(reading: HardwareReading) -> bool:
    """Whether C of a lathe can be the spindle's own drive: one that counts, and queues positions."""
    values, counts = reading.values, f"canopen.nodes.{_SPINDLE}.counts_per_rev"
    own = values.has("axis.C.own_drive") and values.flag("axis.C.own_drive")
    drives = _is(values, "spindle.driver", "cia402") and _is(values, "canopen.mode", "pvt")
    return drives and not own and values.has(counts) and values.number(counts) > 0


def _heartbeat(reading: HardwareReading) -> Iterator[Finding]:
    """0x1016 must watch this computer, and not less patiently than it speaks."""
    values = reading.values
    if not values.has("canopen.host_id", "canopen.heartbeat_ms"):
        return
    host, beat = int(values.number("canopen.host_id")), values.number("canopen.heartbeat_ms")
    for node, entries in reading.sdo.items():
        for entry in entries:
            if entry.index != _WATCH or entry.sub == 0:
                continue
            watched, patience = entry.value >> 16 & 0x7F, (entry.value & 0xFFFF) / 1000.0
            if watched != host or patience < 2 * beat:
                best = host << 16 | round(3000 * beat)
                expected = (
                    f"watches node {watched} for {1000 * patience:g} ms; expected {best}: the host, 3 beats"
                )
                yield Finding(f'canopen.sdo.{node}."{entry.address}"', str(entry.value), expected)
