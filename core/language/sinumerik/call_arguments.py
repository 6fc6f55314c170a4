"""Parsers of call arguments, such as CYCLE95("CONTOUR", 2, , 0.4), and of parameter lists."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError
from core.language.sinumerik.block_reader import LIST_SEPARATOR, BlockReader

_QUOTED = re.compile(r'\s*"([^"]*)"\s*(?=[,)])')
_AXIS = re.compile(r"\s*([A-CU-Z][0-9]?)\s*(?=[,)])")
_PARAMETER = re.compile(
    r"\s*(?:(VAR)\s+)?(REAL|INT|BOOL|CHAR|STRING|AXIS|FRAME)(?:\s*\[[^\]]*\])?"
    r"(?:\s+([A-Z_][A-Z_][A-Z0-9_]*)(?:\s*\[([^\]]*)\])?)?\s*(=)?\s*"
)
_DIMENSION = re.compile(r"\s*([0-9]*)\s*")


class CallArgument(NamedTuple):
    """One argument of a call, which can be a formula, a text, or omitted.

    A text is in quotation marks or is an axis letter. ``column`` counts from 1.
    """

    formula: Formula | None
    text: str | None
    column: int

    @property
    def is_specified(self) -> bool:
        """Return whether the call specifies the argument."""
        return self.formula is not None or self.text is not None


class ProcParameter(NamedTuple):
    """A parameter of PROC.

    - ``type_name`` is its type, such as REAL.
    - ``is_by_reference`` is True if the parameter is declared with VAR.
    - ``default`` is the default value, or None if it has none.
    - ``dimensions`` contains the dimensions of an array, with None for a dimension that the caller's array
      determines. It is empty for a scalar.
    """

    name: str
    type_name: str
    is_by_reference: bool
    default: CallArgument | None
    dimensions: tuple[int | None, ...] = ()


def read_arguments(reader: BlockReader) -> tuple[CallArgument, ...]:
    """Read the arguments in parentheses. Raises FormulaError for invalid text."""
    found: list[CallArgument] = []
    start = reader.index
    reader.index += 1
    while True:
        reader.skip_blanks()
        found.append(_argument(reader))
        match = reader.match_pattern(LIST_SEPARATOR)
        if match is None:
            hint = "Write ( , , )."
            if not reader.uppercase_text[reader.index :]:
                raise FormulaError(start, "The argument list has no closing parenthesis", hint)
            raise FormulaError(reader.index, "The argument list contains text that is not an argument", hint)
        if match[1] == ")":
            return () if len(found) == 1 and not found[0].is_specified else tuple(found)


def _argument(reader: BlockReader) -> CallArgument:
    column = reader.index + 1
    if reader.uppercase_text[reader.index : reader.index + 1] in {",", ")"}:
        return CallArgument(None, None, column)
    if quoted := reader.match_pattern(_QUOTED, uses_original_text=True):
        return CallArgument(None, quoted[1].strip(), column)
    if axis := reader.match_pattern(_AXIS):
        return CallArgument(None, axis[1], column)
    return CallArgument(reader.read_formula(), None, column)


def read_parameters(reader: BlockReader) -> tuple[ProcParameter, ...]:
    """Read the parameters in parentheses. Raises FormulaError for invalid text."""
    reader.index += 1
    reader.skip_blanks()
    if reader.uppercase_text[reader.index : reader.index + 1] == ")":
        reader.index += 1
        return ()
    return tuple(
        reader.read_items(
            lambda: _parameter(reader),
            "The closing parenthesis of the parameter list is missing",
            "Write ) after the last parameter.",
        )
    )


def _parameter(reader: BlockReader) -> ProcParameter:
    match = reader.match_required(
        _PARAMETER, "A parameter needs a type and a name", "Write, for example, PROC NAME(REAL LENGTH)."
    )
    default = _argument(reader) if match[5] else None
    return ProcParameter(match[3] or "", match[2], match[1] is not None, default, _sizes(match))


def _sizes(match: re.Match[str]) -> tuple[int | None, ...]:
    """Return the dimensions of an array parameter such as NAME[3] or NAME[,4].

    Raises FormulaError for an invalid dimension, and for an array parameter without VAR.
    """
    if match[4] is None:
        return ()
    found = [_DIMENSION.fullmatch(each) for each in match[4].split(",")]
    if None in found or not match[1]:
        raise FormulaError(match.start(3),
            "An array parameter needs VAR and whole numbers as its sizes",
                           "Write, for example, PROC NAME(VAR REAL LIST[3]).")  # fmt: skip
    return tuple(int(each[1][:9]) if each is not None and each[1] else None for each in found)
