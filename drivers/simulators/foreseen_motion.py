"""Predicted motion of the simulated axes along one setpoint piece without active limits.

One formula per moving axis then replaces the single steps, and the samples for the scope are calculated for
many grid points at once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from core.ports import BoolArray, FloatArray
from drivers.setpoint_pieces import INF, Piece
from drivers.simulators.servo_axis import AT_REST, Response, Servo, Setpoints

_FARTHEST = 256  # Grid points; new setpoints usually replace a piece earlier.
_WORTH_FORESEEING = 4  # Grid points; fewer are faster to calculate step by step.


def foresee(
    servos: Sequence[Servo], piece: Piece, until: float, first: int, dt: float
) -> ForeseenMotion | None:
    """Return the motion from grid point ``first`` along ``piece``, which is valid before ``until`` seconds.

    ``dt`` is the grid interval in seconds. Return None where a fault or a limit may act, for short pieces,
    and after the last piece, where the axes may settle at any grid point.
    """
    if until == INF:
        return None
    t = first * dt
    steps = math.ceil(min(_FARTHEST * dt, until - t) / dt)
    if (first + steps - 1) * dt >= until:
        steps -= 1
    if steps < _WORTH_FORESEEING:
        return None
    u, half = t - piece.t, 0.5 * dt * dt
    moves = []
    for servo, p, v, a in zip(servos, piece.p, piece.v, piece.a, strict=True):
        ahead = Setpoints(p + (v + 0.5 * a * u) * u, (v + a * u) * dt, a * half)
        response = servo.foresee(ahead, steps)
        if response is None:
            return None
        moves.append((servo, ahead, response))
    return ForeseenMotion(moves, piece, until, range(first, first + steps), dt)


class ForeseenMotion:
    """Predicted motion of the axes along ``piece`` at the grid points ``points``, created by ``foresee``."""

    def __init__(
        self,
        moves: Sequence[tuple[Servo, Setpoints, Response]],
        piece: Piece,
        until: float,
        points: range,
        dt: float,
    ) -> None:
        self._moves = moves
        self._moving = [move for move in moves if move[2] is not AT_REST]
        self._piece, self._until, self._dt = piece, until, dt
        self._points = points
        self._loads = [servo.load for servo, _, _ in moves]  # At the first grid point, like the speeds.
        self._speeds = [servo.v for servo, _, _ in moves]
        for servo, _, response in moves:
            if response is AT_REST:
                servo.load = servo.over = 0.0
        self.last = points.stop  # Grid point at which the motion ends.
        self._note(points.start)

    def holds(self, piece: Piece, until: float, k: int) -> bool:
        """Return whether the prediction is still valid at grid point ``k``.

        It requires the same setpoints and axes that have not changed since ``move_to``.
        """
        if piece is not self._piece or until != self._until or k != self._k or k >= self.last:
            return False
        return all(servo.p == p and servo.v == v and servo.sound for servo, p, v in self._left)

    def move_to(self, k: int) -> None:
        """Move the axes to their state at grid point ``k``."""
        steps = k - self._points.start
        for servo, setpoints, response in self._moving:
            servo.glide(setpoints, response, steps)
        self._note(k)

    def _note(self, k: int) -> None:
        self._k = k
        self._left = [(servo, servo.p, servo.v) for servo, _, _ in self._moves]

    # --- for the scope ------------------------------------------------------------------------------------

    def rows(self, begin: int, end: int) -> FloatArray:
        """Return sample rows from grid point ``begin`` to ``end``, exclusive.

        The columns are those of ``core.ports.SampleSource``. The caller fills those of the spindle and the
        queue.
        """
        first = self._points.start
        return self._rows[begin - first : end - first]

    def cuts(self, begin: int, end: int) -> BoolArray:
        """Return for each grid point from ``begin`` to ``end``, exclusive, whether an axis cuts."""
        first = self._points.start
        return self._cuts[begin - first : end - first]

    @cached_property
    def _rows(self) -> FloatArray:
        t = np.arange(self._points.start, self._points.stop + 1) * self._dt
        u = (t - self._piece.t)[:, None]
        p, v, a = (np.array(each) for each in (self._piece.p, self._piece.v, self._piece.a))
        counts = np.array([servo.axis.count for servo, _, _ in self._moves])
        places, _, loads = self._states
        readings = np.rint(places / counts) * counts
        return np.column_stack([t, p + (v + a * (0.5 * u)) * u, readings, loads, np.zeros((len(t), 4))])

    @cached_property
    def _cuts(self) -> BoolArray:
        limits = np.array([servo.feeds for servo, _, _ in self._moves])
        speeds = np.abs(self._states[1])
        cuts: BoolArray = np.any((limits[:, 0] < speeds) & (speeds < limits[:, 1]), axis=1)
        return cuts

    @cached_property
    def _states(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Positions, velocities and loads at all grid points, including the end point."""
        k = np.arange(len(self._points) + 1, dtype=np.float64)
        each = [servo.states(setpoints, response, k) for servo, setpoints, response in self._moves]
        places, speeds, loads = (np.column_stack(part) for part in zip(*each, strict=True))
        speeds[0], loads[0] = self._speeds, self._loads
        return places, speeds, loads
