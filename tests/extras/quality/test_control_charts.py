"""Limits by hand from the published constants; what has no chart is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.extras.quality.control_charts import (
    CHART_FACTORS,
    ControlChart,
    QualityError,
    make_charts,
    make_individuals_charts,
    make_xbar_r_charts,
)
from tests.coded import raises_code


def test_xbar_r_limits_of_samples_of_two_match_hand_calculation() -> None:
    """Means 11 12 13, ranges 2 2 2: 12 ± 1.880 · 2, and 3.267 · 2 for the range."""
    pair = make_xbar_r_charts([(10, 12), (11, 13), (14, 12)])
    assert pair.location.point_values.tolist() == [11, 12, 13]
    assert (pair.location.lower_limit, pair.location.center_line, pair.location.upper_limit) == pytest.approx(
        (8.24, 12, 15.76)
    )
    assert (pair.spread.lower_limit, pair.spread.center_line, pair.spread.upper_limit) == pytest.approx(
        (0, 2, 6.534)
    )
    assert pair.within_sigma == pytest.approx(2 / 1.128)


def test_xbar_r_limits_of_samples_of_five_match_montgomery() -> None:
    """A2 .577, D3 0, D4 2.114 at an average range of .32521 and a mean of 1.5056 (Montgomery)."""
    half = 0.32521 / 2
    rows = [(1.5056 - half, 1.5056 - half / 2, 1.5056, 1.5056 + half / 2, 1.5056 + half)] * 3
    pair = make_xbar_r_charts(rows)
    assert pair.location.upper_limit == pytest.approx(1.69325, abs=2e-5)
    assert pair.location.lower_limit == pytest.approx(1.31795, abs=2e-5)
    assert pair.spread.upper_limit == pytest.approx(0.68749, abs=2e-5)


def test_individuals_chart_matches_hand_calculation() -> None:
    """Values 10 12 11 13: moving ranges 2 1 2, mean 5/3; 11.5 ± 3/1.128 · 5/3, 3.267 · 5/3."""
    pair = make_individuals_charts([10, 12, 11, 13])
    assert pair.location.upper_limit == pytest.approx(11.5 + 3 / 1.128 * 5 / 3)
    assert pair.location.lower_limit == pytest.approx(11.5 - 3 / 1.128 * 5 / 3)
    assert pair.spread.point_values.tolist() == [2, 1, 2]
    assert pair.spread.upper_limit == pytest.approx(5.445)


@pytest.mark.parametrize("size", range(2, 11))
def test_chart_factors_are_consistent(size: int) -> None:
    """A2 is 3/(d2 √n); D3 and D4 lie as far from 1 on both sides, where D3 is not cut off at 0."""
    a2, d3, d4, d2 = CHART_FACTORS[size]
    assert a2 == pytest.approx(3 / (d2 * math.sqrt(size)), abs=1e-3)
    assert d3 == 0 or d3 + d4 == pytest.approx(2, abs=1e-3)


def test_d2_is_the_mean_range_of_a_normal_sample() -> None:
    drawn = np.random.default_rng(15).standard_normal((200_000, 10))
    for size, factors in CHART_FACTORS.items():
        assert np.ptp(drawn[:, :size], axis=1).mean() == pytest.approx(factors.d2, rel=0.005)


def test_incomplete_sample_is_not_charted() -> None:
    assert len(make_charts([1, 2, 3, 4, 5], 2).location.point_values) == 2
    assert len(make_charts([1, 2, 3, 4, 5], 1).location.point_values) == 5


def test_limits_are_stable_from_twenty_points() -> None:
    assert not ControlChart(np.zeros(19), 0, -1, 1).has_stable_limits
    assert ControlChart(np.zeros(20), 0, -1, 1).has_stable_limits


@pytest.mark.parametrize(
    ("values", "size", "code"),
    [
        ([1.0], 1, "too-few-readings"),
        ([], 1, "too-few-readings"),
        ([1, 2, 3], 2, "too-few-readings"),
        ([1, 2, 3], 11, "sample-size"),
        ([1, 2, 3], 0, "sample-size"),
        ([1, math.nan, 3], 1, "not-a-number"),
        ([1, 2, 3, math.inf], 2, "not-a-number"),
    ],
)
def test_invalid_values_or_sample_size_are_rejected(values: list[float], size: int, code: str) -> None:
    with raises_code(QualityError, code):
        make_charts(values, size)


@pytest.mark.parametrize(
    "samples", [[1, 2, 3], [[1.0, 2.0], [1.0]], [[], []], [[1.0], [2.0]], [list(range(11))]]
)
def test_samples_without_one_size_of_2_to_10_are_rejected(samples: list[object]) -> None:
    with raises_code(QualityError, "sample-size"):
        make_xbar_r_charts(samples)  # type: ignore[arg-type]
