"""Checks of the material that a move removes.

A fault is reported if a move cuts too much for the tool, or nothing where a cut is expected.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

from core.interpreter.shared.elementary_blocks import BlockKind
from core.message import Message
from core.part.cutter import CutSide, Cutter
from core.part.insert_codes import CuttingInsert, InsertCodeError, decode_insert_code, make_insert
from core.part.stock import Stock
from core.part.swept_edge import Point
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Cut, TurnedPart
from core.proving.assumed_tools import GROOVING_TOOLS
from core.proving.checks.thread_checks import Found
from core.proving.tip_moves import TipMove
from core.tool_edges import format_edge_name

NEAR_MATERIAL_MM = 2.0
"""Distance in mm from all stock above which the tool is in the air."""

_AIR_TIME, _AIR_WAY = 5.0, 5.0  # s, mm
_LONG_AIR = 20.0  # s of consecutive moves
_AWAY_DISTANCE_MM = 2.54  # mm, least length of a move away from the part or alongside it
_EXIT_DISTANCE_MM = 5.2  # mm before the face; a feed back along the turned surface ends closer to it
_MIN_FEED_LENGTH_MM = 1.0  # mm of feeds between two rapids
_SIDE_DISTANCE_MM = 5.0  # mm outside the bar
_FACE_DEPTH_MM = 0.5  # mm
_SAMPLE_FRACTIONS = (0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95)
# =
# geometries: Widia, "Selection of insert", the column -LM of its table of effective lengths.
USUAL_DEPTH_FRACTIONS: Mapping[str, float] = {
    "S": 0.5,
    "C": 0.5,
    "W": 0.4,
    "T": 0.3,
    "D": 0.3,
    "V": 0.2,
    "R": 0.3,
}
_OTHER_SHAPE = 0.5
# =
MAX_DEPTH_FRACTIONS: Mapping[str, float] = {
    "S": 2 / 3,
    "C": 2 / 3,
    "W": 0.5,
    "T": 0.5,
    "D": 0.5,
    "V": 0.25,
    "R": 0.4,
}
_BAR_DEPTH_FRACTION = 0.5  # fraction of the diameter of a boring bar
_USUAL = make_insert("C", 12.7, 0.8)  # CNMG432, the largest usual insert of a small lathe
_COARSE_FEED_FRACTION = 0.8  # fraction of the nose radius, the usual limit of a turned surface
_WIDTH_FEED_FRACTION = 0.12  # fraction of the width of a grooving edge; Ingersoll's catalog of 2011 has .075
_DRILL_FEED_FRACTION = 0.04  # fraction of the diameter of a drill, twice the usual .02
_REAMER_FEED_FRACTION = 0.1
_BREAKING_FACTOR = 5.0  # multiple of these limits; suitable feeds of drills and blades vary by this factor
_INSERT_BREAKING_FACTOR = 2.5
_SAFE_FEED_MM = 0.15  # mm of feed that never breaks an insert, even with a sharp nose
_TURNING_WIDTH_FRACTION = 0.8  # fraction of the width for a grooving edge along Z, from the same catalog
_BLADE_FINISH = 0.25  # mm of depth that a parting blade may turn along Z
_DRILLS = frozenset({ToolKind.DRILL, ToolKind.CENTER_DRILL, ToolKind.REAMER})
INSERT_TOOLS = frozenset({ToolKind.TURNING, ToolKind.BORING})


@dataclass(slots=True)
class AirCutChecks:
    """Checks for missing cuts after feeds and after rapids into the part, called in program order.

    Call ``check_feed_move`` or ``check_rapid_move`` after each move has been cut, and ``record_pause``
    between moves.
    """

    stock: Stock | None = None
    _tool: int = 0
    # T → line and block of its first feed, None after a cut
    _milled: dict[int, tuple[int, int] | None] = field(default_factory=dict)
    _cut_before: bool = False  # the previous move has cut or followed material
    _left_part: TipMove | None = None  # a feed that led away from the part without a cut
    _air: float = 0.0  # s in air since the last cut
    _fed: TipMove | None = None  # the first feed since the last rapid if none of the feeds came near material
    _fed_length: float = 0.0
    _has_cut: bool = False  # a feed since the last rapid came near material
    _in_hole: TipMove | None = None  # the first feed of a drill since the last rapid if it has cut nothing
    _fresh: bool = False  # =
    _cut_line: int = 0  # line of the last feed near material, which the rapids of a canned cycle share
    _went_in: TipMove | None = None  # a rapid next to the part after which nothing has been cut

    def record_pause(self) -> None:
        """Record a wait or a switched output, which explains an earlier rapid without a cut."""
        self._went_in = None

    def check_rapid_move(self, move: TipMove, cut: Cut, tool: int) -> Iterator[Found]:
        """Yield a fault if the feeds before this rapid, or earlier rapids into the part, cut nothing."""
        if tool != self._tool:
            self._tool, self._went_in = tool, None
        yield from self._end_of_feeds()
        self._left_part, self._cut_before, self._fresh = None, False, True
        if self.stock is None:
            return
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        if self._went_in is not None and z1 > self.stock.front_z_mm:
            text = "After this rapid alongside the part, the tool retracts without cutting."
            yield Found("unmade-cut", text, self._went_in)
            self._went_in = None
        is_near_part = min(abs(r0), abs(r1)) < self.stock.max_radius_mm + _SIDE_DISTANCE_MM
        if (
            not cut
            and is_near_part
            and move.line != self._cut_line
            and z1 < min(z0, self.stock.front_z_mm) - _AWAY_DISTANCE_MM
        ):
            self._went_in = self._went_in or move

    def check_feed_move(
        self, move: TipMove, cut: Cut, cutter: Cutter, part: TurnedPart, tool: int, cutting_direction: int,
        *, is_drill: bool = False,
    ) -> Iterator[Found]:  # fmt: skip
        """Yield the faults of a feed that cuts no material.

        ``cutting_direction`` is the sign of the Z motion while cutting. ``is_drill`` is True for a drill
        with a known diameter.
        """
        if tool != self._tool:
            yield from self._end_of_feeds()
            self._tool, self._went_in = tool, None
        fresh, self._fresh = self._fresh, False
        if cut and cutting_direction < 0 and self._is_exit_feed(move, cutter, is_after_rapid=fresh):
            yield Found("unmade-cut", "This move feeds backward out of the part, through material.")
        close = bool(cut) or self._comes_near(move, cutter, part)
        if is_drill and fresh and not cut and self._is_inside(move):
            self._in_hole = move
        elif cut:
            self._in_hole = None
        if close:
            self._has_cut, self._went_in, self._cut_line = True, None, move.line
        else:
            self._fed = self._fed or move
            self._fed_length += move.length_mm
        gone, self._left_part = self._left_part, None
        if cut or move.block_kind is BlockKind.THREAD:
            self._air, self._cut_before = 0.0, bool(cut)
            return
        if self._is_outside_stock(move):
            yield Found("larger-than-stock", "This move turns a diameter larger than the stock.")
        yield from self._leads_away(move, gone, cutter, part, fresh=fresh)
        yield from self._in_air(move, cutter, part)
        self._cut_before = close

    def record_milling_feed(
        self, line: int, block_number: int, tool: int, has_cut: Callable[[], bool]
    ) -> None:
        """Record a feed of a live tool. ``has_cut`` is called only if the tool has not cut anything yet."""
        if self._milled.get(tool, (line, block_number)) is None:
            return
        if has_cut():
            self._milled[tool] = None
        else:
            self._milled.setdefault(tool, (line, block_number))

    @property
    def live_feeds_without_cut(self) -> list[tuple[int, int, int]]:
        """Return the line, block number and tool number of each live tool that has cut nothing.

        The line and the block are those of the first feed of the tool.
        """
        return [(*at, tool) for tool, at in self._milled.items() if at is not None]

    def _end_of_feeds(self) -> Iterator[Found]:
        fed, length, has_cut = self._fed, self._fed_length, self._has_cut
        in_hole, self._in_hole = self._in_hole, None
        self._fed, self._fed_length, self._has_cut = None, 0.0, False
        if in_hole is not None and has_cut:
            yield Found("unmade-cut", "A drill feeds into an existing hole.", in_hole)
        if fed is not None and not has_cut and length >= _MIN_FEED_LENGTH_MM:
            text = (
                "Threading moves between two rapids cut only air."
                if fed.block_kind is BlockKind.THREAD
                else "Feed moves between two rapids cut only air."
            )
            yield Found("unmade-cut", text, fed)

    def _comes_near(self, move: TipMove, cutter: Cutter, part: TurnedPart) -> bool:
        middle = move.points[len(move.points) // 2]
        if len(move.points) == 2:
            (z0, r0), (z1, r1) = move.points
            middle = (z0 + z1) / 2.0, (r0 + r1) / 2.0
        return is_near_material(cutter, part, middle, move.points[-1])

    def _leads_away(
        self, move: TipMove, gone: TipMove | None, cutter: Cutter, part: TurnedPart, *, fresh: bool
    ) -> Iterator[Found]:
        if gone is not None and not is_near_material(cutter, part, *move.points):
            text = "This move and the next move feed away from the part and cut nothing."
            yield Found("unmade-cut", text, gone)
        elif move.length_mm >= _AWAY_DISTANCE_MM and not is_near_material(cutter, part, move.points[-1]):
            if self._is_exit_feed(move, cutter, is_after_rapid=fresh):
                text = "This move feeds along Z out of the part and past its face, inside the stock diameter."
                yield Found("unmade-cut", text)
            # after a cut the move is a retract
            elif is_near_material(cutter, part, move.points[0]) and not self._cut_before:
                self._left_part = move

    def _is_inside(self, move: TipMove) -> bool:
        return self.stock is not None and move.points[-1][0] < self.stock.front_z_mm - NEAR_MATERIAL_MM

    def _is_exit_feed(self, move: TipMove, cutter: Cutter, *, is_after_rapid: bool) -> bool:
        """Return whether a tool feeds along a turned surface toward Z+ and out of the part.

        Such a feed is typically caused by a missing minus sign. A boring tool is checked only if it starts
        at the face, because it normally feeds out of its bore.
        """
        if self.stock is None or cutter.is_drill:
            return False
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        front = self.stock.front_z_mm
        inside = max(abs(r0), abs(r1)) < self.stock.max_radius_mm - NEAR_MATERIAL_MM / 10.0
        begins = is_after_rapid or z0 < front + NEAR_MATERIAL_MM
        if cutter.side is CutSide.BORE:
            begins = begins and z0 > front - _FACE_DEPTH_MM
        return inside and begins and z1 > max(front + _EXIT_DISTANCE_MM, z0 + _AWAY_DISTANCE_MM)

    def _in_air(self, move: TipMove, cutter: Cutter, part: TurnedPart) -> Iterator[Found]:
        if move.length_mm < _AWAY_DISTANCE_MM or is_near_material(cutter, part, move.points[-1]):
            return
        share = _air_fraction(cutter, part, move)
        before, self._air = self._air, self._air + move.duration_s * share
        if move.duration_s * share >= _AIR_TIME and move.length_mm * share >= _AIR_WAY:
            text = Message(
                "This move feeds through air for {seconds} s.", seconds=f"{move.duration_s * share:.0f}"
            )
            yield Found("cuts-air", text)
        elif before < _LONG_AIR <= self._air:
            yield Found(
                "cuts-air",
                Message(
                    "Tools have fed through air for {long_air} s up to this move.",
                    long_air=f"{_LONG_AIR:.0f}",
                ),
            )

    def _is_outside_stock(self, move: TipMove) -> bool:
        """Return whether a move cuts along Z near the stock but completely outside it."""
        stock, zs = self.stock, [z for z, _ in move.points]
        if (
            stock is None
            or max(zs) - min(zs) < _AWAY_DISTANCE_MM
            or min(zs) > stock.front_z_mm - _AWAY_DISTANCE_MM
        ):
            return False
        if zs[-1] > max(zs[0], stock.front_z_mm):
            return False  # a retract
        return min(abs(r) for _, r in move.points) > stock.max_radius_mm + NEAR_MATERIAL_MM


def is_near_material(cutter: Cutter, part: TurnedPart, *places: Point) -> bool:
    """Return whether the cutting edge is near material at any of the given positions."""
    around = (
        (0.0, -NEAR_MATERIAL_MM),
        (0.0, NEAR_MATERIAL_MM),
        (-NEAR_MATERIAL_MM, 0.0),
        (NEAR_MATERIAL_MM, 0.0),
    )
    return any(cutter.touches_material(part, p, (p[0] + dz, p[1] + dr)) for p in places for dz, dr in around)


def _air_fraction(cutter: Cutter, part: TurnedPart, move: TipMove) -> float:
    """Return the fraction of a move that is far from all material, sampled along the move."""
    places = [
        (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share)
        for a, b in pairwise(move.points)
        for share in (_SAMPLE_FRACTIONS if len(move.points) == 2 else (0.5,))
    ]
    return sum(not is_near_material(cutter, part, place) for place in places) / len(places)


def check_cut_size(
    move: TipMove, cut: Cut, shape: ToolShape, cutter: Cutter, tool: int, *, is_stock_specified: bool
) -> Iterator[Found]:
    """Yield the faults of a feed if ``cut`` is too large for the tool."""
    yield from _check_feed_rate(move, shape, tool, has_holder=cutter.has_holder)
    if move.block_kind is BlockKind.THREAD:
        return
    if shape.kind in GROOVING_TOOLS:
        yield from _check_blade_turning(move, cut, shape, tool, is_face=cutter.side is CutSide.FACE)
    elif shape.kind in INSERT_TOOLS:
        yield from _check_depth(move, cut, shape, cutter, tool, is_stock_specified=is_stock_specified)


def _check_feed_rate(move: TipMove, shape: ToolShape, tool: int, *, has_holder: bool) -> Iterator[Found]:
    """Check the feed per revolution against the nose radius, the groove width or the drill diameter.

    Yields a fault if the feed exceeds the usual maximum.
    """
    feed = move.feed_per_rev_mm or (move.speed_mm_s * 60.0 / abs(move.rpm) if move.rpm else 0.0)
    if not feed or move.block_kind is BlockKind.THREAD or shape.kind is ToolKind.TAP:
        return
    limit, breaks, least = _feed_limit(shape, has_holder=has_holder)
    if not feed > limit > 0.0:
        return
    words = _feed_message(move, shape, tool, feed)
    if feed > max(breaks * limit, least):
        yield Found("feed-breaks-tool", words)
    else:
        yield Found("chip-load", words)


def _feed_limit(shape: ToolShape, *, has_holder: bool) -> tuple[float, float, float]:
    """Return the usual maximum feed, the multiple of it at which the tool breaks, and a safe feed.

    Feeds are in mm/rev. If the maximum feed is 0, the feed is not limited.
    """
    if shape.kind in _DRILLS and has_holder:
        share = _REAMER_FEED_FRACTION if shape.kind is ToolKind.REAMER else _DRILL_FEED_FRACTION
        return share * shape.diameter, _BREAKING_FACTOR, 0.0
    if shape.kind in GROOVING_TOOLS and has_holder:
        return _WIDTH_FEED_FRACTION * shape.width, _BREAKING_FACTOR, 0.0
    if shape.kind in INSERT_TOOLS:
        return _COARSE_FEED_FRACTION * shape.nose_radius, _INSERT_BREAKING_FACTOR, _SAFE_FEED_MM
    return 0.0, _BREAKING_FACTOR, 0.0


def _feed_message(move: TipMove, shape: ToolShape, tool: int, feed: float) -> Message:
    """Return the message for a feed that exceeds the limit of ``_feed_limit``."""
    name, text = format_edge_name(tool), move.modal.format_length
    shown = move.modal.format_feed(feed, is_per_rev=True)
    if shape.kind in _DRILLS:
        return Message(
            "{name} feeds at {value}, which is too high for a diameter of {diameter}.",
            name=name,
            value=shown,
            diameter=text(shape.diameter),
        )
    if shape.kind in GROOVING_TOOLS:
        return Message(
            "{name} feeds at {value}, which is too high for a cutting edge {width} wide.",
            name=name,
            value=shown,
            width=text(shape.width),
        )
    return Message(
        "{name} feeds at {value}, which is too high for a nose radius of {nose_radius}.",
        name=name,
        value=shown,
        nose_radius=text(shape.nose_radius),
    )


def _is_z_move(move: TipMove) -> bool:
    """Return whether a move travels further along Z than along X."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    return abs(z1 - z0) > abs(r1 - r0)


def _check_blade_turning(
    move: TipMove, cut: Cut, shape: ToolShape, tool: int, *, is_face: bool
) -> Iterator[Found]:
    """Check that a blade does not turn too far along Z, or a face grooving blade (``is_face``) along X.

    A cut to the side that is longer than the width of the blade must not be deeper than the blade can bend.
    A chamfer at 45° and the finishing cut on the wall of a groove are permitted.
    """
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    along, across = abs(z1 - z0), abs(r1 - r0)
    deep, long = cut.depth_mm, cut.width_mm
    if is_face:
        along, across, deep, long = across, along, cut.width_mm, across
    if along <= 2.0 * across:
        return
    limit = _BLADE_FINISH if shape.kind is ToolKind.PARTING else _TURNING_WIDTH_FRACTION * shape.width
    if deep > limit > 0.0 and long > shape.width:
        text = move.modal.format_length
        words = Message(
            "{tool} turns {depth} deep along {axis}; this type of blade allows at most {limit}.",
            tool=format_edge_name(tool),
            depth=text(deep),
            axis="X" if is_face else "Z",
            limit=text(limit),
        )
        yield Found("blade-turns", words)


def _check_depth(
    move: TipMove, cut: Cut, shape: ToolShape, cutter: Cutter, tool: int, *, is_stock_specified: bool
) -> Iterator[Found]:
    """Check the depth of a cut against the length of the cutting edge and, for boring, against the bar.

    The mean depth is checked, because a finishing pass that ends at a shoulder briefly cuts the whole
    shoulder. For a cut across Z, the mean is calculated along Z. An error is reported if the depth exceeds
    the edge length at any point, or if no insert of this shape, or no such bar, can cut the mean depth.
    """
    along, text = _is_z_move(move), move.modal.format_length
    deep = _mean_depth(cut, is_z_move=along)
    if along and cutter.has_holder and cut.depth_mm > cutter.edge_height_mm:
        words = Message(
            "{tool} cuts {depth} deep, but its cutting edge is only {height} long.",
            tool=format_edge_name(tool),
            depth=text(cut.depth_mm),
            height=text(cutter.edge_height_mm),
        )
        yield Found("feed-into-holder", words)
        return
    if not is_stock_specified:
        return
    if not cutter.has_holder:  # =
        shape = replace(shape, insert="", diameter=0.0)
    largest, usual = _breaking_depth(shape), find_max_depth(shape)
    if deep > largest and move.rpm:  # a manually switched spindle may be stopped
        words = Message(
            "{tool} cuts {depth} deep in one pass, but its maximum depth of cut is {largest}.",
            tool=format_edge_name(tool),
            depth=text(deep),
            largest=text(largest),
        )
        yield Found("depth-breaks-tool", words)
    elif deep > usual:
        words = Message(
            "{tool} cuts {depth} deep in one pass; the usual maximum is {usual}.",
            tool=format_edge_name(tool),
            depth=text(deep),
            usual=text(usual),
        )
        yield Found("depth-of-cut", words)


def _mean_depth(cut: Cut, *, is_z_move: bool) -> float:
    """Return the mean depth of a cut in mm, along r, or along Z for a cut across Z.

    For an arc, ``cut`` is the total of straight pieces that were cut one after the other.
    """
    if is_z_move:
        return cut.area / max(cut.width_mm, cut.front_z_mm - cut.back_z_mm)
    return min(cut.width_mm, cut.area / cut.depth_mm)


def _breaking_depth(shape: ToolShape) -> float:
    """Return the depth of cut in mm at which the tool breaks.

    Dimensions that are not specified are ignored.
    """
    bar = (
        _BAR_DEPTH_FRACTION * shape.diameter if shape.kind is ToolKind.BORING and shape.diameter else math.inf
    )
    return min(bar, find_max_depth(shape, MAX_DEPTH_FRACTIONS) if shape.insert.strip() else math.inf)


def find_max_depth(shape: ToolShape, depth_fractions: Mapping[str, float] = USUAL_DEPTH_FRACTIONS) -> float:
    """Return the usual maximum depth of cut in mm.

    This is a fraction of the edge length, or of the diameter of a round insert.
    """
    insert = _insert(shape)
    share = depth_fractions.get(insert.shape, _OTHER_SHAPE)
    edge = insert.edge_lengths[0] - insert.nose_radius if insert.edge_lengths else insert.inscribed_circle
    return share * edge


def has_round_insert(shape: ToolShape) -> bool:
    """Return whether a tool has a round insert."""
    return not _insert(shape).edge_lengths


def _insert(shape: ToolShape) -> CuttingInsert:
    try:
        return decode_insert_code(shape.insert) if shape.insert.strip() else _USUAL
    except InsertCodeError:
        return _USUAL
