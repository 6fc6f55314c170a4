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
from core.motion.motion_plan import plan
from core.motion.window_planner import Chunk, ChunkPlanner, sample_positions
from tests.coded import raises_code
from tests.motion.moves import LIMITS, A, chords, line, polyline, programs, rounded_chords
from tests.motion.paths import build_path


def planned(blocks: list[Block], window: int) -> list[Chunk]:
    """All chunks of a program."""
    planner = ChunkPlanner(LIMITS, window=window)
    return [*planner.add(blocks), *planner.finish()]


@pytest.mark.long
@settings(max_examples=80, deadline=None)
@given(programs(most=40), st.integers(1, 12))
def test_windows_equal_the_whole(blocks: list[Block], window: int) -> None:
    whole = plan(build_path(blocks, LIMITS))
    numbers, start, end = whole.block_times()
    chunks = planned(blocks, window)
    assert np.concatenate([c.n for c in chunks]).tolist() == numbers.tolist()
    assert np.concatenate([c.t0 for c in chunks]) == pytest.approx(start, rel=1e-9, abs=1e-12)
    assert np.concatenate([c.t1 for c in chunks]) == pytest.approx(end, rel=1e-9, abs=1e-12)
    assert chunks[-1].t + chunks[-1].profile.duration == pytest.approx(whole.duration, rel=1e-9)


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(programs(most=40), st.integers(1, 12))
def test_chunks_continue_each_other(blocks: list[Block], window: int) -> None:
    chunks = planned(blocks, window)
    for a, b in pairwise(chunks):
        assert b.t == pytest.approx(a.t + a.profile.duration, rel=1e-12)
        assert (b.profile.start_s, b.profile.phases.v[0]) == pytest.approx((a.profile.end_s, a.profile.end_v))


def test_chords_longer_to_brake_on_than_a_window() -> None:
    """100 mm/s need 1.64 mm to stop; windows of 20 chords hold 0.4 mm and have to grow."""
    blocks = chords(50.0, 0.5, 1250, 100.0)
    whole = plan(build_path(blocks, LIMITS))
    chunks = planned(blocks, 20)
    assert len(chunks) > 10
    assert chunks[-1].t1[-1] == pytest.approx(whole.duration, rel=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("window", [3, 40, 300])
def test_windows_of_chords_on_the_step_equal_the_whole(window: int) -> None:
    """The limit of a joint looks an interval back and ahead, over what is dropped and what is to come."""
    blocks = rounded_chords(1500, 100.0, 0.001)
    whole = plan(build_path(blocks, LIMITS))
    chunks = planned(blocks, window)
    assert len(chunks) > 2
    assert chunks[-1].t1[-1] == pytest.approx(whole.duration, rel=1e-3)


def test_blocks_are_taken_lazily_and_memory_stays_bounded() -> None:
    taken = 0

    def source() -> Iterator[Block]:
        nonlocal taken
        for block in polyline([(0.0, 0.5 * i) for i in range(5001)], 60.0):
            taken += 1
            yield block

    planner = ChunkPlanner(LIMITS, window=100)
    chunks = planner.add(source())
    first = next(chunks)
    assert taken == 100
    assert len(first.n) > 80
    assert max(len(c.profile.path) for c in chunks) < 220
    assert taken == 5000


def test_an_exact_stop_is_the_end_of_a_path() -> None:
    planner = ChunkPlanner(LIMITS)
    blocks = polyline([(0, 0), (0, 50), (0, 100)], 100.0)
    first = [*planner.add(blocks[:1]), *planner.finish()]
    second = [*planner.add(blocks[1:]), *planner.finish()]
    each = 0.5 + 100.0 / A
    assert first[0].t1.tolist() == pytest.approx([each])
    assert (second[0].t, second[0].t1[0]) == pytest.approx((each, 2 * each))
    assert planner.t == pytest.approx(2 * each)


def test_finishing_nothing_yields_nothing() -> None:
    planner = ChunkPlanner(LIMITS)
    assert [*planner.add([]), *planner.finish(), *planner.finish()] == []


def test_blocks_without_length_are_reported_once() -> None:
    points = [(0.0, float(i // 3)) for i in range(60)]
    chunks = planned(polyline(points), 4)
    assert np.concatenate([c.n for c in chunks]).tolist() == list(range(1, 60))


def test_a_bad_block_is_refused_where_it_comes() -> None:
    planner = ChunkPlanner(LIMITS, window=2)
    blocks = polyline([(0, 0), (0, 50), (0, 100), (0, 150)])
    bad = [*blocks, line((0, 150), (0, 160), -3.0, n=4)]
    with raises_code(MotionError, "no-feed", "Block 4"):
        list(planner.add(bad))


def test_an_empty_window_is_refused() -> None:
    with raises_code(MotionError, "empty-window"):
        ChunkPlanner(MotionLimits(), window=0)


def test_samples_of_chunks_lie_on_one_grid() -> None:
    """What a trace does: the first sample of a chunk is the next multiple of dt."""
    blocks = chords(5.0, 3.0, 700, 90.0)
    whole = plan(build_path(blocks, LIMITS))
    rows = []
    for chunk in planned(blocks, 50):
        offset = math.ceil(chunk.t / 0.001 - 1e-9) * 0.001 - chunk.t
        t, p, n = sample_positions(chunk.profile, 0.001, max(offset, 0.0))
        rows += [(chunk.t + a, *b, c) for a, b, c in zip(t.tolist(), p.tolist(), n.tolist(), strict=True)]
    table = np.array(rows)
    assert table[:, 0] == pytest.approx(0.001 * np.arange(len(table)), abs=1e-9)
    assert table[:, 1:4] == pytest.approx(whole.position(table[:, 0]), abs=1e-6)
    assert len(table) == math.ceil(whole.duration / 0.001)


def test_samples_need_an_interval() -> None:
    profile = plan(build_path([line((0, 0), (0, 1))], LIMITS))
    with raises_code(MotionError, "sampling-interval"):
        sample_positions(profile, 0.0)
