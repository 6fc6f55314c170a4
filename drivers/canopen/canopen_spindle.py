"""Spindle drive on the bus in profile velocity mode, which may also be the C axis.

The drive changes between both modes at standstill. As the spindle, it makes its own ramps. As C, it is one
more axis that is powered, fed and stopped with the others. C then starts at the position that the control
last counted. With orientation, the spindle first turns until this position is also correct from the index.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from enum import Enum

from core.ports import DriverError, Fault, Stop, at_rest
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_axes import CanopenAxes
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import SpindleConfig
from drivers.canopen.canopen_homing import SEARCH_RPM, Phase, Referencing
from drivers.canopen.canopen_objects import HM, IP, MODE_BITS, PV, DriveState
from drivers.canopen.canopen_setup import stopping
from drivers.canopen.cia402_drives import SPEED, SPEED_TARGET, Drive402, DriveWork
from drivers.canopen.driven_axes import DrivenAxis
from drivers.port_parts import demand_free_drive, demand_spindle
from drivers.setpoint_queue import straight

_STANDS = 2.0  # rpm
# Without these objects, the spindle would continue to turn if this computer stops responding.
_KEPT_TURNING = (od.ABORT_OPTION, od.WATCHED)
_POWER = 1.0  # Seconds in which the drive must switch on.


class CanopenSpindle:
    """``core.ports.Spindle`` of a CiA 402 drive, which has power only while it turns or must turn."""

    def __init__(self, config: SpindleConfig, bus: Bus) -> None:
        self._config = config
        self._bus = bus
        self._came_on = False
        self._last = self._counts = 0
        self._ordered = 0.0  # Time of the last power request in s.
        self.lent = False  # Used as C, so the drive does not turn as the spindle.
        self.kept = False  # Must remain C.
        self.blind = False  # Ignore changes of the counter during homing.
        self.drive = Drive402(bus, config.node, SPEED_TARGET, (SPEED,))

    def connect(self) -> None:
        """Configure the drive. Raises DriverError."""
        config = self._config
        queue = self.drive.profile.queue if config.is_c else None
        standing = (
            *self.drive.profile.units,
            *stopping(self._bus.config),
            (od.PROFILE_ACCEL, 0, round(config.accel)),
            (od.PROFILE_DECEL, 0, round(config.decel)),
            (od.QUICK_DECEL, 0, round(config.decel)),
        )
        if queue is not None:
            standing = (*standing, (od.IP_SUBMODE, 0, queue.submode))
        self.drive.connect(
            DriveWork(
                modes=MODE_BITS[PV] | (MODE_BITS[HM] | MODE_BITS[IP] if config.is_c else 0),
                standing=standing,
                own=config.node.sdo,
                needed=_KEPT_TURNING,
                records=queue.object if queue is not None else 0,
                axis=False,
            )
        )
        self.drive.mode, self.drive.target = PV, 0

    def tick(self) -> None:
        """Supervise the drive; switch it off at standstill, and never switch it on automatically."""
        drive = self.drive
        drive.look(3.0 * self._bus.config.heartbeat)
        lost = self._came_on and not drive.enabled
        self._came_on = drive.enabled and drive.goal is DriveState.ENABLED
        if drive.trouble:
            drive.goal, drive.target = DriveState.QUICK_STOP, 0
        elif self.lent:
            self._came_on = False
        elif drive.goal is DriveState.ENABLED:
            self._watch(lost)

    def _watch(self, lost: bool) -> None:
        """Switch off after a loss of power, or set a fault if the drive does not switch on.

        Waiting is not permitted, because a return of the power would start the spindle.
        """
        drive, now = self.drive, self._bus.clock.now()
        if lost:
            drive.goal, drive.target = DriveState.OFF, 0
        elif not drive.enabled and now - self._ordered > _POWER:
            drive.trouble = Fault(
                "spindle: the drive does not switch on; check that the E-stop is released and the "
                "drive has power",
                "spindle",
            )
        elif drive.target == 0 and abs(drive.speed) < _STANDS:
            drive.goal = DriveState.OFF

    def run(self, rpm: float) -> None:
        """Turn the spindle at ``rpm``, signed; 0 stops it.

        Raises DriverError with a fault, or while the drive is engaged as C, if the speed is not 0.
        """
        if rpm:
            demand_spindle(self._bus.trouble or self.drive.trouble)
        if rpm and self.kept:
            raise DriverError(
                "the spindle stays off because its drive is engaged as the C axis; release the "
                "drive with M05 first",
                "spindle-off",
                reason="held-as-c",
            )
        limit = self._config.rpm_max
        self.drive.target = round(min(max(rpm, -limit), limit))
        if rpm and self.lent:
            return  # The spindle turns after C is released.
        if rpm and self.drive.goal is not DriveState.ENABLED:
            self.drive.goal, self._ordered = DriveState.ENABLED, self._bus.clock.now()

    def coast(self) -> None:
        """Remove the torque, so that the spindle coasts to a stop."""
        self.drive.target = 0
        if not self.lent:
            self.drive.goal = DriveState.OFF

    @property
    def counts_per_rev(self) -> int:
        """The encoder counts per revolution, or 0 if not specified."""
        return self._config.node.counts_per_rev

    @property
    def commanded(self) -> bool:
        """Whether a speed other than 0 is commanded."""
        return self.drive.target != 0

    def resume(self) -> None:
        """Execute the speed command that was given while the drive was C."""
        if self.drive.target:
            self.drive.goal, self._ordered = DriveState.ENABLED, self._bus.clock.now()

    def clear_fault(self) -> None:
        """Clear the fault without power, and configure a restarted drive again. Raises DriverError."""
        if self.drive.rebooted or self.drive.missing:
            self.connect()
            self.drive.operational()
        self.drive.forget()
        self.drive.clear()

    def speed(self) -> float:
        """Return the measured speed in rpm, signed, or 0 while the drive is C."""
        return 0.0 if self.lent else float(self.drive.speed)

    def angle(self) -> tuple[float, float] | None:
        """Return a (time, revolutions) pair of the last reply, or None without counts per revolution."""
        if not self.counts_per_rev:
            return None
        now = self.drive.position
        if self.blind:
            return self.drive.answered, self._counts / self.counts_per_rev
        # The counter wraps around every few hours.
        self._counts += (now - self._last + 2**31) % 2**32 - 2**31
        self._last = now
        return self.drive.answered, self._counts / self.counts_per_rev

    def leapt(self) -> None:
        """Accept a counter that was set by homing, without counting the jump as rotation."""
        if self.blind:
            self._last, self.blind = self.drive.position, False

    def fault(self) -> str:
        """Return the fault of the drive or bus, or an empty text."""
        return self._bus.trouble or (self.drive.trouble and Fault(self.drive.trouble, "spindle"))


# --- C on the spindle drive.


_CHANGE = 2.0  # Seconds for a change of mode with power.
_TURN = 360.0


class Step(Enum):
    """Steps of the change between spindle and C."""

    FREE = "the drive is running as the spindle drive"
    REST = "waiting until the axis drives have executed their queued motion"
    INDEX = "searching for the encoder index"
    HERE = "setting the current position in the spindle drive"
    POWER = "changing the spindle drive to position mode"
    TURN = "turning the spindle to its C-axis position"
    HELD = "is C"
    LEAVE = "ending C axis mode"
    BACK = "changing the spindle drive to speed mode"


class SpindleC:
    """``core.ports.SpindleHold`` of the spindle drive; a fault stops all axes.

    ``tick`` is called once per cycle of the bus.
    """

    def __init__(self, axes: CanopenAxes, spindle: CanopenSpindle, name: str) -> None:
        self._axes, self._spindle, self._drive = axes, spindle, spindle.drive
        self._number = axes.axes.index(name)
        config = axes.config.axes[self._number]
        per_turn = spindle.counts_per_rev
        config = replace(
            config, count=_TURN / per_turn, counts_per_rev=per_turn, profile=spindle.drive.profile
        )
        self._axis = DrivenAxis(config, spindle.drive, homed=True)
        self.step = Step.FREE
        self.trouble: Fault | str = ""
        self._wanted = self._orient = False
        self._since = 0.0
        self._homing = Referencing(spindle.drive)
        self._phase = Phase(spindle.counts_per_rev)
        self._off = 0.0  # Degrees to turn to the position.
        # Required C position when engaged, preserved across canceled attempts.
        self._goal: float | None = None

    # --- the port ----------------------------------------------------------------------------------------

    def hold(self, on: bool, orient: bool = False) -> None:
        """Engage the drive as C, or release it as the spindle.

        With ``orient``, the spindle first turns to its position from the index. Raises DriverError if the
        drive cannot be engaged now.
        """
        if on and self.trouble:
            raise DriverError(self.trouble)
        if on and not self._wanted:
            turning = self._spindle.commanded or abs(self._drive.speed) >= _STANDS
            demand_free_drive(self._axes.sample().enabled, self.step is Step.FREE and turning)
            self._orient = orient
        self._want(on)

    def held(self) -> bool:
        """Return whether C is engaged and may move."""
        return self.step is Step.HELD and self._wanted

    # --- each cycle --------------------------------------------------------------------------------------

    def tick(self, now: float) -> None:
        """Continue the change that is in progress."""
        self._phase.follow(self._drive.position, leaps=self.step in {Step.INDEX, Step.HERE})
        if self._drive.rebooted:
            self._phase.counts = None
        if self.step is not Step.FREE and (self._drive.trouble or not self._axes.sample().enabled):
            self._want(False)  # Without power, C ends.
        steps: dict[Step, Callable[[float], None]] = {
            Step.FREE: self._free,
            Step.REST: self._rest,
            Step.INDEX: self._search,
            Step.HERE: self._here,
            Step.POWER: self._power,
            Step.TURN: self._turn,
            Step.HELD: self._held,
            Step.LEAVE: self._leave,
            Step.BACK: self._back,
        }
        try:
            steps[self.step](now)
        except DriverError as error:
            self._fail(error.fault)

    def clear_fault(self) -> None:
        """Clear the fault and release the drive."""
        self.trouble = ""
        self._want(False)

    def _free(self, now: float) -> None:
        if self._wanted:
            self._spindle.lent = True
            self._goal = self._demand() if self._goal is None else self._goal
            self._enter(Step.REST, now)

    def _rest(self, now: float) -> None:
        if not self._wanted:
            self._enter(Step.BACK, now)
        elif not self._axes.follower_rests(now):
            self._since = now
        elif self._orient and self._phase.counts is None:
            self._spindle.blind = True
            self._homing.index(now)
            self._enter(Step.INDEX, now)
        else:
            self._tell_place(now)

    def _search(self, now: float) -> None:
        if self._referenced(now):
            self._phase.index_found(self._drive.position)
            self._tell_place(now)

    def _tell_place(self, now: float) -> None:
        """Set the drive's counter to the position of C without motion."""
        self._off = self._beside()
        place = self._place() - self._off
        self._spindle.blind = True
        self._homing.set_position(round(place / self._axis.config.count), now)
        self._enter(Step.HERE, now)

    def _here(self, now: float) -> None:
        if self._referenced(now):
            self._spindle.leapt()
            self._drive.mode = IP
            if self._axis.records is None:
                raise DriverError(
                    "C axis not available: {title} does not have a position queue",
                    "c-coupling",
                    title=self._drive.profile.title,
                )
            self._axis.records.clear()
            self._enter(Step.POWER, now)

    def _referenced(self, now: float) -> bool:
        """Return whether the homing is complete; a canceled request ends it. Raises DriverError."""
        if self._wanted:
            return self._homing.done(now)
        self._drive.extra = 0
        self._enter(Step.BACK, now)
        return False

    def _power(self, now: float) -> None:
        if not self._wanted:
            self._enter(Step.BACK, now)
        elif self._drive.enabled and self._drive.shown_mode == IP:
            self._join()
            self._begin_turn()
            self._enter(Step.TURN, now)
        elif now - self._since > _CHANGE:
            self._fail("the spindle drive remains in mode {shown_mode}", shown_mode=self._drive.shown_mode)

    def _turn(self, now: float) -> None:
        if not self._wanted:
            self._axes.stop(Stop.RAMP_HOLD)
            self._enter(Step.LEAVE, now)
        elif at_rest(self._axes.queue.horizon(now), now) and not self._axes.drives.moving:
            self._goal = None
            self._enter(Step.HELD, now)

    def _held(self, now: float) -> None:
        if not self._wanted:
            self._enter(Step.LEAVE, now)

    def _leave(self, now: float) -> None:
        """Release the drive when the axes are at rest and the queues of the drives have ended."""
        if self._axes.follower_rests(now):
            self._part()
            self._enter(Step.BACK, now)

    def _back(self, now: float) -> None:
        drive = self._drive
        drive.goal, drive.extra, drive.mode = DriveState.OFF, 0, PV
        if drive.shown_mode == PV and not drive.enabled:
            self._spindle.lent = False
            self._spindle.leapt()
            self.step = Step.FREE
            self._spindle.resume()
        elif now - self._since > _CHANGE and not self.trouble:
            self._fail("the spindle drive remains in mode {shown_mode}", shown_mode=drive.shown_mode)

    # --- inside ------------------------------------------------------------------------------------------

    def _demand(self) -> float:
        return self._axes.queue.demand_at(self._axes.now())[0][self._number]

    def _place(self) -> float:
        return self._demand() if self._goal is None else self._goal

    def _beside(self) -> float:
        """Return the angle in degrees from the spindle to its position, by the shortest path."""
        if not self._orient or self._phase.counts is None:
            return 0.0
        off = self._place() - self._phase.counts * self._axis.config.count
        return (off + _TURN / 2.0) % _TURN - _TURN / 2.0

    def _join(self) -> None:
        """Add the drive to the set of axis drives."""
        drives = self._axes.drives
        drives.axes.append(self._axis)
        drives.indices.append(self._number)
        self._axis.last, self._axis.homed = self._drive.position, True
        self._axes.rest_here()

    def _part(self) -> None:
        drives = self._axes.drives
        if self._axis in drives.axes:
            drives.axes.remove(self._axis)
            drives.indices.remove(self._number)

    def _begin_turn(self) -> None:
        axes, config = self._axes, self._axis.config
        off = self._off
        if abs(off) > config.count:
            rest, _ = axes.queue.demand_at(axes.now())
            speed = min(config.vmax, SEARCH_RPM * 6.0)
            start = axes.now() + axes.commit
            axes.splice(
                straight(
                    start, rest, self._number, to=rest[self._number] + off, speed=speed, accel=config.amax
                )
            )

    def _want(self, on: bool) -> None:
        self._wanted = self._spindle.kept = on

    def _enter(self, step: Step, now: float) -> None:
        self.step, self._since = step, now

    def _fail(self, why: str, **values: object) -> None:
        self.trouble = self.trouble or Fault(why, "c-coupling", **values)
        self._want(False)
        self._part()
        self._drive.extra = 0
        self._enter(Step.BACK, self._axes.now())
