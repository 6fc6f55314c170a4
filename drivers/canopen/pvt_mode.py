"""Interpolated position: setpoints as PVT records through the queue in each drive, which ends at rest."""

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

# --- From setpoints to PVT records: points of the path in counts, times in whole milliseconds.
# A drive goes from point to point on a cubic. Where the acceleration changes between two points the cubic
# leaves the path, so such a piece is cut until it stays within half a count, down to the shortest record.


Demand = Callable[[float], tuple[tuple[float, ...], tuple[float, ...]]]  # t → positions, velocities

SHORTEST = 2  # ms; shorter ones would fill queue and bus
_LOOKS = (0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875)


class Span(NamedTuple):
    """How long the piece from ``t`` on lasts, and how far its cubic leaves the path, in counts."""

    ms: int
    off: float


def span(demand: Demand, t: float, longest: int, counts: Sequence[float]) -> Span:
    """The longest piece of at most ``longest`` ms whose cubic keeps within half a count of the path.

    ``counts`` is the length of a count by axis. The shortest piece is taken whatever it costs.
    """
    ms = longest
    while True:
        off = deviation(demand, t, 0.001 * ms, counts)
        if off <= 0.5 or ms <= SHORTEST:
            return Span(ms, off)
        ms = max(ms // 2, SHORTEST)


def deviation(demand: Demand, t: float, dt: float, counts: Sequence[float]) -> float:
    """How far the cubic from ``t`` to ``t + dt`` leaves the path, in counts of the worst axis."""
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
    """The cubic through two points with their velocities, at fraction ``s`` of ``dt``."""
    r = 1.0 - s
    return r * r * (p0 + s * (2.0 * p0 + v0 * dt)) + s * s * (p1 + r * (2.0 * p1 - v1 * dt))


_log = logging.getLogger(__name__)

_BY_NAME = " or ".join(f'"{name}"' for name in QUEUED)
_DRY = "the drives' queues ran empty because this computer stalled for too long"
LOW_WATER = 2  # records; with fewer a drive faults
RESTART = 0.04  # s between the last point of one PVT motion and the first of the next
_LINGER = 0.5  # s at rest after which the drives' queues are ended; until then points of rest are fed
_BEGIN = 0.3  # s in which a drive must have begun
_PREFILL = 2  # records of rest before the queues are let go


class _Phase(Enum):
    REST = "the position queues of the drives are empty"
    PLAYING = "they play"
    ENDING = "the last path point has been sent to the drives"


class PvtFollower(Follower):
    """Records of whole milliseconds, all axes at the same points, a fixed time ahead and never empty."""

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
        self.front = 0.0  # time of the next point
        self._begun = 0.0
        self._sent: deque[float] = deque()  # when each record that was sent is over
        self.lowest = float("inf")  # s, the least that was ever queued in the drives

    @property
    def playing(self) -> bool:
        """The drives' queues are running."""
        return self._phase is not _Phase.REST

    def prepare(self) -> None:
        """Empty queues, so that nothing old is played."""
        for axis in self._axes:
            _records(axis).clear()
        self.abort()

    def abort(self) -> None:
        """Nothing is fed any more."""
        self._phase, self.trouble = _Phase.REST, ""
        self._sent.clear()
        for axis in self._axes:
            axis.drive.extra &= ~NEW

    def feed(self, now: float) -> None:
        """Begin, go on or end."""
        if self._phase is _Phase.REST and not at_rest(self._queue.horizon(now), now):
            self._begin(now)
        elif self._phase is _Phase.PLAYING:
            self._watch(now)
            self._top_up(now)
        elif self._phase is _Phase.ENDING and now > self.front and not self._active(any):
            self.abort()
            self.urgent = True  # bit 4 must be seen to fall before it rises again

    def _begin(self, now: float) -> None:
        """Points of rest, then all drives at one SYNC: the first point is where the slides stand."""
        if any(self._queue.demand_at(now)[1]):
            self.trouble = Fault("the drives started late, after the path had begun", "queue-dry")
            return
        self.front = self._begun = now
        for _ in range(_PREFILL):
            self._push(self._longest)
        for axis in self._axes:
            axis.drive.extra |= NEW
        self._phase, self.urgent = _Phase.PLAYING, True  # the time of that SYNC is the first point's
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
        """Records that have not been played."""
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
        """Lengths of a count: C may have joined."""
        return [axis.config.count for axis in self._axes]

    def _demand(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        p, v = self._queue.demand_at(t)
        return tuple([p[i] for i in self._indices]), tuple([v[i] for i in self._indices])

    def _active(self, some: object) -> bool:
        active = [bool(axis.drive.status & BIT_12) for axis in self._axes]
        return all(active) if some is all else any(active)


def _records(axis: DrivenAxis) -> RecordQueue:
    """The queue in its drive. Raises DriverError where its family has none."""
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
