"""A pass that begins from a checkpoint: what a line inherits, taken from the state and put back."""

from __future__ import annotations

from core.interpreter.checkpoint import Begin, Checkpoint
from core.interpreter.omniturn.omniturn_state import State

_NOT_OF_THE_STATE = ("flow", "kept", "at")  # the flow is the interpreter's, the others are other dialects'
_KEPT = tuple(name for name in Checkpoint._fields if name not in _NOT_OF_THE_STATE)


def checkpoint_of(state: State) -> Checkpoint:
    """All that the line that comes next inherits, to go on from there in another pass."""
    return Checkpoint(*(getattr(state, name) for name in _KEPT))


def restore(state: State, begin: Begin) -> None:
    """Put back what the line of ``begin`` inherits.

    A line of MDI begins where the slides stand. A restart begins at its checkpoint, to which its way leads;
    C stays where it is unless it is locked.
    """
    point = begin.checkpoint
    for name in _KEPT:
        setattr(state, name, getattr(point, name))
    state.derive()
    start_x, start_z, start_c = state.setup.start[:3]
    if begin.single:
        state.x, state.z = start_x - state.offset_x, start_z - state.offset_z
        state.px, state.pz = state.x - state.dx, state.z - state.dz
    if begin.single or not point.modal.c_locked:
        state.c = start_c - point.modal.offset_c
