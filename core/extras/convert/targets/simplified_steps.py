"""Steps of a source program in the form that the writers for other controls need."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.extras.convert.conversion_messages import make_error, make_note, make_warning
from core.extras.convert.path_steps import MOVE_KINDS, PathStep, StepKind
from core.language.diagnostics import Diagnostic


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
