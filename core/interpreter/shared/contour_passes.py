"""Roughing and finishing passes of canned cycles, at equal depths or along a contour."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from math import ceil, dist
from typing import NamedTuple

from core.geometry.contour_offset import RoughingArea, ZSpan
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, compute_min_distance, find_intersections

_ROUNDING_TOLERANCE = 1e-6  # of a pass; tolerance for the rounding of decimal fractions


def count_passes(total_depth_mm: float, max_depth_mm: float) -> int:
    """Return the number of passes of at most ``max_depth_mm`` that cut the total depth ``total_depth_mm``."""
    return ceil(total_depth_mm / max_depth_mm - _ROUNDING_TOLERANCE)


def compute_equal_depths(total_depth_mm: float, count: int) -> list[float]:
    """Return the depths of ``count`` equal passes in mm, ending with ``total_depth_mm``."""
    return [total_depth_mm * k / count for k in range(1, count + 1)]


class CycleMove(NamedTuple):
    """One motion of a cycle to a point in the program frame, in mm.

    ``rapid_rate_mm_s`` is the rapid rate, or None for a move at the feed.
    """

    x: float
    z: float
    rapid_rate_mm_s: float | None = None
    center: Point | None = None
    is_clockwise: bool = False


# --- passes and the finishing cut along the contour, in depth and length from the start point


_SAME = 1e-6  # mm
_CLEARANCE_TOLERANCE_MM = 0.002  # mm; tolerance of the clearance between a move and the contour
_TOUCHING = 0.02  # mm; tolerance at the ends of moves, which end on the contour if U is 0


MAX_ELEMENT_COUNT = 2_000
MAX_COMPARISON_COUNT = 200_000  # elements times passes; takes a few seconds


class ContourClearanceError(Exception):
    """Error for an approach or retract that would come closer to the contour than permitted."""


class RoughingPlanner:
    """Planner of the passes that rough a contour.

    ``add_pass`` adds passes of increasing depth to ``moves``, and ``add_finishing_pass`` adds a cut along
    the contour. A span is a section of a pass in which there is material to cut. The tool moves into a span
    at the feed, starting just above the depth of the previous pass. Between spans, the tool moves at
    ``rapid`` mm/s, ``lift`` mm above the remaining material.
    """

    def __init__(self, area: RoughingArea, rapid: float, lift: float) -> None:
        self.moves: list[CycleMove] = []
        self.has_plunged = False
        self._area = area
        self._rapid, self._lift = rapid, lift
        self._at = 0.0, 0.0
        self._done: list[tuple[float, list[ZSpan]]] = []
        self._free = area.find_clear_spans(0.0)

    def add_pass(self, depth: float) -> None:
        """Add one pass through all spans at a depth in mm.

        The depth must exceed the depths of all earlier passes.
        """
        spans = self._area.find_clear_spans(depth)
        before = self._done[-1][0] if self._done else 0.0
        for start, end in spans:
            self._move_above(start)
            self._sink(before)
            self.has_plunged = self.has_plunged or start > 0
            self._feed(depth, self._at[1])
            self._feed(depth, end)
        self._done.append((depth, spans))

    def add_roughing_passes(self, count: int) -> None:
        """Add ``count`` passes of equal depth, down to the deepest point of the area."""
        for depth in compute_equal_depths(self._area.max_depth, count):
            self.add_pass(depth)

    def add_finishing_pass(self, *, is_reversed: bool) -> None:
        """Add a cut along the contour and the return to the start.

        Raises ContourClearanceError if the approach or the retract would come too close to the contour.
        """
        path = self._area.path
        if is_reversed:
            path = [element.make_reversed() for element in reversed(path)]
        begun = len(self.moves)
        here = self._at
        self._approach(path[0].start, front=not is_reversed)
        self._check(here, self.moves[begun:])
        self._along(path)
        begun, here = len(self.moves), self._at
        self._leave(front=is_reversed)
        self._check(here, self.moves[begun:])

    def _approach(self, to: Point, *, front: bool) -> None:
        """Add the moves to the start of the contour.

        The tool approaches the front end of the contour from the front, and the back end from above.
        """
        length = min(to[1], 0.0) if front else to[1]
        self._move_above(length)
        done = [depth for depth, spans in self._done if _covering(spans, length, to[1])]
        if self._done:
            self._sink(min(max(done, default=0.0), to[0]))
        elif front:  # At the back end, the tool could hit remaining material.
            self._sink(to[0])
        self._feed(to[0], length)
        self._feed(*to)

    def _along(self, path: list[Element]) -> None:
        for element in path:
            if isinstance(element, Arc):
                self.moves.append(CycleMove(*element.end, None, element.center, element.clockwise))
                self._at = element.end
            else:
                self._feed(*element.end)

    def _leave(self, *, front: bool) -> None:
        if front:
            self._feed(self._at[0], min(self._at[1], 0.0))  # No pass may have reached this depth here.
        else:
            self._move_above(0.0)
        self._go(0.0, self._at[1])
        self._go(0.0, 0.0)

    def _move_above(self, target: float) -> None:
        """Add a move to another position, above all remaining material."""
        if abs(target - self._at[1]) < _SAME:
            return
        level = min(self._clear_depth(self._at[1], target), self._at[0])
        self._go(level, self._at[1])
        self._go(level, target)

    def _sink(self, depth: float) -> None:
        """Add a move down to a point ``lift`` mm above a depth, unless the tool is already that low.

        ``depth`` is in mm. The material at this position has already been cut to this depth.
        """
        if depth - self._lift > self._at[0]:
            self._go(depth - self._lift, self._at[1])

    def _clear_depth(self, a: float, b: float) -> float:
        """Return the greatest depth at which the tool can move freely between two positions.

        This depth is ``lift`` above the deepest pass that covers the whole distance.
        """
        low, high = min(a, b), max(a, b)
        for depth, spans in reversed(self._done):
            if _covering(spans, low, high):
                return depth - self._lift
        return 0.0 if _covering(self._free, low, high) else min(0.0, self._area.top_depth - self._lift)

    def _go(self, depth: float, length: float) -> None:
        self.moves.append(CycleMove(depth, length, self._rapid))
        self._at = depth, length

    def _feed(self, depth: float, length: float) -> None:
        self.moves.append(CycleMove(depth, length))
        self._at = depth, length

    def _check(self, here: Point, moves: list[CycleMove]) -> None:
        for move in moves:
            there = move.x, move.z
            if dist(here, there) > _SAME and self._is_too_close(here, there):
                raise ContourClearanceError
            here = there

    def _is_too_close(self, start: Point, end: Point) -> bool:
        """Return whether a move along one axis comes too close to the contour.

        If the allowance U is 0, a move is too close only if it crosses the contour.
        """
        left, line = self._area.allowance_mm, Line(start, end)
        if left > _CLEARANCE_TOLERANCE_MM:
            return any(
                compute_min_distance(line, element) < left - _CLEARANCE_TOLERANCE_MM
                for element in self._area.contour
            )
        depth, lengths = max(start[0], end[0]) - _TOUCHING, (start[1], end[1])
        if line.length <= 2 * _TOUCHING:
            return False
        if _covering(self._area.find_clear_spans(depth), max(min(lengths), 0.0), max(lengths)):
            return False
        inner = Line(line.get_point(_TOUCHING), line.get_point(line.length - _TOUCHING))
        return any(find_intersections(inner, element) for element in self._area.contour)


def _covering(spans: list[ZSpan], low: float, high: float) -> bool:
    """Return whether one span covers the whole range from ``low`` to ``high``."""
    at = bisect_left(spans, low + _SAME, key=lambda span: span[0]) - 1
    return at >= 0 and spans[at][1] >= high - _SAME


# --- the contour in the frame of the start point


class ContourFrame(NamedTuple):
    """The coordinate frame of a contour, with its origin at the start point of the cycle.

    ``x_sign`` and ``z_sign`` are +1 or -1. ``is_reversed`` means that the contour must be reversed so that
    the tool is on its left.
    """

    start: Point
    x_sign: float
    z_sign: float
    is_reversed: bool

    def transform_contour(self, contour: Sequence[Element]) -> list[Element]:
        """Return the contour in depth and length from the start point, oriented with the tool on its left."""
        elements = [self._element(element) for element in contour]
        return [element.make_reversed() for element in reversed(elements)] if self.is_reversed else elements

    def transform_move(self, move: CycleMove) -> CycleMove:
        """Convert a motion from depth and length to the program frame."""
        centre = None if move.center is None else self._out(move.center)
        x, z = self._out((move.x, move.z))
        return CycleMove(
            x,
            z,
            move.rapid_rate_mm_s,
            centre,
            move.is_clockwise == (self.x_sign * self.z_sign > 0) and centre is not None,
        )

    def _element(self, element: Element) -> Element:
        start, end = self._in(element.start), self._in(element.end)
        if isinstance(element, Line):
            return Line(start, end)
        return Arc(start, end, self._in(element.center), element.clockwise == (self.x_sign * self.z_sign > 0))

    def _in(self, point: Point) -> Point:
        return (point[0] - self.start[0]) * self.x_sign, (point[1] - self.start[1]) * self.z_sign

    def _out(self, point: Point) -> Point:
        return self.start[0] + point[0] * self.x_sign, self.start[1] + point[1] * self.z_sign


def make_contour_frame(start: Point, first_point: Point, last_point: Point) -> ContourFrame:
    """Return the frame of a contour from ``first_point`` to ``last_point``.

    As seen from ``start``, both points must be in the same quadrant.
    """
    a, b = _off(start, first_point), _off(start, last_point)
    x = 1.0 if a[0] + b[0] > 0 else -1.0
    z = 1.0 if a[1] + b[1] > 0 else -1.0
    # The tool is on the left of the contour if its first end is closer to the line along X through the start.
    cross = (a[0] * b[1] - a[1] * b[0]) * x * z
    return ContourFrame(start, x, z, is_reversed=cross < 0)


def _off(start: Point, point: Point) -> Point:
    return point[0] - start[0], point[1] - start[1]
