"""Rotary axes of a mill in their chain from the workpiece to the tool, and where programmed points then lie.

One rule holds for heads and tables: a frame seen from the workpiece is the product of Rot(axis, +angle) over
the chain from the workpiece to the tool. A head at +t turns the tool by +t; a table at +t turns the workpiece
by -t in the machine, so that the tool, seen from the workpiece, turns by +t as well. With ``PivotMove`` the
slides follow a turn, so that a point keeps its place on the workpiece (MOVE).
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
RANGE_END = 1e-9  # degrees by which rounding may leave a range whose ends count as inside


@dataclass(frozen=True, slots=True)
class Slide:
    """A linear axis: travel in mm from home, greatest speed in mm/s."""

    name: str
    low: float = -math.inf
    high: float = math.inf
    vmax: float = math.inf


@dataclass(frozen=True, slots=True)
class Rotary:
    """A rotary axis. ``direction`` (unit vector) and ``point`` (mm) of its line hold with all axes at 0.

    A table's point counts in the machine, a head's from the nose of the spindle, where the tool begins.
    ``modulo``: turns without end and shows 0 to 360; ``low high`` otherwise bound it, ends inside.
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
        """Whether the axis can stand there."""
        return self.modulo or self.low - RANGE_END <= angle <= self.high + RANGE_END

    def displayed(self, angle: float) -> float:
        """The angle as displayed: 0 to 360 on a modulo axis."""
        if not self.modulo:
            return angle + 0.0
        rest = angle % TURN
        return 0.0 if TURN - rest < RANGE_END else rest

    def travel(self, start: float, target: float) -> float:
        """Degrees to travel; a modulo axis goes the short way, exactly half a turn goes positive."""
        way = target - start
        if not self.modulo:
            return way
        short = way % TURN
        return short - TURN if short > TURN / 2.0 + RANGE_END else short


@dataclass(frozen=True, slots=True)
class Place:
    """machine = turn · q + shift: machine positions of the points of a system, mm; the rotary axes stand."""

    turn: Matrix
    shift: Vector

    def machine(self, q: Vector) -> Vector:
        """Machine position of the slides for the point ``q``."""
        return plus(applied(self.turn, q), self.shift)

    def point(self, machine: Vector) -> Vector:
        """The point whose machine position this is."""
        return applied(transposed(self.turn), minus(machine, self.shift))


@dataclass(frozen=True, slots=True)
class DatumPreset:
    """A row of the preset table: ``origin`` is the machine position of the workpiece's zero, mm, ``rotation``
    the angle by which the workpiece lies turned about Z (basic rotation), degrees. Rotary axes read 0 at
    ``zeros`` (by name, degrees in the machine), where ``origin`` and ``rotation`` hold; absent ones at 0."""

    origin: Vector
    rotation: float = 0.0
    zeros: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class Kinematics:
    """A mill: slides X Y Z and rotary axes from the workpiece to the tool, tables before heads.

    ``origin`` is the machine position of the workpiece's zero with all rotary axes at 0; ``basic_rotation``
    the angle by which the workpiece system is turned about Z against the machine, with the rotary axes at
    ``zeros``, where they read 0. ``order`` names all axes in the machine's own order. Angles are the
    machine's where nothing else is said.
    """

    slides: tuple[Slide, Slide, Slide]
    rotaries: tuple[Rotary, ...]
    origin: Vector
    basic_rotation: float = 0.0
    order: tuple[str, ...] = field(default=())
    zeros: tuple[tuple[str, float], ...] = ()

    @cached_property
    def basic(self) -> Matrix:
        """The workpiece system as it stands in the machine with all rotary axes at 0."""
        turn, _ = self._tables(self.zero)
        return product(transposed(turn), turned(Z_AXIS, self.basic_rotation))

    @cached_property
    def zero(self) -> Mapping[str, float]:
        """Where each rotary axis reads 0, by name."""
        return {axis.name: 0.0 for axis in self.rotaries} | dict(self.zeros)

    def with_preset(self, preset: DatumPreset) -> Kinematics:
        """The same machine with the workpiece there."""
        zeros = tuple(each for each in preset.zeros if self.rotary(each[0]) is not None and each[1])
        moved = replace(self, basic_rotation=preset.rotation, zeros=zeros)
        return replace(moved, origin=moved.at_home(preset.origin))

    def at_home(self, spot: Vector) -> Vector:
        """Where a point of the workpiece lies with the tables at 0 that lies at ``spot`` with them at their
        zeros; mm in the machine."""
        turn, shift = self._tables(self.zero)
        return applied(transposed(turn), minus(spot, shift))

    def at_zeros(self, spot: Vector) -> Vector:
        """The other way: from the tables at 0 to their zeros."""
        turn, shift = self._tables(self.zero)
        return plus(applied(turn, spot), shift)

    def shown(self, axis: Rotary, angle: float) -> float:
        """An angle of the machine as words and displays have it: from the axis' zero, modulo 0 to 360."""
        return axis.displayed(angle - self.zero[axis.name])

    @property
    def names(self) -> tuple[str, ...]:
        """All axes in the machine's order."""
        return self.order or (*(s.name for s in self.slides), *(r.name for r in self.rotaries))

    def rotary(self, name: str) -> Rotary | None:
        """The rotary axis of this name, None where the machine lacks it."""
        return next((axis for axis in self.rotaries if axis.name == name), None)

    def frame(self, angles: Mapping[str, float]) -> Matrix:
        """The tool's frame as the workpiece sees it, at these angles by name; absent ones are 0."""
        return product(*(turned(axis.direction, angles.get(axis.name, 0.0)) for axis in self.rotaries))

    def place(
        self,
        angles: Mapping[str, float],
        frame: Matrix = IDENTITY,
        datum: Vector = (0.0, 0.0, 0.0),
        tool_length: float = 0.0,
    ) -> Place:
        """Where points of the system ``frame`` at ``datum`` (mm, both in the untilted machine-parallel system
        at the workpiece's zero) bring the slides at these angles with a tool of this length.
        """
        turn, shift = self._tables(angles)
        spot = applied(turn, plus(self.origin, datum))
        nose = self._nose(angles, tool_length)
        return Place(product(turn, frame), minus(plus(spot, shift), nose))

    def tool_axis(self, angles: Mapping[str, float]) -> Vector:
        """The direction from the tip to the spindle, in the machine."""
        return applied(product(*(turned(a.direction, angles.get(a.name, 0.0)) for a in self._heads)), Z_AXIS)

    def tip(self, angles: Mapping[str, float], slides: Vector, tool_length: float = 0.0) -> Vector:
        """Where the tip is in the machine, mm, with the slides there and a tool of this length."""
        return plus(slides, self._nose(angles, tool_length))

    @property
    def _heads(self) -> Sequence[Rotary]:
        return [axis for axis in self.rotaries if not axis.table]

    def _tables(self, angles: Mapping[str, float]) -> tuple[Matrix, Vector]:
        """Rotation and shift that take a point of the machine-parallel system at 0 along with the tables."""
        turn, shift = IDENTITY, (0.0, 0.0, 0.0)
        for axis in self.rotaries:
            if axis.table:
                back = turned(axis.direction, -angles.get(axis.name, 0.0))
                turn = product(back, turn)
                shift = plus(applied(back, minus(shift, axis.point)), axis.point)
        return turn, shift

    def _nose(self, angles: Mapping[str, float], tool_length: float) -> Vector:
        """From the spindle nose at 0, which machine positions count, to the tip; mm in the machine."""
        tip = scaled(Z_AXIS, -tool_length)
        for axis in reversed(self._heads):
            turn = turned(axis.direction, angles.get(axis.name, 0.0))
            tip = plus(applied(turn, minus(tip, axis.point)), axis.point)
        return tip


FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PivotMove:
    """From the angles ``start`` to ``end`` in proportion; ``pivot`` stays (mm, machine-parallel system at the
    workpiece's zero), ``distance`` mm below the tip along the tool, and ``length`` is in degrees. With
    ``pivot_end`` it goes straight there, and ``length`` is in mm.
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
        """Whether the feed counts degrees: the pivot stands."""
        return self.pivot_end is None

    @property
    def straight(self) -> bool:
        """The slides never run in proportion to the angles."""
        return False

    def machine(self, share: FloatArray) -> FloatArray:
        """Machine positions (k, axes), in the machine's order, at fractions (k,) of the way."""
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
        """Machine positions of all axes at the end, by name."""
        there = dict(zip(self.kinematics.names, self.machine(np.ones(1))[0].tolist(), strict=True))
        return {**there, **self.end}

    def part(self, points: FloatArray) -> FloatArray:
        """Where the tip is on the workpiece (k, 3), mm, at machine positions (k, axes)."""
        at = dict(zip(self.kinematics.names, points.T, strict=True))
        spots: FloatArray = np.stack([at[name] for name in "XYZ"], axis=1)
        spots = spots + _noses(self.kinematics, at, self.tool_length)
        for axis in reversed(self.kinematics.rotaries):
            if axis.table:
                spots = _carried(axis, at[axis.name], spots)
        spots -= np.array(self.kinematics.origin)
        return spots

    def nearest(self) -> float:
        """The middle: no fraction is harder than another."""
        return 0.5


def _carried_by_tables(machine: Kinematics, at: Mapping[str, FloatArray], spots: FloatArray) -> FloatArray:
    """Where the tables at these angles (k,) bring machine-parallel points (k, 3) at 0: (k, 3), mm."""
    for axis in machine.rotaries:
        if axis.table:
            spots = _carried(axis, -at[axis.name], spots)
    return spots


def _noses(machine: Kinematics, at: Mapping[str, FloatArray], tool_length: float) -> FloatArray:
    """From the spindle nose at 0 to the tip with the heads at these angles (k,): (k, 3) or one row, mm."""
    tips: FloatArray = np.array([[0.0, 0.0, -tool_length]])
    for axis in reversed(machine.rotaries):
        if not axis.table:
            tips = _carried(axis, at[axis.name], tips)
    return tips


def _carried(axis: Rotary, degrees: FloatArray, points: FloatArray) -> FloatArray:
    """Points (k, 3), or one for all, turned about the axis' line by the angles (k,) (Rodrigues' formula)."""
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
    """A point of the axis' line, and what takes rows of points onto its direction and square to both."""
    x, y, z = axis.direction
    aside = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
    return np.array(axis.point), np.outer(axis.direction, axis.direction), aside
