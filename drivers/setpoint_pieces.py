"""Setpoint queue of pieces with constant acceleration that ends at rest.

The module needs only the standard library, because its user may run under another Python.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple

INF = float("inf")


class Piece(NamedTuple):
    """Motion from ``t`` for ``dt`` seconds: position, velocity and acceleration of each axis at the start."""

    t: float
    dt: float
    p: tuple[float, ...]
    v: tuple[float, ...]
    a: tuple[float, ...]


def at(piece: Piece, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return position and velocity of a piece at ``t``, limited to its start and end."""
    begins, lasts, at_p, at_v, at_a = piece
    dt = t - begins
    if not 0.0 <= dt <= lasts:  # Faster than min and max; drives call this a thousand times per second.
        dt = 0.0 if dt < 0.0 else lasts
    half = 0.5 * dt
    p = tuple([x + (v + a * half) * dt for x, v, a in zip(at_p, at_v, at_a, strict=True)])
    return p, tuple([v + a * dt for v, a in zip(at_v, at_a, strict=True)])


_TRIM = 64  # Pieces; discarding single pieces would cost more than storing them.


class PieceQueue:
    """Queue of pieces with its final rest position; not thread-safe, so the driver must lock it."""

    def __init__(self, rest: Sequence[float]) -> None:
        self._zero = (0.0,) * len(rest)
        self._pieces: list[Piece] = []
        self._starts: list[float] = []
        self._end = -INF
        self._rest = tuple(rest)

    def rest_at(self, position: Sequence[float]) -> None:
        """Discard all setpoints and rest at this position, for example after power-up or homing."""
        self._pieces, self._starts, self._end = [], [], -INF
        self._rest = tuple(position)

    def horizon(self, now: float) -> float:
        """Return the end time of the last motion, or ``now`` if the queue is empty."""
        return max(self._end, now)

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return position and velocity at ``t``; at the joint of two pieces, those of the later one."""
        if t >= self._end:
            return self._rest, self._zero
        index = bisect_right(self._starts, t) - 1
        if index < 0:
            return self._pieces[0].p, self._zero
        return at(self._pieces[index], t)

    def piece_at(self, t: float) -> tuple[Piece, float]:
        """Return the piece that is valid at ``t`` and its end time; without motion, a resting piece."""
        if t >= self._end:
            return Piece(t, INF, self._rest, self._zero, self._zero), INF
        index = bisect_right(self._starts, t) - 1
        if index < 0:
            return Piece(t, INF, self._pieces[0].p, self._zero, self._zero), self._starts[0]
        piece = self._pieces[index]
        ends = piece.t + piece.dt
        following = self._starts[index + 1] if index + 1 < len(self._starts) else self._end
        return piece, min(ends, following)

    def motion_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """Return position, velocity and acceleration at ``t``."""
        p, v = self.demand_at(t)
        index = bisect_right(self._starts, t) - 1
        return p, v, self._pieces[index].a if index >= 0 and t < self._end else self._zero

    @property
    def pieces(self) -> Sequence[Piece]:
        """The queued pieces, including those of the past that have not been trimmed."""
        return self._pieces

    def brake(self, now: float, decel: Sequence[float]) -> float:
        """Replace the queue by a straight deceleration of all axes together, and return its end time.

        It is for stops without the host (E-stop, fault). The axes leave the path only by its curvature within
        the braking distance.
        """
        return self._brake(now, self.demand_at(now), decel)

    def _brake(
        self, now: float, state: tuple[tuple[float, ...], tuple[float, ...]], decel: Sequence[float]
    ) -> float:
        p, v = state
        dt = max((abs(speed) / limit for speed, limit in zip(v, decel, strict=True)), default=0.0)
        if dt <= 0.0:
            self.rest_at(p)
            return now
        piece = Piece(now, dt, p, v, tuple(-speed / dt for speed in v))
        self.replace(now, [piece])
        return now + dt

    def trim(self, before: float) -> None:
        """Discard pieces that ended before this time."""
        gone = bisect_right(self._starts, before) - 1
        if gone >= _TRIM:
            del self._pieces[:gone], self._starts[:gone]

    def replace(self, start: float, pieces: list[Piece]) -> None:
        """Cut the queue at ``start`` and append ``pieces`` without checks; a gap before ``start`` is rest."""
        rest = at(pieces[-1], INF)[0]
        keep = bisect_right(self._starts, start - 1e-12)
        del self._pieces[keep:], self._starts[keep:]
        if self._end < start:
            pieces = [Piece(max(self._end, start - 1.0), 0.0, self._rest, self._zero, self._zero), *pieces]
        self._pieces += pieces
        self._starts += [piece.t for piece in pieces]
        self._end = pieces[-1].t + pieces[-1].dt
        self._rest = rest
