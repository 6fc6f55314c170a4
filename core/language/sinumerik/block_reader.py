"""Parser of formulas, lists of values and other items at a position in a SINUMERIK block."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple, TypeVar

from core.language.formulas import FUNCTION_OPERATIONS, Formula, FormulaError, FormulaGrammar, FormulaReader
from core.language.line_reading import UNSIGNED_NUMBER

MAX_R_NUMBER = 299
"""Number of the last R parameter."""

SINUMERIK_GRAMMAR = FormulaGrammar(
    number_pattern=re.compile(rf"{UNSIGNED_NUMBER}(?:EX[+-]?[0-9]{{1,3}})?"),
    # Names such as $P_… are system variables, and their indices are part of the name.
    parameter_pattern=re.compile(
        r"(R(?=[0-9\[])|\$[A-Z][A-Z0-9_]*(?:\[[^\]]*\])?|[A-Z_][A-Z_][A-Z0-9_]*)([0-9]*)"
    ),
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
        **FUNCTION_OPERATIONS,
        "ATAN2": "direction",
        "POT": "square",
        "TRUNC": "integer part",
        "ROUND": "nearest whole number",
        "MINVAL": "smaller",
        "MAXVAL": "larger",
        "NOT": "not",
    },
    constants={"TRUE": 1.0, "FALSE": 0.0, "$PI": 3.141592653589793},
    operand_separator=",",
    negation_precedence=90,
    has_index=True,
)
"""Grammar of formulas after ``=``, in brackets of a target, and in conditions.

Comparisons have the lowest precedence.
"""


def parse_formula(text: str, index: int) -> tuple[Formula, int]:
    """Return the formula that starts at ``index``, and the index after the formula.

    Raises FormulaError for an invalid formula.
    """
    reader = FormulaReader(SINUMERIK_GRAMMAR, text, index)
    return reader.read_formula(), reader.index


LIST_SEPARATOR = re.compile(r"\s*([,)])")
"""Pattern of a comma or closing parenthesis after a list item."""

_Item = TypeVar("_Item")


class BlockReader(FormulaReader):
    """Parser of a block that starts at ``index``.

    ``uppercase_text`` is the block in capitals, and ``original_text`` is the block as written.
    """

    def __init__(self, uppercase_text: str, original_text: str, index: int) -> None:
        super().__init__(SINUMERIK_GRAMMAR, uppercase_text, index)
        self.original_text = original_text

    @property
    def remaining_text(self) -> str:
        """Return the remaining text without leading blanks."""
        return self.uppercase_text[self.index :].lstrip()

    def match_pattern(
        self, pattern: re.Pattern[str], *, uses_original_text: bool = False
    ) -> re.Match[str] | None:
        """Return the match of the pattern at this position, and move past it.

        Returns None if the pattern does not match.
        """
        match = pattern.match(self.original_text if uses_original_text else self.uppercase_text, self.index)
        if match is not None:
            self.index = match.end()
        return match

    def match_required(self, pattern: re.Pattern[str], message: str, hint: str) -> re.Match[str]:
        """Return the match of the pattern at this position and move past it.

        Raises FormulaError with ``message`` and ``hint`` if the pattern does not match.
        """
        match = self.match_pattern(pattern)
        if match is None:
            raise FormulaError(self.index, message, hint)
        return match

    def read_items(self, read_item: Callable[[], _Item], message: str, hint: str) -> list[_Item]:
        """Read items with ``read_item`` up to the closing parenthesis, and return them.

        Raises FormulaError if the closing parenthesis is missing.
        """
        found: list[_Item] = []
        while True:
            found.append(read_item())
            if self.match_required(LIST_SEPARATOR, message, hint)[1] == ")":
                return found


_LIST = re.compile(r"\s*(SET|REP)?\s*\(")


class ValueList(NamedTuple):
    """The values for consecutive elements of an array, with None for an element that is not changed.

    REP has one formula for ``repeat_count`` elements, or for all remaining elements if ``repeat_count`` is
    None.
    """

    formulas: tuple[Formula | None, ...]
    is_repeated: bool = False
    repeat_count: Formula | None = None


def read_value_list(reader: BlockReader, *, allows_bare_list: bool) -> ValueList | None:
    """Read a list of values, or return None if no list starts at this position.

    With ``allows_bare_list``, a parenthesis without SET also starts a list. Otherwise, such a parenthesis
    starts a formula. Raises FormulaError for an incomplete list.
    """
    match = _LIST.match(reader.uppercase_text, reader.index)
    if match is None or not (match[1] or allows_bare_list):
        return None
    reader.index = match.end()
    found = reader.read_items(
        lambda: None if LIST_SEPARATOR.match(reader.uppercase_text, reader.index) else reader.read_formula(),
        "The closing parenthesis of the list of values is missing",
        "Write ) after the last value.",
    )
    if match[1] != "REP":
        return ValueList(tuple(found))
    if found[0] is None or len(found) > 2:
        raise FormulaError(
            match.end(), "REP accepts only a value and a number of elements", "Write, for example, REP(0)."
        )
    return ValueList((found[0],), is_repeated=True, repeat_count=found[1] if found[1:] else None)
