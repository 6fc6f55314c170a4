"""A thread pass tied to the measured spindle angle: by setpoints planned anew, or by gear.

The slide is in step when s = lead · (turns - index): s along Z from the start of the pass, turns as the
encoder counts them. So every pass enters at the same angle, whatever the speed. The queue always holds the
whole pass, pull-out and rest included, as the spindle is expected to turn; each tick corrects that from a
commit ahead on.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence

import numpy as np

from core.executor.program_motion.thread_curve import turns_of
from core.executor.program_motion.thread_path import Phases, ThreadPath
from core.executor.spindle_control import SpindleAngle
from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits
from core.ports import AxisSink, Cam, DriverError, Gear, Geared, Segments, Stop

_BLEND = 0.01  # s in which a deviation is taken out
_LONGEST = 0.16  # s; a deviation that takes more is no wander
_EARLY = 0.01  # s between the first plan and the start, in which the start can still be corrected
_SHARE = 0.7  # of the acceleration for running up: the rest corrects
_PATIENCE = 0.002  # s more for a braking, which has one try
_TRIES = 3
_OVER = 1.0005  # of the greatest speed, for what corrections need
_AT_START = 1e-6  # mm
_ALLOWED = 0.01  # turns, between the slide and the spindle
_log = logging.getLogger(__name__)
_GEARED_SHARE = 0.9  # of the acceleration; the rest is for a spindle that turns faster than foretold
_AHEAD = 0.01  # s between the plan and what it changes, doubled where that was too short
_FURTHER_AHEAD = tuple(_AHEAD * 2**attempt for attempt in range(4))
_FROM_REST = tuple(_AHEAD * 2**attempt for attempt in range(7))  # .64 s: at rest a later index costs no more
_CHANGED = 0.005  # of the speed: more, and what is still to come is planned again
_SLOWEST = 0.1  # turns/s; a spindle that is as good as still asks for no other plan
_ROUNDING = 1e-9  # turns
_BEGINS = {"late", "broken-path"}  # what a driver says of setpoints behind a start that is near


class SpindlePass:
    """One pass, tied to the spindle by setpoints or by gear, and how far it has come from it."""

    def __init__(
        self, axes: AxisSink, limits: MotionLimits, turns: SpindleAngle, blocks: Sequence[Block]
    ) -> None:
        self._axes = axes
        self._turns = turns
        self._path = ThreadPath.of(blocks, limits)
        self.blocks = tuple(blocks)
        self._sign = 1.0  # of the spindle
        self._stopped = False
        self._reported = False
        self.worst = 0.0  # turns between the slide and the spindle while in step

    def cut_at(self, turns: float) -> Block:
        """The block of the thread that is cut so many turns behind the start of the pass."""
        cut = [self.blocks[0], *(block for block in self.blocks[1:] if block.continues)]
        for block in cut:
            turns -= turns_of(block)
            if turns < 0.0:
                return block
        return cut[-1]

    @property
    def complete(self) -> bool:
        """Whether what is queued is the whole pass."""
        return not self._stopped

    def lost_step(self) -> bool:
        """Whether slide and spindle have come too far apart for a good thread; True once a pass."""
        before, self._reported = self._reported, self.worst > _ALLOWED
        return self._reported and not before


class ThreadPass(SpindlePass):
    """Blocks of one pass: the thread, and behind it its pull-out or the rapid straight out.

    Raises AlarmError where the spindle does not turn or has no encoder.
    """

    def __init__(
        self, axes: AxisSink, limits: MotionLimits, turns: SpindleAngle, blocks: Sequence[Block]
    ) -> None:
        super().__init__(axes, limits, turns, blocks)
        self._top = limits.vmax[1]
        self._lead, self._ramp = self._path.lead, _SHARE * self._path.a
        self._index = 0.0  # turns, unsigned, at which s = 0 is in step
        self._begins = 0.0, 0.0  # when the running up begins, and the speed it leads to
        self._leaves = math.inf  # when the thread itself ends
        self._ends = math.inf
        self._cost = 0.0
        self._free = False  # too near its end for another plan

    @property
    def end(self) -> float:
        """When the pass comes to rest as planned now, s."""
        return self._ends

    def block(self, now: float) -> Block:
        """The block being played."""
        if now >= self._leaves:
            return self.blocks[-1]
        return self.cut_at(self._demand(now)[0] / self._lead) if len(self.blocks) > 1 else self.blocks[0]

    def begin(self) -> None:
        """Choose the index and queue the pass from rest."""
        now = self._axes.now()
        # Nothing of it is done: what cannot be queued begins when it goes on.
        self._stopped, self._ends, self._leaves, self._index = True, now, math.inf, 0.0
        turns, speed = self._state(now)
        v = min(self._lead * speed, self._top)
        earliest = now + self._axes.commit + _EARLY + 0.5 * v / self._ramp
        self._index = math.ceil(turns + speed * (earliest - now) - 1e-9)
        for _ in range(_TRIES):
            if self._replan():
                self._stopped = False
                return
        raise DriverError("the thread moves could not be queued in time", "late")

    def track(self) -> None:
        """Once a tick: correct the way from a commit ahead on, and see how well the last one was met."""
        now = self._axes.now()
        if self._stopped or now >= self._leaves or self._turns.at(now) is None:
            return  # without an encoder what is queued is the best way out
        self._measure(now)
        if self._free:
            return
        self._replan()

    def _replan(self) -> bool:
        """Plan and queue; False when that came too late, and what is queued goes on."""
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

    def hold(self) -> None:
        """A pass that has not begun to move does not begin; any other is finished."""
        t = self._axes.now() + self._axes.commit + max(1.5 * self._cost, _PATIENCE)
        if self._stopped or t >= self._begins[0]:
            return
        place, _ = self._axes.demand_at(t)
        self._axes.splice(Segments.resting(t, place))
        self._stopped, self._ends, self._leaves = True, t, math.inf

    def go_on(self) -> None:
        """Begin again after a hold before the first motion, at another index."""
        s, v = self._demand(self._axes.now())
        if self._stopped and abs(s) <= _AT_START and v == 0.0:
            self.begin()

    def brake(self) -> None:
        """Come to rest along the thread; a pass that is already leaving it is left alone."""
        t = self._axes.now() + self._axes.commit + max(1.5 * self._cost, _PATIENCE)
        s, v = self._demand(t)
        if self._stopped or t >= self._leaves or s + 0.5 * v * v / self._path.a >= self._path.length:
            return
        self._axes.splice(self._path.stopping(t, s, v))
        self._stopped, self._ends, self._leaves = True, t + v / self._path.a, math.inf

    def _queue(self, t: float) -> None:
        s, v = self._demand(t)
        lead_in = self._run_up(t) if s <= _AT_START and v <= 0.0 else None
        if lead_in is None:
            lead_in = self._blend(t, s, v)
        if lead_in is None:
            return
        segments, leaves = self._path.onwards(t, s, v, lead_in)
        if np.abs(segments.v[:, 1]).max() > self._top * _OVER:
            return  # faster than the slide: it falls behind, and that is told
        self._axes.splice(segments)
        self._leaves, self._ends = leaves, _end(segments)

    def _run_up(self, t: float) -> Phases | None:
        """From rest: wait, then accelerate onto the line; None where the start is past already."""
        starts, v = self._begins = self._start()
        if starts < t:
            return None
        return [(starts - t, 0.0), (v / self._ramp, self._ramp)]

    def _blend(self, t: float, s: float, v: float) -> Phases | None:
        """Two accelerations that lead onto the line, never backwards; None where no room is left for that."""
        path, time = self._path, _BLEND
        while time <= _LONGEST:
            goal, speed, rest = self._target(t + time)
            if goal >= path.full_depth(speed):
                self._free = True
                return None
            half = 0.5 * time
            gain, ahead = (speed - v) / half, (goal - s - v * time) / (half * half)
            first, second = ahead - 0.5 * gain, 1.5 * gain - ahead
            onwards = min(v + first * half, speed) >= 0.0 or v < 0.0
            if onwards and max(abs(first), abs(second)) <= path.a:
                return [(half, first), (half, second), *rest]
            time *= 2.0
        return None

    def _target(self, t: float) -> tuple[float, float, Phases]:
        """Where the slide ought to be at ``t`` and how fast, and the rest of its running up."""
        starts, v = self._begins
        into = t - starts
        if into * self._ramp < v:
            into = max(into, 0.0)
            left = (v / self._ramp) - into
            return 0.5 * self._ramp * into * into, self._ramp * into, [(left, self._ramp)]
        turns, speed = self._state(t)
        return self._lead * (turns - self._index), self._lead * speed, []

    def _start(self) -> tuple[float, float]:
        """When to begin to be in step behind the ramp, and the speed it leads to.

        Half the ramp before the index: a slide that speeds up from rest lags behind one that moves by
        v²/2a, which it must have begun v/2a earlier.
        """
        at = self._axes.now()
        for _ in range(3):
            turns, speed = self._state(at)
            at += (self._index - turns) / speed
        v = min(self._lead * speed, self._top)
        return at - 0.5 * v / self._ramp, v

    def _state(self, t: float) -> tuple[float, float]:
        """Turns and turns per second at ``t``, both counted in the direction in which the spindle turns."""
        state = self._turns.turning_at(t)
        if self._index == 0.0:
            self._sign = math.copysign(1.0, state[1])
        return self._sign * state[0], self._sign * state[1]

    def _measure(self, now: float) -> None:
        """How far the setpoints are from the spindle, in leads, once the slide is up to speed."""
        s, v = self._demand(now)
        turns, speed = self._state(now)
        if v < 0.9 * self._lead * speed:
            return
        self.worst = max(self.worst, abs(s / self._lead - (turns - self._index)))

    def _demand(self, t: float) -> tuple[float, float]:
        (_, z, _), (_, v, _) = self._axes.demand_at(t)
        return self._path.place(z, v)


def _end(segments: Segments) -> float:
    return float(segments.t[-1] + segments.dt[-1])


class GearedThreadPass(SpindlePass):
    """Blocks of one pass, as a cam along which the driver's slides follow the spindle, planned once.

    The slide is in step when s = lead · turns, counted from an index that is chosen when the pass begins.
    Running up, pull-out and rest are on the cam too: they depend on the spindle's speed only in that they
    have to stay within what the slides can do.

    Raises AlarmError where the spindle does not turn or has no encoder.
    """

    def __init__(
        self, axes: AxisSink, gear: Gear, limits: MotionLimits, turns: SpindleAngle, blocks: Sequence[Block]
    ) -> None:
        super().__init__(axes, limits, turns, blocks)
        self._gear = gear
        self._zero = 0.0
        self._speed = 0.0  # turns/s, for which the cam is planned
        self._ramp = 0.0  # turns of running up
        self._leaves = math.inf  # turns at which the thread itself ends

    @property
    def end(self) -> float:
        """When the pass will come to rest at the present speed."""
        return self._axes.horizon()

    def block(self, _now: float) -> Block:
        """The block being played."""
        geared = self._gear.geared()
        if geared is None:
            return self.blocks[0] if self._stopped else self.blocks[-1]
        return self.blocks[-1] if geared.turns >= self._leaves else self.cut_at(geared.turns)

    def begin(self) -> None:
        """Choose the index and hand the pass over, from rest."""
        self._stopped = True  # nothing of it is done: what cannot be queued begins when it goes on
        for early in _FROM_REST:
            if self._mesh_from_rest(early):
                self._stopped = False
                return
        raise DriverError("the thread moves could not be queued in time", "late")

    def track(self) -> None:
        """Once a tick: see how well it is followed; plan the end again when the speed has changed."""
        geared = self._gear.geared()
        state = self._turns.at(self._axes.now())
        if self._stopped or geared is None or state is None:
            return
        if self._ramp < geared.turns < self._leaves:
            self.worst = max(self.worst, abs(geared.lag))
        speed = self._sign * state[1]
        if abs(speed - self._speed) > _CHANGED * self._speed and speed > _SLOWEST:
            self._go_on_at(speed, geared)

    def hold(self) -> None:
        """A pass that has not begun to move does not begin; any other is finished."""
        t = self._axes.now() + self._axes.commit + _AHEAD
        geared = self._gear.geared()
        if self._stopped or geared is None or self._reached(geared, t) >= -self._ramp:
            return
        place, _ = self._axes.demand_at(t)
        try:
            self._axes.splice(Segments.resting(t, place))
        except DriverError as error:
            if error.code not in _BEGINS:
                raise
            return  # it ends behind its pull-out
        self._stopped = True

    def go_on(self) -> None:
        """Begin again after a hold before the first motion, at another index."""
        (_, z, *_), _ = self._axes.demand_at(self._axes.now())
        if self._stopped and self._gear.geared() is None and abs(z - self._path.z) <= _AT_START:
            self.begin()

    def brake(self) -> None:
        """Come to rest along the thread; a pass that only draws X back is left alone."""
        if self._stopped or self._gear.geared() is None:
            return
        self._axes.stop(Stop.RAMP_HOLD)
        self._stopped = True

    def _mesh_from_rest(self, early: float) -> bool:
        """Plan the whole pass; False when that came too late."""
        state = self._turns.turning_at(self._axes.now())
        self._sign, self._speed = math.copysign(1.0, state[1]), abs(state[1])
        self._ramp = self._running_up(self._speed)
        first = self._sign * state[0] + self._speed * (self._axes.commit + early)
        self._zero = self._sign * math.ceil(first + self._ramp - _ROUNDING)
        try:
            self._mesh_up(self._speed, self._ramp)
        except DriverError as error:
            if error.code != "late":
                raise
            return False
        return True

    def _running_up(self, speed: float) -> float:
        """Turns from rest to the index: a slide that speeds up from rest lags behind one that moves by
        v²/2a, which it must have begun v/2a earlier; half of its running up."""
        return 0.5 * self._path.lead * speed**2 / (_GEARED_SHARE * self._path.a)

    def _go_on_at(self, speed: float, geared: Geared) -> None:
        """What is still to come, for another speed: the running up, or what follows the thread.

        What was handed over before is a whole pass: where a change of it is refused that goes on, and a slide
        that it asks too much of slips.
        """
        path, ramp = self._path, self._running_up(speed)
        for early in _FURTHER_AHEAD:
            turns = self._reached(geared, self._axes.now() + self._axes.commit + early)
            try:
                if turns < -max(ramp, self._ramp):
                    self._mesh_up(speed, ramp)
                elif turns > self._ramp and path.lead * turns < self._paced(speed).full_depth(path.lead):
                    self._mesh(turns, path.lead * turns, path.lead, speed, [])
            except DriverError as error:
                if error.code == "late":
                    continue
                _log.info("a thread pass goes on as planned for another speed: %s", error)
            return

    def _mesh_up(self, speed: float, ramp: float) -> None:
        """The whole path, from rest ``ramp`` turns before the index. Raises DriverError."""
        self._mesh(-ramp, 0.0, 0.0, speed, [(2.0 * ramp, 0.5 * self._path.lead / ramp)])
        self._ramp = ramp

    def _mesh(self, turns: float, s: float, v: float, speed: float, up: Phases) -> None:
        """Hand over the path from ``turns`` on, where the slide is at ``s`` with ``v`` mm per turn.

        Raises DriverError; what was handed over before then goes on.
        """
        path, leaves = self._paced(speed).onwards(turns, s, v, up)
        self._gear.mesh(Cam(self._zero, self._sign, path, self._path.drawn_back()))
        self._leaves, self._speed = leaves, speed

    def _paced(self, speed: float) -> ThreadPath:
        """The path with limits per turn, up to where the spindle still matters."""
        path, share = self._path, _GEARED_SHARE / speed**2
        out = path.out if path.beyond else path.x_end
        return path._replace(a=path.a * share, ax=path.ax * share, az=path.az * share, out=out)

    def _reached(self, geared: Geared, t: float) -> float:
        """Turns that the cam will not have been played beyond at ``t``, the spindle not speeding up."""
        return geared.turns + max(self._speed, geared.speed) * (t - self._axes.now())
