"""Profiles as pieces of constant axis acceleration, the form in which drivers take them."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import FloatArray, MotionLimits
from core.motion.motion_plan import plan_motion
from core.motion.motion_profile import SegmentArrays
from core.ports import MotionSegments
from tests.motion.moves import LIMITS, A, T, arc, line, polyline, programs
from tests.motion.paths import build_path

few = settings(max_examples=60, deadline=None)


def ends(segments: SegmentArrays) -> tuple[FloatArray, FloatArray]:
    """Position and velocity (n, 3) at the ends of the pieces."""
    _, dt, p, v, a = segments
    span = dt[:, None]
    return p + v * span + 0.5 * a * span**2, v + a * span


def evaluate(segments: SegmentArrays, t: FloatArray) -> FloatArray:
    """Positions (m, 3) at the times (m,), as a driver plays them."""
    start, _, p, v, a = segments
    k = np.clip(np.searchsorted(start, t, side="right") - 1, 0, len(start) - 1)
    tau = (t - start[k])[:, None]
    played: FloatArray = p[k] + v[k] * tau + 0.5 * a[k] * tau**2
    return played


def test_line_is_three_segments_in_driver_order() -> None:
    profile = plan_motion(build_path([line((0, 0), (0, 100), 100.0)], LIMITS))
    segments = MotionSegments(*profile.make_segments(0.0, math.inf, 7.0))
    assert segments.start_times_s == pytest.approx([7.0, 7.0 + 100 / A, 8.0])
    assert segments.velocities[:, 1] == pytest.approx([0.0, 100.0, 100.0])
    assert segments.accelerations[:, 1] == pytest.approx([A, 0.0, -A])


@pytest.mark.long
@few
@given(programs())
def test_segments_are_continuous_and_end_at_rest(blocks: list[Block]) -> None:
    profile = plan_motion(build_path(blocks, LIMITS))
    segments = profile.make_segments(0.0, profile.duration_s)
    t, dt, p, v, _ = segments
    end_p, end_v = ends(segments)
    # NumPy compares: pytest.approx takes a second for ten thousand segments
    assert np.abs((t + dt)[:-1] - t[1:]).max(initial=0.0) <= 1e-12
    assert np.abs(end_p[:-1] - p[1:]).max(initial=0.0) <= 1e-9
    # a corner's own step, and next to it what an arc's parts are off by (see the arcs below)
    assert np.abs(end_v[:-1] - v[1:])[:, :2].max(initial=0.0) <= 1.3 * A * T
    assert v[0] == pytest.approx(np.zeros(3), abs=A * T)
    assert end_v[-1] == pytest.approx(np.zeros(3), abs=1e-9)
    assert end_p[-1, :2] == pytest.approx([blocks[-1].x, blocks[-1].z], abs=1e-9)


@pytest.mark.long
@few
@given(programs())
def test_segments_follow_exact_motion_within_half_a_micrometer(blocks: list[Block]) -> None:
    profile = plan_motion(build_path(blocks, LIMITS))
    t = np.linspace(0.0, profile.duration_s, 3000, endpoint=False)
    played = evaluate(profile.make_segments(0.0, profile.duration_s), t)
    assert np.linalg.norm(played - profile.compute_positions(t), axis=1).max() < 5e-4


@pytest.mark.parametrize("radius", [0.002, 0.05, 0.16, 1.0, 6.6, 300.0])
def test_segments_of_any_arc_stay_on_arc(radius: float) -> None:
    profile = plan_motion(build_path([arc((0, radius), (0, -radius), (0, 0), 500.0)], LIMITS))
    segments = profile.make_segments(0.0, profile.duration_s)
    assert segments[1].max() <= 0.002 * (1 + 1e-9)
    x, z, _ = evaluate(segments, np.linspace(0.0, profile.duration_s, 5000, endpoint=False)).T
    assert np.abs(np.hypot(x, z) - radius).max() < 2.5e-4
    jumps = np.abs(ends(segments)[1][:-1] - segments[3][1:])
    assert jumps.max(initial=0.0) < 0.3 * A * T


def test_faster_machine_gets_shorter_segments() -> None:
    """R 1 mm at 30 m/s²: parts of 2 ms, or of a quarter radian, would leave the arc by 0.9 µm and more."""
    limits = MotionLimits(vmax=(500.0, 500.0, 1.0), amax=(30_000.0, 30_000.0, 1.0))
    profile = plan_motion(build_path([arc((0, 1), (0, -1), (0, 0), 500.0)], limits))
    t = np.linspace(0.0, profile.duration_s, 5000, endpoint=False)
    x, z, _ = evaluate(profile.make_segments(0.0, profile.duration_s), t).T
    assert np.abs(np.hypot(x, z) - 1.0).max() < 2.5e-4
    played = evaluate(profile.make_segments(0.0, profile.duration_s), t)
    assert np.linalg.norm(played - profile.compute_positions(t), axis=1).max() < 2.5e-4


@pytest.mark.long
@few
@given(programs(), st.lists(st.floats(0.0, 1.0), max_size=4))
def test_joined_windows_equal_whole_motion(blocks: list[Block], cuts: list[float]) -> None:
    profile = plan_motion(build_path(blocks, LIMITS))
    times = sorted({0.0, profile.duration_s, *(c * profile.duration_s for c in cuts)})
    windows = [profile.make_segments(a, b) for a, b in pairwise(times)]
    together = tuple(np.concatenate(column) for column in zip(*windows, strict=True))
    assert together[1].sum() == pytest.approx(profile.duration_s, rel=1e-9)
    t = np.linspace(0.0, profile.duration_s, 500, endpoint=False)
    played = evaluate((together[0], together[1], together[2], together[3], together[4]), t)
    assert np.linalg.norm(played - profile.compute_positions(t), axis=1).max() < 5e-4


def test_window_of_long_plan_converts_only_its_own_part() -> None:
    profile = plan_motion(build_path(polyline([(0, 0.02 * i) for i in range(20_000)], 100.0), LIMITS))
    t, dt, *_ = profile.make_segments(1.0, 1.01)
    assert t[0] == 1.0
    assert t[-1] + dt[-1] == pytest.approx(1.01, abs=1e-12)
    assert len(t) <= 52  # 1 mm at 0.02 mm a piece, cut at both ends


@pytest.mark.parametrize(("t_from", "t_to"), [(5.0, 9.0), (-2.0, -1.0), (0.4, 0.4)])
def test_a_window_outside_the_motion_is_empty(t_from: float, t_to: float) -> None:
    profile = plan_motion(build_path([line((0, 0), (0, 1))], LIMITS))
    assert [column.shape for column in profile.make_segments(t_from, t_to)] == [
        (0,),
        (0,),
        (0, 3),
        (0, 3),
        (0, 3),
    ]


def test_zero_length_motion_has_no_segments() -> None:
    profile = plan_motion(build_path([line((3, 4), (3, 4))], LIMITS))
    assert len(profile.make_segments(0.0, 1.0)[0]) == 0
    assert profile.compute_positions(0.0)[0] == pytest.approx([3.0, 4.0, 0.0])
    assert profile.find_block_numbers(0.0).tolist() == [0]
