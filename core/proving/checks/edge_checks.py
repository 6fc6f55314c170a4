"""Checks of a cutting edge: its cutting side, its position along the part, and the spindle direction."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from core.interpreter.shared.elementary_blocks import BlockKind
from core.message import Message
from core.part.cutter import CutSide, Cutter
from core.part.stock import Stock
from core.part.swept_edge import Point
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from core.part.turned_part import NO_CUT, Cut, TurnedPart
from core.proving.checks.cut_checks import INSERT_TOOLS, check_cut_size, has_round_insert
from core.proving.checks.thread_checks import Found
from core.proving.tip_moves import TipMove
from core.tool_edges import format_edge_name

_WRONG_SIDE = 0.5  # mm that the back of an insert may cut
_TRAILING_CUT_MM = 0.05  # mm of material cut after the nose
_FACED = 2.54  # mm that is usually faced in one cut toward the axis
_STEEPER = 2.0  # degrees
_OVER_AXIS = 1.5  # mm beyond the axis that a face or a part-off needs at most
_TURNED_AWAY = 0.1  # mm beyond the axis for a cut along Z that leaves nothing
_FACE_DEPTH_MM = 0.5  # mm
_PASSED_DISTANCE_MM = 12.7  # mm
_BEYOND_CUT = 0.2  # mm
_ENTERS = 1.0  # mm; a shorter cut is a chamfer or a face
_BREAKS_THROUGH = 2.54  # mm that a tool may go beyond the stock
_OFF_AXIS = 0.1  # mm; less is a correction by a work shift
_LOOP = 200.0  # degrees; an insert with a corner can cut an arc of less than 180
_QUARTER = (80.0, 100.0)  # degrees
_EDGE = 3.0  # mm, largest radius of a rounded edge
_AT_FACE = 0.05  # mm
_NEAR_TOLERANCE = 1e-6
_DRILLS = frozenset({ToolKind.DRILL, ToolKind.CENTER_DRILL, ToolKind.REAMER, ToolKind.TAP})


@dataclass(slots=True)
class EdgeChecks:
    """Checks of cutting edges, to be called in program order after each move has been cut."""

    stock: Stock | None = None
    is_stock_specified: bool = False  # the stock is specified instead of assumed
    part_off_z_mm: float | None = None  # Z of the deepest part-off on the side of the chuck
    _turned: dict[int, float] = field(default_factory=dict)  # T → direction in which its edge has cut
    _told: set[int] = field(default_factory=set)
    _solid: float = 0.0  # mm of solid material along Z that the present move enters

    def record_solid_length(self, move: TipMove, shape: ToolShape | None, part: TurnedPart) -> None:
        """Record the length along Z over which the part has no bore before a boring tool feeds."""
        self._solid = 0.0
        if shape is None or not shape.internal or move.is_fast:
            return
        z = [z for z, _ in move.points]
        there = slice(part.columns.find_column(min(z)), part.columns.find_column(max(z)))
        solid = np.all(part.inner_radii[:, there] <= 0.0, axis=0) & np.any(
            part.outer_radii[:, there] > 0.0, axis=0
        )
        self._solid = part.columns.step_mm * float(np.count_nonzero(solid))

    def check_feed_move(
        self,
        move: TipMove,
        cuts: Sequence[Cut],
        cut: Cut,
        shape: ToolShape | None,
        cutter: Cutter,
        part: TurnedPart,
        tool: int,
    ) -> Iterator[Found]:
        """Yield the faults of a feed move after its cut has been removed from the part.

        ``cuts`` are the cuts of the straight sections of the move, and ``cut`` is their total.
        """
        if shape is None or not cut:
            return
        if (
            cutter.has_holder
            and shape.kind in INSERT_TOOLS
            and _arc_turn_angle(move) > _LOOP
            and not has_round_insert(shape)
        ):
            around = f"{_arc_turn_angle(move):.0f}°"
            yield Found(
                "arc-loop",
                Message(
                    "{tool} feeds through the part along an arc of {around}.",
                    tool=format_edge_name(tool),
                    around=around,
                ),
            )
            return
        yield from _check_edge_hollow(move, shape, cutter, part, tool)
        yield from check_cut_size(move, cut, shape, cutter, tool, is_stock_specified=self.is_stock_specified)
        yield from self._check_spindle_direction(move, shape, cutter, tool)
        if shape.kind in _DRILLS:
            yield from _check_axis_position(move, tool)
            yield from _check_speed_limit(move, tool)
        if self._solid > _ENTERS and cut.width_mm > _ENTERS:
            words = Message(
                "{tool} feeds {solid} along Z into solid material.",
                tool=format_edge_name(tool),
                solid=move.modal.format_length(self._solid),
            )
            yield Found("no-bore", words)
        yield from self._check_past_stock(move, shape, tool)
        yield from self._check_axis_crossing(move, cut, cutter, tool)
        yield from self._past_part_off(move, shape, cutter, tool)
        yield from self._check_contour_past_part_off(move, shape, tool)
        if shape.is_rotating and shape.length:
            yield from self._drilled(move, shape, tool)
        # otherwise the insert is assumed
        if cutter.has_holder and shape.kind in INSERT_TOOLS and move.block_kind is not BlockKind.THREAD:
            yield from _check_cutting_side(move, cuts, shape, cutter, part, tool)

    def _check_spindle_direction(
        self, move: TipMove, shape: ToolShape, cutter: Cutter, tool: int
    ) -> Iterator[Found]:
        """Check M03 and M04 against the hand of a drill.

        Also check that each edge cuts in one spindle direction only.
        """
        if not move.rpm:
            return
        if shape.kind in _DRILLS:
            needed = {ToolHand.RIGHT: 1.0, ToolHand.LEFT: -1.0}.get(shape.hand, 0.0)
            if move.rpm * needed < 0.0:
                yield Found("wrong-spindle-direction", _turns_wrongly(move, shape, tool))
            return
        if shape.is_rotating:
            return
        if cutter.has_holder and _is_against_rake(shape, move.rpm) and tool not in self._told:
            self._told.add(tool)
            yield Found("wrong-spindle-direction", _turns_wrongly(move, shape, tool))
            return
        radii = [r for _, r in move.points]
        if min(radii) < _NEAR_TOLERANCE and max(radii) > -_NEAR_TOLERANCE:
            return  # the move crosses the axis
        direction = math.copysign(1.0, move.rpm) * math.copysign(1.0, radii[0])
        if self._turned.setdefault(tool, direction) != direction and tool not in self._told:
            self._told.add(tool)
            words = Message(
                "{tool} cuts with the spindle turning in the opposite direction to its earlier cuts.",
                tool=format_edge_name(tool),
            )
            yield Found("wrong-spindle-direction", words)

    def _check_axis_crossing(self, move: TipMove, cut: Cut, cutter: Cutter, tool: int) -> Iterator[Found]:
        """Check that an outside tool does not feed through the axis or cut on its other side."""
        face = (self.stock.front_z_mm if self.stock is not None else 0.0) - _FACE_DEPTH_MM
        beyond = max((-r * cutter.x_sign for z, r in move.points[1:] if z < face), default=0.0)
        if beyond <= _TURNED_AWAY:
            return
        turns = max(r * cutter.x_sign for _, r in move.points) < 0.0 and cut.width_mm > _ENTERS
        if cutter.side is CutSide.OUTSIDE and beyond > (_TURNED_AWAY if turns else _OVER_AXIS):
            deep = move.modal.format_length(beyond)
            yield Found(
                "over-axis",
                Message(
                    "{tool} cuts {depth} past the spindle centerline, on the side opposite to "
                    "where the tool is mounted.",
                    tool=format_edge_name(tool),
                    depth=deep,
                ),
            )

    def _past_part_off(self, move: TipMove, shape: ToolShape, cutter: Cutter, tool: int) -> Iterator[Found]:
        if self.part_off_z_mm is None or cutter.is_drill or shape.kind is ToolKind.PARTING:
            return
        z = min(z for z, _ in move.points)
        long = (self.stock.front_z_mm if self.stock is not None else 0.0) - self.part_off_z_mm
        if z < self.part_off_z_mm - max(_PASSED_DISTANCE_MM, long):
            text = move.modal.format_length
            yield Found(
                "past-part-off",
                Message(
                    "{tool} cuts at Z {z}, but the part ends at Z {parted_at}.",
                    tool=format_edge_name(tool),
                    z=text(z),
                    parted_at=text(self.part_off_z_mm),
                ),
            )

    def _check_contour_past_part_off(self, move: TipMove, shape: ToolShape, tool: int) -> Iterator[Found]:
        """Check for an arc between the deepest part-off and the chuck, past the finished part."""
        if (
            self.part_off_z_mm is None
            or move.block_kind is not BlockKind.ARC
            or shape.kind not in INSERT_TOOLS
        ):
            return
        front = max(z for z, _ in move.points)
        if front < self.part_off_z_mm - _BEYOND_CUT:
            text = move.modal.format_length
            words = Message(
                "{tool} cuts an arc at Z {front}, but the part ends at Z {parted_at}.",
                tool=format_edge_name(tool),
                front=text(front),
                parted_at=text(self.part_off_z_mm),
            )
            yield Found("contour-past-part-off", words)

    def _check_past_stock(self, move: TipMove, shape: ToolShape, tool: int) -> Iterator[Found]:
        """Check that a feed does not pass the far end of the stock.

        Only the point of a drill may pass it.
        """
        if self.stock is None or not self.is_stock_specified:
            return
        z, allowed = min(z for z, _ in move.points), _BREAKS_THROUGH
        if shape.is_rotating:
            allowed += shape.diameter
        if z < self.stock.back_z_mm - allowed:
            text = move.modal.format_length
            words = Message(
                "{tool} feeds to Z {z}, but the stock ends at Z {back}.",
                tool=format_edge_name(tool),
                z=text(z),
                back=text(self.stock.back_z_mm),
            )
            yield Found("past-stock", words)

    def _drilled(self, move: TipMove, shape: ToolShape, tool: int) -> Iterator[Found]:
        deep = calculate_depth_from_face(move, self.stock)
        if deep > shape.length:
            text = move.modal.format_length
            yield Found(
                "drill-too-deep",
                Message(
                    "{tool} goes {depth} deep, but its cutting length is only {length}.",
                    tool=format_edge_name(tool),
                    depth=text(deep),
                    length=text(shape.length),
                ),
            )


def _turns_wrongly(move: TipMove, shape: ToolShape, tool: int) -> str:
    if move.rpm < 0.0:
        return Message(
            "{tool}, a {hand}-hand tool, cuts while the spindle turns in reverse.",
            tool=format_edge_name(tool),
            hand=shape.hand,
        )
    return Message(
        "{tool}, a {hand}-hand tool, cuts while the spindle turns forward.",
        tool=format_edge_name(tool),
        hand=shape.hand,
    )


def _is_against_rake(shape: ToolShape, rpm: float) -> bool:
    """Return whether the spindle turns in the wrong direction for a front tool that is mounted face up.

    A tool that is mounted upside down, and therefore cuts along Z opposite to its hand, is not checked.
    """
    upright = {ToolHand.RIGHT: -1, ToolHand.LEFT: 1}.get(shape.hand) == shape.direction[0]
    return shape.kind in INSERT_TOOLS and upright and not shape.is_rear_tool and rpm < 0.0


def _check_axis_position(move: TipMove, tool: int) -> Iterator[Found]:
    """Check that a drill or other non-rotating round tool is on the spindle axis when it cuts."""
    off = min(abs(r) for _, r in move.points)
    if move.rpm and off > _OFF_AXIS:
        words = Message(
            "{tool} is {off} off the spindle centerline when it cuts.",
            tool=format_edge_name(tool),
            off=move.modal.format_length(off),
        )
        yield Found("drill-off-axis", words)


def _check_speed_limit(move: TipMove, tool: int) -> Iterator[Found]:
    """Check that a round tool on the axis does not cut at constant surface speed without an rpm limit."""
    off = min(abs(r) for _, r in move.points)
    if move.modal.css and move.modal.max_css_rpm is None and off < _OFF_AXIS:
        words = Message(
            "{tool} cuts on the spindle centerline under G96, so the spindle runs at its maximum speed.",
            tool=format_edge_name(tool),
        )
        yield Found("drill-without-limit", words)


def _arc_turn_angle(move: TipMove) -> float:
    """Return the angle in degrees through which the path of an arc turns, or 0 for any other move."""
    if move.block_kind is not BlockKind.ARC or len(move.points) < 3:
        return 0.0
    headings = np.unwrap(np.arctan2(*np.diff(np.array(move.points), axis=0).T[::-1]))
    chords = len(headings)
    return math.degrees(abs(float(headings[-1] - headings[0]))) * chords / (chords - 1)


def _check_edge_hollow(
    move: TipMove, shape: ToolShape, cutter: Cutter, part: TurnedPart, tool: int
) -> Iterator[Found]:
    """Check for a concave quarter arc at the face where a convex edge rounding is more likely.

    Such an arc is small and starts along Z.
    """
    if not (cutter.has_holder and shape.kind is ToolKind.TURNING and cutter.side is CutSide.OUTSIDE):
        return
    if not _QUARTER[0] < _arc_turn_angle(move) < _QUARTER[1] or shape.direction[0] >= 0:
        return
    points = np.array(move.points) * [1.0, cutter.x_sign]
    (z_in, r_in), (z_out, r_out) = np.diff(points, axis=0)[[0, -1]]
    radius = math.dist(points[0], points[-1]) / math.sqrt(2.0)
    faces = np.flatnonzero(part.max_radii > 0.0)
    front = part.columns.first_z_mm + part.columns.step_mm * float(faces[-1]) if len(faces) else -math.inf
    along, away = -z_in > 5.0 * abs(r_in), r_out > 5.0 * abs(z_out)
    if along and away and radius < _EDGE and abs(points[0][0] - front) < _AT_FACE:
        words = Message(
            "{tool} cuts a concave arc of radius {radius} into the edge of the face.",
            tool=format_edge_name(tool),
            radius=move.modal.format_length(radius),
        )
        yield Found("hollow-at-edge", words)


def calculate_depth_from_face(move: TipMove, stock: Stock | None) -> float:
    """Return the depth in mm of the end of a move, measured from the face of the stock."""
    return (stock.front_z_mm if stock is not None else 0.0) - min(z for z, _ in move.points)


def _check_cutting_side(
    move: TipMove, cuts: Sequence[Cut], shape: ToolShape, cutter: Cutter, part: TurnedPart, tool: int
) -> Iterator[Found]:
    """Check for cuts with the back of an insert.

    Such cuts are deep feeds opposite to the cutting direction, and feeds along walls that are too steep for
    the insert. ``cuts`` are the cuts of the straight pieces of the move.
    """
    forward, across = shape.direction
    if not forward or not across:
        return
    text = move.modal.format_length
    deep = max(
        (met.depth_mm for (start, end), met in zip(pairwise(move.points), cuts, strict=True)
         if _goes_back(start, end, forward)),
        default=0.0,
    )  # fmt: skip
    if deep > max(_WRONG_SIDE, 2.0 * shape.nose_radius):
        yield Found(
            "wrong-side",
            Message(
                "{tool} cuts {depth} deep with the trailing edge of its insert.",
                tool=format_edge_name(tool),
                depth=text(deep),
            ),
        )
        return
    clears = cutter.find_trailing_edge_angle(forward)
    for start, end, met, steep in _iter_steep_runs(move.points, cuts, shape, clears + _STEEPER):
        trailing_mm = met.front_z_mm - start[0] if forward < 0 else start[0] - met.back_z_mm
        faces = trailing_mm <= _FACED and not _leaves_wall(part, met, forward, abs(end[1]), cutter.side)
        if (
            trailing_mm > 2.0 * shape.nose_radius + _TRAILING_CUT_MM
            and met.depth_mm > _TRAILING_CUT_MM
            and not faces
        ):
            words = Message(
                "{tool} cuts into the part at {steep}°, but the trailing edge of its insert clears "
                "only {clears}°.",
                tool=format_edge_name(tool),
                steep=f"{steep:.0f}",
                clears=f"{clears:.0f}",
            )
            yield Found("wrong-side", words)
            return


def _leaves_wall(part: TurnedPart, cut: Cut, forward: int, r: float, side: CutSide) -> bool:
    """Return whether material remains next to the cut, on the back side of the insert.

    The back of the insert has hit this material.
    """
    step = part.columns.step_mm
    edge = cut.front_z_mm + step if forward < 0 else cut.back_z_mm - step
    at = part.columns.find_column(edge)
    if not 0 <= at < part.columns.column_count:
        return False
    low, high = part.inner_radii[:, at], part.outer_radii[:, at]
    above = low < r if side is CutSide.BORE else high > r
    return bool(np.any((high > low + _NEAR_TOLERANCE) & above))


def _goes_back(start: Point, end: Point, forward: int) -> bool:
    along = (end[0] - start[0]) * forward
    return along < -_NEAR_TOLERANCE and abs(end[1] - start[1]) < -along * 0.05


def _iter_steep_runs(
    points: Sequence[Point], cuts: Sequence[Cut], shape: ToolShape, steepest: float
) -> Iterator[tuple[Point, Point, Cut, float]]:
    """Yield the parts of a move that enter the material at an angle of more than ``steepest`` degrees.

    Each item is the start, the end, the cut and the greatest angle.
    """
    forward, across = shape.direction
    start, end, met, angle = points[0], points[0], NO_CUT, 0.0
    for (a, b), cut in zip(pairwise(points), cuts, strict=True):
        along, inwards = (b[0] - a[0]) * forward, (b[1] - a[1]) * across
        steep = (
            math.degrees(math.atan2(inwards, along)) if inwards > _NEAR_TOLERANCE and along >= 0.0 else 0.0
        )
        if steep > steepest:
            start, end = start if angle else a, b
            met, angle = met.combine_with_later(cut), max(angle, steep)
        elif angle:
            yield start, end, met, angle
            met, angle = NO_CUT, 0.0
    if angle:
        yield start, end, met, angle
