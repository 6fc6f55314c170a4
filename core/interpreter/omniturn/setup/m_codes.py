"""Blocks of the M codes, before or after the motion of their line."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.omniturn.codes.code_entry import Acts
from core.interpreter.omniturn.codes.code_rules import check_when
from core.interpreter.omniturn.codes.code_table import carry_out
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.setup.carry_over import after_end
from core.interpreter.omniturn.setup.spindle_and_dwell import warn_of_short_dwell
from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import Diagnostic, ProgramError, Severity, refusal
from core.language.omniturn import other_controls
from core.message import Message


def before_motion(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of an M code that acts before the motion, other than M03 and M04."""
    code = statement.m_code
    if code is None:
        yield from _machine_output(state, statement, on=True)
    elif code.acts is Acts.START:
        yield from carry_out(code)(state, statement)


def after_motion(state: State, statement: Statement) -> Iterator[Block]:
    """The block of an M code that acts after the motion."""
    code = statement.m_code
    if code is None:
        yield from _machine_output(state, statement, on=False)
    elif code.acts is Acts.STOP:
        yield from carry_out(code)(state, statement)


def coolant(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M08 (coolant on) or M09 (coolant off)."""
    state.adopt(state.modal._replace(coolant=statement.m == 8))
    yield _done(state, statement, actions.Coolant(on=statement.m == 8))


def collet(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M12 (clamp) or M13 (unclamp). Raises ProgramError if the spindle must be stopped."""
    opens = statement.m == 13
    assert statement.m_code is not None
    check_when(state, statement, statement.m_code)
    state.adopt(state.modal._replace(collet_closed=not opens))
    yield _done(state, statement, actions.Collet(closed=not opens))


def wait_for_input(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M91 to M94, which wait until a terminal is open or closed."""
    assert statement.m_code is not None
    yield _done(state, statement, actions.WaitInput(*statement.m_code.terminal))


def program_stop(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M00 or M01, with the comment for the operator."""
    yield _done(
        state,
        statement,
        actions.ProgramStop(optional=statement.m == 1, message=(statement.comment or "").strip()),
    )


def repeat_off(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M31, which cancels Cycle Repeat."""
    yield _done(state, statement, actions.RepeatOff())


def program_end(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M30, which resets the M functions, or of M02, which does not."""
    reset = statement.m == 30
    warn_of_short_dwell(state)
    state.stay(after_end(state.modal, abs(state.rpm_at(state.x)), reset=reset))
    yield _done(state, statement, actions.ProgramEnd(reset=reset))


def check_m_codes(state: State, lines: tuple[Statement, ...]) -> None:
    """Report the M codes that neither the control nor the machine file defines."""
    for statement in lines:
        if statement.m in state.setup.limits.m_ignored:
            column = statement.m_word.column if statement.m_word else 0
            text = Message(
                "M{code} has no effect because the machine file defines this code as ignored.",
                code=f"{statement.m:02d}",
            )
            state.log.add(Diagnostic(statement.line, column, Severity.NOTE, "no-effect", text))
        elif statement.m not in state.setup.limits.m_outputs:
            state.log.add(_unknown(state, statement))


def _unknown(state: State, statement: Statement) -> Diagnostic:
    column, name = statement.m_word.column if statement.m_word else 0, f"M{statement.m:02d}"
    if statement.m in state.setup.limits.m_disabled:
        text: str = Message("{name} is defined but not enabled in the machine file.", name=name)
        hint: str = Message("Set enabled = true for {code} under [m_codes].", code=statement.m)
        return refusal(statement.line, column, "m-disabled", text, hint)
    habit, hint = other_controls.meaning_here(name) or (
        "",
        ("In the machine file, assign an output to this M code."),
    )
    text = Message("{name} is not a valid code on this machine. {habit}", name=name, habit=habit).rstrip()
    return refusal(statement.line, column, "m-unknown", text, hint)


def _done(state: State, statement: Statement, action: actions.Action) -> Block:
    return state.action(statement.line, statement.part("m"), action)


def _machine_output(state: State, statement: Statement, *, on: bool) -> Iterator[Block]:
    """Yield the block of an M code of the machine file: output on before the motion, or off after it."""
    output = state.setup.limits.m_outputs.get(statement.m or 0)
    if statement.m in state.setup.limits.m_ignored:
        return
    if output is None:
        raise ProgramError(_unknown(state, statement))
    name, wanted = output
    if wanted is on:
        outputs = state.modal.outputs | {name} if on else state.modal.outputs - {name}
        state.adopt(state.modal._replace(outputs=outputs))
        yield _done(state, statement, actions.Output(name, on))
