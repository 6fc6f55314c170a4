"""Angles of the rotary axes for a working plane's frame, and the choice between two solutions.

The machine is right-angled: every rotary axis is parallel to X, Y or Z at 0, and the tilting axis next to
the tool is perpendicular to the tool. Angles are in degrees. The two solutions follow from Rot(a1, t1)
Rot(a2, t2) z = n (the second subproblem of Paden and Kahan). Only atan2 is used, because acos loses half of
the digits if the tool is nearly parallel to a1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

from core.geometry.rotary_axes import FULL_TURN_DEG, Kinematics
from core.geometry.rotation_frames import (
    Z_AXIS,
    Matrix,
    Vector,
    apply_matrix,
    compute_cross_product,
    compute_dot_product,
    compute_z_rotation_deg,
    make_rotation,
    multiply_matrices,
    scale_vector,
    subtract_vectors,
    transpose_matrix,
)

PARALLEL_TOLERANCE_RAD = math.radians(1e-9)  # =
REACHED_TOLERANCE = 1e-9  # sine of the angle below which a tool direction counts as reached
TRAVEL_TOLERANCE_DEG = 1e-6  # degrees by which two travels must differ to count as different


class PrimaryAxisSide(StrEnum):
    """The side on which the primary rotary axis is requested, as programmed with SYM or SEQ.

    The side is relative to the axis's symmetry point (SYM) or basic position (SEQ).
    """

    SYM_PLUS = "SYM+"
    SYM_MINUS = "SYM-"
    SEQ_PLUS = "SEQ+"
    SEQ_MINUS = "SEQ-"


@dataclass(frozen=True, slots=True)
class SwivelSolution:
    """Angles of the rotary axes, by axis name, that make the tool perpendicular to a plane.

    ``tool_rotation_deg`` is the rotation of the plane about the tool axis that the axes do not perform.
    ``symmetry_angle_deg`` is the angle of the primary axis from its symmetry point. ``primary_angle_deg``
    is its angle from the basic position 0.
    """

    axis_angles: Mapping[str, float]
    tool_rotation_deg: float
    symmetry_angle_deg: float = 0.0
    primary_angle_deg: float = 0.0

    def is_on_side(self, side: PrimaryAxisSide | None) -> bool:
        """Return whether the solution is on this side.

        The symmetry point and the basic position themselves are on both sides.
        """
        if side is None:
            return True
        angle = (
            self.symmetry_angle_deg
            if side in {PrimaryAxisSide.SYM_PLUS, PrimaryAxisSide.SYM_MINUS}
            else self.primary_angle_deg
        )
        return (
            angle >= -TRAVEL_TOLERANCE_DEG
            if side in {PrimaryAxisSide.SYM_PLUS, PrimaryAxisSide.SEQ_PLUS}
            else angle <= TRAVEL_TOLERANCE_DEG
        )


def find_all_solutions(
    machine: Kinematics, frame: Matrix, *, rotates_table: bool = False
) -> list[SwivelSolution]:
    """Return all axis angles that make the tool perpendicular to ``frame``, ignoring axis ranges.

    ``frame`` is in the machine-parallel system. If the first axis of the chain is parallel to the tool, its
    angle is free, and the axis moves to its zero. If ``rotates_table`` is True, it moves to the angle at
    which no rotation about the tool remains.
    """
    normal = apply_matrix(frame, Z_AXIS)
    found: list[SwivelSolution] = []
    for angles, symmetry, primary in _iter_tilt_angles(machine, normal):
        spin = _wrap_angle(
            compute_z_rotation_deg(
                multiply_matrices(transpose_matrix(machine.compute_tool_frame(angles)), frame)
            )
        )
        first = machine.rotary_axes[0] if machine.rotary_axes else None
        if (
            rotates_table
            and first is not None
            and math.hypot(*compute_cross_product(first.direction, normal)) < PARALLEL_TOLERANCE_RAD
        ):
            angles[first.name] += math.copysign(1.0, compute_dot_product(first.direction, normal)) * spin
            spin = 0.0
        made = SwivelSolution(angles, spin, symmetry, primary)
        if not any(_same(machine, made, other) for other in found):
            found.append(made)
    return found


def choose_solution(
    machine: Kinematics,
    frame: Matrix,
    present_angles: Mapping[str, float],
    side: PrimaryAxisSide | None = None,
    *,
    rotates_table: bool = False,
) -> SwivelSolution | None:
    """Return the solution with the shortest travel from ``present_angles``, or None if none exists.

    The solution is on ``side`` and within the axis ranges. The travel is the sum over all axes. If two
    travels differ by less than TRAVEL_TOLERANCE_DEG, the solution on the positive side is selected.
    """
    best: SwivelSolution | None = None
    for made in find_reachable_solutions(machine, frame, present_angles, side, rotates_table=rotates_table):
        if (
            best is None
            or _way(machine, made, present_angles)
            < _way(machine, best, present_angles) - TRAVEL_TOLERANCE_DEG
        ):
            best = made
    return best


def find_reachable_solutions(
    machine: Kinematics,
    frame: Matrix,
    present_angles: Mapping[str, float],
    side: PrimaryAxisSide | None = None,
    *,
    rotates_table: bool = False,
) -> list[SwivelSolution]:
    """Return the solutions on ``side`` within the axis ranges, with the positive side first."""
    near = [
        _choose_nearest_turn(machine, made, present_angles)
        for made in find_all_solutions(machine, frame, rotates_table=rotates_table)
    ]
    fits = [made for made in near if made is not None and made.is_on_side(side)]
    return sorted(fits, key=lambda each: -each.symmetry_angle_deg)


def _iter_tilt_angles(machine: Kinematics, normal: Vector) -> Iterator[tuple[dict[str, float], float, float]]:
    """Yield axis angles that orient the tool along ``normal``.

    Each result also contains the angle of the primary axis from its symmetry point and from 0.
    """
    angles = dict(machine.zero_angles)
    tilting = list(machine.rotary_axes)
    while tilting and math.hypot(*compute_cross_product(tilting[-1].direction, Z_AXIS)) < REACHED_TOLERANCE:
        tilting.pop()  # the axis rotates about the tool and does not tilt it
    if not tilting:
        if math.hypot(*compute_cross_product(Z_AXIS, normal)) < REACHED_TOLERANCE and normal[2] > 0.0:
            yield angles, 0.0, 0.0
    elif len(tilting) == 1:
        axis = tilting[0]
        if abs(compute_dot_product(axis.direction, normal)) < REACHED_TOLERANCE:
            angle = _angle_about(axis.direction, Z_AXIS, normal)
            yield angles | {axis.name: angle}, angle, angle
    else:
        first, second = tilting[-2:]
        for tilt, symmetry in _iter_second_angles(first.direction, second.direction, normal):
            tool = apply_matrix(make_rotation(second.direction, tilt), Z_AXIS)
            free = math.hypot(*compute_cross_product(first.direction, normal)) < PARALLEL_TOLERANCE_RAD
            turn = angles[first.name] if free else _angle_about(first.direction, tool, normal)
            yield angles | {first.name: turn, second.name: tilt}, symmetry, tilt


def _iter_second_angles(a1: Vector, a2: Vector, normal: Vector) -> Iterator[tuple[float, float]]:
    """Yield both angles of the axis next to the tool, each with its difference from their mean.

    The larger angle is first. For either direction of the other axis, the mean is calculated from the
    displayed angles between -180 and 180.
    """
    middle = math.degrees(
        math.atan2(
            compute_dot_product(a1, compute_cross_product(a2, Z_AXIS)), compute_dot_product(a1, Z_AXIS)
        )
    )
    away = math.degrees(
        math.atan2(math.hypot(*compute_cross_product(a1, normal)), compute_dot_product(a1, normal))
    )
    low, high = sorted((_wrap_angle(middle + away), _wrap_angle(middle - away)))
    half = (high - low) / 2.0
    yield high, half
    yield low, -half


def _angle_about(axis: Vector, start: Vector, end: Vector) -> float:
    """Return the signed angle in degrees from ``start`` to ``end``, as seen along ``axis``."""
    p, q = (
        subtract_vectors(each, scale_vector(axis, compute_dot_product(axis, each))) for each in (start, end)
    )
    return math.degrees(
        math.atan2(compute_dot_product(axis, compute_cross_product(p, q)), compute_dot_product(p, q))
    )


def _wrap_angle(angle: float) -> float:
    """Return the equivalent angle in the range (-180, 180]."""
    return angle - FULL_TURN_DEG * math.ceil((angle - FULL_TURN_DEG / 2.0) / FULL_TURN_DEG)


def _same(machine: Kinematics, one: SwivelSolution, other: SwivelSolution) -> bool:
    return all(
        abs(_wrap_angle(one.axis_angles[axis.name] - other.axis_angles[axis.name])) < TRAVEL_TOLERANCE_DEG
        for axis in machine.rotary_axes
    )


def _choose_nearest_turn(
    machine: Kinematics, solution: SwivelSolution, present_angles: Mapping[str, float]
) -> SwivelSolution | None:
    """Return the solution with whole revolutions added, so that limited axes travel least.

    The result is None if an axis is out of range.
    """
    angles = {}
    for axis in machine.rotary_axes:
        angle, now = solution.axis_angles[axis.name], present_angles.get(axis.name, 0.0)
        if axis.is_modulo:
            angles[axis.name] = axis.get_displayed_angle(angle)
            continue
        nearest = angle + FULL_TURN_DEG * round((now - angle) / FULL_TURN_DEG)
        turns = [angle, nearest, nearest - FULL_TURN_DEG, nearest + FULL_TURN_DEG]
        inside = [each for each in turns if axis.is_in_range(each)]
        if not inside:
            return None
        angles[axis.name] = min(inside, key=lambda each: abs(each - now))
    return SwivelSolution(
        angles, solution.tool_rotation_deg, solution.symmetry_angle_deg, solution.primary_angle_deg
    )


def _way(machine: Kinematics, made: SwivelSolution, present: Mapping[str, float]) -> float:
    return sum(
        abs(axis.find_travel(present.get(axis.name, 0.0), made.axis_angles[axis.name]))
        for axis in machine.rotary_axes
    )
