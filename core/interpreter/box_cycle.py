"""G74: a rectangle taken off in passes parallel to Z."""

from __future__ import annotations

from math import ceil

from core.interpreter.cycle_blocks import LIFT, Move, check_count, left_over, name, positive, refused
from core.interpreter.moves import on_step
from core.interpreter.state import State
from core.interpreter.statement import Statement

_WHOLE = 1e-6  # of a pass: what a decimal fraction lacks in binary


def box_moves(state: State, made: Statement) -> list[Move]:
    """Equal passes from the start's X to X, none deeper than I, U left on a side; back to the start.

    The tool goes in at the feed: behind a shoulder it does so in material. Raises ProgramError.
    """
    x = _corner(state, made, "X", state.x, state.dx)
    z = _corner(state, made, "Z", state.z, state.dz)
    cut, left = positive(state, made, "I", "the greatest depth of cut"), left_over(state, made)
    towards = 1.0 if x > state.x else -1.0
    depth = abs(x - state.x) - left
    if depth <= 0:
        text = f"{made.words['U'].text} leaves nothing of the box to cut."
        raise refused(made, "U", "cycle-nothing", text, "U is less than the way from the start to X.")
    count = ceil(depth / cut - _WHOLE)
    check_count(made, "I", count, "passes")
    rapid = state.modal.rapid_rate
    moves: list[Move] = []
    for k in range(1, count + 1):
        level = state.x + towards * depth * k / count
        off = level - towards * LIFT
        moves += [Move(level, state.z), Move(level, z), Move(off, z, rapid), Move(off, state.z, rapid)]
    return [*moves, Move(state.x, state.z, rapid)]


def _corner(state: State, made: Statement, letter: str, start: float, offset: float) -> float:
    """X or Z of the corner opposite to the start."""
    value = on_step(state, made, letter)
    if value is None:
        text = f"{name(made)} needs {letter} of the corner opposite to the start point."
        raise refused(made, letter, "word-missing", text, f"Add {letter}.")
    end = value + (offset if state.absolute else start)
    if end == start:
        text = f"The box has no size along {letter}: its corner lies at the start point."
        raise refused(made, letter, "cycle-nothing", text, f"Correct {letter} or the start point.")
    return end
