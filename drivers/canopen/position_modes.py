"""Transfer of setpoints in profile position mode (PP), or one setpoint per SYNC (CSP, IP by 60C1h).

With one setpoint per SYNC, the drives move linearly between setpoints in the time of 0x60C2 and stop at the
last one. After a late SYNC, the path continues without a jump and catches up by running 2 % faster. A delay
of more than 10 ms is a fault, because the drives have stopped within a cut.
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
    """Base class that makes the drives follow the setpoint queue from their present positions."""

    mode: int  # Mode of CiA 402.

    def __init__(self, axes: Sequence[DrivenAxis], indices: Sequence[int], queue: SetpointQueue) -> None:
        """Create the follower; ``indices`` are the positions of the axes in the queue."""
        self._axes = axes
        self._indices = indices
        self._queue = queue
        self.trouble: Fault | str = ""  # Reason why the drives cannot follow the queue.
        self.urgent = False  # The commands must be sent in this tick.
        self.off_path = 0.0  # Largest unavoidable deviation in counts.

    @property
    def playing(self) -> bool:
        """Whether the drives have not yet completed the transferred setpoints."""
        return False

    def path_time(self, t: float) -> float:
        """Return the time in the queue that the drives had reached at time ``t``."""
        return t

    def check(self, segments: Segments) -> None:
        """Raise DriverError if the drives cannot follow ``segments``; the default accepts any path."""

    def braked(self, at: float) -> None:
        """Handle a queue that brakes from ``at`` on; the default relies on the next ``feed``."""

    @abstractmethod
    def feed(self, now: float) -> None:
        """Transfer setpoints; called once per tick before the commands are sent."""

    def prepare(self) -> None:
        """Set the targets to the present positions before the drives are switched on."""
        for axis in self._axes:
            axis.drive.target = axis.drive.position

    def abort(self) -> None:
        """Stop transferring setpoints, because the drives stop on their own."""
        self.trouble = ""


# --- Profile position: the drive plans jogs and single moves, for drives without a path queue.


_ANSWER = 0.2  # Seconds in which a drive must acknowledge a target.


class ProfiledFollower(Follower):
    """Follower that sends each drive the end of the queue as its target, with the speeds of the path.

    It supports straight moves only, because each drive plans its own motion.
    """

    mode = PP

    def __init__(self, axes: Sequence[DrivenAxis], indices: Sequence[int], queue: SetpointQueue) -> None:
        super().__init__(axes, indices, queue)
        self._pending: tuple[float, Segments | None] | None = None
        self._told = -1.0

    @property
    def playing(self) -> bool:
        """Whether a target is pending or not yet acknowledged."""
        return self._pending is not None or self._told >= 0.0

    def check(self, segments: Segments) -> None:
        """Store a straight move. Raises DriverError if the path is not straight."""
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
        """Send the new end of the queue as the target, with maximum deceleration."""
        self._pending = (at, None)

    def prepare(self) -> None:
        """Discard the pending target and set the targets to the present positions."""
        self._pending = None
        super().prepare()

    def abort(self) -> None:
        """Discard the pending target."""
        self._pending, self._told, self.trouble = None, -1.0, ""
        for axis in self._axes:
            axis.drive.extra &= ~(NEW | AT_ONCE)

    def feed(self, now: float) -> None:
        """Send a target at its time, then wait for the acknowledgment."""
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
        """Clear bit 4 after the drives have acknowledged by bit 12."""
        late = [a.config.name for a in self._axes if not a.drive.status & BIT_12]
        if not late:
            self._told = -1.0
            for axis in self._axes:
                axis.drive.extra &= ~(NEW | AT_ONCE)
        elif now - self._told > _ANSWER:
            self.trouble = self.trouble or Fault(
                "{late}: the drive did not accept its target position", "axis", late=", ".join(late)
            )


# --- One setpoint per SYNC: cyclic synchronous position, and interpolated position.


LONGEST = 0.01  # Seconds without a setpoint in motion; more is a fault.
_MADE_GOOD = 0.02  # Fraction of a period, per period.
_BEGIN = 0.3  # Seconds in which a drive must start to interpolate.


class SyncSchedule:
    """Schedule of the SYNCs, which remain in phase even if one is late."""

    def __init__(self, period: float, now: float) -> None:
        self.period = period
        self.due = now
        self.worst = 0.0  # Largest delay in s since the last report.
        self._late = 0.0  # Delay of the last SYNC.

    def sent(self, now: float) -> float:
        """Record a SYNC at ``now`` and return the extra seconds that the drives have waited.

        The result is 0 for a delay that a drive tolerates, and for the return to the schedule.
        """
        late = max(now - self.due, 0.0)
        self.worst = max(self.worst, late)
        longer = late - self._late if late > EVENED_OUT * self.period else 0.0
        missed = int(late / self.period + 1e-6)
        self._late = late - missed * self.period
        self.due += (missed + 1) * self.period
        return max(longer, 0.0)


class CyclicFollower(Follower):
    """Follower with one setpoint per SYNC, in mode CSP or IP.

    Mode IP must be started by bit 4 and is confirmed by bit 12.
    """

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
        self.lag = 0.0  # Delay of the path relative to the clock in s.
        self._fed = -math.inf  # Time in the queue up to which the drives have setpoints.
        self.gaps = 0  # Number of times that the drives waited at a setpoint in motion.
        self._asked: float | None = None  # Time of the start command for interpolation in s.
        queue.handed_out = lambda: self._fed

    @property
    def playing(self) -> bool:
        """Whether the path is delayed and has not ended yet."""
        return self.lag > 0.0 and not at_rest(self._queue.horizon(-1e9), self.path_time(self.schedule.due))

    def path_time(self, t: float) -> float:
        """Return the time in the queue at ``t``, which is reduced by the lag."""
        return t - self.lag

    def abort(self) -> None:
        """Stop transferring setpoints and clear the lag."""
        self.lag, self.trouble, self._asked = 0.0, "", None
        for axis in self._axes:
            axis.drive.extra &= ~NEW

    def waited(self, away: float) -> None:
        """Delay the path by the seconds that the drives have waited at a setpoint."""
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
        """Set the targets for the next SYNC, which the drives reach at the SYNC after it."""
        standing = at_rest(self._queue.horizon(-1e9), self.path_time(now))
        self.lag = 0.0 if standing else max(self.lag - _MADE_GOOD * self.schedule.period, 0.0)
        self._fed = self.path_time(self.schedule.due + self.schedule.period)
        p, _ = self._queue.demand_at(self._fed)
        for axis, index in zip(self._axes, self._indices, strict=True):
            axis.drive.target = round(p[index] / axis.config.count)
        if self.mode == IP:
            self._interpolate(now)

    def _interpolate(self, now: float) -> None:
        """Set bit 4 when the drives have power in this mode, and check that they start."""
        if self._asked is None:
            self._asked = now
            for axis in self._axes:
                axis.drive.extra |= NEW
        stand = [a.config.name for a in self._axes if not a.drive.status & BIT_12]
        if stand and now - self._asked > _BEGIN:
            self.trouble = self.trouble or Fault(
                "{stand}: the drive did not start interpolated motion", "queue-dry", stand=", ".join(stand)
            )
