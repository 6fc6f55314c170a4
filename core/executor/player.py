"""Plays one stretch of motion, from rest to rest, on the axes: plans it, keeps it queued, brakes it, goes on.

Hold, override and single block are the same act: plan from the present state, splice the result.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from core.executor.geared_pass import GearedPass
from core.executor.plan_queue import PlanQueue
from core.executor.stretch import Scales, Stretch
from core.executor.thread_pass import ThreadPass
from core.executor.tracks import Track
from core.executor.turns import Turns
from core.interpreter.elementary_blocks import Block
from core.motion.limits import MotionLimits
from core.motion.path import Path
from core.motion.plan import plan
from core.motion.profile import Profile
from core.ports import AxisSink, Gear, at_rest

_LEAST = 0.2  # of the acceleration: what braking has in short chords at least


class Player:
    """One stretch at a time; called by the executor's thread alone."""

    def __init__(self, axes: AxisSink, limits: MotionLimits, lookahead: float) -> None:
        self._axes = axes
        self._limits = limits
        self._queue = PlanQueue(axes, lookahead)
        self._stretch: Stretch | None = None
        self._pass: ThreadPass | GearedPass | None = None  # instead of a stretch
        self._shown: Block | None = None
        self._stepped: int | None = None  # the block at whose end single block has come to rest

    @property
    def active(self) -> bool:
        """Whether there is a stretch at all."""
        return self._stretch is not None or self._pass is not None

    @property
    def out_of_step(self) -> bool:
        """Whether a thread pass has just lost the spindle by more than a hundredth of its lead; said once."""
        return self._pass is not None and self._pass.lost_step()

    @property
    def planned_to(self) -> float:
        """When the present plan comes to rest."""
        return self._pass.end if self._pass is not None else self._queue.planned_to

    @property
    def starving(self) -> float:
        """When the tail begins although the plan goes on; endless when the whole plan is queued."""
        return np.inf if self._pass is not None else self._queue.starving

    def begin(self, blocks: Iterable[Block], rpm_max: float) -> None:
        """A new stretch from where the slides rest. Raises MotionError for a block that cannot be moved."""
        self.forget()
        self._stretch = Stretch(self._limits, rpm_max)
        self._stretch.add(blocks)

    def begin_pass(self, blocks: Sequence[Block], turns: Turns, gear: Gear | None) -> None:
        """A thread pass: it follows the spindle, so overrides, holds and single blocks act at its end.

        Inside the driver where it has a gear, else by setpoints in time. Raises TroubleError without a
        turning spindle, DriverError.
        """
        self.forget()
        self._pass = (
            ThreadPass(self._axes, self._limits, turns, blocks)
            if gear is None
            else GearedPass(self._axes, gear, self._limits, turns, blocks)
        )
        self._pass.begin()

    def add(self, blocks: Iterable[Block]) -> None:
        """More of the stretch; planned with the next ``go``."""
        assert self._stretch is not None
        self._stretch.add(blocks, self._reached())

    def forget(self) -> None:
        """The stretch is over, or nothing of it holds any more."""
        self._stretch = self._shown = self._pass = self._stepped = None
        self._queue.clear()

    def go(self, scales: Scales, last: int | None = None, *, soon: bool = True) -> None:
        """Plan on from the present state and splice. ``last``: the block at whose end to stop.

        ``soon`` takes effect as soon as the queue allows; without it what is queued stays and the plan goes
        on behind it. Raises MotionError and DriverError.
        """
        if self._pass is not None:
            self._pass.go_on()
        else:
            self._queue.splice(lambda t: self._plan_on(t, scales, last), soon=soon)

    def hold(self, scales: Scales) -> None:
        """Come to rest as soon as the path allows; a thread pass ends behind its pull-out."""
        if self._pass is not None:
            self._pass.hold()
        else:
            self._queue.splice(lambda t: self._plan_stop(t, scales), soon=True)

    def release(self) -> bool:
        """Give a thread pass back that has not begun to move; False when it has."""
        if self._pass is not None:
            self._pass.hold()
        return self._pass is not None and not self._pass.complete

    def brake(self) -> None:
        """Come to rest at once on the path, thread or not."""
        if self._pass is not None:
            self._pass.brake()
        else:
            self._queue.splice(lambda t: self._plan_stop(t, Scales()), soon=True)

    def let_stop(self) -> None:
        """Leave the tail in the queue as it is: what was planned beyond it no longer holds."""
        self._queue.let_stop()

    def extend(self, now: float) -> bool:
        """Keep the queue filled from the present plan; False when it is too late for that."""
        if self._pass is not None:
            self._pass.track()
        return self._queue.extend(now)

    def settle_at(self, last: int | None, now: float) -> int | None:
        """The first block at or after ``last`` at whose end the slides can still come to rest."""
        if self._pass is not None:
            return self._pass.blocks[-1].n
        assert self._stretch is not None
        if self._queue.last is None:
            return self._stretch.stoppable(last, -np.inf)
        return self._stretch.stoppable(last, self._plan_stop(self._queue.lead(now), Scales()).end_s)

    def at_rest(self) -> bool:
        """Nothing that was queued moves any more. The clock goes on between two questions: ask it last."""
        horizon = self._axes.horizon()
        return at_rest(horizon, self._axes.now())

    def complete(self) -> bool:
        """Whether what is queued ends where the stretch does."""
        if self._pass is not None:
            return self._pass.complete
        track = self._queue.last
        if self._stretch is None or not self._stretch.length:
            return True
        return track is not None and track.profile.end_s >= self._stretch.end_s - 1e-9

    def step_over(self, last: int) -> bool:
        """At rest: whether block ``last`` is done, with way or without; it then is the one being played."""
        if self._pass is not None:
            return self._pass.complete
        assert self._stretch is not None
        track = self._queue.last
        if track is None or track.profile.end_s < self._stretch.end_of(last) - 1e-9:
            return False
        self._stepped = last
        return True

    def steps_left(self) -> bool:
        """At rest: whether there are blocks behind the one that was reached, if only such as go nowhere."""
        if self._stretch is None:
            return False
        at = self.block(self._axes.now())
        return at is None or bool(self._stretch.behind(at.n))

    def block(self, now: float) -> Block | None:
        """The block being played, not one planned ahead."""
        if self._pass is not None:
            return self._pass.block(now)
        if self._stretch is None:
            return None
        track = self._queue.at(now)
        playing = self._stretch.block(track.block(now)) if track else None
        if self._stepped is not None and (playing is None or playing.n < self._stepped):
            playing = self._stretch.block(self._stepped)
        self._shown = playing or self._shown or self._stretch.first_block
        return self._shown

    def ended_with(self) -> Block | None:
        """At the end of the stretch: its last block, which may go nowhere."""
        if self._pass is not None:
            return self._pass.blocks[-1]
        return self._stretch.last_block if self._stretch is not None else None

    def following(self) -> Block | None:
        """The block behind the one being played, when it belongs to the stretch."""
        if self._pass is not None:
            behind = self.behind(self._pass.block(self._axes.now()))
            return behind[0] if behind else None
        return self._stretch.block(self._shown.n + 1) if self._stretch and self._shown else None

    def behind(self, block: Block) -> list[Block]:
        """Blocks of the stretch that come after this one."""
        if self._pass is not None:
            return [each for each in self._pass.blocks if each.n > block.n]
        return self._stretch.behind(block.n) if self._stretch else []

    def _reached(self) -> float:
        """Distance before which the motion under way can come to rest, from when it can be changed on."""
        t = self._queue.latest(self._axes.now())
        track = self._queue.at(t)
        if track is None:
            return -np.inf
        s, v = track.state(t)
        return s + v * v / (2.0 * _LEAST * self._limits.plane_acceleration)

    def _plan_on(self, t: float, scales: Scales, last: int | None) -> Profile:
        assert self._stretch is not None
        playing = self.block(self._axes.now())
        self._stretch.drop_before(playing.n if playing else None)
        return _planned(self._stretch.path(scales, last), self._queue.at(t), t)

    def _plan_stop(self, t: float, scales: Scales) -> Profile:
        assert self._stretch is not None
        return _planned(self._stretch.path(scales, None), self._queue.at(t), t, stop=True)


def _planned(path: Path, playing: Track | None, t: float, *, stop: bool = False) -> Profile:
    """A plan from the state in which the one that is being played is at ``t``; from rest without one."""
    if playing is None:
        return plan(path, stop=stop)
    s, v = playing.state(t)
    return plan(path, start_s=s, start_v=v, stop=stop)
