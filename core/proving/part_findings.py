"""What goes wrong between tool and metal, move by move, as the entries of ``part_checks`` have it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

from core.interpreter.elementary_blocks import Kind
from core.interpreter.modal_state import Modal
from core.language.diagnostics import Diagnostic, Severity
from core.part.bar_whirl import whirling_rpm
from core.part.clamping import Clamping
from core.part.cutter import Cutter
from core.part.neighbours import Neighbours
from core.part.polar_field import Taken
from core.part.stock import Stock
from core.part.swept_edge import Point
from core.part.tool_shape import ToolShape
from core.part.turned_part import NOTHING, Cut, Piece, TurnedPart
from core.proving.edge_checks import EdgeChecks
from core.proving.mill_moves import MillMove
from core.proving.part_checks import CHECKS, Check
from core.proving.thread_checks import Found, ThreadChecks
from core.proving.tip_moves import TipMove

_MOST = 100
_CHUCK_STEP = 0.05  # mm
_RAPID = 0.0254  # mm of metal that a rapid may touch
_NEAR = 2.0  # mm; further from all metal than that is in the air
_AIR_TIME, _AIR_WAY = 5.0, 5.0  # s, mm
_LONG_AIR = 20.0  # s, of moves one after the other
_AWAY = 2.54  # mm; a move that leads away from the part
_PLACES = (0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95)
_SLENDER = 5.0
_SAFE = 0.5  # of the speed at which a bar begins to whirl


@dataclass(slots=True)
class PartFindings:
    """Goes with the moves in their order, and lets each take off its metal."""

    shape: Callable[[int], ToolShape | None]
    stock: Stock | None
    clamping: Clamping | None = None
    neighbours: Neighbours | None = None
    threads: ThreadChecks = field(default_factory=ThreadChecks)
    not_said: Callable[[Check], tuple[str, ...]] = lambda _check: ()
    silenced: Mapping[str, str] = field(default_factory=dict)  # why, by check
    _edges: EdgeChecks = field(init=False)
    _found: dict[tuple[str, int], Diagnostic] = field(default_factory=dict)
    _chuck: TurnedPart | None = None
    _whirls: float = 0.0  # rpm at which the stock begins to whirl; 0: not known
    _before: TipMove | None = None
    _cut_before: bool = False  # the move before has taken metal off
    _left_part: TipMove | None = None  # a feed that led away from the part, and met nothing
    _air: float = 0.0  # s without metal since the last cut

    def __post_init__(self) -> None:
        self._edges = EdgeChecks(self.stock)
        if self.clamping is not None and self.clamping.diameter and self.stock is not None:
            self._whirls = whirling_rpm(self.stock, self.clamping.stick_out)
            self._chuck = TurnedPart(self.clamping.around(self.stock), _CHUCK_STEP)

    @property
    def found(self) -> tuple[Diagnostic, ...]:
        """The findings, each once a line."""
        return tuple(self._found.values())

    def look(self, move: TipMove, cutter: Cutter, part: TurnedPart, tool: int) -> None:
        """Cut, and look at what was met."""
        if move.quick and self._before is not None and self._before.kind is Kind.THREAD:
            self._found_by(move, self.threads.look(move, NOTHING, part, self.shape(tool), tool))
            self._before = move  # out of its groove, wherever round the part that ends
            return
        self.threads.before(move, part)
        met, struck = _executed(move, cutter, part)
        if struck:
            text = f"The holder of T{tool} runs into metal, {_depth(struck, move)}."
            if move.quick:
                self._add("holder-into-stock", move, text)
            else:
                self._add("feed-into-holder", move, text)
        self._clamped(move, cutter, tool)
        if self.neighbours is not None and (
            other := self.neighbours.struck(part, tool, pairwise(move.points))
        ):
            self._add("neighbour-tool", move, f"T{other} beside T{tool} on the plate runs into the stock.")
        if move.quick:
            self._rapid(move, met)
        else:
            self._feed(move, met, cutter, part)
            self._found_by(move, self._edges.look(move, met, self.shape(tool), cutter, part, tool))
        self._found_by(move, self.threads.look(move, met, part, self.shape(tool), tool))
        self._before, self._cut_before = move, bool(met) and not move.quick

    def _found_by(self, move: TipMove, found: Iterable[Found]) -> None:
        for check, text, at in found:
            self._add(check, at or move, text)

    def _clamped(self, move: TipMove, cutter: Cutter, tool: int) -> None:
        """Chuck or collet: what runs into it, and how fast it turns."""
        if self.clamping is None:
            return
        if self._chuck is not None:
            met = NOTHING
            for start, end in pairwise(move.points):
                met = met.joined(cutter.reaches(self._chuck, start, end))
            if met:
                self._add("into-chuck", move, f"T{tool} runs into the chuck, {_depth(met, move)}.")
        highest = self.clamping.max_rpm
        if highest and abs(move.rpm) > highest:
            text = f"The spindle turns at {abs(move.rpm):.0f} rpm; the chuck may turn at {highest:.0f}."
            self._add("spindle-overspeed", move, text)
        if self._whirls and abs(move.rpm) > _SAFE * self._whirls:
            text = f"The stock sticks out so far that it whirls at {self._whirls:.0f} rpm; it turns at"
            self._add("stock-whips", move, f"{text} {abs(move.rpm):.0f}.")

    def _rapid(self, move: TipMove, met: Cut) -> None:
        self._left_part = None
        if met.depth <= _RAPID or met.width <= _RAPID:
            return
        what = "A rapid" if move.kind is Kind.RAPID else "A feed as fast as a rapid"
        behind_cut = self._before is not None and not self._before.quick
        if behind_cut:
            self._add("through-part", move, f"{what} leaves a cut through the part, {_depth(met, move)}.")
        else:
            self._add("rapid-into-stock", move, f"{what} goes into metal, {_depth(met, move)}.")

    def _feed(self, move: TipMove, met: Cut, cutter: Cutter, part: TurnedPart) -> None:
        gone, self._left_part = self._left_part, None
        if met or move.kind is Kind.THREAD:
            self._air = 0.0
            return
        if self._outside_stock(move):
            self._add("larger-than-stock", move, "This move turns a larger diameter than the stock has.")
        if gone is not None and not _near(cutter, part, *move.points):
            self._add(
                "unmade-cut",
                gone,
                "This move leads away from the part and cuts nothing, and so does the next.",
            )
            return
        if move.length < _AWAY or _near(cutter, part, move.points[-1]):
            return
        if _near(cutter, part, move.points[0]) and not self._cut_before:  # behind a cut it is a retract
            self._left_part = move
        share = _share_in_air(cutter, part, move)
        if move.seconds * share >= _AIR_TIME and move.length * share >= _AIR_WAY:
            text = f"This move feeds for {move.seconds * share:.0f} s where there is no metal."
            self._add("cuts-air", move, text)
        elif self._add_air(move, share):
            text = f"Up to here tools have fed for {_LONG_AIR:.0f} s where there is no metal."
            self._add("cuts-air", move, text)

    def _add_air(self, move: TipMove, share: float) -> bool:
        """Whether short moves one after the other have been in the air for long; told once."""
        before, self._air = self._air, self._air + move.seconds * share
        return before < _LONG_AIR <= self._air

    def _outside_stock(self, move: TipMove) -> bool:
        """Whether it cuts along Z beside the stock, and further out."""
        stock, zs = self.stock, [z for z, _ in move.points]
        if stock is None or max(zs) - min(zs) < _AWAY or min(zs) > stock.front - _AWAY:
            return False
        return min(abs(r) for _, r in move.points) > stock.radius + _NEAR

    def milled(self, move: MillMove, met: Taken, shape: ToolShape, modal: Modal) -> None:
        """A live tool has moved."""
        if move.quick and met.volume > _RAPID * math.pi * (shape.diameter / 2.0) ** 2:
            where = f"Z {modal.length_text(met.front)} … {modal.length_text(met.back)}"
            self._tell(
                "rapid-into-stock", move.line, move.n, f"A rapid of a live tool goes into metal at {where}."
            )

    def parted(self, move: TipMove, piece: Piece) -> None:
        """A piece has come off."""
        if not piece.outside:
            return
        length = piece.outside[0][0] - piece.outside[-1][0]
        thick = 2.0 * max(r for _, r in piece.outside)
        if thick and length > _SLENDER * thick:
            text = f"What is parted off is {length / thick:.0f} times as long as it is thick."
            self._add("part-off-unsupported", move, text)

    def _add(self, check: str, move: TipMove, text: str) -> None:
        self._tell(check, move.line, move.n, text)

    def _tell(self, check: str, line: int, n: int, text: str) -> None:
        if len(self._found) < _MOST and (check, line) not in self._found:
            entry, why = CHECKS[check], self.silenced.get(check, "")
            weight = Severity.NOTE if why else entry.severity
            remedy = f"Silenced: {why}" if why else entry.remedy
            found = Diagnostic(line, 0, weight, check, text, remedy, check=check, n=n, silenced=why)
            self._found[check, line] = replace(found, assumed=self.not_said(entry))


def _executed(move: TipMove, cutter: Cutter, part: TurnedPart) -> tuple[Cut, Cut]:
    """What the edges and what the body met on a move; both have been taken off."""
    met = struck = NOTHING
    turns = 0.0
    for start, end in pairwise(move.points):
        if move.kind is Kind.THREAD and move.per_rev:
            met = met.joined(cutter.thread(part, start, end, move.per_rev, turns))
            turns += abs(end[0] - start[0]) / move.per_rev
        else:
            met = met.joined(cutter.cut(part, start, end))
        struck = struck.joined(cutter.strikes(part, start, end))
    return met, struck


def _near(cutter: Cutter, part: TurnedPart, *places: Point) -> bool:
    """Whether the edge stands near metal at one of these places at least."""
    around = ((0.0, -_NEAR), (0.0, _NEAR), (-_NEAR, 0.0), (_NEAR, 0.0))
    return any(cutter.meets(part, p, (p[0] + dz, p[1] + dr)) for p in places for dz, dr in around)


def _share_in_air(cutter: Cutter, part: TurnedPart, move: TipMove) -> float:
    """How much of a way is far from all metal, read at places along it."""
    places = [
        (a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share)
        for a, b in pairwise(move.points)
        for share in (_PLACES if len(move.points) == 2 else (0.5,))
    ]
    return sum(not _near(cutter, part, place) for place in places) / len(places)


def _depth(met: Cut, move: TipMove) -> str:
    deep = move.modal.length_text(met.depth)
    return f"{deep} deep at Z {move.modal.length_text(met.front)} … {move.modal.length_text(met.back)}"
