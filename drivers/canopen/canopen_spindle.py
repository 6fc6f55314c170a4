"""Spindle drive on the CAN bus, in profile velocity mode; it may also serve as the C axis.

The drive changes between spindle mode and C axis mode at standstill. In spindle mode, it generates its own
ramps. In C axis mode, it is powered, receives setpoints and is stopped together with the other axes. Its
first C position is the last position that the control counted. If orientation is configured, the spindle
first turns to that position relative to the index.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from enum import Enum

from core.ports import DriverError, Fault, StopMode, is_queue_finished
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_axes import CanopenAxes
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_config import SpindleConfig
from drivers.canopen.canopen_homing import INDEX_SEARCH_RPM, IndexPhase, SpindleHoming
from drivers.canopen.canopen_objects import HM, IP, MODE_BITS, PV, DriveState
from drivers.canopen.canopen_setup import build_stop_objects
from drivers.canopen.cia402_drives import SPEED, SPEED_TARGET, Cia402Drive, DriveSetupData
from drivers.canopen.drive_set import DrivenAxis
from drivers.port_checks import require_free_spindle_drive, require_spindle_ready
from drivers.setpoint_queue import plan_axis_move

_STANDSTILL_RPM = 2.0  # rpm
# Without these objects, the spindle would continue to turn if this computer stops responding.
_SPINDLE_STOP_OBJECTS = (od.ABORT_OPTION, od.WATCHED)
_POWER_ON_S = 1.0  # Seconds in which the drive must switch on.


class CanopenSpindle:
    """Spindle port (``core.ports.Spindle``) that controls a CiA 402 drive.

    The drive has power only while the spindle turns or is commanded to turn.
    """

    def __init__(self, config: SpindleConfig, bus: CanBus) -> None:
        self._config = config
        self._bus = bus
        self._came_on = False
        self._last = self._counts = 0
        self._ordered = 0.0  # Time of the last power request in s.
        self.is_used_as_c = False  # Used as C, so the drive does not turn as the spindle.
        self.is_c_requested = False  # Must remain C.
        self.is_counter_ignored = False  # Ignore changes of the counter during homing.
        self.drive = Cia402Drive(bus, config.node, SPEED_TARGET, (SPEED,))

    def connect(self) -> None:
        """Configure the drive.

        Raises DriverError if the drive does not respond or does not match the machine file.
        """
        config = self._config
        queue = self.drive.profile.record_queue if config.is_c_axis else None
        standing = (
            *self.drive.profile.unit_objects,
            *build_stop_objects(self._bus.config),
            (od.PROFILE_ACCEL, 0, round(config.acceleration_rpm_per_s)),
            (od.PROFILE_DECEL, 0, round(config.deceleration_rpm_per_s)),
            (od.QUICK_DECEL, 0, round(config.deceleration_rpm_per_s)),
        )
        if queue is not None:
            standing = (*standing, (od.IP_SUBMODE, 0, queue.submode))
        self.drive.connect(
            DriveSetupData(
                mode_bits=MODE_BITS[PV] | (MODE_BITS[HM] | MODE_BITS[IP] if config.is_c_axis else 0),
                default_objects=standing,
                file_objects=config.node.sdo,
                required_objects=_SPINDLE_STOP_OBJECTS,
                record_object_index=queue.object_index if queue is not None else 0,
                is_axis=False,
            )
        )
        self.drive.commanded_mode, self.drive.target_value = PV, 0

    def supervise_drive(self) -> None:
        """Supervise the drive and switch it off at standstill.

        This method never switches the drive on.
        """
        drive = self.drive
        drive.supervise_drive(3.0 * self._bus.config.heartbeat)
        lost = self._came_on and not drive.is_enabled
        self._came_on = drive.is_enabled and drive.goal_state is DriveState.OPERATION_ENABLED
        if drive.failure:
            drive.goal_state, drive.target_value = DriveState.QUICK_STOP_ACTIVE, 0
        elif self.is_used_as_c:
            self._came_on = False
        elif drive.goal_state is DriveState.OPERATION_ENABLED:
            self._check_drive(lost)

    def _check_drive(self, is_power_lost: bool) -> None:
        """Switch the drive off after a loss of power, or set a fault if the drive does not switch on.

        If the drive waited for the power to return, the spindle would then start unexpectedly.
        """
        drive, now = self.drive, self._bus.clock.now()
        if is_power_lost:
            drive.goal_state, drive.target_value = DriveState.SWITCH_ON_DISABLED, 0
        elif not drive.is_enabled and now - self._ordered > _POWER_ON_S:
            drive.failure = Fault(
                "spindle: the drive does not switch on; check that the E-stop is released and the "
                "drive has power",
                "spindle",
            )
        elif drive.target_value == 0 and abs(drive.measured_speed) < _STANDSTILL_RPM:
            drive.goal_state = DriveState.SWITCH_ON_DISABLED

    def set_speed(self, rpm: float) -> None:
        """Turn the spindle at the signed speed ``rpm``, or stop the spindle if ``rpm`` is 0.

        Raises DriverError if ``rpm`` is not 0 while a fault is active or the drive is engaged as C.
        """
        if rpm:
            require_spindle_ready(self._bus.failure or self.drive.failure)
        if rpm and self.is_c_requested:
            raise DriverError(
                "the spindle stays off because its drive is engaged as the C axis; release the "
                "drive with M05 first",
                "spindle-off",
                reason="held-as-c",
            )
        limit = self._config.max_rpm
        self.drive.target_value = round(min(max(rpm, -limit), limit))
        if rpm and self.is_used_as_c:
            return  # The spindle turns after C is released.
        if rpm and self.drive.goal_state is not DriveState.OPERATION_ENABLED:
            self.drive.goal_state, self._ordered = DriveState.OPERATION_ENABLED, self._bus.clock.now()

    def start_coasting(self) -> None:
        """Remove the torque, so that the spindle coasts to a stop."""
        self.drive.target_value = 0
        if not self.is_used_as_c:
            self.drive.goal_state = DriveState.SWITCH_ON_DISABLED

    @property
    def counts_per_rev(self) -> int:
        """Return the encoder counts per revolution, or 0 if they are not specified."""
        return self._config.node.counts_per_rev

    @property
    def has_speed_command(self) -> bool:
        """Return whether a speed other than 0 is commanded."""
        return self.drive.target_value != 0

    def apply_stored_speed(self) -> None:
        """Execute the speed command that was received while the drive was in C axis mode."""
        if self.drive.target_value:
            self.drive.goal_state, self._ordered = DriveState.OPERATION_ENABLED, self._bus.clock.now()

    def clear_fault(self) -> None:
        """Clear the fault without switching the power on.

        A drive that has restarted or did not reply to the last SYNC is configured again. Raises DriverError
        if this configuration fails.
        """
        if self.drive.has_restarted or self.drive.missing_reply_count:
            self.connect()
            self.drive.start_node()
        self.drive.clear_stored_fault()
        self.drive.reset_fault()

    def speed(self) -> float:
        """Return the measured speed in rpm, signed, or 0 while the drive is in C axis mode."""
        return 0.0 if self.is_used_as_c else float(self.drive.measured_speed)

    def read_angle(self) -> tuple[float, float] | None:
        """Return the encoder reading as its time in seconds and the spindle position in revolutions.

        Return None if the counts per revolution are not specified.
        """
        if not self.counts_per_rev:
            return None
        now = self.drive.position
        if self.is_counter_ignored:
            return self.drive.last_reply_s, self._counts / self.counts_per_rev
        # The counter wraps around every few hours.
        self._counts += (now - self._last + 2**31) % 2**32 - 2**31
        self._last = now
        return self.drive.last_reply_s, self._counts / self.counts_per_rev

    def accept_counter_jump(self) -> None:
        """Accept a counter value that homing has set, so that the jump does not count as rotation."""
        if self.is_counter_ignored:
            self._last, self.is_counter_ignored = self.drive.position, False

    def read_fault(self) -> str:
        """Return the fault of the drive or the bus, or an empty string if there is no fault."""
        return self._bus.failure or (self.drive.failure and Fault(self.drive.failure, "spindle"))


# --- C on the spindle drive.


_MODE_CHANGE_S = 2.0  # Seconds for a change of mode with power.
_DEGREES_PER_REV = 360.0


class CAxisModeStep(Enum):
    """Step of the change between spindle mode and C axis mode."""

    SPINDLE_MODE = "the drive is running as the spindle drive"
    WAIT_FOR_REST = "waiting until the axis drives have executed their queued motion"
    FIND_INDEX = "searching for the encoder index"
    SET_POSITION = "setting the current position in the spindle drive"
    POWER_ON = "changing the spindle drive to position mode"
    TURN_TO_POSITION = "turning the spindle to its C-axis position"
    ENGAGED = "is C"
    DISENGAGE = "ending C axis mode"
    RESTORE_SPEED_MODE = "changing the spindle drive to speed mode"


class CanopenCAxis:
    """Port that runs the spindle drive as the C axis (``core.ports.SpindleCAxis``).

    A fault stops all axes. ``advance_mode_change`` must be called once per bus cycle.
    """

    def __init__(self, axes: CanopenAxes, spindle: CanopenSpindle, name: str) -> None:
        self._axes, self._spindle, self._drive = axes, spindle, spindle.drive
        self._number = axes.axes.index(name)
        config = axes.config.axes[self._number]
        per_turn = spindle.counts_per_rev
        config = replace(
            config, count=_DEGREES_PER_REV / per_turn, counts_per_rev=per_turn, profile=spindle.drive.profile
        )
        self._axis = DrivenAxis(config, spindle.drive, is_homed=True)
        self.step = CAxisModeStep.SPINDLE_MODE
        self.failure: Fault | str = ""
        self._wanted = self._orient = False
        self._since = 0.0
        self._homing = SpindleHoming(spindle.drive)
        self._phase = IndexPhase(spindle.counts_per_rev)
        self._off = 0.0  # Degrees to turn to the position.
        # Required C position when engaged, preserved across canceled attempts.
        self._goal: float | None = None

    # --- the port ----------------------------------------------------------------------------------------

    def set_c_mode(self, is_enabled: bool, should_orient: bool = False) -> None:
        """Engage the drive as the C axis, or release it for use as the spindle.

        With ``should_orient``, the spindle first turns to its position relative to the index. Raises
        DriverError if the drive cannot be engaged now.
        """
        if is_enabled and self.failure:
            raise DriverError(self.failure)
        if is_enabled and not self._wanted:
            turning = self._spindle.has_speed_command or abs(self._drive.measured_speed) >= _STANDSTILL_RPM
            require_free_spindle_drive(
                self._axes.sample().enabled, self.step is CAxisModeStep.SPINDLE_MODE and turning
            )
            self._orient = should_orient
        self._want(is_enabled)

    def is_c_ready(self) -> bool:
        """Return whether C is engaged and may move."""
        return self.step is CAxisModeStep.ENGAGED and self._wanted

    # --- each cycle --------------------------------------------------------------------------------------

    def advance_mode_change(self, now: float) -> None:
        """Continue the change between spindle mode and C axis mode, if a change is in progress."""
        self._phase.track_position(
            self._drive.position,
            ignore_jumps=self.step in {CAxisModeStep.FIND_INDEX, CAxisModeStep.SET_POSITION},
        )
        if self._drive.has_restarted:
            self._phase.counts = None
        if self.step is not CAxisModeStep.SPINDLE_MODE and (
            self._drive.failure or not self._axes.sample().enabled
        ):
            self._want(False)  # Without power, C ends.
        steps: dict[CAxisModeStep, Callable[[float], None]] = {
            CAxisModeStep.SPINDLE_MODE: self._free,
            CAxisModeStep.WAIT_FOR_REST: self._rest,
            CAxisModeStep.FIND_INDEX: self._search,
            CAxisModeStep.SET_POSITION: self._here,
            CAxisModeStep.POWER_ON: self._power,
            CAxisModeStep.TURN_TO_POSITION: self._turn,
            CAxisModeStep.ENGAGED: self._held,
            CAxisModeStep.DISENGAGE: self._disengage,
            CAxisModeStep.RESTORE_SPEED_MODE: self._back,
        }
        try:
            steps[self.step](now)
        except DriverError as error:
            self._fail(error.fault)

    def clear_fault(self) -> None:
        """Clear the fault and release the drive."""
        self.failure = ""
        self._want(False)

    def _free(self, now: float) -> None:
        if self._wanted:
            self._spindle.is_used_as_c = True
            self._goal = self._demand() if self._goal is None else self._goal
            self._enter(CAxisModeStep.WAIT_FOR_REST, now)

    def _rest(self, now: float) -> None:
        if not self._wanted:
            self._enter(CAxisModeStep.RESTORE_SPEED_MODE, now)
        elif not self._axes.is_follower_idle(now):
            self._since = now
        elif self._orient and self._phase.counts is None:
            self._spindle.is_counter_ignored = True
            self._homing.start_index_search(now)
            self._enter(CAxisModeStep.FIND_INDEX, now)
        else:
            self._set_drive_position(now)

    def _search(self, now: float) -> None:
        if self._is_homing_done(now):
            self._phase.set_index_position(self._drive.position)
            self._set_drive_position(now)

    def _set_drive_position(self, now: float) -> None:
        """Set the drive's counter to the position of C without motion."""
        self._off = self._angle_to_position()
        place = self._place() - self._off
        self._spindle.is_counter_ignored = True
        self._homing.start_position_setting(self._axis.config.convert_position(place), now)
        self._enter(CAxisModeStep.SET_POSITION, now)

    def _here(self, now: float) -> None:
        if self._is_homing_done(now):
            self._spindle.accept_counter_jump()
            self._drive.commanded_mode = IP
            if self._axis.record_queue is None:
                raise DriverError(
                    "C axis not available: {title} does not have a position queue",
                    "c-coupling",
                    title=self._drive.profile.display_name,
                )
            self._axis.record_queue.clear_records()
            self._enter(CAxisModeStep.POWER_ON, now)

    def _is_homing_done(self, now: float) -> bool:
        """Return whether the homing is complete; raise DriverError if it has failed.

        If C axis mode is no longer requested, the homing is canceled.
        """
        if self._wanted:
            return self._homing.is_done(now)
        self._drive.mode_bits = 0
        self._enter(CAxisModeStep.RESTORE_SPEED_MODE, now)
        return False

    def _power(self, now: float) -> None:
        if not self._wanted:
            self._enter(CAxisModeStep.RESTORE_SPEED_MODE, now)
        elif self._drive.is_enabled and self._drive.reported_mode == IP:
            self._add_to_axes()
            self._begin_turn()
            self._enter(CAxisModeStep.TURN_TO_POSITION, now)
        elif now - self._since > _MODE_CHANGE_S:
            self._fail("the spindle drive remains in mode {shown_mode}", shown_mode=self._drive.reported_mode)

    def _turn(self, now: float) -> None:
        if not self._wanted:
            self._axes.stop(StopMode.RAMP_HOLD)
            self._enter(CAxisModeStep.DISENGAGE, now)
        elif is_queue_finished(self._axes.queue.get_end_time(now), now) and not self._axes.drives.is_moving:
            self._goal = None
            self._enter(CAxisModeStep.ENGAGED, now)

    def _held(self, now: float) -> None:
        if not self._wanted:
            self._enter(CAxisModeStep.DISENGAGE, now)

    def _disengage(self, now: float) -> None:
        """Release the drive when the axes are at rest and the queues of the drives are empty."""
        if self._axes.is_follower_idle(now):
            self._part()
            self._enter(CAxisModeStep.RESTORE_SPEED_MODE, now)

    def _back(self, now: float) -> None:
        drive = self._drive
        drive.goal_state, drive.mode_bits, drive.commanded_mode = DriveState.SWITCH_ON_DISABLED, 0, PV
        if drive.reported_mode == PV and not drive.is_enabled:
            self._spindle.is_used_as_c = False
            self._spindle.accept_counter_jump()
            self.step = CAxisModeStep.SPINDLE_MODE
            self._spindle.apply_stored_speed()
        elif now - self._since > _MODE_CHANGE_S and not self.failure:
            self._fail("the spindle drive remains in mode {shown_mode}", shown_mode=drive.reported_mode)

    # --- inside ------------------------------------------------------------------------------------------

    def _demand(self) -> float:
        return self._axes.queue.get_commanded_state(self._axes.now())[0][self._number]

    def _place(self) -> float:
        return self._demand() if self._goal is None else self._goal

    def _angle_to_position(self) -> float:
        """Return the shortest angle, in degrees, through which the spindle must turn to its C position."""
        if not self._orient or self._phase.counts is None:
            return 0.0
        off = self._place() - self._phase.counts * self._axis.config.count
        return (off + _DEGREES_PER_REV / 2.0) % _DEGREES_PER_REV - _DEGREES_PER_REV / 2.0

    def _add_to_axes(self) -> None:
        """Add the drive to the set of axis drives."""
        drives = self._axes.drives
        drives.axes.append(self._axis)
        drives.axis_indices.append(self._number)
        self._axis.last_position_counts, self._axis.is_homed = self._drive.position, True
        self._axes.reset_queue()

    def _part(self) -> None:
        drives = self._axes.drives
        if self._axis in drives.axes:
            drives.axes.remove(self._axis)
            drives.axis_indices.remove(self._number)

    def _begin_turn(self) -> None:
        axes, config = self._axes, self._axis.config
        off = self._off
        if abs(off) > config.count:
            rest, _ = axes.queue.get_commanded_state(axes.now())
            speed = min(config.vmax, INDEX_SEARCH_RPM * 6.0)
            start = axes.now() + axes.commit
            axes.splice(
                plan_axis_move(
                    start, rest, self._number, target=rest[self._number] + off, speed=speed, accel=config.amax
                )
            )

    def _want(self, on: bool) -> None:
        self._wanted = self._spindle.is_c_requested = on

    def _enter(self, step: CAxisModeStep, now: float) -> None:
        self.step, self._since = step, now

    def _fail(self, why: str, **values: object) -> None:
        self.failure = self.failure or Fault(why, "c-coupling", **values)
        self._want(False)
        self._part()
        self._drive.mode_bits = 0
        self._enter(CAxisModeStep.RESTORE_SPEED_MODE, self._axes.now())
