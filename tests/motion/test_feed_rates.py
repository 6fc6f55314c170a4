"""Feeds per revolution and constant surface speed."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from core.geometry.surface_speed import find_surface_rpm
from core.geometry.working_plane import AxisMove
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from core.motion.axis_limits import MotionError
from core.motion.block_table import build_block_table
from core.motion.motion_plan import plan_motion
from core.motion.speed_limits import find_surface_rpms
from tests.coded import raises_code
from tests.motion.moves import LIMITS, A, Point, arc, line
from tests.motion.paths import build_path

SURFACE = 2000.0  # mm/s


def turning(start: Point, end: Point, **words: Any) -> Block:
    """A move at 0.1 mm per revolution under constant surface speed, clamped at 3000 rpm."""
    modal = ModalState(max_css_rpm=3000.0)
    block = replace(line(start, end, 0.1), per_rev=True, rpm=500.0, css=SURFACE, modal=modal)
    return replace(block, **words)


def test_feed_per_revolution_applies_in_both_spindle_directions() -> None:
    for rpm in (1200.0, -1200.0):
        block = replace(line((0, 0), (0, 50), 0.5), per_rev=True, rpm=rpm)
        assert build_path([block], LIMITS).pieces.rate == pytest.approx([10.0])


def test_operator_speed_limit_reduces_feed_per_revolution() -> None:
    block = replace(line((0, 0), (0, 50), 0.5), per_rev=True, rpm=1200.0)
    assert build_path([block], LIMITS, rpm_max=600.0).pieces.rate == pytest.approx([5.0])


def test_facing_time_follows_increasing_spindle_speed() -> None:
    """dt = dr / (f·S/(2·pi·r)): from r 100 to 50 the time is pi·(100² - 50²)/(f·S)."""
    profile = plan_motion(build_path([turning((100, 0), (50, 0))], LIMITS))
    ideal = math.pi * (100.0**2 - 50.0**2) / (0.1 * SURFACE)
    assert profile.duration_s == pytest.approx(ideal, rel=1e-4)


def test_the_speed_changes_by_two_percent_at_most_within_a_piece() -> None:
    path = build_path([turning((100, 0), (50, 0))], LIMITS)
    ends = path.pieces.point(path.pieces.length)[:, 0]
    assert (path.pieces.start[:, 0] / ends).max() <= 1.02 + 1e-9
    assert len(path) == 36  # ln 2 / ln 1.02 = 35.003
    assert path.block_numbers.tolist() == [1]


def test_feed_is_constant_at_upper_speed_limit() -> None:
    """3000 rpm are reached at r = 2000·60/(2·pi·3000) = 6.366 mm: no split inside, through the axis."""
    path = build_path([turning((6.0, 0), (-6.0, 0))], LIMITS)
    assert path.pieces.rate == pytest.approx([0.1 * 3000.0 / 60.0] * len(path))
    assert len(path) <= 2


def test_facing_to_center_is_limited_in_speed_and_pieces() -> None:
    path = build_path([turning((100, 0), (0, 0))], LIMITS)
    assert path.pieces.rate.max() == pytest.approx(5.0)
    assert path.length == pytest.approx(100.0)
    assert len(path) <= 2 + math.log(100 / 6.366) / math.log(1.02)


def test_lower_speed_limit_applies_at_large_radius() -> None:
    path = build_path(
        [turning((100, 0), (200, 0), modal=ModalState(min_css_rpm=400.0, max_css_rpm=3000.0))], LIMITS
    )
    assert path.pieces.rate == pytest.approx([0.1 * 400.0 / 60.0])


def test_radius_is_measured_from_program_axis() -> None:
    """X offsets move the machine, not the part: the tool stands at r 50 wherever the slide is."""
    path = build_path([turning((50, 0), (50, 20), offset_x=-300.0)], LIMITS)
    assert path.pieces.rate == pytest.approx([0.1 * SURFACE / (2 * math.pi * 50.0)])


def test_arc_at_surface_speed_is_split_and_remains_arc() -> None:
    quarter = replace(turning((20, 50), (60, 10)), kind=BlockKind.ARC, cx=20.0, cz=10.0, clockwise=True)
    path = build_path([quarter], LIMITS)
    assert len(path) >= math.log(3) / math.log(1.02)
    assert path.length == pytest.approx(20.0 * math.pi)
    x, z, _ = path.compute_positions(np.linspace(0.0, path.length, 100)).T
    assert np.hypot(x - 20.0, z - 10.0) == pytest.approx(np.full(100, 40.0), abs=1e-9)
    ends = path.pieces.point(path.pieces.length)[:, 0]
    assert (ends / path.pieces.start[:, 0]).max() < 1.03


def test_rapids_do_not_depend_on_spindle() -> None:
    block = replace(line((0, 0), (0, 50), 100.0, kind=BlockKind.RAPID), per_rev=True, rpm=0.0)
    assert plan_motion(build_path([block], LIMITS)).duration_s == pytest.approx(0.5 + 100.0 / A)


def test_feed_per_revolution_with_the_spindle_stopped_is_refused() -> None:
    block = replace(line((0, 0), (0, 50), 0.5, n=9), per_rev=True)
    with raises_code(MotionError, "spindle-stopped", "Block 9"):
        build_path([block], LIMITS)


def test_surface_speed_at_axis_without_limit_is_rejected() -> None:
    with raises_code(MotionError, "no-speed-limit"):
        build_path([turning((0, 0), (0, 9), modal=ModalState())], LIMITS)
    with raises_code(MotionError, "no-speed-limit"):
        build_path([turning((9, 0), (0, 0), modal=ModalState())], LIMITS)


def test_invalid_surface_speed_is_rejected() -> None:
    with raises_code(MotionError, "surface-speed", "Block 1"):
        build_path([turning((10, 0), (20, 0), css=math.nan)], LIMITS)
    with raises_code(MotionError, "surface-speed", "Block 1"):
        build_path([turning((10, 0), (20, 0), css=-5.0)], LIMITS)


@pytest.mark.parametrize("radius", [0.0, 1e-9, 5.0, -5.0, 20.0, 1e4])
def test_array_and_scalar_speeds_agree(radius: float) -> None:
    words = build_block_table(
        [turning((1, 0), (2, 0), modal=ModalState(min_css_rpm=30.0, max_css_rpm=2500.0))], 2000.0
    )
    assert find_surface_rpms(words, np.array([radius]))[0] == find_surface_rpm(SURFACE, radius, 30.0, 2000.0)


def test_an_arc_at_feed_per_minute_is_not_split() -> None:
    block = replace(arc((20, 50), (60, 10), (20, 10)), css=SURFACE, rpm=500.0)
    assert len(build_path([block], LIMITS)) == 1


def test_low_feed_is_not_rounded_to_zero() -> None:
    """.4 mm/s, and .5 mm a turn at .6 rpm, which is .005 mm/s: both above zero, and run as they are."""
    assert build_path([line((0, 0), (0, 5), 0.4)], LIMITS).pieces.rate == pytest.approx([0.4])
    block = replace(line((0, 0), (0, 0.1), 0.5), per_rev=True, rpm=0.6)
    assert build_path([block], LIMITS).pieces.rate == pytest.approx([0.005])


def test_path_close_to_axis_is_not_at_axis() -> None:
    """From r .9 to .5 without an upper limit: the axis is not crossed, and nothing is refused.

    At r .9 and .5 mm the speed is S/(2·pi·r); at .1 mm a turn the feed grows as 1/r.
    """
    modal = ModalState(max_css_rpm=None)
    path = build_path([turning((0.9, 0), (0.5, 0), modal=modal)], LIMITS, rpm_max=math.inf)
    first, last = path.pieces.rate[0], path.pieces.rate[-1]
    assert first == pytest.approx(0.1 * SURFACE / (2.0 * math.pi * 0.9), rel=0.03)
    assert last == pytest.approx(0.1 * SURFACE / (2.0 * math.pi * 0.5), rel=0.03)
    assert path.pieces.start[:, 0].min() >= 0.5
    assert np.all(path.pieces.length > 0.0)


def test_blocks_with_and_without_all_axes_cannot_be_mixed() -> None:
    whole = line((0, 0), (0, 5), n=4)
    travel = AxisMove((0.0, 0.0, 0.0), (0.0, 5.0, 0.0), 5.0)
    with raises_code(MotionError, "axes-differ", "Block 4"):
        build_block_table([replace(whole, travel=travel), line((0, 5), (0, 6), n=5)], 3000.0)


def test_radius_of_surface_speed_uses_program_axis_offset() -> None:
    """Slides at 25 to 15 mm with the axis at 20: r 5 to -5, through it. With the axis at home: r 25 to 15."""
    modal = ModalState(max_css_rpm=None)
    through = turning((5, 0), (-5, 0), modal=modal, offset_x=20.0)
    with raises_code(MotionError, "no-speed-limit"):
        build_path([through], LIMITS, rpm_max=math.inf)
    beside = turning((25, 0), (15, 0), modal=modal, offset_x=-20.0)
    assert build_path([beside], LIMITS, rpm_max=math.inf).length == pytest.approx(10.0)


@pytest.mark.parametrize(("start", "end"), [((10, 0), (-10, 0)), ((-40, 0), (8, 3)), ((60, 0), (20, 0))])
@pytest.mark.parametrize("offset", [20.0, -7.5])
def test_x_offset_moves_path_without_changing_speeds(start: Point, end: Point, offset: float) -> None:
    """What is turned is the same part: the same pieces at the same feeds, by the offset further out."""
    plain = build_path([turning(start, end)], LIMITS)
    moved = build_path([turning(start, end, offset_x=offset)], LIMITS)
    assert moved.pieces.rate == pytest.approx(plain.pieces.rate, rel=1e-9)
    assert moved.pieces.length == pytest.approx(plain.pieces.length, abs=1e-9)
    assert moved.pieces.start[:, 0] == pytest.approx(plain.pieces.start[:, 0] + offset, abs=1e-9)


def test_each_block_retains_its_span_next_to_split_block() -> None:
    """Facing from 100 to 50, 20 along, facing to 30, 5 along: 50, 20, 20 and 5 mm, in this order."""
    blocks = [
        turning((100, 0), (50, 0)),
        replace(line((50, 0), (50, 20)), n=2),
        replace(turning((50, 20), (30, 20)), n=3),
        replace(line((30, 20), (30, 25)), n=4),
    ]
    path = build_path(blocks, LIMITS)
    spans = [path.find_block_span(n) for n in (1, 2, 3, 4)]
    ways = [0.0, 50.0, 70.0, 90.0, 95.0]
    assert spans == [pytest.approx(pair) for pair in pairwise(ways)]
