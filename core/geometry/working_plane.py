"""Arcs, helices, mirroring and scaling in a mill's working plane, and the motion of all axes in a block.

A point of the program is scaled, then mirrored, then rotated about the tool axis, in any order of
programming.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.rotary_axes import PivotMove, Place
from core.geometry.rotation_frames import IDENTITY, Matrix, Vector, cos_sin
from core.geometry.virtual_mill import PlaneMove

Order = tuple[int, int, int]
"""Columns of X Y Z: the two that a plane lies in, from the first to the second, and the third."""

XY: Order = (0, 1, 2)
YZ: Order = (1, 2, 0)
ZX: Order = (2, 0, 1)
FloatArray = npt.NDArray[np.float64]
_SAMPLES = 65


def seen(order: Order, point: Vector) -> Vector:
    """Return a point X Y Z in the order of the axes of a plane."""
    return point[order[0]], point[order[1]], point[order[2]]


def unseen(order: Order, point: Vector) -> Vector:
    """Return a point given in the order of the axes of a plane as X Y Z."""
    at = [0.0, 0.0, 0.0]
    for column, value in zip(order, point, strict=True):
        at[column] = value
    return at[0], at[1], at[2]


@dataclass(frozen=True, slots=True)
class Figure:
    """Mirrored axes, rotation about Z in degrees, and scale factor."""

    mirrored: str = ""
    rotation: float = 0.0
    factor: float = 1.0

    @property
    def plain(self) -> bool:
        """True if the program's coordinates are those of the plane."""
        return self == _PLAIN

    @property
    def reverses(self) -> bool:
        """True if arcs change their direction because either X or Y is mirrored."""
        return ("X" in self.mirrored) != ("Y" in self.mirrored)

    def plane(self, point: Vector) -> Vector:
        """Return the point of the plane for a point of the program."""
        x, y, z = (at * self._sign(axis) * self.factor for axis, at in zip("XYZ", point, strict=True))
        c, s = cos_sin(self.rotation)
        return c * x - s * y, s * x + c * y, z

    def program(self, point: Vector) -> Vector:
        """Return the point of the program for a point of the plane."""
        c, s = cos_sin(self.rotation)
        turned = c * point[0] + s * point[1], -s * point[0] + c * point[1], point[2]
        x, y, z = (at * self._sign(axis) / self.factor for axis, at in zip("XYZ", turned, strict=True))
        return x, y, z

    def arc(self, arc: Arc) -> Arc:
        """Return the arc of the plane for an arc of the program."""
        if self.plain:
            return arc
        start, end, centre = (self._flat(at) for at in (arc.start, arc.end, arc.centre))
        return Arc(start, end, centre, arc.clockwise != self.reverses)

    def upright(self, arc: Arc, order: Order) -> tuple[Arc, Matrix]:
        """Return an arc in another plane of the program, and its axis directions (rows of a matrix)."""
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


@dataclass(frozen=True, slots=True)
class HelixMove:
    """A helix: ``arc`` in X Y of the system of ``place``, while Z moves from ``z0`` to ``z1``.

    ``standing`` are the machine positions of all axes in the machine's order; X, Y and Z, at ``columns``, are
    replaced. Units are mm and degrees. For an upright arc, ``frame`` (rows) contains the directions of the
    two axes of its plane and of the third axis. X Y Z of the arc then refer to these directions.
    """

    place: Place
    arc: Arc
    z0: float
    z1: float
    standing: tuple[float, ...]
    columns: tuple[int, int, int]
    frame: Matrix = IDENTITY

    @property
    def length(self) -> float:
        """Length of the path, in mm."""
        return math.hypot(self.arc.length, self.z1 - self.z0)

    @property
    def in_degrees(self) -> bool:
        """Always False, because the feed is in mm."""
        return False

    @property
    def straight(self) -> bool:
        """Always False, because the linear axes do not move proportionally."""
        return False

    def machine(self, share: FloatArray) -> FloatArray:
        """Return machine positions (k, axes), in the machine's order, at fractions (k,) of the move."""
        (cx, cy), (x0, y0), radius = self.arc.centre, self.arc.start, self.arc.radius
        # A positive sweep is clockwise, seen with X to the right and Y up.
        angle = math.atan2(y0 - cy, x0 - cx) - self.arc.sweep * share
        z = self.z0 + share * (self.z1 - self.z0)
        points = np.stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle), z], axis=1)
        rows = np.repeat(np.array([self.standing]), len(share), axis=0)
        turn = np.array(self.place.turn) @ np.array(self.frame)
        rows[:, self.columns] = points @ turn.T + np.array(self.place.shift)
        return rows

    def part(self, points: FloatArray) -> FloatArray:
        """Return points (k, 3) of the working plane's system at machine positions (k, axes)."""
        spots: FloatArray = (points[:, self.columns] - np.array(self.place.shift)) @ np.array(self.place.turn)
        return spots

    def nearest(self) -> float:
        """Return 0.5, because no fraction of the move is more critical than another."""
        return 0.5


CurvedMove = HelixMove | PivotMove | PlaneMove
"""A way on which the axes do not run in proportion, unless it is ``straight`` after all.

All tell ``length`` (what the feed counts: mm, or ``in_degrees`` where rotary axes are meant), ``machine``
positions (k, axes) at fractions (k,) from 0 to 1, without a jump, where the tool is on the ``part`` (k, 3) at
machine positions, and the fraction ``nearest`` to where the axes turn most for the way.
"""


@dataclass(frozen=True, slots=True)
class Travel:
    """A move from ``start`` to ``end``, which are machine positions of all axes in the machine's order.

    Linear axes come first, in mm. Rotary axes are in degrees and continuous. ``length`` is the length for the
    feed: in mm, or in degrees if only rotary axes turn. ``way`` is given if the axes do not move
    proportionally, and has the same length. ``slides`` is True if a linear axis is programmed to move.
    """

    start: tuple[float, ...]
    end: tuple[float, ...]
    length: float
    way: CurvedMove | None = None
    slides: bool = True

    def reach(self) -> tuple[FloatArray, FloatArray]:
        """Return the least and greatest position of each axis (axes,); for straight moves, only the end."""
        if self.way is None:
            return np.array(self.end), np.array(self.end)
        points = self.way.machine(np.linspace(0.0, 1.0, _SAMPLES))
        return points.min(axis=0), points.max(axis=0)
