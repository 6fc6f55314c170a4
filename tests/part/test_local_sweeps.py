"""Cuts that sweep only the columns with enough material give what a sweep of the whole edge gives."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.part.cutter import CutSide, Cutter
from core.part.stock import Stock, make_bar_stock, make_tube_stock
from core.part.swept_edge import ColumnGrid, FloatArray, Point, find_axis_facing_edge, sweep_edge
from core.part.tool_outline import make_tool_outline
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import NO_CUT, Cut, TurnedPart

KNIFE = np.array([[0.0, 0.0], [12.0, 4.0], [12.0, 12.0], [0.0, 12.0]])
BUTTON = np.array([[4.0 * math.cos(a), 4.0 * math.sin(a)] for a in np.linspace(0.0, math.tau, 91)[:-1]])
INSERT = make_tool_outline(ToolShape(ToolKind.TURNING, tip=3, insert="CNMG120408")).cutting_outlines[0]
BLADE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 30.0], [0.0, 30.0]])
RING = np.array([[0.0, 6.0], [1.5, 6.0], [1.5, 8.0], [0.0, 8.0]])
STOCKS = [
    make_bar_stock(30.0, 0.0, -40.0),
    make_tube_stock(28.0, 9.0, 0.0, -40.0),
    Stock("", ((-40.0, 16.0), (0.0, 4.0))),
]
SAME_MM = 1e-9  # mm, mm² and mm³ by which the measures of two sums may differ

places = st.tuples(
    st.floats(-45.0, 8.0).map(lambda z: round(z, 3)), st.floats(-1.0, 18.0).map(lambda r: round(r, 3))
)
moves = st.lists(st.tuples(st.sampled_from([KNIFE, BUTTON, INSERT]), places, places), min_size=1, max_size=8)


def make_part(stock: Stock, *, has_groove: bool) -> TurnedPart:
    """Make a part, with a face groove of radius 6 to 8 mm in it if required."""
    part = TurnedPart(stock, 0.05)
    if has_groove:
        Cutter([RING], (), CutSide.FACE).cut_material(part, (5.0, 0.0), (-6.0, 0.0))
    return part


def cut_whole_edge(part: TurnedPart, outline: FloatArray, start: Point, end: Point) -> Cut:
    """Cut with a sweep of all columns under the edge."""
    return part.cut_outside(*sweep_edge(find_axis_facing_edge(outline), start, end, part.columns))


def assert_same(cut: Cut, other: Cut) -> None:
    assert bool(cut) == bool(other)
    assert cut[:-1] == pytest.approx(other[:-1], rel=SAME_MM, abs=SAME_MM)
    assert cut.is_parted_off == other.is_parted_off


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(STOCKS), st.booleans(), moves)
def test_cuts_equal_those_of_the_whole_edge(
    stock: Stock, has_groove: bool, steps: list[tuple[FloatArray, Point, Point]]
) -> None:
    part, other = (make_part(stock, has_groove=has_groove) for _ in range(2))
    for outline, start, end in steps:
        cutter = Cutter([outline], (), CutSide.OUTSIDE)
        found, touched = cutter.find_cut(part, start, end), cutter.touches_material(part, start, end)
        cut = cutter.cut_material(part, start, end)
        assert_same(cut, cut_whole_edge(other, outline, start, end))
        assert_same(found, cut)
        assert touched == bool(cut)
        np.testing.assert_allclose(part.outer_radii, other.outer_radii, rtol=0.0, atol=SAME_MM)
        np.testing.assert_allclose(part.inner_radii, other.inner_radii, rtol=0.0, atol=SAME_MM)


@settings(max_examples=150, deadline=None)
@given(
    st.sampled_from(STOCKS),
    st.booleans(),
    st.sampled_from([KNIFE, BUTTON, INSERT]),
    places,
    st.floats(-1.0, 1.0),
)
def test_touch_along_the_radius_equals_a_cut(
    stock: Stock, has_groove: bool, outline: FloatArray, place: Point, step: float
) -> None:
    part, cutter = make_part(stock, has_groove=has_groove), Cutter([outline], (), CutSide.OUTSIDE)
    end = place[0], place[1] + step
    assert cutter.touches_material(part, place, end) == bool(cut_whole_edge(part, outline, place, end))


@pytest.mark.parametrize(
    ("place", "touches"),
    [
        ((-10.0, 14.99), True),  # a column of 0.008 mm lifts the edge by at most 0.003 mm
        ((-10.0, 15.0), False),  # on the surface
        ((-10.0, 14.9999995), False),  # half of the thickness that counts as material
        ((0.2, 10.0), False),  # in front of the face
        ((-51.9, 10.0), True),  # only with the far end of the edge, which is 12 mm long
        ((-52.1, 10.0), False),  # beyond the end of the bar
    ],
)
def test_knife_touches_a_bar_of_radius_15(place: Point, touches: bool) -> None:
    part = TurnedPart(STOCKS[0])
    assert Cutter([KNIFE], (), CutSide.OUTSIDE).touches_material(part, place, place) is touches
    assert part.removed_volume_mm3 == 0.0


@pytest.mark.parametrize(("depth_mm", "touches"), [(0.005, True), (2e-6, True), (5e-7, False), (0.0, False)])
def test_flat_blade_touches_at_more_than_a_millionth_of_a_millimeter(depth_mm: float, touches: bool) -> None:
    """A blade is parallel to the surface, so its depth is the thickness in every column."""
    part, blade = TurnedPart(STOCKS[0]), Cutter([BLADE], (), CutSide.OUTSIDE)
    place = -10.0, 15.0 - depth_mm
    assert blade.touches_material(part, place, place) is touches
    assert bool(blade.find_cut(part, place, (-11.0, place[1]))) is touches
    assert blade.cut_material(part, place, place).depth_mm == pytest.approx(depth_mm * touches, abs=1e-9)


def test_nose_in_a_groove_does_not_touch() -> None:
    """A blade of 1 mm in a groove of 4 mm; in the wall, it touches."""
    part, cutter = TurnedPart(STOCKS[0]), Cutter([BLADE], (), CutSide.OUTSIDE)
    for z in (-20.0, -19.0, -18.0, -17.0):
        cutter.cut_material(part, (z, 20.0), (z, 10.0))
    assert not cutter.touches_material(part, (-18.5, 12.0), (-18.5, 10.0))
    assert cutter.touches_material(part, (-18.5, 12.0), (-18.5, 9.9))
    assert cutter.touches_material(part, (-16.5, 12.0), (-16.5, 12.0))


def test_total_with_a_cut_of_nothing_is_the_other_cut() -> None:
    cut = Cut(1.0, 2.0, 0.5, 3.0, -3.0, 0.0)
    assert cut.combine_with_later(NO_CUT) == cut
    assert NO_CUT.combine_with_later(cut) == cut
    assert cut.combine_with_later(cut._replace(depth_mm=0.75)).depth_mm == 0.75


def test_column_centers_cannot_be_changed() -> None:
    """Parts share the array, so a change would move the columns of other parts."""
    centers = ColumnGrid(0.5, 1.0, 3).column_centers
    assert centers.tolist() == [0.5, 1.5, 2.5]
    with pytest.raises(ValueError, match="read-only"):
        centers[0] = 0.0
