"""Points to measure from: which there are, which is nearest, which comes next; and what was touched."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.path.measuring import (
    MAX_CROSSING_CHORDS,
    PointKind,
    SnapPoint,
    SnapPoints,
    find_crossings,
    find_nearest_chord,
)
from app.path.polyline import Stroke
from tests.path.made import polyline

EVERYWHERE = (-100.0, 100.0, -100.0, 100.0)
# a square of 4 mm, its last side crossed by a diagonal that comes from elsewhere
SQUARE = polyline(
    [
        (0, 0, Stroke.JUMP),
        (4, 0, Stroke.TURN),
        (4, 4, Stroke.TURN),
        (0, 4, Stroke.TURN),
        (-2, 1, Stroke.JUMP),
        (6, 1, Stroke.TURN),
    ],
    [0, 2, 3, 4, 6],
)


def test_ends_of_blocks_and_starts_after_jumps_are_points() -> None:
    features = SnapPoints(SQUARE)
    assert features.find_nearest(0.3, 0.2) == SnapPoint(0, 0, PointKind.END)
    assert features.find_nearest(-3, 1) == SnapPoint(-2, 1, PointKind.END)


def test_points_within_an_arc_are_none() -> None:
    bend = polyline([(0, 0, Stroke.JUMP), (1, 1, Stroke.TURN), (2, 0, Stroke.TURN)], [0, 3])
    assert SnapPoints(bend).find_nearest(1, 1) != SnapPoint(1, 1, PointKind.END)


def test_middles_of_arcs_are_points() -> None:
    features = SnapPoints(replace(SQUARE, centers=np.array([[2.0, 2.0]])))
    assert features.find_nearest(2.4, 2.1) == SnapPoint(2, 2, PointKind.CENTER)


def test_crossings_are_found_where_they_are_in_sight() -> None:
    features = SnapPoints(SQUARE)
    assert features.find_nearest(4, 1.1) == SnapPoint(4, 0, PointKind.END)
    features.update_intersections(EVERYWHERE)
    assert features.find_nearest(4, 1.1) == SnapPoint(4, 1, PointKind.INTERSECTION)
    features.update_intersections((-100, 3, -100, 100))
    assert features.find_nearest(4, 1.1) == SnapPoint(4, 0, PointKind.END)


def test_a_jump_crosses_nothing() -> None:
    assert find_crossings(SQUARE, EVERYWHERE).tolist() == [[4, 1]]


def test_too_many_stretches_have_no_crossings_and_take_no_time() -> None:
    zigzag = polyline(
        [(float(k % 2), float(k), Stroke.TURN if k else Stroke.JUMP) for k in range(MAX_CROSSING_CHORDS + 2)],
        list(range(MAX_CROSSING_CHORDS + 3)),
    )
    assert len(find_crossings(zigzag, (-1, 2, -1, 1e4))) == 0


@pytest.mark.parametrize(
    ("way", "found"), [((1, 0), (4, 0)), ((0, 1), (0, 4)), ((-1, 0), (-2, 1)), ((0, -1), None)]
)
def test_an_arrow_goes_to_the_next_point_that_way(
    way: tuple[int, int], found: tuple[float, float] | None
) -> None:
    spot = SnapPoints(SQUARE).find_in_direction(0, 0, way)
    assert (spot and spot[:2]) == found


def test_along_the_path_and_on_at_the_other_end() -> None:
    features = SnapPoints(SQUARE)
    assert features.find_next_along_path(4, 4, 1) == SnapPoint(0, 4, PointKind.END)
    assert features.find_next_along_path(0, 0, -1) == SnapPoint(6, 1, PointKind.END)
    assert features.find_next_along_path(6, 1, 1) == SnapPoint(0, 0, PointKind.END)


def test_an_empty_trail_has_no_points() -> None:
    nothing = polyline([(0, 0, Stroke.JUMP)], [0])
    features = SnapPoints(replace(nothing, z=np.zeros(0), x=np.zeros(0), stroke=np.zeros(0, dtype=np.uint8)))
    features.update_intersections(EVERYWHERE)
    assert features.find_nearest(0, 0) is None
    assert features.find_in_direction(0, 0, (1, 0)) is None
    assert features.find_next_along_path(0, 0, 1) is None


def test_what_was_touched_is_the_nearest_stretch() -> None:
    point = find_nearest_chord(SQUARE, 3.8, 2.5, 0.5)
    assert point == 2
    assert SQUARE.find_block(2) == 2
    assert [SQUARE.find_block(p) for p in range(6)] == [1, 1, 2, 3, 4, 4]


def test_beside_the_path_nothing_is_touched() -> None:
    assert find_nearest_chord(SQUARE, 2, 2.5, 0.5) is None
    assert find_nearest_chord(SQUARE, -1, 2.4, 0.5) is None  # on the way of a jump
