"""Arcs, helices, mirroring and scaling in a mill's working plane, and moves of all axes.

A programmed point is scaled, then mirrored, then rotated about the tool axis. The order in which these
functions are programmed has no effect.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.rotary_axes import FrameTransform, PivotMove
from core.geometry.rotation_frames import IDENTITY, Matrix, Vector, compute_exact_cos_sin
from core.geometry.virtual_mill import PlaneMove

AxisOrder = tuple[int, int, int]
"""Column indexes of X, Y and Z: the first and second axis of the plane, and the third axis."""

XY_ORDER: AxisOrder = (0, 1, 2)
YZ_ORDER: AxisOrder = (1, 2, 0)
ZX_ORDER: AxisOrder = (2, 0, 1)
FloatArray = npt.NDArray[np.float64]
_SAMPLES = 65


def convert_to_plane_order(order: AxisOrder, point: Vector) -> Vector:
    """Convert a point from the order X Y Z to the axis order of a plane."""
    return point[order[0]], point[order[1]], point[order[2]]


def convert_from_plane_order(order: AxisOrder, point: Vector) -> Vector:
    """Convert a point from the axis order of a plane to the order X Y Z."""
    at = [0.0, 0.0, 0.0]
    for column, value in zip(order, point, strict=True):
        at[column] = value
    return at[0], at[1], at[2]


@dataclass(frozen=True, slots=True)
class ProgramTransform:
    """Transformation of program coordinates: mirrored axes, rotation about Z in degrees, and scale factor."""

    mirrored_axes: str = ""
    rotation_deg: float = 0.0
    scale_factor: float = 1.0

    @property
    def is_identity(self) -> bool:
        """Return whether the transformation leaves all points unchanged."""
        return self == _IDENTITY_TRANSFORM

    @property
    def reverses_arcs(self) -> bool:
        """Return whether arcs change their direction because only one of X and Y is mirrored."""
        return ("X" in self.mirrored_axes) != ("Y" in self.mirrored_axes)

    def convert_to_plane(self, point: Vector) -> Vector:
        """Convert a programmed point to coordinates of the working plane."""
        x, y, z = (at * self._sign(axis) * self.scale_factor for axis, at in zip("XYZ", point, strict=True))
        c, s = compute_exact_cos_sin(self.rotation_deg)
        return c * x - s * y, s * x + c * y, z

    def convert_to_program(self, point: Vector) -> Vector:
        """Convert a point of the working plane to program coordinates."""
        c, s = compute_exact_cos_sin(self.rotation_deg)
        turned = c * point[0] + s * point[1], -s * point[0] + c * point[1], point[2]
        x, y, z = (at * self._sign(axis) / self.scale_factor for axis, at in zip("XYZ", turned, strict=True))
        return x, y, z

    def transform_arc(self, arc: Arc) -> Arc:
        """Convert a programmed arc to coordinates of the working plane."""
        if self.is_identity:
            return arc
        start, end, centre = (self._flat(at) for at in (arc.start, arc.end, arc.center))
        return Arc(start, end, centre, arc.clockwise != self.reverses_arcs)

    def transform_upright_arc(self, arc: Arc, order: AxisOrder) -> tuple[Arc, Matrix]:
        """Return a scaled arc that is programmed in YZ or ZX, and the directions of its axes.

        The directions are the rows of a matrix.
        """
        start, end, centre = (
            (at[0] * self.scale_factor, at[1] * self.scale_factor) for at in (arc.start, arc.end, arc.center)
        )
        units = (
            convert_from_plane_order(order, unit)
            for unit in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        )
        u, v, w = (tuple(part / self.scale_factor for part in self.convert_to_plane(unit)) for unit in units)
        rows = tuple((u[row], v[row], w[row]) for row in range(3))
        return Arc(start, end, centre, arc.clockwise), (rows[0], rows[1], rows[2])

    def _flat(self, at: Point) -> Point:
        return self.convert_to_plane((*at, 0.0))[:2]

    def _sign(self, axis: str) -> float:
        return -1.0 if axis in self.mirrored_axes else 1.0


_IDENTITY_TRANSFORM = ProgramTransform()


@dataclass(frozen=True, slots=True)
class HelixMove:
    """A helix in the coordinate system of a working plane. Units are mm and degrees.

    - ``arc`` is in X and Y of the system of ``transform``, while Z moves from ``z_start`` to ``z_end``.
    - ``base_position`` contains the machine positions of all axes in the machine's order. The helix
      replaces the positions of X, Y and Z, which are at the indexes ``xyz_columns``.
    - ``frame`` is used for an upright arc (in YZ or ZX). Its rows are the directions of the two axes of the
      arc's plane and of the third axis. X, Y and Z of the arc then refer to these directions.
    """

    transform: FrameTransform
    arc: Arc
    z_start: float
    z_end: float
    base_position: tuple[float, ...]
    xyz_columns: tuple[int, int, int]
    frame: Matrix = IDENTITY

    @property
    def length(self) -> float:
        """Return the length of the path, in mm."""
        return math.hypot(self.arc.length, self.z_end - self.z_start)

    @property
    def is_feed_in_degrees(self) -> bool:
        """Return False, because the feed is in mm."""
        return False

    @property
    def is_straight(self) -> bool:
        """Return False, because the linear axes do not move in proportion to each other."""
        return False

    def compute_machine_positions(self, fractions: FloatArray) -> FloatArray:
        """Return the machine positions (k, axes) at fractions (k,) of the move.

        The columns are in the machine's axis order.
        """
        (cx, cy), (x0, y0), radius = self.arc.center, self.arc.start, self.arc.radius
        # A positive sweep is clockwise, seen with X to the right and Y up.
        angle = math.atan2(y0 - cy, x0 - cx) - self.arc.sweep_rad * fractions
        z = self.z_start + fractions * (self.z_end - self.z_start)
        points = np.stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle), z], axis=1)
        rows = np.repeat(np.array([self.base_position]), len(fractions), axis=0)
        turn = np.array(self.transform.rotation) @ np.array(self.frame)
        rows[:, self.xyz_columns] = points @ turn.T + np.array(self.transform.translation)
        return rows

    def compute_workpiece_points(self, positions: FloatArray) -> FloatArray:
        """Return the working-plane points (k, 3) in mm for machine positions (k, axes)."""
        spots: FloatArray = (
            positions[:, self.xyz_columns] - np.array(self.transform.translation)
        ) @ np.array(self.transform.rotation)
        return spots

    def get_fastest_rotation_fraction(self) -> float:
        """Return 0.5, because the axis rotation per path length has no particular maximum."""
        return 0.5


CurvedMove = HelixMove | PivotMove | PlaneMove
"""Move on which the axes do not move proportionally, unless ``is_straight`` is True.

``length`` is the length that the feed counts, in mm, or in degrees if ``is_feed_in_degrees``.
``compute_machine_positions`` returns positions (k, axes) at fractions (k,) from 0 to 1, without jumps.
``compute_workpiece_points`` returns the tool positions (k, 3) at machine positions.
``get_fastest_rotation_fraction`` returns the fraction at which the axes turn most per path length.
"""


@dataclass(frozen=True, slots=True)
class AxisMove:
    """A move from ``start`` to ``end``: machine positions of all axes in the machine's order.

    Linear axes are first, in mm. Rotary axes are in degrees and continuous. ``length`` is the length to
    which the feed applies, in mm, or in degrees if only rotary axes turn. ``curved_move`` is the curved
    path of the same length if the axes do not move proportionally. ``slides`` is True if a linear axis is
    programmed to move.
    """

    start: tuple[float, ...]
    end: tuple[float, ...]
    length: float
    curved_move: CurvedMove | None = None
    slides: bool = True

    def reach(self) -> tuple[FloatArray, FloatArray]:
        """Return the minimum and the maximum position of each axis during the move, shape (axes,).

        For a straight move, both are the end position.
        """
        if self.curved_move is None:
            return np.array(self.end), np.array(self.end)
        points = self.curved_move.compute_machine_positions(np.linspace(0.0, 1.0, _SAMPLES))
        return points.min(axis=0), points.max(axis=0)
