"""Planning in windows gives what planning at once gives, and holds no more than its windows."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.interpreter.shared.elementary_blocks import Block
from core.motion.axis_limits import MotionError, MotionLimits
from core.motion.motion_plan import plan_motion
from core.motion.window_planner import PlannedChunk, WindowPlanner, sample_positions
from tests.coded import raises_code
from tests.motion.moves import LIMITS, A, chords, line, polyline, programs, rounded_chords
from tests.motion.paths import build_path


def planned(blocks: list[Block], window: int) -> list[PlannedChunk]:
    """All chunks of a program."""
    planner = WindowPlanner(LIMITS, window=window)
    return [*planner.plan_blocks(blocks), *planner.finish_section()]


@pytest.mark.long
@settings(max_examples=80, deadline=None)
@given(programs(most=40), st.integers(1, 12))
def test_windowed_plan_equals_whole_plan(blocks: list[Block], window: int) -> None:
    whole = plan_motion(build_path(blocks, LIMITS))
    numbers, start, end = whole.find_block_times()
    chunks = planned(blocks, window)
    assert np.concatenate([c.block_numbers for c in chunks]).tolist() == numbers.tolist()
    assert np.concatenate([c.block_starts_s for c in chunks]) == pytest.approx(start, rel=1e-8, abs=1e-12)
    assert np.concatenate([c.block_ends_s for c in chunks]) == pytest.approx(end, rel=1e-8, abs=1e-12)
    assert chunks[-1].start_time_s + chunks[-1].profile.duration_s == pytest.approx(
        whole.duration_s, rel=1e-9
    )


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(programs(most=40), st.integers(1, 12))
def test_chunks_are_continuous(blocks: list[Block], window: int) -> None:
    chunks = planned(blocks, window)
    for a, b in pairwise(chunks):
        assert b.start_time_s == pytest.approx(a.start_time_s + a.profile.duration_s, rel=1e-12)
        assert (b.profile.start_distance, b.profile.phases.start_speeds[0]) == pytest.approx(
            (a.profile.end_distance, a.profile.end_speed)
        )


def test_window_grows_when_chords_are_shorter_than_braking_distance() -> None:
    """100 mm/s need 1.64 mm to stop; windows of 20 chords hold 0.4 mm and have to grow."""
    blocks = chords(50.0, 0.5, 1250, 100.0)
    whole = plan_motion(build_path(blocks, LIMITS))
    chunks = planned(blocks, 20)
    assert len(chunks) > 10
    assert chunks[-1].block_ends_s[-1] == pytest.approx(whole.duration_s, rel=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("window", [3, 40, 300])
def test_windowed_plan_of_rounded_chords_equals_whole_plan(window: int) -> None:
    """The limit of a joint looks an interval back and ahead, over what is dropped and what is to come."""
    blocks = rounded_chords(1500, 100.0, 0.001)
    whole = plan_motion(build_path(blocks, LIMITS))
    chunks = planned(blocks, window)
    assert len(chunks) > 2
    assert chunks[-1].block_ends_s[-1] == pytest.approx(whole.duration_s, rel=1e-3)


def test_blocks_are_read_lazily_with_bounded_memory() -> None:
    taken = 0

    def source() -> Iterator[Block]:
        nonlocal taken
        for block in polyline([(0.0, 0.5 * i) for i in range(5001)], 60.0):
            taken += 1
            yield block

    planner = WindowPlanner(LIMITS, window=100)
    chunks = planner.plan_blocks(source())
    first = next(chunks)
    assert taken == 100
    assert len(first.block_numbers) > 80
    assert max(len(c.profile.path) for c in chunks) < 220
    assert taken == 5000


def test_an_exact_stop_is_the_end_of_a_path() -> None:
    planner = WindowPlanner(LIMITS)
    blocks = polyline([(0, 0), (0, 50), (0, 100)], 100.0)
    first = [*planner.plan_blocks(blocks[:1]), *planner.finish_section()]
    second = [*planner.plan_blocks(blocks[1:]), *planner.finish_section()]
    each = 0.5 + 100.0 / A
    assert first[0].block_ends_s.tolist() == pytest.approx([each])
    assert (second[0].start_time_s, second[0].block_ends_s[0]) == pytest.approx((each, 2 * each))
    assert planner.planned_time_s == pytest.approx(2 * each)


def test_finishing_empty_section_yields_nothing() -> None:
    planner = WindowPlanner(LIMITS)
    assert [*planner.plan_blocks([]), *planner.finish_section(), *planner.finish_section()] == []


def test_blocks_without_length_are_reported_once() -> None:
    points = [(0.0, float(i // 3)) for i in range(60)]
    chunks = planned(polyline(points), 4)
    assert np.concatenate([c.block_numbers for c in chunks]).tolist() == list(range(1, 60))


def test_invalid_block_is_rejected_when_it_is_reached() -> None:
    planner = WindowPlanner(LIMITS, window=2)
    blocks = polyline([(0, 0), (0, 50), (0, 100), (0, 150)])
    bad = [*blocks, line((0, 150), (0, 160), -3.0, n=4)]
    with raises_code(MotionError, "no-feed", "Block 4"):
        list(planner.plan_blocks(bad))


def test_an_empty_window_is_refused() -> None:
    with raises_code(MotionError, "empty-window"):
        WindowPlanner(MotionLimits(), window=0)


def test_samples_of_chunks_are_on_one_time_grid() -> None:
    """What a trace does: the first sample of a chunk is the next multiple of dt."""
    blocks = chords(5.0, 3.0, 700, 90.0)
    whole = plan_motion(build_path(blocks, LIMITS))
    rows = []
    for chunk in planned(blocks, 50):
        offset = math.ceil(chunk.start_time_s / 0.001 - 1e-9) * 0.001 - chunk.start_time_s
        t, p, n = sample_positions(chunk.profile, 0.001, max(offset, 0.0))
        rows += [
            (chunk.start_time_s + a, *b, c)
            for a, b, c in zip(t.tolist(), p.tolist(), n.tolist(), strict=True)
        ]
    table = np.array(rows)
    assert table[:, 0] == pytest.approx(0.001 * np.arange(len(table)), abs=1e-9)
    assert table[:, 1:4] == pytest.approx(whole.compute_positions(table[:, 0]), abs=1e-6)
    assert len(table) == math.ceil(whole.duration_s / 0.001)


def test_zero_sampling_interval_is_rejected() -> None:
    profile = plan_motion(build_path([line((0, 0), (0, 1))], LIMITS))
    with raises_code(MotionError, "sampling-interval"):
        sample_positions(profile, 0.0)
