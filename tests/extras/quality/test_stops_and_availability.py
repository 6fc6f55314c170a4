"""Pareto, time between stops and availability, by hand."""

from __future__ import annotations

import pytest

from core.extras.quality.control_charts import QualityError
from core.extras.quality.stops import Span, Stop, availability, pareto, times_between
from tests.coded import raises_code


def test_pareto() -> None:
    rows = pareto([Stop("DOOR", 0, 10), Stop("BAR", 50, 60), Stop("DOOR", 200, 20), Stop("HOLD", 300, 10)])
    assert [(row.reason, row.times, row.seconds) for row in rows] == [
        ("BAR", 1, 60),
        ("DOOR", 2, 30),
        ("HOLD", 1, 10),
    ]
    assert [row.share for row in rows] == pytest.approx([0.6, 0.3, 0.1])
    assert [row.together for row in rows] == pytest.approx([0.6, 0.9, 1.0])


def test_stops_that_cost_nothing_share_nothing() -> None:
    assert pareto([]) == ()
    assert pareto([Stop("A", 0, 0)])[0].share == 0.0


def test_time_between_stops() -> None:
    """From 10 to 50 forty, from 110 to 200 ninety; out of order they are put in order."""
    stops = [Stop("A", 0, 10), Stop("C", 200, 20), Stop("B", 50, 60)]
    assert times_between(stops) == (40, 90)
    assert times_between([Stop("A", 0, 100), Stop("B", 50, 10), Stop("C", 130, 1)]) == (0, 30)
    assert times_between([Stop("A", 0, 10)]) == ()


def test_availability() -> None:
    """Of 100 s: 10 of the first, 30 to 60 once although told twice, 90 to the end."""
    found = availability(Span(100, 200), [Span(0, 110), Span(130, 150), Span(140, 160), Span(190, 250)])
    assert (found.planned, found.producing, found.share) == (100, 50, 0.5)


def test_nothing_ran() -> None:
    assert availability(Span(0, 10), []).share == 0.0
    assert availability(Span(0, 10), [Span(10, 20)]).share == 0.0


@pytest.mark.parametrize("shift", [Span(10, 10), Span(10, 0)])
def test_a_shift_has_a_length(shift: Span) -> None:
    with raises_code(QualityError, "shift-times"):
        availability(shift, [])


def test_a_clock_that_was_set_back() -> None:
    with raises_code(QualityError, "clock-set-back"):
        availability(Span(0, 10), [Span(5, 4)])
    with raises_code(QualityError, "clock-set-back"):
        pareto([Stop("A", 5, -1)])
