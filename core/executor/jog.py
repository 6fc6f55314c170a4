"""Jog: one axis moves while somebody keeps asking; the queue already ends in the stop of a lost lease."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from core.executor import ride
from core.executor.bench import Bench
from core.executor.ride import Piece
from core.machine.model import Axis
from core.ports import DriverError, at_rest

_UNHOMED = 0.1  # of the manual rapid, for an axis that does not know where it is
LONGEST_LEASE = 1.0  # s; no lease is longer, whoever asks
_LONGEST_STEP = 2.54  # mm (.1 in) or degrees: what is longer is no step
_ROUNDING = 1e-9
_MARGINS = (0.0, 0.002, 0.02)  # s of grace for the time between asking the clock and queueing


class Jogger:
    """The jog that is under way, if any: held by a lease, or a step of a given length."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._axis = -1
        self.stepping = False
        self._short = False  # the step was stopped before its end
        self.goal: float | None = None  # where the handwheel sends the axis; None: it does not
        self.ending = False  # told to stop, and still on its way to rest

    @property
    def axis(self) -> str:
        """Name of the axis that moves, empty without one."""
        return self._bench.machine.axes[self._axis].name if self._axis >= 0 else ""

    def refusal(self, name: str, velocity: float, lease: float) -> str:
        """Why this jog is refused; empty when it may begin or go on."""
        if self.missing(name):
            return self.missing(name)
        if not (math.isfinite(velocity) and math.isfinite(lease)) or lease <= 0.0:
            return "a jog needs a velocity and a lease above 0"
        if self.stepping:
            return f"{self.axis} is still on its step"
        return self._barred(name)

    def step_refusal(self, name: str, distance: float, speed: float) -> str:
        """Why this step is refused; empty when it may begin."""
        if self.missing(name):
            return self.missing(name)
        if not math.isfinite(speed) or speed <= 0.0:
            return "a step needs a speed above 0"
        if not 0.0 < abs(distance) <= _LONGEST_STEP + _ROUNDING:
            return f"a step is longer than 0 and no longer than {_LONGEST_STEP:g}, not {distance:g}"
        if self.axis:
            return f"{self.axis} is still moving; wait for the end of its step"
        return self._barred(name) or self._too_far(name, distance)

    def missing(self, name: str) -> str:
        """Why there is no such axis to move by hand; empty when there is."""
        machine = self._bench.machine
        known = name in {axis.name for axis in machine.axes}
        there = known and (name != "C" or machine.c_enabled or machine.kind != "lathe")
        return "" if there else f"this machine has no axis {name} to jog"

    def _barred(self, name: str) -> str:
        bench = self._bench
        if bench.heard.hold:
            return "feed hold is pressed"
        if self.axis and self.axis != name:
            return f"{self.axis} is still being jogged"
        return self.spinning(name) or self.uncoupled(name)

    def spinning(self, name: str) -> str:
        """Why C does not move as long as it turns as the spindle."""
        bench = self._bench
        turns = bench.spindle.asked or not bench.spindle.stopped
        if name == "C" and bench.machine.spindle_is_c and turns:
            return "C is the spindle, and the spindle turns; stop it first"
        return ""

    def uncoupled(self, name: str) -> str:
        """Why C does not move yet: the spindle's drive has to become C first, which begins here."""
        if name != "C" or not self._bench.machine.spindle_is_c or self._bench.spindle.hold(orient=False):
            return ""
        return "the spindle's drive becomes C: let go, and begin again in two seconds"

    def _too_far(self, name: str, distance: float) -> str:
        """A step that would leave the travel is not shortened: it would no longer be what was asked."""
        index = self._bench.ports.axes.axes.index(name)
        axis, here = self._bench.machine.axes[index], self._bench.sample.demand[index]
        if (
            not self._bench.sample.homed[index]
            or abs(distance) <= ride.room(axis, here, distance) + _ROUNDING
        ):
            return ""
        return at_the_end(name, distance)

    def step(self, name: str, distance: float, speed: float) -> None:
        """Begin a step from rest. Raises DriverError."""
        index = self._bench.ports.axes.axes.index(name)
        axis = self._bench.machine.axes[index]
        top = min(speed, self.top(axis, self._bench.sample.homed[index]))
        self._splice(index, lambda _start, _p, _v: ride.step(distance, top, axis.amax))
        self._axis, self.stepping = index, True

    def move(self, name: str, velocity: float, lease: float) -> bool:
        """Begin or renew; False when there is no way to go in that direction. Raises DriverError."""
        bench = self._bench
        index = bench.ports.axes.axes.index(name)
        axis = bench.machine.axes[index]
        homed = bench.sample.homed[index]
        speed = math.copysign(min(abs(velocity), self.top(axis, homed)), velocity)
        until = bench.now + min(lease, LONGEST_LEASE)

        def go(start: float, p: float, v: float) -> list[Piece]:
            way = ride.room(axis, p, speed) if homed else math.inf
            return ride.ride(v, speed, axis.amax, max(until - start, 0.0), way)

        moves = self._splice(index, go)
        if moves:
            self._axis, self.ending = index, False
        return moves

    def chase(self, name: str, rides: Callable[[float, float, float], list[Piece]], goal: float) -> None:
        """Go where the handwheel sends the axis, from whatever it does now. Raises DriverError."""
        index = self._bench.ports.axes.axes.index(name)
        if self._splice(index, rides):
            self._axis, self.goal, self.ending = index, goal, False

    def stop(self) -> None:
        """The lease is given back, or taken away; a step ends short, and that is said when it rests."""
        if self._axis < 0:
            return
        self._short = self._short or self.stepping
        amax = self._bench.machine.axes[self._axis].amax
        self._splice(self._axis, lambda _start, _p, v: ride.ride(v, 0.0, amax, 0.0, math.inf))
        self.stepping, self.goal, self.ending = False, None, True

    def over(self) -> bool:
        """Whether it has come to rest."""
        axes = self._bench.ports.axes
        horizon = axes.horizon()
        if not at_rest(horizon, axes.now()):
            return False
        self.ended()
        return True

    def ended(self) -> None:
        """It rests; a step that was cut short is said to be so."""
        if self._short:
            self._bench.say("refused", f"{self.axis} was stopped before the end of its step")
        self.forget()

    def forget(self) -> None:
        """Nothing is jogged any more: it has come to rest, or something else has stopped it."""
        self._axis, self.stepping, self._short = -1, False, False
        self.goal, self.ending = None, False

    def _splice(self, index: int, rides: Callable[[float, float, float], list[Piece]]) -> bool:
        """Queue what ``rides`` makes of (start, position, velocity); later when the clock was faster.

        False when it makes nothing. Raises DriverError.
        """
        axes = self._bench.ports.axes
        for margin in _MARGINS:
            start = axes.now() + axes.commit + margin
            p, v = axes.demand_at(start)
            pieces = rides(start, p[index], v[index])
            if not pieces:
                return False
            try:
                axes.splice(ride.segments(start, np.asarray(p), index, pieces))
            except DriverError:
                if margin == _MARGINS[-1] or axes.now() + axes.commit <= start:
                    raise
            else:
                return True
        return False

    def top(self, axis: Axis, homed: bool) -> float:
        """How fast an axis goes by hand at most."""
        endless = axis.travel is None or axis.rotary
        rapid = axis.vmax if endless else min(axis.vmax, self._bench.machine.manual_rapid)
        return rapid if homed else _UNHOMED * rapid


def at_the_end(name: str, direction: float) -> str:
    """Why an axis goes no further."""
    return f"{name} is at the end of its travel in {'+' if direction > 0.0 else '−'}"
