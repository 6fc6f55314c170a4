"""Elementary blocks, the common form of all programs for execution, proving and drawing.

Most blocks of a long program are straight moves with the same state. A ``StraightMoveSeries`` stores such
blocks as arrays, because creating an object per block would take too long. ``SectionEndDetector`` finds the
blocks before which all axes must be at rest, both in a run and in its forecast.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import repeat
from math import hypot
from typing import TYPE_CHECKING, NamedTuple, overload

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import compute_arc_extent, compute_arc_length
from core.interpreter.shared.actions import Action, SpindleRun
from core.interpreter.shared.modal_state import ModalState

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove
    from core.geometry.working_plane import AxisMove
    from core.interpreter.shared.working_plane import PlanePosition


class BlockKind(StrEnum):
    """Kind of an elementary block; the enum values are part of the public JSON format."""

    RAPID = "rapid"
    FEED = "feed"
    ARC = "arc"
    THREAD = "thread"
    ROTATE = "rotate"
    DWELL = "dwell"
    PLANE_LINE = "plane-line"
    PLANE_ARC = "plane-arc"
    PLANE = "plane"  # a PLANE block of Klartext, which swivels the rotary axes
    ACTION = "action"


_POSSIBLE_RAPID_KINDS = frozenset({BlockKind.PLANE, BlockKind.PLANE_LINE})


@dataclass(slots=True, eq=False)
class Block:
    """One elementary block, which is never modified.

    Lengths are in mm, X is a radius, and C is in degrees.

    - ``x``, ``z``, ``c`` are the end point in the program frame, after secondary offset and nose
      compensation.
    - ``x0``, ``z0`` and ``c0`` are the start point in the same frame.
    - The machine position is the sum of the point and ``offset_x``, ``offset_z`` and ``modal.offset_c``.
    - ``feed`` is in mm/s, or in mm/rev with ``per_rev``. For a rapid, it is the rapid rate in mm/s.
    - For a move of only C, ``feed`` is in degrees/s.
    - ``rpm`` is the commanded spindle speed at the end of the block, negative under M04 and 0 at
      standstill.
    - If C rotates at its own speed, ``rpm`` is the signed speed of C.
    - ``modal`` is the state after the block and is the checkpoint for a restart.
    """

    n: int  # count from 1, in the order of execution
    line: int  # source line, from 1
    kind: BlockKind
    text: str  # as the screen shows it
    x0: float
    z0: float
    c0: float
    x: float
    z: float
    c: float
    offset_x: float
    offset_z: float
    modal: ModalState
    feed: float = 0.0
    per_rev: bool = False
    rpm: float = 0.0
    css: float | None = None  # surface speed in force, mm/s
    cx: float = 0.0  # arc center, program frame
    cz: float = 0.0
    clockwise: bool = False  # in the view from above, with X+ down and Z+ to the right
    action: Action | None = None
    plane: PlaneMove | None = None  # the same move in the frame of the virtual mill
    travel: AxisMove | None = None  # all axes, on machines that have more than X, Z and C
    swivel: PlanePosition | None = None  # position of a mill's block in its working plane
    growth: float = 0.0  # change of a thread's lead per revolution, mm/rev; ``feed`` is then the mean lead
    follows_spindle: bool = (
        False  # tapping: the feed follows the spindle, and the feed override has no effect
    )
    # the tap remains in the hole at the end, so neither feed hold nor single block stops there
    in_hole: bool = False
    continues: bool = False  # a thread that continues the thread of the previous block in the same pass

    @property
    def mx(self) -> float:
        """Return machine X of the end point as a radius, in mm."""
        return self.x + self.offset_x

    @property
    def mz(self) -> float:
        """Return machine Z of the end point in mm."""
        return self.z + self.offset_z

    @property
    def mc(self) -> float:
        """Return machine C of the end point in degrees."""
        return self.c + self.modal.offset_c

    @property
    def machine_end(self) -> tuple[float, ...]:
        """Return the machine positions of all axes at the end point, in the machine's axis order."""
        return (self.mx, self.mz, self.mc) if self.travel is None else self.travel.end

    def reach(self) -> tuple[float, float, float, float]:
        """Return the extent of the block, without its start point, as (min x, max x, min z, max z).

        The values are in mm in the program frame. The start point belongs to the previous block. Arcs and
        moves of a virtual mill include all points of their path.
        """
        if self.plane is not None:
            (low_x, low_z, _), (high_x, high_z, _) = (
                side.tolist() for side in self.plane.find_travel_range()
            )
            x, z = self.modal.secondary_offset_x, self.modal.secondary_offset_z
            return low_x + x, high_x + x, low_z + z, high_z + z
        if self.kind is BlockKind.ARC:
            return compute_arc_extent(self.x0, self.z0, self.x, self.z, self.cx, self.cz, self.clockwise)
        return self.x, self.x, self.z, self.z

    def compute_machine_bounds(self) -> tuple[tuple[float, float], ...]:
        """Return the (min, max) machine positions of each axis in the block, without its start.

        The axes are in the machine's order.
        """
        if self.travel is not None:
            low, high = (side.tolist() for side in self.travel.reach())
            return tuple(zip(low, high, strict=True))
        low_x, high_x, low_z, high_z = self.reach()
        x, z, c = self.offset_x, self.offset_z, self.mc
        return (low_x + x, high_x + x), (low_z + z, high_z + z), (c, c)

    @property
    def length(self) -> float:
        """Return the length of the block to which the feed applies, in mm.

        If only rotary axes or C move, the length is in degrees.
        """
        if self.travel is not None:
            return self.travel.length
        if self.kind is BlockKind.ARC:
            ends = (self.x0, self.z0), (self.x, self.z)
            return compute_arc_length(*ends, (self.cx, self.cz), is_clockwise=self.clockwise)
        length_mm = hypot(self.x - self.x0, self.z - self.z0) if self.plane is None else self.plane.length
        return length_mm or abs(self.c - self.c0)

    @property
    def rapid(self) -> bool:
        """Return whether the block is a rapid.

        The rapid override applies to a rapid, and a rapid does not wait for the spindle speed.
        """
        return self.kind is BlockKind.RAPID or (self.kind in _POSSIBLE_RAPID_KINDS and self.modal.rapid)

    @property
    def has_angular_feed(self) -> bool:
        """Return whether the feed of a mill's block is in degrees.

        This is the case if only rotary axes move, or if the rotary axes determine the time of the linear
        axes.
        """
        travel = self.travel
        if travel is None or not self.moves:
            return False
        return not travel.slides if travel.curved_move is None else travel.curved_move.is_feed_in_degrees

    @property
    def moves(self) -> bool:
        """Return whether any axis moves in this block."""
        return self.action is None


FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class StraightMoveSeries(Sequence[Block]):
    """A series of m straight moves of X and Z, each of which starts at the end of the previous move.

    The arrays ``n``, ``line``, ``x0``, ``z0``, ``x`` and ``z`` of shape (m,) contain one value per block.
    The block ``pattern`` contains all other values, which are common to the blocks. If F varies, ``feed``
    of shape (m,) contains the feed of each block; otherwise, it is None. ``texts`` contains the lines of
    the program.
    """

    __slots__ = ("feed", "line", "n", "pattern", "texts", "x", "x0", "z", "z0")

    def __init__(
        self, template_block: Block, texts: Sequence[str], n: IntArray, line: IntArray,
        *, x0: FloatArray, z0: FloatArray, x: FloatArray, z: FloatArray, feed: FloatArray | None = None,
    ) -> None:  # fmt: skip
        self.feed = feed
        self.pattern, self.texts = template_block, texts
        self.n, self.line = n, line
        self.x0, self.z0, self.x, self.z = x0, z0, x, z

    def __len__(self) -> int:
        return len(self.n)

    @overload
    def __getitem__(self, at: int) -> Block: ...
    @overload
    def __getitem__(self, at: slice) -> StraightMoveSeries: ...
    def __getitem__(self, at: int | slice) -> Block | StraightMoveSeries:
        if isinstance(at, slice):
            return self._part(at)
        at = range(len(self))[at]
        return next(iter(self._part(slice(at, at + 1))))

    def __iter__(self) -> Iterator[Block]:
        like = self.pattern
        kind, c, per_rev, rpm = like.kind, like.c, like.per_rev, like.rpm
        offset_x, offset_z = like.offset_x, like.offset_z
        columns = (self.n, self.line, self.x0, self.z0, self.x, self.z)
        rows = zip(self.source_lines(), *(column.tolist() for column in columns), strict=True)
        for (text, n, line, x0, z0, x, z), (modal, feed) in zip(rows, self.feeds(), strict=False):
            yield Block(
                n, line, kind, text, x0, z0, c, x, z, c, offset_x, offset_z,
                modal, feed, per_rev, rpm,
            )  # fmt: skip

    def source_lines(self) -> Sequence[str]:
        """Return the program line of each block."""
        if not len(self.line):
            return ()
        first, last = int(self.line[0]), int(self.line[-1])
        # The lines are consecutive. In a loop, there are more blocks than lines.
        if last - first + 1 == len(self.line):
            return self.texts[first - 1 : last]
        return [self.texts[line - 1] for line in self.line.tolist()]

    def feeds(self) -> Iterator[tuple[ModalState, float]]:
        """Return an iterator over the modal state and the feed of each block.

        The iterator is endless if all blocks have the same feed.
        """
        modal, feed = self.pattern.modal, self.pattern.feed
        if self.feed is None:
            return repeat((modal, feed))
        known = {each: (replace_feed(modal, each), each) for each in set(self.feed.tolist())}
        return map(known.__getitem__, self.feed.tolist())

    def _part(self, at: slice) -> StraightMoveSeries:
        return StraightMoveSeries(
            self.pattern, self.texts, self.n[at], self.line[at],
            x0=self.x0[at], z0=self.z0[at], x=self.x[at], z=self.z[at],
            feed=None if self.feed is None else self.feed[at],
        )  # fmt: skip


def replace_feed(modal: ModalState, feed: float) -> ModalState:
    """Return the modal state with another cutting feed in mm/s or mm/rev."""
    return modal._replace(feed=feed, last_cutting_feed=feed)


class TimedSeries(NamedTuple):
    """A series of moves, with arrays (m,) of their start and end times in program time, in seconds."""

    series: StraightMoveSeries
    start_times_s: FloatArray
    end_times_s: FloatArray


def needs_spindle_at_speed(block: Block) -> bool:
    """Return whether the spindle must be at speed before this block starts.

    Rapids do not wait for the spindle.
    """
    return block.moves and not block.rapid


class SectionEndDetector:
    """Detector of the blocks before which all axes must be at rest; they separate the path sections.

    The blocks must be passed in order. The axes must be at rest before every action, before the first block
    that needs a new spindle speed, and before and after each thread pass. A thread pass is a screw thread
    or a chain of threads with its pull-out. No other block requires a standstill.
    """

    def __init__(self) -> None:
        self._new_speed = False  # a spindle speed was commanded, and no block has waited for it yet
        self._pass = 0  # phase of the active thread pass: 1 in its threads, 2 in its pull-out

    @property
    def is_in_thread_pass(self) -> bool:
        """Return whether the previous block belongs to a thread pass; the next block may end this pass."""
        return self._pass > 0

    def needs_standstill_before(self, block: Block) -> bool:
        """Return whether all axes must be at rest before the next block.

        The result does not change until ``record_standstill`` is called.
        """
        if block.action is not None:
            self._new_speed = self._new_speed or isinstance(block.action, SpindleRun)
            return True
        if self._pass == 1 and _is_thread_exit(block):
            self._pass = 1 if block.continues else 2
            return False
        return (
            self._pass > 0
            or block.kind is BlockKind.THREAD
            or (self._new_speed and needs_spindle_at_speed(block))
        )

    def record_standstill(self, block: Block) -> None:
        """Record that all axes came to rest as required before ``block``, and that ``block`` starts."""
        if block.action is None:
            self._new_speed = self._new_speed and not needs_spindle_at_speed(block)
            self._pass = int(block.kind is BlockKind.THREAD)


def _is_thread_exit(block: Block) -> bool:
    """Return whether a block after a thread leaves the thread.

    The block is the pull-out of the thread, or a rapid straight outward in X.
    """
    return block.kind is BlockKind.THREAD or (block.kind is BlockKind.RAPID and block.z == block.z0)
