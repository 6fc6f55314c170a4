"""Checks of a cutting edge: its side, its depth, the feed that it stands, and the hand of the spindle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from core.interpreter.elementary_blocks import Kind
from core.part.cutter import Cutter, Side
from core.part.stock import Stock
from core.part.tool_shape import Hand, ToolKind, ToolShape
from core.part.turned_part import Cut, TurnedPart
from core.proving.assumed_tools import GROOVERS
from core.proving.thread_checks import Found
from core.proving.tip_moves import TipMove
from core.tool_edges import edge_name

_COARSE = 0.8  # of the nose radius: the usual limit of a turned face
_OF_WIDTH = 0.25  # of a grooving edge
_OF_DRILL = 0.1  # of a drill's diameter
_WRONG_SIDE = 0.5  # mm that the back of an insert may take off
_BEHIND = 0.05  # mm of metal behind the nose
_STEEPER = 2.0  # degrees
_OVER_AXIS = 1.5  # mm beyond it, which a face or a part-off needs at most
_BEHIND_FACE = 0.5  # mm
_PAST = 12.7  # mm
_NEAR = 1e-6
_DRILLS = frozenset({ToolKind.DRILL, ToolKind.CENTRE_DRILL, ToolKind.REAMER, ToolKind.TAP})
_INSERTS = frozenset({ToolKind.TURNING, ToolKind.BORING})


@dataclass(slots=True)
class EdgeChecks:
    """Goes with the moves in their order, each once it has been cut."""

    stock: Stock | None = None
    parted_at: float | None = None  # Z of the deepest part-off
    _turned: dict[int, float] = field(default_factory=dict)  # T → which way its edge has been cut with
    _told: set[int] = field(default_factory=set)

    def look(
        self, move: TipMove, met: Cut, shape: ToolShape | None, cutter: Cutter, part: TurnedPart, tool: int
    ) -> Iterator[Found]:
        """What is wrong with a feed that has just taken metal off."""
        if shape is None or not met:
            return
        yield from self._feed(move, shape, tool, held=cutter.held)
        yield from self._spindle(move, shape, tool)
        yield from self._over_axis(move, cutter, tool)
        yield from self._past_part_off(move, shape, cutter, tool)
        yield from self._drilled(move, shape, tool)
        if cutter.held and shape.kind in _INSERTS and move.kind is not Kind.THREAD:  # else it is assumed
            yield from _too_deep(move, met, shape, cutter, tool)
            yield from _wrong_side(move, met, shape, cutter, part, tool)

    @staticmethod
    def _feed(move: TipMove, shape: ToolShape, tool: int, *, held: bool) -> Iterator[Found]:
        """Feed of a turn against nose radius, width of a groover, diameter of a drill."""
        feed = move.per_rev or (move.speed * 60.0 / abs(move.rpm) if move.rpm else 0.0)
        if not feed or move.kind is Kind.THREAD or shape.kind is ToolKind.TAP:
            return
        shown = move.modal.feed_text(feed, per_rev=True)
        text = move.modal.length_text
        if shape.kind in _DRILLS and held and feed > _OF_DRILL * shape.diameter > 0.0:
            yield Found(
                "chip-load", f"{edge_name(tool)} feeds {shown} with a diameter of {text(shape.diameter)}."
            )
        elif shape.kind in GROOVERS and held and feed > _OF_WIDTH * shape.width > 0.0:
            yield Found(
                "chip-load", f"{edge_name(tool)} feeds {shown} with an edge {text(shape.width)} wide."
            )
        elif shape.kind in _INSERTS and feed > _COARSE * shape.nose_radius > 0.0:
            yield Found(
                "chip-load",
                f"{edge_name(tool)} feeds {shown} with a nose radius of {text(shape.nose_radius)}.",
            )

    def _spindle(self, move: TipMove, shape: ToolShape, tool: int) -> Iterator[Found]:
        """M03 and M04 against the hand of a drill; one edge cuts one way only."""
        if not move.rpm:
            return
        if shape.kind in _DRILLS:
            needed = {Hand.RIGHT: 1.0, Hand.LEFT: -1.0}.get(shape.hand, 0.0)
            if move.rpm * needed < 0.0:
                code = "M04" if move.rpm < 0.0 else "M03"
                words = (
                    f"{edge_name(tool)}, which is {shape.hand}-hand, cuts while the spindle turns by {code}."
                )
                yield Found("wrong-spindle-direction", words)
            return
        if shape.turns_itself:
            return
        radii = [r for _, r in move.points]
        if min(radii) < _NEAR and max(radii) > -_NEAR:
            return  # over the axis
        way = math.copysign(1.0, move.rpm) * math.copysign(1.0, radii[0])
        if self._turned.setdefault(tool, way) != way and tool not in self._told:
            self._told.add(tool)
            words = (
                f"{edge_name(tool)} cuts with the spindle turning the other way than where it has cut before."
            )
            yield Found("wrong-spindle-direction", words)

    def _over_axis(self, move: TipMove, cutter: Cutter, tool: int) -> Iterator[Found]:
        """An outside tool that is fed through the axis, or cuts on its other side."""
        z, r = move.points[-1]
        behind = z < (self.stock.front if self.stock is not None else 0.0) - _BEHIND_FACE
        if cutter.side is Side.OUTSIDE and behind and r * cutter.across < -_OVER_AXIS:
            words = f"{edge_name(tool)} cuts {move.modal.length_text(abs(r))} beyond the axis"
            yield Found("over-axis", f"{words}, on the side where it does not stand.")

    def _past_part_off(self, move: TipMove, shape: ToolShape, cutter: Cutter, tool: int) -> Iterator[Found]:
        if self.parted_at is None or cutter.drills or shape.kind is ToolKind.PARTING:
            return
        z = min(z for z, _ in move.points)
        long = (self.stock.front if self.stock is not None else 0.0) - self.parted_at
        if z < self.parted_at - max(_PAST, long):
            text = move.modal.length_text
            yield Found(
                "past-part-off",
                f"{edge_name(tool)} cuts at Z {text(z)}; the part ends at {text(self.parted_at)}.",
            )

    def _drilled(self, move: TipMove, shape: ToolShape, tool: int) -> Iterator[Found]:
        deep = part_depth(move, self.stock)
        if shape.turns_itself and shape.length and deep > shape.length:
            text = move.modal.length_text
            yield Found(
                "drill-too-deep", f"{edge_name(tool)} goes {text(deep)} deep; it cuts {text(shape.length)}."
            )


def part_depth(move: TipMove, stock: Stock | None) -> float:
    """How deep a move ends behind the face of the stock, mm."""
    return (stock.front if stock is not None else 0.0) - min(z for z, _ in move.points)


def _too_deep(move: TipMove, met: Cut, shape: ToolShape, cutter: Cutter, tool: int) -> Iterator[Found]:
    """A cut along Z that is deeper than the edge is long; across it the insert goes in as it comes."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    if shape.kind is not ToolKind.TURNING or abs(z1 - z0) <= abs(r1 - r0):
        return
    if met.depth > cutter.height:
        text = move.modal.length_text
        words = f"{edge_name(tool)} cuts {text(met.depth)} deep; its edge reaches {text(cutter.height)}."
        yield Found("feed-into-holder", words)


def _wrong_side(
    move: TipMove, met: Cut, shape: ToolShape, cutter: Cutter, part: TurnedPart, tool: int
) -> Iterator[Found]:
    """The back of an insert cuts: fed backwards at depth, or down a wall that is steeper than it clears."""
    forward, across = shape.direction
    if not forward or not across or len(move.points) != 2:
        return
    (z0, r0), (z1, r1) = move.points
    along = (z1 - z0) * forward
    inwards = (r1 - r0) * across
    text = move.modal.length_text
    if along < -_NEAR and abs(inwards) < -along * 0.05:
        if met.depth > max(_WRONG_SIDE, 2.0 * shape.nose_radius):
            yield Found(
                "wrong-side", f"{edge_name(tool)} cuts {text(met.depth)} deep with the back of its insert."
            )
        return
    if along < 0.0 or inwards <= _NEAR:
        return
    steep, clears = math.degrees(math.atan2(inwards, along)), cutter.clears(forward)
    if steep <= clears + _STEEPER:
        return
    behind = met.front - z0 if forward < 0 else z0 - met.back
    beyond = _stands_behind(part, met, forward, abs(r1), cutter.side)
    if behind > 2.0 * shape.nose_radius + _BEHIND and met.depth > _BEHIND and beyond:
        words = f"{edge_name(tool)} goes in at {steep:.0f}°, and the back of its insert clears {clears:.0f}°."
        yield Found("wrong-side", words)


def _stands_behind(part: TurnedPart, met: Cut, forward: int, r: float, side: Side) -> bool:
    """Whether metal above the tip is left right behind what was cut: a wall that the back has met."""
    step = part.columns.step
    edge = met.front + step if forward < 0 else met.back - step
    at = part.columns.at(edge)
    if not 0 <= at < part.columns.number:
        return False
    low, high = part.low[:, at], part.high[:, at]
    above = low < r if side is Side.BORE else high > r
    return bool(np.any((high > low + _NEAR) & above))
