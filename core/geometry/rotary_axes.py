"""Rotary axes of a mill as a chain from workpiece to tool, and the machine positions of programmed points.

The same rule applies to heads and tables: a frame as seen from the workpiece is the product of Rot(axis,
+angle) over the chain from the workpiece to the tool. A head at +t rotates the tool by +t. A table at +t
rotates the workpiece by -t in the machine, so the tool, as seen from the workpiece, also rotates by +t. In a
``PivotMove``, the linear axes follow a rotation, so that a point remains fixed on the workpiece (MOVE).
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
    applied,
    minus,
    plus,
    product,
    scaled,
    transposed,
    turned,
)

TURN = 360.0
RANGE_END = 1e-9  # degrees of tolerance at the ends of a range


@dataclass(frozen=True, slots=True)
class Slide:
    """A linear axis, with its travel in mm from home and its maximum speed in mm/s."""

    name: str
    low: float = -math.inf
    high: float = math.inf
    vmax: float = math.inf


@dataclass(frozen=True, slots=True)
class Rotary:
    """A rotary axis. ``direction`` (unit vector) and ``point`` (mm) of its line are given with all axes at 0.

    The point of a table is in machine coordinates. The point of a head is measured from the spindle nose.
    With ``modulo`` the axis turns endlessly and displays 0 to 360 degrees. Otherwise ``low`` and ``high``
    limit it, both inclusive.
    """

    name: str
    table: bool
    direction: Vector
    point: Vector
    low: float = -math.inf
    high: float = math.inf
    modulo: bool = False
    vmax: float = math.inf  # degrees/s

    def inside(self, angle: float) -> bool:
        """Return whether the angle is within the range of the axis."""
        return self.modulo or self.low - RANGE_END <= angle <= self.high + RANGE_END

    def displayed(self, angle: float) -> float:
        """Return the angle as displayed: 0 to 360 degrees on a modulo axis."""
        if not self.modulo:
            return angle + 0.0
        rest = angle % TURN
        return 0.0 if TURN - rest < RANGE_END else rest

    def travel(self, start: float, target: float) -> float:
        """Return the travel in degrees. A modulo axis takes the shorter direction; 180 is positive."""
        way = target - start
        if not self.modulo:
            return way
        short = way % TURN
        return short - TURN if short > TURN / 2.0 + RANGE_END else short


@dataclass(frozen=True, slots=True)
class Place:
    """The transformation machine = turn · q + shift from points of a system to machine positions, in mm.

    It is valid for fixed rotary axes.
    """

    turn: Matrix
    shift: Vector

    def machine(self, q: Vector) -> Vector:
        """Return the machine position of the linear axes for the point ``q``."""
        return plus(applied(self.turn, q), self.shift)

    def point(self, machine: Vector) -> Vector:
        """Return the point with this machine position."""
        return applied(transposed(self.turn), minus(machine, self.shift))


@dataclass(frozen=True, slots=True)
class DatumPreset:
    """A row of the preset table.

    ``origin`` is the machine position of the workpiece zero in mm. ``rotation`` is the basic rotation of the
    workpiece about Z in degrees. ``zeros`` are the machine angles at which the rotary axes read 0, by name.
    ``origin`` and ``rotation`` apply at these angles. An axis that is not listed has the angle 0.
    """

    origin: Vector
    rotation: float = 0.0
    zeros: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class Kinematics:
    """A mill with X, Y, Z and its rotary axes from the workpiece to the tool, tables before heads.

    ``origin`` is the machine position of the workpiece zero with all rotary axes at 0. ``basic_rotation`` is
    the angle of the workpiece system about Z relative to the machine, with the rotary axes at ``zeros``,
    where they read 0. ``order`` lists all axes in the machine's order. Angles are machine angles unless noted
    otherwise.
    """

    slides: tuple[Slide, Slide, Slide]
    rotaries: tuple[Rotary, ...]
    origin: Vector
    basic_rotation: float = 0.0
    order: tuple[str, ...] = field(default=())
    zeros: tuple[tuple[str, float], ...] = ()

    @cached_property
    def basic(self) -> Matrix:
        """The workpiece system in machine coordinates with all rotary axes at 0."""
        turn, _ = self._tables(self.zero)
        return product(transposed(turn), turned(Z_AXIS, self.basic_rotation))

    @cached_property
    def zero(self) -> Mapping[str, float]:
        """The machine angle at which each rotary axis reads 0, by name."""
        return {axis.name: 0.0 for axis in self.rotaries} | dict(self.zeros)

    def with_preset(self, preset: DatumPreset) -> Kinematics:
        """Return the machine with the workpiece of a preset."""
        zeros = tuple(each for each in preset.zeros if self.rotary(each[0]) is not None and each[1])
        moved = replace(self, basic_rotation=preset.rotation, zeros=zeros)
        return replace(moved, origin=moved.at_home(preset.origin))

    def at_home(self, spot: Vector) -> Vector:
        """Return a workpiece point with the tables at 0 that is at ``spot`` with the tables at their zeros.

        Both points are in machine mm.
        """
        turn, shift = self._tables(self.zero)
        return applied(transposed(turn), minus(spot, shift))

    def at_zeros(self, spot: Vector) -> Vector:
        """Return a workpiece point moved with the tables from 0 to their zeros, in machine mm."""
        turn, shift = self._tables(self.zero)
        return plus(applied(turn, spot), shift)

    def shown(self, axis: Rotary, angle: float) -> float:
        """Return the displayed value of a machine angle, relative to the zero of the axis."""
        return axis.displayed(angle - self.zero[axis.name])

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all axes in the machine's order."""
        return self.order or (*(s.name for s in self.slides), *(r.name for r in self.rotaries))

    def rotary(self, name: str) -> Rotary | None:
        """Return the rotary axis with this name, or None if the machine has no such axis."""
        return next((axis for axis in self.rotaries if axis.name == name), None)

    def frame(self, angles: Mapping[str, float]) -> Matrix:
        """Return the tool's frame as seen from the workpiece at the given angles by name (default 0)."""
        return product(*(turned(axis.direction, angles.get(axis.name, 0.0)) for axis in self.rotaries))

    def place(
        self,
        angles: Mapping[str, float],
        frame: Matrix = IDENTITY,
        datum: Vector = (0.0, 0.0, 0.0),
        tool_length: float = 0.0,
    ) -> Place:
        """Return the transformation from points of a system to positions of the linear axes.

        The system has the axes ``frame`` and the origin ``datum`` (mm). Both are given in the
        machine-parallel system at the workpiece zero, without tilt. The transformation is valid for these
        angles and this tool length.
        """
        turn, shift = self._tables(angles)
        spot = applied(turn, plus(self.origin, datum))
        nose = self._nose(angles, tool_length)
        return Place(product(turn, frame), minus(plus(spot, shift), nose))

    def tool_axis(self, angles: Mapping[str, float]) -> Vector:
        """Return the direction from the tip to the spindle, in machine coordinates."""
        return applied(product(*(turned(a.direction, angles.get(a.name, 0.0)) for a in self._heads)), Z_AXIS)

    def tip(self, angles: Mapping[str, float], slides: Vector, tool_length: float = 0.0) -> Vector:
        """Return the machine position of the tip in mm for positions of the linear axes."""
        return plus(slides, self._nose(angles, tool_length))

    @property
    def _heads(self) -> Sequence[Rotary]:
        return [axis for axis in self.rotaries if not axis.table]

    def _tables(self, angles: Mapping[str, float]) -> tuple[Matrix, Vector]:
        """Return rotation and shift that move a point with the tables from 0 to these angles."""
        turn, shift = IDENTITY, (0.0, 0.0, 0.0)
        for axis in self.rotaries:
            if axis.table:
                back = turned(axis.direction, -angles.get(axis.name, 0.0))
                turn = product(back, turn)
                shift = plus(applied(back, minus(shift, axis.point)), axis.point)
        return turn, shift

    def _nose(self, angles: Mapping[str, float], tool_length: float) -> Vector:
        """Return the vector from the spindle nose with the heads at 0 to the tip, in machine mm."""
        tip = scaled(Z_AXIS, -tool_length)
        for axis in reversed(self._heads):
            turn = turned(axis.direction, angles.get(axis.name, 0.0))
            tip = plus(applied(turn, minus(tip, axis.point)), axis.point)
        return tip


FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PivotMove:
    """A move of the rotary axes from the angles ``start`` to ``end`` around a fixed point.

    ``pivot`` is the fixed point in mm, in the machine-parallel system at the workpiece zero. It is
    ``distance`` mm below the tip along the tool. ``length`` is in degrees. With ``pivot_end``, the point
    moves there in a straight line, and ``length`` is in mm.
    """

    kinematics: Kinematics
    start: Mapping[str, float]
    end: Mapping[str, float]
    pivot: Vector
    distance: float
    tool_length: float
    length: float
    pivot_end: Vector | None = None

    @property
    def in_degrees(self) -> bool:
        """True if the feed is in degrees because the pivot is fixed."""
        return self.pivot_end is None

    @property
    def straight(self) -> bool:
        """Always False, because linear axes and angles are not proportional."""
        return False

    def machine(self, share: FloatArray) -> FloatArray:
        """Return machine positions (k, axes), in the machine's order, at fractions (k,) of the move."""
        at: dict[str, FloatArray] = {
            name: start + share * (self.end[name] - start) for name, start in self.start.items()
        }
        first, last = np.array(self.pivot), np.array(self.pivot_end or self.pivot)
        spots = np.array(self.kinematics.origin) + first + share[:, np.newaxis] * (last - first)
        slides = _carried_by_tables(self.kinematics, at, spots)
        slides = slides - _noses(self.kinematics, at, self.tool_length + self.distance)
        at |= {"X": slides[:, 0], "Y": slides[:, 1], "Z": slides[:, 2]}
        rows: FloatArray = np.stack([at[name] for name in self.kinematics.names], axis=1)
        return rows

    def goals(self) -> dict[str, float]:
        """Return the machine positions of all axes at the end, by name."""
        there = dict(zip(self.kinematics.names, self.machine(np.ones(1))[0].tolist(), strict=True))
        return {**there, **self.end}

    def part(self, points: FloatArray) -> FloatArray:
        """Return the tip on the workpiece (k, 3) in mm at machine positions (k, axes)."""
        at = dict(zip(self.kinematics.names, points.T, strict=True))
        spots: FloatArray = np.stack([at[name] for name in "XYZ"], axis=1)
        spots = spots + _noses(self.kinematics, at, self.tool_length)
        for axis in reversed(self.kinematics.rotaries):
            if axis.table:
                spots = _carried(axis, at[axis.name], spots)
        spots -= np.array(self.kinematics.origin)
        return spots

    def nearest(self) -> float:
        """Return 0.5, because no fraction of the move is more critical than another."""
        return 0.5


def _carried_by_tables(machine: Kinematics, at: Mapping[str, FloatArray], spots: FloatArray) -> FloatArray:
    """Return points (k, 3) in mm moved by the tables from 0 to these angles (k,)."""
    for axis in machine.rotaries:
        if axis.table:
            spots = _carried(axis, -at[axis.name], spots)
    return spots


def _noses(machine: Kinematics, at: Mapping[str, FloatArray], tool_length: float) -> FloatArray:
    """Return vectors from the spindle nose at 0 to the tip with the heads at these angles (k,), in mm.

    The result has the shape (k, 3), or one row without heads.
    """
    tips: FloatArray = np.array([[0.0, 0.0, -tool_length]])
    for axis in reversed(machine.rotaries):
        if not axis.table:
            tips = _carried(axis, at[axis.name], tips)
    return tips


def _carried(axis: Rotary, degrees: FloatArray, points: FloatArray) -> FloatArray:
    """Return points (k, 3), or one point, rotated about the axis by the angles (k,) (Rodrigues' formula)."""
    line, along, aside = _turning(axis)
    angle = np.radians(degrees)[:, np.newaxis]
    cosine = np.cos(angle)
    from_line = points - line
    there: FloatArray = from_line * cosine
    there += (from_line @ aside) * np.sin(angle)
    there += (from_line @ along) * (1.0 - cosine)
    there += line
    return there


@lru_cache(maxsize=64)
def _turning(axis: Rotary) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return a point of the axis, the projection onto its direction, and the cross-product matrix."""
    x, y, z = axis.direction
    aside = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
    return np.array(axis.point), np.outer(axis.direction, axis.direction), aside
