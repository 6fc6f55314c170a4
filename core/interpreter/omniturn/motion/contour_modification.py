"""From the moves of the lines to the blocks handed out: corners are cut, then the nose is compensated."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.omniturn.motion.corners import Corners
from core.interpreter.omniturn.motion.move_words import WordedMoves
from core.interpreter.omniturn.motion.nose_compensation import (
    Compensation,
    check_approach,
    check_under_nose,
    nose_radius,
)
from core.interpreter.omniturn.omniturn_state import CompensationSwitch, Corner, Item, State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.elementary_blocks import Block


class ContourModifier:
    """Holds blocks back while a corner waits for its second move or nose compensation is on.

    It holds no more than one corner and the moves that compensation looks ahead; the blocks that come out
    are counted on without a gap.
    """

    def __init__(self, state: State) -> None:
        self._state = state
        moves = WordedMoves(state.setup.limits.max_rpm)
        self._corners = Corners(state.log, moves)
        self._nose = Compensation(state.log, moves)
        self._count: int | None = None  # number of the last block handed out, while active

    def take(self, block: Block) -> Iterator[Block]:
        """Take a block as its line made it; yields the blocks that no later line can change.

        Raises ProgramError where the corner cannot be cut, or the nose cannot follow.
        """
        state = self._state
        corner, state.contour.corner = state.contour.corner, None
        self._begin(block.n - 1)
        if block.moves and state.contour.approach:
            check_approach(state, block)
            self._nose.radius = nose_radius(state)
        yield from self._put(block, corner)

    def check(self, statement: Statement) -> None:
        """Refuse a line that may not follow the moves that are held back. Raises ProgramError."""
        if self._state.contour.active:
            self._corners.check(statement)
            check_under_nose(self._state, statement)

    def switch(self, switch: CompensationSwitch) -> Iterator[Block]:
        """G41, G42 or G40; yields the blocks that no later line can change. Raises ProgramError."""
        self._begin(self._state.blocks)
        yield from self._put(switch, None)

    def end(self) -> Iterator[Block]:
        """The program is over. Raises ProgramError where a corner still waits for its second move."""
        self._corners.end()
        yield from ()

    def drop(self) -> None:
        """After an error: forget all that is held back, so that none of it is handed out."""
        self._corners.drop()
        self._nose.drop()
        self._count = None
        self._state.contour.active = False
        self._state.contour.corner = None
        self._state.contour.approach = 0

    def _begin(self, count: int) -> None:
        if self._count is None:
            self._count = count

    def _put(self, item: Item, corner: Corner | None) -> Iterator[Block]:
        state = self._state
        count = self._count or 0
        for item_cut in self._corners.take(item, corner):
            for block in self._nose.take(item_cut):
                count += 1
                block.n = count
                self._count = count
                yield block
        state.contour.active = self._corners.holds or self._nose.active
        if not state.contour.active:
            state.blocks = count
            state.contour.approach = 0  # a T may have ended what had not begun
            self._count = None
