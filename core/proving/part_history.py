"""The part at any time of a program, replayed from stored copies, and the finished part for a picture.

All results are independent arrays, because another thread may show them.

The finished part is the material in the chuck just before the last piece is parted off. If no piece is parted
off, it is the material at the end or before the collet opens, whichever is less.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from core.interpreter.shared.actions import Collet
from core.message import Message
from core.part.solid_bodies import Round, ToolBody, chuck_solid
from core.part.solid_picture import Scene
from core.part.stock_spec import StockSpec
from core.part.surface_points import Solid, solid_of, turned_solid
from core.part.swept_edge import FloatArray, Point
from core.part.tool_outline import ToolOutline, outline
from core.part.tool_shape import ToolShape
from core.proving.part_instant import Half, Hit, PartCopies, PartInstant, PlacedTool, hit_of, metal_of
from core.proving.part_making import PartMaking
from core.proving.part_proof import MOST_MOVES
from core.proving.program_timeline import MotionSpan, Part, RestSpan
from core.proving.program_tools import PartSetting, ProgramTools
from core.proving.tip_moves import LiveStep, Step, Steps, TipMove, ends_of, slides_at, zero_of

_LOOKED = 20  # blocks between two calls of ``watch``

Go = Callable[[], None]
Watch = Callable[[float], None]


@dataclass(frozen=True, slots=True, eq=False)
class PartMoves:
    """All blocks of a program in their order, with the settings of stock and tools."""

    parts: tuple[Part, ...]
    setting: PartSetting


@dataclass(slots=True)
class PartGathering:
    """Collects the blocks of a pass through a program, up to the limit for the operator screen."""

    setting: PartSetting
    _parts: list[Part] = field(default_factory=list)
    _blocks: int = 0

    def see(self, span: MotionSpan | RestSpan) -> None:
        """Add the next span of the program."""
        if isinstance(span, MotionSpan):
            parts = span.parts
        else:
            parts = ([span.block],) if span.block is not None else ()
        self._blocks += sum(len(part) for part in parts)
        if self._blocks <= MOST_MOVES:
            self._parts += parts
        else:
            self._parts.clear()

    @property
    def too_many(self) -> str:
        """The reason why the part cannot be made, as a sentence, or an empty string."""
        if self._blocks <= MOST_MOVES:
            return ""
        way = "use 'turndesk prove --stock' for longer programs"
        return Message(
            "The program has {blocks} blocks, but TurnDesk can simulate the part for at most "
            "{most_moves} blocks; {details}",
            blocks=self._blocks,
            most_moves=MOST_MOVES,
            details=way,
        )

    def moves(self) -> PartMoves | None:
        """Return the collected blocks, or None if there are none or too many."""
        return PartMoves(tuple(self._parts), self.setting) if self._parts else None


class PartHistory:
    """Makes the part at any block of a program, forward and, from stored copies, backward.

    Used by one thread at a time.
    """

    def __init__(self, moves: PartMoves) -> None:
        reading = Steps()
        self.steps: list[Step] = [step for part in moves.parts for step in reading.of(part)]
        self._numbers = np.array([_number(step) for step in self.steps], dtype=np.int64)
        self._tools = ProgramTools(self.steps, moves.setting)
        stock = moves.setting.stock or self._tools.assumed_stock()
        self.stock = (
            stock.stock(self._tools.back, self._tools.unit) if isinstance(stock, StockSpec) else stock
        )
        self._outlines: dict[int, ToolOutline | None] = {}
        self._hits: dict[tuple[str, int], Hit] = {}
        self._kept = PartCopies()
        self._clamping = moves.setting.clamping
        self._travel = moves.setting.travel
        self._chuck: Solid | None = None
        held = self._clamping
        if held is not None and (held.diameter or held.quill) and self.stock is not None:
            self._chuck = chuck_solid(held, self.stock)
        self._making = PartMaking(self._tools, self.stock, moves.setting)
        self._seen = self._making  # the part as last returned
        self._ahead: tuple[int, float, PartMaking] | None = (
            None  # number of steps, share of the next one, and its part
        )
        self._done = 0  # steps
        self._last: PartInstant | None = None
        self._kept.keep(0, self._making)

    def at(self, block: int, share: float = 0.0, watch: Go | None = None) -> PartInstant:
        """Return the part when ``block`` blocks and the ``share`` (0 to 1) of the next one are done.

        ``watch`` is called regularly during long work and may raise. The work done until then is stored.
        """
        self._last = None
        done = int(np.searchsorted(self._numbers, block, side="right"))
        self._go_to(done, watch)
        under_way = self.steps[done] if done < len(self.steps) and share > 0.0 else None
        self._last = self._instant(block, share, under_way)
        return self._last

    def making_at(self, block: int, tip: Point | None = None, watch: Go | None = None) -> PartMaking:
        """Return a copy of the part before a block, or with the block done up to the ``tip`` (Z, r in mm)."""
        share = 0.0
        step = self._step(block)
        if tip is not None and isinstance(step, TipMove):
            share = share_along(step.points, tip)
        self.at(block - 1, share, watch)
        return self._seen.copy()

    @property
    def tools(self) -> ProgramTools:
        """The tools of the program, as specified or assumed."""
        return self._tools

    def zero(self, tool: int) -> Point | None:
        """Return machine X and Z at which the tip of this tool is at part zero, or None if it never moves."""
        for step in reversed(self.steps):
            if isinstance(step, TipMove) and step.modal.tool == tool:
                return step.zero
            if isinstance(step, LiveStep) and step.block.modal.tool == tool:
                return zero_of(step.block, step.place)
        return None

    @property
    def end(self) -> Point | None:
        """Machine X and Z at the end of the program, or None if no axis moves."""
        for step in reversed(self.steps):
            if isinstance(step, TipMove):
                return step.points[-1][1] + step.zero[0], step.points[-1][0] + step.zero[1]
        return None

    def share_at(self, block: int, behind_end: Point) -> float:
        """Return the share of a block that is done when the tool is ``behind_end`` (Z, r) from its end."""
        step = self._step(block)
        if isinstance(step, LiveStep):
            ends = ends_of(step)
            return share_along(ends, (ends[1][0] + behind_end[0], ends[1][1] + behind_end[1]))
        if not isinstance(step, TipMove):
            return 0.0
        end = step.points[-1]
        return share_along(step.points, (end[0] + behind_end[0], end[1] + behind_end[1]))

    @property
    def blocks(self) -> int:
        """The number of the last block."""
        return int(self._numbers[-1]) if len(self._numbers) else 0

    def now(self) -> PartInstant:
        """Return the part as far as the present work has made it."""
        done = self._done
        return self._instant(int(self._numbers[done - 1]) if done else 0, 0.0, None)

    def is_current(self, instant: PartInstant) -> bool:
        """Return whether ``instant`` is the last one returned, so that the part is unchanged."""
        return instant is self._last

    def solid(self, instant: PartInstant) -> Solid | None:
        """Return the solid of the last instant, for this thread only, or None without material."""
        if instant.near is None:
            return None
        milling = self._seen.milling
        if milling is not None:
            return solid_of(milling.field)
        return turned_solid(*instant.near)

    def scene_at(self, instant: PartInstant) -> Scene:
        """Return the objects around the part at an instant: chuck or collet, and the tool."""
        tool = instant.tool
        if tool is None or not (tool.cutting or tool.body):
            return Scene(self._chuck)
        return Scene(self._chuck, ToolBody(tool.cutting, tool.body, tool.round, tool.assumed))

    def _step(self, block: int) -> Step | None:
        there = int(np.searchsorted(self._numbers, block))
        return self.steps[there] if there < len(self.steps) and self._numbers[there] == block else None

    # --- execution of the program

    def _go_to(self, done: int, watch: Go | None) -> None:
        if self._ahead is not None and self._ahead[0] != done:
            self._ahead = None
        kept = self._kept.before(done)
        if not kept <= self._done <= done:
            self._making, self._done = self._kept.copy(kept), kept
        while self._done < done:
            if watch is not None and self._done % _LOOKED == 0:
                watch()
            self._see(self.steps[self._done])
            self._done += 1
            self._kept.perhaps(self._done, self._making)

    def _see(self, step: Step) -> None:
        """Apply the next block and store its hits."""
        making, known = self._making, len(self._making.findings.diagnostics)
        before = metal_of(making.part)
        making.see(step)
        for found in making.findings.diagnostics[known:]:
            hit = hit_of(found, step, making, before)
            if hit is not None:
                self._hits[found.check, found.line] = hit

    # --- displayed state

    def _instant(self, block: int, share: float, under_way: Step | None) -> PartInstant:
        making, place = self._making, self._place()
        if isinstance(under_way, TipMove):
            cut = _begun(under_way, share)
            place = cut.points[-1]
            if making.milling is None:
                making = making.copy()
                making.see(cut)
        elif isinstance(under_way, LiveStep):
            making, place = self._milled(under_way, share), slides_at(under_way, share)
        self._seen, found = making, making.findings.diagnostics
        near, far = _halves(making)
        return PartInstant(
            block=block,
            share=share,
            line=_line(under_way or (self.steps[self._done - 1] if self._done else None)),
            near=near,
            far=far,
            stock=self.stock,
            tool=self._tool(making.tool, place),
            hits=tuple(
                self._hits[each.check, each.line] for each in found if (each.check, each.line) in self._hits
            ),
            findings=found,
            pieces=making.parted_off,
            clamping=self._clamping,
            is_open=making.is_open,
            reach=self._reach(under_way),
            c=self._c(under_way, share),
        )

    def _milled(self, step: LiveStep, share: float) -> PartMaking:
        """Return the part with a live tool's block in progress, continued from the last view if possible."""
        done, gone, ahead = self._ahead or (-1, 0.0, self._making)
        if done != self._done or gone > share:
            gone, ahead = 0.0, self._making.copy()
        if share > gone:
            ahead.mill(step, gone, share)
        self._ahead = self._done, share, ahead
        return ahead

    def _reach(self, under_way: Step | None) -> tuple[Point, Point] | None:
        """Return the machine limits in tip positions, with the offset of the last moving block."""
        last = self.steps[max(0, self._done - 200) : self._done]
        for step in (*((under_way,) if under_way is not None else ()), *reversed(last)):
            if self._travel is None or not isinstance(step, TipMove | LiveStep):
                continue
            x, z = step.zero if isinstance(step, TipMove) else zero_of(step.block, step.place)
            (x0, x1), (z0, z1) = self._travel
            return (z0 - z, x0 - x), (z1 - z, x1 - x)
        return None

    def _c(self, under_way: Step | None, share: float) -> float:
        """Return C of the block in progress, or of the last block that engaged C."""
        if isinstance(under_way, LiveStep):
            return _c_at(under_way, share)
        for step in reversed(self.steps[max(0, self._done - 200) : self._done]):
            if isinstance(step, LiveStep):
                return _c_at(step, 1.0)
        return 0.0

    def _place(self) -> Point | None:
        """Return the end of the last moving block."""
        for step in reversed(self.steps[max(0, self._done - 200) : self._done]):
            if isinstance(step, TipMove):
                return step.points[-1]
            if isinstance(step, LiveStep):
                return ends_of(step)[1]
        return None

    def _tool(self, number: int, place: Point | None) -> PlacedTool | None:
        if place is None:
            return None
        if number not in self._outlines:
            shape = self._tools.shape(number)
            self._outlines[number] = outline(shape) if shape is not None else None
        lines = self._outlines[number]
        if lines is None:
            return PlacedTool(number, place, (), (), assumed=True)
        cutting, body = (
            tuple(each + np.array(place) for each in group) for group in (lines.cutting, lines.body)
        )
        shape = self._tools.shape(number)
        return PlacedTool(
            number, place, cutting, body, not self._tools.described(number), _round(shape, lines.axial)
        )


def _round(shape: ToolShape | None, axial: bool) -> Round:
    if shape is None or not shape.turns_itself:
        return Round.NOT
    return Round.ALONG if axial else Round.ACROSS


def share_along(points: Sequence[Point], at: Point) -> float:
    """Return the share of a polyline that is before its nearest position to a point."""
    gone = best = 0.0
    least = math.inf
    total = sum(math.dist(a, b) for a, b in pairwise(points))
    for a, b in pairwise(points):
        dz, dr, size = b[0] - a[0], b[1] - a[1], math.dist(a, b)
        along = ((at[0] - a[0]) * dz + (at[1] - a[1]) * dr) / (size * size) if size else 0.0
        along = min(max(along, 0.0), 1.0)
        off = math.dist(at, (a[0] + along * dz, a[1] + along * dr))
        if off < least:
            least, best = off, gone + along * size
        gone += size
    return best / total if total else 0.0


def _begun(move: TipMove, share: float) -> TipMove:
    """Return the first part of a move."""
    left, points = share * move.length, [move.points[0]]
    for a, b in pairwise(move.points):
        size = math.dist(a, b)
        if size >= left:
            part = left / size if size else 0.0
            points.append((a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part))
            break
        points.append(b)
        left -= size
    return move._replace(points=tuple(points) if len(points) > 1 else move.points[:1] * 2)


def _number(step: Step) -> int:
    return step.block.n if isinstance(step, LiveStep) else step.n


def _line(step: Step | None) -> int:
    if step is None:
        return 0
    return step.block.line if isinstance(step, LiveStep) else step.line


def _c_at(step: LiveStep, share: float) -> float:
    """Return C in degrees at a share of a live tool's block."""
    block = step.block
    if block.plane is not None:
        return float(block.plane.machine(np.array([share]))[0, 2])
    return block.c0 + (block.c - block.c0) * share


def _halves(making: PartMaking) -> tuple[Half | None, Half | None]:
    part = making.part
    if part is None:
        return None, None
    if making.milling is not None:
        field, rays = making.milling.field, making.milling.field.low.shape[2]
        sides = [
            Half(field.edges.copy(), field.low[:, :, ray].copy(), field.high[:, :, ray].copy())
            for ray in (rays // 2, 0)  # X+ of the lathe with C at 0 is at 180° of the part
        ]
        return sides[0], sides[1]
    columns = part.columns
    edges: FloatArray = columns.first + columns.step * (np.arange(columns.number + 1, dtype=np.float64) - 0.5)
    half = Half(edges, part.low.copy(), part.high.copy())
    return half, half


class FinishedPart(NamedTuple):
    """The finished part. ``back`` and ``front`` are the ends of its stock in Z, ``radius`` that of the stock.

    Lengths are in mm.
    """

    solid: Solid
    back: float
    front: float
    radius: float


def finished_part(moves: PartMoves, watch: Watch) -> FinishedPart | None:
    """Return the finished part, or None if nothing is cut.

    ``watch`` receives the block number regularly and may raise to cancel.
    """
    history = PartHistory(moves)

    def at(block: int) -> PartInstant:
        return history.at(block, 0.0, lambda: watch(block))

    pieces = at(history.blocks).pieces
    ends = [history.blocks, *_before_last_opening(history)]
    if pieces:
        ends = [_before_last_piece(at, history.blocks, pieces)]
    held = [(volume, end) for end in ends if (volume := _volume(at(end).near)) > 0.0]
    stock = history.stock
    if not held or stock is None:
        return None
    solid = history.solid(at(min(held)[1]))
    return FinishedPart(solid, stock.back, stock.front, stock.radius) if solid is not None else None


def _before_last_opening(history: PartHistory) -> list[int]:
    """Return the block before the last opening of the collet."""
    for step in reversed(history.steps):
        if not isinstance(step, TipMove | LiveStep) and step.action == Collet(closed=False):
            return [max(step.n - 1, 0)]
    return []


def _before_last_piece(at: Callable[[int], PartInstant], last: int, pieces: int) -> int:
    """Return the last block before the last piece was parted off.

    A binary search is possible, because the number of pieces never decreases.
    """
    before, behind = 0, last
    while behind - before > 1:
        middle = (before + behind) // 2
        before, behind = (middle, behind) if at(middle).pieces < pieces else (before, middle)
    return before


def _volume(half: Half | None) -> float:
    """Return the volume of the section rotated about the axis, in mm³."""
    if half is None:
        return 0.0
    wide = half.edges[1:] - half.edges[:-1]
    rings = (half.high**2 - half.low**2).clip(min=0.0)
    return float(math.pi * (rings * wide).sum())
