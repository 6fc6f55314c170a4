"""Angles of the rotary axes for the frame of a working plane, and the choice between two solutions.

The machine is right-angled: every rotary axis is parallel to X, Y or Z at 0, and the axis next to the tool
that tilts it is square to the tool. Angles are in degrees. The two solutions follow from Rot(a1, t1) Rot(a2,
t2) z = n (the second subproblem of Paden and Kahan). Only atan2 is used, because acos loses half of the
digits if the tool is nearly parallel to a1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

from core.geometry.rotary_axes import TURN, Kinematics
from core.geometry.rotation_frames import (
    Z_AXIS,
    Matrix,
    Vector,
    about_z,
    applied,
    cross,
    dot,
    minus,
    product,
    scaled,
    transposed,
    turned,
)

FREE = math.radians(1e-9)  # =
UNREACHED = 1e-9  # sine of the angle below which a tool direction counts as reached
TIE = 1e-6  # degrees by which two travels must differ to count as different


class SolutionSide(StrEnum):
    """The requested side of the symmetry point (SYM) or basic position (SEQ) of the primary axis."""

    SYM_PLUS = "SYM+"
    SYM_MINUS = "SYM-"
    SEQ_PLUS = "SEQ+"
    SEQ_MINUS = "SEQ-"


@dataclass(frozen=True, slots=True)
class Solution:
    """Angles by axis name. ``spin`` is the remaining mathematical rotation about the tool axis.

    ``symmetry`` is the angle of the primary axis from its symmetry point, and ``primary`` from its basic
    position 0.
    """

    angles: Mapping[str, float]
    spin: float
    symmetry: float = 0.0
    primary: float = 0.0

    def on(self, side: SolutionSide | None) -> bool:
        """Return whether the solution is on this side. The point itself is on both sides."""
        if side is None:
            return True
        angle = self.symmetry if side in {SolutionSide.SYM_PLUS, SolutionSide.SYM_MINUS} else self.primary
        return angle >= -TIE if side in {SolutionSide.SYM_PLUS, SolutionSide.SEQ_PLUS} else angle <= TIE


def solutions(machine: Kinematics, frame: Matrix, *, table_rot: bool = False) -> list[Solution]:
    """Return all solutions square to ``frame`` (in the machine-parallel system), without axis ranges.

    If the first axis of the chain is parallel to the tool, it is free and goes to its zero. With
    ``table_rot`` it goes to the angle that leaves no rotation about the tool.
    """
    normal = applied(frame, Z_AXIS)
    found: list[Solution] = []
    for angles, symmetry, primary in _tilts(machine, normal):
        spin = _wrapped(about_z(product(transposed(machine.frame(angles)), frame)))
        first = machine.rotaries[0] if machine.rotaries else None
        if table_rot and first is not None and math.hypot(*cross(first.direction, normal)) < FREE:
            angles[first.name] += math.copysign(1.0, dot(first.direction, normal)) * spin
            spin = 0.0
        made = Solution(angles, spin, symmetry, primary)
        if not any(_same(machine, made, other) for other in found):
            found.append(made)
    return found


def choose(
    machine: Kinematics,
    frame: Matrix,
    present: Mapping[str, float],
    side: SolutionSide | None = None,
    *,
    table_rot: bool = False,
) -> Solution | None:
    """Return the solution on ``side`` within the axis ranges that has the shortest travel from ``present``.

    The travel is the sum over all axes. If two travels differ by less than TIE, the positive side is
    selected. Returns None if no solution is possible.
    """
    best: Solution | None = None
    for made in fitting(machine, frame, present, side, table_rot=table_rot):
        if best is None or _way(machine, made, present) < _way(machine, best, present) - TIE:
            best = made
    return best


def fitting(
    machine: Kinematics,
    frame: Matrix,
    present: Mapping[str, float],
    side: SolutionSide | None = None,
    *,
    table_rot: bool = False,
) -> list[Solution]:
    """Return the solutions on ``side`` within the axis ranges, the positive side first."""
    near = [_nearest(machine, made, present) for made in solutions(machine, frame, table_rot=table_rot)]
    fits = [made for made in near if made is not None and made.on(side)]
    return sorted(fits, key=lambda each: -each.symmetry)


def _tilts(machine: Kinematics, normal: Vector) -> Iterator[tuple[dict[str, float], float, float]]:
    """Yield angles that bring the tool to ``normal``, with the primary angle from symmetry and from 0."""
    angles = dict(machine.zero)
    tilting = list(machine.rotaries)
    while tilting and math.hypot(*cross(tilting[-1].direction, Z_AXIS)) < UNREACHED:
        tilting.pop()  # the axis rotates about the tool and does not tilt it
    if not tilting:
        if math.hypot(*cross(Z_AXIS, normal)) < UNREACHED and normal[2] > 0.0:
            yield angles, 0.0, 0.0
    elif len(tilting) == 1:
        axis = tilting[0]
        if abs(dot(axis.direction, normal)) < UNREACHED:
            angle = _angle(axis.direction, Z_AXIS, normal)
            yield angles | {axis.name: angle}, angle, angle
    else:
        first, second = tilting[-2:]
        for tilt, symmetry in _second(first.direction, second.direction, normal):
            tool = applied(turned(second.direction, tilt), Z_AXIS)
            free = math.hypot(*cross(first.direction, normal)) < FREE
            turn = angles[first.name] if free else _angle(first.direction, tool, normal)
            yield angles | {first.name: turn, second.name: tilt}, symmetry, tilt


def _second(a1: Vector, a2: Vector, normal: Vector) -> Iterator[tuple[float, float]]:
    """Yield both angles of the axis next to the tool, the greater first, with the offset from their mean.

    The mean uses the displayed angles from -180 to 180, for either direction of the other axis.
    """
    middle = math.degrees(math.atan2(dot(a1, cross(a2, Z_AXIS)), dot(a1, Z_AXIS)))
    away = math.degrees(math.atan2(math.hypot(*cross(a1, normal)), dot(a1, normal)))
    low, high = sorted((_wrapped(middle + away), _wrapped(middle - away)))
    half = (high - low) / 2.0
    yield high, half
    yield low, -half


def _angle(axis: Vector, start: Vector, end: Vector) -> float:
    """Return the angle in degrees about ``axis`` from one direction to another, seen along the axis."""
    p, q = (minus(each, scaled(axis, dot(axis, each))) for each in (start, end))
    return math.degrees(math.atan2(dot(axis, cross(p, q)), dot(p, q)))


def _wrapped(angle: float) -> float:
    """Return the angle in the range (-180, 180]."""
    return angle - TURN * math.ceil((angle - TURN / 2.0) / TURN)


def _same(machine: Kinematics, one: Solution, other: Solution) -> bool:
    return all(
        abs(_wrapped(one.angles[axis.name] - other.angles[axis.name])) < TIE for axis in machine.rotaries
    )


def _nearest(machine: Kinematics, made: Solution, present: Mapping[str, float]) -> Solution | None:
    """Return the solution with each limited axis at the turn closest to its present angle.

    Returns None if an axis is out of range.
    """
    angles = {}
    for axis in machine.rotaries:
        angle, now = made.angles[axis.name], present.get(axis.name, 0.0)
        if axis.modulo:
            angles[axis.name] = axis.displayed(angle)
            continue
        nearest = angle + TURN * round((now - angle) / TURN)
        turns = [angle, nearest, nearest - TURN, nearest + TURN]
        inside = [each for each in turns if axis.inside(each)]
        if not inside:
            return None
        angles[axis.name] = min(inside, key=lambda each: abs(each - now))
    return Solution(angles, made.spin, made.symmetry, made.primary)


def _way(machine: Kinematics, made: Solution, present: Mapping[str, float]) -> float:
    return sum(
        abs(axis.travel(present.get(axis.name, 0.0), made.angles[axis.name])) for axis in machine.rotaries
    )
