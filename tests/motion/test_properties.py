"""What must hold on any path of lines and arcs, whatever their lengths and feeds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.motion.axis_limits import FloatArray
from core.motion.motion_path import MotionPath
from core.motion.motion_plan import limit_values_backward, limit_values_forward, plan_motion
from core.motion.motion_profile import MotionProfile
from tests.motion.moves import LIMITS, A, T, V, backwards, programs
from tests.motion.paths import build_path

pytestmark = pytest.mark.long

SLACK = 1.0 + 1e-6  # rounding in the ramps of very short pieces

few = settings(max_examples=60, deadline=None)


def velocities(profile: MotionProfile, path: MotionPath, piece: int, where: float) -> FloatArray:
    """Axis velocities at the start (0) or end (1) of a piece."""
    s = path.joint_distances[piece + int(where)]
    speed = profile.compute_distances_and_speeds(profile.compute_times_at_distances(np.array([s])))[1][0]
    one = path.pieces[piece : piece + 1]
    velocity: FloatArray = one.tangent(one.length * where)[0] * speed
    return velocity


@few
@given(programs())
def test_no_speed_is_above_a_limit(blocks: list[Block]) -> None:
    profile = plan_motion(build_path(blocks, LIMITS))
    t = np.linspace(0.0, profile.duration_s, 400)
    speed = profile.compute_distances_and_speeds(t)[1]
    path, piece = profile.path, profile.phases.piece_indices
    tangent = path.pieces[piece].tangent(path.pieces.length[piece] / 2)
    assert (np.abs(tangent[:, :2] * profile.phases.start_speeds[:, None]) <= V * SLACK).all()
    feeds = {b.n: b.feed for b in blocks}
    assert (
        speed <= np.array([feeds[n] for n in profile.find_block_numbers(t).tolist()]) * SLACK + 1e-9
    ).all()
    radius = path.pieces.radius[piece]
    arc = radius > 0.0
    assert (profile.phases.start_speeds[arc] ** 2 <= 0.8 * A * radius[arc] * SLACK).all()


@few
@given(programs())
def test_no_axis_accelerates_beyond_its_limit(blocks: list[Block]) -> None:
    profile = plan_motion(build_path(blocks, LIMITS))
    path, (_, dt, _, v, a, piece) = profile.path, profile.phases
    pieces = path.pieces[piece]
    fastest = np.maximum(v, v + a * dt)
    on_line = np.abs(pieces.direction[:, :2]).max(axis=1) * np.abs(a)
    on_arc = np.hypot(a, fastest**2 * np.abs(pieces.curvatures))
    assert (np.where(pieces.curvatures == 0.0, on_line, on_arc) <= A * SLACK).all()


@few
@given(programs())
def test_corner_velocity_step_is_within_one_interval_of_acceleration(blocks: list[Block]) -> None:
    path = build_path(blocks, LIMITS)
    profile = plan_motion(path)
    for piece in range(len(path) - 1):
        step = velocities(profile, path, piece, 1) - velocities(profile, path, piece + 1, 0)
        assert np.abs(step[:2]).max() <= A * T * SLACK + 1e-9 * V


@few
@given(programs())
def test_setpoints_need_little_more_than_maximum_acceleration(blocks: list[Block]) -> None:
    """Sampled at the interval; what is over comes from several corners of tiny pieces within one."""
    profile = plan_motion(build_path(blocks, LIMITS))
    changes = np.append(profile.phases.start_times_s, profile.duration_s)
    for begin in (0.0, 0.3 * T, 0.6 * T):
        grid = np.arange(begin - 2 * T, profile.duration_s + 2 * T, T)
        near = np.abs(grid - changes[np.searchsorted(changes, grid).clip(max=len(changes) - 1)]) < 3 * T
        near |= np.abs(grid - changes[(np.searchsorted(changes, grid) - 1).clip(min=0)]) < 3 * T
        near[::61] = True  # within a phase one sample is as good as another
        here = grid[near]
        bend = (
            profile.compute_positions(here - T)
            - 2 * profile.compute_positions(here)
            + profile.compute_positions(here + T)
        )
        assert np.abs(bend).max(initial=0.0) / T**2 <= 1.7 * A


@few
@given(programs())
def test_motion_meets_every_corner_exactly_and_ends_at_rest(blocks: list[Block]) -> None:
    profile = plan_motion(build_path(blocks, LIMITS))
    numbers, start, end = profile.find_block_times()
    assert numbers.tolist() == [b.n for b in blocks]
    assert start[1:] == pytest.approx(end[:-1], abs=0)
    corners = profile.compute_positions(end)
    assert corners[:, :2] == pytest.approx(np.array([[b.x, b.z] for b in blocks]), abs=1e-9)
    assert profile.compute_distances_and_speeds(profile.duration_s)[1][0] == 0.0
    assert profile.end_speed == pytest.approx(0.0, abs=1e-9)


@few
@given(programs())
def test_distance_and_speed_are_continuous(blocks: list[Block]) -> None:
    profile = plan_motion(build_path(blocks, LIMITS))
    _, dt, s, v, a, _ = profile.phases
    assert (s + v * dt + 0.5 * a * dt**2)[:-1] == pytest.approx(s[1:], abs=1e-9)
    assert (v + a * dt)[:-1] == pytest.approx(v[1:], rel=1e-9, abs=1e-9)


@few
@given(programs())
def test_every_point_is_on_programmed_path(blocks: list[Block]) -> None:
    profile = plan_motion(build_path(blocks, LIMITS))
    t = np.linspace(0.0, profile.duration_s, 200)
    by_number = {b.n: b for b in blocks}
    for (x, z, _), n in zip(
        profile.compute_positions(t).tolist(), profile.find_block_numbers(t).tolist(), strict=True
    ):
        b = by_number[n]
        if b.kind is BlockKind.ARC:
            off = math.hypot(x - b.cx, z - b.cz) - math.hypot(b.x0 - b.cx, b.z0 - b.cz)
        else:
            size = math.hypot(b.x - b.x0, b.z - b.z0)
            off = ((x - b.x0) * (b.z - b.z0) - (z - b.z0) * (b.x - b.x0)) / size
        assert abs(off) < 1e-9


@few
@given(programs())
def test_motion_is_not_faster_than_feeds_and_axes_allow(blocks: list[Block]) -> None:
    path = build_path(blocks, LIMITS)
    least = float(np.sum(path.pieces.length / np.minimum(path.pieces.rate, math.sqrt(2) * V)))
    assert plan_motion(path).duration_s >= least * (1.0 - 1e-9)


@few
@given(programs())
def test_reversed_path_has_same_duration(blocks: list[Block]) -> None:
    there, back = plan_motion(build_path(blocks, LIMITS)), plan_motion(build_path(backwards(blocks), LIMITS))
    assert back.duration_s == pytest.approx(there.duration_s, rel=1e-9)


@few
@given(programs(), st.sampled_from([0.01, 0.3, 1.0, 1.5]), st.sampled_from([0.05, 1.0]))
def test_a_lower_override_is_never_faster(blocks: list[Block], feed: float, rapid: float) -> None:
    path = build_path(blocks, LIMITS)
    slow = plan_motion(path, feed_scale=feed * 0.9, rapid_scale=rapid * 0.9)
    assert slow.duration_s >= plan_motion(path, feed_scale=feed, rapid_scale=rapid).duration_s * (1.0 - 1e-9)


_nodes = st.lists(st.tuples(st.floats(0.0, 2e4), st.floats(1e-6, 3e4)), min_size=1, max_size=700)


@few
@given(_nodes)
def test_running_minima_equal_the_plain_loop(nodes: list[tuple[float, float]]) -> None:
    limit, gain = np.array([n[0] for n in nodes]), np.array([n[1] for n in nodes])[1:]
    plain = limit.copy()
    for i, step in enumerate(gain):
        plain[i + 1] = min(plain[i + 1], plain[i] + step)
    assert limit_values_forward(limit, gain) == pytest.approx(plain, rel=1e-9, abs=1e-7)
    mirrored = limit_values_backward(limit[::-1].copy(), gain[::-1].copy())
    assert mirrored[::-1] == pytest.approx(plain, rel=1e-9, abs=1e-7)


def test_running_minima_are_correct_over_many_rows() -> None:
    """A stop far away is felt from row to row: 5000 pieces of gain 1 from 0 up to 3000."""
    limit = np.full(5001, 3000.0)
    limit[0] = 0.0
    assert limit_values_forward(limit, np.ones(5000)) == pytest.approx(np.minimum(np.arange(5001), 3000.0))
