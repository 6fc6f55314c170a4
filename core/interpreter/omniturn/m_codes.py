"""M codes: which block each makes, before or after the motion of its line."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter import actions
from core.interpreter.elementary_blocks import Block
from core.interpreter.omniturn.carry_over import after_end
from core.interpreter.omniturn.code_entry import Acts
from core.interpreter.omniturn.code_rules import check_when
from core.interpreter.omniturn.code_table import carry_out
from core.interpreter.omniturn.dwell import warn_of_short_dwell
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.language.diagnostics import Diagnostic, ProgramError, refusal
from core.language.omniturn import other_controls


def before_motion(state: State, made: Statement) -> Iterator[Block]:
    """The block of an M code that acts before the motion; M03 and M04 are the spindle's."""
    code = made.m_code
    if code is None:
        yield from _machine_output(state, made, on=True)
    elif code.acts is Acts.START:
        yield from carry_out(code)(state, made)


def after_motion(state: State, made: Statement) -> Iterator[Block]:
    """The block of an M code that acts after the motion."""
    code = made.m_code
    if code is None:
        yield from _machine_output(state, made, on=False)
    elif code.acts is Acts.STOP:
        yield from carry_out(code)(state, made)


def coolant(state: State, made: Statement) -> Iterator[Block]:
    """The block of M08 or M09: coolant on, off."""
    state.adopt(state.modal._replace(coolant=made.m == 8))
    yield _done(state, made, actions.Coolant(on=made.m == 8))


def collet(state: State, made: Statement) -> Iterator[Block]:
    """The block of M12 (clamps) or M13. Raises ProgramError where it may not open while the spindle turns."""
    opens = made.m == 13
    assert made.m_code is not None
    check_when(state, made, made.m_code)
    state.adopt(state.modal._replace(collet_closed=not opens))
    yield _done(state, made, actions.Collet(closed=not opens))


def wait_for_input(state: State, made: Statement) -> Iterator[Block]:
    """The block of M91 to M94: wait until the terminal is open or closed."""
    assert made.m_code is not None
    yield _done(state, made, actions.WaitInput(*made.m_code.terminal))


def program_stop(state: State, made: Statement) -> Iterator[Block]:
    """The block of M00 or M01, with the comment that the operator is shown."""
    yield _done(state, made, actions.ProgramStop(optional=made.m == 1, message=(made.comment or "").strip()))


def repeat_off(state: State, made: Statement) -> Iterator[Block]:
    """The block of M31: cancels Cycle Repeat."""
    yield _done(state, made, actions.RepeatOff())


def program_end(state: State, made: Statement) -> Iterator[Block]:
    """The block of M30, which resets the M functions, or M02, which leaves them."""
    reset = made.m == 30
    warn_of_short_dwell(state)
    state.stay(after_end(state.modal, abs(state.rpm_at(state.x)), reset=reset))
    yield _done(state, made, actions.ProgramEnd(reset=reset))


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
    habit, hint = other_controls.meaning_here(name) or ("", "The machine file assigns the outputs.")
    text = f"{name} is no code of this machine. {habit}".rstrip()
    return refusal(made.line, column, "m-unknown", text, hint)


def _done(state: State, made: Statement, action: actions.Action) -> Block:
    return state.action(made.line, made.part("m"), action)


def _machine_output(state: State, made: Statement, *, on: bool) -> Iterator[Block]:
    """An M code of the machine file: an output switched on before the motion, or off after it."""
    output = state.setup.limits.m_outputs.get(made.m or 0)
    if output is None:
        raise ProgramError(_unknown(state, made))
    name, wanted = output
    if wanted is on:
        outputs = state.modal.outputs | {name} if on else state.modal.outputs - {name}
        state.adopt(state.modal._replace(outputs=outputs))
        yield _done(state, made, actions.Output(name, on))
