"""Execution of M codes, before or after the motion of their line."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.omniturn.codes.code_entry import ActionKind
from core.interpreter.omniturn.codes.code_rules import check_conditions
from core.interpreter.omniturn.codes.code_table import load_handler
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.setup.inherited_state import compute_modal_after_end
from core.interpreter.omniturn.setup.spindle_and_dwell import warn_about_short_dwell
from core.interpreter.shared import actions
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import Diagnostic, ProgramError, Severity, make_error_diagnostic
from core.language.omniturn import other_controls
from core.message import Message


def execute_before_motion(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of an M code that acts before the motion, other than M03 and M04."""
    code = statement.m_code_entry
    if code is None:
        yield from _machine_output(state, statement, on=True)
    elif code.action_kind is ActionKind.START:
        yield from load_handler(code)(state, statement)


def execute_after_motion(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of an M code that acts after the motion."""
    code = statement.m_code_entry
    if code is None:
        yield from _machine_output(state, statement, on=False)
    elif code.action_kind is ActionKind.STOP:
        yield from load_handler(code)(state, statement)


def coolant(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M08 (coolant on) or M09 (coolant off)."""
    state.set_modal(state.modal._replace(coolant=statement.m_number == 8))
    yield _done(state, statement, actions.CoolantSwitch(on=statement.m_number == 8))


def switch_collet(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M12 (clamp collet) or M13 (unclamp collet).

    Raises ProgramError if the spindle must be stopped first.
    """
    opens = statement.m_number == 13
    assert statement.m_code_entry is not None
    check_conditions(state, statement, statement.m_code_entry)
    state.set_modal(state.modal._replace(collet_closed=not opens))
    yield _done(state, statement, actions.ColletSwitch(closed=not opens))


def wait_for_input(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M91 to M94, which waits until an input is open or closed."""
    assert statement.m_code_entry is not None
    yield _done(state, statement, actions.InputWait(*statement.m_code_entry.required_input))


def stop_program(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M00 or M01, which shows the line's comment to the operator."""
    yield _done(
        state,
        statement,
        actions.ProgramStop(optional=statement.m_number == 1, message=(statement.comment or "").strip()),
    )


def cancel_repeat(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M31, which cancels Cycle Repeat."""
    yield _done(state, statement, actions.CycleRepeatCancel())


def end_program(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M30 or M02, which ends the program; only M30 resets the M functions."""
    reset = statement.m_number == 30
    warn_about_short_dwell(state)
    state.stay(
        compute_modal_after_end(state.modal, abs(state.compute_rpm_at(state.x)), resets_m_functions=reset)
    )
    yield _done(state, statement, actions.ProgramEnd(reset=reset))


def check_m_codes(state: State, lines: tuple[Statement, ...]) -> None:
    """Report the M codes that neither the control nor the machine file defines."""
    for statement in lines:
        if statement.m_number in state.setup.limits.ignored_m_codes:
            column = statement.m_word.column if statement.m_word else 0
            text = Message(
                "M{code} has no effect because the machine file defines this code as ignored.",
                code=f"{statement.m_number:02d}",
            )
            state.log.add_finding(Diagnostic(statement.line, column, Severity.NOTE, "no-effect", text))
        elif statement.m_number not in state.setup.limits.m_code_outputs:
            state.log.add_finding(_unknown(state, statement))


def _unknown(state: State, statement: Statement) -> Diagnostic:
    column, name = statement.m_word.column if statement.m_word else 0, f"M{statement.m_number:02d}"
    if statement.m_number in state.setup.limits.disabled_m_codes:
        text: str = Message("{name} is defined but not enabled in the machine file.", name=name)
        hint: str = Message("Set enabled = true for {code} under [m_codes].", code=statement.m_number)
        return make_error_diagnostic(statement.line, column, "m-disabled", text, hint)
    habit, hint = other_controls.explain_foreign_word(name) or (
        "",
        ("In the machine file, assign an output to this M code."),
    )
    text = Message("{name} is not a valid code on this machine. {habit}", name=name, habit=habit).rstrip()
    return make_error_diagnostic(statement.line, column, "m-unknown", text, hint)


def _done(state: State, statement: Statement, action: actions.Action) -> Block:
    return state.action(statement.line, statement.get_block_text("m"), action)


def _machine_output(state: State, statement: Statement, *, on: bool) -> Iterator[Block]:
    """Yield the block of an M code that the machine file assigns to an output.

    The output turns on before the motion or turns off after the motion.
    """
    output = state.setup.limits.m_code_outputs.get(statement.m_number or 0)
    if statement.m_number in state.setup.limits.ignored_m_codes:
        return
    if output is None:
        raise ProgramError(_unknown(state, statement))
    name, wanted = output
    if wanted is on:
        outputs = state.modal.outputs | {name} if on else state.modal.outputs - {name}
        state.set_modal(state.modal._replace(outputs=outputs))
        yield _done(state, statement, actions.OutputSwitch(name, on))
