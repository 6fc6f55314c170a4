"""Findings about tool and material, move by move, according to the entries of ``part_checks``."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from core.interpreter.shared.elementary_blocks import Kind
from core.interpreter.shared.modal_state import Modal
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message, join_messages
from core.part.cutter import Cutter, Neighbours, Side
from core.part.stock import Clamping, Stock, whirling_rpm
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import NOTHING, Cut, Piece, TurnedPart
from core.proving.checks.cut_checks import AirChecks
from core.proving.checks.edge_checks import EdgeChecks
from core.proving.checks.part_checks import CHECKS, STOCK, Check
from core.proving.checks.thread_checks import Found, ThreadChecks
from core.proving.tip_moves import TipMove
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from core.part.polar_field import Taken
    from core.proving.milling import MillMove

Touches = Callable[[], bool]

RAPID = 0.0254
"""mm of metal, in r and in Z, that a rapid may touch."""

_MOST = 100
_CHUCK_STEP = 0.05  # mm
_SLENDER = 5.0
_STUB = (0.05, 1.0)  # mm, range of the stub radius that a part-off may leave
_SQUARE = 0.02  # mm of Z
_LONG = 2.54  # mm of Z
_CLEARANCE = 0.25  # mm of clearance in Z to the chuck
_TOUCHES = 0.045  # mm of Z: .001 in plus the overlap of bodies that gives no finding
_SAFE = 0.5  # fraction of the speed at which a bar begins to whirl


@dataclass(slots=True)
class PartFindings:
    """Checks the moves in their order and lets each one remove its material."""

    shape: Callable[[int], ToolShape | None]
    stock: Stock | None
    clamping: Clamping | None = None
    neighbours: Neighbours | None = None
    threads: ThreadChecks = field(default_factory=ThreadChecks)
    not_said: Callable[[tuple[str, ...]], tuple[str, ...]] = lambda _rests_on: ()
    silenced: Mapping[str, str] = field(default_factory=dict)  # reason by check
    parted_at: float | None = None  # Z of the deepest part-off
    _left: tuple[int, TipMove] | None = None  # T with its part-off that stopped before the axis
    into_clamping: dict[tuple[str, int], Cut] = field(default_factory=dict)  # by check and line
    _edges: EdgeChecks = field(init=False)
    _airs: AirChecks = field(init=False)
    _found: dict[tuple[str, int], Diagnostic] = field(default_factory=dict)
    _chuck: TurnedPart | None = None
    _tailstock: TurnedPart | None = None
    _whirls: float = 0.0  # rpm at which the stock begins to whirl; 0: unknown
    _before: TipMove | None = None

    def __post_init__(self) -> None:
        given = not self.not_said((STOCK,))
        self._edges = EdgeChecks(self.stock, stock_given=given, parted_at=self.parted_at)
        self._airs = AirChecks(self.stock)
        if self.clamping is not None and self.clamping.diameter and self.stock is not None:
            if not self.clamping.quill:  # stock supported at both ends whirls at a much higher speed
                self._whirls = whirling_rpm(self.stock, self.clamping.stick_out)
            self._chuck = TurnedPart(self.clamping.around(self.stock), _CHUCK_STEP)
        tailstock = self.clamping.tailstock if self.clamping is not None else None
        self._tailstock = TurnedPart(tailstock, _CHUCK_STEP) if tailstock is not None else None

    @property
    def bodies(self) -> dict[str, TurnedPart]:
        """Chuck and tailstock as bodies, by the check that supervises them; unknown ones are left out."""
        known = {"into-chuck": self._chuck, "into-tailstock": self._tailstock}
        return {check: body for check, body in known.items() if body is not None}

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The findings, each once per line."""
        return tuple(self._found.values())

    def look(self, move: TipMove, cutter: Cutter, part: TurnedPart, tool: int) -> None:
        """Cut the material of a move and check the result."""
        if self._leaves_thread(move, cutter):
            self._found_by(move, self.threads.look(move, NOTHING, part, self.shape(tool), tool))
            self._found_by(move, self._airs.rapid(move, NOTHING, tool))
            self._before = move
            return
        self.threads.before_cut(move, part)
        self._edges.before_cut(move, self.shape(tool), part)
        inside = move.quick and part.contains(move.points, RAPID)
        cuts, struck = _executed(move, cutter, part)
        met = _together(move, cuts)
        if struck:
            text = Message(
                "The holder of {tool} collides with material, {struck}.",
                tool=edge_name(tool),
                struck=_depth(struck, move),
            )
            if move.quick:
                self._add("holder-into-stock", move, text)
            else:
                self._add("feed-into-holder", move, text)
        self._clamped(move, cutter, tool)
        if self.neighbours is not None and (
            other := self.neighbours.struck(part, tool, pairwise(move.points))
        ):
            self._add(
                "neighbour-tool",
                move,
                Message(
                    "{other}, next to {tool} on the gang plate, collides with the stock.",
                    other=edge_name(other),
                    tool=edge_name(tool),
                ),
            )
        if move.quick:
            self._rapid(move, met, certain=inside)
            self._rubs(move, met, cutter, part, tool)
            self._found_by(move, self._airs.rapid(move, met, tool))
        else:
            shape = self.shape(tool)
            self._part_off(move, met, shape, tool)
            forward = shape.direction[0] if shape is not None else 0
            drill = shape is not None and shape.kind is ToolKind.DRILL and cutter.held
            self._found_by(move, self._airs.feed(move, met, cutter, part, tool, forward, drill=drill))
            self._found_by(move, self._edges.look(move, cuts, met, self.shape(tool), cutter, part, tool))
        self._found_by(move, self.threads.look(move, met, part, self.shape(tool), tool))
        self._before = move

    def _leaves_thread(self, move: TipMove, cutter: Cutter) -> bool:
        """Return whether a rapid leaves the groove of a thread pass straight away from the material.

        The end position of the pass is not exactly known, so the material that the edge meets is in the
        groove.
        """
        if not move.quick or self._before is None or self._before.kind is not Kind.THREAD:
            return False
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        return abs(z1 - z0) <= _SQUARE and (abs(r1) < abs(r0)) is (cutter.side is Side.BORE)

    def _found_by(self, move: TipMove, found: Iterable[Found]) -> None:
        for check, text, at in found:
            self._add(check, at or move, text)

    def _clamped(self, move: TipMove, cutter: Cutter, tool: int) -> None:
        """Check for collisions with chuck, collet and tailstock, and the speed of the chuck."""
        if self.clamping is None:
            return
        if met := _reached(self._chuck, move, cutter):
            self.into_clamping["into-chuck", move.line] = met
            text = Message(
                "{tool} collides with the chuck, {what}.", tool=edge_name(tool), what=_depth(met, move)
            )
            certain = self._chuck is not None and self._chuck.contains(move.points, RAPID)
            self._add("into-chuck", move, text, certain=certain)
        elif _reached(self._chuck, _deeper_in_z(move, _TOUCHES), cutter):
            self._add("into-chuck", move, Message("{tool} touches the chuck.", tool=edge_name(tool)))
        elif _reached(self._chuck, _deeper_in_z(move, _CLEARANCE), cutter):
            self._add("near-chuck", move, Message("{tool} nearly touches the chuck.", tool=edge_name(tool)))
        if met := _reached(self._tailstock, move, cutter):
            self.into_clamping["into-tailstock", move.line] = met
            self._add(
                "into-tailstock",
                move,
                Message(
                    "{tool} collides with the tailstock, {what}.",
                    tool=edge_name(tool),
                    what=_depth(met, move),
                ),
            )
        highest = self.clamping.max_rpm
        if highest and abs(move.rpm) > highest:
            text = Message(
                "The spindle turns at {rpm} rpm; the chuck allows at most {highest} rpm.",
                rpm=f"{abs(move.rpm):.0f}",
                highest=f"{highest:.0f}",
            )
            self._add("spindle-overspeed", move, text)
        if self._whirls and abs(move.rpm) > _SAFE * self._whirls:
            text = Message(
                "The stock sticks out so far that it whips at {whip} rpm; the spindle turns at {rpm} rpm.",
                whip=f"{self._whirls:.0f}",
                rpm=f"{abs(move.rpm):.0f}",
            )
            self._add("stock-whips", move, text)

    def _rapid(self, move: TipMove, met: Cut, *, certain: bool) -> None:
        """Check a rapid that removes material. ``certain`` means that the tip itself is in the material."""
        if met.depth <= RAPID or met.width <= RAPID:
            return
        deep, fed = _depth(met, move), move.kind is not Kind.RAPID
        behind_cut = self._before is not None and not self._before.quick
        if behind_cut and fed:
            text = Message(
                "A feed move at rapid speed retracts through the part after a cut, {depth}.", depth=deep
            )
        elif behind_cut:
            text = Message("A rapid retracts through the part after a cut, {depth}.", depth=deep)
        elif fed:
            text = Message("A feed move at rapid speed runs into material, {depth}.", depth=deep)
        else:
            text = Message("A rapid runs into material, {depth}.", depth=deep)
        self._add("through-part" if behind_cut else "rapid-into-stock", move, text, certain=certain)

    def _rubs(self, move: TipMove, met: Cut, cutter: Cutter, part: TurnedPart, tool: int) -> None:
        """Check for a specified insert that returns in rapid along the surface that it has just turned."""
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        before, shape = self._before, self.shape(tool)
        if shape is None or shape.kind is not ToolKind.TURNING or not cutter.held:
            return
        if met or before is None or before.quick:
            return
        if abs(r1 - r0) > _SQUARE or abs(z1 - z0) < _LONG or not move.rpm:
            return
        deeper = r0 - math.copysign(RAPID, r0)
        if cutter.meets(part, (z0, deeper), (z1, deeper)).width > _LONG:
            self._add(
                "rubs-surface",
                move,
                Message(
                    "{tool} returns in rapid along the surface it has just turned.", tool=edge_name(tool)
                ),
            )

    def pause(self) -> None:
        """Record that the program waits or switches an output."""
        self._airs.pause()

    def finish(self) -> None:
        """Add the findings that are known only at the end of the program."""
        self._tell_left()
        for check, text, at in self.threads.finish():
            if at is not None:
                self._add(check, at, text)
        for one, other in self.neighbours.in_one_place if self.neighbours is not None else ():
            words = Message(
                "{one} and {other} have the same offset, so neither is checked for collision while "
                "the other cuts.",
                one=edge_name(one),
                other=edge_name(other),
            )
            self._tell("tools-in-one-place", 0, 0, words)
        for line, n, tool in self._airs.never_milled:
            self._tell(
                "unmade-cut",
                line,
                n,
                Message("Live tool {tool} feeds but never touches material.", tool=edge_name(tool)),
            )

    def standing(self, line: int, n: int, tool: int) -> None:
        """Report that a tool cuts material while neither tool nor spindle turns."""
        self._tell(
            "cut-standing",
            line,
            n,
            Message("{tool} cuts while neither the tool nor the spindle turns.", tool=edge_name(tool)),
        )

    def nothing_cut(self, line: int, n: int, text: str) -> None:
        """Report that a tool, or the whole program, cuts nothing."""
        self._tell("unmade-cut", line, n, text)

    def milled(
        self, move: MillMove, met: Taken, shape: ToolShape, modal: Modal, tool: int, *, touches: Touches
    ) -> None:
        """Check a move of a live tool. ``touches`` returns whether it followed material without a cut."""
        if not move.axial and not _drills_across(move) and self._over_axis(move):
            self._tell(
                "through-part",
                move.line,
                move.n,
                Message("{tool} moves across the spindle centerline through the part.", tool=edge_name(tool)),
            )
        if not move.quick:
            self._airs.mill(move.line, move.n, tool, lambda: bool(met) or touches())
        if move.quick and met.volume > RAPID * math.pi * (shape.diameter / 2.0) ** 2:
            where = Message(
                "Z {front} … {back}", front=modal.length_text(met.front), back=modal.length_text(met.back)
            )
            self._tell(
                "rapid-into-stock",
                move.line,
                move.n,
                Message("A live tool runs into material in rapid at {place}.", place=where),
            )

    def _over_axis(self, move: MillMove) -> bool:
        """Return whether a radial live tool crosses the axis within the stock."""
        ends, front = (float(move.path[0, 0]), float(move.path[-1, 0])), -math.inf
        if self.stock is not None:
            front = self.stock.front
        return ends[0] * ends[1] < 0.0 and float(move.path[:, 1].min()) < front

    def _part_off(self, move: TipMove, met: Cut, shape: ToolShape | None, tool: int) -> None:
        """Record the stub that a parting tool leaves at the axis, until it cuts the stub."""
        if self._left is not None and self._left[0] != tool:
            self._tell_left()
        r = abs(move.points[-1][1])
        if met and shape is not None and shape.kind is ToolKind.PARTING:
            self._left = (tool, move) if _STUB[0] < r <= _STUB[1] else None

    def _tell_left(self) -> None:
        if self._left is not None:
            tool, move = self._left
            thick = move.modal.length_text(2.0 * abs(move.points[-1][1]))
            self._add(
                "part-off-left",
                move,
                Message(
                    "{tool} parts off down to {thick}, but the part is not cut off.",
                    tool=edge_name(tool),
                    thick=thick,
                ),
            )
        self._left = None

    def parted(self, move: TipMove, piece: Piece) -> None:
        """Check a piece that has been parted off."""
        self._left = None
        if not piece.outside:
            return
        length = piece.outside[0][0] - piece.outside[-1][0]
        thick = 2.0 * max(r for _, r in piece.outside)
        if thick and length > _SLENDER * thick:
            text = Message(
                "The parted-off piece is {length} times as long as its diameter.",
                length=f"{length / thick:.0f}",
            )
            self._add("part-off-unsupported", move, text)

    def _add(self, check: str, move: TipMove, text: str, *, certain: bool = False) -> None:
        self._tell(check, move.line, move.n, text, certain=certain)

    def _tell(self, check: str, line: int, n: int, text: str, *, certain: bool = False) -> None:
        """Store a finding. ``certain`` means that it applies to every tool and depends only on the stock."""
        if len(self._found) < _MOST and (check, line) not in self._found:
            entry, why = CHECKS[check], self.silenced.get(check, "")
            rests_on = tuple(each for each in entry.rests_on if each == STOCK) if certain else entry.rests_on
            assumed = self.not_said(rests_on)
            remedy = Message("This check is turned off: {why}", why=why) if why else entry.remedy
            if assumed and not why:
                remedy = Message(
                    "{remedy} Assumed: {assumed}.", remedy=remedy, assumed=join_messages(", ", assumed)
                )
            self._found[check, line] = Diagnostic(
                line, 0, _weight(entry, assumed, why), check, text, remedy,
                check=check, n=n, assumed=assumed, silenced=why,
            )  # fmt: skip


def _drills_across(move: MillMove) -> bool:
    """Return whether a live tool moves straight along a radius, as for a hole through both walls."""
    return float(np.ptp(move.path[:, 1:], axis=0).max(initial=0.0)) < _SQUARE


def _weight(entry: Check, assumed: tuple[str, ...], silenced: str) -> Severity:
    """Return the severity of a finding. A finding that depends on an assumption is at most a warning."""
    if silenced:
        return Severity.NOTE
    return Severity.WARNING if assumed else entry.severity


def _reached(body: TurnedPart | None, move: TipMove, cutter: Cutter) -> Cut:
    """Return the material of a body that a tool would hit. The body is not cut."""
    met = NOTHING
    if body is not None:
        for start, end in pairwise(move.points):
            met = met.joined(cutter.reaches(body, start, end))
    return met


def _deeper_in_z(move: TipMove, by: float) -> TipMove:
    """Return the move shifted toward the chuck by a clearance in mm."""
    return move._replace(points=tuple((z - by, r) for z, r in move.points))


def _executed(move: TipMove, cutter: Cutter, part: TurnedPart) -> tuple[list[Cut], Cut]:
    """Cut a move and return the cuts of its straight pieces, and the collision of the holder."""
    cuts, struck = list[Cut](), NOTHING
    turns = 0.0
    part.holds = True  # The holder is checked before parted material drops, because it may hit that material.
    for start, end in pairwise(move.points):
        if move.kind is Kind.THREAD and move.per_rev:
            cuts.append(cutter.thread(part, start, end, move.per_rev, turns))
            turns += abs(end[0] - start[0]) / move.per_rev
        else:
            cuts.append(cutter.cut(part, start, end))
        struck = struck.followed(cutter.strikes(part, start, end))
    part.let_fall()
    return cuts, struck


def _together(move: TipMove, cuts: Iterable[Cut]) -> Cut:
    """Return the total cut of a move. In a thread, revolutions deepen the cut; along a path they do not."""
    met = NOTHING
    for cut in cuts:
        met = met.joined(cut) if move.kind is Kind.THREAD else met.followed(cut)
    return met


def _depth(met: Cut, move: TipMove) -> str:
    deep = move.modal.length_text(met.depth)
    return Message(
        "at a depth of {depth}, from Z {front} to Z {back}",
        depth=deep,
        front=move.modal.length_text(met.front),
        back=move.modal.length_text(met.back),
    )
