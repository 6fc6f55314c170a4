"""Tools and offsets (T, D, G10 and G92), which determine the machine positions of program coordinates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter.omniturn.codes.code_rules import check_word_groups
from core.interpreter.omniturn.motion.straight_moves import round_to_resolution
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import Preset, ToolChange, WorkShift
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import ToolUsage
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.diagnostics import Diagnostic, Severity
from core.language.omniturn import Word
from core.message import Message


def _offset(state: State, line: int, word: Word, usage: ToolUsage) -> ToolOffset:
    """Return the tool offset of a T word, or 0 with a logged warning if it was never set."""
    number = int(word.value or 0)
    offset = usage.use_tool_offset(number, state.setup.tools) if number else ToolOffset()
    if offset is None:
        state.log.count_repeated_finding(
            make_missing_offset_warning(usage.tools_without_offset, line, word.column)
        )
    return offset or ToolOffset()


def make_missing_offset_warning(tools: Sequence[int], line: int, column: int) -> Diagnostic:
    """Return the warning for tools whose offsets were never set."""
    names, hint = ", ".join(f"T{number}" for number in tools), "Set the tool offsets."
    text = Message("{names} have no offset, so 0 is used and the machine will not start.", names=names)
    if len(tools) == 1:
        hint = "Set the tool offset."
        text = Message(
            "Tool {tool} has no offset, so 0 is used and the machine will not start.", tool=tools[0]
        )
    return Diagnostic(line, column, Severity.WARNING, "tool-offset-missing", text, hint)


def change_tool(state: State, statement: Statement, word: Word, usage: ToolUsage) -> Block:
    """Return the block of T, which activates a tool offset and the sum of the G10 shifts.

    T cancels G92, D and compensation.
    """
    modal = state.modal
    number = int(word.value or 0)
    if modal.css and number:
        text = "G96 is active at a tool change, so the spindle drive must follow every sudden change in X."
        state.log.add_warning(statement.line, word.column, "tool-under-css", text, "Write G97 before T.")
    offset = _offset(state, statement.line, word, usage)
    if number:
        state.pending_shift.update(dict.fromkeys(state.pending_shift, True))
    shift_x = modal.pending_shift_x if number else 0.0
    shift_z = modal.pending_shift_z if number else 0.0
    state.stay(
        modal._replace(
            tool=number, tool_offset_x=offset.x, tool_offset_z=offset.z, compensation_code=40,
            shift_x=shift_x, shift_z=shift_z, pending_shift_x=shift_x, pending_shift_z=shift_z,
            preset_x=0.0, preset_z=0.0, secondary=0, secondary_offset_x=0.0, secondary_offset_z=0.0,
        )
    )  # fmt: skip
    state.tool_line = statement.line if number else 0
    state.fast = False  # The same tool may not change the modal state, but the next move must be checked.
    select_secondary_offset(state, statement)
    return state.action(statement.line, statement.get_block_text("tool"), ToolChange(number))


def select_secondary_offset(state: State, statement: Statement) -> None:
    """Execute D, which selects a secondary offset for this line's end point and all later moves."""
    number = statement.get_value("D")
    if number is None:
        return
    state.contour.secondary_offset_line = statement.line
    offset = state.setup.secondary.get(int(number), SecondaryOffset()) if number else SecondaryOffset()
    state.set_modal(
        state.modal._replace(secondary=int(number), secondary_offset_x=offset.x, secondary_offset_z=offset.z)
    )


def add_work_shift(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of G10, which adds to the work shift that the next T activates.

    Raises ProgramError if the line has neither X nor Z.
    """
    check_word_groups(statement, statement.code_entry)
    x, z = (
        round_to_resolution(state, statement, "X") or 0.0,
        round_to_resolution(state, statement, "Z") or 0.0,
    )
    modal = state.modal
    state.set_modal(
        modal._replace(pending_shift_x=modal.pending_shift_x + x, pending_shift_z=modal.pending_shift_z + z)
    )
    state.pending_shift.setdefault(statement.line, False)
    yield state.action(statement.line, statement.get_block_text("frame"), WorkShift(x, z))


def set_preset(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of G92, which assigns program coordinates to the current position.

    Raises ProgramError if the line has neither X nor Z.
    """
    check_word_groups(statement, statement.code_entry)
    if {"X", "Z", "F"} <= statement.words.keys():
        text = (
            "On this control, G92 presets the position and does not cut a thread. Threads are cut with G33."
        )
        state.log.add_warning(
            statement.line, statement.get_column("F"), "preset-thread", text, "Write G33XnZnInKn."
        )
    x, z = round_to_resolution(state, statement, "X"), round_to_resolution(state, statement, "Z")
    x, z = state.x if x is None else x, state.z if z is None else z
    modal = state.modal
    preset_x, preset_z = modal.preset_x + state.x - x, modal.preset_z + state.z - z
    state.stay(modal._replace(preset_x=preset_x, preset_z=preset_z))
    state.tool_line = 0
    yield state.action(statement.line, statement.get_block_text("frame"), Preset(x, z))


def warn_about_unused_shifts(state: State) -> None:
    """Log a warning at the program end for each G10 without a following T, which has no effect."""
    for line, taken in state.pending_shift.items():
        if not taken:
            text = "No T follows this G10, so its work shift never takes effect."
            state.log.add_warning(line, 0, "shift-without-tool", text, "Write G10 before a T word.")
