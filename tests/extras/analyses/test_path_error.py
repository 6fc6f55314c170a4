"""Distances from a path, worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from core.extras.analyses.path_error import (
    calculate_path_error,
    calculate_path_error_from_samples,
    find_worst_deviations,
)
from core.records.record import AnalysisError
from tests.coded import raises_code


def test_late_axis_is_still_on_its_path() -> None:
    t = np.arange(1000) / 1000.0
    demand = np.column_stack([20.0 * t, 30.0 * t])
    actual = np.column_stack([20.0 * (t - 0.01), 30.0 * (t - 0.01)])
    error = calculate_path_error_from_samples(demand, actual, np.ones(1000), 1000.0)
    assert error.distances_mm[20:] == pytest.approx(0.0, abs=1e-12)
    assert error.path_positions_mm[20:] == pytest.approx(np.hypot(20.0, 30.0) * (t[20:] - 0.01))


def test_lag_of_one_axis_deviates_from_the_path() -> None:
    """x late by d on a line at 45°: the distance is d/√2, to the left of a way to the right above."""
    t = np.arange(1000) / 1000.0
    demand = np.column_stack([10.0 * t, 10.0 * t])
    actual = np.column_stack([10.0 * t - 0.02, 10.0 * t])
    error = calculate_path_error_from_samples(demand, actual, np.ones(1000), 1000.0)
    assert error.distances_mm[10:-10] == pytest.approx(0.02 / np.sqrt(2.0), abs=1e-9)


def test_lagging_circle_shrinks() -> None:
    """Of a first order lag τ at ω both sines shrink to 1/√(1+ω²τ²) of the radius."""
    t = np.arange(4000) / 1000.0
    omega, tau, r = 2.0 * np.pi * 0.5, 0.02, 10.0
    demand = r * np.column_stack([np.cos(omega * t), np.sin(omega * t)])
    gain, phase = 1.0 / np.hypot(1.0, omega * tau), np.arctan(omega * tau)
    actual = gain * r * np.column_stack([np.cos(omega * t - phase), np.sin(omega * t - phase)])
    error = calculate_path_error_from_samples(demand, actual, np.ones(4000), 1000.0)
    assert error.distances_mm[100:-100] == pytest.approx(r * (1.0 - gain), abs=2e-5)  # chords of .0000125 mm


def test_the_worst_lines_come_first() -> None:
    path = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]])
    x = np.linspace(0.5, 9.5, 10)
    measured = np.concatenate(
        [np.column_stack([x, np.full(10, 0.01)]), np.column_stack([np.full(10, 10.03), x])]
    )
    measured[14, 0] = 10.05
    due = np.repeat([0, 1], 10)
    worst = find_worst_deviations(calculate_path_error(path, np.array([7, 8, 8]), measured, due, 1))
    assert [each.line_number for each in worst] == [8, 7]
    assert worst[0].distance_mm == pytest.approx(-0.05)  # to the right of the way up
    assert worst[0].sample_index == 14
    assert worst[0].position == pytest.approx((10.0, x[4]))
    assert worst[1].distance_mm == pytest.approx(0.01)


def test_magnified_deviation_is_scaled_by_the_factor() -> None:
    path = np.array([[0.0, 0.0], [10.0, 0.0]])
    measured = np.column_stack([np.linspace(1, 9, 10), np.full(10, 0.01)])
    error = calculate_path_error(path, np.array([1, 1]), measured, np.zeros(10, dtype=np.int64), 1)
    assert error.magnify_deviation(100.0)[:, 1] == pytest.approx(1.0)
    assert error.magnify_deviation(100.0)[:, 0] == pytest.approx(measured[:, 0])


def test_samples_of_a_self_crossing_path_match_their_own_branch() -> None:
    """Up and back a hair's breadth apart: a sample of the way back belongs to that."""
    t = np.arange(500) / 1000.0
    up, back = np.column_stack([10 * t, 0 * t]), np.column_stack([10 * t[::-1], 0 * t + 0.01])
    demand = np.concatenate([up, back])
    lines = np.repeat([1.0, 2.0], 500)
    error = calculate_path_error_from_samples(
        demand, demand - (0.0, 0.006) * (lines == 2.0)[:, None], lines, 1000.0, delay_s=0.02
    )
    assert error.distances_mm[700:950] == pytest.approx(0.006)
    assert (error.line_numbers[700:950] == 2).all()


@pytest.mark.parametrize(
    ("demand", "code"),
    [
        (np.zeros((3, 2)), "too-few-samples"),
        (np.zeros((50, 2)), "at-rest"),
        (np.full((50, 2), np.nan), "no-positions"),
    ],
)
def test_invalid_path_is_rejected(demand: np.ndarray, code: str) -> None:
    with raises_code(AnalysisError, code):
        calculate_path_error_from_samples(demand, demand, np.ones(len(demand)), 1000.0)


def test_mismatched_arrays_are_rejected() -> None:
    path, measured = np.array([[0.0, 0.0], [1.0, 0.0]]), np.zeros((10, 2))
    with raises_code(AnalysisError, "lengths-differ"):
        calculate_path_error(path, np.array([1]), measured, np.zeros(10, dtype=np.int64), 1)
    with raises_code(AnalysisError, "lengths-differ"):
        calculate_path_error(path, np.array([1, 1]), measured, np.zeros(9, dtype=np.int64), 1)
