"""Setpoints in pieces of constant acceleration that end at rest, in plain numbers.

Needs nothing but the standard library: what plays them may live under another Python.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple

INF = float("inf")


class Piece(NamedTuple):
    """From ``t`` for ``dt`` seconds: position, velocity, acceleration at its start, one number an axis."""

    t: float
    dt: float
    p: tuple[float, ...]
    v: tuple[float, ...]
    a: tuple[float, ...]


def at(piece: Piece, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Position and velocity at ``t``, held at the piece's end when ``t`` lies behind it."""
    begins, lasts, at_p, at_v, at_a = piece
    dt = t - begins
    if not 0.0 <= dt <= lasts:  # quicker than min and max: drives ask for this a thousand times a second
        dt = 0.0 if dt < 0.0 else lasts
    half = 0.5 * dt
    p = tuple([x + (v + a * half) * dt for x, v, a in zip(at_p, at_v, at_a, strict=True)])
    return p, tuple([v + a * dt for v, a in zip(at_v, at_a, strict=True)])


_TRIM = 64  # pieces; forgetting the past one by one would cost more than keeping it


class PieceQueue:
    """What is played, and where it comes to rest; not thread-safe, its driver locks."""

    def __init__(self, rest: Sequence[float]) -> None:
        self._zero = (0.0,) * len(rest)
        self._pieces: list[Piece] = []
        self._starts: list[float] = []
        self._end = -INF
        self._rest = tuple(rest)

    def rest_at(self, position: Sequence[float]) -> None:
        """Forget every setpoint and rest here: after power-up, homing, or a stop by the drive itself."""
        self._pieces, self._starts, self._end = [], [], -INF
        self._rest = tuple(position)

    def horizon(self, now: float) -> float:
        """End of the last motion queued; ``now`` when nothing is."""
        return max(self._end, now)

    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Position and velocity at ``t``; where two pieces meet, those of the later one."""
        if t >= self._end:
            return self._rest, self._zero
        index = bisect_right(self._starts, t) - 1
        if index < 0:
            return self._pieces[0].p, self._zero
        return at(self._pieces[index], t)

    def piece_at(self, t: float) -> tuple[Piece, float]:
        """Return the piece that is played at ``t``, and until when it is; a resting one where none is."""
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
        """Position, velocity and acceleration at ``t``."""
        p, v = self.demand_at(t)
        index = bisect_right(self._starts, t) - 1
        return p, v, self._pieces[index].a if index >= 0 and t < self._end else self._zero

    @property
    def pieces(self) -> Sequence[Piece]:
        """What is queued, with what has not been forgotten of the past."""
        return self._pieces

    def brake(self, now: float, decel: Sequence[float]) -> float:
        """The drive's own stop: from now on straight to rest, all axes together; returns when it ends.

        For stops that do not ask the host (E-stop, a fault). It leaves the path only by the curve within the
        braking distance.
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
        """Forget what was over ``before`` this time."""
        gone = bisect_right(self._starts, before) - 1
        if gone >= _TRIM:
            del self._pieces[:gone], self._starts[:gone]

    def replace(self, start: float, pieces: list[Piece]) -> None:
        """Cut at ``start`` and append; a gap before ``start`` is rest. Unchecked."""
        rest = at(pieces[-1], INF)[0]
        keep = bisect_right(self._starts, start - 1e-12)
        del self._pieces[keep:], self._starts[keep:]
        if self._end < start:
            pieces = [Piece(max(self._end, start - 1.0), 0.0, self._rest, self._zero, self._zero), *pieces]
        self._pieces += pieces
        self._starts += [piece.t for piece in pieces]
        self._end = pieces[-1].t + pieces[-1].dt
        self._rest = rest
