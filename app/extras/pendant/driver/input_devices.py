"""Search, opening and reading of Linux input devices (evdev), by name or USB number.

The kernel sends events as ``struct input_event`` entries, grouped into packets. The entry SYN_DROPPED marks
lost events.
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
    PendantControl,
)
from core.message import Message
from core.ports import DriverError

# Two C longs of time, then type, code and value: 24 bytes if a long has 8 bytes. The format is part of the
# kernel's stable interface (Documentation/input/event-codes.rst).
EVENT_STRUCT = struct.Struct("@llHHi")


class InputEvent(NamedTuple):
    """Event of an input device.

    ``time_s`` is the kernel's time stamp in seconds, on the clock that was selected for the device.
    """

    time_s: float
    event_kind: int
    event_code: int
    value: int


class EventPacket(NamedTuple):
    """Packet of events that occurred at the same time.

    ``has_lost_events`` means that earlier events were lost, so handwheel counts are not reliable.
    """

    events: tuple[InputEvent, ...]
    has_lost_events: bool = False


class PacketParser:
    """Parser that divides received bytes into complete packets.

    Data from SYN_DROPPED to the next SYN_REPORT are discarded.
    """

    def __init__(self) -> None:
        self._bytes = b""
        self._events: list[InputEvent] = []
        self._lost = False

    def parse(self, data: bytes) -> Iterator[EventPacket]:
        """Add received bytes, and yield every packet that is complete with these bytes."""
        self._bytes += data
        whole = len(self._bytes) // EVENT_STRUCT.size * EVENT_STRUCT.size
        read, self._bytes = self._bytes[:whole], self._bytes[whole:]
        for seconds, micro, kind, code, value in EVENT_STRUCT.iter_unpack(read):
            event = InputEvent(seconds + 1e-6 * micro, kind, code, value)
            if kind != SYN:
                self._events.append(event)
            elif code == SYN_DROPPED:
                self._lost = True
            elif code == SYN_REPORT:
                packet = EventPacket(() if self._lost else tuple(self._events), self._lost)
                self._events, self._lost = [], False
                yield packet


class AxisRange(NamedTuple):
    """Range of a device axis from ``minimum`` to ``maximum``, with the current ``value``."""

    minimum: int
    maximum: int
    value: int


NODES, SYSFS = Path("/dev/input"), Path("/sys/class/input")
# --- Devices. -------------------------------


_BLUETOOTH = "0005"
_CAPABILITIES = {KEY: "key", REL: "rel", ABS: "abs"}
UDEV_RULES_PATH = "/etc/udev/rules.d/70-turndesk-pendant.rules"


class EventSource(Protocol):
    """Interface of an open input device, which provides its current state and its events.

    Events are bytes of ``struct input_event``.
    """

    def read(self) -> bytes:
        """Return the bytes received since the last call, or empty bytes.

        Raises OSError after the device is disconnected.
        """
        ...

    def fileno(self) -> int:
        """Return the file descriptor of the device, on which a thread can wait for events."""
        ...

    def read_pressed_keys(self) -> frozenset[int]:
        """Return the codes of all pressed keys.

        Raises OSError if the device is disconnected.
        """
        ...

    def read_axis_ranges(self) -> Mapping[int, AxisRange]:
        """Return the ranges and current values of all device axes by axis code.

        Raises OSError if the device is disconnected.
        """
        ...

    def close(self) -> None:
        """Close the device."""
        ...


@dataclass(frozen=True, slots=True)
class DeviceEntry:
    """Input device node that is listed in /sys.

    All nodes of one physical device have the same ``stem``.
    """

    node: str
    name: str
    numbers: str  # vendor:product
    serial: str
    stem: str
    bluetooth: bool
    able: frozenset[tuple[int, int]]  # kind and code of all possible events


def list_input_devices(sysfs_folder: Path = SYSFS) -> list[DeviceEntry]:
    """Return the entries of all connected input devices."""
    found = []
    for path in sorted(sysfs_folder.glob("event*")):
        with contextlib.suppress(OSError):  # The device was unplugged in the meantime.
            found.append(_entry(path))
    return found


def _entry(path: Path) -> DeviceEntry:
    device = path / "device"

    def read_attribute(name: str) -> str:
        try:
            return (device / name).read_text(encoding="utf-8", errors="replace").strip()
        except FileNotFoundError:
            return ""

    name = read_attribute("name")
    if not name:
        raise FileNotFoundError(device)
    able = {
        (kind, code)
        for kind, word in _CAPABILITIES.items()
        for code in _bits(read_attribute(f"capabilities/{word}"))
    }
    return DeviceEntry(
        path.name,
        name,
        f"{read_attribute('id/vendor')}:{read_attribute('id/product')}".lower(),
        read_attribute("uniq"),
        read_attribute("phys").rpartition("/")[0] or path.name,
        read_attribute("id/bustype") == _BLUETOOTH,
        frozenset(able),
    )


def _bits(words: str) -> Iterable[int]:
    """Yield the numbers of the set bits in a bit field of the kernel.

    The kernel writes the bit field as hexadecimal longs, starting with the highest long.
    """
    size = 8 * struct.calcsize("@l")
    for place, word in enumerate(reversed(words.split())):
        value = int(word, 16)
        yield from (place * size + bit for bit in range(size) if value >> bit & 1)


def select_device_nodes(
    device: str, serial: str, required_controls: Mapping[str, PendantControl], entries: Sequence[DeviceEntry]
) -> tuple[DeviceEntry, ...]:
    """Return those nodes of the matching device that have a required control.

    Raises DriverError if no device or more than one device matches, if a required control is missing, or if
    the device uses Bluetooth.
    """
    meant = [each for each in entries if device.lower() in {each.name.lower(), each.numbers}]
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
    lacking = [name for name, control in required_controls.items() if control[:2] not in able]
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
    needed = {control[:2] for control in required_controls.values()}
    return tuple(each for each in meant if each.able & needed)


def _apart(meant: Sequence[DeviceEntry]) -> str:
    serials = sorted({each.serial for each in meant} - {""})
    if not serials:
        return "the devices cannot be distinguished because they have no serial numbers"
    return Message(
        "alternatively, set serial in the machine file to one of these serial numbers: {serials}",
        serials=", ".join(serials),
    )


# --- kernel calls -----------------------------------------------------------------------------------------


def _request(direction: int, number: int, size: int) -> int:
    """Return the ioctl number of a request to an input device, calculated like the kernel macro _IOC."""
    return direction << 30 | size << 16 | ord("E") << 8 | number


_ABSINFO = struct.Struct("@iiiiii")  # value, minimum, maximum, fuzz, flat, resolution
_GRAB, _CLOCK = _request(1, 0x90, 4), _request(1, 0xA0, 4)
_MONOTONIC = 1
_CHUNK = 64 * 24


def _ioctl(device: int, request: int, value: int | bytes | bytearray | array.array[int]) -> None:
    """Send one ioctl request to a device.

    The module ``fcntl`` is imported here because it exists only on Linux.
    """
    import fcntl

    fcntl.ioctl(device, request, value)


class KernelDevice:
    """Implementation of ``EventSource`` for a device node.

    The node is opened exclusively, so key presses do not reach the screen. Time stamps are on the monotonic
    clock. Raises DriverError if the device cannot be opened.
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
        """Return the file descriptor of the device, for ``select``."""
        return self._fd

    def read(self) -> bytes:
        """Return the bytes received since the last call, or empty bytes."""
        try:
            return os.read(self._fd, _CHUNK)
        except BlockingIOError:
            return b""

    def read_pressed_keys(self) -> frozenset[int]:
        """Return the codes of the pressed keys (EVIOCGKEY)."""
        bits = bytearray(KEYS // 8)
        _ioctl(self._fd, _request(2, 0x18, len(bits)), bits)
        return frozenset(i for i in range(KEYS) if bits[i // 8] >> (i % 8) & 1)

    def read_axis_ranges(self) -> Mapping[int, AxisRange]:
        """Return the range of every device axis by axis code (EVIOCGABS)."""
        axis_ranges = {}
        for code in range(AXES):
            if (ABS, code) in self._able:
                raw = array.array("B", bytes(_ABSINFO.size))
                _ioctl(self._fd, _request(2, 0x40 + code, _ABSINFO.size), raw)
                value, low, high, *_ = _ABSINFO.unpack(raw)
                axis_ranges[code] = AxisRange(low, high, value)
        return axis_ranges

    def close(self) -> None:
        """Close the device and end its exclusive use."""
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
        rules=UDEV_RULES_PATH,
        vendor=vendor,
        product=product,
    )
