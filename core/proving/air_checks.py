"""Checks of moves that meet no metal where the program seems to mean some: a lost minus, G00 left on."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

from core.interpreter.elementary_blocks import Kind
from core.message import Message
from core.part.cutter import Cutter, Side
from core.part.stock import Stock
from core.part.swept_edge import Point
from core.part.turned_part import Cut, TurnedPart
from core.proving.thread_checks import Found
from core.proving.tip_moves import TipMove

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
