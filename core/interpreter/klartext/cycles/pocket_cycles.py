"""Milling cycles for pockets, slots and studs (210 to 215, 251 to 257), level by level.

Pockets are cleared from the inside out, studs from the blank inward; walls and floor are finished last. The
tool path is TurnDesk's own, and the remaining material is as the parameters specify. A ramp has 3 degrees,
because the tool table has no plunge angle.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.pocket_area import Loop
from core.interpreter.klartext.cycles.contour_cycles import floor_finishing, rough_out, side_finishing
from core.interpreter.klartext.cycles.cycle_moves import CycleTool, Parameters, Ring, Seat
from core.interpreter.klartext.cycles.hole_cycles import SMALLEST, heights, infeeds, levels, out
from core.interpreter.shared.elementary_blocks import Block
from core.language.klartext.q_parameters import MAX_FEED

_RAMP = math.tan(math.radians(3.0))
_MOST_OVERLAP = 1.9999
_BOTH, _ROUGH, _FINISH = 0, 1, 2
_MOST_SLOTS = 1_000
_CENTRE, _LEFT_END, _MIDDLE, _RIGHT_END = range(4)


class _Milling:
    """Parameters of a milling cycle."""

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
        """Return the heights of the clearing levels, the deepest last."""
        floor = self.bottom + (self.floor if self.scope != _FINISH else 0.0)
        return levels(self.tool, self.surface, floor, lambda: self.tool.length(202))

    @property
    def finishes(self) -> bool:
        """Whether walls and floor are finished."""
        return self.scope == _FINISH or (self.scope == _BOTH and max(self.side, self.floor) > SMALLEST)

    @property
    def last_feed(self) -> float:
        """Feed of the finishing passes."""
        return self.tool.cut(385) if self.tool.plain(385, 0.0) else self.feed

    def wall_levels(self) -> list[float]:
        """Return the heights of wall finishing in steps of Q338; with 0, only the bottom."""
        step = self.tool.length(338, 0.0)
        return [self.surface - done for done in infeeds(self.tool, self.surface - self.bottom, step)]


# --- pockets and slots: from the inside out


def rectangular_pocket(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 251: sides Q218 and Q219, corners Q220, rotation Q224, position Q367."""
    a, b = tool.length(218) / 2.0, tool.length(219) / 2.0
    corner = {0: (0.0, 0.0), 1: (a, b), 2: (-a, b), 3: (-a, -b), 4: (a, -b)}
    seat = Seat(tool.here, tool.plain(224, 0.0)).moved(*_placed(tool, corner))
    yield from _pocket(tool, seat, Ring(a, b, tool.length(220, 0.0)))


def circular_pocket(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 252: a pocket of diameter Q223 around the tool position."""
    radius = tool.length(223) / 2.0
    yield from _pocket(tool, Seat(tool.here), Ring(radius, radius, radius))


def slot(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 253: length Q218, width Q219, rotation Q374, position Q367."""
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
    if wall.b > wall.a:  # the long side first, because the tool plunges along it
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
    """Yield the plunge from ``above`` to ``z`` at the start of the center line: straight, helix or zigzag."""
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
    """Yield the clearing moves of the present level, from the center line to the ring."""
    tool = told.tool
    if ring.a - ring.b > SMALLEST:
        yield tool.across(seat.at(ring.a - ring.b, 0.0), None, feed)
    count = math.ceil(ring.b / told.step - SMALLEST) if ring.b > SMALLEST else 0
    for at in range(1, count + 1):
        each = ring.wider(-ring.b * (1.0 - at / count))
        yield tool.across(seat.at(each.a, 0.0), None, feed)
        yield from each.milled(tool, seat, feed, clockwise=told.against)


def _finished(told: _Milling, seat: Seat, ring: Ring) -> Iterator[Block]:
    """Yield the finishing moves of floor and walls, with quarter circles as approach and departure."""
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
    """Yield the approach to a ring, one round, and the departure.

    A positive ``quarter`` approaches from the inside, a negative one from the outside.
    """
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
    """Yield the blocks of cycle 256: sides Q218 and Q219, blank Q424 and Q425.

    Q220 is the corner radius, and Q224 is the rotation.
    """
    a, b = tool.length(218) / 2.0, tool.length(219) / 2.0
    corner = {0: (0.0, 0.0), 1: (a, b), 2: (-a, b), 3: (-a, -b), 4: (a, -b)}
    seat = Seat(tool.here, tool.plain(224, 0.0)).moved(*_placed(tool, corner))
    more = max(tool.length(424) / 2.0 - a, tool.length(425) / 2.0 - b)
    yield from _stud(tool, seat, Ring(a, b, tool.length(220, 0.0)), more)


def circular_stud(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 257: diameter Q223, blank Q222, start angle Q376."""
    radius = tool.length(223) / 2.0
    seat = Seat(tool.here, max(tool.plain(376, 0.0), 0.0))
    yield from _stud(tool, seat, Ring(radius, radius, radius), tool.length(222) / 2.0 - radius)


def _stud(tool: CycleTool, seat: Seat, wall: Ring, more: float) -> Iterator[Block]:
    """Yield rings that approach the stud on each level; ``more`` is the oversize of the blank in mm."""
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
    """Yield the rapid to a point next to the blank and the move down to the level."""
    tool = told.tool
    if not down:
        return
    yield from tool.over(seat.at(outside, 0.0), told.clear)
    yield tool.to(z, told.plunge)


def _around(told: _Milling, seat: Seat, ring: Ring, feed: float) -> Iterator[Block]:
    tool = told.tool
    side = 1.0 if told.against else -1.0  # the direction is opposite to that of a pocket
    yield tool.across(seat.at(ring.a + tool.radius, -side * tool.radius), None, feed)
    yield from _round_once(told, seat, ring, -tool.radius, feed)


# --- circular slots: areas with a separate boundary, cleared by the rings of the SL cycles


def circular_slot(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 254: width Q219 on the circle Q375, from Q376 over Q248 degrees.

    Q377 is the number of slots, and Q378 is the angle between them.
    """
    surface, clear, _ = heights(tool)
    safe = max(surface + tool.length(204, 0.0), clear) / tool.scale
    centre, begin, sweep = _slot_place(tool)
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
    """Return the outline of one slot, counterclockwise. Raises ProgramError if its dimensions are invalid."""
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


def _slot_place(tool: CycleTool) -> tuple[Point, float, float]:
    """Return center, start angle and sweep, from the parameters or from the tool position (Q367)."""
    begin, sweep, radius = tool.plain(376), tool.plain(248), tool.length(375) / 2.0
    place = int(tool.plain(367, 0.0))
    share = {_LEFT_END: 0.0, _MIDDLE: 0.5, _RIGHT_END: 1.0}.get(place)
    if share is None:
        tool.check(place == _CENTRE, "Q367 must be 0, 1, 2 or 3.", "Correct Q367.")
        return (tool.length(216), tool.length(217)), begin, sweep
    turned = math.radians(begin)  # Q376 is the angle of the tool position
    x, y = tool.here
    return (x - radius * math.cos(turned), y - radius * math.sin(turned)), begin - share * sweep, sweep


# The parameters of a slot by the numbers of the SL cycles. Other parameters of these cycles have fixed
# values.
_AS_CONTOUR: Parameters = {
    1: 201, 2: 370, 3: 368, 4: 369, 5: 203, 6: 200, 9: 351, 10: 202, 11: 206, 12: 207, 14: 0.0,
    18: 0.0, 208: MAX_FEED, 401: 100.0,
}  # fmt: skip


def _finishing(tool: CycleTool) -> Parameters:
    """Return the finishing parameters: feed Q385, infeeds of Q338, or one infeed if Q338 is 0."""
    feed: Parameters = {12: 385} if tool.plain(385, 0.0) else {}
    return {**feed, 10: 338 if tool.plain(338, 0.0) else -1e9}


# --- older cycles with a programmed center (Q216, Q217), executed as newer cycles with these parameters


Milling = Callable[[CycleTool], Iterator[Block]]

_HEIGHTS: Parameters = {200: 200, 201: 201, 203: 203, 204: 204}
_SLOT: Parameters = {**_HEIGHTS, 202: 202, 206: 207, 207: 207, 215: 215, 219: 219, 338: 338, 366: 1.0}
_WALLS: Parameters = {**_HEIGHTS, 202: 202, 206: 206, 207: 207, 215: 2.0, 338: 202}


def _centred(milling: Milling, parameters: Parameters) -> Milling:
    """Return a cycle around Q216, Q217 that executes another cycle with these parameters."""

    def run(tool: CycleTool) -> Iterator[Block]:
        surface, clear, _ = heights(tool)
        yield tool.to(max(clear, surface + tool.length(204, 0.0), tool.height))
        yield tool.across((tool.length(216), tool.length(217)))
        yield from milling(tool.seen(parameters))

    return run


def _round_corners(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 212, with corners of the tool radius if Q220 is 0."""
    radius = tool.length(220, 0.0) or tool.radius
    yield from _centred(rectangular_pocket, {**_WALLS, 218: 218, 219: 219, 220: radius / tool.scale})(tool)


def _older_stud(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 213; the oversize of the blank is Q221, or the tool diameter without Q221."""
    more = 2.0 * (tool.plain(221, 0.0) or tool.radius / tool.scale)
    sides = {424: tool.plain(218) + more, 425: tool.plain(219) + more}
    yield from _centred(rectangular_stud, {**_WALLS, 218: 218, 219: 219, 220: 220, **sides})(tool)


MILLED: dict[int, Milling] = {
    210: _centred(slot, {**_SLOT, 218: 218, 374: 224}),
    211: _centred(circular_slot, {**_SLOT, 216: 216, 217: 217, 375: 244, 376: 245, 248: 248}),
    212: _round_corners,
    213: _older_stud,
    214: _centred(circular_pocket, {**_WALLS, 223: 223}),
    215: _centred(circular_stud, {**_WALLS, 222: 222, 223: 223}),
    251: rectangular_pocket,
    252: circular_pocket,
    253: slot,
    254: circular_slot,
    256: rectangular_stud,
    257: circular_stud,
}
"""Cycles by their number."""
