"""What must hold between buses, drives, terminals and the rest of a machine file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from core.machine.errors import Finding
from core.machine.hardware import drive_limits, wiring
from core.machine.hardware.encoder import broken as wrong_encoder
from core.machine.hardware.fields import AXIS_FAULTS
from core.machine.hardware.palms import broken as wrong_palms
from core.machine.hardware.reading import HardwareReading
from core.machine.hardware.terminals import on_the_bus
from core.machine.hardware.wheel import broken as wrong_wheel
from core.machine.schema import Values, written

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
    yield from wiring.shared(reading, signals)
    yield from wiring.pots(reading, signals)
    yield from _faults(reading, axes)
    yield from _renewed(reading.values, signals)
    yield from _guard(reading.values, signals)
    yield from _ports(reading.values)
    yield from wrong_wheel(reading, axes)
    yield from wrong_palms(reading)
    yield from wrong_encoder(reading)
    yield from drive_limits.outside(reading, axes)
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
