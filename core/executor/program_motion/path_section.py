"""A path section: its blocks, its path and speeds, and the plans that fill the queue of the axes.

A plan is spliced in time, kept filled ahead, and ends in a braking tail. Only a second or so is ever queued,
and the tail behind it, so the slides stop on the path when nobody comes back.
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

_SETTLED = 0.4  # s before a plan's end within which its braking may differ from the law of a longer path
_TRIES = 3
_PATIENCE = 0.02  # s added to the lead when a plan came too late


class Progress(Enum):
    """How far the present path section is."""

    DONE = "no move is active, or all moves of the path are finished"
    MOVING = "moving"
    BLOCK_END = "the axes are stopped at the end of a block by Single Block"
    STILL = "the axes are stopped because the override is 0"
    HELD = "the axes are stopped by an external hold"


class Overrides(NamedTuple):
    """Fractions of the programmed speeds. ``spindle``: its speed over the programmed one."""

    feed: float = 1.0
    rapid: float = 1.0
    spindle: float = 1.0


class PathSection:
    """Blocks that are played without a standstill between them."""

    def __init__(self, limits: MotionLimits, rpm_max: float) -> None:
        self._builder = PathBuilder(limits, rpm_max=rpm_max)
        self._blocks: dict[int, Block] = {}
        self.first_block: Block | None = None

    def add(self, blocks: Iterable[Block], reached: float = -np.inf) -> None:
        """Append; ``reached`` as for ``PathBuilder.add``."""
        new = list(blocks)
        self._builder.add(new, reached)
        for block in new:
            self.first_block = self.first_block or block
            self._blocks[block.n] = block

    def block(self, n: int) -> Block | None:
        """The block with this number."""
        return self._blocks.get(n)

    def behind(self, n: int) -> list[Block]:
        """The blocks after this one, in order."""
        return [block for number, block in sorted(self._blocks.items()) if number > n]

    @property
    def length(self) -> float:
        """Length of what is held, mm (degrees where only C turns)."""
        return self._builder.path().length

    @property
    def end_s(self) -> float:
        """Distance of the end."""
        return float(self._builder.path().s[-1])

    @property
    def last_block(self) -> Block | None:
        """The block with the highest number."""
        return self._blocks[max(self._blocks)] if self._blocks else None

    def end_of(self, n: int) -> float:
        """Distance at which this block ends; behind everything when it is not held."""
        path = self._builder.path()
        return path.block_span(n)[1] if n in self._blocks else np.inf

    def drop_before(self, n: int | None) -> None:
        """Forget what lies behind block ``n``."""
        if n is None or n not in self._blocks:
            return
        self._builder.drop_before(n)
        kept = set(self._builder.path().blocks.tolist())
        for old in [number for number in self._blocks if number not in kept and number < n]:
            del self._blocks[old]

    def path(self, overrides: Overrides, last: int | None) -> Path:
        """The path with its speeds scaled; behind block ``last`` they are 0, so that a plan stops there.

        Limits do not depend on the overrides, so a plan made from a moving state meets the limits of the plan
        that it replaces.
        """
        path = self._builder.path()
        if last is None and overrides == (1.0, 1.0, 1.0):
            return path
        factors = [self._factor(n, overrides, last) for n in path.blocks.tolist()]
        rate = path.pieces.rate * np.repeat(factors, np.diff(path.first))
        return dataclasses.replace(path, pieces=dataclasses.replace(path.pieces, rate=rate))

    def stoppable(self, last: int | None, s: float) -> int | None:
        """The first block from ``last`` on that ends at or behind distance ``s`` and may be stopped at.

        None where there is none, as behind a tap that is in its hole.
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


# --- what the queue holds -------------------------------------------------------------------------------


class Track(NamedTuple):
    """From time ``since`` on this plan is played; its own time zero is at ``origin``."""

    since: float
    origin: float
    profile: Profile

    def state(self, t: float) -> tuple[float, float]:
        """Distance along the path and speed at ``t``."""
        s, v = self.profile.at(t - self.origin)
        return float(s[0]), float(v[0])

    def block(self, t: float) -> int:
        """Number of the block being played at ``t``."""
        return self.profile.block_of(t - self.origin)


class Tracks:
    """The plans in the order in which they are played."""

    def __init__(self) -> None:
        self._tracks: list[Track] = []

    def clear(self) -> None:
        """Nothing is queued."""
        self._tracks = []

    @property
    def last(self) -> Track | None:
        """How the queue ends."""
        return self._tracks[-1] if self._tracks else None

    def at(self, t: float) -> Track | None:
        """The plan that is played at ``t``; before the first one, that."""
        for track in reversed(self._tracks):
            if track.since <= t:
                return track
        return self._tracks[0] if self._tracks else None

    def replace(self, t: float, tracks: Sequence[Track], now: float) -> None:
        """What was spliced at ``t``; what is over by ``now`` is forgotten."""
        kept = [track for track in self._tracks if track.since < t]
        over = max((i for i, track in enumerate(kept) if track.since <= now), default=0)
        self._tracks = [*kept[over:], *tracks]


class PlanQueue:
    """What is queued and what of the present plan is still to be; on the executor's thread alone."""

    def __init__(self, axes: AxisSink, lateness: Lateness) -> None:
        self._axes = axes
        self._lateness = lateness
        self._cost = 0.0  # s that planning took of late
        self._tracks = Tracks()
        self._profile: Profile | None = None
        self._origin = 0.0
        self._queued_to = 0.0  # end of the plan's part in the queue; behind it lies the tail

    @property
    def planned_to(self) -> float:
        """When the present plan comes to rest."""
        return self._origin + (self._profile.duration if self._profile else 0.0)

    @property
    def starving(self) -> float:
        """When the tail begins although the plan goes on; endless when the whole plan is queued."""
        return self._queued_to if self._queued_to < self.planned_to - 1e-9 else np.inf

    @property
    def last(self) -> Track | None:
        """How the queue ends."""
        return self._tracks.last

    def lead(self, now: float) -> float:
        """The earliest moment for which a plan that is begun now can still be spliced."""
        return now + self._axes.commit + 1.5 * self._cost

    def latest(self, now: float) -> float:
        """The moment for which it is spliced if it takes every try."""
        return self.lead(now) + _TRIES * _PATIENCE

    def at(self, t: float) -> Track | None:
        """What is played at ``t``; None: nothing was queued."""
        return self._tracks.at(t)

    def clear(self) -> None:
        """Nothing of it holds any more."""
        self._tracks.clear()
        self._profile, self._origin, self._queued_to = None, 0.0, 0.0

    def splice(self, make: Callable[[float], Profile], *, soon: bool) -> None:
        """Plan for a moment that can still be changed, and splice; again, later, when that took too long.

        ``soon``: as soon as the queue allows; else behind what is queued. Raises MotionError, DriverError.
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
        """Keep it filled from the present plan; False when it is too late for that."""
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
        """Leave the tail as it is: what was planned beyond it no longer holds."""
        track = self._tracks.last
        if track is not None:
            self._origin, self._profile = track.origin, track.profile
            self._queued_to = self.planned_to

    def _queue(self, t: float, origin: float, profile: Profile) -> None:
        """Splice the plan from ``t`` on, as far as the look-ahead, and its tail."""
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
