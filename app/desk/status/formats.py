"""Formats of figures for the operator: inch with 5 places, metric with 4, never a negative zero."""

from __future__ import annotations

import math
from datetime import datetime

from core.message import Message

MM_PER_INCH = 25.4
MM_PER_FOOT = 304.8
MINUS = "−"  # the true minus: a hyphen is too short to be read from two metres
NOTHING = "—"
ANGLE_PLACES = 2


def fixed(value: float, places: int) -> str:
    """``value`` with ``places`` decimals; what rounds to zero has no sign; a value that is none is a dash."""
    if not math.isfinite(value):
        return NOTHING
    digits = f"{abs(value):.{places}f}"
    negative = value < 0 and digits.strip("0.") != ""
    return MINUS + digits if negative else digits


def length(mm: float, metric: bool) -> str:
    """A length or coordinate: 5 places in inch, 4 in metric, as the control shows them."""
    return fixed(mm, 4) if metric else fixed(mm / MM_PER_INCH, 5)


def angle(degrees: float) -> str:
    """The spindle angle; its step is .02 degree."""
    return fixed(degrees, ANGLE_PLACES)


def turn_unit(per_rev: bool) -> str:
    """The unit of a feed of C alone."""
    return f"°/{'rev' if per_rev else 'min'}"


def feed_unit(metric: bool, per_rev: bool) -> str:
    """The unit of a feed."""
    return f"{'mm' if metric else 'in'}/{'rev' if per_rev else 'min'}"


def feed(value: float, metric: bool, per_rev: bool) -> str:
    """A feed given in mm/s, or in mm/rev when ``per_rev``, without its unit (``feed_unit``)."""
    if metric:
        return fixed(value, 4) if per_rev else fixed(value * 60, 1)
    return fixed(value / MM_PER_INCH, 5) if per_rev else fixed(value * 60 / MM_PER_INCH, 2)


def surface_speed(mm_s: float, metric: bool) -> str:
    """Surface speed: ft/min, or m/min; a speed over ground has no sign."""
    return fixed(abs(mm_s) * 60 / (1000.0 if metric else MM_PER_FOOT), 0)


def rpm(value: float) -> str:
    """Spindle speed without the sign: the direction stands beside it in words."""
    return fixed(abs(value), 0)


def percent(fraction: float) -> str:
    """An override, given as a fraction of 1, in per cent."""
    return f"{fixed(fraction * 100, 0)} %"


def duration(seconds: float) -> str:
    """``m:ss``, from an hour on ``h:mm:ss``; rounded down as a clock does. No time known: a dash."""
    if not math.isfinite(seconds) or seconds < 0:
        return NOTHING
    whole = int(seconds)
    minutes, rest = divmod(whole, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def file_size(size: int) -> str:
    """Bytes, in the unit that gives one to three digits before the point."""
    for unit, most in (("B", 1e3), ("KB", 1e6), ("MB", 1e9)):
        if size < most:
            return f"{size / (most / 1e3):.{0 if unit == 'B' else 1}f} {unit}"
    return Message("{size} GB", size=f"{size / 1000000000.0:.1f}")


def wall_time(at: str, today: str = "%H:%M") -> str:
    """A UTC time of the store as a wall clock shows it: one of ``today`` so, any other with its day."""
    try:
        then = datetime.fromisoformat(at).astimezone()
    except ValueError:
        return at
    same = datetime.now().astimezone().date() == then.date()
    return then.strftime(today if same else "%Y-%m-%d %H:%M")


def local_time(at: str, *, seconds: bool = True) -> str:
    """A UTC time of the store (ISO 8601) as a clock on the wall shows it, with its day."""
    return datetime.fromisoformat(at).astimezone().strftime(f"%Y-%m-%d %H:%M{':%S' if seconds else ''}")
