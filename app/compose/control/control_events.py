"""What is done when something comes from the process of the control."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from core.executor.snapshot import Event, InterruptedJob


@dataclass(slots=True)
class ControlEvents:
    """What is called on the client's thread when something comes from the control."""

    event: Callable[[Event], None]
    note: Callable[[InterruptedJob | None], None]
    thread_ended: Callable[[str], None]
    stirs: Callable[[], None] = lambda: None
