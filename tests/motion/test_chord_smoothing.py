"""Joints of short chords: moved by the step of the words at most, to where the curve is."""

from __future__ import annotations

import dataclasses
import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.motion.axis_limits import FloatArray
from core.motion.joint_easing import SUPPORT_PIECE_COUNT
from core.motion.motion_path import MotionPath, PathBuilder
from core.motion.motion_plan import find_last_settled_joint, plan_motion
from core.motion.motion_profile import MotionProfile
from core.motion.window_planner import WindowPlanner
from tests.motion.moves import LIMITS, A, T, arc, chords, line, polyline, programs, rounded_chords
from tests.motion.paths import build_path

GRAIN = 0.00127  # mm: the step of the shipped lathe, .00005 in
STEPPED = dataclasses.replace(LIMITS, grain=GRAIN)


def joints(path: MotionPath) -> FloatArray:
    return np.vstack([path.pieces.start, path.compute_positions(path.joint_distances[-1:])])


def written(blocks: list[Block]) -> FloatArray:
    return joints(build_path(blocks, LIMITS))


def felt(profile: MotionProfile, dt: float) -> float:
    """Largest second difference of setpoints ``dt`` apart, as a share of the acceleration."""
    worst = 0.0
    for begin in (0.0, 0.3 * dt, 0.7 * dt):
        p = profile.compute_positions(np.arange(begin, profile.duration_s, dt))
        worst = max(worst, float(np.abs(np.diff(p, 2, axis=0)).max(initial=0.0)))
    return worst / dt**2 / A


@pytest.mark.long
@pytest.mark.parametrize("grid", [0.0001, 0.001, 0.00127, 0.00254])
def test_rounded_chords_are_as_fast_as_their_circle(grid: float) -> None:
    """R 50 mm in 0.02 mm chords at 100 mm/s, words of 4 and 3 places of a mm, of .00005 and .0001 in."""
    profile = plan_motion(build_path(rounded_chords(7854, 100.0, grid), STEPPED))
    assert profile.duration_s < 1.01 * (math.pi * 50.0 / 100.0 + 100.0 / A)
    assert felt(profile, T) < 1.02
    assert felt(profile, T / 2) < 1.05


@pytest.mark.long
@pytest.mark.parametrize("grid", [0.001, 0.00127, 0.00254])
def test_smoothing_moves_no_joint_by_more_than_a_step(grid: float) -> None:
    blocks = rounded_chords(3000, 100.0, grid)
    off = joints(build_path(blocks, STEPPED)) - written(blocks)
    assert np.abs(off).max() <= GRAIN + 1e-12
    assert np.abs(off).max() > 0.3 * GRAIN
    assert off[[0, -1]] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("grid", [0.001, 0.00127, 0.00254])
def test_smoothed_path_is_nearer_to_curve_than_programmed_points(grid: float) -> None:
    blocks = rounded_chords(3000, 100.0, grid)
    off, before = (
        np.abs(np.hypot(*each[100:-100, :2].T) - 50.0)
        for each in (joints(build_path(blocks, STEPPED)), written(blocks))
    )
    assert off.max() < before.max()
    assert off.mean() < 0.5 * before.mean()


def test_exact_chords_of_a_small_circle_hardly_move() -> None:
    blocks = chords(2.0, math.pi, 400, 30.0)
    off = np.abs(joints(build_path(blocks, STEPPED)) - written(blocks))
    assert off[50:-50].max() < 0.01 * GRAIN
    assert off.max() < 0.4 * GRAIN


def test_corner_between_chords_is_not_smoothed() -> None:
    there = [(0.0, 0.02 * i) for i in range(200)]
    across = [(0.02 * i, 0.02 * 199) for i in range(1, 200)]
    blocks = polyline([*there, *across], 100.0)
    assert joints(build_path(blocks, STEPPED)) == pytest.approx(written(blocks), abs=1e-12)


def test_straight_line_of_uneven_chords_stays_straight() -> None:
    ends = np.cumsum(np.random.default_rng(1).uniform(0.01, 0.15, 300))
    blocks = polyline([(0.3 * z, z) for z in [0.0, *ends.tolist()]], 60.0)
    off = joints(build_path(blocks, STEPPED)) - written(blocks)
    across = off[:, 0] - 0.3 * off[:, 1]
    assert np.abs(across).max() < 1e-12


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(programs())
def test_only_joints_between_short_chords_are_smoothed(blocks: list[Block]) -> None:
    """Of lines and arcs of all lengths only a joint between two of 0.02 mm that hardly turn may move."""
    path, as_written = build_path(blocks, STEPPED), build_path(blocks, LIMITS)
    off = np.abs(joints(path) - joints(as_written)).max(axis=1)
    assert off.max() <= GRAIN + 1e-12
    short = (as_written.pieces.length < 0.05) & (as_written.pieces.curvatures == 0.0)
    between = np.concatenate([[False], short[:-1] & short[1:], [False]])
    assert (off[~between] < 1e-12).all()
    assert path.block_numbers.tolist() == as_written.block_numbers.tolist()
    assert plan_motion(path).end_distance == path.joint_distances[-1]


@pytest.mark.parametrize("kind", ["arc", "rapid", "long"])
def test_chord_run_ends_at_other_element(kind: str) -> None:
    blocks = rounded_chords(300, 60.0, 0.001)
    last = blocks[-1]
    here, to = (last.x, last.z), (last.x + 0.4, last.z)
    other = {
        "arc": arc(here, to, (last.x + 0.2, last.z), 60.0, n=301),
        "rapid": dataclasses.replace(line(here, (last.x + 0.02, last.z), 60.0, n=301), kind=BlockKind.RAPID),
        "long": line(here, to, 60.0, n=301),
    }[kind]
    path = build_path([*blocks, other], STEPPED)
    assert path.find_block_span(301)[0] == pytest.approx(path.joint_distances[300])
    assert joints(path)[300, :2] == pytest.approx(here, abs=0)


@pytest.mark.long
@pytest.mark.parametrize("window", [90, 300, 2000])
def test_windowed_plan_equals_whole_plan(window: int) -> None:
    blocks = rounded_chords(1500, 100.0, 0.00127)
    whole = plan_motion(build_path(blocks, STEPPED))
    planner = WindowPlanner(STEPPED, window=window)
    chunks = [*planner.plan_blocks(blocks), *planner.finish_section()]
    assert chunks[-1].block_ends_s[-1] == pytest.approx(whole.duration_s, rel=1e-3)
    assert [n for chunk in chunks for n in chunk.block_numbers.tolist()] == [b.n for b in blocks]
    for before, after in pairwise(chunks):
        ends, begins = (
            before.profile.compute_positions(before.profile.duration_s),
            after.profile.compute_positions(0.0),
        )
        assert ends == pytest.approx(begins, abs=1e-9)


@pytest.mark.long
@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from([0.001, 0.00127, 0.00254, 0.004]))
def test_growing_path_does_not_move_current_position(seed: int, grid: float) -> None:
    """Blocks come in and are dropped at any moment, also in the middle of the last braking."""
    chance = np.random.default_rng(seed)
    blocks = rounded_chords(700, 100.0, grid)
    builder, at = PathBuilder(STEPPED), 40
    builder.add_blocks(blocks[:at])
    profile = plan_motion(builder.build_path())
    while at < len(blocks):
        (s,), (v,) = profile.compute_distances_and_speeds(float(chance.random()) * profile.duration_s)
        here = builder.build_path().compute_positions(np.array([s]))
        builder.drop_blocks_before(
            int(builder.build_path().block_numbers[profile.path.find_piece_indices(np.array([s]))[0]])
        )
        count = int(chance.integers(1, 150))
        builder.add_blocks(blocks[at : at + count], s + v * v / (2.0 * 0.2 * A))
        at += count
        assert builder.build_path().compute_positions(np.array([s])) == pytest.approx(here, abs=1e-9)
        profile = plan_motion(builder.build_path(), start_distance=s, start_speed=v)
    assert profile.compute_positions(profile.duration_s)[0][0] == pytest.approx(blocks[-1].x, abs=1e-9)


def test_chords_added_later_smooth_previous_end() -> None:
    blocks = rounded_chords(600, 100.0, 0.00127)
    whole = joints(build_path(blocks, STEPPED))
    builder = PathBuilder(STEPPED)
    for part in range(0, 600, 150):
        builder.add_blocks(blocks[part : part + 150])
    builder.end_path()
    assert joints(builder.build_path()) == pytest.approx(whole, abs=1e-9)


@pytest.mark.parametrize("near", [0, 1, 5])
def test_other_elements_added_later_are_not_smoothed(near: int) -> None:
    """A half circle of R 2, a long line and a turn of C behind chords, the slides ``near`` chords before."""
    there = rounded_chords(200, 100.0, 0.00127)
    at = there[-1]
    here, top = (at.x, at.z), (at.x, at.z - 4.0)
    behind = [
        line(here, (at.x + 0.02, at.z), 60.0, n=201),
        arc((at.x + 0.02, at.z), (at.x + 0.02, at.z - 4.0), (at.x + 0.02, at.z - 2.0), 60.0, n=202),
        line((at.x + 0.02, at.z - 4.0), top, 60.0, n=203),
        dataclasses.replace(line(top, top, 120.0, n=204), c=90.0),
    ]
    builder = PathBuilder(STEPPED)
    builder.add_blocks(there)
    end = builder.build_path().joint_distances
    builder.add_blocks(behind, float(end[-1 - near]))
    path = builder.build_path()
    assert path.find_block_span(202)[1] - path.find_block_span(202)[0] == pytest.approx(
        2.0 * math.pi, abs=1e-9
    )
    assert path.find_block_span(204)[1] - path.find_block_span(204)[0] == pytest.approx(90.0, abs=1e-9)
    ends = path.pieces.point(path.pieces.length)
    assert ends[:-1] == pytest.approx(path.pieces.start[1:], abs=1e-9)
    assert path.compute_positions(path.joint_distances[-1:])[0] == pytest.approx([*top, 90.0], abs=1e-9)


def test_path_close_to_current_position_is_not_changed() -> None:
    blocks = rounded_chords(400, 100.0, 0.00127)
    builder = PathBuilder(STEPPED)
    builder.add_blocks(blocks[:200])
    before = joints(builder.build_path())
    builder.add_blocks(
        blocks[200:], float(builder.build_path().joint_distances[-1 - SUPPORT_PIECE_COUNT // 2])
    )
    assert joints(builder.build_path())[:201] == pytest.approx(before, abs=0)


def test_c_rotation_added_during_motion_retains_its_length() -> None:
    """Its start differs from the end of the path by the noise of sums; a slide that stands has no chord."""
    builder = PathBuilder(STEPPED)
    builder.add_blocks([dataclasses.replace(line((10.0, 5.0), (20.0, 7.0)), c=-345.0)])
    turn = dataclasses.replace(line((20.0, 7.0), (20.0, 7.0), 120.0, n=2), c0=-345.0 + 1e-12, c=-355.0)
    builder.add_blocks([turn], math.inf)
    path = builder.build_path()
    assert path.pieces.length[-1] == pytest.approx(10.0)
    assert path.compute_positions(path.joint_distances[-1:])[0] == pytest.approx([20.0, 7.0, -355.0])


_short = st.lists(
    st.tuples(
        st.sampled_from([0.02, 0.00127, 1e-6, 0.0, -0.0004]), st.sampled_from([0.02, 1e-6, 0.0, -0.00127])
    ),
    min_size=1,
    max_size=6,
)


@pytest.mark.long
@settings(max_examples=150, deadline=None)
@given(_short, _short)
def test_joints_before_corner_do_not_depend_on_blocks_after_it(
    before: list[tuple[float, float]], behind: list[tuple[float, float]]
) -> None:
    """The slides may have passed it by then."""
    ends = np.cumsum([(60.0, 40.0), *before, (-5.0, -0.01), *behind], axis=0).tolist()
    blocks = polyline([(x, z) for x, z in ends], 60.0)
    alone = joints(build_path(blocks[: len(before) + 1], STEPPED))
    assert joints(build_path(blocks, STEPPED))[: len(alone)] == pytest.approx(alone, abs=1e-12)


def test_settled_joints_do_not_move_when_chords_are_added() -> None:
    blocks, builder = rounded_chords(400, 5.0, 0.00254), PathBuilder(STEPPED)
    builder.add_blocks(blocks[:200])
    path = builder.build_path()
    settled = find_last_settled_joint(path)
    builder.add_blocks(blocks[200:])
    assert settled > 100
    assert joints(builder.build_path())[: settled + 1] == pytest.approx(
        joints(path)[: settled + 1], abs=1e-12
    )


def test_chord_of_two_steps_retains_half_its_length() -> None:
    """Both of its ends may move by a quarter of it towards each other, not through each other."""
    zigzag = [(0.0013 * (i % 2), 0.0025 * i) for i in range(60)]
    blocks = polyline(zigzag, 60.0)
    off = np.abs(joints(build_path(blocks, STEPPED)) - written(blocks)).max()
    assert 0.0 < off <= 0.25 * math.hypot(0.0013, 0.0025) + 1e-12
