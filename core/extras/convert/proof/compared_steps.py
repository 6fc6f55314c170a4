"""Selection of the steps and blocks that the proof of a conversion compares."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.extras.convert.path_steps import MOVE_KINDS, PathStep, SpindleState, StepKind, has_same_speed
from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.units import get_surface_speed_unit


def drop_repeated_speeds(
    blocks: Sequence[Block], *, resolution: float = 1e-6, is_metric: bool = True
) -> Sequence[Block]:
    """Return the blocks without those that repeat the spindle speed of the block before.

    Speeds are equal if they do not differ after rounding to ``resolution`` in rpm, m/min or ft/min.
    """
    css_resolution = resolution * get_surface_speed_unit(is_metric=is_metric)
    found = []
    speed: object = None
    for block in blocks:
        action = block.action
        if isinstance(action, actions.SpindleRun):
            css = action.surface_speed
            now = round(action.rpm / resolution), False
            if css is not None:
                now = round(css / css_resolution) * (1 if action.rpm > 0 else -1), True
            if now == speed:
                continue
            speed = now
        elif isinstance(action, actions.SpindleStop):
            if speed is None:
                continue
            speed = None
        found.append(block)
    return found


def drop_idle(blocks: Sequence[Block], *, has_home_moves: bool) -> list[Block]:
    """Return the blocks that the comparison includes.

    Tool changes, presets, repeated coolant codes and moves of zero length are excluded. The first move
    after a tool change is never excluded, and with ``has_home_moves``, neither are moves without a tool
    offset.
    """
    found = []
    is_tool_new, tool = False, 0
    coolant: actions.Action | None = None
    for block in blocks:
        action = block.action
        if isinstance(action, actions.ToolChange):
            is_tool_new = is_tool_new or action.tool not in {0, tool}
            tool = action.tool or tool
        if action is not None:
            if not isinstance(action, actions.ToolChange | actions.Preset) and action != coolant:
                found.append(block)
            coolant = action if isinstance(action, actions.CoolantSwitch) else coolant
            continue
        is_home = has_home_moves and (not block.modal.tool or block.modal.edge == 0)
        is_still = block.kind is not BlockKind.ARC and block.x == block.x0 and block.z == block.z0
        if not is_still or is_home or is_tool_new:
            found.append(block)
        is_tool_new = is_tool_new and is_home
    return found


def select_compared_steps(steps: Sequence[PathStep], *, has_partial_moves: bool) -> Iterator[PathStep]:
    """Yield the source steps that must have a matching block in the converted program.

    Nose compensation codes, presets, repeated coolant codes and moves to an unknown end point are omitted.
    With ``has_partial_moves``, a move is not omitted if one of its coordinates is known.
    """
    spindle = SpindleState()
    coolant = 0.0
    for step in steps:
        unknown = (step.x, step.z).count(None)
        if step.kind in MOVE_KINDS and unknown > has_partial_moves:
            continue
        if step.kind in {StepKind.NOSE, StepKind.PRESET}:
            continue
        if step.kind is StepKind.M and step.number in {8, 9}:
            is_repeated, coolant = step.number == coolant, step.number
            if is_repeated:
                continue
        if step.kind is StepKind.SPINDLE:
            same, spindle = has_same_speed(step.spindle, spindle), step.spindle
            if same or (spindle.direction and not spindle.speed and not has_partial_moves):
                continue
        yield step
