"""Set of axis drives that are powered and stopped together at one SYNC, with the PVT queue of each drive.

Records of position, velocity and time (PVT) are those of EPOS2 (20C1h) and of Copley (2010h).
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, replace

from core.message import Message
from core.ports import DriverError
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import AxisConfig
from drivers.canopen.canopen_nodes import Objects
from drivers.canopen.canopen_objects import (
    CSP,
    HM,
    IP,
    MODE_BITS,
    PP,
    DriveState,
)
from drivers.canopen.canopen_setup import Setup, axis_objects
from drivers.canopen.canopen_table import CanopenTable
from drivers.canopen.cia402_drives import Drive402, DriveWork
from drivers.canopen.drive_profiles import Entry, Queue, Records

_RECORD = struct.Struct("<i")
_TOP = 2**23 - 1  # Maximum of a signed 24-bit number.
_CLEAR, _COUNT_ANEW = 0x80, 0x83  # Commands to a Copley queue: clear and stop, restart the segment count.
_TENTHS = 10.0  # Copley velocities are in 0.1 counts/s.
_SEGMENTS = 8  # Range of the integrity counter.
POSITION_TARGET, POINT_TARGET = Entry(od.TARGET, 0, 32), Entry(od.IP_RECORD, 1, 32)
_POWER = 1.5  # Seconds in which the drives must switch on or clear their faults.
_REST, _LOOKS = 2, 0.0095  # Counts within at least this number of seconds; fewer mean standstill.
_REACTION = 1.0  # Seconds until a drive without host is at rest: three heartbeats and its ramp.
_FAULTS = frozenset((DriveState.FAULT, DriveState.REACTING))


def packed(ms: int, velocity: float, position: float) -> bytes:
    """Pack one EPOS2 record: position in the low 32 bits, velocity in 24 bits, time in 8 bits.

    Raises ValueError for values out of range.
    """
    speed, place = round(velocity), round(position)
    if abs(speed) > _TOP or not 0 <= ms <= 255:
        raise ValueError(f"a record of {ms} ms and {speed} counts/s does not fit the drive")
    return _RECORD.pack(place) + (speed & 0xFFFFFF).to_bytes(3, "little") + bytes([ms])


def unpacked(data: bytes) -> tuple[int, int, int]:
    """Return milliseconds, velocity and position of an EPOS2 record."""
    return data[7], _signed(data[4:7]), _RECORD.unpack(data[:4])[0]


def segment(number: int, ms: int, velocity: float, position: float) -> bytes:
    """Pack one Copley segment of format 0: count, time, position, and velocity in 0.1 counts/s.

    Raises ValueError for values that exceed 24 bits.
    """
    speed, place = round(_TENTHS * velocity), round(position)
    if abs(speed) > _TOP or abs(place) > _TOP or not 0 <= ms <= 255:
        raise ValueError(f"a segment of {ms} ms, {place} counts and {velocity:.0f} counts/s does not fit")
    return bytes([number % _SEGMENTS, ms]) + _low(place) + _low(speed)


def unpacked_segment(data: bytes) -> tuple[int, int, float, int]:
    """Return count, milliseconds, velocity in counts/s and position of a Copley segment."""
    return data[0] & 0x07, data[1], _signed(data[5:8]) / _TENTHS, _signed(data[2:5])


class RecordQueue:
    """PVT queue of one drive."""

    def __init__(self, config: AxisConfig, queue: Queue, setup: Setup, send: Callable[[bytes], None]) -> None:
        """Create the queue; ``send`` transmits a record to the drive immediately."""
        self._config, self._setup, self._send = config, setup, send
        self.queue = queue
        self._pushed = 0

    def clear(self) -> None:
        """Clear the queue in the drive. Raises DriverError."""
        self._pushed = 0
        if self.queue.records is Records.COPLEY:
            for order in (_CLEAR, _COUNT_ANEW):
                self._setup.write_bytes(self.queue.object, 0, bytes([order]) + bytes(7))
        else:
            for clear in (0, 1):
                self._setup.write(od.BUFFER, 6, clear)

    def push(self, ms: int, velocity: float, position: float) -> None:
        """Send one record with position in mm or degrees and velocity per second.

        Raises ValueError for values that do not fit into a record.
        """
        config = self._config
        place = position / config.count
        if self.queue.records is Records.COPLEY:
            self._send(segment(self._pushed, ms, velocity / config.count, place))
        else:
            self._send(packed(ms, config.velocity(velocity), place))
        self._pushed += 1


def _low(value: int) -> bytes:
    return (value & 0xFFFFFF).to_bytes(3, "little")


def _signed(data: bytes) -> int:
    return int.from_bytes(data, "little", signed=True)


@dataclass(frozen=True, slots=True)
class Motion:
    """Motion mode: CiA 402 mode, object of the setpoints, and whether one setpoint is sent per SYNC."""

    mode: int
    target: Entry = POSITION_TARGET
    cyclic: bool = False


MOTIONS = {  # By the mode in the machine file.
    "pvt": Motion(IP),
    "csp": Motion(CSP, cyclic=True),
    "ip": Motion(IP, POINT_TARGET, cyclic=True),
    "pp": Motion(PP),
}


@dataclass(slots=True)
class DrivenAxis:
    """One axis with its drive; ``homed`` means that its counts are machine positions."""

    config: AxisConfig
    drive: Drive402
    homed: bool = False
    last: int = 0  # Counts at the previous reply.
    moving: bool = False
    records: RecordQueue | None = None  # Queue of the drive if its family has one.

    def __post_init__(self) -> None:
        """Create the queue of the drive if its family has one."""
        queue = self.config.profile.queue
        self.records = None
        if queue is not None:
            self.records = RecordQueue(self.config, queue, self.drive.setup, self.drive.push)

    @property
    def ready(self) -> bool:
        """Whether the drive has power and reports the commanded mode."""
        return self.drive.enabled and self.drive.shown_mode == self.drive.mode


class DriveSet:
    """Set of all axis drives with their common motion mode."""

    def __init__(self, axes: tuple[AxisConfig, ...], bus: Bus, how: Motion) -> None:
        self._bus = bus
        self._how = how
        self.indices = [i for i, axis in enumerate(axes) if axis.node is not None]
        self.axes = [
            _driven(axis, Drive402(bus, axis.node, how.target, ())) for axis in axes if axis.node is not None
        ]
        for axis in self.axes:
            axis.drive.tracks = how.mode if how.cyclic else None
        # Times of the SYNC of the last replies and of the last exchange.
        self.seen = self._sent = bus.clock.now()
        self._compared = self.seen  # Time of the last comparison of positions.

    @property
    def drives(self) -> list[Drive402]:
        """The drives of the axes."""
        return [axis.drive for axis in self.axes]

    @property
    def powered(self) -> bool:
        """Whether all drives have power."""
        return all(axis.drive.enabled for axis in self.axes)

    @property
    def moving(self) -> bool:
        """Whether any axis moves, according to its counts."""
        return any(axis.moving for axis in self.axes)

    def connect(self) -> None:
        """Configure every drive before the NMT start. Raises DriverError."""
        for axis in self.axes:
            self._connect(axis)

    def operational(self) -> None:
        """Start all drives by NMT."""
        for axis in self.axes:
            axis.drive.operational()

    def command(self) -> None:
        """Send the commands of all drives, which take effect together at the next SYNC."""
        for axis in self.axes:
            axis.drive.command()

    def sync_sent(self, now: float) -> None:
        """Record that a SYNC is sent, to which every drive must reply."""
        for axis in self.axes:
            axis.drive.sync_sent(now)

    def exchange(self) -> None:
        """Send the commands and a SYNC immediately."""
        self._sent = self._bus.clock.now()
        self.command()
        self.sync_sent(self._sent)
        self._bus.synchronise()

    def answered(self) -> list[DrivenAxis]:
        """Exchange once if the last exchange has been answered or has timed out, and return the axes.

        Used as the polling step of a wait. In cyclic modes, the SYNC continues independently.
        """
        if self._how.cyclic and not self._bus.stepped:
            return self.axes  # The wait of the bus continues the SYNC.
        waiting = any(axis.drive.missing for axis in self.axes)
        if not waiting or self._bus.clock.now() - self._sent >= 2 * self._bus.config.sync:
            self.exchange()
        self._bus.pump()
        return self.axes

    def aim(self, goal: DriveState) -> None:
        """Set the goal state of all drives and clear their motion bits."""
        for axis in self.axes:
            axis.drive.goal, axis.drive.extra = goal, 0

    def power_on(self) -> None:
        """Switch all drives on and wait.

        Raises DriverError that names the drives that fail; then all are switched off.
        """
        for axis in self.axes:
            axis.drive.mode, axis.drive.goal = self._how.mode, DriveState.ENABLED
        if not self._bus.wait(lambda: all(axis.ready for axis in self.answered()), _POWER):
            slow = [
                Message("{name} is {state}", name=axis.config.name, state=axis.drive.state)
                for axis in self.axes
                if not axis.ready
            ]
            self.aim(DriveState.OFF)
            why = Message(
                "the drives do not switch on: {slow}; check that the E-stop is released and the "
                "drives have power",
                slow=", ".join(slow),
            )
            raise DriverError(why, "no-power")

    def power_off(self) -> None:
        """Switch all drives off and wait up to 0.3 s."""
        self.aim(DriveState.OFF)
        self._bus.wait(lambda: not any(axis.drive.enabled for axis in self.answered()), 0.3)

    def clear(self) -> None:
        """Reset faults and configure drives that have restarted; afterwards no drive has power.

        Raises DriverError if a fault remains.
        """
        for axis in self.axes:
            if axis.drive.rebooted or axis.drive.missing:
                self._connect(axis)
                axis.drive.operational()
            axis.drive.forget()
            axis.drive.clear()
        if not self._bus.wait(lambda: not any(a.drive.state in _FAULTS for a in self.answered()), _POWER):
            names = [axis.config.name for axis in self.axes if axis.drive.state in _FAULTS]
            why = Message(
                "{names}: the drive fault cannot be cleared; check the drive's display",
                names=", ".join(names),
            )
            raise DriverError(why, "drive-keeps-fault")

    def lose_home(self) -> None:
        """Clear the home of all axes without an absolute encoder, as required after an E-stop."""
        for axis in self.axes:
            axis.homed = axis.config.absolute

    def look(self) -> str:
        """Supervise the drives and return the first fault, or an empty text."""
        trouble: str = ""
        for axis in self.axes:
            axis.drive.look(3.0 * self._bus.config.heartbeat)
            trouble = trouble or axis.drive.trouble
            if axis.drive.rebooted:
                axis.homed = axis.config.absolute
        return trouble

    def note_motion(self, now: float) -> None:
        """Update which axes move, by comparing the positions of two replies.

        A silent drive counts as stopped when the time for its own stop reaction has passed.
        """
        speaking = [axis for axis in self.axes if not axis.drive.silent]
        for axis in self.axes:
            if axis not in speaking and now - axis.drive.answered > _REACTION:
                axis.moving = False
        seen = min((axis.drive.answered for axis in speaking), default=now)
        if seen <= self.seen:
            return
        self.seen = seen
        if seen - self._compared < _LOOKS:
            return
        self._compared = seen
        for axis in speaking:
            axis.moving = abs(axis.drive.position - axis.last) > _REST
            axis.last = axis.drive.position

    def _connect(self, axis: DrivenAxis) -> None:
        config = axis.config
        axis.drive.connect(axis_work(config, self._bus.config, self._how))
        if config.counts_per_rev:
            axis.drive.setup.demand_turn(config.counts_per_rev)
        if not config.absolute:
            axis.drive.setup.demand_homing(config.home_method)
        axis.homed, axis.last = config.absolute, axis.drive.position
        axis.drive.mode = self._how.mode


def axis_work(config: AxisConfig, bus: CanopenTable, how: Motion) -> DriveWork:
    """Return the configuration of an axis drive."""
    queue = config.profile.queue if how.mode == IP and not how.cyclic else None
    submode: Objects = ((od.IP_SUBMODE, 0, queue.submode if queue is not None else 0),)
    return DriveWork(
        modes=MODE_BITS[how.mode] | (0 if config.absolute else MODE_BITS[HM]),
        standing=(
            *axis_objects(config, bus),
            *(submode if how.mode == IP else ()),
            *(every(bus.sync) if how.cyclic else ()),
        ),
        own=config.node.sdo if config.node is not None else (),
        records=queue.object if queue is not None else 0,
        period=bus.sync if how.cyclic else 0.0,
    )


def _driven(config: AxisConfig, drive: Drive402) -> DrivenAxis:
    """Create an axis with the profile of its drive. Raises DriverError if required counts are missing."""
    profile = drive.profile
    if profile.rpm and not config.counts_per_rev:
        where = f"canopen.nodes.{config.name}.counts_per_rev"
        raise DriverError(
            "{name}: {title} reports speeds in rpm, but {place} is missing; enter 4 × the "
            "encoder pulses per revolution",
            "drive-setup",
            name=config.name,
            title=profile.title,
            place=where,
        )
    return DrivenAxis(replace(config, profile=profile), drive)


def every(period: float) -> Objects:
    """Return the objects that set the setpoint period (0x60C2)."""
    return ((od.IP_TIME, 1, round(1000 * period)), (od.IP_TIME, 2, -3))
