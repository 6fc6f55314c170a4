"""Overrides: the controller only knows steps, so each is sent as reset and steps, and read back."""

from __future__ import annotations

from collections.abc import Callable

from drivers.grblhal import codes

_APART = 0.1  # s between two corrections
_TRIES = 8  # without effect: a fault
Steps = tuple[int, int, int, int, int]
_FEED: Steps = (codes.FEED_100, codes.FEED_UP_10, codes.FEED_DOWN_10, codes.FEED_UP_1, codes.FEED_DOWN_1)
_SPINDLE: Steps = (
    codes.SPINDLE_100,
    codes.SPINDLE_UP_10,
    codes.SPINDLE_DOWN_10,
    codes.SPINDLE_UP_1,
    codes.SPINDLE_DOWN_1,
)
LEAST, MOST = 10, 200  # per cent that the controller knows


def steps_to(percent: int, steps: Steps = _FEED) -> bytes:
    """Reset to 100 % and step to ``percent``; 15 bytes at most, which the controller takes together."""
    reset, up_10, down_10, up_1, down_1 = steps
    tens, ones = divmod(abs(percent - 100), 10)
    tens, ones = (tens + 1, ones - 10) if ones > 5 else (tens, ones)
    coarse, fine, back = (up_10, up_1, down_1) if percent > 100 else (down_10, down_1, up_1)
    return bytes([reset, *[coarse] * tens, *[fine if ones > 0 else back] * abs(ones)])


def spindle_steps_to(percent: int) -> bytes:
    """The same for the spindle."""
    return steps_to(percent, _SPINDLE)


def rapid_step(fraction: float) -> int:
    """Per cent: the greatest of the controller's three that is not faster than asked; 25 is its least."""
    return 100 if fraction >= 1.0 else 50 if fraction >= 0.5 else 25


def in_reach(fraction: float) -> int:
    """Per cent of a fraction, within what the controller knows."""
    return min(max(round(100 * fraction), LEAST), MOST)


class Overrides:
    """``wanted`` is compared with what the controller reports; differences are sent again."""

    def __init__(self, write: Callable[[bytes], None], fail: Callable[[str], None]) -> None:
        self._write = write
        self._fail = fail
        self._last = -1.0
        self._tries = 0
        self.wanted = [100, 100, 100]  # per cent: feed, rapid, spindle

    def want(self, feed: float, rapid: float) -> None:
        """Fractions above 0."""
        asked = [in_reach(feed), rapid_step(rapid)]
        if asked != self.wanted[:2]:
            self.wanted[:2], self._tries = asked, 0

    def want_spindle(self, percent: int) -> None:
        """Of the speed in its last S word."""
        if percent != self.wanted[2]:
            self.wanted[2], self._tries = percent, 0

    def true_to(self, reported: tuple[int, ...] | None) -> bool:
        """Whether the controller does what is wanted."""
        return reported is not None and list(reported[:3]) == self.wanted

    def correct(self, reported: tuple[int, ...] | None, now: float) -> None:
        """Send what differs; not more often than the controller can report it."""
        if reported is None or self.true_to(reported):
            self._tries = 0 if reported is not None else self._tries
            return
        if now - self._last < _APART * (1 + self._tries):
            return
        self._last, self._tries = now, self._tries + 1
        if self._tries > _TRIES:
            self._fail(
                f"the controller does not take an override: {self.wanted} asked, {list(reported)} told"
            )
            return
        feed, rapid, spindle = self.wanted
        data = steps_to(feed) if reported[0] != feed else b""
        if reported[1] != rapid:
            data += bytes([{100: codes.RAPID_100, 50: codes.RAPID_50, 25: codes.RAPID_25}[rapid]])
        if len(reported) > 2 and reported[2] != spindle:
            data += spindle_steps_to(spindle)
        self._write(data)
