"""G35, G35F2 and G36: coarse feeds, bought with a coarser step, so the position is said anew each time."""

from __future__ import annotations

from collections.abc import Sequence

from core.interpreter.omniturn.codes.code_entry import MOST_PER_REV, When
from core.interpreter.omniturn.codes.code_rules import check_when, number
from core.interpreter.omniturn.codes.code_table import G_CODES, LETTERS
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import ReadyLine, Statement
from core.interpreter.shared import units

COARSE = frozenset({35, 36})
_SAME = 0.0005 * units.MM_PER_INCH * (1 + 1e-9)  # mm; the coarsest step


def looks_ahead(statement: Statement) -> bool:
    """Whether the lines that follow must be known: G92 behind G35 and G36, tapping behind F."""
    return "F" in statement.words or not COARSE.isdisjoint(statement.modal)


def coarse_line(state: State, statement: Statement, ahead: Sequence[ReadyLine]) -> bool:
    """Carry out a line of G35 or G36; False for any other. Raises ProgramError, for a T under G35 too."""
    if COARSE.isdisjoint(statement.modal):
        if "T" in statement.words:
            check_when(state, statement, LETTERS["T"])
        return False
    _change(state, statement, ahead)
    return True


def _change(state: State, statement: Statement, ahead: Sequence[ReadyLine]) -> None:
    """Take up or leave a coarse step. ``ahead``: the lines that follow."""
    code = 35 if 35 in statement.modal else 36
    before = state.modal.coarse
    entry = G_CODES[code]
    check_when(state, statement, entry, When.WITH_OTHERS)
    if "F" in statement.words:
        number(state, statement, "F", entry)
    check_when(state, statement, entry)
    _check_place(state, statement, code)
    state.coarse_at = (state.x + state.offset_x, state.z + state.offset_z) if code == 35 else None
    modal = state.modal._replace(coarse=0 if code == 36 else 2 if "F" in statement.words else 1)
    if before and code == 36 and modal.per_rev and (modal.feed or 0.0) > MOST_PER_REV[0] * (1 + 1e-9):
        modal = modal._replace(feed=None, cut_feed=None)
    state.adopt(modal)
    _check_preset(state, statement, code, ahead)


def _check_place(state: State, statement: Statement, code: int) -> None:
    """G36 ends a coarse feed where G35 began it."""
    if code == 35 or state.coarse_at is None:
        return
    x, z = state.coarse_at
    if max(abs(state.x + state.offset_x - x), abs(state.z + state.offset_z - z)) > _SAME:
        place = (
            state.modal.length_text(x - state.offset_x),
            state.modal.length_text(z - state.offset_z),
        )
        state.adopt(state.modal._replace(coarse=0))  # so that the rest is judged as it was meant
        text = "G36 is not at the same position as G35, which was at radius {place}, Z {place2}."
        hint = "Move back to the G35 position before G36."
        raise statement.refuse(1, "coarse-place", text, hint, place=place[0], place2=place[1])


def _check_preset(state: State, statement: Statement, code: int, ahead: Sequence[ReadyLine]) -> None:
    """The next line says where the slides stand: G92 with the coordinates in force."""
    line = next((step for step in ahead if step is not None), None)
    hint = "Write G92 with the current X and Z on the next line."
    if not isinstance(line, Statement) or line.one_shot != 92 or not {"X", "Z"}.issubset(line.words):
        text = "G{code} is not followed by a G92 with X and Z."
        raise statement.refuse(1, "coarse-preset", text, hint, code=code)
    x, z = (line.value("X") or 0.0) * state.scale_x, (line.value("Z") or 0.0) * state.scale_z
    if max(abs(x - state.px), abs(z - state.pz)) > _SAME or line.modal:
        here = state.modal.length_text(state.px), state.modal.length_text(state.pz)
        text = (
            "The G92 after G{code} does not match the current position, which is radius {position}, Z "
            "{position2}."
        )
        raise line.refuse("X", "coarse-preset", text, hint, code=code, position=here[0], position2=here[1])
