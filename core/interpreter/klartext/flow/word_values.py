"""Evaluation of program words: Q parameters, formulas, permitted ranges, and lengths in mm."""

from __future__ import annotations

from collections.abc import Callable

from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.motion.feed_rates import MAX_FEED, REVOLUTION, convert_to_feed_per_minute
from core.interpreter.shared.formula_values import compute_formula, convert_to_whole_number
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Parameter
from core.language.klartext.cycle_blocks import PREDEFINED_WORD
from core.language.klartext.klartext_faults import (
    ARITHMETIC_ERROR,
    CYCLE_MISSING,
    FEED_MISSING,
    INPUT_VALUE_INCORRECT,
    MissingValueError,
)
from core.language.klartext.klartext_words import AxisWord, FeedWord, Value
from core.language.klartext.q_parameters import CONDITION_OPERATOR
from core.message import Message

MAX_Q_VALUE = 999_999_999.999999
MIN_RESULT = 1e-9  # a result closer to 0 counts as 0

CONTROL_Q_PARAMETERS: dict[int, Callable[[State], float]] = {
    108: lambda state: state.tool_radius_mm / state.mm_per_unit,
    109: lambda state: 2.0 if state.tool_axis else -1.0,
    110: lambda state: {1: 0.0, -1: 1.0, 0: -1.0}[state.modal.spindle],
    111: lambda state: 1.0 if state.modal.coolant else 0.0,
    113: lambda state: 0.0 if state.mm_per_unit == 1.0 else 1.0,
    114: lambda state: state.tool_length_mm / state.mm_per_unit,
}
"""Functions that return the Q parameters set by the control, by parameter number."""


def held(state: State, kind: str, number: int) -> float | None:
    """Return the current value of a Q, QL or QR parameter, or None if no value has been assigned."""
    if kind != "Q":
        return state.ql_and_qr_values.get((kind, number))
    kept = CONTROL_Q_PARAMETERS.get(number)
    return state.q_values.get(number) if kept is None else kept(state)


def read_parameter(state: State, kind: str, number: int, column: int) -> float:
    """Return the value of a Q, QL or QR parameter. Raises MissingValueError if it has no value."""
    found = held(state, kind, number)
    if found is None:
        raise MissingValueError(state.line_number, column, (kind, number))
    return found


def _predefined(state: State, number: int, column: int) -> float:
    """Return the GLOBAL DEF value of a cycle parameter.

    Raises ProgramError if GLOBAL DEF does not define it.
    """
    if number not in state.global_def_values:
        text = Message(
            "Q{number}=PREDEF, but no GLOBAL DEF defines Q{number2}.", number=number, number2=number
        )
        raise state.make_error(
            column, CYCLE_MISSING, text, "Write GLOBAL DEF before this block, or enter a number."
        )
    return state.global_def_values[number]


def value(state: State, formula: Formula) -> float:
    """Return the value of a formula. Raises ProgramError if the formula has no value or is out of range."""

    def evaluate_parameter(asked: Parameter) -> float:
        assert isinstance(asked.number, int)  # Q parameters have no computed numbers
        if asked.letters == PREDEFINED_WORD:
            return _predefined(state, asked.number, asked.column)
        if asked.letters.endswith(CONDITION_OPERATOR):
            return float(
                held(state, asked.letters.removesuffix(CONDITION_OPERATOR), asked.number) is not None
            )
        return read_parameter(state, asked.letters, asked.number, asked.column)

    def make_formula_error(column: int, why: str) -> ProgramError:
        text = Message("{what}.", what=why)
        return state.mark_position_error(
            state.make_error(column, ARITHMETIC_ERROR, text, "Correct the formula.")
        )

    found = compute_formula(formula, evaluate_parameter, make_formula_error)
    if abs(found) > MAX_Q_VALUE:
        text = Message(
            "The result {value} exceeds the limit of {most_q}.",
            value=f"{found:g}",
            most_q=f"{MAX_Q_VALUE:.15g}",
        )
        raise state.make_error(1, INPUT_VALUE_INCORRECT, text, "Correct the formula.")
    return 0.0 if abs(found) < MIN_RESULT else found


def set_parameter(state: State, kind: str, number: int, new_value: float) -> None:
    """Set the value of a Q, QL or QR parameter."""
    if kind == "Q":
        state.q_values[number] = new_value
    else:
        state.ql_and_qr_values[kind, number] = new_value


# Input ranges of the control's manuals.
MAX_AXIS_ANGLE_DEG = 99_999_999.9999999  # PLANE AXIAL
MAX_POINT_COORDINATE = 999_999_999.999999  # PLANE POINTS
MAX_SPATIAL_ANGLE_DEG = 359.9999
MAX_COORDINATE = 99_999.9999
MAX_SPEED_RPM = 99_999.999


def number(
    state: State, value: Value, description: str, maximum: float, minimum: float | None = None
) -> float:
    """Return the number of a word, or the value of its Q parameter.

    Raises ProgramError if the value is not from ``minimum`` to ``maximum``, or if the Q parameter has no
    value. Without ``minimum``, the lower limit is -``maximum``.
    """
    found = value.number
    if value.parameter_number is not None:
        found = read_parameter(state, value.parameter_kind, value.parameter_number, value.column)
        found = -found if value.is_negative else found
    low = -maximum if minimum is None else minimum
    if not low <= found <= maximum:
        raise state.make_error(
            value.column,
            INPUT_VALUE_INCORRECT,
            "{what} {value} is not between {low} and {maximum}.",
            "Correct the value.",
            what=description,
            value=f"{found:+.12g}",
            low=f"{low:.15g}",
            maximum=f"{maximum:.15g}",
        )
    return found


def whole_number(state: State, value: Value, description: str, maximum: float) -> int:
    """Return the whole number of a word, or of its Q parameter.

    Raises ProgramError if the value is not a whole number from 0 to ``maximum``, or if the Q parameter has
    no value.
    """
    return check_whole_number(
        state, number(state, value, description, maximum, 0.0), description, value.column
    )


def check_whole_number(state: State, found: float, description: str, column: int) -> int:
    """Return a value as a whole number. Raises ProgramError if it is not whole."""
    whole = convert_to_whole_number(found)
    if whole is None:
        text = "{what} {value} must be a whole number."
        raise state.make_error(
            column, INPUT_VALUE_INCORRECT, text, "Correct the value.", what=description, value=found
        )
    return whole


def evaluate_coordinate(state: State, word: AxisWord) -> float:
    """Return the value of an axis word in mm, or in degrees for a rotary axis."""
    found = number(state, word.value, word.axis, MAX_COORDINATE)
    return found if word.axis in "ABC" else found * state.mm_per_unit


def evaluate_length_mm(state: State, value: Value | None, description: str) -> float:
    """Return an unsigned length in mm, or 0 if ``value`` is None."""
    return (
        0.0 if value is None else number(state, value, description, MAX_COORDINATE, 0.0) * state.mm_per_unit
    )


def evaluate_feed(state: State, feed: FeedWord | None, column: int) -> float | None:
    """Return the programmed feed per minute, or None for a rapid.

    The unit is mm, or tenths of an inch in an INCH program. Without an F word, the active feed is returned.
    Raises ProgramError in these cases:
    - No feed is active, or the feed is not above 0.
    - FAUTO is programmed, but the last TOOL CALL has no F.
    - A feed per revolution or per tooth cannot be converted, because the spindle is stopped,
      the number of teeth is unknown, or the result is too high.
    """
    found = read_programmed_feed(state, feed, column)
    return (
        None
        if found is None
        else convert_to_feed_per_minute(state, *found, column if feed is None else feed.column)
    )


def read_programmed_feed(state: State, feed: FeedWord | None, column: int) -> tuple[float, str] | None:
    """Return F as programmed and its reference, or None for a rapid.

    The reference is U for a feed per revolution, Z for a feed per tooth, or an empty string for a feed per
    minute.
    """
    if feed is None:
        if state.feed is None:
            raise _missing(state, column, "No feed rate is active.", "Write F or FMAX.")
        return state.feed, state.feed_base
    if feed.feed_kind == "max":
        return None
    if feed.feed_kind == "auto":
        if state.tool_feed is None:
            raise _missing(state, feed.column, "The last TOOL CALL has no F.", "Program F in TOOL CALL.")
        return state.tool_feed, state.tool_feed_base
    assert feed.value is not None
    found = number(state, feed.value, "F", MAX_FEED, 0.0)
    if found <= 0.0:
        raise state.make_error(
            feed.column, INPUT_VALUE_INCORRECT, "F must be above zero.", "Enter a feed rate."
        )
    return found, feed.feed_unit_letter or (REVOLUTION if state.is_feed_per_revolution else "")


def _missing(state: State, column: int, text: str, hint: str) -> ProgramError:
    return state.make_error(column, FEED_MISSING, text, hint)
