"""SL cycles: pockets and islands of closed contours (20 to 24), and milling along open contours (25).

As in the manual, every point of the pocket that the tool can reach is cleared, and no point outside the
pocket or in an island is touched. The tool path is TurnDesk's own: rings from the inside out, and a ramp of 3
degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

from core.geometry.contour_offset import GougeError, pieces_beside
from core.geometry.lines_and_arcs import SAME_POINT, Arc, Element, Point, left_of
from core.geometry.pocket_area import AreaError, Cut, Loop, Within, begun_at, clearing, follows, inset, walked
from core.interpreter.klartext.cycles.contour_figures import OPEN, ContourFigure, area_of
from core.interpreter.klartext.cycles.cycle_moves import CycleTool
from core.interpreter.klartext.cycles.hole_cycles import SMALLEST, levels
from core.interpreter.klartext.klartext_state import State
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import ProgramError
from core.language.klartext.q_parameters import MAX_FEED

_RAMP = math.tan(math.radians(3.0))
_MOST_OVERLAP = 2.0
_MOST_RAMP = 1000.0  # maximum number of rounds of a ramp along a ring
_ABOVE = 2.0  # mm above the surface; cycle 25 has no Q6 and continues at Q11 from there
_TRIES = 6  # number of times that the arc to a wall is halved until it fits

Figures = Sequence[ContourFigure]


class Clearing:
    """Data of cycle 20 (Q1 to Q9), feeds of the active cycle, and the area to be cleared."""

    def __init__(self, tool: CycleTool, area: Sequence[Loop] = (), above: float | None = None) -> None:
        self.tool, self.area = tool, area
        depth = tool.length(1)
        text = "Depth Q1={depth} mm is positive (upward)."
        tool.check(depth <= 0.0, text, "Enter the depth with a minus sign.", depth=f"{depth:+.10g}")
        self.surface = tool.length(5, 0.0)
        self.bottom = self.surface + depth
        self.clear = self.surface + (tool.length(6) if above is None else above)
        self.safe = max(tool.length(7), self.clear)
        self.side, self.floor = tool.length(3, 0.0), tool.length(4, 0.0)
        if tool.radius <= SMALLEST:
            raise tool.refuse("The tool radius is not defined.", "Enter the tool radius R in the tool table.")

    @property
    def against(self) -> bool:
        """Whether pockets are milled clockwise: up-cut milling (negative Q9) with M3."""
        return (self.tool.plain(9, 1.0) < 0.0) != (self.tool.rpm < 0.0)

    @property
    def step(self) -> float:
        """Distance between rings in mm: Q2 times the tool radius.

        It is at most the tool radius, so that no material remains. Raises ProgramError for an invalid Q2.
        """
        overlap = self.tool.plain(2, 1.0)
        text = "With path overlap {named}={overlap}, the cycle cannot clear the area."
        hint = "Enter a value between 0.0001 and 1.9999."
        self.tool.check(0.0 < overlap < _MOST_OVERLAP, text, hint, named=self.tool.named(2), overlap=overlap)
        return min(overlap, 1.0) * self.tool.radius

    def levels(self, bottom: float) -> list[float]:
        """Return the heights of the infeeds; the last one is the bottom."""
        return levels(self.tool, self.surface, bottom, lambda: abs(self.tool.length(10)))

    def plan(self, radius: float) -> list[Cut]:
        """Return the rings that clear one level with a tool of this radius in mm."""
        share = self.step / self.tool.radius * radius
        here = self.tool.here
        try:
            return clearing(self.area, radius + self.side, share, radius, against=self.against, here=here)
        except AreaError as problem:
            raise self.unfit(problem) from None

    def unfit(self, problem: AreaError | GougeError) -> ProgramError:
        """Return the error for a contour that does not fit the tool radius."""
        text = "The contour cannot be milled with tool radius {radius} mm plus the allowance: {problem}."
        hint, radius = "Use a smaller tool, or correct the contour.", f"{self.tool.radius:.10g}"
        return self.tool.refuse(text, hint, radius=radius, problem=problem)

    def above(self) -> Iterator[Block]:
        """Yield a rapid to the clearance height."""
        yield self.tool.to(max(self.safe, self.tool.height))

    def home(self) -> Iterator[Block]:
        """Yield the retract at Q208 to the clearance height."""
        tool = self.tool
        asked = tool.plain(208, MAX_FEED)
        back = None if asked >= MAX_FEED else tool.feed(208) if asked else tool.cut(12)
        if back is not None and tool.height < self.clear:
            yield tool.to(self.clear, back)
        yield tool.to(self.safe)


def contour_data(tool: CycleTool) -> None:
    """Check the data of cycle 20, which remain in Q1 to Q9. Raises ProgramError if they are invalid."""
    tool.check(tool.length(1) <= 0.0, "Depth Q1 is positive (upward).", "Enter the depth with a minus sign.")
    text = "With the programmed path overlap Q2, the cycle cannot clear the area."
    tool.check(0.0 < tool.plain(2, 1.0) < _MOST_OVERLAP, text, "Set Q2 to a value between 0.0001 and 1.9999.")


# --- clearing -------------------------------------------------------------------------------------------


def pilot_drilling(tool: CycleTool, area: Sequence[Loop]) -> Iterator[Block]:
    """Yield the blocks of cycle 21: a hole at each position at which cycle 22 plunges with tool Q13."""
    told = Clearing(tool, area)
    radius = tool.radius_of(int(tool.plain(13)))
    if radius is None or radius <= SMALLEST:
        text = "Rough-out tool {plain} (Q13) has no radius in the tool table."
        raise tool.refuse(text, "Set Q13 to the number of a measured tool.", plain=tool.plain(13))
    feed, bottom = told.tool.cut(11), told.bottom + told.floor
    yield from told.above()
    for cut in told.plan(radius):
        if cut.straight:
            continue
        yield tool.across(cut.ramp[0].start)
        yield tool.to(told.clear)
        for z in told.levels(bottom):
            yield tool.to(z, feed)
            yield tool.to(told.clear)
        yield tool.to(told.safe)


def rough_out(tool: CycleTool, area: Sequence[Loop]) -> Iterator[Block]:
    """Yield the blocks of cycle 22: clearing by levels, with the allowances of cycle 20.

    Q401 reduces the feed in full cuts.
    """
    told = Clearing(tool, area)
    if tool.plain(18, 0.0):
        tool.tell(
            "the whole pocket is milled again, including the area that the coarse roughing tool "
            "(Q18) has cleared."
        )
    feed = told.tool.cut(12)
    slow = feed * min(max(tool.plain(401, 100.0), 1.0), 100.0) / 100.0
    plan = told.plan(tool.radius)
    yield from told.above()
    top = told.surface
    for z in told.levels(told.bottom + told.floor):
        for cut in plan:
            yield from _down_to(told, cut, top, z, slow)
            yield from _along(tool, cut.loop, feed if cut.straight else slow)
        top = z
    yield from told.home()


def _down_to(told: Clearing, cut: Cut, top: float, z: float, slow: float) -> Iterator[Block]:
    """Yield the moves to the start of a ring at its depth, or along a ramp."""
    tool = told.tool
    if not cut.straight:
        yield from tool.over(cut.ramp[0].start, told.clear)
        yield from _ramp(told, cut, top, z, slow)
    elif math.dist(tool.here, cut.loop[0].start) > SAME_POINT:
        yield tool.across(cut.loop[0].start, None, slow)


def _ramp(told: Clearing, cut: Cut, top: float, z: float, slow: float) -> Iterator[Block]:
    """Yield the plunge: straight down at Q11 if Q19 is 0, otherwise along the ring at Q19."""
    tool = told.tool
    yield tool.to(top, told.tool.cut(11))
    if not tool.plain(19, 0.0):
        yield tool.to(z, told.tool.cut(11))
    else:
        feed, length, ring = told.tool.cut(19), (top - z) / _RAMP, sum(element.length for element in cut.ramp)
        text = "There is not enough room to plunge along a ramp."
        tool.check(length <= _MOST_RAMP * ring, text, "Use a center-cutting tool and plunge vertically.")
        way, rest = walked(cut.ramp, length)
        done = 0.0
        for element in way:
            done += element.length
            yield _element(tool, element, top + (z - top) * min(done / length, 1.0), feed)
        yield from _along(tool, walked(rest, math.ceil(length / ring - 1e-9) * ring - length)[0], slow)
    if math.dist(tool.here, cut.loop[0].start) > SAME_POINT:
        yield tool.across(cut.loop[0].start, None, slow)


def _along(tool: CycleTool, loop: Sequence[Element], feed: float) -> Iterator[Block]:
    for element in loop:
        yield _element(tool, element, tool.height, feed)


def _element(tool: CycleTool, element: Element, z: float, feed: float) -> Block:
    if isinstance(element, Arc):
        return tool.round(element, z, feed)
    return tool.across(element.end, z, feed)


def floor_finishing(tool: CycleTool, area: Sequence[Loop]) -> Iterator[Block]:
    """Yield the blocks of cycle 23: the floor at its depth, up to the walls with their allowance."""
    told = Clearing(tool, area)
    feed, plunge = told.tool.cut(12), told.tool.cut(11)
    plan = told.plan(tool.radius)
    yield from told.above()
    for cut in plan if told.surface - told.bottom > SMALLEST else ():
        start = cut.loop[0].start
        if not cut.straight:
            yield from tool.over(start, told.clear)
            yield tool.to(told.bottom, plunge)
        elif math.dist(tool.here, start) > SAME_POINT:
            yield tool.across(start, None, feed)
        yield from _along(tool, cut.loop, feed)
    yield from told.home()


# --- walls ------------------------------------------------------------------------------------------------


def side_finishing(tool: CycleTool, area: Sequence[Loop]) -> Iterator[Block]:
    """Yield the blocks of cycle 24: the walls to Q14, with quarter circles as approach and departure."""
    told = Clearing(tool, area)
    feed, plunge = told.tool.cut(12), told.tool.cut(11)
    apart = tool.radius + tool.length(14, 0.0)
    try:
        loops = inset(area, apart)
    except AreaError as problem:
        raise told.unfit(problem) from None
    if not loops:
        raise told.unfit(AreaError("the tool does not fit anywhere inside the contour"))
    room = Within(area)
    yield from told.above()
    for loop in loops:
        ring = [element.reversed() for element in reversed(loop)] if told.against else loop
        ring, to_it, off_it = _led(ring, room, apart, tool.radius, against=told.against)
        for z in told.levels(told.bottom):
            yield from tool.over(to_it.start if to_it else ring[0].start, told.clear)
            yield tool.to(z, plunge)
            yield from _along(tool, [each for each in (to_it, *ring, off_it) if each is not None], feed)
        yield tool.to(told.clear)
    yield from told.home()


def _led(
    ring: Loop, room: Within, apart: float, radius: float, *, against: bool
) -> tuple[Loop, Arc | None, Arc | None]:
    """Return the ring with a new start, and its approach and departure arcs.

    The start is at a point with room for both arcs. Without such a point, both arcs are None.
    """
    order = sorted(range(len(ring)), key=lambda at: (isinstance(ring[at], Arc), -ring[at].length))
    for size in (radius / 2.0**tries for tries in range(_TRIES)):
        for at in order:
            begun = begun_at(ring, at, ring[at].length / 2.0)
            to_it, off_it = _quarters(begun[0].start, begun[0].start_direction, size, left=not against)
            if room.holds(to_it, apart) and room.holds(off_it, apart):
                return begun, to_it, off_it
    return begun_at(ring, order[0], ring[order[0]].length / 2.0), None, None


def _quarters(at: Point, direction: Point, size: float, *, left: bool) -> tuple[Arc, Arc]:
    """Return the quarter circles on the pocket side, to a point of the wall and away from it."""
    x, y = left_of(direction)
    side = (x, y) if left else (-x, -y)
    centre = at[0] + side[0] * size, at[1] + side[1] * size
    before = centre[0] - direction[0] * size, centre[1] - direction[1] * size
    behind = centre[0] + direction[0] * size, centre[1] + direction[1] * size
    return Arc(before, at, centre, not left), Arc(at, behind, centre, not left)


# --- open contours ----------------------------------------------------------------------------------------


def contour_train(tool: CycleTool, figures: Figures) -> Iterator[Block]:
    """Yield the blocks of cycle 25: levels along a contour; Q15 is 0 for both directions, -1 for up-cut."""
    told = Clearing(tool, above=_ABOVE)
    if len(figures) > 1:
        tool.tell("Cycle 25 mills only the first contour listed in cycle 14.")
    figure = figures[0]
    way = _beside(told, figure)
    kind = tool.plain(15, 1.0)
    climbs = (figure.side == "L") == (tool.rpm > 0.0)  # in the programmed direction
    if kind and figure.side and climbs != (kind > 0.0):
        way = [element.reversed() for element in reversed(way)]
    feed, plunge = told.tool.cut(12), told.tool.cut(11)
    yield from told.above()
    for index, z in enumerate(told.levels(told.bottom)):
        if kind or index == 0:
            yield tool.to(max(told.clear, tool.height) if index else tool.height)
            yield tool.across(way[0].start)
            yield tool.to(told.clear)
        yield tool.to(z, plunge)
        yield from _along(tool, way, feed)
        if not kind:
            way = [element.reversed() for element in reversed(way)]
    yield tool.to(told.safe)


def _beside(told: Clearing, figure: ContourFigure) -> list[Element]:
    """Return the path of the tool center, at the tool radius plus Q3 from the contour.

    Without RL or RR, the path is the contour itself.
    """
    elements = list(figure.elements)
    text = "Contour {figure} does not contain any elements."
    told.tool.check(elements, text, "Add path functions to the contour.", figure=figure.label)
    if not figure.side:
        return elements
    apart = told.tool.radius + told.side
    closed = math.dist(elements[-1].end, elements[0].start) <= OPEN
    if closed:
        elements = follows(elements)
    try:
        beside = pieces_beside(elements, apart if figure.side == "L" else -apart)
    except GougeError as problem:
        raise told.unfit(problem) from None
    return [piece.element for piece in beside]


def run_contour(state: State, tool: CycleTool, number: int, figures: Figures, column: int) -> Iterator[Block]:
    """Yield the blocks of a cycle of ``CONTOURS`` for its contours. Raises ProgramError."""
    if number == TRAIN:
        yield from contour_train(tool, figures)
    else:
        yield from _AREAS[number](tool, area_of(state, figures, column))


TRAIN = 25
_AREAS: dict[int, Callable[[CycleTool, Sequence[Loop]], Iterator[Block]]] = {
    21: pilot_drilling,
    22: rough_out,
    23: floor_finishing,
    24: side_finishing,
}
CONTOURS = frozenset({*_AREAS, TRAIN})
"""Cycles by their number."""
