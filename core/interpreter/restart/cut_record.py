"""Record of all moves and cuts of a program, which is used to check paths through the part.

The record has one row for each straight segment of each move, in the order of execution. Arcs are recorded
as chords. ``x0``, ``z0``, ``x`` and ``z`` are tip positions relative to part zero (machine position minus
tool offset) in mm, with X as a signed radius. This frame moves with the part and does not depend on G10,
G92 and D.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import cos, hypot, inf, nan, pi, sin, sqrt

import numpy as np
import numpy.typing as npt

from core.geometry.lines_and_arcs import compute_arc_sweep
from core.geometry.virtual_mill import SidePlane
from core.interpreter.shared.actions import ColletSwitch
from core.interpreter.shared.elementary_blocks import Block, BlockKind, StraightMoveSeries

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]

FEED, THREAD, STILL, FACE, SIDE, PER_REV, REVERSE = 1, 2, 4, 8, 16, 32, 64
"""Bits of ``move_kinds``.

They mean feed move, thread, stationary C axis, face milling, side milling, feed per revolution, and spindle
direction M04. A rapid has no bit set.
"""

SAME_POINT_MM = 1e-5  # mm
_TOLERANCE_MM = 0.05  # mm
_CENTERLINE_TOLERANCE_MM = 0.05  # mm of radius
_CHORD = 0.004  # mm; permitted distance of a chord from its arc
_PROGRESS_INTERVAL = 2000  # number of blocks between two calls of ``report_progress``


@dataclass(frozen=True, slots=True, eq=False)
class CutRecord:
    """All moves of a program as arrays (m,), one row per segment, and the limits of the material.

    - ``block_number``: number of the elementary block.
    - ``bar_sections``: how often the collet was opened; earlier cuts are on another section of the bar.
    - ``max_feed_radius``: largest radius of a feed move, or 0 if no feed move exists.
    - ``retract_radius``: radius at which tools retract at rapid, or inf if it is unknown, because
      the largest cut may be a bore.
    - ``face_z``: Z past all cuts at which rapids move inside that radius, or inf if it is unknown.
    - ``machine_x_range_by_tool``: minimum and maximum machine X of each tool.
    - ``max_machine_z``: maximum machine Z of all moves.
    """

    block_numbers: IntArray
    line_numbers: IntArray
    start_x: FloatArray
    start_z: FloatArray
    end_x: FloatArray
    end_z: FloatArray
    move_kinds: IntArray
    tool_numbers: IntArray
    bar_sections: IntArray
    tool_offsets: dict[int, tuple[float, float]]  # by tool: machine position minus tip position, mm
    max_feed_radius: float
    max_cut_start_z: float  # the maximum Z at which a cut begins
    retract_radius: float
    face_z: float
    face_z_by_tool: dict[int, float]  # by tool, if its moves show a face
    machine_x_range_by_tool: dict[int, tuple[float, float]]
    max_machine_z: float
    block_count: int

    def __len__(self) -> int:
        return len(self.block_numbers)

    def find_last_row(self, block_number: int) -> int:
        """Return the last row of this block or of an earlier block, or -1 if no axis has moved."""
        return int(np.searchsorted(self.block_numbers, block_number, side="right")) - 1

    def find_first_row(self, row: int) -> int:
        """Return the first row of the block to which a row belongs."""
        return int(np.searchsorted(self.block_numbers, self.block_numbers[row], side="left"))

    def get_end_points(self, row: int) -> tuple[float, float, float, float]:
        """Return the start and end points of a row as (x0, z0, x, z)."""
        return (
            float(self.start_x[row]),
            float(self.start_z[row]),
            float(self.end_x[row]),
            float(self.end_z[row]),
        )

    def compute_front_z(self, tool: int) -> float:
        """Return the Z from which on the tip of this tool is in front of all material, in mm."""
        return self.face_z_by_tool.get(tool, self.face_z)

    def is_clear_after_rapid(self, x: float, z: float) -> bool:
        """Return whether a tool is clear of the part, radially or axially, where a rapid ends."""
        return abs(x) >= self.max_feed_radius - SAME_POINT_MM or z >= self.max_cut_start_z - SAME_POINT_MM

    def is_outside_material(self, x: float, z: float, tool: int) -> bool:
        """Return whether the tip of this tool is outside the material, radially or in front of the face."""
        return (
            not self.max_feed_radius
            or abs(x) >= self.retract_radius - SAME_POINT_MM
            or z >= self.compute_front_z(tool) - SAME_POINT_MM
        )


class _Rows:
    """Collector of the rows of a cut record.

    The rows are collected in tables (9, m) with one column for each straight segment. Each column contains
    the block number, line, x0, z0, x, z, move kind, tool and bar section.
    """

    def __init__(self) -> None:
        self.offsets: dict[int, tuple[float, float]] = {}
        self._fed: dict[int, tuple[float, float]] = {}
        self._tables = [np.zeros((9, 0))]
        self._pieces: list[tuple[float, ...]] = []  # rows of blocks that are not in a table yet
        self._opened = 0

    def add_block(self, block: Block) -> None:
        """Add the rows of one block, with arcs as chords."""
        if not block.moves:
            self._opened += isinstance(block.action, ColletSwitch)
            return
        if block.kind in {BlockKind.ROTATE, BlockKind.DWELL}:
            return
        dx, dz = self._frame(block)
        x, z = block.x0 + dx, block.z0 + dz
        same = (_how(block), block.modal.tool, self._opened)
        for to_x, to_z in _points(block):
            self._pieces.append((block.n, block.line, x, z, to_x + dx, to_z + dz, *same))
            x, z = to_x + dx, to_z + dz
        if len(self._pieces) >= _PROGRESS_INTERVAL:
            self._finish_pieces()

    def add_series(self, series: StraightMoveSeries) -> None:
        """Add the rows of a series of straight moves."""
        self._finish_pieces()
        like, ends = series.pattern, (series.x0, series.z0, series.x, series.z)
        dx, dz = self._frame(like)
        places = (column + off for column, off in zip(ends, (dx, dz, dx, dz), strict=True))
        same = (np.full(len(series), each) for each in (_how(like), like.modal.tool, self._opened))
        self._tables.append(np.array([series.n, series.line, *places, *same], dtype=np.float64))

    def make_table(self) -> FloatArray:
        """Return all rows as one table."""
        self._finish_pieces()
        return np.concatenate(self._tables, axis=1)

    def _frame(self, block: Block) -> tuple[float, float]:
        """Return the shift from the program frame to tip positions relative to part zero, in mm."""
        modal = block.modal
        base = modal.drawing_zero_x, modal.drawing_zero_z
        if block.kind is BlockKind.RAPID:
            self.offsets.setdefault(modal.tool, base)
        elif self._fed.setdefault(modal.tool, base) == base:
            self.offsets[modal.tool] = base
        else:  # The tool cuts with two offsets, and the one that applies to the present position is unknown.
            self.offsets[modal.tool] = nan, nan
        return block.offset_x - base[0], block.offset_z - base[1]

    def _finish_pieces(self) -> None:
        if self._pieces:
            self._tables.append(np.array(self._pieces, dtype=np.float64).T)
            self._pieces = []


def record_all_cuts(
    blocks: Iterable[Block | StraightMoveSeries], report_progress: Callable[[float], None]
) -> CutRecord:
    """Record the moves of all blocks.

    ``report_progress`` is called with the number of blocks and may raise an exception to cancel the
    recording.
    """
    rows, count = _Rows(), 0
    for each in blocks:
        if isinstance(each, StraightMoveSeries):
            rows.add_series(each)
            count = int(each.n[-1])
            report_progress(count)
            continue
        rows.add_block(each)
        count = each.n
        if count % _PROGRESS_INTERVAL == 0:
            report_progress(count)
    return _record(rows, count)


def _record(rows: _Rows, blocks: int) -> CutRecord:
    table = rows.make_table()
    n, line, how, tool, bar = table[[0, 1, 6, 7, 8]].astype(np.int64)
    x0, z0, x, z = table[2:6]
    _forget_start(x0, z0, x, z)
    feeds = (how & FEED) != 0
    radius = _greatest(np.abs(np.concatenate((x0[feeds], x[feeds]))), 0.0)
    radius = max(radius, _CENTERLINE_TOLERANCE_MM) if feeds.any() else 0.0
    faces = _faces(feeds, x0, x, z, tool, radius)
    farthest = _farthest(feeds, z0, z, tool)
    clear, reach = -inf, {}
    for each, (off_x, off_z) in rows.offsets.items():
        own = tool == each
        reach[each] = -_greatest(-x[own], inf) + off_x, _greatest(x[own], -inf) + off_x
        clear = max(clear, _greatest(z[own], -inf) + off_z)
    return CutRecord(
        n,
        line,
        x0,
        z0,
        x,
        z,
        how,
        tool,
        bar,
        rows.offsets,
        radius,
        _greatest(np.concatenate((z0[feeds], z[feeds])), -inf),
        _retract_radius(feeds, x0, z0, x, z, radius),
        min(faces.values(), default=inf),
        {**farthest, **faces},
        reach,
        clear,
        blocks,
    )


def _faces(
    feeds: BoolArray, x0: FloatArray, x: FloatArray, z: FloatArray, tool: IntArray, radius: float
) -> dict[int, float]:
    """Return, by tool, the smallest Z at which a rapid along X passes in front of all cuts.

    Only rapids that end inside the radius of the cuts are considered. The comparison uses the ends of the
    cuts, because the start of a cut may be in air.
    """
    cut = _greatest(z[feeds], inf)
    within = max(radius - SAME_POINT_MM, _CENTERLINE_TOLERANCE_MM)
    across = ~(np.abs(x - x0) <= SAME_POINT_MM)  # the start of the first move is unknown
    called = np.concatenate(([True], tool[1:] != tool[:-1])) if len(tool) else across
    before = (z > cut + SAME_POINT_MM) | (called & (z >= cut - SAME_POINT_MM))
    known = ~feeds & across & before & (np.abs(x) < within)
    return {int(each): float(z[known & (tool == each)].min()) for each in np.unique(tool[known])}


def _farthest(feeds: BoolArray, z0: FloatArray, z: FloatArray, tool: IntArray) -> dict[int, float]:
    """Return for each tool the maximum Z of its rapids, if all cuts start at a smaller Z."""
    cut = _greatest(np.concatenate((z0[feeds], z[feeds])), -inf)
    rapid_z_by_tool = {int(each): _greatest(z[~feeds & (tool == each)], -inf) for each in np.unique(tool)}
    return {each: far for each, far in rapid_z_by_tool.items() if far > cut + SAME_POINT_MM}


def _retract_radius(
    feeds: BoolArray, x0: FloatArray, z0: FloatArray, x: FloatArray, z: FloatArray, radius: float
) -> float:
    """Return the minimum radius outside all cuts to which the tools retract at rapid between cuts.

    A boring bar retracts toward the center, so its rapids end at a smaller radius than its cuts.
    """
    reached = feeds & ((np.abs(z - z0) > SAME_POINT_MM) | (np.abs(x) >= np.abs(x0)))
    cut = _greatest(np.abs(np.concatenate((x[feeds], x0[reached], x[reached]))), 0.0)
    deep = z <= _greatest(z[feeds], -inf)
    out = ~feeds & deep & (np.abs(z - z0) <= SAME_POINT_MM) & (np.abs(x) > np.abs(x0) + SAME_POINT_MM)
    levels = np.abs(x[out])
    levels = levels[(levels > cut + _TOLERANCE_MM) & (levels >= radius - SAME_POINT_MM)]
    return float(levels.min()) if len(levels) else inf


def _forget_start(x0: FloatArray, z0: FloatArray, x: FloatArray, z: FloatArray) -> None:
    """Set the start positions of an axis to NaN until its first move, because they are unknown."""
    for start, end in ((x0, x), (z0, z)):
        if len(start):
            moved = np.flatnonzero(np.abs(end - start) > SAME_POINT_MM)
            first = int(moved[0]) if len(moved) else len(start)
            start[: first + 1], end[:first] = np.nan, np.nan


def _greatest(values: FloatArray, none: float) -> float:
    known = values[~np.isnan(values)]
    return float(known.max()) if len(known) else none


def _how(block: Block) -> int:
    if block.kind is BlockKind.RAPID:
        return 0
    how = FEED
    if block.kind is BlockKind.THREAD:
        how |= THREAD
    if block.modal.c_locked:
        how |= STILL
    if block.plane is not None:
        how |= SIDE if isinstance(block.plane.frame, SidePlane) else FACE
    if block.per_rev:
        how |= PER_REV
    if block.rpm < 0.0:
        how |= REVERSE
    return how


def _points(block: Block) -> list[tuple[float, float]]:
    """Return the end points of the straight segments of a block."""
    if block.kind is not BlockKind.ARC:
        return [(block.x, block.z)]
    cx, cz = block.cx, block.cz
    radius = hypot(block.x0 - cx, block.z0 - cz)
    start, sweep = compute_arc_sweep(
        block.x0, block.z0, block.x, block.z, cx, cz, is_clockwise=block.clockwise
    )
    count = max(1, min(720, round(abs(sweep) / _step(radius)) + 1))
    angles = [start + sweep * k / count for k in range(1, count)]
    return [*((cx + radius * sin(a), cz + radius * cos(a)) for a in angles), (block.x, block.z)]


def _step(radius: float) -> float:
    """Return the angle in radians of the longest chord that is within tolerance of an arc."""
    share = min(1.0, _CHORD / radius) if radius > 0.0 else 1.0
    return min(pi / 2, 2.0 * sqrt(2.0 * share))
