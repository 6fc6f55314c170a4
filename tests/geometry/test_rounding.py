"""Roundings between lines and arcs: tangent at both ends, of their radius, on the ways as they were."""

from __future__ import annotations

import math
import random
from math import cos, dist, pi, sin

import pytest

from core.geometry.chamfer_and_rounding import CornerError, SameDirectionError, make_rounding
from core.geometry.lines_and_arcs import Arc, Element, Line, make_arc
from tests.coded import raises_code

Point = tuple[float, float]


def near(one: Point, other: Point) -> bool:
    return dist(one, other) < 1e-6


def check(before: Element, after: Element, radius: float) -> None:
    """Everything that makes a rounding one, seen from the points and directions alone."""
    first, arc, last = make_rounding(before, after, radius)
    assert near(first.start, before.start)
    assert near(last.end, after.end)
    assert near(first.end, arc.start)
    assert near(arc.end, last.start)
    assert arc.radius == pytest.approx(radius, abs=1e-6)
    assert abs(arc.sweep_rad) < pi
    for one, other in ((first, arc), (arc, last)):
        assert near(one.end_direction, other.start_direction)
    for part, whole in ((first, before), (last, after)):
        assert part.length <= whole.length + 1e-6
        if isinstance(part, Arc) and isinstance(whole, Arc):
            assert near(part.center, whole.center)


def test_rounding_from_line_into_arc_matches_hand_calculation() -> None:
    """Along the axis onto a ball of 10, then out along it: the rounding's centre is 2 off the axis and 12 off
    the middle of the ball.
    """
    line = Line((0.0, 30.0), (0.0, 10.0))
    ball = make_arc((0.0, 10.0), (10.0, 0.0), (0.0, 0.0), is_clockwise=True)
    first, arc, last = make_rounding(line, ball, 2.0)
    assert arc.center == pytest.approx((2.0, math.sqrt(12.0**2 - 2.0**2)))
    assert first.end == pytest.approx((0.0, math.sqrt(140.0)))
    assert last.start == pytest.approx((10.0 / 12.0 * 2.0, 10.0 / 12.0 * math.sqrt(140.0)))
    check(line, ball, 2.0)


def test_rounding_of_two_lines_is_repeatable() -> None:
    one, other = Line((0.0, 0.0), (0.0, -20.0)), Line((0.0, -20.0), (15.0, -20.0))
    assert make_rounding(one, other, 3.0) == make_rounding(one, other, 3.0)


def test_random_roundings_are_tangent() -> None:
    dice, made = random.Random(3), 0
    for _ in range(3000):
        corner = (dice.uniform(-5, 5), dice.uniform(-5, 5))
        before, after = _way(dice, corner).make_reversed(), _way(dice, corner)
        radius = dice.uniform(0.05, 1.5)
        try:
            check(before, after, radius)
        except CornerError:
            continue
        made += 1
    assert made > 1500


def _way(dice: random.Random, start: Point) -> Element:
    """A line or an arc from this point, some mm long."""
    angle = dice.uniform(0, 2 * pi)
    if dice.random() < 0.4:
        length = dice.uniform(3, 12)
        return Line(start, (start[0] + length * sin(angle), start[1] + length * cos(angle)))
    radius, clockwise = dice.uniform(2, 9), dice.random() < 0.5
    centre = start[0] + radius * sin(angle), start[1] + radius * cos(angle)
    turned = angle + pi + (1 if clockwise else -1) * dice.uniform(0.6, 2.5)
    end = centre[0] + radius * sin(turned), centre[1] + radius * cos(turned)
    return make_arc(start, end, centre, is_clockwise=clockwise)


def test_tangent_elements_have_no_corner() -> None:
    line = Line((10.0, 20.0), (10.0, 0.0))
    arc = make_arc((10.0, 0.0), (0.0, -10.0), (0.0, 0.0), is_clockwise=True)
    with pytest.raises(SameDirectionError):
        make_rounding(line, arc, 1.0)


def test_rounding_longer_than_the_line_is_rejected() -> None:
    """r 45 would touch the axis at sqrt(55² - 45²) = 31.6; the line begins at 30, where r 40 does."""
    line = Line((0.0, 30.0), (0.0, 10.0))
    ball = make_arc((0.0, 10.0), (10.0, 0.0), (0.0, 0.0), is_clockwise=True)
    check(line, ball, 39.9)
    with raises_code(CornerError, "no-touching-arc"):
        make_rounding(line, ball, 45.0)


@pytest.mark.parametrize("radius", [2.6, 5.0, 6.0])
def test_rounding_too_large_for_the_inside_of_an_arc_is_rejected(radius: float) -> None:
    """From the middle of a bowl of 5 out to its rim: r 2.5 is the largest that lies between both."""
    spoke = Line((0.0, 0.0), (0.0, 5.0))
    bowl = make_arc((0.0, 5.0), (5.0, 0.0), (0.0, 0.0), is_clockwise=True)
    check(spoke, bowl, 2.4)
    with pytest.raises(CornerError):
        make_rounding(spoke, bowl, radius)


def test_rounding_that_consumes_a_whole_arc_is_rejected() -> None:
    """The rounding of 2 touches the ball where it is asked to end: nothing of it would be left."""
    line = Line((0.0, 30.0), (0.0, 10.0))
    touch = 10.0 / 12.0 * 2.0, 10.0 / 12.0 * math.sqrt(140.0)
    with raises_code(CornerError, "no-touching-arc"):
        make_rounding(line, make_arc((0.0, 10.0), touch, (0.0, 0.0), is_clockwise=True), 2.0)
