"""The moving part of a cycle: stretches from rest to rest under overrides, single block and read-ahead."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence

import numpy as np

from core.executor.geared_thread_pass import GearedThreadPass
from core.executor.machine_context import MachineContext
from core.executor.path_section import Overrides, PathSection, Progress
from core.executor.plan_queue import PlanQueue, Track
from core.executor.raised_alarm import AlarmError
from core.executor.read_ahead import ReadAhead
from core.executor.spindle_control import SpindleAngle
from core.executor.thread_pass import ThreadPass
from core.interpreter.elementary_blocks import Block, Kind
from core.motion.axis_limits import MotionLimits
from core.motion.motion_path import Path
from core.motion.motion_plan import plan
from core.motion.motion_profile import Profile
from core.ports import AxisSink, Gear, at_rest

# --- playing one path section ---------------------------------------------------------------------------


_LEAST = 0.2  # of the acceleration: what braking has in short chords at least


class Player:
    """One stretch at a time; called by the executor's thread alone."""

    def __init__(self, axes: AxisSink, limits: MotionLimits, lookahead: float) -> None:
        self._axes = axes
        self._limits = limits
        self._queue = PlanQueue(axes, lookahead)
        self._section: PathSection | None = None
        self._pass: ThreadPass | GearedThreadPass | None = None  # instead of a stretch
        self._shown: Block | None = None
        self._stepped: int | None = None  # the block at whose end single block has come to rest

    @property
    def active(self) -> bool:
        """Whether there is a stretch at all."""
        return self._section is not None or self._pass is not None

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
        self._section = PathSection(self._limits, rpm_max)
        self._section.add(blocks)

    def begin_pass(self, blocks: Sequence[Block], turns: SpindleAngle, gear: Gear | None) -> None:
        """A thread pass: it follows the spindle, so overrides, holds and single blocks act at its end.

        Inside the driver where it has a gear, else by setpoints in time. Raises TroubleError without a
        turning spindle, DriverError.
        """
        self.forget()
        self._pass = (
            ThreadPass(self._axes, self._limits, turns, blocks)
            if gear is None
            else GearedThreadPass(self._axes, gear, self._limits, turns, blocks)
        )
        self._pass.begin()

    def add(self, blocks: Iterable[Block]) -> None:
        """More of the stretch; planned with the next ``go``."""
        assert self._section is not None
        self._section.add(blocks, self._reached())

    def forget(self) -> None:
        """The stretch is over, or nothing of it holds any more."""
        self._section = self._shown = self._pass = self._stepped = None
        self._queue.clear()

    def go(self, scales: Overrides, last: int | None = None, *, soon: bool = True) -> None:
        """Plan on from the present state and splice. ``last``: the block at whose end to stop.

        ``soon`` takes effect as soon as the queue allows; without it what is queued stays and the plan goes
        on behind it. Raises MotionError and DriverError.
        """
        if self._pass is not None:
            self._pass.go_on()
        else:
            self._queue.splice(lambda t: self._plan_on(t, scales, last), soon=soon)

    def hold(self, scales: Overrides) -> None:
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
            self._queue.splice(lambda t: self._plan_stop(t, Overrides()), soon=True)

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
        assert self._section is not None
        if self._queue.last is None:
            return self._section.stoppable(last, -np.inf)
        return self._section.stoppable(last, self._plan_stop(self._queue.lead(now), Overrides()).end_s)

    def at_rest(self) -> bool:
        """Nothing that was queued moves any more. The clock goes on between two questions: ask it last."""
        horizon = self._axes.horizon()
        return at_rest(horizon, self._axes.now())

    def complete(self) -> bool:
        """Whether what is queued ends where the stretch does."""
        if self._pass is not None:
            return self._pass.complete
        track = self._queue.last
        if self._section is None or not self._section.length:
            return True
        return track is not None and track.profile.end_s >= self._section.end_s - 1e-9

    def step_over(self, last: int) -> bool:
        """At rest: whether block ``last`` is done, with way or without; it then is the one being played."""
        if self._pass is not None:
            return self._pass.complete
        assert self._section is not None
        track = self._queue.last
        if track is None or track.profile.end_s < self._section.end_of(last) - 1e-9:
            return False
        self._stepped = last
        return True

    def steps_left(self) -> bool:
        """At rest: whether there are blocks behind the one that was reached, if only such as go nowhere."""
        if self._section is None:
            return False
        at = self.block(self._axes.now())
        return at is None or bool(self._section.behind(at.n))

    def block(self, now: float) -> Block | None:
        """The block being played, not one planned ahead."""
        if self._pass is not None:
            return self._pass.block(now)
        if self._section is None:
            return None
        track = self._queue.at(now)
        playing = self._section.block(track.block(now)) if track else None
        if self._stepped is not None and (playing is None or playing.n < self._stepped):
            playing = self._section.block(self._stepped)
        self._shown = playing or self._shown or self._section.first_block
        return self._shown

    def ended_with(self) -> Block | None:
        """At the end of the stretch: its last block, which may go nowhere."""
        if self._pass is not None:
            return self._pass.blocks[-1]
        return self._section.last_block if self._section is not None else None

    def following(self) -> Block | None:
        """The block behind the one being played, when it belongs to the stretch."""
        if self._pass is not None:
            behind = self.behind(self._pass.block(self._axes.now()))
            return behind[0] if behind else None
        return self._section.block(self._shown.n + 1) if self._section and self._shown else None

    def behind(self, block: Block) -> list[Block]:
        """Blocks of the stretch that come after this one."""
        if self._pass is not None:
            return [each for each in self._pass.blocks if each.n > block.n]
        return self._section.behind(block.n) if self._section else []

    def _reached(self) -> float:
        """Distance before which the motion under way can come to rest, from when it can be changed on."""
        t = self._queue.latest(self._axes.now())
        track = self._queue.at(t)
        if track is None:
            return -np.inf
        s, v = track.state(t)
        return s + v * v / (2.0 * _LEAST * self._limits.plane_acceleration)

    def _plan_on(self, t: float, scales: Overrides, last: int | None) -> Profile:
        assert self._section is not None
        playing = self.block(self._axes.now())
        self._section.drop_before(playing.n if playing else None)
        return _planned(self._section.path(scales, last), self._queue.at(t), t)

    def _plan_stop(self, t: float, scales: Overrides) -> Profile:
        assert self._section is not None
        return _planned(self._section.path(scales, None), self._queue.at(t), t, stop=True)


def _planned(path: Path, playing: Track | None, t: float, *, stop: bool = False) -> Profile:
    """A plan from the state in which the one that is being played is at ``t``; from rest without one."""
    if playing is None:
        return plan(path, stop=stop)
    s, v = playing.state(t)
    return plan(path, start_s=s, start_v=v, stop=stop)


# --- out of a thread ------------------------------------------------------------------------------------


_RETRACTED = 1e-6  # mm
INCH = 25.4


def _why_lost(context: MachineContext) -> str:
    spindle = context.spindle
    if spindle.why_slow:
        return spindle.why_slow.lower()
    if spindle.measured * spindle.command < 0.0:
        return f"the spindle turned the wrong way, at {abs(spindle.measured):.0f} rpm"
    return f"the spindle fell to {abs(spindle.measured):.0f} of {abs(spindle.command):.0f} rpm"


class ThreadRetract:
    """Begins with braking; ``step`` raises TroubleError once X is back."""

    def __init__(self, context: MachineContext, player: Player, block: Block) -> None:
        self._context = context
        self._player = player
        self._block = block
        behind = player.behind(block)
        self._x = [block, *behind][-1].mx  # where the pass would have pulled out to
        self._cutting = bool(behind)  # else it was in its pull-out
        self._why = _why_lost(context)
        player.brake()

    def step(self) -> None:
        """At rest: draw back, or be done. Raises TroubleError("thread-lost") in the end."""
        (x, z, c), _ = self._context.ports.axes.demand_at(self._context.now)
        if abs(x - self._x) < _RETRACTED:
            raise AlarmError("thread-lost", self._left(z), self._block.line)
        self._player.begin([self._away((x, z, c))], self._context.spindle.highest)
        self._player.go(Overrides())

    def _left(self, z: float) -> str:
        """Why, and what the thread on the part is now."""
        if not self._cutting:
            return f"{self._why} in the pull-out: the thread is cut, its end runs out short"
        metric = self._block.modal.metric
        at = f"{z - self._block.offset_z:.3f}" if metric else f"{(z - self._block.offset_z) / INCH:.4f}"
        return f"{self._why}: the tool left the thread at Z{at}, behind it this pass is not cut"

    def _away(self, at: tuple[float, float, float]) -> Block:
        """A rapid along X alone from where the slides stand."""
        block = self._block
        return dataclasses.replace(
            block,
            kind=Kind.RAPID,
            per_rev=False,
            x0=at[0] - block.offset_x,
            z0=at[1] - block.offset_z,
            c0=at[2],
            x=self._x - block.offset_x,
            z=at[1] - block.offset_z,
            c=at[2],
            feed=block.modal.rapid_rate,
        )


class SetpointMotion:
    """``Moving`` by setpoints: plans with the overrides and switches of now, and again when they change."""

    def __init__(self, context: MachineContext, player: Player) -> None:
        self._context = context
        self.player = player
        self._scales = Overrides()
        self._single = False  # the present plan stops at the end of a block
        self._single_from: int | None = None  # the block from which on it may stop
        self._last: int | None = None  # the block at whose end the present plan stops
        self._retreat: ThreadRetract | None = None

    @property
    def active(self) -> bool:
        """Whether there is a stretch at all."""
        return self.player.active

    @property
    def moving(self) -> bool:
        """Whether anything still moves."""
        return self.player.active and not self.player.at_rest()

    @property
    def block(self) -> Block | None:
        """The block being played."""
        return self.player.block(self._context.now)

    @property
    def following(self) -> Block | None:
        """The block behind it, when it belongs to the stretch."""
        return self.player.following()

    @property
    def complete(self) -> bool:
        """Whether what is queued ends where the stretch does."""
        left = self._context.switches.single_block and self.player.steps_left()
        return self.player.complete() and not left

    @property
    def ended_with(self) -> Block | None:
        """At the end of the stretch: its last block."""
        return self.player.ended_with()

    @property
    def starving(self) -> float:
        """When the tail begins although the plan goes on."""
        return self.player.starving

    def begin(self, blocks: list[Block]) -> None:
        """A new stretch, from rest; a thread pass is tied to the spindle."""
        self._single_from = None
        if blocks[0].kind is Kind.THREAD:
            self.player.begin_pass(blocks, self._context.spindle.turns, self._context.ports.gear)
        else:
            self.player.begin(blocks, self._context.spindle.highest)
        self.go()

    def go_on(self, behind: Block | None) -> None:
        """From rest within the stretch; with single block to the end of the block after this one."""
        self._single_from = behind.n + 1 if behind else None
        self.go()

    def go(self, *, soon: bool = True) -> None:
        """Plan on from the present state. Raises MotionError and DriverError."""
        context, player = self._context, self.player
        self._scales = self.wanted()
        self._single = context.switches.single_block
        self._last = self._last_block() if self._single else None
        if not self._single:
            self._single_from = None
        player.go(self._scales, self._last, soon=soon)

    def progress(self, feed: ReadAhead) -> Progress:
        """Follow switches and overrides, take read-ahead blocks in, and say how far it is."""
        player = self.player
        if not player.active:
            return Progress.DONE
        if self.wanted() != self._scales or self._context.switches.single_block != self._single:
            self.go()
        if self.moving:
            self._refill(feed)
            return Progress.MOVING
        if self._last is not None and player.step_over(self._last):
            return Progress.BLOCK_END if player.steps_left() else Progress.DONE
        if self._last is None and player.complete():
            return Progress.DONE
        if not (self._scales.feed and self._scales.rapid and self._scales.turn):
            return Progress.STILL
        self.go()
        return Progress.MOVING

    def keep_up(self) -> None:
        """Keep the queue filled while the slides come to rest."""
        self.player.extend(self._context.now)

    def hold(self) -> None:
        """Come to rest as soon as the path allows; a thread pass ends behind its pull-out."""
        self.player.hold(self.wanted())

    def brake(self) -> None:
        """Come to rest at once on the path, thread or not."""
        self.player.brake()

    def let_stop(self) -> None:
        """Leave the tail in the queue as it is."""
        self.player.let_stop()

    def release(self) -> bool:
        """Give a thread pass back that still waits for its index; False when it moves."""
        return self.player.release()

    def retreat(self, block: Block) -> None:
        """Begin to leave a thread whose spindle is lost."""
        self._retreat = ThreadRetract(self._context, self.player, block)

    def retreated(self) -> None:
        """At rest: draw back, or be done. Raises TroubleError("thread-lost") in the end."""
        if self._retreat is not None:
            self._retreat.step()

    def forget(self) -> None:
        """The stretch is over, or nothing of it holds any more."""
        self._retreat = None
        self.player.forget()

    def wanted(self) -> Overrides:
        """The scales of now. A rapid is never faster than its rate; G95 follows the spindle's pot."""
        feed = self._context.feed_override
        return Overrides(feed, min(feed, 1.0), round(self._context.spindle.override, 2))

    def _last_block(self) -> int | None:
        now = self._context.now
        current = self.player.block(now)
        first = self._single_from if self._single_from is not None else (current.n if current else None)
        last = self.player.settle_at(first, now)
        self._single_from = first if last is None else last
        return last

    def _refill(self, feed: ReadAhead) -> None:
        """Read-ahead blocks join the stretch before its braking end comes near."""
        player, now = self.player, self._context.now
        left = player.planned_to - now
        ahead = self._context.machine.timing.lookahead
        wanted = feed.seconds > 0.25 * ahead or feed.dry or left < 0.75 * ahead
        if feed.pending and wanted and left < 1.5 * ahead:
            player.add(feed.take())
            self.go(soon=False)
        player.extend(now)
        if player.out_of_step:
            self._context.say(
                "thread",
                "the spindle changed its speed faster than the slides could follow: check the thread",
            )
