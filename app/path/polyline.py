"""One view of a program as a polyline, and what collects it point by point."""

from __future__ import annotations

import math
from array import array
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove, Spot

Floats = npt.NDArray[np.float64]
Bounds = tuple[float, float, float, float]

SAME = 1e-7  # mm


class Stroke(IntEnum):
    """What the chord that ends in a point is; ``TURN`` strokes cut both sides of X0."""

    JUMP = 0  # another tool's tip: nothing is drawn
    RAPID = 1
    TURN = 2
    MILL = 3  # fed with the spindle standing


@dataclass(frozen=True, slots=True, eq=False)
class Polyline:
    """Points ``z x`` (p,) with the stroke that ends in each; block n ends with point ``first[n] - 1``.

    ``z`` goes to the right and ``x`` downwards, mm: Z and X seen from above; on the face of the part its own
    X and minus its Y; on the unrolled side Z and minus the way round. ``first`` is (blocks + 1,). ``bounds``
    (least z, greatest z, least x, greatest x) of what is cut, or of everything when nothing is. ``centres``
    (arcs, 2) are z and x of the middles of arcs. ``round`` is how many mm of ``x`` are a degree of C, 0 where
    ``x`` is no way round.
    """

    z: Floats
    x: Floats
    stroke: npt.NDArray[np.uint8]
    first: npt.NDArray[np.int64]
    bounds: Bounds
    centres: Floats = field(default_factory=lambda: np.zeros((0, 2)), kw_only=True)
    round: float = field(default=0.0, kw_only=True)

    @property
    def blocks(self) -> int:
        """How many elementary blocks it was made of."""
        return len(self.first) - 1

    def points_done(self, blocks: int) -> int:
        """How many points are behind when so many blocks are."""
        return int(self.first[max(0, min(blocks, self.blocks))])

    def block_of_point(self, point: int) -> int:
        """The number of the block, from 1, that the chord which ends in a point (from 0) belongs to."""
        return int(np.searchsorted(self.first, point, side="right"))


class PolylineBuilder:
    """Draws a polyline: ``to`` as often as a block needs it, then ``end_block``."""

    def __init__(self, blocks: int = 0) -> None:
        self.z, self.x, self.stroke = array("d"), array("d"), array("B")
        self.first = array("q", bytes(8 * (blocks + 1)))
        self.centres = array("d")

    def start(self, z: float, x: float) -> None:
        """Be at a point, by a jump where the pencil is elsewhere."""
        if self.z and abs(self.z[-1] - z) < SAME and abs(self.x[-1] - x) < SAME:
            return
        self.to(z, x, Stroke.JUMP)

    def to(self, z: float, x: float, stroke: int) -> None:
        """Draw on to a point."""
        self.z.append(z)
        self.x.append(x)
        self.stroke.append(stroke)

    def row(self, z: Floats, x: Floats, stroke: int) -> None:
        """Draw on from point to point, each the end of a block of its own."""
        first = len(self.z)
        self.z.frombytes(z.tobytes())
        self.x.frombytes(x.tobytes())
        self.stroke.frombytes(bytes([stroke]) * len(z))
        self.first.frombytes(np.arange(first + 1, first + 1 + len(z)).tobytes())

    def end_block(self) -> None:
        """What was drawn since the last call was one block."""
        self.first.append(len(self.z))

    def arrays(self) -> tuple[Floats, Floats, npt.NDArray[np.uint8], npt.NDArray[np.int64]]:
        """``z``, ``x``, ``stroke`` and ``first`` of a polyline."""
        return (
            np.array(self.z),
            np.array(self.x),
            np.array(self.stroke, dtype=np.uint8),
            np.array(self.first, dtype=np.int64),
        )


def bounds_of(z: Floats, x: Floats, stroke: npt.NDArray[np.uint8]) -> Bounds:
    """The box round what is cut, or round everything when nothing is."""
    if not len(z):
        return 0.0, 0.0, 0.0, 0.0
    cut = np.flatnonzero(stroke >= Stroke.TURN)
    if len(cut):
        # A stroke's start is the point before it.
        index = np.concatenate((cut, np.maximum(cut - 1, 0)))
        z, x = z[index], x[index]
    return float(z.min()), float(z.max()), float(x.min()), float(x.max())


# --- arcs as chords -----------------------------------------------------------------------------------


CHORD_ERROR = 0.004  # mm: half a pixel at 125 pixels to the millimetre
TURN_STEP = 4.0  # degrees of C from point to point where the slides go along with it
MOST = 720  # points of one turning way


def arc_pieces(radius: float, sweep: float) -> int:
    """Into how many chords an arc falls so that none leaves it by more than CHORD_ERROR."""
    if radius <= CHORD_ERROR:
        return 4
    step = 2 * math.acos(1 - CHORD_ERROR / radius)
    return max(1, math.ceil(abs(sweep) / step))


def turn_pieces(degrees: float) -> int:
    """Into how many chords a way falls along which C turns so far."""
    return max(1, min(MOST, math.ceil(abs(degrees) / TURN_STEP)))


def mill_way(move: PlaneMove, degrees: float) -> list[Spot]:
    """Points of the mill's way in its own frame from behind the start to the end; ``degrees`` is C's turn."""
    if move.centre is None:
        pieces = turn_pieces(degrees)
        (x0, y0, z0), (x1, y1, z1) = move.start, move.end
        shares = [k / pieces for k in range(1, pieces)]
        return [*((x0 + (x1 - x0) * s, y0 + (y1 - y0) * s, z0 + (z1 - z0) * s) for s in shares), move.end]
    radius = move.radius
    sweep = move.length / radius if radius else 0.0
    pieces = max(turn_pieces(degrees), arc_pieces(radius, sweep))
    return [(x, y, z) for x, y, z in move.points(np.linspace(0.0, 1.0, pieces + 1)[1:]).tolist()]
