"""A path section: its blocks, its path with speeds, and the plans that fill the setpoint queue.

Only about one second of a plan is queued, followed by a braking tail. The axes therefore stop on the path if
the queue is not extended.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Sequence
from enum import Enum
from typing import NamedTuple

import numpy as np

from core.executor.lateness import AHEAD, Lateness
from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import MotionLimits
from core.motion.motion_path import Path, PathBuilder
from core.motion.motion_plan import plan
from core.motion.motion_profile import Profile
from core.ports import AxisSink, DriverError, Segments

_SETTLED = 0.4  # s before the end of a plan within which a longer path would give another speed
_TRIES = 3
_PATIENCE = 0.02  # s added to the splice time when a plan came too late


class Progress(Enum):
    """The progress of the present path section."""

    DONE = "no move is active, or all moves of the path are finished"
    MOVING = "moving"
    BLOCK_END = "the axes are stopped at the end of a block by Single Block"
    STILL = "the axes are stopped because the override is 0"
    HELD = "the axes are stopped by an external hold"


class Overrides(NamedTuple):
    """The overrides as fractions of the programmed speeds. ``spindle`` is actual over programmed speed."""

    feed: float = 1.0
    rapid: float = 1.0
    spindle: float = 1.0


class PathSection:
    """A sequence of blocks that are executed without a standstill between them."""

    def __init__(self, limits: MotionLimits, rpm_max: float) -> None:
        self._builder = PathBuilder(limits, rpm_max=rpm_max)
        self._blocks: dict[int, Block] = {}
        self.first_block: Block | None = None

    def add(self, blocks: Iterable[Block], reached: float = -np.inf) -> None:
        """Append blocks; ``reached`` is described in ``PathBuilder.add``."""
        new = list(blocks)
        self._builder.add(new, reached)
        for block in new:
            self.first_block = self.first_block or block
            self._blocks[block.n] = block

    def block(self, n: int) -> Block | None:
        """Return the block with this number, or None."""
        return self._blocks.get(n)

    def behind(self, n: int) -> list[Block]:
        """Return the blocks after block ``n``, in order."""
        return [block for number, block in sorted(self._blocks.items()) if number > n]

    @property
    def length(self) -> float:
        """The length of the stored path in mm, or in degrees if only C turns."""
        return self._builder.path().length

    @property
    def end_s(self) -> float:
        """The distance along the path at its end."""
        return float(self._builder.path().s[-1])

    @property
    def last_block(self) -> Block | None:
        """The block with the highest number, or None."""
        return self._blocks[max(self._blocks)] if self._blocks else None

    def end_of(self, n: int) -> float:
        """Return the distance at which block ``n`` ends; inf if the block is not on the path."""
        path = self._builder.path()
        return path.block_span(n)[1] if n in self._blocks else np.inf

    def drop_before(self, n: int | None) -> None:
        """Drop the blocks before block ``n``."""
        if n is None or n not in self._blocks:
            return
        self._builder.drop_before(n)
        kept = set(self._builder.path().blocks.tolist())
        for old in [number for number in self._blocks if number not in kept and number < n]:
            del self._blocks[old]

    def path(self, overrides: Overrides, last: int | None) -> Path:
        """Return the path with scaled speeds, which are 0 after block ``last`` so that a plan stops there.

        The limits do not depend on the overrides. A new plan from a moving state therefore meets the limits
        of the plan that it replaces.
        """
        path = self._builder.path()
        if last is None and overrides == (1.0, 1.0, 1.0):
            return path
        factors = [self._factor(n, overrides, last) for n in path.blocks.tolist()]
        rate = path.pieces.rate * np.repeat(factors, np.diff(path.first))
        return dataclasses.replace(path, pieces=dataclasses.replace(path.pieces, rate=rate))

    def stoppable(self, last: int | None, s: float) -> int | None:
        """Return the first block from ``last`` on that ends at or after ``s`` and permits a stop.

        Returns None if no block does, for example while a tap is in its hole.
        """
        path = self._builder.path()
        numbers: list[int] = path.blocks.tolist()
        ends: list[float] = path.s[path.first[1:]].tolist()
        for n, end in zip(numbers, ends, strict=True):
            if (last is None or n >= last) and end >= s - 1e-9 and not self._blocks[n].in_hole:
                return n
        return None

    def _factor(self, n: int, overrides: Overrides, last: int | None) -> float:
        if last is not None and n > last:
            return 0.0
        block = self._blocks[n]
        if block.rapid:
            return overrides.rapid
        if block.coupled:
            return overrides.spindle
        turns = block.per_rev and not block.modal.c_locked
        return overrides.feed * overrides.spindle if turns else overrides.feed


# --- contents of the setpoint queue ---------------------------------------------------------------------


class Track(NamedTuple):
    """A plan in the queue. It is executed from time ``since`` on, and its own time zero is ``origin``."""

    since: float
    origin: float
    profile: Profile

    def state(self, t: float) -> tuple[float, float]:
        """Return the distance along the path and the speed at time ``t``."""
        s, v = self.profile.at(t - self.origin)
        return float(s[0]), float(v[0])

    def block(self, t: float) -> int:
        """Return the number of the block that is executed at time ``t``."""
        return self.profile.block_of(t - self.origin)


class Tracks:
    """The queued plans in the order of their execution."""

    def __init__(self) -> None:
        self._tracks: list[Track] = []

    def clear(self) -> None:
        """Remove all plans."""
        self._tracks = []

    @property
    def last(self) -> Track | None:
        """The last plan in the queue, or None."""
        return self._tracks[-1] if self._tracks else None

    def at(self, t: float) -> Track | None:
        """Return the plan that is executed at ``t``, or the first plan if ``t`` is before it."""
        for track in reversed(self._tracks):
            if track.since <= t:
                return track
        return self._tracks[0] if self._tracks else None

    def replace(self, t: float, tracks: Sequence[Track], now: float) -> None:
        """Replace the plans from ``t`` on, and drop the plans that are over at ``now``."""
        kept = [track for track in self._tracks if track.since < t]
        over = max((i for i, track in enumerate(kept) if track.since <= now), default=0)
        self._tracks = [*kept[over:], *tracks]


class PlanQueue:
    """The setpoint queue and the rest of the present plan. Used on the executor's thread only."""

    def __init__(self, axes: AxisSink, lateness: Lateness) -> None:
        self._axes = axes
        self._lateness = lateness
        self._cost = 0.0  # s that recent planning took
        self._tracks = Tracks()
        self._profile: Profile | None = None
        self._origin = 0.0
        self._queued_to = 0.0  # end of the queued part of the plan, after which the braking tail follows

    @property
    def planned_to(self) -> float:
        """The time at which the present plan comes to rest."""
        return self._origin + (self._profile.duration if self._profile else 0.0)

    @property
    def starving(self) -> float:
        """The start time of the braking tail if the queue is not extended; inf if all is queued."""
        return self._queued_to if self._queued_to < self.planned_to - 1e-9 else np.inf

    @property
    def last(self) -> Track | None:
        """The last plan in the queue, or None."""
        return self._tracks.last

    def lead(self, now: float) -> float:
        """Return the earliest time from which a plan started now can change the queue."""
        return now + self._axes.commit + 1.5 * self._cost

    def latest(self, now: float) -> float:
        """Return the splice time if the plan needs all its attempts."""
        return self.lead(now) + _TRIES * _PATIENCE

    def at(self, t: float) -> Track | None:
        """Return the plan that is executed at ``t``, or None if the queue is empty."""
        return self._tracks.at(t)

    def clear(self) -> None:
        """Discard the plan and the record of the queue."""
        self._tracks.clear()
        self._profile, self._origin, self._queued_to = None, 0.0, 0.0

    def splice(self, make: Callable[[float], Profile], *, soon: bool) -> None:
        """Make a plan from a time that can still be changed, and splice it. Retry later if it came too late.

        With ``soon`` the plan starts as soon as possible, otherwise after the queued motion. Raises
        MotionError or DriverError.
        """
        for attempt in range(_TRIES):
            began = self._axes.now()
            t = self.lead(began) + attempt * _PATIENCE
            if not soon:
                t = max(t, min(self._queued_to, self.planned_to - _SETTLED))
            profile = make(t)
            try:
                self._queue(t, t, profile)
            except DriverError:
                late = self._axes.now() + self._axes.commit > t
                self._cost = min(self._axes.now() - began, 0.2)
                if not late or attempt == _TRIES - 1:
                    raise
                continue
            self._cost = max(min(self._axes.now() - began, 0.2), 0.8 * self._cost)
            self._origin, self._profile = t, profile
            return

    def extend(self, now: float) -> bool:
        """Extend the queue from the present plan; return False if that is too late."""
        if (
            self._profile is None
            or self._queued_to - now >= self._lateness.lookahead
            or self.starving == np.inf
        ):
            return True
        at = self._queued_to
        if at < self._axes.now() + self._axes.commit:
            return False
        self._queue(at, self._origin, self._profile)
        return True

    def let_stop(self) -> None:
        """Leave the tail in the queue and discard the rest of the plan."""
        track = self._tracks.last
        if track is not None:
            self._origin, self._profile = track.origin, track.profile
            self._queued_to = self.planned_to

    def _queue(self, t: float, origin: float, profile: Profile) -> None:
        """Splice the plan from ``t`` to the end of the look-ahead, followed by its braking tail."""
        ahead = self._axes.now() + self._lateness.lookahead + AHEAD
        end = min(origin + profile.duration, max(ahead, t + AHEAD))
        parts = [profile.segments(t - origin, end - origin, origin)]
        tracks = [Track(t, origin, profile)]
        if end < origin + profile.duration - 1e-9:
            s, v = profile.at(end - origin)
            tail = plan(profile.path, start_s=float(s[0]), start_v=float(v[0]), stop=True)
            parts.append(tail.segments(0.0, tail.duration, end))
            tracks.append(Track(end, end, tail))
        setpoints = Segments(*[np.concatenate(part) for part in zip(*parts, strict=True)])
        if not len(setpoints.t):
            setpoints = Segments.resting(t, profile.path.point(np.array([profile.end_s]))[0])
        self._axes.splice(setpoints)
        self._tracks.replace(t, tracks, self._axes.now())
        self._queued_to = end
