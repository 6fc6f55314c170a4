"""Execution of TOOL DEF and TOOL CALL: tool dimensions, tool change, tool axis, speed and feed."""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.interpreter.klartext.flow import word_values
from core.interpreter.klartext.klartext_state import State, ToolDeltas
from core.interpreter.klartext.motion.feed_rates import MAX_FEED, REVOLUTION
from core.interpreter.shared.actions import ProgramStop, SpindleRun, SpindleStop, ToolChange
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import ToolUsage
from core.language.klartext.klartext_faults import (
    NOT_ALLOWED_WITH_M128,
    TOOL_UNKNOWN,
    WRONG_RPM,
    make_unsupported_error,
)
from core.language.klartext.klartext_nodes import ToolCall, ToolDefinition
from core.language.klartext.klartext_words import Value
from core.language.klartext.structure_blocks import MAX_TOOL_NUMBER
from core.message import Message
from core.tool_edges import FIRST_NAMED_TOOL, NamedToolNumber


def execute_tool_call(state: State, node: ToolCall, usage: ToolUsage) -> Iterator[Block]:
    """Yield the blocks of TOOL CALL.

    The axes do not move, but the tip position changes with the new tool length. If ProgramError is raised,
    the state has not changed.
    """
    words = {"DL": node.delta_length, "DR": node.delta_radius, "DR2": node.corner_radius}
    has_deltas = any(word is not None for word in words.values())
    if state.is_tcpm_active and (node.tool is not None or has_deltas):
        text = "TOOL CALL with a tool or an oversize is not allowed while M128 is active."
        raise state.make_error(1, NOT_ALLOWED_WITH_M128, text, "Switch M128 off with M129 before this block.")
    if node.tool_axis not in {"", "Z"}:
        raise make_unsupported_error(
            state.line_number, node.column, Message("The tool axis {tool_axis}", tool_axis=node.tool_axis)
        )
    number = _number(state, node.tool, node.column)
    rpm = _speed(state, node, number)
    feed = _feed(state, node)
    deltas_mm = ToolDeltas(*(_oversize(state, word, name) for name, word in words.items()))
    state.tool_axis = node.tool_axis or state.tool_axis
    if feed is not None:
        state.feed = state.tool_feed = feed
        per = node.feed_unit_letter or (REVOLUTION if state.is_feed_per_revolution else "")
        state.feed_base = state.tool_feed_base = per
    elif node.tool is not None:
        state.tool_feed = None
    if number is not None:
        yield from _change(state, number, deltas_mm, usage, node.column)
    elif has_deltas:
        _measure(state, state.modal.tool, deltas_mm, usage, node.column)
    if rpm is not None:
        state.modal = state.modal._replace(rpm=rpm)
        if state.modal.spindle:
            yield state.make_action_block(SpindleRun(rpm * state.modal.spindle))


def define_tool(state: State, node: ToolDefinition) -> None:
    """Execute TOOL DEF. Its length and radius have priority over the tool table.

    Raises ProgramError for an invalid length or radius.
    """
    if node.length is None and node.radius is None:
        return  # the block only prepares the tool
    length = _oversize(state, node.length, "L", word_values.MAX_COORDINATE)
    state.tool_definitions[node.tool] = length, _oversize(state, node.radius, "R", word_values.MAX_COORDINATE)


def _number(state: State, tool: int | str | Value | None, column: int) -> int | None:
    """Return the number of the called tool.

    A tool name must be defined in the program or in the tool table.
    """
    if isinstance(tool, Value):
        return word_values.whole_number(state, tool, "TOOL CALL", MAX_TOOL_NUMBER)
    if not isinstance(tool, str):
        return tool
    names = [each for each in state.tool_definitions if isinstance(each, str)]
    if tool in names:
        return NamedToolNumber(FIRST_NAMED_TOOL + names.index(tool), tool)
    if (found := state.setup.tool_names.get(tool.upper())) is not None:
        return found
    hint = "Give this name to a tool in the tool table, or call the tool by its number."
    raise state.make_error(column, TOOL_UNKNOWN, 'No tool is named "{tool}".', hint, tool=tool)


def _oversize(state: State, value: Value | None, what: str, most: float = 99.999) -> float:
    return 0.0 if value is None else word_values.number(state, value, what, most) * state.mm_per_unit


def _change(state: State, tool: int, deltas_mm: ToolDeltas, usage: ToolUsage, column: int) -> Iterator[Block]:
    """Yield the blocks of a tool change: spindle stop, new tool, and a program stop if manual."""
    before = state.modal.tool
    if state.modal.spindle:
        state.modal = state.modal._replace(spindle=0, oriented=None)
        yield state.make_action_block(SpindleStop())
    state.modal = state.modal._replace(tool=tool)
    _measure(state, tool, deltas_mm, usage, column)
    yield state.make_action_block(ToolChange(tool))
    if tool and before not in {0, tool}:
        yield state.make_action_block(
            ProgramStop(optional=False, message=Message("TOOL {tool}", tool=format_tool(tool)))
        )


def _measure(state: State, tool: int, deltas_mm: ToolDeltas, usage: ToolUsage, column: int) -> None:
    """Set the tool dimensions from TOOL DEF or from the tool offset.

    If the tool has not been measured, the dimensions are 0 and a warning is logged.
    """
    state.tool_deltas_mm = deltas_mm
    if 0 < tool < FIRST_NAMED_TOOL:
        usage.record_tool(tool)
    if _defined(state, tool) is None and tool and usage.use_tool_offset(tool, state.setup.tools) is None:
        text = "Tool {tool} has no offset, so 0 is used and the machine will not start."
        hint = "Set the tool offset."
        state.log.add_warning(
            state.line_number, column, "tool-offset-missing", text, hint, tool=format_tool(tool)
        )
    update_tool_dimensions(state)


def update_tool_dimensions(state: State) -> None:
    """Update the length and radius of the active tool from the current TOOL DEF or tool table."""
    tool, deltas_mm = state.modal.tool, state.tool_deltas_mm
    offset = state.setup.tools.get(tool)
    table = (offset.z, offset.nose_radius) if tool and offset is not None else (0.0, 0.0)
    length, radius = _defined(state, tool) or table
    state.tool_length_mm, state.tool_radius_mm = length + deltas_mm.length, radius + deltas_mm.radius
    state.update_derived_values()


def find_tool_radius_mm(state: State, tool: int) -> float | None:
    """Return the radius of a tool without deltas in mm, or None if it is undefined.

    The radius comes from TOOL DEF or the tool table.
    """
    if (tool_definition := _defined(state, tool)) is not None:
        return tool_definition[1]
    offset = state.setup.tools.get(tool)
    return None if offset is None else offset.nose_radius


def _defined(state: State, tool: int) -> tuple[float, float] | None:
    return state.tool_definitions.get(tool) or state.tool_definitions.get(_name_of(state, tool))


def format_tool(tool: int) -> str:
    """Return the tool number or name in the notation of the program."""
    return f'"{tool.name}"' if isinstance(tool, NamedToolNumber) else f"{tool}"


def _name_of(state: State, tool: int) -> str:
    names = [each for each in state.tool_definitions if isinstance(each, str)]
    at = tool - FIRST_NAMED_TOOL
    return names[at] if 0 <= at < len(names) else ""


def _by_cutting_speed(state: State, node: ToolCall, number: int | None) -> float:
    """Return the spindle speed in rpm for a programmed cutting speed, such as S(VC = 120).

    The cutting speed is in m/min at the tool radius. Raises ProgramError if the tool radius is unknown.
    """
    assert node.cutting_speed is not None
    speed = word_values.number(state, node.cutting_speed, "VC", word_values.MAX_SPEED_RPM, 0.0)
    radius = find_tool_radius_mm(state, state.modal.tool if number is None else number) or 0.0
    text = "A cutting speed needs the tool radius, but the radius of the tool is not defined."
    hint = "Enter the tool radius R in the tool table, or program S."
    state.check_condition(radius > 0.0, node.cutting_speed.column, WRONG_RPM, text, hint)
    return speed * 1000.0 / (2.0 * math.pi * radius)


def _speed(state: State, node: ToolCall, number: int | None) -> float | None:
    if node.cutting_speed is not None:
        return min(_by_cutting_speed(state, node, number), state.setup.limits.max_rpm)
    if node.speed is None:
        return None
    rpm = word_values.number(state, node.speed, "S", word_values.MAX_SPEED_RPM, 0.0)
    highest = state.setup.limits.max_rpm
    text = "S{rpm} is above the spindle maximum of {highest} rpm."
    state.check_condition(
        rpm <= highest, node.speed.column, WRONG_RPM, text, "Lower S.", rpm=rpm, highest=highest
    )
    return rpm


def _feed(state: State, node: ToolCall) -> float | None:
    if node.feed is None:
        return None
    feed = word_values.number(state, node.feed, "F", MAX_FEED, 0.0)
    return feed or None
