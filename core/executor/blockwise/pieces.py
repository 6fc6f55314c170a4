"""Elementary blocks as a controller that plans by itself gets them: pieces of a fraction of a second.

What has been handed over runs to its end whatever becomes of the host. So a long block goes out in pieces
on its own line or circle, between which the controller does not slow down.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from core.block_port import ArcOp, BlockOp, LineOp, RapidOp, ThreadOp
from core.executor.alarms import TroubleError
from core.executor.feed import nominal
from core.geometry.extent import arc_sweep
from core.geometry.spindle import surface_rpm
from core.interpreter.elementary_blocks import Block, Kind

LONGEST = 0.2  # s of a piece at its programmed speed
_SHORTEST = 0.05  # mm; a slow feed is not cut up finer
_WIDEST = 3.0  # radians


class Piece(NamedTuple):
    """One thing for the controller, the block that it is part of, and seconds that it takes at least."""

    op: BlockOp
    block: Block
    seconds: float


class Turning(NamedTuple):
    """What feeds per revolution go by: spindle speed over programmed speed, and the highest rpm allowed."""

    scale: float
    highest: float


def pieces_of(block: Block, turning: Turning, fastest: float = math.inf) -> Iterator[Piece]:
    """The pieces of one moving block, none faster than ``fastest`` mm/s.

    Raises TroubleError for what has no speed or is not X and Z alone.
    """
    if block.travel is not None or block.plane is not None or block.c != block.c0:
        raise TroubleError("program", "this controller moves X and Z only", block.line)
    seconds = max(nominal(block), _way(block) / fastest)
    if block.kind is Kind.THREAD:
        start = block.x0 + block.offset_x, block.z0 + block.offset_z
        yield Piece(ThreadOp(*start, block.mx, block.mz, block.feed), block, seconds)
        return
    n = _cuts(block, seconds)
    for i in range(n):
        yield Piece(_op(block, i / n, (i + 1) / n, turning), block, seconds / n)


def _cuts(block: Block, seconds: float) -> int:
    """An arc in parts of less than half a turn: the controller has ends and centre only, which do not tell a
    whole turn from none.
    """
    least = math.ceil(abs(_sweep(block)[1]) / _WIDEST) if block.kind is Kind.ARC else 1
    return max(least, min(math.ceil(seconds / LONGEST - 1e-9), math.ceil(_way(block) / _SHORTEST)))


def _way(block: Block) -> float:
    if block.kind is Kind.ARC:
        return math.hypot(block.x0 - block.cx, block.z0 - block.cz) * abs(_sweep(block)[1])
    return math.hypot(block.x - block.x0, block.z - block.z0)


def _op(block: Block, begin: float, end: float, turning: Turning) -> BlockOp:
    """The part of a block between two fractions of its way."""
    if block.kind is Kind.ARC:
        return _arc(block, begin, end, turning)
    x, z = _on_line(block, end)
    if block.kind is Kind.RAPID:
        return RapidOp(x, z, block.feed)
    return LineOp(x, z, _feed(block, x - block.offset_x, turning))


def _on_line(block: Block, part: float) -> tuple[float, float]:
    if part == 1.0:
        return block.mx, block.mz
    x = block.x0 + part * (block.x - block.x0)
    z = block.z0 + part * (block.z - block.z0)
    return x + block.offset_x, z + block.offset_z


def _arc(block: Block, begin: float, end: float, turning: Turning) -> ArcOp:
    (x0, z0), (x, z) = _on_circle(block, begin), _on_circle(block, end)
    cx, cz = block.cx + block.offset_x, block.cz + block.offset_z
    return ArcOp(x0, z0, x, z, cx, cz, block.clockwise, _feed(block, x - block.offset_x, turning))


def _on_circle(block: Block, part: float) -> tuple[float, float]:
    """Exact at both ends, where the radii may differ by a rounding of the program."""
    if part == 0.0:
        return block.x0 + block.offset_x, block.z0 + block.offset_z
    if part == 1.0:
        return block.mx, block.mz
    start, sweep = _sweep(block)
    first = math.hypot(block.x0 - block.cx, block.z0 - block.cz)
    last = math.hypot(block.x - block.cx, block.z - block.cz)
    radius, angle = first + part * (last - first), start + part * sweep
    x, z = block.cx + radius * math.sin(angle), block.cz + radius * math.cos(angle)
    return x + block.offset_x, z + block.offset_z


def _sweep(block: Block) -> tuple[float, float]:
    return arc_sweep(block.x0, block.z0, block.x, block.z, block.cx, block.cz, block.clockwise)


def _feed(block: Block, x: float, turning: Turning) -> float:
    """mm/s. A feed per revolution follows the spindle's command, as it does with setpoints."""
    feed = block.feed
    if block.per_rev:
        rpm = abs(block.rpm)
        if block.css is not None:
            modal = block.modal
            rpm = surface_rpm(block.css, x, modal.css_min, modal.css_max or turning.highest)
        feed *= min(rpm, turning.highest) * turning.scale / 60.0
    if feed <= 0.0:
        raise TroubleError("program", f"line {block.line} has no feed", block.line)
    return feed
