"""Dwells of a source program."""

from __future__ import annotations

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_lines import SourceWord
from core.extras.convert.source_options import SourceControl
from core.extras.convert.source_state import SourceState

SHORTEST_DWELL_S = 0.1  # of OmniTurn


def read_seconds(state: SourceState, word: SourceWord) -> float:
    """Return the time of a dwell in seconds. Raises ProgramError if its unit is unknown."""
    if state.source_control is SourceControl.MACH:
        state.add_warning(word, "dwell-unit", word=word.text)
    if not state.source_control.is_fanuc or word.has_decimal_point:
        return word.value
    if word.letter == "P":
        return word.value / 1000.0
    if not state.options.no_point:
        raise make_error(word.line_number, word.column, "no-point", word=word.text)
    return word.value * state.options.no_point


def append_dwell(state: SourceState, word: SourceWord, seconds: float) -> None:
    """Append a dwell, which lasts at least as long as the shortest dwell of OmniTurn.

    Raises ProgramError if the time is negative.
    """
    if seconds < 0:
        raise make_error(word.line_number, word.column, "dwell-negative", word=word.text)
    if not seconds:
        state.add_note(word, "no-change", word=word.text)
        return
    if seconds < SHORTEST_DWELL_S:
        state.add_warning(word, "dwell-short", word=word.text)
    state.append_step(PathStep(StepKind.DWELL, word.line_number, number=max(seconds, SHORTEST_DWELL_S)))
