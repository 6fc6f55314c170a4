"""Ball-bar plots of arcs with errors that are put in by formula."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.extras.analyses.path_error import analyze_ball_bar, find_arcs, fit_circle
from core.records.record import AnalysisError
from tests.coded import raises_code

R = 25.0
T = np.linspace(0.0, 2.0 * math.pi, 7201)


def arc(angle: np.ndarray, r: float = R) -> np.ndarray:
    return np.column_stack([40.0 + r * np.cos(angle), -60.0 + r * np.sin(angle)])


def with_play(demand: np.ndarray, bu: float, bv: float) -> np.ndarray:
    """The slide stays half the play behind, on the side that it comes from."""
    way = np.sign(np.gradient(demand, axis=0))
    actual: np.ndarray = demand - 0.5 * np.array([bu, bv]) * way
    return actual


def test_circle_is_fitted_through_points() -> None:
    u, v, r = fit_circle(arc(np.array([0.1, 0.9, 2.0, 2.1])))
    assert (u, v, r) == pytest.approx((40.0, -60.0, R))


def test_perfect_arc_has_zero_errors() -> None:
    found = analyze_ball_bar(arc(T), arc(T))
    assert found.radius_mm == pytest.approx(R)
    assert found.circularity_mm == pytest.approx(0.0, abs=1e-9)
    assert found.arc_angle_deg == pytest.approx(360.0)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_backlash_is_separated_by_axis(way: float) -> None:
    found = analyze_ball_bar(arc(way * T), with_play(arc(way * T), 0.012, 0.005))
    assert found.backlash_mm == pytest.approx((0.012, 0.005), abs=1e-4)
    assert found.squareness_error_mm_m == pytest.approx(0.0, abs=0.02)
    assert found.scale_error_mm_m == pytest.approx(0.0, abs=0.02)


def test_squareness_and_scale_errors_are_measured() -> None:
    """v leans by 80 µm a metre towards u; u is 60 µm a metre longer than v."""
    at = arc(T) - (40.0, -60.0)
    lean = np.array([[1.0 + 60e-6, 80e-6], [0.0, 1.0]])
    seen = at @ lean.T + np.array([40.0, -60.0])
    found = analyze_ball_bar(arc(T), seen)
    assert found.squareness_error_mm_m == pytest.approx(0.080, abs=1e-4)
    assert found.scale_error_mm_m == pytest.approx(0.060, abs=1e-4)
    assert found.size_error_mm == pytest.approx(0.5 * 60e-6 * R, abs=1e-6)
    assert found.backlash_mm == pytest.approx((0.0, 0.0), abs=1e-5)


def test_lag_reduces_the_size_but_not_the_roundness() -> None:
    found = analyze_ball_bar(arc(T), arc(T - 0.01, R * 0.999))
    assert found.size_error_mm == pytest.approx(-0.001 * R, abs=1e-6)
    assert found.circularity_mm == pytest.approx(0.0, abs=1e-6)


def test_reversal_spike_is_assigned_to_its_axis() -> None:
    """v reverses at 90° and 270°, u at 0° and 180°: a bump of 8 µm half a degree behind 90°."""
    bump = 0.008 * np.exp(-(((np.degrees(T) - 90.5) / 0.4) ** 2))
    seen = arc(T) + bump[:, None] * np.column_stack([np.cos(T), np.sin(T)])
    found = analyze_ball_bar(arc(T), seen)
    assert found.reversal_spike_mm[1] == pytest.approx(0.008, abs=4e-4)
    assert found.reversal_spike_mm[0] < 0.001


def test_short_arc_gives_only_its_size() -> None:
    part = np.radians(np.linspace(10.0, 80.0, 2000))
    found = analyze_ball_bar(arc(part), with_play(arc(part), 0.01, 0.01))
    assert math.isnan(found.backlash_mm[0])
    assert math.isnan(found.squareness_error_mm_m)
    assert found.arc_angle_deg == pytest.approx(70.0, abs=0.1)


@pytest.mark.parametrize(
    ("demand", "code"),
    [
        (arc(T)[:10], "too-few-samples"),
        (np.column_stack([np.linspace(0, 9, 500), np.zeros(500)]), "no-arc"),
        (arc(np.radians(np.linspace(0, 20, 500))), "arc-too-short"),
        (np.full((500, 2), np.nan), "no-positions"),
        (arc(T) + np.column_stack([0 * T, 0.1 * np.sin(5 * T)]), "no-arc"),
    ],
)
def test_invalid_arc_is_rejected(demand: np.ndarray, code: str) -> None:
    with raises_code(AnalysisError, code):
        analyze_ball_bar(demand, demand)


def test_arcs_are_found_by_their_lines() -> None:
    straight = np.column_stack([np.linspace(0, 65, 300), np.full(300, -60.0)])
    demand = np.concatenate([straight, arc(T[::20]), straight[::-1]])
    lines = np.repeat([3.0, 4.0, 5.0], [300, len(T[::20]), 300])
    ((line, part),) = find_arcs(demand, lines)
    assert line == 4
    assert (part.start, part.stop) == (300, 300 + len(T[::20]))
    assert find_arcs(straight, np.full(300, 3.0)) == ()
    assert find_arcs(np.empty((0, 2)), np.empty(0)) == ()
