"""The path: pieces, their limits, which block owns them, and blocks in which C turns too.

C turns with the slides in moves of a virtual mill, and where slides are fed by the turns of C. The path of
such a piece is measured as its feed is, along the mill's way or along the slide's; what X, Z and
C do is its ``direction``. So limits, corners, look-ahead and holds are those of any other line. A curved way
becomes chords in X, Z and C; the reasons are in docs/decisions/0005-c-axis-and-virtual-mill.md.
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
from core.motion.path_pieces import (
    SAME_POINT,
    SUPPORT,
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


CHORD_ERROR = 1e-4  # mm by which a chord may leave the mill's way, seen from the part
STEP_SHARE = 0.5  # of what a corner may ask of an axis: the joints of chords then cost no speed
_FIRST = 16  # chords to begin with
_HALVINGS = 30  # no chord is cut more often
_SHORTEST = 1e-5  # mm; no shorter chord is cut again: distances of a path are good to 1e-9
_ROUNDING = 1e-9
_SPOTS = np.array([0.25, 0.5, 0.75])  # of a chord, where it is compared with the true way
GAP = 1e-6  # mm or degrees between the end of a block and the start of the next


def with_parts(table: BlockTable) -> BoolArray:
    """Blocks (m,) that this module cuts into pieces."""
    parted = _fed_by_c(table)
    if table.way.count(None) < len(table.way):
        parted = parted | np.array([way is not None for way in table.way], dtype=bool)
    return parted


def parts_of(whole: Pieces, table: BlockTable, limits: MotionLimits, index: int) -> Pieces:
    """Piece ``index`` as chords, or as the slide's way and what C turns on behind it.

    Raises MotionError where C turns too little for the slide's way.
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
    """Fractions of the way (k+1,) between which the axes may run in proportion.

    Chords leave the way by CHORD_ERROR at most, measured on the part, and neighbours differ so little that
    their joint does not hold the feed ``rate`` (mm/s) up, unless the way itself has a corner there.
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
    """Chords (k,) between ``ends`` (at ``share``) that leave the way by over CHORD_ERROR, for the part."""
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
    """Chords (k,) at whose ends an axis would have to change its velocity too much at once."""
    length = np.diff(share) * move.length
    direction = np.diff(ends, axis=0) / length[:, None]
    turn = np.abs(np.diff(direction, axis=0))
    mean = 0.5 * (length[:-1] + length[1:])
    fastest = np.minimum(speed, least_ratio(limits.speeds, np.abs(direction)))
    bend = least_ratio(limits.accelerations * CENTRIPETAL_SHARE, turn / mean[:, None])
    v = np.minimum(np.minimum(fastest[:-1], fastest[1:]), np.sqrt(bend))
    sharp = (v[:, None] * turn > STEP_SHARE * limits.accelerations * limits.interval).any(axis=1)
    long = mean > v * limits.interval  # shorter ones are a corner of the way itself
    wide = np.zeros(len(length), dtype=bool)
    wide[:-1] |= sharp & long
    wide[1:] |= sharp & long
    return wide


def _chain(piece: Pieces, points: FloatArray, length: FloatArray) -> Pieces:
    """Straight pieces through ``points`` (k+1, axes) whose ``length`` (k,) is measured otherwise."""
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
    """Straight moves (m,) at a feed per revolution in which the spindle turns as C: its turns are meant."""
    delta = table.end - table.start
    lathe = np.isnan(table.length)
    slides = np.hypot(delta[:, 0], delta[:, 1]) > SAME_POINT
    turned = table.locked & (np.abs(delta[:, 2]) > SAME_POINT)
    fed: BoolArray = lathe & table.per_rev & ~table.arc & slides & turned
    return fed


def _slide_by_c(piece: Pieces, table: BlockTable, index: int) -> Pieces:
    """The slide's way with C, and behind it the degrees that C turns beyond what the way needs."""
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
    """A path in machine coordinates that can be planned; n pieces of m blocks.

    ``s`` (n+1,) is the distance of the joints along the path, mm; it goes on counting where a builder has
    dropped what lies behind. ``cap`` (n,) mm/s and ``a`` (n,) mm/s² are the limits along the pieces,
    ``corner`` (n+1,) the squared speed limits of the joints, endless at both ends. Block i, whose number is
    ``blocks[i]``, owns the pieces ``first[i]:first[i+1]``, none when it has no length. ``start`` (axes,) is
    the point where the path begins. The last ``loose`` joints may yet move, by the step of the words, when
    more blocks come in.
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
        """Length of the whole path, mm."""
        return float(self.s[-1] - self.s[0])

    @property
    def reach(self) -> float:
        """How far round a joint its limit looks at most, mm: the way of one interval."""
        return float(self.limits.interval * self.cap.max(initial=0.0))

    def block_span(self, n: int) -> tuple[float, float]:
        """Distances at which block ``n`` starts and ends. Raises MotionError when it is not on this path."""
        i = int(np.searchsorted(self.blocks, n))
        if i == len(self.blocks) or self.blocks[i] != n:
            raise MotionError(
                Message("Block {number} is not on the planned path.", number=n), "block-not-on-path"
            )
        return float(self.s[self.first[i]]), float(self.s[self.first[i + 1]])

    def piece_at(self, s: FloatArray) -> IntArray:
        """Index of the piece that holds each distance; at a joint the piece that starts there."""
        found: IntArray = np.searchsorted(self.s, s, side="right") - 1
        return np.clip(found, 0, max(len(self) - 1, 0))

    def point(self, s: FloatArray, piece: IntArray | None = None) -> FloatArray:
        """Machine position (k, axes) at the distances ``s`` (k,), exact on lines and arcs."""
        if not len(self):
            return np.tile(self.start, (len(s), 1))
        index = self.piece_at(s) if piece is None else piece
        pieces = self.pieces[index]
        return pieces.point(np.clip(s - self.s[index], 0.0, pieces.length))


class PathBuilder:
    """Makes paths of blocks that come in one after the other.

    ``rpm_max`` is the highest spindle speed that can be reached now: the machine's, or the operator's limit;
    it may be changed and counts for blocks that are added afterwards. A path stays good while it grows: from
    any state of a plan on it, a plan on the longer path is possible.
    """

    def __init__(self, limits: MotionLimits, *, rpm_max: float = np.inf) -> None:
        self._limits = limits
        self.rpm_max = rpm_max
        self._closed = False
        self._parts: list[Pieces] = []
        self._written: Pieces | None = None  # the last pieces as the words have them
        self._blocks: list[IntArray] = []
        self._counts: list[IntArray] = []
        self._start: FloatArray | None = None
        self._end: FloatArray | None = None
        self._s0 = 0.0
        self._path: Path | None = None

    @property
    def holds_blocks(self) -> bool:
        """Whether there is anything to make a path of."""
        return self._start is not None

    def add(self, blocks: Iterable[MotionBlock], reached: float = -np.inf) -> None:
        """Append blocks that move. Raises MotionError, and adds nothing, when one of them cannot be moved.

        ``reached`` is the distance before which a motion under way can still come to rest. Where it comes
        near the end no joint of the path so far is moved any more.
        """
        batch = list(blocks)
        if batch:
            self.add_batch([batch], reached)

    def add_batch(self, batch: Sequence[Part], reached: float = -np.inf) -> None:
        """``add`` for blocks that come as lists and rows, none of them empty."""
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
        """Join on; joints of short chords before the old end are moved to where the new ones say."""
        known = joined([*self._parts, new[:0]])
        if self._written is None or not len(known):  # blocks without length leave nothing to join on to
            self._parts, self._written = [unrounded(new, self._limits)], new[-2 * SUPPORT :]
            return
        end = self._s0 + float(known.length.sum())
        redo = min(SUPPORT, len(known), len(self._written))
        if reached > end - float(known.length[len(known) - redo :].sum()):
            redo = 0
        self._parts = [known[: len(known) - redo], regrown(known, self._written, new, redo, self._limits)]
        self._written = joined([self._written, new[-2 * SUPPORT :]])[-2 * SUPPORT :]

    def path(self) -> Path:
        """The path of all blocks that were added and not dropped. Raises MotionError before the first."""
        if self._path is None:
            self._path = self._make()
        return self._path

    def close(self) -> None:
        """Say that the path ends here, in an exact stop: its last short piece need not be kept in hand."""
        self._closed, self._path = True, None

    def drop_before(self, n: int) -> None:
        """Forget the blocks before block ``n`` but the last with a length: corners need a neighbour.

        Short chords need those of one interval.
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
    """Pieces of the blocks and how many (m,) each block has."""
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
