"""Values for the elements of an array: SET(1, 2, 3), REP(0), and the bare (1, 2, 3) of DEF."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError
from core.language.sinumerik.sinumerik_formulas import formula_at, list_at

_LIST = re.compile(r"\s*(SET|REP)?\s*\(")
_LEFT_OUT = re.compile(r"\s*[,)]")


class Values(NamedTuple):
    """What elements are given, one after the other; None for one that keeps what it has.

    Of REP there is one formula, for ``times`` elements, or without it for all that are left.
    """

    formulas: tuple[Formula | None, ...]
    repeated: bool = False
    times: Formula | None = None


def read_values(text: str, at: int, *, bare: bool) -> tuple[Values, int] | None:
    """The list that begins at ``at`` and the index behind it; None where none does. Raises FormulaError.

    ``text`` is in capitals. ``bare`` takes brackets without SET before them, which elsewhere begin a formula.
    """
    match = _LIST.match(text, at)
    if match is None or not (match[1] or bare):
        return None
    found, end = list_at(text, match.end(), lambda at: _element(text, at), _unclosed)
    if match[1] != "REP":
        return Values(tuple(found)), end
    if found[0] is None or len(found) > 2:
        raise FormulaError(
            match.end(), "REP accepts only a value and a number of elements", "Write, for example, REP(0)."
        )
    return Values((found[0],), repeated=True, times=found[1] if found[1:] else None), end


def _element(text: str, at: int) -> tuple[Formula | None, int]:
    """Return a formula, or None before the next comma, and the index behind it."""
    return (None, at) if _LEFT_OUT.match(text, at) else formula_at(text, at)


def _unclosed(at: int) -> FormulaError:
    return FormulaError(
        at, "The closing parenthesis of the list of values is missing", "Write ) after the last value."
    )
