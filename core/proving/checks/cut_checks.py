"""Checks of how much a move takes off: too much for the tool, or nothing where metal is meant."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

from core.interpreter.shared.elementary_blocks import Kind
from core.message import Message
from core.part.cutter import Cutter, Side
from core.part.insert_codes import Insert, InsertCodeError, decoded, insert_of
from core.part.stock import Stock
from core.part.swept_edge import Point
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Cut, TurnedPart
from core.proving.assumed_tools import GROOVERS
from core.proving.checks.thread_checks import Found
from core.proving.tip_moves import TipMove
from core.tool_edges import edge_name

NEAR = 2.0
"""mm; further from all metal than that is in the air."""

_AIR_TIME, _AIR_WAY = 5.0, 5.0  # s, mm
_LONG_AIR = 20.0  # s, of moves one after the other
_AWAY = 2.54  # mm; a move that leads away from the part, or in beside it
_OUT = 5.2  # mm before the face: a feed back along what was turned ends nearer
_LEAST = 1.0  # mm of feeds between two rapids
_BESIDE = 5.0  # mm outside the bar
_BEHIND_FACE = 0.5  # mm
_PLACES = (0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95)
# Largest usual depth of cut in lengths of the cutting edge (a round insert: diameters), for medium
# geometries: Widia, "Selection of insert", the column -LM of its table of effective lengths.
USUAL: Mapping[str, float] = {"S": 0.5, "C": 0.5, "W": 0.4, "T": 0.3, "D": 0.3, "V": 0.2, "R": 0.3}
_OTHER_SHAPE = 0.5
# The largest share that makers allow for roughing geometries.
LARGEST: Mapping[str, float] = {"S": 2 / 3, "C": 2 / 3, "W": 0.5, "T": 0.5, "D": 0.5, "V": 0.25, "R": 0.4}
_OF_BAR = 0.5  # of a boring bar's diameter
_USUAL = insert_of("C", 12.7, 0.8)  # CNMG432, the largest that a small lathe usually has
_COARSE = 0.8  # of the nose radius: the usual limit of a turned face
_OF_WIDTH = 0.12  # of a grooving edge; Ingersoll's catalog of 2011 has .075
_OF_DRILL = 0.04  # of the diameter of a drill: twice the usual .02
_OF_REAMER = 0.1
_BREAKS = 5.0  # times one of these; drills and blades are made for feeds that differ by so much
_BREAKS_INSERT = 2.5
_NEVER_BREAKS = 0.15  # mm of feed of an insert, however sharp its nose
_TURNS_WIDE = 0.8  # of the width, by a grooving edge along Z: the same catalog
_BLADE_FINISH = 0.25  # mm along Z that a parting blade may take off
_DRILLS = frozenset({ToolKind.DRILL, ToolKind.CENTRE_DRILL, ToolKind.REAMER})
INSERTS = frozenset({ToolKind.TURNING, ToolKind.BORING})


@dataclass(slots=True)
class AirChecks:
    """Goes with the moves in their order: ``feed`` or ``rapid`` once each has been cut, ``pause`` between."""

    stock: Stock | None = None
    _tool: int = 0
    _milled: dict[int, tuple[int, int] | None] = field(default_factory=dict)  # T → line and n, until it cuts
    _cut_before: bool = False  # the move before has taken metal off, or gone along it
    _left_part: TipMove | None = None  # a feed that led away from the part, and met nothing
    _air: float = 0.0  # s without metal since the last cut
    _fed: TipMove | None = None  # the first of the feeds since the last rapid, none of which came near metal
    _fed_length: float = 0.0
    _has_cut: bool = False  # one of the feeds since the last rapid came near metal
    _in_hole: TipMove | None = None  # the first feed of a drill since then, while it has cut nothing
    _fresh: bool = False  # no feed since the last rapid
    _cut_line: int = 0  # of the last feed that came near metal: a cycle's own rapids have it
    _went_in: TipMove | None = None  # a rapid beside the part, where nothing has been cut since

    def pause(self) -> None:
        """The program waits or switches something: what it has gone in for."""
        self._went_in = None

    def rapid(self, move: TipMove, met: Cut, tool: int) -> Iterator[Found]:
        """What the feeds before a rapid, and the rapids before it, should have cut."""
        if tool != self._tool:
            self._tool, self._went_in = tool, None
        yield from self._end_of_feeds()
        self._left_part, self._cut_before, self._fresh = None, False, True
        if self.stock is None:
            return
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        if self._went_in is not None and z1 > self.stock.front:
            text = "After this rapid alongside the part, the tool retracts without cutting."
            yield Found("unmade-cut", text, self._went_in)
            self._went_in = None
        beside = min(abs(r0), abs(r1)) < self.stock.radius + _BESIDE
        if not met and beside and move.line != self._cut_line and z1 < min(z0, self.stock.front) - _AWAY:
            self._went_in = self._went_in or move

    def feed(
        self, move: TipMove, met: Cut, cutter: Cutter, part: TurnedPart, tool: int, forward: int,
        *, drill: bool = False,
    ) -> Iterator[Found]:  # fmt: skip
        """What a feed that meets nothing should have cut; ``forward``: sign of Z the tool cuts towards.

        ``drill``: it is a drill of a known diameter.
        """
        if tool != self._tool:
            yield from self._end_of_feeds()
            self._tool, self._went_in = tool, None
        fresh, self._fresh = self._fresh, False
        if met and forward < 0 and self._out_of_part(move, cutter, fresh=fresh):
            yield Found("unmade-cut", "This move feeds backward out of the part, through material.")
        close = bool(met) or self._comes_near(move, cutter, part)
        if drill and fresh and not met and self._is_inside(move):
            self._in_hole = move
        elif met:
            self._in_hole = None
        if close:
            self._has_cut, self._went_in, self._cut_line = True, None, move.line
        else:
            self._fed = self._fed or move
            self._fed_length += move.length
        gone, self._left_part = self._left_part, None
        if met or move.kind is Kind.THREAD:
            self._air, self._cut_before = 0.0, bool(met)
            return
        if self._outside_stock(move):
            yield Found("larger-than-stock", "This move turns a diameter larger than the stock.")
        yield from self._leads_away(move, gone, cutter, part, fresh=fresh)
        yield from self._in_air(move, cutter, part)
        self._cut_before = close

    def mill(self, line: int, n: int, tool: int, cut: Callable[[], bool]) -> None:
        """A live tool has been fed; ``cut`` is asked of one that has cut nothing yet."""
        if self._milled.get(tool, (line, n)) is None:
            return
        if cut():
            self._milled[tool] = None
        else:
            self._milled.setdefault(tool, (line, n))

    @property
    def never_milled(self) -> list[tuple[int, int, int]]:
        """Line and block of the first feed of each live tool that has cut nothing, and its T."""
        return [(*at, tool) for tool, at in self._milled.items() if at is not None]

    def _end_of_feeds(self) -> Iterator[Found]:
        fed, length, has_cut = self._fed, self._fed_length, self._has_cut
        in_hole, self._in_hole = self._in_hole, None
        self._fed, self._fed_length, self._has_cut = None, 0.0, False
        if in_hole is not None and has_cut:
            yield Found("unmade-cut", "A drill feeds into an existing hole.", in_hole)
        if fed is not None and not has_cut and length >= _LEAST:
            text = (
                "Threading moves between two rapids cut only air."
                if fed.kind is Kind.THREAD
                else "Feed moves between two rapids cut only air."
            )
            yield Found("unmade-cut", text, fed)

    def _comes_near(self, move: TipMove, cutter: Cutter, part: TurnedPart) -> bool:
        middle = move.points[len(move.points) // 2]
        if len(move.points) == 2:
            (z0, r0), (z1, r1) = move.points
            middle = (z0 + z1) / 2.0, (r0 + r1) / 2.0
        return near(cutter, part, middle, move.points[-1])

    def _leads_away(
        self, move: TipMove, gone: TipMove | None, cutter: Cutter, part: TurnedPart, *, fresh: bool
    ) -> Iterator[Found]:
        if gone is not None and not near(cutter, part, *move.points):
            text = "This move and the next move feed away from the part and cut nothing."
            yield Found("unmade-cut", text, gone)
        elif move.length >= _AWAY and not near(cutter, part, move.points[-1]):
            if self._out_of_part(move, cutter, fresh=fresh):
                text = "This move feeds along Z out of the part and past its face, inside the stock diameter."
                yield Found("unmade-cut", text)
            elif near(cutter, part, move.points[0]) and not self._cut_before:  # behind a cut it is a retract
                self._left_part = move

    def _is_inside(self, move: TipMove) -> bool:
        return self.stock is not None and move.points[-1][0] < self.stock.front - NEAR

    def _out_of_part(self, move: TipMove, cutter: Cutter, *, fresh: bool) -> bool:
        """Whether a tool is fed forwards out of the part, on what it has turned: a lost minus.

        One that bores is fed out of its bore; from the face on it is no more than that.
        """
        if self.stock is None or cutter.drills:
            return False
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        front = self.stock.front
        inside = max(abs(r0), abs(r1)) < self.stock.radius - NEAR / 10.0
        begins = fresh or z0 < front + NEAR
        if cutter.side is Side.BORE:
            begins = begins and z0 > front - _BEHIND_FACE
        return inside and begins and z1 > max(front + _OUT, z0 + _AWAY)

    def _in_air(self, move: TipMove, cutter: Cutter, part: TurnedPart) -> Iterator[Found]:
        if move.length < _AWAY or near(cutter, part, move.points[-1]):
            return
        share = _share_in_air(cutter, part, move)
        before, self._air = self._air, self._air + move.seconds * share
        if move.seconds * share >= _AIR_TIME and move.length * share >= _AIR_WAY:
            text = Message(
                "This move feeds through air for {seconds} s.", seconds=f"{move.seconds * share:.0f}"
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

    def _outside_stock(self, move: TipMove) -> bool:
        """Whether it cuts along Z beside the stock, and further out."""
        stock, zs = self.stock, [z for z, _ in move.points]
        if stock is None or max(zs) - min(zs) < _AWAY or min(zs) > stock.front - _AWAY:
            return False
        if zs[-1] > max(zs[0], stock.front):
            return False  # a retract
        return min(abs(r) for _, r in move.points) > stock.radius + NEAR


def near(cutter: Cutter, part: TurnedPart, *places: Point) -> bool:
    """Whether the edge stands near metal at one of these places at least."""
    around = ((0.0, -NEAR), (0.0, NEAR), (-NEAR, 0.0), (NEAR, 0.0))
    return any(cutter.meets(part, p, (p[0] + dz, p[1] + dr)) for p in places for dz, dr in around)


def _share_in_air(cutter: Cutter, part: TurnedPart, move: TipMove) -> float:
    """How much of a way is far from all metal, read at places along it."""
    places = [
        (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share)
        for a, b in pairwise(move.points)
        for share in (_PLACES if len(move.points) == 2 else (0.5,))
    ]
    return sum(not near(cutter, part, place) for place in places) / len(places)


def size_faults(
    move: TipMove, met: Cut, shape: ToolShape, cutter: Cutter, tool: int, *, stock_given: bool
) -> Iterator[Found]:
    """Yield what is too large in a feed that has just cut ``met``."""
    yield from _feed(move, shape, tool, held=cutter.held)
    if move.kind is Kind.THREAD:
        return
    if shape.kind in GROOVERS:
        yield from _blade_turns(move, met, shape, tool)
    elif shape.kind in INSERTS:
        yield from _depth(move, met, shape, cutter, tool, stock_given=stock_given)


def _feed(move: TipMove, shape: ToolShape, tool: int, *, held: bool) -> Iterator[Found]:
    """Feed per revolution against nose radius, width of a groover or diameter of a drill."""
    feed = move.per_rev or (move.speed * 60.0 / abs(move.rpm) if move.rpm else 0.0)
    if not feed or move.kind is Kind.THREAD or shape.kind is ToolKind.TAP:
        return
    limit, breaks, least = _feed_limit(shape, held=held)
    if not feed > limit > 0.0:
        return
    words = _too_fast(move, shape, tool, feed)
    if feed > max(breaks * limit, least):
        yield Found("feed-breaks-tool", words)
    else:
        yield Found("chip-load", words)


def _feed_limit(shape: ToolShape, *, held: bool) -> tuple[float, float, float]:
    """Usual largest feed of a tool, mm (0: none), how many times that breaks it, and mm that never do."""
    if shape.kind in _DRILLS and held:
        share = _OF_REAMER if shape.kind is ToolKind.REAMER else _OF_DRILL
        return share * shape.diameter, _BREAKS, 0.0
    if shape.kind in GROOVERS and held:
        return _OF_WIDTH * shape.width, _BREAKS, 0.0
    if shape.kind in INSERTS:
        return _COARSE * shape.nose_radius, _BREAKS_INSERT, _NEVER_BREAKS
    return 0.0, _BREAKS, 0.0


def _too_fast(move: TipMove, shape: ToolShape, tool: int, feed: float) -> Message:
    """Return the words for a feed over the limit of ``_feed_limit``."""
    name, text = edge_name(tool), move.modal.length_text
    shown = move.modal.feed_text(feed, per_rev=True)
    if shape.kind in _DRILLS:
        return Message(
            "{name} feeds at {value}, which is too high for a diameter of {diameter}.",
            name=name,
            value=shown,
            diameter=text(shape.diameter),
        )
    if shape.kind in GROOVERS:
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


def _is_along(move: TipMove) -> bool:
    """Return whether a move goes along Z rather than across it."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    return abs(z1 - z0) > abs(r1 - r0)


def _blade_turns(move: TipMove, met: Cut, shape: ToolShape, tool: int) -> Iterator[Found]:
    """A blade that turns further along Z than it is wide, and deeper than it can bend.

    A chamfer at 45° is not such a move, nor the last shaving off the wall of a groove.
    """
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    if abs(z1 - z0) <= 2.0 * abs(r1 - r0):
        return
    limit = _BLADE_FINISH if shape.kind is ToolKind.PARTING else _TURNS_WIDE * shape.width
    if met.depth > limit > 0.0 and met.width > shape.width:
        text = move.modal.length_text
        words = Message(
            "{tool} turns {depth} deep along Z; this type of blade allows at most {limit}.",
            tool=edge_name(tool),
            depth=text(met.depth),
            limit=text(limit),
        )
        yield Found("blade-turns", words)


def _depth(
    move: TipMove, met: Cut, shape: ToolShape, cutter: Cutter, tool: int, *, stock_given: bool
) -> Iterator[Found]:
    """Depth of a cut against the length of the edge, and against the bar of a boring tool.

    It is the mean depth: a finishing pass that ends in a shoulder shaves all of it for a moment. Across it is
    the mean of Z. A pass that is deeper anywhere than its edge is long is an error, and so is one that is
    deeper on the average than any insert of this shape, or the bar of a boring tool, can take.
    """
    along, text = _is_along(move), move.modal.length_text
    deep = _mean(met, along=along)
    if along and cutter.held and met.depth > cutter.height:
        words = Message(
            "{tool} cuts {depth} deep, but its cutting edge is only {height} long.",
            tool=edge_name(tool),
            depth=text(met.depth),
            height=text(cutter.height),
        )
        yield Found("feed-into-holder", words)
        return
    if not stock_given:
        return
    if not cutter.held:  # the insert is assumed with its holder
        shape = replace(shape, insert="", diameter=0.0)
    largest, usual = _largest(shape), depth_limit(shape)
    if deep > largest and move.rpm:  # a spindle that is switched by hand may stand
        words = Message(
            "{tool} cuts {depth} deep in one pass, but its maximum depth of cut is {largest}.",
            tool=edge_name(tool),
            depth=text(deep),
            largest=text(largest),
        )
        yield Found("depth-breaks-tool", words)
    elif deep > usual:
        words = Message(
            "{tool} cuts {depth} deep in one pass; the usual maximum is {usual}.",
            tool=edge_name(tool),
            depth=text(deep),
            usual=text(usual),
        )
        yield Found("depth-of-cut", words)


def _mean(met: Cut, *, along: bool) -> float:
    """Mean depth along r, or along Z of a cut across; the pieces of an arc follow each other."""
    if along:
        return met.area / max(met.width, met.front - met.back)
    return min(met.width, met.area / met.depth)


def _largest(shape: ToolShape) -> float:
    """Return the depth of cut, mm, at which the tool breaks; what is not stated of it has no limit."""
    bar = _OF_BAR * shape.diameter if shape.kind is ToolKind.BORING and shape.diameter else math.inf
    return min(bar, depth_limit(shape, LARGEST) if shape.insert.strip() else math.inf)


def depth_limit(shape: ToolShape, shares: Mapping[str, float] = USUAL) -> float:
    """Return the largest usual depth of cut, mm: a share of the straight edge or of a round insert."""
    insert = _insert(shape)
    share = shares.get(insert.shape, _OTHER_SHAPE)
    edge = insert.edges[0] - insert.nose_radius if insert.edges else insert.inscribed_circle
    return share * edge


def is_round(shape: ToolShape) -> bool:
    """Return whether a tool has a round insert."""
    return not _insert(shape).edges


def _insert(shape: ToolShape) -> Insert:
    try:
        return decoded(shape.insert) if shape.insert.strip() else _USUAL
    except InsertCodeError:
        return _USUAL
