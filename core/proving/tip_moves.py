"""The moves of a program in the part's frame, as the path of the tool's control point."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from core.geometry.lines_and_arcs import compute_arc_sweep
from core.interpreter.shared.actions import Preset, ToolChange
from core.interpreter.shared.elementary_blocks import Block, BlockKind, StraightMoveSeries
from core.interpreter.shared.modal_state import ModalState
from core.part.swept_edge import Point

FAST_FEED_MM_S = 100 * 25.4 / 60
"""Feed in mm/s from which a G94 move is positioning and does not cut."""

_CHORD = 0.001  # mm of deviation from an arc
_MOVE_PIECES = 16  # pieces of a move in a plane, which is curved in the axes

_TURNED = frozenset({BlockKind.RAPID, BlockKind.FEED, BlockKind.ARC, BlockKind.THREAD})


class TipMove(NamedTuple):
    """The move of one elementary block, with its points as Z and r in mm from part zero.

    ``speed_mm_s`` is the speed along the path in mm/s. ``is_fast`` is True for a rapid, and for a feed per
    minute that is as fast as a rapid. ``feed_per_rev_mm`` is the feed per revolution in mm, or 0 for a feed
    per minute. ``part_zero`` is the machine X and Z at which the tip is at part zero.
    """

    n: int
    line: int
    block_kind: BlockKind
    points: tuple[Point, ...]
    speed_mm_s: float
    is_fast: bool
    feed_per_rev_mm: float
    rpm: float
    modal: ModalState
    part_zero: tuple[float, float] = (0.0, 0.0)

    @property
    def length_mm(self) -> float:
        """Return the length of the move, in mm."""
        return sum(math.dist(a, b) for a, b in pairwise(self.points))

    @property
    def duration_s(self) -> float:
        """Return the duration of the move at its speed in seconds, or 0 without a speed."""
        return self.length_mm / self.speed_mm_s if self.speed_mm_s else 0.0


MachineXZ = tuple[float, float]
"""X and Z offset from block coordinates to part zero, in mm."""


_ON_AXIS = 0.05  # mm


class LiveToolStep(NamedTuple):
    """A block that moves with C engaged or in a plane of the virtual mill, with its part zero."""

    block: Block
    part_zero: MachineXZ


ProgramStep = TipMove | LiveToolStep | Block
"""Step of a program that the part sees: a tip move of X and Z, a live tool move, or a block without
motion.
"""


class StepConverter:
    """Converter of program blocks to simulation steps; pass the blocks in program order.

    A G92 before the first move of a tool specifies the position of part zero. A later G92 shifts the part,
    like G10.

    ``tip_positions`` are the true positions at which tips are at part zero, as machine X and Z in mm, by T
    number or by G54 to G59. If the active offsets differ from them, the tool is displaced from its
    programmed position.
    """

    def __init__(self, tip_positions: Mapping[int, MachineXZ] | None = None) -> None:
        self._tips = tip_positions or {}
        self._zero = (0.0, 0.0)  # presets that only specify part zero: X, Z
        self._moved = False

    def convert_blocks(self, blocks: Sequence[Block]) -> Iterator[ProgramStep]:
        """Yield the steps of the next blocks."""
        if isinstance(blocks, StraightMoveSeries):
            self._moved = True
            if not blocks.pattern.modal.c_locked:
                yield from self._of_series(blocks)
                return
        for block in blocks:
            if block.action is not None:
                self._act(block)
                yield block
            elif (
                block.kind in _TURNED
                and block.travel is None
                and (not block.modal.c_locked or is_rigid_tap(block))
            ):
                self._moved = True
                place = self._part_zero(block)
                yield _move(block, block.n, block.line, tuple(_points(block, *place)), place)
            elif block.travel is None:
                yield LiveToolStep(block, self._part_zero(block))

    def _act(self, block: Block) -> None:
        modal = block.modal
        if isinstance(block.action, ToolChange):
            self._moved = False
            self._zero = (0.0, 0.0) if modal.preset_x == modal.preset_z == 0.0 else self._zero
        elif isinstance(block.action, Preset) and not self._moved:
            self._zero = modal.preset_x, modal.preset_z

    def _part_zero(self, block: Block) -> MachineXZ:
        """Return the sum of the work shift, the preset and the zero offset.

        Presets that only specify part zero are not included.
        """
        modal = block.modal
        x, z = self._tips.get(modal.tool, (modal.tool_offset_x, modal.tool_offset_z))
        if modal.settable:
            zero_x, zero_z = self._tips.get(modal.settable, (modal.zero_offset_x, modal.zero_offset_z))
            x, z = x + zero_x, z + zero_z
        return block.offset_x - x - self._zero[0], block.offset_z - z - self._zero[1]

    def _of_series(self, series: StraightMoveSeries) -> Iterator[TipMove]:
        like = series.pattern
        dx, dz = self._part_zero(like)
        columns = (series.n, series.line, series.x0 + dx, series.z0 + dz, series.x + dx, series.z + dz)
        rows = zip(*(column.tolist() for column in columns), strict=True)
        for (n, line, x0, z0, x, z), (modal, feed) in zip(rows, series.feeds(), strict=False):
            if feed != like.feed:
                like = replace(like, modal=modal, feed=feed)
            yield _move(like, n, line, ((z0, x0), (z, x)), (dx, dz))


def find_part_zero(block: Block, part_shift: MachineXZ) -> MachineXZ:
    """Return the machine X and Z at which the tip is at part zero."""
    return block.offset_x - part_shift[0], block.offset_z - part_shift[1]


def find_step_end_points(step: LiveToolStep) -> tuple[Point, Point]:
    """Return the start and the end of a live tool's block, as positions of the axes in the part's frame."""
    (dx, dz), block = step.part_zero, step.block
    return (block.z0 + dz, block.x0 + dx), (block.z + dz, block.x + dx)


def find_axis_position(step: LiveToolStep, fraction: float) -> Point:
    """Return the position of the axes after a fraction of a live tool's block."""
    plane = step.block.plane
    if plane is not None:
        x, z, _ = plane.compute_machine_positions(np.array([fraction]))[0].tolist()
        return z + step.part_zero[1] + step.block.modal.secondary_offset_z, x
    start, end = find_step_end_points(step)
    return start[0] + (end[0] - start[0]) * fraction, start[1] + (end[1] - start[1]) * fraction


def make_live_tool_move(step: LiveToolStep) -> TipMove:
    """Return the move of the axes during a block of a live tool, for drawing."""
    pieces = _MOVE_PIECES if step.block.plane is not None else 1
    points = tuple(find_axis_position(step, k / pieces) for k in range(pieces + 1))
    return _move(step.block, step.block.n, step.block.line, points, step.part_zero)


def is_rigid_tap(block: Block) -> bool:
    """Return whether the block is a rigid tap.

    In a rigid tap, the C axis turns the spindle in proportion to a move along Z at the centerline.
    """
    turned = block.kind is BlockKind.FEED and block.c != block.c0 and block.z != block.z0
    return turned and block.modal.c_locked and block.x == block.x0 and abs(block.x) < _ON_AXIS


def _move(block: Block, n: int, line: int, points: tuple[Point, ...], place: MachineXZ) -> TipMove:
    per_rev, rpm = (block.feed if block.per_rev and not block.rapid else 0.0), block.rpm
    speed = per_rev * abs(rpm) / 60.0 if per_rev else block.feed
    if is_rigid_tap(block):
        per_rev = abs((block.z - block.z0) / (block.c - block.c0)) * 360.0
        rpm = math.copysign(speed / per_rev * 60.0, block.c - block.c0)
    quick = block.rapid or (
        not per_rev and block.feed >= FAST_FEED_MM_S and block.kind is not BlockKind.THREAD
    )
    return TipMove(
        n, line, block.kind, points, speed, quick, per_rev, rpm, block.modal, find_part_zero(block, place)
    )


def _points(block: Block, dx: float, dz: float) -> Iterator[Point]:
    yield block.z0 + dz, block.x0 + dx
    if block.kind is BlockKind.ARC:
        start, sweep = compute_arc_sweep(
            block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise
        )
        radius = math.hypot(block.x0 - block.cx, block.z0 - block.cz)
        step = 2.0 * math.acos(max(1.0 - _CHORD / radius, 0.0)) if radius > 0.0 else math.pi
        pieces = max(math.ceil(abs(sweep) / step), 1)
        for k in range(1, pieces):
            at = start + sweep * k / pieces
            yield block.cz + dz + radius * math.cos(at), block.cx + dx + radius * math.sin(at)
    yield block.z + dz, block.x + dx
