"""The axis drives together: configured, powered and stopped as one, at one SYNC."""

from __future__ import annotations

from dataclasses import dataclass

from core.ports import DriverError
from drivers.canopen import objects as od
from drivers.canopen.bus import Bus
from drivers.canopen.config import AxisConfig, Objects
from drivers.canopen.drive import SYNCS, Drive402
from drivers.canopen.standing import standing
from drivers.canopen.states import HM, IP, MODE_BITS, DriveState

_POWER = 1.5  # s in which the drives must come on, or leave their faults
_CUBIC = -1  # 0x60C0: position, velocity and time
_REST = 2  # counts from one answer to the next; less is standing
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
        self.indices = [i for i, axis in enumerate(axes) if axis.node]
        self.axes = [
            DrivenAxis(axis, Drive402(bus, axis.name, axis.node, axis.eds, od.TARGET, od.FOLLOWING))
            for axis in axes
            if axis.node
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
        values = (*standing(config, self._bus.config), *cubic, *config.objects)
        axis.drive.connect((od.PVT_RECORD,) if queued else (), needed, values)
        axis.homed, axis.last = config.absolute, axis.drive.position
        axis.drive.mode = self._mode
