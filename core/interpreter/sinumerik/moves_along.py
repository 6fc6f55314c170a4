"""A block's own move on other elements than it names: cut at a corner, or beside the contour by the nose."""

from __future__ import annotations

from dataclasses import replace

from core.geometry.lines_and_arcs import Element
from core.interpreter.adjusted_moves import AdjustedMoves
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.sinumerik.linear_moves import AxisTravel
from core.interpreter.sinumerik.sinumerik_state import State


class MovesAlong(AdjustedMoves):
    """They keep their text; a rapid takes the time of its slowest axis."""

    def __init__(self, state: State) -> None:
        self._state = state

    @property
    def highest_rpm(self) -> float:
        """The speed limit of the spindle, that of G26 included."""
        return self._state.highest

    def along(self, block: Block, element: Element) -> Block:
        """The block's own move along an element."""
        made = self._placed(block, element, block.text)
        if block.kind is not Kind.RAPID:
            return made
        zero = block.offset_x, block.offset_z
        travel = AxisTravel(*element.start, block.c0, *element.end, block.c, block.modal, *zero)
        return replace(made, feed=travel.rapid_rate(self._state.setup.limits.speeds))

    def inserted(self, block: Block, element: Element) -> Block:
        """What is put in behind a block: a move of X and Z alone; C has ended with the block."""
        return replace(self.along(block, element), c0=block.c, text=f"{block.text} ›")
