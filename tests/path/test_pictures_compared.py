"""Where two pictures of one program differ most."""

from __future__ import annotations

from app.path.measuring import LargestDistance, find_largest_distance
from app.path.polyline import StrokeKind
from tests.path.made import polyline

JUMP, RAPID, TURN = StrokeKind.JUMP, StrokeKind.RAPID, StrokeKind.TURN
BEFORE = polyline([(9, 9, JUMP), (0, 5, RAPID), (-9, 5, TURN), (-9, 8, TURN)], [0, 2, 3, 4])


def test_largest_distance_is_at_farthest_cut_point() -> None:
    after = polyline(
        [(9, 9, JUMP), (7, 5, RAPID), (-9, 5.3, TURN), (-9.4, 8.3, TURN)],
        [0, 2, 3, 4],
    )
    found = find_largest_distance(BEFORE, after)
    assert found is not None
    assert abs(found.distance_mm - 0.5) < 1e-12  # .4 and .3; the rapid's 7 mm do not count
    assert found[1:] == (-9.4, 8.3)


def test_equal_paths_have_zero_distance() -> None:
    assert find_largest_distance(BEFORE, BEFORE) == LargestDistance(0.0, -9.0, 5.0)


def test_paths_with_different_point_counts_are_not_compared() -> None:
    assert find_largest_distance(BEFORE, polyline([(9, 9, JUMP), (0, 5, TURN)], [0, 2])) is None


def test_paths_with_different_strokes_are_not_compared() -> None:
    other = polyline([(9, 9, JUMP), (0, 5, TURN), (-9, 5, TURN), (-9, 8, TURN)], [0, 2, 3, 4])
    assert find_largest_distance(BEFORE, other) is None


def test_paths_without_cuts_are_not_compared() -> None:
    rapid = polyline([(9, 9, JUMP), (0, 5, RAPID)], [0, 2])
    assert find_largest_distance(rapid, rapid) is None
