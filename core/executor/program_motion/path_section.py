"""Path section: its blocks, its path with speeds, and the plans that fill the setpoint queue.

Only about one second of a plan is queued, followed by braking to rest (the braking tail). If the queue is
not extended, the axes therefore stop on the path.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Sequence
from enum import Enum
from typing import NamedTuple

import numpy as np

from core.executor.tick_lateness import QUEUE_RESERVE_S, TickLateness
from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits
from core.motion.motion_path import MotionPath, PathBuilder
from core.motion.motion_plan import plan_motion
from core.motion.motion_profile import MotionProfile
from core.ports import AxisSink, DriverError, MotionSegments

_PLAN_END_MARGIN_S = 0.4  # s before the end of a plan within which a longer path would give another speed
_MAX_ATTEMPTS = 3
_SPLICE_DELAY_S = 0.02  # s added to the splice time when a plan came too late


class SectionProgress(Enum):
    """Progress of the motion along the current path section."""

    DONE = "no move is active, or all moves of the path are finished"
    MOVING = "moving"
    BLOCK_END = "the axes are stopped at the end of a block by Single Block"
    AT_REST = "the axes are stopped because the override is 0"
    IN_FEED_HOLD = "the axes are stopped by an external hold"


class OverrideFactors(NamedTuple):
    """Overrides as fractions of the programmed speeds.

    ``spindle_factor`` is the ratio of the actual to the programmed spindle speed.
    """

    feed_factor: float = 1.0
    rapid_factor: float = 1.0
    spindle_factor: float = 1.0


class PathSection:
    """A sequence of blocks that are executed without a standstill between them."""

    def __init__(self, limits: MotionLimits, rpm_max: float) -> None:
        self._builder = PathBuilder(limits, rpm_max=rpm_max)
        self._blocks: dict[int, Block] = {}
        self.first_block: Block | None = None

    def append_blocks(self, blocks: Iterable[Block], reached_distance: float = -np.inf) -> None:
        """Append blocks to the path section.

        ``reached_distance`` is described in ``PathBuilder.add_blocks``.
        """
        new = list(blocks)
        self._builder.add_blocks(new, reached_distance)
        for block in new:
            self.first_block = self.first_block or block
            self._blocks[block.n] = block

    def find_block(self, number: int) -> Block | None:
        """Return the block with the given number, or None if it is not in the path section."""
        return self._blocks.get(number)

    def list_following_blocks(self, block_number: int) -> list[Block]:
        """Return the blocks after block ``block_number``, in order."""
        return [block for number, block in sorted(self._blocks.items()) if number > block_number]

    @property
    def length_mm(self) -> float:
        """Return the length of the stored path in mm, or in degrees if only C turns."""
        return self._builder.build_path().length

    @property
    def end_distance(self) -> float:
        """Return the distance along the path at which the path ends."""
        return float(self._builder.build_path().joint_distances[-1])

    @property
    def last_block(self) -> Block | None:
        """Return the block with the highest number, or None if the path section has no blocks."""
        return self._blocks[max(self._blocks)] if self._blocks else None

    def get_block_end_distance(self, number: int) -> float:
        """Return the distance at which block ``number`` ends, or inf if the block is not on the path."""
        path = self._builder.build_path()
        return path.find_block_span(number)[1] if number in self._blocks else np.inf

    def discard_earlier_blocks(self, block_number: int | None) -> None:
        """Drop the blocks before block ``block_number``."""
        if block_number is None or block_number not in self._blocks:
            return
        self._builder.drop_blocks_before(block_number)
        kept = set(self._builder.build_path().block_numbers.tolist())
        for old in [number for number in self._blocks if number not in kept and number < block_number]:
            del self._blocks[old]

    def scale_path(self, overrides: OverrideFactors, last_block_number: int | None) -> MotionPath:
        """Return the path with its speeds scaled by the overrides.

        After block ``last_block_number`` the speeds are 0, so that a plan stops there. Acceleration and
        other limits do not depend on the overrides. A plan that replaces another one during motion
        therefore starts within its limits.
        """
        path = self._builder.build_path()
        if last_block_number is None and overrides == (1.0, 1.0, 1.0):
            return path
        factors = [self._factor(n, overrides, last_block_number) for n in path.block_numbers.tolist()]
        rate = path.pieces.rate * np.repeat(factors, np.diff(path.first_pieces))
        return dataclasses.replace(path, pieces=dataclasses.replace(path.pieces, rate=rate))

    def find_stop_block(self, first_block_number: int | None, distance: float) -> int | None:
        """Return the first block at whose end the axes can stop, or None if no block permits a stop.

        The search starts at block ``first_block_number``, and the block must end at or after ``distance``.
        While a tap is in its hole, for example, no block permits a stop.
        """
        path = self._builder.build_path()
        numbers: list[int] = path.block_numbers.tolist()
        ends: list[float] = path.joint_distances[path.first_pieces[1:]].tolist()
        for n, end in zip(numbers, ends, strict=True):
            if (
                (first_block_number is None or n >= first_block_number)
                and end >= distance - 1e-9
                and not self._blocks[n].in_hole
            ):
                return n
        return None

    def _factor(self, n: int, overrides: OverrideFactors, last: int | None) -> float:
        if last is not None and n > last:
            return 0.0
        block = self._blocks[n]
        if block.rapid:
            return overrides.rapid_factor
        if block.follows_spindle:
            return overrides.spindle_factor
        turns = block.per_rev and not block.modal.c_locked
        return overrides.feed_factor * overrides.spindle_factor if turns else overrides.feed_factor


# --- contents of the setpoint queue ---------------------------------------------------------------------


class QueuedPlan(NamedTuple):
    """A plan in the setpoint queue, which is executed from the time ``start_time_s`` on.

    Times within the plan are relative to ``time_origin_s``.
    """

    start_time_s: float
    time_origin_s: float
    motion_profile: MotionProfile

    def get_distance_and_speed(self, time_s: float) -> tuple[float, float]:
        """Return the distance along the path and the speed at ``time_s``."""
        s, v = self.motion_profile.compute_distances_and_speeds(time_s - self.time_origin_s)
        return float(s[0]), float(v[0])

    def get_block_number(self, time_s: float) -> int:
        """Return the number of the block that is executed at ``time_s``."""
        return self.motion_profile.find_block_number(time_s - self.time_origin_s)


class QueuedPlanList:
    """The queued plans in order of execution."""

    def __init__(self) -> None:
        self._tracks: list[QueuedPlan] = []

    def clear_plans(self) -> None:
        """Remove all plans."""
        self._tracks = []

    @property
    def last_plan(self) -> QueuedPlan | None:
        """Return the last plan in the queue, or None."""
        return self._tracks[-1] if self._tracks else None

    def find_plan(self, time_s: float) -> QueuedPlan | None:
        """Return the plan executed at ``time_s``, or the first plan if ``time_s`` is before its start."""
        for track in reversed(self._tracks):
            if track.start_time_s <= time_s:
                return track
        return self._tracks[0] if self._tracks else None

    def replace_plans(self, time_s: float, plans: Sequence[QueuedPlan], now: float) -> None:
        """Replace the plans from ``time_s`` on by new ones, and drop the plans that ended before ``now``."""
        kept = [track for track in self._tracks if track.start_time_s < time_s]
        over = max((i for i, track in enumerate(kept) if track.start_time_s <= now), default=0)
        self._tracks = [*kept[over:], *plans]


class PlanQueue:
    """Setpoint queue, with the part of the current plan that is not queued yet.

    Only the executor's thread uses it.
    """

    def __init__(self, axes: AxisSink, lateness: TickLateness) -> None:
        self._axes = axes
        self._lateness = lateness
        self._cost = 0.0  # s that recent planning took
        self._tracks = QueuedPlanList()
        self._profile: MotionProfile | None = None
        self._origin = 0.0
        self._queued_to = 0.0  # end of the queued part of the plan, after which the braking tail follows

    @property
    def planned_end_s(self) -> float:
        """Return the time at which the motion of the current plan comes to rest."""
        return self._origin + (self._profile.duration_s if self._profile else 0.0)

    @property
    def starvation_time_s(self) -> float:
        """Return the time at which braking starts if the queue is not extended.

        The result is inf if the whole plan is queued.
        """
        return self._queued_to if self._queued_to < self.planned_end_s - 1e-9 else np.inf

    @property
    def last_plan(self) -> QueuedPlan | None:
        """Return the last plan in the queue, or None if the queue is empty."""
        return self._tracks.last_plan

    def get_earliest_splice_time(self, now: float) -> float:
        """Return the earliest time at which a plan can change the queue if planning starts at ``now``."""
        return now + self._axes.commit + 1.5 * self._cost

    def get_latest_splice_time(self, now: float) -> float:
        """Return the splice time of the last attempt, which is made if all earlier attempts fail."""
        return self.get_earliest_splice_time(now) + _MAX_ATTEMPTS * _SPLICE_DELAY_S

    def find_plan(self, time_s: float) -> QueuedPlan | None:
        """Return the plan that is executed at ``time_s``, or None if the queue is empty."""
        return self._tracks.find_plan(time_s)

    def clear_queue(self) -> None:
        """Discard the current plan and the stored queue."""
        self._tracks.clear_plans()
        self._profile, self._origin, self._queued_to = None, 0.0, 0.0

    def splice_plan(self, make_plan: Callable[[float], MotionProfile], *, as_soon_as_possible: bool) -> None:
        """Make a plan that starts at a time that can still be changed, and splice it into the queue.

        If the plan is too late, a later time is tried. If ``as_soon_as_possible`` is False, the plan starts
        at the end of the queued motion, or 0.4 s before the end of the current plan if this is earlier.
        Raises MotionError if planning fails, or DriverError if the driver rejects the plan.
        """
        for attempt in range(_MAX_ATTEMPTS):
            began = self._axes.now()
            t = self.get_earliest_splice_time(began) + attempt * _SPLICE_DELAY_S
            if not as_soon_as_possible:
                t = max(t, min(self._queued_to, self.planned_end_s - _PLAN_END_MARGIN_S))
            profile = make_plan(t)
            try:
                self._queue_plan(t, t, profile)
            except DriverError:
                late = self._axes.now() + self._axes.commit > t
                self._cost = min(self._axes.now() - began, 0.2)
                if not late or attempt == _MAX_ATTEMPTS - 1:
                    raise
                continue
            self._cost = max(min(self._axes.now() - began, 0.2), 0.8 * self._cost)
            self._origin, self._profile = t, profile
            return

    def extend_queue(self, now: float) -> bool:
        """Queue more of the current plan; return False if the queue can no longer be extended in time."""
        if (
            self._profile is None
            or self._queued_to - now >= self._lateness.lookahead_s
            or self.starvation_time_s == np.inf
        ):
            return True
        at = self._queued_to
        if at < self._axes.now() + self._axes.commit:
            return False
        self._queue_plan(at, self._origin, self._profile)
        return True

    def discard_remaining_plan(self) -> None:
        """Discard the rest of the plan, but leave the braking tail in the queue."""
        track = self._tracks.last_plan
        if track is not None:
            self._origin, self._profile = track.time_origin_s, track.motion_profile
            self._queued_to = self.planned_end_s

    def _queue_plan(self, t: float, origin: float, profile: MotionProfile) -> None:
        """Splice the plan from ``t`` to the end of the look-ahead into the queue.

        A braking tail follows the plan.
        """
        ahead = self._axes.now() + self._lateness.lookahead_s + QUEUE_RESERVE_S
        end = min(origin + profile.duration_s, max(ahead, t + QUEUE_RESERVE_S))
        parts = [profile.make_segments(t - origin, end - origin, origin)]
        tracks = [QueuedPlan(t, origin, profile)]
        if end < origin + profile.duration_s - 1e-9:
            s, v = profile.compute_distances_and_speeds(end - origin)
            tail = plan_motion(
                profile.path, start_distance=float(s[0]), start_speed=float(v[0]), stop_early=True
            )
            parts.append(tail.make_segments(0.0, tail.duration_s, end))
            tracks.append(QueuedPlan(end, end, tail))
        setpoints = MotionSegments(*[np.concatenate(part) for part in zip(*parts, strict=True)])
        if not len(setpoints.start_times_s):
            setpoints = MotionSegments.make_standstill(
                t, profile.path.compute_positions(np.array([profile.end_distance]))[0]
            )
        self._axes.splice(setpoints)
        self._tracks.replace_plans(t, tracks, self._axes.now())
        self._queued_to = end
