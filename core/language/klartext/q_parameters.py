"""Readers of Q parameter blocks: formulas, and the functions FN 0 to FN 38."""

from __future__ import annotations

import re
from collections.abc import Callable

from core.language.formulas import (
    FUNCTIONS,
    Formula,
    FormulaError,
    FormulaReader,
    Grammar,
    Operation,
    Parameter,
)
from core.language.klartext.klartext_faults import FREE_TABLE, STRING, syntax, unsupported
from core.language.klartext.klartext_nodes import (
    Assign,
    ErrorMessage,
    Jump,
    Node,
    SystemRead,
    SystemWrite,
    Unheeded,
)
from core.language.klartext.line_cursor import NUMBER, Cursor
from core.message import Message

_PARAMETER = re.compile(r"(Q[LR]?)\s*([0-9]{1,4})(?![0-9])")
_TIMES, _POWER = 40, 60

MAX_FEED = 99999.0
"""A feed of a cycle from which on it is a rapid; FMAX is written so too."""

TOOL_FEED = -1.0
"""FAUTO in a cycle: the feed of the last TOOL CALL."""

GRAMMAR = Grammar(
    number=re.compile(rf"{NUMBER}(?:E[+-]?[0-9]{{1,3}})?"),
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
        **FUNCTIONS,
        "ATAN": "arc tangent",
        "SQ": "square",
        "LOG": "common logarithm",
        "NEG": "negative",
        "INT": "integer part",
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
_EQUAL = 9
_A_TEXT = re.compile(r'"|QS')
_OF_TEXTS = re.compile(r"(?:TONUMB|INSTR|STRLEN|STRCOMP)(?![A-Z])")
_OF_FREE_TABLES = frozenset({26, 27, 28})
WHETHER = "?"
"""Behind the letters of a parameter: 1 where it has a value, else 0."""
_UNHEEDED = {15: "PRINT", 16: "F-PRINT", 38: "SEND"}
_OF_THE_BUILDER = {
    19: "PLC (sends values to the machine builder's PLC)",
    29: "PLC (sends values to the machine builder's PLC)",
    37: "EXPORT (for machine-builder cycles)",
}
MOST_LABEL = 65535


def formula(cursor: Cursor, what: str) -> Formula:
    """Read the complete formula for ``what``. Raises ProgramError if it is invalid."""
    reader = FormulaReader(GRAMMAR, cursor.upper, cursor.at)
    try:
        made = reader.formula()
    except FormulaError as problem:
        cursor.at = problem.at
        cursor.blanks()
        raise cursor.expected(
            Message("{what}: {problem}", what=what, problem=problem), problem.hint
        ) from None
    cursor.at = reader.at
    cursor.blanks()
    return made


def assign(cursor: Cursor) -> Assign:
    """Read ``Q5 = …`` to the end of the line. Raises ProgramError for string functions."""
    column, (kind, number) = cursor.column, _target(cursor)
    if _OF_TEXTS.match(cursor.upper, cursor.at):
        raise STRING.error(cursor.line, cursor.column)
    made = formula(cursor, f"{kind}{number}")
    cursor.demand_end("Expected an operator")
    return Assign(number, made, column, kind)


def function(cursor: Cursor, number: int, column: int) -> Node:
    """Read the block after ``FN n:``. Raises ProgramError for functions that TurnDesk does not support."""
    cursor.take(_COLON)
    if number in _UNHEEDED:
        cursor.rest()
        return Unheeded(Message("FN {number} {unheeded}", number=number, unheeded=_UNHEEDED[number]), column)
    if number in _JUMPS:
        return _jump(cursor, number, column)
    if number in _READERS:
        return _READERS[number](cursor, column)
    if number == 0 or number in _TWO or number in _ONE or number == _ANGLE:
        return _arithmetic(cursor, number, column)
    if number in _OF_FREE_TABLES:
        raise FREE_TABLE.error(cursor.line, column)
    what = (
        Message(" {of_the_builder}", of_the_builder=_OF_THE_BUILDER[number])
        if number in _OF_THE_BUILDER
        else ""
    )
    raise unsupported(cursor.line, column, Message("FN {number}{what}", number=number, what=what))


def parameter(cursor: Cursor) -> tuple[str, int]:
    """Read the kind and number of a parameter. Raises ProgramError if the number is too high."""
    column, match = cursor.column, cursor.take(_TARGET)
    if match is None:
        raise cursor.expected("Expected a Q parameter")
    kind, number = match.group(1), int(match.group(2)[:6])
    if number > HIGHEST[kind]:
        text = Message(
            "{kind} parameters go up to {kind2}{highest}.", kind=kind, kind2=kind, highest=HIGHEST[kind]
        )
        raise syntax(cursor.line, column, text, "Use a parameter with a smaller number.")
    return kind, number


def _target(cursor: Cursor) -> tuple[str, int]:
    kind, number = parameter(cursor)
    if cursor.take(_EQUALS) is None:
        raise cursor.expected(Message("Expected '=' after {kind}{number}", kind=kind, number=number))
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
    cursor.demand_end(Message("Unexpected word in FN {number}", number=number))
    return Assign(q, made, column, kind)


def _operand(cursor: Cursor, q: int) -> Formula:
    """Read a number or a parameter with its sign. FN does not accept formulas."""
    value = cursor.value(f"Q{q}")
    return value.formula


def _demand(cursor: Cursor, word: str, number: int) -> None:
    if word.isalpha():
        found = cursor.keyword(word)
    else:
        found = word if cursor.take(re.compile(re.escape(word))) else None
    if found is None:
        raise cursor.expected(Message("FN {number} needs {word}", number=number, word=word))


def _jump(cursor: Cursor, number: int, column: int) -> Jump:
    word, name = _JUMPS[number]
    if not cursor.take(re.compile(r"IF")):
        raise cursor.expected(Message("FN {number} needs IF", number=number))
    if _A_TEXT.match(cursor.upper, cursor.at):
        raise STRING.error(cursor.line, cursor.column)
    value = cursor.value("IF")
    if number == _EQUAL and (state := cursor.keyword("IS UNDEFINED", "IS DEFINED")):
        condition: Formula = Parameter(value.kind + WHETHER, value.q, value.column)
        if state == "IS UNDEFINED":
            condition = Operation("not", (condition,), column)
    else:
        _demand(cursor, word, number)
        condition = Operation(name, (value.formula, _operand(cursor, 0)), column)
    return _whole_jump(cursor, condition)


def _whole_jump(cursor: Cursor, condition: Formula) -> Jump:
    """Read the label after GOTO. Raises ProgramError if it is missing."""
    if not cursor.keyword("GOTO LBL"):
        raise cursor.expected("A jump needs GOTO LBL")
    at = cursor.column
    made = Jump(condition, cursor.name("GOTO LBL", MOST_LABEL), at)
    cursor.demand_end("Unexpected word in a jump")
    return made


def _wait(cursor: Cursor, column: int) -> Unheeded:
    """Read FN 20: WAIT FOR SYNC, which has no effect. Raises ProgramError for a PLC condition."""
    if not cursor.keyword("WAIT FOR SYNC") or not cursor.done:
        raise unsupported(cursor.line, column, "FN 20 with a condition from the machine builder's PLC")
    return Unheeded("FN 20 WAIT FOR SYNC", column)


def _error(cursor: Cursor, column: int) -> ErrorMessage:
    if not cursor.keyword("ERROR") or not cursor.take(_EQUALS):
        raise cursor.expected("FN 14 needs ERROR =")
    return ErrorMessage(cursor.whole("ERROR", 9999), column)


def _system(cursor: Cursor, column: int) -> SystemRead:
    if not cursor.keyword("SYSREAD"):
        raise cursor.expected("FN 18 needs SYSREAD")
    kind, q = _target(cursor)
    group, number, index = _place(cursor, 18)
    cursor.demand_end("Unexpected word in FN 18")
    return SystemRead(q, group, number, index, column, kind)


def _system_write(cursor: Cursor, column: int) -> SystemWrite:
    if not cursor.keyword("SYSWRITE"):
        raise cursor.expected("FN 17 needs SYSWRITE")
    group, number, index = _place(cursor, 17)
    if cursor.take(_EQUALS) is None:
        raise cursor.expected("FN 17 needs = and a value to write")
    made = SystemWrite(group, number, index, _operand(cursor, 0), column)
    cursor.demand_end("Unexpected word in FN 17")
    return made


def _place(cursor: Cursor, function: int) -> tuple[Formula, Formula, Formula | None]:
    """Read the group, number and index of a system value."""
    found: dict[str, Formula] = {}
    for word in ("ID", "NR", "IDX"):
        if cursor.take(re.compile(rf"{word}(?=\s*[+\-0-9Q])")):
            found[word] = _operand(cursor, 0)
    if "ID" not in found or "NR" not in found:
        raise cursor.expected(Message("FN {function} needs ID and NR", function=function))
    return found["ID"], found["NR"], found.get("IDX")


_READERS: dict[int, Callable[[Cursor, int], Node]] = {
    14: _error,
    17: _system_write,
    18: _system,
    20: _wait,
}
