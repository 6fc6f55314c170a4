"""Manual motion of one axis: a jog while its lease is renewed, or a step of a given length.

The queued setpoints always end with the stop that follows an expired lease. They consist of ramps, which
are phases of constant acceleration; the last ramp ends at rest. A controller with its own planner uses its
own jog function.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from core.block_ports import BlockController
from core.executor.hand_motion.jog_line import (
    SOFT_LIMIT_MARGIN,
    Direction,
    FloatArray,
    JogLine,
    Ramp,
    get_distance_to_limit,
    is_not_unit_vector,
)
from core.executor.hand_motion.jog_ramps import POSITION_TOLERANCE, plan_jog_ramps, plan_step_ramps
from core.executor.machine_context import MachineContext
from core.machine.machine_model import Axis
from core.message import Message
from core.ports import DriverError, is_queue_finished

_UNHOMED_SPEED_FRACTION = 0.1  # fraction of the manual rapid for an axis that is not homed
MAX_LEASE_S = 1.0  # s, the longest lease that is accepted
_MAX_STEP = 2.54  # mm (.1 in) or degrees, the longest step
_STEP_ROUNDING = 1e-9
_MARGINS = (0.0, 0.002, 0.02)  # s added to the start for the time between reading the clock and queueing


class Jogger:
    """Manual motion of one axis, either while a lease lasts or by one step of a given length."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._axis = -1
        self._line: JogLine | None = None  # the line of the present or the last motion
        self.is_stepping = False
        self._short = False  # the step was stopped before its end
        self.target_position: float | None = None  # target of the handwheel, or None
        self.is_stopping = False  # the axis is braking after a stop
        self.is_testing = False  # a drive test is running
        self.completed_test_count = 0  # number of completed drive tests
        self.button_input = ""  # input of the button that must stay pressed

    @property
    def axis_name(self) -> str:
        """Return the name of the moving axis, or an empty string if no axis moves."""
        return self._context.machine.axes[self._axis].name if self._axis >= 0 else ""

    def find_jog_refusal_reason(
        self, name: str, velocity: float, lease_s: float, direction: Direction | None = None
    ) -> str:
        """Return why this jog is refused, or an empty string if it may start or continue."""
        if why := self.find_axis_refusal_reason(name) or self._find_direction_refusal(name, direction):
            return why
        if not (math.isfinite(velocity) and math.isfinite(lease_s)) or lease_s <= 0.0:
            return "a jog needs a velocity and a watchdog time greater than 0"
        if self.is_testing:
            return Message("the drive test of {axis} is still running", axis=self.axis_name)
        if self.is_stepping:
            return Message("the jog step of {axis} is not finished", axis=self.axis_name)
        return self._barred(name)

    def find_step_refusal_reason(
        self, name: str, distance: float, speed: float, direction: Direction | None = None
    ) -> str:
        """Return why this step is refused, or an empty string if it may start."""
        if why := self.find_axis_refusal_reason(name) or self._find_direction_refusal(name, direction):
            return why
        if not math.isfinite(speed) or speed <= 0.0:
            return "a jog step needs a speed above 0"
        if not 0.0 < abs(distance) <= _MAX_STEP + _STEP_ROUNDING:
            return Message(
                "a jog step must be above 0 and at most {longest_step}, not {distance}",
                longest_step=f"{_MAX_STEP:g}",
                distance=f"{distance:g}",
            )
        if self.axis_name:
            return Message("{axis} is still moving; wait until its jog step is finished", axis=self.axis_name)
        return self._barred(name) or self._find_travel_refusal(name, distance, direction)

    def _find_direction_refusal(self, name: str, direction: Direction | None) -> str:
        """Return why the axis cannot be jogged along a direction, or an empty string if it can."""
        context = self._context
        if self.axis_name == name and not self._line_of(name, direction).has_same_direction(self._line):
            return Message("{axis} is still being jogged", axis=self.axis_name)
        if direction is None:
            return ""
        if not set("XYZ") <= {axis.name for axis in context.machine.axes} or is_not_unit_vector(direction):
            return "jogging in a tilted plane needs the axes X, Y and Z and a direction vector of length 1"
        if not all(context.axis_sample.homed):
            return "home all axes before jogging in a tilted plane"
        return ""

    def _line_of(self, name: str, along: Direction | None = None) -> JogLine:
        axes = self._context.machine.axes
        if along is not None:
            return JogLine.from_direction(axes, along)
        return JogLine.from_axis(axes, self._context.ports.axes.axes.index(name))

    def find_axis_refusal_reason(self, name: str) -> str:
        """Return why an axis does not exist or cannot be jogged, or an empty string if it can be jogged."""
        machine = self._context.machine
        known = name in {axis.name for axis in machine.axes}
        there = known and (name != "C" or machine.is_c_enabled or machine.kind != "lathe")
        return "" if there else Message("this machine has no axis {name} to jog", name=name)

    def _barred(self, name: str) -> str:
        context = self._context
        if context.station_signals.is_hold_requested:
            return "feed hold is pressed"
        if self.axis_name and self.axis_name != name:
            return Message("{axis} is still being jogged", axis=self.axis_name)
        return self.find_spindle_turning_reason(name) or self.request_c_axis_mode(name)

    def find_spindle_turning_reason(self, name: str) -> str:
        """Return why C cannot move because the spindle is turning, or an empty string if C can move.

        This applies only if the spindle is the C axis.
        """
        context = self._context
        turns = context.spindle.is_requested or not context.spindle.is_stopped
        if name == "C" and context.machine.is_spindle_c_axis and turns:
            return "the C axis is the spindle, and the spindle is turning; stop the spindle first"
        return ""

    def request_c_axis_mode(self, name: str) -> str:
        """Start the change to C-axis mode if necessary; return why C cannot move yet.

        The result is an empty string if C can move.
        """
        spindle = self._context.spindle
        if (
            name != "C"
            or not self._context.machine.is_spindle_c_axis
            or spindle.engage_c_axis(should_orient=False)
        ):
            return ""
        if spindle.is_c_refused_by_turning:
            return (
                "the spindle drive reports that the spindle is still turning; release the key or button and "
                "jog again when the spindle has stopped"
            )
        return "the spindle drive is switching to C-axis mode; release the key or button and jog again in 2 s"

    def _find_travel_refusal(self, name: str, distance: float, direction: Direction | None) -> str:
        """Return why a step is refused because of the travel limits, or an empty string if it is not.

        A step that would exceed the limits is never shortened.
        """
        line, sample = self._line_of(name, direction), self._context.axis_sample
        homed = all(sample.homed[place] for place, _, _ in line.iter_moving_axes())
        if not homed or abs(distance) <= line.get_distance_to_limit(sample.demand, distance) + _STEP_ROUNDING:
            return ""
        return make_travel_end_message(name, distance)

    def start_step(
        self, name: str, distance: float, speed: float, direction: Direction | None = None
    ) -> None:
        """Start a step from rest. Raises DriverError if the setpoints are rejected."""
        line = self._line_of(name, direction)
        top = min(speed, self._max_line_speed(line))
        self._splice(line, lambda _start, _p, _v: plan_step_ramps(distance, top, line.max_acceleration))
        self._axis, self.is_stepping = self._context.ports.axes.axes.index(name), True

    def start_or_renew_jog(
        self, name: str, velocity: float, lease_s: float, direction: Direction | None = None
    ) -> bool:
        """Start or renew a jog; return False if no travel remains in that direction.

        ``direction`` is the direction of an axis of a tilted plane, in machine coordinates. Raises
        DriverError if the setpoints are rejected.
        """
        context, line = self._context, self._line_of(name, direction)
        homed = all(context.axis_sample.homed[place] for place, _, _ in line.iter_moving_axes())
        speed = math.copysign(min(abs(velocity), self._max_line_speed(line)), velocity)
        until = context.now + min(lease_s, MAX_LEASE_S)

        def plan_ramps(start: float, p: FloatArray, v: FloatArray) -> list[Ramp]:
            room = line.get_distance_to_limit(p, speed) if homed else math.inf
            return plan_jog_ramps(
                line.project_on_line(v), speed, line.max_acceleration, max(until - start, 0.0), room
            )

        moves = self._splice(line, plan_ramps)
        if moves:
            self._axis, self.is_stopping = context.ports.axes.axes.index(name), False
        return moves

    def _max_line_speed(self, line: JogLine) -> float:
        """Return the highest jog speed along the line."""
        homed = self._context.axis_sample.homed
        return min(
            self.get_max_jog_speed(axis, homed[place]) / abs(share)
            for place, axis, share in line.iter_moving_axes()
        )

    def run_drive_test(self, name: str, make_ramps: Callable[[float, float, float], list[Ramp]]) -> bool:
        """Start or continue a drive test; return False if no motion of the test remains.

        Raises DriverError if the driver rejects the setpoints.
        """
        index = self._context.ports.axes.axes.index(name)
        plays = self._splice_axis(index, make_ramps)
        if plays:
            self._axis, self.is_testing = index, True
        return plays

    def set_test_fully_queued(self, is_queued: bool) -> None:
        """Store whether the complete drive test has been queued.

        If it is stopped before that, its end is logged as a premature stop.
        """
        self._short = not is_queued

    def jog_to_target(self, name: str, target: float, speed: float, lease_s: float) -> bool:
        """Start or renew a jog that stops at ``target``; return False if no travel remains.

        Raises DriverError if the setpoints are rejected.
        """
        context = self._context
        index = context.ports.axes.axes.index(name)
        axis, until = context.machine.axes[index], context.now + min(lease_s, MAX_LEASE_S)
        top = min(speed, self.get_max_jog_speed(axis, context.axis_sample.homed[index]))

        def plan_ramps(start: float, p: float, v: float) -> list[Ramp]:
            distance = target - p
            if abs(distance) <= POSITION_TOLERANCE:
                return []
            room = get_distance_to_limit(axis, p, distance)
            return plan_jog_ramps(
                v,
                math.copysign(top, distance),
                axis.max_acceleration,
                max(until - start, 0.0),
                min(abs(distance), room),
            )

        moves = self._splice_axis(index, plan_ramps)
        if moves:
            self._axis, self.is_stopping = index, False
        return moves

    def follow_target(
        self, name: str, make_ramps: Callable[[float, float, float], list[Ramp]], target: float
    ) -> None:
        """Move to the handwheel's target from the current motion. Raises DriverError if a driver fails."""
        index = self._context.ports.axes.axes.index(name)
        if self._splice_axis(index, make_ramps):
            self._axis, self.target_position, self.is_stopping = index, target, False

    def stop(self) -> None:
        """Stop the jog. A step that ends early is logged when the axis is at rest."""
        line = self._line
        if self._axis < 0 or line is None:
            return
        self._short = self._short or self.is_stepping or self.is_testing
        self._splice(
            line,
            lambda _start, _p, v: plan_jog_ramps(
                line.project_on_line(v), 0.0, line.max_acceleration, 0.0, math.inf
            ),
        )
        self.is_stepping, self.target_position, self.is_stopping = False, None, True

    def stop_if_button_released(self) -> None:
        """Stop the jog if its button is released or unreadable. Raises DriverError if a driver fails."""
        if self.button_input and not self._context.is_button_pressed(self.button_input):
            self.button_input = ""
            self.stop()

    def finish_if_at_rest(self) -> bool:
        """Return whether the jog has come to rest. If so, finish and log it."""
        axes = self._context.ports.axes
        horizon = axes.horizon()
        if not is_queue_finished(horizon, axes.now()):
            return False
        self.finish_jog()
        return True

    def finish_jog(self) -> None:
        """Finish the jog of an axis at rest; log a completed test, or a step that was stopped early."""
        if self._short and self.is_testing:
            self._context.log_text(
                "refused",
                Message("the drive test of {axis} was stopped before it was finished", axis=self.axis_name),
            )
        elif self._short:
            self._context.log_text(
                "refused",
                Message("the jog step of {axis} was stopped before it was finished", axis=self.axis_name),
            )
        elif self.is_testing:
            self.completed_test_count += 1
            self._context.log_text("test", Message("{axis} drive test", axis=self.axis_name))
        self.clear_jog()

    def clear_jog(self) -> None:
        """Clear the jog because the axis is at rest or another function has stopped it."""
        self._axis, self.is_stepping, self._short, self.is_testing = -1, False, False, False
        self.target_position, self.is_stopping, self.button_input = None, False, ""

    def _splice_axis(self, index: int, ramps: Callable[[float, float, float], list[Ramp]]) -> bool:
        """Queue the ramps of one axis, starting from its current position and velocity."""
        line = JogLine.from_axis(self._context.machine.axes, index)
        return self._splice(line, lambda start, p, v: ramps(start, float(p[index]), float(v[index])))

    def _splice(self, line: JogLine, ramps: Callable[[float, FloatArray, FloatArray], list[Ramp]]) -> bool:
        """Queue the ramps that the function ``ramps`` returns for (start time, positions, velocities).

        If the change reaches the driver too late, a later start time is tried. Returns False if there are
        no ramps. Raises DriverError if the setpoints are rejected.
        """
        axes = self._context.ports.axes
        for margin in _MARGINS:
            start = axes.now() + axes.commit + margin
            p, v = (np.asarray(each) for each in axes.demand_at(start))
            pieces = ramps(start, p, v)
            if not pieces:
                return False
            try:
                axes.splice(line.make_setpoints(start, p, pieces))
            except DriverError:
                if margin == _MARGINS[-1] or axes.now() + axes.commit <= start:
                    raise
            else:
                self._line = line
                return True
        return False

    def get_max_jog_speed(self, axis: Axis, is_homed: bool) -> float:
        """Return the highest jog speed of an axis; an axis that is not homed has a lower limit."""
        endless = axis.travel is None or axis.is_rotary
        rapid = axis.max_speed if endless else min(axis.max_speed, self._context.machine.limits.manual_rapid)
        return rapid if is_homed else _UNHOMED_SPEED_FRACTION * rapid


def make_travel_end_message(name: str, direction: float) -> str:
    """Return the message for an axis that is at the end of its travel."""
    return Message(
        "{name} is at the end of its travel in the {ending} direction",
        name=name,
        ending="+" if direction > 0.0 else "−",
    )


# --- jog by the controller ------------------------------------------------------------------------------


def create_jogger(context: MachineContext) -> Jogger:
    """Create a jogger that queues setpoints, or one that uses the controller's own jog function."""
    return Jogger(context) if context.ports.blocks is None else BlockJogger(context, context.ports.blocks)


class _PendingJog(NamedTuple):
    """A jog that was requested while the previous jog was still stopping.

    ``lease_end_s`` is the end of its lease.
    """

    axis: str
    velocity: float
    lease_end_s: float


class BlockJogger(Jogger):
    """A jogger that uses the jog function of a controller with its own planner.

    It refuses the same requests as ``Jogger``. The controller accepts a jog only after the previous one has
    ended. A jog requested before that starts afterwards, but only if its key is still pressed.
    """

    def __init__(self, context: MachineContext, controller: BlockController) -> None:
        super().__init__(context)
        self._sink = controller
        self._pressed: _PendingJog | None = None

    def find_jog_refusal_reason(
        self, name: str, velocity: float, lease_s: float, direction: Direction | None = None
    ) -> str:
        """Return why this jog is refused, or an empty string if it may start or continue."""
        return super().find_jog_refusal_reason(name, velocity, lease_s, direction) or (
            "" if self.axis_name else self._unready()
        )

    def find_step_refusal_reason(
        self, name: str, distance: float, speed: float, direction: Direction | None = None
    ) -> str:
        """Return why this step is refused, or an empty string if it may start."""
        return super().find_step_refusal_reason(name, distance, speed, direction) or self._unready()

    def _find_direction_refusal(self, name: str, direction: Direction | None) -> str:
        """Return why the axis cannot be jogged along a direction, or an empty string if it can."""
        return (
            ""
            if direction is None
            else Message("{name}: the controller can jog only its own axes", name=name)
        )

    def start_step(
        self, name: str, distance: float, speed: float, direction: Direction | None = None
    ) -> None:
        """Start a step from rest. Raises DriverError if the controller rejects it."""
        assert direction is None  # otherwise the request was refused
        index, top = self._speed(name, speed)
        self._sink.move_to_target(name, self._context.axis_sample.demand[index] + distance, top)
        self._axis, self.is_stepping = index, True

    def start_or_renew_jog(
        self, name: str, velocity: float, lease_s: float, direction: Direction | None = None
    ) -> bool:
        """Start or renew a jog; return False if no travel remains in that direction.

        Raises DriverError if the controller rejects the jog.
        """
        assert direction is None  # otherwise the request was refused
        if self.is_stopping:
            self._pressed = _PendingJog(name, velocity, self._context.now + min(lease_s, MAX_LEASE_S))
            return True
        index, top = self._speed(name, abs(velocity))
        axis = self._context.machine.axes[index]
        limits = axis.travel if self._context.axis_sample.homed[index] else None
        if limits is not None:
            limits = limits[0] + SOFT_LIMIT_MARGIN, limits[1] - SOFT_LIMIT_MARGIN
        moves = self._sink.start_jog(name, math.copysign(top, velocity), min(lease_s, MAX_LEASE_S), limits)
        if moves:
            self._axis = index
        return moves

    def jog_to_target(self, name: str, target: float, speed: float, lease_s: float) -> bool:
        """Start or renew a jog that stops at ``target``; return False if no travel remains.

        Raises DriverError if the controller rejects the jog.
        """
        index, top = self._speed(name, speed)
        here = self._context.axis_sample.demand[index]
        limits = (min(here, target), max(here, target))
        moves = self._sink.start_jog(
            name, math.copysign(top, target - here), min(lease_s, MAX_LEASE_S), limits
        )
        if moves:
            self._axis = index
        return moves

    def stop(self) -> None:
        """Stop the jog. A step that ends early is logged when the axis is at rest."""
        if self._axis < 0:
            return
        self._short = self._short or self.is_stepping
        self.is_stepping, self.is_stopping, self._pressed = False, True, None
        self._sink.stop_jog()

    def finish_if_at_rest(self) -> bool:
        """Return whether the jog is at rest and no other jog is waiting."""
        if not self._sink.state().is_at_rest:
            return False
        pressed, button = self._pressed, self.button_input
        self.finish_jog()
        if pressed is None or pressed.lease_end_s <= self._context.now or self._unready():
            return True
        self.button_input = button
        return not self.start_or_renew_jog(
            pressed.axis, pressed.velocity, pressed.lease_end_s - self._context.now
        )

    def clear_jog(self) -> None:
        """Clear the active jog and the jog that is waiting to start after it."""
        super().clear_jog()
        self._pressed = None

    def _speed(self, name: str, speed: float) -> tuple[int, float]:
        index = self._context.ports.axes.axes.index(name)
        axis = self._context.machine.axes[index]
        return index, min(speed, self.get_max_jog_speed(axis, self._context.axis_sample.homed[index]))

    def _unready(self) -> str:
        state = self._sink.state()
        return state.start_refusal_reason or (
            "" if state.is_at_rest else "the controller is still moving the axes"
        )
