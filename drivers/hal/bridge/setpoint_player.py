"""Setpoint player with a queue that ends at rest, and a cam over the revolutions of the spindle."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple

from drivers.setpoint_pieces import INF, Piece, PieceQueue

_WINDOW = 0.06  # Seconds of readings from which the speed is calculated.
Row = tuple[float, ...]
State = tuple[tuple[float, ...], tuple[float, ...]]


def rows_of(pieces: list[Piece]) -> Callable[[float], Row]:
    """Return a function that returns the row of setpoints at a time, without the spindle."""
    queue = PieceQueue(pieces[0].p)
    queue.replace(pieces[0].t, pieces)
    return lambda t: _still_row(queue, t)


def _still_row(queue: PieceQueue, t: float) -> Row:
    """Return the row with the position of each axis and zero travel per revolution."""
    return tuple([each for p in queue.demand_at(t)[0] for each in (p, 0.0)])


class TurnsAhead:
    """Prediction of the spindle position from its recent readings."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, float]] = deque()
        self.speed = 0.0  # turns/s

    def note(self, t: float, turns: float) -> None:
        """Add a reading."""
        seen = self._seen
        if seen and t <= seen[-1][0]:
            return
        seen.append((t, turns))
        while len(seen) > 2 and seen[1][0] <= t - _WINDOW:
            seen.popleft()
        since = t - seen[0][0]
        self.speed = (turns - seen[0][1]) / since if since > 0.0 else 0.0

    def at(self, t: float) -> float:
        """Return the predicted revolutions at ``t``."""
        if not self._seen:
            return 0.0
        then, turns = self._seen[-1]
        return turns + self.speed * (t - then)


class Cam(NamedTuple):
    """Motion over revolutions from ``zero`` on, as ``core.ports.Cam``; ``then`` continues by time."""

    zero: float
    sign: float
    way: PieceQueue
    then: Sequence[Piece]


class Player:
    """Player that returns a row of setpoints for any time.

    A row has the position without the spindle and the travel per revolution of each axis.
    """

    def __init__(self, axes: int) -> None:
        self.queue = PieceQueue((0.0,) * axes)
        self.turns = TurnsAhead()
        self.cam: Cam | None = None
        self.left: float | None = None  # End time of the cam in s.

    def rest_at(self, place: Sequence[float]) -> None:
        """Discard all setpoints and rest at this position."""
        self.cam = self.left = None
        self.queue.rest_at(place)

    def splice(self, pieces: list[Piece]) -> None:
        """Play these pieces by time from their start on, and end the cam."""
        if self.cam is not None:
            self.queue.rest_at(pieces[0].p)
        self.cam = self.left = None
        self.queue.replace(pieces[0].t, pieces)

    def mesh(self, zero: float, sign: float, pieces: list[Piece], then: Sequence[Piece]) -> None:
        """Follow the spindle with these pieces; earlier pieces of the same cam remain."""
        way = PieceQueue(pieces[0].p)
        if self.cam is not None and (self.cam.zero, self.cam.sign) == (zero, sign):
            way = self.cam.way
        way.replace(pieces[0].t, pieces)
        self.cam, self.left = Cam(zero, sign, way, then), None

    def brake(self, t: float, decel: Sequence[float]) -> list[Piece]:
        """Brake straight to rest from ``t`` on and return the pieces, which are empty at rest."""
        state = self.state(t)
        if self.cam is not None:
            self.rest_at(state[0])
        took = max((abs(v) / a for v, a in zip(state[1], decel, strict=True)), default=0.0)
        if took <= 0.0:
            self.queue.rest_at(state[0])
            return []
        piece = Piece(t, took, *state, tuple(-v / took for v in state[1]))
        self.queue.replace(t, [piece])
        return [piece]

    @property
    def rests(self) -> bool:
        """Whether no axis follows the spindle."""
        return self.cam is None or self.left is not None

    def horizon(self, t: float) -> float:
        """Return the end time of the motion, or inf while an axis follows the spindle."""
        return self.queue.horizon(t) if self.rests else INF

    def state(self, t: float) -> State:
        """Return position and velocity at ``t``, predicted for a cam."""
        if self.cam is None or (self.left is not None and t >= self.left):
            return self.queue.demand_at(t)
        p, per_turn = self.cam.way.demand_at(self._cam_turns(self.cam, t))
        speed = max(self.cam.sign * self.turns.speed, 0.0)
        return p, tuple([v * speed for v in per_turn])

    def row(self, t: float) -> Row:
        """Return the row for HAL at ``t``: position and travel per revolution of each axis in sequence."""
        cam = self.cam
        if cam is not None and (self.left is None or t < self.left):
            u = self._cam_turns(cam, t)
            if u < cam.way.horizon(-INF):
                return self._geared(cam, u)
            if self.left is None:
                self._leave(cam, t)
        return _still_row(self.queue, t)

    def geared(self) -> tuple[float, float] | None:
        """Return the direction and speed of the spindle on the cam, or None without an active cam."""
        if self.cam is None or self.left is not None:
            return None
        return self.cam.sign, self.cam.sign * self.turns.speed

    def _cam_turns(self, cam: Cam, t: float) -> float:
        return cam.sign * (self.turns.at(t) - cam.zero)

    def _geared(self, cam: Cam, u: float) -> Row:
        """Return the tangent of the cam at the predicted revolutions, as HAL needs it for the position."""
        place, per_turn = cam.way.demand_at(u)
        start = cam.zero + cam.sign * u
        return tuple(
            [
                x
                for p, v in zip(place, per_turn, strict=True)
                for x in (p - cam.sign * v * start, cam.sign * v)
            ]
        )

    def _leave(self, cam: Cam, t: float) -> None:
        """End the cam: rest, or continue by time if the cam has a tail."""
        rest, _ = cam.way.demand_at(INF)
        self.left = t
        self.queue.rest_at(rest)
        if cam.then:
            self.queue.replace(t, [piece._replace(t=piece.t + t) for piece in cam.then])
