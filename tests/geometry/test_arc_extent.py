"""The box around an arc, against figures worked out by hand."""

import math

import pytest

from core.geometry.lines_and_arcs import compute_arc_extent, compute_arc_sweep


def test_convex_shaft_corner_is_a_clockwise_quarter() -> None:
    start, sweep = compute_arc_sweep(0.1, 0.0, 0.25, -0.15, 0.1, -0.15, is_clockwise=True)
    assert start == pytest.approx(0.0)
    assert sweep == pytest.approx(math.pi / 2)


def test_opposite_direction_sweeps_three_quarters_backward() -> None:
    _, sweep = compute_arc_sweep(0.1, 0.0, 0.25, -0.15, 0.1, -0.15, is_clockwise=False)
    assert sweep == pytest.approx(-3 * math.pi / 2)


def test_equal_start_and_end_give_a_full_circle() -> None:
    assert compute_arc_sweep(2.0, 0.0, 2.0, 0.0, 1.0, 0.0, is_clockwise=True)[1] == pytest.approx(2 * math.pi)
    assert compute_arc_sweep(2.0, 0.0, 2.0, 0.0, 1.0, 0.0, is_clockwise=False)[1] == pytest.approx(
        -2 * math.pi
    )


def test_quarter_arc_extends_no_further_than_its_ends() -> None:
    assert compute_arc_extent(0.1, 0.0, 0.25, -0.15, 0.1, -0.15, is_clockwise=True) == pytest.approx(
        (0.1, 0.25, -0.15, 0.0)
    )


def test_barrel_arc_extends_past_both_ends() -> None:
    # R .635 over a chord of .3 from (.2, -.2) to (.2, -.5): centre r .2 - sqrt(.635² - .15²), crown at +.635.
    cx = 0.2 - math.sqrt(0.635**2 - 0.15**2)
    box = compute_arc_extent(0.2, -0.2, 0.2, -0.5, cx, -0.35, is_clockwise=True)
    assert box == pytest.approx((0.2, cx + 0.635, -0.5, -0.2))


def test_full_circle_extends_to_its_four_quadrants() -> None:
    assert compute_arc_extent(2.0, 0.0, 2.0, 0.0, 1.0, 0.0, is_clockwise=False) == pytest.approx(
        (0.0, 2.0, -1.0, 1.0)
    )


@pytest.mark.parametrize("quadrant", range(4))
@pytest.mark.parametrize("clockwise", [True, False])
def test_arc_within_a_quadrant_is_short_or_spans_all_quadrants(quadrant: int, clockwise: bool) -> None:
    # Angles of 20 and 70 degrees in the quadrant: the arc the other way around passes all four axes.
    angles = [math.radians(90.0 * quadrant + each) for each in (20.0, 70.0)]
    (x0, z0), (x, z) = ((3.0 + 2.0 * math.sin(a), -1.0 + 2.0 * math.cos(a)) for a in angles)
    box = compute_arc_extent(x0, z0, x, z, 3.0, -1.0, is_clockwise=clockwise)
    short = (min(x0, x), max(x0, x), min(z0, z), max(z0, z))
    assert box == pytest.approx(short if clockwise else (1.0, 5.0, -3.0, 1.0))
    back = compute_arc_extent(x, z, x0, z0, 3.0, -1.0, is_clockwise=not clockwise)
    assert back == pytest.approx(box)


def test_nearly_equal_ends_give_a_full_circle() -> None:
    at = math.radians(30.0)
    x, z = 2.0 * math.sin(at), 2.0 * math.cos(at)
    assert compute_arc_extent(x, z, x + 5e-7, z, 0.0, 0.0, is_clockwise=True) == pytest.approx(
        (-2.0, 2.0, -2.0, 2.0)
    )
