"""Corners: a velocity step per setpoint interval, and chords that stand for a curve."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.motion.motion_plan import plan_motion
from tests.motion.moves import LIMITS, A, T, arc, chords, line, polyline, rounded_chords
from tests.motion.paths import build_path


def corner_speed(points: list[tuple[float, float]], feed: float = 100.0) -> float:
    path = build_path(polyline(points, feed), LIMITS)
    profile = plan_motion(path)
    return float(
        profile.compute_distances_and_speeds(profile.compute_times_at_distances(path.joint_distances[1:2]))[
            1
        ][0]
    )


def felt(points: list[tuple[float, float]], feed: float = 100.0) -> float:
    """Largest second difference of setpoints an interval apart, as a share of the acceleration."""
    profile = plan_motion(build_path(polyline(points, feed), LIMITS))
    worst = 0.0
    for begin in np.linspace(0.0, T, 8, endpoint=False):
        p = profile.compute_positions(np.arange(begin - 2 * T, profile.duration_s + 2 * T, T))
        worst = max(worst, float(np.abs(np.diff(p, 2, axis=0)).max()))
    return worst / T**2 / A


def test_a_right_angle_shares_an_interval_with_the_ramps() -> None:
    """Half an interval's change for the ramp out of it or into it, half for the turn.

    Setpoints half an interval off the corner show most: with x = vt + at²/2 behind it, a + v²/2aT².
    """
    corner = [(0.0, 0.0), (0.0, 50.0), (50.0, 50.0)]
    assert corner_speed(corner) == pytest.approx(A * T / 2)
    assert felt(corner) == pytest.approx(1.125, rel=0.01)


def test_a_reversal_is_a_stop() -> None:
    there_and_back = [(0.0, 0.0), (0.0, 50.0), (0.0, 0.0)]
    assert corner_speed(there_and_back) == 0.0
    assert felt(there_and_back) == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("degrees", [4.0, 20.0, 60.0])
def test_bend_needs_little_more_than_axis_acceleration(degrees: float) -> None:
    bend = math.radians(degrees)
    points = [(0.0, 0.0), (0.0, 50.0), (50 * math.sin(bend), 50 + 50 * math.cos(bend))]
    along = A / max(math.sin(bend), math.cos(bend))  # of the slanted line
    turn = max(math.sin(bend), 1.0 - math.cos(bend))
    assert corner_speed(points) == pytest.approx(A * T / turn - 0.5 * along * T)
    assert felt(points) < 1.13


@pytest.mark.parametrize("apart", [0.002, 0.008, 0.02, 0.1])
def test_two_corners_within_an_interval_share_it(apart: float) -> None:
    """Two bends of 15 degrees the same way; each alone would be passed at 10 mm/s, .01 mm an interval."""
    one, two = math.radians(15.0), math.radians(30.0)
    middle = (apart * math.sin(one), 20.0 + apart * math.cos(one))
    end = (middle[0] + 20.0 * math.sin(two), middle[1] + 20.0 * math.cos(two))
    assert felt([(0.0, 0.0), (0.0, 20.0), middle, end]) < 1.25


def test_straight_joint_does_not_slow_motion() -> None:
    assert corner_speed([(0, 0), (0, 50), (0, 100)]) == pytest.approx(100.0)


def test_tangential_joint_does_not_slow_motion() -> None:
    blocks = [
        line((0, 0), (0, 30), 60.0, n=1),
        arc((0, 30), (10, 40), (10, 30), 60.0, n=2),  # from +Z to +X, which is clockwise
        line((10, 40), (40, 40), 60.0, n=3),
    ]
    profile = plan_motion(build_path(blocks, LIMITS))
    assert profile.duration_s == pytest.approx((60.0 + 5.0 * math.pi) / 60.0 + 60.0 / A, rel=1e-9)


def test_half_circle_in_short_chords_is_as_fast_as_arc() -> None:
    """R 50 mm in 0.02 mm chords at 100 mm/s: the way at full feed plus one ramp."""
    profile = plan_motion(build_path(chords(50.0, math.pi, 7854, 100.0), LIMITS))
    ideal = math.pi * 50.0 / 100.0 + 100.0 / A
    assert ideal * (1.0 - 1e-4) < profile.duration_s < 1.01 * ideal


@pytest.mark.parametrize("chord", [0.002, 0.01, 0.05])
def test_chord_speed_is_centripetal_limit_for_any_chord_length(chord: float) -> None:
    """Axis by axis: at 45 degrees the acceleration is shared, so v² may be sqrt(2) of what an arc takes."""
    count = round(5.0 * math.pi / chord)
    profile = plan_motion(build_path(chords(5.0, math.pi, count, 127.0), LIMITS))
    limit = math.sqrt(0.8 * A * 5.0)
    on_axis = profile.compute_distances_and_speeds(profile.duration_s / 2)[1][0]
    assert on_axis == pytest.approx(limit, rel=0.02)
    assert profile.phases.start_speeds.max() <= limit * 2**0.25


def test_chords_do_not_exceed_axis_acceleration() -> None:
    """What a drive sees: second differences of setpoints, away from the start and the end."""
    profile = plan_motion(build_path(chords(5.0, math.pi, 3000, 127.0), LIMITS))
    t = np.arange(0.0, profile.duration_s, T)
    felt = np.abs(np.diff(profile.compute_positions(t), 2, axis=0)) / T**2
    assert felt.max() < 1.02 * A


def test_rounded_chords_are_as_fast_as_their_circle() -> None:
    """Four places of a millimetre on chords of 0.02 mm: a joint turns by up to half a degree to and fro."""
    profile = plan_motion(build_path(rounded_chords(7854, 100.0, 0.0001), LIMITS))
    assert profile.duration_s < 1.01 * (math.pi * 50.0 / 100.0 + 100.0 / A)
    felt = np.abs(np.diff(profile.compute_positions(np.arange(0.0, profile.duration_s, T)), 2, axis=0)) / T**2
    assert felt.max() < 1.02 * A


def test_a_coarse_grid_slows_the_chords() -> None:
    """Steps of .00005 in: joints turn by up to seven degrees, and an axis may step by amax · interval."""
    profile = plan_motion(build_path(rounded_chords(2000, 100.0, 0.00127), LIMITS))
    assert profile.duration_s > 1.5 * (40.0 / 100.0 + 100.0 / A)


def test_corner_between_short_chords_slows_motion() -> None:
    """A right angle in chords of 0.02 mm is passed as between long lines."""
    there = [(0.0, 0.02 * i) for i in range(200)]
    across = [(0.02 * i, 0.02 * 199) for i in range(1, 200)]
    path = build_path(polyline([*there, *across], 100.0), LIMITS)
    profile = plan_motion(path)
    assert float(
        profile.compute_distances_and_speeds(
            profile.compute_times_at_distances(path.joint_distances[199:200])
        )[1][0]
    ) == pytest.approx(A * T / 2)


def test_zero_length_block_is_not_a_corner() -> None:
    straight = corner_speed([(0, 0), (0, 50), (0, 100)])
    path = build_path(polyline([(0, 0), (0, 50), (0, 50), (0, 100)], 100.0), LIMITS)
    assert plan_motion(path).compute_distances_and_speeds(
        plan_motion(path).compute_times_at_distances(path.joint_distances[1:2])
    )[1][0] == pytest.approx(straight)
