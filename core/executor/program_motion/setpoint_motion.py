"""Motion by setpoints: one path section or thread pass at a time, from rest to rest.

Feed hold, override changes and single block use the same method. A new plan is made from the current state
with the current overrides and switches, and is spliced into the queue.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from core.executor.job import ReadAheadQueue
from core.executor.machine_context import MachineContext
from core.executor.program_motion.path_section import (
    OverrideFactors,
    PathSection,
    PlanQueue,
    QueuedPlan,
    SectionProgress,
)
from core.executor.program_motion.thread_pass import GearedThreadPass, ThreadPass
from core.executor.program_motion.thread_path import ThreadRetract
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.motion.axis_limits import MotionLimits
from core.motion.motion_path import MotionPath
from core.motion.motion_plan import plan_motion
from core.motion.motion_profile import MotionProfile
from core.ports import is_queue_finished

_LEAST = 0.2  # fraction of the acceleration that braking has at least in short chords


class SetpointMotion:
    """Planner that plans, queues, stops and resumes a path section.

    It is used on the executor's thread only.
    """

    def __init__(self, context: MachineContext) -> None:
        machine = context.machine
        self._context = context
        self._axes = context.ports.axes
        self._limits = MotionLimits.from_axes(
            machine.axes, machine.timing.setpoint_duration_s, machine.limits.corner_tolerance
        )
        self._queue = PlanQueue(self._axes, context.tick_lateness)
        self._section: PathSection | None = None
        # a thread pass, used instead of a path section
        self._pass: ThreadPass | GearedThreadPass | None = None
        self._retract: ThreadRetract | None = None
        self._shown: Block | None = None
        self._overrides = OverrideFactors()  # overrides of the present plan
        self._single = False  # the present plan stops at the end of a block
        self._single_from: int | None = None  # the first block at whose end the plan may stop
        self._last: int | None = None  # the block at whose end the present plan stops
        self._stepped: int | None = None  # the block at whose end single block has stopped

    # --- state --------------------------------------------------------------------------------------------

    @property
    def has_path_section(self) -> bool:
        """Return whether a path section or a thread pass is active."""
        return self._section is not None or self._pass is not None

    @property
    def is_moving(self) -> bool:
        """Return whether a path section or a thread pass is active and the axes are not at rest."""
        return self.has_path_section and not self._is_at_rest()

    @property
    def current_block(self) -> Block | None:
        """Return the block being executed. The plans in the queue can already be at a later block."""
        return self._block_at(self._context.now)

    @property
    def following_block(self) -> Block | None:
        """Return the block after the one being executed, or None if it is not in the path section."""
        if self._pass is not None:
            following_blocks = self._following_blocks(self._pass.get_block(self._axes.now()))
            return following_blocks[0] if following_blocks else None
        return self._section.find_block(self._shown.n + 1) if self._section and self._shown else None

    @property
    def is_complete(self) -> bool:
        """Return whether every block of the path section has been started."""
        left = self._context.switches.single_block and self._has_steps_left()
        return self._is_fully_queued() and not left

    @property
    def last_block(self) -> Block | None:
        """Return the last block of the path section; this block may have zero length."""
        if self._pass is not None:
            return self._pass.blocks[-1]
        return self._section.last_block if self._section is not None else None

    @property
    def starvation_time_s(self) -> float:
        """Return the time at which braking starts if the queue is not extended.

        The result is inf if all motion is queued.
        """
        return np.inf if self._pass is not None else self._queue.starvation_time_s

    # --- requests -----------------------------------------------------------------------------------------

    def start_path_section(self, blocks: list[Block]) -> None:
        """Start a new path section, or a thread pass that follows the spindle, from rest.

        Raises AlarmError if a thread pass finds the spindle stopped or its angle not measured. Raises
        MotionError if a block cannot be planned, and DriverError if a driver fails.
        """
        self._single_from = None
        if blocks[0].kind is BlockKind.THREAD:
            self._begin_thread(blocks)
        else:
            self._begin_section(blocks)
        self._plan_motion()

    def resume(self, last_executed_block: Block | None) -> None:
        """Resume from rest within the path section.

        With single block, the motion ends with the block after ``last_executed_block``.
        """
        self._single_from = last_executed_block.n + 1 if last_executed_block else None
        self._plan_motion()

    def update_progress(self, read_ahead: ReadAheadQueue) -> SectionProgress:
        """Apply switches and overrides, add blocks that were read ahead, and return the progress."""
        if not self.has_path_section:
            return SectionProgress.DONE
        # the queue has run dry within this tick; the next tick holds the cycle
        ran_dry = self.starvation_time_s < self._axes.now()
        changed = (
            self._present_overrides() != self._overrides
            or self._context.switches.single_block != self._single
        )
        if changed and not ran_dry:
            self._plan_motion()
        if ran_dry or self.is_moving:
            if not ran_dry:
                self._refill(read_ahead)
            return SectionProgress.MOVING
        if self._last is not None and self._finish_step(self._last):
            return SectionProgress.BLOCK_END if self._has_steps_left() else SectionProgress.DONE
        if self._last is None and self._is_fully_queued():
            return SectionProgress.DONE
        if not all(self._overrides):
            return SectionProgress.AT_REST
        self._plan_motion()
        return SectionProgress.MOVING

    def extend_queue(self) -> None:
        """Extend the queue while the axes stop."""
        self._extend(self._context.now)

    def stop_on_path(self) -> None:
        """Stop as soon as the path permits; a thread pass stops after its pull-out."""
        if self._pass is not None:
            self._pass.cancel_unstarted_pass()
        else:
            overrides = self._present_overrides()
            self._queue.splice_plan(lambda t: self._plan_stop(t, overrides), as_soon_as_possible=True)

    def stop_immediately(self) -> None:
        """Stop at once on the path, even in a thread."""
        if self._pass is not None:
            self._pass.stop_in_thread()
        else:
            self._queue.splice_plan(lambda t: self._plan_stop(t, OverrideFactors()), as_soon_as_possible=True)

    def discard_remaining_plan(self) -> None:
        """Discard the rest of the plan, but leave the braking tail in the queue."""
        self._queue.discard_remaining_plan()

    def cancel_waiting_thread_pass(self) -> bool:
        """Cancel a thread pass that is waiting for the index pulse.

        Return False if the pass already moves.
        """
        if self._pass is not None:
            self._pass.cancel_unstarted_pass()
        return self._pass is not None and not self._pass.is_fully_queued

    def start_retract(self, block: Block) -> None:
        """Stop in a thread that has lost spindle synchronization, and prepare the retract of X."""
        self._retract = ThreadRetract.from_block(block, self._following_blocks(block), self._context.spindle)
        self.stop_immediately()

    def continue_retract(self) -> None:
        """Retract X from rest, and raise AlarmError("thread-lost") when the tool is clear of the thread."""
        if self._retract is None:
            return
        # The time of the tick may be before the end of the braking if the computer was late.
        at, _ = self._axes.demand_at(self._axes.now())
        self._retract.require_axes_in_thread(at)
        self._begin_section([self._retract.make_retract_block(at)])
        self._splice(OverrideFactors(), None)

    def clear_path_section(self) -> None:
        """Clear the path section or thread pass."""
        self._retract = None
        self._clear()

    # --- planning -----------------------------------------------------------------------------------------

    def _begin_section(self, blocks: list[Block]) -> None:
        self._clear()
        self._section = PathSection(self._limits, self._context.spindle.max_rpm)
        self._section.append_blocks(blocks)

    def _begin_thread(self, blocks: list[Block]) -> None:
        """Start a thread pass by electronic gearing or, if the driver has none, by setpoints.

        Overrides, feed hold and single block take effect at the end of the pass.
        """
        self._clear()
        gear, angle = self._context.ports.gear, self._context.spindle.angle
        if gear is None:
            self._pass = ThreadPass(self._axes, self._limits, angle, blocks)
        else:
            self._pass = GearedThreadPass(self._axes, gear, self._limits, angle, blocks)
        self._pass.start_pass()

    def _clear(self) -> None:
        self._section = self._shown = self._pass = self._stepped = None
        self._queue.clear_queue()

    def _present_overrides(self) -> OverrideFactors:
        """Return the current overrides.

        The rapid override is never greater than 1. Feed per revolution (G95) follows the spindle override.
        """
        feed = self._context.feed_override
        return OverrideFactors(feed, min(feed, 1.0), round(self._context.spindle.override, 2))

    def _plan_motion(self, *, as_soon_as_possible: bool = True) -> None:
        """Plan with the current overrides and switches. Raises MotionError or DriverError if this fails."""
        self._overrides = self._present_overrides()
        self._single = self._context.switches.single_block
        self._last = self._last_block() if self._single else None
        if not self._single:
            self._single_from = None
        self._splice(self._overrides, self._last, soon=as_soon_as_possible)

    def _splice(self, overrides: OverrideFactors, last: int | None, *, soon: bool = True) -> None:
        """Plan from the current state to the end of the path section, or to the end of block ``last``.

        If ``soon`` is True, the plan takes effect as soon as possible, otherwise after the motion that is
        already queued.
        """
        if self._pass is not None:
            self._pass.restart_pass()
        else:
            self._queue.splice_plan(lambda t: self._plan_on(t, overrides, last), as_soon_as_possible=soon)

    def _plan_on(self, t: float, overrides: OverrideFactors, last: int | None) -> MotionProfile:
        assert self._section is not None
        playing = self._block_at(self._axes.now())
        self._section.discard_earlier_blocks(playing.n if playing else None)
        return _make_plan(self._section.scale_path(overrides, last), self._queue.find_plan(t), t)

    def _plan_stop(self, t: float, overrides: OverrideFactors) -> MotionProfile:
        assert self._section is not None
        return _make_plan(self._section.scale_path(overrides, None), self._queue.find_plan(t), t, stop=True)

    def _refill(self, feed: ReadAheadQueue) -> None:
        """Append blocks that were read ahead.

        The blocks are appended before the axes begin to brake for the end of the path section.
        """
        now = self._context.now
        left = (self._pass.end_time_s if self._pass is not None else self._queue.planned_end_s) - now
        ahead = self._context.tick_lateness.lookahead_s
        wanted = feed.pending_motion_s > 0.25 * ahead or feed.is_exhausted or left < 0.75 * ahead
        if feed.pending_blocks and wanted and left < 1.5 * ahead:
            self._add(feed.pop_pending_blocks())
            self._plan_motion(as_soon_as_possible=False)
        self._extend(now)
        if self._pass is not None and self._pass.detect_lost_step():
            self._context.log_text(
                "thread",
                "the spindle speed changed faster than the axes could follow; check the thread",
            )

    def _add(self, blocks: Iterable[Block]) -> None:
        """Append blocks to the path section; the next splice includes them in the plan."""
        assert self._section is not None
        self._section.append_blocks(blocks, self._stop_distance())

    def _extend(self, now: float) -> None:
        """Extend the queue from the current plan."""
        if self._pass is not None:
            self._pass.correct_motion()
        self._queue.extend_queue(now)

    def _stop_distance(self) -> float:
        """Return the shortest distance along the path at which the current motion can still stop."""
        t = self._queue.get_latest_splice_time(self._axes.now())
        track = self._queue.find_plan(t)
        if track is None:
            return -np.inf
        s, v = track.get_distance_and_speed(t)
        return s + v * v / (2.0 * _LEAST * self._limits.max_plane_acceleration)

    # --- single block and the present block ---------------------------------------------------------------

    def _last_block(self) -> int | None:
        """Return the number of the block at whose end single block stops the axes.

        Blocks at whose end the axes can no longer stop are skipped.
        """
        now = self._context.now
        current = self._block_at(now)
        first = self._single_from if self._single_from is not None else (current.n if current else None)
        last = self._stoppable(first, now)
        self._single_from = first if last is None else last
        return last

    def _stoppable(self, first: int | None, now: float) -> int | None:
        """Return the number of the first block at whose end the axes can still stop.

        The search starts at block ``first``. The result is None if there is no such block.
        """
        if self._pass is not None:
            return self._pass.blocks[-1].n
        assert self._section is not None
        if self._queue.last_plan is None:
            return self._section.find_stop_block(first, -np.inf)
        return self._section.find_stop_block(
            first, self._plan_stop(self._queue.get_earliest_splice_time(now), OverrideFactors()).end_distance
        )

    def _finish_step(self, last: int) -> bool:
        """Return whether block ``last`` has ended at rest; if so, make it the current block."""
        if self._pass is not None:
            return self._pass.is_fully_queued
        assert self._section is not None
        track = self._queue.last_plan
        if (
            track is None
            or track.motion_profile.end_distance < self._section.get_block_end_distance(last) - 1e-9
        ):
            return False
        self._stepped = last
        return True

    def _has_steps_left(self) -> bool:
        """Return whether blocks remain after the block at whose end the axes are at rest.

        Blocks of zero length are included.
        """
        if self._section is None:
            return False
        at = self._block_at(self._axes.now())
        return at is None or bool(self._section.list_following_blocks(at.n))

    def _is_fully_queued(self) -> bool:
        """Return whether the queue ends where the path section ends."""
        if self._pass is not None:
            return self._pass.is_fully_queued
        track = self._queue.last_plan
        if self._section is None or not self._section.length_mm:
            return True
        return track is not None and track.motion_profile.end_distance >= self._section.end_distance - 1e-9

    def _is_at_rest(self) -> bool:
        """Return whether the queue has ended.

        The clock is read last, because time passes while the other values are read.
        """
        horizon = self._axes.horizon()
        return is_queue_finished(horizon, self._axes.now())

    def _block_at(self, now: float) -> Block | None:
        if self._pass is not None:
            return self._pass.get_block(now)
        if self._section is None:
            return None
        track = self._queue.find_plan(now)
        playing = self._section.find_block(track.get_block_number(now)) if track else None
        if self._stepped is not None and (playing is None or playing.n < self._stepped):
            playing = self._section.find_block(self._stepped)
        self._shown = playing or self._shown or self._section.first_block
        return self._shown

    def _following_blocks(self, block: Block) -> list[Block]:
        """Return the blocks of the path section or thread pass after ``block``."""
        if self._pass is not None:
            return [each for each in self._pass.blocks if each.n > block.n]
        return self._section.list_following_blocks(block.n) if self._section else []


def _make_plan(
    path: MotionPath, present: QueuedPlan | None, t: float, *, stop: bool = False
) -> MotionProfile:
    """Return a plan that starts from the state of the current plan at time ``t``.

    Without a current plan, the new plan starts from rest.
    """
    if present is None:
        return plan_motion(path, stop_early=stop)
    s, v = present.get_distance_and_speed(t)
    return plan_motion(path, start_distance=s, start_speed=v, stop_early=stop)
