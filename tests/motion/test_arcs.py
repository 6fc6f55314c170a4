"""Arcs: sense of rotation, centripetal limit, vector sum, closed circles, bad centres."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.motion.axis_limits import MotionError
from core.motion.motion_plan import plan_motion
from tests.coded import raises_code
from tests.motion.moves import LIMITS, A, V, arc
from tests.motion.paths import build_path


def test_clockwise_arc_is_convex_corner_of_shaft() -> None:
    """X.1 Z0 to X.25 Z-.15 round (.1, -.15), inches: halfway at 45 degrees outside the corner."""
    block = arc((2.54, 0.0), (6.35, -3.81), (2.54, -3.81), 20.0)
    profile = plan_motion(build_path([block], LIMITS))
    halfway = profile.compute_positions(profile.duration_s / 2)[0]
    side = 3.81 / math.sqrt(2)
    assert halfway == pytest.approx([2.54 + side, -3.81 + side, 0.0], abs=1e-9)


def test_counterclockwise_arc_bulges_to_other_side() -> None:
    block = arc((2.54, 0.0), (6.35, -3.81), (2.54, -3.81), 20.0, clockwise=False)
    path = build_path([block], LIMITS)
    assert path.length == pytest.approx(3.81 * 1.5 * math.pi)
    middle = path.compute_positions(np.array([path.length / 2]))[0]
    assert middle[:2] == pytest.approx([2.54 - 3.81 / math.sqrt(2), -3.81 - 3.81 / math.sqrt(2)])


def test_arc_with_equal_ends_is_full_circle() -> None:
    path = build_path([arc((0, 10), (0, 10), (0, 0))], LIMITS)
    assert path.length == pytest.approx(20.0 * math.pi)


def test_speed_and_total_acceleration_on_arc_stay_within_limits() -> None:
    radius = 2.0
    profile = plan_motion(build_path([arc((0, radius), (0, radius), (0, 0), 500.0)], LIMITS))
    limit = math.sqrt(0.8 * A * radius)
    assert profile.phases.start_speeds.max() == pytest.approx(limit)
    assert np.abs(profile.phases.accelerations).max() == pytest.approx(0.6 * A)
    t = np.linspace(0.0, profile.duration_s, 4001)
    felt = np.diff(profile.compute_positions(t), 2, axis=0)[:, :2] / (t[1] - t[0]) ** 2
    assert np.hypot(*felt.T).max() <= A * (1.0 + 1e-6)


def test_wide_arc_is_limited_by_axis_speed() -> None:
    profile = plan_motion(build_path([arc((0, 900), (900, 0), (0, 0), 500.0)], LIMITS))
    assert profile.phases.start_speeds.max() == pytest.approx(V)


def test_a_slow_arc_may_use_nearly_all_the_acceleration() -> None:
    path = build_path([arc((0, 10), (10, 0), (0, 0), 10.0)], LIMITS)
    assert path.accelerations[0] == pytest.approx(
        math.sqrt(A**2 - (15.0**2 / 10.0) ** 2)
    )  # 15: half as much again


def test_arc_with_rounded_center_ends_exactly_at_end() -> None:
    block = arc((0, 10), (10, 0), (0.0005, -0.0008))
    profile = plan_motion(build_path([block], LIMITS))
    assert profile.compute_positions(np.array([0.0, profile.duration_s]))[:, :2] == pytest.approx(
        np.array([[0.0, 10.0], [10.0, 0.0]]), abs=1e-9
    )


def test_arc_with_wrong_center_is_rejected() -> None:
    with raises_code(MotionError, "arc-radii-differ", "Block 4", "10.0000", "9.9000"):
        build_path([arc((0, 10), (9.9, 0), (0, 0), n=4)], LIMITS)


def test_arc_with_zero_radius_does_not_move() -> None:
    path = build_path([arc((0, 10), (0, 10), (0, 10))], LIMITS)
    assert len(path) == 0
    assert plan_motion(path).duration_s == 0.0
