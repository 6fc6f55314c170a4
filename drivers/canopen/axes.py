"""The slides on the bus behind ``core.ports.AxisSink``: one queue of setpoints, one drive an axis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from core.ports import AxisSample, DriverError, Segments, Stop
from drivers.canopen import objects as od
from drivers.canopen.bus import Bus
from drivers.canopen.config import AxisConfig, CanopenConfig
from drivers.canopen.drive import Drive402
from drivers.canopen.follow import CspFollower, Follower, PvtFollower
from drivers.canopen.homing import Homing
from drivers.canopen.profiled import ProfiledFollower
from drivers.canopen.states import HM, MODE_BITS, DriveState
from drivers.setpoint_queue import SetpointQueue, Tolerance

_POWER = 1.5  # s in which the drives must come on
_CUBIC = -1  # 0x60C0: position, velocity and time
_REST = 2  # counts from one answer to the next; less is standing


@dataclass(slots=True)
class DrivenAxis:
    """One axis and its drive; homed: its counts mean machine positions."""

    config: AxisConfig
    drive: Drive402
    homed: bool = False
    last: int = 0  # counts at the look before
    moving: bool = False


class CanopenAxes:
    """Used by the one thread that owns the bus. ``exchange`` sends commands and one SYNC."""

    def __init__(self, config: CanopenConfig, bus: Bus) -> None:
        self._bus = bus
        self._config = config
        self.axes = tuple(axis.name for axis in config.axes)
        self.commit = config.commit
        self.driven = [_axis(axis, bus) for axis in config.axes if axis.node]
        self._indices = [i for i, axis in enumerate(config.axes) if axis.node]
        tolerance = Tolerance(
            position=(0.001,) * len(self.axes),
            velocity=tuple(1.01 * axis.corner + 1e-3 for axis in config.axes),
        )
        self.queue = SetpointQueue(self.axes, (0.0,) * len(self.axes), config.commit, tolerance)
        self.follower = self._follower()
        self.homing: Homing | None = None
        self.fault = ""
        self.beside = ""  # what is wrong elsewhere on the bus
        self.clearing: list[Callable[[], None]] = []  # who else has faults to clear
        self._on = False
        self._seen = self._exchange = bus.clock.now()

    # --- start and every tick -----------------------------------------------------------------------------

    def connect(self) -> None:
        """Configure every drive; NMT start comes later. Raises DriverError."""
        for axis in self.driven:
            self._connect(axis)
        self.queue.rest_at(self._actual())

    def operational(self) -> None:
        """NMT start of the drives."""
        for axis in self.driven:
            axis.drive.operational()

    def tick(self, now: float) -> None:
        """Supervise, home, feed. Raises nothing: what is wrong becomes the fault, and all axes stop."""
        try:
            self._supervise()
            if self._on and not self.fault:
                self._go_on(now)
        except DriverError as error:
            self._trip(str(error))
        self._motion(now)
        self.queue.trim(now - 0.5)

    def command(self) -> None:
        """Send every drive its command; the bus's SYNC makes them act together."""
        for axis in self.driven:
            axis.drive.command()

    # --- the port -----------------------------------------------------------------------------------------

    def now(self) -> float:
        """The machine's clock."""
        return self._bus.clock.now()

    def horizon(self) -> float:
        """End of what is queued; now when nothing is."""
        return self.queue.horizon(self.now())

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Queued position and velocity at ``t``."""
        return self.queue.demand_at(t)

    def splice(self, segments: Segments) -> None:
        """Queue setpoints. Raises DriverError as the port says, and for what the drives cannot follow."""
        if self.fault:
            raise DriverError(f"{self.fault}; clear the fault first")
        if not self._powered():
            raise DriverError("the drives are off; switch them on first")
        if self.homing is not None:
            raise DriverError(f"{self.homing.config.name} is homing; wait until it is done")
        self._check_limits(segments)
        self.follower.check(segments)
        self.queue.splice(segments, self.now())
        self.follower.spliced()

    def sample(self) -> AxisSample:
        """The axes as the last answers have it."""
        actual, powered = self._actual(), self._powered()
        demand, velocity = self.queue.demand_at(self._seen)
        if not powered or self.homing is not None:
            demand = actual
        return AxisSample(
            t=self._seen,
            demand=demand,
            actual=actual,
            following_error=tuple([d - a for d, a in zip(demand, actual, strict=True)]),
            enabled=powered,
            homed=self._homed(),
            moving=self.homing is not None or any(velocity) or any(axis.moving for axis in self.driven),
            fault=self.fault,
        )

    def enable(self, on: bool) -> None:
        """Power on or off, and wait for it. Raises DriverError naming the drive that does not come."""
        if not on:
            self._off(DriveState.OFF)
            self._bus.wait(lambda: not any(axis.drive.enabled for axis in self._exchanged()), 0.3)
            return
        if self.fault:
            raise DriverError(f"drives stay off: {self.fault}; clear the fault first")
        self._power_on()

    def stop(self, how: Stop) -> None:
        """The drives' own stop at once, all of them at one SYNC; RAMP_HOLD brakes on the path."""
        if self.homing is not None:
            self.homing.give_up()
            self.homing = None
        if how is Stop.RAMP_HOLD and self._powered():
            self.queue.brake(self.now() + self.commit, [axis.amax for axis in self._config.axes])
            self.follower.spliced()
            return
        self._off(DriveState.OFF if how is Stop.OFF else DriveState.QUICK_STOP)
        if not self._bus.trouble:  # now, whatever was answered
            self.command()
            self._bus.synchronise()

    def home(self, axis: str) -> None:
        """Start the drive's homing. Raises DriverError."""
        if axis not in self.axes:
            raise DriverError(f"there is no axis {axis!r}")
        driven = next((a for a in self.driven if a.config.name == axis), None)
        if driven is None or driven.config.absolute:
            return
        if not self._powered() or self.fault:
            raise DriverError("the drives are off; switch them on first")
        if self.homing is not None or self.sample().moving:
            raise DriverError(f"{axis} cannot home while an axis moves; wait for standstill")
        self.follower.abort()
        self.homing = Homing(driven.config, driven.drive, self.follower.mode, self.now())

    def clear_fault(self) -> None:
        """Forget the fault, reset the drives that have one; they stay without power. Raises DriverError."""
        if self._bus.trouble:
            raise DriverError(f"{self._bus.trouble}; mend it and start the control again")
        self._off(DriveState.OFF)
        for axis in self.driven:
            if axis.drive.rebooted or axis.drive.missing:
                self._connect(axis)
                axis.drive.operational()
            axis.drive.forget()
            axis.drive.clear()
        for clear in self.clearing:
            clear()
        self.beside = ""
        faults = {DriveState.FAULT, DriveState.REACTING}
        done = self._bus.wait(lambda: not any(a.drive.state in faults for a in self._exchanged()), _POWER)
        self.fault = ""
        if not done:
            names = [axis.config.name for axis in self.driven if axis.drive.state in faults]
            raise DriverError(f"{', '.join(names)}: the drive keeps its fault; look at its display")

    # --- inside -------------------------------------------------------------------------------------------

    def _connect(self, axis: DrivenAxis) -> None:
        config = axis.config
        mode = MODE_BITS[self.follower.mode] | (0 if config.absolute else MODE_BITS[HM])
        records = (od.PVT_RECORD,) if isinstance(self.follower, PvtFollower) else ()
        cubic = ((od.IP_SUBMODE, 0, _CUBIC),) if records else ()
        axis.drive.connect(records, mode, (*_standing(config, self._bus), *cubic, *config.objects))
        axis.homed, axis.last = config.absolute, axis.drive.position
        axis.drive.mode = self.follower.mode

    def _follower(self) -> Follower:
        config, queue = self._config, self.queue
        if config.mode == "pp":
            return ProfiledFollower(self.driven, self._indices, queue)
        if config.mode == "csp":
            return CspFollower(self.driven, self._indices, queue, config.bus.sync)
        return PvtFollower(self.driven, self._indices, queue, config.commit, config.record)

    def _supervise(self) -> None:
        patience = 3.0 * self._config.bus.heartbeat
        trouble = self._bus.trouble or self.beside or self.follower.trouble
        for axis in self.driven:
            axis.drive.look(patience)
            trouble = trouble or axis.drive.trouble
            if axis.drive.rebooted:
                axis.homed = axis.config.absolute
        if self.homing is not None:
            trouble = trouble or self.homing.trouble
        if trouble and not self.fault:
            self._trip(trouble)
        elif self._on and not self._powered() and not trouble:
            self._off(DriveState.OFF)  # power was taken away: E-stop, safe torque off

    def _trip(self, fault: str) -> None:
        """No axis is kept alive without the others."""
        self.fault = self.fault or fault
        self.homing = None
        self._off(DriveState.QUICK_STOP)

    def _off(self, goal: DriveState) -> None:
        self._on = False
        for axis in self.driven:
            axis.drive.goal, axis.drive.extra = goal, 0
        self.follower.abort()
        self.follower.urgent = True
        self.queue.rest_at(self._actual())

    def _go_on(self, now: float) -> None:
        if self.homing is None:
            self.follower.feed(now)
            return
        self.homing.step(now)
        if self.homing.done:
            homed = next(a for a in self.driven if self.homing and a.config is self.homing.config)
            homed.homed, self.homing = True, None
            homed.drive.setup.write_all(_limits(homed.config))
            self.queue.rest_at(self._actual())

    def _power_on(self) -> None:
        self.follower.prepare()
        for axis in self.driven:
            axis.drive.mode, axis.drive.goal = self.follower.mode, DriveState.ENABLED
        if not self._bus.wait(lambda: all(_ready(axis) for axis in self._exchanged()), _POWER):
            slow = [f"{a.config.name} is {a.drive.state}" for a in self.driven if not _ready(a)]
            self._off(DriveState.OFF)
            raise DriverError(f"drives do not come on: {', '.join(slow)}; is E-stop pressed, is power there?")
        self.queue.rest_at(self._actual())
        self._on = True

    def _exchanged(self) -> list[DrivenAxis]:
        """One exchange outside the tick, not before the last was answered or its time is over."""
        now, waiting = self.now(), any(axis.drive.missing for axis in self.driven)
        if not waiting or now - self._exchange >= 2 * self._config.bus.sync:
            self._exchange = now
            self.command()
            self._bus.synchronise()
        self._bus.pump()
        return self.driven

    def _powered(self) -> bool:
        return self._on and all(axis.drive.enabled for axis in self.driven)

    def _motion(self, now: float) -> None:
        """Whether the slides move, by two answers; without drives by the queue alone."""
        seen = min((axis.drive.answered for axis in self.driven), default=now)
        if seen <= self._seen:
            return
        for axis in self.driven:
            axis.moving = abs(axis.drive.position - axis.last) > _REST
            axis.last = axis.drive.position
        self._seen = seen

    def _actual(self) -> tuple[float, ...]:
        """Positions by the drives' counts; an axis without a drive is where the queue has it."""
        p = list(self.queue.demand_at(self.now())[0])
        for index, axis in zip(self._indices, self.driven, strict=True):
            p[index] = axis.drive.position * axis.config.count
        return tuple(p)

    def _homed(self) -> tuple[bool, ...]:
        homed = [True] * len(self.axes)
        for index, axis in zip(self._indices, self.driven, strict=True):
            homed[index] = axis.homed
        return tuple(homed)

    def _check_limits(self, segments: Segments) -> None:
        """The last line before the wire, behind the control's own."""
        homed = self._homed()
        for i, axis in enumerate(self._config.axes):
            if abs(segments.v[:, i]).max() > axis.vmax * 1.001 + 0.01:
                raise DriverError(f"{axis.name}: setpoints faster than {axis.vmax:.1f}/s; nothing was queued")
            if axis.travel is None or not homed[i]:
                continue
            low, high = axis.travel
            if segments.p[:, i].min() < low - 0.01 or segments.p[:, i].max() > high + 0.01:
                raise DriverError(f"{axis.name}: setpoints leave {low:.2f}…{high:.2f}; nothing was queued")


def _axis(config: AxisConfig, bus: Bus) -> DrivenAxis:
    drive = Drive402(bus, config.name, config.node, config.eds, od.TARGET, od.FOLLOWING)
    return DrivenAxis(config, drive)


def _ready(axis: DrivenAxis) -> bool:
    """Powered, and the mode read back."""
    return axis.drive.enabled and axis.drive.shown_mode == axis.drive.mode


def _limits(config: AxisConfig) -> tuple[tuple[int, int, int], ...]:
    """The drive's own software limits; they mean something once it knows where home is."""
    if config.travel is None:
        return ()
    low, high = config.travel
    return ((od.LIMITS, 1, round(low / config.count)), (od.LIMITS, 2, round(high / config.count)))


def _standing(config: AxisConfig, bus: Bus) -> tuple[tuple[int, int, int], ...]:
    """What every drive is told unless the machine file says otherwise: how to stop, and what to watch."""
    beat = bus.config.heartbeat
    return (
        (od.ABORT_OPTION, 0, 3),
        (od.QUICK_OPTION, 0, 2),
        (od.FAULT_OPTION, 0, 2),
        (od.WINDOW, 0, round(config.following_window / config.count)),
        (od.WINDOW_TIME, 0, round(1000 * config.following_time)),
        (od.QUICK_DECEL, 0, round(config.amax / config.count)),
        *(_limits(config) if config.absolute else ()),
        (od.HEARTBEAT, 0, round(1000 * beat)),
        (od.WATCHED, 1, bus.config.host_id << 16 | round(3000 * beat)),
    )
