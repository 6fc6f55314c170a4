"""The finished part of a program, as a solid for a picture: what the chuck holds when it is done.

That is just before the last piece is parted off; where nothing is, at the end or before the collet opens for
the next one, whichever has less metal left.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from core.interpreter.actions import Collet
from core.part.surface_points import Solid
from core.proving.part_history import PartHistory, PartMoves
from core.proving.part_instant import Half, PartInstant
from core.proving.tip_moves import LiveStep, TipMove

Watch = Callable[[float], None]


class FinishedPart(NamedTuple):
    """``back`` and ``front`` are the ends of its stock along Z, ``radius`` that of the stock; mm."""

    solid: Solid
    back: float
    front: float
    radius: float


def finished_part(moves: PartMoves, watch: Watch) -> FinishedPart | None:
    """None where nothing is cut. ``watch`` is told now and then, and may raise to give up."""
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
    """The block before the collet opens for the last time."""
    for step in reversed(history.steps):
        if not isinstance(step, TipMove | LiveStep) and step.action == Collet(closed=False):
            return [max(step.n - 1, 0)]
    return []


def _before_last_piece(at: Callable[[int], PartInstant], last: int, pieces: int) -> int:
    """The last block before the last piece has come off; there are never fewer of them later."""
    before, behind = 0, last
    while behind - before > 1:
        middle = (before + behind) // 2
        before, behind = (middle, behind) if at(middle).pieces < pieces else (before, middle)
    return before


def _volume(half: Half | None) -> float:
    """Of the section, turned about the axis, mm³."""
    if half is None:
        return 0.0
    wide = half.edges[1:] - half.edges[:-1]
    rings = (half.high**2 - half.low**2).clip(min=0.0)
    return float(math.pi * (rings * wide).sum())
