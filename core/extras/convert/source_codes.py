"""G and M codes of a source program that select modes, or that have no counterpart on this lathe."""

from __future__ import annotations

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import SourceControl
from core.extras.convert.source_preset import cancel_preset
from core.extras.convert.source_spindle import stop_spindle
from core.extras.convert.source_state import SourceState

_ALWAYS_ACTIVE = frozenset({13.1, 15, 18, 50.1, 67, 69, 91.1, 113})
"""Codes that select a state which this lathe always has: plane XZ, and no rotation, mirror or C axis."""
_LEFT_OUT = frozenset({9, 22, 23, 25, 26, 61, 61.1, 64})
"""Codes for exact stop, cornering, travel limits of the control, and monitoring of the spindle speed."""
_LEFT_OUT_M = frozenset({17, 18, 23, 24, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49})
_LEFT_OUT_M_OF_HAAS = frozenset({12, 13, 31, 32, 33, 76, 77, 83, 84, 85, 86, 88, 89})
"""Chip conveyor, automatic door, high-pressure coolant, air jet and display of Haas controls."""
_STOPS = frozenset({0, 1, 2, 3, 4, 5, 9, 30, 60})
_C_AXIS = frozenset({7.1, 12.1, 107, 112, 12, 16, 12.2})
_PRESET_CANCEL = frozenset({92.1, 92.2})
_WITH_WORDS = {64: "PQ", 22: "XZIK", 26: "PQRI", 50.1: "XZ"}
LEFT_OUT_WITH_AXES = frozenset({22, 50.1})
"""Codes whose X and Z are not an end point: G22 with travel limits, and G50.1 with mirrored axes."""
_AXES = {"U": "X", "W": "Z"}
ROTARY_LETTERS = "CHABYV"


def execute_mode(state: SourceState, statement: SourceStatement, word: SourceWord) -> None:
    """Execute a G code that selects a mode. Raises ProgramError if this lathe has no such mode."""
    if not _select_numbers(state, word) and not _select_feed_mode(state, word):
        _select_other_mode(state, statement, word)


def is_mode(state: SourceState, code: float) -> bool:
    """Return whether ``execute_mode`` handles this G code, by executing it or by reporting it."""
    fanuc, system_a = state.source_control.is_fanuc, state.source_control.uses_code_system_a
    return (
        code in _ALWAYS_ACTIVE | _LEFT_OUT | {17, 19, 20, 21, 40, 41, 42, 43, 49, 80, 96, 97}
        or code in get_feed_codes(state)
        or 54 <= code < 60
        or (code in {90, 91, 98, 99} and not system_a)
        or (code in _PRESET_CANCEL | {7, 8} and not fanuc)
        or (code in {70, 71} and state.source_control is SourceControl.MACH)
    )


def get_feed_codes(state: SourceState) -> frozenset[int]:
    """Return the codes for feed per minute and feed per revolution."""
    return frozenset({98, 99}) if state.source_control.uses_code_system_a else frozenset({94, 95})


def _select_numbers(state: SourceState, word: SourceWord) -> bool:
    """Execute a code for units, X diameter or increments; return whether the word is such a code."""
    fanuc, code = state.source_control.is_fanuc, word.value
    if code in {20, 21} or (code in {70, 71} and state.source_control is SourceControl.MACH):
        state.is_metric = code in {21, 71}
    elif code in {7, 8} and not fanuc:
        state.is_x_diameter = code == 7
    elif code in {90, 91} and not state.source_control.uses_code_system_a:
        state.is_absolute = code == 90
    else:
        return False
    return True


def _select_feed_mode(state: SourceState, word: SourceWord) -> bool:
    """Execute a code that selects the feed mode; return whether the word is such a code."""
    code = word.value
    if code in get_feed_codes(state):
        per_rev = code in {99, 95}
        state.feed = None if per_rev != state.is_feed_per_rev else state.feed
        state.is_feed_per_rev = per_rev
    elif code == 93 and not state.source_control.is_fanuc:
        raise make_error(word.line_number, word.column, "inverse-time")
    elif code in {98, 99} and not state.source_control.uses_code_system_a:
        state.returns_to_r_plane = code == 99
    else:
        return False
    return True


def _select_other_mode(state: SourceState, statement: SourceStatement, word: SourceWord) -> None:
    code = word.value
    if 54 <= code < 60:
        _select_work_offset(state, word)
    elif code in _C_AXIS:
        raise make_error(word.line_number, word.column, "c-axis", word=word.text)
    elif code in {17, 18, 19}:
        state.plane_code = code
        if code != 18:
            state.add_warning(word, "plane", word=word.text)
            return
    elif code in _PRESET_CANCEL and state.has_preset:
        cancel_preset(state, word)
        return
    words = [word, *(each for each in statement.words if each.letter in _WITH_WORDS.get(code, ""))]
    text = " ".join(each.text for each in words)
    if (code in _ALWAYS_ACTIVE or code in _PRESET_CANCEL) and is_mode(state, code):
        state.add_note(word, "no-change", word=text)
    elif code in _LEFT_OUT:
        state.add_warning(word, "left-out", word=text)


def get_left_out_letters(statement: SourceStatement) -> str:
    """Return the letters of the words that belong to codes of a line that are not converted."""
    return "".join(_WITH_WORDS.get(each.value, "") for each in statement.find_words("G"))


def _select_work_offset(state: SourceState, word: SourceWord) -> None:
    code = word.value
    if state.work_offset not in {0, code} or code != int(code):
        raise make_error(word.line_number, word.column, "work-offset", word=word.text)
    if not state.work_offset:
        state.add_note(word, "work-offset-used", word=word.text)
    state.work_offset = code


def execute_start_codes(state: SourceState, statement: SourceStatement) -> None:
    """Execute the M codes that act before the move of a line.

    Raises ProgramError for an M code that this machine does not have.
    """
    for word in statement.find_words("M"):
        if word.value in {7, 8}:
            if word.value == 7:
                state.add_warning(word, "replaced", word=word.text, replacement="M08")
            state.append_step(PathStep(StepKind.M, statement.line_number, number=8))
        elif word.value == 6 and not state.uses_tool_change:
            state.add_note(word, "no-change", word=word.text)
        elif word.value not in _STOPS | {6}:
            _execute_machine_code(state, word)


def _execute_machine_code(state: SourceState, word: SourceWord) -> None:
    options, code = state.options, word.value
    haas = options.control is SourceControl.HAAS and code in _LEFT_OUT_M_OF_HAAS
    if code in options.skipped_m_codes or code in _LEFT_OUT_M or haas:
        state.add_warning(word, "left-out", word=word.text)
    elif code in options.m_codes:
        state.add_warning(word, "machine-code", word=word.text)
        state.append_step(PathStep(StepKind.M, word.line_number, number=code))
    else:
        raise make_error(word.line_number, word.column, "m-code", word=word.text, number=f"{code:g}")


def execute_stop_codes(state: SourceState, statement: SourceStatement) -> bool:
    """Execute the M codes that act after the move of a line; return whether the program ends."""
    ended = False
    for word in statement.find_words("M"):
        if word.value in {9, 0, 1, 60}:
            if word.value == 60:
                state.add_warning(word, "replaced", word=word.text, replacement="M00")
            number = 0 if word.value == 60 else word.value
            state.append_step(PathStep(StepKind.M, statement.line_number, number=number))
        elif word.value == 5:
            stop_spindle(state, word)
        elif word.value in {2, 30}:
            state.append_step(PathStep(StepKind.END, statement.line_number, number=word.value))
            ended = True
    return ended


def check_repeated_words(statement: SourceStatement) -> None:
    """Raise ProgramError if two words of a line contradict each other, so that only one could act."""
    seen: dict[str, SourceWord] = {}
    for word in statement.words:
        key = _get_group(word)
        if not key:
            continue
        before = seen.setdefault(key, word)
        if before is not word:
            raise make_error(word.line_number, word.column, "word-twice", word=before.text, other=word.text)


def _get_group(word: SourceWord) -> str:
    """Return the key of the group in which two words contradict each other, or an empty string.

    The result is an empty string for a word that contradicts no other word.
    """
    if word.letter == "G":
        return "motion" if word.value in {0, 1, 2, 3, 32, 33} else ""
    if word.letter == "M":
        return "spindle" if word.value in {3, 4, 5} else ""
    return _AXES.get(word.letter, word.letter)
