"""Stretches beside a contour, and the way along it: by hand, and on random contours."""

from __future__ import annotations

from itertools import pairwise
from math import dist, sqrt

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.geometry.contour_offset import RoughingArea, TrimError, trim_offset
from core.geometry.lines_and_arcs import Arc, Element, Line, compute_distance_to_point
from tests.geometry.contours import arc, polyline, sampled

STEP = polyline((10, 1), (6, 1), (6, 20), (2, 20))
"""Face at way 1 up to depth 6, cylinder to way 20, shoulder up to depth 2; (depth, way)."""


def test_passes_end_at_the_shoulder_and_at_the_face() -> None:
    area = RoughingArea(STEP, 0.5)
    assert area.find_clear_spans(1) == [(0, pytest.approx(19.5))]
    assert area.find_clear_spans(5) == [(0, pytest.approx(19.5))]
    assert area.find_clear_spans(5.5) == [(0, pytest.approx(19.5))]  # on the offset of the cylinder itself
    assert area.find_clear_spans(5.6) == [(0, pytest.approx(1 - sqrt(0.25 - 0.4**2), abs=1e-5))]
    assert area.find_clear_spans(9) == [(0, pytest.approx(0.5))]
    assert area.find_clear_spans(10.1) == []


def test_zero_allowance_follows_the_contour() -> None:
    area = RoughingArea(STEP, 0)
    assert area.path == STEP
    assert area.find_clear_spans(5.9) == [(0, pytest.approx(20))]
    assert area.find_clear_spans(7) == [(0, pytest.approx(1))]


def test_protrusion_divides_a_pass_in_two() -> None:
    bump = [*polyline((6, 0), (6, 10)), arc((6, 10), (6, 14), 2, clockwise=True), *polyline((6, 14), (6, 30))]
    assert bump[1].get_point(bump[1].length / 2) == pytest.approx((4, 12))
    area = RoughingArea(bump, 1)
    half = sqrt(3**2 - 1**2)  # the offset circle of radius 3 about (6, 12), cut at depth 5
    assert area.find_clear_spans(2.9) == [(0, 30)]
    assert area.find_clear_spans(5) == [
        (0, pytest.approx(12 - half, abs=1e-5)),
        (pytest.approx(12 + half, abs=1e-5), 30),
    ]
    assert not area.reverses_in_z


def test_span_does_not_reach_under_an_edge() -> None:
    """A hook: depth 6, up to depth 2 at way 20, back to way 12 at depth 3."""
    hook = polyline((6, 0), (6, 20), (2, 20), (2, 12), (1, 12))
    area = RoughingArea(hook, 0)
    assert area.reverses_in_z
    assert area.find_clear_spans(4) == [(0, 12)]


def test_path_rounds_outside_corners_and_meets_in_inside_corners() -> None:
    path = trim_offset(STEP, 0.5)
    assert [type(element) for element in path] == [Line, Arc, Line, Line]
    assert path[0].start == pytest.approx((10, 0.5))
    assert path[1].start == pytest.approx((6, 0.5))
    assert path[1].end == pytest.approx((5.5, 1))
    assert path[2].end == pytest.approx((5.5, 19.5))
    assert path[3].end == pytest.approx((2, 19.5))


def test_fillet_smaller_than_the_allowance_is_skipped() -> None:
    fillet = [
        *polyline((6, 0), (6, 19.7)),
        arc((6, 19.7), (5.7, 20), 0.3, clockwise=False),
        Line((5.7, 20), (2, 20)),
    ]
    path = trim_offset(fillet, 0.5)
    assert [element.end for element in path] == [pytest.approx((5.5, 19.5)), pytest.approx((2, 19.5))]


def test_path_rounds_the_corner_after_a_skipped_fillet() -> None:
    """A fillet of .4, less than the .5, up to a wall that is none: a corner outwards right behind it."""
    contour = [
        *polyline((4, 0), (4, 9.6)),
        arc((4, 9.6), (3.6, 10), 0.4, clockwise=False),
        *polyline((3.6, 10), (3.6, 20)),
    ]
    path = trim_offset(contour, 0.5)
    assert path[-1].end == pytest.approx((3.1, 20))
    assert all(dist(a.end, b.start) < 0.01 for a, b in pairwise(path))
    round_corner = next(each for each in path if isinstance(each, Arc))
    assert round_corner.center == (3.6, 10)


def test_groove_that_is_too_narrow_is_skipped() -> None:
    groove = polyline((6, 0), (6, 10), (9, 10), (9, 10.8), (6, 10.8), (6, 20))
    path = trim_offset(groove, 0.5)
    # The two round corners of radius .5 meet half way between the walls, .4 from each: depth 6 - .3.
    deepest = max(element.bounding_box[1] for element in path)
    assert deepest == pytest.approx(6 - sqrt(0.5**2 - 0.4**2))


def test_a_bottle_is_not_entered_through_a_narrow_neck() -> None:
    bottle = polyline(
        (6, 0), (6, 10), (9, 10), (9, 5), (12, 5), (12, 15), (9, 15), (9, 10.8), (6, 10.8), (6, 20)
    )
    assert max(element.bounding_box[1] for element in trim_offset(bottle, 0.5)) < 6


def test_step_smaller_than_the_allowance_ends_the_path_before_it() -> None:
    """The step of .2 at way 20: at depth 5.5 its corner (5.8, 20) is .5 away at 20 - .4."""
    path = trim_offset(polyline((6, 0), (6, 20), (5.8, 20)), 0.5)
    assert [element.end for element in path] == [pytest.approx((5.5, 19.6), abs=1e-6)]


def test_contour_that_doubles_back_is_rejected() -> None:
    with pytest.raises(TrimError):
        trim_offset(polyline((6, 0), (6, 10), (3, 10), (6, 10), (6, 20)), 0.5)


_SHAPE = st.tuples(
    st.floats(0.5, 8.0),  # way
    st.floats(1.0, 12.0),  # depth at its end
    st.sampled_from(["line", "line", "wall", "left", "right"]),
    st.floats(0.55, 3.0),  # radius over the chord
)


def profile(steps: list[tuple[float, float, str, float]]) -> list[Element]:
    """A contour that never runs back along the way, but for the bulge of an arc."""
    at, found = (14.0, 2.0), list[Element]()
    for way, depth, kind, radius in steps:
        end = (depth, at[1]) if kind == "wall" else (depth, at[1] + way)
        if dist(at, end) < 0.05:
            continue
        if kind in {"line", "wall"}:
            found.append(Line(at, end))
        else:
            found.append(arc(at, end, radius * dist(at, end), clockwise=kind == "right"))
        at = end
    return found


def straight_back(contour: list[Element]) -> bool:
    return any(
        a.end_direction[0] * b.start_direction[0] + a.end_direction[1] * b.start_direction[1] < -0.9999
        for a, b in pairwise(contour)
    )


PROFILES = st.lists(_SHAPE, min_size=1, max_size=8).map(profile)
LEFT = st.sampled_from([0.0, 0.1, 0.5, 1.3])


def area_of(contour: list[Element], left: float) -> RoughingArea:
    assume(len(contour) > 0 and not straight_back(contour))
    try:
        return RoughingArea(contour, left)
    except TrimError:
        assume(False)
        raise


@settings(max_examples=150, deadline=None)
@given(PROFILES, LEFT)
def test_path_is_continuous_and_never_too_close(contour: list[Element], left: float) -> None:
    path = area_of(contour, left).path
    for before, after in pairwise(path):
        assert dist(before.end, after.start) < 0.0051
    for element in path:
        for point in sampled(element, 21):
            assert min(compute_distance_to_point(each, point) for each in contour) >= left - 0.002


@settings(max_examples=150, deadline=None)
@given(PROFILES, LEFT, st.floats(0.05, 14.0))
def test_spans_stay_clear_of_the_contour_and_reach_it(
    contour: list[Element], left: float, depth: float
) -> None:
    """No point of a stretch, nor above it, is too near; just past its ends there is a reason to stop."""
    area = area_of(contour, left)
    for start, end in area.find_clear_spans(depth):
        for k in range(21):
            way = start + (end - start) * k / 20
            for level in (depth, depth * 0.7, depth * 0.3):
                assert min(compute_distance_to_point(each, (level, way)) for each in contour) >= left - 0.002
    if left > 0:
        for start, end in area.find_clear_spans(depth):
            at_wall = [start] * (start > 0) + [end] * (end < area.path[-1].end[1] - 1e-6)
            for way in at_wall:
                if way == pytest.approx(area.path[0].start[1]):
                    continue
                nearest = min(
                    compute_distance_to_point(each, (depth * k / 200, way))
                    for each in contour
                    for k in range(201)
                )
                assert nearest <= left + 0.1


@settings(max_examples=100, deadline=None)
@given(PROFILES, LEFT, st.floats(0.05, 13.0), st.floats(0.01, 2.0))
def test_deeper_spans_are_within_shallower_ones(
    contour: list[Element], left: float, depth: float, more: float
) -> None:
    area = area_of(contour, left)
    shallow = area.find_clear_spans(depth)
    for start, end in area.find_clear_spans(depth + more):
        assert any(a - 1e-6 <= start and end <= b + 1e-6 for a, b in shallow)
