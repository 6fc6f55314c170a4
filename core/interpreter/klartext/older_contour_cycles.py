"""SL cycles of older controls: rough-out (6), pilot drilling (15) and contour milling (16).

They mill the contours of cycle 14 as cycles 22, 21 and 24 do, in rings. Their depths count from the set-up
clearance, at which the tool stands when they are called. Cycle 6 goes down by a ramp and needs no hole.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from core.geometry.pocket_area import Loop
from core.interpreter.elementary_blocks import Block
from core.interpreter.klartext.contour_cycles import pilot_drilling, rough_out, side_finishing
from core.interpreter.klartext.cycle_moves import CycleTool
from core.interpreter.klartext.klartext_state import State
from core.interpreter.klartext.older_cycles import Lines, Told

Area = Sequence[Loop]


def _heights(tool: CycleTool, told: Told) -> dict[int, float]:
    """Q1 to Q9 of cycle 20 as lines n.1 tell them, in the program's unit; nothing is left on the floor."""
    clear = tool.height / tool.scale
    setup, depth = abs(told.number(1)), abs(told.number(1, at=1))
    return {1: -depth, 2: 1.0, 3: 0.0, 4: 0.0, 5: clear - setup, 6: setup, 7: clear, 9: 1.0}


def _rough(state: State, tool: CycleTool, lines: Lines, area: Area, column: int) -> Iterator[Block]:
    """6: 6.1 set-up clearance and depth, 6.2 infeed, its feed and the allowance, 6.3 angle and feed."""
    told = Told(state, lines, column)
    plunge = told.cutting_feed(2)
    values = _heights(tool, told) | {3: told.number(2, at=1), 10: -abs(told.number(2)), 11: plunge}
    values |= {12: told.cutting_feed(3), 19: plunge, 208: 99999.0}
    if told.number(3):
        tool.tell("the pocket is cleared in concentric passes, not along parallel paths.")
    yield from rough_out(tool.seen(values), area)


def _pilot(state: State, tool: CycleTool, lines: Lines, area: Area, column: int) -> Iterator[Block]:
    """15: 15.1 set-up clearance and depth, 15.2 infeed, its feed and the allowance."""
    told = Told(state, lines, column)
    values = _heights(tool, told) | {3: told.number(2, at=1), 10: -abs(told.number(2))}
    values |= {11: told.cutting_feed(2), 13: float(state.modal.tool)}
    tool.tell(
        "the cycle drills holes where the active tool would plunge; cycle 6 plunges along a "
        "ramp and does not need these holes."
    )
    yield from pilot_drilling(tool.seen(values), area)


def _walls(state: State, tool: CycleTool, lines: Lines, area: Area, column: int) -> Iterator[Block]:
    """16: 16.1 set-up clearance and depth, 16.2 infeed and its feed, 16.3 sense and feed."""
    told = Told(state, lines, column)
    sense = told.turn(3) * (1.0 if tool.rpm > 0.0 else -1.0)
    values = _heights(tool, told) | {9: sense, 10: -abs(told.number(2)), 11: told.cutting_feed(2)}
    values |= {12: told.cutting_feed(3), 14: 0.0, 208: 99999.0}
    yield from side_finishing(tool.seen(values), area)


OLDER_CONTOURS: dict[int, Callable[[State, CycleTool, Lines, Area, int], Iterator[Block]]] = {
    6: _rough,
    15: _pilot,
    16: _walls,
}
"""Cycles by their number."""

LAST_LINE = {6: 3, 15: 2, 16: 3}
"""The number behind the point of the last line that each has."""
