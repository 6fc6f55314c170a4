"""Arguments of a call, CYCLE95("CONTOUR", 2, , 0.4), and parameters of PROC and EXTERN."""

from __future__ import annotations

import re
from typing import NamedTuple

from core.language.formulas import Formula, FormulaError
from core.language.line_reading import after_blanks
from core.language.sinumerik.sinumerik_formulas import formula_at, list_at

_QUOTED = re.compile(r'\s*"([^"]*)"\s*(?=[,)])')
_AXIS = re.compile(r"\s*([A-CU-Z][0-9]?)\s*(?=[,)])")
_PARAMETER = re.compile(
    r"\s*(?:(VAR)\s+)?(REAL|INT|BOOL|CHAR|STRING|AXIS|FRAME)(?:\s*\[[^\]]*\])?"
    r"(?:\s+([A-Z_][A-Z_][A-Z0-9_]*)(?:\s*\[([^\]]*)\])?)?\s*(=)?\s*"
)
_DIMENSION = re.compile(r"\s*([0-9]*)\s*")


class Argument(NamedTuple):
    """One argument: a formula, or a text in quotes (an axis by its letter too); neither where it is left out.

    ``column`` from 1.
    """

    formula: Formula | None
    text: str | None
    column: int

    @property
    def given(self) -> bool:
        """Whether anything stands there."""
        return self.formula is not None or self.text is not None


class Parameter(NamedTuple):
    """A parameter of PROC: ``kind`` such as REAL, ``by_reference`` with VAR, ``default`` where it has one.

    ``sizes`` are those of an array, None for one that the caller's array has; without them it is no array.
    """

    name: str
    kind: str
    by_reference: bool
    default: Argument | None
    sizes: tuple[int | None, ...] = ()


def read_arguments(text: str, written: str, at: int) -> tuple[tuple[Argument, ...], int]:
    """The arguments in the brackets that open at ``at``, and the index behind them. Raises FormulaError.

    ``text`` is in capitals, ``written`` the same in its own case.
    """
    found, end = list_at(
        text,
        at + 1,
        lambda place: _argument(text, written, after_blanks(text, place)),
        lambda place: _no_argument(text, at, place),
    )
    return (() if len(found) == 1 and not found[0].given else tuple(found)), end


def _no_argument(text: str, start: int, at: int) -> FormulaError:
    hint = "Write ( , , )."
    if at >= len(text):
        return FormulaError(start, "The argument list has no closing parenthesis", hint)
    return FormulaError(at, "The argument list contains text that is not an argument", hint)


def _argument(text: str, written: str, at: int) -> tuple[Argument, int]:
    column = at + 1
    if text[at : at + 1] in {",", ")"}:
        return Argument(None, None, column), at
    if quoted := _QUOTED.match(written, at):
        return Argument(None, quoted[1].strip(), column), quoted.end()
    if axis := _AXIS.match(text, at):
        return Argument(None, axis[1], column), axis.end()
    formula, end = formula_at(text, at)
    return Argument(formula, None, column), end


def read_parameters(text: str, written: str, at: int) -> tuple[tuple[Parameter, ...], int]:
    """The parameters in the brackets that open at ``at``, and the index behind them. Raises FormulaError."""
    at = after_blanks(text, at + 1)
    if text[at : at + 1] == ")":
        return (), at + 1
    found, end = list_at(text, at, lambda place: _parameter(text, written, place), _unclosed)
    return tuple(found), end


def _parameter(text: str, written: str, at: int) -> tuple[Parameter, int]:
    match = _PARAMETER.match(text, at)
    if match is None:
        raise FormulaError(
            at, "A parameter needs a type and a name", "Write, for example, PROC NAME(REAL LENGTH)."
        )
    sizes = _sizes(match)
    default, end = _argument(text, written, match.end()) if match[5] else (None, match.end())
    return Parameter(match[3] or "", match[2], match[1] is not None, default, sizes), end


def _unclosed(at: int) -> FormulaError:
    return FormulaError(
        at, "The closing parenthesis of the parameter list is missing", "Write ) after the last parameter."
    )


def _sizes(match: re.Match[str]) -> tuple[int | None, ...]:
    """The sizes of an array parameter, NAME[3] or NAME[,4]. Raises FormulaError."""
    if match[4] is None:
        return ()
    found = [_DIMENSION.fullmatch(each) for each in match[4].split(",")]
    if None in found or not match[1]:
        raise FormulaError(match.start(3),
            "An array parameter needs VAR and whole numbers as its sizes",
                           "Write, for example, PROC NAME(VAR REAL LIST[3]).")  # fmt: skip
    return tuple(int(each[1][:9]) if each is not None and each[1] else None for each in found)
