"""Motion of the simulated axes along one setpoint piece, predicted while no drive limit applies.

One formula per moving axis then replaces the single steps, and the samples for the scope are calculated for
many grid points at once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from core.ports import BoolArray, FloatArray
from drivers.setpoint_pieces import INFINITY, MotionPiece
from drivers.simulators.servo_axis import RESPONSE_AT_REST, ServoResponse, SetpointPolynomial, SimulatedServo

_MAX_POINTS = 256  # Grid points; new setpoints usually replace a piece earlier.
_MIN_POINTS = 4  # Grid points; fewer are faster to calculate step by step.


def predict_motion(
    servos: Sequence[SimulatedServo], piece: MotionPiece, end_time: float, first_point: int, step_s: float
) -> PredictedMotion | None:
    """Return the predicted motion along ``piece`` from grid point ``first_point``, or None.

    The piece is valid until ``end_time`` in seconds, and ``step_s`` is the grid interval in seconds. The
    result is None in these cases:

    - A fault or a limit could affect the motion.
    - The piece contains too few grid points for a prediction to save time.
    - The piece is the last one, so that the axes may come to rest at any grid point.
    """
    if end_time == INFINITY:
        return None
    t = first_point * step_s
    steps = math.ceil(min(_MAX_POINTS * step_s, end_time - t) / step_s)
    if (first_point + steps - 1) * step_s >= end_time:
        steps -= 1
    if steps < _MIN_POINTS:
        return None
    u, half = t - piece.start_time_s, 0.5 * step_s * step_s
    moves = []
    for servo, p, v, a in zip(servos, piece.positions, piece.velocities, piece.accelerations, strict=True):
        ahead = SetpointPolynomial(p + (v + 0.5 * a * u) * u, (v + a * u) * step_s, a * half)
        response = servo.predict_response(ahead, steps)
        if response is None:
            return None
        moves.append((servo, ahead, response))
    return PredictedMotion(moves, piece, end_time, range(first_point, first_point + steps), step_s)


class PredictedMotion:
    """Predicted motion of the axes along ``piece`` at the grid points ``points``.

    ``predict_motion`` creates this object.
    """

    def __init__(
        self,
        axis_responses: Sequence[tuple[SimulatedServo, SetpointPolynomial, ServoResponse]],
        piece: MotionPiece,
        end_time: float,
        points: range,
        dt: float,
    ) -> None:
        self._moves = axis_responses
        self._moving = [move for move in axis_responses if move[2] is not RESPONSE_AT_REST]
        self._piece, self._until, self._dt = piece, end_time, dt
        self._points = points
        self._loads = [
            servo.load for servo, _, _ in axis_responses
        ]  # At the first grid point, like the speeds.
        self._speeds = [servo.v for servo, _, _ in axis_responses]
        for servo, _, response in axis_responses:
            if response is RESPONSE_AT_REST:
                servo.load = servo.over = 0.0
        self.last_point = points.stop  # Grid point at which the motion ends.
        self._note(points.start)

    def is_valid_at(self, piece: MotionPiece, end_time: float, grid_point: int) -> bool:
        """Return whether the prediction is still valid at grid point ``grid_point``.

        The setpoints must be the same, and the axes must not have changed since the last call of
        ``move_axes_to``.
        """
        if (
            piece is not self._piece
            or end_time != self._until
            or grid_point != self._k
            or grid_point >= self.last_point
        ):
            return False
        return all(servo.p == p and servo.v == v and servo.sound for servo, p, v in self._left)

    def move_axes_to(self, grid_point: int) -> None:
        """Move the axes to their predicted state at grid point ``grid_point``."""
        steps = grid_point - self._points.start
        for servo, setpoints, response in self._moving:
            servo.apply_response(setpoints, response, steps)
        self._note(grid_point)

    def _note(self, k: int) -> None:
        self._k = k
        self._left = [(servo, servo.p, servo.v) for servo, _, _ in self._moves]

    # --- for the scope ------------------------------------------------------------------------------------

    def get_sample_rows(self, first_point: int, end_point: int) -> FloatArray:
        """Return the sample rows from grid point ``first_point`` to ``end_point``, exclusive.

        The columns are those of ``core.ports.SampleSource``. The caller fills the columns of the spindle
        and the queue.
        """
        first = self._points.start
        return self._rows[first_point - first : end_point - first]

    def get_cutting_flags(self, first_point: int, end_point: int) -> BoolArray:
        """Return whether an axis is cutting at each grid point of a range.

        The range is from ``first_point`` to ``end_point``, exclusive.
        """
        first = self._points.start
        return self._cuts[first_point - first : end_point - first]

    @cached_property
    def _rows(self) -> FloatArray:
        t = np.arange(self._points.start, self._points.stop + 1) * self._dt
        u = (t - self._piece.start_time_s)[:, None]
        p, v, a = (
            np.array(each)
            for each in (self._piece.positions, self._piece.velocities, self._piece.accelerations)
        )
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
        """Return the positions, velocities and loads at all grid points, including the end point."""
        k = np.arange(len(self._points) + 1, dtype=np.float64)
        each = [servo.states(setpoints, response, k) for servo, setpoints, response in self._moves]
        places, speeds, loads = (np.column_stack(part) for part in zip(*each, strict=True))
        speeds[0], loads[0] = self._speeds, self._loads
        return places, speeds, loads
