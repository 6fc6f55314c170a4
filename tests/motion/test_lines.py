"""Times of straight moves that can be worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import BlockKind
from core.motion.axis_limits import MotionError, MotionLimits
from core.motion.motion_plan import plan_motion
from tests.coded import raises_code
from tests.motion.moves import LIMITS, A, V, line, polyline
from tests.motion.paths import build_path


def test_long_line_has_trapezoidal_speed() -> None:
    profile = plan_motion(build_path([line((0, 0), (0, 100), 100.0)], LIMITS))
    assert profile.duration_s == pytest.approx(100.0 / 100.0 + 100.0 / A, rel=1e-12)
    assert profile.phases.start_speeds.max() == pytest.approx(100.0)


def test_short_line_has_triangular_speed() -> None:
    profile = plan_motion(build_path([line((0, 0), (1, 0), 100.0)], LIMITS))
    assert profile.duration_s == pytest.approx(2.0 * math.sqrt(1.0 / A), rel=1e-12)
    assert profile.compute_distances_and_speeds(profile.duration_s / 2)[1][0] == pytest.approx(math.sqrt(A))


def test_diagonal_uses_speed_of_both_axes() -> None:
    """At 45 degrees the path may run and accelerate sqrt(2) faster than each slide."""
    rapid = line((0, 0), (200, 200), 10 * V, kind=BlockKind.RAPID)
    v, a = math.sqrt(2) * V, math.sqrt(2) * A
    profile = plan_motion(build_path([rapid], LIMITS))
    assert profile.duration_s == pytest.approx(200 * math.sqrt(2) / v + v / a, rel=1e-12)


def test_slower_axis_limits_line() -> None:
    limits = MotionLimits(vmax=(10.0, 127.0, 1.0), amax=(100.0, 3048.0, 1.0))
    profile = plan_motion(build_path([line((0, 0), (30, 40), 127.0)], limits))
    v, a = 10.0 / 0.6, 100.0 / 0.6
    assert profile.duration_s == pytest.approx(50.0 / v + v / a, rel=1e-12)


def test_offsets_convert_to_machine_coordinates() -> None:
    block = replace(line((1, 2), (3, 4)), offset_x=10.0, offset_z=-20.0)
    profile = plan_motion(build_path([block], LIMITS))
    assert profile.compute_positions(np.array([0.0, profile.duration_s])) == pytest.approx(
        np.array([[11.0, -18.0, 0.0], [13.0, -16.0, 0.0]]), abs=1e-12
    )


def test_c_alone_turns_in_degrees() -> None:
    block = replace(line((5, 5), (5, 5), 600.0), c=360.0)
    profile = plan_motion(build_path([block], LIMITS))
    assert profile.duration_s == pytest.approx(360.0 / 600.0 + 600.0 / 12000.0, rel=1e-12)


def test_c_limits_linear_axis_that_moves_with_it() -> None:
    """10 degrees per mm: 1200 degrees/s allow 120 mm/s, 12000 degrees/s² allow 1200 mm/s²."""
    block = replace(line((0, 0), (0, 100), 127.0), c=1000.0)
    profile = plan_motion(build_path([block], LIMITS))
    assert profile.duration_s == pytest.approx(100.0 / 120.0 + 120.0 / 1200.0, rel=1e-12)


@pytest.mark.parametrize("parts", [2, 7, 100])
def test_splitting_line_does_not_change_motion(parts: int) -> None:
    whole = plan_motion(build_path([line((0, 0), (30, 40), 80.0)], LIMITS))
    points = [(30.0 * i / parts, 40.0 * i / parts) for i in range(parts + 1)]
    cut = plan_motion(build_path(polyline(points, 80.0), LIMITS))
    assert cut.duration_s == pytest.approx(whole.duration_s, rel=1e-9)
    t = np.linspace(0.0, whole.duration_s, 50)
    assert cut.compute_positions(t) == pytest.approx(whole.compute_positions(t), abs=1e-9)


def test_half_feed_doubles_time() -> None:
    path = build_path([line((0, 0), (0, 300), 20.0)], LIMITS)
    half = plan_motion(path, feed_scale=0.5)
    assert half.duration_s == pytest.approx(300.0 / 10.0 + 10.0 / A, rel=1e-12)


def test_rapid_override_does_not_change_feeds() -> None:
    path = build_path([line((0, 0), (0, 50), 100.0, kind=BlockKind.RAPID)], LIMITS)
    assert plan_motion(path, feed_scale=0.1).duration_s == plan_motion(path).duration_s
    assert plan_motion(path, rapid_scale=0.5).duration_s == pytest.approx(50.0 / 50.0 + 50.0 / A, rel=1e-12)


@pytest.mark.parametrize(
    ("feed", "code"),
    [(0.0, "no-feed"), (-1.0, "no-feed"), (math.nan, "not-a-number"), (math.inf, "not-a-number")],
)
def test_a_feed_must_be_a_positive_number(feed: float, code: str) -> None:
    with raises_code(MotionError, code, "Block 7", "feed"):
        build_path([line((0, 0), (0, 1), feed, n=7)], LIMITS)


@pytest.mark.parametrize("word", ["x", "z0", "c", "offset_x"])
def test_a_coordinate_must_be_a_number(word: str) -> None:
    figures: dict[str, Any] = {word: math.nan}
    with raises_code(MotionError, "not-a-number", f"Block 3: {word} "):
        build_path([replace(line((0, 0), (0, 1), n=3), **figures)], LIMITS)


def test_block_kind_without_motion_is_rejected() -> None:
    with raises_code(MotionError, "no-time-law", "Block 1"):
        build_path([line((0, 0), (0, 1), kind=BlockKind.DWELL)], LIMITS)


@pytest.mark.parametrize(
    ("figures", "named"),
    [
        ({"vmax": (0.0, 1.0, 1.0)}, "vmax of axis 1"),
        ({"amax": (1.0, -1.0, 1.0)}, "amax of axis 2"),
        ({"amax": (1.0, 1.0, math.nan)}, "amax of axis 3"),
        ({"interval": 0.0}, "interval"),
    ],
)
def test_limits_must_be_positive(figures: dict[str, Any], named: str) -> None:
    with raises_code(MotionError, "axis-limit", named):
        MotionLimits(**figures)


@pytest.mark.parametrize("scale", [-0.1, 1.6, math.nan])
def test_an_override_outside_its_range_is_refused(scale: float) -> None:
    path = build_path([line((0, 0), (0, 1))], LIMITS)
    with raises_code(MotionError, "feed-override"):
        plan_motion(path, feed_scale=scale)
    with raises_code(MotionError, "rapid-override"):
        plan_motion(path, rapid_scale=scale)
