"""Small paths whose limits, plans and setpoints follow with a pencil."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.motion.axis_limits import FloatArray, IntArray, MotionError, MotionLimits
from core.motion.block_table import build_batch_table
from core.motion.motion_path import PathBuilder
from core.motion.motion_plan import find_last_settled_joint, limit_values_forward, plan_motion
from core.motion.path_pieces import smooth_joints
from core.motion.speed_limits import PathJointLimits, find_path_joint_limits
from core.motion.window_planner import WindowPlanner
from tests.coded import raises_code
from tests.motion.moves import LIMITS, A, T, arc, line, polyline
from tests.motion.paths import build_path

ZIGZAG = polyline([(0.0, z) for z in (0.0, 1.0) * 5 + (0.0,)], 10.0)  # ten lines, each a full reversal
REVERSAL = 1.0 / 10.0 + 10.0 / A  # s of one of them: its way, and half of speeding up and of slowing down


# --- look-ahead ---------------------------------------------------------------------------------------------


def test_reachable_speed_increases_from_lowest_limit_across_rows() -> None:
    """1 at the last place of the first row of 256, half of one more each step."""
    limit = np.full(600, 100.0)
    limit[255] = 1.0
    reached = limit_values_forward(limit, np.full(599, 0.5))
    assert reached[254:257].tolist() == [100.0, 1.0, 1.5]
    assert reached[300] == pytest.approx(1.0 + 45 * 0.5)
    assert reached[500] == 100.0


def test_start_speed_above_corner_limit_is_rejected() -> None:
    """A right angle takes amax times the interval, 3.048 mm/s."""
    path = build_path(polyline([(0.0, 0.0), (0.0, 1.0), (1.0, 1.0)], 10.0), LIMITS)
    assert plan_motion(path, start_distance=1.0, start_speed=0.0).duration_s == pytest.approx(REVERSAL)
    with raises_code(MotionError, "too-fast", "8.000 mm/s"):
        plan_motion(path, start_distance=1.0, start_speed=8.0)


def test_zero_feed_override_stops_at_first_feed_after_rapid() -> None:
    rapid, feed = line((0.0, 0.0), (0.0, 1.0), 10.0, kind=BlockKind.RAPID), line((0.0, 1.0), (0.0, 2.0), n=2)
    assert plan_motion(build_path([feed], LIMITS), feed_scale=0.0).duration_s == 0.0
    before = plan_motion(build_path([rapid, feed], LIMITS), feed_scale=0.0)
    assert (before.end_distance, before.duration_s) == (1.0, pytest.approx(REVERSAL))


def test_stop_without_stopping_distance_is_rejected() -> None:
    """From 50 mm/s it takes 2500/2A = .41 mm."""
    path = build_path([line((0.0, 0.0), (0.0, 0.3))], LIMITS)
    with raises_code(MotionError, "cannot-stop", "0.3000 mm"):
        plan_motion(path, start_speed=50.0, stop_early=True)


# --- what a path may yet become -----------------------------------------------------------------------------


def test_joints_that_may_be_smoothed_are_not_settled() -> None:
    """The last fifty of a run of chords that goes on; one interval of way before its end would be eight."""
    builder = PathBuilder(MotionLimits(LIMITS.vmax, LIMITS.amax, T, grain=0.001))
    builder.add_blocks(polyline([(0.0, 0.01 * i) for i in range(201)], 5.0))
    assert 100 < find_last_settled_joint(builder.build_path()) < 150


def test_joints_within_an_interval_of_the_end_are_not_settled() -> None:
    """A right angle .03 mm before the end: chords that follow within .127 mm may yet allow it more."""
    builder = PathBuilder(LIMITS)
    there = [(0.0, 0.01 * i) for i in range(301)]
    builder.add_blocks(polyline([*there, *((0.01 * i, 3.0) for i in range(1, 4))]))
    path = builder.build_path()
    assert path.joint_distances[find_last_settled_joint(path)] <= 3.03 - 127.0 * T


@pytest.mark.parametrize("back", [2, 7, 1000])
def test_settled_joint_is_found_for_any_backward_window(back: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Joint 60 is a full reversal; behind it .6 mm are left, and to rest from 100 mm/s takes 1.64 mm."""
    monkeypatch.setattr("core.motion.motion_plan._BACKWARD_PIECES", back)
    builder = PathBuilder(LIMITS)
    there = [(0.0, 0.2 * i) for i in range(61)]
    builder.add_blocks(polyline([*there, *((0.0, 12.0 - 0.2 * i) for i in range(1, 4))], 100.0))
    assert find_last_settled_joint(builder.build_path()) == 60


@pytest.mark.parametrize(
    ("chord", "before", "first"),
    [(0.01, 60, 47), (1.0, 60, 59)],  # .127 mm are twelve chords and a part of one; of long lines one is kept
)
def test_dropping_blocks_retains_one_interval_of_path_and_one_neighbor(
    chord: float, before: int, first: int
) -> None:
    builder = PathBuilder(LIMITS)
    builder.add_blocks(polyline([(0.0, chord * i) for i in range(101)], 5.0))
    builder.drop_blocks_before(before)
    assert builder.build_path().block_numbers[0] == first
    assert builder.build_path().find_block_span(before) == pytest.approx(
        ((before - 1) * chord, before * chord)
    )


@pytest.mark.parametrize("window", [1, 3, 4, 10, 99])
def test_windowed_program_counts_time_once(window: int) -> None:
    planner = WindowPlanner(LIMITS, window=window)
    chunks = [*planner.plan_blocks(ZIGZAG), *planner.finish_section()]
    assert [n for chunk in chunks for n in chunk.block_numbers.tolist()] == list(range(1, 11))
    ends = [t for chunk in chunks for t in chunk.block_ends_s.tolist()]
    assert ends == pytest.approx([REVERSAL * n for n in range(1, 11)])
    assert planner.planned_time_s == pytest.approx(10 * REVERSAL)
    if window < 4:
        assert len(chunks) > 1


# --- setpoints ----------------------------------------------------------------------------------------------


def test_a_part_of_a_plan_ends_when_its_last_joint_is_reached() -> None:
    profile = plan_motion(build_path(ZIGZAG, LIMITS))
    assert profile.cut_at_distance(3.0).duration_s == pytest.approx(3 * REVERSAL)
    assert profile.cut_at_distance(0.0).duration_s == 0.0


def test_plan_has_no_setpoints_outside_its_time() -> None:
    profile = plan_motion(build_path(ZIGZAG, LIMITS))
    for begin, end in ((0.5, 0.5), (-2.0, -1.0), (9.0, 10.0)):
        assert len(profile.make_segments(begin, end)[0]) == 0


def test_arc_segments_are_continuous_and_short_enough_for_jerk() -> None:
    """R 3 at 300 mm/s: v/R = 100 and v²/R = 30000, so j = 3e6 and h³ = 40.5·2.5e-4/j is .0015 s cubed."""
    limits = MotionLimits(vmax=(400.0, 400.0, 1200.0), amax=(40000.0, 40000.0, 12000.0), interval=T)
    path = build_path([arc((0.0, 3.0), (0.0, -3.0), (0.0, 0.0), 300.0)], limits)
    profile = plan_motion(path)
    cruise = int(np.flatnonzero(profile.phases.accelerations == 0.0)[0])
    begin = float(profile.phases.start_times_s[cruise])
    t, dt, p, v, a = profile.make_segments(begin, begin + 0.015)
    assert dt == pytest.approx(np.full(10, 0.0015))
    assert np.hypot(p[:, 0], p[:, 1]) == pytest.approx(np.full(10, 3.0))
    ends = p + v * dt[:, None] + 0.5 * a * dt[:, None] ** 2
    assert ends[:-1] == pytest.approx(p[1:], abs=1e-9)
    assert ends[-1] == pytest.approx(profile.compute_positions(t[-1] + dt[-1])[0], abs=1e-9)


def test_time_at_distance_follows_acceleration_ramps() -> None:
    """Up to 100 mm/s: s = At²/2; on; and down as it went up. Beyond the end it is never."""
    profile = plan_motion(build_path([line((0.0, 0.0), (0.0, 50.0), 100.0)], LIMITS))
    ramp = 100.0 / A
    times = np.array([0.25, 0.5, 0.9]) * ramp
    ways = 0.5 * A * times**2
    assert profile.compute_times_at_distances(ways) == pytest.approx(times)
    assert profile.compute_times_at_distances(50.0 - ways) == pytest.approx(profile.duration_s - times)
    assert profile.compute_times_at_distances(np.array([25.0])) == pytest.approx([0.5 * profile.duration_s])
    assert profile.duration_s == pytest.approx(0.5 + ramp)
    assert profile.compute_times_at_distances(np.array([-1.0, 50.0, 51.0])).tolist() == [
        0.0,
        profile.duration_s,
        math.inf,
    ]


def test_tiny_speed_at_end_is_rounding_but_0_02_mm_s_is_rejected() -> None:
    """Over the 1e-9 mm that are rounding sqrt(2e-9·A) = .0025 mm/s come to rest."""
    path = build_path([line((0.0, 0.0), (0.0, 1.0))], LIMITS)
    assert plan_motion(path, start_distance=1.0, start_speed=0.0024).duration_s == 0.0
    with raises_code(MotionError, "cannot-stop-at-end"):
        plan_motion(path, start_distance=1.0, start_speed=0.02)


# --- chords -------------------------------------------------------------------------------------------------


def test_uneven_chords_of_straight_line_are_not_smoothed() -> None:
    ways = np.cumsum([0.0, *([0.01, 0.03, 0.02, 0.005] * 8)]).tolist()
    limits = MotionLimits(LIMITS.vmax, LIMITS.amax, T, grain=0.001)
    pieces = build_path(polyline([(0.0, z) for z in ways]), LIMITS).pieces
    eased = smooth_joints(pieces, limits)
    assert eased.start[:, 1] == pytest.approx(np.array(ways[:-1]), abs=1e-12)


BEND = 0.1  # by which X turns at the one bend; at 50 mm/s an interval has five chords of .01 mm
DIRECTION = (BEND, math.sqrt(1.0 - BEND**2))


def bent(turned: tuple[float, float] = DIRECTION) -> list[Block]:
    """Twenty chords along Z, twenty more along ``turned``."""
    first = [(0.0, 0.01 * i) for i in range(21)]
    more = [(0.01 * i * turned[0], 0.2 + 0.01 * i * turned[1]) for i in range(1, 21)]
    return polyline([*first, *more])


def test_speed_limit_of_single_bend_depends_on_its_angle() -> None:
    """v·Δu over an interval of .8 amax: (.8·3048·.001/.1)², whatever the speed."""
    pieces = build_path(bent(), LIMITS).pieces
    alone = PathJointLimits(np.array([19]), np.array([1.0]), np.zeros((1, 3)))
    asked = find_path_joint_limits(pieces, alone, np.array([50.0]), LIMITS, has_more_pieces=False)
    assert asked.squared_speeds == pytest.approx([(0.8 * A * T / BEND) ** 2], rel=1e-6)


def test_single_bend_per_interval_has_no_additional_limit() -> None:
    """Bends there and back by .2, .05 mm apart: at 20 mm/s an interval has one of them, so it asks nothing.

    Else each would be held to (.8·3048·.001/.2)² = 148.6 mm²/s².
    """
    x = [0.0, 0.05 * BEND]
    points = [(x[i % 2], 0.05 * i * DIRECTION[1]) for i in range(21)]
    alone = PathJointLimits(np.array([9]), np.array([1.0]), np.zeros((1, 3)))
    pieces = build_path(polyline(points), LIMITS).pieces
    asked = find_path_joint_limits(pieces, alone, np.array([20.0]), LIMITS, has_more_pieces=False)
    assert asked.squared_speeds.tolist() == [math.inf]


def test_chords_on_both_sides_of_bend_have_reduced_acceleration() -> None:
    """A bend about 45 degrees at 1.5 times the feed asks v·Δu over an interval; the rest is along both."""
    half = 0.5 * math.asin(0.02)
    before, after = math.pi / 4 - half, math.pi / 4 + half
    points = [(-0.01 * i * math.sin(before), -0.01 * i * math.cos(before)) for i in range(20, 0, -1)]
    points += [(0.01 * i * math.sin(after), 0.01 * i * math.cos(after)) for i in range(21)]
    path = build_path(polyline(points), LIMITS)
    asked = 1.5 * 50.0 * (math.sin(after) - math.sin(before)) / T
    assert path.accelerations[19:21] == pytest.approx([(A - asked) / math.sin(after)] * 2)
    assert path.accelerations[[10, 30]] == pytest.approx([A / math.sin(after)] * 2)


# --- rows ---------------------------------------------------------------------------------------------------


@dataclass
class Columns:
    """Two straight moves as columns."""

    pattern: Block
    n: IntArray = field(default_factory=lambda: np.array([4, 5]))
    x0: FloatArray = field(default_factory=lambda: np.array([1.0, 2.0]))
    z0: FloatArray = field(default_factory=lambda: np.array([3.0, 4.0]))
    x: FloatArray = field(default_factory=lambda: np.array([2.0, 5.0]))
    z: FloatArray = field(default_factory=lambda: np.array([4.0, 8.0]))
    feed: FloatArray | None = None

    def __len__(self) -> int:
        return len(self.n)

    def __getitem__(self, at: slice) -> Columns:
        raise NotImplementedError


def test_move_series_is_added_to_table_with_offsets() -> None:
    like = line((7.0, 7.0), (8.0, 8.0), 20.0)
    shifted = Block(**{**{f: getattr(like, f) for f in like.__slots__}, "offset_x": 10.0, "offset_z": 20.0})
    table = build_batch_table([Columns(shifted)], 3500.0)
    assert table.n.tolist() == [4.0, 5.0]
    assert table.start[:, :2].tolist() == [[11.0, 23.0], [12.0, 24.0]]
    assert table.end[:, :2].tolist() == [[12.0, 24.0], [15.0, 28.0]]
    assert table.feed.tolist() == [20.0, 20.0]


def test_move_series_has_its_own_feeds() -> None:
    row = Columns(line((7.0, 7.0), (8.0, 8.0), 20.0), feed=np.array([20.0, 30.0]))
    before, behind = line((0.0, 0.0), (1.0, 3.0), 5.0), line((5.0, 8.0), (9.0, 9.0), 6.0)
    assert build_batch_table([[before], row, [behind]], 3500.0).feed.tolist() == [5.0, 20.0, 30.0, 6.0]


def test_series_of_one_move_uses_its_own_coordinates() -> None:
    row = Columns(line((7.0, 7.0), (8.0, 8.0), 20.0))
    single = Columns(row.pattern, row.n[:1], row.x0[:1], row.z0[:1], row.x[:1], row.z[:1])
    table = build_batch_table([single], 3500.0)
    assert (table.n.tolist(), table.start[:, :2].tolist()) == ([4.0], [[1.0, 3.0]])
    assert table.end[:, :2].tolist() == [[2.0, 4.0]]


def test_blocks_around_series_are_in_order_in_table() -> None:
    before, behind = line((0.0, 0.0), (1.0, 3.0), 5.0, n=3), line((5.0, 8.0), (6.0, 8.0), 7.0, n=6)
    table = build_batch_table([[before], Columns(line((7.0, 7.0), (8.0, 8.0), 20.0)), [behind]], 3500.0)
    assert table.n.tolist() == [3.0, 4.0, 5.0, 6.0]
    assert table.start[:, 0].tolist() == [0.0, 1.0, 2.0, 5.0]
    assert table.feed.tolist() == [5.0, 20.0, 20.0, 7.0]
