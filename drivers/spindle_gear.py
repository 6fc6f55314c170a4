"""The gear: slides follow the spindle's measured angle by themselves, within what the slides can do."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from itertools import accumulate
from typing import NamedTuple

from core.ports import Cam, DriverError, Geared, Segments, at_rest
from drivers.setpoint_pieces import Piece
from drivers.setpoint_queue import AxisFigures, SetpointQueue, Tolerance

# --- Angle and speed of a spindle from an encoder that counts in steps, read at the driver's own rate.


_FAST = 250.0  # 1/s; how fast a deviation is forgotten. Faster follows a swing better, slower hides the steps


class Phase:
    """A filter of the third order (fading memory, Morrison 1969): no lag at an even speed or acceleration.

    With 4096 steps a turn read every millisecond the angle is good to .02 degree at a speed of 3000 rpm that
    swings by 2 % four times a second.
    """

    def __init__(self, t: float, turns: float, speed: float) -> None:
        """A reading at ``t`` (s), and how fast it turns (turns/s, signed) as far as known."""
        self.t = t
        self.turns = turns
        self.speed = speed
        self.gain = 0.0  # of speed, turns/s²

    def note(self, t: float, turns: float) -> None:
        """A reading; one that is not newer than the last says nothing."""
        dt = t - self.t
        if dt <= 0.0:
            return
        self.turns, self.speed, self.t = self.at(t), self.speed + self.gain * dt, t
        keep = math.exp(-_FAST * dt)
        lose = 1.0 - keep
        off = turns - self.turns
        self.turns += (1.0 - keep**3) * off
        self.speed += 1.5 * lose * lose * (1.0 + keep) / dt * off
        self.gain += lose**3 / (dt * dt) * off

    def at(self, t: float) -> float:
        """Turns at ``t``, soon after the last reading."""
        dt = t - self.t
        return self.turns + (self.speed + 0.5 * self.gain * dt) * dt


State = tuple[tuple[float, ...], tuple[float, ...]]
Motion = tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]
_STANDS = 1e-6  # turns/s
_RESERVE = 1.2  # of an axis' acceleration, for its way and the spindle's changes of speed together
_LEFT = 0.2  # of it for those changes at least, where the way alone asks for much


class Slides(NamedTuple):
    """The slides of one machine; limits are one number an axis, mm/s and mm/s² (degrees for C)."""

    names: tuple[str, ...]
    vmax: tuple[float, ...]
    amax: tuple[float, ...]
    commit: float  # s
    tolerance: Tolerance  # of setpoints in time

    @classmethod
    def of(cls, axes: Sequence[AxisFigures], commit: float) -> Slides:
        """The slides of these axes, with ``commit`` in seconds."""
        vmax, amax = tuple(axis.vmax for axis in axes), tuple(axis.amax for axis in axes)
        return cls(tuple(axis.name for axis in axes), vmax, amax, commit, Tolerance.of(axes))


class Wall(NamedTuple):
    """From ``begins`` to ``ends`` (turns) the way may be played at the root of ``square``, turns²/s²."""

    begins: float
    ends: float
    square: float


class Walls:
    """The walls of a way in its order; all of it bears a change of speed of ``softest`` turns/s²."""

    def __init__(self, walls: Sequence[Wall], softest: float) -> None:
        self._walls = walls
        self._begins = [wall.begins for wall in walls]
        self._twice = 2.0 * softest
        # From each wall on, what the nearest of them leaves at turn 0: not all ahead are looked through.
        onwards = accumulate((wall.square + self._twice * wall.begins for wall in reversed(walls)), min)
        self._onwards = [*reversed([*onwards]), math.inf]

    def square(self, turns: float, reach: float) -> float:
        """The square of the speed that is free at ``turns``, turns²/s²: each wall may still be met ``reach``
        turns before it begins.
        """
        near = turns + reach
        ahead = bisect_right(self._begins, near)
        square = self._onwards[ahead] - self._twice * near if ahead < len(self._walls) else math.inf
        for _, ends, most in self._walls[max(bisect_right(self._begins, turns) - 1, 0) : ahead]:
            if ends > turns:
                square = min(square, most)
        return square


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
            raise DriverError(
                "the spindle is not turning, so no axis can be synchronized with the spindle",
                "thread-no-encoder",
            )
        self._queue = self._empty()
        self._walls = Walls([], math.inf)
        self.load(cam)

    def load(self, cam: Cam) -> None:
        """Replace what lies behind the start of this way."""
        if not self.fits(cam):
            raise DriverError(
                "the axes cannot change to another spindle index pulse while they are "
                "synchronized with the spindle",
                "broken-path",
                reason="other-index",
            )
        queue = self._queue if self.begun else self._empty()  # nothing of a way that is not begun stays
        queue.commit = self._slides.commit * self._speed
        queue.trim(self.turns)
        queue.splice(cam.way, self.turns)
        self._cam, self._queue = cam, queue
        self._walls = Walls(*self._walls_of(queue.pieces))

    def _empty(self) -> SetpointQueue:
        position, velocity = self._slides.tolerance.position, self._slides.tolerance.velocity
        per_turn = Tolerance(position, tuple(v / self._speed for v in velocity))
        return SetpointQueue(self._slides.names, self._standing, 0.0, per_turn)

    def fits(self, cam: Cam) -> bool:
        """Whether it counts from the same index."""
        return (cam.zero, cam.sign) == (self._cam.zero, self._cam.sign)

    @property
    def cam(self) -> Cam:
        """As loaded last."""
        return self._cam

    @property
    def spindle(self) -> float:
        """Turns a second of the spindle itself, positive the way the cam counts."""
        return self._cam.sign * self._phase.speed

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
        top, bend = self._limits(2.0 * self._speed * dt)
        need = (goal - self.turns) / dt
        if need <= top and (bend == math.inf or (need >= 0.0 and abs(need - self._speed) <= bend * dt)):
            self.turns, self._speed = goal, max(speed, 0.0)
            return
        if bend < math.inf:
            behind = goal - speed * dt - self.turns
            wanted = speed + math.copysign(math.sqrt(2.0 * bend * abs(behind)), behind)
            least, most = self._speed - bend * dt, self._speed + bend * dt
            top = min(max(min(max(wanted, 0.0), top), least), most)
        self._speed = top
        self.turns += self._speed * dt

    def _limits(self, reach: float) -> tuple[float, float]:
        """Speed and change of speed, turns/s and turns/s², that no slide exceeds here; endless at rest.

        The speed is also that from which what comes on the way can still be met, looked at ``reach`` turns
        earlier: a setpoint holds for its interval.
        """
        _, per_turn, accel = self._queue.motion_at(self.turns)
        bend = math.inf
        for v, a, amax in zip(per_turn, accel, self._slides.amax, strict=True):
            if v:
                spare = _RESERVE * amax - abs(a) * self._speed**2
                bend = min(bend, max(spare, _LEFT * amax) / abs(v))
        return math.sqrt(self._walls.square(self.turns, reach)), bend

    def _walls_of(self, pieces: Sequence[Piece]) -> tuple[list[Wall], float]:
        """How fast each piece of the way may be played, and the change of speed that all of them bear."""
        walls, softest = [], math.inf
        for piece in pieces:
            most = math.inf
            ends = zip(piece.v, piece.a, self._slides.vmax, self._slides.amax, strict=True)
            for v, a, vmax, amax in ends:
                fastest = max(abs(v), abs(v + a * piece.dt))
                if fastest:
                    most = min(most, (vmax / fastest) ** 2)
                    softest = min(softest, _RESERVE * amax / fastest)
                if a:
                    most = min(most, amax / abs(a))
            if most < math.inf:
                walls.append(Wall(piece.t, piece.t + piece.dt, most))
        return walls, softest


# --- The setpoint queue of a driver with a gear: played by time, or for a while by the turns of the spindle.


class GearedQueue(SetpointQueue):
    """As SetpointQueue, and ``mesh`` and ``play``; not thread-safe, its driver locks."""

    def __init__(self, slides: Slides, rest: Sequence[float]) -> None:
        super().__init__(slides.names, rest, slides.commit, slides.tolerance)
        self._slides = slides
        self._gearing: Gearing | None = None

    @property
    def meshed(self) -> bool:
        """Whether the slides follow the spindle; then ``play`` has to be called at the driver's rate."""
        return self._gearing is not None

    def geared(self) -> Geared | None:
        """As ``core.ports.Gear`` says."""
        gearing = self._gearing
        return None if gearing is None else Geared(gearing.turns, gearing.lag, gearing.spindle)

    def mesh(self, cam: Cam, phase: Phase, now: float) -> None:
        """Follow the spindle, whose ``phase`` is that of ``now``; raises as ``core.ports.Gear`` says."""
        gearing = self._gearing
        if gearing is not None and (gearing.begun or gearing.fits(cam)):
            gearing.load(cam)
            return
        if gearing is None and not at_rest(self.horizon(now), now):
            raise DriverError(
                "the axes must be at rest before they can be synchronized with the spindle",
                "broken-path",
                reason="not-at-rest",
            )
        self._gearing = Gearing(cam, phase, self._slides, self._rest)

    def play(self, t: float, read_at: float, count: float) -> Motion:
        """The setpoint for ``t`` while the slides follow the spindle, after a reading of its encoder."""
        assert self._gearing is not None
        motion = self._gearing.play(t, read_at, count)
        if self._gearing.over:
            self._leave(t, self._gearing)
        return motion

    def rest_at(self, position: Sequence[float]) -> None:
        """At rest there, and no longer led by the spindle."""
        self._gearing = None
        super().rest_at(position)

    def horizon(self, now: float) -> float:
        """End of what is queued, s; of a way by the spindle as its speed of now foretells it."""
        if self._gearing is None:
            return super().horizon(now)
        then = self._gearing.cam.then
        ends = self._gearing.ends() + (0.0 if then is None else float(then.t[-1] + then.dt[-1]))
        return max(ends, now + self.commit)  # foretold as over, and yet not played to its end

    def demand_at(self, t: float) -> State:
        """Position and velocity that are queued for ``t``, or foretold by the spindle's speed."""
        return super().demand_at(t) if self._gearing is None else self._gearing.at(t)

    def splice(self, segments: Segments, now: float) -> None:
        """Go on by time. Raises DriverError while the slides still follow the spindle at its beginning."""
        gearing = self._gearing
        if gearing is not None and len(segments.t) and not gearing.still_at(float(segments.t[0])):
            raise DriverError(
                "the axes are synchronized with the spindle; stop the axes before you start a "
                "time-based move",
                "broken-path",
                reason="follows-spindle",
            )
        super().splice(segments, now)
        self._gearing = None

    def brake(self, now: float, decel: Sequence[float]) -> float:
        """Leave the spindle, and straight to rest (decelerations in mm/s²); returns when it ends, s."""
        state = self.demand_at(now)
        if self._gearing is not None:
            self.rest_at(state[0])
        return self._brake(now, state, decel)

    def _leave(self, t: float, gearing: Gearing) -> None:
        """Behind the end of the way: rest, or what goes on by time."""
        self.rest_at(gearing.rest)
        then = gearing.cam.then
        if then is not None:
            super().splice(then._replace(t=then.t + t), t - self.commit)
