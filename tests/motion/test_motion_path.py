"""Paths: blocks without length, gaps, owners, dropping what lies behind."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.motion.axis_limits import MotionError
from core.motion.motion_path import PathBuilder
from core.motion.motion_plan import plan_motion
from core.motion.path_pieces import ends_with_chord
from tests.coded import raises_code
from tests.motion.moves import LIMITS, arc, line, polyline
from tests.motion.paths import build_path


def test_zero_length_block_is_complete_when_it_is_reached() -> None:
    path = build_path(polyline([(0, 0), (0, 50), (0, 50), (0, 50), (0, 90)], 100.0), LIMITS)
    assert len(path) == 2
    numbers, start, end = plan_motion(path).find_block_times()
    assert numbers.tolist() == [1, 2, 3, 4]
    assert start[1] == end[1] == start[2] == end[2] == end[0]
    assert 0.0 < end[0] < end[3]


def test_path_of_points_only_has_zero_duration() -> None:
    profile = plan_motion(build_path(polyline([(3, 4), (3, 4), (3, 4)]), LIMITS))
    numbers, start, end = profile.find_block_times()
    assert (profile.duration_s, numbers.tolist(), start.tolist(), end.tolist()) == (
        0.0,
        [1, 2],
        [0, 0],
        [0, 0],
    )


def test_block_at_time_is_the_moving_block() -> None:
    profile = plan_motion(build_path(polyline([(0, 0), (0, 50), (0, 50), (0, 100)], 100.0), LIMITS))
    middle = profile.duration_s / 2
    times = [-1.0, 0.0, middle - 0.01, middle + 0.01, 99.0]
    assert profile.find_block_numbers(np.array(times)).tolist() == [1, 1, 1, 3, 3]
    assert [profile.find_block_number(t) for t in times] == [1, 1, 1, 3, 3]


def test_blocks_before_start_are_complete() -> None:
    path = build_path(polyline([(0, 0), (0, 10), (0, 20), (0, 30)]), LIMITS)
    _, start, end = plan_motion(path, start_distance=15.0).find_block_times()
    assert (start[0], end[0], start[1]) == (0.0, 0.0, 0.0)
    assert 0.0 < end[1] == start[2] < end[2]


def test_a_gap_is_refused() -> None:
    blocks = [line((0, 0), (0, 10), n=1), line((0, 10.5), (0, 20), n=2)]
    with raises_code(MotionError, "broken-path", "Block 2", "0.5000 mm"):
        build_path(blocks, LIMITS)


def test_gap_to_previous_blocks_is_rejected_and_adds_nothing() -> None:
    builder = PathBuilder(LIMITS)
    builder.add_blocks([line((0, 0), (0, 10), n=1)])
    with raises_code(MotionError, "broken-path", "Block 2", "1.0000 mm"):
        builder.add_blocks([line((0, 11), (0, 20), n=2)])
    assert builder.build_path().block_numbers.tolist() == [1]


def test_offset_change_without_machine_motion_is_not_a_gap() -> None:
    second = replace(line((5, 110), (5, 120), n=2), offset_x=-5.0, offset_z=-100.0)
    assert build_path([line((0, 0), (0, 10), n=1), second], LIMITS).length == pytest.approx(20.0)


def test_empty_path_is_rejected() -> None:
    with raises_code(MotionError, "no-block"):
        build_path([], LIMITS)


def test_block_not_on_path_is_rejected() -> None:
    builder = PathBuilder(LIMITS)
    builder.add_blocks(polyline([(0, 0), (0, 10), (0, 20), (0, 30)]))
    builder.drop_blocks_before(3)
    assert builder.build_path().find_block_span(2) == (10.0, 20.0)  # kept for its corner
    with raises_code(MotionError, "block-not-on-path", "Block 1"):
        builder.build_path().find_block_span(1)
    with raises_code(MotionError, "block-not-on-path", "Block 4"):
        builder.build_path().find_block_span(4)


def test_full_circle_between_lines_is_continuous() -> None:
    blocks = [
        line((0, 0), (0, 10), n=1),
        arc((0, 10), (0, 10), (5, 10), n=2),
        line((0, 10), (0, 20), n=3),
    ]
    path = build_path(blocks, LIMITS)
    assert path.compute_positions(path.joint_distances)[:, :2] == pytest.approx(
        np.array([[0, 0], [0, 10], [0, 10], [0, 20.0]]), abs=1e-9
    )


def test_empty_path_does_not_end_with_chord() -> None:
    pieces = build_path([line((0, 0), (0, 5))], LIMITS).pieces
    assert not ends_with_chord(pieces[:0], LIMITS)
