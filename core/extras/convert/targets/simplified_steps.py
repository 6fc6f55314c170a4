"""Steps of a source program in the form that the writers for other controls need."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from core.extras.convert.conversion_messages import make_error, make_note, make_warning
from core.extras.convert.path_steps import MOVE_KINDS, PathStep, StepKind
from core.geometry.lines_and_arcs import Point, compute_arc_length
from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.diagnostics import Diagnostic

RoundPoint = Callable[[float, float], tuple[float, float]]
"""Function that returns the written coordinates of X as a radius and Z in mm."""
_SHORT_MM = 0.01  # longest arc whose ends may become equal by rounding; a longer arc is almost a circle


def simplify_steps(steps: Sequence[PathStep], max_rpm: float) -> tuple[list[PathStep], list[Diagnostic]]:
    """Return the steps without presets and without moves to the present position, and findings.

    A note reports each preset, because the coordinates of the moves contain it. M02 becomes M30, which has
    the same effect on a SINUMERIK control. A constant surface speed without a maximum gets ``max_rpm``, with
    a warning. Raises ProgramError for a preset at an unknown position, and for a tool change while a preset
    is active.
    """
    made: list[PathStep] = []
    notes: list[Diagnostic] = []
    shift = (0.0, 0.0)
    position: tuple[float | None, float | None] = (None, None)
    for step in steps:
        if step.kind is StepKind.PRESET:
            notes.append(make_note(step.line, 0, "shift-contained"))
            shift = _add_preset(step, position, shift)
            position = step.x, step.z
            continue
        if step.kind is StepKind.TOOL and shift != (0.0, 0.0):
            raise make_error(step.line, 0, "preset-target")
        if step.kind in MOVE_KINDS:
            if (step.x is None or step.z is None) and (step.x, step.z) == position:
                continue
            position = step.x, step.z
        elif step.kind is StepKind.TOOL:
            position = None, None
        elif step.kind is StepKind.HOME:
            position = _leave_axes(step, position)
        made.append(_simplify_step(step, shift))
        if step.spindle.is_css and step.spindle.direction and not step.spindle.max_rpm:
            made[-1] = replace(made[-1], spindle=replace(step.spindle, max_rpm=max_rpm))
            if not any(each.code == "maximum-speed-added" for each in notes):
                notes.append(make_warning(step.line, 0, "maximum-speed-added", rpm=f"{max_rpm:g}"))
    return made, notes


def _add_preset(
    step: PathStep, position: tuple[float | None, float | None], shift: tuple[float, float]
) -> tuple[float, float]:
    """Return the shift after a preset. Raises ProgramError if the preset axis has no known position."""
    changed = []
    for old, new, value in zip(position, (step.x, step.z), shift, strict=True):
        if new is None:
            changed.append(value)
        elif old is None:
            raise make_error(step.line, 0, "preset-target")
        else:
            changed.append(value + old - new)
    return changed[0], changed[1]


def _leave_axes(
    step: PathStep, position: tuple[float | None, float | None]
) -> tuple[float | None, float | None]:
    """Return the position after a move to machine home, at which the coordinates are unknown."""
    x, z = position
    return (x if step.x is None else None), (z if step.z is None else None)


def _simplify_step(step: PathStep, shift: tuple[float, float]) -> PathStep:
    if step.kind is StepKind.END:
        return replace(step, number=30)
    if step.kind not in MOVE_KINDS:
        return step
    x = None if step.x is None else step.x + shift[0]
    z = None if step.z is None else step.z + shift[1]
    return replace(step, x=x, z=z, cx=step.cx + shift[0], cz=step.cz + shift[1])


def drop_short_steps(steps: Sequence[PathStep], round_point: RoundPoint) -> list[PathStep]:
    """Return the steps without moves whose ends become equal by rounding, except under nose compensation.

    The first move of a tool is never dropped, because its start is unknown.
    """
    made = []
    start: tuple[float, float] | None = None
    nose_code = 40.0
    for step in steps:
        if step.kind is StepKind.NOSE:
            nose_code = step.number
        elif step.kind in {StepKind.TOOL, StepKind.HOME}:
            start = None
        elif step.kind in MOVE_KINDS:
            end = None if step.x is None or step.z is None else (step.x, step.z)
            ends, start = (start, end), end
            center = (step.cx, step.cz) if step.kind is StepKind.ARC else None
            if nose_code == 40 and _is_short(ends, center, round_point, is_clockwise=step.clockwise):
                continue
        made.append(step)
    return made


def drop_short_blocks(blocks: Sequence[Block], round_point: RoundPoint) -> list[Block]:
    """Return the blocks without the moves that ``drop_short_steps`` drops."""
    made = []
    is_known, tool = False, 0
    for block in blocks:
        if isinstance(block.action, actions.ToolChange):
            is_known = is_known and block.action.tool in {0, tool}
            tool = block.action.tool or tool
        elif block.moves:
            start = (block.x0, block.z0) if is_known else None
            is_known = bool(block.modal.tool)
            center = (block.cx, block.cz) if block.kind is BlockKind.ARC else None
            is_free = block.modal.compensation_code == 40 and is_known
            ends = start, (block.x, block.z)
            if is_free and _is_short(ends, center, round_point, is_clockwise=block.clockwise):
                continue
        made.append(block)
    return made


def _is_short(
    ends: tuple[Point | None, Point | None],
    center: Point | None,
    round_point: RoundPoint,
    *,
    is_clockwise: bool,
) -> bool:
    """Return whether the ends of a move become equal by rounding, and the move is not a large arc."""
    start, end = ends
    if start is None or end is None or round_point(*start) != round_point(*end):
        return False
    return center is None or compute_arc_length(start, end, center, is_clockwise=is_clockwise) < _SHORT_MM
