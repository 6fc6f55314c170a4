"""Arithmetic expressions in input fields, for example ``.5-.002`` or ``(1.25+.03)/2``."""

from __future__ import annotations

import re
from math import isfinite

from core.message import Message

EXPRESSION_CHARACTERS = frozenset("0123456789.,+-*/()−")  # Characters that an expression may contain.
MAX_LENGTH = 80  # Maximum length of an expression in characters.
_TOKEN = re.compile(r"\s*(?:([0-9]+\.?[0-9]*|\.[0-9]+)|([-+*/()−]))")


class InvalidEntryError(ValueError):
    """Error for an expression that has no numeric value. The message gives the reason."""


def evaluate_expression(entry: str) -> float:
    """Return the value of an arithmetic expression.

    Raises InvalidEntryError with the reason if the expression is empty, invalid or longer than
    ``MAX_LENGTH``. It also raises InvalidEntryError for a division by zero or a value that is too large.
    For an unexpected number or operator, the error text contains its position.
    """
    if not entry.strip():
        raise InvalidEntryError("no value entered; type a number")
    if len(entry) > MAX_LENGTH:
        raise InvalidEntryError(
            Message(
                "the expression is longer than {longest} characters; calculate it yourself and type "
                "the result",
                longest=MAX_LENGTH,
            )
        )
    entry = " ".join(entry.split())
    reader = _ExpressionParser(entry)
    value = reader.parse_sum()
    reader.expect_end()
    if not isfinite(value):
        raise InvalidEntryError(Message("{entry} is too large; type a smaller number", entry=entry))
    return value


def evaluate_line_number(entry: str) -> int | None:
    """Return the line number that is the value of an expression such as ``20+5``.

    The result is None if the expression is invalid, or if its value is not an integer of at least 1.
    """
    try:
        value = evaluate_expression(entry)
    except InvalidEntryError:
        return None
    return int(value) if value == int(value) and value >= 1 else None


class _ExpressionParser:
    """Recursive-descent parser of one expression with sums, products, signs, numbers and parentheses."""

    def __init__(self, entry: str) -> None:
        self._entry = entry
        self._tokens = list(_split_tokens(entry))
        self._next = 0

    def parse_sum(self) -> float:
        value = self._product()
        while sign := self._take("+", "-"):
            part = self._product()
            value = value + part if sign == "+" else value - part
        return value

    def _product(self) -> float:
        value = self._signed()
        while sign := self._take("*", "/"):
            part = self._signed()
            if sign == "/" and part == 0:
                raise InvalidEntryError(Message("{entry} divides by zero", entry=self._entry))
            value = value * part if sign == "*" else value / part
        return value

    def _signed(self) -> float:
        sign = self._take("+", "-")
        if sign:
            value = self._signed()
            return -value if sign == "-" else value
        if self._take("("):
            value = self.parse_sum()
            if not self._take(")"):
                raise self._refusal("a closing parenthesis")
            return value
        return self._number()

    def _number(self) -> float:
        if self._next < len(self._tokens) and self._tokens[self._next][0] not in "+-*/()":
            self._next += 1
            return float(self._tokens[self._next - 1][0])
        raise self._refusal("a number")

    def expect_end(self) -> None:
        if self._next < len(self._tokens):
            raise self._refusal("+, -, *, / or the end of the entry")

    def _take(self, *wanted: str) -> str:
        if self._next < len(self._tokens) and self._tokens[self._next][0] in wanted:
            self._next += 1
            return self._tokens[self._next - 1][0]
        return ""

    def _refusal(self, expected: str) -> InvalidEntryError:
        if self._next >= len(self._tokens):
            return InvalidEntryError(
                Message(
                    "{entry} is incomplete; expected {expected} at the end",
                    entry=self._entry,
                    expected=expected,
                )
            )
        found, column = self._tokens[self._next]
        return InvalidEntryError(
            Message(
                "unexpected {value} at character {column} of {entry}; expected {expected}",
                value=found,
                column=column,
                entry=self._entry,
                expected=expected,
            )
        )


def _split_tokens(entry: str) -> list[tuple[str, int]]:
    """Return the numbers and operators of an expression, each with its column, counted from 1.

    Raises InvalidEntryError for a character that must not occur in an expression.
    """
    tokens, at = [], 0
    while at < len(entry):
        match = _TOKEN.match(entry, at)
        if not match:
            bad = entry[at:].lstrip()[0]
            hint = (
                "use a decimal point instead of a comma"
                if bad == ","
                else ("use only numbers and + - * / ( )")
            )
            raise InvalidEntryError(
                Message("{bad} in {entry} is not a number; {hint}", bad=bad, entry=entry, hint=hint)
            )
        word = match.group(1) or match.group(2)
        tokens.append((word.replace("−", "-"), match.end() - len(word) + 1))
        at = match.end()
    return tokens
