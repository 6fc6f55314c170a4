"""The G codes that stay in force: motion, plane, units, G90 and G91, and where the program's zero lies."""

from __future__ import annotations

from core.interpreter.job_setup import ZeroOffset
from core.interpreter.sinumerik.sinumerik_state import NO_OFFSET, State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import Form, Word


def settable_offset(state: State, made: Statement) -> None:
    """Take up the settable offset that G54 to G59 name; none under G500."""
    code = made.code("settable offset")
    if code is None:
        return
    state.settable = state.setup.zero.get(code, NO_OFFSET) if code != 500 else NO_OFFSET
    state.adopt(state.modal._replace(settable=0 if code == 500 else code))
    state.derive_offsets()


def programmed_offset(state: State, made: Statement) -> None:
    """TRANS replaces, ATRANS adds, TRANS alone clears. Raises ProgramError."""
    key = made.offset_key
    if key is None:
        return
    check_c(state, made)
    base = state.programmed if key.name == "ATRANS" else NO_OFFSET
    state.programmed = ZeroOffset(
        base.x + _shift(state, made, "X"),
        base.z + _shift(state, made, "Z"),
        base.c + _shift(state, made, "C"),
    )
    state.derive_offsets()


def leave_offsets(state: State) -> None:
    """The end of a program takes its offsets away: what comes next, in whatever language, counts without."""
    state.settable = state.programmed = NO_OFFSET
    state.adopt(state.modal._replace(settable=0))
    state.derive_offsets()


def check_c(state: State, made: Statement) -> None:
    """Raises ProgramError for a C word on a machine that has no C."""
    word = made.words.get("C")
    if word is not None and not state.setup.limits.c_enabled:
        text = "unknown axis: this machine has no third axis."
        raise made.refuse(word, "unknown-axis", text, "Take C out, or choose a machine file that has it.")


def _shift(state: State, made: Statement, name: str) -> float:
    """One axis of TRANS or ATRANS: mm or degrees. X is a radius, whatever DIAMON says."""
    word = made.words.get(name)
    if word is None:
        return 0.0
    _check_form(made, word)
    return state.number(made, word) if name == "C" else state.length(made, word)


def _check_form(made: Statement, word: Word) -> None:
    if word.form is not Form.PLAIN:
        text = f"{word.text}: an offset is a plain number."
        raise made.refuse(word, "offset-form", text, f"Write {word.name} with its number.")


def modes(state: State, made: Statement) -> None:
    """Take up the codes of a block that stay in force."""
    modal = state.modal
    state.motion = _chosen(made.code("motion"), state.motion)
    state.plane = _chosen(made.code("plane"), state.plane)
    metric, absolute = made.code("unit of length"), made.code("absolute or incremental")
    if "DIAMON" in made.keys or "DIAMOF" in made.keys:
        modal = modal._replace(diameter="DIAMON" in made.keys)
    if metric is not None:
        modal = modal._replace(metric=metric == 71)
    if absolute is not None:
        modal = modal._replace(absolute=absolute == 90)
    if modal.rapid != (state.motion == 0):
        modal = modal._replace(rapid=state.motion == 0)
    state.adopt(modal)
    settable_offset(state, made)


def _chosen(code: int | None, before: int) -> int:
    return before if code is None else code
