"""Availability of the shift: the share of its time in which parts were made (ISO 22400-2)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from core.extras.quality.quality_errors import QualityError


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
