"""Arcs and the ways of a mill as chords that nobody can tell from them on a screen."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from core.geometry.virtual_mill import PlaneMove, Spot

CHORD_ERROR = 0.004  # mm: half a pixel at 125 pixels to the millimetre
TURN_STEP = 4.0  # degrees of C from point to point where the slides go along with it
MOST = 720  # points of one turning way


def arc_pieces(radius: float, sweep: float) -> int:
    """Into how many chords an arc falls so that none leaves it by more than CHORD_ERROR."""
    if radius <= CHORD_ERROR:
        return 4
    step = 2 * math.acos(1 - CHORD_ERROR / radius)
    return max(1, math.ceil(abs(sweep) / step))


def turn_pieces(degrees: float) -> int:
    """Into how many chords a way falls along which C turns so far."""
    return max(1, min(MOST, math.ceil(abs(degrees) / TURN_STEP)))


def mill_way(move: PlaneMove, degrees: float) -> list[Spot]:
    """Points of the mill's way in its own frame from behind the start to the end; ``degrees`` is C's turn."""
    if move.centre is None:
        pieces = turn_pieces(degrees)
        (x0, y0, z0), (x1, y1, z1) = move.start, move.end
        shares = [k / pieces for k in range(1, pieces)]
        return [*((x0 + (x1 - x0) * s, y0 + (y1 - y0) * s, z0 + (z1 - z0) * s) for s in shares), move.end]
    radius = move.radius
    sweep = move.length / radius if radius else 0.0
    pieces = max(turn_pieces(degrees), arc_pieces(radius, sweep))
    return [(x, y, z) for x, y, z in move.points(np.linspace(0.0, 1.0, pieces + 1)[1:]).tolist()]
