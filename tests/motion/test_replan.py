"""Planning again while moving: hold, override, resume, and states that no plan can have led to."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.motion.axis_limits import MotionError
from core.motion.motion_path import PathBuilder
from core.motion.motion_plan import plan_motion
from tests.coded import raises_code
from tests.motion.moves import LIMITS, A, T, arc, line, polyline, programs, rounded_chords
from tests.motion.paths import build_path

few = settings(max_examples=60, deadline=None)
moment = st.floats(0.0, 1.0)


@pytest.mark.long
@few
@given(programs(), moment)
def test_replanning_without_change_gives_same_motion(blocks: list[Block], when: float) -> None:
    path = build_path(blocks, LIMITS)
    before = plan_motion(path)
    t0 = when * before.duration_s
    (s,), (v,) = before.compute_distances_and_speeds(t0)
    after = plan_motion(path, start_distance=s, start_speed=v)
    assert after.duration_s == pytest.approx(before.duration_s - t0, abs=1e-6)
    t = np.linspace(0.0, after.duration_s, 40)
    assert after.compute_distances_and_speeds(t)[0] == pytest.approx(
        before.compute_distances_and_speeds(t0 + t)[0], abs=1e-5
    )


@pytest.mark.long
@few
@given(programs(), moment, st.sampled_from([0.2, 0.7, 1.5]))
def test_hold_stops_within_braking_distance(blocks: list[Block], when: float, scale: float) -> None:
    path = build_path(blocks, LIMITS)
    before = plan_motion(path, feed_scale=scale)
    (s,), (v,) = before.compute_distances_and_speeds(when * before.duration_s)
    hold = plan_motion(path, start_distance=s, start_speed=v, stop_early=True)
    weakest = path.accelerations[
        path.find_piece_indices(np.array([s]))[0] : path.find_piece_indices(np.array([hold.end_distance]))[0]
        + 1
    ].min()
    assert hold.end_distance - s <= v * v / (2.0 * weakest) * (1.0 + 1e-6) + 1e-8
    assert hold.compute_distances_and_speeds(hold.duration_s)[1][0] == 0.0
    assert hold.phases.start_speeds.max(initial=0.0) <= v + 1e-9
    resumed = plan_motion(path, start_distance=hold.end_distance)
    assert resumed.end_distance == pytest.approx(path.joint_distances[-1], rel=1e-12)


@pytest.mark.long
@few
@given(programs(), moment, st.sampled_from([0.0, 0.05, 0.5, 1.5]), st.sampled_from([0.0, 0.3, 1.0]))
def test_override_change_is_continuous_and_respects_corner_limits(
    blocks: list[Block], when: float, feed: float, rapid: float
) -> None:
    path = build_path(blocks, LIMITS)
    before = plan_motion(path)
    (s,), (v,) = before.compute_distances_and_speeds(when * before.duration_s)
    after = plan_motion(path, start_distance=s, start_speed=v, feed_scale=feed, rapid_scale=rapid)
    if not len(after):
        return
    _, dt, _, v0, a, piece = after.phases
    assert v0[0] == pytest.approx(v, abs=1e-9)
    assert (v0 + a * dt)[:-1] == pytest.approx(v0[1:], rel=1e-9, abs=1e-9)
    assert (np.abs(a) <= path.accelerations[piece] * (1.0 + 1e-5)).all()
    joints = np.flatnonzero(path.joint_distances > s)
    reached = after.compute_distances_and_speeds(
        after.compute_times_at_distances(path.joint_distances[joints]).clip(max=after.duration_s)
    )[1]
    assert (reached**2 <= path.squared_speed_limits[joints] * (1.0 + 1e-6) + 1e-5).all()


def test_a_lower_feed_brakes_at_full_acceleration_and_then_cruises() -> None:
    path = build_path([line((0, 0), (0, 100), 100.0)], LIMITS)
    after = plan_motion(path, start_distance=20.0, start_speed=100.0, feed_scale=0.5)
    braking = (100.0**2 - 50.0**2) / (2 * A)
    stopping = 50.0**2 / (2 * A)
    by_hand = 50.0 / A + (80.0 - braking - stopping) / 50.0 + 50.0 / A
    assert after.duration_s == pytest.approx(by_hand, rel=1e-12)


def test_braking_spans_short_pieces_into_slower_ones() -> None:
    path = build_path(polyline([(0, 0), (0, 1), (0, 1.1), (0, 1.2), (0, 100)], 100.0), LIMITS)
    after = plan_motion(path, start_distance=0.5, start_speed=100.0, feed_scale=0.1)
    whole = (100.0**2 - 10.0**2) / (2 * A)
    assert after.compute_distances_and_speeds((100.0 - 10.0) / A)[0][0] == pytest.approx(0.5 + whole)
    assert after.compute_distances_and_speeds((100.0 - 10.0) / A + 1.0)[1][0] == pytest.approx(10.0)


def test_zero_override_is_a_hold_in_a_feed() -> None:
    path = build_path([line((0, 0), (0, 100), 100.0)], LIMITS)
    after = plan_motion(path, start_distance=50.0, start_speed=100.0, feed_scale=0.0)
    assert after.end_distance == pytest.approx(50.0 + 100.0**2 / (2 * A))
    assert after.duration_s == pytest.approx(100.0 / A)


def test_zero_feed_override_lets_rapid_reach_start_of_feed() -> None:
    blocks = [line((0, 0), (0, 50), 100.0, n=1, kind=BlockKind.RAPID), line((0, 50), (0, 90), 10.0, n=2)]
    after = plan_motion(build_path(blocks, LIMITS), feed_scale=0.0)
    assert after.end_distance == 50.0
    assert after.duration_s == pytest.approx(50.0 / 100.0 + 100.0 / A)
    _, start, end = after.find_block_times()
    assert end[0] == start[1] == after.duration_s
    assert math.isinf(end[1])


@pytest.mark.long
def test_stop_far_from_end_of_long_path_is_short_plan() -> None:
    points = [(0.0, 0.01 * i) for i in range(20_000)]
    path = build_path(polyline(points, 100.0), LIMITS)
    hold = plan_motion(path, start_distance=50.0, start_speed=100.0, stop_early=True)
    assert hold.end_distance == pytest.approx(50.0 + 100.0**2 / (2 * A))
    assert len(hold) < 200


def test_stop_at_rest_does_not_move() -> None:
    path = build_path([line((0, 0), (0, 1))], LIMITS)
    hold = plan_motion(path, start_distance=0.4, stop_early=True)
    assert (hold.duration_s, hold.end_distance) == (0.0, 0.4)
    assert hold.compute_positions(1.0)[0] == pytest.approx([0.0, 0.4, 0.0])


def test_start_speed_at_end_of_path_is_rejected() -> None:
    path = build_path([line((0, 0), (0, 100), 100.0)], LIMITS)
    with raises_code(MotionError, "cannot-stop", "100.000 mm/s", "1.0000 mm"):
        plan_motion(path, start_distance=99.0, start_speed=100.0)
    with raises_code(MotionError, "cannot-stop"):
        plan_motion(path, start_distance=99.0, start_speed=100.0, stop_early=True)
    with raises_code(MotionError, "cannot-stop-at-end"):
        plan_motion(path, start_distance=100.0, start_speed=1.0)


def test_start_speed_too_high_for_corner_is_rejected() -> None:
    path = build_path(polyline([(0, 0), (0, 50), (50, 50)], 100.0), LIMITS)
    with raises_code(MotionError, "too-fast", "1.524"):
        plan_motion(path, start_distance=49.5, start_speed=100.0)
    with raises_code(MotionError, "too-fast", "1.524"):
        plan_motion(path, start_distance=49.5, start_speed=100.0, stop_early=True)


def test_start_speed_too_high_for_arc_is_rejected() -> None:
    path = build_path([arc((0, 1), (0, -1), (0, 0), 100.0)], LIMITS)
    allowed = math.sqrt(0.8 * A)
    with raises_code(MotionError, "too-fast", f"{allowed:.3f}"):
        plan_motion(path, start_distance=0.5, start_speed=allowed * 1.2)


@pytest.mark.parametrize("v", [-1.0, math.nan, math.inf])
def test_invalid_start_speed_is_rejected(v: float) -> None:
    with raises_code(MotionError, "negative-speed"):
        plan_motion(build_path([line((0, 0), (0, 1))], LIMITS), start_speed=v)


@pytest.mark.parametrize("s", [-0.1, 1.1, math.nan])
def test_start_distance_off_the_path_is_rejected(s: float) -> None:
    with raises_code(MotionError, "not-on-path"):
        plan_motion(build_path([line((0, 0), (0, 1))], LIMITS), start_distance=s)


def test_added_blocks_continue_without_stop() -> None:
    """The executor's way: blocks arrive while moving, what lies behind is dropped, the distance counts on."""
    builder = PathBuilder(LIMITS)
    blocks = polyline([(0.0, 10.0 * i) for i in range(11)], 100.0)
    whole = plan_motion(build_path(blocks, LIMITS))
    builder.add_blocks(blocks[:5])
    (s,), (v,) = plan_motion(builder.build_path()).compute_distances_and_speeds(0.3)
    builder.add_blocks(blocks[5:])
    builder.drop_blocks_before(3)
    assert builder.build_path().find_block_span(3) == pytest.approx((20.0, 30.0))
    after = plan_motion(builder.build_path(), start_distance=s, start_speed=v)
    assert after.duration_s == pytest.approx(whole.duration_s - 0.3, rel=1e-9)
    assert after.compute_positions(after.duration_s)[0] == pytest.approx([0.0, 100.0, 0.0])


@pytest.mark.long
@settings(max_examples=100, deadline=None)
@given(programs(most=20), st.lists(moment, min_size=20, max_size=20))
def test_growing_path_can_always_be_replanned(blocks: list[Block], moments: list[float]) -> None:
    """Each block comes in at any moment of the plan so far, also in the middle of its last braking."""
    builder = PathBuilder(LIMITS)
    builder.add_blocks(blocks[:1])
    profile = plan_motion(builder.build_path())
    for block, when in zip(blocks[1:], moments, strict=False):
        (s,), (v,) = profile.compute_distances_and_speeds(when * profile.duration_s)
        builder.add_blocks([block])
        profile = plan_motion(builder.build_path(), start_distance=s, start_speed=v)
    builder.end_path()
    (s,), (v,) = profile.compute_distances_and_speeds(moments[-1] * profile.duration_s)
    assert plan_motion(builder.build_path(), start_distance=s, start_speed=v).end_distance == pytest.approx(
        profile.end_distance, abs=1e-9
    )


@pytest.mark.long
@pytest.mark.parametrize("grid", [0.001, 0.00127, 0.004])
@pytest.mark.parametrize("seed", range(4))
def test_rounded_chords_can_be_added_and_dropped_at_any_time(grid: float, seed: int) -> None:
    chance = np.random.default_rng(seed)
    blocks = rounded_chords(900, 100.0, grid)
    builder, at = PathBuilder(LIMITS), 40
    builder.add_blocks(blocks[:at])
    profile = plan_motion(builder.build_path())
    while at < len(blocks):
        (s,), (v,) = profile.compute_distances_and_speeds(
            float(chance.random()) * min(profile.duration_s, 0.004)
        )
        builder.drop_blocks_before(
            int(builder.build_path().block_numbers[profile.path.find_piece_indices(np.array([s]))[0]])
        )
        count = int(chance.integers(1, 40))
        builder.add_blocks(blocks[at : at + count])
        at += count
        profile = plan_motion(builder.build_path(), start_distance=s, start_speed=v)
    assert profile.compute_positions(profile.duration_s)[0][0] == pytest.approx(blocks[-1].x, abs=1e-9)


def test_corner_added_late_does_not_affect_current_braking() -> None:
    """At the start of a last chord of 0.05 mm, braking for its end, a right angle into another is added."""
    builder = PathBuilder(LIMITS)
    blocks = polyline([(0, 0), (0, 10), (0, 10.05), (0.05, 10.05)], 100.0)
    builder.add_blocks(blocks[:2])
    path = builder.build_path()
    (v,) = plan_motion(path).compute_distances_and_speeds(
        plan_motion(path).compute_times_at_distances(path.joint_distances[1:2])
    )[1]
    builder.add_blocks(blocks[2:])
    assert plan_motion(
        builder.build_path(), start_distance=10.0, start_speed=v
    ).end_distance == pytest.approx(10.1)


def test_start_speed_above_reduced_feed_is_braked_to_the_feed() -> None:
    """The operator's spindle limit takes a feed per revolution to a tenth while the slide runs at 50 mm/s."""
    block = replace(line((0, 0), (0, 100), 1.0), per_rev=True, rpm=3000.0)
    slow = build_path([block], LIMITS, rpm_max=300.0)
    after = plan_motion(slow, start_distance=20.0, start_speed=50.0)
    assert after.compute_distances_and_speeds(45.0 / A)[1][0] == pytest.approx(5.0)
    assert after.duration_s > 79.0 / 5.0


def test_blocks_after_end_of_path_are_rejected() -> None:
    builder = PathBuilder(LIMITS)
    builder.add_blocks([line((0, 0), (0, 10), n=1)])
    builder.end_path()
    with raises_code(MotionError, "path-ended", "Block 2"):
        builder.add_blocks([line((0, 10), (0, 20), n=2)])


def test_dropping_blocks_retains_previous_corner() -> None:
    blocks = polyline([(0, 0), (0, 50), (50, 50), (50, 90)], 100.0)
    builder = PathBuilder(LIMITS)
    builder.add_blocks(blocks)
    builder.drop_blocks_before(2)
    with raises_code(MotionError, "too-fast", "1.524"):
        plan_motion(builder.build_path(), start_distance=50.0, start_speed=4.0)
    assert plan_motion(
        builder.build_path(), start_distance=50.0, start_speed=A * T / 2
    ).end_distance == pytest.approx(140.0)
