"""Planning of whole programs in bounded memory, window by window, and sampling for a trace."""

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
    """A final part of the planned motion. ``t`` is its start in seconds since the start of the planner.

    ``profile`` starts at time 0 and may start and end in motion; the next chunk continues it. ``n t0 t1`` are
    the numbers of the blocks that end in the chunk, and their start and end times on the scale of ``t``.
    """

    t: float
    profile: Profile
    n: IntArray
    t0: FloatArray
    t1: FloatArray


class ChunkPlanner:
    """Plans blocks as they arrive, with about ``window`` blocks in memory.

    The result equals one plan of the whole program. Each window yields only the part whose speeds no further
    block can change, because its braking ends at a corner or a feed inside the window. If no part is final,
    the window grows.
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
    def t(self) -> float:
        """The time up to which motion has been yielded, in seconds."""
        return self._t

    def add(self, blocks: Iterable[MotionBlock | Row]) -> Iterator[Chunk]:
        """Read blocks lazily and yield the motion that is final.

        Nothing happens until the result is iterated. Raises MotionError for a block that cannot be planned.
        """
        for batch, size in batches(blocks, self._window - self._waiting, self._window):
            self._builder.add_batch(batch)
            self._waiting += size
            if self._waiting >= self._window:
                self._waiting = 0
                yield from self._settled()

    def finish(self) -> Iterator[Chunk]:
        """Stop at the end of the last block, as for an exact stop. More blocks may be added afterwards."""
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
        """Return ``whole`` up to ``joint`` (None: to its end) and continue from there."""
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
    """Return times (m,), machine positions (m, axes) and block numbers (m,) every ``dt`` seconds.

    The samples start at ``t_offset``. The end is left out, because the next profile starts there. Raises
    MotionError if ``dt`` is not greater than 0.
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
