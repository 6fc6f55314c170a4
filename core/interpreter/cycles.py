"""The cycles: one line that stands for many motions."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from core.interpreter.blocks import Block
from core.interpreter.box_cycle import box_moves
from core.interpreter.cycle_blocks import Move, blocks_of_moves, check_ready
from core.interpreter.drilling import drill_moves, peck_moves
from core.interpreter.state import State
from core.interpreter.statement import Statement

_MOVES: dict[int | None, Callable[[State, Statement], list[Move]]] = {
    74: box_moves,
    81: drill_moves,
    83: peck_moves,
}


def cycle_blocks(state: State, made: Statement) -> Iterator[Block]:
    """The blocks of a cycle, which ends where it starts. Raises ProgramError before the first of them."""
    check_ready(state, made)
    yield from blocks_of_moves(state, made, _MOVES[made.one_shot](state, made))
