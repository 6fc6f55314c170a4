"""How setpoints reach the drives: profile position (PP), or one setpoint each SYNC (CSP, IP by 60C1h).

With a setpoint each SYNC the drives go in a straight line from setpoint to setpoint in the time that 0x60C2
says; at the last one they stand. A SYNC that comes late is not leapt over: the path goes on where it was,
later, and makes good by going faster by a fiftieth. More than 10 ms is a fault: the drives have stood still
in the middle of a cut.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from core.ports import DriverError, Fault, Segments, at_rest
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_nodes import EVENED_OUT
from drivers.canopen.canopen_objects import AT_ONCE, BIT_12, IP, NEW, PP
from drivers.canopen.driven_axes import DrivenAxis
from drivers.setpoint_queue import SetpointQueue


class Follower(ABC):
    """Keeps the drives on the queue; the drives begin where they stand."""

    mode: int  # of CiA 402

    def __init__(self, axes: Sequence[DrivenAxis], indices: Sequence[int], queue: SetpointQueue) -> None:
        """``indices`` are those of the axes in the queue."""
        self._axes = axes
        self._indices = indices
        self._queue = queue
        self.trouble: Fault | str = ""  # why it cannot keep them on it
        self.urgent = False  # the commands must go out in this tick
        self.off_path = 0.0  # counts, the worst deviation that could not be avoided

    @property
    def playing(self) -> bool:
        """The drives still have something of it to do."""
        return False

    def path_time(self, t: float) -> float:
        """The place in the queue that the drives had reached at ``t``: what is late is not leapt over."""
        return t

    def check(self, segments: Segments) -> None:
        """Refuse, by DriverError, what these drives cannot follow; most follow any path."""

    def braked(self, at: float) -> None:
        """The queue brakes from ``at`` on, without anything spliced: most take that up by the next feed."""

    @abstractmethod
    def feed(self, now: float) -> None:
        """Once a tick, before the commands go out."""

    def prepare(self) -> None:
        """Before the drives get power."""
        for axis in self._axes:
            axis.drive.target = axis.drive.position

    def abort(self) -> None:
        """The drives stop by themselves: nothing is fed any more."""
        self.trouble = ""


# --- Profile position: the drive plans. For jogging and single moves where a drive has no queue for paths.


_ANSWER = 0.2  # s in which a drive must have taken a target


class ProfiledFollower(Follower):
    """Gives each drive the end of the queue as its target, with the speeds of the path there.

    Only straight moves: each drive plans for itself, and on a line all of them keep in step.
    """

    mode = PP

    def __init__(self, axes: Sequence[DrivenAxis], indices: Sequence[int], queue: SetpointQueue) -> None:
        super().__init__(axes, indices, queue)
        self._pending: tuple[float, Segments | None] | None = None
        self._told = -1.0

    @property
    def playing(self) -> bool:
        """A target waits, or was not acknowledged yet."""
        return self._pending is not None or self._told >= 0.0

    def check(self, segments: Segments) -> None:
        """Refuse what is no straight line."""
        dt = segments.dt[-1]
        end = segments.p[-1] + (segments.v[-1] + 0.5 * segments.a[-1] * dt) * dt
        way = end - segments.p[0]
        length = float(np.linalg.norm(way))
        along = way / length if length > 0.0 else way
        off = segments.p - segments.p[0]
        off = off - np.outer(off @ along, along)
        limit = max(axis.config.count for axis in self._axes)
        if float(np.abs(off).max()) > limit:
            raise DriverError(
                'the drives plan only single straight moves ([canopen] mode = "pp"); to run '
                'programs, set mode to "csp" or "ip", or to "pvt" for drives with a queue',
                "drive-limits",
                reason="one-move-only",
            )
        self._pending = (float(segments.t[0]), segments)

    def braked(self, at: float) -> None:
        """The end of the queue is another now, and is reached by braking as hard as the axes may."""
        self._pending = (at, None)

    def prepare(self) -> None:
        """No target is waiting."""
        self._pending = None
        super().prepare()

    def abort(self) -> None:
        """No target is waiting any more."""
        self._pending, self._told, self.trouble = None, -1.0, ""
        for axis in self._axes:
            axis.drive.extra &= ~(NEW | AT_ONCE)

    def feed(self, now: float) -> None:
        """Hand a target over when its time has come, then see that it was taken."""
        if self._told >= 0.0:
            self._finish(now)
        elif self._pending is not None and now >= self._pending[0]:
            _, segments = self._pending
            self._pending, self._told = None, now
            self._hand_over(segments)

    def _hand_over(self, segments: Segments | None) -> None:
        rest, _ = self._queue.demand_at(float("inf"))
        self.urgent = True
        for axis, i in zip(self._axes, self._indices, strict=True):
            config, drive = axis.config, axis.drive
            accel = config.amax
            if segments is not None:
                speed = config.velocity(float(np.abs(segments.v[:, i]).max()))
                accel = float(np.abs(segments.a[:, i]).max())
                drive.setup.write(od.PROFILE_SPEED, 0, max(round(speed), 1))
            drive.setup.try_write(od.PROFILE_ACCEL, 0, config.acceleration(accel))
            drive.setup.try_write(od.PROFILE_DECEL, 0, config.acceleration(accel))
            drive.target = round(rest[i] / config.count)
            drive.extra |= NEW | AT_ONCE

    def _finish(self, now: float) -> None:
        """The drives acknowledge by bit 12; then bit 4 may fall."""
        late = [a.config.name for a in self._axes if not a.drive.status & BIT_12]
        if not late:
            self._told = -1.0
            for axis in self._axes:
                axis.drive.extra &= ~(NEW | AT_ONCE)
        elif now - self._told > _ANSWER:
            self.trouble = self.trouble or Fault(
                "{late}: the drive did not accept its target position", "axis", late=", ".join(late)
            )


# --- One setpoint each SYNC: cyclic synchronous position, and interpolated position.


LONGEST = 0.01  # s without a setpoint in motion; more is a fault
_MADE_GOOD = 0.02  # of a period, in each
_BEGIN = 0.3  # s in which a drive must have begun to interpolate


class SyncSchedule:
    """When each SYNC is due; they keep their beat, whatever came late."""

    def __init__(self, period: float, now: float) -> None:
        self.period = period
        self.due = now
        self.worst = 0.0  # s, the latest so far since somebody asked
        self._late = 0.0  # of the last

    def sent(self, now: float) -> float:
        """A SYNC goes out now: how much longer than a period, s, the drives have waited for it.

        0 for what a drive evens out; one that comes back to its beat is none either.
        """
        late = max(now - self.due, 0.0)
        self.worst = max(self.worst, late)
        longer = late - self._late if late > EVENED_OUT * self.period else 0.0
        missed = int(late / self.period + 1e-6)
        self._late = late - missed * self.period
        self.due += (missed + 1) * self.period
        return max(longer, 0.0)


class CyclicFollower(Follower):
    """``mode`` is CSP, or IP, which has to be let begin by bit 4 and tells by bit 12 that it goes."""

    def __init__(
        self,
        axes: Sequence[DrivenAxis],
        indices: Sequence[int],
        queue: SetpointQueue,
        mode: int,
        schedule: SyncSchedule,
    ) -> None:
        super().__init__(axes, indices, queue)
        self.mode = mode
        self.schedule = schedule
        self.lag = 0.0  # s that the path is behind the clock
        self._fed = -math.inf  # the path up to which the drives have setpoints
        self.gaps = 0  # times that the drives stood at a setpoint in motion
        self._asked: float | None = None  # s, when the drives were told to interpolate
        queue.handed_out = lambda: self._fed

    @property
    def playing(self) -> bool:
        """The path is behind, and has not ended yet."""
        return self.lag > 0.0 and not at_rest(self._queue.horizon(-1e9), self.path_time(self.schedule.due))

    def path_time(self, t: float) -> float:
        """Behind the clock by what came late."""
        return t - self.lag

    def abort(self) -> None:
        """The drives stop by themselves, or another mode takes them."""
        self.lag, self.trouble, self._asked = 0.0, "", None
        for axis in self._axes:
            axis.drive.extra &= ~NEW

    def waited(self, away: float) -> None:
        """The drives have stood at a setpoint for so many s: the path waits for them."""
        if at_rest(self._queue.horizon(-1e9), self.path_time(self.schedule.due) - away):
            self.lag = 0.0
            return
        self.gaps += 1
        self.lag += away
        if self.lag > LONGEST:
            self.trouble = self.trouble or Fault(
                "setpoints were {lag} ms late because this computer stalled for too long",
                "queue-dry",
                lag=f"{1000 * self.lag:.0f}",
            )

    def feed(self, now: float) -> None:
        """What the drives take at the next SYNC, and reach by the one behind it."""
        standing = at_rest(self._queue.horizon(-1e9), self.path_time(now))
        self.lag = 0.0 if standing else max(self.lag - _MADE_GOOD * self.schedule.period, 0.0)
        self._fed = self.path_time(self.schedule.due + self.schedule.period)
        p, _ = self._queue.demand_at(self._fed)
        for axis, index in zip(self._axes, self._indices, strict=True):
            axis.drive.target = round(p[index] / axis.config.count)
        if self.mode == IP:
            self._interpolate(now)

    def _interpolate(self, now: float) -> None:
        """Bit 4 rises once they have power in this mode, with setpoints where they stand."""
        if self._asked is None:
            self._asked = now
            for axis in self._axes:
                axis.drive.extra |= NEW
        stand = [a.config.name for a in self._axes if not a.drive.status & BIT_12]
        if stand and now - self._asked > _BEGIN:
            self.trouble = self.trouble or Fault(
                "{stand}: the drive did not start interpolated motion", "queue-dry", stand=", ".join(stand)
            )
