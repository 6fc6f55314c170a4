"""Waiting: for what shall be, with a deadline; and looking for so long that something stays as it is."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable

# s after which what should have happened is given up: it ends a hung story and measures nothing.
PATIENCE = float(os.environ.get("STORY_PATIENCE", "60"))
LOOK = 0.02  # s


def until(ready: Callable[[], bool], what: Callable[[], object], patience: float = PATIENCE) -> None:
    """Wait for it; the result of ``what`` is reported when it does not come."""
    tick, end = threading.Event(), time.monotonic() + patience
    while not ready():
        assert time.monotonic() < end, what()
        tick.wait(LOOK)


def throughout(seconds: float, look: Callable[[], None]) -> None:
    """Look again and again for so long; ``look`` raises when it sees what must not be."""
    tick, end = threading.Event(), time.monotonic() + seconds
    while time.monotonic() < end:
        look()
        tick.wait(LOOK)
    look()
