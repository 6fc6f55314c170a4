"""Counts of a handwheel as clicks: what a hand can have turned since the last look, and nothing older."""

from __future__ import annotations

_FASTEST = 1000.0  # clicks a second and
_AT_ONCE = 10  # clicks more are what a hand can do; 300 a second is a hard spin
_AWAY = 0.1  # s between two looks; what was turned in a longer one is old


class Clicks:
    """``per``: counts of one click; a negative number turns the wheel round."""

    def __init__(self, per: int) -> None:
        self._per = per
        self._last: tuple[float, int] | None = None  # time and counts of the last look
        self._base = 0  # counts that have become clicks
        self.still = 0.0  # s since it has last moved
        self.leapt = False  # this look: a leap that no hand makes

    def take(self, counts: int, now: float) -> int:
        """Clicks since the last look, signed. Half a click waits: a wheel that rests on its edge is still."""
        before, self._last = self._last, (now, counts)
        if before is None:
            self._base = counts
            return 0
        passed, moved = now - before[0], abs(counts - before[1])
        self.leapt = moved > abs(self._per) * (_FASTEST * passed + _AT_ONCE)
        if self.leapt or passed > _AWAY:
            self._base, self.still = counts, 0.0
            return 0
        clicks = int((counts - self._base) / self._per)  # towards 0
        self._base += clicks * self._per
        self.still = 0.0 if clicks else self.still + passed
        return clicks
