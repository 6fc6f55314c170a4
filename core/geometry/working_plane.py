"""Mirroring, rotation and scaling within a working plane.

A point of the program is scaled, mirrored, turned about the tool axis, whichever was programmed first.
"""

from __future__ import annotations

from dataclasses import dataclass

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.rotation_frames import Matrix, Vector, cos_sin

Order = tuple[int, int, int]
"""Columns of X Y Z: the two that a plane lies in, from the first to the second, and the third."""

XY: Order = (0, 1, 2)
YZ: Order = (1, 2, 0)
ZX: Order = (2, 0, 1)


def seen(order: Order, point: Vector) -> Vector:
    """A point by the axes of a plane."""
    return point[order[0]], point[order[1]], point[order[2]]


def unseen(order: Order, point: Vector) -> Vector:
    """The point X Y Z of one that is told by the axes of a plane."""
    at = [0.0, 0.0, 0.0]
    for column, value in zip(order, point, strict=True):
        at[column] = value
    return at[0], at[1], at[2]


@dataclass(frozen=True, slots=True)
class Figure:
    """Mirrored axes, rotation about Z in degrees, factor."""

    mirrored: str = ""
    rotation: float = 0.0
    factor: float = 1.0

    @property
    def plain(self) -> bool:
        """Whether the program's coordinates are those of the plane."""
        return self == _PLAIN

    @property
    def reverses(self) -> bool:
        """Whether an arc runs the other way: one of X and Y is mirrored."""
        return ("X" in self.mirrored) != ("Y" in self.mirrored)

    def plane(self, point: Vector) -> Vector:
        """The point of the plane for a point of the program."""
        x, y, z = (at * self._sign(axis) * self.factor for axis, at in zip("XYZ", point, strict=True))
        c, s = cos_sin(self.rotation)
        return c * x - s * y, s * x + c * y, z

    def program(self, point: Vector) -> Vector:
        """The point of the program for a point of the plane."""
        c, s = cos_sin(self.rotation)
        turned = c * point[0] + s * point[1], -s * point[0] + c * point[1], point[2]
        x, y, z = (at * self._sign(axis) / self.factor for axis, at in zip("XYZ", turned, strict=True))
        return x, y, z

    def arc(self, arc: Arc) -> Arc:
        """The arc of the plane for an arc of the program."""
        if self.plain:
            return arc
        start, end, centre = (self._flat(at) for at in (arc.start, arc.end, arc.centre))
        return Arc(start, end, centre, arc.clockwise != self.reverses)

    def upright(self, arc: Arc, order: Order) -> tuple[Arc, Matrix]:
        """An arc in another plane of the program, and the directions (rows of a matrix) of its axes."""
        start, end, centre = (
            (at[0] * self.factor, at[1] * self.factor) for at in (arc.start, arc.end, arc.centre)
        )
        units = (unseen(order, unit) for unit in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
        u, v, w = (tuple(part / self.factor for part in self.plane(unit)) for unit in units)
        rows = tuple((u[row], v[row], w[row]) for row in range(3))
        return Arc(start, end, centre, arc.clockwise), (rows[0], rows[1], rows[2])

    def _flat(self, at: Point) -> Point:
        return self.plane((*at, 0.0))[:2]

    def _sign(self, axis: str) -> float:
        return -1.0 if axis in self.mirrored else 1.0


_PLAIN = Figure()
