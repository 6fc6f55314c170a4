"""Parsing of the values of SINUMERIK words, which are numbers or formulas, and checks of their ranges."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError, Number, Operation, Parameter
from core.language.sinumerik import sinumerik_words as known
from core.language.sinumerik.block_reader import MAX_R_NUMBER, parse_formula
from core.language.sinumerik.sinumerik_words import Word
from core.message import Message

R_PARAMETER_PATTERN = re.compile(r"R([0-9]+)")
_MAX_CODE_LENGTH = 4  # digits


class ParsedValue(NamedTuple):
    """A number or a formula, and the index after it in the text."""

    number: float | None
    formula: Formula | None
    end_index: int


def parse_value(text: str, index: int) -> ParsedValue:
    """Return the value that starts at this index.

    Raises FormulaError if no valid value starts there, or if a formula contains an R parameter that does
    not exist.
    """
    made, end = parse_formula(text, index)
    match made:
        case Number(value):
            return ParsedValue(value, None, end)
        case Operation("negative", (Number(value),)):
            return ParsedValue(-value, None, end)
        case _:
            check_parameter_numbers(made, index)
            return ParsedValue(None, made, end)


def check_parameter_numbers(formula: Formula, index: int) -> None:
    """Raise FormulaError if a formula contains an R parameter that does not exist."""
    match formula:
        case Parameter("R", int(number), column) if number > MAX_R_NUMBER:
            raise FormulaError(
                column - 1,
                Message("R{number} is not a valid parameter", number=number),
                Message("Use a parameter from R0 to R{most_r}.", most_r=MAX_R_NUMBER),
            )
        case Operation(_, operands):
            for each in operands:
                check_parameter_numbers(each, index)


def is_variable(name: str) -> bool:
    """Return whether the name is an R parameter or a variable of the program."""
    return R_PARAMETER_PATTERN.fullmatch(name) is not None or (len(name) > 1 and name not in known.VOCABULARY)


def find_range_error(word: Word) -> tuple[str, str] | None:
    """Return the message and hint for an invalid number of a word, or None if the number is valid."""
    if word.value is None:
        return None
    if word.name in {"G", "M"}:
        digits = word.text.rpartition("=")[2] if "=" in word.text else word.text[1:]
        if digits.isdigit() and len(digits) <= _MAX_CODE_LENGTH:
            return None
        return Message(
            "{word} is not a valid code", word=word.text
        ), "Write a whole number of up to four digits."
    if word.name in {"T", "D"} and not word.value.is_integer():
        return Message("{word} is not a valid tool or edge number", word=word.text), "Enter a whole number."
    limits = find_violated_limits(word.name, word.value)
    if limits is None:
        return None
    return Message("{word} is out of range", word=word.text), make_limit_hint(word.name, limits)


def find_violated_limits(name: str, value: float) -> tuple[float, float] | None:
    """Return the limits of a word that the value violates, or None if the value is valid.

    A variable has the limits of an R parameter.
    """
    low, high = known.VALUE_RANGES.get(name, known.VALUE_RANGES["R"])
    return None if low <= value <= high else (low, high)


def make_limit_hint(name: str, limits: tuple[float, float]) -> str:
    """Return the remedy for a value outside the limits of a word; it names the limits."""
    low, high = limits
    return Message(
        "Use a value of {word} between {low} and {high}.", word=name, low=f"{low:g}", high=f"{high:g}"
    )
