"""Texts while a Klartext program runs (QS), names that they hold, and free tables (FN 26, 27, 28).

The first sign of a text stands at place 0 (manual). What SYSSTR and CFGREAD would give is not known here: a
text of theirs may be printed, and is refused where something goes by it.
"""

from __future__ import annotations

from collections.abc import Callable

from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.q_functions import content, keep, value
from core.language.formulas import Formula
from core.language.klartext.klartext_faults import FILE_MISSING, INPUT_VALUE, MissingValueError, unsupported
from core.language.klartext.klartext_nodes import (
    Jump,
    TableRead,
    TableWrite,
    TextAssign,
    TextName,
    TextPart,
    TextRead,
)
from core.language.klartext.table_file import Row
from core.message import Message

MOST_SIGNS = 255
_MOST_DECIMALS = 9
_NEVER_SET = -1.0  # what STRLEN gives of a text without a value (manual)


def assign_text(state: State, node: TextAssign) -> None:
    """``QS5 = …``. Raises ProgramError for a text that is too long or made of one without a value."""
    for number, parts in node.texts:
        made = [_of(state, part) for part in parts]
        unknown = next((part.kind for part, text in zip(parts, made, strict=True) if text is None), "")
        if unknown:
            state.texts[number] = None
            state.unheeded(
                Message(
                    ("Function {unknown} in string parameter QS{number}"), unknown=unknown, number=number
                ),
                node.column,
            )
            continue
        text = "".join(filter(None, made))
        if len(text) > MOST_SIGNS:
            message = Message(
                "QS{number} would have {text_count} characters, which is too many.",
                number=number,
                text_count=len(text),
            )
            raise state.refuse(
                node.column,
                INPUT_VALUE,
                message,
                Message("The maximum is {most_points} points.", most_points=MOST_SIGNS),
            )
        state.texts[number] = text


def text_of(state: State, name: TextName) -> str:
    """The text of QS. Raises ProgramError where it has none, or nobody knows it here."""
    found = _kept(state, name.number, name.column)
    if found is None:
        raise unsupported(
            state.line,
            name.column,
            (Message("A function that uses text supplied by the control in QS{number}", number=name.number)),
        )
    return found


def _kept(state: State, number: int, column: int) -> str | None:
    if number not in state.texts:
        raise MissingValueError(state.line, column, ("QS", number))
    return state.texts[number]


def _of(state: State, part: TextPart) -> str | None:
    """A part of a text; None where it is the control's own."""
    if part.kind == "":
        return part.text
    if part.kind == "QS":
        return _kept(state, part.number, part.column)
    if part.kind == "TOCHAR":
        return _number_as_text(state, part)
    if part.kind == "SUBSTR":
        return _cut(state, part)
    return None


def _number_as_text(state: State, part: TextPart) -> str:
    """TOCHAR: the number with so many decimals, rounded."""
    assert part.first is not None
    decimals = 0 if part.second is None else int(value(state, part.second))
    if not 0 <= decimals <= _MOST_DECIMALS:
        text = Message(
            "DECIMALS{decimals} is not between 0 and {most_decimals}.",
            decimals=decimals,
            most_decimals=_MOST_DECIMALS,
        )
        raise state.refuse(part.column, INPUT_VALUE, text, "Correct the value.")
    return f"{value(state, part.first):.{decimals}f}"


def _cut(state: State, part: TextPart) -> str | None:
    """SUBSTR: LEN signs from place BEG, both from 0 and to the end where they are missing."""
    whole = _kept(state, part.number, part.column)
    begin = _whole(state, part.first, 0)
    length = _whole(state, part.second, MOST_SIGNS)
    if begin < 0 or length < 0:
        text = "BEG and LEN of SUBSTR cannot be negative."
        raise state.refuse(part.column, INPUT_VALUE, text, "Correct the value.")
    return None if whole is None else whole[begin : begin + length]


def _whole(state: State, formula: Formula | None, without: int) -> int:
    return without if formula is None else int(value(state, formula))


# --- numbers of texts


def read_text(state: State, node: TextRead) -> None:
    """TONUMB, INSTR, STRLEN, STRCOMP. Raises ProgramError."""
    if node.function == "STRLEN" and node.source not in state.texts:
        keep(state, node.kind, node.q, _NEVER_SET)
        return
    source = text_of(state, TextName(node.source, node.column))
    sought = "" if node.sought is None else text_of(state, TextName(node.sought, node.column))
    begin = _whole(state, node.begin, 0)
    if node.function == "TONUMB":
        found = _as_number(state, node, source)
    else:
        found = _READ[node.function](source, sought, begin)
    keep(state, node.kind, node.q, found)


def _as_number(state: State, node: TextRead, text: str) -> float:
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        message = Message('QS{source}, "{text}", is not a number.', source=node.source, text=text)
        raise state.refuse(
            node.column, INPUT_VALUE, message, ("Check the content of the QS parameter.")
        ) from None


def _place(source: str, sought: str, begin: int) -> float:
    """Where a text stands in another one from ``begin`` on; its length where it does not (manual)."""
    found = source.find(sought, max(begin, 0))
    return float(found if found >= 0 else len(source))


_READ: dict[str, Callable[[str, str, int], float]] = {
    "STRLEN": lambda source, _, __: float(len(source)),
    "STRCOMP": lambda source, sought, _: float((source > sought) - (source < sought)),
    "INSTR": _place,
}


def texts_agree(state: State, node: Jump) -> bool:
    """Whether FN 9 (equal) or FN 10 (unequal) holds of two texts. Raises ProgramError."""
    assert node.texts is not None
    known = []
    for part in node.texts:
        text = _of(state, part)
        if text is None:
            raise unsupported(
                state.line, part.column, ("A jump that depends on text supplied by the control")
            )
        known.append(text)
    return (known[0] == known[1]) == (value(state, node.condition) != 0.0)


# --- free tables


def read_cells(state: State, node: TableRead) -> None:
    """FN 28: cells of a row into parameters one after the other. Raises ProgramError."""
    row = _row(state, node)
    for offset, column in enumerate(node.columns):
        if column not in row:
            text = Message("The table row does not contain a number in column {column}.", column=column)
            raise state.refuse(node.column, INPUT_VALUE, text, ("Correct the column, or fill in the cell."))
        keep(state, node.kind, node.q + offset, row[column])


def write_cells(state: State, node: TableWrite) -> None:
    """FN 27: the cells hold it for this pass; the file stays as it is, which is told. Raises ProgramError."""
    row = _row(state, node)
    for offset, column in enumerate(node.columns):
        row[column] = content(state, node.kind, node.q + offset, node.column)
    state.unheeded("Writing to the file with FN 27: TABWRITE", node.column)


def _row(state: State, node: TableRead | TableWrite) -> Row:
    if state.free_table is None:
        text = "No table is open."
        raise state.refuse(
            node.column, FILE_MISSING, text, ("Open the file with FN 26: TABOPEN before this block.")
        )
    if node.kind == "QS":
        raise unsupported(state.line, node.column, "Text in a freely definable table")
    number = int(value(state, node.row))
    if number not in state.free_table:
        text = Message("The table has no row {number}.", number=number)
        raise state.refuse(node.column, INPUT_VALUE, text, "Correct the row number.")
    return state.free_table[number]
