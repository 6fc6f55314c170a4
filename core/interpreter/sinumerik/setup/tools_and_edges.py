"""Tools (T, by number or name) and their cutting edges (D), with the offsets that they activate."""

from __future__ import annotations

import re
from collections.abc import Iterator

from core.interpreter.shared.actions import ToolChange
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.formula_values import convert_to_whole_number
from core.interpreter.shared.interpretation import ToolUsage
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import VALUE_RANGES, Word
from core.language.sinumerik.word_values import find_violated_limits
from core.message import Message
from core.tool_edges import (
    EDGE_NUMBERS,
    FIRST_NAMED_TOOL,
    NamedToolNumber,
    format_edge_name,
    get_edge_number,
    get_tool_number,
    make_edge_row_number,
)

WRONG_TOOL_NUMBER = 17190
WRONG_EDGE_NUMBER = 17180


def execute_tool_words(state: SinumerikState, statement: Statement, usage: ToolUsage) -> Iterator[Block]:
    """Yield the blocks of the tool words T and D.

    T without D selects the tool with D1, and D0 cancels the offset. For a tool without an offset, only a
    warning is logged. Raises ProgramError in the following cases:
    - The tool number or the edge is invalid, or the tool does not have this edge.
    - D1 to D9 is programmed without an active tool.
    - G41 or G42 is active.
    """
    tool, edge = statement.words.get("T"), statement.words.get("D")
    if tool is None and edge is None:
        return
    if state.modal.compensation_code != 40:
        word = tool or edge
        text = "{what} is not allowed while G{state} is active."
        hint = "Write G40 and a move before this block."
        raise statement.make_error(
            word, "comp-with", text, hint, what=word.text if word else "", state=state.modal.compensation_code
        )
    before = state.modal.tool
    number = get_tool_number(before) if tool is None else _number(state, statement, tool)
    wanted = 1 if edge is None else _edge(state, statement, edge)
    if not number and edge is not None and wanted:
        text = "{edge}: no tool is active."
        raise statement.make_error(
            edge, WRONG_EDGE_NUMBER, text, "Write T before this block.", edge=edge.text
        )
    _activate_edge(state, statement, number, wanted if number else 0, usage)
    if tool is not None or state.modal.tool != before:
        text = " ".join(word.text for word in (tool, edge) if word is not None)
        yield state.action(statement.lexed_block.line_number, text, ToolChange(state.modal.tool))


def _number(state: SinumerikState, statement: Statement, word: Word) -> int:
    if not word.quoted_name:
        value = state.compute_word_value(statement, word)
        whole = convert_to_whole_number(value)
        if whole is None or find_violated_limits(word.name, whole) is not None:
            text = "{word} results in {value}, which is not a tool number."
            low, high = VALUE_RANGES[word.name]
            hint = "Enter the tool number as a whole number from {low} to {high}."
            raise statement.make_error(
                word,
                WRONG_TOOL_NUMBER,
                text,
                hint,
                word=word.text,
                value=f"{value:g}",
                low=f"{low:g}",
                high=f"{high:g}",
            )
        return whole
    wanted = word.quoted_name.casefold()
    for key, offset in sorted(state.setup.tools.items()):
        if offset.name.casefold() == wanted:
            return get_tool_number(key)
    if wanted not in state.names:
        state.names.append(wanted)
    return NamedToolNumber(FIRST_NAMED_TOOL + state.names.index(wanted), word.quoted_name)


def _edge(state: SinumerikState, statement: Statement, word: Word) -> int:
    whole = convert_to_whole_number(state.compute_word_value(statement, word))
    text = "{word}: cutting edges are D1 to D9; D0 deselects the cutting edge."
    if whole is None or (whole and whole not in EDGE_NUMBERS):
        raise statement.make_error(word, WRONG_EDGE_NUMBER, text, "Correct D.", word=word.text)
    return whole


def _activate_edge(
    state: SinumerikState, statement: Statement, number: int, edge: int, usage: ToolUsage
) -> None:
    """Activate the cutting edge with this number, which is 0 for D0 and T0."""
    key = make_edge_row_number(
        number,
        edge or get_edge_number(state.modal.tool) if number == get_tool_number(state.modal.tool) else edge,
    )
    offset = ToolOffset() if not number else _offset(state, statement, key, usage)
    moved = state.edge if state.modal.edge else ToolOffset()
    other = offset if edge else ToolOffset()
    state.moved_by_tool |= {
        name for name, a, b in (("X", moved.x, other.x), ("Z", moved.z, other.z)) if a != b
    }
    state.edge = offset
    state.set_modal_state(state.modal._replace(tool=key if number else 0, edge=edge))
    state.derive_offsets()


def _offset(state: SinumerikState, statement: Statement, key: int, usage: ToolUsage) -> ToolOffset:
    """Return the offset of a cutting edge.

    Raises ProgramError if the tool has offsets, but none for this edge. If the tool has no offset at all, a
    warning is logged, and the offset is 0.
    """
    tools = state.setup.tools
    if key not in tools and get_tool_number(key) in tools:
        name, word = format_edge_name(key), statement.words.get("D")
        text = "{name} does not exist: {key} has no such cutting edge in the tool offsets."
        hint = "Set {other} on the TOOL OFFSETS page (F8)."
        raise statement.make_error(
            word,
            WRONG_EDGE_NUMBER,
            text,
            hint,
            name=name,
            key=format_edge_name(get_tool_number(key)),
            other=name,
        )
    offset = usage.use_tool_offset(key, tools)
    if offset is None:
        word = statement.words.get("T") or statement.words.get("D")
        text = Message(
            "{key} has no tool offset, so 0 is used and the machine will not start.",
            key=format_edge_name(key),
        )
        hint = _hint(word)
        state.log_finding(statement.make_warning(word, "tool-offset-missing", text, hint))
    return offset or ToolOffset()


def _hint(word: Word | None) -> str:
    """Return the remedy that a finding suggests for a tool without an offset.

    For T0101, the remedy is T1 D1, because other controls use T0101 for tool 1 with its offset.
    """
    if word is not None and word.quoted_name:
        return "Enter this name as the remark of a tool (F8)."
    if word is not None and (iso := _TOOL_AND_OFFSET.fullmatch(word.text)):
        meant = f"T{int(iso[1])} D{max(int(iso[2]) % 10, 1)}"
        return Message(
            "{word} calls tool {word2} on this control; write {meant}.",
            word=word.text,
            word2=int(word.text[1:]),
            meant=meant,
        )
    return _SET


_TOOL_AND_OFFSET = re.compile(r"T([0-9]{1,2})([0-9]{2})")
_SET = "Set the offset of the tool on the TOOL OFFSETS page (F8); tools are T1 to T32."
