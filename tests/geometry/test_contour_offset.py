"""Offsets of lines and arcs, of contours, and what they refuse. mm, (x, z), X downwards, Z to the right."""

from __future__ import annotations

from itertools import pairwise
from math import dist, pi, sqrt, tan

import pytest
from hypothesis import assume, event, given, settings
from hypothesis import strategies as st

from core.geometry.contour_offset import (
    GOUGE_CHECK_ELEMENT_COUNT,
    JOIN_TOLERANCE_MM,
    GougeError,
    OffsetBuilder,
    offset_element,
    offset_known_contour,
)
from core.geometry.lines_and_arcs import (
    Arc,
    Element,
    Line,
    Point,
    compute_distance_to_point,
    compute_min_distance,
)
from tests.geometry.contours import CONTOURS, arc, follow, polyline, sampled

pytestmark = pytest.mark.long


def offset_contour(elements: list[Element], left: float) -> list[Element]:
    """The whole path beside a contour."""
    return [piece.element for piece in offset_known_contour(elements, left)]


def test_left_offset_of_an_outward_line_is_away_from_the_spindle() -> None:
    assert offset_element(Line((1, 0), (5, 0)), 0.4) == Line((1, 0.4), (5, 0.4))
    assert offset_element(Line((5, 0), (5, -9)), 0.4) == Line((5.4, 0), (5.4, -9))
    assert offset_element(Line((5, 0), (5, -9)), -0.4) == Line((4.6, 0), (4.6, -9))


def test_arcs_stay_concentric() -> None:
    convex = Arc((1, 0), (4, -3), (1, -3), clockwise=True)
    assert offset_element(convex, 0.5) == Arc((1, 0.5), (4.5, -3), (1, -3), clockwise=True)
    assert offset_element(convex, -0.5) == Arc((1, -0.5), (3.5, -3), (1, -3), clockwise=True)
    hollow = Arc((4, -3), (1, 0), (1, -3), clockwise=False)
    assert offset_element(hollow, 0.5) == Arc((3.5, -3), (1, -0.5), (1, -3), clockwise=False)


def ends(path: list[Element]) -> list[Point]:
    found = [path[0].start, *(element.end for element in path)]
    return [(round(x, 6), round(z, 6)) for x, z in found]


def test_outside_corner_gets_an_arc_around_it() -> None:
    path = offset_contour(polyline((0, 0), (5, 0), (5, -9)), 0.4)
    assert ends(path) == [(0, 0.4), (5, 0.4), (5.4, 0), (5.4, -9)]
    assert path[1] == Arc((5, 0.4), (5.4, 0), (5, 0), clockwise=True)


def test_outside_corner_on_the_other_side_gets_the_opposite_arc() -> None:
    path = offset_contour(polyline((5, -9), (5, 0), (0, 0)), -0.4)
    assert path[1] == Arc((5.4, 0), (5, 0.4), (5, 0), clockwise=False)


def test_an_inside_corner_is_where_the_offsets_meet() -> None:
    path = offset_contour(polyline((5, 0), (5, -9), (8, -9)), 0.4)
    assert ends(path) == [(5.4, 0), (5.4, -8.6), (8, -8.6)]
    path = offset_contour(polyline((0, 0), (5, 0), (5, -9)), -0.4)
    assert ends(path) == [(0, -0.4), (4.6, -0.4), (4.6, -9)]


def test_line_and_arc_meet_at_an_inside_corner() -> None:
    # A cylinder of 5 that ends at a ball of radius 5 about (5, -15): the offsets are x 5.4 and radius 5.4.
    ball = Arc((5, -10), (10, -15), (5, -15), clockwise=True)
    path = offset_contour([Line((5, 0), (5, -10)), ball], 0.4)
    assert ends(path)[1] == (5.4, round(-15 + sqrt(5.4**2 - 0.4**2), 6))
    assert isinstance(path[1], Arc)
    assert path[1].radius == pytest.approx(5.4)


def test_two_arcs_meet_at_an_inside_corner() -> None:
    # Two balls of radius 5 whose centres lie 8 apart meet 3 over the line of centres.
    first = Arc((0, 5), (3, -4), (0, 0), clockwise=True)
    second = Arc((3, -4), (0, -13), (0, -8), clockwise=True)
    path = offset_contour([first, second], 1)
    assert ends(path)[1] == (round(sqrt(36 - 16), 6), -4)


def test_tangent_elements_get_no_corner_arc() -> None:
    fillet = Arc((4, 0), (5, -1), (4, -1), clockwise=True)
    path = offset_contour([Line((0, 0), (4, 0)), fillet, Line((5, -1), (5, -9))], 0.4)
    assert ends(path) == [(0, 0.4), (4, 0.4), (5.4, -1), (5.4, -9)]


def test_zero_distance_returns_the_contour() -> None:
    contour = polyline((0, 0), (5, 0), (5, -9), (5, -3))
    assert offset_contour(contour, 0) == contour


GROOVE = polyline((5, 0), (5, -3), (3, -3), (3, -4), (5, -4), (5, -9))
KEYHOLE = polyline((5, 0), (5, -3), (4.5, -3), (4.5, -1), (2, -1), (2, -6), (4.5, -6), (4.5, -3.5), (5, -3.5))
REFUSED: list[tuple[str, list[Element], float, int]] = [
    ("an inside arc of the radius itself", [arc((0, 0), (5, -5), 5, clockwise=False)], 5, 0),
    ("an inside arc under the radius", [arc((0, 0), (5, -5), 5, clockwise=False)], 6, 0),
    ("the same on the right", [arc((0, 0), (5, -5), 5, clockwise=True)], -6, 0),
    ("a groove narrower than the nose", GROOVE, 0.6, 2),
    ("a step lower than the nose", polyline((5, 0), (5, -3), (5.3, -3.3), (5.3, -6), (9, -6)), 5, 1),
    ("a second wall far along the way", KEYHOLE, 0.3, 6),
    ("straight back", polyline((5, 0), (5, -3), (5, 0)), 0.4, 1),
    ("straight back at an arc", [Line((5, 0), (5, -3)), arc((5, -3), (7, -1), 2, clockwise=True)], 0.4, 1),
    ("a line too short for an inside arc", [  # its offset x 8 meets the arc's only behind its start
        Line((5, 0), (5, -0.1)), arc((5, -0.1), (6, -1.1), 1, clockwise=True)], 3, 0),
]  # fmt: skip


@pytest.mark.parametrize(
    ("contour", "left", "index"), [each[1:] for each in REFUSED], ids=[each[0] for each in REFUSED]
)
def test_gouges_are_rejected_at_their_element(contour: list[Element], left: float, index: int) -> None:
    with pytest.raises(GougeError) as refused:
        offset_contour(contour, left)
    assert refused.value.element_index == index


@pytest.mark.parametrize(
    ("contour", "left"),
    [
        ([arc((0, 0), (5, -5), 5, clockwise=False)], 4.99),
        (GROOVE, 0.49),
        (KEYHOLE, 0.24),
        (polyline((5, 0), (5, -3), (5.3, -3.3), (5.3, -6), (9, -6)), 0.3),
    ],
)
def test_contour_just_short_of_a_gouge_is_offset(contour: list[Element], left: float) -> None:
    check(contour, offset_contour(contour, left), abs(left))


def check(contour: list[Element], path: list[Element], apart: float) -> None:
    """No point too near to any element; where it runs along elements, exactly the distance."""
    for piece in path:
        for point in sampled(piece):
            nearest = min(compute_distance_to_point(element, point) for element in contour)
            assert apart - 0.002 <= nearest <= apart + 0.001
    for before, after in pairwise(path):
        assert dist(before.end, after.start) < 1e-6


@settings(max_examples=400, deadline=None)
@given(CONTOURS, st.floats(0.05, 1.5), st.booleans())
def test_offset_points_are_never_nearer_than_the_distance(
    contour: list[Element], apart: float, left: bool
) -> None:
    try:
        path = offset_contour(contour, apart if left else -apart)
    except GougeError:
        event("refused")
        return
    event("offset")
    check(contour, path, apart)


@settings(max_examples=300, deadline=None)
@given(CONTOURS, st.floats(0.05, 1.5), st.booleans())
def test_offset_of_the_reversed_contour_is_the_same(contour: list[Element], apart: float, left: bool) -> None:
    side = apart if left else -apart
    turned = [element.make_reversed() for element in reversed(contour)]
    try:
        path, back = offset_contour(contour, side), offset_contour(turned, -side)
    except GougeError:
        assume(False)
    if len(back) != len(path):  # by an arc so short that it is left out
        assert min(piece.length for piece in path + back) < 2 * JOIN_TOLERANCE_MM
        return
    for forth, other in zip(path, reversed(back), strict=True):
        assert dist(forth.start, other.end) < JOIN_TOLERANCE_MM
        assert dist(forth.end, other.start) < JOIN_TOLERANCE_MM


@settings(max_examples=200, deadline=None)
@given(CONTOURS)
def test_the_clearance_of_two_elements_is_the_least_distance(contour: list[Element]) -> None:
    assume(len(contour) > 1)
    a, b = contour[0], contour[-1]
    measured = min(dist(p, q) for p in sampled(a, 61) for q in sampled(b, 61))
    longest = max(a.length, b.length) / 60
    assert measured - longest <= compute_min_distance(a, b) <= measured + 1e-9


@given(CONTOURS, st.floats(0, 1))
def test_distance_from_start_locates_a_point_on_an_element(contour: list[Element], share: float) -> None:
    for element in contour:
        at = share * element.length
        assert element.get_distance_from_start(element.get_point(at)) == pytest.approx(at, abs=1e-6)
        assert compute_distance_to_point(element, element.get_point(at)) < 1e-6


def test_long_contour_is_offset_while_it_is_added() -> None:
    offset, out = OffsetBuilder(0.2), 0
    for k in range(1000):
        out += len(list(offset.add(Line((10.0, -k), (10.0, -k - 1)))))
    assert out == 1000 - 1 - GOUGE_CHECK_ELEMENT_COUNT
    assert len(list(offset.finish_contour())) == GOUGE_CHECK_ELEMENT_COUNT + 1


def test_cone_inside_corner_matches_hand_calculation() -> None:
    # Half the turn of 45 degrees: the corner moves back by tan 22.5 degrees of the distance.
    corner = offset_contour(polyline((5, 0), (5, -5), (8, -8)), 1)[0].end
    assert corner == pytest.approx((6, -5 + tan(pi / 8)))


@given(
    st.lists(st.tuples(st.floats(0.01, 9), st.floats(0.001, 0.5)), min_size=2, max_size=6), st.floats(0, 5)
)
def test_convex_contour_is_never_rejected(steps: list[tuple[float, float]], apart: float) -> None:
    # It turns by 172 degrees at most, always away from the free side.
    contour = follow([(length, -turned, "line", 1.0) for length, turned in steps])
    path = offset_contour(contour, -apart)
    assert sum(isinstance(element, Line) for element in path) == len(contour)
