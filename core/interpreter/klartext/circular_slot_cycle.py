"""Circular slot (254): an arc of even width with round ends, on a pitch circle, several times where asked.

It is cleared as an area with a boundary of its own, by the rings of the SL cycles.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.pocket_area import Loop
from core.interpreter.elementary_blocks import Block
from core.interpreter.klartext.contour_cycles import floor_finishing, rough_out, side_finishing
from core.interpreter.klartext.cycle_moves import CycleTool, Parameters
from core.interpreter.klartext.hole_cycles import SMALLEST, heights
from core.language.klartext.q_parameters import MAX_FEED

_MOST_SLOTS = 1_000
_CENTRE, _LEFT_END, _MIDDLE, _RIGHT_END = range(4)
_BOTH, _ROUGH, _FINISH = range(3)


def circular_slot(tool: CycleTool) -> Iterator[Block]:
    """254: Q219 wide on the circle Q375, from Q376 over Q248 degrees, Q377 times Q378 degrees on."""
    surface, clear, _ = heights(tool)
    safe = max(surface + tool.length(204, 0.0), clear) / tool.scale
    centre, begin, sweep = _placed(tool)
    count, step = int(tool.plain(377, 1.0)), tool.plain(378, 0.0)
    text = "Q377={count} is not a valid number of slots."
    tool.check(1 <= count <= _MOST_SLOTS, text, "Enter a valid number.", count=count)
    scope = int(tool.plain(215, 0.0))
    side, floor = tool.length(368, 0.0), tool.length(369, 0.0)
    for at in range(count):
        area = [slot_of(tool, centre, begin + at * step, sweep)]
        asked = tool.seen({**_AS_CONTOUR, 7: safe, 19: 206 if tool.plain(366, 1.0) else 0.0})
        if scope != _FINISH:
            yield from rough_out(asked, area)
        if scope == _FINISH or (scope == _BOTH and max(side, floor) > SMALLEST):
            last = tool.seen({**_AS_CONTOUR, 3: 0.0, 4: 0.0, 7: safe, **_finishing(tool)})
            if floor > SMALLEST:
                yield from floor_finishing(last, area)
            yield from side_finishing(last, area)


def slot_of(tool: CycleTool, centre: Point, begin: float, sweep: float) -> Loop:
    """The outline of one slot, counter-clockwise. Raises ProgramError for one that is none."""
    radius, half = tool.length(375) / 2.0, tool.length(219) / 2.0
    if not SMALLEST < half < radius or not 0.0 < abs(sweep) <= 360.0:
        text = (
            "A slot {half} mm wide over {sweep} degrees on a circle {radius} mm in diameter is not possible."
        )
        raise tool.refuse(text, "Correct Q219, Q248 and Q375.", half=2 * half, sweep=sweep, radius=2 * radius)
    if radius * math.radians(360.0 - abs(sweep)) < 2.0 * half:
        raise tool.refuse("The ends of the slot overlap.", "Reduce Q248.")
    first, last = sorted((begin, begin + sweep))

    def at(angle: float, away: float) -> Point:
        turned = math.radians(angle)
        return centre[0] + away * math.cos(turned), centre[1] + away * math.sin(turned)

    wide, near = radius + half, radius - half
    return [
        Arc(at(first, wide), at(last, wide), centre, False),
        Arc(at(last, wide), at(last, near), at(last, radius), False),
        Arc(at(last, near), at(first, near), centre, True),
        Arc(at(first, near), at(first, wide), at(first, radius), False),
    ]


def _placed(tool: CycleTool) -> tuple[Point, float, float]:
    """Centre, begin and sweep: as told, or from the tool, which stands at an end or in the middle (Q367)."""
    begin, sweep, radius = tool.plain(376), tool.plain(248), tool.length(375) / 2.0
    place = int(tool.plain(367, 0.0))
    share = {_LEFT_END: 0.0, _MIDDLE: 0.5, _RIGHT_END: 1.0}.get(place)
    if share is None:
        tool.check(place == _CENTRE, "Q367 must be 0, 1, 2 or 3.", "Correct Q367.")
        return (tool.length(216), tool.length(217)), begin, sweep
    turned = math.radians(begin)  # Q376 is the angle of the place where the tool stands
    x, y = tool.here
    return (x - radius * math.cos(turned), y - radius * math.sin(turned)), begin - share * sweep, sweep


# A slot's parameters by the numbers of the SL cycles; what those have beyond is 0 or as they take it.
_AS_CONTOUR: Parameters = {
    1: 201, 2: 370, 3: 368, 4: 369, 5: 203, 6: 200, 9: 351, 10: 202, 11: 206, 12: 207, 14: 0.0,
    18: 0.0, 208: MAX_FEED, 401: 100.0,
}  # fmt: skip


def _finishing(tool: CycleTool) -> Parameters:
    """Finishing at Q385 in infeeds of Q338, at once where that is 0."""
    feed: Parameters = {12: 385} if tool.plain(385, 0.0) else {}
    return {**feed, 10: 338 if tool.plain(338, 0.0) else -1e9}
