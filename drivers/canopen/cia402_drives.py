"""CiA 402 drive that is configured by SDO and controlled by PDO."""

from __future__ import annotations

import struct
from contextlib import suppress
from dataclasses import dataclass

import canopen
from canopen.emcy import EmcyError

from core.message import Message
from core.ports import DriverError, Fault, FaultCode
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_nodes import CanNode, ObjectValues
from drivers.canopen.canopen_objects import (
    QUICK,
    DriveState,
    decode_drive_state,
    get_enabling_control_word,
    get_reset_control_word,
)
from drivers.canopen.canopen_setup import NodeSetup
from drivers.canopen.drive_profiles import PdoEntry

_FOLLOWING_ERROR_CODE = 0x8611  # EMCY
MAX_MISSING_REPLIES = 3  # Replies that may be missing from a device that replies every 10 ms.
_COMMAND_FORMAT = struct.Struct("<Hbi")  # control word, mode, target
_REPLY_FORMAT = struct.Struct("<Hbi")  # status word, mode, position
_TORQUE_FORMAT = struct.Struct("<h")  # Per mille of the rated torque.
_NAN = float("nan")
# Factor of the interval of slow values, and the maximum interval in SYNCs by CiA 301.
_RARER, _MOST_RARE = 5, 240
SPEED_TARGET, SPEED = PdoEntry(od.TARGET_SPEED, 0, 32), PdoEntry(od.VELOCITY, 0, 32, is_signed=True)
_REQUIRED_OBJECTS = (
    PdoEntry(od.CONTROL, 0, 16),
    PdoEntry(od.MODE, 0, 8),
    PdoEntry(od.STATUS, 0, 16),
    PdoEntry(od.MODE_SHOWN, 0, 8),
)


class Cia402Drive:
    """CiA 402 drive with its commanded and reported values.

    ``send_command`` sends the commanded values ``goal_state``, ``commanded_mode``, ``mode_bits`` and
    ``target_value``. ``target_value`` is a position, or a speed for a spindle. ``reported_values`` contains
    the values of optional objects by their index.
    """

    def __init__(
        self, bus: CanBus, config: CanNode, target_entry: PdoEntry, optional_entries: tuple[PdoEntry, ...]
    ) -> None:
        self.bus = bus
        self.name = config.name
        self.node_id = config.id
        objects, self.profile = od.load_drive_dictionary(config)
        self.setup = NodeSetup(bus, self.name, self.node_id, objects)
        self.node = self.setup.node
        self._target_object = target_entry
        self._asked_for = (*optional_entries, self.profile.digital_input_entry)
        self._told_as: tuple[PdoEntry, ...] = ()  # Optional objects that the drive has.
        self.reported_values: dict[int, int] = {}  # By object index.
        self.setpoint_mode: int | None = None  # In all other modes, the target is the present position.
        self.goal_state = DriveState.SWITCH_ON_DISABLED
        self.mode_bits = 0  # bits 4, 5, 6, 8 of the control word, while enabled
        self.commanded_mode = 0
        self.target_value = 0
        self.control_word = 0  # Control word of the last command.
        self.status_word = 0
        self.reported_mode = 0
        self.position = 0  # counts
        self._load = _NAN
        self.missing_reply_count = 0  # SYNCs without an answer
        # The last one is the time of the SYNC of the last reply.
        self.last_heartbeat_s = self.last_request_s = self.last_reply_s = bus.clock.now()
        self.failure: Fault | str = ""
        self.has_restarted = False
        self._resetting = False
        self._patience = bus.config.max_missing_reply_count  # Number of replies that may be missing.
        self._beats = True  # The drive has a heartbeat.

    @property
    def reported_state(self) -> DriveState:
        """Return the drive state that the last status word reports."""
        return decode_drive_state(self.status_word)

    @property
    def is_enabled(self) -> bool:
        """Return whether the drive has power and follows commands."""
        return self.reported_state is DriveState.OPERATION_ENABLED

    @property
    def is_silent(self) -> bool:
        """Return whether so many SYNC replies are missing that the reported values may be outdated."""
        return self.missing_reply_count > self._patience

    @property
    def reports_inputs(self) -> bool:
        """Return whether the drive reports digital inputs."""
        return self.profile.digital_input_entry in self._told_as

    @property
    def digital_inputs(self) -> int:
        """Return the digital inputs as bits, or 0 if the drive does not report its inputs."""
        return self.reported_values.get(self.profile.digital_input_entry.object_index, 0)

    @property
    def measured_speed(self) -> int:
        """Return the measured speed in the unit of the drive, or 0 if the speed is not mapped to a PDO."""
        return self.reported_values.get(od.VELOCITY, 0)

    @property
    def torque_percent(self) -> float:
        """Return the torque in percent of the rated torque, signed.

        The value is nan if the drive does not report its torque or is silent.
        """
        return _NAN if self.is_silent else self._load

    def connect(self, setup_data: DriveSetupData) -> None:
        """Check and configure the drive and map its PDOs while it is in the state PRE-OPERATIONAL.

        Raises DriverError if the drive does not respond or does not match the machine file.
        """
        setup, records = self.setup, setup_data.record_object_index
        setup.enter_pre_operational()
        setup.require_profile(402)
        setup.require_modes(setup_data.mode_bits, self.profile.supported_mode_bits)
        setup.configure_objects(
            setup_data.default_objects, setup_data.file_objects, setup_data.required_objects
        )
        setup.require_objects(*_REQUIRED_OBJECTS, self._target_object)
        if setup_data.setpoint_period_s:
            setup.enable_setpoint_monitoring(setup_data.setpoint_period_s)
        setup.map_received_objects(1, (od.CONTROL, 16), (od.MODE, 8), _to_object_address(self._target_object))
        if records:
            setup.map_received_objects(2, (records, 64), event_driven=True)
        shown = ((od.STATUS, 16), (od.MODE_SHOWN, 8), (od.POSITION, 32))
        setup.map_sent_objects(
            1, self._shown, *shown, every=1 if setup_data.is_axis else self.bus.config.slow_reply_divisor
        )
        self._told_as = tuple(
            each for each in self._asked_for if setup.has_object(each.object_index, each.object_subindex)
        )
        if self._told_as:
            more = [_to_object_address(entry) for entry in self._told_as]
            setup.map_sent_objects(2, self._told, *more, every=self.bus.config.slow_reply_divisor)
        self._map_torque()
        self._beats = od.HEARTBEAT not in setup.missing_objects
        self._patience = (
            self.bus.config.max_missing_reply_count if setup_data.is_axis else MAX_MISSING_REPLIES
        )
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.node.emcy.add_callback(self._emergency)
        self.status_word = setup.read(od.STATUS)
        self.position = self.target_value = setup.read(od.POSITION)
        self.last_heartbeat_s, self.missing_reply_count, self.has_restarted, self.failure = (
            self.bus.clock.now(),
            0,
            False,
            "",
        )

    def _map_torque(self) -> None:
        """Map the torque to a PDO for the scope, if the drive has this object; errors are ignored."""
        self._load = _NAN
        if self.setup.has_object(od.ACTUAL_TORQUE, 0):
            every = min(_RARER * self.bus.config.slow_reply_divisor, _MOST_RARE)
            with suppress(DriverError):  # Some drives cannot map the torque or have no fourth PDO.
                self.setup.map_sent_objects(4, self._torque, (od.ACTUAL_TORQUE, 16), every=every)

    def start_node(self) -> None:
        """Start the drive by NMT, after all nodes are configured."""
        self.node.nmt.state = "OPERATIONAL"

    def send_command(self) -> None:
        """Send the commanded values, which the drive applies at the next SYNC."""
        if self.setpoint_mode is not None and not (
            self.is_enabled and self.reported_mode == self.setpoint_mode
        ):
            self.target_value = self.position  # The drive starts at its present position.
        self.control_word = self._next_word()
        data = _COMMAND_FORMAT.pack(self.control_word, self.commanded_mode, self.target_value)
        self.bus.send_message(0x200 + self.node_id, data)

    def record_sync(self, now: float, *, reply_expected: bool = True) -> None:
        """Record that a SYNC was sent at time ``now``.

        With ``reply_expected``, the drive must reply to this SYNC.
        """
        self.missing_reply_count, self.last_request_s = self.missing_reply_count + reply_expected, now

    def send_setpoint_record(self, record: bytes) -> None:
        """Send one record to the queue in the drive."""
        self.bus.send_message(0x300 + self.node_id, record)

    def reset_fault(self) -> None:
        """Start to reset a fault, and switch off the power of the drive."""
        self.goal_state, self.mode_bits, self._resetting = DriveState.SWITCH_ON_DISABLED, 0, True

    def supervise_drive(self, heartbeat_timeout_s: float) -> None:
        """Set a fault if heartbeats or replies are missing, or if the drive reports a fault.

        The fault remains active until ``clear_stored_fault`` is called. ``heartbeat_timeout_s`` is in
        seconds.
        """
        now = self.bus.clock.now()
        if self._beats and now - self.last_heartbeat_s > heartbeat_timeout_s:
            self._wrong(
                "{name}: no heartbeat from the drive for {now} s; check cable and power",
                "drive-silent",
                name=self.name,
                now=f"{now - self.last_heartbeat_s:.2f}",
            )
        elif self.is_silent:
            self._wrong(
                "{name}: the drive does not respond to SYNC; check cable and power",
                "drive-silent",
                name=self.name,
            )
        elif (
            self.reported_state in {DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE}
            and not self._resetting
        ):
            self._wrong("{name}: drive fault", "axis", name=self.name)

    def clear_stored_fault(self) -> None:
        """Clear the stored fault."""
        self.failure = ""

    def _next_word(self) -> int:
        state = self.reported_state
        if self._resetting:
            self._resetting = state in {DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE}
            return get_reset_control_word(state, self.control_word)
        if self.goal_state is DriveState.OPERATION_ENABLED:
            word = get_enabling_control_word(state)
            return word | self.mode_bits if state is DriveState.OPERATION_ENABLED else word
        if self.goal_state is DriveState.QUICK_STOP_ACTIVE and state in {
            DriveState.OPERATION_ENABLED,
            DriveState.QUICK_STOP_ACTIVE,
        }:
            return QUICK
        return 0

    def _wrong(self, what: str, code: FaultCode, **values: object) -> None:
        self.failure = self.failure or Fault(what, code, **values)

    def _shown(self, map_: canopen.pdo.PdoMap) -> None:
        self.status_word, self.reported_mode, self.position = _REPLY_FORMAT.unpack(map_.data)
        self.missing_reply_count, self.last_reply_s = 0, self.last_request_s

    def _torque(self, map_: canopen.pdo.PdoMap) -> None:
        self._load = _TORQUE_FORMAT.unpack(map_.data)[0] / 10.0

    def _told(self, map_: canopen.pdo.PdoMap) -> None:
        if len(map_.data) != sum(entry.bit_count for entry in self._told_as) // 8:
            raise ValueError(f"{len(map_.data)} bytes")
        at = 0
        for index, _, bits, signed in self._told_as:
            size = bits // 8
            self.reported_values[index] = int.from_bytes(map_.data[at : at + size], "little", signed=signed)
            at += size

    def _heartbeat(self, state: int) -> None:
        self.last_heartbeat_s = self.bus.clock.now()
        if state == 0:
            self.has_restarted = True
            self._wrong(
                "{name}: the drive has restarted; its position is lost", "drive-restarted", name=self.name
            )
        elif state == 4:
            self._wrong("{name}: the drive was stopped by an NMT command", "axis", name=self.name)

    def _emergency(self, error: EmcyError) -> None:
        if error.code & 0xFF00:
            what = Message(
                "{name}: {description} (EMCY {code})",
                name=self.name,
                description=error.get_desc().lower() or "drive error",
                code=f"{error.code:04X}",
            )
            self._wrong(what, "following" if error.code == _FOLLOWING_ERROR_CODE else "axis")


def _to_object_address(entry: PdoEntry) -> tuple[int, int]:
    """Return the object of a PDO entry as (index + sub-index · 65536, size in bits)."""
    return entry.object_index | entry.object_subindex << 16, entry.bit_count


@dataclass(frozen=True, slots=True)
class DriveSetupData:
    """Configuration of a drive.

    ``mode_bits`` are the required modes as bits of object 6502h. ``default_objects`` and ``file_objects``
    are the values to write; those of the machine file replace the defaults. A drive that lacks an object in
    ``required_objects`` cannot be used. ``record_object_index`` is the queue for motion records.
    ``setpoint_period_s`` is the setpoint period in seconds that the drive must monitor.
    """

    mode_bits: int
    default_objects: ObjectValues
    file_objects: ObjectValues = ()
    required_objects: tuple[int, ...] = ()
    record_object_index: int = 0
    setpoint_period_s: float = 0.0
    is_axis: bool = True  # Replies to each SYNC; a spindle replies every 10 ms.
