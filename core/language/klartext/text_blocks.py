"""Texts of Klartext (QS): DECLARE STRING, QSn = …, what is read of them, and free tables (FN 26, 27, 28)."""

from __future__ import annotations

import re

from core.language.formulas import Formula
from core.language.klartext.klartext_faults import syntax
from core.language.klartext.klartext_nodes import (
    TableOpen,
    TableRead,
    TableWrite,
    TextAssign,
    TextPart,
    TextRead,
)
from core.language.klartext.line_cursor import Cursor
from core.message import Message

_HIGHEST = 1999
_TARGET = re.compile(r"QS\s*([0-9]+)")
_EQUALS = re.compile(r"=")
_AND = re.compile(r"\|\|")
_COMMA = re.compile(r",")
_OPEN, _CLOSED = re.compile(r"\("), re.compile(r"\)")
_MADE = re.compile(r"(TOCHAR|SUBSTR|SYSSTR|CFGREAD)(?=\s*\()")
_REST_OF_BRACKETS = re.compile(r"\([^()]*\)")
_SOURCE = re.compile(r"SRC_(?=QS)")
_SOUGHT = re.compile(r"SEA_(?=QS)")
_DATA = re.compile(r"DAT(?=\s*[+\-0-9Q])")
_COUNTS = {word: re.compile(rf"{word}(?=\s*[+\-0-9Q])") for word in ("BEG", "LEN", "DECIMALS")}
READERS = ("TONUMB", "INSTR", "STRLEN", "STRCOMP")
"""Functions that make a number of texts."""

_READER = re.compile("|".join(READERS))


def declare(cursor: Cursor, column: int) -> TextAssign:
    """Behind ``DECLARE STRING``: one text or several. Raises ProgramError."""
    found = [_one(cursor)]
    while cursor.take(_COMMA):
        found.append(_one(cursor))
    return _whole(cursor, TextAssign(tuple(found), column))


def assign(cursor: Cursor, column: int) -> TextAssign:
    """``QS5 = "A" || QS6``. Raises ProgramError."""
    return _whole(cursor, TextAssign((_one(cursor),), column))


def _whole(cursor: Cursor, made: TextAssign) -> TextAssign:
    if not cursor.done:
        raise cursor.expected("Unexpected word after a string", "Join strings with ||.")
    return made


def _one(cursor: Cursor) -> tuple[int, tuple[TextPart, ...]]:
    """The number of a text and its parts."""
    number = _number(cursor)
    if cursor.take(_EQUALS) is None:
        raise cursor.expected(Message("Expected '=' after QS{number}", number=number))
    parts = [part(cursor)]
    while cursor.take(_AND):
        parts.append(part(cursor))
    return number, tuple(parts)


def _number(cursor: Cursor) -> int:
    column, match = cursor.column, cursor.take(_TARGET)
    if match is None:
        raise cursor.expected("Expected a string parameter", "Write QS and a number.")
    number = int(match.group(1)[:6])
    if number > _HIGHEST:
        message = Message("The highest QS parameter is QS{highest}.", highest=_HIGHEST)
        raise syntax(cursor.line, column, message, "Use a parameter with a smaller number.")
    return number


def part(cursor: Cursor) -> TextPart:
    """A text in quotes, QS and a number, or a function that makes a text. Raises ProgramError."""
    column = cursor.column
    if (text := cursor.quoted()) is not None:
        return TextPart("", text, column=column)
    if match := cursor.take(_MADE):
        return _made(cursor, match.group(1), column)
    if not _TARGET.match(cursor.upper, cursor.at):
        raise cursor.expected("Expected a string", ("Write the string in quotes, or QS and a number."))
    return TextPart("QS", number=_number(cursor), column=column)


def _made(cursor: Cursor, name: str, column: int) -> TextPart:
    if name not in {"TOCHAR", "SUBSTR"}:
        if cursor.take(_REST_OF_BRACKETS) is None:
            raise cursor.expected(
                Message("The closing parenthesis of {name} is missing", name=name), "Write ) at the end."
            )
        return TextPart(name, column=column)
    _bracket(cursor, name, _OPEN)
    if name == "TOCHAR":
        if cursor.take(_DATA) is None:
            raise cursor.expected("TOCHAR needs DAT", "Write, for example, TOCHAR(DAT+Q5 DECIMALS3).")
        made = TextPart(name, column=column, first=cursor.value("DAT").formula)
        made = made._replace(second=_count(cursor, "DECIMALS"))
    else:
        source = _named(cursor, _SOURCE, name, "SRC_")
        made = TextPart(name, number=source, column=column, first=_count(cursor, "BEG"))
        made = made._replace(second=_count(cursor, "LEN"))
    _bracket(cursor, name, _CLOSED)
    return made


def _bracket(cursor: Cursor, name: str, sign: re.Pattern[str]) -> None:
    if cursor.take(sign) is None:
        raise cursor.expected(Message("{name} needs its arguments in parentheses", name=name))


def _named(cursor: Cursor, word: re.Pattern[str], name: str, written: str) -> int:
    if cursor.take(word) is None:
        raise cursor.expected(Message("{name} needs {written}QS and a number", name=name, written=written))
    return _number(cursor)


def _count(cursor: Cursor, word: str) -> Formula | None:
    return cursor.value(word).formula if cursor.take(_COUNTS[word]) else None


def read(cursor: Cursor, kind: str, q: int) -> TextRead | None:
    """``STRLEN( SRC_QS15 )`` behind ``Q5 =``; None where a formula stands. Raises ProgramError."""
    column, match = cursor.column, cursor.take(_READER)
    if match is None:
        return None
    name = match.group()
    _bracket(cursor, name, _OPEN)
    source = _named(cursor, _SOURCE, name, "SRC_")
    sought = _named(cursor, _SOUGHT, name, "SEA_") if name in {"INSTR", "STRCOMP"} else None
    begin = _count(cursor, "BEG")
    _bracket(cursor, name, _CLOSED)
    if not cursor.done:
        raise cursor.expected(
            Message("{name} cannot be part of a longer formula", name=name),
            "Continue the calculation in a separate block.",
        )
    return TextRead(kind, q, name, source, sought, begin, column)


# --- free tables


_SLASH = re.compile(r"/")
_RESULT = re.compile(r"(QS|Q[LR]?)\s*([0-9]{1,4})")


def open_table(cursor: Cursor, column: int) -> TableOpen:
    """Behind ``FN 26:``: ``TABOPEN TNC:\\DIR\\TAB1.TAB``."""
    if not cursor.keyword("TABOPEN"):
        raise cursor.expected("FN 26 needs TABOPEN and a file name")
    name = cursor.rest().strip('"')
    if not name:
        raise cursor.expected("TABOPEN needs a table name")
    return TableOpen(name, column)


def read_table(cursor: Cursor, column: int) -> TableRead:
    """Behind ``FN 28:``: ``TABREAD Q10 = 6/"X,Y"``. Raises ProgramError."""
    if not cursor.keyword("TABREAD"):
        raise cursor.expected("FN 28 needs TABREAD")
    kind, number = _result(cursor)
    if cursor.take(_EQUALS) is None:
        raise cursor.expected("TABREAD needs = and a row number")
    return TableRead(kind, number, *_cells(cursor), column)


def write_table(cursor: Cursor, column: int) -> TableWrite:
    """Behind ``FN 27:``: ``TABWRITE 5/"RADIUS,DEPTH" = Q5``. Raises ProgramError."""
    if not cursor.keyword("TABWRITE"):
        raise cursor.expected("FN 27 needs TABWRITE")
    row, columns = _cells(cursor)
    if cursor.take(_EQUALS) is None:
        raise cursor.expected("TABWRITE needs = and a parameter")
    kind, number = _result(cursor)
    return TableWrite(kind, number, row, columns, column)


def _result(cursor: Cursor) -> tuple[str, int]:
    match = cursor.take(_RESULT)
    if match is None:
        raise cursor.expected("Expected a parameter")
    return match.group(1), int(match.group(2))


def _cells(cursor: Cursor) -> tuple[Formula, tuple[str, ...]]:
    """A row and the names of its columns."""
    row = cursor.value("The row number").formula
    if cursor.take(_SLASH) is None or not (names := cursor.quoted()):
        raise cursor.expected(
            "The column names are missing", ('Write the column names after the row number, as in 6/"X,Y".')
        )
    return row, tuple(name.strip().upper() for name in names.split(","))
