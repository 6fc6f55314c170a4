"""The queue refuses whatever would not end at rest on the path."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.ports import DriverError, MotionSegments
from drivers.setpoint_queue import JunctionTolerance, SetpointQueue
from tests.coded import raises_code
from tests.drivers.machines import ramp

REST = (1.0, 2.0, 3.0)


def queue() -> SetpointQueue:
    return SetpointQueue(("X", "Z", "C"), REST, 0.03, JunctionTolerance((0.001,) * 3, (3.0, 3.0, 3.6)))


def test_queued_motion_is_played_and_ends_at_rest() -> None:
    q = queue()
    q.splice_segments(ramp(0.05, REST, 60.0, 0.2), now=0.0)
    assert q.get_commanded_state(0.0) == (REST, (0.0, 0.0, 0.0))
    p, v = q.get_commanded_state(0.05 + 0.02 + 0.1)
    assert v == pytest.approx((60.0, 0.0, 0.0))
    assert p[0] == pytest.approx(1.0 + 0.6 + 6.0)  # half of 60*0.02, then 60*0.1
    p, v = q.get_commanded_state(9.0)
    assert p == pytest.approx((1.0 + 1.2 + 12.0, 2.0, 3.0))
    assert v == (0.0, 0.0, 0.0)
    assert q.get_end_time(0.0) == pytest.approx(0.29)
    assert q.get_end_time(7.0) == 7.0


def test_splice_replaces_later_motion() -> None:
    q = queue()
    q.splice_segments(ramp(0.03, REST, 60.0, 1.0), now=0.0)
    p, v = q.get_commanded_state(0.5)
    brake = MotionSegments(
        np.array([0.5]), np.array([0.02]), np.array([p]), np.array([v]), np.array([[-3000.0, 0.0, 0.0]])
    )
    q.splice_segments(brake, now=0.47)
    assert q.get_end_time(0.47) == pytest.approx(0.52)
    assert q.get_commanded_state(1.0)[0][0] == pytest.approx(p[0] + 0.6)
    assert q.get_commanded_state(0.4)[1][0] == pytest.approx(60.0)


def test_splice_after_the_end_waits_at_rest() -> None:
    q = queue()
    q.splice_segments(ramp(0.03, REST, 60.0, 0.1), now=0.0)
    rest = q.get_commanded_state(1.0)[0]
    q.splice_segments(ramp(2.0, (rest[0], rest[1], rest[2]), -60.0, 0.1), now=1.0)
    assert q.get_commanded_state(1.9)[0] == pytest.approx(rest)
    assert q.get_commanded_state(1.9)[1] == (0.0, 0.0, 0.0)
    assert q.get_commanded_state(3.0)[0] == pytest.approx(REST)


def test_splice_before_the_commit_time_is_rejected() -> None:
    q = queue()
    with raises_code(DriverError, "late") as told:
        q.splice_segments(ramp(0.029, REST, 60.0, 0.1), now=0.0)
    assert told.value.reason == "too-early"
    assert q.get_end_time(0.0) == 0.0


def in_slices(start: float, count: int) -> MotionSegments:
    """At rest in so many pieces of 2 ms."""
    t = start + 0.002 * np.arange(count, dtype=np.float64)
    zero = np.zeros((count, 3))
    return MotionSegments(t, np.full(count, 0.002), np.tile(REST, (count, 1)), zero, zero)


def test_splicing_a_long_path_yields_the_cpu() -> None:
    q = queue()
    asked: list[float] = []
    q.yield_cpu = lambda: asked.append(q.get_end_time(0.0))
    q.splice_segments(in_slices(0.05, 1000), now=0.0)
    assert len(asked) == 10
    assert asked == [0.0] * 10  # nothing of it is played before all of it is there
    assert q.get_end_time(0.0) == pytest.approx(2.05)


def test_long_path_overtaken_by_its_own_start_time_is_rejected() -> None:
    q = queue()
    fed = [0.0]

    def go_on() -> None:
        fed[0] += 0.01

    q.yield_cpu, q.get_transferred_until = go_on, lambda: fed[0]
    q.splice_segments(in_slices(0.05, 400), now=0.0)
    fed[0] = 0.0
    with raises_code(DriverError, "late", "10.0 ms") as error:
        q.splice_segments(in_slices(0.05, 600), now=0.0)
    assert error.value.reason == "too-early"
    assert q.get_end_time(0.0) == pytest.approx(0.85)


@pytest.mark.parametrize(("off", "axis"), [(0.0011, 0), (-0.0011, 1), (0.0011, 2)])
def test_jump_in_position_is_rejected(off: float, axis: int) -> None:
    start = list(REST)
    start[axis] += off
    with raises_code(DriverError, "driver", f"{'XZC'[axis]}: ", "position") as told:
        queue().splice_segments(ramp(0.05, (start[0], start[1], start[2]), 60.0, 0.1), now=0.0)
    assert told.value.reason == "jump"


def test_jump_in_velocity_is_rejected() -> None:
    good = ramp(0.05, REST, 60.0, 0.1)
    moving = MotionSegments(
        good.start_times_s[1:],
        good.durations_s[1:],
        good.positions[1:] - good.positions[1] + good.positions[0],
        good.velocities[1:],
        good.accelerations[1:],
    )
    with raises_code(DriverError, "driver", "X: ", "velocity", "0.0000", "60.0000") as told:
        queue().splice_segments(moving, now=0.0)
    assert told.value.reason == "jump"


def test_queue_that_does_not_end_at_rest_is_rejected() -> None:
    good = ramp(0.05, REST, 60.0, 0.1)
    endless = MotionSegments(*(part[:2] for part in good))
    with raises_code(DriverError, "broken-path", "X") as told:
        queue().splice_segments(endless, now=0.0)
    assert told.value.reason == "moves-at-end"


@pytest.mark.parametrize("part", [2, 3])
def test_jump_between_segments_is_rejected(part: int) -> None:
    bad = ramp(0.05, REST, 60.0, 0.1)
    bad[part][1, 1] += 5.0
    with raises_code(DriverError, "broken-path", "Z: ", "0.0700") as told:
        queue().splice_segments(bad, now=0.0)
    assert told.value.reason == "jump"


def test_time_gap_and_backward_time_are_rejected() -> None:
    bad = ramp(0.05, REST, 60.0, 0.1)
    bad.start_times_s[2] += 0.01
    with raises_code(DriverError, "broken-path") as told:
        queue().splice_segments(bad, now=0.0)
    assert told.value.reason == "gap"
    bad.durations_s[1] = -0.1
    with raises_code(DriverError, "broken-path") as told:
        queue().splice_segments(bad, now=0.0)
    assert told.value.reason == "backwards"


def test_non_finite_values_and_wrong_shapes_are_rejected() -> None:
    bad = ramp(0.05, REST, 60.0, 0.1)
    bad.positions[0, 0] = np.nan
    with raises_code(DriverError, "broken-path") as told:
        queue().splice_segments(bad, now=0.0)
    assert told.value.reason == "no-number"
    with raises_code(DriverError, "broken-path") as told:
        queue().splice_segments(
            MotionSegments(
                bad.start_times_s, bad.durations_s, bad.positions[:, :2], bad.velocities, bad.accelerations
            ),
            now=0.0,
        )
    assert told.value.reason == "shape"
    empty = np.zeros((0, 3))
    with raises_code(DriverError, "broken-path") as told:
        queue().splice_segments(MotionSegments(np.zeros(0), np.zeros(0), empty, empty, empty), now=0.0)
    assert told.value.reason == "shape"


def test_braking_to_rest_needs_no_further_setpoints() -> None:
    q = queue()
    q.splice_segments(ramp(0.03, REST, 60.0, 1.0), now=0.0)
    before = q.get_commanded_state(0.5)[0][0]
    assert q.brake_to_rest(0.5, (3000.0, 3000.0, 3600.0)) == pytest.approx(0.52)
    assert q.get_commanded_state(0.52)[1] == (0.0, 0.0, 0.0)
    assert q.get_commanded_state(9.0)[0][0] == pytest.approx(before + 0.6)  # v²/2a


def test_trimming_removes_only_past_motion() -> None:
    q, rest = queue(), REST
    for k in range(100):
        q.splice_segments(ramp(0.1 + k, rest, 60.0 if k % 2 else -60.0, 0.1), now=float(k))
        after = q.get_commanded_state(k + 0.9)[0]
        rest = (after[0], after[1], after[2])
    late = q.get_commanded_state(99.15)
    q.discard_pieces_before(99.1)
    assert q.get_commanded_state(99.15) == late
    assert len(q._pieces) < 20


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    st.lists(
        st.tuples(st.floats(0.001, 0.4), st.floats(-120.0, 120.0), st.floats(0.0, 0.3)),
        min_size=1,
        max_size=12,
    )
)
def test_any_sequence_of_splices_is_continuous_and_ends_at_rest(
    calls: list[tuple[float, float, float]],
) -> None:
    q, now = queue(), 0.0
    for wait, speed, cruise in calls:
        now += wait
        try:
            p, _ = q.get_commanded_state(now + 0.03)
            q.splice_segments(ramp(now + 0.03, (p[0], p[1], p[2]), speed, cruise), now)
        except DriverError:
            continue
    assert q.get_commanded_state(q.get_end_time(now) + 1e-9)[1] == (0.0, 0.0, 0.0)
    times = np.arange(0.0, q.get_end_time(now) + 0.01, 0.0005)
    x = np.array([q.get_commanded_state(float(t))[0][0] for t in times])
    assert np.abs(np.diff(x)).max() <= 120.0 * 0.0005 + 0.0011
