"""A pass that begins from a checkpoint: the state put back, and the blocks that lead to its line."""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign

from core.interpreter.actions import SpindleRun, SpindleStop
from core.interpreter.checkpoint import Begin, Checkpoint, CTurn, FunctionStep, Leg
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.omniturn.omniturn_state import State

_KEPT = Checkpoint._fields[:-1]  # by the names that they have in the state; the flow is the interpreter's


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


def approach_blocks(state: State, begin: Begin) -> Iterator[Block]:
    """The blocks of the way, numbered so that the first block of the line keeps its number of a full run."""
    modal, point = state.modal, begin.checkpoint
    offsets = state.offset_x, state.offset_z, modal.offset_c
    at = [value - offset for value, offset in zip(state.setup.start, offsets, strict=False)]
    turning = 0.0
    for number, step in enumerate(begin.approach, start=point.blocks - len(begin.approach) + 1):
        x0, z0, c0 = at
        kind, feed, action = Kind.ACTION, 0.0, None
        match step:
            case Leg():
                kind, feed = Kind.RAPID if step.rapid else Kind.FEED, step.feed
                at[0] = x0 if step.x is None else step.x - state.offset_x
                at[1] = z0 if step.z is None else step.z - state.offset_z
            case CTurn():
                kind, feed = Kind.ROTATE, step.speed
                at[2] = step.c - modal.offset_c
            case FunctionStep():
                action = step.action
                if isinstance(action, SpindleRun | SpindleStop):
                    turning = state.rpm_at(at[0]) if isinstance(action, SpindleRun) else 0.0
        rpm = copysign(feed / 6.0, at[2] - c0) if kind is Kind.ROTATE else turning
        css = modal.surface_speed if modal.css and turning else None
        yield Block(
            number, begin.line, kind, step.text, x0, z0, c0, at[0], at[1], at[2],
            state.offset_x, state.offset_z, modal, feed, False, rpm, css, action=action,
        )  # fmt: skip
