"""Expressions and variables of macros, such as ``#100``, ``#<name>`` and ``[#1 + 2] * SIN[30]``."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Mapping

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


def _is_true(value: float) -> bool:
    """Return whether a logical value is true.

    Raises ValueError for any value other than 0 and 1, because Fanuc controls combine the bits of numbers.
    """
    if value not in {0.0, 1.0}:
        raise ValueError("an operand of a logical operation must be 0 or 1")
    return bool(value)


def _is_equal(a: float, b: float) -> bool:
    """Return whether two values are equal. A variable without a value equals only another such variable."""
    return math.isnan(a) and math.isnan(b) if math.isnan(a) or math.isnan(b) else abs(a - b) < 1e-9


def _compare(a: float, b: float) -> float:
    """Return the difference of two values. Raises ValueError if one of them has no value."""
    if math.isnan(a) or math.isnan(b):
        raise ValueError("a variable without a value cannot be compared")
    return a - b


_CALCULATE: Mapping[str, Callable[[float, float], float]] = {
    "AND": lambda a, b: float(_is_true(a) & _is_true(b)),
    "&&": lambda a, b: float(_is_true(a) & _is_true(b)),
    "OR": lambda a, b: float(_is_true(a) | _is_true(b)),
    "||": lambda a, b: float(_is_true(a) | _is_true(b)),
    "XOR": lambda a, b: float(_is_true(a) ^ _is_true(b)),
    "EQ": lambda a, b: float(_is_equal(a, b)),
    "NE": lambda a, b: float(not _is_equal(a, b)),
    "GE": lambda a, b: float(_compare(a, b) >= 0.0),
    "GT": lambda a, b: float(_compare(a, b) > 0.0),
    "LE": lambda a, b: float(_compare(a, b) <= 0.0),
    "LT": lambda a, b: float(_compare(a, b) < 0.0),
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
_FUNCTIONS_OF_FANUC: Mapping[str, Callable[[float], float]] = {
    **_FUNCTIONS,
    "FIX": math.trunc,  # Fanuc rounds toward zero and away from zero; LinuxCNC rounds down and up.
    "FUP": lambda a: math.copysign(math.ceil(abs(a)), a),
}
_LOCAL_COUNT = 33  # #1 to #33 have no value at the start of a Fanuc program


class Variables(dict[str, float]):
    """Values of variables by key. ``is_fanuc`` selects the calculation rules of Fanuc macros."""

    def __init__(self, *, is_fanuc: bool = False) -> None:
        super().__init__()
        self.is_fanuc = is_fanuc

    def is_vacant(self, key: str) -> bool:
        """Return whether a Fanuc variable is known to have no value: #0, or an unused local variable."""
        return self.is_fanuc and key.isdecimal() and int(key) <= _LOCAL_COUNT and key not in self


_DEEPEST = 50
"""Maximum number of brackets and variables inside each other; Fanuc controls allow 5 brackets."""


class ExpressionReader:
    """Reader of the expressions in one source line.

    ``at`` is the index of the next character to read.
    """

    def __init__(self, line: int, text: str, variables: Variables, at: int = 0) -> None:
        self.line, self.text, self.variables, self.at = line, text, variables, at
        self._depth = 0

    def skip_blanks(self) -> None:
        """Advance the reading position to the next character that is not a blank."""
        while self.at < len(self.text) and self.text[self.at].isspace():
            self.at += 1

    def peek_character(self) -> str:
        """Return the next character that is not a blank, or an empty string at the end."""
        self.skip_blanks()
        return self.text[self.at : self.at + 1]

    def skip_text(self, sign: str) -> bool:
        """Skip the text ``sign`` if it is next in the line; return whether it was."""
        self.skip_blanks()
        found = self.text[self.at : self.at + len(sign)].upper() == sign
        self.at += len(sign) * found
        return found

    def read_value(self) -> tuple[float, bool]:
        """Return the value of a word, and whether the decimal point rule does not apply to the word.

        The rule (a number without a decimal point may be in least increments) applies only to literal
        numbers. Raises ProgramError if the value is invalid.
        """
        begin = self.at
        negative = False
        while self.peek_character() in {"+", "-"}:
            negative ^= self.peek_character() == "-"
            self.at += 1
        number = _NUMBER.match(self.text, self.at)
        if number:
            self.at = number.end()
            value = self._finite(begin, float(number[0]))
            return (-1 if negative else 1) * value, "." in number[0]
        if self.peek_character() not in {"#", "["} and not _NAME.match(self.text, self.at):
            raise self._error(begin)
        try:
            return (-1 if negative else 1) * self._finite(begin, self._atom()), True
        except (ZeroDivisionError, ValueError, OverflowError) as error:
            raise make_error(self.line, begin + 1, "division") from error

    def read_bracketed_expression(self) -> float:
        """Return the value of the expression in ``[ ]``. Raises ProgramError if it is invalid."""
        begin = self.at
        if not self.skip_text("["):
            raise self._error(begin)
        try:
            found = self._finite(begin, self._binary(0))
        except (ZeroDivisionError, ValueError, OverflowError) as error:
            raise make_error(self.line, begin + 1, "division") from error
        if not self.skip_text("]"):
            raise self._error(begin)
        return found

    def read_expression(self) -> float:
        """Return the value of the expression to the right of ``=``. Raises ProgramError if it is invalid."""
        begin = self.at
        try:
            return self._finite(begin, self._binary(0))
        except (ZeroDivisionError, ValueError, OverflowError) as error:
            raise make_error(self.line, begin + 1, "division") from error

    def read_variable_key(self) -> str:
        """Return the key of the variable that begins with ``#`` at the reading position.

        Raises ProgramError if it is invalid.
        """
        self.at += 1
        if self.skip_text("<"):
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
            self.skip_text(sign)
            found = _CALCULATE[sign](found, right := self._binary(level + 1))
            if sign == "MOD" and found < 0.0 and not self.variables.is_fanuc:
                found += abs(right)  # A remainder of LinuxCNC is never negative.

    def _is_operator(self, sign: str) -> bool:
        self.skip_blanks()
        if sign == "*" and self.text.startswith("**", self.at):
            return False
        return self.text[self.at : self.at + len(sign)].upper() == sign

    def _power(self) -> float:
        found = self._signed()
        while self.skip_text("**"):
            found = math.pow(found, self._signed())  # Unlike **, pow raises an error for a complex result.
        return found

    def _signed(self) -> float:
        sign = 1.0
        while self.peek_character() in {"+", "-"}:
            sign = -sign if self.peek_character() == "-" else sign
            self.at += 1
        return sign * self._atom()

    def _finite(self, begin: int, value: float) -> float:
        """Return the value of an expression.

        Raises ProgramError if it is infinite, or if a variable in it has no value.
        """
        if math.isnan(value):
            raise make_error(self.line, begin + 1, "variable", word=self.text[begin : self.at].strip())
        if math.isinf(value):
            raise self._error(begin)
        return value

    def _atom(self) -> float:
        if self._depth >= _DEEPEST:
            raise self._error(self.at)
        self._depth += 1
        try:
            return self._nested_atom()
        finally:
            self._depth -= 1

    def _nested_atom(self) -> float:
        sign = self.peek_character()
        if sign == "[":
            return self.read_bracketed_expression()
        if sign == "#":
            begin = self.at
            key = self.read_variable_key()
            if self.variables.is_vacant(key):
                return math.nan
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
            first = self.read_bracketed_expression()
            if self.skip_text("/"):
                angle = math.degrees(math.atan2(first, self.read_bracketed_expression()))
                return angle % 360.0 if self.variables.is_fanuc else angle
            return math.degrees(math.atan(first))
        if word == "EXISTS" and self.skip_text("["):
            known = self.read_variable_key() in self.variables
            self.skip_text("]")
            return float(known)
        functions = _FUNCTIONS_OF_FANUC if self.variables.is_fanuc else _FUNCTIONS
        if word not in functions:
            raise self._error(begin)
        return float(functions[word](self.read_bracketed_expression()))

    def _error(self, begin: int) -> ProgramError:
        return make_error(
            self.line, begin + 1, "expression", text=self.text[begin : begin + 24].strip() or "?"
        )
