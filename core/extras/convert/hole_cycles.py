"""Drilling, boring and tapping cycles along Z: G81 to G85 and G89."""

from __future__ import annotations

from dataclasses import replace

from core.extras.convert.path_steps import Kind, Step
from core.extras.convert.reasons import refuse
from core.extras.convert.source_lines import Statement, Word
from core.extras.convert.source_options import Control
from core.extras.convert.source_state import SourceState

HOLES = frozenset({73, 81, 82, 83, 84, 85, 89})
_CLEARANCE = {Control.LINUXCNC: 0.254, Control.MACH: 0.254}  # mm before the next peck
_USUAL_CLEARANCE = 0.508  # mm
_SAME = 1e-6  # mm


def hole_cycle(state: SourceState, statement: Statement, code: Word) -> None:
    """Append the moves of a hole cycle.

    Words of earlier lines of the cycle remain active. Raises ProgramError.
    """
    for word in statement.words:
        if word.letter in "ZWRQPK":
            state.hole[word.letter] = word
    x, _ = state.target(statement)
    x0, z0 = state.here(code)
    assert x is not None
    state.rapid(statement.line, x, z0)
    bottom = _bottom(state, code, z0)
    plane = _plane(state, z0)
    state.rapid(statement.line, x, plane)
    if code.value in {83, 73}:
        _pecks(state, code, plane, bottom, full=code.value == 83)
    else:
        state.cut(code, x, bottom)
    _at_bottom(state, code)
    back = plane if state.returns_to_r else max(z0, plane)
    if code.value in {84, 85, 89}:
        _out_at_feed(state, code, plane)
    state.rapid(statement.line, x, back)
    del x0


def _bottom(state: SourceState, code: Word, z0: float) -> float:
    word = state.hole.get("Z") or state.hole.get("W")
    if word is None:
        raise refuse(code.line, code.column, "cycle-word", word="Z")
    value = state.length(word)
    return value if word.letter == "Z" and state.absolute else z0 + value


def _plane(state: SourceState, z0: float) -> float:
    """Return the Z at which the feed begins.

    R is a distance on Fanuc controls and a coordinate on other controls.
    """
    word = state.hole.get("R")
    if word is None:
        return z0
    value = state.length(word)
    is_distance = state.control in {Control.FANUC_A, Control.FANUC_B} or not state.absolute
    return z0 + value if is_distance else value


def _pecks(state: SourceState, code: Word, plane: float, bottom: float, *, full: bool) -> None:
    """Append the pecks of a hole.

    If ``full`` is False, the drill retracts only far enough to break the chip.
    """
    q = state.hole.get("Q")
    x = state.x
    if q is None:
        state.cut(code, x, bottom)
        return
    step = abs(state.increment(q))
    clear = _CLEARANCE.get(state.control, _USUAL_CLEARANCE)
    state.warn(code, "peck-clearance", value=clear)
    reached = plane
    while step > _SAME and reached - bottom > step + _SAME:
        reached -= step
        state.cut(code, x, reached)
        if full:
            state.rapid(code.line, x, plane)
        state.rapid(code.line, x, min(reached + clear, plane))
    state.cut(code, x, bottom)


def _at_bottom(state: SourceState, code: Word) -> None:
    p = state.hole.get("P")
    if p is None or code.value not in {82, 83, 89, 84}:
        return
    seconds = p.value if p.has_point or not state.control.is_fanuc else p.value / 1000.0
    if seconds > 0:
        state.add(Step(Kind.DWELL, code.line, number=max(seconds, 0.1)))


def _out_at_feed(state: SourceState, code: Word, plane: float) -> None:
    spindle = state.spindle
    if code.value == 84:
        if not spindle.direction:
            raise refuse(code.line, code.column, "cycle-word", word="M03")
        _turn(state, code, -spindle.direction)
    state.cut(code, state.x, plane)
    if code.value == 84:
        _turn(state, code, spindle.direction)


def _turn(state: SourceState, code: Word, direction: int) -> None:
    state.spindle = replace(state.spindle, direction=direction)
    state.add(Step(Kind.SPINDLE, code.line, spindle=state.spindle))
