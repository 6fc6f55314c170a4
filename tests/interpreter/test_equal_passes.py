"""How many passes a depth takes, and where they lie."""

from __future__ import annotations

import pytest

from core.interpreter.shared.contour_passes import compute_equal_depths, count_passes


@pytest.mark.parametrize(
    ("whole", "most", "count"),
    [(10.0, 4.0, 3), (12.0, 4.0, 3), (0.3, 0.1, 3), (0.7, 0.1, 7), (4.0, 10.0, 1), (4.0001, 4.0, 2)],
)
def test_no_pass_exceeds_maximum_depth(whole: float, most: float, count: int) -> None:
    assert count_passes(whole, most) == count


def test_zero_depth_needs_no_pass() -> None:
    assert count_passes(0.0, 4.0) == 0
    assert compute_equal_depths(0.0, 0) == []


def test_last_pass_reaches_full_depth() -> None:
    assert compute_equal_depths(9.0, 3) == [3.0, 6.0, 9.0]


def test_zero_pass_depth_is_rejected() -> None:
    with pytest.raises(ZeroDivisionError):
        count_passes(1.0, 0.0)
