"""Jog: one axis moves while somebody keeps asking; the queue already ends in the stop of a lost lease."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from core.executor.bench import Bench
from core.machine.model import Axis
from core.ports import DriverError, Segments

_Piece = tuple[float, float, float]  # seconds, speed at its start, acceleration

_UNHOMED = 0.1  # of the manual rapid, for an axis that does not know where it is
_LONGEST = 1.0  # s; no lease is longer, whoever asks
_MARGINS = (0.0, 0.002, 0.02)  # s of grace for the time between asking the clock and queueing
_MARGIN = 0.01  # mm or degrees kept from the soft limit


class Jogger:
    """The jog that is under way, if any."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._axis = -1

    @property
    def axis(self) -> str:
        """Name of the axis that moves, empty without one."""
        return self._bench.machine.axes[self._axis].name if self._axis >= 0 else ""

    def refusal(self, name: str, velocity: float, lease: float) -> str:
        """Why this jog is refused; empty when it may begin or go on."""
        machine = self._bench.machine
        if name not in {axis.name for axis in machine.axes} or (name == "C" and not machine.c_enabled):
            return f"this machine has no axis {name} to jog"
        if not (math.isfinite(velocity) and math.isfinite(lease)) or lease <= 0.0:
            return "a jog needs a velocity and a lease above 0"
        if self._bench.heard.hold:
            return "feed hold is pressed"
        if self.axis and self.axis != name:
            return f"{self.axis} is still being jogged"
        return ""

    def move(self, name: str, velocity: float, lease: float) -> bool:
        """Begin or renew; False when there is no way to go in that direction. Raises DriverError."""
        bench = self._bench
        index = bench.ports.axes.axes.index(name)
        axis = bench.machine.axes[index]
        homed = bench.sample.homed[index]
        top = min(axis.vmax, self._slowest(axis, homed))
        speed = math.copysign(min(abs(velocity), top), velocity)
        until = bench.now + min(lease, _LONGEST)

        def ride(start: float, p: float, v: float) -> list[_Piece]:
            room = _room(axis, p, speed) if homed else math.inf
            return _ride(v, speed, axis.amax, max(until - start, 0.0), room)

        moves = self._splice(index, ride)
        if moves:
            self._axis = index
        return moves

    def stop(self) -> None:
        """The lease is given back, or taken away."""
        if self._axis >= 0:
            amax = self._bench.machine.axes[self._axis].amax
            self._splice(self._axis, lambda _start, _p, v: _ride(v, 0.0, amax, 0.0, math.inf))

    def over(self) -> bool:
        """Whether it has come to rest."""
        axes = self._bench.ports.axes
        horizon = axes.horizon()
        if horizon > axes.now() + 1e-9:
            return False
        self._axis = -1
        return True

    def _splice(self, index: int, ride: Callable[[float, float, float], list[_Piece]]) -> bool:
        """Queue what ``ride`` makes of (start, position, velocity); a little later when the clock was faster.

        False when it makes nothing. Raises DriverError.
        """
        axes = self._bench.ports.axes
        for margin in _MARGINS:
            start = axes.now() + axes.commit + margin
            p, v = axes.demand_at(start)
            pieces = ride(start, p[index], v[index])
            if not pieces:
                return False
            try:
                axes.splice(_segments(start, np.asarray(p), index, pieces))
            except DriverError:
                if margin == _MARGINS[-1] or axes.now() + axes.commit <= start:
                    raise
            else:
                return True
        return False

    def _slowest(self, axis: Axis, homed: bool) -> float:
        rapid = axis.vmax if axis.travel is None else self._bench.machine.manual_rapid
        return rapid if homed else _UNHOMED * rapid


def _room(axis: Axis, at: float, speed: float) -> float:
    """How far the axis may go in this direction; less than a count is nothing."""
    if axis.travel is None:
        return math.inf
    low, high = axis.travel
    room = (high - at if speed > 0.0 else at - low) - _MARGIN
    return room if room > axis.count else 0.0


def _ride(v0: float, v1: float, a: float, time: float, room: float) -> list[_Piece]:
    """(seconds, speed at start, acceleration): to ``v1``, on for the rest of ``time``, then to rest.

    A ride that ``room`` is too short for goes less fast or less long. Braking alone takes v0²/2a.
    """
    if v0 * v1 < 0.0:
        first = abs(v0) / a
        return [(first, v0, -math.copysign(a, v0)), *_ride(0.0, v1, a, time - first, room)]
    sign = math.copysign(1.0, v1 or v0)
    here, top = abs(v0), abs(v1)
    reach = math.sqrt(max(here * here / 2.0 + a * max(room, 0.0), 0.0)) if math.isfinite(room) else math.inf
    top = max(min(top, reach, here + a * max(time, 0.0)), 0.0) if top > here else min(top, reach)
    change = abs(top - here) / a
    way = change * (here + top) / 2.0 + top * top / (2.0 * a)
    cruise = max(time - change, 0.0) if top > 0.0 else 0.0
    if cruise and math.isfinite(room):
        cruise = min(cruise, max(room - way, 0.0) / top)
    pieces = [
        (change, v0, sign * math.copysign(a, top - here)),
        (cruise, sign * top, 0.0),
        (top / a, sign * top, -sign * a),
    ]
    return [piece for piece in pieces if piece[0] > 1e-12]


def _segments(
    start: float,
    p: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    axis: int,
    pieces: list[_Piece],
) -> Segments:
    n = len(pieces)
    dt = np.array([piece[0] for piece in pieces])
    t = start + np.concatenate([[0.0], np.cumsum(dt)[:-1]])
    position, v, a = np.tile(p, (n, 1)), np.zeros((n, len(p))), np.zeros((n, len(p)))
    v[:, axis] = [piece[1] for piece in pieces]
    a[:, axis] = [piece[2] for piece in pieces]
    way = (v[:, axis] + 0.5 * a[:, axis] * dt) * dt
    position[1:, axis] += np.cumsum(way)[:-1]
    return Segments(t, dt, position, v, a)
