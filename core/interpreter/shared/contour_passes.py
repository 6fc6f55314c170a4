"""Passes of canned cycles: passes of equal depth, and roughing passes along a contour."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from math import ceil, dist
from typing import NamedTuple

from core.geometry.contour_offset import Area, Span
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, clearance, intersections

_WHOLE = 1e-6  # of a pass; tolerance for the rounding of decimal fractions


def pass_count(whole: float, most: float) -> int:
    """Return the number of passes, each at most ``most`` mm deep, for a total depth of ``whole`` mm."""
    return ceil(whole / most - _WHOLE)


def equal_depths(whole: float, count: int) -> list[float]:
    """Return the depths of ``count`` equal passes in mm; the last depth is ``whole``."""
    return [whole * k / count for k in range(1, count + 1)]


class Move(NamedTuple):
    """One motion of a cycle to a point in the program frame, in mm.

    ``rapid`` is the rapid rate in mm/s, or None for a move at the feed.
    """

    x: float
    z: float
    rapid: float | None = None
    centre: Point | None = None
    clockwise: bool = False


# --- passes and the finishing cut along the contour, in depth and length from the start point


_SAME = 1e-6  # mm
_NEARER = 0.002  # mm; tolerance of the clearance between a move and the contour
_TOUCHING = 0.02  # mm; tolerance at the ends of moves, which end on the contour if U is 0


MOST_ELEMENTS = 2_000
MOST_LOOKS = 200_000  # elements times passes; takes a few seconds


class StartNearError(Exception):
    """The approach to the contour or the retract would come closer to the contour than permitted."""


class Rougher:
    """Planner of roughing passes.

    ``cut`` adds passes of growing depth to ``moves``, and ``finish`` adds a cut along the contour.

    The tool feeds into a span from the end of the previous pass. Between spans, it moves at ``rapid`` mm/s,
    ``lift`` mm above the remaining material.
    """

    def __init__(self, area: Area, rapid: float, lift: float) -> None:
        self.moves: list[Move] = []
        self.plunged = False
        self._area = area
        self._rapid, self._lift = rapid, lift
        self._at = 0.0, 0.0
        self._done: list[tuple[float, list[Span]]] = []
        self._free = area.spans(0.0)

    def cut(self, depth: float) -> None:
        """Add one pass through all spans at a depth in mm that exceeds the depth of all earlier passes."""
        spans = self._area.spans(depth)
        before = self._done[-1][0] if self._done else 0.0
        for start, end in spans:
            self._over(start)
            self._sink(before)
            self.plunged = self.plunged or start > 0
            self._feed(depth, self._at[1])
            self._feed(depth, end)
        self._done.append((depth, spans))

    def rough(self, count: int) -> None:
        """Add ``count`` passes of equal depth, down to the deepest point of the area."""
        for depth in equal_depths(self._area.deepest, count):
            self.cut(depth)

    def finish(self, *, backwards: bool) -> None:
        """Add a cut along the contour and the return to the start.

        Raises StartNearError if the approach or the retract would come too close to the contour.
        """
        path = self._area.path
        if backwards:
            path = [element.reversed() for element in reversed(path)]
        begun = len(self.moves)
        here = self._at
        self._approach(path[0].start, front=not backwards)
        self._check(here, self.moves[begun:])
        self._along(path)
        begun, here = len(self.moves), self._at
        self._leave(front=backwards)
        self._check(here, self.moves[begun:])

    def _approach(self, to: Point, *, front: bool) -> None:
        """Add the moves to the start of the path.

        The front end is reached from in front of the area, the back end from above.
        """
        way = min(to[1], 0.0) if front else to[1]
        self._over(way)
        done = [depth for depth, spans in self._done if _covering(spans, way, to[1])]
        if self._done:
            self._sink(min(max(done, default=0.0), to[0]))
        elif front:  # At the back end, the tool could hit remaining material.
            self._sink(to[0])
        self._feed(to[0], way)
        self._feed(*to)

    def _along(self, path: list[Element]) -> None:
        for element in path:
            if isinstance(element, Arc):
                self.moves.append(Move(*element.end, None, element.centre, element.clockwise))
                self._at = element.end
            else:
                self._feed(*element.end)

    def _leave(self, *, front: bool) -> None:
        if front:
            self._feed(self._at[0], min(self._at[1], 0.0))  # No pass may have reached this depth here.
        else:
            self._over(0.0)
        self._go(0.0, self._at[1])
        self._go(0.0, 0.0)

    def _over(self, way: float) -> None:
        """Add a move to another position above all remaining material."""
        if abs(way - self._at[1]) < _SAME:
            return
        level = min(self._clear(self._at[1], way), self._at[0])
        self._go(level, self._at[1])
        self._go(level, way)

    def _sink(self, depth: float) -> None:
        """Add a move down to ``lift`` above a depth that has already been cut here."""
        if depth - self._lift > self._at[0]:
            self._go(depth - self._lift, self._at[1])

    def _clear(self, a: float, b: float) -> float:
        """Return the depth at which the tool can move between two positions.

        It is ``lift`` above the deepest pass that covers the whole distance.
        """
        low, high = min(a, b), max(a, b)
        for depth, spans in reversed(self._done):
            if _covering(spans, low, high):
                return depth - self._lift
        return 0.0 if _covering(self._free, low, high) else min(0.0, self._area.top - self._lift)

    def _go(self, depth: float, way: float) -> None:
        self.moves.append(Move(depth, way, self._rapid))
        self._at = depth, way

    def _feed(self, depth: float, way: float) -> None:
        self.moves.append(Move(depth, way))
        self._at = depth, way

    def _check(self, here: Point, moves: list[Move]) -> None:
        for move in moves:
            there = move.x, move.z
            if dist(here, there) > _SAME and self._near(here, there):
                raise StartNearError
            here = there

    def _near(self, here: Point, there: Point) -> bool:
        """Return whether a move along one axis comes too close to the contour, or crosses it if U is 0."""
        left, way = self._area.left, Line(here, there)
        if left > _NEARER:
            return any(clearance(way, element) < left - _NEARER for element in self._area.contour)
        depth, ways = max(here[0], there[0]) - _TOUCHING, (here[1], there[1])
        if way.length <= 2 * _TOUCHING:
            return False
        if _covering(self._area.spans(depth), max(min(ways), 0.0), max(ways)):
            return False
        inner = Line(way.point(_TOUCHING), way.point(way.length - _TOUCHING))
        return any(intersections(inner, element) for element in self._area.contour)


def _covering(spans: list[Span], low: float, high: float) -> bool:
    """Return whether one span covers the whole range from ``low`` to ``high``."""
    at = bisect_left(spans, low + _SAME, key=lambda span: span[0]) - 1
    return at >= 0 and spans[at][1] >= high - _SAME


# --- the contour in the frame of the start point


class ContourView(NamedTuple):
    """The frame of a contour, relative to the start point of the cycle.

    ``x`` and ``z`` are +1 or -1. With ``backwards``, the tool is on the left of the reversed contour.
    """

    start: Point
    x: float
    z: float
    backwards: bool

    def from_start(self, contour: Sequence[Element]) -> list[Element]:
        """Return the contour in depth and length from the start point, with the tool on its left."""
        elements = [self._element(element) for element in contour]
        return [element.reversed() for element in reversed(elements)] if self.backwards else elements

    def placed(self, move: Move) -> Move:
        """Return a motion, given in depth and length, in the program frame."""
        centre = None if move.centre is None else self._out(move.centre)
        x, z = self._out((move.x, move.z))
        return Move(x, z, move.rapid, centre, move.clockwise == (self.x * self.z > 0) and centre is not None)

    def _element(self, element: Element) -> Element:
        start, end = self._in(element.start), self._in(element.end)
        if isinstance(element, Line):
            return Line(start, end)
        return Arc(start, end, self._in(element.centre), element.clockwise == (self.x * self.z > 0))

    def _in(self, point: Point) -> Point:
        return (point[0] - self.start[0]) * self.x, (point[1] - self.start[1]) * self.z

    def _out(self, point: Point) -> Point:
        return self.start[0] + point[0] * self.x, self.start[1] + point[1] * self.z


def view_from(start: Point, first: Point, last: Point) -> ContourView:
    """Return the view of a contour from ``first`` to ``last``, both in one quadrant of ``start``."""
    a, b = _off(start, first), _off(start, last)
    x = 1.0 if a[0] + b[0] > 0 else -1.0
    z = 1.0 if a[1] + b[1] > 0 else -1.0
    # The tool is on the left of the contour if its first end is closer to the line along X through the start.
    cross = (a[0] * b[1] - a[1] * b[0]) * x * z
    return ContourView(start, x, z, backwards=cross < 0)


def _off(start: Point, point: Point) -> Point:
    return point[0] - start[0], point[1] - start[1]
