"""Motion by setpoints: one path section or thread pass at a time, from rest to rest.

Feed hold, override and single block are the same act: plan from the present state with the overrides and
switches of now, and splice the result into the queue.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from core.executor.job import ReadAhead
from core.executor.machine_context import MachineContext
from core.executor.program_motion.path_section import Overrides, PathSection, PlanQueue, Progress, Track
from core.executor.program_motion.thread_pass import GearedThreadPass, ThreadPass
from core.executor.program_motion.thread_path import ThreadRetract
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.motion.axis_limits import MotionLimits
from core.motion.motion_path import Path
from core.motion.motion_plan import plan
from core.motion.motion_profile import Profile
from core.ports import at_rest

_LEAST = 0.2  # of the acceleration: what braking has in short chords at least


class SetpointMotion:
    """Plans a path section, keeps it queued, brakes it, goes on. Called by the executor's thread alone."""

    def __init__(self, context: MachineContext) -> None:
        machine = context.machine
        self._context = context
        self._axes = context.ports.axes
        self._limits = MotionLimits.of(machine.axes, machine.timing.setpoint, machine.limits.corner_tolerance)
        self._queue = PlanQueue(self._axes, context.lateness)
        self._section: PathSection | None = None
        self._pass: ThreadPass | GearedThreadPass | None = None  # instead of a path section
        self._retract: ThreadRetract | None = None
        self._shown: Block | None = None
        self._overrides = Overrides()  # of the present plan
        self._single = False  # the present plan stops at the end of a block
        self._single_from: int | None = None  # the block from which on it may stop
        self._last: int | None = None  # the block at whose end the present plan stops
        self._stepped: int | None = None  # the block at whose end single block has come to rest

    # --- how it stands ------------------------------------------------------------------------------------

    @property
    def active(self) -> bool:
        """Whether there is a path section or a thread pass at all."""
        return self._section is not None or self._pass is not None

    @property
    def moving(self) -> bool:
        """Whether anything still moves."""
        return self.active and not self._rests()

    @property
    def block(self) -> Block | None:
        """The block being played, not one planned ahead."""
        return self._block_at(self._context.now)

    @property
    def following(self) -> Block | None:
        """The block behind it, when it belongs to the path section."""
        if self._pass is not None:
            behind = self._behind(self._pass.block(self._axes.now()))
            return behind[0] if behind else None
        return self._section.block(self._shown.n + 1) if self._section and self._shown else None

    @property
    def complete(self) -> bool:
        """Whether nothing of the path section is left to be begun: what is queued ends where it does."""
        left = self._context.switches.single_block and self._steps_left()
        return self._all_queued() and not left

    @property
    def ended_with(self) -> Block | None:
        """At the end of the path section: its last block, which may go nowhere."""
        if self._pass is not None:
            return self._pass.blocks[-1]
        return self._section.last_block if self._section is not None else None

    @property
    def starving(self) -> float:
        """When the braking tail begins although the plan goes on; endless when all of it is queued."""
        return np.inf if self._pass is not None else self._queue.starving

    # --- what is asked ------------------------------------------------------------------------------------

    def begin(self, blocks: list[Block]) -> None:
        """A new path section, from rest; a thread pass is tied to the spindle.

        Raises AlarmError without a turning spindle, MotionError for what cannot be moved, DriverError.
        """
        self._single_from = None
        if blocks[0].kind is Kind.THREAD:
            self._begin_thread(blocks)
        else:
            self._begin_section(blocks)
        self._go()

    def go_on(self, behind: Block | None) -> None:
        """From rest within the path section; with single block to the end of the block after this one."""
        self._single_from = behind.n + 1 if behind else None
        self._go()

    def progress(self, feed: ReadAhead) -> Progress:
        """Follow switches and overrides, take read-ahead blocks in, and say how far it is."""
        if not self.active:
            return Progress.DONE
        ran_dry = self.starving < self._axes.now()  # within this tick: the next one holds the cycle
        changed = self._wanted() != self._overrides or self._context.switches.single_block != self._single
        if changed and not ran_dry:
            self._go()
        if ran_dry or self.moving:
            if not ran_dry:
                self._refill(feed)
            return Progress.MOVING
        if self._last is not None and self._stepped_over(self._last):
            return Progress.BLOCK_END if self._steps_left() else Progress.DONE
        if self._last is None and self._all_queued():
            return Progress.DONE
        if not all(self._overrides):
            return Progress.STILL
        self._go()
        return Progress.MOVING

    def keep_up(self) -> None:
        """Keep the queue filled while the slides come to rest."""
        self._extend(self._context.now)

    def hold(self) -> None:
        """Feed hold: come to rest as soon as the path allows; a thread pass ends behind its pull-out."""
        if self._pass is not None:
            self._pass.hold()
        else:
            overrides = self._wanted()
            self._queue.splice(lambda t: self._plan_stop(t, overrides), soon=True)

    def brake(self) -> None:
        """Come to rest at once on the path, thread or not."""
        if self._pass is not None:
            self._pass.brake()
        else:
            self._queue.splice(lambda t: self._plan_stop(t, Overrides()), soon=True)

    def let_stop(self) -> None:
        """Leave the tail in the queue as it is: what was planned beyond it no longer holds."""
        self._queue.let_stop()

    def release(self) -> bool:
        """Give a thread pass back that still waits for its index; False when it moves."""
        if self._pass is not None:
            self._pass.hold()
        return self._pass is not None and not self._pass.complete

    def retract(self, block: Block) -> None:
        """Begin to leave a thread whose spindle is lost: brake along it, to draw X back then."""
        self._retract = ThreadRetract.of(block, self._behind(block), self._context.spindle)
        self.brake()

    def retracted(self) -> None:
        """At rest: draw back, or be done. Raises AlarmError("thread-lost") in the end."""
        if self._retract is None:
            return
        # The time of the tick may be before the end of the braking where the computer was late.
        at, _ = self._axes.demand_at(self._axes.now())
        self._retract.demand_left(at)
        self._begin_section([self._retract.way_out(at)])
        self._splice(Overrides(), None)

    def forget(self) -> None:
        """The path section is over, or nothing of it holds any more."""
        self._retract = None
        self._clear()

    # --- planning -----------------------------------------------------------------------------------------

    def _begin_section(self, blocks: list[Block]) -> None:
        self._clear()
        self._section = PathSection(self._limits, self._context.spindle.highest)
        self._section.add(blocks)

    def _begin_thread(self, blocks: list[Block]) -> None:
        """Followed inside the driver where it has a gear, else by setpoints in time.

        Overrides, holds and single block act at its end.
        """
        self._clear()
        gear, angle = self._context.ports.gear, self._context.spindle.angle
        if gear is None:
            self._pass = ThreadPass(self._axes, self._limits, angle, blocks)
        else:
            self._pass = GearedThreadPass(self._axes, gear, self._limits, angle, blocks)
        self._pass.begin()

    def _clear(self) -> None:
        self._section = self._shown = self._pass = self._stepped = None
        self._queue.clear()

    def _wanted(self) -> Overrides:
        """The overrides of now. A rapid is never faster than its rate; G95 follows the spindle's pot."""
        feed = self._context.feed_override
        return Overrides(feed, min(feed, 1.0), round(self._context.spindle.override, 2))

    def _go(self, *, soon: bool = True) -> None:
        """Plan on with the overrides and switches of now. Raises MotionError and DriverError."""
        self._overrides = self._wanted()
        self._single = self._context.switches.single_block
        self._last = self._last_block() if self._single else None
        if not self._single:
            self._single_from = None
        self._splice(self._overrides, self._last, soon=soon)

    def _splice(self, overrides: Overrides, last: int | None, *, soon: bool = True) -> None:
        """Plan on from the present state to the end of the path section, or of block ``last``.

        ``soon`` takes effect as soon as the queue allows; without it what is queued stays and the plan goes
        on behind it.
        """
        if self._pass is not None:
            self._pass.go_on()
        else:
            self._queue.splice(lambda t: self._plan_on(t, overrides, last), soon=soon)

    def _plan_on(self, t: float, overrides: Overrides, last: int | None) -> Profile:
        assert self._section is not None
        playing = self._block_at(self._axes.now())
        self._section.drop_before(playing.n if playing else None)
        return _planned(self._section.path(overrides, last), self._queue.at(t), t)

    def _plan_stop(self, t: float, overrides: Overrides) -> Profile:
        assert self._section is not None
        return _planned(self._section.path(overrides, None), self._queue.at(t), t, stop=True)

    def _refill(self, feed: ReadAhead) -> None:
        """Read-ahead blocks join the path section before its braking end comes near."""
        now = self._context.now
        left = (self._pass.end if self._pass is not None else self._queue.planned_to) - now
        ahead = self._context.lateness.lookahead
        wanted = feed.seconds > 0.25 * ahead or feed.dry or left < 0.75 * ahead
        if feed.pending and wanted and left < 1.5 * ahead:
            self._add(feed.take())
            self._go(soon=False)
        self._extend(now)
        if self._pass is not None and self._pass.lost_step():
            self._context.log(
                "thread",
                "the spindle speed changed faster than the axes could follow; check the thread",
            )

    def _add(self, blocks: Iterable[Block]) -> None:
        """More of the path section; planned with the next splice."""
        assert self._section is not None
        self._section.add(blocks, self._reached())

    def _extend(self, now: float) -> None:
        """Keep the queue filled from the present plan."""
        if self._pass is not None:
            self._pass.track()
        self._queue.extend(now)

    def _reached(self) -> float:
        """Distance before which the motion under way can come to rest, from when it can be changed on."""
        t = self._queue.latest(self._axes.now())
        track = self._queue.at(t)
        if track is None:
            return -np.inf
        s, v = track.state(t)
        return s + v * v / (2.0 * _LEAST * self._limits.plane_acceleration)

    # --- single block and what is played ------------------------------------------------------------------

    def _last_block(self) -> int | None:
        """Single block: the block at whose end to stop, no earlier than the slides still can."""
        now = self._context.now
        current = self._block_at(now)
        first = self._single_from if self._single_from is not None else (current.n if current else None)
        last = self._stoppable(first, now)
        self._single_from = first if last is None else last
        return last

    def _stoppable(self, first: int | None, now: float) -> int | None:
        """The first block at or after ``first`` at whose end the slides can still come to rest."""
        if self._pass is not None:
            return self._pass.blocks[-1].n
        assert self._section is not None
        if self._queue.last is None:
            return self._section.stoppable(first, -np.inf)
        return self._section.stoppable(first, self._plan_stop(self._queue.lead(now), Overrides()).end_s)

    def _stepped_over(self, last: int) -> bool:
        """At rest: whether block ``last`` is done; it then is the one being played, length or not."""
        if self._pass is not None:
            return self._pass.complete
        assert self._section is not None
        track = self._queue.last
        if track is None or track.profile.end_s < self._section.end_of(last) - 1e-9:
            return False
        self._stepped = last
        return True

    def _steps_left(self) -> bool:
        """At rest: whether there are blocks behind the one that was reached, if only such as go nowhere."""
        if self._section is None:
            return False
        at = self._block_at(self._axes.now())
        return at is None or bool(self._section.behind(at.n))

    def _all_queued(self) -> bool:
        """Whether what is queued ends where the path section does."""
        if self._pass is not None:
            return self._pass.complete
        track = self._queue.last
        if self._section is None or not self._section.length:
            return True
        return track is not None and track.profile.end_s >= self._section.end_s - 1e-9

    def _rests(self) -> bool:
        """Nothing that was queued moves any more. The clock goes on between two questions: asked last."""
        horizon = self._axes.horizon()
        return at_rest(horizon, self._axes.now())

    def _block_at(self, now: float) -> Block | None:
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

    def _behind(self, block: Block) -> list[Block]:
        """Blocks of the path section or thread pass that come after this one."""
        if self._pass is not None:
            return [each for each in self._pass.blocks if each.n > block.n]
        return self._section.behind(block.n) if self._section else []


def _planned(path: Path, playing: Track | None, t: float, *, stop: bool = False) -> Profile:
    """A plan from the state in which the one that is being played is at ``t``; from rest without one."""
    if playing is None:
        return plan(path, stop=stop)
    s, v = playing.state(t)
    return plan(path, start_s=s, start_v=v, stop=stop)
