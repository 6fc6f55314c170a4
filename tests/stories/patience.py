"""Waiting: for what shall be, with a deadline; and looking for so long that something stays as it is."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable

from tests import late_computer

PATIENCE = float(
    os.environ.get("STORY_PATIENCE", "60")
)  # s for what comes at once on a computer that is not busy
LOOK = 0.02  # s
STALL = 0.3  # s between two looks of a computer that stood still: hands are shut out then, and leases end


def until(ready: Callable[[], bool], what: Callable[[], object], patience: float = PATIENCE) -> None:
    """Wait for it; ``what`` is told when it does not come."""
    tick, end, looked = threading.Event(), time.monotonic() + patience, time.monotonic()
    while not ready():
        assert time.monotonic() < end, what()
        tick.wait(LOOK)
        looked = _now(looked)


def throughout(seconds: float, look: Callable[[], None]) -> None:
    """Look again and again for so long; ``look`` raises when it sees what must not be."""
    tick, looked = threading.Event(), time.monotonic()
    end = looked + seconds
    while looked < end:
        try:
            look()
            tick.wait(LOOK)
        finally:
            looked = _now(looked)
    look()


def _now(looked: float) -> float:
    """The time, and that this computer is late where the last look was too long ago."""
    now = time.monotonic()
    if now - looked > STALL:
        late_computer.tell("late")
    return now
