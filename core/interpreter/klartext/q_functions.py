"""Q parameters while a program runs: what they hold, formulas, jumps, figures of the control (FN 18)."""

from __future__ import annotations

from collections.abc import Callable

from core.interpreter.formula_values import NoValueError, worth
from core.interpreter.klartext.klartext_state import State
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter
from core.language.klartext.klartext_faults import (
    ARITHMETIC,
    INPUT_VALUE,
    OWN_ERROR,
    Q_UNDEFINED,
    unsupported,
)
from core.language.klartext.klartext_nodes import Assign, ErrorMessage, Jump, SystemRead

MOST_Q = 999_999_999.999999
SMALLEST = 1e-9  # a result nearer to 0 is what rounding has left of 0

# Parameters that the control itself keeps up to date.
_OF_THE_CONTROL: dict[int, Callable[[State], float]] = {
    108: lambda state: state.tool_radius / state.scale,
    109: lambda state: 2.0 if state.tool_axis else -1.0,
    110: lambda state: {1: 0.0, -1: 1.0, 0: -1.0}[state.modal.spindle],
    111: lambda state: 1.0 if state.modal.coolant else 0.0,
    113: lambda state: 0.0 if state.scale == 1.0 else 1.0,
    114: lambda state: state.tool_length / state.scale,
}


def content(state: State, kind: str, number: int, column: int) -> float:
    """What a parameter holds. Raises ProgramError where nothing has given it a value."""
    if kind != "Q":
        if (kind, number) in state.q_beside:
            return state.q_beside[kind, number]
    elif number in _OF_THE_CONTROL:
        return _OF_THE_CONTROL[number](state)
    elif number in state.q:
        return state.q[number]
    text = f"{kind}{number} has no value yet."
    raise state.refuse(column, Q_UNDEFINED, text, f"Write {kind}{number} = … before.")


def value(state: State, formula: Formula) -> float:
    """What a formula comes to. Raises ProgramError where it has no value, or one out of range."""

    def parameter(asked: Parameter) -> float:
        assert isinstance(asked.number, int)  # Q has no computed numbers
        return content(state, asked.letters, asked.number, asked.column)

    try:
        found = worth(formula, parameter)
    except NoValueError as problem:
        raise state.refuse(problem.column, ARITHMETIC, f"{problem}.", "Correct the formula.") from None
    if abs(found) > MOST_Q:
        text = f"The result {found:g} is larger than {MOST_Q:.15g}."
        raise state.refuse(1, INPUT_VALUE, text, "Correct the formula.")
    return 0.0 if abs(found) < SMALLEST else found


def assign(state: State, node: Assign) -> None:
    """``Q5 = …``. Raises ProgramError."""
    keep(state, node.kind, node.q, value(state, node.formula))


def keep(state: State, kind: str, number: int, found: float) -> None:
    """The parameter holds this from now on."""
    if kind == "Q":
        state.q[number] = found
    else:
        state.q_beside[kind, number] = found


def jumps(state: State, node: Jump) -> bool:
    """Whether the comparison of FN 9 to FN 12 holds."""
    return value(state, node.condition) != 0.0


def own_error(state: State, node: ErrorMessage) -> ProgramError:
    """FN 14: the fault that the program itself tells, and stops at."""
    text = f"The program tells its error {node.number} and stops."
    return state.refuse(node.column, OWN_ERROR, text, "Look at the conditions before this block.")


_POSITIONS = {1: "X", 2: "Y", 3: "Z", 4: "A", 5: "B", 6: "C"}


def read_system(state: State, node: SystemRead) -> None:
    """FN 18. Raises ProgramError for figures that this control has not."""
    group, number = int(value(state, node.group)), int(value(state, node.number))
    index = int(value(state, node.index)) if node.index is not None else 0
    keep(state, node.kind, node.q, _figure(state, node.column, group, number, index))


def _figure(state: State, column: int, group: int, number: int, index: int) -> float:
    known: dict[tuple[int, int], Callable[[], float]] = {
        (20, 1): lambda: float(state.modal.tool),
        (20, 3): lambda: 2.0,
        (20, 4): lambda: state.modal.rpm,
        (20, 5): lambda: _OF_THE_CONTROL[110](state),
        (20, 8): lambda: _OF_THE_CONTROL[111](state),
        (20, 9): lambda: state.feed or 0.0,
        (50, 1): lambda: state.tool_length / state.scale,
        (50, 2): lambda: state.tool_radius / state.scale,
    }
    if (group, number) in known and (group != 50 or index in {0, state.modal.tool}):
        return known[group, number]()
    if (group, number) == (240, 1) and _POSITIONS.get(index) in state.at:
        return state.at[_POSITIONS[index]] / (state.scale if index <= 3 else 1.0)
    if (group, number) == (270, 1) and index in {1, 2, 3}:
        return state.programmed[index - 1] / state.scale
    raise unsupported(state.line, column, f"FN 18 with ID{group} NR{number} IDX{index}")
