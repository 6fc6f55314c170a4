"""Formulas of programs, with numbers, parameters, operators with precedence, and functions.

Each dialect defines its own ``FormulaGrammar``. The parsed formulas have the same form in all dialects and
are evaluated by ``core.interpreter.shared.formula_values``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from core.language.line_reading import LineReader


class Number(NamedTuple):
    """A number in a formula."""

    value: float


class Parameter(NamedTuple):
    """A parameter in a formula, with its letters, its number or index if any, and its column from 1.

    The letters are ``Q``, ``R`` or the name of a variable.
    """

    letters: str
    number: int | Formula | None
    column: int


class Operation(NamedTuple):
    """An operator or function with its operands; ``name`` is a key of ``OPERATIONS``."""

    name: str
    operands: tuple[Formula, ...]
    column: int


Formula = Number | Parameter | Operation
INDEX_OPERATION = "indices"
"""Name of the operation for several indexes of one element. The operation has no value."""
FUNCTION_OPERATIONS = {
    "SIN": "sine",
    "COS": "cosine",
    "TAN": "tangent",
    "ASIN": "arc sine",
    "ACOS": "arc cosine",
    "SQRT": "square root",
    "ABS": "absolute",
    "LN": "natural logarithm",
    "EXP": "exponential",
}
"""Formula functions with the same name in every program language, by name."""


def get_index_formulas(index: Formula) -> tuple[Formula, ...]:
    """Return the formulas of an index in square brackets, with one formula for each dimension."""
    return index.operands if isinstance(index, Operation) and index.name == INDEX_OPERATION else (index,)


class FormulaError(Exception):
    """Error for invalid syntax in a formula.

    ``index`` is the index of the error in the text, and ``str()`` returns the message.
    """

    def __init__(self, index: int, message: str, hint: str) -> None:
        super().__init__(message)
        self.index = index
        self.hint = hint


@dataclass(frozen=True)
class FormulaGrammar:
    """The notation of formulas in a dialect, in capitals.

    - ``number_pattern`` and ``parameter_pattern`` match one operand. The groups of the parameter pattern
      are the letters and the number of the parameter.
    - ``operators`` maps each operator to its precedence and name; a higher value binds more tightly.
    - ``functions`` maps functions to names, and ``constants`` maps constants to values.
    - ``operand_separator`` separates the operands of a function. If it is empty, each function has one
      operand without parentheses.
    """

    number_pattern: re.Pattern[str]
    parameter_pattern: re.Pattern[str]
    operators: Mapping[str, tuple[int, str]]
    functions: Mapping[str, str]
    constants: Mapping[str, float] = field(default_factory=dict)
    operand_separator: str = ""
    negation_precedence: int = 50  # precedence of a sign before an operand
    has_index: bool = False  # the number of a parameter may be a formula in square brackets
    _sign: re.Pattern[str] = field(init=False, repr=False)
    _word: re.Pattern[str] = field(init=False, repr=False)
    _constant: re.Pattern[str] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_sign", _any_of(self.operators))
        object.__setattr__(self, "_word", _any_of(self.functions))
        object.__setattr__(self, "_constant", _any_of(self.constants))

    def find_operator(self, text: str, index: int) -> str | None:
        """Return the operator at this index, or None if the text there is not an operator."""
        match = self._sign.match(text, index)
        return match.group() if match else None

    def find_function(self, text: str, index: int) -> str | None:
        """Return the function at this index, or None if the text there is not a function."""
        match = self._word.match(text, index)
        return match.group() if match else None

    def find_constant(self, text: str, index: int) -> str | None:
        """Return the constant at this index, or None if the text there is not a constant."""
        match = self._constant.match(text, index)
        return match.group() if match else None


def _any_of(words: Mapping[str, object]) -> re.Pattern[str]:
    """Return a pattern that matches the longest of these words and requires that no letter follows."""
    if not words:
        return re.compile(r"(?!)")
    ordered = sorted(words, key=len, reverse=True)
    return re.compile(
        "|".join(
            re.escape(word) + ("(?![A-Z_])" if word.isalpha() else _OPERATOR_LOOKAHEADS.get(word, ""))
            for word in ordered
        )
    )


_OPERATOR_LOOKAHEADS = {"<": "(?!<)"}  # << concatenates strings


_HIGHEST_PRECEDENCE = 1000
_MAX_DEPTH = 40


class FormulaReader(LineReader):
    """Parser of one formula in ``uppercase_text``, which starts at ``index``.

    After parsing, ``index`` is the index after the formula.
    """

    def __init__(self, grammar: FormulaGrammar, uppercase_text: str, index: int) -> None:
        self.uppercase_text, self.index = uppercase_text, index
        self._grammar = grammar
        self._depth = 0

    def read_formula(self) -> Formula:
        """Read and return the formula. Raises FormulaError if the formula is incomplete or invalid."""
        return self._expression(0)

    def _expression(self, weakest: int) -> Formula:
        """Read an expression from left to right; operators below the precedence ``weakest`` end it."""
        self._depth += 1
        if self._depth > _MAX_DEPTH:
            raise FormulaError(
                self.index, "The formula is nested too deeply", "Split the formula into several assignments."
            )
        made = self._operand()
        while (sign := self._operator()) is not None:
            power, name = self._grammar.operators[sign]
            if power < weakest:
                break
            column = self.index + 1
            self.index += len(sign)
            made = Operation(name, (made, self._expression(power + 1)), column)
        self._depth -= 1
        return made

    def _operator(self) -> str | None:
        self.skip_blanks()
        return self._grammar.find_operator(self.uppercase_text, self.index)

    def _operand(self) -> Formula:
        self.skip_blanks()
        at = self.index
        if self._takes("-"):
            return Operation("negative", (self._expression(self._grammar.negation_precedence),), at + 1)
        if self._takes("+"):
            return self._expression(self._grammar.negation_precedence)
        if self._takes("("):
            return self._enclosed()
        return self._word(at) or self._parameter_or_number(at)

    def _word(self, index: int) -> Formula | None:
        """Read a constant or a function with its operands; return None if the text is neither."""
        grammar = self._grammar
        if word := grammar.find_function(self.uppercase_text, index):
            self.index += len(word)
            return Operation(grammar.functions[word], self._function_operands(), index + 1)
        if word := grammar.find_constant(self.uppercase_text, index):
            self.index += len(word)
            return Number(grammar.constants[word])
        return None

    def _parameter_or_number(self, index: int) -> Formula:
        """Read a parameter or a number."""
        grammar = self._grammar
        if match := grammar.parameter_pattern.match(self.uppercase_text, index):
            self.index = match.end()
            letters, number = match.group(1), match.group(2)
            if not number and grammar.has_index and self.uppercase_text.startswith("[", self.index):
                return Parameter(letters, self.read_index(), index + 1)
            return Parameter(letters, int(number) if number else None, index + 1)
        if match := grammar.number_pattern.match(self.uppercase_text, index):
            self.index = match.end()
            return Number(float(match.group().replace(",", ".").replace("EX", "E")))
        raise FormulaError(
            index, "A number or a parameter is missing in the formula", "Complete the formula."
        )

    def read_index(self) -> Formula:
        """Read the index in square brackets at the current position.

        Several indices are returned as one operation ``INDEX_OPERATION``. Raises FormulaError if the
        closing bracket is missing.
        """
        self.index += 1
        column, found = self.index, [self._expression(0)]
        while self._grammar.operand_separator and self._takes(self._grammar.operand_separator):
            found.append(self._expression(0))
        if not self._takes("]"):
            raise FormulaError(
                self.index, "The closing square bracket is missing", "Write ] after the index."
            )
        return found[0] if len(found) == 1 else Operation(INDEX_OPERATION, tuple(found), column)

    def _enclosed(self) -> Formula:
        made = self._expression(0)
        self._close()
        return made

    def _function_operands(self) -> tuple[Formula, ...]:
        """Read the operands of a function.

        A function has one operand, or a list in parentheses if the dialect has a separator.
        """
        self.skip_blanks()
        if not self._grammar.operand_separator or not self._takes("("):
            return (self._expression(_HIGHEST_PRECEDENCE),)
        found = [self._expression(0)]
        while self._takes(self._grammar.operand_separator):
            found.append(self._expression(0))
        self._close()
        return tuple(found)

    def _close(self) -> None:
        if not self._takes(")"):
            raise FormulaError(self.index, "A closing parenthesis is missing", "Write ) after the formula.")

    def _takes(self, sign: str) -> bool:
        self.skip_blanks()
        if not self.uppercase_text.startswith(sign, self.index):
            return False
        self.index += len(sign)
        return True
