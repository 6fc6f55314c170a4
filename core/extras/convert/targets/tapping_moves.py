"""Detection of tapping with a reversal of the spindle between two feed moves."""

from __future__ import annotations

from collections.abc import Sequence

from core.extras.convert.path_steps import MOVE_KINDS, PathStep, StepKind

_SAME = 1e-6  # mm


def find_tapping(steps: Sequence[PathStep]) -> int:
    """Return the line of the first spindle reversal between a feed move in Z and the feed move back, or 0.

    A floating tap holder compensates the revolutions until the spindle of this lathe has reversed. The
    spindle of another lathe may need more of them.
    """
    direction = 0
    reversal = 0  # line
    x = z = travel = 0.0
    for step in steps:
        if step.kind is StepKind.SPINDLE and step.spindle.direction:
            is_reversal = step.spindle.direction == -direction and travel
            reversal, direction = step.line if is_reversal else reversal, step.spindle.direction
        elif step.kind in MOVE_KINDS:
            before = travel
            is_along_z = step.x is not None and abs(step.x - x) < _SAME and step.z is not None
            is_feed = step.kind is StepKind.FEED and step.per_rev
            travel = (step.z or 0.0) - z if is_along_z and is_feed else 0.0
            if reversal and before * travel < 0:
                return reversal
            reversal = 0
            x, z = step.x or 0.0, step.z or 0.0
        elif step.kind in {StepKind.TOOL, StepKind.HOME}:
            reversal, travel = 0, 0.0
    return 0
