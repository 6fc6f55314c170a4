"""Planner that plans a whole program in limited memory, one window of blocks at a time.

The module also samples the planned positions for a trace.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from core.message import Message
from core.motion.axis_limits import FloatArray, IntArray, MotionError, MotionLimits
from core.motion.block_table import MotionBlock, MoveSeries, split_into_batches
from core.motion.motion_path import PathBuilder
from core.motion.motion_plan import find_last_settled_joint, plan_motion
from core.motion.motion_profile import MotionProfile
from core.motion.section_plans import SectionPlan, plan_sections


class PlannedChunk(NamedTuple):
    """A part of the planned motion that later blocks can no longer change.

    ``start_time_s`` is the start of the chunk in seconds since the start of the planner. ``profile`` starts
    at time 0 and may start and end in motion; the next chunk continues the motion. ``block_numbers`` are
    the numbers of the blocks that end in the chunk. ``block_starts_s`` and ``block_ends_s`` are their start
    and end times in seconds since the start of the planner.
    """

    start_time_s: float
    profile: MotionProfile
    block_numbers: IntArray
    block_starts_s: FloatArray
    block_ends_s: FloatArray


class WindowPlanner:
    """Motion planner for blocks as they arrive, with about ``window`` blocks in memory.

    The result equals a single plan of the whole program. Each window yields only the motion that is final.
    Motion is final if later blocks cannot change its speeds, because a corner or a feed inside the window
    limits them. If no motion is final, the window grows.
    """

    def __init__(self, limits: MotionLimits, *, rpm_max: float = math.inf, window: int = 20_000) -> None:
        if window < 1:
            raise MotionError(
                Message(
                    "A planning window of {window} blocks is too small. Set at least 1 block.", window=window
                ),
                "empty-window",
            )
        self._limits = limits
        self._rpm_max = rpm_max
        self._window = window
        self._t = 0.0
        self._last = -1  # =
        self._builder = PathBuilder(limits, rpm_max=rpm_max)
        self._s: float | None = None
        self._v = 0.0
        self._waiting = 0

    @property
    def planned_time_s(self) -> float:
        """Return the time in seconds up to which motion has been yielded."""
        return self._t

    def plan_blocks(self, blocks: Iterable[MotionBlock | MoveSeries]) -> Iterator[PlannedChunk]:
        """Read blocks lazily and yield the motion that later blocks cannot change.

        No block is read before the result is iterated. Raises MotionError for a block that cannot be
        planned.
        """
        for batch, size in split_into_batches(blocks, self._window - self._waiting, self._window):
            self._builder.add_batch(batch)
            self._waiting += size
            if self._waiting >= self._window:
                self._waiting = 0
                yield from self._settled()

    def plan_sections_ahead(self, sections: Sequence[Sequence[MotionBlock]]) -> list[SectionPlan | None]:
        """Return the plans of path sections that will follow; see ``plan_sections``."""
        return plan_sections(sections, self._limits, self._rpm_max)

    def accept_section(self, plan: SectionPlan) -> PlannedChunk:
        """Append the plan of a whole section to the motion yielded so far, and return its chunk."""
        begin, joints, numbers = self._t, plan.joint_times_s, plan.profile.path.block_numbers
        self._t = begin + plan.profile.duration_s
        self._last = int(numbers[-1])
        return PlannedChunk(begin, plan.profile, numbers, begin + joints[:-1], begin + joints[1:])

    def finish_section(self) -> Iterator[PlannedChunk]:
        """Plan a stop at the end of the last block, as for an exact stop, and yield the motion.

        More blocks may be added afterwards.
        """
        if self._builder.has_blocks:
            self._builder.end_path()
            yield self._accept_profile(self._plan(), None)
        self._builder = PathBuilder(self._limits, rpm_max=self._rpm_max)
        self._s, self._v, self._waiting = None, 0.0, 0

    def _plan(self) -> MotionProfile:
        return plan_motion(self._builder.build_path(), start_distance=self._s, start_speed=self._v)

    def _settled(self) -> Iterator[PlannedChunk]:
        path = self._builder.build_path()
        joints = find_last_settled_joint(path, self._s)
        block_ends = path.first_pieces[1:][path.first_pieces[1:] <= joints]
        if not len(block_ends) or path.joint_distances[block_ends[-1]] <= (
            path.joint_distances[0] if self._s is None else self._s
        ):
            return
        joint = int(block_ends[-1])
        yield self._accept_profile(self._plan(), joint)

    def _accept_profile(self, profile: MotionProfile, joint: int | None) -> PlannedChunk:
        """Return the chunk of ``profile`` up to ``joint``, from which planning then continues.

        If ``joint`` is None, the chunk contains the whole profile.
        """
        path, begin = profile.path, self._t
        n, t0, t1 = profile.find_block_times()
        ended = len(n) if joint is None else int(np.searchsorted(path.first_pieces[1:], joint, side="right"))
        part = profile if joint is None else profile.cut_at_distance(float(path.joint_distances[joint]))
        fresh = slice(int(np.searchsorted(n, self._last, side="right")), ended)
        chunk = PlannedChunk(begin, part, n[fresh], begin + t0[fresh], begin + t1[fresh])
        self._t = begin + part.duration_s
        self._last = int(n[ended - 1])
        if joint is not None:
            self._s, self._v = part.end_distance, part.end_speed
            self._builder.drop_blocks_before(self._last + 1)
        return chunk


def sample_positions(
    profile: MotionProfile, interval_s: float, time_offset_s: float = 0.0
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return times (m,), machine positions (m, axes) and block numbers (m,) every ``interval_s`` seconds.

    The samples start at ``time_offset_s``. The end of the profile is not sampled, because the next profile
    starts there. Raises MotionError if ``interval_s`` is not greater than 0.
    """
    if not interval_s > 0.0:
        raise MotionError(
            Message("A sampling interval of {dt} s gives no samples. Set a time above zero.", dt=interval_s),
            "sampling-interval",
        )
    count = max(math.ceil((profile.duration_s - time_offset_s) / interval_s), 0)
    t: FloatArray = time_offset_s + interval_s * np.arange(count, dtype=np.float64)
    t = t[t < profile.duration_s]
    return t, profile.compute_positions(t), profile.find_block_numbers(t)
