"""A thread pass by gear: the driver's slides follow the spindle by themselves along a cam, planned once.

The slide is in step when s = lead · turns: s along Z from the start of the pass, turns counted from an index
that is chosen when the pass begins. Running up, pull-out and rest are on the cam too, so they only depend on
the spindle's speed in that they have to stay within what the slides can do.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence

from core.executor.spindle_control import SpindleAngle
from core.executor.thread_pass import SpindlePass
from core.executor.thread_path import Phases, ThreadPath
from core.interpreter.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits
from core.ports import AxisSink, Cam, DriverError, Gear, Geared, Segments, Stop

_log = logging.getLogger(__name__)

_SHARE = 0.9  # of the acceleration; the rest is for a spindle that turns faster than foretold
_EARLY = 0.01  # s between the plan and what it changes, doubled where that was too short
_EARLIER = tuple(_EARLY * 2**attempt for attempt in range(4))
_FROM_REST = tuple(_EARLY * 2**attempt for attempt in range(7))  # .64 s: at rest a later index costs no more
_CHANGED = 0.005  # of the speed: more, and what is still to come is planned again
_SLOWEST = 0.1  # turns/s; a spindle that is as good as still asks for no other plan
_ROUNDING = 1e-9  # turns
_BEGINS = {"late", "broken-path"}  # what a driver says of setpoints behind a start that is near
_AT_START = 1e-6  # mm


class GearedThreadPass(SpindlePass):
    """Blocks of one pass: the thread, and behind it its pull-out or the rapid straight out.

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
        t = self._axes.now() + self._axes.commit + _EARLY
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
        return 0.5 * self._path.lead * speed**2 / (_SHARE * self._path.a)

    def _go_on_at(self, speed: float, geared: Geared) -> None:
        """What is still to come, for another speed: the running up, or what follows the thread.

        What was handed over before is a whole pass: where a change of it is refused that goes on, and a slide
        that it asks too much of slips.
        """
        path, ramp = self._path, self._running_up(speed)
        for early in _EARLIER:
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
        path, share = self._path, _SHARE / speed**2
        out = path.out if path.beyond else path.x_end
        return path._replace(a=path.a * share, ax=path.ax * share, az=path.az * share, out=out)

    def _reached(self, geared: Geared, t: float) -> float:
        """Turns that the cam will not have been played beyond at ``t``, the spindle not speeding up."""
        return geared.turns + max(self._speed, geared.speed) * (t - self._axes.now())
