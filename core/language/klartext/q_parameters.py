"""Q parameters: formulas, and the functions FN 0 to FN 18."""

from __future__ import annotations

import re

from core.language.formulas import Formula, FormulaError, FormulaReader, Grammar, Operation
from core.language.klartext.klartext_faults import syntax, unsupported
from core.language.klartext.klartext_nodes import Assign, ErrorMessage, Jump, Node, SystemRead, Unheeded
from core.language.klartext.line_cursor import Cursor

_NUMBER = re.compile(r"(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)(?:E[+-]?[0-9]{1,3})?")
_PARAMETER = re.compile(r"(Q[LR]?)\s*([0-9]{1,4})(?![0-9])")
_TIMES, _POWER = 40, 60

MAX_FEED = 99999.0
"""A feed of a cycle from which on it is a rapid; FMAX is written so too."""

TOOL_FEED = -1.0
"""FAUTO in a cycle: the feed of the last TOOL CALL."""

GRAMMAR = Grammar(
    number=_NUMBER,
    parameter=_PARAMETER,
    operators={
        "+": (30, "plus"),
        "-": (30, "minus"),
        "*": (_TIMES, "times"),
        "/": (_TIMES, "over"),
        "%": (_TIMES, "modulo"),
        "^": (_POWER, "power"),
    },
    functions={
        "SIN": "sine",
        "COS": "cosine",
        "TAN": "tangent",
        "ASIN": "arc sine",
        "ACOS": "arc cosine",
        "ATAN": "arc tangent",
        "SQ": "square",
        "SQRT": "square root",
        "LN": "natural logarithm",
        "LOG": "common logarithm",
        "EXP": "exponential",
        "NEG": "negative",
        "INT": "whole part",
        "ABS": "absolute",
        "FRAC": "fraction",
        "SGN": "sign",
    },
    constants={
        "PI": 3.141592653589793,
        "FMAX": MAX_FEED,
        "MAX": MAX_FEED,
        "FAUTO": TOOL_FEED,
        "AUTO": TOOL_FEED,
    },
)
"""Formulas behind ``Qn =``."""

HIGHEST = {"Q": 1999, "QL": 499, "QR": 499}
"""The highest number of each kind of parameter."""

_EQUALS = re.compile(r"=")
_COLON = re.compile(r":?")
_TARGET = re.compile(r"(Q[LR]?)\s*([0-9]+)")
_TWO = {1: ("+", "plus"), 2: ("-", "minus"), 3: ("*", "times"), 4: ("DIV", "over"), 8: ("LEN", "length")}
_ONE = {5: ("SQRT", "square root"), 6: ("SIN", "sine"), 7: ("COS", "cosine")}
_ANGLE = 13
_JUMPS = {9: ("EQU", "equal"), 10: ("NE", "unequal"), 11: ("GT", "greater"), 12: ("LT", "less")}
_UNHEEDED = {15: "PRINT", 16: "F-PRINT"}
MOST_LABEL = 65535


def formula(cursor: Cursor, what: str) -> Formula:
    """A whole formula for ``what``. Raises ProgramError where it cannot be read."""
    reader = FormulaReader(GRAMMAR, cursor.upper, cursor.at)
    try:
        made = reader.formula()
    except FormulaError as problem:
        cursor.at = problem.at
        cursor.blanks()
        raise cursor.expected(f"{problem} for {what}", problem.hint) from None
    cursor.at = reader.at
    cursor.blanks()
    return made


def assign(cursor: Cursor) -> Assign:
    """``Q5 = …`` to the end of the line."""
    column, (kind, number) = cursor.column, _target(cursor)
    made = formula(cursor, f"{kind}{number}")
    if not cursor.done:
        raise cursor.expected("An operator was expected")
    return Assign(number, made, column, kind)


def function(cursor: Cursor, number: int, column: int) -> Node:
    """Behind ``FN n:``. Raises ProgramError for those that this control does not execute."""
    cursor.take(_COLON)
    if number in _JUMPS:
        return _jump(cursor, number, column)
    if number == 14:
        return _error(cursor, column)
    if number in _UNHEEDED:
        cursor.rest()
        return Unheeded(f"FN {number} {_UNHEEDED[number]}", column)
    if number == 18:
        return _system(cursor, column)
    if number == 0 or number in _TWO or number in _ONE or number == _ANGLE:
        return _arithmetic(cursor, number, column)
    raise unsupported(cursor.line, column, f"FN {number}")


def parameter(cursor: Cursor) -> tuple[str, int]:
    """Kind and number of the parameter that stands here. Raises ProgramError for one too high."""
    column, match = cursor.column, cursor.take(_TARGET)
    if match is None:
        raise cursor.expected("A Q parameter was expected")
    kind, number = match.group(1), int(match.group(2)[:6])
    if number > HIGHEST[kind]:
        text = f"{kind} parameters go up to {kind}{HIGHEST[kind]}."
        raise syntax(cursor.line, column, text, "Take another parameter.")
    return kind, number


def _target(cursor: Cursor) -> tuple[str, int]:
    kind, number = parameter(cursor)
    if cursor.take(_EQUALS) is None:
        raise cursor.expected(f"'=' was expected behind {kind}{number}")
    return kind, number


def _arithmetic(cursor: Cursor, number: int, column: int) -> Assign:
    kind, q = _target(cursor)
    if number in _ONE:
        word, name = _ONE[number]
        _demand(cursor, word, number)
        made: Formula = Operation(name, (_operand(cursor, q),), column)
    else:
        made = _operand(cursor, q)
        if number != 0:
            word, name = ("ANG", "angle") if number == _ANGLE else _TWO[number]
            _demand(cursor, word, number)
            made = Operation(name, (made, _operand(cursor, q)), column)
    if not cursor.done:
        raise cursor.expected(f"FN {number} has more than it takes")
    return Assign(q, made, column, kind)


def _operand(cursor: Cursor, q: int) -> Formula:
    """A number or a parameter with its sign: FN takes no formula."""
    value = cursor.value(f"Q{q}")
    return value.formula


def _demand(cursor: Cursor, word: str, number: int) -> None:
    if word.isalpha():
        found = cursor.keyword(word)
    else:
        found = word if cursor.take(re.compile(re.escape(word))) else None
    if found is None:
        raise cursor.expected(f"FN {number} needs {word}")


def _jump(cursor: Cursor, number: int, column: int) -> Jump:
    word, name = _JUMPS[number]
    if not cursor.take(re.compile(r"IF")):
        raise cursor.expected(f"FN {number} needs IF")
    first = _operand(cursor, 0)
    _demand(cursor, word, number)
    second = _operand(cursor, 0)
    if not cursor.keyword("GOTO LBL"):
        raise cursor.expected(f"FN {number} needs GOTO LBL")
    at = cursor.column
    made = Jump(Operation(name, (first, second), column), cursor.name("GOTO LBL", MOST_LABEL), at)
    if not cursor.done:
        raise cursor.expected("No word of a jump")
    return made


def _error(cursor: Cursor, column: int) -> ErrorMessage:
    if not cursor.keyword("ERROR") or not cursor.take(_EQUALS):
        raise cursor.expected("FN 14 needs ERROR =")
    return ErrorMessage(cursor.whole("ERROR", 9999), column)


def _system(cursor: Cursor, column: int) -> SystemRead:
    if not cursor.keyword("SYSREAD"):
        raise cursor.expected("FN 18 needs SYSREAD")
    kind, q = _target(cursor)
    found: dict[str, Formula] = {}
    for word in ("ID", "NR", "IDX"):
        if cursor.take(re.compile(rf"{word}(?=\s*[+\-0-9Q])")):
            found[word] = _operand(cursor, q)
    if "ID" not in found or "NR" not in found:
        raise cursor.expected("FN 18 needs ID and NR")
    if not cursor.done:
        raise cursor.expected("No word of FN 18")
    return SystemRead(q, found["ID"], found["NR"], found.get("IDX"), column, kind)
