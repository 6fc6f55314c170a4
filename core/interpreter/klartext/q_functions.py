"""Q parameters while a program runs: what they hold, and what formulas come to."""

from __future__ import annotations

from collections.abc import Callable

from core.interpreter.formula_values import worth
from core.interpreter.klartext.klartext_state import State
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter
from core.language.klartext.cycle_blocks import PREDEFINED
from core.language.klartext.klartext_faults import ARITHMETIC, CYCLE_MISSING, INPUT_VALUE, MissingValueError
from core.language.klartext.q_parameters import WHETHER
from core.message import Message

MOST_Q = 999_999_999.999999
SMALLEST = 1e-9  # a result nearer to 0 is what rounding has left of 0

OF_THE_CONTROL: dict[int, Callable[[State], float]] = {
    108: lambda state: state.tool_radius / state.scale,
    109: lambda state: 2.0 if state.tool_axis else -1.0,
    110: lambda state: {1: 0.0, -1: 1.0, 0: -1.0}[state.modal.spindle],
    111: lambda state: 1.0 if state.modal.coolant else 0.0,
    113: lambda state: 0.0 if state.scale == 1.0 else 1.0,
    114: lambda state: state.tool_length / state.scale,
}
"""Parameters that the control itself keeps up to date."""


def held(state: State, kind: str, number: int) -> float | None:
    """What a parameter holds; None where nothing has given it a value."""
    if kind != "Q":
        return state.q_beside.get((kind, number))
    kept = OF_THE_CONTROL.get(number)
    return state.q.get(number) if kept is None else kept(state)


def content(state: State, kind: str, number: int, column: int) -> float:
    """What a parameter holds. Raises ProgramError where nothing has given it a value."""
    found = held(state, kind, number)
    if found is None:
        raise MissingValueError(state.line, column, (kind, number))
    return found


def _predefined(state: State, number: int, column: int) -> float:
    """What GLOBAL DEF has told for a parameter of cycles. Raises ProgramError where none has."""
    if number not in state.q_global:
        text = Message(
            "Q{number}=PREDEF, but no GLOBAL DEF defines Q{number2}.", number=number, number2=number
        )
        raise state.refuse(
            column, CYCLE_MISSING, text, "Write GLOBAL DEF before this block, or enter a number."
        )
    return state.q_global[number]


def value(state: State, formula: Formula) -> float:
    """What a formula comes to. Raises ProgramError where it has no value, or one out of range."""

    def parameter(asked: Parameter) -> float:
        assert isinstance(asked.number, int)  # Q has no computed numbers
        if asked.letters == PREDEFINED:
            return _predefined(state, asked.number, asked.column)
        if asked.letters.endswith(WHETHER):
            return float(held(state, asked.letters.removesuffix(WHETHER), asked.number) is not None)
        return content(state, asked.letters, asked.number, asked.column)

    def no_value(column: int, why: str) -> ProgramError:
        text = Message("{what}.", what=why)
        return state.of_the_place(state.refuse(column, ARITHMETIC, text, "Correct the formula."))

    found = worth(formula, parameter, no_value)
    if abs(found) > MOST_Q:
        text = Message(
            "The result {value} exceeds the limit of {most_q}.", value=f"{found:g}", most_q=f"{MOST_Q:.15g}"
        )
        raise state.refuse(1, INPUT_VALUE, text, "Correct the formula.")
    return 0.0 if abs(found) < SMALLEST else found


def keep(state: State, kind: str, number: int, found: float) -> None:
    """The parameter holds this from now on."""
    if kind == "Q":
        state.q[number] = found
    else:
        state.q_beside[kind, number] = found
