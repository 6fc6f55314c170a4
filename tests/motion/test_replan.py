"""Planning again while moving: hold, override, resume, and states that no plan can have led to."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block, Kind
from core.motion.axis_limits import MotionError
from core.motion.motion_path import PathBuilder
from core.motion.motion_plan import plan
from tests.coded import raises_code
from tests.motion.moves import LIMITS, A, T, arc, line, polyline, programs, rounded_chords
from tests.motion.paths import build_path

few = settings(max_examples=60, deadline=None)
moment = st.floats(0.0, 1.0)


@pytest.mark.long
@few
@given(programs(), moment)
def test_nothing_changed_gives_the_same_future(blocks: list[Block], when: float) -> None:
    path = build_path(blocks, LIMITS)
    before = plan(path)
    t0 = when * before.duration
    (s,), (v,) = before.at(t0)
    after = plan(path, start_s=s, start_v=v)
    assert after.duration == pytest.approx(before.duration - t0, abs=1e-6)
    t = np.linspace(0.0, after.duration, 40)
    assert after.at(t)[0] == pytest.approx(before.at(t0 + t)[0], abs=1e-5)


@pytest.mark.long
@few
@given(programs(), moment, st.sampled_from([0.2, 0.7, 1.5]))
def test_a_hold_rests_within_the_braking_distance(blocks: list[Block], when: float, scale: float) -> None:
    path = build_path(blocks, LIMITS)
    before = plan(path, feed_scale=scale)
    (s,), (v,) = before.at(when * before.duration)
    hold = plan(path, start_s=s, start_v=v, stop=True)
    weakest = path.a[path.piece_at(np.array([s]))[0] : path.piece_at(np.array([hold.end_s]))[0] + 1].min()
    assert hold.end_s - s <= v * v / (2.0 * weakest) * (1.0 + 1e-6) + 1e-8
    assert hold.at(hold.duration)[1][0] == 0.0
    assert hold.phases.v.max(initial=0.0) <= v + 1e-9
    resumed = plan(path, start_s=hold.end_s)
    assert resumed.end_s == pytest.approx(path.s[-1], rel=1e-12)


@pytest.mark.long
@few
@given(programs(), moment, st.sampled_from([0.0, 0.05, 0.5, 1.5]), st.sampled_from([0.0, 0.3, 1.0]))
def test_an_override_never_jumps_and_keeps_the_corners(
    blocks: list[Block], when: float, feed: float, rapid: float
) -> None:
    path = build_path(blocks, LIMITS)
    before = plan(path)
    (s,), (v,) = before.at(when * before.duration)
    after = plan(path, start_s=s, start_v=v, feed_scale=feed, rapid_scale=rapid)
    if not len(after):
        return
    _, dt, _, v0, a, piece = after.phases
    assert v0[0] == pytest.approx(v, abs=1e-9)
    assert (v0 + a * dt)[:-1] == pytest.approx(v0[1:], rel=1e-9, abs=1e-9)
    assert (np.abs(a) <= path.a[piece] * (1.0 + 1e-5)).all()
    joints = np.flatnonzero(path.s > s)
    reached = after.at(after.time_at(path.s[joints]).clip(max=after.duration))[1]
    assert (reached**2 <= path.corner[joints] * (1.0 + 1e-6) + 1e-5).all()


def test_a_lower_feed_brakes_at_full_acceleration_and_then_cruises() -> None:
    path = build_path([line((0, 0), (0, 100), 100.0)], LIMITS)
    after = plan(path, start_s=20.0, start_v=100.0, feed_scale=0.5)
    braking = (100.0**2 - 50.0**2) / (2 * A)
    stopping = 50.0**2 / (2 * A)
    by_hand = 50.0 / A + (80.0 - braking - stopping) / 50.0 + 50.0 / A
    assert after.duration == pytest.approx(by_hand, rel=1e-12)


def test_braking_reaches_over_short_pieces_into_slower_ones() -> None:
    path = build_path(polyline([(0, 0), (0, 1), (0, 1.1), (0, 1.2), (0, 100)], 100.0), LIMITS)
    after = plan(path, start_s=0.5, start_v=100.0, feed_scale=0.1)
    whole = (100.0**2 - 10.0**2) / (2 * A)
    assert after.at((100.0 - 10.0) / A)[0][0] == pytest.approx(0.5 + whole)
    assert after.at((100.0 - 10.0) / A + 1.0)[1][0] == pytest.approx(10.0)


def test_zero_override_is_a_hold_in_a_feed() -> None:
    path = build_path([line((0, 0), (0, 100), 100.0)], LIMITS)
    after = plan(path, start_s=50.0, start_v=100.0, feed_scale=0.0)
    assert after.end_s == pytest.approx(50.0 + 100.0**2 / (2 * A))
    assert after.duration == pytest.approx(100.0 / A)


def test_zero_feed_override_lets_a_rapid_come_to_the_feed() -> None:
    blocks = [line((0, 0), (0, 50), 100.0, n=1, kind=Kind.RAPID), line((0, 50), (0, 90), 10.0, n=2)]
    after = plan(build_path(blocks, LIMITS), feed_scale=0.0)
    assert after.end_s == 50.0
    assert after.duration == pytest.approx(50.0 / 100.0 + 100.0 / A)
    _, start, end = after.block_times()
    assert end[0] == start[1] == after.duration
    assert math.isinf(end[1])


@pytest.mark.long
def test_a_stop_far_from_the_end_of_a_long_path() -> None:
    points = [(0.0, 0.01 * i) for i in range(20_000)]
    path = build_path(polyline(points, 100.0), LIMITS)
    hold = plan(path, start_s=50.0, start_v=100.0, stop=True)
    assert hold.end_s == pytest.approx(50.0 + 100.0**2 / (2 * A))
    assert len(hold) < 200


def test_at_rest_a_stop_stays() -> None:
    path = build_path([line((0, 0), (0, 1))], LIMITS)
    hold = plan(path, start_s=0.4, stop=True)
    assert (hold.duration, hold.end_s) == (0.0, 0.4)
    assert hold.position(1.0)[0] == pytest.approx([0.0, 0.4, 0.0])


def test_too_fast_for_the_end_is_refused() -> None:
    path = build_path([line((0, 0), (0, 100), 100.0)], LIMITS)
    with raises_code(MotionError, "cannot-stop", "100.000 mm/s", "1.0000 mm"):
        plan(path, start_s=99.0, start_v=100.0)
    with raises_code(MotionError, "cannot-stop"):
        plan(path, start_s=99.0, start_v=100.0, stop=True)
    with raises_code(MotionError, "cannot-stop-at-end"):
        plan(path, start_s=100.0, start_v=1.0)


def test_too_fast_for_a_corner_is_refused() -> None:
    path = build_path(polyline([(0, 0), (0, 50), (50, 50)], 100.0), LIMITS)
    with raises_code(MotionError, "too-fast", "1.524"):
        plan(path, start_s=49.5, start_v=100.0)
    with raises_code(MotionError, "too-fast", "1.524"):
        plan(path, start_s=49.5, start_v=100.0, stop=True)


def test_too_fast_for_an_arc_is_refused() -> None:
    path = build_path([arc((0, 1), (0, -1), (0, 0), 100.0)], LIMITS)
    allowed = math.sqrt(0.8 * A)
    with raises_code(MotionError, "too-fast", f"{allowed:.3f}"):
        plan(path, start_s=0.5, start_v=allowed * 1.2)


@pytest.mark.parametrize("v", [-1.0, math.nan, math.inf])
def test_the_present_speed_must_be_a_speed(v: float) -> None:
    with raises_code(MotionError, "negative-speed"):
        plan(build_path([line((0, 0), (0, 1))], LIMITS), start_v=v)


@pytest.mark.parametrize("s", [-0.1, 1.1, math.nan])
def test_the_start_must_lie_on_the_path(s: float) -> None:
    with raises_code(MotionError, "not-on-path"):
        plan(build_path([line((0, 0), (0, 1))], LIMITS), start_s=s)


def test_more_blocks_are_taken_up_without_a_stop() -> None:
    """The executor's way: blocks arrive while moving, what lies behind is dropped, the distance counts on."""
    builder = PathBuilder(LIMITS)
    blocks = polyline([(0.0, 10.0 * i) for i in range(11)], 100.0)
    whole = plan(build_path(blocks, LIMITS))
    builder.add(blocks[:5])
    (s,), (v,) = plan(builder.path()).at(0.3)
    builder.add(blocks[5:])
    builder.drop_before(3)
    assert builder.path().block_span(3) == pytest.approx((20.0, 30.0))
    after = plan(builder.path(), start_s=s, start_v=v)
    assert after.duration == pytest.approx(whole.duration - 0.3, rel=1e-9)
    assert after.position(after.duration)[0] == pytest.approx([0.0, 100.0, 0.0])


@pytest.mark.long
@settings(max_examples=100, deadline=None)
@given(programs(most=20), st.lists(moment, min_size=20, max_size=20))
def test_a_growing_path_never_leads_into_a_state_without_a_future(
    blocks: list[Block], moments: list[float]
) -> None:
    """Each block comes in at any moment of the plan so far, also in the middle of its last braking."""
    builder = PathBuilder(LIMITS)
    builder.add(blocks[:1])
    profile = plan(builder.path())
    for block, when in zip(blocks[1:], moments, strict=False):
        (s,), (v,) = profile.at(when * profile.duration)
        builder.add([block])
        profile = plan(builder.path(), start_s=s, start_v=v)
    builder.close()
    (s,), (v,) = profile.at(moments[-1] * profile.duration)
    assert plan(builder.path(), start_s=s, start_v=v).end_s == pytest.approx(profile.end_s, abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("grid", [0.001, 0.00127, 0.004])
@pytest.mark.parametrize("seed", range(4))
def test_chords_on_the_step_may_come_in_and_be_dropped_at_any_moment(grid: float, seed: int) -> None:
    chance = np.random.default_rng(seed)
    blocks = rounded_chords(900, 100.0, grid)
    builder, at = PathBuilder(LIMITS), 40
    builder.add(blocks[:at])
    profile = plan(builder.path())
    while at < len(blocks):
        (s,), (v,) = profile.at(float(chance.random()) * min(profile.duration, 0.004))
        builder.drop_before(int(builder.path().blocks[profile.path.piece_at(np.array([s]))[0]]))
        count = int(chance.integers(1, 40))
        builder.add(blocks[at : at + count])
        at += count
        profile = plan(builder.path(), start_s=s, start_v=v)
    assert profile.position(profile.duration)[0][0] == pytest.approx(blocks[-1].x, abs=1e-9)


def test_a_corner_that_comes_in_late_takes_nothing_from_the_braking_under_way() -> None:
    """At the start of a last chord of 0.05 mm, braking for its end, a right angle into another is added."""
    builder = PathBuilder(LIMITS)
    blocks = polyline([(0, 0), (0, 10), (0, 10.05), (0.05, 10.05)], 100.0)
    builder.add(blocks[:2])
    path = builder.path()
    (v,) = plan(path).at(plan(path).time_at(path.s[1:2]))[1]
    builder.add(blocks[2:])
    assert plan(builder.path(), start_s=10.0, start_v=v).end_s == pytest.approx(10.1)


def test_less_feed_than_before_is_braked_down_to_even_beyond_the_override() -> None:
    """The operator's spindle limit takes a feed per revolution to a tenth while the slide runs at 50 mm/s."""
    block = replace(line((0, 0), (0, 100), 1.0), per_rev=True, rpm=3000.0)
    slow = build_path([block], LIMITS, rpm_max=300.0)
    after = plan(slow, start_s=20.0, start_v=50.0)
    assert after.at(45.0 / A)[1][0] == pytest.approx(5.0)
    assert after.duration > 79.0 / 5.0


def test_nothing_can_be_added_behind_the_end() -> None:
    builder = PathBuilder(LIMITS)
    builder.add([line((0, 0), (0, 10), n=1)])
    builder.close()
    with raises_code(MotionError, "path-ended", "Block 2"):
        builder.add([line((0, 10), (0, 20), n=2)])


def test_dropping_keeps_the_corner_behind() -> None:
    blocks = polyline([(0, 0), (0, 50), (50, 50), (50, 90)], 100.0)
    builder = PathBuilder(LIMITS)
    builder.add(blocks)
    builder.drop_before(2)
    with raises_code(MotionError, "too-fast", "1.524"):
        plan(builder.path(), start_s=50.0, start_v=4.0)
    assert plan(builder.path(), start_s=50.0, start_v=A * T / 2).end_s == pytest.approx(140.0)
