"""Evaluation of formulas with floating-point numbers and angles in degrees."""

from __future__ import annotations

import math
from collections.abc import Callable

from core.geometry.rotation_frames import compute_exact_cos_sin
from core.language.diagnostics import ProgramError
from core.language.formulas import Formula, Number, Operation, Parameter
from core.message import Message

MissingValueFactory = Callable[[int, str], ProgramError]
"""Function that makes the error for an operation without a value, from its column and the reason."""


def compute_formula(
    formula: Formula, get_parameter: Callable[[Parameter], float], make_missing_error: MissingValueFactory
) -> float:
    """Return the value of a formula.

    ``get_parameter`` returns the value of a parameter. If an operation has no result, such as a division by
    0, the function raises the error that ``make_missing_error`` returns.
    """
    if isinstance(formula, Number):
        return formula.value
    if isinstance(formula, Parameter):
        return get_parameter(formula)
    operands = [compute_formula(each, get_parameter, make_missing_error) for each in formula.operands]
    try:
        found = OPERATIONS[formula.name](*operands)
    except ZeroDivisionError:
        raise make_missing_error(formula.column, "The formula divides by zero") from None
    except (ValueError, OverflowError):
        raise make_missing_error(formula.column, _undefined(formula, operands)) from None
    except TypeError:
        raise make_missing_error(formula.column, "A function has too few or too many arguments") from None
    if not math.isfinite(found):
        raise make_missing_error(formula.column, "The result is too large")
    return found


def _undefined(formula: Operation, operands: list[float]) -> str:
    return Message(
        "{formula} of {item} is undefined",
        formula=formula.name,
        item=", ".join(f"{each:g}" for each in operands),
    )


def _tangent(degrees: float) -> float:
    cosine, sine = compute_exact_cos_sin(degrees)
    return sine / cosine


def _vector_angle(opposite: float, adjacent: float) -> float:
    """Return the angle of a vector in degrees, from 0 to less than 360."""
    return math.degrees(math.atan2(opposite, adjacent)) % 360.0


def _power(base: float, exponent: float) -> float:
    return math.pow(base, exponent)


_TRUTH = 1e-12  # numbers with a smaller difference are equal

_ROUNDING_ERROR = 1e-9


def convert_to_whole_number(value: float) -> int | None:
    """Return the nearest whole number, or None if the value differs by more than rounding errors."""
    nearest = round(value)
    return nearest if abs(value - nearest) <= _ROUNDING_ERROR else None


OPERATIONS: dict[str, Callable[..., float]] = {
    "plus": lambda a, b: a + b,
    "minus": lambda a, b: a - b,
    "times": lambda a, b: a * b,
    "over": lambda a, b: a / b,
    "power": _power,
    "modulo": lambda a, b: a - b * math.floor(a / b),
    "integer quotient": lambda a, b: float(math.trunc(a / b)),
    "negative": lambda a: -a + 0.0,
    "square": lambda a: a * a,
    "square root": math.sqrt,
    "sine": lambda a: compute_exact_cos_sin(a)[1],
    "cosine": lambda a: compute_exact_cos_sin(a)[0],
    "tangent": _tangent,
    "arc sine": lambda a: math.degrees(math.asin(a)),
    "arc cosine": lambda a: math.degrees(math.acos(a)),
    "arc tangent": lambda a: math.degrees(math.atan(a)),
    "angle": _vector_angle,
    "natural logarithm": math.log,
    "common logarithm": math.log10,
    "exponential": math.exp,
    "integer part": lambda a: float(math.trunc(a)),
    "fraction": lambda a: a - math.trunc(a),
    "absolute": abs,
    "sign": lambda a: math.copysign(1.0, a) if a else 0.0,
    "length": math.hypot,
    "equal": lambda a, b: float(abs(a - b) <= _TRUTH),
    "unequal": lambda a, b: float(abs(a - b) > _TRUTH),
    "greater": lambda a, b: float(a > b),
    "less": lambda a, b: float(a < b),
    "greater than or equal": lambda a, b: float(a >= b - _TRUTH),
    "less than or equal": lambda a, b: float(a <= b + _TRUTH),
    "and": lambda a, b: float(bool(a) and bool(b)),
    "or": lambda a, b: float(bool(a) or bool(b)),
    "exclusive or": lambda a, b: float(bool(a) != bool(b)),
    "not": lambda a: float(not a),
    "remainder": math.fmod,
    "direction": lambda a, b: math.degrees(math.atan2(a, b)),
    "nearest whole number": lambda a: float(math.floor(a + 0.5)),
    "smaller": min,
    "larger": max,
}
"""Function of each formula operation, by name. Angles are in degrees."""
