"""Jog: one axis moves by hand as long as its lease is renewed, or by one step of a given length.

What is queued already ends in the stop of a lost lease. The setpoints of one axis are ramps, pieces of
constant acceleration that always end at rest; a controller that plans by itself jogs by itself.
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


_SHORTEST = 1e-12  # s; a piece that takes less is none
_SAME = 1e-9  # mm or degrees; places nearer than that are one
_UNHOMED = 0.1  # of the manual rapid, for an axis that does not know where it is
LONGEST_LEASE = 1.0  # s; no lease is longer, whoever asks
_LONGEST_STEP = 2.54  # mm (.1 in) or degrees: what is longer is no step
_STEP_ROUNDING = 1e-9
_MARGINS = (0.0, 0.002, 0.02)  # s of grace for the time between asking the clock and queueing


def jog_ramps(v0: float, v1: float, a: float, time: float, way: float) -> list[Ramp]:
    """Ramps from speed ``v0`` to ``v1``, on for the rest of ``time`` s, then to rest, within ``way`` mm.

    A jog that ``way`` is too short for goes less fast or less long. Braking alone takes v0²/2a.
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
    """From rest to rest over exactly ``distance``: up to ``speed``, on, down again.

    A way too short for that speed is half speeding up, half braking: top = √(a·|distance|).
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
    """From speed ``v0`` to rest at exactly ``way`` from here, no faster than ``top`` once it is that slow.

    A ``way`` that lies behind, or is shorter than the braking, is come back to from rest.
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
    """The jog that is under way, if any: held by a lease, or a step of a given length."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._axis = -1
        self._line: JogLine | None = None  # along which it moves, or has moved last
        self.stepping = False
        self._short = False  # the step was stopped before its end
        self.goal: float | None = None  # where the handwheel sends the axis; None: it does not
        self.ending = False  # told to stop, and still on its way to rest
        self.testing = False  # a drive test is played
        self.tested = 0  # drive tests that came to their end
        self.while_on = ""  # the input of the button that holds it

    @property
    def axis(self) -> str:
        """Name of the axis that moves, empty without one."""
        return self._context.machine.axes[self._axis].name if self._axis >= 0 else ""

    def refusal(self, name: str, velocity: float, lease: float, along: Direction | None = None) -> str:
        """Why this jog is refused; empty when it may begin or go on."""
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
        """Why this step is refused; empty when it may begin."""
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
        """Why nothing moves along an axis of a tilted plane."""
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
        """Why there is no such axis to move by hand; empty when there is."""
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
        """Why C does not move as long as it turns as the spindle."""
        context = self._context
        turns = context.spindle.asked or not context.spindle.stopped
        if name == "C" and context.machine.spindle_is_c and turns:
            return "the C axis is the spindle, and the spindle is turning; stop the spindle first"
        return ""

    def uncoupled(self, name: str) -> str:
        """Why C does not move yet: the spindle's drive has to become C first, which begins here."""
        if name != "C" or not self._context.machine.spindle_is_c or self._context.spindle.hold(orient=False):
            return ""
        return "the spindle drive is switching to C-axis mode; release the key or button and jog again in 2 s"

    def _too_far(self, name: str, distance: float, along: Direction | None) -> str:
        """A step that would leave the travel is not shortened: it would no longer be what was asked."""
        line, sample = self._line_of(name, along), self._context.sample
        homed = all(sample.homed[place] for place, _, _ in line.moving())
        if not homed or abs(distance) <= line.room(sample.demand, distance) + _STEP_ROUNDING:
            return ""
        return at_the_end(name, distance)

    def step(self, name: str, distance: float, speed: float, along: Direction | None = None) -> None:
        """Begin a step from rest. Raises DriverError."""
        line = self._line_of(name, along)
        top = min(speed, self._top_of(line))
        self._splice(line, lambda _start, _p, _v: step_ramps(distance, top, line.amax))
        self._axis, self.stepping = self._context.ports.axes.axes.index(name), True

    def move(self, name: str, velocity: float, lease: float, along: Direction | None = None) -> bool:
        """Begin or renew; False when there is no way to go in that direction. Raises DriverError.

        ``along``: not the machine's axis but that of a tilted plane, as a direction in the machine.
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
        """How fast it goes along the line by hand at most."""
        homed = self._context.sample.homed
        return min(self.top(axis, homed[place]) / abs(share) for place, axis, share in line.moving())

    def play(self, name: str, ramps: Callable[[float, float, float], list[Ramp]]) -> bool:
        """A drive test begins, or goes on; False where there is nothing left of it. Raises DriverError."""
        index = self._context.ports.axes.axes.index(name)
        plays = self._splice_axis(index, ramps)
        if plays:
            self._axis, self.testing = index, True
        return plays

    def whole(self, queued: bool) -> None:
        """Whether all of a drive test is queued: one that ends sooner is said to have been stopped."""
        self._short = not queued

    def toward(self, name: str, target: float, speed: float, lease: float) -> bool:
        """As ``move``, and no further than ``target``, where it rests. Raises DriverError."""
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
        """Go where the handwheel sends the axis, from whatever it does now. Raises DriverError."""
        index = self._context.ports.axes.axes.index(name)
        if self._splice_axis(index, ramps):
            self._axis, self.goal, self.ending = index, goal, False

    def stop(self) -> None:
        """The lease is given back, or taken away; a step ends short, and that is said when it rests."""
        line = self._line
        if self._axis < 0 or line is None:
            return
        self._short = self._short or self.stepping or self.testing
        self._splice(line, lambda _start, _p, v: jog_ramps(line.on(v), 0.0, line.amax, 0.0, math.inf))
        self.stepping, self.goal, self.ending = False, None, True

    def mind_button(self) -> None:
        """A jog that a button holds ends when that comes up, or is no longer known. Raises DriverError."""
        if self.while_on and not self._context.button(self.while_on):
            self.while_on = ""
            self.stop()

    def over(self) -> bool:
        """Whether it has come to rest."""
        axes = self._context.ports.axes
        horizon = axes.horizon()
        if not at_rest(horizon, axes.now()):
            return False
        self.ended()
        return True

    def ended(self) -> None:
        """It rests; a step that was cut short is said to be so."""
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
        """Nothing is jogged any more: it has come to rest, or something else has stopped it."""
        self._axis, self.stepping, self._short, self.testing = -1, False, False, False
        self.goal, self.ending, self.while_on = None, False, ""

    def _splice_axis(self, index: int, ramps: Callable[[float, float, float], list[Ramp]]) -> bool:
        """The same of one axis, with its own position and velocity."""
        line = JogLine.of_axis(self._context.machine.axes, index)
        return self._splice(line, lambda start, p, v: ramps(start, float(p[index]), float(v[index])))

    def _splice(self, line: JogLine, ramps: Callable[[float, FloatArray, FloatArray], list[Ramp]]) -> bool:
        """Queue what ``ramps`` makes of (start, positions, velocities); later when the clock was faster.

        False when it makes nothing. Raises DriverError.
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
        """How fast an axis goes by hand at most."""
        endless = axis.travel is None or axis.rotary
        rapid = axis.vmax if endless else min(axis.vmax, self._context.machine.limits.manual_rapid)
        return rapid if homed else _UNHOMED * rapid


def at_the_end(name: str, direction: float) -> str:
    """Why an axis goes no further."""
    return Message(
        "{name} is at the end of its travel in the {ending} direction",
        name=name,
        ending="+" if direction > 0.0 else "−",
    )


# --- jog by the controller ------------------------------------------------------------------------------


def jogger_of(context: MachineContext) -> Jogger:
    """By setpoints, or by the controller's own jog."""
    return Jogger(context) if context.ports.blocks is None else BlockJogger(context, context.ports.blocks)


class _Pressed(NamedTuple):
    """A jog that is asked for while the one before still ends; ``until`` is the end of its lease."""

    axis: str
    velocity: float
    until: float


class BlockJogger(Jogger):
    """Same questions and refusals; the controller moves.

    It takes no other jog before the one that was let go is over: a key that is pressed again meanwhile waits
    for that as long as it is held.
    """

    def __init__(self, context: MachineContext, sink: BlockSink) -> None:
        super().__init__(context)
        self._sink = sink
        self._pressed: _Pressed | None = None

    def refusal(self, name: str, velocity: float, lease: float, along: Direction | None = None) -> str:
        """Why this jog is refused; empty when it may begin or go on."""
        return super().refusal(name, velocity, lease, along) or ("" if self.axis else self._unready())

    def step_refusal(self, name: str, distance: float, speed: float, along: Direction | None = None) -> str:
        """Why this step is refused; empty when it may begin."""
        return super().step_refusal(name, distance, speed, along) or self._unready()

    def _astray(self, name: str, along: Direction | None) -> str:
        """A controller that jogs by itself jogs its own axes."""
        return "" if along is None else Message("{name}: the controller can jog only its own axes", name=name)

    def step(self, name: str, distance: float, speed: float, along: Direction | None = None) -> None:
        """Begin a step from rest. Raises DriverError."""
        assert along is None  # else it was refused
        index, top = self._speed(name, speed)
        self._sink.jog_to(name, self._context.sample.demand[index] + distance, top)
        self._axis, self.stepping = index, True

    def move(self, name: str, velocity: float, lease: float, along: Direction | None = None) -> bool:
        """Begin or renew; False when there is no way to go in that direction. Raises DriverError."""
        assert along is None  # else it was refused
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
        """As ``move``, and no further than ``target``, where it rests. Raises DriverError."""
        index, top = self._speed(name, speed)
        here = self._context.sample.demand[index]
        limits = (min(here, target), max(here, target))
        moves = self._sink.jog(name, math.copysign(top, target - here), min(lease, LONGEST_LEASE), limits)
        if moves:
            self._axis = index
        return moves

    def stop(self) -> None:
        """The lease is given back, or taken away; a step ends short, and that is said when it rests."""
        if self._axis < 0:
            return
        self._short = self._short or self.stepping
        self.stepping, self.ending, self._pressed = False, True, None
        self._sink.jog_stop()

    def over(self) -> bool:
        """Whether it has come to rest, and nothing is held any more."""
        if not self._sink.state().resting:
            return False
        pressed, button = self._pressed, self.while_on
        self.ended()
        if pressed is None or pressed.until <= self._context.now or self._unready():
            return True
        self.while_on = button
        return not self.move(pressed.axis, pressed.velocity, pressed.until - self._context.now)

    def forget(self) -> None:
        """Nothing is jogged any more, and nothing waits."""
        super().forget()
        self._pressed = None

    def _speed(self, name: str, speed: float) -> tuple[int, float]:
        index = self._context.ports.axes.axes.index(name)
        axis = self._context.machine.axes[index]
        return index, min(speed, self.top(axis, self._context.sample.homed[index]))

    def _unready(self) -> str:
        state = self._sink.state()
        return state.hindrance or ("" if state.resting else "the controller is still moving the axes")
