"""The other tools of a gang plate: they ride the same slide, and their tool offsets say where they stand."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from math import dist
from typing import NamedTuple

import numpy as np

from core.part.cutter import Cutter, Side
from core.part.swept_edge import FloatArray, Point
from core.part.tool_outline import outline
from core.part.tool_shape import ToolShape
from core.part.turned_part import NOTHING, Cut, TurnedPart

_ONE_PLACE = 1.0  # mm between the tips of two tools that cannot both be mounted
_ASSUMED_BODY = frozenset({"holder", "stick_out", "length"})


class SolidTool(NamedTuple):
    """All of a tool that must not meet metal: its extent about the control point, and its outlines on
    either side of the axis.
    """

    low: FloatArray
    high: FloatArray
    sides: tuple[Cutter, Cutter]

    def met(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Return the metal on the straight path of the control point, Z and r in mm; all of it stays."""
        low = self.low + np.minimum(start, end)
        high = self.high + np.maximum(start, end)
        columns, radius = part.columns, part.largest
        if low[0] > columns.first + columns.step * columns.number or high[0] < columns.first:
            return NOTHING
        if low[1] > radius or high[1] < -radius:
            return NOTHING
        front, rear = self.sides
        return front.reaches(part, start, end).joined(rear.reaches(part, start, end))


class _Neighbour(NamedTuple):
    """A tool and where it is on the plate, Z and r."""

    at: Point
    solid: SolidTool


class Neighbours:
    """Tools with a shape and an offset; ``offsets`` are machine Z and X of each tip on part zero, mm.

    Two tools with the same offset cannot both be mounted: ``in_one_place`` has such pairs, and neither is
    taken for the neighbour of the other. A holder without a stated size is left out.
    """

    def __init__(self, shapes: Mapping[int, ToolShape], offsets: Mapping[int, Point]) -> None:
        self._offsets = offsets
        self._tools = {n: _neighbour(shapes[n], offsets[n]) for n in sorted(shapes.keys() & offsets.keys())}
        self.in_one_place = tuple(
            (a, b)
            for a, b in combinations(sorted(self._tools), 2)
            if dist(offsets[a], offsets[b]) < _ONE_PLACE
        )

    def struck(self, part: TurnedPart, tool: int, way: Iterable[tuple[Point, Point]]) -> int:
        """The first other tool that metal meets while ``tool`` goes this way; 0 where none does."""
        if tool not in self._offsets:
            return 0
        own = self._offsets[tool]
        for start, end in way:
            for number, each in self._tools.items():
                shift = own[0] - each.at[0], own[1] - each.at[1]
                if number == tool or dist(own, each.at) < _ONE_PLACE:
                    continue
                if each.solid.met(part, _moved(start, shift), _moved(end, shift)):
                    return number
        return 0


def solid_tool(outlines: Sequence[FloatArray]) -> SolidTool:
    """Return the tool that consists of these convex outlines (k, 2) of Z and r, mm."""
    points = np.vstack(outlines)
    sides = Cutter((), outlines, Side.FACE), Cutter((), outlines, Side.FACE, rear=True)
    return SolidTool(points.min(axis=0), points.max(axis=0), sides)


def _neighbour(shape: ToolShape, at: Point) -> _Neighbour:
    lines = outline(shape)
    assumed = _ASSUMED_BODY.intersection(lines.assumed)
    return _Neighbour(at, solid_tool(lines.cutting if assumed else (*lines.cutting, *lines.body)))


def _same(one: Point, other: Point) -> bool:
    return dist(one, other) < _ONE_PLACE


def _moved(place: Point, by: Point) -> Point:
    return place[0] + by[0], place[1] + by[1]
