"""Elementary blocks: the one list that the runner executes, the prover checks and the screen draws.

Nearly all of a long program is straight moves under one state. As a ``Series`` they stand in columns, since a
block of its own costs more than all that is done with it. ``SectionEnds`` tells before which blocks all comes
to rest, in a run as in its forecast.
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

from core.geometry.lines_and_arcs import arc_extent, arc_length
from core.interpreter.shared.actions import Action, SpindleRun
from core.interpreter.shared.modal_state import Modal

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove
    from core.geometry.working_plane import Travel
    from core.interpreter.shared.working_plane import Swivel


class Kind(StrEnum):
    """What an elementary block is; the words are part of the public JSON."""

    RAPID = "rapid"
    FEED = "feed"
    ARC = "arc"
    THREAD = "thread"
    ROTATE = "rotate"
    DWELL = "dwell"
    PLANE_LINE = "plane-line"
    PLANE_ARC = "plane-arc"
    PLANE = "plane"  # a PLANE block of Klartext: rotary axes swivel
    ACTION = "action"


_MAY_BE_RAPID = frozenset({Kind.PLANE, Kind.PLANE_LINE})


@dataclass(slots=True, eq=False)
class Block:
    """One elementary block, never changed once made. Lengths in mm, X a radius, C in degrees.

    ``x z c`` is the end point in the program's frame with secondary offset and nose compensation in it,
    ``x0 z0 c0`` where the block starts, in that same frame; machine coordinates are ``offset_x offset_z``
    further, machine C is ``modal.offset_c`` further. ``feed`` is mm/s, or mm/rev when ``per_rev``; a rapid's
    feed is the rapid rate in mm/s, that of a turn of C alone degrees/s.
    ``rpm`` is the commanded spindle speed at the block's end, negative under M04, 0 with the spindle stopped;
    where C turns by its own speed it is that speed, signed.
    ``modal`` is the state after the block: the checkpoint from which a restart can go on.
    """

    n: int  # count from 1, in the order of execution
    line: int  # source line, from 1
    kind: Kind
    text: str  # as the screen shows it
    x0: float
    z0: float
    c0: float
    x: float
    z: float
    c: float
    offset_x: float
    offset_z: float
    modal: Modal
    feed: float = 0.0
    per_rev: bool = False
    rpm: float = 0.0
    css: float | None = None  # surface speed in force, mm/s
    cx: float = 0.0  # arc centre, program frame
    cz: float = 0.0
    clockwise: bool = False  # seen from above: X+ down, Z+ right
    action: Action | None = None
    plane: PlaneMove | None = None  # the same way in the frame of the virtual mill
    travel: Travel | None = None  # all axes, on machines that have more than X, Z and C
    swivel: Swivel | None = None  # where a mill's block stands in its working plane
    growth: float = 0.0  # of a thread's lead, mm a revolution more with each; ``feed`` is then its mean
    coupled: bool = False  # a tap: its feed follows the spindle alone, the feed override leaves it as it is
    in_hole: bool = False  # behind it a tap is still in its hole: neither hold nor single block stops there
    continues: bool = False  # a thread that goes on with that of the block before, in one pass

    @property
    def mx(self) -> float:
        """Machine X of the end, mm, radius."""
        return self.x + self.offset_x

    @property
    def mz(self) -> float:
        """Machine Z of the end, mm."""
        return self.z + self.offset_z

    @property
    def mc(self) -> float:
        """Machine C of the end, degrees."""
        return self.c + self.modal.offset_c

    @property
    def machine_end(self) -> tuple[float, ...]:
        """Machine positions of all axes at the end, in the machine's order."""
        return (self.mx, self.mz, self.mc) if self.travel is None else self.travel.end

    def reach(self) -> tuple[float, float, float, float]:
        """(least x, greatest x, least z, greatest z) of what the block goes to, its start left out.

        Program frame, mm. The start belongs to the block before; arcs and mill ways count all along.
        """
        if self.plane is not None:
            (low_x, low_z, _), (high_x, high_z, _) = (side.tolist() for side in self.plane.reach())
            x, z = self.modal.secondary_x, self.modal.secondary_z
            return low_x + x, high_x + x, low_z + z, high_z + z
        if self.kind is Kind.ARC:
            return arc_extent(self.x0, self.z0, self.x, self.z, self.cx, self.cz, self.clockwise)
        return self.x, self.x, self.z, self.z

    def machine_reach(self) -> tuple[tuple[float, float], ...]:
        """Least and greatest machine position of each axis, in the machine's order; the start left out."""
        if self.travel is not None:
            low, high = (side.tolist() for side in self.travel.reach())
            return tuple(zip(low, high, strict=True))
        low_x, high_x, low_z, high_z = self.reach()
        x, z, c = self.offset_x, self.offset_z, self.mc
        return (low_x + x, high_x + x), (low_z + z, high_z + z), (c, c)

    @property
    def length(self) -> float:
        """Length of the path that the feed counts, mm; degrees where only C or rotary axes turn."""
        if self.travel is not None:
            return self.travel.length
        if self.kind is Kind.ARC:
            ends = (self.x0, self.z0), (self.x, self.z)
            return arc_length(*ends, (self.cx, self.cz), clockwise=self.clockwise)
        way = hypot(self.x - self.x0, self.z - self.z0) if self.plane is None else self.plane.length
        return way or abs(self.c - self.c0)

    @property
    def rapid(self) -> bool:
        """Whether the rapid override counts for it, and no spindle has to be at its speed."""
        return self.kind is Kind.RAPID or (self.kind in _MAY_BE_RAPID and self.modal.rapid)

    @property
    def swivels(self) -> bool:
        """Whether a mill's block counts degrees: its rotary axes turn alone, or lead the slides."""
        travel = self.travel
        if travel is None or not self.moves:
            return False
        return not travel.slides if travel.way is None else travel.way.in_degrees

    @property
    def moves(self) -> bool:
        """Whether the slides or the C axis move in this block."""
        return self.action is None


Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


class Series(Sequence[Block]):
    """m straight moves of X and Z, one from the end of the other.

    ``n line x0 z0 x z`` (m,) are those of the blocks; everything else is the same in all and stands in
    ``pattern``, a block such as each of them. Where F varies, ``feed`` (m,) has that of each block, else it
    is None. ``texts`` are the lines of the program.
    """

    __slots__ = ("feed", "line", "n", "pattern", "texts", "x", "x0", "z", "z0")

    def __init__(
        self, pattern: Block, texts: Sequence[str], n: Ints, line: Ints,
        *, x0: Floats, z0: Floats, x: Floats, z: Floats, feed: Floats | None = None,
    ) -> None:  # fmt: skip
        self.feed = feed
        self.pattern, self.texts = pattern, texts
        self.n, self.line = n, line
        self.x0, self.z0, self.x, self.z = x0, z0, x, z

    def __len__(self) -> int:
        return len(self.n)

    @overload
    def __getitem__(self, at: int) -> Block: ...
    @overload
    def __getitem__(self, at: slice) -> Series: ...
    def __getitem__(self, at: int | slice) -> Block | Series:
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
        """The line of the program of each block."""
        if not len(self.line):
            return ()
        first, last = int(self.line[0]), int(self.line[-1])
        if last - first + 1 == len(self.line):  # consecutive: passes of a loop are more than their lines
            return self.texts[first - 1 : last]
        return [self.texts[line - 1] for line in self.line.tolist()]

    def feeds(self) -> Iterator[tuple[Modal, float]]:
        """The state and the feed of each block; endless where F does not vary."""
        modal, feed = self.pattern.modal, self.pattern.feed
        if self.feed is None:
            return repeat((modal, feed))
        known = {each: (with_feed(modal, each), each) for each in set(self.feed.tolist())}
        return map(known.__getitem__, self.feed.tolist())

    def _part(self, at: slice) -> Series:
        return Series(
            self.pattern, self.texts, self.n[at], self.line[at],
            x0=self.x0[at], z0=self.z0[at], x=self.x[at], z=self.z[at],
            feed=None if self.feed is None else self.feed[at],
        )  # fmt: skip


def with_feed(modal: Modal, feed: float) -> Modal:
    """The state after another F of a cut, mm/s or mm/rev."""
    return modal._replace(feed=feed, cut_feed=feed)


class TimedSeries(NamedTuple):
    """Moves with the starts and ends (m,) of each on the program's clock, s."""

    series: Series
    t0: Floats
    t1: Floats


def needs_speed(block: Block) -> bool:
    """Whether this block must not begin before the spindle is at its speed; rapids may."""
    return block.moves and not block.rapid


class SectionEnds:
    """Goes with the elementary blocks of one pass through a program, in their order.

    A standstill is needed before every action, before the first block after a spindle command that must not
    begin without its speed, and before and behind each thread pass, which is the thread or a chain of them,
    and what pulls out of it. All other blocks are moved through without one: they are one path section.
    """

    def __init__(self) -> None:
        self._new_speed = False  # a speed was commanded that no block has waited for yet
        self._pass = 0  # of the thread pass under way: 1 in its threads, 2 in what pulls out of them

    @property
    def in_thread(self) -> bool:
        """Whether the block before belongs to a thread pass, which what comes next may end."""
        return self._pass > 0

    def rests_before(self, block: Block) -> bool:
        """Whether all has to be at rest before ``block``, which comes next.

        While it is waited for the answer stays the same, until ``rested``.
        """
        if block.action is not None:
            self._new_speed = self._new_speed or isinstance(block.action, SpindleRun)
            return True
        if self._pass == 1 and _pulls_out(block):
            self._pass = 1 if block.continues else 2
            return False
        return self._pass > 0 or block.kind is Kind.THREAD or (self._new_speed and needs_speed(block))

    def rested(self, block: Block) -> None:
        """All is at rest, and ``block``, before which it had to be, begins."""
        if block.action is None:
            self._new_speed = self._new_speed and not needs_speed(block)
            self._pass = int(block.kind is Kind.THREAD)


def _pulls_out(block: Block) -> bool:
    """Behind a thread: its pull-out, or a rapid straight out."""
    return block.kind is Kind.THREAD or (block.kind is Kind.RAPID and block.z == block.z0)
