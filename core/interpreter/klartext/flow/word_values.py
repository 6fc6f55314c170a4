"""Conversion of words to numbers: Q parameters, formulas, input ranges, and lengths in mm."""

from __future__ import annotations

from collections.abc import Callable

from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.feed_rates import MOST_FEED, REVOLUTION, per_minute
from core.interpreter.shared.formula_values import worth
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter
from core.language.klartext.cycle_blocks import PREDEFINED
from core.language.klartext.klartext_faults import (
    ARITHMETIC,
    CYCLE_MISSING,
    FEED_MISSING,
    INPUT_VALUE,
    MissingValueError,
)
from core.language.klartext.klartext_nodes import AxisWord, Feed, Value
from core.language.klartext.q_parameters import WHETHER
from core.message import Message

MOST_Q = 999_999_999.999999
SMALLEST = 1e-9  # a result closer to 0 counts as 0

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
    """Return the value of a parameter; None if it has no value."""
    if kind != "Q":
        return state.q_beside.get((kind, number))
    kept = OF_THE_CONTROL.get(number)
    return state.q.get(number) if kept is None else kept(state)


def content(state: State, kind: str, number: int, column: int) -> float:
    """Return the value of a parameter. Raises ProgramError if it has no value."""
    found = held(state, kind, number)
    if found is None:
        raise MissingValueError(state.line, column, (kind, number))
    return found


def _predefined(state: State, number: int, column: int) -> float:
    """Return the value of GLOBAL DEF for a cycle parameter. Raises ProgramError without one."""
    if number not in state.q_global:
        text = Message(
            "Q{number}=PREDEF, but no GLOBAL DEF defines Q{number2}.", number=number, number2=number
        )
        raise state.refuse(
            column, CYCLE_MISSING, text, "Write GLOBAL DEF before this block, or enter a number."
        )
    return state.q_global[number]


def value(state: State, formula: Formula) -> float:
    """Return the value of a formula. Raises ProgramError if it has no value or is out of range."""

    def parameter(asked: Parameter) -> float:
        assert isinstance(asked.number, int)  # Q parameters have no computed numbers
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
    """Set the value of a parameter."""
    if kind == "Q":
        state.q[number] = found
    else:
        state.q_beside[kind, number] = found


# Input ranges of the control's manuals.
MOST_ANGLE = 99_999_999.9999999  # PLANE AXIAL
MOST_POINT = 999_999_999.999999  # PLANE POINTS
MOST_SPATIAL = 359.9999
MOST_COORDINATE = 99_999.9999
MOST_SPEED = 99_999.999


def number(state: State, value: Value, what: str, most: float, least: float | None = None) -> float:
    """Return the number or the Q parameter value.

    Raises ProgramError outside ±``most`` or below ``least``.
    """
    found = value.number
    if value.q is not None:
        found = content(state, value.kind, value.q, value.column)
        found = -found if value.negative else found
    low = -most if least is None else least
    if not low <= found <= most:
        raise state.refuse(
            value.column,
            INPUT_VALUE,
            "{what} {value} is not between {low} and {maximum}.",
            "Correct the value.",
            what=what,
            value=f"{found:+.12g}",
            low=f"{low:.15g}",
            maximum=f"{most:.15g}",
        )
    return found


def coordinate(state: State, word: AxisWord) -> float:
    """Return the value of an axis word in mm, or in degrees for a rotary axis."""
    found = number(state, word.value, word.axis, MOST_COORDINATE)
    return found if word.axis in "ABC" else found * state.scale


def length(state: State, value: Value | None, what: str) -> float:
    """Return an unsigned length in mm; 0 without a value."""
    return 0.0 if value is None else number(state, value, what, MOST_COORDINATE, 0.0) * state.scale


def feed_word(state: State, feed: Feed | None, column: int) -> float | None:
    """Return F per minute in its unit, or None for a rapid; without a word, the active feed.

    Raises ProgramError without a feed, for a feed that is not above 0, and for a feed per revolution with the
    spindle stopped.
    """
    found = programmed_feed(state, feed, column)
    return None if found is None else per_minute(state, *found, column if feed is None else feed.column)


def programmed_feed(state: State, feed: Feed | None, column: int) -> tuple[float, str] | None:
    """Return F as programmed and its base (U per revolution, Z per tooth); None for a rapid."""
    if feed is None:
        if state.feed is None:
            raise _missing(state, column, "No feed rate is active.", "Write F or FMAX.")
        return state.feed, state.feed_per
    if feed.kind == "max":
        return None
    if feed.kind == "auto":
        if state.tool_feed is None:
            raise _missing(state, feed.column, "The last TOOL CALL has no F.", "Program F in TOOL CALL.")
        return state.tool_feed, state.tool_feed_per
    assert feed.value is not None
    found = number(state, feed.value, "F", MOST_FEED, 0.0)
    if found <= 0.0:
        raise state.refuse(feed.column, INPUT_VALUE, "F must be above zero.", "Enter a feed rate.")
    return found, feed.per or (REVOLUTION if state.per_revolution else "")


def _missing(state: State, column: int, text: str, hint: str) -> ProgramError:
    return state.refuse(column, FEED_MISSING, text, hint)
