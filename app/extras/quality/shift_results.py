"""Results of a shift, calculated from stored data, and the period of the shift.

The results use the same stored rows as the trends and ``turndesk parts``, so all counts agree.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from typing import NamedTuple

from app.desk.status.formats import format_duration, format_local_time
from app.desk.translation import tr
from app.extras.quality.parts_data import make_measured_feature
from app.production.cycle_recorder import COMPLETE
from core.extras.quality.production_stops import (
    Availability,
    ProductionStop,
    StopReasonTotal,
    TimeSpan,
    analyze_stop_reasons,
    calculate_availability,
)
from core.message import CodedError, Message
from core.store import event_log
from core.store.offsets import offset_history
from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, CycleTime, ProductionStopRow
from core.store.production.tool_lives import InsertChange, ToolLifeRow
from core.store.store import Store
from core.store.store_rows import EventRow, OffsetChange, OffsetKind, format_utc

DEFAULT_SHIFT_HOURS = (6, 14)
SHIFT_HOURS_SETTING = "shift"  # setting with the first and last hour
MAX_REPORT_DAYS = 62  # maximum length of a report
_TIME_FORMATS = ("%Y-%m-%d %H:%M", "%Y-%m-%dT%H:%M", "%Y-%m-%d")


class Shift(NamedTuple):
    """Period of a shift from ``start_s`` to ``end_s``, in seconds since the epoch (UTC).

    If the local clock changes during the shift, as for daylight saving time, the period is longer or
    shorter than usual.
    """

    start_s: float
    end_s: float

    @property
    def utc_time_texts(self) -> tuple[str, str]:
        """Return the start and the end of the shift as UTC texts in the format of the store."""
        first, last = (format_utc(datetime.fromtimestamp(each, UTC)) for each in self)
        return first, last

    @property
    def clock_change_s(self) -> float:
        """Return the time in seconds by which the local clock is set forward during the shift.

        The value is negative if the clock is set back.
        """
        first, last = (datetime.fromtimestamp(each).astimezone().utcoffset() for each in self)
        return ((last or timedelta()) - (first or timedelta())).total_seconds()


class ShiftTimesError(CodedError, ValueError):
    """Error raised if the start or end time of a report is invalid."""


def get_shift_hours(stored: object) -> tuple[int, int]:
    """Return the stored start and end hour of the shift, or the default hours if none are stored."""
    match stored:
        case [int(first), int(last)] if 0 <= first < 24 and 0 <= last <= 24:
            return first, last
        case _:
            return DEFAULT_SHIFT_HOURS


def find_shift(hours: tuple[int, int], now: datetime, shifts_back: int = 0) -> Shift:
    """Return the shift that is ``shifts_back`` shifts before the current or latest shift.

    ``hours`` are the start and end hour on the local clock. A night shift is one hour longer if the clock
    is set back during the night.
    """
    wall = now.astimezone().replace(tzinfo=None)
    begins = wall.replace(hour=hours[0], minute=0, second=0, microsecond=0)
    if begins.timestamp() > now.timestamp():
        begins -= timedelta(days=1)
    begins -= timedelta(days=shifts_back)
    length = (hours[1] - hours[0]) % 24 or 24
    return Shift(begins.timestamp(), (begins + timedelta(hours=length)).timestamp())


def parse_local_time(text: str) -> float:
    """Return a typed local time in seconds since the epoch (UTC).

    The text is a date and time such as ``2026-11-23 06:00``, or only a date. Raises ShiftTimesError if the
    text is not a time.
    """
    for form in _TIME_FORMATS:
        try:
            return datetime.strptime(text.strip(), form).timestamp()
        except ValueError:
            continue
    raise ShiftTimesError(
        f"{text!r} is no time; write it as 2026-11-23 06:00, by the clock on the wall", "not-a-time"
    )


def make_report_period(start: str, end: str) -> Shift:
    """Return the period between two typed times.

    Raises ShiftTimesError if a text is not a time, if the end is not after the start, or if the period is
    longer than ``MAX_REPORT_DAYS`` days.
    """
    shift = Shift(parse_local_time(start), parse_local_time(end))
    if shift.end_s <= shift.start_s:
        raise ShiftTimesError(
            f"{end} is not behind {start}; a report goes from the earlier to the later", "ends-first"
        )
    if shift.end_s - shift.start_s > MAX_REPORT_DAYS * 86_400:
        raise ShiftTimesError(
            f"from {start} to {end} are more than {MAX_REPORT_DAYS} days; take fewer", "too-many-days"
        )
    return shift


ALARM_EVENT_KINDS = frozenset({"alarm", "estop"})
_MAX_CHANGES = 1_000_000  # maximum number of changes of offsets
_MIN_CLOCK_STEP_BACK_S = 1.0  # seconds of backward jump from which the clock counts as set back


class ProgramResults(NamedTuple):
    """Results of one program in a shift.

    ``part_count`` is the number of counted parts. ``incomplete_cycles`` is the number of cycles without a
    part, by outcome. ``cycle_times_s`` are the times of complete cycles in seconds.
    """

    program_name: str
    part_count: int
    incomplete_cycles: tuple[tuple[str, int], ...]
    cycle_times_s: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ShiftResults:
    """Results of a shift.

    ``evaluated_until_s`` is the end of the shift, or the current time while the shift is still running. It
    is in seconds since the epoch (UTC).
    """

    shift: Shift
    evaluated_until_s: float
    program_results: tuple[ProgramResults, ...]
    availability: Availability | None
    stop_rows: tuple[ProductionStopRow, ...]
    stop_reasons: tuple[StopReasonTotal, ...]
    alarms: tuple[EventRow, ...]
    tool_lives: tuple[ToolLifeRow, ...]
    insert_changes: tuple[InsertChange, ...]
    offset_changes: tuple[OffsetChange, ...]
    reading_count: int
    bad_readings: tuple[tuple[FeatureRow, ReadingRow], ...]
    cycle_spans: tuple[TimeSpan, ...]
    notes: tuple[str, ...]

    @property
    def part_count(self) -> int:
        """Return the number of parts that all programs made."""
        return sum(each.part_count for each in self.program_results)

    @property
    def total_stop_time_s(self) -> float:
        """Return the total duration of all stops in the shift, in seconds."""
        return sum(each.seconds for each in self.stop_reasons)

    @property
    def unrecorded_time_s(self) -> float:
        """Return the time in seconds for which neither a cycle nor a stop is recorded.

        During this time, the control was off or no part was started.
        """
        if self.availability is None:
            return 0.0
        return max(0.0, self.availability.planned_s - self.availability.producing_s - self.total_stop_time_s)


def parse_store_time(time_text: str) -> float:
    """Return a time from the store in seconds since the epoch (UTC)."""
    return datetime.fromisoformat(time_text).timestamp()


def make_cycle_span(row: CycleRow | CycleTime, now_s: float) -> TimeSpan | None:
    """Return the time span of a cycle, or None if the cycle has not ended or starts after ``now_s``.

    The span has the start and the duration of the cycle, but ends at ``now_s`` at the latest.
    """
    start = parse_store_time(row.started)
    if row.ended is None or start > now_s:
        return None
    return TimeSpan(start, max(start, min(start + row.seconds, now_s)))


def make_cycle_spans(rows: Iterable[CycleRow | CycleTime], now_s: float) -> list[TimeSpan]:
    """Return the time spans of all cycles that have ended."""
    return [span for row in rows if (span := make_cycle_span(row, now_s)) is not None]


def convert_stop_rows(rows: Iterable[ProductionStopRow]) -> list[ProductionStop]:
    """Return stored stops in the format that the calculation of stop reasons and availability needs."""
    return [ProductionStop(row.reason, parse_store_time(row.at), row.seconds) for row in rows]


def calculate_shift_results(
    store: Store, shift: Shift, now_s: float, tool_kind: OffsetKind = OffsetKind.TOOL
) -> ShiftResults:
    """Calculate and return the results of a shift.

    This function runs on a worker. Raises StoreError if the data cannot be read.
    """
    since, end = shift.utc_time_texts
    until = max(shift.start_s, min(shift.end_s, now_s))
    with store.read() as connection:
        cycles = part_cycles.read_cycles_between(connection, since, end)
        stops = part_cycles.read_stops_between(connection, since, end)
        alarms = event_log.find_events_between(connection, ALARM_EVENT_KINDS, since, end)
        readings = measured_parts.read_readings_between(connection, since, end)
        lives = tool_lives.read_tool_lives(connection, tool_kind)
        inserts = tool_lives.read_insert_changes(connection, -1)
        offsets = offset_history.read_store_history(connection, _MAX_CHANGES)
    running = make_cycle_spans(cycles, now_s)
    ended = [row for row in cycles if row.ended is not None and since <= row.ended < end]
    return ShiftResults(
        shift,
        until,
        _make_program_results(ended, _select_interrupted(cycles, on=now_s < shift.end_s)),
        calculate_availability(TimeSpan(shift.start_s, until), running) if until > shift.start_s else None,
        stops,
        analyze_stop_reasons(_limit_stops(convert_stop_rows(stops), shift.start_s, until)),
        alarms,
        tuple(row for row in lives.values() if any(row[5:7]) or any(row[1:3])),
        tuple(row for row in reversed(inserts) if since <= row.at < end),
        tuple(row for row in reversed(offsets) if since <= row.at < end),
        len(readings),
        tuple(each for each in readings if not make_measured_feature(each[0]).good(each[1].value)),
        tuple(running),
        tuple(_make_remarks(shift, until, now_s, cycles)),
    )


def _make_program_results(
    ended: Sequence[CycleRow], cut_off: Sequence[CycleRow]
) -> tuple[ProgramResults, ...]:
    """Return the results of each program.

    A part belongs to the shift in which its cycle ended.
    """
    found = []
    for name in dict.fromkeys(row.program for row in (*ended, *cut_off)):
        rows = [row for row in ended if row.program == name]
        others = [row.outcome for row in rows if not row.part]
        others += [tr("CUT OFF")] * sum(row.program == name for row in cut_off)
        times = tuple(row.seconds for row in rows if row.outcome == COMPLETE and row.seconds > 0.0)
        parts = sum(row.part > 0 for row in rows)
        found.append(
            ProgramResults(name, parts, tuple((w, others.count(w)) for w in dict.fromkeys(others)), times)
        )
    return tuple(found)


def _select_interrupted(cycles: Sequence[CycleRow], *, on: bool) -> list[CycleRow]:
    """Return the interrupted cycles, which are the cycles without a stored end.

    If ``on`` is True, the shift is running. Its last cycle is then omitted, because that cycle may still be
    running.
    """
    known = cycles[:-1] if on else cycles
    return [row for row in known if row.ended is None]


def _limit_stops(stops: Iterable[ProductionStop], start: float, end: float) -> list[ProductionStop]:
    """Return the stops between ``start`` and ``end``.

    A stop that extends beyond this period is shortened to it.
    """
    clipped = [
        (each.reason, max(each.start_s, start), min(each.start_s + each.duration_s, end)) for each in stops
    ]
    return [ProductionStop(reason, a, b - a) for reason, a, b in clipped if b > a]


def _make_remarks(shift: Shift, until: float, now: float, cycles: Sequence[CycleRow]) -> Iterable[str]:
    """Yield remarks about the period of the report, such as a shift that is still running."""
    if now < shift.start_s:
        yield tr("The shift has not started.")
    elif until < shift.end_s:
        yield tr(
            Message(
                "The shift is still running; this report covers it up to {time}.",
                time=datetime.fromtimestamp(until).astimezone().strftime("%H:%M"),
            )
        )
    moved = shift.clock_change_s
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
        yield tr(Message(words, time=format_duration(abs(moved))))
    for before, after in pairwise(cycles):
        if parse_store_time(after.started) < parse_store_time(before.started) - _MIN_CLOCK_STEP_BACK_S:
            words = tr(
                "The clock was set back after {time}, so times of day overlap at that point, but "
                "durations are correct."
            )
            yield tr(Message(words, time=format_local_time(before.started)))
    if not cycles and now >= shift.start_s:
        yield tr("No part was started in this period.")
