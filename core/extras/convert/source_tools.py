"""Tool words of a source program: T, M06, G43 and G49."""

from __future__ import annotations

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import SourceControl
from core.extras.convert.source_state import SourceState

_HIGHEST = 32


def execute_tool_words(state: SourceState, statement: SourceStatement) -> None:
    """Execute T, M06, G43 and G49.

    In a LinuxCNC or Mach program that contains M06, T only prepares the tool. Raises ProgramError if
    OmniTurn does not have this tool.
    """
    word = statement.find_word("T")
    if word is not None:
        if state.uses_tool_change:
            report_unused_tool(state)
            state.prepared_tool = word
        else:
            _select_tool(state, word)
    change = next((each for each in statement.find_words("M") if each.value == 6), None)
    if change is not None and state.uses_tool_change:
        _require_spindle_start(state, change)
        if state.prepared_tool is None:
            state.add_note(change, "no-change", word=change.text)
        else:
            _select_tool(state, state.prepared_tool, statement.line_number)
            state.prepared_tool = None
    for code in statement.find_words("G"):
        if code.value == 43:
            _check_offset_number(state, statement, code)
        elif code.value == 49:
            known = "no-change" if not state.tool_number else "offset-cancelled"
            (state.add_note if not state.tool_number else state.add_warning)(code, known, word=code.text)


def _require_spindle_start(state: SourceState, change: SourceWord) -> None:
    """Require M03 or M04 before the next cut, because M06 of LinuxCNC stops the spindle."""
    if state.source_control is SourceControl.LINUXCNC and state.spindle.direction:
        state.start_request = make_error(change.line_number, change.column, "spindle-start", word=change.text)


def report_unused_tool(state: SourceState) -> None:
    """Add a warning about a T word that no M06 follows."""
    word = state.prepared_tool
    if word is not None:
        state.add_warning(word, "left-out", word=word.text)


def _check_offset_number(state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
    """Check the offset number H of G43, and change to the tool with this number.

    If H is missing or is the number of the current tool, only a note is added.
    """
    word = statement.find_word("H")
    if word is None or word.value == state.tool_number:
        state.add_note(code, "no-change", word=code.text)
        return
    _check_number(word, round(word.value))
    state.add_warning(word, "tool-of-offset", word=word.text, number=round(word.value))
    _change_tool(state, round(word.value), word.line_number)


def _select_tool(state: SourceState, word: SourceWord, line: int = 0) -> None:
    number = offset = round(word.value)
    if number > 99 and state.source_control is not SourceControl.LINUXCNC:
        number, offset = divmod(number, 100)
    if not number or not offset:
        state.add_warning(word, "offset-cancelled", word=word.text)
        if number in {0, state.tool_number}:
            return
        offset = number
    _check_number(word, offset)
    if offset != number:
        state.add_warning(word, "tool-of-offset", word=word.text, number=offset)
    if offset == state.tool_number:
        state.add_note(word, "no-change", word=word.text)
        return
    _change_tool(state, offset, line or word.line_number)


def _check_number(word: SourceWord, offset: int) -> None:
    if word.value != round(word.value) or not 1 <= offset <= _HIGHEST:
        raise make_error(word.line_number, word.column, "tool-number", word=word.text)


def _change_tool(state: SourceState, number: int, line: int) -> None:
    state.tool_number, state.x, state.z = number, None, None
    state.preset_shift = None if state.has_preset else state.preset_shift
    state.append_step(PathStep(StepKind.TOOL, line, number=number))
