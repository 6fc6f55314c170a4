"""Clocks of the operator screen."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial


@dataclass(slots=True)
class DeskClock:
    """Clock with monotonic time in seconds and with the local time of day as text."""

    read_seconds: Callable[[], float] = time.monotonic
    format_local_time: Callable[[], str] = field(default=partial(time.strftime, "%H:%M:%S"))
