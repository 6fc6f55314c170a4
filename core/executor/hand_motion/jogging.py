"""Jog: manual motion of one axis while its lease is renewed, or by one step of a given length.

The queued setpoints always end in the stop of an expired lease. They consist of ramps, which are phases of
constant acceleration that end at rest. A controller with its own planner uses its own jog function.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from core.executor.hand_motion.jog_line import (
    LIMIT_MARGIN,
    Direction,
    FloatArray,
    JogLine,
    Ramp,
    room_to_limit,
    wrong_direction,
)
from core.executor.machine_context import MachineContext
from core.machine.machine_model import Axis
from core.message import Message
from core.ports import BlockSink, DriverError, at_rest

# --- setpoints of one axis ------------------------------------------------------------------------------


_SHORTEST = 1e-12  # s; shorter ramps are dropped
_SAME = 1e-9  # mm or degrees; closer positions count as equal
_UNHOMED = 0.1  # fraction of the manual rapid for an axis that is not homed
LONGEST_LEASE = 1.0  # s, the longest lease that is accepted
_LONGEST_STEP = 2.54  # mm (.1 in) or degrees, the longest step
_STEP_ROUNDING = 1e-9
_MARGINS = (0.0, 0.002, 0.02)  # s added to the start for the time between reading the clock and queueing


def jog_ramps(v0: float, v1: float, a: float, time: float, way: float) -> list[Ramp]:
    """Return ramps from speed ``v0`` to ``v1``, a cruise for the rest of ``time``, and braking to rest.

    If ``way`` (mm) is too short, the jog is slower or ends earlier. The braking distance v0²/2a is always
    used.
    """
    if v0 * v1 < 0.0:
        first = abs(v0) / a
        return [(first, v0, -math.copysign(a, v0)), *jog_ramps(0.0, v1, a, time - first, way)]
    sign = math.copysign(1.0, v1 or v0)
    here, top = abs(v0), abs(v1)
    fastest = math.sqrt(max(here * here / 2.0 + a * max(way, 0.0), 0.0)) if math.isfinite(way) else math.inf
    top = max(min(top, fastest, here + a * max(time, 0.0)), 0.0) if top > here else min(top, fastest)
    change = abs(top - here) / a
    least = change * (here + top) / 2.0 + top * top / (2.0 * a)
    cruise = max(time - change, 0.0) if top > 0.0 else 0.0
    if cruise and math.isfinite(way):
        cruise = min(cruise, max(way - least, 0.0) / top)
    return _ramps(
        (change, v0, sign * math.copysign(a, top - here)),
        (cruise, sign * top, 0.0),
        (top / a, sign * top, -sign * a),
    )


def step_ramps(distance: float, speed: float, a: float) -> list[Ramp]:
    """Return ramps from rest to rest over exactly ``distance``, at ``speed`` at most.

    A short distance has no cruise; its top speed is √(a·|distance|).
    """
    sign, way = math.copysign(1.0, distance), abs(distance)
    top = min(speed, math.sqrt(a * way))
    change = top / a
    return _ramps(
        (change, 0.0, sign * a),
        ((way - top * change) / top, sign * top, 0.0),
        (change, sign * top, -sign * a),
    )


def reach_ramps(v0: float, way: float, top: float, a: float) -> list[Ramp]:
    """Return ramps from speed ``v0`` to rest at exactly the distance ``way``.

    The speed does not exceed ``top`` except while the axis slows down to it. If the target is in the opposite
    direction or within the braking distance, the axis stops first and then returns.
    """
    stop = v0 * abs(v0) / (2.0 * a)
    if v0 * way < 0.0 or abs(stop) > abs(way) + _SAME:
        brake = (abs(v0) / a, v0, -math.copysign(a, v0))
        back = way - stop
        return _ramps(brake, *(step_ramps(back, top, a) if abs(back) > _SAME else ()))
    if abs(way) <= _SAME:
        return []
    sign, here, left = math.copysign(1.0, way), abs(v0), abs(way)
    peak = min(top, math.sqrt(a * left + here * here / 2.0))
    change = abs(peak - here) / a
    cruise = (left - change * (here + peak) / 2.0 - peak * peak / (2.0 * a)) / peak
    return _ramps(
        (change, v0, sign * math.copysign(a, peak - here)),
        (cruise, sign * peak, 0.0),
        (peak / a, sign * peak, -sign * a),
    )


def _ramps(*pieces: Ramp) -> list[Ramp]:
    return [piece for piece in pieces if piece[0] > _SHORTEST]


class Jogger:
    """Jogs one axis, either while a lease lasts or by one step of a given length."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._axis = -1
        self._line: JogLine | None = None  # the line of the present or the last motion
        self.stepping = False
        self._short = False  # the step was stopped before its end
        self.goal: float | None = None  # target of the handwheel, or None
        self.ending = False  # the axis is braking after a stop
        self.testing = False  # a drive test is running
        self.tested = 0  # number of completed drive tests
        self.while_on = ""  # input of the button that must stay pressed

    @property
    def axis(self) -> str:
        """The name of the moving axis, or an empty string."""
        return self._context.machine.axes[self._axis].name if self._axis >= 0 else ""

    def refusal(self, name: str, velocity: float, lease: float, along: Direction | None = None) -> str:
        """Return why this jog is refused, or an empty string if it may start or continue."""
        if why := self.missing(name) or self._astray(name, along):
            return why
        if not (math.isfinite(velocity) and math.isfinite(lease)) or lease <= 0.0:
            return "a jog needs a velocity and a watchdog time greater than 0"
        if self.testing:
            return Message("the drive test of {axis} is still running", axis=self.axis)
        if self.stepping:
            return Message("the jog step of {axis} is not finished", axis=self.axis)
        return self._barred(name)

    def step_refusal(self, name: str, distance: float, speed: float, along: Direction | None = None) -> str:
        """Return why this step is refused, or an empty string if it may start."""
        if why := self.missing(name) or self._astray(name, along):
            return why
        if not math.isfinite(speed) or speed <= 0.0:
            return "a jog step needs a speed above 0"
        if not 0.0 < abs(distance) <= _LONGEST_STEP + _STEP_ROUNDING:
            return Message(
                "a jog step must be above 0 and at most {longest_step}, not {distance}",
                longest_step=f"{_LONGEST_STEP:g}",
                distance=f"{distance:g}",
            )
        if self.axis:
            return Message("{axis} is still moving; wait until its jog step is finished", axis=self.axis)
        return self._barred(name) or self._too_far(name, distance, along)

    def _astray(self, name: str, along: Direction | None) -> str:
        """Return why the axis cannot be jogged along this direction, or an empty string."""
        context = self._context
        if self.axis == name and not self._line_of(name, along).same(self._line):
            return Message("{axis} is still being jogged", axis=self.axis)
        if along is None:
            return ""
        if not set("XYZ") <= {axis.name for axis in context.machine.axes} or wrong_direction(along):
            return "jogging in a tilted plane needs the axes X, Y and Z and a direction vector of length 1"
        if not all(context.sample.homed):
            return "home all axes before jogging in a tilted plane"
        return ""

    def _line_of(self, name: str, along: Direction | None = None) -> JogLine:
        axes = self._context.machine.axes
        if along is not None:
            return JogLine.along(axes, along)
        return JogLine.of_axis(axes, self._context.ports.axes.axes.index(name))

    def missing(self, name: str) -> str:
        """Return why this axis does not exist or cannot be jogged, or an empty string."""
        machine = self._context.machine
        known = name in {axis.name for axis in machine.axes}
        there = known and (name != "C" or machine.c_enabled or machine.kind != "lathe")
        return "" if there else Message("this machine has no axis {name} to jog", name=name)

    def _barred(self, name: str) -> str:
        context = self._context
        if context.signals.hold:
            return "feed hold is pressed"
        if self.axis and self.axis != name:
            return Message("{axis} is still being jogged", axis=self.axis)
        return self.spinning(name) or self.uncoupled(name)

    def spinning(self, name: str) -> str:
        """Return why C cannot move while it turns as the spindle, or an empty string."""
        context = self._context
        turns = context.spindle.asked or not context.spindle.stopped
        if name == "C" and context.machine.spindle_is_c and turns:
            return "the C axis is the spindle, and the spindle is turning; stop the spindle first"
        return ""

    def uncoupled(self, name: str) -> str:
        """Start the change to C-axis mode if needed; return why C cannot move yet, or an empty string."""
        if name != "C" or not self._context.machine.spindle_is_c or self._context.spindle.hold(orient=False):
            return ""
        return "the spindle drive is switching to C-axis mode; release the key or button and jog again in 2 s"

    def _too_far(self, name: str, distance: float, along: Direction | None) -> str:
        """Return why a step that would leave the travel is refused. A step is never shortened."""
        line, sample = self._line_of(name, along), self._context.sample
        homed = all(sample.homed[place] for place, _, _ in line.moving())
        if not homed or abs(distance) <= line.room(sample.demand, distance) + _STEP_ROUNDING:
            return ""
        return at_the_end(name, distance)

    def step(self, name: str, distance: float, speed: float, along: Direction | None = None) -> None:
        """Start a step from rest. Raises DriverError if the setpoints are rejected."""
        line = self._line_of(name, along)
        top = min(speed, self._top_of(line))
        self._splice(line, lambda _start, _p, _v: step_ramps(distance, top, line.amax))
        self._axis, self.stepping = self._context.ports.axes.axes.index(name), True

    def move(self, name: str, velocity: float, lease: float, along: Direction | None = None) -> bool:
        """Start or renew a jog; return False if no travel is left in that direction.

        ``along`` is the direction, in machine coordinates, of an axis of a tilted plane. Raises DriverError
        if the setpoints are rejected.
        """
        context, line = self._context, self._line_of(name, along)
        homed = all(context.sample.homed[place] for place, _, _ in line.moving())
        speed = math.copysign(min(abs(velocity), self._top_of(line)), velocity)
        until = context.now + min(lease, LONGEST_LEASE)

        def go(start: float, p: FloatArray, v: FloatArray) -> list[Ramp]:
            way = line.room(p, speed) if homed else math.inf
            return jog_ramps(line.on(v), speed, line.amax, max(until - start, 0.0), way)

        moves = self._splice(line, go)
        if moves:
            self._axis, self.ending = context.ports.axes.axes.index(name), False
        return moves

    def _top_of(self, line: JogLine) -> float:
        """Return the highest jog speed along the line."""
        homed = self._context.sample.homed
        return min(self.top(axis, homed[place]) / abs(share) for place, axis, share in line.moving())

    def play(self, name: str, ramps: Callable[[float, float, float], list[Ramp]]) -> bool:
        """Start or continue a drive test; return False if nothing of it remains. Raises DriverError."""
        index = self._context.ports.axes.axes.index(name)
        plays = self._splice_axis(index, ramps)
        if plays:
            self._axis, self.testing = index, True
        return plays

    def whole(self, queued: bool) -> None:
        """Store whether the whole drive test is queued. If not, its end is logged as a premature stop."""
        self._short = not queued

    def toward(self, name: str, target: float, speed: float, lease: float) -> bool:
        """Jog like ``move``, but no further than ``target``, where the axis stops. Raises DriverError."""
        context = self._context
        index = context.ports.axes.axes.index(name)
        axis, until = context.machine.axes[index], context.now + min(lease, LONGEST_LEASE)
        top = min(speed, self.top(axis, context.sample.homed[index]))

        def go(start: float, p: float, v: float) -> list[Ramp]:
            way = target - p
            if abs(way) <= _SAME:
                return []
            room = room_to_limit(axis, p, way)
            return jog_ramps(
                v, math.copysign(top, way), axis.amax, max(until - start, 0.0), min(abs(way), room)
            )

        moves = self._splice_axis(index, go)
        if moves:
            self._axis, self.ending = index, False
        return moves

    def chase(self, name: str, ramps: Callable[[float, float, float], list[Ramp]], goal: float) -> None:
        """Move to the target of the handwheel from any present motion. Raises DriverError."""
        index = self._context.ports.axes.axes.index(name)
        if self._splice_axis(index, ramps):
            self._axis, self.goal, self.ending = index, goal, False

    def stop(self) -> None:
        """Stop the jog. The early end of a step is logged when the axis is at rest."""
        line = self._line
        if self._axis < 0 or line is None:
            return
        self._short = self._short or self.stepping or self.testing
        self._splice(line, lambda _start, _p, v: jog_ramps(line.on(v), 0.0, line.amax, 0.0, math.inf))
        self.stepping, self.goal, self.ending = False, None, True

    def mind_button(self) -> None:
        """Stop the jog if its button is released or its state is unknown. Raises DriverError."""
        if self.while_on and not self._context.button(self.while_on):
            self.while_on = ""
            self.stop()

    def over(self) -> bool:
        """Return whether the jog is at rest; if so, finish and log it."""
        axes = self._context.ports.axes
        horizon = axes.horizon()
        if not at_rest(horizon, axes.now()):
            return False
        self.ended()
        return True

    def ended(self) -> None:
        """Finish the jog at rest, and log a completed test or a step that was stopped early."""
        if self._short and self.testing:
            self._context.log(
                "refused",
                Message("the drive test of {axis} was stopped before it was finished", axis=self.axis),
            )
        elif self._short:
            self._context.log(
                "refused",
                Message("the jog step of {axis} was stopped before it was finished", axis=self.axis),
            )
        elif self.testing:
            self.tested += 1
            self._context.log("test", Message("{axis} drive test", axis=self.axis))
        self.forget()

    def forget(self) -> None:
        """Clear the jog because the axis is at rest or another function has stopped it."""
        self._axis, self.stepping, self._short, self.testing = -1, False, False, False
        self.goal, self.ending, self.while_on = None, False, ""

    def _splice_axis(self, index: int, ramps: Callable[[float, float, float], list[Ramp]]) -> bool:
        """Queue the ramps of one axis, based on its own position and velocity."""
        line = JogLine.of_axis(self._context.machine.axes, index)
        return self._splice(line, lambda start, p, v: ramps(start, float(p[index]), float(v[index])))

    def _splice(self, line: JogLine, ramps: Callable[[float, FloatArray, FloatArray], list[Ramp]]) -> bool:
        """Queue the ramps that ``ramps`` returns for (start, positions, velocities).

        A splice that was too late is retried with a later start. Returns False if there are no ramps. Raises
        DriverError if the setpoints are rejected.
        """
        axes = self._context.ports.axes
        for margin in _MARGINS:
            start = axes.now() + axes.commit + margin
            p, v = (np.asarray(each) for each in axes.demand_at(start))
            pieces = ramps(start, p, v)
            if not pieces:
                return False
            try:
                axes.splice(line.setpoints(start, p, pieces))
            except DriverError:
                if margin == _MARGINS[-1] or axes.now() + axes.commit <= start:
                    raise
            else:
                self._line = line
                return True
        return False

    def top(self, axis: Axis, homed: bool) -> float:
        """Return the highest jog speed of an axis."""
        endless = axis.travel is None or axis.rotary
        rapid = axis.vmax if endless else min(axis.vmax, self._context.machine.limits.manual_rapid)
        return rapid if homed else _UNHOMED * rapid


def at_the_end(name: str, direction: float) -> str:
    """Return the message that an axis is at the end of its travel."""
    return Message(
        "{name} is at the end of its travel in the {ending} direction",
        name=name,
        ending="+" if direction > 0.0 else "−",
    )


# --- jog by the controller ------------------------------------------------------------------------------


def jogger_of(context: MachineContext) -> Jogger:
    """Return the jogger for setpoints, or the one for a controller with its own jog function."""
    return Jogger(context) if context.ports.blocks is None else BlockJogger(context, context.ports.blocks)


class _Pressed(NamedTuple):
    """A jog requested while the previous one is still stopping; ``until`` is the end of its lease."""

    axis: str
    velocity: float
    until: float


class BlockJogger(Jogger):
    """A jogger that uses the jog function of the controller, with the same refusals as ``Jogger``.

    The controller accepts a jog only after the previous one has ended. A key pressed again in the meantime
    waits until then, if it is still pressed.
    """

    def __init__(self, context: MachineContext, sink: BlockSink) -> None:
        super().__init__(context)
        self._sink = sink
        self._pressed: _Pressed | None = None

    def refusal(self, name: str, velocity: float, lease: float, along: Direction | None = None) -> str:
        """Return why this jog is refused, or an empty string if it may start or continue."""
        return super().refusal(name, velocity, lease, along) or ("" if self.axis else self._unready())

    def step_refusal(self, name: str, distance: float, speed: float, along: Direction | None = None) -> str:
        """Return why this step is refused, or an empty string if it may start."""
        return super().step_refusal(name, distance, speed, along) or self._unready()

    def _astray(self, name: str, along: Direction | None) -> str:
        """Return why the axis cannot be jogged along this direction, or an empty string."""
        return "" if along is None else Message("{name}: the controller can jog only its own axes", name=name)

    def step(self, name: str, distance: float, speed: float, along: Direction | None = None) -> None:
        """Start a step from rest. Raises DriverError if the controller rejects it."""
        assert along is None  # otherwise the request was refused
        index, top = self._speed(name, speed)
        self._sink.jog_to(name, self._context.sample.demand[index] + distance, top)
        self._axis, self.stepping = index, True

    def move(self, name: str, velocity: float, lease: float, along: Direction | None = None) -> bool:
        """Start or renew a jog; return False if no travel is left in that direction.

        Raises DriverError if the controller rejects the jog.
        """
        assert along is None  # otherwise the request was refused
        if self.ending:
            self._pressed = _Pressed(name, velocity, self._context.now + min(lease, LONGEST_LEASE))
            return True
        index, top = self._speed(name, abs(velocity))
        axis = self._context.machine.axes[index]
        limits = axis.travel if self._context.sample.homed[index] else None
        if limits is not None:
            limits = limits[0] + LIMIT_MARGIN, limits[1] - LIMIT_MARGIN
        moves = self._sink.jog(name, math.copysign(top, velocity), min(lease, LONGEST_LEASE), limits)
        if moves:
            self._axis = index
        return moves

    def toward(self, name: str, target: float, speed: float, lease: float) -> bool:
        """Jog like ``move``, but no further than ``target``, where the axis stops. Raises DriverError."""
        index, top = self._speed(name, speed)
        here = self._context.sample.demand[index]
        limits = (min(here, target), max(here, target))
        moves = self._sink.jog(name, math.copysign(top, target - here), min(lease, LONGEST_LEASE), limits)
        if moves:
            self._axis = index
        return moves

    def stop(self) -> None:
        """Stop the jog. The early end of a step is logged when the axis is at rest."""
        if self._axis < 0:
            return
        self._short = self._short or self.stepping
        self.stepping, self.ending, self._pressed = False, True, None
        self._sink.jog_stop()

    def over(self) -> bool:
        """Return whether the jog is at rest and no other jog is waiting."""
        if not self._sink.state().resting:
            return False
        pressed, button = self._pressed, self.while_on
        self.ended()
        if pressed is None or pressed.until <= self._context.now or self._unready():
            return True
        self.while_on = button
        return not self.move(pressed.axis, pressed.velocity, pressed.until - self._context.now)

    def forget(self) -> None:
        """Clear the jog and the waiting jog."""
        super().forget()
        self._pressed = None

    def _speed(self, name: str, speed: float) -> tuple[int, float]:
        index = self._context.ports.axes.axes.index(name)
        axis = self._context.machine.axes[index]
        return index, min(speed, self.top(axis, self._context.sample.homed[index]))

    def _unready(self) -> str:
        state = self._sink.state()
        return state.hindrance or ("" if state.resting else "the controller is still moving the axes")
