"""Number formats for the operator: 5 decimals in inches, 4 decimals in mm, and no negative zero."""

from __future__ import annotations

import math
from datetime import datetime

from core.message import Message

MM_PER_INCH = 25.4
MM_PER_FOOT = 304.8
MINUS_SIGN = "−"  # The minus sign. A hyphen is too short to be read from a distance of 2 m.
NO_VALUE = "—"
ANGLE_DECIMALS = 2


def format_fixed(value: float, decimals: int) -> str:
    """Return a value as text with a fixed number of decimals.

    A value that rounds to zero has no sign. The text of a value that is not finite is a dash.
    """
    if not math.isfinite(value):
        return NO_VALUE
    digits = f"{abs(value):.{decimals}f}"
    negative = value < 0 and digits.strip("0.") != ""
    return MINUS_SIGN + digits if negative else digits


def format_length(mm: float, is_metric: bool) -> str:
    """Return a length or coordinate as text. ``mm`` is the value in mm.

    If ``is_metric`` is true, the text is in mm with 4 decimals. Otherwise it is in inches with 5 decimals.
    """
    return format_fixed(mm, 4) if is_metric else format_fixed(mm / MM_PER_INCH, 5)


def format_angle(degrees: float) -> str:
    """Return the spindle angle in degrees as text. The resolution is 0.02 degrees."""
    return format_fixed(degrees, ANGLE_DECIMALS)


def find_rotary_feed_unit(per_rev: bool) -> str:
    """Return the unit of the feed for a move of the C axis only."""
    return f"°/{'rev' if per_rev else 'min'}"


def find_feed_unit(is_metric: bool, per_rev: bool) -> str:
    """Return the unit of a linear feed, such as ``mm/rev`` or ``in/min``."""
    return f"{'mm' if is_metric else 'in'}/{'rev' if per_rev else 'min'}"


def format_feed(value: float, is_metric: bool, per_rev: bool) -> str:
    """Return a feed as text without its unit. ``value`` is in mm/s, or in mm/rev if ``per_rev``."""
    if is_metric:
        return format_fixed(value, 4) if per_rev else format_fixed(value * 60, 1)
    return format_fixed(value / MM_PER_INCH, 5) if per_rev else format_fixed(value * 60 / MM_PER_INCH, 2)


def format_surface_speed(mm_s: float, is_metric: bool) -> str:
    """Return a surface speed as text without a sign. ``mm_s`` is the speed in mm/s.

    If ``is_metric`` is true, the text is in m/min. Otherwise it is in ft/min.
    """
    return format_fixed(abs(mm_s) * 60 / (1000.0 if is_metric else MM_PER_FOOT), 0)


def rpm(value: float) -> str:
    """Return a spindle speed in rpm as text without a sign or unit."""
    return format_fixed(abs(value), 0)


def format_percent(fraction: float) -> str:
    """Return an override fraction as text in percent."""
    return f"{format_fixed(fraction * 100, 0)} %"


def format_duration(seconds: float) -> str:
    """Return a time in seconds as ``m:ss``, or as ``h:mm:ss`` if it is one hour or longer.

    The time is rounded down. The text of an unknown or negative time is a dash.
    """
    if not math.isfinite(seconds) or seconds < 0:
        return NO_VALUE
    whole = int(seconds)
    minutes, rest = divmod(whole, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def format_file_size(size_bytes: int) -> str:
    """Return a file size in bytes as text, in a unit that leaves one to three integer digits."""
    for unit, most in (("B", 1e3), ("KB", 1e6), ("MB", 1e9)):
        if size_bytes < most:
            return f"{size_bytes / (most / 1e3):.{0 if unit == 'B' else 1}f} {unit}"
    return Message("{size} GB", size=f"{size_bytes / 1000000000.0:.1f}")


def format_wall_time(utc_time: str, today_format: str = "%H:%M") -> str:
    """Return a UTC time from the store as local time, with the date if it is not today.

    ``today_format`` is the format for a time of the current day. An invalid time is returned unchanged.
    """
    try:
        then = datetime.fromisoformat(utc_time).astimezone()
    except ValueError:
        return utc_time
    same = datetime.now().astimezone().date() == then.date()
    return then.strftime(today_format if same else "%Y-%m-%d %H:%M")


def format_local_time(utc_time: str, *, with_seconds: bool = True) -> str:
    """Return a UTC time from the store (ISO 8601) as local date and time.

    The text contains seconds if ``with_seconds`` is true.
    """
    return (
        datetime.fromisoformat(utc_time)
        .astimezone()
        .strftime(f"%Y-%m-%d %H:%M{':%S' if with_seconds else ''}")
    )
