"""The path of a motion as pieces with limits, including blocks in which C also rotates.

C moves together with X and Z in moves of a virtual mill, and if a feed per revolution refers to the
revolutions of C. The length of such a piece is measured along the path of the mill or of X and Z, to which
the feed applies. The ``direction`` of the piece is the motion of X, Z and C per unit of length. Limits,
corners, look-ahead and feed hold therefore work as for any other line. A curved move is divided into chords
in X, Z and C. The reasons are in docs/decisions/0005-c-axis-and-virtual-mill.md.
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
from core.motion.block_table import BlockGroup, BlockTable, MotionBlock, build_batch_table
from core.motion.joint_easing import SUPPORT_PIECE_COUNT
from core.motion.path_pieces import (
    SAME_POINT_TOLERANCE,
    PathPieces,
    concatenate_pieces,
    ends_with_chord,
    extend_smoothed_pieces,
    make_pieces,
    smooth_joints,
)
from core.motion.speed_limits import (
    depends_on_radius,
    find_block_speeds,
    find_min_ratio,
    find_piece_limits,
    split_piece_by_radius,
)

if TYPE_CHECKING:
    from core.geometry.working_plane import CurvedMove


MAX_CHORD_ERROR_MM = 1e-4  # mm by which a chord may deviate from the move, measured on the part
VELOCITY_STEP_FRACTION = (
    0.5  # fraction of the velocity step of a corner, so that joints of chords do not limit the speed
)
_FIRST_CHORDS = 16  # initial number of chords
_MAX_HALVINGS = 30  # largest number of halvings
# mm; shorter chords are not halved, because distances along a path have an accuracy of 1e-9 mm
_MIN_CHORD_MM = 1e-5
_ROUNDING = 1e-9
_CHECK_FRACTIONS = np.array([0.25, 0.5, 0.75])  # fractions of a chord at which its deviation is checked
BLOCK_GAP_TOLERANCE = 1e-6  # mm or degrees between the end of a block and the start of the next


def find_divided_blocks(table: BlockTable) -> BoolArray:
    """Return a mask (m,) of the blocks that are divided into several pieces."""
    parted = _find_c_fed_moves(table)
    if table.curved_moves.count(None) < len(table.curved_moves):
        parted = parted | np.array([travel is not None for travel in table.curved_moves], dtype=bool)
    return parted


def divide_piece(pieces: PathPieces, table: BlockTable, limits: MotionLimits, index: int) -> PathPieces:
    """Return the pieces into which the piece ``index`` is divided.

    These are chords, or a move of X, Z and C followed by the remaining rotation of C alone. Raises
    MotionError if C turns too little for the move of X and Z.
    """
    piece, move = pieces[index : index + 1], table.curved_moves[index]
    if move is None:
        return _divide_c_fed_move(piece, table, index)
    if move.length <= SAME_POINT_TOLERANCE:
        return piece[:0]
    share = (
        np.array([0.0, 1.0]) if move.is_straight else divide_into_chords(move, float(piece.rate[0]), limits)
    )
    points = move.compute_machine_positions(share)
    points += table.start[index] - points[0]
    points[-1] = table.end[index]
    return _make_straight_pieces(piece, points, np.diff(share) * move.length)


def divide_into_chords(move: CurvedMove, feed_mm_s: float, limits: MotionLimits) -> FloatArray:
    """Return the fractions (k+1,) of a curved move at which it is divided into chords.

    Along a chord, the axes move proportionally. Measured on the part, the chords deviate from the move by
    at most MAX_CHORD_ERROR_MM. Where two chords meet, their directions differ so little that the feed
    ``feed_mm_s`` is possible, unless the move itself has a corner there.
    """
    share, nearest = np.linspace(0.0, 1.0, _FIRST_CHORDS + 1), move.get_fastest_rotation_fraction()
    if np.abs(share - nearest).min() > _ROUNDING:
        share = np.sort(np.append(share, nearest))
    for _ in range(_MAX_HALVINGS):
        ends = move.compute_machine_positions(share)
        wide = _deviates(move, share, ends) | _exceeds_velocity_step(
            move, share, ends, OVERRIDE_MAX * feed_mm_s, limits
        )
        wide &= np.diff(share) * move.length > _MIN_CHORD_MM
        if not wide.any():
            break
        share = np.sort(np.append(share, 0.5 * (share[:-1] + share[1:])[wide]))
    return share


def _deviates(move: CurvedMove, fractions: FloatArray, ends: FloatArray) -> BoolArray:
    """Return a mask (k,) of the chords whose deviation from the move, on the part, is too large.

    The chords are between the positions ``ends`` at ``fractions`` of the move.
    """
    span, change = np.diff(fractions), np.diff(ends, axis=0)
    true = move.compute_machine_positions((fractions[:-1] + _CHECK_FRACTIONS[:, None] * span).ravel())
    chord = (ends[:-1] + _CHECK_FRACTIONS[:, None, None] * change).reshape(true.shape)
    seen = move.compute_workpiece_points(np.concatenate([chord, true]))
    off = seen[: len(true)] - seen[len(true) :]
    worst: FloatArray = (off**2).sum(axis=1).reshape(len(_CHECK_FRACTIONS), len(span)).max(axis=0)
    return worst > MAX_CHORD_ERROR_MM**2


def _exceeds_velocity_step(
    move: CurvedMove, fractions: FloatArray, ends: FloatArray, speed: float, limits: MotionLimits
) -> BoolArray:
    """Return a mask (k,) of the chords at whose ends the velocity of an axis would change too much."""
    length = np.diff(fractions) * move.length
    direction = np.diff(ends, axis=0) / length[:, None]
    turn = np.abs(np.diff(direction, axis=0))
    mean = 0.5 * (length[:-1] + length[1:])
    fastest = np.minimum(speed, find_min_ratio(limits.speeds, np.abs(direction)))
    bend = find_min_ratio(limits.max_acceleration_array * CENTRIPETAL_SHARE, turn / mean[:, None])
    v = np.minimum(np.minimum(fastest[:-1], fastest[1:]), np.sqrt(bend))
    sharp = (
        v[:, None] * turn > VELOCITY_STEP_FRACTION * limits.max_acceleration_array * limits.interval
    ).any(axis=1)
    long = mean > v * limits.interval  # shorter chords belong to a corner of the move itself
    wide = np.zeros(len(length), dtype=bool)
    wide[:-1] |= sharp & long
    wide[1:] |= sharp & long
    return wide


def _make_straight_pieces(piece: PathPieces, points: FloatArray, length: FloatArray) -> PathPieces:
    """Return straight pieces of the given ``length`` (k,) through ``points`` (k+1, axes)."""
    parts = piece[np.zeros(len(length), dtype=np.int64)]
    zero = np.zeros(len(length))
    return replace(
        parts,
        start=points[:-1],
        direction=np.diff(points, axis=0) / length[:, None],
        centre=np.zeros((len(length), 2)),
        radius=zero,
        angle=zero,
        curvatures=zero,
        length=length,
    )


def _find_c_fed_moves(table: BlockTable) -> BoolArray:
    """Return a mask (m,) of the straight moves whose feed is per revolution of C.

    In these moves, the spindle turns as the C axis.
    """
    if not table.locked.any():
        return np.zeros(len(table.n), dtype=bool)
    delta = table.end - table.start
    lathe = np.isnan(table.length)
    slides = np.hypot(delta[:, 0], delta[:, 1]) > SAME_POINT_TOLERANCE
    turned = table.locked & (np.abs(delta[:, 2]) > SAME_POINT_TOLERANCE)
    fed: BoolArray = lathe & table.per_rev & ~table.arc & slides & turned
    return fed


def _divide_c_fed_move(piece: PathPieces, table: BlockTable, index: int) -> PathPieces:
    """Return the move of X, Z and C, and then the remaining rotation of C alone, if any remains.

    Raises MotionError if C rotates less than the move needs at its feed.
    """
    start, end, feed = table.start[index], table.end[index], float(table.feed[index])
    path_length_mm = float(np.hypot(*(end - start)[:2]))
    needed, turn = path_length_mm / feed * 360.0, float(end[2] - start[2])
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
    first = _make_straight_pieces(piece, np.array([start, there]), np.array([path_length_mm]))
    rest = (abs(turn) - needed) * feed / 360.0
    if rest <= SAME_POINT_TOLERANCE:
        return _make_straight_pieces(piece, np.array([start, end]), np.array([path_length_mm]))
    return concatenate_pieces([first, _make_straight_pieces(piece, np.array([there, end]), np.array([rest]))])


@dataclass(frozen=True, slots=True)
class MotionPath:
    """A path in machine coordinates that can be planned, with n pieces of m blocks.

    A joint is the point at which two pieces meet.
    - ``joint_distances`` (n+1,) are the distances of the joints along the path in mm. They include the
      length of earlier pieces that a builder has dropped.
    - ``speed_caps`` (n,) in mm/s and ``accelerations`` (n,) in mm/s² are the limits along the pieces.
    - ``squared_speed_limits`` (n+1,) are the squared speed limits of the joints, infinite at both ends.
    - The block ``block_numbers[i]`` has the pieces ``first_pieces[i]:first_pieces[i+1]``; a block without
      length has no pieces.
    - ``start_position`` (axes,) is the first point of the path.
    - When blocks are added, the last ``movable_joint_count`` joints may still move by the resolution of
      programmed coordinates.
    """

    pieces: PathPieces
    joint_distances: FloatArray
    speed_caps: FloatArray
    accelerations: FloatArray
    squared_speed_limits: FloatArray
    block_numbers: IntArray
    first_pieces: IntArray
    start_position: FloatArray
    limits: MotionLimits
    movable_joint_count: int = 0

    def __len__(self) -> int:
        return len(self.pieces)

    @property
    def length(self) -> float:
        """Return the length of the whole path, in mm."""
        return float(self.joint_distances[-1] - self.joint_distances[0])

    @property
    def corner_reach_mm(self) -> float:
        """Return the distance around a corner in which the path affects its speed limit, in mm.

        This is the distance that is traveled in one interval at the highest speed.
        """
        return float(self.limits.interval * self.speed_caps.max(initial=0.0))

    def find_block_span(self, number: int) -> tuple[float, float]:
        """Return the distances at which block ``number`` starts and ends.

        Raises MotionError if the block is not on this path.
        """
        i = int(np.searchsorted(self.block_numbers, number))
        if i == len(self.block_numbers) or self.block_numbers[i] != number:
            raise MotionError(
                Message("Block {number} is not on the planned path.", number=number), "block-not-on-path"
            )
        return float(self.joint_distances[self.first_pieces[i]]), float(
            self.joint_distances[self.first_pieces[i + 1]]
        )

    def find_piece_indices(self, distances: FloatArray) -> IntArray:
        """Return the index of the piece at each distance along the path.

        At the junction of two pieces, this is the second piece.
        """
        found: IntArray = np.searchsorted(self.joint_distances, distances, side="right") - 1
        return np.clip(found, 0, max(len(self) - 1, 0))

    def compute_positions(self, distances: FloatArray, piece: IntArray | None = None) -> FloatArray:
        """Return the machine positions (k, axes) at the given distances (k,).

        The positions are exact on lines and arcs.
        """
        if not len(self):
            return np.tile(self.start_position, (len(distances), 1))
        index = self.find_piece_indices(distances) if piece is None else piece
        pieces = self.pieces[index]
        return pieces.point(np.clip(distances - self.joint_distances[index], 0.0, pieces.length))


class PathBuilder:
    """Builder of a path from blocks that are added step by step.

    ``rpm_max`` is the current limit of the spindle speed, set by the machine or by the operator. A change
    applies only to blocks that are added later. The path remains valid while it grows: a motion that was
    planned on a shorter path can be planned again, from any of its states, on the longer path.
    """

    def __init__(self, limits: MotionLimits, *, rpm_max: float = np.inf) -> None:
        self._limits = limits
        self.rpm_max = rpm_max
        self._closed = False
        self._parts: list[PathPieces] = []
        self._written: PathPieces | None = None  # the last pieces as programmed
        self._blocks: list[IntArray] = []
        self._counts: list[IntArray] = []
        self._start: FloatArray | None = None
        self._end: FloatArray | None = None
        self._s0 = 0.0
        self._path: MotionPath | None = None

    @property
    def has_blocks(self) -> bool:
        """Return whether the path contains blocks."""
        return self._start is not None

    def add_blocks(self, blocks: Iterable[MotionBlock], reached_distance: float = -np.inf) -> None:
        """Append blocks that move an axis.

        ``reached_distance`` is the distance before which the current motion can still stop. If this
        distance is near the end of the path, existing joints are no longer moved. If MotionError is raised,
        because a block cannot be planned, no block has been added.
        """
        batch = list(blocks)
        if batch:
            self.add_batch([batch], reached_distance)

    def add_batch(self, batch: Sequence[BlockGroup], reached_distance: float = -np.inf) -> None:
        """Append blocks given as non-empty lists and series; see ``add_blocks``."""
        table = build_batch_table(batch, self.rpm_max)
        if self._closed:
            raise MotionError(
                Message(
                    "Block {number} comes after the end of the path. Begin a new path.",
                    number=f"{table.n[0]:.0f}",
                ),
                "path-ended",
            )
        demand_unbroken(table, self._end)
        pieces, counts = _make_block_pieces(table, self._limits)
        if self._start is None:
            self._start = table.start[0].copy()
        self._end = table.end[-1].copy()
        self._append_pieces(pieces, reached_distance)
        self._blocks.append(table.n.astype(np.int64))
        self._counts.append(counts)
        self._path = None

    def _append_pieces(self, pieces: PathPieces, reached: float) -> None:
        """Append pieces to the path, and repeat the smoothing of the short chords at its previous end.

        The new pieces affect the positions at which these chords meet.
        """
        known = concatenate_pieces([*self._parts, pieces[:0]])
        if self._written is None or not len(known):  # blocks without length leave nothing to continue
            self._parts, self._written = (
                [smooth_joints(pieces, self._limits)],
                pieces[-2 * SUPPORT_PIECE_COUNT :],
            )
            return
        end = self._s0 + float(known.length.sum())
        redo = min(SUPPORT_PIECE_COUNT, len(known), len(self._written))
        if reached > end - float(known.length[len(known) - redo :].sum()):
            redo = 0
        self._parts = [
            known[: len(known) - redo],
            extend_smoothed_pieces(known, self._written, pieces, redo, self._limits),
        ]
        self._written = concatenate_pieces([self._written, pieces[-2 * SUPPORT_PIECE_COUNT :]])[
            -2 * SUPPORT_PIECE_COUNT :
        ]

    def build_path(self) -> MotionPath:
        """Return the path of all blocks that were added and have not been dropped.

        Raises MotionError if no block has been added.
        """
        if self._path is None:
            self._path = self._make()
        return self._path

    def end_path(self) -> None:
        """End the path with an exact stop; no more blocks can be added."""
        self._closed, self._path = True, None

    def drop_blocks_before(self, block_number: int) -> None:
        """Drop the blocks before a block, except those that affect the speed limit at its start.

        These are the last block with a length and, for short chords, the blocks within one interval.
        """
        path = self.build_path()
        keep = int(np.searchsorted(path.block_numbers, block_number))
        piece = int(path.first_pieces[keep])
        if piece == 0:
            return
        near = (
            int(
                np.searchsorted(
                    path.joint_distances, path.joint_distances[piece] - path.corner_reach_mm, side="right"
                )
            )
            - 1
        )
        keep = int(np.searchsorted(path.first_pieces, max(min(piece - 1, near), 0), side="right")) - 1
        piece = int(path.first_pieces[keep])
        self._s0 = float(path.joint_distances[piece])
        self._start = path.compute_positions(path.joint_distances[piece : piece + 1])[0]
        self._parts = [path.pieces[piece:]]
        self._blocks = [path.block_numbers[keep:]]
        self._counts = [np.diff(path.first_pieces)[keep:]]
        self._path = None

    def _make(self) -> MotionPath:
        if self._start is None:
            raise MotionError("The path has no blocks to plan. Add the blocks first.", "no-block")
        pieces = concatenate_pieces(self._parts)
        cap, a, corner = find_piece_limits(pieces, self._limits, has_more_pieces=not self._closed)
        return MotionPath(
            pieces=pieces,
            joint_distances=self._s0 + np.concatenate([[0.0], np.cumsum(pieces.length)]),
            speed_caps=cap,
            accelerations=a,
            squared_speed_limits=corner,
            block_numbers=np.concatenate(self._blocks),
            first_pieces=np.concatenate([[0], np.cumsum(np.concatenate(self._counts))]),
            start_position=self._start,
            limits=self._limits,
            movable_joint_count=SUPPORT_PIECE_COUNT
            if not self._closed and ends_with_chord(pieces, self._limits)
            else 0,
        )


def _make_block_pieces(table: BlockTable, limits: MotionLimits) -> tuple[PathPieces, IntArray]:
    """Return the pieces of the blocks and the number of pieces (m,) of each block."""
    whole = make_pieces(table, find_block_speeds(table))
    counts = (whole.length > 0.0).astype(np.int64)
    turned, mapped = (counts > 0) & depends_on_radius(table), find_divided_blocks(table)
    parts, done = [], 0
    for i in np.flatnonzero(turned | mapped).tolist():
        split = divide_piece(whole, table, limits, i) if mapped[i] else split_piece_by_radius(whole, table, i)
        if len(split) != 1 or mapped[i]:
            parts += [whole[done:i], split]
            counts[i], done = len(split), i + 1
    pieces = concatenate_pieces([*parts, whole[done:]])
    long = pieces.length > 0.0
    return pieces if long.all() else pieces[long], counts


def demand_unbroken(table: BlockTable, end: FloatArray | None) -> None:
    """Raise MotionError if a block does not start where the previous block ends.

    ``end`` (axes,) is the end of the block before the first row, or None if the first row starts the path.
    """
    before = table.end[:-1] if end is None else np.vstack([end, table.end[:-1]])
    gap = np.abs(table.start[len(table.n) - len(before) :] - before)
    if (gap > BLOCK_GAP_TOLERANCE).any():
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
