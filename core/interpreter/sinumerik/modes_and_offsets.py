"""The G codes that stay in force: motion, plane, units, G90 and G91, and where the program's zero lies."""

from __future__ import annotations

from core.interpreter.job_setup import ZeroOffset
from core.interpreter.sinumerik.sinumerik_state import NO_OFFSET, State
from core.interpreter.sinumerik.sinumerik_statement import Statement
from core.language.sinumerik.sinumerik_words import Form


def settable_offset(state: State, statement: Statement) -> None:
    """Take up the settable offset that G54 to G59 name; none under G500."""
    code = statement.code("settable offset")
    if code is None:
        return
    state.settable = state.setup.zero.get(code, NO_OFFSET) if code != 500 else NO_OFFSET
    state.adopt(state.modal._replace(settable=0 if code == 500 else code))
    state.derive_offsets()


def programmed_offset(state: State, statement: Statement) -> None:
    """TRANS replaces, ATRANS adds, TRANS alone clears. Raises ProgramError."""
    key = statement.offset_key
    if key is None:
        return
    check_c(state, statement)
    base = state.programmed if key.name == "ATRANS" else NO_OFFSET
    x, z, c = (_shift(state, statement, name) for name in "XZC")
    state.programmed = ZeroOffset(base.x + x, base.z + z, base.c + c)
    state.derive_offsets()


def leave_offsets(state: State) -> None:
    """The end of a program takes its offsets away: what comes next, in whatever language, counts without."""
    state.settable = state.programmed = NO_OFFSET
    state.adopt(state.modal._replace(settable=0))
    state.derive_offsets()


def check_c(state: State, statement: Statement) -> None:
    """Raises ProgramError for a C word on a machine that has no C."""
    word = statement.words.get("C")
    if word is not None and not state.setup.limits.c_enabled:
        text = "unknown axis: this machine has no third axis."
        raise statement.refuse(
            word, "unknown-axis", text, "Take C out, or choose a machine file that has it."
        )


def _shift(state: State, statement: Statement, name: str) -> float:
    """One axis of TRANS or ATRANS: mm or degrees. X is a radius, whatever DIAMON says."""
    word = statement.words.get(name)
    if word is None:
        return 0.0
    if word.form is not Form.PLAIN:
        text = f"{word.text}: an offset is a plain number."
        raise statement.refuse(word, "offset-form", text, f"Write {word.name} with its number.")
    return state.number(statement, word) if name == "C" else state.length(statement, word)


def modes(state: State, statement: Statement) -> None:
    """Take up the codes of a block that stay in force."""
    modal = state.modal
    motion, plane = statement.code("motion"), statement.code("plane")
    state.motion = state.motion if motion is None else motion
    state.plane = plane or state.plane
    metric, absolute = statement.code("unit of length"), statement.code("absolute or incremental")
    if "DIAMON" in statement.keys or "DIAMOF" in statement.keys:
        modal = modal._replace(diameter="DIAMON" in statement.keys)
    if metric is not None:
        modal = modal._replace(metric=metric == 71)
    if absolute is not None:
        modal = modal._replace(absolute=absolute == 90)
    if modal.rapid != (state.motion == 0):
        modal = modal._replace(rapid=state.motion == 0)
    state.adopt(modal)
    settable_offset(state, statement)
