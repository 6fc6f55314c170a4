"""What the queue holds, told as plans: so that any moment has a block, a distance and a speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from core.motion.profile import Profile


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
        return int(self.profile.block_at(t - self.origin)[0])


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
