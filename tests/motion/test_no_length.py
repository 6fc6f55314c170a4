"""Blocks and paths of no length: repeated points, ways under a step, turns of C alone, arcs of no radius.

Real programs are full of them, and none may be a special case of anything: they are done when their turn
comes, whatever comes in behind them and wherever a plan begins, is braked or is stopped.
"""

from __future__ import annotations

import dataclasses
import math
from random import Random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.motion.axis_limits import FloatArray, MotionLimits
from core.motion.motion_path import MotionPath, PathBuilder
from core.motion.motion_plan import plan_motion
from core.motion.motion_profile import MotionProfile
from core.motion.window_planner import WindowPlanner
from tests.motion.moves import LIMITS, arc, line, polyline
from tests.motion.paths import build_path

STEPPED = dataclasses.replace(LIMITS, grain=0.00127)
# mm: none, what is one point, what is hardly none, parts of a step, a step, chords, moves
_WAYS = st.sampled_from([0.0, 0.0, 0.0, 1e-12, 5e-8, 1.2e-7, 1e-6, 1e-5, 4e-4, 0.00127, 0.02, 0.3, 5.0])
_TURNS = st.sampled_from([0.0, 0.0, 0.0, 1e-8, 1.5e-7, 1e-6, 0.01, 3.0, 90.0, -360.0])
_FEEDS = st.sampled_from([2.0, 8.0, 60.0, 126.0, 500.0])
_SIGNS = st.sampled_from([1.0, -1.0])
_RADII = st.sampled_from([0.0, 1e-9, 1e-7, 2e-7, 1e-5, 0.001, 0.5, 20.0])
_SWEEPS = st.sampled_from([0.0, 0.0, 1e-9, 1e-6, 0.001, 0.5, 3.0, 6.28])


@st.composite
def mostly_nothing(draw: st.DrawFn) -> list[Block]:
    """Lines, turns of C and arcs, most of them of no length or next to none."""
    at, c, blocks = (0.0, 0.0), 0.0, []
    for n in range(1, draw(st.integers(1, 20)) + 1):
        what = draw(st.sampled_from(["line", "line", "line", "point", "turn", "arc"]))
        feed, turn = draw(_FEEDS), draw(_TURNS) if what == "turn" else 0.0
        if what == "arc":
            block = _arc(at, draw(_RADII), draw(st.floats(0.0, 6.28)), draw(_SWEEPS), feed, n)
        else:
            way = (0.0, 0.0) if what == "point" else (draw(_WAYS) * draw(_SIGNS), draw(_WAYS) * draw(_SIGNS))
            kind = draw(st.sampled_from([BlockKind.RAPID, BlockKind.FEED]))
            block = line(at, (at[0] + way[0], at[1] + way[1]), feed, n=n, kind=kind)
        blocks.append(dataclasses.replace(block, c0=c, c=c + turn))
        at, c = (block.x, block.z), c + turn
    return blocks


def _arc(at: tuple[float, float], radius: float, angle: float, sweep: float, feed: float, n: int) -> Block:
    centre = at[0] - radius * math.sin(angle), at[1] - radius * math.cos(angle)
    end = centre[0] + radius * math.sin(angle + sweep), centre[1] + radius * math.cos(angle + sweep)
    return arc(at, end if sweep else at, centre, feed, n=n)


def demand_setpoints(profile: MotionProfile, limits: MotionLimits) -> None:
    """What a driver demands of a plan: no jump, no axis beyond its limits, rest at the end."""
    _, dt, p, v, a = profile.make_segments(0.0, profile.duration_s)
    if not len(dt):
        return
    assert all(np.isfinite(part).all() for part in (p, v, a))
    p_end, v_end = p + (v + 0.5 * a * dt[:, None]) * dt[:, None], v + a * dt[:, None]
    assert np.abs(p[1:] - p_end[:-1]).max(initial=0.0) < 5e-4
    assert (np.abs(v[1:] - v_end[:-1]) <= limits.max_acceleration_array * limits.interval * 1.01 + 1e-3).all()
    assert (np.abs(v) <= limits.speeds * 1.001 + 0.01).all()
    assert np.abs(v_end[-1]).max() < 0.01


def end_of(blocks: list[Block]) -> FloatArray:
    return np.array([blocks[-1].x, blocks[-1].z, blocks[-1].c])


limits_of_both = st.sampled_from([LIMITS, STEPPED])
some = settings(max_examples=150, deadline=None)


@pytest.mark.long
@some
@given(mostly_nothing(), limits_of_both)
def test_plan_ends_at_end_of_last_block(blocks: list[Block], limits: MotionLimits) -> None:
    profile = plan_motion(build_path(blocks, limits))
    demand_setpoints(profile, limits)
    assert profile.compute_positions(profile.duration_s)[0] == pytest.approx(end_of(blocks), abs=1e-6)
    numbers, start, end = profile.find_block_times()
    assert numbers.tolist() == [block.n for block in blocks]
    assert (end >= start).all()
    assert np.isfinite(end).all()


@pytest.mark.long
@some
@given(mostly_nothing(), limits_of_both, st.sampled_from([1, 2, 5]))
def test_windows_contain_every_block_once(blocks: list[Block], limits: MotionLimits, window: int) -> None:
    planner = WindowPlanner(limits, window=window)
    chunks = [*planner.plan_blocks(blocks), *planner.finish_section()]
    assert [n for chunk in chunks for n in chunk.block_numbers.tolist()] == [block.n for block in blocks]
    assert chunks[-1].profile.compute_positions(1e9)[0] == pytest.approx(end_of(blocks), abs=1e-6)


@pytest.mark.long
@settings(max_examples=120, deadline=None)
@given(mostly_nothing(), limits_of_both, st.randoms(use_true_random=False))
def test_motion_can_be_stopped_changed_and_continued_anywhere(
    blocks: list[Block], limits: MotionLimits, chance: Random
) -> None:
    """Blocks come in, single block, holds and overrides (0 too) come at any moment, again and again."""
    builder, taken = PathBuilder(limits), chance.randint(1, len(blocks))
    builder.add_blocks(blocks[:taken])
    profile = plan_motion(builder.build_path())
    for _ in range(30):
        t = chance.choice([0.0, 1.0, 1.0, chance.random()]) * profile.duration_s
        (s,), (v,) = profile.compute_distances_and_speeds(t)
        here = profile.compute_positions(t)[0]
        if chance.random() < 0.5:
            builder.drop_blocks_before(int(profile.find_block_numbers(t)[0]))
        if taken < len(blocks) and chance.random() < 0.6:
            more = blocks[taken : taken + chance.randint(1, 4)]
            builder.add_blocks(more, float(s + v * v / (0.4 * limits.max_plane_acceleration)))
            taken += len(more)
        profile = _changed(builder.build_path(), float(s), float(v), chance)
        demand_setpoints(profile, limits)
        assert profile.compute_positions(0.0)[0] == pytest.approx(here, abs=1e-5)
    (s,), (v,) = profile.compute_distances_and_speeds(profile.duration_s)
    if taken < len(blocks):
        builder.add_blocks(blocks[taken:], float(s))
    builder.end_path()
    profile = plan_motion(builder.build_path(), start_distance=float(s), start_speed=float(v))
    assert profile.compute_positions(profile.duration_s)[0] == pytest.approx(end_of(blocks), abs=1e-6)


def _changed(path: MotionPath, s: float, v: float, chance: Random) -> MotionProfile:
    """Another plan from a state of the last one: a hold, an override, a stop behind a block, or just on."""
    match chance.choice(["hold", "override", "single", "on"]):
        case "hold":
            return plan_motion(path, start_distance=s, start_speed=v, stop_early=True)
        case "override":
            feed, rapid = chance.choice([0.0, 0.01, 1.5]), chance.choice([0.0, 0.5, 1.0])
            return plan_motion(path, start_distance=s, start_speed=v, feed_scale=feed, rapid_scale=rapid)
        case "single":
            last = chance.choice(path.block_numbers.tolist())
            factor = np.repeat(np.where(path.block_numbers > last, 0.0, 1.0), np.diff(path.first_pieces))
            pieces = dataclasses.replace(path.pieces, rate=path.pieces.rate * factor)
            return plan_motion(dataclasses.replace(path, pieces=pieces), start_distance=s, start_speed=v)
    return plan_motion(path, start_distance=s, start_speed=v)


# --- by hand ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("limits", [LIMITS, STEPPED], ids=["written", "stepped"])
def test_blocks_can_be_added_to_zero_length_path(limits: MotionLimits) -> None:
    """The machine stands where the first move goes, and what comes behind it comes in later."""
    builder = PathBuilder(limits)
    builder.add_blocks([line((3, 4), (3, 4), n=1)])
    assert plan_motion(builder.build_path()).duration_s == 0.0
    builder.add_blocks([line((3, 4), (3, 4), n=2)], 0.0)
    builder.add_blocks(
        [dataclasses.replace(block, n=block.n + 2) for block in polyline([(3, 4), (3, 4), (3, 9)])], 0.0
    )
    path = builder.build_path()
    assert path.block_numbers.tolist() == [1, 2, 3, 4]
    assert path.length == pytest.approx(5.0)
    assert plan_motion(path).compute_positions(99.0)[0, :2].tolist() == [3.0, 9.0]


def test_single_block_stops_after_zero_length_block() -> None:
    blocks = polyline([(0, 0), (0, 0), (0, 10)])
    path = build_path(blocks, LIMITS)
    still = dataclasses.replace(path, pieces=dataclasses.replace(path.pieces, rate=path.pieces.rate * 0.0))
    profile = plan_motion(still)
    assert (profile.duration_s, profile.end_distance) == (0.0, 0.0)
    assert plan_motion(still, start_distance=0.0, stop_early=True).duration_s == 0.0


def test_zero_length_path_can_be_stopped_planned_and_scaled() -> None:
    path = build_path([line((1, 2), (1, 2))], LIMITS)
    for profile in (
        plan_motion(path),
        plan_motion(path, stop_early=True),
        plan_motion(path, feed_scale=0.0, rapid_scale=0.0),
    ):
        assert (profile.duration_s, profile.end_speed) == (0.0, 0.0)
        assert profile.compute_positions(np.array([0.0, 1.0])).tolist() == [[1.0, 2.0, 0.0]] * 2
        assert profile.make_segments(0.0, 1.0)[0].size == 0


@pytest.mark.parametrize("way", [1.2e-7, 1e-6, 5e-5])
def test_c_rotation_with_move_below_resolution_is_planned_as_c_rotation(way: float) -> None:
    """Far along a path rounding of the distance would else be a jump of C."""
    far = line((0, 0), (0, 900.0), 126.0, n=1)
    turn = dataclasses.replace(line((0, 900.0), (way, 900.0), 100.0, n=2, kind=BlockKind.RAPID), c=-3600.0)
    path = build_path([far, turn], LIMITS)
    span = path.find_block_span(2)
    assert span[1] - span[0] == pytest.approx(3600.0)
    assert path.compute_positions(np.array([span[1]]))[0] == pytest.approx([way, 900.0, -3600.0], abs=1e-9)


def test_slow_c_rotation_with_real_move_is_measured_along_linear_axes() -> None:
    block = dataclasses.replace(line((0, 0), (0.002, 0.0), 1.0), c=90.0)
    assert build_path([block], LIMITS).length == pytest.approx(0.002)
