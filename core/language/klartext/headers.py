"""Program frame, blank form and tool call."""

from __future__ import annotations

import re

from core.language.diagnostics import ProgramError
from core.language.klartext import faults
from core.language.klartext.cursor import Cursor
from core.language.klartext.feeds import axis_words, doubled
from core.language.klartext.nodes import AxisWord, Begin, BlankForm, End, ToolCall, Value

_PROGRAM = re.compile(r"(\S.*?)\s+(MM|INCH)\s*$")
_PART = re.compile(r"0\.([12])(?![0-9])")
_AXIS = re.compile(r"([XYZUVW])(?![A-Z0-9+\-])")
_TOOL_WORD = re.compile(r"(DL|DR|S|F)(?=\s*[+\-0-9.,Q])")
_TOOL = re.compile(r'(?=[0-9"])')
MOST_TOOL = 32767


def begin(cursor: Cursor) -> Begin:
    """Behind ``BEGIN PGM``."""
    return Begin(*_named(cursor, "BEGIN PGM"))


def end(cursor: Cursor) -> End:
    """Behind ``END PGM``."""
    return End(*_named(cursor, "END PGM"))


def _named(cursor: Cursor, what: str) -> tuple[str, bool]:
    match = _PROGRAM.match(cursor.text[cursor.at :].upper())
    if match is None:
        raise faults.syntax(
            cursor.line, cursor.column, f"{what} needs a name and MM or INCH.", "Write both behind it."
        )
    name = cursor.text[cursor.at : cursor.at + len(match.group(1))]
    cursor.rest()
    return name, match.group(2) == "INCH"


def blank_form(cursor: Cursor) -> BlankForm:
    """Behind ``BLK FORM``: two corners of a block. Raises ProgramError for other forms."""
    part = cursor.take(_PART)
    if part is None:
        raise faults.unsupported(cursor.line, cursor.column, f"BLK FORM {cursor.rest()}".strip())
    axis = ""
    if part.group(1) == "1":
        found = cursor.take(_AXIS)
        if found is None or found.group(1) not in "XYZ":
            raise cursor.expected("BLK FORM 0.1 needs the tool axis", "Write Z behind 0.1.")
        axis = found.group(1)
    corner = axis_words(cursor, "XYZ", incremental=False)
    _demand_all(cursor, corner)
    return BlankForm(int(part.group(1)), corner, axis)


def _demand_all(cursor: Cursor, corner: tuple[AxisWord, ...]) -> None:
    missing = [axis for axis in "XYZ" if axis not in {word.axis for word in corner}]
    if missing:
        raise cursor.expected(f"{', '.join(missing)} is missing", "A corner needs X, Y and Z.")
    if not cursor.done:
        raise cursor.expected("No word of BLK FORM")


def tool_call(cursor: Cursor) -> ToolCall:
    """Behind ``TOOL CALL``."""
    column = cursor.column
    tool = cursor.name("TOOL CALL", MOST_TOOL) if cursor.take(_TOOL) else None
    found = cursor.take(_AXIS)
    axis = "" if found is None else found.group(1)
    words: dict[str, Value] = {}
    while not cursor.done:
        at = cursor.column
        match = cursor.take(_TOOL_WORD)
        if match is None:
            raise _strange_word(cursor)
        name = match.group(1)
        if name in words:
            raise doubled(cursor, at, name)
        words[name] = cursor.value(name)
    return ToolCall(tool, axis, words.get("S"), words.get("F"), words.get("DL"), words.get("DR"), column)


def _strange_word(cursor: Cursor) -> ProgramError:
    return cursor.expected("No word of TOOL CALL", "It takes a tool, its axis, S, F, DL and DR.")
