"""CiA 402 drives: each configured and read back by SDO and driven by PDO; the axis drives together as one."""

from __future__ import annotations

import struct
from dataclasses import dataclass

import canopen
from canopen.emcy import EmcyError

from core.ports import DriverError, Fault, FaultCode
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import AxisConfig
from drivers.canopen.canopen_objects import (
    HM,
    IP,
    MODE_BITS,
    QUICK,
    DriveState,
    reset_step,
    state_of,
    towards_enabled,
)
from drivers.canopen.canopen_setup import Setup, axis_objects
from drivers.canopen.canopen_table import CanNode, Objects

_FOLLOWING = 0x8611  # EMCY
SYNCS = 3  # answers that may be missing before a drive counts as silent
_COMMAND = struct.Struct("<Hbi")  # control word, mode, target
_SHOWN = struct.Struct("<Hbi")  # status word, mode, position
_MORE = struct.Struct("<iI")  # following error of an axis or speed of a spindle, digital inputs


class Drive402:
    """``word`` and ``goal`` are what is wanted; ``exchange`` sends it, the answers come with the bus's pump.

    ``target`` is the object that the command carries: a position, or a speed for a spindle.
    """

    def __init__(self, bus: Bus, config: CanNode, target: int, more: int) -> None:
        self.bus = bus
        self.name = config.name
        self.id = config.id
        self.setup = Setup(bus, self.name, self.id, od.dictionary(self.name, config.eds, od.drive_objects))
        self.node = self.setup.node
        self._target_object, self._more_object = target, more
        self.goal = DriveState.OFF
        self.extra = 0  # bits 4, 5, 6, 8 of the control word, while enabled
        self.mode = 0
        self.target = 0
        self.word = 0  # of the last command
        self.status = 0
        self.shown_mode = 0
        self.position = 0  # counts
        self.more = 0
        self.inputs = 0  # 0x60FD
        self.missing = 0  # SYNCs without an answer
        self.heard = self.asked = self.answered = bus.clock.now()  # answered: the SYNC that it shows
        self.trouble: Fault | str = ""
        self.rebooted = False
        self._resetting = False

    @property
    def state(self) -> DriveState:
        """As the last status word has it."""
        return state_of(self.status)

    @property
    def enabled(self) -> bool:
        """Power is on and the drive obeys."""
        return self.state is DriveState.ENABLED

    @property
    def silent(self) -> bool:
        """Whether it has left too many SYNCs unanswered: what it shows is of before."""
        return self.missing > SYNCS

    def connect(
        self, mappings: tuple[int, ...], modes: int, values: tuple[tuple[int, int, int], ...]
    ) -> None:
        """Check, configure and map it in PRE-OPERATIONAL. Raises DriverError with what does not fit.

        ``modes``: bits of 0x6502 that are needed. ``mappings``: objects received beside the command.
        """
        self.setup.pre_operational()
        self.setup.demand_profile(402)
        self.setup.demand_modes(modes)
        self.setup.write_all(values)
        self.setup.receive(1, (od.CONTROL, 16), (od.MODE, 8), (self._target_object, 32))
        if mappings:
            self.setup.receive(2, *((index, 64) for index in mappings), at_once=True)
        self.setup.transmit(1, self._shown, (od.STATUS, 16), (od.MODE_SHOWN, 8), (od.POSITION, 32))
        self.setup.transmit(2, self._told, (self._more_object, 32), (od.INPUTS_402, 32))
        self.node.nmt.add_heartbeat_callback(self._heartbeat)
        self.node.emcy.add_callback(self._emergency)
        self.status = self.setup.read(od.STATUS)
        self.position = self.target = self.setup.read(od.POSITION)
        self.heard, self.missing, self.rebooted, self.trouble = self.bus.clock.now(), 0, False, ""

    def operational(self) -> None:
        """NMT start; only after every node has been configured."""
        self.node.nmt.state = "OPERATIONAL"

    def command(self) -> None:
        """Send what is wanted; the drive applies it at the next SYNC."""
        self.word = self._next_word()
        data = _COMMAND.pack(self.word, self.mode, self.target)
        self.bus.send_message(0x200 + self.id, data)
        self.missing, self.asked = self.missing + 1, self.bus.clock.now()

    def push(self, record: bytes) -> None:
        """One more record for the queue in the drive."""
        self.bus.send_message(0x300 + self.id, record)

    def clear(self) -> None:
        """Begin to reset a fault; ends without power, whatever was wanted before."""
        self.goal, self.extra, self._resetting = DriveState.OFF, 0, True

    def look(self, patience: float) -> None:
        """Supervise: heartbeat, answers, status. ``trouble`` stays until ``forget``."""
        now = self.bus.clock.now()
        if now - self.heard > patience:
            self._wrong(
                f"{self.name}: no heartbeat for {now - self.heard:.2f} s; check cable and power",
                "drive-silent",
            )
        elif self.silent:
            self._wrong(f"{self.name}: the drive does not answer SYNC; check cable and power", "drive-silent")
        elif self.state in {DriveState.FAULT, DriveState.REACTING} and not self._resetting:
            self._wrong(f"{self.name}: drive fault", "axis")

    def forget(self) -> None:
        """The operator has seen it."""
        self.trouble = ""

    def _next_word(self) -> int:
        state = self.state
        if self._resetting:
            self._resetting = state in {DriveState.FAULT, DriveState.REACTING}
            return reset_step(state, self.word)
        if self.goal is DriveState.ENABLED:
            word = towards_enabled(state)
            return word | self.extra if state is DriveState.ENABLED else word
        if self.goal is DriveState.QUICK_STOP and state in {DriveState.ENABLED, DriveState.QUICK_STOP}:
            return QUICK
        return 0

    def _wrong(self, what: str, code: FaultCode) -> None:
        self.trouble = self.trouble or Fault(what, code)

    def _shown(self, map_: canopen.pdo.PdoMap) -> None:
        self.status, self.shown_mode, self.position = _SHOWN.unpack(map_.data)
        self.missing, self.answered = 0, self.asked

    def _told(self, map_: canopen.pdo.PdoMap) -> None:
        self.more, self.inputs = _MORE.unpack(map_.data)

    def _heartbeat(self, state: int) -> None:
        self.heard = self.bus.clock.now()
        if state == 0:
            self.rebooted = True
            self._wrong(f"{self.name}: the drive has restarted; its reference is lost", "drive-restarted")
        elif state == 4:
            self._wrong(f"{self.name}: the drive was stopped by NMT", "axis")

    def _emergency(self, error: EmcyError) -> None:
        if error.code & 0xFF00:
            what = f"{error.get_desc().lower() or 'drive error'} (EMCY {error.code:04X})"
            self._wrong(f"{self.name}: {what}", "following" if error.code == _FOLLOWING else "axis")


# --- The axis drives together: configured, powered and stopped as one, at one SYNC.


_POWER = 1.5  # s in which the drives must come on, or leave their faults
_CUBIC = -1  # 0x60C0: position, velocity and time
_REST = 2  # counts from one answer to the next; less is axis_objects
_REACTION = 1.0  # s in which a drive that has lost its host is at rest: three heartbeats and its ramp
_FAULTS = frozenset((DriveState.FAULT, DriveState.REACTING))


@dataclass(slots=True)
class DrivenAxis:
    """One axis and its drive; homed: its counts mean machine positions."""

    config: AxisConfig
    drive: Drive402
    homed: bool = False
    last: int = 0  # counts at the answer before
    moving: bool = False

    @property
    def ready(self) -> bool:
        """Powered, and the mode read back."""
        return self.drive.enabled and self.drive.shown_mode == self.drive.mode


class DriveSet:
    """``mode`` is the one in which they follow setpoints."""

    def __init__(self, axes: tuple[AxisConfig, ...], bus: Bus, mode: int) -> None:
        self._bus = bus
        self._mode = mode
        self.indices = [i for i, axis in enumerate(axes) if axis.node is not None]
        self.axes = [
            DrivenAxis(axis, Drive402(bus, axis.node, od.TARGET, od.FOLLOWING))
            for axis in axes
            if axis.node is not None
        ]
        self.seen = self._sent = bus.clock.now()  # the SYNC of the last answers, of the last exchange

    @property
    def drives(self) -> list[Drive402]:
        """Without what they move."""
        return [axis.drive for axis in self.axes]

    @property
    def powered(self) -> bool:
        """Every one of them."""
        return all(axis.drive.enabled for axis in self.axes)

    @property
    def moving(self) -> bool:
        """Any of them, by its counts."""
        return any(axis.moving for axis in self.axes)

    def connect(self) -> None:
        """Configure every drive; NMT start comes later. Raises DriverError."""
        for axis in self.axes:
            self._connect(axis)

    def operational(self) -> None:
        """NMT start."""
        for axis in self.axes:
            axis.drive.operational()

    def command(self) -> None:
        """Send every drive its command; the bus's SYNC makes them act together."""
        for axis in self.axes:
            axis.drive.command()

    def exchange(self) -> None:
        """Command and SYNC, whatever was answered."""
        self._sent = self._bus.clock.now()
        self.command()
        self._bus.synchronise()

    def answered(self) -> list[DrivenAxis]:
        """For waiting: one exchange, not before the last was answered or its time is over."""
        waiting = any(axis.drive.missing for axis in self.axes)
        if not waiting or self._bus.clock.now() - self._sent >= 2 * self._bus.config.sync:
            self.exchange()
        self._bus.pump()
        return self.axes

    def aim(self, goal: DriveState) -> None:
        """What all of them shall come to, and no bits of motion left."""
        for axis in self.axes:
            axis.drive.goal, axis.drive.extra = goal, 0

    def power_on(self) -> None:
        """Walk up, and wait. Raises DriverError naming the drive that does not come; then all are off."""
        for axis in self.axes:
            axis.drive.mode, axis.drive.goal = self._mode, DriveState.ENABLED
        if not self._bus.wait(lambda: all(axis.ready for axis in self.answered()), _POWER):
            slow = [f"{axis.config.name} is {axis.drive.state}" for axis in self.axes if not axis.ready]
            self.aim(DriveState.OFF)
            why = f"drives do not come on: {', '.join(slow)}; is E-stop pressed, is power there?"
            raise DriverError(why, "no-power")

    def power_off(self) -> None:
        """Wait a little for it."""
        self.aim(DriveState.OFF)
        self._bus.wait(lambda: not any(axis.drive.enabled for axis in self.answered()), 0.3)

    def clear(self) -> None:
        """Reset faults, configure anew what was away. Raises DriverError; no drive has power afterwards."""
        for axis in self.axes:
            if axis.drive.rebooted or axis.drive.missing:
                self._connect(axis)
                axis.drive.operational()
            axis.drive.forget()
            axis.drive.clear()
        if not self._bus.wait(lambda: not any(a.drive.state in _FAULTS for a in self.answered()), _POWER):
            names = [axis.config.name for axis in self.axes if axis.drive.state in _FAULTS]
            why = f"{', '.join(names)}: the drive keeps its fault; look at its display"
            raise DriverError(why, "drive-keeps-fault")

    def lose_home(self) -> None:
        """Behind an E-stop only encoders that are absolute are believed."""
        for axis in self.axes:
            axis.homed = axis.config.absolute

    def look(self) -> str:
        """Supervise; the first thing that is wrong, or nothing."""
        trouble: str = ""
        for axis in self.axes:
            axis.drive.look(3.0 * self._bus.config.heartbeat)
            trouble = trouble or axis.drive.trouble
            if axis.drive.rebooted:
                axis.homed = axis.config.absolute
        return trouble

    def note_motion(self, now: float) -> None:
        """Whether they move, by two answers; without drives there is nothing to wait for.

        One that no longer answers keeps nobody waiting once its own reaction must be over.
        """
        speaking = [axis for axis in self.axes if axis.drive.missing <= SYNCS]
        for axis in self.axes:
            if axis not in speaking and now - axis.drive.answered > _REACTION:
                axis.moving = False
        seen = min((axis.drive.answered for axis in speaking), default=now)
        if seen <= self.seen:
            return
        for axis in speaking:
            axis.moving = abs(axis.drive.position - axis.last) > _REST
            axis.last = axis.drive.position
        self.seen = seen

    def _connect(self, axis: DrivenAxis) -> None:
        config = axis.config
        needed = MODE_BITS[self._mode] | (0 if config.absolute else MODE_BITS[HM])
        queued = self._mode == IP
        cubic: Objects = ((od.IP_SUBMODE, 0, _CUBIC),) if queued else ()
        own = config.node.sdo if config.node is not None else ()
        values = (*axis_objects(config, self._bus.config), *cubic, *own)
        axis.drive.connect((od.PVT_RECORD,) if queued else (), needed, values)
        axis.homed, axis.last = config.absolute, axis.drive.position
        axis.drive.mode = self._mode
