"""Palm buttons that are wired to the control: refused, because two hands are told apart by a relay alone."""

from __future__ import annotations

import re
from collections.abc import Iterator

from core.machine.errors import Finding
from core.machine.hardware.reading import HardwareReading

_PALM = re.compile(
    r"(left|right)?_?palms?_?(left|right|\d)?|(left|right)_start|start_?(left|right|\d)", re.IGNORECASE
)
WHY = (
    "palm buttons are not wired to the control: a two-hand relay tells whether both came within 0.5 s and"
    " were let go in between; its one output is the input start"
)


def broken(reading: HardwareReading) -> Iterator[Finding]:
    """A finding for every input that is one button of two."""
    wired = reading.data.get("io")
    inputs = wired.get("in") if isinstance(wired, dict) else None
    for name in inputs if isinstance(inputs, dict) else ():
        if _PALM.fullmatch(name):
            yield Finding(f"io.in.{name}", "", WHY)
