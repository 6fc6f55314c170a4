"""Simulated lathe without a thread; each call advances it to the current time of the clock.

The model advances on a grid of fixed times, so its behavior does not depend on when it is called.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping

import numpy as np

from core.ports import (
    BoolArray,
    Cam,
    Clock,
    DriverError,
    Fault,
    FloatArray,
    MotionSegments,
    StationState,
    StopMode,
)
from drivers.operator_station import PanelState
from drivers.port_checks import SampleRingBuffer, require_drive_power, require_no_fault, require_no_homing
from drivers.setpoint_queue import plan_axis_move
from drivers.simulators.plant_config import SimConfig
from drivers.simulators.plant_terminals import SimulatedTerminals, SimulatedToolSetter
from drivers.simulators.predicted_motion import PredictedMotion, predict_motion
from drivers.simulators.servo_axis import SimulatedServo, check_cam_limits, check_drive_limits
from drivers.simulators.spindle_motor import SpindleMotor
from drivers.spindle_gear import GearAxes, GearedQueue, SpindlePhaseFilter
from drivers.wakeups import ActionLock, LocalWakeup

_NO_TIME = float("inf")
AxisMotion = tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]
_HISTORY_S = 0.1  # Age in s of setpoints that are still available.
_LOCK_TIMEOUT_S = 0.2  # s
_HOME_SETTLE = 0.2  # s between the end of a homing move and the reference
# Columns of a sample: speed, turns and load of the spindle, and the end of the queue.
_SPINDLE_AT_REST = (0.0, 0.0, 0.0, 0.0)
_REST_SAMPLE_INTERVAL_S = 0.1  # Seconds between two samples of a machine at rest.


class SimulatedPlant:
    """Simulated axes, spindle, terminals and operator station with one common lock.

    Any thread may call the methods.
    """

    def __init__(self, config: SimConfig, clock: Clock) -> None:
        self.config = config
        self.clock = clock
        self.lock = threading.RLock()
        self.wakeup = LocalWakeup(self.is_state_constant)
        self.action_lock = ActionLock(
            self.lock, self.wakeup.request_poll
        )  # For operator actions and for faults.
        self.servos = tuple(SimulatedServo(axis, config.model_step_s) for axis in config.axes)
        self.axis_names = tuple(axis.name for axis in config.axes)
        self.spindle = SpindleMotor(config.spindle)
        self.terminals = SimulatedTerminals(config.outputs, config.inputs, config.collet, config.random_seed)
        self.terminals.setter = SimulatedToolSetter(config.setter) if config.setter is not None else None
        self.station_panel = PanelState(config.palm_window_s, config.min_start_pulse_s, config.random_seed)
        self.setpoint_queue = GearedQueue(
            GearAxes.from_axes(config.axes, config.commit_time_s), self._readings()
        )
        self.enabled = False
        self.fault: str = ""
        self._off_at = _NO_TIME
        self._homing: tuple[SimulatedServo, float] | None = None
        self.apply_due_faults: Callable[[float], None] | None = (
            None  # Applies the scheduled faults that are due.
        )
        self.sample_log: SampleRingBuffer | None = (
            None  # Samples of all grid points from the first request on.
        )
        self._turned: tuple[float, ...] = (
            0.0,
            0.0,
            0.0,
        )  # speed, turns and load of the spindle at the present grid point
        self._changed = True  # The last sample was not at rest.
        self._k = int(clock.now() / config.model_step_s)
        self.spindle.time_s = clock.now()
        self._hands: tuple[StationState, Mapping[str, bool]] | None = None
        # Number of changes at the last reading. None: they can change at any time.
        self._hands_at: int | None = None
        self._looked_at = -_NO_TIME  # Time of the last call of `advance` in s.
        self._ahead: PredictedMotion | None = None

    @property
    def model_time_s(self) -> float:
        """Return the time of the last calculated grid point in seconds."""
        return self._k * self.config.model_step_s

    def advance(self) -> float:
        """Advance the model to the current time of the clock, and return this time in seconds."""
        now = self.clock.now()
        with self.lock:
            if now == self._looked_at:
                return now
            self._apply_faults(now)
            self._looked_at = now
            last = int(now / self.config.model_step_s + 1e-6)
            if last > self._k:
                self._advance_axes(last)
                self.setpoint_queue.discard_pieces_before(self.model_time_s - _HISTORY_S)
            if now > self.spindle.time_s:
                self.spindle.advance_to(now)
        return now

    def read_station_and_inputs(self, time_s: float) -> tuple[StationState, Mapping[str, bool]]:
        """Return the state of the operator station and the inputs at time ``time_s`` in seconds.

        They are calculated again only if they may have changed since the last call.
        """
        changes = self.action_lock.action_count + self.terminals.write_count
        if self._hands is None or changes != self._hands_at:
            still = (
                self.terminals.setter is None
                and self.terminals.is_collet_motion_complete(time_s)
                and self.station_panel.is_state_constant(time_s)
            )
            self._hands_at = changes if still else None
            self._hands = self.station_panel.state(time_s), self.terminals.read_inputs(time_s)
        return self._hands

    def is_state_constant(self) -> bool:
        """Return whether the machine will not change before the next action of an operator or a test.

        The result is always False for a machine with scheduled faults.
        """
        with self.lock:
            now = self.advance()
            waits = self.apply_due_faults is not None or self._off_at < _NO_TIME or self._homing is not None
            moves = waits or not self.spindle.is_at_rest or not self._resting()
            return (
                not moves
                and self.terminals.is_collet_motion_complete(now)
                and self.station_panel.is_state_constant(now)
            )

    def _apply_faults(self, now: float) -> None:
        """Apply the faults that are due at time ``now``; nested calls are prevented."""
        due, self.apply_due_faults = self.apply_due_faults, None
        if due is not None:
            due(now)
            self.apply_due_faults = due

    def splice_segments(self, segments: MotionSegments) -> None:
        """Splice setpoints into the queue.

        Raises DriverError if a fault is active, the power is off or an axis is homing. Also raises
        DriverError if the setpoints are invalid or the drives cannot follow them.
        """
        with self.lock:
            now = self.advance()
            self._need_power()
            check_drive_limits(segments, self.servos, self.spindle.speed)
            self.setpoint_queue.splice_segments(segments, now)

    def engage_cam(self, cam: Cam) -> None:
        """Make the axes follow the spindle along ``cam``.

        Raises DriverError if a fault is active, the power is off, an axis is homing or moving, or the
        spindle is not turning in the direction of the cam. Also raises DriverError if the cam is invalid or
        the drives cannot follow it.
        """
        with self.lock:
            now = self.advance()
            self._need_power()
            check_cam_limits(cam, self.servos, self.spindle.speed)
            self.setpoint_queue.engage_cam(
                cam, SpindlePhaseFilter(now, self.spindle.counted_revolutions, self.spindle.speed / 60.0), now
            )

    def set_drive_power(self, is_on: bool) -> None:
        """Switch the drives on at their current positions, or off.

        Raises DriverError if the drives are to be switched on while the E-stop is pressed or a fault is
        active.
        """
        with self.lock:
            self.advance()
            if not is_on:
                self._power_off()
                return
            if self.station_panel.estop:
                raise DriverError(
                    "the drives stay off while the E-stop is pressed; release the E-stop first", "no-power"
                )
            require_no_fault(self.fault)
            if not self.enabled:
                self.setpoint_queue.reset_to_position(self._readings())
            self.enabled, self._off_at = True, _NO_TIME

    def stop(self, mode: StopMode) -> None:
        """Stop the axes with the ramps of the drives, independently of the queued path."""
        with self.lock:
            now = self.advance()
            self._homing = None
            if mode is StopMode.OFF:
                self._power_off()
            elif self.enabled:
                ends = self.setpoint_queue.brake_to_rest(now, [axis.amax for axis in self.config.axes])
                if mode is StopMode.RAMP_OFF or self._off_at < _NO_TIME:
                    self._off_at = ends

    def home_axis(self, name: str) -> None:
        """Start to home one axis; nothing happens if the axis has an absolute encoder.

        Raises DriverError without power, with a fault, while another axis homes, or while an axis moves.
        """
        with self.lock:
            now = self.advance()
            self._need_power()
            index = self.axis_names.index(name)
            servo = self.servos[index]
            if servo.axis.absolute:
                return
            rest, velocity = self.setpoint_queue.get_commanded_state(now)
            if any(velocity) or self._homing is not None:
                raise DriverError(
                    "{axis} cannot home while an axis is moving; wait until all axes are at rest",
                    reason="axis-moves",
                    axis=name,
                )
            pieces = plan_axis_move(
                now + self.config.commit_time_s,
                rest,
                index,
                target=servo.switch,
                speed=servo.axis.home_speed,
                accel=servo.axis.amax,
            )
            self.setpoint_queue.splice_segments(pieces, now)
            self._homing = (servo, self.setpoint_queue.get_end_time(now) + _HOME_SETTLE)

    def press_estop(self) -> None:
        """Brake the axes, remove their power and let the spindle coast, as the E-stop circuit does."""
        with self.action_lock:
            now = self.advance()
            self.station_panel.estop = True
            self.stop(StopMode.RAMP_OFF)
            self.spindle.remove_power(now)

    def stop_machine(self) -> None:
        """Stop the axes and the spindle, and set the outputs to their safe states.

        Any thread may call this method. Raises DriverError if the lock is not available within 0.2 s.
        """
        if not self.lock.acquire(timeout=_LOCK_TIMEOUT_S):
            raise DriverError("no response from the simulated machine")
        try:
            self.stop(StopMode.RAMP_OFF)
            self.spindle.command_speed(self.advance(), 0.0, should_coast=True)
            self.terminals.switch_to_safe_state(self.clock.now())
        finally:
            self.lock.release()

    def trip_drives(self, fault: str) -> None:
        """Set a drive fault, brake all axes and switch their drives off."""
        self.fault = self.fault or fault
        self.stop(StopMode.RAMP_OFF)

    def clear_fault(self) -> None:
        """Clear the fault; the drives remain off until they are switched on again."""
        self.advance()
        self.fault = ""
        for servo in self.servos:
            servo.over = 0.0

    def _readings(self) -> tuple[float, ...]:
        return tuple(servo.reading for servo in self.servos)

    def _need_power(self) -> None:
        require_drive_power(self.fault, self.enabled and self._off_at >= _NO_TIME)
        require_no_homing(self._homing[0].axis.name if self._homing is not None else "")

    def _power_off(self) -> None:
        self.enabled, self._off_at, self._homing = False, _NO_TIME, None
        self.setpoint_queue.reset_to_position(self._readings())
        for servo in self.servos:
            servo.handle_power_loss()

    def _advance_axes(self, last: int) -> None:
        """Move the axes to grid point ``last``.

        While the axes are at rest, single steps are not calculated.
        """
        while self._k < last:
            if self.model_time_s >= self._off_at:
                self._power_off()
            if self._resting():
                self._advance_at_rest(last)
            elif not (self._is_undisturbed() and self._advance_predicted(last)):
                self._step()
            self._reference()

    def _advance_at_rest(self, last: int) -> None:
        """Advance the time to grid point ``last``, or only to the time when the drives switch off."""
        self.spindle.is_cutting = False
        if self.spindle.slip_fraction:
            self.spindle.set_cutting(self.model_time_s, is_cutting=False)
        until = max(self._k + 1, int(min(self._off_at / self.config.model_step_s + 1, last)))
        if self.sample_log is not None:
            self._store_rest_samples(until)
        self._k = until

    def _is_undisturbed(self) -> bool:
        """Return whether the axes only follow time-based setpoints, so that they can be predicted."""
        ordered = self.enabled and self._off_at == _NO_TIME and self._homing is None and not self.fault
        return (
            ordered
            and self.terminals.setter is None
            and not self.spindle.faults.belt_slip_fraction
            and not self.setpoint_queue.is_engaged
        )

    def _advance_predicted(self, last: int) -> bool:
        """Move the axes along the current setpoint piece, but not past grid point ``last``.

        Return False if the piece must be calculated step by step.
        """
        ahead = self._ahead
        piece, until = self.setpoint_queue.find_piece_at(self.model_time_s)
        if ahead is None or not ahead.is_valid_at(piece, until, self._k):
            ahead = self._ahead = predict_motion(self.servos, piece, until, self._k, self.config.model_step_s)
        if ahead is None:
            return False
        last = min(last, ahead.last_point)
        if self.sample_log is not None:
            self._store_predicted(ahead, last)
        ahead.move_axes_to(last)
        self._k = last
        self.spindle.is_cutting = self.is_cutting()
        return True

    def _resting(self) -> bool:
        if not self.enabled:
            return all(servo.v == 0.0 for servo in self.servos)
        if (
            self.setpoint_queue.is_engaged
            or self.setpoint_queue.get_end_time(self.model_time_s) > self.model_time_s
        ):
            return False
        rest, _ = self.setpoint_queue.get_commanded_state(self.model_time_s)
        settled = [servo.settle_at_setpoint(p) for servo, p in zip(self.servos, rest, strict=True)]
        return all(settled)

    def _step(self) -> None:
        dt, t = self.config.model_step_s, self.model_time_s
        if not self.enabled:
            self._store_sample(t, None)
            self._k += 1
            for servo in self.servos:
                servo.roll(dt)
        else:
            p, v, demand = self._setpoint(t)
            self._store_sample(t, demand)
            self._k += 1
            self._follow_setpoints(p, v, dt)
        if self.terminals.setter is not None:
            x, z = (self.servos[self.axis_names.index(name)].where for name in "XZ")
            self.terminals.setter.update_touch(self.model_time_s, x, z, self._readings())
        self.spindle.is_cutting = self.is_cutting()
        if self.spindle.faults.belt_slip_fraction:
            self.spindle.set_cutting(self.model_time_s, is_cutting=self.spindle.is_cutting)
        self._advance_spindle()

    def _follow_setpoints(self, p: tuple[float, ...], v: tuple[float, ...], dt: float) -> bool:
        """Advance all axes by one step toward the given positions and velocities.

        Return whether a drive has a fault.
        """
        for servo, position, speed in zip(self.servos, p, v, strict=True):
            if servo.follow_setpoint(position, speed, dt) and not self.fault:
                self.fault = Fault("{axis}: following error", "following", axis=servo.axis.name)
        if self.fault and self._off_at == _NO_TIME:
            self._off_at = self.setpoint_queue.brake_to_rest(
                self.model_time_s, [axis.amax for axis in self.config.axes]
            )
        return bool(self.fault)

    def is_cutting(self) -> bool:
        """Return whether an axis is moving at a cutting feed."""
        return any(servo.cuts for servo in self.servos)

    def _setpoint(self, t: float) -> AxisMotion:
        """Return the setpoints for the drives, the velocities and the queued positions at time ``t``.

        While the axes follow the spindle, the setpoints for the drives compensate for the following error.
        """
        if not self.setpoint_queue.is_engaged:
            p, v = self.setpoint_queue.get_commanded_state(t)
            return p, v, p
        if t > self.spindle.time_s:
            self.spindle.advance_to(t)
        p, v, a = self.setpoint_queue.calculate_setpoint(
            t, self.spindle.time_s, self.spindle.counted_revolutions
        )
        return tuple(servo.lead(*each) for servo, *each in zip(self.servos, p, v, a, strict=True)), v, p

    # --- samples for the scope ----------------------------------------------------------------------------

    def _store_sample(self, t: float, demand: tuple[float, ...] | None) -> None:
        """Store a sample at the current grid point; without power, the demand is the measured position."""
        if self.sample_log is None:
            return
        actual = [servo.reading for servo in self.servos]
        load = [servo.load for servo in self.servos]
        left = self.setpoint_queue.get_end_time(t) - t
        self.sample_log.append_row(t, *(demand or actual), *actual, *load, *self._turned, left)
        self._changed = True

    def _store_turning_samples(self, demand: tuple[float, ...] | None, end_point: int) -> None:
        """Store samples while the axes are at rest and the spindle turns.

        The last sample is at the grid point before ``end_point``.
        """
        assert self.sample_log is not None
        actual = self._readings()
        row = [0.0, *(demand or actual), *actual, *(servo.load for servo in self.servos), *_SPINDLE_AT_REST]
        rows = np.tile(np.array(row), (end_point - self._k, 1))
        rows[:, 0] = np.arange(self._k, end_point) * self.config.model_step_s
        self._add_spindle_columns(rows, np.zeros(len(rows), dtype=np.bool_))
        self.sample_log.append_rows(rows)
        self._k, self._changed = end_point, True

    def _store_predicted(self, prediction: PredictedMotion, last: int) -> None:
        """Store samples of a predicted motion at all grid points before ``last``."""
        assert self.sample_log is not None
        rows = prediction.get_sample_rows(self._k, last)
        self._add_spindle_columns(rows, prediction.get_cutting_flags(self._k + 1, last + 1))
        rows[:, -1] = self.setpoint_queue.get_end_time(self.model_time_s) - rows[:, 0]
        self.sample_log.append_rows(rows)
        self._changed = True

    def _add_spindle_columns(self, rows: FloatArray, cuts: BoolArray) -> None:
        """Fill the spindle columns of ``rows``, and turn the spindle to the grid point after the last row.

        ``cuts`` specifies for each grid point after the first whether a tool is cutting.
        """
        rows[:, -4:-1] = self._turned
        if self._turned[0] or not self.spindle.is_at_rest:
            following = self.spindle.advance_through_times(rows[:, 0] + self.config.model_step_s, cuts)
            rows[1:, -4:-1] = following[:-1]
            self._turned = tuple(following[-1].tolist())

    def _store_rest_samples(self, end_point: int) -> None:
        """Store samples while the axes are at rest, up to grid point ``end_point``.

        While the spindle is also at rest, the interval between samples is 0.1 s.
        """
        assert self.sample_log is not None
        demand = self.setpoint_queue.get_commanded_state(self.model_time_s)[0] if self.enabled else None
        while self._k < end_point:
            turns = not self.spindle.is_at_rest or self._turned[0] != 0.0
            if self.spindle.is_speed_constant and not self.spindle.is_at_rest:
                self._store_turning_samples(demand, end_point)
                return
            if (
                turns
                or self._changed
                or self.model_time_s >= self.sample_log.newest_time_s + _REST_SAMPLE_INTERVAL_S
            ):
                self._store_sample(self.model_time_s, demand)
                self._changed = turns
            if not turns:
                return
            self._k += 1
            self._advance_spindle()

    def _advance_spindle(self) -> None:
        """Advance the spindle to the current grid point, so that its values can be sampled."""
        if self.sample_log is not None and (self._turned[0] or not self.spindle.is_at_rest):
            if self.model_time_s > self.spindle.time_s:
                self.spindle.advance_to(self.model_time_s)
            self._turned = self.spindle.speed, self.spindle.counted_revolutions, self.spindle.load_percent

    def _reference(self) -> None:
        if self._homing is not None and self.model_time_s >= self._homing[1]:
            self._homing[0].reference()
            self._homing = None
            self.setpoint_queue.reset_to_position(self._readings())
