"""Programmed speeds: as given, per revolution of the spindle, or by the radius under surface speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from core.message import Message
from core.motion.axis_limits import BoolArray, FloatArray, MotionError
from core.motion.block_table import BlockTable
from core.motion.path_pieces import Pieces

RPM_STEP = 1.02  # the spindle speed changes by no more than this factor within a piece
ARC_SAMPLES = 65  # points at which an arc's radius is read for the split


def constant_rates(table: BlockTable) -> FloatArray:
    """Speed (m,) of each block in mm/s, that of surface-speed blocks at the middle of their radii.

    Raises MotionError for a feed that is not positive and for a feed per revolution with the spindle still.
    """
    _refuse(table, ~(table.feed > 0.0), "the feed must be greater than 0; program an F word", "no-feed")
    surface = by_radius(table)
    middle = 0.5 * (table.start[:, 0] + table.end[:, 0]) - table.axis
    rpm = np.where(surface, surface_rpms(table, middle), table.rpm)
    _refuse(
        table,
        table.per_rev & ~(rpm > 0.0),
        "the feed is per revolution, but the spindle is stopped; start the spindle first",
        "spindle-stopped",
    )
    on_axis = (table.start[:, 0] - table.axis) * (table.end[:, 0] - table.axis) <= 0.0
    endless = surface & on_axis & np.isinf(table.hi)
    _refuse(
        table,
        endless,
        "the spindle speed has no upper limit at the spindle centerline; program a "
        "speed limit, or set rpm_max",
        "no-speed-limit",
    )
    rate = np.where(table.per_rev, table.feed * rpm / 60.0, table.feed)
    return rate * _per_lead(table) if table.thread.any() else rate


def _per_lead(table: BlockTable) -> FloatArray:
    """Way (m,) per way along Z, 1 save in threads: a lead counts along the axis of the thread."""
    _refuse(
        table,
        table.thread & (table.start[:, 1] == table.end[:, 1]),
        "the thread does not advance along Z",
        "no-lead",
    )
    way = np.hypot(table.end[:, 0] - table.start[:, 0], table.end[:, 1] - table.start[:, 1])
    along = np.where(table.thread, np.abs(table.end[:, 1] - table.start[:, 1]), 1.0)
    return np.where(table.thread, way / along, 1.0)


def by_radius(table: BlockTable) -> BoolArray:
    """Blocks (m,) whose speed follows the radius."""
    return table.per_rev & np.isfinite(table.surface)


def surface_rpms(table: BlockTable, radius: FloatArray) -> FloatArray:
    """``surface_rpm`` of ``core.geometry`` for arrays; NaN without a surface speed, or by 0 on the axis."""
    with np.errstate(divide="ignore", invalid="ignore"):
        rpm = 60.0 * table.surface / (2.0 * np.pi * np.abs(radius))
    return np.clip(rpm, table.lo, table.hi)


def _refuse(table: BlockTable, wrong: BoolArray, why: str, code: str) -> None:
    if wrong.any():
        raise MotionError(
            Message("Block {number}: {why}.", number=f"{table.n[wrong.argmax()]:.0f}", why=why), code
        )


def split_by_radius(pieces: Pieces, table: BlockTable, index: int) -> Pieces:
    """Piece ``index`` in parts within which the rpm changes by 2 % at most, each with the rate at its middle.

    On a line across the axis the time of a part is then exact, since 1/v grows linearly with the radius.
    Where the rpm is clamped nothing is split; the parts are bounded by ln(max/min rpm)/ln 1.02 per pass.
    """
    piece, owner = pieces[index : index + 1], _row(table, index)
    length = float(piece.length[0])
    at = _cuts(piece, owner, length)
    middle = _radii(piece, owner, 0.5 * (at[1:] + at[:-1]))
    rate = owner.feed * surface_rpms(owner, middle) / 60.0
    return cut(piece, at, rate)


def cut(piece: Pieces, at: FloatArray, rate: FloatArray) -> Pieces:
    """One piece cut at the distances ``at`` (k+1,), its ends included, with rates ``rate`` (k,)."""
    parts = piece[np.zeros(len(at) - 1, dtype=np.int64)]
    return replace(
        parts,
        start=parts.point(at[:-1]),
        angle=parts.angle + parts.curvature * at[:-1],
        length=np.diff(at),
        rate=rate,
    )


def _row(table: BlockTable, index: int) -> BlockTable:
    """The table of one block alone."""
    row = slice(index, index + 1)
    return BlockTable(*(getattr(table, name)[row] for name in table.__dataclass_fields__))


def _radii(piece: Pieces, owner: BlockTable, at: FloatArray) -> FloatArray:
    many = piece[np.zeros(len(at), dtype=np.int64)]
    radii: FloatArray = np.abs(many.point(at)[:, 0] - owner.axis[0])
    return radii


def _cuts(piece: Pieces, owner: BlockTable, length: float) -> FloatArray:
    """Distances at which the radius passes a level of the geometric ladder between both clamps."""
    if piece.curvature[0] == 0.0:
        x0, x1 = owner.start[0, 0] - owner.axis[0], owner.end[0, 0] - owner.axis[0]
        crossing = [length * x0 / (x0 - x1)] if x0 * x1 < 0.0 else []
        grid = np.array([0.0, *crossing, length])
    else:
        grid = np.linspace(0.0, length, ARC_SAMPLES)
    radii = _radii(piece, owner, grid)
    pairs = zip(grid[:-1], grid[1:], radii[:-1], radii[1:], strict=True)
    cuts = np.unique(np.concatenate([_passed(owner, *pair) for pair in pairs]))
    inside = cuts[(cuts > 1e-9 * length) & (cuts < length * (1.0 - 1e-9))]
    return np.concatenate([[0.0], inside, [length]])


def _passed(owner: BlockTable, s0: float, s1: float, r0: float, r1: float) -> FloatArray:
    """Distances between s0 and s1, the radius running straight from r0 to r1, at which levels are passed."""
    unclamped = 60.0 * owner.surface[0] / (2.0 * np.pi)  # rpm times radius
    low, high = min(r0, r1), max(r0, r1)
    bottom = max(low, unclamped / owner.hi[0])
    top = min(high, unclamped / owner.lo[0]) if owner.lo[0] > 0.0 else high
    if not bottom < top or bottom == 0.0:
        return np.empty(0)
    steps = int(np.ceil(np.log(top / bottom) / np.log(RPM_STEP)))
    levels = bottom * (top / bottom) ** (np.arange(steps + 1) / steps)
    fraction = (levels - r0) / (r1 - r0)
    return np.asarray(s0 + fraction * (s1 - s0), dtype=np.float64)
