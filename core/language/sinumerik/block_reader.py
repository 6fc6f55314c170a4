"""Reader of a SINUMERIK block: formulas, lists of values and other items at a position."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from core.language.formulas import FUNCTIONS, Formula, FormulaError, FormulaReader, Grammar
from core.language.line_reading import UNSIGNED

GRAMMAR = Grammar(
    number=re.compile(rf"{UNSIGNED}(?:EX[+-]?[0-9]{{1,3}})?"),
    # Names such as $P_… are system variables, and their indices are part of the name.
    parameter=re.compile(r"(R(?=[0-9\[])|\$[A-Z][A-Z0-9_]*(?:\[[^\]]*\])?|[A-Z_][A-Z_][A-Z0-9_]*)([0-9]*)"),
    operators={
        "*": (80, "times"),
        "/": (80, "over"),
        "DIV": (80, "integer quotient"),
        "MOD": (80, "remainder"),
        "+": (70, "plus"),
        "-": (70, "minus"),
        "AND": (40, "and"),
        "XOR": (30, "exclusive or"),
        "OR": (20, "or"),
        "==": (10, "equal"),
        "<>": (10, "unequal"),
        ">=": (10, "greater than or equal"),
        "<=": (10, "less than or equal"),
        ">": (10, "greater"),
        "<": (10, "less"),
    },
    functions={
        **FUNCTIONS,
        "ATAN2": "direction",
        "POT": "square",
        "TRUNC": "integer part",
        "ROUND": "nearest whole number",
        "MINVAL": "smaller",
        "MAXVAL": "larger",
        "NOT": "not",
    },
    constants={"TRUE": 1.0, "FALSE": 0.0, "$PI": 3.141592653589793},
    separator=",",
    negation=90,
    indexed=True,
)
"""Formulas behind ``=``, in brackets of a target, and of conditions. Comparisons bind weakest of all."""


def formula_at(text: str, at: int) -> tuple[Formula, int]:
    """Return the formula that starts at ``at`` and the index after it. Raises FormulaError."""
    reader = FormulaReader(GRAMMAR, text, at)
    return reader.formula(), reader.at


NEXT = re.compile(r"\s*([,)])")
"""A comma or the closing parenthesis behind an item."""

_Item = TypeVar("_Item")


class BlockReader(FormulaReader):
    """Reader of a block from index ``at`` on.

    ``upper`` is the block in capitals, and ``written`` is the original text.
    """

    def __init__(self, upper: str, written: str, at: int) -> None:
        super().__init__(GRAMMAR, upper, at)
        self.written = written

    @property
    def rest(self) -> str:
        """The remaining text without leading blanks."""
        return self.upper[self.at :].lstrip()

    def take(self, pattern: re.Pattern[str], *, written: bool = False) -> re.Match[str] | None:
        """Return the match of the pattern at this position and move past it; None without a match."""
        match = pattern.match(self.written if written else self.upper, self.at)
        if match is not None:
            self.at = match.end()
        return match

    def demand(self, pattern: re.Pattern[str], why: str, hint: str) -> re.Match[str]:
        """Return the match of the pattern at this position and move past it.

        Raises FormulaError without a match.
        """
        match = self.take(pattern)
        if match is None:
            raise FormulaError(self.at, why, hint)
        return match

    def items(self, read: Callable[[], _Item], why: str, hint: str) -> list[_Item]:
        """Return the items that ``read`` returns up to the closing parenthesis.

        Raises FormulaError without one.
        """
        found: list[_Item] = []
        while True:
            found.append(read())
            if self.demand(NEXT, why, hint)[1] == ")":
                return found


_LIST = re.compile(r"\s*(SET|REP)?\s*\(")


class Values(NamedTuple):
    """Values for consecutive elements of an array; None leaves an element unchanged.

    REP has one formula for ``times`` elements, or for all remaining elements if ``times`` is None.
    """

    formulas: tuple[Formula | None, ...]
    repeated: bool = False
    times: Formula | None = None


def read_values(reader: BlockReader, *, bare: bool) -> Values | None:
    """Read a list of values; return None if no list starts here.

    With ``bare``, a parenthesis without SET also starts a list. Otherwise, such a parenthesis starts a
    formula. Raises FormulaError for an incomplete list.
    """
    match = _LIST.match(reader.upper, reader.at)
    if match is None or not (match[1] or bare):
        return None
    reader.at = match.end()
    found = reader.items(
        lambda: None if NEXT.match(reader.upper, reader.at) else reader.formula(),
        "The closing parenthesis of the list of values is missing",
        "Write ) after the last value.",
    )
    if match[1] != "REP":
        return Values(tuple(found))
    if found[0] is None or len(found) > 2:
        raise FormulaError(
            match.end(), "REP accepts only a value and a number of elements", "Write, for example, REP(0)."
        )
    return Values((found[0],), repeated=True, times=found[1] if found[1:] else None)
