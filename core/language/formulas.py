"""Formulas of a program: numbers, parameters, operators with their precedence, functions.

Each language states its own ``Grammar``; what comes of the text is the same for all, and is worked out by
``core.interpreter.shared.formula_values``.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from core.language.line_reading import LineReader


class Number(NamedTuple):
    """A number as written."""

    value: float


class Parameter(NamedTuple):
    """A parameter by its letters, ``Q`` or ``R``, and its number; a name stands alone. ``column`` from 1."""

    letters: str
    number: int | Formula | None
    column: int


class Operation(NamedTuple):
    """An operator or a function by the name that ``formula_values`` knows, and what it is asked of."""

    name: str
    operands: tuple[Formula, ...]
    column: int


Formula = Number | Parameter | Operation
INDICES = "indices"
"""The operation that stands for several indices of one element; it has no value of its own."""
FUNCTIONS = {
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
"""Functions that have the same name in every language."""


def indices_of(index: Formula) -> tuple[Formula, ...]:
    """What stands in square brackets, one formula for each dimension."""
    return index.operands if isinstance(index, Operation) and index.name == INDICES else (index,)


class FormulaError(Exception):
    """What cannot be read. ``at`` is the index of the place in the text; ``str()`` a sentence about it."""

    def __init__(self, at: int, why: str, hint: str) -> None:
        super().__init__(why)
        self.at = at
        self.hint = hint


@dataclass(frozen=True)
class Grammar:
    """How formulas of a language are written, all in capitals.

    ``number`` and ``parameter`` match one operand (a parameter's groups are its letters and its number);
    ``operators`` give precedence (higher binds closer) and name by how they are written; ``functions`` the
    name, ``constants`` the value. ``separator`` stands between the operands of a function (empty: there is
    one, without brackets).
    """

    number: re.Pattern[str]
    parameter: re.Pattern[str]
    operators: Mapping[str, tuple[int, str]]
    functions: Mapping[str, str]
    constants: Mapping[str, float] = field(default_factory=dict)
    separator: str = ""
    negation: int = 50  # precedence of a sign before an operand
    indexed: bool = False  # a parameter may have its number, a formula, in square brackets
    _sign: re.Pattern[str] = field(init=False, repr=False)
    _word: re.Pattern[str] = field(init=False, repr=False)
    _constant: re.Pattern[str] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_sign", _any_of(self.operators))
        object.__setattr__(self, "_word", _any_of(self.functions))
        object.__setattr__(self, "_constant", _any_of(self.constants))

    def operator(self, text: str, at: int) -> str | None:
        """The operator that stands here."""
        match = self._sign.match(text, at)
        return match.group() if match else None

    def function(self, text: str, at: int) -> str | None:
        """The function that stands here."""
        match = self._word.match(text, at)
        return match.group() if match else None

    def constant(self, text: str, at: int) -> str | None:
        """The constant that stands here."""
        match = self._constant.match(text, at)
        return match.group() if match else None


def _any_of(words: Mapping[str, object]) -> re.Pattern[str]:
    """The longest that stands here; a word ends where its letters do."""
    if not words:
        return re.compile(r"(?!)")
    ordered = sorted(words, key=len, reverse=True)
    return re.compile(
        "|".join(
            re.escape(word) + ("(?![A-Z_])" if word.isalpha() else _APART.get(word, "")) for word in ordered
        )
    )


_APART = {"<": "(?!<)"}  # << joins texts


_CLOSEST = 1000
_DEEPEST = 40


class FormulaReader(LineReader):
    """Reads one formula from ``upper`` at ``at``; ``at`` then stands behind it."""

    def __init__(self, grammar: Grammar, upper: str, at: int) -> None:
        self.upper, self.at = upper, at
        self._grammar = grammar
        self._depth = 0

    def formula(self) -> Formula:
        """The formula. Raises FormulaError for what is missing or is none."""
        return self._expression(0)

    def _expression(self, weakest: int) -> Formula:
        """Operands and operators that bind at least as close as ``weakest``, from left to right."""
        self._depth += 1
        if self._depth > _DEEPEST:
            raise FormulaError(
                self.at, "The formula is nested too deeply", "Split the contour into smaller parts."
            )
        made = self._operand()
        while (sign := self._operator()) is not None:
            power, name = self._grammar.operators[sign]
            if power < weakest:
                break
            column = self.at + 1
            self.at += len(sign)
            made = Operation(name, (made, self._expression(power + 1)), column)
        self._depth -= 1
        return made

    def _operator(self) -> str | None:
        self.blanks()
        return self._grammar.operator(self.upper, self.at)

    def _operand(self) -> Formula:
        self.blanks()
        at = self.at
        if self._takes("-"):
            return Operation("negative", (self._expression(self._grammar.negation),), at + 1)
        if self._takes("+"):
            return self._expression(self._grammar.negation)
        if self._takes("("):
            return self._enclosed()
        return self._word(at) or self._figure(at)

    def _word(self, at: int) -> Formula | None:
        """A function with what it is asked of, or a constant."""
        grammar = self._grammar
        if word := grammar.function(self.upper, at):
            self.at += len(word)
            return Operation(grammar.functions[word], self._asked_of(), at + 1)
        if word := grammar.constant(self.upper, at):
            self.at += len(word)
            return Number(grammar.constants[word])
        return None

    def _figure(self, at: int) -> Formula:
        """A parameter or a number."""
        grammar = self._grammar
        if match := grammar.parameter.match(self.upper, at):
            self.at = match.end()
            letters, number = match.group(1), match.group(2)
            if not number and grammar.indexed and self.upper.startswith("[", self.at):
                return Parameter(letters, self.index(), at + 1)
            return Parameter(letters, int(number) if number else None, at + 1)
        if match := grammar.number.match(self.upper, at):
            self.at = match.end()
            return Number(float(match.group().replace(",", ".").replace("EX", "E")))
        raise FormulaError(at, "A number or a parameter is missing in the formula", "Complete the formula.")

    def index(self) -> Formula:
        """The index in the square bracket that opens here; several as an operation INDICES of them all.

        Raises FormulaError.
        """
        self.at += 1
        column, found = self.at, [self._expression(0)]
        while self._grammar.separator and self._takes(self._grammar.separator):
            found.append(self._expression(0))
        if not self._takes("]"):
            raise FormulaError(self.at, "The closing square bracket is missing", "Write ] after the index.")
        return found[0] if len(found) == 1 else Operation(INDICES, tuple(found), column)

    def _enclosed(self) -> Formula:
        made = self._expression(0)
        self._close()
        return made

    def _asked_of(self) -> tuple[Formula, ...]:
        """What a function is asked of: one operand, or a list in brackets where the language has that."""
        self.blanks()
        if not self._grammar.separator or not self._takes("("):
            return (self._expression(_CLOSEST),)
        found = [self._expression(0)]
        while self._takes(self._grammar.separator):
            found.append(self._expression(0))
        self._close()
        return tuple(found)

    def _close(self) -> None:
        if not self._takes(")"):
            raise FormulaError(self.at, "A closing parenthesis is missing", "Write ) after the formula.")

    def _takes(self, sign: str) -> bool:
        self.blanks()
        if not self.upper.startswith(sign, self.at):
            return False
        self.at += len(sign)
        return True
