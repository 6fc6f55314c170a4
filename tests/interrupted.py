"""A job that was interrupted, as the control keeps it: for tests of whoever shows or keeps it."""

from __future__ import annotations

from dataclasses import replace

from core.executor.snapshot import InterruptedJob

_MADE = InterruptedJob(
    program="PIN.NC",
    job="a1",
    text="b2",
    line=8,
    block=12,
    begun=12,
    tool=3,
    part=5,
    axes=("X", "Z", "C"),
    where=(9.525, -58.42, 0.0),
    why="E-STOP",
    at="2026-05-04T09:30:00Z",
)


def broken_off(**changes: object) -> InterruptedJob:
    """Line 8 of PIN.NC with T3 in part 5, but for what is given."""
    return replace(_MADE, **changes)  # type: ignore[arg-type]
