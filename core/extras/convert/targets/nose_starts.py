"""Starts of nose compensation at which LinuxCNC and OmniTurn position the nose differently."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from core.extras.convert.path_steps import MOVE_KINDS, PathStep, StepKind

_MIN_TURN = 1e-3  # sine of the angle between the approach and the first move of the contour


def find_incomplete_starts(steps: Sequence[PathStep]) -> list[int]:
    """Return the lines of the approach moves after which LinuxCNC does not cut the start of the contour.

    OmniTurn approaches square to the first move of the contour. The nose of LinuxCNC also touches the line
    of the approach. If the contour turns toward the nose, a fillet with the radius of the nose remains.
    """
    found = []
    code = 40.0
    start: tuple[float, float] | None = None
    approach: tuple[PathStep, tuple[float, float]] | None = None
    is_new = False
    for step in steps:
        if step.kind is StepKind.NOSE:
            code, is_new, approach = step.number, True, None
        elif step.kind is StepKind.TOOL:
            start = approach = None
        if step.kind not in MOVE_KINDS or step.x is None or step.z is None:
            continue
        direction = None if start is None else _get_start_direction(step, start)
        if approach is not None and direction is not None:
            if _turns_to_nose(approach[1], direction, is_left=code == 41):
                found.append(approach[0].line)
            approach = None
        if is_new and code != 40 and direction is not None:
            approach, is_new = (step, direction), False
        start = step.x, step.z
    return found


def _get_start_direction(step: PathStep, start: tuple[float, float]) -> tuple[float, float] | None:
    """Return the direction in X and Z at the start of a move as a unit vector, or None without travel."""
    assert step.x is not None
    assert step.z is not None
    dx, dz = step.x - start[0], step.z - start[1]
    if step.kind is StepKind.ARC:
        radius_x, radius_z = start[0] - step.cx, start[1] - step.cz
        dx, dz = (radius_z, -radius_x) if step.clockwise else (-radius_z, radius_x)
    length = hypot(dx, dz)
    return (dx / length, dz / length) if length else None


def _turns_to_nose(before: tuple[float, float], after: tuple[float, float], *, is_left: bool) -> bool:
    """Return whether a contour turns toward the side of the nose, seen with X+ toward the operator."""
    to_left = after[0] * -before[1] + after[1] * before[0]
    return (to_left if is_left else -to_left) > _MIN_TURN
