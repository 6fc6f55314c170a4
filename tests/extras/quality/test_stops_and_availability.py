"""Pareto, time between stops and availability, by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from app.desk.arithmetic import InvalidEntryError
from app.extras.quality.charts_and_trends import TrendsSection
from core.extras.quality.control_charts import QualityError
from core.extras.quality.production_stops import (
    ProductionStop,
    TimeSpan,
    analyze_stop_reasons,
    calculate_availability,
    calculate_times_between,
)
from tests.coded import raises_code


def test_stop_reasons_are_ranked_by_duration() -> None:
    rows = analyze_stop_reasons(
        [
            ProductionStop("DOOR", 0, 10),
            ProductionStop("BAR", 50, 60),
            ProductionStop("DOOR", 200, 20),
            ProductionStop("HOLD", 300, 10),
        ]
    )
    assert [(row.reason, row.times, row.seconds) for row in rows] == [
        ("BAR", 1, 60),
        ("DOOR", 2, 30),
        ("HOLD", 1, 10),
    ]
    assert [row.share for row in rows] == pytest.approx([0.6, 0.3, 0.1])
    assert [row.together for row in rows] == pytest.approx([0.6, 0.9, 1.0])


def test_zero_length_stops_have_zero_share() -> None:
    assert analyze_stop_reasons([]) == ()
    assert analyze_stop_reasons([ProductionStop("A", 0, 0)])[0].share == 0.0


def test_time_between_stops_is_calculated_in_order() -> None:
    """From 10 to 50 forty, from 110 to 200 ninety; out of order they are put in order."""
    stops = [ProductionStop("A", 0, 10), ProductionStop("C", 200, 20), ProductionStop("B", 50, 60)]
    assert calculate_times_between(stops) == (40, 90)
    assert calculate_times_between(
        [ProductionStop("A", 0, 100), ProductionStop("B", 50, 10), ProductionStop("C", 130, 1)]
    ) == (0, 30)
    assert calculate_times_between([ProductionStop("A", 0, 10)]) == ()


def test_availability_counts_overlapping_stops_once() -> None:
    """Of 100 s: 10 of the first, 30 to 60 once although told twice, 90 to the end."""
    found = calculate_availability(
        TimeSpan(100, 200), [TimeSpan(0, 110), TimeSpan(130, 150), TimeSpan(140, 160), TimeSpan(190, 250)]
    )
    assert (found.planned_s, found.producing_s, found.producing_fraction) == (100, 50, 0.5)


def test_shift_without_production_has_zero_share() -> None:
    assert calculate_availability(TimeSpan(0, 10), []).producing_fraction == 0.0
    assert calculate_availability(TimeSpan(0, 10), [TimeSpan(10, 20)]).producing_fraction == 0.0


@pytest.mark.parametrize("shift", [TimeSpan(10, 10), TimeSpan(10, 0)])
def test_shift_without_a_length_is_rejected(shift: TimeSpan) -> None:
    with raises_code(QualityError, "shift-times"):
        calculate_availability(shift, [])


def test_clock_set_back_is_rejected() -> None:
    with raises_code(QualityError, "clock-set-back"):
        calculate_availability(TimeSpan(0, 10), [TimeSpan(5, 4)])
    with raises_code(QualityError, "clock-set-back"):
        analyze_stop_reasons([ProductionStop("A", 5, -1)])


@pytest.mark.parametrize("text", ["²-14", "6-²", "①-14", "25-3", "6-25", "6", "-", "6-14-20", "6.5-14"])
def test_invalid_shift_hours_are_rejected(text: str) -> None:
    untouched: Any = None
    with pytest.raises(InvalidEntryError):
        TrendsSection.accept_entry(untouched, text)


def test_only_digits_and_a_hyphen_are_keys_of_the_shift_hours() -> None:
    section: Any = SimpleNamespace(selected_trend="AVAILABILITY")
    accepted = [key for key in "6²①½-.x" if TrendsSection.accepts_key(section, key)]
    assert accepted == ["6", "-"]
