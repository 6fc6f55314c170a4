"""Drilling, boring and tapping cycles along Z: G81 to G85 and G89."""

from __future__ import annotations

from dataclasses import replace

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.cycles.cycle_limits import limit_pass_count, require_positive
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_dwell import append_dwell, read_seconds
from core.extras.convert.source_lines import SourceStatement, SourceWord
from core.extras.convert.source_options import SourceControl
from core.extras.convert.source_state import SourceState

HOLE_CYCLE_CODES = frozenset({73, 81, 82, 83, 84, 85, 89})
_CLEARANCE = {SourceControl.LINUXCNC: 0.254, SourceControl.MACH: 0.254}  # mm before the next peck
_USUAL_CLEARANCE = 0.508  # mm
_SAME = 1e-6  # mm


def get_hole_letters(code: int) -> str:
    """Return the letters that have an effect in a hole cycle, apart from axes and feed."""
    return "RKL" + {73: "Q", 82: "P", 83: "QP", 84: "P", 89: "P"}.get(code, "")


def append_hole_cycle(state: SourceState, statement: SourceStatement, code: SourceWord) -> None:
    """Append the moves of a hole cycle.

    Words of earlier lines of the same cycle remain active. Raises ProgramError if a required word is
    missing.
    """
    for word in statement.words:
        if word.letter in "KL" and word.value != 1:
            raise make_error(word.line_number, word.column, "code-unknown", word=word.text)
        if word.letter in "ZWRQP":
            state.hole_cycle_words[word.letter] = word
    x, _ = state.find_target(statement)
    x0, z0 = state.get_position(code)
    assert x is not None
    state.append_rapid(statement.line_number, x, z0)
    bottom = _bottom(state, code, z0)
    plane = _plane(state, z0)
    state.append_rapid(statement.line_number, x, plane)
    if code.value in {83, 73}:
        _pecks(state, code, plane, bottom, full=code.value == 83)
    else:
        state.append_cut(code, x, bottom)
    _at_bottom(state, code)
    back = plane if state.returns_to_r_plane else max(z0, plane)
    if code.value in {84, 85, 89}:
        _out_at_feed(state, code, plane)
    state.append_rapid(statement.line_number, x, back)
    del x0


def _bottom(state: SourceState, code: SourceWord, z0: float) -> float:
    word = state.hole_cycle_words.get("Z") or state.hole_cycle_words.get("W")
    if word is None:
        raise make_error(code.line_number, code.column, "cycle-word", word="Z")
    value = state.convert_length(word)
    return value if word.letter == "Z" and state.is_absolute else z0 + value


def _plane(state: SourceState, z0: float) -> float:
    """Return the Z of the R plane, at which the move at feed rate begins.

    R is a distance on Fanuc controls and a coordinate on other controls.
    """
    word = state.hole_cycle_words.get("R")
    if word is None:
        return z0
    value = state.convert_length(word)
    is_distance = (
        state.source_control in {SourceControl.FANUC_A, SourceControl.FANUC_B} or not state.is_absolute
    )
    return z0 + value if is_distance else value


def _pecks(state: SourceState, code: SourceWord, plane: float, bottom: float, *, full: bool) -> None:
    """Append the pecks of a hole.

    If ``full`` is False, the drill retracts only a short distance to break the chip.
    """
    q = state.hole_cycle_words.get("Q")
    x = state.x
    if q is None:
        state.append_cut(code, x, bottom)
        return
    step = require_positive(q, abs(state.convert_increment(q)))
    limit_pass_count(code, abs(plane - bottom), step)
    clear = _CLEARANCE.get(state.source_control, _USUAL_CLEARANCE)
    state.add_warning(code, "peck-clearance", value=clear)
    reached = plane
    while reached - bottom > step + _SAME:
        reached -= step
        state.append_cut(code, x, reached)
        if full:
            state.append_rapid(code.line_number, x, plane)
        state.append_rapid(code.line_number, x, min(reached + clear, plane))
    state.append_cut(code, x, bottom)


def _at_bottom(state: SourceState, code: SourceWord) -> None:
    p = state.hole_cycle_words.get("P")
    if p is None or code.value not in {82, 83, 89, 84}:
        return
    append_dwell(state, p._replace(line_number=code.line_number), read_seconds(state, p))


def _out_at_feed(state: SourceState, code: SourceWord, plane: float) -> None:
    spindle = state.spindle
    if code.value == 84:
        if not spindle.direction:
            raise make_error(code.line_number, code.column, "cycle-word", word="M03")
        _turn(state, code, -spindle.direction)
    state.append_cut(code, state.x, plane)
    if code.value == 84:
        _turn(state, code, spindle.direction)


def _turn(state: SourceState, code: SourceWord, direction: int) -> None:
    state.spindle = replace(state.spindle, direction=direction)
    state.append_step(PathStep(StepKind.SPINDLE, code.line_number, spindle=state.spindle))
