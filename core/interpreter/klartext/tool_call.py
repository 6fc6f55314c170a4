"""TOOL CALL: tool, tool axis, speed and feed."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.actions import ProgramStop, SpindleRun, SpindleStop, ToolChange
from core.interpreter.elementary_blocks import Block
from core.interpreter.interpretation import ToolUse
from core.interpreter.klartext import word_values
from core.interpreter.klartext.klartext_state import State
from core.language.klartext.klartext_faults import NOT_WITH_M128, WRONG_RPM, unsupported
from core.language.klartext.klartext_nodes import ToolCall


def tool_call(state: State, node: ToolCall, use: ToolUse) -> Iterator[Block]:
    """The blocks of TOOL CALL. The slides stay; the tip's place follows from the new length.

    Raises ProgramError before anything has changed.
    """
    if state.m128:
        why = "TOOL CALL while M128 is on."
        raise state.refuse(1, NOT_WITH_M128, why, "Switch it off with M129 before.")
    if node.tool_axis not in {"", "Z"}:
        raise unsupported(state.line, node.column, f"The tool axis {node.tool_axis}")
    if isinstance(node.tool, str):
        raise unsupported(state.line, node.column, "A tool by its name")
    rpm = _speed(state, node)
    feed = _feed(state, node)
    oversize = 0.0
    for value, what in ((node.length, "DL"), (node.radius, "DR")):
        delta = 0.0 if value is None else word_values.number(state, value, what, 99.999) * state.scale
        oversize = delta if what == "DL" else oversize
    state.tool_axis = node.tool_axis or state.tool_axis
    if feed is not None:
        state.feed = state.tool_feed = feed
    elif node.tool is not None:
        state.tool_feed = None
    if node.tool is not None:
        yield from _change(state, node.tool, oversize, use, node.column)
    if rpm is not None:
        state.modal = state.modal._replace(rpm=rpm)
        if state.modal.spindle:
            yield state.action(SpindleRun(rpm * state.modal.spindle))


def _change(state: State, tool: int, oversize: float, use: ToolUse, column: int) -> Iterator[Block]:
    """Another tool: the spindle stops, and where one was in it before, somebody has to change it."""
    before = state.modal.tool
    if state.modal.spindle:
        state.modal = state.modal._replace(spindle=0)
        yield state.action(SpindleStop())
    state.tool_length = _length(state, tool, use, column) + oversize
    state.modal = state.modal._replace(tool=tool)
    state.derive()
    yield state.action(ToolChange(tool))
    if tool and before not in {0, tool}:
        yield state.action(ProgramStop(optional=False, message=f"TOOL {tool}"))


def _length(state: State, tool: int, use: ToolUse, column: int) -> float:
    """The length of the tool: its offset in Z; 0 with a warning where nobody has measured it."""
    if tool == 0:
        return 0.0
    offset = use.offset(tool, state.setup.tools)
    if offset is not None:
        return offset.z
    text = f"Tool {tool} has no offset; 0 is used, and the machine will refuse to start."
    state.log.warn(state.line, column, "tool-offset-missing", text, "Set the tool's offset.")
    return 0.0


def _speed(state: State, node: ToolCall) -> float | None:
    if node.speed is None:
        return None
    rpm = word_values.number(state, node.speed, "S", word_values.MOST_SPEED, 0.0)
    highest = state.setup.limits.max_rpm
    if rpm > highest:
        text = f"S{rpm:g} is over the spindle's {highest:g} rpm."
        raise state.refuse(node.speed.column, WRONG_RPM, text, "Lower S.")
    return rpm


def _feed(state: State, node: ToolCall) -> float | None:
    if node.feed is None:
        return None
    feed = word_values.number(state, node.feed, "F", word_values.MOST_FEED, 0.0)
    return feed or None
