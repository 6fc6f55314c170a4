"""How setpoints reach the drives: the common shape, and one at a time (CSP), experimental."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from core.ports import Segments
from drivers.canopen.config import AxisConfig
from drivers.canopen.drive import Drive402
from drivers.canopen.states import CSP
from drivers.setpoint_queue import SetpointQueue


class Fed(Protocol):
    """One axis with its drive; an axis without one has none."""

    config: AxisConfig
    drive: Drive402


class Follower(Protocol):
    """Keeps the drives on the queue. ``trouble`` says why it cannot, ``warning`` what was not exact."""

    mode: int
    trouble: str
    urgent: bool  # the commands must go out in this tick
    off_path: float  # counts, the worst deviation that could not be avoided

    @property
    def playing(self) -> bool:
        """The drives still have something of it to do."""
        ...

    def check(self, segments: Segments) -> None:
        """Refuse, by DriverError, what these drives cannot follow."""
        ...

    def braked(self, at: float) -> None:
        """The queue brakes from ``at`` on, without anything spliced."""
        ...

    def feed(self, now: float) -> None:
        """Once a tick, before the commands go out."""
        ...

    def prepare(self) -> None:
        """Before the drives get power."""
        ...

    def abort(self) -> None:
        """The drives stop by themselves: nothing is fed any more."""
        ...


class CspFollower:
    """One setpoint a SYNC, straight from this process: experimental, good for a bench."""

    mode = CSP

    def __init__(
        self, axes: Sequence[Fed], indices: Sequence[int], queue: SetpointQueue, period: float
    ) -> None:
        self._axes = axes
        self._indices = indices
        self._queue = queue
        self._period = period
        self.trouble = ""
        self.urgent = False
        self.off_path = 0.0

    @property
    def playing(self) -> bool:
        """Each setpoint is alone."""
        return False

    def check(self, segments: Segments) -> None:
        """Any path will do."""

    def braked(self, at: float) -> None:
        """Taken up by the next feed."""

    def prepare(self) -> None:
        """The drives begin where they stand."""
        for axis in self._axes:
            axis.drive.target = axis.drive.position

    def abort(self) -> None:
        """Stay where the drives are."""
        self.trouble = ""

    def feed(self, now: float) -> None:
        """What shall be reached at the SYNC after the next."""
        p, _ = self._queue.demand_at(now + self._period)
        for axis, index in zip(self._axes, self._indices, strict=True):
            axis.drive.target = round(p[index] / axis.config.count)
