"""Parsers of Q parameter blocks, with formulas and the functions FN 0 to FN 38."""

from __future__ import annotations

import re
from collections.abc import Callable

from core.language.formulas import (
    FUNCTION_OPERATIONS,
    Formula,
    FormulaError,
    FormulaGrammar,
    FormulaReader,
    Operation,
    Parameter,
)
from core.language.klartext.klartext_faults import (
    FREE_TABLES,
    STRING_FUNCTIONS,
    make_syntax_error,
    make_unsupported_error,
)
from core.language.klartext.klartext_nodes import (
    Assignment,
    ConditionalJump,
    ErrorMessageBlock,
    IgnoredBlock,
    Node,
    SystemRead,
    SystemWrite,
)
from core.language.klartext.line_cursor import NUMBER_PATTERN, LineCursor
from core.message import Message

_PARAMETER = re.compile(r"(Q[LR]?)\s*([0-9]{1,4})(?![0-9])")
_TIMES, _POWER = 40, 60

MAX_FEED_VALUE = 99999.0
"""Cycle feed at or above which the control uses rapid traverse. FMAX is also stored as this value."""

TOOL_FEED_VALUE = -1.0
"""Value of FAUTO in a cycle. It means the feed of the last TOOL CALL."""

KLARTEXT_GRAMMAR = FormulaGrammar(
    number_pattern=re.compile(rf"{NUMBER_PATTERN}(?:E[+-]?[0-9]{{1,3}})?"),
    parameter_pattern=_PARAMETER,
    operators={
        "+": (30, "plus"),
        "-": (30, "minus"),
        "*": (_TIMES, "times"),
        "/": (_TIMES, "over"),
        "%": (_TIMES, "modulo"),
        "^": (_POWER, "power"),
    },
    functions={
        **FUNCTION_OPERATIONS,
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
        "FMAX": MAX_FEED_VALUE,
        "MAX": MAX_FEED_VALUE,
        "FAUTO": TOOL_FEED_VALUE,
        "AUTO": TOOL_FEED_VALUE,
    },
)
"""Grammar of formulas after ``Qn =``."""

MAX_PARAMETER_NUMBERS = {"Q": 1999, "QL": 499, "QR": 499}
"""Highest number of each kind of Q parameter."""

_EQUALS = re.compile(r"=")
_COLON = re.compile(r":?")
_TARGET = re.compile(r"(Q[LR]?)\s*([0-9]+)")
_TWO_OPERANDS = {
    1: ("+", "plus"),
    2: ("-", "minus"),
    3: ("*", "times"),
    4: ("DIV", "over"),
    8: ("LEN", "length"),
}
_ONE_OPERAND = {5: ("SQRT", "square root"), 6: ("SIN", "sine"), 7: ("COS", "cosine")}
_ANGLE = 13
_JUMPS = {9: ("EQU", "equal"), 10: ("NE", "unequal"), 11: ("GT", "greater"), 12: ("LT", "less")}
_EQUAL = 9
_TEXT_PARAMETER = re.compile(r'"|QS')
_TEXT_FUNCTIONS = re.compile(r"(?:TONUMB|INSTR|STRLEN|STRCOMP)(?![A-Z])")
_FREE_TABLE_FUNCTIONS = frozenset({26, 27, 28})
CONDITION_OPERATOR = "?"
"""Suffix of a parameter kind in a condition. The condition is 1 if the parameter has a value, otherwise 0."""
_IGNORED_FUNCTIONS = {15: "PRINT", 16: "F-PRINT", 38: "SEND"}
_MACHINE_BUILDER_FUNCTIONS = {
    19: "PLC (sends values to the machine builder's PLC)",
    29: "PLC (sends values to the machine builder's PLC)",
    37: "EXPORT (for machine-builder cycles)",
}
MAX_LABEL_NUMBER = 65535


def read_full_formula(cursor: LineCursor, description: str) -> Formula:
    """Read a complete formula. Raises ProgramError with ``description`` in the message if it is invalid."""
    reader = FormulaReader(KLARTEXT_GRAMMAR, cursor.uppercase_text, cursor.index)
    try:
        made = reader.read_formula()
    except FormulaError as problem:
        cursor.index = problem.index
        cursor.skip_blanks()
        raise cursor.make_expected_error(
            Message("{what}: {problem}", what=description, problem=problem), problem.hint
        ) from None
    cursor.index = reader.index
    cursor.skip_blanks()
    return made


def read_assignment(cursor: LineCursor) -> Assignment:
    """Read ``Q5 = …`` up to the end of the line.

    Raises ProgramError for a syntax error and for string functions.
    """
    column, (kind, number) = cursor.column, _target(cursor)
    if _TEXT_FUNCTIONS.match(cursor.uppercase_text, cursor.index):
        raise STRING_FUNCTIONS.make_error(cursor.line_number, cursor.column)
    made = read_full_formula(cursor, f"{kind}{number}")
    cursor.check_at_end("Expected an operator")
    return Assignment(number, made, column, kind)


def read_fn_block(cursor: LineCursor, number: int, column: int) -> Node:
    """Read the block after ``FN n:``.

    Raises ProgramError for a syntax error and for functions that TurnDesk does not support.
    """
    cursor.match_pattern(_COLON)
    if number in _IGNORED_FUNCTIONS:
        cursor.read_remaining_text()
        return IgnoredBlock(
            Message("FN {number} {unheeded}", number=number, unheeded=_IGNORED_FUNCTIONS[number]), column
        )
    if number in _JUMPS:
        return _jump(cursor, number, column)
    if number in _READERS:
        return _READERS[number](cursor, column)
    if number == 0 or number in _TWO_OPERANDS or number in _ONE_OPERAND or number == _ANGLE:
        return _arithmetic(cursor, number, column)
    if number in _FREE_TABLE_FUNCTIONS:
        raise FREE_TABLES.make_error(cursor.line_number, column)
    what = (
        Message(" {of_the_builder}", of_the_builder=_MACHINE_BUILDER_FUNCTIONS[number])
        if number in _MACHINE_BUILDER_FUNCTIONS
        else ""
    )
    raise make_unsupported_error(
        cursor.line_number, column, Message("FN {number}{what}", number=number, what=what)
    )


def read_parameter(cursor: LineCursor) -> tuple[str, int]:
    """Read the kind and number of a parameter.

    Raises ProgramError if the cursor is not at a parameter or the number is too high.
    """
    column, match = cursor.column, cursor.match_pattern(_TARGET)
    if match is None:
        raise cursor.make_expected_error("Expected a Q parameter")
    kind, number = match.group(1), int(match.group(2)[:6])
    if number > MAX_PARAMETER_NUMBERS[kind]:
        text = Message(
            "{kind} parameters go up to {kind2}{highest}.",
            kind=kind,
            kind2=kind,
            highest=MAX_PARAMETER_NUMBERS[kind],
        )
        raise make_syntax_error(cursor.line_number, column, text, "Use a parameter with a smaller number.")
    return kind, number


def _target(cursor: LineCursor) -> tuple[str, int]:
    kind, number = read_parameter(cursor)
    if cursor.match_pattern(_EQUALS) is None:
        raise cursor.make_expected_error(
            Message("Expected '=' after {kind}{number}", kind=kind, number=number)
        )
    return kind, number


def _arithmetic(cursor: LineCursor, number: int, column: int) -> Assignment:
    kind, q = _target(cursor)
    if number in _ONE_OPERAND:
        word, name = _ONE_OPERAND[number]
        _demand(cursor, word, number)
        made: Formula = Operation(name, (_operand(cursor, q),), column)
    else:
        made = _operand(cursor, q)
        if number != 0:
            word, name = ("ANG", "angle") if number == _ANGLE else _TWO_OPERANDS[number]
            _demand(cursor, word, number)
            made = Operation(name, (made, _operand(cursor, q)), column)
    cursor.check_at_end(Message("Unexpected word in FN {number}", number=number))
    return Assignment(q, made, column, kind)


def _operand(cursor: LineCursor, q: int) -> Formula:
    """Read an operand of an FN function: a number or a Q parameter, with an optional sign.

    FN functions do not accept formulas as operands. ``q`` is the number of the Q parameter that is shown if
    the operand is missing.
    """
    value = cursor.read_value(f"Q{q}")
    return value.as_formula


def _demand(cursor: LineCursor, word: str, number: int) -> None:
    if word.isalpha():
        found = cursor.read_keyword(word)
    else:
        found = word if cursor.match_pattern(re.compile(re.escape(word))) else None
    if found is None:
        raise cursor.make_expected_error(Message("FN {number} needs {word}", number=number, word=word))


def _jump(cursor: LineCursor, number: int, column: int) -> ConditionalJump:
    word, name = _JUMPS[number]
    if not cursor.match_pattern(re.compile(r"IF")):
        raise cursor.make_expected_error(Message("FN {number} needs IF", number=number))
    if _TEXT_PARAMETER.match(cursor.uppercase_text, cursor.index):
        raise STRING_FUNCTIONS.make_error(cursor.line_number, cursor.column)
    value = cursor.read_value("IF")
    if number == _EQUAL and (state := cursor.read_keyword("IS UNDEFINED", "IS DEFINED")):
        condition: Formula = Parameter(
            value.parameter_kind + CONDITION_OPERATOR, value.parameter_number, value.column
        )
        if state == "IS UNDEFINED":
            condition = Operation("not", (condition,), column)
    else:
        _demand(cursor, word, number)
        condition = Operation(name, (value.as_formula, _operand(cursor, 0)), column)
    return _read_jump(cursor, condition)


def _read_jump(cursor: LineCursor, condition: Formula) -> ConditionalJump:
    """Read the label after GOTO.

    Raises ProgramError if GOTO LBL or the label is missing, or if text follows the label.
    """
    if not cursor.read_keyword("GOTO LBL"):
        raise cursor.make_expected_error("A jump needs GOTO LBL")
    at = cursor.column
    made = ConditionalJump(condition, cursor.read_name("GOTO LBL", MAX_LABEL_NUMBER), at)
    cursor.check_at_end("Unexpected word in a jump")
    return made


def _wait(cursor: LineCursor, column: int) -> IgnoredBlock:
    """Read FN 20: WAIT FOR SYNC, which has no effect. Raises ProgramError for a PLC condition."""
    if not cursor.read_keyword("WAIT FOR SYNC") or not cursor.is_at_end:
        raise make_unsupported_error(
            cursor.line_number, column, "FN 20 with a condition from the machine builder's PLC"
        )
    return IgnoredBlock("FN 20 WAIT FOR SYNC", column)


def _error(cursor: LineCursor, column: int) -> ErrorMessageBlock:
    if not cursor.read_keyword("ERROR") or not cursor.match_pattern(_EQUALS):
        raise cursor.make_expected_error("FN 14 needs ERROR =")
    return ErrorMessageBlock(cursor.read_whole_number("ERROR", 9999), column)


def _system(cursor: LineCursor, column: int) -> SystemRead:
    if not cursor.read_keyword("SYSREAD"):
        raise cursor.make_expected_error("FN 18 needs SYSREAD")
    kind, q = _target(cursor)
    group, number, index = _system_value_address(cursor, 18)
    cursor.check_at_end("Unexpected word in FN 18")
    return SystemRead(q, group, number, index, column, kind)


def _system_write(cursor: LineCursor, column: int) -> SystemWrite:
    if not cursor.read_keyword("SYSWRITE"):
        raise cursor.make_expected_error("FN 17 needs SYSWRITE")
    group, number, index = _system_value_address(cursor, 17)
    if cursor.match_pattern(_EQUALS) is None:
        raise cursor.make_expected_error("FN 17 needs = and a value to write")
    made = SystemWrite(group, number, index, _operand(cursor, 0), column)
    cursor.check_at_end("Unexpected word in FN 17")
    return made


def _system_value_address(cursor: LineCursor, function: int) -> tuple[Formula, Formula, Formula | None]:
    """Read the group, number and index of a system value."""
    found: dict[str, Formula] = {}
    for word in ("ID", "NR", "IDX"):
        if cursor.match_pattern(re.compile(rf"{word}(?=\s*[+\-0-9Q])")):
            found[word] = _operand(cursor, 0)
    if "ID" not in found or "NR" not in found:
        raise cursor.make_expected_error(Message("FN {function} needs ID and NR", function=function))
    return found["ID"], found["NR"], found.get("IDX")


_READERS: dict[int, Callable[[LineCursor, int], Node]] = {
    14: _error,
    17: _system_write,
    18: _system,
    20: _wait,
}
