"""Older cycles of pockets, studs and slots with Q parameters (210 to 215), by way of their successors.

Their place is a centre of its own (Q216, Q217); 212 to 215 go along walls alone, in infeeds of Q202.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from core.interpreter.elementary_blocks import Block
from core.interpreter.klartext.circular_slot_cycle import circular_slot
from core.interpreter.klartext.cycle_moves import CycleTool, Parameters
from core.interpreter.klartext.hole_cycles import heights
from core.interpreter.klartext.pocket_cycles import (
    circular_pocket,
    circular_stud,
    rectangular_pocket,
    rectangular_stud,
    slot,
)

Milling = Callable[[CycleTool], Iterator[Block]]

_HEIGHTS: Parameters = {200: 200, 201: 201, 203: 203, 204: 204}
_SLOT: Parameters = {**_HEIGHTS, 202: 202, 206: 207, 207: 207, 215: 215, 219: 219, 338: 338, 366: 1.0}
_WALLS: Parameters = {**_HEIGHTS, 202: 202, 206: 206, 207: 207, 215: 2.0, 338: 202}


def _placed(milling: Milling, parameters: Parameters) -> Milling:
    """A cycle round Q216 Q217, as another one with these parameters."""

    def run(tool: CycleTool) -> Iterator[Block]:
        surface, clear, _ = heights(tool)
        yield tool.to(max(clear, surface + tool.length(204, 0.0), tool.height))
        yield tool.across((tool.length(216), tool.length(217)))
        yield from milling(tool.seen(parameters))

    return run


def _round_corners(tool: CycleTool) -> Iterator[Block]:
    """212: corners of the tool's radius where Q220 tells none."""
    radius = tool.length(220, 0.0) or tool.radius
    yield from _placed(rectangular_pocket, {**_WALLS, 218: 218, 219: 219, 220: radius / tool.scale})(tool)


def _stud(tool: CycleTool) -> Iterator[Block]:
    """213: the blank stands out by Q221, or by as much as the tool is wide."""
    more = 2.0 * (tool.plain(221, 0.0) or tool.radius / tool.scale)
    sides = {424: tool.plain(218) + more, 425: tool.plain(219) + more}
    yield from _placed(rectangular_stud, {**_WALLS, 218: 218, 219: 219, 220: 220, **sides})(tool)


OLDER_MILLED: dict[int, Milling] = {
    210: _placed(slot, {**_SLOT, 218: 218, 374: 224}),
    211: _placed(circular_slot, {**_SLOT, 216: 216, 217: 217, 375: 244, 376: 245, 248: 248}),
    212: _round_corners,
    213: _stud,
    214: _placed(circular_pocket, {**_WALLS, 223: 223}),
    215: _placed(circular_stud, {**_WALLS, 222: 222, 223: 223}),
}
"""Cycles by their number."""
