"""Results of a shift from stored data, and the start and end of a shift.

The rows are the same as those of the trends and of ``turndesk parts``. Nothing is counted again.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from typing import NamedTuple

from app.desk.status.formats import duration, local_time
from app.desk.translation import tr
from app.extras.quality.parts_data import feature_of
from app.production.cycle_recorder import COMPLETE
from core.extras.quality.stops import Availability, ReasonShare, Span, Stop, availability, pareto
from core.message import CodedError, Message
from core.store import event_log
from core.store.offsets import offset_history
from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, CycleTime, StopRow
from core.store.production.tool_lives import InsertChange, LifeRow
from core.store.store import Store
from core.store.store_rows import Change, EventRow, Kind, utc

USUAL = (6, 14)
SETTING = "shift"  # setting with the first and last hour
MOST_DAYS = 62  # maximum length of a report
_FORMS = ("%Y-%m-%d %H:%M", "%Y-%m-%dT%H:%M", "%Y-%m-%d")


class Shift(NamedTuple):
    """Period from ``start`` to ``end`` in seconds of UTC, including changes of the local clock."""

    start: float
    end: float

    @property
    def utc(self) -> tuple[str, str]:
        """Start and end in the time format of the store."""
        first, last = (utc(datetime.fromtimestamp(each, UTC)) for each in self)
        return first, last

    @property
    def clock_moved(self) -> float:
        """Seconds by which the local clock was set forward during the shift, negative if it was set back."""
        first, last = (datetime.fromtimestamp(each).astimezone().utcoffset() for each in self)
        return ((last or timedelta()) - (first or timedelta())).total_seconds()


class ShiftTimesError(CodedError, ValueError):
    """Error for invalid start or end times of a report."""


def hours_of(kept: object) -> tuple[int, int]:
    """Return the stored hours of a shift, or the default hours."""
    match kept:
        case [int(first), int(last)] if 0 <= first < 24 and 0 <= last <= 24:
            return first, last
        case _:
            return USUAL


def shift_of(hours: tuple[int, int], now: datetime, back: int = 0) -> Shift:
    """Return the present or last shift, or the shift ``back`` shifts earlier.

    Start and end are hours of the local clock. A night in which the clock is set back is one hour longer.
    """
    wall = now.astimezone().replace(tzinfo=None)
    begins = wall.replace(hour=hours[0], minute=0, second=0, microsecond=0)
    if begins.timestamp() > now.timestamp():
        begins -= timedelta(days=1)
    begins -= timedelta(days=back)
    length = (hours[1] - hours[0]) % 24 or 24
    return Shift(begins.timestamp(), (begins + timedelta(hours=length)).timestamp())


def moment_of(text: str) -> float:
    """Return the seconds of a typed local time such as ``2026-11-23 06:00`` or a day.

    Raises ShiftTimesError.
    """
    for form in _FORMS:
        try:
            return datetime.strptime(text.strip(), form).timestamp()
        except ValueError:
            continue
    raise ShiftTimesError(
        f"{text!r} is no time; write it as 2026-11-23 06:00, by the clock on the wall", "not-a-time"
    )


def between(start: str, end: str) -> Shift:
    """Return the period between two typed times. Raises ShiftTimesError."""
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


ALARMS = frozenset({"alarm", "estop"})
_ALL = 1_000_000  # maximum number of changes of offsets
_SET_BACK = 1.0  # seconds of backward jump from which the clock counts as set back


class ProgramFigures(NamedTuple):
    """Results of one program: counted parts, cycles without a part by outcome, and complete cycle times."""

    program: str
    parts: int
    others: tuple[tuple[str, int], ...]
    times: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ShiftFigures:
    """Results of a shift.

    ``until`` is its end, or the present time while the shift runs, in seconds of UTC.
    """

    shift: Shift
    until: float
    programs: tuple[ProgramFigures, ...]
    availability: Availability | None
    stops: tuple[StopRow, ...]
    stood: tuple[ReasonShare, ...]
    alarms: tuple[EventRow, ...]
    lives: tuple[LifeRow, ...]
    inserts: tuple[InsertChange, ...]
    offsets: tuple[Change, ...]
    measured: int
    bad: tuple[tuple[FeatureRow, ReadingRow], ...]
    running: tuple[Span, ...]
    notes: tuple[str, ...]

    @property
    def parts(self) -> int:
        """Number of parts of all programs."""
        return sum(each.parts for each in self.programs)

    @property
    def stopped(self) -> float:
        """Duration of all stops within the shift in seconds."""
        return sum(each.seconds for each in self.stood)

    @property
    def untold(self) -> float:
        """Duration without stored data in seconds, because the control was off or no part was started."""
        if self.availability is None:
            return 0.0
        return max(0.0, self.availability.planned - self.availability.producing - self.stopped)


def stamp(at: str) -> float:
    """Return a time of the store in seconds of UTC."""
    return datetime.fromisoformat(at).timestamp()


def span_of(row: CycleRow | CycleTime, now: float) -> Span | None:
    """Return the span of a cycle from its start for its duration, or None if the cycle has not ended."""
    start = stamp(row.started)
    if row.ended is None or start > now:
        return None
    return Span(start, max(start, min(start + row.seconds, now)))


def spans_of(rows: Iterable[CycleRow | CycleTime], now: float) -> list[Span]:
    """Return the spans of all ended cycles."""
    return [span for row in rows if (span := span_of(row, now)) is not None]


def stops_of(rows: Iterable[StopRow]) -> list[Stop]:
    """Return the stops for the calculation of reasons and availability."""
    return [Stop(row.reason, stamp(row.at), row.seconds) for row in rows]


def shift_figures(store: Store, shift: Shift, now: float, tools: Kind = Kind.TOOL) -> ShiftFigures:
    """Return the results of a shift; runs on a worker. Raises StoreError."""
    since, end = shift.utc
    until = max(shift.start, min(shift.end, now))
    with store.read() as connection:
        cycles = part_cycles.cycles_between(connection, since, end)
        stops = part_cycles.stops_between(connection, since, end)
        alarms = event_log.events_between(connection, ALARMS, since, end)
        readings = measured_parts.readings_between(connection, since, end)
        lives = tool_lives.lives(connection, tools)
        inserts = tool_lives.insert_changes(connection, -1)
        offsets = offset_history.history_any(connection, _ALL)
    running = spans_of(cycles, now)
    ended = [row for row in cycles if row.ended is not None and since <= row.ended < end]
    return ShiftFigures(
        shift,
        until,
        _programs(ended, _cut_off(cycles, on=now < shift.end)),
        availability(Span(shift.start, until), running) if until > shift.start else None,
        stops,
        pareto(_within(stops_of(stops), shift.start, until)),
        alarms,
        tuple(row for row in lives.values() if any(row[5:7]) or any(row[1:3])),
        tuple(row for row in reversed(inserts) if since <= row.at < end),
        tuple(row for row in reversed(offsets) if since <= row.at < end),
        len(readings),
        tuple(each for each in readings if not feature_of(each[0]).good(each[1].value)),
        tuple(running),
        tuple(_notes(shift, until, now, cycles)),
    )


def _programs(ended: Sequence[CycleRow], cut_off: Sequence[CycleRow]) -> tuple[ProgramFigures, ...]:
    """Return the results by program. A part belongs to the shift in which it was finished."""
    found = []
    for name in dict.fromkeys(row.program for row in (*ended, *cut_off)):
        rows = [row for row in ended if row.program == name]
        others = [row.outcome for row in rows if not row.part]
        others += [tr("CUT OFF")] * sum(row.program == name for row in cut_off)
        times = tuple(row.seconds for row in rows if row.outcome == COMPLETE and row.seconds > 0.0)
        parts = sum(row.part > 0 for row in rows)
        found.append(
            ProgramFigures(name, parts, tuple((w, others.count(w)) for w in dict.fromkeys(others)), times)
        )
    return tuple(found)


def _cut_off(cycles: Sequence[CycleRow], *, on: bool) -> list[CycleRow]:
    """Return cycles without a stored end.

    The last cycle of a shift that is ``on`` may still run.
    """
    known = cycles[:-1] if on else cycles
    return [row for row in known if row.ended is None]


def _within(stops: Iterable[Stop], start: float, end: float) -> list[Stop]:
    """Return the stops limited to a period."""
    clipped = [(each.reason, max(each.start, start), min(each.start + each.seconds, end)) for each in stops]
    return [Stop(reason, a, b - a) for reason, a, b in clipped if b > a]


def _notes(shift: Shift, until: float, now: float, cycles: Sequence[CycleRow]) -> Iterable[str]:
    """Yield remarks about the times of the report."""
    if now < shift.start:
        yield tr("The shift has not started.")
    elif until < shift.end:
        yield tr(
            Message(
                "The shift is still running; this report covers it up to {time}.",
                time=datetime.fromtimestamp(until).astimezone().strftime("%H:%M"),
            )
        )
    moved = shift.clock_moved
    if moved:
        words = tr(
            "The clock was set forward by {time} during the shift, so the shift was shorter by "
            "the same amount."
        )
        if moved < 0:
            words = tr(
                "The clock was set back by {time} during the shift, so the shift was longer by the "
                "same amount."
            )
        yield tr(Message(words, time=duration(abs(moved))))
    for before, after in pairwise(cycles):
        if stamp(after.started) < stamp(before.started) - _SET_BACK:
            words = tr(
                "The clock was set back after {time}, so times of day overlap at that point, but "
                "durations are correct."
            )
            yield tr(Message(words, time=local_time(before.started)))
    if not cycles and now >= shift.start:
        yield tr("No part was started in this period.")
