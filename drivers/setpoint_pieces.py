"""Setpoint queue of motion pieces with constant acceleration, which always ends at rest.

The module uses only the standard library, because it may be loaded under another Python installation.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from typing import NamedTuple

INFINITY = float("inf")


class MotionPiece(NamedTuple):
    """Motion of all axes at constant acceleration, from ``start_time_s`` for ``duration_s`` seconds.

    Positions, velocities and accelerations are the values of each axis at the start time.
    """

    start_time_s: float
    duration_s: float
    positions: tuple[float, ...]
    velocities: tuple[float, ...]
    accelerations: tuple[float, ...]


def calculate_piece_motion(piece: MotionPiece, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the positions and velocities of a piece at time ``time_s``.

    Before its start and after its end, return the values at the start or end.
    """
    begins, lasts, at_p, at_v, at_a = piece
    dt = time_s - begins
    if not 0.0 <= dt <= lasts:  # Faster than min and max; drives call this a thousand times per second.
        dt = 0.0 if dt < 0.0 else lasts
    half = 0.5 * dt
    p = tuple([x + (v + a * half) * dt for x, v, a in zip(at_p, at_v, at_a, strict=True)])
    return p, tuple([v + a * dt for v, a in zip(at_v, at_a, strict=True)])


_TRIM_COUNT = 64  # Pieces; discarding single pieces would cost more than storing them.


class MotionPieceQueue:
    """Queue of motion pieces and the final rest position.

    The queue is not thread-safe, so the driver must lock it.
    """

    def __init__(self, rest_positions: Sequence[float]) -> None:
        self._zero = (0.0,) * len(rest_positions)
        self._pieces: list[MotionPiece] = []
        self._starts: list[float] = []
        self._end = -INFINITY
        self._rest = tuple(rest_positions)

    def reset_to_position(self, position: Sequence[float]) -> None:
        """Discard all setpoints and stay at rest at ``position``, for example after power-up or homing."""
        self._pieces, self._starts, self._end = [], [], -INFINITY
        self._rest = tuple(position)

    def get_end_time(self, now: float) -> float:
        """Return the end time of the last motion, or ``now`` if the queue is empty."""
        return max(self._end, now)

    def get_commanded_state(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the positions and velocities at time ``time_s``.

        Where two pieces meet, return the values of the later piece.
        """
        if time_s >= self._end:
            return self._rest, self._zero
        index = bisect_right(self._starts, time_s) - 1
        if index < 0:
            return self._pieces[0].positions, self._zero
        return calculate_piece_motion(self._pieces[index], time_s)

    def find_piece_at(self, time_s: float) -> tuple[MotionPiece, float]:
        """Return the piece that is active at time ``time_s``, and the end time of that piece.

        If no motion is queued for ``time_s``, return a piece at rest.
        """
        if time_s >= self._end:
            return MotionPiece(time_s, INFINITY, self._rest, self._zero, self._zero), INFINITY
        index = bisect_right(self._starts, time_s) - 1
        if index < 0:
            return MotionPiece(
                time_s, INFINITY, self._pieces[0].positions, self._zero, self._zero
            ), self._starts[0]
        piece = self._pieces[index]
        ends = piece.start_time_s + piece.duration_s
        following = self._starts[index + 1] if index + 1 < len(self._starts) else self._end
        return piece, min(ends, following)

    def get_commanded_motion(
        self, time_s: float
    ) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """Return the positions, velocities and accelerations at time ``time_s``."""
        p, v = self.get_commanded_state(time_s)
        index = bisect_right(self._starts, time_s) - 1
        return p, v, self._pieces[index].accelerations if index >= 0 and time_s < self._end else self._zero

    @property
    def pieces(self) -> Sequence[MotionPiece]:
        """Return the queued pieces, including those that have ended but are not discarded yet."""
        return self._pieces

    def brake_to_rest(self, now: float, decelerations: Sequence[float]) -> float:
        """Replace the queue with a straight-line deceleration to rest, and return its end time.

        All axes decelerate at the same time. This method is for stops without the host, such as an E-stop
        or a fault. On a curved path, the axes leave the path because they brake on the tangent.
        """
        return self._brake(now, self.get_commanded_state(now), decelerations)

    def _brake(
        self, now: float, state: tuple[tuple[float, ...], tuple[float, ...]], decel: Sequence[float]
    ) -> float:
        p, v = state
        dt = max((abs(speed) / limit for speed, limit in zip(v, decel, strict=True)), default=0.0)
        if dt <= 0.0:
            self.reset_to_position(p)
            return now
        piece = MotionPiece(now, dt, p, v, tuple(-speed / dt for speed in v))
        self.replace_pieces_from(now, [piece])
        return now + dt

    def discard_pieces_before(self, time_s: float) -> None:
        """Discard the pieces that ended before ``time_s``, but only if there are at least 64 of them."""
        gone = bisect_right(self._starts, time_s) - 1
        if gone >= _TRIM_COUNT:
            del self._pieces[:gone], self._starts[:gone]

    def replace_pieces_from(self, start_time_s: float, pieces: list[MotionPiece]) -> None:
        """Cut the queue at time ``start_time_s`` and append ``pieces`` without checks.

        If the queue ends before ``start_time_s``, the axes are at rest in between.
        """
        rest = calculate_piece_motion(pieces[-1], INFINITY)[0]
        keep = bisect_right(self._starts, start_time_s - 1e-12)
        del self._pieces[keep:], self._starts[keep:]
        if self._end < start_time_s:
            pieces = [
                MotionPiece(max(self._end, start_time_s - 1.0), 0.0, self._rest, self._zero, self._zero),
                *pieces,
            ]
        self._pieces += pieces
        self._starts += [piece.start_time_s for piece in pieces]
        self._end = pieces[-1].start_time_s + pieces[-1].duration_s
        self._rest = rest
