"""One piece of motion with constant acceleration, all axes together, in plain numbers for the fast path."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.ports import DriverError, Segments


class Piece(NamedTuple):
    """From ``t`` for ``dt`` seconds: position, velocity, acceleration at its start, one number an axis."""

    t: float
    dt: float
    p: tuple[float, ...]
    v: tuple[float, ...]
    a: tuple[float, ...]


def at(piece: Piece, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Position and velocity at ``t``, held at the piece's end when ``t`` lies behind it."""
    dt = min(max(t - piece.t, 0.0), piece.dt)
    p = tuple([x + (v + 0.5 * a * dt) * dt for x, v, a in zip(piece.p, piece.v, piece.a, strict=True)])
    return p, tuple([v + a * dt for v, a in zip(piece.v, piece.a, strict=True)])


def pieces_of(segments: Segments, axes: int) -> list[Piece]:
    """The segments as pieces; raises DriverError when they have the wrong shape or hold no numbers."""
    count = len(segments.t)
    shapes = {segments.p.shape, segments.v.shape, segments.a.shape}
    if count == 0 or shapes != {(count, axes)} or segments.dt.shape != (count,):
        raise DriverError(f"setpoints need one row each of t, dt, p, v, a for {axes} axes", "broken-path")
    for part in segments:
        if not np.isfinite(part).all():
            raise DriverError("setpoints hold a value that is no number", "broken-path")
    if (segments.dt < 0).any():
        raise DriverError("setpoints run backwards in time", "broken-path")
    rows = zip(
        segments.t.tolist(),
        segments.dt.tolist(),
        map(tuple, segments.p.tolist()),
        map(tuple, segments.v.tolist()),
        map(tuple, segments.a.tolist()),
        strict=True,
    )
    return [Piece(*row) for row in rows]
