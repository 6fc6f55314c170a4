"""The path as pieces with their limits and blocks, including blocks in which C turns too.

C moves together with X and Z in moves of a virtual mill, and when a feed per revolution counts the
revolutions of C. The length of such a piece is measured like its feed, along the path of the mill or of X and
Z. The motion of X, Z and C per unit of length is its ``direction``. Limits, corners, look-ahead and holds are
therefore those of any other line. A curved move becomes chords in X, Z and C. The reasons are in
docs/decisions/0005-c-axis-and-virtual-mill.md.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from core.message import Message
from core.motion.axis_limits import (
    CENTRIPETAL_SHARE,
    OVERRIDE_MAX,
    BoolArray,
    FloatArray,
    IntArray,
    MotionError,
    MotionLimits,
)
from core.motion.block_table import BlockTable, MotionBlock, Part, table_of
from core.motion.joint_easing import SUPPORT
from core.motion.path_pieces import (
    SAME_POINT,
    Pieces,
    ends_in_chord,
    joined,
    make_pieces,
    regrown,
    unrounded,
)
from core.motion.speed_limits import by_radius, constant_rates, least_ratio, piece_limits, split_by_radius

if TYPE_CHECKING:
    from core.geometry.working_plane import CurvedMove


CHORD_ERROR = 1e-4  # mm by which a chord may deviate from the move, measured on the part
STEP_SHARE = 0.5  # fraction of the velocity step of a corner, so that joints of chords do not limit the speed
_FIRST = 16  # initial number of chords
_HALVINGS = 30  # largest number of halvings
# mm; shorter chords are not halved, because distances along a path have an accuracy of 1e-9 mm
_SHORTEST = 1e-5
_ROUNDING = 1e-9
_SPOTS = np.array([0.25, 0.5, 0.75])  # fractions of a chord at which its deviation is checked
GAP = 1e-6  # mm or degrees between the end of a block and the start of the next


def with_parts(table: BlockTable) -> BoolArray:
    """Return the blocks (m,) that are divided into several pieces."""
    parted = _fed_by_c(table)
    if table.way.count(None) < len(table.way):
        parted = parted | np.array([way is not None for way in table.way], dtype=bool)
    return parted


def parts_of(whole: Pieces, table: BlockTable, limits: MotionLimits, index: int) -> Pieces:
    """Return piece ``index`` as chords, or as a move of X and Z followed by the remaining rotation of C.

    Raises MotionError if C turns too little for the move of X and Z.
    """
    piece, move = whole[index : index + 1], table.way[index]
    if move is None:
        return _slide_by_c(piece, table, index)
    if move.length <= SAME_POINT:
        return piece[:0]
    share = np.array([0.0, 1.0]) if move.straight else chords(move, float(piece.rate[0]), limits)
    points = move.machine(share)
    points += table.start[index] - points[0]
    points[-1] = table.end[index]
    return _chain(piece, points, np.diff(share) * move.length)


def chords(move: CurvedMove, rate: float, limits: MotionLimits) -> FloatArray:
    """Return fractions of a curved move (k+1,) between which the axes may move proportionally.

    The chords deviate from the move by at most CHORD_ERROR, measured on the part. Neighboring chords differ
    so little that their joint permits the feed ``rate`` (mm/s), unless the move itself has a corner there.
    """
    share, nearest = np.linspace(0.0, 1.0, _FIRST + 1), move.nearest()
    if np.abs(share - nearest).min() > _ROUNDING:
        share = np.sort(np.append(share, nearest))
    for _ in range(_HALVINGS):
        ends = move.machine(share)
        wide = _leaves(move, share, ends) | _jerks(move, share, ends, OVERRIDE_MAX * rate, limits)
        wide &= np.diff(share) * move.length > _SHORTEST
        if not wide.any():
            break
        share = np.sort(np.append(share, 0.5 * (share[:-1] + share[1:])[wide]))
    return share


def _leaves(move: CurvedMove, share: FloatArray, ends: FloatArray) -> BoolArray:
    """Return which chords (k,) between ``ends`` at ``share`` deviate too much on the part."""
    span, change = np.diff(share), np.diff(ends, axis=0)
    true = move.machine((share[:-1] + _SPOTS[:, None] * span).ravel())
    chord = (ends[:-1] + _SPOTS[:, None, None] * change).reshape(true.shape)
    seen = move.part(np.concatenate([chord, true]))
    off = seen[: len(true)] - seen[len(true) :]
    worst: FloatArray = (off**2).sum(axis=1).reshape(len(_SPOTS), len(span)).max(axis=0)
    return worst > CHORD_ERROR**2


def _jerks(
    move: CurvedMove, share: FloatArray, ends: FloatArray, speed: float, limits: MotionLimits
) -> BoolArray:
    """Return the chords (k,) at whose ends the velocity step of an axis would be too large."""
    length = np.diff(share) * move.length
    direction = np.diff(ends, axis=0) / length[:, None]
    turn = np.abs(np.diff(direction, axis=0))
    mean = 0.5 * (length[:-1] + length[1:])
    fastest = np.minimum(speed, least_ratio(limits.speeds, np.abs(direction)))
    bend = least_ratio(limits.accelerations * CENTRIPETAL_SHARE, turn / mean[:, None])
    v = np.minimum(np.minimum(fastest[:-1], fastest[1:]), np.sqrt(bend))
    sharp = (v[:, None] * turn > STEP_SHARE * limits.accelerations * limits.interval).any(axis=1)
    long = mean > v * limits.interval  # shorter chords belong to a corner of the move itself
    wide = np.zeros(len(length), dtype=bool)
    wide[:-1] |= sharp & long
    wide[1:] |= sharp & long
    return wide


def _chain(piece: Pieces, points: FloatArray, length: FloatArray) -> Pieces:
    """Return straight pieces through ``points`` (k+1, axes) with the given ``length`` (k,)."""
    parts = piece[np.zeros(len(length), dtype=np.int64)]
    zero = np.zeros(len(length))
    return replace(
        parts,
        start=points[:-1],
        direction=np.diff(points, axis=0) / length[:, None],
        centre=np.zeros((len(length), 2)),
        radius=zero,
        angle=zero,
        curvature=zero,
        length=length,
    )


def _fed_by_c(table: BlockTable) -> BoolArray:
    """Return the straight moves (m,) with a feed per revolution in which the spindle turns as C.

    The revolutions of C count for their feed.
    """
    if not table.locked.any():
        return np.zeros(len(table.n), dtype=bool)
    delta = table.end - table.start
    lathe = np.isnan(table.length)
    slides = np.hypot(delta[:, 0], delta[:, 1]) > SAME_POINT
    turned = table.locked & (np.abs(delta[:, 2]) > SAME_POINT)
    fed: BoolArray = lathe & table.per_rev & ~table.arc & slides & turned
    return fed


def _slide_by_c(piece: Pieces, table: BlockTable, index: int) -> Pieces:
    """Return the move of X and Z with C, followed by the rotation of C that the move does not need."""
    start, end, feed = table.start[index], table.end[index], float(table.feed[index])
    way = float(np.hypot(*(end - start)[:2]))
    needed, turn = way / feed * 360.0, float(end[2] - start[2])
    if abs(turn) < needed * (1.0 - _ROUNDING):
        raise MotionError(
            Message(
                "Block {number}: the move needs {needed} degrees of C rotation, but C turns "
                "only {turn} degrees.",
                number=f"{table.n[index]:.0f}",
                needed=f"{needed:g}",
                turn=f"{abs(turn):g}",
            ),
            "rotary-range",
        )
    there = end.copy()
    there[2] = start[2] + np.copysign(min(needed, abs(turn)), turn)
    first = _chain(piece, np.array([start, there]), np.array([way]))
    rest = (abs(turn) - needed) * feed / 360.0
    if rest <= SAME_POINT:
        return _chain(piece, np.array([start, end]), np.array([way]))
    return joined([first, _chain(piece, np.array([there, end]), np.array([rest]))])


@dataclass(frozen=True, slots=True)
class Path:
    """A path in machine coordinates that can be planned, with n pieces of m blocks.

    ``s`` (n+1,) is the distance of the joints along the path in mm. It continues from earlier pieces that a
    builder has dropped. ``cap`` (n,) in mm/s and ``a`` (n,) in mm/s² are the limits along the pieces.
    ``corner`` (n+1,) are the squared speed limits of the joints, infinite at both ends. The block with the
    number ``blocks[i]`` has the pieces ``first[i]:first[i+1]``, none if it has no length. ``start`` (axes,)
    is the first point of the path. The last ``loose`` joints may still move, by the resolution of the words,
    when more blocks are added.
    """

    pieces: Pieces
    s: FloatArray
    cap: FloatArray
    a: FloatArray
    corner: FloatArray
    blocks: IntArray
    first: IntArray
    start: FloatArray
    limits: MotionLimits
    loose: int = 0

    def __len__(self) -> int:
        return len(self.pieces)

    @property
    def length(self) -> float:
        """Length of the whole path, in mm."""
        return float(self.s[-1] - self.s[0])

    @property
    def reach(self) -> float:
        """The largest distance around a joint that affects its limit, in mm: the path of one interval."""
        return float(self.limits.interval * self.cap.max(initial=0.0))

    def block_span(self, n: int) -> tuple[float, float]:
        """Return the distances at which block ``n`` starts and ends.

        Raises MotionError if the block is not on this path.
        """
        i = int(np.searchsorted(self.blocks, n))
        if i == len(self.blocks) or self.blocks[i] != n:
            raise MotionError(
                Message("Block {number} is not on the planned path.", number=n), "block-not-on-path"
            )
        return float(self.s[self.first[i]]), float(self.s[self.first[i + 1]])

    def piece_at(self, s: FloatArray) -> IntArray:
        """Return the index of the piece at each distance; at a joint, that of the piece that starts there."""
        found: IntArray = np.searchsorted(self.s, s, side="right") - 1
        return np.clip(found, 0, max(len(self) - 1, 0))

    def point(self, s: FloatArray, piece: IntArray | None = None) -> FloatArray:
        """Return the machine positions (k, axes) at the distances ``s`` (k,), exact on lines and arcs."""
        if not len(self):
            return np.tile(self.start, (len(s), 1))
        index = self.piece_at(s) if piece is None else piece
        pieces = self.pieces[index]
        return pieces.point(np.clip(s - self.s[index], 0.0, pieces.length))


class PathBuilder:
    """Builds a path from blocks that are added step by step.

    ``rpm_max`` is the highest spindle speed that is possible now: that of the machine, or the operator's
    limit. It may be changed and applies to blocks that are added afterwards. The path remains valid while it
    grows. A plan on the longer path is possible from any state of a plan on the shorter one.
    """

    def __init__(self, limits: MotionLimits, *, rpm_max: float = np.inf) -> None:
        self._limits = limits
        self.rpm_max = rpm_max
        self._closed = False
        self._parts: list[Pieces] = []
        self._written: Pieces | None = None  # the last pieces as programmed
        self._blocks: list[IntArray] = []
        self._counts: list[IntArray] = []
        self._start: FloatArray | None = None
        self._end: FloatArray | None = None
        self._s0 = 0.0
        self._path: Path | None = None

    @property
    def holds_blocks(self) -> bool:
        """True if the path contains blocks."""
        return self._start is not None

    def add(self, blocks: Iterable[MotionBlock], reached: float = -np.inf) -> None:
        """Append blocks that move.

        Raises MotionError, and adds nothing, if one of them cannot be planned. ``reached`` is the distance
        before which the present motion can still stop. If it is near the end, no existing joint is moved any
        more.
        """
        batch = list(blocks)
        if batch:
            self.add_batch([batch], reached)

    def add_batch(self, batch: Sequence[Part], reached: float = -np.inf) -> None:
        """Append blocks given as lists and rows, which must not be empty; see ``add``."""
        table = table_of(batch, self.rpm_max)
        if self._closed:
            raise MotionError(
                Message(
                    "Block {number} comes after the end of the path. Begin a new path.",
                    number=f"{table.n[0]:.0f}",
                ),
                "path-ended",
            )
        _demand_unbroken(table, self._end)
        pieces, counts = _pieces(table, self._limits)
        if self._start is None:
            self._start = table.start[0].copy()
        self._end = table.end[-1].copy()
        self._append(pieces, reached)
        self._blocks.append(table.n.astype(np.int64))
        self._counts.append(counts)
        self._path = None

    def _append(self, new: Pieces, reached: float) -> None:
        """Append pieces and move the joints of short chords before the old end, which the new ones affect."""
        known = joined([*self._parts, new[:0]])
        if self._written is None or not len(known):  # blocks without length leave nothing to continue
            self._parts, self._written = [unrounded(new, self._limits)], new[-2 * SUPPORT :]
            return
        end = self._s0 + float(known.length.sum())
        redo = min(SUPPORT, len(known), len(self._written))
        if reached > end - float(known.length[len(known) - redo :].sum()):
            redo = 0
        self._parts = [known[: len(known) - redo], regrown(known, self._written, new, redo, self._limits)]
        self._written = joined([self._written, new[-2 * SUPPORT :]])[-2 * SUPPORT :]

    def path(self) -> Path:
        """Return the path of all blocks that were added and not dropped.

        Raises MotionError if no block has been added.
        """
        if self._path is None:
            self._path = self._make()
        return self._path

    def close(self) -> None:
        """End the path with an exact stop, so that no blocks can be added."""
        self._closed, self._path = True, None

    def drop_before(self, n: int) -> None:
        """Drop the blocks before block ``n``, except those that its corner limit still needs.

        These are the last block with a length and, for short chords, those within one interval.
        """
        path = self.path()
        keep = int(np.searchsorted(path.blocks, n))
        piece = int(path.first[keep])
        if piece == 0:
            return
        near = int(np.searchsorted(path.s, path.s[piece] - path.reach, side="right")) - 1
        keep = int(np.searchsorted(path.first, max(min(piece - 1, near), 0), side="right")) - 1
        piece = int(path.first[keep])
        self._s0 = float(path.s[piece])
        self._start = path.point(path.s[piece : piece + 1])[0]
        self._parts = [path.pieces[piece:]]
        self._blocks = [path.blocks[keep:]]
        self._counts = [np.diff(path.first)[keep:]]
        self._path = None

    def _make(self) -> Path:
        if self._start is None:
            raise MotionError("The path has no blocks to plan. Add the blocks first.", "no-block")
        pieces = joined(self._parts)
        cap, a, corner = piece_limits(pieces, self._limits, more=not self._closed)
        return Path(
            pieces=pieces,
            s=self._s0 + np.concatenate([[0.0], np.cumsum(pieces.length)]),
            cap=cap,
            a=a,
            corner=corner,
            blocks=np.concatenate(self._blocks),
            first=np.concatenate([[0], np.cumsum(np.concatenate(self._counts))]),
            start=self._start,
            limits=self._limits,
            loose=SUPPORT if not self._closed and ends_in_chord(pieces, self._limits) else 0,
        )


def _pieces(table: BlockTable, limits: MotionLimits) -> tuple[Pieces, IntArray]:
    """Return the pieces of the blocks and the number of pieces (m,) of each block."""
    whole = make_pieces(table, constant_rates(table))
    counts = (whole.length > 0.0).astype(np.int64)
    turned, mapped = (counts > 0) & by_radius(table), with_parts(table)
    parts, done = [], 0
    for i in np.flatnonzero(turned | mapped).tolist():
        split = parts_of(whole, table, limits, i) if mapped[i] else split_by_radius(whole, table, i)
        if len(split) != 1 or mapped[i]:
            parts += [whole[done:i], split]
            counts[i], done = len(split), i + 1
    pieces = joined([*parts, whole[done:]])
    long = pieces.length > 0.0
    return pieces if long.all() else pieces[long], counts


def _demand_unbroken(table: BlockTable, end: FloatArray | None) -> None:
    before = table.end[:-1] if end is None else np.vstack([end, table.end[:-1]])
    gap = np.abs(table.start[len(table.n) - len(before) :] - before)
    if (gap > GAP).any():
        i = int(gap.max(axis=1).argmax()) + len(table.n) - len(before)
        raise MotionError(
            Message(
                "Block {number} starts {max} mm from the end of the previous block. Plan the block from "
                "the current machine position.",
                number=f"{table.n[i]:.0f}",
                max=f"{gap.max():.4f}",
            ),
            "broken-path",
        )
