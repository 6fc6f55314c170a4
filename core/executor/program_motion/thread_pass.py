"""Thread pass that follows the measured spindle angle, by setpoints or by electronic gearing.

The axis is in step if s = lead · (revolutions - index), where s is the distance along Z from the start of
the pass and the encoder counts the revolutions. Every pass therefore enters the thread at the same angle at
any speed. With setpoints, the queue always contains the complete pass with pull-out and stop, based on the
predicted spindle angle. Each tick corrects the queue from one commit time ahead.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence

import numpy as np

from core.executor.program_motion.spindle_angle import SpindleAnglePredictor
from core.executor.program_motion.thread_curve import calculate_spindle_revolutions
from core.executor.program_motion.thread_path import Phases, ThreadPath
from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits
from core.ports import AxisSink, Cam, DriverError, GearState, MotionSegments, SpindleGear, StopMode

_BLEND = 0.01  # s for the correction of a deviation
_MAX_CORRECTION_S = 0.16  # s, the longest correction
_EARLY_START_S = 0.01  # s between the first plan and the start, for corrections of the start
_SHARE = 0.7  # fraction of the acceleration for the run-up; the rest is for corrections
_BRAKING_DELAY_S = 0.002  # additional s for braking, which has only one attempt
_MAX_ATTEMPTS = 3
_CORRECTION_SPEED_FACTOR = 1.0005  # fraction of the maximum speed that corrections may use
_AT_START = 1e-6  # mm
_ALLOWED_DEVIATION = 0.01  # revolutions, permitted deviation between axis and spindle
_log = logging.getLogger(__name__)
# fraction of the acceleration; the rest is for a spindle that turns faster than predicted
_GEARED_SHARE = 0.9
_CHANGE_LEAD_S = 0.01  # s between a plan and its first change, doubled if too short
_CHANGE_LEADS_S = tuple(_CHANGE_LEAD_S * 2**attempt for attempt in range(4))
# up to 0.64 s, because a later index costs nothing at rest
_FROM_REST = tuple(_CHANGE_LEAD_S * 2**attempt for attempt in range(7))
_SPEED_CHANGE_FRACTION = 0.005  # relative speed change after which the rest is planned again
_MIN_SPINDLE_SPEED = 0.1  # rev/s; a slower spindle needs no other plan
_ROUNDING = 1e-9  # turns
_START_ERROR_CODES = {"late", "broken-path"}  # error codes of a driver if the pass is about to start


class SynchronizedThreadPass:
    """A thread pass that follows the spindle, and records its largest deviation from synchronism."""

    def __init__(
        self,
        axes: AxisSink,
        limits: MotionLimits,
        spindle_angle: SpindleAnglePredictor,
        blocks: Sequence[Block],
    ) -> None:
        self._axes = axes
        self._turns = spindle_angle
        self._path = ThreadPath.from_blocks(blocks, limits)
        self.blocks = tuple(blocks)
        self._sign = 1.0  # direction of the spindle
        self._stopped = False
        self._reported = False
        self.max_deviation = 0.0  # largest deviation in revolutions between axis and spindle while in step

    def get_block_at_revolution(self, revolutions: float) -> Block:
        """Return the thread block that is cut ``revolutions`` revolutions after the start of the pass."""
        cut = [self.blocks[0], *(block for block in self.blocks[1:] if block.continues)]
        for block in cut:
            revolutions -= calculate_spindle_revolutions(block)
            if revolutions < 0.0:
                return block
        return cut[-1]

    @property
    def is_fully_queued(self) -> bool:
        """Return whether the queue contains the complete pass."""
        return not self._stopped

    def detect_lost_step(self) -> bool:
        """Return whether the axis has lost synchronism with the spindle, which may spoil the thread.

        The result is True only once per pass.
        """
        before, self._reported = self._reported, self.max_deviation > _ALLOWED_DEVIATION
        return self._reported and not before


class ThreadPass(SynchronizedThreadPass):
    """A thread pass that is executed by setpoints.

    The thread is followed by its pull-out or by a straight rapid in X. The methods that plan the pass, such
    as ``start_pass``, raise AlarmError if the spindle does not turn or has no encoder, and DriverError if
    the moves cannot be queued in time.
    """

    def __init__(
        self,
        axes: AxisSink,
        limits: MotionLimits,
        spindle_angle: SpindleAnglePredictor,
        blocks: Sequence[Block],
    ) -> None:
        super().__init__(axes, limits, spindle_angle, blocks)
        self._top = limits.vmax[1]
        self._lead, self._ramp = self._path.lead_mm, _SHARE * self._path.path_acceleration
        self._index = 0.0  # unsigned revolutions at which s = 0 is in step
        self._begins = 0.0, 0.0  # start time of the run-up, and its final speed
        self._leaves = math.inf  # time at which the thread itself ends
        self._ends = math.inf
        self._cost = 0.0
        self._free = False  # too close to the end for another plan

    @property
    def end_time_s(self) -> float:
        """Return the planned time at which the pass comes to rest, in seconds."""
        return self._ends

    def get_block(self, now: float) -> Block:
        """Return the block that is executed at time ``now``."""
        if now >= self._leaves:
            return self.blocks[-1]
        return (
            self.get_block_at_revolution(self._demand(now)[0] / self._lead)
            if len(self.blocks) > 1
            else self.blocks[0]
        )

    def start_pass(self) -> None:
        """Select the index pulse and queue the pass from rest."""
        now = self._axes.now()
        # Nothing has started yet, so a pass that cannot be queued starts on resume.
        self._stopped, self._ends, self._leaves, self._index = True, now, math.inf, 0.0
        turns, speed = self._spindle_state(now)
        v = min(self._lead * speed, self._top)
        earliest = now + self._axes.commit + _EARLY_START_S + 0.5 * v / self._ramp
        self._index = math.ceil(turns + speed * (earliest - now) - 1e-9)
        for _ in range(_MAX_ATTEMPTS):
            if self._replan():
                self._stopped = False
                return
        raise DriverError("the thread moves could not be queued in time", "late")

    def correct_motion(self) -> None:
        """Correct the setpoints that are later than the commit time, and measure the deviation.

        The function is called once per tick.
        """
        now = self._axes.now()
        if self._stopped or now >= self._leaves or self._turns.predict_angle(now) is None:
            return  # without encoder data the queued pass is the best choice
        self._measure(now)
        if self._free:
            return
        self._replan()

    def _replan(self) -> bool:
        """Replan and queue the pass; return False if it is too late, in which case the old plan remains."""
        now = self._axes.now()
        t = now + self._axes.commit + 1.5 * self._cost
        try:
            self._queue(t)
        except DriverError:
            after = self._axes.now()
            if after + self._axes.commit <= t:
                raise
            self._cost = after - now
            return False
        self._cost = max(min(self._axes.now() - now, 0.2), 0.8 * self._cost)
        return True

    def cancel_unstarted_pass(self) -> None:
        """Cancel the pass if it has not started to move. A pass that already moves is completed."""
        t = self._axes.now() + self._axes.commit + max(1.5 * self._cost, _BRAKING_DELAY_S)
        if self._stopped or t >= self._begins[0]:
            return
        place, _ = self._axes.demand_at(t)
        self._axes.splice(MotionSegments.make_standstill(t, place))
        self._stopped, self._ends, self._leaves = True, t, math.inf

    def restart_pass(self) -> None:
        """Start the pass again at another index pulse, if a hold canceled it before its first motion."""
        s, v = self._demand(self._axes.now())
        if self._stopped and abs(s) <= _AT_START and v == 0.0:
            self.start_pass()

    def stop_in_thread(self) -> None:
        """Stop along the thread, unless the pull-out has started."""
        t = self._axes.now() + self._axes.commit + max(1.5 * self._cost, _BRAKING_DELAY_S)
        s, v = self._demand(t)
        if (
            self._stopped
            or t >= self._leaves
            or s + 0.5 * v * v / self._path.path_acceleration >= self._path.length_mm
        ):
            return
        self._axes.splice(self._path.make_stop_setpoints(t, s, v))
        self._stopped, self._ends, self._leaves = True, t + v / self._path.path_acceleration, math.inf

    def _queue(self, t: float) -> None:
        s, v = self._demand(t)
        lead_in = self._plan_run_up(t) if s <= _AT_START and v <= 0.0 else None
        if lead_in is None:
            lead_in = self._plan_blend(t, s, v)
        if lead_in is None:
            return
        segments, leaves = self._path.plan_remaining_pass(t, s, v, lead_in)
        if np.abs(segments.velocities[:, 1]).max() > self._top * _CORRECTION_SPEED_FACTOR:
            return  # The pass is faster than the axis, so the axis lags and the deviation is reported.
        self._axes.splice(segments)
        self._leaves, self._ends = leaves, _end(segments)

    def _plan_run_up(self, t: float) -> Phases | None:
        """Return the phases of a wait and an acceleration that bring the axis in step with the spindle.

        The result is None if it is too late to start.
        """
        starts, v = self._begins = self._find_start()
        if starts < t:
            return None
        return [(starts - t, 0.0), (v / self._ramp, self._ramp)]

    def _plan_blend(self, t: float, s: float, v: float) -> Phases | None:
        """Return two phases that bring the axis back in step with the spindle without reversing.

        The result is None in two cases: the phases do not fit before the end of the full-depth thread, or
        the axis cannot accelerate enough.
        """
        path, time = self._path, _BLEND
        while time <= _MAX_CORRECTION_S:
            goal, speed, rest = self._target(t + time)
            if goal >= path.find_full_depth_end(speed):
                self._free = True
                return None
            half = 0.5 * time
            gain, ahead = (speed - v) / half, (goal - s - v * time) / (half * half)
            first, second = ahead - 0.5 * gain, 1.5 * gain - ahead
            onwards = min(v + first * half, speed) >= 0.0 or v < 0.0
            if onwards and max(abs(first), abs(second)) <= path.path_acceleration:
                return [(half, first), (half, second), *rest]
            time *= 2.0
        return None

    def _target(self, t: float) -> tuple[float, float, Phases]:
        """Return the required s and speed at time ``t``, and the remaining phases of the run-up."""
        starts, v = self._begins
        into = t - starts
        if into * self._ramp < v:
            into = max(into, 0.0)
            left = (v / self._ramp) - into
            return 0.5 * self._ramp * into * into, self._ramp * into, [(left, self._ramp)]
        turns, speed = self._spindle_state(t)
        return self._lead * (turns - self._index), self._lead * speed, []

    def _find_start(self) -> tuple[float, float]:
        """Return the start time of the run-up and the speed that the run-up reaches.

        The run-up starts half its duration before the index pulse. An axis that accelerates from rest lags
        an axis already in motion by v²/2a, so it must start v/2a earlier.
        """
        at = self._axes.now()
        for _ in range(3):
            turns, speed = self._spindle_state(at)
            at += (self._index - turns) / speed
        v = min(self._lead * speed, self._top)
        return at - 0.5 * v / self._ramp, v

    def _spindle_state(self, t: float) -> tuple[float, float]:
        """Return revolutions and revolutions per second at ``t``, positive in the direction of rotation."""
        state = self._turns.predict_turning_angle(t)
        if self._index == 0.0:
            self._sign = math.copysign(1.0, state[1])
        return self._sign * state[0], self._sign * state[1]

    def _measure(self, now: float) -> None:
        """Record the deviation of the setpoints from the spindle when the axis is at speed.

        The deviation is in revolutions.
        """
        s, v = self._demand(now)
        turns, speed = self._spindle_state(now)
        if v < 0.9 * self._lead * speed:
            return
        self.max_deviation = max(self.max_deviation, abs(s / self._lead - (turns - self._index)))

    def _demand(self, t: float) -> tuple[float, float]:
        (_, z, _), (_, v, _) = self._axes.demand_at(t)
        return self._path.find_position_and_speed(z, v)


def _end(segments: MotionSegments) -> float:
    return float(segments.start_times_s[-1] + segments.durations_s[-1])


class GearedThreadPass(SynchronizedThreadPass):
    """A thread pass that is planned as an electronic cam, along which the axes follow the spindle.

    The axis is in step if s = lead · revolutions, counted from the index pulse that is selected at the
    start. The cam also contains run-up, pull-out and stop. Only these depend on the spindle speed, because
    of the axis limits. ``start_pass`` and ``restart_pass`` raise AlarmError if the spindle does not turn or
    has no encoder, and DriverError if the moves cannot be queued in time.
    """

    def __init__(
        self,
        axes: AxisSink,
        gear: SpindleGear,
        limits: MotionLimits,
        spindle_angle: SpindleAnglePredictor,
        blocks: Sequence[Block],
    ) -> None:
        super().__init__(axes, limits, spindle_angle, blocks)
        self._gear = gear
        self._zero = 0.0
        self._speed = 0.0  # rev/s for which the cam is planned
        self._ramp = 0.0  # revolutions of the run-up
        self._leaves = math.inf  # revolutions at which the thread itself ends

    @property
    def end_time_s(self) -> float:
        """Return the time in seconds at which the pass will come to rest at the current spindle speed."""
        return self._axes.horizon()

    def get_block(self, _now: float) -> Block:
        """Return the block being executed; the given time is not used."""
        geared = self._gear.geared()
        if geared is None:
            return self.blocks[0] if self._stopped else self.blocks[-1]
        return (
            self.blocks[-1]
            if geared.cam_revolutions >= self._leaves
            else self.get_block_at_revolution(geared.cam_revolutions)
        )

    def start_pass(self) -> None:
        """Select the index pulse and send the pass to the driver, from rest."""
        self._stopped = True  # Nothing has started yet, so a pass that cannot be queued starts on resume.
        for early in _FROM_REST:
            if self._engage_from_rest(early):
                self._stopped = False
                return
        raise DriverError("the thread moves could not be queued in time", "late")

    def correct_motion(self) -> None:
        """Measure the deviation, and plan the remaining pass again if the spindle speed has changed.

        The function is called once per tick.
        """
        geared = self._gear.geared()
        state = self._turns.predict_angle(self._axes.now())
        if self._stopped or geared is None or state is None:
            return
        if self._ramp < geared.cam_revolutions < self._leaves:
            self.max_deviation = max(self.max_deviation, abs(geared.lag_revolutions))
        speed = self._sign * state[1]
        if abs(speed - self._speed) > _SPEED_CHANGE_FRACTION * self._speed and speed > _MIN_SPINDLE_SPEED:
            self._replan_for_speed(speed, geared)

    def cancel_unstarted_pass(self) -> None:
        """Cancel the pass if it has not started to move. A pass that already moves is completed."""
        t = self._axes.now() + self._axes.commit + _CHANGE_LEAD_S
        geared = self._gear.geared()
        if self._stopped or geared is None or self._reachable_position(geared, t) >= -self._ramp:
            return
        place, _ = self._axes.demand_at(t)
        try:
            self._axes.splice(MotionSegments.make_standstill(t, place))
        except DriverError as error:
            if error.code not in _START_ERROR_CODES:
                raise
            return  # the pass ends after its pull-out
        self._stopped = True

    def restart_pass(self) -> None:
        """Start the pass again at another index pulse, if a hold canceled it before its first motion."""
        (_, z, *_), _ = self._axes.demand_at(self._axes.now())
        if self._stopped and self._gear.geared() is None and abs(z - self._path.start_z) <= _AT_START:
            self.start_pass()

    def stop_in_thread(self) -> None:
        """Stop along the thread, unless only the X retract remains."""
        if self._stopped or self._gear.geared() is None:
            return
        self._axes.stop(StopMode.RAMP_HOLD)
        self._stopped = True

    def _engage_from_rest(self, early: float) -> bool:
        """Plan the complete pass from rest; return False if it was too late to start."""
        state = self._turns.predict_turning_angle(self._axes.now())
        self._sign, self._speed = math.copysign(1.0, state[1]), abs(state[1])
        self._ramp = self._run_up_revolutions(self._speed)
        first = self._sign * state[0] + self._speed * (self._axes.commit + early)
        self._zero = self._sign * math.ceil(first + self._ramp - _ROUNDING)
        try:
            self._send_from_rest(self._speed, self._ramp)
        except DriverError as error:
            if error.code != "late":
                raise
            return False
        return True

    def _run_up_revolutions(self, speed: float) -> float:
        """Return the number of revolutions from the start of the run-up to the index pulse.

        An axis that accelerates from rest lags an axis already in motion by v²/2a. It must therefore start
        v/2a earlier, which is half of its run-up.
        """
        return 0.5 * self._path.lead_mm * speed**2 / (_GEARED_SHARE * self._path.path_acceleration)

    def _replan_for_speed(self, speed: float, geared: GearState) -> None:
        """Plan the run-up, or the motion after the thread, again for another spindle speed.

        If the driver rejects the change, it continues with the complete pass that it already has. An axis
        that cannot follow this pass then lags.
        """
        path, ramp = self._path, self._run_up_revolutions(speed)
        for early in _CHANGE_LEADS_S:
            turns = self._reachable_position(geared, self._axes.now() + self._axes.commit + early)
            try:
                if turns < -max(ramp, self._ramp):
                    self._send_from_rest(speed, ramp)
                elif turns > self._ramp and path.lead_mm * turns < self._path_per_revolution(
                    speed
                ).find_full_depth_end(path.lead_mm):
                    self._send_path(turns, path.lead_mm * turns, path.lead_mm, speed, [])
            except DriverError as error:
                if error.code == "late":
                    continue
                _log.info("a thread pass goes on as planned for another speed: %s", error)
            return

    def _send_from_rest(self, speed: float, ramp: float) -> None:
        """Send the complete path, which starts from rest ``ramp`` revolutions before the index pulse.

        Raises DriverError if the driver rejects the path.
        """
        self._send_path(-ramp, 0.0, 0.0, speed, [(2.0 * ramp, 0.5 * self._path.lead_mm / ramp)])
        self._ramp = ramp

    def _send_path(self, revolutions: float, s: float, v: float, speed: float, run_up: Phases) -> None:
        """Send the path from ``revolutions`` on, where the axis is at ``s`` with ``v`` mm per revolution.

        Raises DriverError if the driver rejects the path; the previous path then remains active.
        """
        path, leaves = self._path_per_revolution(speed).plan_remaining_pass(revolutions, s, v, run_up)
        self._gear.mesh(Cam(self._zero, self._sign, path, self._path.make_retract()))
        self._leaves, self._speed = leaves, speed

    def _path_per_revolution(self, speed: float) -> ThreadPath:
        """Return the path with its limits converted from seconds to spindle revolutions.

        The path ends where it no longer follows the spindle.
        """
        path, share = self._path, _GEARED_SHARE / speed**2
        out = path.retract_x_mm if path.exit_length_mm else path.end_x_mm
        return path._replace(
            path_acceleration=path.path_acceleration * share,
            x_acceleration=path.x_acceleration * share,
            z_acceleration=path.z_acceleration * share,
            retract_x_mm=out,
        )

    def _reachable_position(self, geared: GearState, t: float) -> float:
        """Return the furthest possible cam position at time ``t``, in revolutions.

        The spindle speed is assumed not to rise.
        """
        return geared.cam_revolutions + max(self._speed, geared.speed) * (t - self._axes.now())
