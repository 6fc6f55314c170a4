"""Chamfers beside arcs: on both ways, of equal straight legs, cutting the corner and nothing else."""

from __future__ import annotations

import random
from math import asin, cos, dist, pi, sin

import pytest

from core.geometry.chamfer_and_rounding import (
    CornerError,
    CornerTooLargeError,
    SameDirectionError,
    chamfer,
    find_chamfer_leg,
)
from core.geometry.lines_and_arcs import Arc, Element, Line, compute_turn_angle, make_arc
from tests.coded import raises_code

LONG = Line((0.0, 90.0), (0.0, 10.0))
LINE = Line((0.0, 30.0), (0.0, 10.0))
BALL = make_arc((0.0, 10.0), (10.0, 0.0), (0.0, 0.0), is_clockwise=True)


def test_chamfer_leg_at_a_right_angle_is_length_over_sqrt_2() -> None:
    one, other = Line((0.0, 0.0), (0.0, -20.0)), Line((0.0, -20.0), (15.0, -20.0))
    assert chamfer(one, other, 3.0) == chamfer(one, other, 3.0)
    assert find_chamfer_leg(one, other, 3.0) == pytest.approx(3.0 / 2**0.5)


def test_chamfer_between_line_and_arc_matches_hand_calculation() -> None:
    """On the circle of 10 a chord of 4 spans 2 asin(.2)."""
    first, cut, last = chamfer(LINE, BALL, 4.0)
    angle = 2 * asin(0.2)
    assert first == Line((0.0, 30.0), (0.0, 14.0))
    assert last.start == pytest.approx((10 * sin(angle), 10 * cos(angle)))
    assert cut == Line(first.end, last.start)
    assert last.end == BALL.end


def test_random_chamfers_have_the_requested_leg_length() -> None:
    dice, made = random.Random(7), 0
    for _ in range(3000):
        before, after = _way(dice).make_reversed(), _way(dice)
        leg = dice.uniform(0.01, 3.0)
        try:
            first, cut, last = chamfer(before, after, leg)
        except CornerError:
            continue
        made += 1
        assert dist(first.end, (0.0, 0.0)) == pytest.approx(leg, abs=1e-9)
        assert dist(last.start, (0.0, 0.0)) == pytest.approx(leg, abs=1e-9)
        for part, whole in ((first, before), (last, after)):
            if isinstance(part, Arc) and isinstance(whole, Arc):
                assert part.radius == pytest.approx(whole.radius, abs=1e-9)
                assert abs(part.sweep_rad) < abs(whole.sweep_rad)
        corner = compute_turn_angle(before.end_direction, after.start_direction)
        if first.length > 1e-3 and last.length > 1e-3:
            assert compute_turn_angle(first.end_direction, cut.start_direction) * corner > 0
            assert compute_turn_angle(cut.end_direction, last.start_direction) * corner > 0
    assert made > 1000


def test_leg_for_a_chamfer_length_gives_that_length() -> None:
    dice, made = random.Random(11), 0
    for _ in range(1000):
        before, after = _way(dice).make_reversed(), _way(dice)
        length = dice.uniform(0.01, 2.0)
        try:
            _, cut, _ = chamfer(before, after, find_chamfer_leg(before, after, length))
        except CornerError:
            continue
        made += 1
        assert cut.length == pytest.approx(length, abs=1e-7)
    assert made > 300


def _way(dice: random.Random) -> Element:
    """From the origin."""
    if dice.random() < 0.4:
        angle = dice.uniform(-pi, pi)
        return Line((0.0, 0.0), (5 * sin(angle), 5 * cos(angle)))
    radius, at, sweep = dice.uniform(1, 9), dice.uniform(-pi, pi), dice.uniform(0.2, 5.0)
    clockwise = dice.random() < 0.5
    centre = radius * sin(at), radius * cos(at)
    turned = at + pi + (sweep if clockwise else -sweep)
    end = centre[0] + radius * sin(turned), centre[1] + radius * cos(turned)
    return Arc((0.0, 0.0), end, centre, clockwise)


@pytest.mark.parametrize(
    ("before", "after", "leg", "first"),
    [
        (LINE, BALL, 15.0, False),  # a quarter of 10 has a chord of 14.14
        (LONG, BALL, 21.0, False),  # longer than the circle is wide
        (Line((0.0, 12.0), (0.0, 10.0)), BALL, 3.0, True),
        (LONG, Arc(BALL.start, BALL.start, BALL.center, clockwise=True), 20.5, False),
    ],
)
def test_element_that_is_too_short_is_named(before: Element, after: Element, leg: float, first: bool) -> None:
    with pytest.raises(CornerTooLargeError) as caught:
        chamfer(before, after, leg)
    assert caught.value.is_first_move is first


def test_chamfer_that_consumes_a_whole_arc_is_rejected() -> None:
    with pytest.raises(CornerTooLargeError):
        chamfer(LINE, BALL, dist(BALL.start, BALL.end))


def test_tangent_elements_have_no_corner() -> None:
    with pytest.raises(SameDirectionError):
        chamfer(Line((-5.0, 10.0), (0.0, 10.0)), BALL, 1.0)


def test_reversing_line_and_arc_have_no_corner() -> None:
    with raises_code(CornerError, "straight-back"):
        chamfer(Line((5.0, 10.0), (0.0, 10.0)), BALL, 1.0)


def test_a_chamfer_that_would_cross_the_arc_is_refused() -> None:
    """A blunt corner onto an arc that bends back under the chamfer."""
    before = Line((-4.0, 10.5), (0.0, 10.0))
    with raises_code(CornerError, "crosses"):
        chamfer(before, BALL, 3.0)


def test_chamfer_length_that_does_not_fit_is_rejected() -> None:
    with raises_code(CornerError, "too-short"):
        find_chamfer_leg(LINE, BALL, 60.0)
