"""Simulated CANopen node with NMT, PDO, SYNC, heartbeat and EMCY.

The SDO server is part of the canopen library.
"""

from __future__ import annotations

import struct
from typing import NamedTuple, Protocol

import can
import canopen
from canopen import LocalNode, ObjectDictionary
from canopen.objectdictionary import ODVariable, datatypes

from drivers.canopen import canopen_objects as od

_OPERATIONAL, _PRE_OPERATIONAL, _STOPPED = 5, 127, 4
_START, _STOP, _PRE, _RESET, _RESET_COMMUNICATION = 1, 2, 128, 129, 130
_STATES = {_START: _OPERATIONAL, _STOP: _STOPPED, _PRE: _PRE_OPERATIONAL}
_SYNCHRONOUS = 240
_MAX_MISSING_SYNCS = 10  # periods without a SYNC
_PDO_DISABLED = 1 << 31


class NodeDevice(Protocol):
    """Device that provides and receives the values of a node's objects."""

    def read(self, index: int, subindex: int, /) -> int | None:
        """Return the calculated value of an object, or None if the stored value is to be used."""
        ...

    def write(self, index: int, subindex: int, value: int, /) -> None:
        """Apply a value that the host has written to an object by SDO or PDO."""
        ...

    def handle_host_loss(self) -> None:
        """React to a missing heartbeat, SYNC or PDO of the host."""
        ...

    def reset(self) -> None:
        """Clear all volatile values after power-up or an NMT reset."""
        ...


class DeviceNetwork(canopen.Network):
    """CANopen network without a receiver thread and without periodic tasks.

    ``CanopenDevices.process_frames`` receives frames, and ``DeviceNode.run_cycle`` sends heartbeats.
    """

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send one frame, or discard the frame if the bus is closed."""
        if self.bus is not None:
            frame = can.Message(
                arbitration_id=can_id, data=bytes(data), is_extended_id=False, is_remote_frame=remote
            )
            self.bus.send(frame)

    def send_periodic(self, *_: object, **__: object) -> _NoTask:
        """Return a task that does nothing, because ``DeviceNode.run_cycle`` sends the heartbeat."""
        return _NoTask()


class _NoTask(canopen.network.PeriodicMessageTask):
    def __init__(self) -> None:
        """Create a task that sends nothing."""

    def stop(self) -> None:
        """Do nothing, because the task sends nothing."""

    def update(self, data: bytes) -> None:
        """Do nothing, because the task sends nothing."""


_Entry = tuple[int, int, int, bool]  # Index, sub-index, number of bytes and sign of a PDO entry.
_SIGNED = frozenset(datatypes.SIGNED_TYPES)


class _ReceivePdo(NamedTuple):
    """PDO that the node receives (RPDO), with the objects that are mapped to it."""

    pdo_number: int
    waits_for_sync: bool  # The RPDO takes effect at the next SYNC.
    entries: list[_Entry]


class _TransmitPdo(NamedTuple):
    """PDO that the node sends every ``sync_divisor`` SYNCs (TPDO), with its mapped objects."""

    cob_id: int
    sync_divisor: int
    entries: list[_Entry]


class _Communication(NamedTuple):
    """Communication settings of a node, which are read again after a write to an object of CiA 301.

    Times are in seconds; a time of 0 disables the function.
    """

    heartbeat_period_s: float
    monitored_cob_id: int  # COB-ID of the monitored heartbeat.
    heartbeat_timeout_s: float
    sync_period_s: float
    max_setpoint_gap_s: float  # Longest time between two frames of the first RPDO.
    receive_pdos: dict[int, _ReceivePdo]
    transmit_pdos: list[_TransmitPdo]
    accepted_can_ids: frozenset[int]


class DeviceNode:
    """One simulated node on the bus.

    Tests can set ``is_silent`` or call ``boot_up``.
    """

    def __init__(
        self, network: DeviceNetwork, node_id: int, objects: ObjectDictionary, device: NodeDevice
    ) -> None:
        self.network = network
        self.node_id = node_id
        self.device = device
        self.local_node = LocalNode(node_id, objects)
        network.add_node(self.local_node)
        self.local_node.add_read_callback(self._on_read)
        self.local_node.add_write_callback(self._on_write)
        self.state = _PRE_OPERATIONAL
        self.is_silent = False
        self.time_s = 0.0
        self._next_beat = 0.0
        self._host_heard: float | None = None
        self._syncs = 0
        self._sync_at: float | None = None  # Time of the last SYNC.
        self._told_at: float | None = None
        self._waiting: dict[
            int, tuple[list[_Entry], bytes]
        ] = {}  # By number of the RPDO, until the next SYNC.
        self._communication: _Communication | None = None  # None: the settings must be read again.
        self.boot_up()

    def boot_up(self) -> None:
        """Clear all volatile values and send the boot-up message."""
        self.state = _PRE_OPERATIONAL
        self.local_node.data_store.clear()
        self._communication = None
        self._waiting.clear()
        self._host_heard = self._sync_at = self._told_at = None
        self.device.reset()
        self.network.send_message(0x700 + self.node_id, b"\x00")

    @property
    def accepted_can_ids(self) -> frozenset[int]:
        """Return the identifiers of the frames that the node accepts."""
        return self._get_communication().accepted_can_ids

    def handle_frame(self, can_id: int, data: bytes) -> None:
        """Handle one received frame that the node accepts."""
        communication = self._get_communication()
        if self.is_silent:
            return
        if can_id == 0 and len(data) >= 2 and data[1] in {0, self.node_id}:
            self._command(data[0])
        elif can_id == 0x600 + self.node_id and self.state != _STOPPED:
            self.local_node.sdo.on_request(can_id, bytearray(data), self.time_s)
        elif can_id == communication.monitored_cob_id:
            self._host_heard = self.time_s
        elif self.state == _OPERATIONAL:
            self._process_data(can_id, data, communication)

    def run_cycle(self, now: float) -> None:
        """Send the heartbeat when it is due, and check the heartbeat and the setpoints of the host."""
        self.time_s = now
        communication = self._get_communication()
        if communication.heartbeat_period_s and now >= self._next_beat and not self.is_silent:
            self._next_beat = now + communication.heartbeat_period_s
            self.network.send_message(0x700 + self.node_id, bytes([self.state]))
        if (
            communication.heartbeat_timeout_s
            and self._host_heard is not None
            and now - self._host_heard > communication.heartbeat_timeout_s
        ):
            self._host_heard = None
            self.send_emergency(0x8130)
            self.device.handle_host_loss()
        self._check_setpoints(now, communication)

    def _check_setpoints(self, now: float, communication: _Communication) -> None:
        """Treat the host as lost if SYNC or the first RPDO is missing for longer than configured."""
        if self.state != _OPERATIONAL:
            self._sync_at = self._told_at = None
        if (
            communication.sync_period_s
            and self._sync_at is not None
            and now - self._sync_at > _MAX_MISSING_SYNCS * communication.sync_period_s
        ):
            self._sync_at = None
            self.send_emergency(0x8700)
            self.device.handle_host_loss()
        elif (
            communication.max_setpoint_gap_s
            and self._told_at is not None
            and now - self._told_at > communication.max_setpoint_gap_s
        ):
            self._told_at = None
            self.send_emergency(0x8250)
            self.device.handle_host_loss()

    def send_emergency(self, code: int, error_register: int = 1) -> None:
        """Send an EMCY frame, unless the node is silent."""
        if not self.is_silent:
            self.network.send_message(0x80 + self.node_id, struct.pack("<HB5x", code, error_register))

    def _command(self, code: int) -> None:
        if code in _STATES:
            self.state = _STATES[code]
        elif code in {_RESET, _RESET_COMMUNICATION}:
            self.boot_up()

    def _process_data(self, can_id: int, data: bytes, communication: _Communication) -> None:
        if can_id == 0x80:
            self._syncs, self._sync_at = self._syncs + 1, self.time_s
            for _, (entries, waiting) in sorted(self._waiting.items()):
                self._apply(entries, waiting)
            self._waiting.clear()
            self._answer(communication)
        elif can_id in communication.receive_pdos:
            number, waits, entries = communication.receive_pdos[can_id]
            self._told_at = self._told_at if number else self.time_s
            if waits:
                self._waiting[number] = entries, data
            else:
                self._apply(entries, data)

    def _apply(self, entries: list[_Entry], data: bytes) -> None:
        at = 0
        for index, sub, size, signed in entries:  # Faster than the node of the library.
            part = data[at : at + size]
            if len(part) == size:
                self.local_node.data_store.setdefault(index, {})[sub] = part
                self.device.write(index, sub, int.from_bytes(part, "little", signed=signed))
            at += size

    def _answer(self, communication: _Communication) -> None:
        for cob, kind, entries in communication.transmit_pdos:
            if self._syncs % kind == 0:
                self.network.send_message(cob, b"".join([self._encode_value(*entry) for entry in entries]))

    def _encode_value(self, index: int, sub: int, size: int, _signed: bool) -> bytes:
        """Return the value of an object as bytes.

        This method is faster than the corresponding method of the canopen library.
        """
        value = self.device.read(index, sub)
        if value is None:
            stored = self.local_node.data_store.setdefault(index, {})
            if sub not in stored:
                stored[sub] = bytes(self.local_node.get_data(index, sub))
            return bytes(stored[sub])
        return value.to_bytes(size, "little", signed=value < 0)

    def _get_communication(self) -> _Communication:
        """Return the communication settings, after reading them again if they have changed."""
        if self._communication is None:
            self._communication = self._read()
        return self._communication

    def _read(self) -> _Communication:
        stored, numbers = self._stored_value, range(4)
        taken = {
            cob: _ReceivePdo(
                number, stored(0x1400 + number, 2) <= _SYNCHRONOUS, self._read_mapping(0x1600 + number)
            )
            for number in numbers
            if (cob := stored(0x1400 + number, 1))
        }
        sent = [
            _TransmitPdo(cob & 0x7FF, kind, self._read_mapping(0x1A00 + number))
            for number in numbers
            if (cob := stored(0x1800 + number, 1)) and not cob & _PDO_DISABLED
            if 1 <= (kind := stored(0x1800 + number, 2)) <= _SYNCHRONOUS
        ]
        watched = 0x700 + (stored(od.WATCHED, 1) >> 16 & 0x7F)
        return _Communication(
            heartbeat_period_s=stored(od.HEARTBEAT, 0) / 1000.0,
            monitored_cob_id=watched,
            heartbeat_timeout_s=(stored(od.WATCHED, 1) & 0xFFFF) / 1000.0,
            sync_period_s=1e-6 * stored(od.SYNC_PERIOD, 0),
            max_setpoint_gap_s=0.001 * stored(od.COMMANDED, 5),
            receive_pdos=taken,
            transmit_pdos=sent,
            accepted_can_ids=frozenset({0, 0x80, 0x600 + self.node_id, watched, *taken}),
        )

    def _read_mapping(self, index: int) -> list[_Entry]:
        """Return the entries that are mapped to a PDO."""
        entries = [self._stored_value(index, sub) for sub in range(1, self._stored_value(index, 0) + 1)]
        places = [(entry >> 16, entry >> 8 & 0xFF, (entry & 0xFF) // 8) for entry in entries]
        return [(index, sub, size, self._is_signed(index, sub)) for index, sub, size in places]

    def _is_signed(self, index: int, sub: int) -> bool:
        variable = self.local_node.object_dictionary.get_variable(index, sub)
        return variable is not None and variable.data_type in _SIGNED

    def _stored_value(self, index: int, sub: int) -> int:
        """Return a stored number, such as a communication parameter, or 0 if no number is stored."""
        return int.from_bytes(self.local_node.data_store.get(index, {}).get(sub, b""), "little")

    def _on_read(self, index: int, subindex: int, **_: object) -> int | None:
        return self.device.read(index, subindex)

    def _on_write(self, index: int, subindex: int, od: ODVariable, data: bytes) -> None:
        if index < 0x2000:  # The objects of CiA 301.
            self._communication = None
        self.device.write(index, subindex, int(od.decode_raw(data)))
