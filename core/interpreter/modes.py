"""The modes that say what X and Z mean."""

from __future__ import annotations

from core.interpreter.state import State
from core.interpreter.statement import Statement


def geometry_modes(state: State, made: Statement) -> None:
    """Distance, units and X words of a line; the other groups belong to feed and spindle."""
    if not made.modal:
        return
    modal = state.modal
    for code in made.modal:
        if code in {90, 91}:
            modal = modal._replace(absolute=code == 90)
        elif code in {70, 71}:
            modal = modal._replace(metric=code == 71)
        elif code in {72, 73}:
            modal = modal._replace(diameter=code == 72)
    state.adopt(modal)
