"""A progress bar on anything over two seconds; on a terminal only, and never on stdout."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from core.message import Message

SHOW_AFTER = 2.0  # seconds: what takes less needs no bar
REDRAW_EVERY = 0.2
WIDTH = 30


class Progress:
    """Counts towards ``total`` (0: unknown) and draws itself on stderr once the work takes long.

    What goes beyond its total, such as blocks beyond the lines of a program with loops, is counted alone.
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
        """Say how far the work has come; costs a clock reading unless it is time to draw."""
        if not self._terminal or time.monotonic() < self._next:
            return
        self._next = time.monotonic() + REDRAW_EVERY
        self._drawn = True
        sys.stderr.write("\r\x1b[K" + self.text(done))
        sys.stderr.flush()

    def text(self, done: float) -> str:
        """The bar as it stands after ``done``."""
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
