"""Rotary axes of a mill from workpiece to tool, and machine positions of programmed points.

The same rule applies to heads and tables. The frame of the tool as seen from the workpiece is the product
of Rot(axis, +angle) over the chain from the workpiece to the tool. A head at +t rotates the tool by +t. A
table at +t rotates the workpiece by -t in the machine, so the tool, as seen from the workpiece, also
rotates by +t. In a ``PivotMove``, the linear axes follow the rotation, so that a point remains fixed on the
workpiece (MOVE).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from core.geometry.rotation_frames import (
    IDENTITY,
    Z_AXIS,
    Matrix,
    Vector,
    add_vectors,
    apply_matrix,
    make_rotation,
    multiply_matrices,
    scale_vector,
    subtract_vectors,
    transpose_matrix,
)

FULL_TURN_DEG = 360.0
RANGE_TOLERANCE_DEG = 1e-9  # degrees of tolerance at the ends of a range


@dataclass(frozen=True, slots=True)
class LinearAxis:
    """A linear axis, with its travel in mm from home and its maximum speed in mm/s."""

    name: str
    travel_min: float = -math.inf
    travel_max: float = math.inf
    vmax: float = math.inf


@dataclass(frozen=True, slots=True)
class RotaryAxis:
    """A rotary axis of a mill.

    ``direction`` (unit vector) and ``point_on_axis`` (mm) define its line when all axes are at 0. The point
    of a table is in machine coordinates. The point of a head is measured from the spindle nose. If
    ``is_modulo`` is True, the axis turns endlessly and displays 0 to 360 degrees. Otherwise ``travel_min``
    and ``travel_max`` limit the axis, both inclusive.
    """

    name: str
    is_table: bool
    direction: Vector
    point_on_axis: Vector
    travel_min: float = -math.inf
    travel_max: float = math.inf
    is_modulo: bool = False
    vmax: float = math.inf  # degrees/s

    def is_in_range(self, angle: float) -> bool:
        """Return whether the angle is within the range of the axis."""
        return (
            self.is_modulo
            or self.travel_min - RANGE_TOLERANCE_DEG <= angle <= self.travel_max + RANGE_TOLERANCE_DEG
        )

    def get_displayed_angle(self, angle: float) -> float:
        """Return the angle as it is displayed, which is 0 to 360 degrees on a modulo axis."""
        if not self.is_modulo:
            return angle + 0.0
        rest = angle % FULL_TURN_DEG
        return 0.0 if FULL_TURN_DEG - rest < RANGE_TOLERANCE_DEG else rest

    def find_travel(self, start: float, target: float) -> float:
        """Return the signed travel from ``start`` to ``target`` in degrees.

        A modulo axis takes the shorter direction. If both directions are 180 degrees, the travel is
        positive.
        """
        travel_deg = target - start
        if not self.is_modulo:
            return travel_deg
        short = travel_deg % FULL_TURN_DEG
        return short - FULL_TURN_DEG if short > FULL_TURN_DEG / 2.0 + RANGE_TOLERANCE_DEG else short


@dataclass(frozen=True, slots=True)
class FrameTransform:
    """The transformation from points of a coordinate system to machine positions, in mm.

    The formula is machine = rotation · point + translation. It is valid only for one position of the rotary
    axes.
    """

    rotation: Matrix
    translation: Vector

    def convert_to_machine_position(self, point: Vector) -> Vector:
        """Convert a point of the coordinate system to the machine position of the linear axes, in mm."""
        return add_vectors(apply_matrix(self.rotation, point), self.translation)

    def convert_to_frame_point(self, machine: Vector) -> Vector:
        """Convert a machine position of the linear axes to the point of the coordinate system, in mm."""
        return apply_matrix(transpose_matrix(self.rotation), subtract_vectors(machine, self.translation))


@dataclass(frozen=True, slots=True)
class DatumPreset:
    """A row of the preset table.

    ``origin`` is the machine position of the workpiece zero in mm. ``rotation_deg`` is the basic rotation
    of the workpiece about Z in degrees. ``axis_zeros`` contains the machine angles at which the rotary axes
    read 0, by axis name; an axis that is not listed has the angle 0. ``origin`` and ``rotation_deg`` apply
    when the rotary axes are at these angles.
    """

    origin: Vector
    rotation_deg: float = 0.0
    axis_zeros: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class Kinematics:
    """The axes of a mill: X, Y, Z and the rotary axes in order from workpiece to tool.

    Tables precede heads in this order. ``origin`` is the machine position of the workpiece zero with all
    rotary axes at 0. ``basic_rotation_deg`` is the angle of the workpiece system about Z relative to the
    machine. It applies with the rotary axes at ``axis_zeros``, where they read 0. ``axis_order`` lists all
    axes in the machine's order. Angles are machine angles unless noted otherwise.
    """

    linear_axes: tuple[LinearAxis, LinearAxis, LinearAxis]
    rotary_axes: tuple[RotaryAxis, ...]
    origin: Vector
    basic_rotation_deg: float = 0.0
    axis_order: tuple[str, ...] = field(default=())
    axis_zeros: tuple[tuple[str, float], ...] = ()

    @cached_property
    def workpiece_rotation(self) -> Matrix:
        """Return the rotation of the workpiece system in machine coordinates with all rotary axes at 0."""
        turn, _ = self._table_transform(self.zero_angles)
        return multiply_matrices(transpose_matrix(turn), make_rotation(Z_AXIS, self.basic_rotation_deg))

    @cached_property
    def zero_angles(self) -> Mapping[str, float]:
        """Return the machine angle at which each rotary axis reads 0, by axis name."""
        return {axis.name: 0.0 for axis in self.rotary_axes} | dict(self.axis_zeros)

    def apply_preset(self, preset: DatumPreset) -> Kinematics:
        """Return the same machine with the workpiece zero and the basic rotation of a preset."""
        zeros = tuple(
            each for each in preset.axis_zeros if self.find_rotary_axis(each[0]) is not None and each[1]
        )
        moved = replace(self, basic_rotation_deg=preset.rotation_deg, axis_zeros=zeros)
        return replace(moved, origin=moved.move_from_table_zeros(preset.origin))

    def move_from_table_zeros(self, point: Vector) -> Vector:
        """Return the position of a workpiece point after the tables rotate from their zeros to angle 0.

        Both positions are in machine coordinates in mm. ``point`` is the position before the rotation.
        """
        turn, shift = self._table_transform(self.zero_angles)
        return apply_matrix(transpose_matrix(turn), subtract_vectors(point, shift))

    def move_to_table_zeros(self, point: Vector) -> Vector:
        """Return the position of a workpiece point after the tables rotate to their zeros.

        ``point`` is its position with the tables at machine angle 0. The zeros are the machine angles at
        which the tables read 0. Both positions are in machine coordinates in mm.
        """
        turn, shift = self._table_transform(self.zero_angles)
        return add_vectors(apply_matrix(turn, point), shift)

    def get_displayed_angle(self, axis: RotaryAxis, angle: float) -> float:
        """Return the displayed value of a machine angle, relative to the zero of the axis."""
        return axis.get_displayed_angle(angle - self.zero_angles[axis.name])

    @property
    def axis_names(self) -> tuple[str, ...]:
        """Return the names of all axes in the machine's order."""
        return self.axis_order or (*(s.name for s in self.linear_axes), *(r.name for r in self.rotary_axes))

    def find_rotary_axis(self, name: str) -> RotaryAxis | None:
        """Return the rotary axis with this name, or None if the machine has no such axis."""
        return next((axis for axis in self.rotary_axes if axis.name == name), None)

    def compute_tool_frame(self, angles: Mapping[str, float]) -> Matrix:
        """Return the frame (orientation) of the tool as seen from the workpiece at the given angles.

        ``angles`` contains angles by axis name; an axis that is not listed has the angle 0.
        """
        return multiply_matrices(
            *(make_rotation(axis.direction, angles.get(axis.name, 0.0)) for axis in self.rotary_axes)
        )

    def make_transform(
        self,
        angles: Mapping[str, float],
        frame: Matrix = IDENTITY,
        datum: Vector = (0.0, 0.0, 0.0),
        tool_length: float = 0.0,
    ) -> FrameTransform:
        """Return the transformation from a coordinate system to positions of the linear axes.

        The system has the axes ``frame`` and the origin ``datum`` (mm). Both are specified in the
        machine-parallel system at the workpiece zero, without tilt. The transformation is valid only for
        the given angles and tool length.
        """
        turn, shift = self._table_transform(angles)
        spot = apply_matrix(turn, add_vectors(self.origin, datum))
        nose = self._nose_to_tip(angles, tool_length)
        return FrameTransform(
            multiply_matrices(turn, frame), subtract_vectors(add_vectors(spot, shift), nose)
        )

    def compute_tool_direction(self, angles: Mapping[str, float]) -> Vector:
        """Return the direction from the tip to the spindle, in machine coordinates."""
        return apply_matrix(
            multiply_matrices(*(make_rotation(a.direction, angles.get(a.name, 0.0)) for a in self._heads)),
            Z_AXIS,
        )

    def compute_tip_position(
        self, angles: Mapping[str, float], positions: Vector, tool_length: float = 0.0
    ) -> Vector:
        """Return the machine position of the tool tip in mm for the given positions of the linear axes."""
        return add_vectors(positions, self._nose_to_tip(angles, tool_length))

    @property
    def _heads(self) -> Sequence[RotaryAxis]:
        return [axis for axis in self.rotary_axes if not axis.is_table]

    def _table_transform(self, angles: Mapping[str, float]) -> tuple[Matrix, Vector]:
        """Return the rotation and the shift of a workpiece point when the tables rotate from 0.

        ``angles`` are the new angles of the tables by axis name.
        """
        turn, shift = IDENTITY, (0.0, 0.0, 0.0)
        for axis in self.rotary_axes:
            if axis.is_table:
                back = make_rotation(axis.direction, -angles.get(axis.name, 0.0))
                turn = multiply_matrices(back, turn)
                shift = add_vectors(
                    apply_matrix(back, subtract_vectors(shift, axis.point_on_axis)), axis.point_on_axis
                )
        return turn, shift

    def _nose_to_tip(self, angles: Mapping[str, float], tool_length: float) -> Vector:
        """Return the vector from the spindle nose to the tool tip in machine coordinates, in mm.

        The start of the vector is the position of the spindle nose with all heads at angle 0. The end is
        the position of the tip with the heads at ``angles``.
        """
        tip = scale_vector(Z_AXIS, -tool_length)
        for axis in reversed(self._heads):
            turn = make_rotation(axis.direction, angles.get(axis.name, 0.0))
            tip = add_vectors(
                apply_matrix(turn, subtract_vectors(tip, axis.point_on_axis)), axis.point_on_axis
            )
        return tip


FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PivotMove:
    """A move of the rotary axes from ``start_angles`` to ``end_angles`` around a fixed point.

    ``pivot`` is the fixed point in mm, in the machine-parallel system at the workpiece zero. It is
    ``pivot_distance`` mm below the tool tip along the tool, and ``length`` is in degrees. If ``pivot_end``
    is not None, the pivot itself moves straight to ``pivot_end``, and ``length`` is in mm.
    """

    kinematics: Kinematics
    start_angles: Mapping[str, float]
    end_angles: Mapping[str, float]
    pivot: Vector
    pivot_distance: float
    tool_length: float
    length: float
    pivot_end: Vector | None = None

    @property
    def is_feed_in_degrees(self) -> bool:
        """Return whether the feed is in degrees, which is the case if the pivot is fixed."""
        return self.pivot_end is None

    @property
    def is_straight(self) -> bool:
        """Return False, because the linear axes do not move proportionally to the angles."""
        return False

    def compute_machine_positions(self, fractions: FloatArray) -> FloatArray:
        """Return the machine positions (k, axes) at fractions (k,) of the move.

        The columns are in the machine's axis order.
        """
        at: dict[str, FloatArray] = {
            name: start + fractions * (self.end_angles[name] - start)
            for name, start in self.start_angles.items()
        }
        first, last = np.array(self.pivot), np.array(self.pivot_end or self.pivot)
        spots = np.array(self.kinematics.origin) + first + fractions[:, np.newaxis] * (last - first)
        slides = _rotate_with_tables(self.kinematics, at, spots)
        slides = slides - _noses_to_tips(self.kinematics, at, self.tool_length + self.pivot_distance)
        at |= {"X": slides[:, 0], "Y": slides[:, 1], "Z": slides[:, 2]}
        rows: FloatArray = np.stack([at[name] for name in self.kinematics.axis_names], axis=1)
        return rows

    def compute_end_positions(self) -> dict[str, float]:
        """Return the machine positions of all axes at the end of the move, by axis name."""
        there = dict(
            zip(
                self.kinematics.axis_names,
                self.compute_machine_positions(np.ones(1))[0].tolist(),
                strict=True,
            )
        )
        return {**there, **self.end_angles}

    def compute_workpiece_points(self, positions: FloatArray) -> FloatArray:
        """Return the positions of the tip on the workpiece (k, 3) in mm for machine positions (k, axes)."""
        at = dict(zip(self.kinematics.axis_names, positions.T, strict=True))
        spots: FloatArray = np.stack([at[name] for name in "XYZ"], axis=1)
        spots = spots + _noses_to_tips(self.kinematics, at, self.tool_length)
        for axis in reversed(self.kinematics.rotary_axes):
            if axis.is_table:
                spots = _rotate_about_axis(axis, at[axis.name], spots)
        spots -= np.array(self.kinematics.origin)
        return spots

    def get_fastest_rotation_fraction(self) -> float:
        """Return 0.5, the middle of the move, because the rotation has no particular maximum."""
        return 0.5


def _rotate_with_tables(
    machine: Kinematics, angles: Mapping[str, FloatArray], points: FloatArray
) -> FloatArray:
    """Return workpiece points (k, 3) in mm after the tables have rotated from 0 to the angles (k,)."""
    for axis in machine.rotary_axes:
        if axis.is_table:
            points = _rotate_about_axis(axis, -angles[axis.name], points)
    return points


def _noses_to_tips(machine: Kinematics, angles: Mapping[str, FloatArray], tool_length: float) -> FloatArray:
    """Return the vectors from the spindle nose to the tool tip at the head angles (k,), in mm.

    The vectors start where the nose is with the heads at 0. The result has the shape (k, 3), or one row if
    there are no heads.
    """
    tips: FloatArray = np.array([[0.0, 0.0, -tool_length]])
    for axis in reversed(machine.rotary_axes):
        if not axis.is_table:
            tips = _rotate_about_axis(axis, angles[axis.name], tips)
    return tips


def _rotate_about_axis(axis: RotaryAxis, degrees: FloatArray, points: FloatArray) -> FloatArray:
    """Return one or several points (k, 3), rotated about an axis by the angles (k,) in degrees.

    The function uses Rodrigues' formula.
    """
    line, along, aside = _rotation_terms(axis)
    angle = np.radians(degrees)[:, np.newaxis]
    cosine = np.cos(angle)
    from_line = points - line
    there: FloatArray = from_line * cosine
    there += (from_line @ aside) * np.sin(angle)
    there += (from_line @ along) * (1.0 - cosine)
    there += line
    return there


@lru_cache(maxsize=64)
def _rotation_terms(axis: RotaryAxis) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the constant terms of Rodrigues' formula for a rotary axis.

    The terms are a point on the axis, the projection onto the axis direction, and the cross-product matrix.
    """
    x, y, z = axis.direction
    aside = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
    return np.array(axis.point_on_axis), np.outer(axis.direction, axis.direction), aside
