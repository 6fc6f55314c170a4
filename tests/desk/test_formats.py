"""Figures as the operator reads them, against values worked out by hand."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.desk.status import formats


@pytest.mark.parametrize(
    ("mm", "metric", "shown"),
    [
        (25.4, False, "1.00000"),
        (25.4, True, "25.4000"),
        (-12.7, False, "−0.50000"),
        (0.0, False, "0.00000"),
        (-0.0, True, "0.0000"),
        (-0.00001, True, "0.0000"),  # rounds to nothing: no sign
        (-0.00001, False, "0.00000"),  # .0000004 in
        (-0.000127, False, "−0.00001"),  # .000005 in: half a figure up
        (0.00005, True, "0.0001"),
        (-101.6, False, "−4.00000"),
    ],
)
def test_length_is_formatted_in_its_unit(mm: float, metric: bool, shown: str) -> None:
    assert formats.format_length(mm, metric) == shown


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_invalid_number_is_shown_as_a_dash(value: float) -> None:
    assert formats.format_length(value, is_metric=False) == "—"
    assert formats.format_duration(value) == "—"


@given(st.floats(-1000, 1000), st.booleans())
def test_negative_zero_is_shown_without_a_sign(mm: float, metric: bool) -> None:
    shown = formats.format_length(mm, metric)
    assert not (shown.startswith("−") and set(shown) <= set("−0."))


@given(st.floats(-1000, 1000))
def test_length_has_four_decimals_in_mm_and_five_in_inches(mm: float) -> None:
    assert len(formats.format_length(mm, is_metric=True).partition(".")[2]) == 4
    assert len(formats.format_length(mm, is_metric=False).partition(".")[2]) == 5


@pytest.mark.parametrize(
    ("value", "metric", "per_rev", "shown"),
    [
        (127.0, False, False, "300.00"),  # 300 in/min = 127 mm/s
        (0.127, False, True, "0.00500"),
        (2.0, True, False, "120.0"),
        (0.15, True, True, "0.1500"),
        (0.0, True, False, "0.0"),
    ],
)
def test_feed_is_formatted_in_its_unit(value: float, metric: bool, per_rev: bool, shown: str) -> None:
    assert formats.format_feed(value, metric, per_rev) == shown


@pytest.mark.parametrize(
    ("metric", "per_rev", "unit"),
    [(False, False, "in/min"), (False, True, "in/rev"), (True, False, "mm/min"), (True, True, "mm/rev")],
)
def test_feed_unit_depends_on_units_and_feed_mode(metric: bool, per_rev: bool, unit: str) -> None:
    assert formats.find_feed_unit(metric, per_rev) == unit


def test_surface_speed_has_no_sign() -> None:
    # 400 ft/min = 400 · 304.8 / 60 mm/s
    assert formats.format_surface_speed(-2032.0, is_metric=False) == "400"
    assert formats.format_surface_speed(-2000.0, is_metric=True) == "120"


@pytest.mark.parametrize(
    ("seconds", "shown"),
    [(0.0, "0:00"), (59.99, "0:59"), (60.0, "1:00"), (3599.0, "59:59"), (3661.0, "1:01:01"), (-1.0, "—")],
)
def test_duration_is_formatted(seconds: float, shown: str) -> None:
    assert formats.format_duration(seconds) == shown


@pytest.mark.parametrize(
    ("fraction", "shown"), [(1.0, "100 %"), (0.0, "0 %"), (1.5, "150 %"), (0.555, "56 %")]
)
def test_percentage_is_formatted(fraction: float, shown: str) -> None:
    assert formats.format_percent(fraction) == shown
