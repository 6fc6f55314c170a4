"""Chamfers and fillets between lines. mm, (x, z), X downwards, Z to the right."""

from __future__ import annotations

from math import dist, pi, sqrt, tan

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from core.geometry.chamfer_and_rounding import (
    CornerError,
    CornerTooLargeError,
    SameDirectionError,
    chamfer,
    make_rounding,
)
from core.geometry.lines_and_arcs import Line, compute_distance_to_point, compute_turn_angle
from tests.coded import raises_code
from tests.geometry.contours import follow

FACE = Line((0, 0), (5, 0))
CYLINDER = Line((5, 0), (5, -9))


def test_right_angle_corner_is_chamfered() -> None:
    first, cut, last = chamfer(FACE, CYLINDER, 1)
    assert (first, cut, last) == (Line((0, 0), (4, 0)), Line((4, 0), (5, -1)), Line((5, -1), (5, -9)))


def test_fillet_at_a_convex_corner_toward_the_spindle_is_clockwise() -> None:
    first, round_, last = make_rounding(FACE, CYLINDER, 1)
    assert first.end == (4, 0)
    assert round_.end == last.start == pytest.approx((5, -1))
    assert round_.center == pytest.approx((4, -1))
    assert round_.clockwise


def test_fillet_at_a_concave_corner_is_counterclockwise() -> None:
    _, round_, _ = make_rounding(CYLINDER, Line((5, -9), (8, -9)), 1)
    assert (*round_.start, *round_.end, *round_.center) == pytest.approx((5, -8, 6, -9, 6, -8))
    assert not round_.clockwise


def test_chamfer_setback_is_measured_along_both_lines() -> None:
    # A cone of 45 degrees: 2 back on the face, 2 along the cone.
    _, cut, _ = chamfer(FACE, Line((5, 0), (8, -3)), 2)
    assert cut.start == pytest.approx((3, 0))
    assert cut.end == pytest.approx((5 + sqrt(2), -sqrt(2)))


def test_fillet_setback_depends_on_half_of_the_turn_angle() -> None:
    first, _, _ = make_rounding(FACE, Line((5, 0), (8, -3)), 2)
    assert first.end == pytest.approx((5 - 2 * tan(pi / 8), 0))


@pytest.mark.parametrize("size", [5.001, 9.5])
def test_a_set_back_longer_than_the_line_is_refused(size: float) -> None:
    with pytest.raises(CornerTooLargeError) as refused:
        chamfer(FACE, CYLINDER, size)
    assert refused.value.is_first_move
    with pytest.raises(CornerTooLargeError):
        make_rounding(FACE, CYLINDER, size)


def test_a_set_back_longer_than_the_next_line_is_refused() -> None:
    with pytest.raises(CornerTooLargeError) as refused:
        make_rounding(CYLINDER, Line((5, -9), (7, -9)), 2.5)
    assert (refused.value.is_first_move, refused.value.needed_length) == (False, pytest.approx(2.5))


def test_corner_may_use_the_whole_line() -> None:
    first, _, _ = chamfer(FACE, CYLINDER, 5)
    assert first.length == 0


def test_collinear_lines_have_no_corner() -> None:
    with pytest.raises(SameDirectionError):
        chamfer(FACE, Line((5, 0), (9, 0)), 1)


def test_reversing_lines_have_no_corner() -> None:
    with raises_code(CornerError, "straight-back"):
        make_rounding(FACE, Line((5, 0), (1, 0)), 1)


def test_zero_length_line_cannot_be_chamfered() -> None:
    with pytest.raises(CornerTooLargeError):
        chamfer(FACE, Line((5, 0), (5, 0)), 1)


@given(st.floats(-3.0, 3.0).filter(lambda a: abs(a) > 0.01), st.floats(0.01, 3.0))
def test_a_fillet_touches_both_lines(angle: float, radius: float) -> None:
    before, after = follow([(50.0, 0.0, "line", 1.0), (50.0, angle, "line", 1.0)])
    assert isinstance(before, Line)
    assert isinstance(after, Line)
    try:
        first, round_, last = make_rounding(before, after, radius)
    except CornerTooLargeError:
        assume(radius * tan(abs(angle) / 2) < 50)
        raise
    assert abs(compute_turn_angle(first.end_direction, round_.start_direction)) < 1e-5
    assert abs(compute_turn_angle(round_.end_direction, last.start_direction)) < 1e-5
    assert round_.radius == pytest.approx(radius)
    assert dist(round_.end, round_.center) == pytest.approx(radius, abs=1e-6)
    assert compute_distance_to_point(before, round_.center) == pytest.approx(radius, abs=1e-6)
    assert compute_distance_to_point(after, round_.center) == pytest.approx(radius, abs=1e-6)
