"""Simulation of a tool that cuts a turned part: material removal, and collisions of the tool.

An outside tool removes all material at a greater radius than its edge, because such material becomes a chip
or would hit the holder. A boring tool removes all material closer to the axis. A face tool removes only the
material that its outline covers.
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

from core.part.swept_edge import AxisFacingEdge, FloatArray, Point, find_axis_facing_edge, sweep_edge
from core.part.tool_outline import make_tool_outline as outline_of
from core.part.tool_shape import ToolShape
from core.part.turned_part import NO_CUT, Cut, TurnedPart

_OVERLAP_TOLERANCE_MM = 0.02  # mm; a body that enters the material by less only touches it
_PHASE = 1e-6  # turns
_SAME_PLACE_MM = 1.0  # =
_ASSUMED_BODY = frozenset({"holder", "stick_out", "length"})


class CutSide(StrEnum):
    """The side from which a tool machines the part."""

    OUTSIDE = "outside"
    BORE = "bore"
    FACE = "face"


@dataclass(frozen=True, slots=True)
class _OutlineSides:
    """The two sides of one convex outline.

    ``near_edge`` faces the axis. ``far_edge`` is the side away from the axis, mirrored. ``z_range`` and
    ``min_radius`` are the bounds of ``near_edge``, in mm.
    """

    near_edge: AxisFacingEdge
    far_edge: AxisFacingEdge
    z_range: tuple[float, float]
    min_radius: float


class _OutlineSet(NamedTuple):
    """Convex outlines with their common limits: the smallest Z and r, and the largest Z.

    If the set is empty, the limits are infinite.
    """

    sides: list[_OutlineSides]
    min_point: Point
    front_z: float

    @classmethod
    def from_outlines(cls, outlines: Iterable[FloatArray]) -> _OutlineSet:
        sides = [_sides(outline) for outline in outlines]
        z = min((each.z_range[0] for each in sides), default=math.inf)
        r = min((each.min_radius for each in sides), default=math.inf)
        return cls(sides, (z, r), max((each.z_range[1] for each in sides), default=-math.inf))


class Cutter:
    """Tool prepared for sweeping, given by convex outlines (k, 2) of Z and r about the control point.

    ``is_drill`` means that the tool is rotationally symmetrical about the spindle axis. ``is_rear`` means
    that the tool works at negative X, where its outlines are given. ``edge_height_mm`` is the extent of its
    cutting edges along r, in mm.
    """

    def __init__(
        self,
        cutting_outlines: Iterable[FloatArray],
        body_outlines: Iterable[FloatArray],
        side: CutSide,
        *,
        is_rear: bool = False,
        is_drill: bool = False,
    ) -> None:
        self.side, self.is_drill = side, is_drill
        self.x_sign = -1.0 if is_rear else 1.0  # sign of X on the working side
        turned = np.array([1.0, self.x_sign])
        outlines = tuple(cutting_outlines)
        self._cutting = _OutlineSet.from_outlines(outline * turned for outline in outlines)
        self._body = _OutlineSet.from_outlines(outline * turned for outline in body_outlines)
        self.edge_height_mm = max((float(np.ptp(outline[:, 1])) for outline in outlines), default=0.0)
        self._clears: dict[int, float] = {}

    @property
    def has_holder(self) -> bool:
        """Return whether the holder of the tool is known."""
        return bool(self._body.sides)

    def find_trailing_edge_angle(self, cutting_direction: int) -> float:
        """Return the angle in degrees between the trailing edge and Z, measured at the tip.

        ``cutting_direction`` is the sign of the Z motion while cutting. The result is 90 if the tool has no
        trailing edge that rises from the tip.
        """
        if cutting_direction not in self._clears:
            self._clears[cutting_direction] = self._clearance(cutting_direction)
        return self._clears[cutting_direction]

    def _clearance(self, forward: int) -> float:
        outline = self._cutting.sides[0]
        edge = outline.far_edge if self.side is CutSide.BORE else outline.near_edge
        rises = -forward * edge.slopes
        lengths = np.where(rises > 0.0, np.hypot(np.diff(edge.z), np.diff(edge.r)), 0.0)
        sides = rises[lengths > 0.5 * lengths.max(initial=0.0)]  # without the chords of the nose
        return float(np.degrees(np.arctan(sides.min()))) if len(sides) else 90.0

    def cut_material(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Remove the material that the edges sweep on a straight move, and return the cut.

        ``start`` and ``end`` are positions of the control point.
        """
        return self._swept(part, start, end, cut=True)

    def find_cut(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Return the cut that the edges would make, without removing material."""
        return self._swept(part, start, end, cut=False)

    def touches_material(self, part: TurnedPart, start: Point, end: Point) -> bool:
        """Return whether the edges would cut material on a straight move.

        For a move along r, the column at the tool nose is checked first, because it usually decides.
        """
        if self.side is CutSide.OUTSIDE and start[0] == end[0]:
            one, other = self._ends_on_working_side(start, end)
            place = start[0], min(one[1], other[1])
            if any(part.is_cut_at_nose(outline.near_edge, place) for outline in self._cutting.sides):
                return True
        return bool(self.find_cut(part, start, end))

    def cut_with_body(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Remove the material that the holder and the shank hit, and return the cut.

        Because the material is removed, each collision is reported only once.
        """
        met = NO_CUT
        start, end = self._ends_on_working_side(start, end)
        if self._is_clear(part, self._body, start, end) or self._is_outside_columns(
            part, self._body, start, end
        ):
            return NO_CUT
        for outline in self._body.sides:
            met = met.combine_with(self._take(part, outline, start, end, cut=True))
            if self.side is CutSide.BORE and not self.is_drill:
                met = met.combine_with(_find_opposite_wall(part, outline, start, end))
        return (
            met if met.depth_mm > _OVERLAP_TOLERANCE_MM and met.width_mm > _OVERLAP_TOLERANCE_MM else NO_CUT
        )

    def find_collision(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Return the material that the edges and the body would hit, without removing it.

        ``part`` may also be the outline of an obstacle, such as a chuck.
        """
        start, end = self._ends_on_working_side(start, end)
        met = NO_CUT
        for outlines in (self._cutting, self._body):
            if not self._is_clear(part, outlines, start, end):
                for outline in outlines.sides:
                    met = met.combine_with(self._take(part, outline, start, end, cut=False))
        return (
            met if met.depth_mm > _OVERLAP_TOLERANCE_MM and met.width_mm > _OVERLAP_TOLERANCE_MM else NO_CUT
        )

    def cut_thread(
        self, part: TurnedPart, start: Point, end: Point, lead_mm: float, revolutions: float
    ) -> Cut:
        """Cut a screw thread in the section plane, where the edge passes once per revolution.

        ``revolutions`` is the number of revolutions since the synchronized pass started. If the lead is
        shorter than a column of the part, the columns cannot show the thread. The thread is then cut like a
        cylinder.
        """
        if lead_mm <= part.columns.step_mm:
            return self.cut_material(part, start, end)
        count = abs(end[0] - start[0]) / lead_mm
        met, at = NO_CUT, math.ceil(revolutions - _PHASE) - revolutions
        while at <= count + _PHASE:
            share = min(at / count, 1.0) if count else 0.0
            place = start[0] + (end[0] - start[0]) * share, start[1] + (end[1] - start[1]) * share
            met = met.combine_with(self.cut_material(part, place, place))
            at += 1.0
        return met

    def _is_clear(self, part: TurnedPart, outlines: _OutlineSet, start: Point, end: Point) -> bool:
        """Return whether the outlines stay in front of the part's face or outside its diameter."""
        columns, low = part.columns, outlines.min_point
        if min(start[0], end[0]) + low[0] > columns.first_z_mm + columns.step_mm * columns.column_count:
            return True
        return self.side is CutSide.OUTSIDE and min(start[1], end[1]) + low[1] > part.max_stock_radius_mm

    def _is_outside_columns(self, part: TurnedPart, outlines: _OutlineSet, start: Point, end: Point) -> bool:
        """Return whether the outlines of an outside tool remain outside all columns that they pass."""
        if self.side is not CutSide.OUTSIDE or not outlines.sides:
            return False
        z = min(start[0], end[0]) + outlines.min_point[0], max(start[0], end[0]) + outlines.front_z
        return min(start[1], end[1]) + outlines.min_point[1] > part.find_max_radius(*z)

    def _front(self, place: Point) -> Point:
        return place[0], place[1] * self.x_sign

    def _ends_on_working_side(self, start: Point, end: Point) -> tuple[Point, Point]:
        """Return the ends of a move, mirrored to the side of the axis with the outlines.

        A round tool works on both sides.
        """
        if self.is_drill:
            side = math.copysign(1.0, start[1] + end[1])
            return (start[0], start[1] * side), (end[0], end[1] * side)
        return self._front(start), self._front(end)

    def _swept(self, part: TurnedPart, start: Point, end: Point, *, cut: bool) -> Cut:
        met = NO_CUT
        start, end = self._ends_on_working_side(start, end)
        if self._is_clear(part, self._cutting, start, end):
            return NO_CUT
        for outline in self._cutting.sides:
            met = met.combine_with(self._take(part, outline, start, end, cut=cut))
        return met

    def _take(self, part: TurnedPart, outline: _OutlineSides, start: Point, end: Point, *, cut: bool) -> Cut:
        if self.side is CutSide.OUTSIDE:
            back, front = outline.z_range
            radius = part.find_max_radius(min(start[0], end[0]) + back, max(start[0], end[0]) + front)
            if min(start[1], end[1]) + outline.min_radius >= radius:
                return NO_CUT
            swept = sweep_edge(outline.near_edge, start, end, part.columns, radius)
            return part.cut_outside(*swept, remove=cut)
        first, far = sweep_edge(outline.far_edge, _mirrored(start), _mirrored(end), part.columns)
        if self.side is CutSide.BORE and not self.is_drill:
            return part.cut_inside(first, -far, remove=cut)
        _, near = sweep_edge(outline.near_edge, start, end, part.columns)
        return part.cut_between(first, near, -far, remove=cut)


def _find_opposite_wall(part: TurnedPart, outline: _OutlineSides, start: Point, end: Point) -> Cut:
    """Return the cut that an oversize boring bar makes at the opposite wall of the bore."""
    first, near = sweep_edge(outline.near_edge, start, end, part.columns)
    return part.cut_inside(first, -near)


def _sides(outline: FloatArray) -> _OutlineSides:
    near, far = find_axis_facing_edge(outline), find_axis_facing_edge(outline * np.array([1.0, -1.0]))
    return _OutlineSides(near, far, (float(near.z[0]), float(near.z[-1])), float(near.r.min()))


def _mirrored(point: Point) -> Point:
    return point[0], -point[1]


class SolidTool(NamedTuple):
    """The parts of a tool that must not hit material.

    ``lower_corner`` and ``upper_corner`` are the corners of the bounding box, relative to the control
    point. ``sides`` are the outlines on either side of the axis.
    """

    lower_corner: FloatArray
    upper_corner: FloatArray
    side_cutters: tuple[Cutter, Cutter]

    def find_collision(self, part: TurnedPart, start: Point, end: Point) -> Cut:
        """Return the material that the tool hits on a straight path, without removing it.

        The path is that of the control point, as Z and r in mm.
        """
        low = self.lower_corner + np.minimum(start, end)
        high = self.upper_corner + np.maximum(start, end)
        columns, radius = part.columns, part.max_stock_radius_mm
        if (
            low[0] > columns.first_z_mm + columns.step_mm * columns.column_count
            or high[0] < columns.first_z_mm
        ):
            return NO_CUT
        if low[1] > radius or high[1] < -radius:
            return NO_CUT
        front, rear = self.side_cutters
        return front.find_collision(part, start, end).combine_with(rear.find_collision(part, start, end))


class _NeighborTool(NamedTuple):
    """A tool with its position on the tool plate in Z and r."""

    plate_position: Point
    solid_tool: SolidTool


class NeighborTools:
    """The tools on the tool plate that have a shape and an offset, for collision checks.

    ``offsets`` are the machine Z and X in mm at which each tip is at part zero. Two tools with the same
    offset cannot both be mounted. Such pairs are in ``coincident_tools``, and are not checked against each
    other. Holders without a specified size are left out.
    """

    def __init__(self, shapes: Mapping[int, ToolShape], offsets: Mapping[int, Point]) -> None:
        self._offsets = offsets
        self._tools = {n: _neighbour(shapes[n], offsets[n]) for n in sorted(shapes.keys() & offsets.keys())}
        self.coincident_tools = tuple(
            (a, b)
            for a, b in combinations(sorted(self._tools), 2)
            if dist(offsets[a], offsets[b]) < _SAME_PLACE_MM
        )

    def find_struck_tool(self, part: TurnedPart, tool: int, path: Iterable[tuple[Point, Point]]) -> int:
        """Return the first other tool number that hits material while ``tool`` moves along ``path``.

        The result is 0 if no other tool hits material.
        """
        if tool not in self._offsets:
            return 0
        own = self._offsets[tool]
        for start, end in path:
            for number, each in self._tools.items():
                shift = own[0] - each.plate_position[0], own[1] - each.plate_position[1]
                if number == tool or dist(own, each.plate_position) < _SAME_PLACE_MM:
                    continue
                if each.solid_tool.find_collision(part, _moved(start, shift), _moved(end, shift)):
                    return number
        return 0


def make_solid_tool(outlines: Sequence[FloatArray]) -> SolidTool:
    """Return a tool that consists of convex outlines (k, 2) of Z and r in mm."""
    points = np.vstack(outlines)
    sides = Cutter((), outlines, CutSide.FACE), Cutter((), outlines, CutSide.FACE, is_rear=True)
    return SolidTool(points.min(axis=0), points.max(axis=0), sides)


def _neighbour(shape: ToolShape, at: Point) -> _NeighborTool:
    lines = outline_of(shape)
    assumed = _ASSUMED_BODY.intersection(lines.assumed_fields)
    return _NeighborTool(
        at,
        make_solid_tool(
            lines.cutting_outlines if assumed else (*lines.cutting_outlines, *lines.body_outlines)
        ),
    )


def _same(one: Point, other: Point) -> bool:
    return dist(one, other) < _SAME_PLACE_MM


def _moved(place: Point, by: Point) -> Point:
    return place[0] + by[0], place[1] + by[1]
