"""Areas of pockets and what lies a distance inside of them, against closed formulas."""

from __future__ import annotations

import math
import random
from itertools import pairwise

import pytest

from core.geometry.lines_and_arcs import Arc, Element, Line, Point, compute_distance_to_point
from core.geometry.pocket_area import (
    ElementLoop,
    PocketAreaError,
    WindingCalculator,
    find_boundary,
    is_counterclockwise,
    make_inset_loops,
)


def polygon(*points: Point) -> ElementLoop:
    return [Line(a, b) for a, b in zip(points, (*points[1:], points[0]), strict=True)]


def circle(centre: Point, radius: float, *, clockwise: bool = False) -> ElementLoop:
    start = centre[0] + radius, centre[1]
    return [Arc(start, start, centre, clockwise)]


def enclosed(loops: list[ElementLoop]) -> float:
    """Area by Green's formula, sampled finely on arcs: islands count against it."""
    total = 0.0
    for loop in loops:
        for element in loop:
            steps = 1 if isinstance(element, Line) else 400
            points = [element.get_point(element.length * at / steps) for at in range(steps + 1)]
            total += sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(points)) / 2.0
    return total


SQUARE = polygon((0.0, 0.0), (60.0, 0.0), (60.0, 40.0), (0.0, 40.0))


def area(
    pockets: list[ElementLoop], islands: list[ElementLoop]
) -> tuple[list[ElementLoop], list[WindingCalculator], list[WindingCalculator]]:
    within, stay = (
        [WindingCalculator(loop) for loop in pockets],
        [WindingCalculator(loop) for loop in islands],
    )
    found = find_boundary(
        [*pockets, *islands],
        lambda p: (
            any(w.compute_winding_number(p) for w in within)
            and not any(w.compute_winding_number(p) for w in stay)
        ),
    )
    return found, within, stay


def test_rectangle_inset_matches_its_formula_until_nothing_is_left() -> None:
    loops, _, _ = area([SQUARE], [])
    for by in (1.0, 7.5, 19.9):
        assert enclosed(make_inset_loops(loops, by)) == pytest.approx((60 - 2 * by) * (40 - 2 * by), abs=1e-6)
    assert make_inset_loops(loops, 20.001) == []


def test_island_grows_with_rounded_corners_until_the_pocket_is_gone() -> None:
    """Rectangle less a circle, both moved: (60 - 2d)(40 - 2d) - pi (8 + d)^2 while they do not meet."""
    loops, _, _ = area([SQUARE], [circle((30.0, 20.0), 8.0)])
    for by in (1.0, 5.0):
        expected = (60 - 2 * by) * (40 - 2 * by) - math.pi * (8 + by) ** 2
        assert enclosed(make_inset_loops(loops, by)) == pytest.approx(expected, abs=1e-2)
    assert len(make_inset_loops(loops, 5.0)) == 2
    assert len(make_inset_loops(loops, 7.0)) == 2  # fallen apart into a left and a right room
    assert all(is_counterclockwise(loop) for loop in make_inset_loops(loops, 7.0))


def test_overlapping_circles_merge_and_an_island_across_a_wall_cuts_in() -> None:
    loops, _, _ = area([circle((35.0, 50.0), 25.0), circle((65.0, 50.0), 25.0, clockwise=True)], [])
    lens = 2 * 25**2 * math.acos(0.6) - 30 * 20  # of two circles of R25, 30 apart
    assert enclosed(loops) == pytest.approx(2 * math.pi * 25**2 - lens, abs=1e-1)
    loops, _, _ = area([SQUARE], [polygon((20.0, -5.0), (30.0, -5.0), (30.0, 25.0), (20.0, 25.0))])
    assert enclosed(loops) == pytest.approx(60 * 40 - 10 * 25)


def test_coincident_edges_are_not_a_boundary() -> None:
    loops, _, _ = area([SQUARE, polygon((60.0, 10.0), (80.0, 10.0), (80.0, 30.0), (60.0, 30.0))], [])
    assert len(loops) == 1
    assert enclosed(loops) == pytest.approx(60 * 40 + 20 * 20)


def _nearest(loops: list[ElementLoop], point: Point) -> float:
    return min(compute_distance_to_point(element, point) for loop in loops for element in loop)


def _random_loop(dice: random.Random) -> ElementLoop:
    middle = dice.uniform(0, 40), dice.uniform(0, 40)
    if dice.random() < 0.3:
        return circle(middle, dice.uniform(5, 20), clockwise=dice.random() < 0.5)
    count = dice.randint(3, 8)
    corners = []
    for at in range(count):
        angle, size = 2 * math.pi * (at + dice.uniform(0, 0.9)) / count, dice.uniform(8, 25)
        x, y = middle[0] + size * math.cos(angle), middle[1] + size * math.sin(angle)
        corners.append((round(x, 3), round(y, 3)))
    return polygon(*corners)


def test_point_is_inside_the_inset_only_if_far_enough_from_boundaries() -> None:
    """Any pockets and islands: each point by its distance alone, as no offset does it."""
    dice, judged, given_up = random.Random(71), 0, 0
    for _ in range(25):
        loops, within, stay = area([_random_loop(dice) for _ in range(dice.randint(1, 2))],
                                   [_random_loop(dice) for _ in range(dice.randint(0, 2))])  # fmt: skip
        by = dice.choice((0.5, 2.0, 4.0))
        try:
            inner = [WindingCalculator(loop) for loop in make_inset_loops(loops, by)]
        except PocketAreaError:
            given_up += 1
            continue
        for _ in range(80):
            point = dice.uniform(-20, 60), dice.uniform(-20, 60)
            inside = any(w.compute_winding_number(point) for w in within) and not any(
                w.compute_winding_number(point) for w in stay
            )
            away = _nearest(loops, point) if loops else 0.0
            if inside and abs(away - by) > 0.002:
                judged += 1
                assert (sum(w.compute_winding_number(point) for w in inner) == 1) == (away > by)
    assert judged > 100
    assert given_up <= 1


def test_open_contour_is_rejected() -> None:
    open_end: list[Element] = [Line((0.0, 0.0), (10.0, 0.0)), Line((10.0, 0.0), (10.0, 10.0))]
    with pytest.raises(PocketAreaError):
        find_boundary([open_end], lambda point: point[1] > 0.0)
