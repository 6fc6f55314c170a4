"""The path: pieces, their limits, and which block owns them; built at once or as blocks come in."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from core.message import Message
from core.motion.axis_limits import FloatArray, IntArray, MotionError, MotionLimits
from core.motion.block_table import BlockTable, MotionBlock, Part, table_of
from core.motion.chord_smoothing import SUPPORT, ends_in_chord, regrown, unrounded
from core.motion.curved_axes import parts_of, with_parts
from core.motion.path_pieces import Pieces, joined, make_pieces
from core.motion.speed_limits import by_radius, constant_rates, piece_limits, split_by_radius

GAP = 1e-6  # mm or degrees between the end of a block and the start of the next


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
