"""Overrides: the controller knows steps only. They go out from what it has told, and are read back."""

from __future__ import annotations

from collections.abc import Callable

from core.message import Message
from core.ports import FaultCode
from drivers.grblhal import grblhal_codes

_APART = 0.1  # s between two corrections
_AGAIN = 2.5  # s without a word of the overrides, which every twentieth plain report carries at least
_PATIENCE = 7.0  # s: then it does not take them
LEAST, MOST = 10, 200  # per cent that the controller knows


def steps_to(percent: int, told: int, steps: tuple[int, ...] = grblhal_codes.FEED) -> bytes:
    """From the ``told`` per cent to ``percent``.

    By way of 100 % only where that lies in between: the reset acts at once, and slides that creep would leap.
    So there are never more of them than its queue holds.
    """
    reset, *moves = steps
    straight, over = _from(told, percent, moves), bytes([reset]) + _from(100, percent, moves)
    crosses = (percent - 100) * (told - 100) <= 0
    return over if crosses and len(over) < len(straight) else straight


def _from(told: int, percent: int, moves: list[int]) -> bytes:
    """Coarse steps, then fine ones; the other way round where a coarse one would be cut short at a limit."""
    up_10, down_10, up_1, down_1 = moves
    tens, ones = divmod(abs(percent - told), 10)
    tens, ones = (tens + 1, ones - 10) if ones > 5 else (tens, ones)
    sign = 1 if percent > told else -1
    coarse, fine, back = (up_10, up_1, down_1) if sign > 0 else (down_10, down_1, up_1)
    steps = [coarse] * tens, [fine if ones > 0 else back] * abs(ones)
    fits = LEAST <= told + sign * 10 * tens <= MOST
    return bytes([*steps[0], *steps[1]] if fits else [*steps[1], *steps[0]])


def rapid_step(fraction: float) -> int:
    """Per cent: the greatest of the controller's three that is not faster than asked; 25 is its least."""
    return 100 if fraction >= 1.0 else 50 if fraction >= 0.5 else 25


def in_reach(fraction: float) -> int:
    """Per cent of a fraction, within what the controller knows."""
    return min(max(round(100 * fraction), LEAST), MOST)


class Overrides:
    """``wanted`` is compared with what the controller reports; differences are sent again."""

    def __init__(self, write: Callable[[bytes], None], fail: Callable[[str, FaultCode], None]) -> None:
        self._write = write
        self._fail = fail
        self._asked = [100, 100, 100]
        self._sent_at, self._seen = -1.0, 0
        self._since: float | None = None  # it has not been true, nor come nearer
        self._last: tuple[int, ...] | None = None  # that was told
        self.level = False  # a thread: at 100 % whatever is asked, for it would run beside its lead

    @property
    def commanded(self) -> list[int]:
        """Per cent: feed, rapid, spindle."""
        return [100, self._asked[1], 100] if self.level else self._asked

    def want(self, feed: float, rapid: float) -> None:
        """Fractions above 0."""
        self._asked[:2] = in_reach(feed), rapid_step(rapid)

    def want_spindle(self, percent: int) -> None:
        """Of the speed in its last S word."""
        self._asked[2] = percent

    def true_to(self, reported: tuple[int, ...] | None) -> bool:
        """Whether the controller does what is wanted."""
        return reported is not None and list(reported[:3]) == self.commanded

    def correct(self, reported: tuple[int, ...] | None, told: int, now: float) -> None:
        """Send what differs, from a word of the controller that is younger than what was sent.

        ``told`` counts these words. One that does not come is asked for, by sending again.
        """
        if reported is None or self.true_to(reported) or reported != self._last:
            self._since = None  # what follows the radius is on its way for as long as it does
        self._last = reported
        if reported is None or self.true_to(reported):
            return
        fresh = told > self._seen and now - self._sent_at >= _APART
        if not fresh and now - self._sent_at < _AGAIN:
            return
        self._since = now if self._since is None else self._since
        if now - self._since > _PATIENCE:
            self._fail(
                Message(
                    "the controller does not accept an override: {commanded} was commanded, but "
                    "{reported} is reported",
                    commanded=self.commanded,
                    reported=list(reported),
                ),
                "controller-refuses",
            )
            return
        self._sent_at, self._seen = now, told
        self._write(self._steps(reported))

    def _steps(self, reported: tuple[int, ...]) -> bytes:
        feed, rapid, spindle = self.commanded
        data = steps_to(feed, reported[0])
        data += bytes([grblhal_codes.RAPIDS[rapid]]) if reported[1] != rapid else b""
        return data + (steps_to(spindle, reported[2], grblhal_codes.SPINDLE) if len(reported) > 2 else b"")
