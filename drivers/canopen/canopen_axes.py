"""Axes on a CANopen bus, with one common setpoint queue and one drive for each axis."""

from __future__ import annotations

from collections.abc import Callable

from core.ports import AxisSample, DriverError, MotionSegments, StopMode, is_queue_finished
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_homing import CanopenHoming
from drivers.canopen.canopen_objects import DriveState
from drivers.canopen.canopen_setup import build_travel_limit_objects
from drivers.canopen.drive_set import MOTION_MODES, DriveSet
from drivers.canopen.position_modes import (
    CyclicSetpointFollower,
    ProfilePositionFollower,
    SetpointFollower,
    SyncSchedule,
)
from drivers.canopen.pvt_mode import PvtFollower
from drivers.port_checks import (
    require_drive_power,
    require_existing_axis,
    require_no_fault,
    require_no_homing,
    require_standstill,
)
from drivers.setpoint_queue import JunctionTolerance, SetpointQueue, check_setpoint_limits


def create_setpoint_follower(
    config: CanopenConfig, drives: DriveSet, queue: SetpointQueue, schedule: SyncSchedule
) -> SetpointFollower:
    """Create the setpoint follower for the motion mode ``config.bus.mode``."""
    if config.bus_settings.mode == "pp":
        return ProfilePositionFollower(drives.axes, drives.axis_indices, queue)
    if MOTION_MODES[config.bus_settings.mode].is_cyclic:
        return CyclicSetpointFollower(
            drives.axes,
            drives.axis_indices,
            queue,
            MOTION_MODES[config.bus_settings.mode].cia402_mode,
            schedule,
        )
    return PvtFollower(
        drives.axes, drives.axis_indices, queue, config.commit_time_s, config.bus_settings.record
    )


_HISTORY_S = 0.5  # Age in s of setpoints that are still available.
_BRAKING_RESERVE_S = (
    0.15  # Seconds in addition to the ramp from full speed until a quick stop must have ended without power.
)


class CanopenAxes:
    """``core.ports.AxisSink`` of the CANopen drives.

    Only the thread that owns the bus may use this object.
    """

    def __init__(self, config: CanopenConfig, bus: CanBus) -> None:
        self._bus = bus
        self.config = config
        self.axes = tuple(axis.name for axis in config.axes)
        self.commit = config.commit_time_s
        self.drives = DriveSet(config.axes, bus, MOTION_MODES[config.bus_settings.mode])
        tolerance = JunctionTolerance.from_axes(config.axes)
        self.queue = SetpointQueue(self.axes, (0.0,) * len(self.axes), config.commit_time_s, tolerance)
        self.sync_schedule = SyncSchedule(config.bus_settings.sync, bus.clock.now())
        self.follower = create_setpoint_follower(config, self.drives, self.queue, self.sync_schedule)
        self.is_cyclic = MOTION_MODES[config.bus_settings.mode].is_cyclic
        self.active_homing: CanopenHoming | None = None
        self.fault = ""
        self.other_device_fault = ""  # Fault of another device on the bus.
        self.reconnect_bus: Callable[[], None] = lambda: None  # Opens the bus and configures all nodes.
        self.fault_clearers: list[
            Callable[[], None]
        ] = []  # Functions that clear the faults of other devices.
        self._on = False
        self._braking = False  # Braking by quick stop, after which a drive switches itself off.
        self._powerless_at = 0.0  # Time when the power is switched off at the latest.
        self._given_up: CanopenHoming | None = None  # A canceled homing that still brakes.

    def connect(self) -> None:
        """Configure every drive.

        Raises DriverError if a drive does not respond or does not match the machine file.
        """
        self.drives.configure_drives()
        self.queue.reset_to_position(self._actual_positions())

    def run_cycle(self, now: float) -> None:
        """Supervise the drives, continue a homing, and feed setpoints; this method raises no exceptions.

        A fault stops all axes. In cyclic modes, ``advance`` feeds the setpoints at each SYNC instead.
        """
        self._supervise()
        if not self.is_cyclic:
            self.advance_motion(now)
        self._check_braking_time(now)
        self.drives.update_moving_axes(now)
        self.queue.discard_pieces_before(now - _HISTORY_S)

    def advance_motion(self, now: float) -> None:
        """Execute the next step of a homing, or feed the next setpoints.

        An error sets a fault and stops all axes.
        """
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
        """Return the end time of the setpoint queue, or the current time if the queue is empty."""
        return self.queue.get_end_time(self.now())

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at time ``time_s``."""
        return self.queue.get_commanded_state(time_s)

    def splice(self, segments: MotionSegments) -> None:
        """Splice setpoints into the queue.

        Raises DriverError if a fault is active, the power is off or an axis is homing. Also raises
        DriverError if the setpoints are invalid or the drives cannot follow them.
        """
        self._need_power()
        homing = self.active_homing or self._given_up
        require_no_homing(homing.config.name if homing is not None else "")
        check_setpoint_limits(segments, self.config.axes, self._homed())
        self.follower.check_segments(segments)
        self.queue.splice_segments(segments, self.now())

    def sample(self) -> AxisSample:
        """Return the state of the axes from the last replies, with the time of their SYNC."""
        actual, powered, seen = self._actual_positions(), self._powered(), self.drives.last_reply_s
        demand, velocity = self.queue.get_commanded_state(self.follower.get_path_time(seen))
        busy = self.active_homing is not None or self._given_up is not None
        if not powered or busy:
            demand = actual
        return AxisSample(
            t=seen,
            demand=demand,
            actual=actual,
            following_error=tuple([d - a for d, a in zip(demand, actual, strict=True)]),
            enabled=powered,
            homed=self._homed(),
            moving=not self._bus.failure and (busy or any(velocity) or self._plays),
            fault=self.fault,
        )

    @property
    def _plays(self) -> bool:
        return self.drives.is_moving or (self.is_cyclic and self.follower.is_executing)

    def enable(self, is_on: bool) -> None:
        """Switch the power of the drives on or off, and wait until all drives have switched.

        Switching off waits at most 0.3 s and reports no error if a drive still has power then. When
        switching on, raises DriverError if a fault is active, if a drive rejects a request or if drives do
        not switch on. The error names these drives.
        """
        if not is_on:
            self._off(DriveState.SWITCH_ON_DISABLED)
            self.drives.power_off()
            return
        require_no_fault(self.fault)
        if self._powered():
            return
        self.follower.prepare_targets()
        self.drives.power_on()
        self.queue.reset_to_position(self._actual_positions())
        self._on = True

    def stop(self, mode: StopMode) -> None:
        """Stop all axes at the same time, either along the path or by a command to the drives.

        With RAMP_HOLD, powered axes brake along the path. Otherwise all drives receive the stop command
        with the same SYNC: OFF removes their power, and the other modes start a quick stop.
        """
        if mode is StopMode.RAMP_HOLD and self._powered():
            self._brake_on_path()
            return
        self._off(DriveState.SWITCH_ON_DISABLED if mode is StopMode.OFF else DriveState.QUICK_STOP_ACTIVE)
        if not self._bus.failure and not self.is_cyclic:  # Otherwise with the next SYNC at its regular time.
            self.drives.send_commands_and_sync()

    def home(self, axis: str) -> None:
        """Start homing an axis with the homing function of its drive.

        An axis without a drive or with an absolute encoder is not homed. Raises DriverError if the axis
        does not exist. Also raises DriverError if a fault is active, the power is off, an axis is moving,
        or the drive rejects the homing parameters.
        """
        require_existing_axis(axis, self.axes)
        driven = next((a for a in self.drives.axes if a.config.name == axis), None)
        if driven is None or driven.config.absolute:
            return
        self._need_power()
        require_standstill(axis, self.sample().moving)
        self.follower.abort_transfer()
        self.active_homing = CanopenHoming(driven, self.follower.cia402_mode, self.now())

    def clear_fault(self) -> None:
        """Clear the fault and reset the drives, which remain without power.

        After a bus failure, the bus is also reopened and every node is configured again. Raises DriverError
        if this fails or if a fault remains.
        """
        if self._bus.failure:
            self.reconnect_bus()
        self._off(DriveState.SWITCH_ON_DISABLED)
        for clear in self.fault_clearers:
            clear()
        self.other_device_fault = self.fault = ""
        self.drives.reset_faults()

    def is_follower_idle(self, now: float) -> bool:
        """Return whether neither the queue nor any drive contains setpoints that are not executed yet."""
        return is_queue_finished(self.queue.get_end_time(now), now) and not self.follower.is_executing

    def reset_queue(self) -> None:
        """Restart the setpoint queue at the measured positions."""
        self.queue.reset_to_position(self._actual_positions())

    # --- inside -------------------------------------------------------------------------------------------

    def _supervise(self) -> None:
        fault_text = (
            self._bus.failure
            or self.other_device_fault
            or self.follower.failure
            or self.drives.supervise_drives()
        )
        fault_text = fault_text or (self.active_homing.failure if self.active_homing is not None else "")
        if fault_text and not self.fault:
            self._trip(fault_text)
        elif self._on and not self._powered() and not fault_text:
            self._off(DriveState.SWITCH_ON_DISABLED)  # The power was removed by E-stop or STO.
            self.drives.mark_axes_not_homed()

    def _trip(self, fault: str) -> None:
        """Record a fault, unless another fault is already active, and stop all axes."""
        self.fault = self.fault or fault
        self._off(DriveState.QUICK_STOP_ACTIVE)

    def _off(self, goal: DriveState) -> None:
        if goal is DriveState.QUICK_STOP_ACTIVE and not self._braking:
            driven = [axis.config for axis in self.drives.axes]
            ramp = max((axis.vmax / axis.amax for axis in driven), default=0.0)
            self._powerless_at = self.now() + ramp + _BRAKING_RESERVE_S
        self._braking = goal is DriveState.QUICK_STOP_ACTIVE
        self._on, self.active_homing, self._given_up = False, None, None
        self.drives.set_goal_state(goal)
        self.follower.abort_transfer()
        self.follower.must_send_now = True
        self.queue.reset_to_position(self._actual_positions())

    def _check_braking_time(self, now: float) -> None:
        """Switch the drives off if a quick stop takes too long.

        Otherwise a drive with a failed encoder or a runaway axis could continue to move the axis.
        """
        if self._braking and now > self._powerless_at:
            self._braking = False
            self.drives.set_goal_state(DriveState.SWITCH_ON_DISABLED)

    def _brake_on_path(self) -> None:
        """Brake all axes along the programmed path, or cancel the homing of an axis.

        A homing axis brakes with the ramp of its drive.
        """
        if self.active_homing is not None:
            self.active_homing.cancel_homing()
            self.active_homing, self._given_up = None, self.active_homing
        elif self._given_up is None:
            at = self.now() + self.commit
            if any(self.queue.get_commanded_state(at)[1]):
                self.queue.brake_to_rest(at, [axis.amax for axis in self.config.axes])
            else:
                place, _ = self.queue.get_commanded_state(at)  # Setpoints until then remain.
                self.queue.splice_segments(MotionSegments.make_standstill(at, place), at - self.commit)
            self.follower.handle_braking(at)

    def _go_on(self, now: float) -> None:
        homing = self.active_homing or self._given_up
        if homing is None:
            self.follower.transfer_setpoints(now)
            return
        homing.advance_homing(now)
        if homing.is_done:
            if self.active_homing is not None:
                homing.axis.is_homed = True
                for index, sub, value in build_travel_limit_objects(homing.config):
                    homing.axis.drive.setup.write_optional_object(index, sub, value)
            self.active_homing = self._given_up = None
            self.queue.reset_to_position(
                self._actual_positions()
            )  # The path continues from the stop position of the drive.

    def _need_power(self) -> None:
        require_drive_power(self.fault, self._powered())

    def _powered(self) -> bool:
        return self._on and self.drives.is_powered

    def _actual_positions(self) -> tuple[float, ...]:
        """Return the measured position of each axis, or the queued position of an axis without a drive."""
        p = list(self.queue.get_commanded_state(self.now())[0])
        for index, axis in zip(self.drives.axis_indices, self.drives.axes, strict=True):
            p[index] = axis.drive.position * axis.config.count
        return tuple(p)

    def _homed(self) -> tuple[bool, ...]:
        homed = [True] * len(self.axes)
        for index, axis in zip(self.drives.axis_indices, self.drives.axes, strict=True):
            homed[index] = axis.is_homed
        return tuple(homed)
