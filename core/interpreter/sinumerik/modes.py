"""The codes that stay in force: motion, plane, units, absolute or incremental, diameter, settable offset."""

from __future__ import annotations

from core.interpreter.sinumerik.offsets import settable_offset
from core.interpreter.sinumerik.state import State
from core.interpreter.sinumerik.statement import Statement


def modes(state: State, made: Statement) -> None:
    """The codes that stay in force."""
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
