"""Cycles that mill pockets, slots and studs (251, 252, 253, 256, 257): level by level, walls and floor last.

Pockets are cleared from the inside out, studs from the blank inwards. The way is this control's own; what is
left standing is what the parameters say. A ramp goes down by 3 degrees: the tool table tells no other angle.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from core.geometry.lines_and_arcs import Arc
from core.interpreter.elementary_blocks import Block
from core.interpreter.klartext.cycle_moves import CycleTool
from core.interpreter.klartext.hole_cycles import SMALLEST, heights, infeeds, levels, out
from core.interpreter.klartext.milled_rings import Ring, Seat

_RAMP = math.tan(math.radians(3.0))
_MOST_OVERLAP = 1.9999
_BOTH, _ROUGH, _FINISH = 0, 1, 2


class _Milling:
    """What the parameters of a milling cycle say, and its ways down."""

    def __init__(self, tool: CycleTool) -> None:
        self.tool = tool
        self.surface, self.clear, self.bottom = heights(tool)
        self.safe = self.surface + max(tool.length(204, 0.0), tool.length(200))
        self.feed, self.plunge = tool.cut(207), tool.cut(206)
        self.side, self.floor = tool.length(368, 0.0), tool.length(369, 0.0)
        self.scope = int(tool.plain(215, float(_ROUGH)))
        overlap = tool.plain(370, 1.0)
        if not 0.0 < overlap <= _MOST_OVERLAP or tool.radius <= SMALLEST:
            text = (
                "With path overlap Q370={overlap} and tool radius {radius} mm, the cycle cannot clear the "
                "area."
            )
            hint = "Set Q370 between 0.1 and 1.9999, and enter the tool radius."
            raise tool.refuse(text, hint, overlap=overlap, radius=tool.radius)
        self.step = overlap * tool.radius
        self.against = (tool.plain(351, 1.0) < 0.0) != (tool.rpm < 0.0)

    def levels(self) -> list[float]:
        """Heights of clearing, the last one last."""
        floor = self.bottom + (self.floor if self.scope != _FINISH else 0.0)
        return levels(self.tool, self.surface, floor, lambda: self.tool.length(202))

    @property
    def finishes(self) -> bool:
        """Whether walls and floor are gone over once more."""
        return self.scope == _FINISH or (self.scope == _BOTH and max(self.side, self.floor) > SMALLEST)

    @property
    def last_feed(self) -> float:
        """Of finishing."""
        return self.tool.cut(385) if self.tool.plain(385, 0.0) else self.feed

    def wall_levels(self) -> list[float]:
        """Heights of finishing: by Q338, where that is 0 at once."""
        step = self.tool.length(338, 0.0)
        return [self.surface - done for done in infeeds(self.tool, self.surface - self.bottom, step)]


# --- pockets and slots: from the inside out


def rectangular_pocket(tool: CycleTool) -> Iterator[Block]:
    """251: Q218 and Q219 its sides, Q220 its corners, turned by Q224; the tool stands at Q367 of it."""
    a, b = tool.length(218) / 2.0, tool.length(219) / 2.0
    corner = {0: (0.0, 0.0), 1: (a, b), 2: (-a, b), 3: (-a, -b), 4: (a, -b)}
    seat = Seat(tool.here, tool.plain(224, 0.0)).moved(*_placed(tool, corner))
    yield from _pocket(tool, seat, Ring(a, b, tool.length(220, 0.0)))


def circular_pocket(tool: CycleTool) -> Iterator[Block]:
    """252: Q223 its diameter, round where the tool stands."""
    radius = tool.length(223) / 2.0
    yield from _pocket(tool, Seat(tool.here), Ring(radius, radius, radius))


def slot(tool: CycleTool) -> Iterator[Block]:
    """253: Q218 long and Q219 wide, turned by Q374; the tool stands at Q367 of it."""
    a, b = tool.length(218) / 2.0, tool.length(219) / 2.0
    tool.check(a >= b - SMALLEST, "The slot is wider than it is long.", "Correct Q218 and Q219.")
    ends = {0: (0.0, 0.0), 1: (a, 0.0), 2: (a - b, 0.0), 3: (b - a, 0.0), 4: (-a, 0.0)}
    seat = Seat(tool.here, tool.plain(374, 0.0)).moved(*_placed(tool, ends))
    yield from _pocket(tool, seat, Ring(a, b, b))


def _placed(tool: CycleTool, places: dict[int, tuple[float, float]]) -> tuple[float, float]:
    found = places.get(int(tool.plain(367, 0.0)))
    if found is None:
        raise tool.refuse("Q367 must be 0, 1, 2, 3 or 4.", "Correct Q367.")
    return found


def _pocket(tool: CycleTool, seat: Seat, wall: Ring) -> Iterator[Block]:
    if wall.b > wall.a:  # the long way first, along which the tool goes down
        seat, wall = Seat(seat.middle, seat.angle + 90.0), Ring(wall.b, wall.a, wall.radius)
    told = _Milling(tool)
    last = wall.wider(-tool.radius)
    rough = last.wider(-told.side) if told.scope != _FINISH else last
    if min(rough.b, last.b) < -SMALLEST:
        raise tool.refuse("The tool is wider than the pocket or slot.", "Use a smaller tool.")
    rough, last = (Ring(max(each.a, 0.0), max(each.b, 0.0), each.radius) for each in (rough, last))
    yield tool.to(max(told.clear, min(tool.height, told.safe)))
    if told.surface - told.bottom < SMALLEST:
        return
    if told.scope != _FINISH:
        above = told.surface
        for z in told.levels():
            yield from _down(told, seat, rough, above, z)
            yield from _cleared(told, seat, rough, told.feed)
            above = z
    if told.finishes:
        yield from _finished(told, seat, last)
    yield tool.to(told.clear)
    yield tool.across(seat.middle)
    yield from out(tool, told.surface, told.clear, None)


def _down(told: _Milling, seat: Seat, ring: Ring, above: float, z: float) -> Iterator[Block]:
    """From ``above`` to ``z`` at the beginning of the middle line: straight, by a helix, to and fro."""
    tool, half = told.tool, ring.a - ring.b
    start, end = seat.at(-half, 0.0), seat.at(half, 0.0)
    yield tool.to(min(told.clear, above + tool.length(200)))
    yield tool.across(start)
    if not int(tool.plain(366, 1.0)):
        yield tool.to(z, told.plunge)
    elif half > tool.radius:
        yield tool.to(above, told.plunge)
        passes = 2 * math.ceil((above - z) / (4.0 * half * _RAMP) - SMALLEST)
        for count in range(1, passes + 1):
            yield tool.across((start, end)[count % 2], above + (z - above) * count / passes, told.plunge)
    else:
        yield from _helix(told, seat.moved(-half, 0.0), min(tool.radius, ring.b), above, z)


def _helix(told: _Milling, seat: Seat, radius: float, above: float, z: float) -> Iterator[Block]:
    tool = told.tool
    text = "There is not enough room to plunge along a ramp."
    tool.check(radius >= SMALLEST * 1000.0, text, "Set Q366=+0 for a center-cutting tool.")
    begin = seat.at(radius, 0.0)
    yield tool.across(begin)
    yield tool.to(above, told.plunge)
    turns = math.ceil((above - z) / (2.0 * math.pi * radius * _RAMP) - SMALLEST)
    circle = Arc(begin, begin, seat.middle, told.against)
    for count in range(1, turns + 1):
        yield tool.round(circle, above + (z - above) * count / turns, told.plunge)
    yield tool.round(circle, z, told.plunge)
    yield tool.across(seat.middle, None, told.feed)


def _cleared(told: _Milling, seat: Seat, ring: Ring, feed: float) -> Iterator[Block]:
    """The level where the tool stands, from the middle line out to the ring."""
    tool = told.tool
    if ring.a - ring.b > SMALLEST:
        yield tool.across(seat.at(ring.a - ring.b, 0.0), None, feed)
    count = math.ceil(ring.b / told.step - SMALLEST) if ring.b > SMALLEST else 0
    for at in range(1, count + 1):
        each = ring.wider(-ring.b * (1.0 - at / count))
        yield tool.across(seat.at(each.a, 0.0), None, feed)
        yield from each.milled(tool, seat, feed, clockwise=told.against)


def _finished(told: _Milling, seat: Seat, ring: Ring) -> Iterator[Block]:
    """Floor, then walls: led to the wall on a quarter of a circle, and off it."""
    tool, feed = told.tool, told.last_feed
    half = seat.at(ring.b - ring.a, 0.0)
    if told.floor > SMALLEST:
        yield tool.to(told.clear)
        yield tool.across(half)
        yield tool.to(told.bottom, told.plunge)
        yield from _cleared(told, seat, ring, feed)
    if told.side <= SMALLEST and told.scope != _FINISH:
        return
    quarter, side = min(tool.radius / 2.0, ring.b), -1.0 if told.against else 1.0
    for z in told.wall_levels():
        yield tool.to(min(told.clear, tool.height + tool.length(200)))
        yield tool.across(seat.at(ring.a - quarter, -side * quarter))
        yield tool.to(z, told.plunge)
        yield from _round_once(told, seat, ring, quarter, feed)


def _round_once(told: _Milling, seat: Seat, ring: Ring, quarter: float, feed: float) -> Iterator[Block]:
    """Onto the ring from inside (a quarter over 0) or from outside, once round, and off it."""
    tool, clockwise = told.tool, told.against
    if quarter < 0.0:
        clockwise = not clockwise
    side = -1.0 if clockwise else 1.0
    on, size = seat.at(ring.a, 0.0), abs(quarter)
    about = seat.at(ring.a - quarter, 0.0)
    turns = clockwise if quarter > 0.0 else not clockwise
    if size > SMALLEST:
        begin = seat.at(ring.a - quarter, -side * size)
        yield tool.round(Arc(begin, on, about, turns), tool.height, feed)
    yield from ring.milled(tool, seat, feed, clockwise=clockwise)
    if size > SMALLEST:
        end = seat.at(ring.a - quarter, side * size)
        yield tool.round(Arc(on, end, about, turns), tool.height, feed)


# --- studs: from the blank inwards


def rectangular_stud(tool: CycleTool) -> Iterator[Block]:
    """256: Q218 and Q219 its sides, Q424 and Q425 those of the blank, Q220 its corners, turned by Q224."""
    a, b = tool.length(218) / 2.0, tool.length(219) / 2.0
    corner = {0: (0.0, 0.0), 1: (a, b), 2: (-a, b), 3: (-a, -b), 4: (a, -b)}
    seat = Seat(tool.here, tool.plain(224, 0.0)).moved(*_placed(tool, corner))
    more = max(tool.length(424) / 2.0 - a, tool.length(425) / 2.0 - b)
    yield from _stud(tool, seat, Ring(a, b, tool.length(220, 0.0)), more)


def circular_stud(tool: CycleTool) -> Iterator[Block]:
    """257: Q223 its diameter, Q222 that of the blank, begun at Q376."""
    radius = tool.length(223) / 2.0
    seat = Seat(tool.here, max(tool.plain(376, 0.0), 0.0))
    yield from _stud(tool, seat, Ring(radius, radius, radius), tool.length(222) / 2.0 - radius)


def _stud(tool: CycleTool, seat: Seat, wall: Ring, more: float) -> Iterator[Block]:
    """Level by level in rings that come nearer; ``more`` is how far the blank stands out."""
    told = _Milling(tool)
    tool.check(more >= SMALLEST, "The blank is not larger than the stud.", "Correct the blank dimensions.")
    last = wall.wider(tool.radius)
    rough = last.wider(told.side if told.scope != _FINISH else 0.0)
    outside = last.a + more + tool.radius + tool.length(200)
    yield tool.to(max(told.safe, tool.height))
    if told.surface - told.bottom < SMALLEST:
        return
    rounds = math.ceil(more / told.step - SMALLEST)
    for z in told.levels() if told.scope != _FINISH else ():
        for at in range(1, rounds + 1):
            each = rough.wider(more * (1.0 - at / rounds))
            yield from _approached(told, seat, outside, z, at == 1)
            yield from _around(told, seat, each, told.feed)
    if told.finishes:
        for z in told.wall_levels():
            yield from _approached(told, seat, outside, z, True)
            yield from _around(told, seat, last, told.last_feed)
    yield tool.to(told.clear)
    yield from out(tool, told.surface, told.clear, None)


def _approached(told: _Milling, seat: Seat, outside: float, z: float, down: bool) -> Iterator[Block]:
    """Beside the blank, and down to the level where it begins."""
    tool = told.tool
    if not down:
        return
    yield from tool.over(seat.at(outside, 0.0), told.clear)
    yield tool.to(z, told.plunge)


def _around(told: _Milling, seat: Seat, ring: Ring, feed: float) -> Iterator[Block]:
    tool = told.tool
    side = 1.0 if told.against else -1.0  # milled the other way round than a pocket
    yield tool.across(seat.at(ring.a + tool.radius, -side * tool.radius), None, feed)
    yield from _round_once(told, seat, ring, -tool.radius, feed)


MILLED: dict[int, Callable[[CycleTool], Iterator[Block]]] = {
    251: rectangular_pocket,
    252: circular_pocket,
    253: slot,
    256: rectangular_stud,
    257: circular_stud,
}
"""Cycles by their number."""
