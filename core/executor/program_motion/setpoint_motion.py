"""Motion by setpoints: one path section or thread pass at a time, from rest to rest.

Feed hold, override and single block use the same method. A new plan starts from the present state with the
present overrides and switches, and is spliced into the queue.
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

_LEAST = 0.2  # fraction of the acceleration that braking has at least in short chords


class SetpointMotion:
    """Plans, queues, stops and resumes a path section. Used on the executor's thread only."""

    def __init__(self, context: MachineContext) -> None:
        machine = context.machine
        self._context = context
        self._axes = context.ports.axes
        self._limits = MotionLimits.of(machine.axes, machine.timing.setpoint, machine.limits.corner_tolerance)
        self._queue = PlanQueue(self._axes, context.lateness)
        self._section: PathSection | None = None
        # a thread pass, used instead of a path section
        self._pass: ThreadPass | GearedThreadPass | None = None
        self._retract: ThreadRetract | None = None
        self._shown: Block | None = None
        self._overrides = Overrides()  # overrides of the present plan
        self._single = False  # the present plan stops at the end of a block
        self._single_from: int | None = None  # the first block at whose end the plan may stop
        self._last: int | None = None  # the block at whose end the present plan stops
        self._stepped: int | None = None  # the block at whose end single block has stopped

    # --- state --------------------------------------------------------------------------------------------

    @property
    def active(self) -> bool:
        """True if there is a path section or a thread pass."""
        return self._section is not None or self._pass is not None

    @property
    def moving(self) -> bool:
        """True if a path section or a thread pass is active and the axes are not at rest."""
        return self.active and not self._rests()

    @property
    def block(self) -> Block | None:
        """The block being executed, not one that is planned ahead."""
        return self._block_at(self._context.now)

    @property
    def following(self) -> Block | None:
        """The block after the one being executed, if it belongs to the path section."""
        if self._pass is not None:
            behind = self._behind(self._pass.block(self._axes.now()))
            return behind[0] if behind else None
        return self._section.block(self._shown.n + 1) if self._section and self._shown else None

    @property
    def complete(self) -> bool:
        """True if no block of the path section remains to be started."""
        left = self._context.switches.single_block and self._steps_left()
        return self._all_queued() and not left

    @property
    def ended_with(self) -> Block | None:
        """The last block at the end of the path section, which may have no length."""
        if self._pass is not None:
            return self._pass.blocks[-1]
        return self._section.last_block if self._section is not None else None

    @property
    def starving(self) -> float:
        """The start time of the braking tail if the queue is not extended; inf if all is queued."""
        return np.inf if self._pass is not None else self._queue.starving

    # --- requests -----------------------------------------------------------------------------------------

    def begin(self, blocks: list[Block]) -> None:
        """Start a new path section, or a thread pass that follows the spindle, from rest.

        Raises AlarmError if the spindle does not turn, MotionError if a block cannot be planned, or
        DriverError.
        """
        self._single_from = None
        if blocks[0].kind is Kind.THREAD:
            self._begin_thread(blocks)
        else:
            self._begin_section(blocks)
        self._go()

    def go_on(self, behind: Block | None) -> None:
        """Resume from rest within the path section.

        With single block, the motion ends with the block after ``behind``.
        """
        self._single_from = behind.n + 1 if behind else None
        self._go()

    def progress(self, feed: ReadAhead) -> Progress:
        """Apply switches and overrides, add blocks that were read ahead, and return the progress."""
        if not self.active:
            return Progress.DONE
        # the queue has run dry within this tick; the next tick holds the cycle
        ran_dry = self.starving < self._axes.now()
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
        """Extend the queue while the axes stop."""
        self._extend(self._context.now)

    def hold(self) -> None:
        """Stop as soon as the path permits; a thread pass ends after its pull-out."""
        if self._pass is not None:
            self._pass.hold()
        else:
            overrides = self._wanted()
            self._queue.splice(lambda t: self._plan_stop(t, overrides), soon=True)

    def brake(self) -> None:
        """Stop at once on the path, even in a thread."""
        if self._pass is not None:
            self._pass.brake()
        else:
            self._queue.splice(lambda t: self._plan_stop(t, Overrides()), soon=True)

    def let_stop(self) -> None:
        """Leave the tail in the queue and discard the rest of the plan."""
        self._queue.let_stop()

    def release(self) -> bool:
        """Cancel a thread pass that still waits for its index; return False if it moves."""
        if self._pass is not None:
            self._pass.hold()
        return self._pass is not None and not self._pass.complete

    def retract(self, block: Block) -> None:
        """Stop along a thread that has lost its spindle, to retract X afterwards."""
        self._retract = ThreadRetract.of(block, self._behind(block), self._context.spindle)
        self.brake()

    def retracted(self) -> None:
        """Retract X at rest, and raise AlarmError("thread-lost") when the tool is out."""
        if self._retract is None:
            return
        # The time of the tick may be before the end of the braking if the computer was late.
        at, _ = self._axes.demand_at(self._axes.now())
        self._retract.demand_left(at)
        self._begin_section([self._retract.way_out(at)])
        self._splice(Overrides(), None)

    def forget(self) -> None:
        """Clear the path section or thread pass."""
        self._retract = None
        self._clear()

    # --- planning -----------------------------------------------------------------------------------------

    def _begin_section(self, blocks: list[Block]) -> None:
        self._clear()
        self._section = PathSection(self._limits, self._context.spindle.highest)
        self._section.add(blocks)

    def _begin_thread(self, blocks: list[Block]) -> None:
        """Start a thread pass, inside the driver if it has a gear, otherwise by setpoints over time.

        Overrides, holds and single block take effect at its end.
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
        """Return the present overrides. A rapid never exceeds its rate; G95 follows the spindle override."""
        feed = self._context.feed_override
        return Overrides(feed, min(feed, 1.0), round(self._context.spindle.override, 2))

    def _go(self, *, soon: bool = True) -> None:
        """Plan with the present overrides and switches. Raises MotionError or DriverError."""
        self._overrides = self._wanted()
        self._single = self._context.switches.single_block
        self._last = self._last_block() if self._single else None
        if not self._single:
            self._single_from = None
        self._splice(self._overrides, self._last, soon=soon)

    def _splice(self, overrides: Overrides, last: int | None, *, soon: bool = True) -> None:
        """Plan from the present state to the end of the path section or of block ``last``.

        With ``soon`` the plan takes effect as soon as possible, otherwise after the queued motion.
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
        """Add blocks that were read ahead before the braking end of the path section is near."""
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
        """Append blocks to the path section; the next splice plans them."""
        assert self._section is not None
        self._section.add(blocks, self._reached())

    def _extend(self, now: float) -> None:
        """Extend the queue from the present plan."""
        if self._pass is not None:
            self._pass.track()
        self._queue.extend(now)

    def _reached(self) -> float:
        """Return the distance before which the present motion can stop if it is changed now."""
        t = self._queue.latest(self._axes.now())
        track = self._queue.at(t)
        if track is None:
            return -np.inf
        s, v = track.state(t)
        return s + v * v / (2.0 * _LEAST * self._limits.plane_acceleration)

    # --- single block and the present block ---------------------------------------------------------------

    def _last_block(self) -> int | None:
        """Return the block at whose end single block stops, no earlier than the axes can."""
        now = self._context.now
        current = self._block_at(now)
        first = self._single_from if self._single_from is not None else (current.n if current else None)
        last = self._stoppable(first, now)
        self._single_from = first if last is None else last
        return last

    def _stoppable(self, first: int | None, now: float) -> int | None:
        """Return the first block from ``first`` on at whose end the axes can still stop, or None."""
        if self._pass is not None:
            return self._pass.blocks[-1].n
        assert self._section is not None
        if self._queue.last is None:
            return self._section.stoppable(first, -np.inf)
        return self._section.stoppable(first, self._plan_stop(self._queue.lead(now), Overrides()).end_s)

    def _stepped_over(self, last: int) -> bool:
        """Return whether block ``last`` is finished at rest, and record it as the present block."""
        if self._pass is not None:
            return self._pass.complete
        assert self._section is not None
        track = self._queue.last
        if track is None or track.profile.end_s < self._section.end_of(last) - 1e-9:
            return False
        self._stepped = last
        return True

    def _steps_left(self) -> bool:
        """Return whether blocks follow the present one at rest, including blocks without length."""
        if self._section is None:
            return False
        at = self._block_at(self._axes.now())
        return at is None or bool(self._section.behind(at.n))

    def _all_queued(self) -> bool:
        """Return whether the queue ends where the path section ends."""
        if self._pass is not None:
            return self._pass.complete
        track = self._queue.last
        if self._section is None or not self._section.length:
            return True
        return track is not None and track.profile.end_s >= self._section.end_s - 1e-9

    def _rests(self) -> bool:
        """Return whether the queue has ended. The clock is read last because it continues to run."""
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
        """Return the blocks of the path section or thread pass after ``block``."""
        if self._pass is not None:
            return [each for each in self._pass.blocks if each.n > block.n]
        return self._section.behind(block.n) if self._section else []


def _planned(path: Path, playing: Track | None, t: float, *, stop: bool = False) -> Profile:
    """Return a plan from the state of the present plan at time ``t``, or from rest without one."""
    if playing is None:
        return plan(path, stop=stop)
    s, v = playing.state(t)
    return plan(path, start_s=s, start_v=v, stop=stop)
