"""A Cpk worked by hand; too few readings promise nothing."""

from __future__ import annotations

import math

import pytest

from core.extras.quality.control_charts import MIN_READINGS, QualityError, calculate_capability
from tests.coded import raises_code

TEN = [9.99, 10.01] * 5


def test_capability_matches_hand_calculation() -> None:
    """Every moving range is .02, so sigma within is .02/1.128; all of it s = .01 √(10/9)."""
    found = calculate_capability(TEN, 9.95, 10.08)
    assert found.mean == pytest.approx(10.0)
    assert found.cp == pytest.approx(0.13 * 1.128 / 0.12)  # 1.222
    assert found.cpk == pytest.approx(0.94)  # .05 · 1.128 / .06: the lower limit is nearer
    assert found.pp == pytest.approx(0.13 / (0.06 * math.sqrt(10 / 9)))
    assert found.ppk == pytest.approx(1.581139, abs=1e-6)


def test_cpk_lower_bound_of_ten_readings_matches_hand_calculation() -> None:
    """.94 − 1.645 √(1/90 + .8836/18)."""
    assert calculate_capability(TEN, 9.95, 10.08).cpk_lower_bound == pytest.approx(0.536388, abs=1e-5)


def test_within_sigma_of_samples_comes_from_the_range() -> None:
    """Five samples of two, each range .02: the same sigma; samples of five have d2 2.326."""
    assert calculate_capability(TEN, 9.95, 10.08, 2).cpk == pytest.approx(0.94)
    assert calculate_capability(TEN, 9.95, 10.08, 5).cpk == pytest.approx(0.05 * 2.326 / 0.06)


def test_one_sided_tolerance_has_no_cp() -> None:
    found = calculate_capability(TEN, None, 10.05)
    assert (found.cp, found.pp) == (None, None)
    assert found.cpk == pytest.approx(0.94)


def test_mean_outside_the_limits_gives_a_negative_cpk() -> None:
    assert (calculate_capability(TEN, 9.8, 9.95).cpk or 0) == pytest.approx(-0.94)


def test_readings_without_scatter_have_no_cpk() -> None:
    found = calculate_capability([10.0] * 12, 9.9, 10.1)
    assert (found.cpk, found.cp, found.cpk_lower_bound) == (None, None, None)


@pytest.mark.parametrize(
    ("count", "lower", "upper", "code"),
    [
        (MIN_READINGS - 1, 9.9, 10.1, "too-few-readings"),
        (0, 9.9, 10.1, "too-few-readings"),
        (MIN_READINGS, None, None, "no-tolerance"),
        (MIN_READINGS, 10.1, 9.9, "limits-reversed"),
        (MIN_READINGS, 10.0, 10.0, "limits-reversed"),
    ],
)
def test_invalid_input_is_rejected(count: int, lower: float | None, upper: float | None, code: str) -> None:
    with raises_code(QualityError, code):
        calculate_capability(TEN[:count], lower, upper)
