"""A CANopen device: SDO server of the library; NMT, PDO, SYNC, heartbeats and EMCY of our own."""

from __future__ import annotations

import struct
from typing import Protocol

import can
import canopen
from canopen import LocalNode, ObjectDictionary
from canopen.objectdictionary import ODVariable

from drivers.canopen import canopen_objects as od

_OPERATIONAL, _PRE_OPERATIONAL, _STOPPED = 5, 127, 4
_START, _STOP, _PRE, _RESET, _RESET_COMMUNICATION = 1, 2, 128, 129, 130
_STATES = {_START: _OPERATIONAL, _STOP: _STOPPED, _PRE: _PRE_OPERATIONAL}
_SYNCHRONOUS = 240
_PATIENT = 10  # periods without a SYNC
_OFF = 1 << 31


class Device(Protocol):
    """What stands behind the objects."""

    def read(self, index: int, sub: int, /) -> int | None:
        """A value that lives in the device; None: the stored one."""
        ...

    def write(self, index: int, sub: int, value: int, /) -> None:
        """Called behind every write, by SDO and by PDO."""
        ...

    def host_lost(self) -> None:
        """The heartbeat that 0x1016 watches has stopped."""
        ...

    def reset(self) -> None:
        """Power or NMT reset: everything volatile is gone."""
        ...


class DeviceNetwork(canopen.Network):
    """A bus without a reading thread and without periodic jobs: both are done by ``CanopenDevices.pump``."""

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """One frame; without a bus it is lost."""
        if self.bus is not None:
            frame = can.Message(
                arbitration_id=can_id, data=bytes(data), is_extended_id=False, is_remote_frame=remote
            )
            self.bus.send(frame)

    def send_periodic(self, *_: object, **__: object) -> _NoTask:
        """The node's own heartbeat is sent by its tick."""
        return _NoTask()


class _NoTask(canopen.network.PeriodicMessageTask):
    def __init__(self) -> None:
        """Nothing to send."""

    def stop(self) -> None:
        """Nothing runs."""

    def update(self, data: bytes) -> None:
        """Nothing runs."""


class DeviceNode:
    """One device on the bus. Tests may make it ``silent``, or let it ``reboot``."""

    def __init__(
        self, network: DeviceNetwork, node_id: int, objects: ObjectDictionary, device: Device
    ) -> None:
        self.network = network
        self.id = node_id
        self.device = device
        self.local = LocalNode(node_id, objects)
        network.add_node(self.local)
        self.local.add_read_callback(self._on_read)
        self.local.add_write_callback(self._on_write)
        self.state = _PRE_OPERATIONAL
        self.silent = False
        self.now = 0.0
        self._next_beat = 0.0
        self._host_heard: float | None = None
        self._syncs = 0
        self._sync_at: float | None = None  # of the last SYNC, and of the last of its first PDO
        self._told_at: float | None = None
        self._waiting: dict[int, bytes] = {}  # RPDO number → data until the next SYNC
        # What was read of the stored objects since one of them was written: COB-ID and number of each RPDO,
        # the entries of each PDO, and numbers by their place.
        self._rpdos: list[tuple[int, int]] | None = None
        self._entries: dict[int, list[tuple[int, int, int]]] = {}
        self._numbers: dict[tuple[int, int], int] = {}
        self.boot()

    def boot(self) -> None:
        """Say that it is there; everything volatile is gone."""
        self.state = _PRE_OPERATIONAL
        self.local.data_store.clear()
        self._forget()
        self._waiting.clear()
        self._host_heard = self._sync_at = self._told_at = None
        self.device.reset()
        self.network.send_message(0x700 + self.id, b"\x00")

    def take(self, can_id: int, data: bytes) -> None:
        """One frame of the bus."""
        if self.silent:
            return
        if can_id == 0 and len(data) >= 2 and data[1] in {0, self.id}:
            self._command(data[0])
        elif can_id == 0x600 + self.id and self.state != _STOPPED:
            self.local.sdo.on_request(can_id, bytearray(data), self.now)
        elif can_id == 0x700 + self._watched()[0]:
            self._host_heard = self.now
        elif self.state == _OPERATIONAL:
            self._process_data(can_id, data)

    def tick(self, now: float) -> None:
        """Heartbeat, and watching the host's."""
        self.now = now
        period = self._stored(od.HEARTBEAT, 0) / 1000.0
        if period and now >= self._next_beat and not self.silent:
            self._next_beat = now + period
            self.network.send_message(0x700 + self.id, bytes([self.state]))
        patience = self._watched()[1]
        if patience and self._host_heard is not None and now - self._host_heard > patience:
            self._host_heard = None
            self.emergency(0x8130)
            self.device.host_lost()
        self._miss_setpoints(now)

    def _miss_setpoints(self, now: float) -> None:
        """A SYNC, or a first PDO, that stays away for longer than this device was told."""
        if self.state != _OPERATIONAL:
            self._sync_at = self._told_at = None
        period, longest = 1e-6 * self._stored(od.SYNC_PERIOD, 0), 0.001 * self._stored(od.COMMANDED, 5)
        if period and self._sync_at is not None and now - self._sync_at > _PATIENT * period:
            self._sync_at = None
            self.emergency(0x8700)
            self.device.host_lost()
        elif longest and self._told_at is not None and now - self._told_at > longest:
            self._told_at = None
            self.emergency(0x8250)
            self.device.host_lost()

    def emergency(self, code: int, register: int = 1) -> None:
        """An EMCY, unless the node is silent."""
        if not self.silent:
            self.network.send_message(0x80 + self.id, struct.pack("<HB5x", code, register))

    def _command(self, code: int) -> None:
        if code in _STATES:
            self.state = _STATES[code]
        elif code in {_RESET, _RESET_COMMUNICATION}:
            self.boot()

    def _process_data(self, can_id: int, data: bytes) -> None:
        if can_id == 0x80:
            self._syncs, self._sync_at = self._syncs + 1, self.now
            for number, waiting in sorted(self._waiting.items()):
                self._apply(number, waiting)
            self._waiting.clear()
            self._answer()
        for taken, number in self._taken():
            if can_id == taken:
                self._told_at = self._told_at if number else self.now
                if self._stored(0x1400 + number, 2) <= _SYNCHRONOUS:
                    self._waiting[number] = data
                else:
                    self._apply(number, data)

    def _apply(self, number: int, data: bytes) -> None:
        at = 0
        for index, sub, size in self._mapped(0x1600 + number):
            part = data[at : at + size]
            if len(part) == size:
                self.local.set_data(index, sub, part)
            at += size

    def _answer(self) -> None:
        for number in range(4):
            cob, kind = self._stored(0x1800 + number, 1), self._stored(0x1800 + number, 2)
            due = 1 <= kind <= _SYNCHRONOUS and self._syncs % kind == 0
            if cob and not cob & _OFF and due:
                parts = [self.local.get_data(index, sub) for index, sub, _ in self._mapped(0x1A00 + number)]
                self.network.send_message(cob & 0x7FF, b"".join(parts))

    def _taken(self) -> list[tuple[int, int]]:
        """COB-ID and number of each RPDO that has one."""
        if self._rpdos is None:
            told = [(self._stored(0x1400 + number, 1), number) for number in range(4)]
            self._rpdos = [each for each in told if each[0]]
        return self._rpdos

    def _forget(self) -> None:
        self._rpdos = None
        self._entries.clear()
        self._numbers.clear()

    def _mapped(self, index: int) -> list[tuple[int, int, int]]:
        """(index, sub-index, bytes) of each entry."""
        if index in self._entries:
            return self._entries[index]
        found = self._entries[index] = []
        for sub in range(1, self._stored(index, 0) + 1):
            entry = self._stored(index, sub)
            found.append((entry >> 16, entry >> 8 & 0xFF, (entry & 0xFF) // 8))
        return found

    def _stored(self, index: int, sub: int) -> int:
        """A number that is kept as it was written, such as those of communication; 0 where none is."""
        known = self._numbers.get((index, sub))
        if known is None:
            kept = self.local.data_store.get(index, {}).get(sub, b"")
            known = self._numbers[index, sub] = int.from_bytes(kept, "little")
        return known

    def _watched(self) -> tuple[int, float]:
        """Node whose heartbeat is watched, and for how long it may be missing."""
        value = self._stored(od.WATCHED, 1)
        return value >> 16 & 0x7F, (value & 0xFFFF) / 1000.0

    def _on_read(self, index: int, subindex: int, **_: object) -> int | None:
        return self.device.read(index, subindex)

    def _on_write(self, index: int, subindex: int, od: ODVariable, data: bytes) -> None:
        if index < 0x2000:  # of CiA 301; the device's own are not asked here
            self._forget()
        self.device.write(index, subindex, int(od.decode_raw(data)))
