"""Spindle speed from surface speed."""

from __future__ import annotations

import math

import pytest

from core.geometry.surface_speed import find_surface_rpm


def test_rpm_follows_the_surface_speed_formula() -> None:
    """250 ft/min at r .25 in: 250·12/(2·pi·.25) = 1909.86 rpm."""
    assert find_surface_rpm(250 * 304.8 / 60, 0.25 * 25.4, 0.0, 9999.0) == pytest.approx(
        3000 / (0.5 * math.pi)
    )


@pytest.mark.parametrize(("radius", "rpm"), [(0.0, 2500.0), (0.001, 2500.0), (1e6, 80.0)])
def test_rpm_is_clamped_to_its_limits(radius: float, rpm: float) -> None:
    assert find_surface_rpm(1270.0, radius, 80.0, 2500.0) == rpm


def test_the_side_of_the_axis_does_not_matter() -> None:
    assert find_surface_rpm(1000.0, -7.0, 0.0, 9e9) == find_surface_rpm(1000.0, 7.0, 0.0, 9e9)


def test_the_upper_limit_wins_over_the_lower() -> None:
    assert find_surface_rpm(1000.0, 10.0, 3000.0, 2000.0) == 2000.0
