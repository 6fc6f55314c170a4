"""Setpoint player for a queue that ends at rest, or for a cam (a path over spindle revolutions)."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple

from drivers.setpoint_pieces import INFINITY, MotionPiece, MotionPieceQueue

_SPEED_WINDOW_S = 0.06  # Seconds of readings from which the speed is calculated.
SetpointRow = tuple[float, ...]
MotionState = tuple[tuple[float, ...], tuple[float, ...]]


def make_row_function(pieces: list[MotionPiece]) -> Callable[[float], SetpointRow]:
    """Return a function that converts a time into a setpoint row without spindle following."""
    queue = MotionPieceQueue(pieces[0].positions)
    queue.replace_pieces_from(pieces[0].start_time_s, pieces)
    return lambda t: _rest_row(queue, t)


def _rest_row(queue: MotionPieceQueue, t: float) -> SetpointRow:
    """Return a setpoint row for axes that do not follow the spindle (zero travel per revolution)."""
    return tuple([each for p in queue.get_commanded_state(t)[0] for each in (p, 0.0)])


class SpindlePredictor:
    """A predictor of the spindle position from its recent readings."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, float]] = deque()
        self.speed_rev_per_s = 0.0  # turns/s

    def add_reading(self, time_s: float, revolutions: float) -> None:
        """Add a reading of the spindle position, in revolutions."""
        seen = self._seen
        if seen and time_s <= seen[-1][0]:
            return
        seen.append((time_s, revolutions))
        while len(seen) > 2 and seen[1][0] <= time_s - _SPEED_WINDOW_S:
            seen.popleft()
        since = time_s - seen[0][0]
        self.speed_rev_per_s = (revolutions - seen[0][1]) / since if since > 0.0 else 0.0

    def predict_revolutions(self, time_s: float) -> float:
        """Return the predicted revolutions at ``time_s``."""
        if not self._seen:
            return 0.0
        then, turns = self._seen[-1]
        return turns + self.speed_rev_per_s * (time_s - then)


class PlayerCam(NamedTuple):
    """A motion over spindle revolutions from ``start_revolutions`` on, as in ``core.ports.Cam``.

    ``following_pieces`` are time-based motion pieces that continue the motion after the cam.
    """

    start_revolutions: float
    direction_sign: float
    path_queue: MotionPieceQueue
    following_pieces: Sequence[MotionPiece]


class SetpointPlayer:
    """Source of the setpoint row for any time, from queued motion or from a cam.

    With a cam, the axes follow the spindle. For each axis, a row contains the position at spindle position
    0 and the travel per revolution.
    """

    def __init__(self, axes: int) -> None:
        self.queue = MotionPieceQueue((0.0,) * axes)
        self.spindle_predictor = SpindlePredictor()
        self.cam: PlayerCam | None = None
        self.cam_end_time_s: float | None = None  # End time of the cam in s.

    def reset_to_position(self, position: Sequence[float]) -> None:
        """Discard all setpoints, and rest at the given position."""
        self.cam = self.cam_end_time_s = None
        self.queue.reset_to_position(position)

    def splice_pieces(self, pieces: list[MotionPiece]) -> None:
        """Replace the setpoints by time-based motion pieces from their start on, and end the cam."""
        if self.cam is not None:
            self.queue.reset_to_position(pieces[0].positions)
        self.cam = self.cam_end_time_s = None
        self.queue.replace_pieces_from(pieces[0].start_time_s, pieces)

    def engage_cam(
        self,
        start_revolutions: float,
        direction_sign: float,
        pieces: list[MotionPiece],
        following_pieces: Sequence[MotionPiece],
    ) -> None:
        """Make the axes follow the spindle along the given motion pieces.

        If the new cam has the same start and direction as the current cam, earlier pieces remain.
        """
        path_queue = MotionPieceQueue(pieces[0].positions)
        if self.cam is not None and (self.cam.start_revolutions, self.cam.direction_sign) == (
            start_revolutions,
            direction_sign,
        ):
            path_queue = self.cam.path_queue
        path_queue.replace_pieces_from(pieces[0].start_time_s, pieces)
        self.cam, self.cam_end_time_s = (
            PlayerCam(start_revolutions, direction_sign, path_queue, following_pieces),
            None,
        )

    def brake_to_rest(self, time_s: float, deceleration: Sequence[float]) -> list[MotionPiece]:
        """Brake on a straight line from ``time_s`` on, and return the motion pieces of the deceleration.

        No pieces are returned if the axes are at rest.
        """
        state = self.get_motion_at(time_s)
        if self.cam is not None:
            self.reset_to_position(state[0])
        took = max((abs(v) / a for v, a in zip(state[1], deceleration, strict=True)), default=0.0)
        if took <= 0.0:
            self.queue.reset_to_position(state[0])
            return []
        piece = MotionPiece(time_s, took, *state, tuple(-v / took for v in state[1]))
        self.queue.replace_pieces_from(time_s, [piece])
        return [piece]

    @property
    def is_cam_inactive(self) -> bool:
        """Return whether no axis follows the spindle."""
        return self.cam is None or self.cam_end_time_s is not None

    def get_end_time(self, time_s: float) -> float:
        """Return the end time of the motion, or inf while an axis follows the spindle."""
        return self.queue.get_end_time(time_s) if self.is_cam_inactive else INFINITY

    def get_motion_at(self, time_s: float) -> MotionState:
        """Return the position and velocity at ``time_s``, predicted if a cam is active."""
        if self.cam is None or (self.cam_end_time_s is not None and time_s >= self.cam_end_time_s):
            return self.queue.get_commanded_state(time_s)
        p, per_turn = self.cam.path_queue.get_commanded_state(self._cam_turns(self.cam, time_s))
        speed = max(self.cam.direction_sign * self.spindle_predictor.speed_rev_per_s, 0.0)
        return p, tuple([v * speed for v in per_turn])

    def get_row_at(self, time_s: float) -> SetpointRow:
        """Return the row for HAL at ``time_s``.

        The row contains the position and the travel per revolution of each axis in sequence.
        """
        cam = self.cam
        if cam is not None and (self.cam_end_time_s is None or time_s < self.cam_end_time_s):
            u = self._cam_turns(cam, time_s)
            if u < cam.path_queue.get_end_time(-INFINITY):
                return self._geared_row(cam, u)
            if self.cam_end_time_s is None:
                self._leave_cam(cam, time_s)
        return _rest_row(self.queue, time_s)

    def read_gear_state(self) -> tuple[float, float] | None:
        """Return the spindle direction of the cam (1 or -1) and the speed in this direction in rev/s.

        Without an active cam, the result is None.
        """
        if self.cam is None or self.cam_end_time_s is not None:
            return None
        return self.cam.direction_sign, self.cam.direction_sign * self.spindle_predictor.speed_rev_per_s

    def _cam_turns(self, cam: PlayerCam, t: float) -> float:
        return cam.direction_sign * (self.spindle_predictor.predict_revolutions(t) - cam.start_revolutions)

    def _geared_row(self, cam: PlayerCam, u: float) -> SetpointRow:
        """Return the row with the tangent of the cam at spindle revolutions ``u`` from the cam start.

        HAL calculates the axis positions from this tangent.
        """
        place, per_turn = cam.path_queue.get_commanded_state(u)
        start = cam.start_revolutions + cam.direction_sign * u
        return tuple(
            [
                x
                for p, v in zip(place, per_turn, strict=True)
                for x in (p - cam.direction_sign * v * start, cam.direction_sign * v)
            ]
        )

    def _leave_cam(self, cam: PlayerCam, t: float) -> None:
        """End the cam: the axes rest, or continue with time-based pieces if such pieces follow the cam."""
        rest, _ = cam.path_queue.get_commanded_state(INFINITY)
        self.cam_end_time_s = t
        self.queue.reset_to_position(rest)
        if cam.following_pieces:
            self.queue.replace_pieces_from(
                t, [piece._replace(start_time_s=piece.start_time_s + t) for piece in cam.following_pieces]
            )
