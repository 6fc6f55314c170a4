"""Conversion between the units of the program, millimeters and message texts."""

from __future__ import annotations

from core.message import Message

MM_PER_INCH = 25.4
FEET_PER_MINUTE = 12 * MM_PER_INCH / 60  # mm/s
METRES_PER_MINUTE = 1000 / 60  # mm/s
METRIC_STEP = 0.0001  # mm; the last decimal place of the metric display


def per_unit(*, metric: bool) -> float:
    """Return the millimeters in one length unit of the program."""
    return 1.0 if metric else MM_PER_INCH


def length(mm: float, *, metric: bool) -> str:
    """Return a length (mm) as text with its unit: five decimal places in inches, four in millimeters."""
    return (
        Message("{unit} mm", unit=f"{mm:.4f}") if metric else Message("{mm} in", mm=f"{mm / MM_PER_INCH:.5f}")
    )


def feed(value: float, *, per_rev: bool, metric: bool) -> str:
    """Return a feed (mm/s or mm/rev) as text in the program's unit."""
    number = value / per_unit(metric=metric) * (1 if per_rev else 60)
    digits = f"{number:.5f}".rstrip("0").rstrip(".")
    return Message(
        "{digits} {ending}/{choice}",
        digits=digits,
        ending="mm" if metric else "in",
        choice="rev" if per_rev else "min",
    )
