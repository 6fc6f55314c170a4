"""Whole programs in bounded memory: the same law, planned window by window, and sampled for a trace."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from core.message import Message
from core.motion.axis_limits import FloatArray, IntArray, MotionError, MotionLimits
from core.motion.block_table import MotionBlock, Row, batches
from core.motion.motion_path import PathBuilder
from core.motion.motion_plan import plan, settled_joints
from core.motion.motion_profile import Profile


class Chunk(NamedTuple):
    """Motion that is planned for good. ``t`` is when it starts, s of motion since the planner's beginning.

    ``profile`` counts from 0 and may begin and end in motion; the next chunk goes on from there. ``n t0 t1``
    are the numbers of the blocks that end in it and when they start and end, counted as ``t`` is.
    """

    t: float
    profile: Profile
    n: IntArray
    t0: FloatArray
    t1: FloatArray


class ChunkPlanner:
    """Plans blocks as they come in, holding about ``window`` of them.

    What it yields equals one plan of the whole: from a window only that part is taken whose speeds no
    further block can change, because its braking ends at a corner or feed inside the window. Where none
    does the window grows.
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
        self._last = -1  # number of the last block that was yielded
        self._builder = PathBuilder(limits, rpm_max=rpm_max)
        self._s: float | None = None
        self._v = 0.0
        self._waiting = 0

    @property
    def t(self) -> float:
        """Time up to which motion has been yielded, s."""
        return self._t

    def add(self, blocks: Iterable[MotionBlock | Row]) -> Iterator[Chunk]:
        """Take blocks lazily and yield what is settled; nothing happens until the result is iterated.

        Raises MotionError for a block that cannot be moved.
        """
        for batch, size in batches(blocks, self._window - self._waiting, self._window):
            self._builder.add_batch(batch)
            self._waiting += size
            if self._waiting >= self._window:
                self._waiting = 0
                yield from self._settled()

    def finish(self) -> Iterator[Chunk]:
        """Come to rest at the end of the last block: an exact stop. Blocks may be added again afterwards."""
        if self._builder.holds_blocks:
            self._builder.close()
            yield self._accept(self._plan(), None)
        self._builder = PathBuilder(self._limits, rpm_max=self._rpm_max)
        self._s, self._v, self._waiting = None, 0.0, 0

    def _plan(self) -> Profile:
        return plan(self._builder.path(), start_s=self._s, start_v=self._v)

    def _settled(self) -> Iterator[Chunk]:
        path = self._builder.path()
        joints = settled_joints(path, self._s)
        block_ends = path.first[1:][path.first[1:] <= joints]
        if not len(block_ends) or path.s[block_ends[-1]] <= (path.s[0] if self._s is None else self._s):
            return
        joint = int(block_ends[-1])
        yield self._accept(self._plan(), joint)

    def _accept(self, whole: Profile, joint: int | None) -> Chunk:
        """Yield ``whole`` up to ``joint`` (None: to its end) and go on from there."""
        path, begin = whole.path, self._t
        n, t0, t1 = whole.block_times()
        ended = len(n) if joint is None else int(np.searchsorted(path.first[1:], joint, side="right"))
        part = whole if joint is None else whole.until(float(path.s[joint]))
        fresh = slice(int(np.searchsorted(n, self._last, side="right")), ended)
        chunk = Chunk(begin, part, n[fresh], begin + t0[fresh], begin + t1[fresh])
        self._t = begin + part.duration
        self._last = int(n[ended - 1])
        if joint is not None:
            self._s, self._v = part.end_s, part.end_v
            self._builder.drop_before(self._last + 1)
        return chunk


def sample_positions(
    profile: Profile, dt: float, t_offset: float = 0.0
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Times (m,), machine positions (m, axes) and block numbers (m,) every ``dt`` from ``t_offset`` on.

    The end itself is left out, since it is the start of what follows. Raises MotionError for a ``dt`` that
    is not above zero.
    """
    if not dt > 0.0:
        raise MotionError(
            Message("A sampling interval of {dt} s gives no samples. Set a time above zero.", dt=dt),
            "sampling-interval",
        )
    count = max(math.ceil((profile.duration - t_offset) / dt), 0)
    t: FloatArray = t_offset + dt * np.arange(count, dtype=np.float64)
    t = t[t < profile.duration]
    return t, profile.position(t), profile.block_at(t)
