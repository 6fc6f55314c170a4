"""Analysis of production stops: Pareto analysis, times between stops, and availability.

The availability of a shift is the fraction of its time in which a cycle ran (ISO 22400-2).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from core.extras.quality.control_charts import QualityError
from core.message import Message


class ProductionStop(NamedTuple):
    """A production stop: its reason, its start and its duration.

    Start and duration are in seconds of the same clock.
    """

    reason: str
    start_s: float
    duration_s: float


class StopReasonTotal(NamedTuple):
    """Total of all production stops with the same reason.

    ``share`` is the fraction of the total stop time. ``together`` is the cumulative fraction of this reason
    and all reasons with a longer total.
    """

    reason: str
    times: int
    seconds: float
    share: float
    together: float


def analyze_stop_reasons(stops: Iterable[ProductionStop]) -> tuple[StopReasonTotal, ...]:
    """Return the stop reasons in descending order of total duration.

    Raises QualityError if a stop has a negative duration.
    """
    counts: dict[str, tuple[int, float]] = {}
    for stop in stops:
        if stop.duration_s < 0.0:
            raise QualityError(
                Message(
                    "{reason}: the end of a stop is earlier than its start because the clock was set back",
                    reason=stop.reason,
                ),
                "clock-set-back",
            )
        count, seconds = counts.get(stop.reason, (0, 0.0))
        counts[stop.reason] = count + 1, seconds + stop.duration_s
    total = sum(seconds for _, seconds in counts.values())
    rows, together = [], 0.0
    for reason, (count, seconds) in sorted(counts.items(), key=lambda item: (-item[1][1], item[0])):
        share = seconds / total if total else 0.0
        together += share
        rows.append(StopReasonTotal(reason, count, seconds, share, together))
    return tuple(rows)


def calculate_times_between(stops: Sequence[ProductionStop]) -> tuple[float, ...]:
    """Return the times in seconds between consecutive stops, in chronological order.

    A time is from the end of a stop to the start of the next stop. The time between stops that overlap is
    0.
    """
    ordered = sorted(stops, key=lambda stop: stop.start_s)
    between, end = [], None
    for stop in ordered:
        if end is not None:
            between.append(max(0.0, stop.start_s - end))
        end = max(end or stop.start_s, stop.start_s + stop.duration_s)
    return tuple(between)


class TimeSpan(NamedTuple):
    """A period from ``start_s`` to ``end_s``, in seconds of the same clock."""

    start_s: float
    end_s: float


class Availability(NamedTuple):
    """Availability of a shift: its duration, and the time in which a cycle ran, in seconds."""

    planned_s: float
    producing_s: float

    @property
    def producing_fraction(self) -> float:
        """Return the fraction of the shift in which a cycle ran, 0 to 1."""
        return self.producing_s / self.planned_s


def calculate_availability(shift: TimeSpan, cycle_spans: Iterable[TimeSpan]) -> Availability:
    """Return the availability of a shift from the periods in which a cycle ran.

    Overlapping periods count once, and time outside the shift does not count. Raises QualityError if the
    shift does not end after its start, or if a cycle ends before its start.
    """
    if shift.end_s <= shift.start_s:
        raise QualityError(
            "the end of a shift must be later than its start; correct the shift times", "shift-times"
        )
    producing, reached = 0.0, shift.start_s
    for span in sorted(cycle_spans):
        if span.end_s < span.start_s:
            raise QualityError(
                "the end of a cycle is earlier than its start because the clock was set back",
                "clock-set-back",
            )
        start, end = max(span.start_s, reached), min(span.end_s, shift.end_s)
        if end > start:
            producing += end - start
            reached = end
    return Availability(shift.end_s - shift.start_s, producing)
