"""Jog: one axis moves by hand as long as its lease is renewed, or by one step of a given length.

What is queued already ends in the stop of a lost lease. The setpoints of one axis are ramps, pieces of
constant acceleration that always end at rest; a controller that plans by itself jogs by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from core.executor.machine_context import MachineContext
from core.machine.machine_model import Axis
from core.ports import BlockSink, DriverError, Segments, at_rest

# --- setpoints of one axis ------------------------------------------------------------------------------


Ramp = tuple[float, float, float]  # seconds, speed at its start, acceleration

LIMIT_MARGIN = 0.01  # mm or degrees kept from the soft limit
_SHORTEST = 1e-12  # s; a piece that takes less is none
_SAME = 1e-9  # mm or degrees; places nearer than that are one


def room_to_limit(axis: Axis, at: float, direction: float) -> float:
    """How far the axis may go in this direction; less than a count is nothing."""
    if axis.travel is None:
        return math.inf
    low, high = axis.travel
    left = (high - at if direction > 0.0 else at - low) - LIMIT_MARGIN
    return left if left > axis.count else 0.0


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


def axis_setpoints(start: float, p: npt.NDArray[np.float64], axis: int, pieces: list[Ramp]) -> Segments:
    """The pieces of one axis from ``start`` on as setpoints of all; the others stay at ``p``."""
    n = len(pieces)
    dt = np.array([piece[0] for piece in pieces])
    t = start + np.concatenate([[0.0], np.cumsum(dt)[:-1]])
    position, v, a = np.tile(p, (n, 1)), np.zeros((n, len(p))), np.zeros((n, len(p)))
    v[:, axis] = [piece[1] for piece in pieces]
    a[:, axis] = [piece[2] for piece in pieces]
    way = (v[:, axis] + 0.5 * a[:, axis] * dt) * dt
    position[1:, axis] += np.cumsum(way)[:-1]
    return Segments(t, dt, position, v, a)


_UNHOMED = 0.1  # of the manual rapid, for an axis that does not know where it is
LONGEST_LEASE = 1.0  # s; no lease is longer, whoever asks
_LONGEST_STEP = 2.54  # mm (.1 in) or degrees: what is longer is no step
_STEP_ROUNDING = 1e-9
_MARGINS = (0.0, 0.002, 0.02)  # s of grace for the time between asking the clock and queueing


class Jogger:
    """The jog that is under way, if any: held by a lease, or a step of a given length."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._axis = -1
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

    def refusal(self, name: str, velocity: float, lease: float) -> str:
        """Why this jog is refused; empty when it may begin or go on."""
        if self.missing(name):
            return self.missing(name)
        if not (math.isfinite(velocity) and math.isfinite(lease)) or lease <= 0.0:
            return "a jog needs a velocity and a lease above 0"
        if self.testing:
            return f"{self.axis} is still in its drive test"
        if self.stepping:
            return f"{self.axis} is still on its step"
        return self._barred(name)

    def step_refusal(self, name: str, distance: float, speed: float) -> str:
        """Why this step is refused; empty when it may begin."""
        if self.missing(name):
            return self.missing(name)
        if not math.isfinite(speed) or speed <= 0.0:
            return "a step needs a speed above 0"
        if not 0.0 < abs(distance) <= _LONGEST_STEP + _STEP_ROUNDING:
            return f"a step is longer than 0 and no longer than {_LONGEST_STEP:g}, not {distance:g}"
        if self.axis:
            return f"{self.axis} is still moving; wait for the end of its step"
        return self._barred(name) or self._too_far(name, distance)

    def missing(self, name: str) -> str:
        """Why there is no such axis to move by hand; empty when there is."""
        machine = self._context.machine
        known = name in {axis.name for axis in machine.axes}
        there = known and (name != "C" or machine.c_enabled or machine.kind != "lathe")
        return "" if there else f"this machine has no axis {name} to jog"

    def _barred(self, name: str) -> str:
        context = self._context
        if context.signals.hold:
            return "feed hold is pressed"
        if self.axis and self.axis != name:
            return f"{self.axis} is still being jogged"
        return self.spinning(name) or self.uncoupled(name)

    def spinning(self, name: str) -> str:
        """Why C does not move as long as it turns as the spindle."""
        context = self._context
        turns = context.spindle.asked or not context.spindle.stopped
        if name == "C" and context.machine.spindle_is_c and turns:
            return "C is the spindle, and the spindle turns; stop it first"
        return ""

    def uncoupled(self, name: str) -> str:
        """Why C does not move yet: the spindle's drive has to become C first, which begins here."""
        if name != "C" or not self._context.machine.spindle_is_c or self._context.spindle.hold(orient=False):
            return ""
        return "the spindle's drive becomes C: let go, and begin again in two seconds"

    def _too_far(self, name: str, distance: float) -> str:
        """A step that would leave the travel is not shortened: it would no longer be what was asked."""
        index = self._context.ports.axes.axes.index(name)
        axis, here = self._context.machine.axes[index], self._context.sample.demand[index]
        if (
            not self._context.sample.homed[index]
            or abs(distance) <= room_to_limit(axis, here, distance) + _STEP_ROUNDING
        ):
            return ""
        return at_the_end(name, distance)

    def step(self, name: str, distance: float, speed: float) -> None:
        """Begin a step from rest. Raises DriverError."""
        index = self._context.ports.axes.axes.index(name)
        axis = self._context.machine.axes[index]
        top = min(speed, self.top(axis, self._context.sample.homed[index]))
        self._splice(index, lambda _start, _p, _v: step_ramps(distance, top, axis.amax))
        self._axis, self.stepping = index, True

    def move(self, name: str, velocity: float, lease: float) -> bool:
        """Begin or renew; False when there is no way to go in that direction. Raises DriverError."""
        context = self._context
        index = context.ports.axes.axes.index(name)
        axis = context.machine.axes[index]
        homed = context.sample.homed[index]
        speed = math.copysign(min(abs(velocity), self.top(axis, homed)), velocity)
        until = context.now + min(lease, LONGEST_LEASE)

        def go(start: float, p: float, v: float) -> list[Ramp]:
            way = room_to_limit(axis, p, speed) if homed else math.inf
            return jog_ramps(v, speed, axis.amax, max(until - start, 0.0), way)

        moves = self._splice(index, go)
        if moves:
            self._axis, self.ending = index, False
        return moves

    def play(self, name: str, ramps: Callable[[float, float, float], list[Ramp]]) -> bool:
        """A drive test begins, or goes on; False where there is nothing left of it. Raises DriverError."""
        index = self._context.ports.axes.axes.index(name)
        plays = self._splice(index, ramps)
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

        moves = self._splice(index, go)
        if moves:
            self._axis, self.ending = index, False
        return moves

    def chase(self, name: str, ramps: Callable[[float, float, float], list[Ramp]], goal: float) -> None:
        """Go where the handwheel sends the axis, from whatever it does now. Raises DriverError."""
        index = self._context.ports.axes.axes.index(name)
        if self._splice(index, ramps):
            self._axis, self.goal, self.ending = index, goal, False

    def stop(self) -> None:
        """The lease is given back, or taken away; a step ends short, and that is said when it rests."""
        if self._axis < 0:
            return
        self._short = self._short or self.stepping or self.testing
        amax = self._context.machine.axes[self._axis].amax
        self._splice(self._axis, lambda _start, _p, v: jog_ramps(v, 0.0, amax, 0.0, math.inf))
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
            self._context.log("refused", f"{self.axis} was stopped before the end of its drive test")
        elif self._short:
            self._context.log("refused", f"{self.axis} was stopped before the end of its step")
        elif self.testing:
            self.tested += 1
            self._context.log("test", f"{self.axis} drive test")
        self.forget()

    def forget(self) -> None:
        """Nothing is jogged any more: it has come to rest, or something else has stopped it."""
        self._axis, self.stepping, self._short, self.testing = -1, False, False, False
        self.goal, self.ending, self.while_on = None, False, ""

    def _splice(self, index: int, ramps: Callable[[float, float, float], list[Ramp]]) -> bool:
        """Queue what ``ramps`` makes of (start, position, velocity); later when the clock was faster.

        False when it makes nothing. Raises DriverError.
        """
        axes = self._context.ports.axes
        for margin in _MARGINS:
            start = axes.now() + axes.commit + margin
            p, v = axes.demand_at(start)
            pieces = ramps(start, p[index], v[index])
            if not pieces:
                return False
            try:
                axes.splice(axis_setpoints(start, np.asarray(p), index, pieces))
            except DriverError:
                if margin == _MARGINS[-1] or axes.now() + axes.commit <= start:
                    raise
            else:
                return True
        return False

    def top(self, axis: Axis, homed: bool) -> float:
        """How fast an axis goes by hand at most."""
        endless = axis.travel is None or axis.rotary
        rapid = axis.vmax if endless else min(axis.vmax, self._context.machine.manual_rapid)
        return rapid if homed else _UNHOMED * rapid


def at_the_end(name: str, direction: float) -> str:
    """Why an axis goes no further."""
    return f"{name} is at the end of its travel in {'+' if direction > 0.0 else '−'}"


# --- jog by the controller ------------------------------------------------------------------------------


def jogger_of(context: MachineContext) -> Jogger:
    """By setpoints, or by the controller's own jog."""
    return Jogger(context) if context.ports.blocks is None else BlockJogger(context, context.ports.blocks)


class BlockJogger(Jogger):
    """Same questions and refusals; the controller moves."""

    def __init__(self, context: MachineContext, sink: BlockSink) -> None:
        super().__init__(context)
        self._sink = sink

    def refusal(self, name: str, velocity: float, lease: float) -> str:
        """Why this jog is refused; empty when it may begin or go on."""
        return super().refusal(name, velocity, lease) or ("" if self.axis else self._unready())

    def step_refusal(self, name: str, distance: float, speed: float) -> str:
        """Why this step is refused; empty when it may begin."""
        return super().step_refusal(name, distance, speed) or self._unready()

    def step(self, name: str, distance: float, speed: float) -> None:
        """Begin a step from rest. Raises DriverError."""
        index, top = self._speed(name, speed)
        self._sink.jog_to(name, self._context.sample.demand[index] + distance, top)
        self._axis, self.stepping = index, True

    def move(self, name: str, velocity: float, lease: float) -> bool:
        """Begin or renew; False when there is no way to go in that direction. Raises DriverError."""
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
        self.stepping = False
        self._sink.jog_stop()

    def over(self) -> bool:
        """Whether it has come to rest."""
        if not self._sink.state().resting:
            return False
        self.ended()
        return True

    def _speed(self, name: str, speed: float) -> tuple[int, float]:
        index = self._context.ports.axes.axes.index(name)
        axis = self._context.machine.axes[index]
        return index, min(speed, self.top(axis, self._context.sample.homed[index]))

    def _unready(self) -> str:
        state = self._sink.state()
        return state.hindrance or ("" if state.resting else "the controller is still moving")
