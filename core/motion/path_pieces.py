"""Lines and arcs as arrays: the geometry on which the time law runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from core.message import Message
from core.motion.axis_limits import BoolArray, FloatArray, IntArray, MotionError
from core.motion.block_table import BlockTable

SAME_POINT = 1e-7  # mm or degrees: nearer points are one point
_STEEPEST = 1e5  # degrees of C a mm: distances along the path are good to 1e-9 mm, so C to a ten-thousandth
_NO_WAY = 1e-4  # mm of the slides beside a turn of C that measures the path then
_TURN_ALONE = 1e-6  # mm of the slides under which the feed is that of C
RADII_DIFFER = 0.02  # mm by which start and end of an arc may differ in their distance from the centre


@dataclass(frozen=True, slots=True)
class Pieces:
    """n lines and arcs in machine coordinates; mm, degrees for C, radians for angles, mm/s.

    Lines: ``start`` (n, axes) and ``direction`` (n, axes), the change of the axes per unit of path. A lathe's
    path is measured in X and Z, and in degrees where only C turns; blocks of other machines say what counts.
    Arcs: ``curvature`` ±1/radius, positive clockwise, 0 for lines; ``angle`` at the start, with
    x = centre x + radius·sin, z = centre z + radius·cos; ``direction`` then holds only what C does. ``block``
    is the owner's n. ``rate`` is the programmed speed.
    """

    block: IntArray
    start: FloatArray
    direction: FloatArray
    centre: FloatArray
    radius: FloatArray
    angle: FloatArray
    curvature: FloatArray
    length: FloatArray
    rate: FloatArray
    rapid: BoolArray

    def __len__(self) -> int:
        return len(self.length)

    def __getitem__(self, part: slice | IntArray | BoolArray) -> Pieces:
        return Pieces(*[getattr(self, name)[part] for name in _FIELDS])

    def tangent(self, at: FloatArray) -> FloatArray:
        """Direction (n, axes) at the distances ``at`` (n,) from the start of each piece."""
        tangent = self.direction.copy(order="K")
        arc = np.flatnonzero(self.curvature)
        if len(arc):
            angle = self.angle[arc] + self.curvature[arc] * at[arc]
            turning = np.sign(self.curvature[arc])
            tangent[arc, 0] += turning * np.cos(angle)
            tangent[arc, 1] -= turning * np.sin(angle)
        return tangent

    def point(self, at: FloatArray) -> FloatArray:
        """Position (n, axes) at the distances ``at`` (n,) from the start of each piece."""
        point = self.start + self.direction * at[:, None]
        arc = self.curvature != 0.0
        if arc.any():
            angle = self.angle[arc] + self.curvature[arc] * at[arc]
            point[arc, 0] = self.centre[arc, 0] + self.radius[arc] * np.sin(angle)
            point[arc, 1] = self.centre[arc, 1] + self.radius[arc] * np.cos(angle)
        return point


_FIELDS = tuple(f.name for f in fields(Pieces))


def joined(parts: Sequence[Pieces]) -> Pieces:
    """Pieces of several arrays, one after the other."""
    if len(parts) == 1:
        return parts[0]
    return Pieces(*[np.concatenate([getattr(p, name) for p in parts]) for name in _FIELDS])


def make_pieces(table: BlockTable, rate: FloatArray) -> Pieces:
    """One piece for each of m blocks, those of length zero included. ``rate`` (m,) is its speed in mm/s.

    Raises MotionError for an arc whose start and end do not lie on one circle.
    """
    delta = table.end - table.start
    length = np.hypot(delta[:, 0], delta[:, 1])
    turn = np.abs(delta[:, 2])
    way, slides = length, length > np.maximum(SAME_POINT, np.minimum(turn / _STEEPEST, _NO_WAY))
    length = np.where(slides, way, np.where(turn > SAME_POINT, turn, 0.0))
    beside = ~slides & (way > _TURN_ALONE) & np.isnan(table.length)
    rate = np.where(beside, rate * length / np.maximum(way, _TURN_ALONE), rate)  # the slides keep their feed
    length = np.where(np.isnan(table.length), length, table.length)
    centre, radius, angle, curvature, sweep = _circles(table)
    length = np.where(curvature != 0.0, radius * sweep, length)
    direction = delta / np.where(length > 0.0, length, 1.0)[:, None]
    direction[curvature != 0.0, :2] = 0.0
    return Pieces(
        block=table.n.astype(np.int64),
        start=table.start,
        direction=direction,
        centre=centre,
        radius=radius,
        angle=angle,
        curvature=curvature,
        length=length,
        rate=rate,
        rapid=table.rapid,
    )


def _circles(table: BlockTable) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Centre, radius, start angle, curvature and positive sweep; zeros for lines and points."""
    m = len(table.n)
    centre, sweep = np.zeros((m, 2)), np.zeros(m)
    radius, angle, curvature = np.zeros(m), np.zeros(m), np.zeros(m)
    arc = np.flatnonzero(table.arc)
    if not len(arc):
        return centre, radius, angle, curvature, sweep
    start, end = table.start[arc, :2], table.end[arc, :2]
    centre[arc] = _settled_centre(table, arc)
    a, b = start - centre[arc], end - centre[arc]
    first, last = np.arctan2(a[:, 0], a[:, 1]), np.arctan2(b[:, 0], b[:, 1])
    turning = np.where(table.clockwise[arc], 1.0, -1.0)
    closed = np.hypot(*(end - start).T) <= SAME_POINT
    sweep[arc] = np.where(closed, 2.0 * np.pi, (turning * (last - first)) % (2.0 * np.pi))
    radius[arc], angle[arc] = np.hypot(a[:, 0], a[:, 1]), first
    real = radius > SAME_POINT
    np.divide(1.0, radius, out=curvature, where=real)
    curvature[arc] *= turning
    return centre, radius, angle, curvature, sweep


def _settled_centre(table: BlockTable, arc: IntArray) -> FloatArray:
    """The centre moved onto the perpendicular bisector of the chord, so that the arc meets its end exactly.

    A program gives centres rounded to the machine's step; without this the path would jump by that step.
    """
    start, end, centre = table.start[arc, :2], table.end[arc, :2], table.centre[arc]
    radii = np.hypot(*(start - centre).T), np.hypot(*(end - centre).T)
    off = np.abs(radii[0] - radii[1])
    if (off > RADII_DIFFER).any():
        worst = int(off.argmax())
        raise MotionError(
            Message(
                "Block {number}: the arc starts {radii} mm and ends {radii2} mm from its center. Correct "
                "the center or the end point.",
                number=f"{table.n[arc[worst]]:.0f}",
                radii=f"{radii[0][worst]:.4f}",
                radii2=f"{radii[1][worst]:.4f}",
            ),
            "arc-radii-differ",
        )
    chord = end - start
    size = np.hypot(chord[:, 0], chord[:, 1])[:, None]
    along = np.divide(chord, size, out=np.zeros_like(chord), where=size > SAME_POINT)
    middle = 0.5 * (start + end)
    settled: FloatArray = centre - along * np.sum((centre - middle) * along, axis=1)[:, None]
    return settled
