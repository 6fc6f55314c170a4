"""Values for the elements of an array: SET(1, 2, 3), REP(0), and the bare (1, 2, 3) of DEF."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError
from core.language.sinumerik.block_reader import NEXT, BlockReader

_LIST = re.compile(r"\s*(SET|REP)?\s*\(")


class Values(NamedTuple):
    """What elements are given, one after the other; None for one that keeps what it has.

    Of REP there is one formula, for ``times`` elements, or without it for all that are left.
    """

    formulas: tuple[Formula | None, ...]
    repeated: bool = False
    times: Formula | None = None


def read_values(reader: BlockReader, *, bare: bool) -> Values | None:
    """The list that begins here; None where none does. Raises FormulaError.

    ``bare`` takes brackets without SET before them, which elsewhere begin a formula.
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
