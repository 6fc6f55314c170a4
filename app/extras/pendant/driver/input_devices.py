"""Input devices of Linux (evdev): found by name or USB number, opened for us alone, their events read.

Events are as the kernel writes them: ``struct input_event``, its packets, and what gets lost.
"""

from __future__ import annotations

import array
import contextlib
import os
import struct
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol

from app.extras.pendant.driver.pendant_table import (
    ABS,
    AXES,
    KEY,
    KEYS,
    REL,
    SYN,
    SYN_DROPPED,
    SYN_REPORT,
    Control,
)
from core.message import Message
from core.ports import DriverError

# Two C longs of time, then type, code and value: 24 bytes where a long has 8. It is part of the kernel's
# promise to programs (Documentation/input/event-codes.rst), and does not change.
EVENT = struct.Struct("@llHHi")


class InputEvent(NamedTuple):
    """``t`` is when the kernel had it, seconds of the clock that the device was told to use."""

    t: float
    kind: int
    code: int
    value: int


class Packet(NamedTuple):
    """What changed at once; ``lost``: events before it were thrown away, so nothing in it can be counted."""

    events: tuple[InputEvent, ...]
    lost: bool = False


class Packets:
    """Bytes in, whole packets out. From SYN_DROPPED to the next SYN_REPORT everything is worth nothing."""

    def __init__(self) -> None:
        self._bytes = b""
        self._events: list[InputEvent] = []
        self._lost = False

    def feed(self, data: bytes) -> Iterator[Packet]:
        """Every packet that is whole now."""
        self._bytes += data
        whole = len(self._bytes) // EVENT.size * EVENT.size
        read, self._bytes = self._bytes[:whole], self._bytes[whole:]
        for seconds, micro, kind, code, value in EVENT.iter_unpack(read):
            event = InputEvent(seconds + 1e-6 * micro, kind, code, value)
            if kind != SYN:
                self._events.append(event)
            elif code == SYN_DROPPED:
                self._lost = True
            elif code == SYN_REPORT:
                packet = Packet(() if self._lost else tuple(self._events), self._lost)
                self._events, self._lost = [], False
                yield packet


class AxisRange(NamedTuple):
    """What an axis tells: from ``low`` to ``high``, ``value`` now."""

    low: int
    high: int
    value: int


NODES, SYSFS = Path("/dev/input"), Path("/sys/class/input")
# --- Devices: found, and opened for us alone.


_BLUETOOTH = "0005"
_CAPABILITIES = {KEY: "key", REL: "rel", ABS: "abs"}
RULES = "/etc/udev/rules.d/70-turndesk-pendant.rules"


class EventSource(Protocol):
    """One open device: bytes of ``struct input_event``, and what is pressed now."""

    def read(self) -> bytes:
        """What has come since, nothing where nothing has. Raises OSError once the device is gone."""
        ...

    def fileno(self) -> int: ...

    def keys(self) -> frozenset[int]:
        """Every key that is down. Raises OSError."""
        ...

    def ranges(self) -> Mapping[int, AxisRange]:
        """Its axes and where they stand. Raises OSError."""
        ...

    def close(self) -> None: ...


@dataclass(frozen=True, slots=True)
class DeviceEntry:
    """A device as /sys tells it. ``stem``: nodes of one device have the same."""

    node: str
    name: str
    numbers: str  # vendor:product
    serial: str
    stem: str
    bluetooth: bool
    able: frozenset[tuple[int, int]]  # kind and code of whatever it can tell


def entries(sysfs: Path = SYSFS) -> list[DeviceEntry]:
    """Every input device that is plugged in."""
    found = []
    for path in sorted(sysfs.glob("event*")):
        with contextlib.suppress(OSError):  # pulled out while we look
            found.append(_entry(path))
    return found


def _entry(path: Path) -> DeviceEntry:
    device = path / "device"

    def text(name: str) -> str:
        try:
            return (device / name).read_text(encoding="utf-8", errors="replace").strip()
        except FileNotFoundError:
            return ""

    name = text("name")
    if not name:
        raise FileNotFoundError(device)
    able = {
        (kind, code) for kind, word in _CAPABILITIES.items() for code in _bits(text(f"capabilities/{word}"))
    }
    return DeviceEntry(
        path.name,
        name,
        f"{text('id/vendor')}:{text('id/product')}".lower(),
        text("uniq"),
        text("phys").rpartition("/")[0] or path.name,
        text("id/bustype") == _BLUETOOTH,
        frozenset(able),
    )


def _bits(words: str) -> Iterable[int]:
    """The kernel writes long words in hexadecimal, the highest first."""
    size = 8 * struct.calcsize("@l")
    for place, word in enumerate(reversed(words.split())):
        value = int(word, 16)
        yield from (place * size + bit for bit in range(size) if value >> bit & 1)


def chosen(
    device: str, serial: str, wanted: Mapping[str, Control], found: Sequence[DeviceEntry]
) -> tuple[DeviceEntry, ...]:
    """The nodes of the one device that is meant and that has all that is wanted of it. Raises DriverError."""
    meant = [each for each in found if device.lower() in {each.name.lower(), each.numbers}]
    meant = [each for each in meant if not serial or each.serial == serial]
    if not meant:
        of = Message(" with serial number {serial}", serial=serial) if serial else ""
        raise DriverError(
            "the pendant {device}{total} is not plugged in", reason="missing", device=device, total=of
        )
    groups: dict[str, list[DeviceEntry]] = {}
    for each in meant:
        groups.setdefault(each.stem, []).append(each)
    if len(groups) > 1:
        raise DriverError(
            "{groups_count} devices match {device}; unplug all but one of these devices; {meant}",
            reason="several",
            groups_count=len(groups),
            device=device,
            meant=_apart(meant),
        )
    able = frozenset().union(*(each.able for each in meant))
    lacking = [name for name, control in wanted.items() if control[:2] not in able]
    if lacking:
        names = ", ".join(lacking)
        raise DriverError(
            "the pendant {device} does not have the button or handwheel that the machine file "
            "assigns to {names}",
            reason="lacks-control",
            device=device,
            names=names,
        )
    if any(each.bluetooth for each in meant):
        raise DriverError(
            "the pendant {device} uses Bluetooth, where a lost link cannot be distinguished from "
            "a button held down; use a pendant with a cable",
            reason="bluetooth",
            device=device,
        )
    needed = {control[:2] for control in wanted.values()}
    return tuple(each for each in meant if each.able & needed)


def _apart(meant: Sequence[DeviceEntry]) -> str:
    serials = sorted({each.serial for each in meant} - {""})
    if not serials:
        return "the devices cannot be distinguished because they have no serial numbers"
    return Message(
        "alternatively, set serial in the machine file to one of these serial numbers: {serials}",
        serials=", ".join(serials),
    )


# --- the kernel's own calls -------------------------------------------------------------------------------


def _request(direction: int, number: int, size: int) -> int:
    """An ioctl of input devices, as the kernel's macro _IOC puts it together."""
    return direction << 30 | size << 16 | ord("E") << 8 | number


_ABSINFO = struct.Struct("@iiiiii")  # value, minimum, maximum, fuzz, flat, resolution
_GRAB, _CLOCK = _request(1, 0x90, 4), _request(1, 0xA0, 4)
_MONOTONIC = 1
_CHUNK = 64 * 24


def _ioctl(device: int, request: int, value: int | bytes | bytearray | array.array[int]) -> None:
    """One request to a device; only Linux has such devices, and the library for it."""
    import fcntl

    fcntl.ioctl(device, request, value)


class KernelDevice:
    """``EventSource`` on a device node, read by us alone: what it types must not reach the screen too.

    Times are of the monotonic clock. Raises DriverError where it is not to be had.
    """

    def __init__(self, entry: DeviceEntry, folder: Path = NODES) -> None:
        path = folder / entry.node
        try:
            self._fd = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        except PermissionError as error:
            raise DriverError(_not_allowed(entry, path)) from error
        except OSError as error:
            raise DriverError(
                "the pendant {entry} cannot be opened: {cause}",
                reason="not-opened",
                entry=entry.name,
                cause=error.strerror,
            ) from error
        self._able = entry.able
        try:
            _ioctl(self._fd, _CLOCK, struct.pack("@i", _MONOTONIC))
            _ioctl(self._fd, _GRAB, 1)
        except OSError as error:
            os.close(self._fd)
            raise DriverError(
                "another program is using the pendant {entry}; close that program ({cause})",
                reason="taken",
                entry=entry.name,
                cause=error.strerror,
            ) from error

    def fileno(self) -> int:
        """For select."""
        return self._fd

    def read(self) -> bytes:
        """What has come since."""
        try:
            return os.read(self._fd, _CHUNK)
        except BlockingIOError:
            return b""

    def keys(self) -> frozenset[int]:
        """EVIOCGKEY: a bit for each key that is down."""
        bits = bytearray(KEYS // 8)
        _ioctl(self._fd, _request(2, 0x18, len(bits)), bits)
        return frozenset(i for i in range(KEYS) if bits[i // 8] >> (i % 8) & 1)

    def ranges(self) -> Mapping[int, AxisRange]:
        """EVIOCGABS of every axis that it has."""
        told = {}
        for code in range(AXES):
            if (ABS, code) in self._able:
                raw = array.array("B", bytes(_ABSINFO.size))
                _ioctl(self._fd, _request(2, 0x40 + code, _ABSINFO.size), raw)
                value, low, high, *_ = _ABSINFO.unpack(raw)
                told[code] = AxisRange(low, high, value)
        return told

    def close(self) -> None:
        """Let it go: it types for everybody again."""
        with contextlib.suppress(OSError):
            os.close(self._fd)


def _not_allowed(entry: DeviceEntry, path: Path) -> str:
    vendor, _, product = entry.numbers.partition(":")
    return Message(
        "no permission to read {path} (the pendant {entry}): add this line to {rules}: "
        'SUBSYSTEM=="input", ATTRS{{idVendor}}=="{vendor}", '
        'ATTRS{{idProduct}}=="{product}", TAG+="uaccess"; then unplug the pendant and '
        "plug it in again",
        path=path,
        entry=entry.name,
        rules=RULES,
        vendor=vendor,
        product=product,
    )
