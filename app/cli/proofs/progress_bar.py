"""Progress bar on stderr for work that takes more than two seconds, shown only on a terminal."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from core.message import Message

SHOW_DELAY_S = 2.0  # s, shorter work has no progress bar
REDRAW_INTERVAL_S = 0.2
BAR_WIDTH = 30


class ProgressBar:
    """Progress bar toward ``total``, or counter if ``total`` is 0.

    Progress beyond the total, such as the blocks of a program with loops, is also shown as a counter.
    """

    def __init__(self, description: str, total: float = 0.0) -> None:
        self.description = description
        self.total = total
        self._drawn = False
        self._next = time.monotonic() + SHOW_DELAY_S
        self._terminal = sys.stderr.isatty()

    def __enter__(self) -> ProgressBar:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._drawn:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()

    def report_progress(self, done_amount: float) -> None:
        """Report the progress. The call takes little time unless the bar must be drawn."""
        if not self._terminal or time.monotonic() < self._next:
            return
        self._next = time.monotonic() + REDRAW_INTERVAL_S
        self._drawn = True
        sys.stderr.write("\r\x1b[K" + self.format_bar(done_amount))
        sys.stderr.flush()

    def format_bar(self, done_amount: float) -> str:
        """Return the text of the bar for the progress ``done_amount``."""
        if not 0 < done_amount <= self.total:
            return f"{self.description}: {done_amount:,.0f}"
        share = done_amount / self.total
        filled = round(share * BAR_WIDTH)
        bar = f"{'█' * filled}{'·' * (BAR_WIDTH - filled)}"
        return Message(
            "{what} [{bar}] {share} of {total}",
            what=self.description,
            bar=bar,
            share=f"{share:4.0%}",
            total=f"{self.total:,.0f}",
        )
