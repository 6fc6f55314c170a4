"""Stops of the machine: the Pareto of their reasons, the time between them, and availability.

Availability of the shift is the share of its time in which parts were made (ISO 22400-2).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from core.extras.quality.control_charts import QualityError
from core.message import Message


class Stop(NamedTuple):
    """Production stood from ``start`` for ``seconds``; times in seconds of one clock."""

    reason: str
    start: float
    seconds: float


class ReasonShare(NamedTuple):
    """All stops of one reason; ``share`` of the time of all, ``together`` with all greater ones."""

    reason: str
    times: int
    seconds: float
    share: float
    together: float


def pareto(stops: Iterable[Stop]) -> tuple[ReasonShare, ...]:
    """Reasons by the time they cost, the dearest first. Raises QualityError for a stop of negative length."""
    counts: dict[str, tuple[int, float]] = {}
    for stop in stops:
        if stop.seconds < 0.0:
            raise QualityError(
                Message(
                    "{reason}: the end of a stop is earlier than its start because the clock was set back",
                    reason=stop.reason,
                ),
                "clock-set-back",
            )
        count, seconds = counts.get(stop.reason, (0, 0.0))
        counts[stop.reason] = count + 1, seconds + stop.seconds
    total = sum(seconds for _, seconds in counts.values())
    rows, together = [], 0.0
    for reason, (count, seconds) in sorted(counts.items(), key=lambda item: (-item[1][1], item[0])):
        share = seconds / total if total else 0.0
        together += share
        rows.append(ReasonShare(reason, count, seconds, share, together))
    return tuple(rows)


def times_between(stops: Sequence[Stop]) -> tuple[float, ...]:
    """Seconds from the end of each stop to the beginning of the next, in the order of time.

    Stops that overlap leave no time between them.
    """
    ordered = sorted(stops, key=lambda stop: stop.start)
    between, end = [], None
    for stop in ordered:
        if end is not None:
            between.append(max(0.0, stop.start - end))
        end = max(end or stop.start, stop.start + stop.seconds)
    return tuple(between)


class Span(NamedTuple):
    """From ``start`` to ``end``, seconds of one clock."""

    start: float
    end: float


class Availability(NamedTuple):
    """Seconds of a shift, those in which a cycle ran, and their share."""

    planned: float
    producing: float

    @property
    def share(self) -> float:
        """0…1."""
        return self.producing / self.planned


def availability(shift: Span, running: Iterable[Span]) -> Availability:
    """Of a shift, from the spans in which a cycle ran; what overlaps counts once, what is outside not at all.

    Raises QualityError for a shift without length and for a span that ends before it begins.
    """
    if shift.end <= shift.start:
        raise QualityError(
            "the end of a shift must be later than its start; correct the shift times", "shift-times"
        )
    producing, reached = 0.0, shift.start
    for span in sorted(running):
        if span.end < span.start:
            raise QualityError(
                "the end of a cycle is earlier than its start because the clock was set back",
                "clock-set-back",
            )
        start, end = max(span.start, reached), min(span.end, shift.end)
        if end > start:
            producing += end - start
            reached = end
    return Availability(shift.end - shift.start, producing)
