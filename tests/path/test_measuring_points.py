"""Points to measure from: which there are, which is nearest, which comes next; and what was touched."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.path.measuring import (
    MAX_CROSSING_CHORDS,
    SnapPoint,
    SnapPointKind,
    SnapPoints,
    find_intersections,
    find_nearest_chord,
)
from app.path.polyline import StrokeKind
from tests.path.made import polyline

EVERYWHERE = (-100.0, 100.0, -100.0, 100.0)
# a square of 4 mm, its last side crossed by a diagonal that comes from elsewhere
SQUARE = polyline(
    [
        (0, 0, StrokeKind.JUMP),
        (4, 0, StrokeKind.TURN),
        (4, 4, StrokeKind.TURN),
        (0, 4, StrokeKind.TURN),
        (-2, 1, StrokeKind.JUMP),
        (6, 1, StrokeKind.TURN),
    ],
    [0, 2, 3, 4, 6],
)


def test_ends_of_blocks_and_starts_after_jumps_are_points() -> None:
    features = SnapPoints(SQUARE)
    assert features.find_nearest_point(0.3, 0.2) == SnapPoint(0, 0, SnapPointKind.END)
    assert features.find_nearest_point(-3, 1) == SnapPoint(-2, 1, SnapPointKind.END)


def test_intermediate_arc_points_are_not_snap_points() -> None:
    bend = polyline([(0, 0, StrokeKind.JUMP), (1, 1, StrokeKind.TURN), (2, 0, StrokeKind.TURN)], [0, 3])
    assert SnapPoints(bend).find_nearest_point(1, 1) != SnapPoint(1, 1, SnapPointKind.END)


def test_arc_centers_are_snap_points() -> None:
    features = SnapPoints(replace(SQUARE, arc_centers=np.array([[2.0, 2.0]])))
    assert features.find_nearest_point(2.4, 2.1) == SnapPoint(2, 2, SnapPointKind.CENTER)


def test_intersections_are_found_in_visible_area() -> None:
    features = SnapPoints(SQUARE)
    assert features.find_nearest_point(4, 1.1) == SnapPoint(4, 0, SnapPointKind.END)
    features.update_intersections(EVERYWHERE)
    assert features.find_nearest_point(4, 1.1) == SnapPoint(4, 1, SnapPointKind.INTERSECTION)
    features.update_intersections((-100, 3, -100, 100))
    assert features.find_nearest_point(4, 1.1) == SnapPoint(4, 0, SnapPointKind.END)


def test_jump_intersects_nothing() -> None:
    assert find_intersections(SQUARE, EVERYWHERE).tolist() == [[4, 1]]


def test_intersections_are_skipped_for_too_many_segments() -> None:
    zigzag = polyline(
        [
            (float(k % 2), float(k), StrokeKind.TURN if k else StrokeKind.JUMP)
            for k in range(MAX_CROSSING_CHORDS + 2)
        ],
        list(range(MAX_CROSSING_CHORDS + 3)),
    )
    assert len(find_intersections(zigzag, (-1, 2, -1, 1e4))) == 0


@pytest.mark.parametrize(
    ("way", "found"), [((1, 0), (4, 0)), ((0, 1), (0, 4)), ((-1, 0), (-2, 1)), ((0, -1), None)]
)
def test_arrow_key_selects_next_point_in_its_direction(
    way: tuple[int, int], found: tuple[float, float] | None
) -> None:
    spot = SnapPoints(SQUARE).find_point_in_direction(0, 0, way)
    assert (spot and spot[:2]) == found


def test_next_point_along_path_wraps_around() -> None:
    features = SnapPoints(SQUARE)
    assert features.find_next_path_point(4, 4, 1) == SnapPoint(0, 4, SnapPointKind.END)
    assert features.find_next_path_point(0, 0, -1) == SnapPoint(6, 1, SnapPointKind.END)
    assert features.find_next_path_point(6, 1, 1) == SnapPoint(0, 0, SnapPointKind.END)


def test_empty_path_has_no_snap_points() -> None:
    nothing = polyline([(0, 0, StrokeKind.JUMP)], [0])
    features = SnapPoints(replace(nothing, z=np.zeros(0), x=np.zeros(0), stroke=np.zeros(0, dtype=np.uint8)))
    features.update_intersections(EVERYWHERE)
    assert features.find_nearest_point(0, 0) is None
    assert features.find_point_in_direction(0, 0, (1, 0)) is None
    assert features.find_next_path_point(0, 0, 1) is None


def test_touch_selects_nearest_segment() -> None:
    point = find_nearest_chord(SQUARE, 3.8, 2.5, 0.5)
    assert point == 2
    assert SQUARE.find_block(2) == 2
    assert [SQUARE.find_block(p) for p in range(6)] == [1, 1, 2, 3, 4, 4]


def test_touch_away_from_path_selects_nothing() -> None:
    assert find_nearest_chord(SQUARE, 2, 2.5, 0.5) is None
    assert find_nearest_chord(SQUARE, -1, 2.4, 0.5) is None  # on the way of a jump
