"""M codes: which block each makes, before or after the motion of its line."""

from __future__ import annotations

from core.interpreter.actions import (
    Action,
    Collet,
    Coolant,
    Output,
    ProgramEnd,
    ProgramStop,
    RepeatOff,
    WaitInput,
)
from core.interpreter.diagnostic_log import refusal
from core.interpreter.elementary_blocks import Block
from core.interpreter.omniturn import code_table
from core.interpreter.omniturn.carry_over import after_end
from core.interpreter.omniturn.dwell import warn_of_short_dwell
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.spindle_speed import rpm_at, stop_block
from core.language.diagnostics import Diagnostic, ProgramError
from core.language.omniturn import other_controls

_WAITS = {91: ("TB2-5", False), 92: ("TB2-5", True), 93: ("TB2-7", False), 94: ("TB2-7", True)}


def before_motion(state: State, made: Statement) -> Block | None:
    """The block of an M code that acts before the motion; M03 and M04 are the spindle's."""
    m = made.m
    if m is None or m in {3, 4} or m in code_table.M_AFTER:
        return None
    if m in {8, 12, 13}:
        return _done(state, made, _switch(state, made, m))
    if m in _WAITS:
        return _done(state, made, WaitInput(*_WAITS[m]))
    output = state.setup.limits.m_outputs.get(m)
    if output is None:
        raise ProgramError(_unknown(state, made))
    return _output(state, made, *output) if output[1] else None


def after_motion(state: State, made: Statement) -> Block | None:
    """The block of an M code that acts after the motion."""
    m = made.m
    if m is None:
        return None
    if m == 5:
        return stop_block(state, made)
    if m in code_table.ENDS:
        return _end(state, made, reset=m == 30)
    action = _stops(state, made, m)
    if action is not None:
        return _done(state, made, action)
    output = state.setup.limits.m_outputs.get(m)
    if m in code_table.M_BEFORE or output is None or output[1]:
        return None
    return _output(state, made, *output)


def _stops(state: State, made: Statement, m: int) -> Action | None:
    if m == 9:
        return _switch(state, made, m)
    if m in {0, 1}:
        return ProgramStop(optional=m == 1, message=(made.comment or "").strip())
    return RepeatOff() if m == 31 else None


def check_m_codes(state: State, lines: tuple[Statement, ...]) -> None:
    """Report the M codes that neither the control nor the machine file knows."""
    for made in lines:
        if made.m not in state.setup.limits.m_outputs:
            state.log.add(_unknown(state, made))


def _unknown(state: State, made: Statement) -> Diagnostic:
    column, name = made.m_word.column if made.m_word else 0, f"M{made.m:02d}"
    if made.m in state.setup.limits.m_disabled:
        text = f"{name} is defined, and not switched on in the machine file."
        hint = f"Set enabled = true for {made.m} under [m_codes]."
        return refusal(made.line, column, "m-disabled", text, hint)
    habit, hint = other_controls.here(name) or ("", "The machine file assigns the outputs.")
    text = f"{name} is no code of this machine. {habit}".rstrip()
    return refusal(made.line, column, "m-unknown", text, hint)


def _done(state: State, made: Statement, action: Action) -> Block:
    return state.action(made.line, made.part("m"), action, rpm_at(state, state.x))


def _switch(state: State, made: Statement, m: int) -> Action:
    if m in {8, 9}:
        state.adopt(state.modal._replace(coolant=m == 8))
        return Coolant(on=m == 8)
    if m == 13 and state.modal.spindle and not state.setup.limits.unclamp_while_turning:
        column = made.m_word.column if made.m_word else 0
        text = "M13 opens the collet while the spindle turns."
        raise ProgramError(refusal(made.line, column, "unclamp-turning", text, "Stop it with M05 first."))
    state.adopt(state.modal._replace(collet_closed=m == 12))
    return Collet(closed=m == 12)


def _output(state: State, made: Statement, name: str, on: bool) -> Block:
    outputs = state.modal.outputs | {name} if on else state.modal.outputs - {name}
    state.adopt(state.modal._replace(outputs=outputs))
    return _done(state, made, Output(name, on))


def _end(state: State, made: Statement, *, reset: bool) -> Block:
    warn_of_short_dwell(state)
    state.stay(after_end(state.modal, abs(rpm_at(state, state.x)), reset=reset))
    return _done(state, made, ProgramEnd(reset=reset))
