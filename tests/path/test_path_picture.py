"""Blocks as polylines: where points lie, how arcs fall into chords, what is left to do."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.path.path_picture import PictureBuilder, build_picture
from app.path.polyline import MAX_CHORD_ERROR_MM, StrokeKind, count_arc_chords
from core.interpreter.shared.actions import SpindleStop
from core.interpreter.shared.elementary_blocks import Block, BlockKind, StraightMoveSeries, TimedSeries
from core.interpreter.shared.modal_state import ModalState

TURNING = ModalState(spindle=1, tool=1)


def move(
    n: int, kind: BlockKind, start: tuple[float, float], end: tuple[float, float], **more: object
) -> Block:
    """A block from (x, z) to (x, z)."""
    given = {"offset_x": 0.0, "offset_z": 0.0, "modal": TURNING, **more}
    return Block(n, n, kind, "", start[0], start[1], 0.0, end[0], end[1], 0.0, **given)  # type: ignore[arg-type]


def test_lines_share_their_corners() -> None:
    sketch = PictureBuilder()
    sketch.add_block(move(1, BlockKind.RAPID, (10, 5), (8, 1)), 1.0)
    sketch.add_block(move(2, BlockKind.FEED, (8, 1), (8, -20)), 3.0)
    picture = sketch.build_picture()
    assert picture.x.tolist() == [10, 8, 8]
    assert picture.z.tolist() == [5, 1, -20]
    assert picture.stroke.tolist() == [StrokeKind.JUMP, StrokeKind.RAPID, StrokeKind.TURN]
    assert [picture.count_finished_points(n) for n in (-1, 0, 1, 2, 99)] == [0, 0, 2, 3, 3]


def test_bounds_include_only_cuts() -> None:
    sketch = PictureBuilder()
    sketch.add_block(move(1, BlockKind.RAPID, (100, 90), (8, 1)), 1.0)
    sketch.add_block(move(2, BlockKind.FEED, (8, 1), (6, -20)), 3.0)
    assert sketch.build_picture().bounds == (-20, 1, 6, 8)


def test_no_blocks_make_an_empty_picture() -> None:
    picture = PictureBuilder().build_picture()
    assert picture.blocks == 0
    assert picture.bounds == (0, 0, 0, 0)
    assert picture.time_left(1, 0.0) == 0.0


def test_drawing_excludes_tool_offset_and_includes_work_shift() -> None:
    modal = ModalState(spindle=1, tool_offset_x=-50.0, tool_offset_z=-200.0)
    block = move(1, BlockKind.FEED, (5, 0), (5, -3), modal=modal, offset_x=-50.0, offset_z=-230.0)
    sketch = PictureBuilder()
    sketch.add_block(block, 1.0)
    assert sketch.build_picture().z.tolist() == [-30, -33]
    assert sketch.build_picture().x.tolist() == [5, 5]


def test_tool_change_is_a_jump() -> None:
    sketch = PictureBuilder()
    sketch.add_block(move(1, BlockKind.FEED, (5, 0), (5, -3)), 1.0)
    sketch.add_block(move(2, BlockKind.FEED, (2, 7), (2, 6)), 2.0)
    assert sketch.build_picture().stroke.tolist() == [
        StrokeKind.JUMP,
        StrokeKind.TURN,
        StrokeKind.JUMP,
        StrokeKind.TURN,
    ]


def test_feed_with_stopped_spindle_is_drawn_as_milling() -> None:
    sketch = PictureBuilder()
    sketch.add_block(move(1, BlockKind.FEED, (5, 0), (5, -3), modal=ModalState()), 1.0)
    assert sketch.build_picture().stroke[-1] == StrokeKind.MILL


@pytest.mark.parametrize("clockwise", [True, False])
def test_arc_is_drawn_on_its_circle(clockwise: bool) -> None:
    # quarter of a circle of 10 mm about (x, z) = (0, -10), or three quarters the other way
    sketch = PictureBuilder()
    sketch.add_block(move(1, BlockKind.ARC, (0, 0), (10, -10), cx=0.0, cz=-10.0, clockwise=clockwise), 1.0)
    picture = sketch.build_picture()
    radius = np.hypot(picture.x, picture.z + 10)
    assert radius == pytest.approx(np.full(len(radius), 10.0))
    chords = np.hypot(np.diff(picture.x), np.diff(picture.z))
    sagitta = 10 - np.sqrt(100 - (chords / 2) ** 2)
    assert sagitta.max() <= MAX_CHORD_ERROR_MM * 1.001
    turned = np.abs(np.diff(np.unwrap(np.arctan2(picture.x, picture.z + 10)))).sum()
    assert turned == pytest.approx(math.pi / 2 if clockwise else 3 * math.pi / 2)


def test_tiny_arc_has_few_chords() -> None:
    assert count_arc_chords(0.001, math.pi) == 4
    assert count_arc_chords(1000.0, 1e-9) == 1


def test_time_left_is_interpolated_within_block() -> None:
    sketch = PictureBuilder()
    sketch.add_block(move(1, BlockKind.FEED, (5, 0), (5, -10)), 4.0)
    sketch.add_block(
        Block(2, 2, BlockKind.ACTION, "", 5, -10, 0, 5, -10, 0, 0, 0, TURNING, action=SpindleStop()), 5.0
    )
    picture = sketch.build_picture()
    assert picture.time_left(1, 10.0) == pytest.approx(5.0)
    assert picture.time_left(1, 2.5) == pytest.approx(2.0)
    assert picture.time_left(2, 0.0) == pytest.approx(1.0)
    assert picture.time_left(0, 0.0) == pytest.approx(5.0)


def test_progress_callback_can_cancel_drawing() -> None:
    class EnoughError(Exception):
        pass

    def watch(count: int) -> None:
        raise EnoughError

    blocks = ((move(n, BlockKind.FEED, (5, 0), (5, -1)), 0.0, 1.0) for n in range(1, 5000))
    with pytest.raises(EnoughError):
        build_picture(blocks, watch)


def test_series_are_drawn_as_their_blocks_are() -> None:
    """A jump to the start, and each move a point and a block of its own."""
    moves = [move(n, BlockKind.FEED, (10 - n, n), (9 - n, n + 1)) for n in range(1, 6)]
    ends = [1.0, 2.5, 3.0, 4.0, 7.0]
    columns = [np.array([getattr(b, name) for b in moves], dtype=float) for name in ("x0", "z0", "x", "z")]
    numbers = np.arange(1, 6)
    x0, z0, x, z = columns
    series = StraightMoveSeries(moves[0], [""] * 5, numbers, numbers, x0=x0, z0=z0, x=x, z=z)
    told: list[int] = []
    rows = build_picture([TimedSeries(series, np.array([0.0, *ends[:-1]]), np.array(ends))], told.append)
    single = build_picture([(b, 0.0, end) for b, end in zip(moves, ends, strict=True)], told.append)
    for name in ("z", "x", "stroke", "first", "ends", "line"):
        assert getattr(rows, name).tolist() == getattr(single, name).tolist()
    assert rows.chord == pytest.approx(single.chord)
    assert rows.first.tolist() == [0, 2, 3, 4, 5, 6]
    assert rows.bounds == (1, 6, 4, 9)
