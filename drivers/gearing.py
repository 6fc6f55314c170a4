"""A cam played by the measured angle of the spindle, within what the slides can do."""

from __future__ import annotations

import math
from typing import NamedTuple

from core.ports import Cam, DriverError
from drivers.phase import Phase
from drivers.setpoint_queue import SetpointQueue, Tolerance

State = tuple[tuple[float, ...], tuple[float, ...]]
Motion = tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]
_STANDS = 1e-6  # turns/s
_RESERVE = 1.2  # of an axis' acceleration, to follow the spindle's


class Slides(NamedTuple):
    """The slides of one machine; limits are one number an axis, mm/s and mm/s² (degrees for C)."""

    names: tuple[str, ...]
    vmax: tuple[float, ...]
    amax: tuple[float, ...]
    commit: float  # s
    tolerance: Tolerance  # of setpoints in time


class Gearing:
    """One cam and where on it the slides are; not thread-safe, its driver locks.

    ``standing`` is where the slides rest. Raises DriverError where the spindle does not turn the way the cam
    counts, and as ``core.ports.Gear.mesh`` says.
    """

    def __init__(self, cam: Cam, phase: Phase, slides: Slides, standing: tuple[float, ...]) -> None:
        self._cam = cam
        self._phase = phase
        self._slides = slides
        self._standing = standing
        self._t = phase.t
        self.turns = self._goal(phase.t)  # at which the cam is played
        self._speed = cam.sign * phase.speed  # at which it is played, turns/s
        if self._speed < _STANDS:
            raise DriverError("the spindle does not turn; no slide can follow it", "thread-no-encoder")
        position, velocity = slides.tolerance.position, slides.tolerance.velocity
        per_turn = Tolerance(position, tuple(v / self._speed for v in velocity))
        self._queue = SetpointQueue(slides.names, standing, 0.0, per_turn)
        self.load(cam)

    def load(self, cam: Cam) -> None:
        """Replace what lies behind the start of this way."""
        if not self.fits(cam):
            raise DriverError("slides that follow the spindle cannot change to another index", "broken-path")
        self._queue.commit = self._slides.commit * self._speed
        self._queue.splice(cam.way, self.turns)
        self._cam = cam

    def fits(self, cam: Cam) -> bool:
        """Whether it counts from the same index."""
        return (cam.zero, cam.sign) == (self._cam.zero, self._cam.sign)

    @property
    def cam(self) -> Cam:
        """As loaded last."""
        return self._cam

    @property
    def lag(self) -> float:
        """Turns by which the setpoints are behind the spindle."""
        return self._goal(self._t) - self.turns

    @property
    def begun(self) -> bool:
        """Whether anything has moved."""
        return self._queue.demand_at(self.turns)[0] != self._standing

    @property
    def over(self) -> bool:
        """Whether the way has been played to its end."""
        return self.turns >= self._queue.horizon(-math.inf)

    @property
    def rest(self) -> tuple[float, ...]:
        """Where the way ends."""
        return self._queue.demand_at(math.inf)[0]

    def still_at(self, t: float) -> bool:
        """Whether nothing will have moved at ``t``, the speed staying."""
        return self.at(t)[0] == self._standing

    def ends(self) -> float:
        """When the way will have been played at the present speed; never, where the spindle stands."""
        left = self._queue.horizon(-math.inf) - self.turns
        return self._t + left / self._speed if self._speed > _STANDS else math.inf

    def at(self, t: float) -> State:
        """Setpoint and its velocity at ``t``, foretold from the last reading."""
        p, v = self._queue.demand_at(self.turns + self._speed * (t - self._t))
        return p, tuple([each * self._speed for each in v])

    def play(self, t: float, read_at: float, count: float) -> Motion:
        """A reading of the encoder, and the setpoint for ``t`` that follows from it.

        Position, velocity, and the acceleration that comes from the spindle.
        """
        self._phase.note(read_at, count)
        if t > self._t:
            self._follow(t)
        p, per_turn = self._queue.demand_at(self.turns)
        gain = self._cam.sign * self._phase.gain
        return p, tuple([v * self._speed for v in per_turn]), tuple([v * gain for v in per_turn])

    def _goal(self, t: float) -> float:
        return self._cam.sign * (self._phase.at(t) - self._cam.zero)

    def _follow(self, t: float) -> None:
        """On to where the spindle is at ``t``, or as far towards it as the slides can come."""
        dt, self._t = t - self._t, t
        goal, speed = self._goal(t), self._cam.sign * self._phase.speed
        top, bend = self._limits()
        need = (goal - self.turns) / dt
        if top == math.inf or (0.0 <= need <= top and abs(need - self._speed) <= bend * dt):
            self.turns, self._speed = goal, max(speed, 0.0)
            return
        behind = goal - speed * dt - self.turns
        wanted = speed + math.copysign(math.sqrt(2.0 * bend * abs(behind)), behind)
        wanted = min(max(wanted, self._speed - bend * dt), self._speed + bend * dt)
        self._speed = min(max(wanted, 0.0), top)
        self.turns += self._speed * dt

    def _limits(self) -> tuple[float, float]:
        """Speed and change of speed, turns/s and turns/s², that no slide exceeds here; endless at rest."""
        _, per_turn = self._queue.demand_at(self.turns)
        top = bend = math.inf
        for v, vmax, amax in zip(per_turn, self._slides.vmax, self._slides.amax, strict=True):
            if v:
                top, bend = min(top, vmax / abs(v)), min(bend, _RESERVE * amax / abs(v))
        return top, bend
