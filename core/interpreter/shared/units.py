"""Conversion between program units and millimeters, and formatting of values for messages."""

from __future__ import annotations

from core.message import Message

MM_PER_INCH = 25.4
MM_S_PER_FT_MIN = 12 * MM_PER_INCH / 60  # mm/s
MM_S_PER_M_MIN = 1000 / 60  # mm/s
METRIC_STEP_MM = 0.0001  # mm; the last decimal place of the metric display


def get_mm_per_unit(*, is_metric: bool) -> float:
    """Return the number of millimeters in one length unit of the program."""
    return 1.0 if is_metric else MM_PER_INCH


def get_surface_speed_unit(*, is_metric: bool) -> float:
    """Return 1 m/min or 1 ft/min in mm/s, according to the unit of the program."""
    return MM_S_PER_M_MIN if is_metric else MM_S_PER_FT_MIN


def format_length(length_mm: float, *, is_metric: bool) -> str:
    """Return a length in mm as text with its unit.

    The text has five decimal places in inches and four in millimeters.
    """
    return (
        Message("{unit} mm", unit=f"{length_mm:.4f}")
        if is_metric
        else Message("{mm} in", mm=f"{length_mm / MM_PER_INCH:.5f}")
    )


def format_feed(value: float, *, is_per_rev: bool, is_metric: bool) -> str:
    """Return a feed (mm/s or mm/rev) as text in the program's unit."""
    number = value / get_mm_per_unit(is_metric=is_metric) * (1 if is_per_rev else 60)
    digits = f"{number:.5f}".rstrip("0").rstrip(".")
    return Message(
        "{digits} {ending}/{choice}",
        digits=digits,
        ending="mm" if is_metric else "in",
        choice="rev" if is_per_rev else "min",
    )
