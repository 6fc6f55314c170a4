"""The cycles: one line that stands for many motions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter import codes
from core.interpreter.blocks import Block
from core.interpreter.box_cycle import box_moves
from core.interpreter.contour_cycle import contour_moves
from core.interpreter.cycle_blocks import blocks_of_moves, check_ready
from core.interpreter.drilling import drill_moves, peck_moves
from core.interpreter.state import State
from core.interpreter.statement import Statement

_MOVES = {74: box_moves, 81: drill_moves, 83: peck_moves}


def cycle_blocks(state: State, made: Statement, contour: Sequence[Statement] = ()) -> Iterator[Block]:
    """The blocks of a cycle, which ends where it starts. Raises ProgramError before the first of them.

    ``contour``: the lines that describe it to G75 and G78.
    """
    check_ready(state, made)
    if made.one_shot in codes.CONTOUR_CYCLES:
        moves = contour_moves(state, made, contour)
    else:
        moves = _MOVES[made.one_shot or 0](state, made)
    yield from blocks_of_moves(state, made, moves)
