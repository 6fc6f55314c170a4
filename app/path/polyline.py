"""One view of a program as a polyline, with the builder that collects its points."""

from __future__ import annotations

import math
from array import array
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from core.geometry.virtual_mill import MillPoint, PlaneMove

FloatArray = npt.NDArray[np.float64]
Bounds = tuple[float, float, float, float]

SAME_POINT_MM = 1e-7  # mm


class StrokeKind(IntEnum):
    """Kinds of stroke. Each point of a polyline has the kind of the chord that ends there.

    ``TURN`` strokes cut on both sides of X0.
    """

    JUMP = 0  # change to the tip of another tool, not drawn
    RAPID = 1
    TURN = 2
    MILL = 3  # feed with the spindle stopped


@dataclass(frozen=True, slots=True, eq=False)
class Polyline:
    """Polyline with points ``z``, ``x`` (p,) in mm, each with the kind of the stroke that ends there.

    - ``z`` is to the right and ``x`` is down. Seen from above, they are Z and X. On the face, they are face X
      and minus face Y. On the unrolled side, they are Z and minus the circumferential length.
    - ``first`` (blocks + 1,): block n ends with point ``first[n] - 1``.
    - ``bounds``: (minimum z, maximum z, minimum x, maximum x) of all cuts, or of all points without cuts.
    - ``arc_centers`` (arcs, 2): z and x of arc centers.
    - ``mm_per_degree``: mm of ``x`` per degree of C, or 0 if ``x`` is not a circumferential length.
    """

    z: FloatArray
    x: FloatArray
    stroke: npt.NDArray[np.uint8]
    first: npt.NDArray[np.int64]
    bounds: Bounds
    arc_centers: FloatArray = field(default_factory=lambda: np.zeros((0, 2)), kw_only=True)
    mm_per_degree: float = field(default=0.0, kw_only=True)

    @property
    def blocks(self) -> int:
        """Return the number of elementary blocks."""
        return len(self.first) - 1

    def count_finished_points(self, block_count: int) -> int:
        """Return the number of points of the first ``block_count`` blocks."""
        return int(self.first[max(0, min(block_count, self.blocks))])

    def find_block(self, point: int) -> int:
        """Return the number of the block that contains the line ending at a point.

        Blocks are counted from 1, and points from 0.
        """
        return int(np.searchsorted(self.first, point, side="right"))


class PolylineBuilder:
    """Builder of a polyline.

    For each block, call ``add_point`` for each of its points, then ``end_block``.
    """

    def __init__(self, block_count: int = 0) -> None:
        self.z, self.x, self.strokes = array("d"), array("d"), array("B")
        self.first_points = array("q", bytes(8 * (block_count + 1)))
        self.centers = array("d")

    def move_to(self, z: float, x: float) -> None:
        """Set the start point, and add a jump if it differs from the last point."""
        if self.z and abs(self.z[-1] - z) < SAME_POINT_MM and abs(self.x[-1] - x) < SAME_POINT_MM:
            return
        self.add_point(z, x, StrokeKind.JUMP)

    def add_point(self, z: float, x: float, stroke: int) -> None:
        """Append a point with the kind of the stroke that ends there."""
        self.z.append(z)
        self.x.append(x)
        self.strokes.append(stroke)

    def add_separate_points(self, z: FloatArray, x: FloatArray, stroke: int) -> None:
        """Append points, each as a separate block that consists of one point."""
        first = len(self.z)
        self.z.frombytes(z.tobytes())
        self.x.frombytes(x.tobytes())
        self.strokes.frombytes(bytes([stroke]) * len(z))
        self.first_points.frombytes(np.arange(first + 1, first + 1 + len(z)).tobytes())

    def end_block(self) -> None:
        """End a block that contains all points added since the previous call."""
        self.first_points.append(len(self.z))

    def make_arrays(self) -> tuple[FloatArray, FloatArray, npt.NDArray[np.uint8], npt.NDArray[np.int64]]:
        """Return the arrays ``z``, ``x``, ``stroke`` and ``first`` of a polyline."""
        return (
            np.array(self.z),
            np.array(self.x),
            np.array(self.strokes, dtype=np.uint8),
            np.array(self.first_points, dtype=np.int64),
        )


def find_bounds(z: FloatArray, x: FloatArray, stroke: npt.NDArray[np.uint8]) -> Bounds:
    """Return the bounding box of all cuts, or of all points if there are no cuts."""
    if not len(z):
        return 0.0, 0.0, 0.0, 0.0
    cut = np.flatnonzero(stroke >= StrokeKind.TURN)
    if len(cut):
        # A stroke starts at the preceding point.
        index = np.concatenate((cut, np.maximum(cut - 1, 0)))
        z, x = z[index], x[index]
    return float(z.min()), float(z.max()), float(x.min()), float(x.max())


# --- arcs as chords -----------------------------------------------------------------------------------


MAX_CHORD_ERROR_MM = 0.004  # mm; half a pixel at 125 pixels per millimeter
TURN_STEP_DEG = 4.0  # degrees of C between two points of a combined move
MAX_TURN_POINTS = 720  # maximum number of points of one turning move


def count_arc_chords(radius_mm: float, sweep_rad: float) -> int:
    """Return the number of chords that approximate an arc.

    The chords deviate from the arc by at most ``MAX_CHORD_ERROR_MM``.
    """
    if radius_mm <= MAX_CHORD_ERROR_MM:
        return 4
    step = 2 * math.acos(1 - MAX_CHORD_ERROR_MM / radius_mm)
    return max(1, math.ceil(abs(sweep_rad) / step))


def count_turn_chords(degrees: float) -> int:
    """Return the number of lines that approximate a move during which C rotates by ``degrees``."""
    return max(1, min(MAX_TURN_POINTS, math.ceil(abs(degrees) / TURN_STEP_DEG)))


def sample_mill_move(move: PlaneMove, c_rotation_deg: float) -> list[MillPoint]:
    """Return the points of a milling move in the coordinates of its plane, without the start point.

    ``c_rotation_deg`` is the rotation of C during the move, in degrees.
    """
    if move.center is None:
        pieces = count_turn_chords(c_rotation_deg)
        (x0, y0, z0), (x1, y1, z1) = move.start, move.end
        shares = [k / pieces for k in range(1, pieces)]
        return [*((x0 + (x1 - x0) * s, y0 + (y1 - y0) * s, z0 + (z1 - z0) * s) for s in shares), move.end]
    radius = move.radius
    sweep = move.length / radius if radius else 0.0
    pieces = max(count_turn_chords(c_rotation_deg), count_arc_chords(radius, sweep))
    return [(x, y, z) for x, y, z in move.compute_mill_points(np.linspace(0.0, 1.0, pieces + 1)[1:]).tolist()]
