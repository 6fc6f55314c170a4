"""A setpoint each SYNC: cyclic synchronous position (CSP), and interpolated position by 60C1h (IP).

The drives go in a straight line from setpoint to setpoint in the time that 0x60C2 says; at the last one they
stand. A SYNC that comes late is not leapt over: the path goes on where it was, later, and makes good by going
faster by a fiftieth. More than 10 ms is a fault: the drives have stood still in the middle of a cut.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from core.message import Message
from core.ports import Fault, at_rest
from drivers.canopen.canopen_nodes import EVENED_OUT
from drivers.canopen.canopen_objects import BIT_12, IP, NEW
from drivers.canopen.cia402_drives import DrivenAxis
from drivers.canopen.position_modes import Follower
from drivers.setpoint_queue import SetpointQueue

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
                Message(
                    "setpoints were {lag} ms late because this computer stalled for too long",
                    lag=f"{1000 * self.lag:.0f}",
                ),
                "queue-dry",
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
                Message("{stand}: the drive did not start interpolated motion", stand=", ".join(stand)),
                "queue-dry",
            )
