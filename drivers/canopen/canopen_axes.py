"""The slides on the bus behind ``core.ports.AxisSink``: one queue of setpoints, one drive an axis."""

from __future__ import annotations

from collections.abc import Callable

from core.faults import code_of
from core.message import Message
from core.ports import AxisSample, DriverError, Segments, Stop, at_rest
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_homing import Homing
from drivers.canopen.canopen_objects import DriveState
from drivers.canopen.canopen_setup import limits
from drivers.canopen.cia402_drives import MOTIONS, DriveSet
from drivers.canopen.cyclic_mode import CyclicFollower, SyncSchedule
from drivers.canopen.position_modes import Follower, ProfiledFollower
from drivers.canopen.pvt_mode import PvtFollower
from drivers.setpoint_queue import SetpointQueue, Tolerance, check_limits


def follower_of(
    config: CanopenConfig, drives: DriveSet, queue: SetpointQueue, schedule: SyncSchedule
) -> Follower:
    """The one of ``config.bus.mode``."""
    if config.bus.mode == "pp":
        return ProfiledFollower(drives.axes, drives.indices, queue)
    if MOTIONS[config.bus.mode].cyclic:
        return CyclicFollower(drives.axes, drives.indices, queue, MOTIONS[config.bus.mode].mode, schedule)
    return PvtFollower(drives.axes, drives.indices, queue, config.commit, config.bus.record)


_PAST = 0.5  # s of setpoints that may still be asked for
_BRAKES = (
    0.15  # s beyond the ramp from full speed in which a quick stop must have ended in a drive without power
)


class CanopenAxes:
    """Used by the one thread that owns the bus, which sends the commands and the SYNC."""

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
        self.beside = ""  # what is wrong elsewhere on the bus
        self.reconnect: Callable[[], None] = lambda: None  # opens the bus and configures all that is on it
        self.clearing: list[Callable[[], None]] = []  # who else has faults to clear
        self._on = False
        self._braking = False  # by quick stop, after which a drive takes its power itself
        self._powerless_at = 0.0  # when it is taken in any case
        self._given_up: Homing | None = None  # a homing that was stopped and still brakes

    def connect(self) -> None:
        """Configure every drive. Raises DriverError."""
        self.drives.connect()
        self.queue.rest_at(self._actual())

    def tick(self, now: float) -> None:
        """Supervise, home, feed; what is fed at each SYNC is fed by ``go_on``. Raises nothing.

        What is wrong becomes the fault, and all axes stop.
        """
        self._supervise()
        if not self.cyclic:
            self.go_on(now)
        self._end_braking(now)
        self.drives.note_motion(now)
        self.queue.trim(now - _PAST)

    def go_on(self, now: float) -> None:
        """The next step of a homing, or the next setpoints."""
        try:
            if self._on and not self.fault:
                self._go_on(now)
        except DriverError as error:
            self._trip(error.fault)

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
        self._need_power()
        homing = self.homing or self._given_up
        if homing is not None:
            raise DriverError(
                Message("{name} is homing; wait until homing is complete", name=homing.config.name),
                reason="homing",
            )
        check_limits(segments, self.config.axes, self._homed())
        self.follower.check(segments)
        self.queue.splice(segments, self.now())

    def sample(self) -> AxisSample:
        """The axes as the last answers have it, at the time of their SYNC."""
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
        """Power on or off, and wait for it. Raises DriverError naming the drive that does not come."""
        if not on:
            self._off(DriveState.OFF)
            self.drives.power_off()
            return
        if self.fault:
            raise DriverError(
                Message(
                    "the drives stay off because of a fault ({fault}); clear the fault first",
                    fault=self.fault,
                ),
                "no-power",
            )
        if self._powered():
            return
        self.follower.prepare()
        self.drives.power_on()
        self.queue.rest_at(self._actual())
        self._on = True

    def stop(self, how: Stop) -> None:
        """The drives' own stop at once, all of them at one SYNC; RAMP_HOLD brakes on the path."""
        if how is Stop.RAMP_HOLD and self._powered():
            self._hold()
            return
        self._off(DriveState.OFF if how is Stop.OFF else DriveState.QUICK_STOP)
        if not self._bus.trouble and not self.cyclic:  # else with the next SYNC, which keeps its time
            self.drives.exchange()

    def home(self, axis: str) -> None:
        """Start the drive's homing. Raises DriverError."""
        if axis not in self.axes:
            raise DriverError(Message("axis {axis} does not exist", axis=f"{axis!r}"), reason="no-axis")
        driven = next((a for a in self.drives.axes if a.config.name == axis), None)
        if driven is None or driven.config.absolute:
            return
        self._need_power()
        if self.sample().moving:
            raise DriverError(
                Message(
                    "{axis} cannot home while an axis is moving; wait until all axes are at rest", axis=axis
                ),
                "homing",
                reason="axis-moves",
            )
        self.follower.abort()
        self.homing = Homing(driven, self.follower.mode, self.now())

    def clear_fault(self) -> None:
        """Forget the fault, reset the drives that have one; they stay without power. A bus that has failed is
        opened anew, and every node configured. Raises DriverError.
        """
        if self._bus.trouble:
            self.reconnect()
        self._off(DriveState.OFF)
        for clear in self.clearing:
            clear()
        self.beside = self.fault = ""
        self.drives.clear()

    def follower_rests(self, now: float) -> bool:
        """Nothing is queued, and nothing is left in the drives."""
        return at_rest(self.queue.horizon(now), now) and not self.follower.playing

    def rest_here(self) -> None:
        """The path goes on from where the drives stand."""
        self.queue.rest_at(self._actual())

    # --- inside -------------------------------------------------------------------------------------------

    def _supervise(self) -> None:
        trouble = self._bus.trouble or self.beside or self.follower.trouble or self.drives.look()
        trouble = trouble or (self.homing.trouble if self.homing is not None else "")
        if trouble and not self.fault:
            self._trip(trouble)
        elif self._on and not self._powered() and not trouble:
            self._off(DriveState.OFF)  # power was taken away: E-stop, safe torque off
            self.drives.lose_home()

    def _trip(self, fault: str) -> None:
        """No axis is kept alive without the others."""
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
        """A drive whose encoder no longer counts, or that runs away, brakes for ever and pushes meanwhile."""
        if self._braking and now > self._powerless_at:
            self._braking = False
            self.drives.aim(DriveState.OFF)

    def _hold(self) -> None:
        """Brake on the path; a homing has none, there the drive brakes by itself."""
        if self.homing is not None:
            self.homing.give_up()
            self.homing, self._given_up = None, self.homing
        elif self._given_up is None:
            at = self.now() + self.commit
            if any(self.queue.demand_at(at)[1]):
                self.queue.brake(at, [axis.amax for axis in self.config.axes])
            else:
                place, _ = self.queue.demand_at(at)  # what is played until then stays
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
            self.queue.rest_at(self._actual())  # the path goes on from where the drive has stopped

    def _need_power(self) -> None:
        if self.fault:
            raise DriverError(
                Message("{fault}; clear the fault first", fault=self.fault), code_of(self.fault, "axis")
            )
        if not self._powered():
            raise DriverError("the drives are off; switch them on first", "power-lost")

    def _powered(self) -> bool:
        return self._on and self.drives.powered

    def _actual(self) -> tuple[float, ...]:
        """Positions by the drives' counts; an axis without a drive is where the queue has it."""
        p = list(self.queue.demand_at(self.now())[0])
        for index, axis in zip(self.drives.indices, self.drives.axes, strict=True):
            p[index] = axis.drive.position * axis.config.count
        return tuple(p)

    def _homed(self) -> tuple[bool, ...]:
        homed = [True] * len(self.axes)
        for index, axis in zip(self.drives.indices, self.drives.axes, strict=True):
            homed[index] = axis.homed
        return tuple(homed)
