"""The part at any block of a program, calculated forward from stored copies.

All results are independent arrays, because another thread may display them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from core.message import Message
from core.part.picture.clamping_bodies import make_clamping_bodies, make_stock_bodies
from core.part.picture.part_scene import PartScene
from core.part.picture.solid_bodies import SymmetryAxis, ToolBody
from core.part.picture.surface_points import Solid, make_milled_solid, make_turned_solid
from core.part.stock_spec import StockSpec
from core.part.swept_edge import FloatArray, Point
from core.part.tool_outline import ToolOutline, make_tool_outline
from core.part.tool_shape import ToolShape
from core.proving.part_instant import (
    MaterialHit,
    PartCopies,
    PartState,
    PlacedTool,
    SectionHalf,
    copy_material,
    find_material_hit,
)
from core.proving.part_proof import MAX_MOVES
from core.proving.part_simulation import PartSimulation
from core.proving.program_timeline import BlockGroup, MotionSpan, RestSpan
from core.proving.program_tools import PartSettings, ProgramTools
from core.proving.thread_helix import find_thread_zones, make_threaded_solid
from core.proving.tip_moves import (
    LiveToolStep,
    ProgramStep,
    StepConverter,
    TipMove,
    find_axis_position,
    find_part_zero,
    find_step_end_points,
)

_CHECK_INTERVAL = 20  # blocks between two calls of ``watch``

CheckCanceled = Callable[[], None]
ReportProgress = Callable[[float], None]


@dataclass(frozen=True, slots=True, eq=False)
class ProgramSteps:
    """All blocks of a program in program order, with the settings of the stock and the tools."""

    block_groups: tuple[BlockGroup, ...]
    part_settings: PartSettings


@dataclass(slots=True)
class StepCollector:
    """Collector of the blocks of one program pass, up to the maximum for the operator screen."""

    part_settings: PartSettings
    _parts: list[BlockGroup] = field(default_factory=list)
    _blocks: int = 0

    def add_span(self, span: MotionSpan | RestSpan) -> None:
        """Add the blocks of the next span of the program."""
        if isinstance(span, MotionSpan):
            parts = span.block_groups
        else:
            parts = ([span.block],) if span.block is not None else ()
        self._blocks += sum(len(part) for part in parts)
        if self._blocks <= MAX_MOVES:
            self._parts += parts
        else:
            self._parts.clear()

    @property
    def overflow_reason(self) -> str:
        """Return the reason why the program has too many blocks to show its part, or an empty string."""
        if self._blocks <= MAX_MOVES:
            return ""
        hint = "use 'turndesk prove --stock' for longer programs"
        return Message(
            "The program has {blocks} blocks, but TurnDesk can simulate the part for at most "
            "{most_moves} blocks; {details}",
            blocks=self._blocks,
            most_moves=MAX_MOVES,
            details=hint,
        )

    def make_program_steps(self) -> ProgramSteps | None:
        """Return the collected blocks, or None if there are no blocks or too many."""
        return ProgramSteps(tuple(self._parts), self.part_settings) if self._parts else None


class PartHistory:
    """The part at any block of a program, calculated from the last state or from a stored copy.

    Only one thread may use it at a time.
    """

    def __init__(self, program_steps: ProgramSteps) -> None:
        reading = StepConverter()
        self.steps: list[ProgramStep] = [
            step for part in program_steps.block_groups for step in reading.convert_blocks(part)
        ]
        self._numbers = np.array([_number(step) for step in self.steps], dtype=np.int64)
        self._tools = ProgramTools(self.steps, program_steps.part_settings)
        stock = program_steps.part_settings.stock or self._tools.assume_stock()
        self.stock = (
            stock.stock(self._tools.back_z_mm, self._tools.unit_mm) if isinstance(stock, StockSpec) else stock
        )
        self._outlines: dict[int, ToolOutline | None] = {}
        self._hits: dict[tuple[str, int], MaterialHit] = {}
        self._kept = PartCopies()
        self._clamping = program_steps.part_settings.clamping
        self._travel = program_steps.part_settings.travel
        self._bodies = make_clamping_bodies(self._clamping, self.stock) if self.stock is not None else ()
        self._making = PartSimulation(self._tools, self.stock, program_steps.part_settings)
        self._seen = self._making  # the part as last returned
        self._ahead: tuple[int, float, PartSimulation] | None = (
            None  # number of steps, share of the next one, and its part
        )
        self._done = 0  # steps
        self._last: PartState | None = None
        self._kept.store_copy(0, self._making)

    def at(self, block: int, fraction: float = 0.0, check_canceled: CheckCanceled | None = None) -> PartState:
        """Return the part after ``block`` blocks and the given fraction (0 to 1) of the next block.

        ``check_canceled`` is called regularly during long calculations, and may raise an exception to
        cancel. The intermediate results are stored even then.
        """
        self._last = None
        done = int(np.searchsorted(self._numbers, block, side="right"))
        self._go_to(done, check_canceled)
        under_way = self.steps[done] if done < len(self.steps) and fraction > 0.0 else None
        self._last = self._instant(block, fraction, under_way)
        return self._last

    def make_simulation_at(
        self, block: int, tip: Point | None = None, check_canceled: CheckCanceled | None = None
    ) -> PartSimulation:
        """Return a copy of the simulation before a block, or with the block executed up to ``tip``.

        ``tip`` contains Z and r in mm.
        """
        share = 0.0
        step = self._step(block)
        if tip is not None and isinstance(step, TipMove):
            share = find_polyline_fraction(step.points, tip)
        self.at(block - 1, share, check_canceled)
        return self._seen.copy()

    @property
    def program_tools(self) -> ProgramTools:
        """Return the tools of the program, as specified or as assumed."""
        return self._tools

    def find_part_zero(self, tool: int) -> Point | None:
        """Return the machine X and Z at which the tip of a tool is at part zero.

        The result is None if the tool never moves.
        """
        for step in reversed(self.steps):
            if isinstance(step, TipMove) and step.modal.tool == tool:
                return step.part_zero
            if isinstance(step, LiveToolStep) and step.block.modal.tool == tool:
                return find_part_zero(step.block, step.part_zero)
        return None

    @property
    def end_position(self) -> Point | None:
        """Return the machine X and Z at the end of the program, or None if no axis moves."""
        for step in reversed(self.steps):
            if isinstance(step, TipMove):
                return step.points[-1][1] + step.part_zero[0], step.points[-1][0] + step.part_zero[1]
        return None

    def find_executed_fraction(self, block: int, offset_from_end: Point) -> float:
        """Return the fraction of a block that has been executed.

        ``offset_from_end`` (Z, r) is the position of the tool relative to the end of the block.
        """
        step = self._step(block)
        if isinstance(step, LiveToolStep):
            ends = find_step_end_points(step)
            return find_polyline_fraction(
                ends, (ends[1][0] + offset_from_end[0], ends[1][1] + offset_from_end[1])
            )
        if not isinstance(step, TipMove):
            return 0.0
        end = step.points[-1]
        return find_polyline_fraction(step.points, (end[0] + offset_from_end[0], end[1] + offset_from_end[1]))

    @property
    def last_block_number(self) -> int:
        """Return the number of the last block, or 0 without blocks."""
        return int(self._numbers[-1]) if len(self._numbers) else 0

    def make_current_part(self) -> PartState:
        """Return the part in the state that the running calculation has reached."""
        done = self._done
        return self._instant(int(self._numbers[done - 1]) if done else 0, 0.0, None)

    def is_current_instant(self, instant: PartState) -> bool:
        """Return whether ``instant`` is the last returned state; the part has then not changed."""
        return instant is self._last

    def make_solid(self, instant: PartState) -> Solid | None:
        """Return the solid of the last returned part state, or None without material.

        Only the calling thread may use the solid.
        """
        if instant.x_plus_half is None:
            return None
        milling = self._seen.milling
        if milling is not None:
            return make_milled_solid(milling.updated_field)
        done = int(np.searchsorted(self._numbers, instant.block_count, side="right"))
        zones = find_thread_zones(self.steps[:done])
        if zones:
            return make_threaded_solid(*instant.x_plus_half, zones)
        return make_turned_solid(*instant.x_plus_half)

    def make_scene_at(self, instant: PartState, *, has_stock: bool = False) -> PartScene:
        """Return the objects around a part state for the picture: the clamping, the tool and the stock.

        The stock is included only if ``has_stock`` is True.
        """
        stock = make_stock_bodies(self.stock) if has_stock and self.stock is not None else ()
        tool = instant.tool
        if tool is None or not (tool.cutting_outlines or tool.body_outlines):
            return PartScene(self._bodies, stock=stock)
        return PartScene(
            self._bodies,
            ToolBody(tool.cutting_outlines, tool.body_outlines, tool.symmetry_axis, tool.is_assumed),
            stock,
        )

    def _step(self, block: int) -> ProgramStep | None:
        there = int(np.searchsorted(self._numbers, block))
        return self.steps[there] if there < len(self.steps) and self._numbers[there] == block else None

    # --- execution of the program

    def _go_to(self, done: int, watch: CheckCanceled | None) -> None:
        if self._ahead is not None and self._ahead[0] != done:
            self._ahead = None
        kept = self._kept.find_last_copy(done)
        if not kept <= self._done <= done:
            self._making, self._done = self._kept.copy(kept), kept
        while self._done < done:
            if watch is not None and self._done % _CHECK_INTERVAL == 0:
                watch()
            self._apply_step(self.steps[self._done])
            self._done += 1
            self._kept.store_copy_if_due(self._done, self._making)

    def _apply_step(self, step: ProgramStep) -> None:
        """Apply the next block, and store its collisions."""
        making, known = self._making, len(self._making.findings.diagnostics)
        before = copy_material(making.part)
        making.apply_step(step)
        for found in making.findings.diagnostics[known:]:
            hit = find_material_hit(found, step, making, before)
            if hit is not None:
                self._hits[found.check_name, found.line] = hit

    # --- displayed state

    def _instant(self, block: int, share: float, under_way: ProgramStep | None) -> PartState:
        making, place = self._making, self._last_position()
        if isinstance(under_way, TipMove):
            cut = _first_part(under_way, share)
            place = cut.points[-1]
            if making.milling is None:
                making = making.copy()
                making.apply_step(cut)
        elif isinstance(under_way, LiveToolStep):
            making, place = self._milled_part(under_way, share), find_axis_position(under_way, share)
        self._seen, found = making, making.findings.diagnostics
        near, far = _halves(making)
        return PartState(
            block_count=block,
            next_block_fraction=share,
            line_number=_line(under_way or (self.steps[self._done - 1] if self._done else None)),
            x_plus_half=near,
            x_minus_half=far,
            stock=self.stock,
            tool=self._tool(making.active_tool_number, place),
            material_hits=tuple(
                self._hits[each.check_name, each.line]
                for each in found
                if (each.check_name, each.line) in self._hits
            ),
            findings=found,
            parted_piece_count=making.parted_piece_count,
            clamping=self._clamping,
            is_collet_open=making.is_collet_open,
            tip_range=self._tip_range(under_way),
            c_angle_deg=self._c_angle(under_way, share),
        )

    def _milled_part(self, step: LiveToolStep, fraction: float) -> PartSimulation:
        """Return the part while a block of a live tool is in progress.

        If the previous call was for the same block and an earlier position, the calculation continues from
        its result.
        """
        done, gone, ahead = self._ahead or (-1, 0.0, self._making)
        if done != self._done or gone > fraction:
            gone, ahead = 0.0, self._making.copy()
        if fraction > gone:
            ahead.apply_milling_step(step, gone, fraction)
        self._ahead = self._done, fraction, ahead
        return ahead

    def _tip_range(self, current_step: ProgramStep | None) -> tuple[Point, Point] | None:
        """Return the travel limits of the machine, converted to tip positions (Z, r), or None if unknown.

        The conversion uses the offset of the last moving block.
        """
        last = self.steps[max(0, self._done - 200) : self._done]
        for step in (*((current_step,) if current_step is not None else ()), *reversed(last)):
            if self._travel is None or not isinstance(step, TipMove | LiveToolStep):
                continue
            x, z = step.part_zero if isinstance(step, TipMove) else find_part_zero(step.block, step.part_zero)
            (x0, x1), (z0, z1) = self._travel
            return (z0 - z, x0 - x), (z1 - z, x1 - x)
        return None

    def _c_angle(self, current_step: ProgramStep | None, fraction: float) -> float:
        """Return the C angle in degrees in the current block, or after the last block that engaged C."""
        if isinstance(current_step, LiveToolStep):
            return _c_at(current_step, fraction)
        for step in reversed(self.steps[max(0, self._done - 200) : self._done]):
            if isinstance(step, LiveToolStep):
                return _c_at(step, 1.0)
        return 0.0

    def _last_position(self) -> Point | None:
        """Return the end position of the last moving block."""
        for step in reversed(self.steps[max(0, self._done - 200) : self._done]):
            if isinstance(step, TipMove):
                return step.points[-1]
            if isinstance(step, LiveToolStep):
                return find_step_end_points(step)[1]
        return None

    def _tool(self, number: int, place: Point | None) -> PlacedTool | None:
        if place is None:
            return None
        if number not in self._outlines:
            shape = self._tools.find_tool_shape(number)
            self._outlines[number] = make_tool_outline(shape) if shape is not None else None
        lines = self._outlines[number]
        if lines is None:
            return PlacedTool(number, place, (), (), is_assumed=True)
        cutting, body = (
            tuple(each + np.array(place) for each in group)
            for group in (lines.cutting_outlines, lines.body_outlines)
        )
        shape = self._tools.find_tool_shape(number)
        return PlacedTool(
            number,
            place,
            cutting,
            body,
            not self._tools.is_shape_specified(number),
            _round(shape, lines.is_axially_symmetric),
        )


def _round(shape: ToolShape | None, axial: bool) -> SymmetryAxis:
    if shape is None or not shape.is_rotating:
        return SymmetryAxis.NONE
    return SymmetryAxis.Z if axial else SymmetryAxis.X


def find_polyline_fraction(points: Sequence[Point], position: Point) -> float:
    """Return the fraction of a polyline up to its point nearest to ``position``."""
    gone = best = 0.0
    least = math.inf
    total = sum(math.dist(a, b) for a, b in pairwise(points))
    for a, b in pairwise(points):
        dz, dr, size = b[0] - a[0], b[1] - a[1], math.dist(a, b)
        along = ((position[0] - a[0]) * dz + (position[1] - a[1]) * dr) / (size * size) if size else 0.0
        along = min(max(along, 0.0), 1.0)
        off = math.dist(position, (a[0] + along * dz, a[1] + along * dr))
        if off < least:
            least, best = off, gone + along * size
        gone += size
    return best / total if total else 0.0


def _first_part(move: TipMove, fraction: float) -> TipMove:
    """Return the move shortened to the given fraction of its length."""
    left, points = fraction * move.length_mm, [move.points[0]]
    for a, b in pairwise(move.points):
        size = math.dist(a, b)
        if size >= left:
            part = left / size if size else 0.0
            points.append((a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part))
            break
        points.append(b)
        left -= size
    return move._replace(points=tuple(points) if len(points) > 1 else move.points[:1] * 2)


def _number(step: ProgramStep) -> int:
    return step.block.n if isinstance(step, LiveToolStep) else step.n


def _line(step: ProgramStep | None) -> int:
    if step is None:
        return 0
    return step.block.line if isinstance(step, LiveToolStep) else step.line


def _c_at(step: LiveToolStep, fraction: float) -> float:
    """Return the C angle in degrees at a fraction of a live tool's block."""
    block = step.block
    if block.plane is not None:
        return float(block.plane.compute_machine_positions(np.array([fraction]))[0, 2])
    return block.c0 + (block.c - block.c0) * fraction


def _halves(making: PartSimulation) -> tuple[SectionHalf | None, SectionHalf | None]:
    part = making.part
    if part is None:
        return None, None
    if making.milling is not None:
        field, rays = making.milling.updated_field, making.milling.updated_field.inner_radii.shape[2]
        sides = [
            SectionHalf(
                field.column_edges.copy(),
                field.inner_radii[:, :, ray].copy(),
                field.outer_radii[:, :, ray].copy(),
            )
            for ray in (rays // 2, 0)  # X+ of the lathe with C at 0 is at 180° of the part
        ]
        return sides[0], sides[1]
    columns = part.columns
    edges: FloatArray = columns.first_z_mm + columns.step_mm * (
        np.arange(columns.column_count + 1, dtype=np.float64) - 0.5
    )
    half = SectionHalf(edges, part.inner_radii.copy(), part.outer_radii.copy())
    return half, half
