"""Where a line from a point touches a circle, by the sense in which the way goes on round it."""

from __future__ import annotations

from math import dist

import pytest

from core.geometry.lines_and_arcs import Arc, Line, compute_turn_angle, find_tangent_point

CENTRE, POINT, RADIUS = (1.0, 2.0), (1.0, 7.0), 3.0  # 5 apart: 3, 4 and 5 are the sides


@pytest.mark.parametrize("clockwise", [True, False])
def test_tangent_line_continues_into_the_circle_without_a_corner(clockwise: bool) -> None:
    touch = find_tangent_point(POINT, CENTRE, RADIUS, is_clockwise=clockwise)
    assert dist(touch, CENTRE) == pytest.approx(3.0)
    assert dist(touch, POINT) == pytest.approx(4.0)
    onwards = Arc(touch, (1.0, -1.0), CENTRE, clockwise)
    assert compute_turn_angle(Line(POINT, touch).end_direction, onwards.start_direction) == pytest.approx(
        0.0, abs=1e-12
    )


def test_point_on_the_circle_is_its_own_tangent_point() -> None:
    assert find_tangent_point((4.0, 2.0), CENTRE, RADIUS, is_clockwise=True) == pytest.approx((4.0, 2.0))


def test_center_has_no_tangent_line() -> None:
    with pytest.raises(ZeroDivisionError):
        find_tangent_point(CENTRE, CENTRE, RADIUS, is_clockwise=True)
