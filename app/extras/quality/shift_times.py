"""When a shift begins and ends: hours of the clock on the wall, also where that is put forward or back."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import NamedTuple

from core.message import CodedError
from core.store.store_rows import utc

USUAL = (6, 14)
SETTING = "shift"  # first hour and last
MOST_DAYS = 62  # of one report
_FORMS = ("%Y-%m-%d %H:%M", "%Y-%m-%dT%H:%M", "%Y-%m-%d")


class Shift(NamedTuple):
    """From ``start`` to ``end``, seconds of UTC; they are as long as they really were."""

    start: float
    end: float

    @property
    def utc(self) -> tuple[str, str]:
        """Both as the store has times."""
        first, last = (utc(datetime.fromtimestamp(each, UTC)) for each in self)
        return first, last

    @property
    def clock_moved(self) -> float:
        """Seconds by which the clock on the wall was put forward within it; back: less than 0."""
        first, last = (datetime.fromtimestamp(each).astimezone().utcoffset() for each in self)
        return ((last or timedelta()) - (first or timedelta())).total_seconds()


class ShiftTimesError(CodedError, ValueError):
    """Times, as typed, that are not the times of a report."""


def hours_of(kept: object) -> tuple[int, int]:
    """The hours of a shift as they are kept; else the usual ones."""
    match kept:
        case [int(first), int(last)] if 0 <= first < 24 and 0 <= last <= 24:
            return first, last
        case _:
            return USUAL


def shift_of(hours: tuple[int, int], now: datetime, back: int = 0) -> Shift:
    """The shift that is on or has ended last; ``back``: so many shifts before that.

    Its ends are hours of the wall clock: a night in which that is put back lasts an hour longer.
    """
    wall = now.astimezone().replace(tzinfo=None)
    begins = wall.replace(hour=hours[0], minute=0, second=0, microsecond=0)
    if begins.timestamp() > now.timestamp():
        begins -= timedelta(days=1)
    begins -= timedelta(days=back)
    length = (hours[1] - hours[0]) % 24 or 24
    return Shift(begins.timestamp(), (begins + timedelta(hours=length)).timestamp())


def moment_of(text: str) -> float:
    """A moment as it is typed, by the wall clock: ``2026-11-23 06:00`` or a day. Raises ShiftTimesError."""
    for form in _FORMS:
        try:
            return datetime.strptime(text.strip(), form).timestamp()
        except ValueError:
            continue
    raise ShiftTimesError(
        f"{text!r} is no time; write it as 2026-11-23 06:00, by the clock on the wall", "not-a-time"
    )


def between(start: str, end: str) -> Shift:
    """From one typed moment to another. Raises ShiftTimesError."""
    shift = Shift(moment_of(start), moment_of(end))
    if shift.end <= shift.start:
        raise ShiftTimesError(
            f"{end} is not behind {start}; a report goes from the earlier to the later", "ends-first"
        )
    if shift.end - shift.start > MOST_DAYS * 86_400:
        raise ShiftTimesError(
            f"from {start} to {end} are more than {MOST_DAYS} days; take fewer", "too-many-days"
        )
    return shift
