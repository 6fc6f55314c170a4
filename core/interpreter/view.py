"""A contour as the start point of a cycle sees it: depth along X and way along Z, both growing towards it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from core.geometry.arcs import Point
from core.geometry.contour import Arc, Element, Line
from core.interpreter.cycle_blocks import Move


class View(NamedTuple):
    """``x`` and ``z`` are +1 or -1; ``backwards``: the tool is left of the contour as run from its end."""

    start: Point
    x: float
    z: float
    backwards: bool

    def seen(self, contour: Sequence[Element]) -> list[Element]:
        """The contour in depths and ways, so that the tool is on its left."""
        elements = [self._element(element) for element in contour]
        return [element.reversed() for element in reversed(elements)] if self.backwards else elements

    def placed(self, move: Move) -> Move:
        """A motion in depth and way back in the program's frame."""
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


def view_from(start: Point, first: Point, last: Point) -> View:
    """The view of a contour from ``first`` to ``last``, both in one quadrant of ``start``."""
    a, b = _off(start, first), _off(start, last)
    x = 1.0 if a[0] + b[0] > 0 else -1.0
    z = 1.0 if a[1] + b[1] > 0 else -1.0
    # The tool is on the left of a contour whose first end is the nearer one to the X axis through the start.
    cross = (a[0] * b[1] - a[1] * b[0]) * x * z
    return View(start, x, z, backwards=cross < 0)


def _off(start: Point, point: Point) -> Point:
    return point[0] - start[0], point[1] - start[1]
