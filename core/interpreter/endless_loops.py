"""Loops that come round with nothing changed that anything goes by: they never end, and are told at once."""

from __future__ import annotations

from collections.abc import Callable

ENDLESS = "endless-loop"
"""The code of the finding, in every language."""


class LoopWatch:
    """Compares what jumps go by whenever a program jumps back.

    A program does the same again from the same state. So when a jump back comes round with the same state as
    an earlier time, the loop has no end. What is kept for comparison is renewed at the 1st, 2nd, 4th, 8th …
    jump (Brent's cycle detection), so a round of any length is found within three of it at most, and a loop
    that ends costs one comparison a jump, which stops at the first difference.
    """

    def __init__(self) -> None:
        self._jumps = 0
        self._renew = 1
        self._kept: tuple[object, ...] = ()

    def comes_round(self, now: tuple[object, ...], copied: Callable[[], tuple[object, ...]]) -> bool:
        """Whether a jump back meets what an earlier one met.

        ``now`` is where it goes to and all that later jumps may go by, compared by its values; ``copied``
        gives the same as it will not change any more.
        """
        if now == self._kept:
            return True
        self._jumps += 1
        if self._jumps == self._renew:
            self._renew *= 2
            self._kept = copied()
        return False
