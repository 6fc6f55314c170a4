"""Set of axis drives that are powered and stopped together at one SYNC, and the PVT queue of each drive.

The records of position, velocity and time (PVT) have the formats of EPOS2 (object 20C1h) and Copley (object
2010h).
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, replace

from core.message import Message
from core.ports import DriverError
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_config import MAX_SIGNED_32_BIT, AxisConfig
from drivers.canopen.canopen_nodes import ObjectValues
from drivers.canopen.canopen_objects import (
    CSP,
    HM,
    IP,
    MODE_BITS,
    PP,
    DriveState,
)
from drivers.canopen.canopen_setup import NodeSetup, build_axis_objects
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.cia402_drives import Cia402Drive, DriveSetupData
from drivers.canopen.drive_profiles import DriveQueue, PdoEntry, RecordFormat

_RECORD_FORMAT = struct.Struct("<i")
_MAX_SIGNED_24_BIT = 2**23 - 1  # Maximum of a signed 24-bit number.
_CLEAR, _COUNT_ANEW = 0x80, 0x83  # Commands to a Copley queue: clear and stop, restart the segment count.
_COPLEY_VELOCITY_SCALE = 10.0  # Copley velocities are in 0.1 counts/s.
_COUNTER_RANGE = 8  # Range of the integrity counter.
POSITION_TARGET, POINT_TARGET = PdoEntry(od.TARGET, 0, 32), PdoEntry(od.IP_RECORD, 1, 32)
_POWER_ON_S = 1.5  # Seconds in which the drives must switch on or clear their faults.
_REST, _LOOKS = 2, 0.0095  # Counts within at least this number of seconds; fewer mean standstill.
_DRIVE_STOP_S = 1.0  # Seconds until a drive without host is at rest: three heartbeats and its ramp.
_FAULT_STATES = frozenset((DriveState.FAULT, DriveState.FAULT_REACTION_ACTIVE))


def pack_epos2_record(duration_ms: int, velocity: float, position: float) -> bytes:
    """Pack one EPOS2 record: position in the low 32 bits, velocity in 24 bits, time in 8 bits.

    ``velocity`` is in the drive's unit, rpm or counts/s, and ``position`` in counts. Raises ValueError if
    the position does not fit in 32 bits or the velocity in 24 bits, or if the time is not between 0 and 255
    ms.
    """
    _check_record(duration_ms, velocity, position, MAX_SIGNED_32_BIT)
    return _RECORD_FORMAT.pack(round(position)) + _low(round(velocity)) + bytes([duration_ms])


def unpack_epos2_record(data: bytes) -> tuple[int, int, int]:
    """Return the milliseconds, velocity and position of an EPOS2 record."""
    return data[7], _signed(data[4:7]), _RECORD_FORMAT.unpack(data[:4])[0]


def pack_copley_segment(segment_number: int, duration_ms: int, velocity: float, position: float) -> bytes:
    """Pack one Copley segment of format 0: number, time, position, and velocity in 0.1 counts/s.

    ``velocity`` is in counts/s, and ``position`` in counts. Raises ValueError if the position or the packed
    velocity does not fit in 24 bits, or if the time is not between 0 and 255 ms.
    """
    scaled = _COPLEY_VELOCITY_SCALE * velocity
    _check_record(duration_ms, scaled, position, _MAX_SIGNED_24_BIT)
    return bytes([segment_number % _COUNTER_RANGE, duration_ms]) + _low(round(position)) + _low(round(scaled))


def unpack_copley_segment(data: bytes) -> tuple[int, int, float, int]:
    """Return the number, milliseconds, velocity in counts/s, and position of a Copley segment."""
    return data[0] & 0x07, data[1], _signed(data[5:8]) / _COPLEY_VELOCITY_SCALE, _signed(data[2:5])


def _check_record(duration_ms: int, velocity: float, position: float, max_position: int) -> None:
    """Raise ValueError unless each value of a record fits into its bits."""
    # A value that is not a number fits nowhere.
    if not (
        0 <= duration_ms <= 255 and abs(velocity) <= _MAX_SIGNED_24_BIT and abs(position) <= max_position
    ):
        raise ValueError(
            f"{duration_ms} ms, velocity {velocity:.0f} or position {position:.0f} does not fit the drive"
        )


class PvtRecordQueue:
    """Queue of records with position, velocity and time (PVT) in one drive."""

    def __init__(
        self, config: AxisConfig, queue: DriveQueue, setup: NodeSetup, send_bytes: Callable[[bytes], None]
    ) -> None:
        """Create the queue; ``send_bytes`` sends a record to the drive immediately."""
        self._config, self._setup, self._send = config, setup, send_bytes
        self.drive_queue = queue
        self._pushed = 0

    def clear_records(self) -> None:
        """Clear the queue in the drive.

        Raises DriverError if the drive rejects the request or does not respond.
        """
        self._pushed = 0
        if self.drive_queue.record_format is RecordFormat.COPLEY:
            for order in (_CLEAR, _COUNT_ANEW):
                self._setup.write_object_bytes(self.drive_queue.object_index, 0, bytes([order]) + bytes(7))
        else:
            for clear in (0, 1):
                self._setup.write(od.BUFFER, 6, clear)

    def send_record(self, duration_ms: int, velocity: float, position: float) -> None:
        """Send one record.

        ``position`` is in mm or degrees, and ``velocity`` in mm/s or degrees/s. Raises DriverError if a
        value does not fit into a record, or if the bus has failed.
        """
        place = self._config.convert_position(position)
        try:
            record = self._pack_record(duration_ms, velocity, place)
        except ValueError as error:
            raise DriverError(
                "{axis}: position {position} at speed {speed}/s does not fit into a record of the drive's "
                "queue; check the resolution and the maximum speed of the axis in the machine file",
                "drive-limits",
                reason="record-range",
                axis=self._config.name,
                position=f"{position:.1f}",
                speed=f"{velocity:.1f}",
            ) from error
        self._send(record)
        self._pushed += 1

    def _pack_record(self, duration_ms: int, velocity: float, place: int) -> bytes:
        """Return a record in the format of the drive. ``velocity`` is in mm/s or degrees/s."""
        config = self._config
        if self.drive_queue.record_format is RecordFormat.COPLEY:
            return pack_copley_segment(self._pushed, duration_ms, velocity / config.count, place)
        return pack_epos2_record(duration_ms, config.convert_to_drive_speed(velocity), place)


def _low(value: int) -> bytes:
    return (value & 0xFFFFFF).to_bytes(3, "little")


def _signed(data: bytes) -> int:
    return int.from_bytes(data, "little", signed=True)


@dataclass(frozen=True, slots=True)
class MotionMode:
    """Motion mode, with its CiA 402 mode number and the object that receives setpoints.

    If ``is_cyclic`` is true, one setpoint is sent per SYNC.
    """

    cia402_mode: int
    target_entry: PdoEntry = POSITION_TARGET
    is_cyclic: bool = False


MOTION_MODES = {  # By the mode in the machine file.
    "pvt": MotionMode(IP),
    "csp": MotionMode(CSP, is_cyclic=True),
    "ip": MotionMode(IP, POINT_TARGET, is_cyclic=True),
    "pp": MotionMode(PP),
}


@dataclass(slots=True)
class DrivenAxis:
    """Axis with its drive.

    If ``is_homed`` is true, the drive's counts correspond to machine positions.
    """

    config: AxisConfig
    drive: Cia402Drive
    is_homed: bool = False
    last_position_counts: int = 0  # Counts at the previous reply.
    is_moving: bool = False
    record_queue: PvtRecordQueue | None = None  # Queue of the drive if its family has one.

    def __post_init__(self) -> None:
        """Create the record queue if the drive family has one."""
        queue = self.config.profile.record_queue
        self.record_queue = None
        if queue is not None:
            self.record_queue = PvtRecordQueue(
                self.config, queue, self.drive.setup, self.drive.send_setpoint_record
            )

    @property
    def is_ready(self) -> bool:
        """Return whether the drive has power and reports the commanded mode."""
        return self.drive.is_enabled and self.drive.reported_mode == self.drive.commanded_mode


class DriveSet:
    """All axis drives of the machine, which use the same motion mode."""

    def __init__(self, axes: tuple[AxisConfig, ...], bus: CanBus, motion_mode: MotionMode) -> None:
        self._bus = bus
        self._how = motion_mode
        self.axis_indices = [i for i, axis in enumerate(axes) if axis.node is not None]
        self.axes = [
            _create_axis(axis, Cia402Drive(bus, axis.node, motion_mode.target_entry, ()))
            for axis in axes
            if axis.node is not None
        ]
        for axis in self.axes:
            axis.drive.setpoint_mode = motion_mode.cia402_mode if motion_mode.is_cyclic else None
        # Times of the SYNC of the last replies and of the last exchange.
        self.last_reply_s = self._sent = bus.clock.now()
        self._compared = self.last_reply_s  # Time of the last comparison of positions.

    @property
    def drives(self) -> list[Cia402Drive]:
        """Return the drives of all axes."""
        return [axis.drive for axis in self.axes]

    @property
    def is_powered(self) -> bool:
        """Return whether all drives have power."""
        return all(axis.drive.is_enabled for axis in self.axes)

    @property
    def is_moving(self) -> bool:
        """Return whether the counts of any axis are changing."""
        return any(axis.is_moving for axis in self.axes)

    def configure_drives(self) -> None:
        """Configure every drive before the nodes are started by NMT.

        Raises DriverError if a drive does not respond or does not match the machine file.
        """
        for axis in self.axes:
            self._connect(axis)

    def start_nodes(self) -> None:
        """Start all drives by NMT."""
        for axis in self.axes:
            axis.drive.start_node()

    def send_commands(self) -> None:
        """Send the commands to all drives, which execute them together at the next SYNC."""
        for axis in self.axes:
            axis.drive.send_command()

    def record_sync(self, now: float) -> None:
        """Record that a SYNC was sent, to which every drive must reply."""
        for axis in self.axes:
            axis.drive.record_sync(now)

    def send_commands_and_sync(self) -> None:
        """Immediately send the commands to all drives, and then a SYNC."""
        self._sent = self._bus.clock.now()
        self.send_commands()
        self.record_sync(self._sent)
        self._bus.send_sync()

    def poll_axes(self) -> list[DrivenAxis]:
        """Process received frames and return the axes; call this repeatedly to wait for the drives.

        The next commands and a SYNC are sent if all drives have replied to the last SYNC, or if a reply is
        overdue. In cyclic modes, the SYNC is sent independently of this method.
        """
        if self._how.is_cyclic and not self._bus.has_simulated_time:
            return self.axes  # The wait of the bus continues the SYNC.
        waiting = any(axis.drive.missing_reply_count for axis in self.axes)
        if not waiting or self._bus.clock.now() - self._sent >= 2 * self._bus.config.sync:
            self.send_commands_and_sync()
        self._bus.process_frames()
        return self.axes

    def set_goal_state(self, goal: DriveState) -> None:
        """Set the goal state of all drives and clear their mode bits."""
        for axis in self.axes:
            axis.drive.goal_state, axis.drive.mode_bits = goal, 0

    def power_on(self) -> None:
        """Switch all drives on, and wait until all of them have power.

        If a drive does not switch on, switch all drives off again and raise DriverError with the names of
        the drives that failed.
        """
        for axis in self.axes:
            axis.drive.commanded_mode, axis.drive.goal_state = (
                self._how.cia402_mode,
                DriveState.OPERATION_ENABLED,
            )
        if not self._bus.wait_until(lambda: all(axis.is_ready for axis in self.poll_axes()), _POWER_ON_S):
            slow = [
                Message("{name} is {state}", name=axis.config.name, state=axis.drive.reported_state)
                for axis in self.axes
                if not axis.is_ready
            ]
            self.set_goal_state(DriveState.SWITCH_ON_DISABLED)
            why = Message(
                "the drives do not switch on: {slow}; check that the E-stop is released and the "
                "drives have power",
                slow=", ".join(slow),
            )
            raise DriverError(why, "no-power")

    def power_off(self) -> None:
        """Switch all drives off, and wait up to 0.3 s until they have no power."""
        self.set_goal_state(DriveState.SWITCH_ON_DISABLED)
        self._bus.wait_until(lambda: not any(axis.drive.is_enabled for axis in self.poll_axes()), 0.3)

    def reset_faults(self) -> None:
        """Reset all faults, and configure the drives that have restarted or did not reply to the last SYNC.

        Afterward, all drives are without power. Raises DriverError if a drive cannot be configured, or if a
        fault remains active.
        """
        for axis in self.axes:
            if axis.drive.has_restarted or axis.drive.missing_reply_count:
                self._connect(axis)
                axis.drive.start_node()
            axis.drive.clear_stored_fault()
            axis.drive.reset_fault()
        if not self._bus.wait_until(
            lambda: not any(a.drive.reported_state in _FAULT_STATES for a in self.poll_axes()), _POWER_ON_S
        ):
            names = [axis.config.name for axis in self.axes if axis.drive.reported_state in _FAULT_STATES]
            why = Message(
                "{names}: the drive fault cannot be cleared; check the drive's display",
                names=", ".join(names),
            )
            raise DriverError(why, "drive-keeps-fault")

    def mark_axes_not_homed(self) -> None:
        """Mark all axes without an absolute encoder as not homed, as required after an E-stop."""
        for axis in self.axes:
            axis.is_homed = axis.config.absolute

    def supervise_drives(self) -> str:
        """Supervise the drives, and return the first fault, or an empty string if there is no fault."""
        fault_text: str = ""
        for axis in self.axes:
            axis.drive.supervise_drive(3.0 * self._bus.config.heartbeat)
            fault_text = fault_text or axis.drive.failure
            if axis.drive.has_restarted:
                axis.is_homed = axis.config.absolute
        return fault_text

    def update_moving_axes(self, now: float) -> None:
        """Determine which axes are moving by comparing their positions in two consecutive replies.

        A silent drive is treated as stopped after the time in which it must have stopped on its own.
        """
        speaking = [axis for axis in self.axes if not axis.drive.is_silent]
        for axis in self.axes:
            if axis not in speaking and now - axis.drive.last_reply_s > _DRIVE_STOP_S:
                axis.is_moving = False
        seen = min((axis.drive.last_reply_s for axis in speaking), default=now)
        if seen <= self.last_reply_s:
            return
        self.last_reply_s = seen
        if seen - self._compared < _LOOKS:
            return
        self._compared = seen
        for axis in speaking:
            axis.is_moving = abs(axis.drive.position - axis.last_position_counts) > _REST
            axis.last_position_counts = axis.drive.position

    def _connect(self, axis: DrivenAxis) -> None:
        config = axis.config
        axis.drive.connect(build_drive_setup(config, self._bus.config, self._how))
        if config.counts_per_rev:
            axis.drive.setup.require_counts_per_rev(config.counts_per_rev)
        if not config.absolute:
            axis.drive.setup.require_homing_method(config.home_method)
        axis.is_homed, axis.last_position_counts = config.absolute, axis.drive.position
        axis.drive.commanded_mode = self._how.cia402_mode


def build_drive_setup(config: AxisConfig, bus: CanopenTable, motion_mode: MotionMode) -> DriveSetupData:
    """Return the configuration for an axis drive."""
    queue = (
        config.profile.record_queue if motion_mode.cia402_mode == IP and not motion_mode.is_cyclic else None
    )
    submode: ObjectValues = ((od.IP_SUBMODE, 0, queue.submode if queue is not None else 0),)
    return DriveSetupData(
        mode_bits=MODE_BITS[motion_mode.cia402_mode] | (0 if config.absolute else MODE_BITS[HM]),
        default_objects=(
            *build_axis_objects(config, bus),
            *(submode if motion_mode.cia402_mode == IP else ()),
            *(build_setpoint_period_objects(bus.sync) if motion_mode.is_cyclic else ()),
        ),
        file_objects=config.node.sdo if config.node is not None else (),
        record_object_index=queue.object_index if queue is not None else 0,
        setpoint_period_s=bus.sync if motion_mode.is_cyclic else 0.0,
    )


def _create_axis(config: AxisConfig, drive: Cia402Drive) -> DrivenAxis:
    """Create an axis with the profile of its drive.

    Raises DriverError if the drive needs counts per revolution, but the machine file does not specify them.
    """
    profile = drive.profile
    if profile.uses_rpm and not config.counts_per_rev:
        where = f"canopen.nodes.{config.name}.counts_per_rev"
        raise DriverError(
            "{name}: {title} reports speeds in rpm, but {place} is missing; enter 4 × the "
            "encoder pulses per revolution",
            "drive-setup",
            name=config.name,
            title=profile.display_name,
            place=where,
        )
    return DrivenAxis(replace(config, profile=profile), drive)


def build_setpoint_period_objects(period_s: float) -> ObjectValues:
    """Return the objects that set the setpoint period (object 60C2h)."""
    return ((od.IP_TIME, 1, round(1000 * period_s)), (od.IP_TIME, 2, -3))
