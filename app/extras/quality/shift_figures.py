"""The figures of a shift, out of what the store keeps; and when a shift begins and ends.

The rows are those of the trends and of ``turndesk parts``: nothing is counted a second time.
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


ALARMS = frozenset({"alarm", "estop"})
_ALL = 1_000_000  # changes of offsets
_SET_BACK = 1.0  # s by which a clock is late at least when it was set back


class ProgramFigures(NamedTuple):
    """Of one program: parts that were counted, cycles without one by how they ended, times of whole ones."""

    program: str
    parts: int
    others: tuple[tuple[str, int], ...]
    times: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ShiftFigures:
    """A shift as it is reported; ``until``: its end, or now while it is on (seconds of UTC)."""

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
        """Of all programs."""
        return sum(each.parts for each in self.programs)

    @property
    def stopped(self) -> float:
        """Seconds of all stops within the shift."""
        return sum(each.seconds for each in self.stood)

    @property
    def untold(self) -> float:
        """Seconds of which nothing is kept: the control was off, or nobody had started a first part."""
        if self.availability is None:
            return 0.0
        return max(0.0, self.availability.planned - self.availability.producing - self.stopped)


def stamp(at: str) -> float:
    """A time of the store in seconds of UTC."""
    return datetime.fromisoformat(at).timestamp()


def span_of(row: CycleRow | CycleTime, now: float) -> Span | None:
    """When a cycle ran: from its beginning for its seconds; of one under way nobody knows more than now."""
    start = stamp(row.started)
    if row.ended is None or start > now:
        return None
    return Span(start, max(start, min(start + row.seconds, now)))


def spans_of(rows: Iterable[CycleRow | CycleTime], now: float) -> list[Span]:
    """Of several cycles."""
    return [span for row in rows if (span := span_of(row, now)) is not None]


def stops_of(rows: Iterable[StopRow]) -> list[Stop]:
    """Stops as they are reckoned with."""
    return [Stop(row.reason, stamp(row.at), row.seconds) for row in rows]


def shift_figures(store: Store, shift: Shift, now: float, tools: Kind = Kind.TOOL) -> ShiftFigures:
    """Of a shift; on a worker. Raises StoreError."""
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
    """A part is that of the shift in which it was finished."""
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
    """Cycles whose end was never told; the last of a shift that is still ``on`` may be under way."""
    known = cycles[:-1] if on else cycles
    return [row for row in known if row.ended is None]


def _within(stops: Iterable[Stop], start: float, end: float) -> list[Stop]:
    """What of each lies in the shift."""
    clipped = [(each.reason, max(each.start, start), min(each.start + each.seconds, end)) for each in stops]
    return [Stop(reason, a, b - a) for reason, a, b in clipped if b > a]


def _notes(shift: Shift, until: float, now: float, cycles: Sequence[CycleRow]) -> Iterable[str]:
    """What a reader must know of the times."""
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
