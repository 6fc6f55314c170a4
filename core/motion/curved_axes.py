"""Blocks in which C turns with the slides: moves of a virtual mill, and slides fed by the turns of C.

The path of such a piece is measured as its feed is, along the mill's way or along the slide's; what X, Z and
C do is its ``direction``. So limits, corners, look-ahead and holds are those of any other line. A curved way
becomes chords in X, Z and C; the reasons are in docs/decisions/0005-c-axis-and-virtual-mill.md.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from core.message import Message
from core.motion.axis_limits import (
    CENTRIPETAL_SHARE,
    OVERRIDE_MAX,
    BoolArray,
    FloatArray,
    MotionError,
    MotionLimits,
)
from core.motion.block_table import BlockTable
from core.motion.path_pieces import SAME_POINT, Pieces, joined
from core.motion.speed_limits import least_ratio

if TYPE_CHECKING:
    from core.geometry.working_plane import CurvedMove

CHORD_ERROR = 1e-4  # mm by which a chord may leave the mill's way, seen from the part
STEP_SHARE = 0.5  # of what a corner may ask of an axis: the joints of chords then cost no speed
_FIRST = 16  # chords to begin with
_HALVINGS = 30  # no chord is cut more often
_SHORTEST = 1e-5  # mm; no shorter chord is cut again: distances of a path are good to 1e-9
_ROUNDING = 1e-9
_SPOTS = np.array([0.25, 0.5, 0.75])  # of a chord, where it is compared with the true way


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
