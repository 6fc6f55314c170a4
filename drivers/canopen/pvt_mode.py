"""Interpolated position mode with PVT (position, velocity, time) records.

The record queue of each drive always ends at rest.
"""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Sequence
from enum import Enum
from typing import NamedTuple

from core.message import Message
from core.ports import DriverError, Fault, is_queue_finished
from drivers.canopen.canopen_objects import BIT_12, IP, NEW
from drivers.canopen.drive_profiles import QUEUE_PROFILE_NAMES
from drivers.canopen.drive_set import DrivenAxis, PvtRecordQueue
from drivers.canopen.position_modes import SetpointFollower
from drivers.setpoint_queue import SetpointQueue

# --- Conversion of setpoints to PVT records: path points in counts, times in whole milliseconds. A drive
# interpolates between points with a cubic. Where the acceleration changes between two points, the cubic
# deviates from the path. Such a piece is divided until its deviation is at most half a count, or until it has
# the shortest record time.


GetMotion = Callable[
    [float], tuple[tuple[float, ...], tuple[float, ...]]
]  # Time to positions and velocities.

MIN_RECORD_MS = 2  # Milliseconds; shorter records would overload queue and bus.
_CHECK_FRACTIONS = (0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875)


class PathPiece(NamedTuple):
    """Piece of the path that is sent as one PVT record.

    ``max_deviation_counts`` is the largest deviation of the drive's cubic curve from the path in counts.
    """

    duration_ms: int
    max_deviation_counts: float


def fit_longest_piece(
    motion_at: GetMotion, start_time_s: float, max_duration_ms: int, count_sizes: Sequence[float]
) -> PathPiece:
    """Return the longest piece whose cubic curve deviates from the path by at most half a count.

    The piece starts at ``start_time_s`` and takes at most ``max_duration_ms``. ``count_sizes`` is each
    axis's distance per count. The shortest possible piece is returned even if its deviation is larger.
    """
    ms = max_duration_ms
    while True:
        off = find_max_deviation(motion_at, start_time_s, 0.001 * ms, count_sizes)
        if off <= 0.5 or ms <= MIN_RECORD_MS:
            return PathPiece(ms, off)
        ms = max(ms // 2, MIN_RECORD_MS)


def find_max_deviation(
    motion_at: GetMotion, start_time_s: float, duration_s: float, count_sizes: Sequence[float]
) -> float:
    """Return the largest deviation of a PVT record's cubic curve from the path, in counts.

    The curve starts at time ``start_time_s`` and takes ``duration_s`` seconds.
    """
    p0, v0 = motion_at(start_time_s)
    p1, v1 = motion_at(start_time_s + duration_s)
    worst = 0.0
    for s in _CHECK_FRACTIONS:
        p, _ = motion_at(start_time_s + s * duration_s)
        for i, count in enumerate(count_sizes):
            cubic = interpolate_hermite(p0[i], v0[i], p1[i], v1[i], duration_s, s)
            worst = max(worst, abs(cubic - p[i]) / count)
    return worst


def interpolate_hermite(
    start_position: float,
    start_velocity: float,
    end_position: float,
    end_velocity: float,
    duration_s: float,
    fraction: float,
) -> float:
    """Return the value of the cubic curve through two points with given velocities.

    The value applies at the fraction ``fraction`` of the duration ``duration_s``.
    """
    r = 1.0 - fraction
    return r * r * (
        start_position + fraction * (2.0 * start_position + start_velocity * duration_s)
    ) + fraction * fraction * (end_position + r * (2.0 * end_position - end_velocity * duration_s))


_log = logging.getLogger(__name__)

_QUEUE_PROFILES_TEXT = " or ".join(f'"{name}"' for name in QUEUE_PROFILE_NAMES)
_QUEUE_EMPTY_TEXT = "the drives' queues ran empty because this computer stalled for too long"
MIN_QUEUED_RECORDS = 2  # Records; with fewer, a drive faults.
RESTART_DELAY_S = 0.04  # Seconds between the last point of one PVT motion and the first of the next.
_REST_TIME_S = 0.5  # Seconds at rest after which the queues are ended; until then, points at rest are sent.
_START_TIMEOUT_S = 0.3  # Seconds in which a drive must start.
_PREFILL_RECORDS = 2  # Records at rest before the queues are started.


class _Phase(Enum):
    REST = "the position queues of the drives are empty"
    PLAYING = "they play"
    ENDING = "the last path point has been sent to the drives"


class PvtFollower(SetpointFollower):
    """Follower that sends PVT records to the drives' queues for a fixed time in advance.

    All axes have records with the same times. The duration of each record is a whole number of
    milliseconds.
    """

    cia402_mode = IP

    def __init__(
        self,
        axes: Sequence[DrivenAxis],
        axis_indices: Sequence[int],
        queue: SetpointQueue,
        lead_time_s: float,
        max_record_s: float,
    ) -> None:
        super().__init__(axes, axis_indices, queue)
        self._ahead = lead_time_s - RESTART_DELAY_S
        self._longest = round(1000 * max_record_s)
        self._phase = _Phase.REST
        self.next_point_time_s = 0.0  # Time of the next point.
        self._begun = 0.0
        self._sent: deque[float] = deque()  # End time of each sent record.
        self.min_queued_time_s = float("inf")  # Shortest time that was queued in the drives, in s.

    @property
    def is_executing(self) -> bool:
        """Return whether the drives are executing the records in their queues."""
        return self._phase is not _Phase.REST

    def prepare_targets(self) -> None:
        """Clear the drives' record queues before power-on; PVT mode has no other target."""
        for axis in self._axes:
            _get_record_queue(axis).clear_records()
        self.abort_transfer()

    def abort_transfer(self) -> None:
        """Stop filling the record queues."""
        self._phase, self.failure = _Phase.REST, ""
        self._sent.clear()
        for axis in self._axes:
            axis.drive.mode_bits &= ~NEW

    def transfer_setpoints(self, now: float) -> None:
        """Start or fill the record queues; after the end of the path, let them run out."""
        if self._phase is _Phase.REST and not is_queue_finished(self._queue.get_end_time(now), now):
            self._start_queues(now)
        elif self._phase is _Phase.PLAYING:
            self._watch(now)
            self._top_up(now)
        elif self._phase is _Phase.ENDING and now > self.next_point_time_s and not self._active(any):
            self.abort_transfer()
            self.must_send_now = True  # The drives must detect the fall of bit 4 before it rises again.

    def _start_queues(self, now: float) -> None:
        """Send records at rest, and then start all drives from their current positions at one SYNC."""
        if any(self._queue.get_commanded_state(now)[1]):
            self.failure = Fault("the drives started late, after the path had begun", "queue-dry")
            return
        self.next_point_time_s = self._begun = now
        for _ in range(_PREFILL_RECORDS):
            self._push(self._longest)
        for axis in self._axes:
            axis.drive.mode_bits |= NEW
        self._phase, self.must_send_now = (
            _Phase.PLAYING,
            True,
        )  # The time of this SYNC is that of the first point.
        self._top_up(now)

    def _watch(self, now: float) -> None:
        left = self.next_point_time_s - now
        if left < MIN_QUEUED_RECORDS * 0.001 * self._longest and left < self.min_queued_time_s:
            _log.warning("the drives' queues are low: %.0f ms left", 1000 * left)
        self.min_queued_time_s = min(self.min_queued_time_s, left)
        if left <= 0.0:
            self.failure = self.failure or Fault(_QUEUE_EMPTY_TEXT, "queue-dry")
        if now - self._begun > _START_TIMEOUT_S and not self._active(all):
            names = [a.config.name for a in self._axes if not a.drive.status_word & BIT_12]
            why = Message("{names}: the drive has stopped executing its queue", names=", ".join(names))
            self.failure = self.failure or Fault(why, "queue-dry")

    def _top_up(self, now: float) -> None:
        rests = is_queue_finished(self._queue.get_end_time(now), min(self.next_point_time_s, now))
        if rests and now - self._queue.get_end_time(-1e9) > _REST_TIME_S:
            self._push(0)
            self._phase = _Phase.ENDING
            return
        most = min(_get_record_queue(axis).drive_queue.max_record_count for axis in self._axes)
        while self._queued_record_count(now) < most:
            piece = fit_longest_piece(
                self._demand, self.next_point_time_s, self._longest, self._count_sizes()
            )
            if self.next_point_time_s + 0.001 * piece.duration_ms > now + self._ahead:
                return
            self.max_deviation_counts = max(self.max_deviation_counts, piece.max_deviation_counts)
            self._push(piece.duration_ms)

    def _queued_record_count(self, now: float) -> int:
        """Return the number of records that the drives have not executed yet."""
        while self._sent and self._sent[0] < now:
            self._sent.popleft()
        return len(self._sent)

    def _push(self, ms: int) -> None:
        positions, velocities = self._demand(self.next_point_time_s)
        for axis, p, v in zip(self._axes, positions, velocities, strict=True):
            _get_record_queue(axis).send_record(ms, v, p)
        self.next_point_time_s += 0.001 * ms
        self._sent.append(self.next_point_time_s)

    def _count_sizes(self) -> list[float]:
        """Return the distance per count of each axis, including C while it is engaged."""
        return [axis.config.count for axis in self._axes]

    def _demand(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        p, v = self._queue.get_commanded_state(t)
        return tuple([p[i] for i in self._indices]), tuple([v[i] for i in self._indices])

    def _active(self, some: object) -> bool:
        active = [bool(axis.drive.status_word & BIT_12) for axis in self._axes]
        return all(active) if some is all else any(active)


def _get_record_queue(axis: DrivenAxis) -> PvtRecordQueue:
    """Return the record queue of a drive.

    Raises DriverError if the drive family does not have a queue.
    """
    if axis.record_queue is None:
        raise DriverError(
            '{name}: {title} has no queue for [canopen] mode = "pvt"; choose "csp" or "ip", or '
            "set drive = {by_name}",
            "drive-setup",
            name=axis.config.name,
            title=axis.config.profile.display_name,
            by_name=_QUEUE_PROFILES_TEXT,
        )
    return axis.record_queue
