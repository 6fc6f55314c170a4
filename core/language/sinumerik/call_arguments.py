"""Readers of call arguments, such as CYCLE95("CONTOUR", 2, , 0.4), and of parameter lists."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError
from core.language.sinumerik.block_reader import NEXT, BlockReader

_QUOTED = re.compile(r'\s*"([^"]*)"\s*(?=[,)])')
_AXIS = re.compile(r"\s*([A-CU-Z][0-9]?)\s*(?=[,)])")
_PARAMETER = re.compile(
    r"\s*(?:(VAR)\s+)?(REAL|INT|BOOL|CHAR|STRING|AXIS|FRAME)(?:\s*\[[^\]]*\])?"
    r"(?:\s+([A-Z_][A-Z_][A-Z0-9_]*)(?:\s*\[([^\]]*)\])?)?\s*(=)?\s*"
)
_DIMENSION = re.compile(r"\s*([0-9]*)\s*")


class Argument(NamedTuple):
    """One argument: a formula, or a text (in quotation marks or an axis letter), or neither if it is omitted.

    ``column`` counts from 1.
    """

    formula: Formula | None
    text: str | None
    column: int

    @property
    def given(self) -> bool:
        """Whether the argument is specified."""
        return self.formula is not None or self.text is not None


class Parameter(NamedTuple):
    """A parameter of PROC. ``kind`` is its type such as REAL, and ``by_reference`` is True with VAR.

    ``default`` is the default value, or None. ``sizes`` are the dimensions of an array, with None for a
    dimension that the caller's array determines; it is empty for a scalar.
    """

    name: str
    kind: str
    by_reference: bool
    default: Argument | None
    sizes: tuple[int | None, ...] = ()


def read_arguments(reader: BlockReader) -> tuple[Argument, ...]:
    """Read the arguments in parentheses. Raises FormulaError for invalid text."""
    found: list[Argument] = []
    start = reader.at
    reader.at += 1
    while True:
        reader.blanks()
        found.append(_argument(reader))
        match = reader.take(NEXT)
        if match is None:
            hint = "Write ( , , )."
            if not reader.upper[reader.at :]:
                raise FormulaError(start, "The argument list has no closing parenthesis", hint)
            raise FormulaError(reader.at, "The argument list contains text that is not an argument", hint)
        if match[1] == ")":
            return () if len(found) == 1 and not found[0].given else tuple(found)


def _argument(reader: BlockReader) -> Argument:
    column = reader.at + 1
    if reader.upper[reader.at : reader.at + 1] in {",", ")"}:
        return Argument(None, None, column)
    if quoted := reader.take(_QUOTED, written=True):
        return Argument(None, quoted[1].strip(), column)
    if axis := reader.take(_AXIS):
        return Argument(None, axis[1], column)
    return Argument(reader.formula(), None, column)


def read_parameters(reader: BlockReader) -> tuple[Parameter, ...]:
    """Read the parameters in parentheses. Raises FormulaError for invalid text."""
    reader.at += 1
    reader.blanks()
    if reader.upper[reader.at : reader.at + 1] == ")":
        reader.at += 1
        return ()
    return tuple(
        reader.items(
            lambda: _parameter(reader),
            "The closing parenthesis of the parameter list is missing",
            "Write ) after the last parameter.",
        )
    )


def _parameter(reader: BlockReader) -> Parameter:
    match = reader.demand(
        _PARAMETER, "A parameter needs a type and a name", "Write, for example, PROC NAME(REAL LENGTH)."
    )
    default = _argument(reader) if match[5] else None
    return Parameter(match[3] or "", match[2], match[1] is not None, default, _sizes(match))


def _sizes(match: re.Match[str]) -> tuple[int | None, ...]:
    """Return the dimensions of an array parameter, NAME[3] or NAME[,4]. Raises FormulaError."""
    if match[4] is None:
        return ()
    found = [_DIMENSION.fullmatch(each) for each in match[4].split(",")]
    if None in found or not match[1]:
        raise FormulaError(match.start(3),
            "An array parameter needs VAR and whole numbers as its sizes",
                           "Write, for example, PROC NAME(VAR REAL LIST[3]).")  # fmt: skip
    return tuple(int(each[1][:9]) if each is not None and each[1] else None for each in found)
