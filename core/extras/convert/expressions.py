"""Expressions and variables of macros, such as ``#100``, ``#<name>`` and ``[#1 + 2] * SIN[30]``."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Mapping, MutableMapping

from core.extras.convert.conversion_messages import make_error
from core.language.diagnostics import ProgramError

_NUMBER = re.compile(r"\d+\.?\d*|\.\d+")
_NAME = re.compile(r"[A-Za-z]+")
_LEVELS: tuple[tuple[str, ...], ...] = (
    ("AND", "OR", "XOR", "&&", "||"),
    ("EQ", "NE", "GE", "GT", "LE", "LT"),
    ("+", "-"),
    ("MOD", "/", "*"),
)
_CALCULATE: Mapping[str, Callable[[float, float], float]] = {
    "AND": lambda a, b: float(bool(a) and bool(b)),
    "&&": lambda a, b: float(bool(a) and bool(b)),
    "OR": lambda a, b: float(bool(a) or bool(b)),
    "||": lambda a, b: float(bool(a) or bool(b)),
    "XOR": lambda a, b: float(bool(a) != bool(b)),
    "EQ": lambda a, b: float(abs(a - b) < 1e-9),
    "NE": lambda a, b: float(abs(a - b) >= 1e-9),
    "GE": lambda a, b: float(a >= b),
    "GT": lambda a, b: float(a > b),
    "LE": lambda a, b: float(a <= b),
    "LT": lambda a, b: float(a < b),
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "MOD": math.fmod,
}
_FUNCTIONS: Mapping[str, Callable[[float], float]] = {
    "SIN": lambda a: math.sin(math.radians(a)),
    "COS": lambda a: math.cos(math.radians(a)),
    "TAN": lambda a: math.tan(math.radians(a)),
    "ASIN": lambda a: math.degrees(math.asin(a)),
    "ACOS": lambda a: math.degrees(math.acos(a)),
    "SQRT": math.sqrt,
    "ABS": abs,
    "ROUND": lambda a: math.copysign(math.floor(abs(a) + 0.5), a),
    "FIX": math.floor,
    "FUP": math.ceil,
    "LN": math.log,
    "EXP": math.exp,
}
Variables = MutableMapping[str, float]


class ExpressionReader:
    """Reader of the expressions in one source line.

    ``at`` is the index of the next character to read.
    """

    def __init__(self, line: int, text: str, variables: Variables, at: int = 0) -> None:
        self.line, self.text, self.variables, self.at = line, text, variables, at

    def skip_blanks(self) -> None:
        """Advance the reading position to the next character that is not a blank."""
        while self.at < len(self.text) and self.text[self.at].isspace():
            self.at += 1

    def peek_character(self) -> str:
        """Return the next character that is not a blank, or an empty string at the end."""
        self.skip_blanks()
        return self.text[self.at : self.at + 1]

    def accept_text(self, sign: str) -> bool:
        """Skip ``sign`` if the text at the reading position starts with it; return whether it does."""
        self.skip_blanks()
        found = self.text[self.at : self.at + len(sign)].upper() == sign
        self.at += len(sign) * found
        return found

    def read_value(self) -> tuple[float, bool]:
        """Return the value of a word, and whether the decimal point rule does not apply to it.

        The rule applies only to a literal number without a decimal point. Raises ProgramError if the value
        is invalid.
        """
        begin = self.at
        negative = False
        while self.peek_character() in {"+", "-"}:
            negative ^= self.peek_character() == "-"
            self.at += 1
        number = _NUMBER.match(self.text, self.at)
        if number:
            self.at = number.end()
            return (-1 if negative else 1) * float(number[0]), "." in number[0]
        if self.peek_character() not in {"#", "["} and not _NAME.match(self.text, self.at):
            raise self._error(begin)
        try:
            return (-1 if negative else 1) * self._atom(), True
        except (ZeroDivisionError, ValueError, OverflowError) as error:
            raise make_error(self.line, begin + 1, "division") from error

    def read_bracket(self) -> float:
        """Return the value of the expression in ``[ ]``. Raises ProgramError if it is invalid."""
        begin = self.at
        if not self.accept_text("["):
            raise self._error(begin)
        try:
            found = self._binary(0)
        except (ZeroDivisionError, ValueError, OverflowError) as error:
            raise make_error(self.line, begin + 1, "division") from error
        if not self.accept_text("]"):
            raise self._error(begin)
        return found

    def read_expression(self) -> float:
        """Return the value of the expression to the right of ``=``. Raises ProgramError if it is invalid."""
        begin = self.at
        try:
            return self._binary(0)
        except (ZeroDivisionError, ValueError, OverflowError) as error:
            raise make_error(self.line, begin + 1, "division") from error

    def read_variable_key(self) -> str:
        """Return the key of the variable that begins with ``#`` at the reading position.

        Raises ProgramError if it is invalid.
        """
        self.at += 1
        if self.accept_text("<"):
            end = self.text.find(">", self.at)
            if end < 0:
                raise self._error(self.at)
            name, self.at = self.text[self.at : end], end + 1
            return "<" + name.replace(" ", "").lower()
        value, _ = self.read_value()
        return str(round(value))

    def _binary(self, level: int) -> float:
        if level == len(_LEVELS):
            return self._power()
        found = self._binary(level + 1)
        while True:
            sign = next((each for each in _LEVELS[level] if self._is_operator(each)), None)
            if sign is None:
                return found
            self.accept_text(sign)
            found = _CALCULATE[sign](found, self._binary(level + 1))

    def _is_operator(self, sign: str) -> bool:
        self.skip_blanks()
        if sign == "*" and self.text.startswith("**", self.at):
            return False
        return self.text[self.at : self.at + len(sign)].upper() == sign

    def _power(self) -> float:
        found = self._signed()
        while self.accept_text("**"):
            found = found ** self._signed()
        return found

    def _signed(self) -> float:
        if self.accept_text("-"):
            return -self._signed()
        if self.accept_text("+"):
            return self._signed()
        return self._atom()

    def _atom(self) -> float:
        sign = self.peek_character()
        if sign == "[":
            return self.read_bracket()
        if sign == "#":
            begin = self.at
            key = self.read_variable_key()
            if key not in self.variables:
                raise make_error(self.line, begin + 1, "variable", word=self.text[begin : self.at])
            return self.variables[key]
        number = _NUMBER.match(self.text, self.at)
        if number:
            self.at = number.end()
            return float(number[0])
        return self._function()

    def _function(self) -> float:
        begin = self.at
        name = _NAME.match(self.text, self.at)
        if name is None:
            raise self._error(begin)
        word = name[0].upper()
        self.at = name.end()
        if word == "ATAN":
            first = self.read_bracket()
            if self.accept_text("/"):
                return math.degrees(math.atan2(first, self.read_bracket())) % 360.0
            return math.degrees(math.atan(first))
        if word == "EXISTS" and self.accept_text("["):
            known = self.read_variable_key() in self.variables
            self.accept_text("]")
            return float(known)
        if word not in _FUNCTIONS:
            raise self._error(begin)
        return float(_FUNCTIONS[word](self.read_bracket()))

    def _error(self, begin: int) -> ProgramError:
        return make_error(
            self.line, begin + 1, "expression", text=self.text[begin : begin + 24].strip() or "?"
        )
