"""Rings that pockets, slots and studs are milled by: rectangles with round corners, placed and turned."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from core.geometry.lines_and_arcs import Arc, Point
from core.interpreter.elementary_blocks import Block
from core.interpreter.klartext.cycle_moves import CycleTool

_SMALLEST = 1e-6  # mm


@dataclass(frozen=True, slots=True)
class Seat:
    """Where a figure sits in the program's X and Y: its middle, and the angle of its first side, degrees."""

    middle: Point
    angle: float = 0.0

    def at(self, u: float, v: float) -> Point:
        """The point of the program for one along the first side and one along the second, mm."""
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        return self.middle[0] + c * u - s * v, self.middle[1] + s * u + c * v

    def moved(self, u: float, v: float) -> Seat:
        """The same with its middle there."""
        return Seat(self.at(u, v), self.angle)


@dataclass(frozen=True, slots=True)
class Ring:
    """A rectangle of half sides ``a`` and ``b`` with corners of ``radius``, mm."""

    a: float
    b: float
    radius: float

    def wider(self, by: float) -> Ring:
        """The same, ``by`` further out; corners stay round."""
        return Ring(self.a + by, self.b + by, max(self.radius + by, 0.0))

    def milled(self, tool: CycleTool, seat: Seat, feed: float, *, clockwise: bool) -> Iterator[Block]:
        """Round from the middle of the side in +u, at the height where the tool stands."""
        r = min(self.radius, self.a, self.b)
        side = -1.0 if clockwise else 1.0
        u, v = self.a - r, self.b - r
        corners = (
            ((self.a, v), (u, self.b), (u, v)),
            ((-u, self.b), (-self.a, v), (-u, v)),
            ((-self.a, -v), (-u, -self.b), (-u, -v)),
            ((u, -self.b), (self.a, -v), (u, -v)),
        )
        z = tool.height
        for start, end, centre in corners:
            first, last, about = (seat.at(x, side * y) for x, y in (start, end, centre))
            yield from _straight(tool, first, feed)
            if r > _SMALLEST:
                yield tool.round(Arc(first, last, about, clockwise), z, feed)
        yield from _straight(tool, seat.at(self.a, 0.0), feed)


def _straight(tool: CycleTool, at: Point, feed: float) -> Iterator[Block]:
    if math.dist(tool.here, at) > _SMALLEST:
        yield tool.across(at, None, feed)
