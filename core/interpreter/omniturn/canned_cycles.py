"""The cycles: one line that stands for many motions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter.elementary_blocks import Block
from core.interpreter.omniturn import code_table
from core.interpreter.omniturn.cycle_motions import blocks_of_moves, check_ready
from core.interpreter.omniturn.drilling_cycles import drill_moves, peck_moves
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.omniturn.roughing_cycles import box_moves, contour_moves

_MOVES = {74: box_moves, 81: drill_moves, 83: peck_moves}


def cycle_blocks(state: State, made: Statement, contour: Sequence[Statement] = ()) -> Iterator[Block]:
    """The blocks of a cycle, which ends where it starts. Raises ProgramError before the first of them.

    ``contour``: the lines that describe it to G75 and G78.
    """
    check_ready(state, made)
    if made.one_shot in code_table.CONTOUR_CYCLES:
        moves = contour_moves(state, made, contour)
    else:
        moves = _MOVES[made.one_shot or 0](state, made)
    yield from blocks_of_moves(state, made, moves)
