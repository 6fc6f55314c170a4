"""Values of SINUMERIK words, which are numbers or formulas, and the checks of their ranges."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError, Number, Operation, Parameter
from core.language.sinumerik import sinumerik_words as known
from core.language.sinumerik.block_reader import formula_at
from core.language.sinumerik.sinumerik_words import Word
from core.message import Message

PARAMETER = re.compile(r"R([0-9]+)")
_LONGEST_CODE = 4  # digits


class Value(NamedTuple):
    """A number or a formula, and the index after it."""

    number: float | None
    formula: Formula | None
    end: int


def value_at(text: str, at: int) -> Value:
    """Return the value that starts at this index. Raises FormulaError without a value."""
    made, end = formula_at(text, at)
    match made:
        case Number(value):
            return Value(value, None, end)
        case Operation("negative", (Number(value),)):
            return Value(-value, None, end)
        case _:
            demand_parameters(made, at)
            return Value(None, made, end)


def demand_parameters(formula: Formula, at: int) -> None:
    """Raise FormulaError if a formula contains an R parameter that does not exist."""
    match formula:
        case Parameter("R", int(number), column) if number > known.MOST_R:
            raise FormulaError(
                column - 1,
                Message("R{number} is not a valid parameter", number=number),
                Message("Use a parameter from R0 to R{most_r}.", most_r=known.MOST_R),
            )
        case Operation(_, operands):
            for each in operands:
                demand_parameters(each, at)


def variable(name: str) -> bool:
    """Return whether a word assigns an R parameter or a variable of the program."""
    return PARAMETER.fullmatch(name) is not None or (len(name) > 1 and name not in known.VOCABULARY)


def beyond(word: Word) -> tuple[str, str] | None:
    """Return the message and hint for an invalid number of a word; None if the number is valid."""
    if word.value is None:
        return None
    if word.name in {"G", "M"}:
        digits = word.text.rpartition("=")[2] if "=" in word.text else word.text[1:]
        if digits.isdigit() and len(digits) <= _LONGEST_CODE:
            return None
        return Message(
            "{word} is not a valid code", word=word.text
        ), "Write a whole number of up to four digits."
    if word.name in {"T", "D"} and not word.value.is_integer():
        return Message("{word} is not a valid tool or edge number", word=word.text), "Enter a whole number."
    low, high = known.REACH.get(word.name, known.REACH["R"])  # a variable has the range of an R parameter
    if low <= word.value <= high:
        return None
    return Message("{word} is out of range", word=word.text), (
        Message(
            "Use a value of {word} between {low} and {high}.",
            word=word.name,
            low=f"{low:g}",
            high=f"{high:g}",
        )
    )
