"""A tool that machines a turned part: the material that it removes, and collisions of its body.

An outside tool removes everything further out than its edge, because material above the edge is a chip or
would hit the holder. A boring tool removes everything closer to the axis. A face tool removes only what its
outline covers.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import combinations
from math import dist
from typing import NamedTuple

import numpy as np

from core.part.swept_edge import Edge, FloatArray, Point, sweep, towards_axis
from core.part.tool_outline import outline as outline_of
from core.part.tool_shape import ToolShape
from core.part.turned_part import NOTHING, Cut, TurnedPart

_OVERLAP = 0.02  # mm; a body that enters the material by less only touches it
_PHASE = 1e-6  # turns
_ONE_PLACE = 1.0  # =
_ASSUMED_BODY = frozenset({"holder", "stick_out", "length"})


class Side(StrEnum):
    """The side from which a tool machines the part."""

    OUTSIDE = "outside"
    BORE = "bore"
    FACE = "face"


@dataclass(frozen=True, slots=True)
class _Sides:
    """Both sides of one convex outline. ``far`` is the side away from the axis, mirrored."""

    near: Edge
    far: Edge


class _Outlines(NamedTuple):
    """Convex outlines with their least Z and r and their greatest Z; infinitely far away if empty."""

    sides: list[_Sides]
    low: Point
    front: float

    @classmethod
    def of(cls, outlines: Iterable[FloatArray]) -> _Outlines:
        sides = [_sides(outline) for outline in outlines]
        z = min((float(each.near.z[0]) for each in sides), default=math.inf)
        r = min((float(each.near.r.min()) for each in sides), default=math.inf)
        return cls(sides, (z, r), max((float(each.near.z[-1]) for each in sides), default=-math.inf))


class Cutter:
    """The outlines (k, 2) of a tool in Z and r about its control point, prepared for sweeping.

    ``drills`` means that the tool is round about the spindle axis. ``rear`` means that it works at negative
    X, where its outlines are given. ``height`` is the size of its edges along r in mm.
    """

    def __init__(
        self, cutting: Iterable[FloatArray], body: Iterable[FloatArray], side: Side, *, rear: bool = False,
        drills: bool = False,
    ) -> None:  # fmt: skip
        self.side, self.drills = side, drills
        self.across = -1.0 if rear else 1.0  # sign of X on the working side
        turned = np.array([1.0, self.across])
        outlines = tuple(cutting)
        self._cutting = _Outlines.of(outline * turned for outline in outlines)
        self._body = _Outlines.of(outline * turned for outline in body)
        self.height = max((float(np.ptp(outline[:, 1])) for outline in outlines), default=0.0)
        self._clears: dict[int, float] = {}

    @property
    def held(self) -> bool:
        """True if the holder of the tool is known."""
        return bool(self._body.sides)

    def clears(self, forward: int) -> float:
        """Return the angle in degrees from Z at which the trailing edge rises from the tip.

        ``forward`` is the sign of Z in the cutting direction. The result is 90 if no trailing edge rises.
        """
        if forward not in self._clears:
            self._clears[forward] = self._clearance(forward)
        return self._clears[forward]

    def _clearance(self, forward: int) -> float:
        outline = self._cutting.sides[0]
        edge = outline.far if self.side is Side.BORE else outline.near
        rises = -forward * edge.slope
        lengths = np.where(rises > 0.0, np.hypot(np.diff(edge.z), np.diff(edge.r)), 0.0)
        sides = rises[lengths > 0.5 * lengths.max(initial=0.0)]  # without the chords of the nose
        return float(np.degrees(np.arctan(sides.min()))) if len(sides) else 90.0

    def cut(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Remove the material that the edges sweep on a straight move of the control point."""
        return self._swept(part, start, end, cut=True)

    def meets(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Return the material that the edges would remove, without removing it."""
        return self._swept(part, start, end, cut=False)

    def strikes(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Return the material that holder and shank hit, and remove it so that it is reported only once."""
        met = NOTHING
        start, end = self._fronts(start, end)
        if self._clear_of(part, self._body, start, end) or self._above(part, self._body, start, end):
            return NOTHING
        for outline in self._body.sides:
            met = met.joined(self._take(part, outline, start, end, cut=True))
            if self.side is Side.BORE and not self.drills:
                met = met.joined(_opposite(part, outline, start, end))
        return met if met.depth > _OVERLAP and met.width > _OVERLAP else NOTHING

    def reaches(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Return what edges and body would hit, without removing it, such as the outline of a chuck."""
        start, end = self._fronts(start, end)
        met = NOTHING
        for outlines in (self._cutting, self._body):
            if not self._clear_of(part, outlines, start, end):
                for outline in outlines.sides:
                    met = met.joined(self._take(part, outline, start, end, cut=False))
        return met if met.depth > _OVERLAP and met.width > _OVERLAP else NOTHING

    def thread(self, part: TurnedPart, start: Point, end: Point, lead: float, turns: float) -> Cut:
        """Cut the section of a thread, where the edge is in the section plane once per revolution.

        ``turns`` is the number of revolutions since the pass started in step. If the lead is finer than a
        column, the thread is cut like a cylinder, because no column could show it.
        """
        if lead <= part.columns.step:
            return self.cut(part, start, end)
        count = abs(end[0] - start[0]) / lead
        met, at = NOTHING, np.ceil(turns - _PHASE) - turns
        while at <= count + _PHASE:
            share = min(at / count, 1.0) if count else 0.0
            place = start[0] + (end[0] - start[0]) * share, start[1] + (end[1] - start[1]) * share
            met = met.joined(self.cut(part, place, place))
            at += 1.0
        return met

    def _clear_of(self, part: TurnedPart, outlines: _Outlines, start: Point, end: Point) -> bool:
        """Return whether the outlines remain in front of the part or outside it."""
        columns, low = part.columns, outlines.low
        if min(start[0], end[0]) + low[0] > columns.first + columns.step * columns.number:
            return True
        return self.side is Side.OUTSIDE and min(start[1], end[1]) + low[1] > part.largest

    def _above(self, part: TurnedPart, outlines: _Outlines, start: Point, end: Point) -> bool:
        """Return whether the outlines of an outside tool remain outside all columns that they pass."""
        if self.side is not Side.OUTSIDE or not outlines.sides:
            return False
        z = min(start[0], end[0]) + outlines.low[0], max(start[0], end[0]) + outlines.front
        return min(start[1], end[1]) + outlines.low[1] > part.highest(*z)

    def _front(self, place: Point) -> Point:
        return place[0], place[1] * self.across

    def _fronts(self, start: Point, end: Point) -> tuple[Point, Point]:
        """Return both ends of a move on the side of the axis where the outlines are.

        A round tool works on both sides.
        """
        if self.drills:
            side = math.copysign(1.0, start[1] + end[1])
            return (start[0], start[1] * side), (end[0], end[1] * side)
        return self._front(start), self._front(end)

    def _swept(self, part: TurnedPart, start: Point, end: Point, *, cut: bool) -> Cut:
        met = NOTHING
        start, end = self._fronts(start, end)
        if not cut and self._above(part, self._cutting, start, end):
            return NOTHING
        for outline in self._cutting.sides:
            met = met.joined(self._take(part, outline, start, end, cut=cut))
        return met

    def _take(self, part: TurnedPart, outline: _Sides, start: Point, end: Point, *, cut: bool) -> Cut:
        if self.side is Side.OUTSIDE:
            return part.outwards(*sweep(outline.near, start, end, part.columns, part.largest), cut=cut)
        first, far = sweep(outline.far, _mirrored(start), _mirrored(end), part.columns)
        if self.side is Side.BORE and not self.drills:
            return part.inwards(first, -far, cut=cut)
        _, near = sweep(outline.near, start, end, part.columns)
        return part.between(first, near, -far, cut=cut)


def _opposite(part: TurnedPart, outline: _Sides, start: Point, end: Point) -> Cut:
    """Return the opposite wall of a bore that a bar of too large diameter would hit."""
    first, near = sweep(outline.near, start, end, part.columns)
    return part.inwards(first, -near)


def _sides(outline: FloatArray) -> _Sides:
    return _Sides(towards_axis(outline), towards_axis(outline * np.array([1.0, -1.0])))


def _mirrored(point: Point) -> Point:
    return point[0], -point[1]


class SolidTool(NamedTuple):
    """The parts of a tool that must not hit material.

    ``low`` and ``high`` are the extent about the control point, and ``sides`` are the outlines on either side
    of the axis.
    """

    low: FloatArray
    high: FloatArray
    sides: tuple[Cutter, Cutter]

    def met(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Return the material on the straight path of the control point (Z, r in mm), without removing it."""
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
    """A tool with its position on the plate, Z and r."""

    at: Point
    solid: SolidTool


class Neighbours:
    """The tools on the plate that have a shape and an offset.

    ``offsets`` are the machine Z and X in mm at which each tip is at part zero. Two tools with the same
    offset cannot both be mounted. Such pairs are in ``in_one_place``, and neither tool counts as a neighbor
    of the other. Holders without a specified size are left out.
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
        """Return the first other tool that hits material while ``tool`` moves along the path, or 0."""
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
    """Return a tool that consists of these convex outlines (k, 2) of Z and r in mm."""
    points = np.vstack(outlines)
    sides = Cutter((), outlines, Side.FACE), Cutter((), outlines, Side.FACE, rear=True)
    return SolidTool(points.min(axis=0), points.max(axis=0), sides)


def _neighbour(shape: ToolShape, at: Point) -> _Neighbour:
    lines = outline_of(shape)
    assumed = _ASSUMED_BODY.intersection(lines.assumed)
    return _Neighbour(at, solid_tool(lines.cutting if assumed else (*lines.cutting, *lines.body)))


def _same(one: Point, other: Point) -> bool:
    return dist(one, other) < _ONE_PLACE


def _moved(place: Point, by: Point) -> Point:
    return place[0] + by[0], place[1] + by[1]
