"""Findings about tools and material for each move, according to the entries of ``part_checks``."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message, join_messages
from core.part.cutter import CutSide, Cutter, NeighborTools
from core.part.stock import Clamping, Stock, calculate_critical_rpm
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import NO_CUT, Cut, PartedPiece, TurnedPart
from core.proving.checks.cut_checks import AirCutChecks
from core.proving.checks.edge_checks import EdgeChecks
from core.proving.checks.part_checks import PART_CHECKS, STOCK, PartCheck
from core.proving.checks.thread_checks import Found, ThreadChecks
from core.proving.tip_moves import TipMove
from core.tool_edges import format_edge_name

if TYPE_CHECKING:
    from core.part.polar_field import RemovedMaterial
    from core.proving.milling import MillMove

TouchesMaterial = Callable[[], bool]

RAPID_TOLERANCE_MM = 0.0254
"""Depth of stock in mm, in radius and in Z, that a rapid may touch."""

_MAX_FINDINGS = 100
_CHUCK_STEP = 0.05  # mm
_SLENDER = 5.0
_STUB = (0.05, 1.0)  # mm, range of the stub radius that a part-off may leave
_SQUARE = 0.02  # mm of Z
_LONG = 2.54  # mm of Z
_CLEARANCE = 0.25  # mm of clearance in Z to the chuck
_TOUCH_TOLERANCE_MM = 0.045  # mm of Z: .001 in plus the overlap of bodies that gives no finding
_SAFE = 0.5  # fraction of the speed at which a bar begins to whirl


@dataclass(slots=True)
class PartFindings:
    """The findings of a program, collected while each move is checked and removes its material.

    The moves must be passed in program order.
    """

    find_tool_shape: Callable[[int], ToolShape | None]
    stock: Stock | None
    clamping: Clamping | None = None
    neighbors: NeighborTools | None = None
    thread_checks: ThreadChecks = field(default_factory=ThreadChecks)
    find_unspecified_data: Callable[[tuple[str, ...]], tuple[str, ...]] = lambda _rests_on: ()
    silenced_checks: Mapping[str, str] = field(default_factory=dict)  # reason by check
    part_off_z_mm: float | None = None  # Z of the deepest part-off
    _left: tuple[int, TipMove] | None = None  # T with its part-off that stopped before the axis
    clamping_cuts: dict[tuple[str, int], Cut] = field(default_factory=dict)  # by check and line
    _edges: EdgeChecks = field(init=False)
    _airs: AirCutChecks = field(init=False)
    _found: dict[tuple[str, int], Diagnostic] = field(default_factory=dict)
    _chuck: TurnedPart | None = None
    _tailstock: TurnedPart | None = None
    _whirls: float = 0.0  # rpm at which the stock begins to whirl; 0: unknown
    _before: TipMove | None = None

    def __post_init__(self) -> None:
        given = not self.find_unspecified_data((STOCK,))
        self._edges = EdgeChecks(self.stock, is_stock_specified=given, part_off_z_mm=self.part_off_z_mm)
        self._airs = AirCutChecks(self.stock)
        if self.clamping is not None and self.clamping.chuck_diameter and self.stock is not None:
            if not self.clamping.quill_diameter:  # stock supported at both ends whirls at a much higher speed
                self._whirls = calculate_critical_rpm(self.stock, self.clamping.stick_out)
            self._chuck = TurnedPart(self.clamping.make_chuck_for_stock(self.stock), _CHUCK_STEP)
        tailstock = self.clamping.tailstock_solid if self.clamping is not None else None
        self._tailstock = TurnedPart(tailstock, _CHUCK_STEP) if tailstock is not None else None

    @property
    def clamping_bodies(self) -> dict[str, TurnedPart]:
        """Return the chuck and the tailstock as bodies, by the name of their collision check.

        Bodies that are unknown are left out.
        """
        known = {"into-chuck": self._chuck, "into-tailstock": self._tailstock}
        return {check: body for check, body in known.items() if body is not None}

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Return the findings, at most one per check and line."""
        return tuple(self._found.values())

    def check_move(self, move: TipMove, cutter: Cutter, part: TurnedPart, tool: int) -> None:
        """Remove the material that a move cuts, and check the result."""
        if self._leaves_thread(move, cutter):
            self._found_by(
                move, self.thread_checks.check_move(move, NO_CUT, part, self.find_tool_shape(tool), tool)
            )
            self._found_by(move, self._airs.check_rapid_move(move, NO_CUT, tool))
            self._before = move
            return
        self.thread_checks.record_initial_radii(move, part)
        self._edges.record_solid_length(move, self.find_tool_shape(tool), part)
        inside = move.is_fast and part.enters_material(move.points, RAPID_TOLERANCE_MM)
        cuts, struck = _execute_move(move, cutter, part)
        met = _combine_cuts(move, cuts)
        if struck:
            text = Message(
                "The holder of {tool} collides with material, {struck}.",
                tool=format_edge_name(tool),
                struck=_depth(struck, move),
            )
            if move.is_fast:
                self._add("holder-into-stock", move, text)
            else:
                self._add("feed-into-holder", move, text)
        self._check_clamping(move, cutter, tool)
        if self.neighbors is not None and (
            other := self.neighbors.find_struck_tool(part, tool, pairwise(move.points))
        ):
            self._add(
                "neighbour-tool",
                move,
                Message(
                    "{other}, next to {tool} on the gang plate, collides with the stock.",
                    other=format_edge_name(other),
                    tool=format_edge_name(tool),
                ),
            )
        if move.is_fast:
            self._check_rapid_cut(move, met, is_certain=inside)
            self._check_rubbing(move, met, cutter, part, tool)
            self._found_by(move, self._airs.check_rapid_move(move, met, tool))
        else:
            shape = self.find_tool_shape(tool)
            self._record_part_off(move, met, shape, tool)
            forward = shape.direction[0] if shape is not None else 0
            drill = shape is not None and shape.kind is ToolKind.DRILL and cutter.has_holder
            self._found_by(
                move, self._airs.check_feed_move(move, met, cutter, part, tool, forward, is_drill=drill)
            )
            self._found_by(
                move,
                self._edges.check_feed_move(move, cuts, met, self.find_tool_shape(tool), cutter, part, tool),
            )
        self._found_by(move, self.thread_checks.check_move(move, met, part, self.find_tool_shape(tool), tool))
        self._before = move

    def _leaves_thread(self, move: TipMove, cutter: Cutter) -> bool:
        """Return whether a rapid leaves the groove of a thread pass directly away from the material.

        Contact with material is then not a fault. The end position of the pass is not exactly known, so the
        material that the edge touches is inside the groove.
        """
        if not move.is_fast or self._before is None or self._before.block_kind is not BlockKind.THREAD:
            return False
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        return abs(z1 - z0) <= _SQUARE and (abs(r1) < abs(r0)) is (cutter.side is CutSide.BORE)

    def _found_by(self, move: TipMove, found: Iterable[Found]) -> None:
        for check, text, at in found:
            self._add(check, at or move, text)

    def _check_clamping(self, move: TipMove, cutter: Cutter, tool: int) -> None:
        """Check for collisions with the chuck, collet and tailstock, and check the speed of the chuck."""
        if self.clamping is None:
            return
        if met := _find_body_hit(self._chuck, move, cutter):
            self.clamping_cuts["into-chuck", move.line] = met
            text = Message(
                "{tool} collides with the chuck, {what}.", tool=format_edge_name(tool), what=_depth(met, move)
            )
            certain = self._chuck is not None and self._chuck.enters_material(move.points, RAPID_TOLERANCE_MM)
            self._add("into-chuck", move, text, certain=certain)
        elif _find_body_hit(self._chuck, _shift_toward_chuck(move, _TOUCH_TOLERANCE_MM), cutter):
            self._add("into-chuck", move, Message("{tool} touches the chuck.", tool=format_edge_name(tool)))
        elif _find_body_hit(self._chuck, _shift_toward_chuck(move, _CLEARANCE), cutter):
            self._add(
                "near-chuck", move, Message("{tool} nearly touches the chuck.", tool=format_edge_name(tool))
            )
        if met := _find_body_hit(self._tailstock, move, cutter):
            self.clamping_cuts["into-tailstock", move.line] = met
            self._add(
                "into-tailstock",
                move,
                Message(
                    "{tool} collides with the tailstock, {what}.",
                    tool=format_edge_name(tool),
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

    def _check_rapid_cut(self, move: TipMove, cut: Cut, *, is_certain: bool) -> None:
        """Check a rapid that removes material.

        ``is_certain`` means that the tip itself is in the material.
        """
        if cut.depth_mm <= RAPID_TOLERANCE_MM or cut.width_mm <= RAPID_TOLERANCE_MM:
            return
        deep, fed = _depth(cut, move), move.block_kind is not BlockKind.RAPID
        behind_cut = self._before is not None and not self._before.is_fast
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
        self._add("through-part" if behind_cut else "rapid-into-stock", move, text, certain=is_certain)

    def _check_rubbing(self, move: TipMove, cut: Cut, cutter: Cutter, part: TurnedPart, tool: int) -> None:
        """Check whether an insert rapids back along the surface that it has just turned.

        An insert is checked only if its holder is known, which is not the case for an assumed tool.
        """
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        before, shape = self._before, self.find_tool_shape(tool)
        if shape is None or shape.kind is not ToolKind.TURNING or not cutter.has_holder:
            return
        if cut or before is None or before.is_fast:
            return
        if abs(r1 - r0) > _SQUARE or abs(z1 - z0) < _LONG or not move.rpm:
            return
        deeper = r0 - math.copysign(RAPID_TOLERANCE_MM, r0)
        if cutter.find_cut(part, (z0, deeper), (z1, deeper)).width_mm > _LONG:
            self._add(
                "rubs-surface",
                move,
                Message(
                    "{tool} returns in rapid along the surface it has just turned.",
                    tool=format_edge_name(tool),
                ),
            )

    def record_pause(self) -> None:
        """Record that the program waits or switches an output at this point."""
        self._airs.record_pause()

    def add_final_findings(self) -> None:
        """Add the findings that are known only at the end of the program."""
        self._tell_left()
        for check, text, at in self.thread_checks.check_last_thread():
            if at is not None:
                self._add(check, at, text)
        for one, other in self.neighbors.coincident_tools if self.neighbors is not None else ():
            words = Message(
                "{one} and {other} have the same offset, so neither is checked for collision while "
                "the other cuts.",
                one=format_edge_name(one),
                other=format_edge_name(other),
            )
            self._store_finding("tools-in-one-place", 0, 0, words)
        for line, n, tool in self._airs.live_feeds_without_cut:
            self._store_finding(
                "unmade-cut",
                line,
                n,
                Message("Live tool {tool} feeds but never touches material.", tool=format_edge_name(tool)),
            )

    def report_stationary_cut(self, line: int, block_number: int, tool: int) -> None:
        """Report that a tool cuts material while neither the tool nor the spindle rotates."""
        self._store_finding(
            "cut-standing",
            line,
            block_number,
            Message("{tool} cuts while neither the tool nor the spindle turns.", tool=format_edge_name(tool)),
        )

    def report_missing_cut(self, line: int, block_number: int, text: str) -> None:
        """Report that a tool, or the whole program, cuts no material."""
        self._store_finding("unmade-cut", line, block_number, text)

    def check_milled_move(
        self,
        move: MillMove,
        cut: RemovedMaterial,
        shape: ToolShape,
        modal: ModalState,
        tool: int,
        *,
        touches_material: TouchesMaterial,
    ) -> None:
        """Check a move of a live tool.

        ``touches_material`` returns whether the move followed material without cutting.
        """
        if not move.is_axial and not _is_cross_drilling(move) and self._crosses_axis(move):
            self._store_finding(
                "through-part",
                move.line,
                move.block_number,
                Message(
                    "{tool} moves across the spindle centerline through the part.",
                    tool=format_edge_name(tool),
                ),
            )
        if not move.is_fast:
            self._airs.record_milling_feed(
                move.line, move.block_number, tool, lambda: bool(cut) or touches_material()
            )
        if move.is_fast and cut.volume_mm3 > RAPID_TOLERANCE_MM * math.pi * (shape.diameter / 2.0) ** 2:
            where = Message(
                "Z {front} … {back}",
                front=modal.format_length(cut.front_z_mm),
                back=modal.format_length(cut.back_z_mm),
            )
            self._store_finding(
                "rapid-into-stock",
                move.line,
                move.block_number,
                Message("A live tool runs into material in rapid at {place}.", place=where),
            )

    def _crosses_axis(self, move: MillMove) -> bool:
        """Return whether a radial live tool crosses the axis within the stock."""
        ends, front = (float(move.path[0, 0]), float(move.path[-1, 0])), -math.inf
        if self.stock is not None:
            front = self.stock.front_z_mm
        return ends[0] * ends[1] < 0.0 and float(move.path[:, 1].min()) < front

    def _record_part_off(self, move: TipMove, cut: Cut, shape: ToolShape | None, tool: int) -> None:
        """Record a parting cut that stops short of the axis, or clear an earlier record.

        Such a cut leaves a stub that still connects the part.
        """
        if self._left is not None and self._left[0] != tool:
            self._tell_left()
        r = abs(move.points[-1][1])
        if cut and shape is not None and shape.kind is ToolKind.PARTING:
            self._left = (tool, move) if _STUB[0] < r <= _STUB[1] else None

    def _tell_left(self) -> None:
        if self._left is not None:
            tool, move = self._left
            thick = move.modal.format_length(2.0 * abs(move.points[-1][1]))
            self._add(
                "part-off-left",
                move,
                Message(
                    "{tool} parts off down to {thick}, but the part is not cut off.",
                    tool=format_edge_name(tool),
                    thick=thick,
                ),
            )
        self._left = None

    def check_parted_piece(self, move: TipMove, piece: PartedPiece) -> None:
        """Check a piece that has been parted off."""
        self._left = None
        if not piece.outside_profile:
            return
        length = piece.outside_profile[0][0] - piece.outside_profile[-1][0]
        thick = 2.0 * max(r for _, r in piece.outside_profile)
        if thick and length > _SLENDER * thick:
            text = Message(
                "The parted-off piece is {length} times as long as its diameter.",
                length=f"{length / thick:.0f}",
            )
            self._add("part-off-unsupported", move, text)

    def _add(self, check: str, move: TipMove, text: str, *, certain: bool = False) -> None:
        self._store_finding(check, move.line, move.n, text, is_certain=certain)

    def _store_finding(self, check: str, line: int, n: int, text: str, *, is_certain: bool = False) -> None:
        """Store a finding.

        ``is_certain`` means that the finding applies to every tool and depends only on the stock.
        """
        if len(self._found) < _MAX_FINDINGS and (check, line) not in self._found:
            entry, why = PART_CHECKS[check], self.silenced_checks.get(check, "")
            rests_on = (
                tuple(each for each in entry.required_data if each == STOCK)
                if is_certain
                else entry.required_data
            )
            assumed = self.find_unspecified_data(rests_on)
            remedy = Message("This check is turned off: {why}", why=why) if why else entry.remedy
            if assumed and not why:
                remedy = Message(
                    "{remedy} Assumed: {assumed}.", remedy=remedy, assumed=join_messages(", ", assumed)
                )
            self._found[check, line] = Diagnostic(
                line, 0, _find_severity(entry, assumed, why), check, text, remedy,
                check_name=check, block_number=n, assumptions=assumed, downgrade_reason=why,
            )  # fmt: skip


def _is_cross_drilling(move: MillMove) -> bool:
    """Return whether a live tool moves straight along a radius, as for a hole through both walls."""
    return float(np.ptp(move.path[:, 1:], axis=0).max(initial=0.0)) < _SQUARE


def _find_severity(entry: PartCheck, assumptions: tuple[str, ...], silenced: str) -> Severity:
    """Return the severity of a finding, which is at most a warning if it depends on an assumption."""
    if silenced:
        return Severity.NOTE
    return Severity.WARNING if assumptions else entry.severity


def _find_body_hit(body: TurnedPart | None, move: TipMove, cutter: Cutter) -> Cut:
    """Return the material of a body that a tool would hit, without cutting the body."""
    met = NO_CUT
    if body is not None:
        for start, end in pairwise(move.points):
            met = met.combine_with(cutter.find_collision(body, start, end))
    return met


def _shift_toward_chuck(move: TipMove, distance: float) -> TipMove:
    """Return the move shifted toward the chuck by the clearance ``distance``, in mm."""
    return move._replace(points=tuple((z - distance, r) for z, r in move.points))


def _execute_move(move: TipMove, cutter: Cutter, part: TurnedPart) -> tuple[list[Cut], Cut]:
    """Cut a move, and return the cuts of its straight pieces and the collision of the holder."""
    cuts, struck = list[Cut](), NO_CUT
    turns = 0.0
    part.holds_parted_pieces = (
        True  # The holder is checked before parted material drops, because it may hit that material.
    )
    for start, end in pairwise(move.points):
        if move.block_kind is BlockKind.THREAD and move.feed_per_rev_mm:
            cuts.append(cutter.cut_thread(part, start, end, move.feed_per_rev_mm, turns))
            turns += abs(end[0] - start[0]) / move.feed_per_rev_mm
        else:
            cuts.append(cutter.cut_material(part, start, end))
        struck = struck.combine_with_later(cutter.cut_with_body(part, start, end))
    part.drop_parted_pieces()
    return cuts, struck


def _combine_cuts(move: TipMove, cuts: Iterable[Cut]) -> Cut:
    """Return the total cut of a move from the cuts of its straight pieces.

    In a screw thread, the pieces cut the same place more than once, so their depths add up. On other paths,
    the greatest depth applies.
    """
    met = NO_CUT
    for cut in cuts:
        met = met.combine_with(cut) if move.block_kind is BlockKind.THREAD else met.combine_with_later(cut)
    return met


def _depth(met: Cut, move: TipMove) -> str:
    deep = move.modal.format_length(met.depth_mm)
    return Message(
        "at a depth of {depth}, from Z {front} to Z {back}",
        depth=deep,
        front=move.modal.format_length(met.front_z_mm),
        back=move.modal.format_length(met.back_z_mm),
    )
