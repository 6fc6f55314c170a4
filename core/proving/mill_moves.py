"""The moves of a live tool as the part sees them: blocks of plane switching, and moves with C held."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.interpreter.elementary_blocks import Block
from core.part.mill_paths import axial_path, locked_path, plane_path, radial_path
from core.part.ray_cuts import FloatArray
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.tip_moves import QUICK, Place

_CONES = frozenset({ToolKind.DRILL, ToolKind.CENTRE_DRILL})


class MillMove(NamedTuple):
    """One elementary block of a live tool: its path (n, 3) as ``MilledPart`` takes it, along Z or across."""

    n: int
    line: int
    path: FloatArray
    axial: bool
    quick: bool


def mill_move(block: Block, place: Place, shape: ToolShape) -> MillMove | None:
    """The block's path in the part's frame, to which ``place`` leads from X and Z; None without a move."""
    turns_only = (block.x, block.z) == (block.x0, block.z0)  # its feed is in degrees
    quick = block.rapid or (not block.per_rev and not turns_only and block.feed >= QUICK)
    dx, dz = place
    if block.plane is not None:
        lift = dz + block.modal.secondary_z
        axial = not block.plane.on_side
        return MillMove(block.n, block.line, plane_path(block.plane, lift), axial, quick)
    ends = np.array(
        [[block.x0 + dx, block.z0 + dz, block.c0], [block.x + dx, block.z + dz, block.c]], dtype=np.float64
    )
    if np.array_equal(ends[0], ends[1]):
        return None
    axial = shape.direction[0] != 0
    if axial:
        return MillMove(block.n, block.line, axial_path(locked_path(ends[0], ends[1])), True, quick)
    far_side = float(ends[:, 0].mean()) > 0.0
    return MillMove(block.n, block.line, radial_path(ends, far_side=far_side), False, quick)


def between(path: FloatArray, first: float, last: float) -> FloatArray:
    """The piece of a path from one share of it to another, 0 … 1."""
    at = np.linspace(0.0, 1.0, len(path))
    shares = np.concatenate(([first], at[(at > first) & (at < last)], [last]))
    return np.column_stack([np.interp(shares, at, figures) for figures in path.T])


def cone_height(shape: ToolShape) -> float:
    """How high the point of a live drill is, mm; 0 of a mill."""
    if shape.kind not in _CONES or not shape.point:
        return 0.0
    return float(shape.diameter / 2.0 / np.tan(np.radians(shape.point / 2.0)))
