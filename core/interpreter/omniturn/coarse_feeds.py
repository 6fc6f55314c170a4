"""G35, G35F2 and G36: coarse feeds, bought with a coarser step, so the position is said anew each time."""

from __future__ import annotations

from collections.abc import Sequence

from core.interpreter import units
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import ReadyLine, Statement

COARSE = frozenset({35, 36})
MOST_PER_REV = tuple(inches * units.MM_PER_INCH for inches in (0.2, 1.0, 2.0))
"""The greatest feed and lead, mm/rev, by G36, G35 and G35F2."""

_SAME = 0.0005 * units.MM_PER_INCH * (1 + 1e-9)  # mm; the coarsest step


def looks_ahead(made: Statement) -> bool:
    """Whether the lines that follow must be known: G92 behind G35 and G36, tapping behind F."""
    return "F" in made.words or not COARSE.isdisjoint(made.modal)


def coarse_line(state: State, made: Statement, ahead: Sequence[ReadyLine]) -> bool:
    """Carry out a line of G35 or G36; False for any other. Raises ProgramError, for a T under G35 too."""
    if COARSE.isdisjoint(made.modal):
        if state.modal.coarse and "T" in made.words:
            _refuse_tool(made)
        return False
    _change(state, made, ahead)
    return True


def _change(state: State, made: Statement, ahead: Sequence[ReadyLine]) -> None:
    """Take up or leave a coarse step. ``ahead``: the lines that follow."""
    code = 35 if 35 in made.modal else 36
    before = state.modal.coarse
    _check_alone(made, code)
    _check_change(state, made, code)
    state.coarse_at = (state.x + state.offset_x, state.z + state.offset_z) if code == 35 else None
    modal = state.modal._replace(coarse=0 if code == 36 else 2 if "F" in made.words else 1)
    if before and code == 36 and modal.per_rev and (modal.feed or 0.0) > MOST_PER_REV[0] * (1 + 1e-9):
        modal = modal._replace(feed=None, cut_feed=None)
    state.adopt(modal)
    _check_preset(state, made, code, ahead)


def _refuse_tool(made: Statement) -> None:
    """A T between G35 and G36 would leave its tool on the coarse step."""
    text = "A T stands between G35 and G36."
    raise made.refuse("T", "coarse-tool", text, "Write G36 before it.")


def _check_alone(made: Statement, code: int) -> None:
    others = set(made.words) - ({"F"} if code == 35 else set())
    if others or made.one_shot is not None or made.m is not None or len(made.modal) > 1:
        text = f"G{code} stands alone on its line."
        raise made.refuse(1, "not-alone", text, "Put the rest on a line of its own.")
    if "F" in made.words and made.value("F") != 2:
        text = f"{made.words['F'].text}: beside G35 only F2 has a meaning (leads to 2 in/rev)."
        raise made.refuse("F", "coarse-range", text, "Write G35 or G35F2.")


def _check_change(state: State, made: Statement, code: int) -> None:
    on = bool(state.modal.coarse)
    if on == (code == 35):
        text = "G35 is in force already." if on else "No G35 is in force that G36 could end."
        raise made.refuse(1, "coarse-order", text, "Take the line out.")
    if code == 35 or state.coarse_at is None:
        return
    x, z = state.coarse_at
    if max(abs(state.x + state.offset_x - x), abs(state.z + state.offset_z - z)) > _SAME:
        place = (
            state.modal.length_text(x - state.offset_x),
            state.modal.length_text(z - state.offset_z),
        )
        state.adopt(state.modal._replace(coarse=0))  # so that the rest is judged as it was meant
        text = f"G36 stands elsewhere than its G35, which was at radius {place[0]}, Z {place[1]}."
        raise made.refuse(1, "coarse-place", text, "Move back there before G36.")


def _check_preset(state: State, made: Statement, code: int, ahead: Sequence[ReadyLine]) -> None:
    """The next line says where the slides stand: G92 with the coordinates in force."""
    line = next((step for step in ahead if step is not None), None)
    hint = "Write G92 with the present X and Z on the next line."
    if not isinstance(line, Statement) or line.one_shot != 92 or not {"X", "Z"}.issubset(line.words):
        text = f"G{code} is not followed by a G92 with X and Z."
        raise made.refuse(1, "coarse-preset", text, hint)
    x, z = (line.value("X") or 0.0) * state.scale_x, (line.value("Z") or 0.0) * state.scale_z
    if max(abs(x - state.px), abs(z - state.pz)) > _SAME or line.modal:
        here = state.modal.length_text(state.px), state.modal.length_text(state.pz)
        text = f"The G92 behind G{code} says another place than radius {here[0]}, Z {here[1]}."
        raise line.refuse("X", "coarse-preset", text, hint)
