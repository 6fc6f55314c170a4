"""Axes on a CANopen bus, with one setpoint queue and one drive per axis."""

from __future__ import annotations

from collections.abc import Callable

from core.ports import AxisSample, DriverError, Segments, Stop, at_rest
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_homing import Homing
from drivers.canopen.canopen_objects import DriveState
from drivers.canopen.canopen_setup import limits
from drivers.canopen.driven_axes import MOTIONS, DriveSet
from drivers.canopen.position_modes import CyclicFollower, Follower, ProfiledFollower, SyncSchedule
from drivers.canopen.pvt_mode import PvtFollower
from drivers.port_parts import demand_axis, demand_no_fault, demand_no_homing, demand_power, demand_standstill
from drivers.setpoint_queue import SetpointQueue, Tolerance, check_limits


def follower_of(
    config: CanopenConfig, drives: DriveSet, queue: SetpointQueue, schedule: SyncSchedule
) -> Follower:
    """Create the follower for ``config.bus.mode``."""
    if config.bus.mode == "pp":
        return ProfiledFollower(drives.axes, drives.indices, queue)
    if MOTIONS[config.bus.mode].cyclic:
        return CyclicFollower(drives.axes, drives.indices, queue, MOTIONS[config.bus.mode].mode, schedule)
    return PvtFollower(drives.axes, drives.indices, queue, config.commit, config.bus.record)


_PAST = 0.5  # Age in s of setpoints that are still available.
_BRAKES = (
    0.15  # Seconds in addition to the ramp from full speed until a quick stop must have ended without power.
)


class CanopenAxes:
    """``core.ports.AxisSink`` of the CANopen drives, used only by the thread that owns the bus."""

    def __init__(self, config: CanopenConfig, bus: Bus) -> None:
        self._bus = bus
        self.config = config
        self.axes = tuple(axis.name for axis in config.axes)
        self.commit = config.commit
        self.drives = DriveSet(config.axes, bus, MOTIONS[config.bus.mode])
        tolerance = Tolerance.of(config.axes)
        self.queue = SetpointQueue(self.axes, (0.0,) * len(self.axes), config.commit, tolerance)
        self.schedule = SyncSchedule(config.bus.sync, bus.clock.now())
        self.follower = follower_of(config, self.drives, self.queue, self.schedule)
        self.cyclic = MOTIONS[config.bus.mode].cyclic
        self.homing: Homing | None = None
        self.fault = ""
        self.beside = ""  # Fault of another device on the bus.
        self.reconnect: Callable[[], None] = lambda: None  # Opens the bus and configures all nodes.
        self.clearing: list[Callable[[], None]] = []  # Functions that clear the faults of other devices.
        self._on = False
        self._braking = False  # Braking by quick stop, after which a drive switches itself off.
        self._powerless_at = 0.0  # Time when the power is switched off at the latest.
        self._given_up: Homing | None = None  # A canceled homing that still brakes.

    def connect(self) -> None:
        """Configure every drive. Raises DriverError."""
        self.drives.connect()
        self.queue.rest_at(self._actual())

    def tick(self, now: float) -> None:
        """Supervise the drives, home and feed setpoints, without raising errors.

        A fault stops all axes. In cyclic modes, ``go_on`` feeds the setpoints at each SYNC instead.
        """
        self._supervise()
        if not self.cyclic:
            self.go_on(now)
        self._end_braking(now)
        self.drives.note_motion(now)
        self.queue.trim(now - _PAST)

    def go_on(self, now: float) -> None:
        """Execute the next step of a homing, or feed the next setpoints."""
        try:
            if self._on and not self.fault:
                self._go_on(now)
        except DriverError as error:
            self._trip(error.fault)

    # --- the port -----------------------------------------------------------------------------------------

    def now(self) -> float:
        """Return the time of the machine's clock in seconds."""
        return self._bus.clock.now()

    def horizon(self) -> float:
        """Return the end time of the setpoint queue, or the present time if it is empty."""
        return self.queue.horizon(self.now())

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at time ``t``."""
        return self.queue.demand_at(t)

    def splice(self, segments: Segments) -> None:
        """Splice setpoints into the queue.

        Raises DriverError if they are invalid or the drives cannot follow.
        """
        self._need_power()
        homing = self.homing or self._given_up
        demand_no_homing(homing.config.name if homing is not None else "")
        check_limits(segments, self.config.axes, self._homed())
        self.follower.check(segments)
        self.queue.splice(segments, self.now())

    def sample(self) -> AxisSample:
        """Return the state of the axes from the last replies, at the time of their SYNC."""
        actual, powered, seen = self._actual(), self._powered(), self.drives.seen
        demand, velocity = self.queue.demand_at(self.follower.path_time(seen))
        busy = self.homing is not None or self._given_up is not None
        if not powered or busy:
            demand = actual
        return AxisSample(
            t=seen,
            demand=demand,
            actual=actual,
            following_error=tuple([d - a for d, a in zip(demand, actual, strict=True)]),
            enabled=powered,
            homed=self._homed(),
            moving=not self._bus.trouble and (busy or any(velocity) or self._plays),
            fault=self.fault,
        )

    @property
    def _plays(self) -> bool:
        return self.drives.moving or (self.cyclic and self.follower.playing)

    def enable(self, on: bool) -> None:
        """Switch the power on or off and wait for it. Raises DriverError that names the drives that fail."""
        if not on:
            self._off(DriveState.OFF)
            self.drives.power_off()
            return
        demand_no_fault(self.fault)
        if self._powered():
            return
        self.follower.prepare()
        self.drives.power_on()
        self.queue.rest_at(self._actual())
        self._on = True

    def stop(self, how: Stop) -> None:
        """Stop all axes by the drives at one SYNC, or on the path with RAMP_HOLD."""
        if how is Stop.RAMP_HOLD and self._powered():
            self._hold()
            return
        self._off(DriveState.OFF if how is Stop.OFF else DriveState.QUICK_STOP)
        if not self._bus.trouble and not self.cyclic:  # Otherwise with the next SYNC at its regular time.
            self.drives.exchange()

    def home(self, axis: str) -> None:
        """Start the homing of the drive. Raises DriverError without power or while the axis moves."""
        demand_axis(axis, self.axes)
        driven = next((a for a in self.drives.axes if a.config.name == axis), None)
        if driven is None or driven.config.absolute:
            return
        self._need_power()
        demand_standstill(axis, self.sample().moving)
        self.follower.abort()
        self.homing = Homing(driven, self.follower.mode, self.now())

    def clear_fault(self) -> None:
        """Clear the fault and reset the drives, which remain without power.

        After a bus failure, the bus is opened again and every node is configured. Raises DriverError.
        """
        if self._bus.trouble:
            self.reconnect()
        self._off(DriveState.OFF)
        for clear in self.clearing:
            clear()
        self.beside = self.fault = ""
        self.drives.clear()

    def follower_rests(self, now: float) -> bool:
        """Return whether no setpoints are left in the queue or in the drives."""
        return at_rest(self.queue.horizon(now), now) and not self.follower.playing

    def rest_here(self) -> None:
        """Restart the setpoint queue at the measured positions."""
        self.queue.rest_at(self._actual())

    # --- inside -------------------------------------------------------------------------------------------

    def _supervise(self) -> None:
        trouble = self._bus.trouble or self.beside or self.follower.trouble or self.drives.look()
        trouble = trouble or (self.homing.trouble if self.homing is not None else "")
        if trouble and not self.fault:
            self._trip(trouble)
        elif self._on and not self._powered() and not trouble:
            self._off(DriveState.OFF)  # The power was removed by E-stop or STO.
            self.drives.lose_home()

    def _trip(self, fault: str) -> None:
        """Set the fault and stop all axes."""
        self.fault = self.fault or fault
        self._off(DriveState.QUICK_STOP)

    def _off(self, goal: DriveState) -> None:
        if goal is DriveState.QUICK_STOP and not self._braking:
            driven = [axis.config for axis in self.drives.axes]
            ramp = max((axis.vmax / axis.amax for axis in driven), default=0.0)
            self._powerless_at = self.now() + ramp + _BRAKES
        self._braking = goal is DriveState.QUICK_STOP
        self._on, self.homing, self._given_up = False, None, None
        self.drives.aim(goal)
        self.follower.abort()
        self.follower.urgent = True
        self.queue.rest_at(self._actual())

    def _end_braking(self, now: float) -> None:
        """Switch the drives off when a quick stop takes too long.

        A drive with a failed encoder or a runaway would otherwise push without end.
        """
        if self._braking and now > self._powerless_at:
            self._braking = False
            self.drives.aim(DriveState.OFF)

    def _hold(self) -> None:
        """Brake on the path; during homing, the drive brakes on its own ramp."""
        if self.homing is not None:
            self.homing.give_up()
            self.homing, self._given_up = None, self.homing
        elif self._given_up is None:
            at = self.now() + self.commit
            if any(self.queue.demand_at(at)[1]):
                self.queue.brake(at, [axis.amax for axis in self.config.axes])
            else:
                place, _ = self.queue.demand_at(at)  # Setpoints until then remain.
                self.queue.splice(Segments.resting(at, place), at - self.commit)
            self.follower.braked(at)

    def _go_on(self, now: float) -> None:
        homing = self.homing or self._given_up
        if homing is None:
            self.follower.feed(now)
            return
        homing.step(now)
        if homing.done:
            if self.homing is not None:
                homing.axis.homed = True
                for index, sub, value in limits(homing.config):
                    homing.axis.drive.setup.try_write(index, sub, value)
            self.homing = self._given_up = None
            self.queue.rest_at(self._actual())  # The path continues from the stop position of the drive.

    def _need_power(self) -> None:
        demand_power(self.fault, self._powered())

    def _powered(self) -> bool:
        return self._on and self.drives.powered

    def _actual(self) -> tuple[float, ...]:
        """Return the positions measured by the drives, or the queued position of an axis without a drive."""
        p = list(self.queue.demand_at(self.now())[0])
        for index, axis in zip(self.drives.indices, self.drives.axes, strict=True):
            p[index] = axis.drive.position * axis.config.count
        return tuple(p)

    def _homed(self) -> tuple[bool, ...]:
        homed = [True] * len(self.axes)
        for index, axis in zip(self.drives.indices, self.drives.axes, strict=True):
            homed[index] = axis.homed
        return tuple(homed)
