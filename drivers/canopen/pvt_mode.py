"""Interpolated position mode with PVT records in a queue of each drive, which ends at rest."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Sequence
from enum import Enum
from typing import NamedTuple

from core.message import Message
from core.ports import DriverError, Fault, at_rest
from drivers.canopen.canopen_objects import BIT_12, IP, NEW
from drivers.canopen.drive_profiles import QUEUED
from drivers.canopen.driven_axes import DrivenAxis, RecordQueue
from drivers.canopen.position_modes import Follower
from drivers.setpoint_queue import SetpointQueue

# --- Conversion of setpoints to PVT records: path points in counts, times in whole milliseconds. A drive
# interpolates between points with a cubic. Where the acceleration changes between two points, the cubic
# deviates from the path. Such a piece is divided until its deviation is at most half a count, or until it has
# the shortest record time.


Demand = Callable[[float], tuple[tuple[float, ...], tuple[float, ...]]]  # Time to positions and velocities.

SHORTEST = 2  # Milliseconds; shorter records would overload queue and bus.
_LOOKS = (0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875)


class Span(NamedTuple):
    """Piece of the path: its duration, and the deviation of its cubic from the path in counts."""

    ms: int
    off: float


def span(demand: Demand, t: float, longest: int, counts: Sequence[float]) -> Span:
    """Return the longest piece of at most ``longest`` ms whose cubic stays within half a count of the path.

    ``counts`` is the length of a count for each axis. The shortest piece is used regardless of its deviation.
    """
    ms = longest
    while True:
        off = deviation(demand, t, 0.001 * ms, counts)
        if off <= 0.5 or ms <= SHORTEST:
            return Span(ms, off)
        ms = max(ms // 2, SHORTEST)


def deviation(demand: Demand, t: float, dt: float, counts: Sequence[float]) -> float:
    """Return the largest deviation of the cubic from ``t`` to ``t + dt`` in counts of the worst axis."""
    p0, v0 = demand(t)
    p1, v1 = demand(t + dt)
    worst = 0.0
    for s in _LOOKS:
        p, _ = demand(t + s * dt)
        for i, count in enumerate(counts):
            cubic = hermite(p0[i], v0[i], p1[i], v1[i], dt, s)
            worst = max(worst, abs(cubic - p[i]) / count)
    return worst


def hermite(p0: float, v0: float, p1: float, v1: float, dt: float, s: float) -> float:
    """Return the cubic through two points with their velocities, at fraction ``s`` of ``dt``."""
    r = 1.0 - s
    return r * r * (p0 + s * (2.0 * p0 + v0 * dt)) + s * s * (p1 + r * (2.0 * p1 - v1 * dt))


_log = logging.getLogger(__name__)

_BY_NAME = " or ".join(f'"{name}"' for name in QUEUED)
_DRY = "the drives' queues ran empty because this computer stalled for too long"
LOW_WATER = 2  # Records; with fewer, a drive faults.
RESTART = 0.04  # Seconds between the last point of one PVT motion and the first of the next.
_LINGER = 0.5  # Seconds at rest after which the queues are ended; until then, points at rest are sent.
_BEGIN = 0.3  # Seconds in which a drive must start.
_PREFILL = 2  # Records at rest before the queues are started.


class _Phase(Enum):
    REST = "the position queues of the drives are empty"
    PLAYING = "they play"
    ENDING = "the last path point has been sent to the drives"


class PvtFollower(Follower):
    """Follower that fills the drives' queues a fixed time ahead, with the same points for all axes.

    The duration of each record is a whole number of milliseconds.
    """

    mode = IP

    def __init__(
        self,
        axes: Sequence[DrivenAxis],
        indices: Sequence[int],
        queue: SetpointQueue,
        ahead: float,
        record: float,
    ) -> None:
        super().__init__(axes, indices, queue)
        self._ahead = ahead - RESTART
        self._longest = round(1000 * record)
        self._phase = _Phase.REST
        self.front = 0.0  # Time of the next point.
        self._begun = 0.0
        self._sent: deque[float] = deque()  # End time of each sent record.
        self.lowest = float("inf")  # Shortest time that was queued in the drives, in s.

    @property
    def playing(self) -> bool:
        """Whether the queues of the drives are running."""
        return self._phase is not _Phase.REST

    def prepare(self) -> None:
        """Clear the queues of the drives."""
        for axis in self._axes:
            _records(axis).clear()
        self.abort()

    def abort(self) -> None:
        """Stop filling the queues."""
        self._phase, self.trouble = _Phase.REST, ""
        self._sent.clear()
        for axis in self._axes:
            axis.drive.extra &= ~NEW

    def feed(self, now: float) -> None:
        """Start, fill or end the queues."""
        if self._phase is _Phase.REST and not at_rest(self._queue.horizon(now), now):
            self._begin(now)
        elif self._phase is _Phase.PLAYING:
            self._watch(now)
            self._top_up(now)
        elif self._phase is _Phase.ENDING and now > self.front and not self._active(any):
            self.abort()
            self.urgent = True  # The drives must detect the fall of bit 4 before it rises again.

    def _begin(self, now: float) -> None:
        """Send points at rest, then start all drives at one SYNC from their present positions."""
        if any(self._queue.demand_at(now)[1]):
            self.trouble = Fault("the drives started late, after the path had begun", "queue-dry")
            return
        self.front = self._begun = now
        for _ in range(_PREFILL):
            self._push(self._longest)
        for axis in self._axes:
            axis.drive.extra |= NEW
        self._phase, self.urgent = _Phase.PLAYING, True  # The time of this SYNC is that of the first point.
        self._top_up(now)

    def _watch(self, now: float) -> None:
        left = self.front - now
        if left < LOW_WATER * 0.001 * self._longest and left < self.lowest:
            _log.warning("the drives' queues are low: %.0f ms left", 1000 * left)
        self.lowest = min(self.lowest, left)
        if left <= 0.0:
            self.trouble = self.trouble or Fault(_DRY, "queue-dry")
        if now - self._begun > _BEGIN and not self._active(all):
            names = [a.config.name for a in self._axes if not a.drive.status & BIT_12]
            why = Message("{names}: the drive has stopped executing its queue", names=", ".join(names))
            self.trouble = self.trouble or Fault(why, "queue-dry")

    def _top_up(self, now: float) -> None:
        rests = at_rest(self._queue.horizon(now), min(self.front, now))
        if rests and now - self._queue.horizon(-1e9) > _LINGER:
            self._push(0)
            self._phase = _Phase.ENDING
            return
        most = min(_records(axis).queue.most for axis in self._axes)
        while self._in_drives(now) < most:
            piece = span(self._demand, self.front, self._longest, self._counts())
            if self.front + 0.001 * piece.ms > now + self._ahead:
                return
            self.off_path = max(self.off_path, piece.off)
            self._push(piece.ms)

    def _in_drives(self, now: float) -> int:
        """Return the number of records that are not yet executed."""
        while self._sent and self._sent[0] < now:
            self._sent.popleft()
        return len(self._sent)

    def _push(self, ms: int) -> None:
        positions, velocities = self._demand(self.front)
        for axis, p, v in zip(self._axes, positions, velocities, strict=True):
            try:
                _records(axis).push(ms, v, p)
            except ValueError as error:
                self.trouble = self.trouble or Fault(f"{axis.config.name}: {error}", "drive-limits")
        self.front += 0.001 * ms
        self._sent.append(self.front)

    def _counts(self) -> list[float]:
        """Return the length of a count for each axis, including C while it is engaged."""
        return [axis.config.count for axis in self._axes]

    def _demand(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        p, v = self._queue.demand_at(t)
        return tuple([p[i] for i in self._indices]), tuple([v[i] for i in self._indices])

    def _active(self, some: object) -> bool:
        active = [bool(axis.drive.status & BIT_12) for axis in self._axes]
        return all(active) if some is all else any(active)


def _records(axis: DrivenAxis) -> RecordQueue:
    """Return the queue of a drive. Raises DriverError if its family does not have one."""
    if axis.records is None:
        raise DriverError(
            '{name}: {title} has no queue for [canopen] mode = "pvt"; choose "csp" or "ip", or '
            "set drive = {by_name}",
            "drive-setup",
            name=axis.config.name,
            title=axis.config.profile.title,
            by_name=_BY_NAME,
        )
    return axis.records
