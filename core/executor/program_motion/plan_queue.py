"""The queue of the axes as plans: a plan is spliced in time, kept filled ahead, and ends in a braking tail.

Only a second or so is ever queued, and the tail behind it, so the slides stop on the path when nobody comes
back.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from core.motion.motion_plan import plan
from core.motion.motion_profile import Profile
from core.ports import AxisSink, DriverError, Segments

_AHEAD = 0.25  # s queued beyond the look-ahead, so that extending is not needed every tick
_SETTLED = 0.4  # s before a plan's end within which its braking may differ from the law of a longer path
_TRIES = 3
_PATIENCE = 0.02  # s added to the lead when a plan came too late

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

    def __init__(self, axes: AxisSink, lookahead: float) -> None:
        self._axes = axes
        self._lookahead = lookahead
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
        if self._profile is None or self._queued_to - now >= self._lookahead or self.starving == np.inf:
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
        ahead = self._axes.now() + self._lookahead + _AHEAD
        end = min(origin + profile.duration, max(ahead, t + _AHEAD))
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
