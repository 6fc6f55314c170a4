"""Progress bar for work of more than two seconds, on stderr and only on a terminal."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from core.message import Message

SHOW_AFTER = 2.0  # s, shorter work has no progress bar
REDRAW_EVERY = 0.2
WIDTH = 30


class Progress:
    """A progress bar toward ``total``, or a counter if ``total`` is 0.

    A value beyond the total, such as blocks of a program with loops, is also shown as a counter.
    """

    def __init__(self, what: str, total: float = 0.0) -> None:
        self.what = what
        self.total = total
        self._drawn = False
        self._next = time.monotonic() + SHOW_AFTER
        self._terminal = sys.stderr.isatty()

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._drawn:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()

    def reach(self, done: float) -> None:
        """Report the progress. The call is cheap unless the bar must be drawn."""
        if not self._terminal or time.monotonic() < self._next:
            return
        self._next = time.monotonic() + REDRAW_EVERY
        self._drawn = True
        sys.stderr.write("\r\x1b[K" + self.text(done))
        sys.stderr.flush()

    def text(self, done: float) -> str:
        """Return the text of the bar for this progress."""
        if not 0 < done <= self.total:
            return f"{self.what}: {done:,.0f}"
        share = done / self.total
        filled = round(share * WIDTH)
        bar = f"{'█' * filled}{'·' * (WIDTH - filled)}"
        return Message(
            "{what} [{bar}] {share} of {total}",
            what=self.what,
            bar=bar,
            share=f"{share:4.0%}",
            total=f"{self.total:,.0f}",
        )
