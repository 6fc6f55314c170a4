"""The finished part of a program, as shown in the thumbnail picture.

The finished part is the material in the chuck just before the last piece is parted off. If no piece is
parted off, it is the material at the end or before the collet opens, whichever has the smaller volume.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from core.interpreter.shared.actions import ColletSwitch
from core.part.picture.surface_points import Solid
from core.proving.part_history import PartHistory, ProgramSteps, ReportProgress
from core.proving.part_instant import PartState, SectionHalf
from core.proving.tip_moves import LiveToolStep, TipMove


class FinishedPart(NamedTuple):
    """The finished part with the dimensions of its stock, in mm.

    ``back_z_mm`` and ``front_z_mm`` are the ends of the stock in Z, and ``radius_mm`` is the radius of the
    stock.
    """

    solid: Solid
    back_z_mm: float
    front_z_mm: float
    radius_mm: float


def make_finished_part(steps: ProgramSteps, report_progress: ReportProgress) -> FinishedPart | None:
    """Return the finished part, or None if nothing is cut.

    ``report_progress`` receives the block number regularly and may raise to cancel.
    """
    history = PartHistory(steps)

    def make_part_at_block(block: int) -> PartState:
        return history.at(block, 0.0, lambda: report_progress(block))

    pieces = make_part_at_block(history.last_block_number).parted_piece_count
    ends = [history.last_block_number, *_find_block_before_opening(history)]
    if pieces:
        ends = [_find_block_before_last_piece(make_part_at_block, history.last_block_number, pieces)]
    held = [
        (volume, end)
        for end in ends
        if (volume := _section_volume(make_part_at_block(end).x_plus_half)) > 0.0
    ]
    stock = history.stock
    if not held or stock is None:
        return None
    solid = history.make_solid(make_part_at_block(min(held)[1]))
    return (
        FinishedPart(solid, stock.back_z_mm, stock.front_z_mm, stock.max_radius_mm)
        if solid is not None
        else None
    )


def _find_block_before_opening(history: PartHistory) -> list[int]:
    """Return the number of the block before the last opening of the collet, as a list.

    The list is empty if the collet does not open.
    """
    for step in reversed(history.steps):
        if not isinstance(step, TipMove | LiveToolStep) and step.action == ColletSwitch(closed=False):
            return [max(step.n - 1, 0)]
    return []


def _find_block_before_last_piece(at: Callable[[int], PartState], last: int, pieces: int) -> int:
    """Return the last block before the last piece is parted off.

    A binary search is possible, because the number of pieces never decreases.
    """
    before, upper = 0, last
    while upper - before > 1:
        middle = (before + upper) // 2
        before, upper = (middle, upper) if at(middle).parted_piece_count < pieces else (before, middle)
    return before


def _section_volume(half: SectionHalf | None) -> float:
    """Return the volume in mm³ of the body that results from rotating the section about the axis."""
    if half is None:
        return 0.0
    wide = half.column_edges[1:] - half.column_edges[:-1]
    rings = (half.outer_radii**2 - half.inner_radii**2).clip(min=0.0)
    return float(math.pi * (rings * wide).sum())
