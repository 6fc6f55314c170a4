"""Spindle words of a source program: G96, G97, S, M03 and M04."""

from __future__ import annotations

from dataclasses import replace

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.path_steps import PathStep, SpindleState, StepKind
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import SourceControl
from core.extras.convert.source_state import SourceState
from core.interpreter.shared.units import get_surface_speed_unit


def execute_spindle_words(state: SourceState, statement: SourceStatement) -> None:
    """Execute G96, G97, S, M03 and M04.

    A speed in rpm above the maximum speed in the conversion options is limited with a warning. Without a
    speed, no spindle step is appended, and the next cut raises ProgramError. Raises ProgramError if the
    speed is invalid.
    """
    before = state.spindle
    spindle = _set_speed(state, statement, _select_mode(state, statement))
    for code in statement.find_words("M"):
        if code.value in {3, 4}:
            state.start_request = None
            spindle = replace(spindle, direction=1 if code.value == 3 else -1)
            if not spindle.speed and spindle.direction != before.direction:
                state.speed_request = make_error(
                    code.line_number, code.column, "spindle-speed", word=code.text
                )
    _check_zero(statement, spindle)
    state.spindle = spindle
    keeps_speed = before.is_css and not spindle.is_css and before.direction == spindle.direction
    if spindle != before and spindle.direction and (spindle.speed or keeps_speed):
        state.append_step(PathStep(StepKind.SPINDLE, statement.line_number, spindle=spindle))


def stop_spindle(state: SourceState, word: SourceWord) -> None:
    """Execute M05."""
    state.speed_request = state.start_request = None
    if not state.spindle.direction:
        state.add_note(word, "no-change", word=word.text)
        return
    state.spindle = replace(state.spindle, direction=0)
    state.append_step(PathStep(StepKind.SPINDLE, word.line_number, spindle=state.spindle))


def _select_mode(state: SourceState, statement: SourceStatement) -> SpindleState:
    """Return the spindle state after G96 and G97. G96 requests a surface speed."""
    spindle = state.spindle
    for code in statement.find_words("G"):
        if code.value in {96, 97} and spindle.is_css != (code.value == 96):
            spindle = replace(spindle, is_css=code.value == 96, speed=0.0)
            if spindle.is_css:
                state.speed_request = make_error(code.line_number, code.column, "surface-speed")
    return spindle


def _set_speed(state: SourceState, statement: SourceStatement, spindle: SpindleState) -> SpindleState:
    """Return the spindle state after S and the maximum rpm. Raises ProgramError for a negative speed.

    S is the maximum rpm in G50, and in G92 except in system A. Old programs of system B use G50 too.
    """
    control = state.source_control
    limit = (control.is_fanuc and statement.has_g_code(50)) or (
        statement.has_g_code(92) and not control.uses_code_system_a and control is not SourceControl.LINUXCNC
    )
    word = statement.find_word("S")
    if word is not None and word.value < 0:
        raise make_error(word.line_number, word.column, "spindle-negative", word=word.text)
    if word is not None and limit:
        spindle = replace(spindle, max_rpm=_limit_rpm(state, word))
    elif word is not None:
        speed = _convert_surface_speed(state, word) if spindle.is_css else _limit_rpm(state, word)
        spindle = replace(spindle, speed=speed)
        state.speed_request = None
    most = statement.find_word("D")
    if most is not None and statement.has_g_code(96) and not control.is_fanuc:
        spindle = replace(spindle, max_rpm=_limit_rpm(state, most))
    return spindle


def _convert_surface_speed(state: SourceState, word: SourceWord) -> float:
    """Return a surface speed in mm/s. Raises ProgramError if the unit of the program is unknown."""
    state.get_unit_mm(word)
    return word.value * get_surface_speed_unit(is_metric=bool(state.is_metric))


def _check_zero(statement: SourceStatement, spindle: SpindleState) -> None:
    word = statement.find_word("S")
    stops = any(each.value == 5 for each in statement.find_words("M"))
    if word is not None and not word.value and spindle.direction and not stops:
        raise make_error(word.line_number, word.column, "spindle-zero", word=word.text)


def _limit_rpm(state: SourceState, word: SourceWord) -> float:
    most = state.options.max_rpm
    if word.value > most:
        state.add_warning(word, "speed-limited", word=word.text)
    return min(word.value, most)
