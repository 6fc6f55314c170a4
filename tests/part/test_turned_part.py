"""Metal taken off a turned part: volumes against closed formulas, and what a move meets."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from core.part.cutter import CutSide, Cutter
from core.part.stock import Stock, make_bar_stock, make_tube_stock
from core.part.turned_part import TurnedPart

KNIFE = np.array(
    [[0.0, 0.0], [12.0, 4.0], [12.0, 12.0], [0.0, 12.0]]
)  # a sharp corner, upright towards the chuck
BORER = np.array(
    [[0.0, 0.0], [0.0, -6.0], [30.0, -6.0], [30.0, -1.0]]
)  # the same in a bore, its edge outwards
BLADE = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 30.0], [0.0, 30.0]])  # 3 mm, set on its left edge
DRILL = np.array(
    [[0.0, 0.0], [5.0, 5.0], [60.0, 5.0], [60.0, -5.0], [5.0, -5.0]]
)  # 10 mm, point of 90 degrees
BUTTON = np.array([[4.0 * math.cos(a), 4.0 * math.sin(a)] for a in np.linspace(0.0, math.tau, 721)[:-1]])


def outside(shape: np.ndarray = KNIFE) -> Cutter:
    return Cutter([shape], [], CutSide.OUTSIDE)


def in_bore(shape: np.ndarray = BORER) -> Cutter:
    return Cutter([shape], [], CutSide.BORE)


def ring(outer: float, inner: float, length: float) -> float:
    return math.pi * (outer**2 - inner**2) * length


def test_a_bar_and_a_tube_have_their_volume() -> None:
    assert TurnedPart(make_bar_stock(30.0, 1.0, -80.0)).volume_mm3 == pytest.approx(
        ring(15.0, 0.0, 81.0), rel=1e-6
    )
    assert TurnedPart(make_tube_stock(30.0, 12.0, 0.0, -50.0)).volume_mm3 == pytest.approx(
        ring(15.0, 6.0, 50.0), rel=1e-6
    )


def test_cone_stock_has_expected_volume() -> None:
    cone = TurnedPart(Stock("", ((-40.0, 20.0), (0.0, 5.0))))
    assert cone.volume_mm3 == pytest.approx(math.pi * 40.0 / 3.0 * (400.0 + 100.0 + 25.0), rel=1e-6)


@pytest.mark.parametrize("step", [0.008, 0.01])
def test_a_cylinder_is_turned(step: float) -> None:
    part = TurnedPart(make_bar_stock(30.0, 0.0, -60.0), step)
    before = part.volume_mm3
    met = outside().cut_material(part, (2.0, 12.0), (-25.0, 12.0))
    assert met.volume_mm3 == pytest.approx(ring(15.0, 12.0, 25.0), rel=1e-3)
    assert before - part.volume_mm3 == pytest.approx(met.volume_mm3, rel=1e-9)
    assert met.depth_mm == pytest.approx(3.0)
    assert met.back_z_mm == pytest.approx(-25.0, abs=step)
    assert met.front_z_mm == pytest.approx(0.0, abs=step)


def test_a_taper_is_turned() -> None:
    part = TurnedPart(make_bar_stock(40.0, 0.0, -60.0))
    met = outside().cut_material(part, (0.0, 10.0), (-20.0, 20.0))  # from r 10 at the face to r 20
    cone = math.pi * 20.0 / 3.0 * (100.0 + 200.0 + 400.0)
    assert met.volume_mm3 == pytest.approx(ring(20.0, 0.0, 20.0) - cone, rel=1e-3)


def test_face_is_cut_past_center() -> None:
    part = TurnedPart(make_bar_stock(20.0, 1.0, -30.0))
    met = outside().cut_material(part, (0.0, 12.0), (0.0, -0.4))
    assert met.volume_mm3 == pytest.approx(ring(10.0, 0.0, 1.0), rel=1e-3)
    assert part.volume_mm3 == pytest.approx(ring(10.0, 0.0, 30.0), rel=1e-3)
    assert part.parted_pieces == []


def test_groove_leaves_material_on_both_sides() -> None:
    part = TurnedPart(make_bar_stock(20.0, 0.0, -30.0))
    met = outside(BLADE).cut_material(part, (-12.0, 11.0), (-12.0, 7.0))
    assert met.volume_mm3 == pytest.approx(ring(10.0, 7.0, 3.0), rel=1e-3)
    assert (met.back_z_mm, met.front_z_mm) == (pytest.approx(-12.0, abs=0.01), pytest.approx(-9.0, abs=0.01))


def test_round_nose_leaves_its_cross_section() -> None:
    part = TurnedPart(make_bar_stock(60.0, 0.0, -60.0))
    met = outside(BUTTON).cut_material(
        part, (-30.0, 40.0), (-30.0, 30.0)
    )  # plunged by its radius: a half circle
    # a half disc of radius 4 whose diameter lies on r 30, turned about the axis (Pappus)
    area, centroid = math.pi * 16.0 / 2.0, 30.0 - 4.0 * 4.0 / (3.0 * math.pi)
    assert met.area == pytest.approx(area, rel=1e-3)
    assert met.volume_mm3 == pytest.approx(math.tau * centroid * area, rel=1e-3)


def test_a_sphere_is_turned_by_chords_of_its_arc() -> None:
    part = TurnedPart(make_bar_stock(20.0, 0.0, -20.0))
    before = part.volume_mm3
    point = np.array([[0.0, 0.0], [0.001, 30.0], [-0.001, 30.0]])
    tool = Cutter([point], [], CutSide.OUTSIDE)
    angles = np.linspace(0.0, math.pi / 2.0, 361)
    ways = [(10.0 * math.cos(a) - 10.0, 10.0 * math.sin(a)) for a in angles]
    for start, end in pairwise(ways):
        tool.cut_material(part, start, end)
    half_ball = 2.0 / 3.0 * math.pi * 1000.0
    assert before - part.volume_mm3 == pytest.approx(ring(10.0, 0.0, 10.0) - half_ball, rel=1e-3)


def test_a_drill_leaves_its_cone() -> None:
    part = TurnedPart(make_bar_stock(30.0, 0.0, -40.0))
    met = in_bore(DRILL).cut_material(part, (2.0, 0.0), (-20.0, 0.0))
    assert met.volume_mm3 == pytest.approx(ring(5.0, 0.0, 15.0) + math.pi * 125.0 / 3.0, rel=1e-3)
    assert in_bore(DRILL).cut_material(part, (2.0, 0.0), (-20.0, 0.0)).volume_mm3 == 0.0


def test_bored_wall_is_in_bore_profile() -> None:
    part = TurnedPart(make_tube_stock(30.0, 16.0, 0.0, -40.0))
    met = in_bore().cut_material(part, (2.0, 11.0), (-25.0, 11.0))
    assert met.volume_mm3 == pytest.approx(ring(11.0, 8.0, 25.0), rel=1e-3)
    rest = part.make_remaining_piece()
    assert rest.min_wall_mm == pytest.approx(4.0)
    assert rest.bore_profile is not None
    assert rest.bore_profile[0] == pytest.approx((0.0, 11.0), abs=0.01)
    assert rest.bore_profile[-1] == pytest.approx((-40.0, 8.0), abs=0.01)


def test_a_face_groove_leaves_a_core_and_a_ring() -> None:
    part = TurnedPart(make_bar_stock(40.0, 0.0, -30.0))
    tool = Cutter([np.array([[0.0, 0.0], [0.0, 4.0], [20.0, 4.0], [20.0, 0.0]])], [], CutSide.FACE)
    met = tool.cut_material(part, (1.0, 8.0), (-5.0, 8.0))  # between r 8 and r 12, 5 deep
    assert met.volume_mm3 == pytest.approx(ring(12.0, 8.0, 5.0), rel=1e-3)
    assert part.volume_mm3 == pytest.approx(ring(20.0, 0.0, 30.0) - ring(12.0, 8.0, 5.0), rel=1e-3)
    deeper = tool.cut_material(part, (1.0, 8.0), (-7.0, 8.0))
    assert deeper.volume_mm3 == pytest.approx(ring(12.0, 8.0, 2.0), rel=1e-3)
    wider = tool.cut_material(part, (1.0, 10.0), (-7.0, 10.0))
    assert wider.volume_mm3 == pytest.approx(ring(14.0, 12.0, 7.0), rel=1e-3)


def test_parting_off_separates_front_piece() -> None:
    part = TurnedPart(make_bar_stock(20.0, 0.0, -40.0))
    before = part.volume_mm3
    outside(BLADE).cut_material(part, (-18.0, 12.0), (-18.0, -0.2))
    assert [piece.volume_mm3 for piece in part.parted_pieces] == [
        pytest.approx(ring(10.0, 0.0, 15.0), rel=1e-3)
    ]
    assert part.removed_volume_mm3 == pytest.approx(ring(10.0, 0.0, 3.0), rel=2e-3)
    assert part.volume_mm3 == pytest.approx(before - ring(10.0, 0.0, 18.0), rel=1e-3)
    assert part.parted_pieces[0].outside_profile == [
        (pytest.approx(0.0, abs=0.01), 10.0),
        (pytest.approx(-15.0, abs=0.01), 10.0),
    ]


def test_a_tube_is_parted_where_the_blade_reaches_its_bore() -> None:
    part = TurnedPart(make_tube_stock(20.0, 12.0, 0.0, -40.0))
    outside(BLADE).cut_material(part, (-18.0, 12.0), (-18.0, 6.1))
    assert part.parted_pieces == []
    outside(BLADE).cut_material(part, (-18.0, 12.0), (-18.0, 5.9))
    assert [piece.volume_mm3 for piece in part.parted_pieces] == [
        pytest.approx(ring(10.0, 6.0, 15.0), rel=1e-3)
    ]


def test_a_thread_has_its_form_and_its_volume() -> None:
    part = TurnedPart(make_bar_stock(20.0, 0.0, -40.0))
    depth, lead = 1.0, 2.0
    half = depth * math.tan(math.radians(30.0))
    form = np.array([[0.0, 0.0], [3.0 * half, 3.0], [-3.0 * half, 3.0]])
    tool = Cutter([form], [], CutSide.OUTSIDE)
    met = tool.cut_thread(part, (4.0, 9.0), (-20.0, 9.0), lead, 0.0)
    # each turn of the groove: a triangle of this depth, its centroid a third from the outside (Pappus)
    each = math.tau * (10.0 - depth / 3.0) * half * depth
    assert met.volume_mm3 == pytest.approx(10.5 * each, rel=2e-3)  # at z 0 half of one: 0, -2 … -20
    assert part.max_radii.min() == pytest.approx(9.0, abs=0.02)


def test_rear_tool_cuts_same_as_front_tool() -> None:
    front, rear = TurnedPart(make_bar_stock(30.0, 0.0, -60.0)), TurnedPart(make_bar_stock(30.0, 0.0, -60.0))
    outside().cut_material(front, (2.0, 12.0), (-25.0, 12.0))
    Cutter([KNIFE * np.array([1.0, -1.0])], [], CutSide.OUTSIDE, is_rear=True).cut_material(
        rear, (2.0, -12.0), (-25.0, -12.0)
    )
    assert rear.volume_mm3 == front.volume_mm3


def test_collision_query_and_cut_in_air_do_not_change_part() -> None:
    part = TurnedPart(make_bar_stock(30.0, 0.0, -60.0))
    before = part.volume_mm3
    assert outside().find_cut(part, (-5.0, 20.0), (-5.0, 10.0)).depth_mm == pytest.approx(5.0, abs=0.01)
    assert part.volume_mm3 == before
    assert not outside().find_cut(part, (1.0, 20.0), (1.0, 0.0))
    assert not outside().cut_material(part, (5.0, 15.0), (-60.0, 15.0))  # along the bar, touching it


def test_shank_collides_with_shoulder() -> None:
    part = TurnedPart(make_bar_stock(40.0, 0.0, -60.0))
    shank = np.array(
        [[-2.0, 3.0], [-2.0, 40.0], [10.0, 40.0], [10.0, 3.0]]
    )  # 2 mm before the edge, 3 above it
    tool = Cutter([BLADE], [shank], CutSide.OUTSIDE)
    start, end = (-20.0, 22.0), (-20.0, 18.0)
    tool.cut_material(part, start, end)
    assert not tool.cut_with_body(part, start, end)
    start, end = end, (-20.0, 15.0)  # the shank is at r 18
    tool.cut_material(part, start, end)
    struck = tool.cut_with_body(part, start, end)
    assert struck.depth_mm == pytest.approx(2.0)
    assert not tool.cut_with_body(part, start, end)  # told once


def test_boring_bar_too_thick_for_bore_collides_with_opposite_wall() -> None:
    part = TurnedPart(make_tube_stock(40.0, 10.0, 0.0, -30.0))
    thick = np.array([[0.5, -0.5], [0.5, -11.0], [40.0, -11.0], [40.0, -0.5]])
    thin = np.array([[0.5, -0.5], [0.5, -8.0], [40.0, -8.0], [40.0, -0.5]])
    at = (2.0, 5.0), (-10.0, 5.0)
    assert not Cutter([BORER], [thin], CutSide.BORE).cut_with_body(part, *at)
    assert Cutter([BORER], [thick], CutSide.BORE).cut_with_body(part, *at).depth_mm == pytest.approx(1.0)


def test_profile_starts_at_face_and_has_vertical_shoulders() -> None:
    part = TurnedPart(make_bar_stock(30.0, 0.0, -50.0))
    outside().cut_material(part, (1.0, 10.0), (-20.0, 10.0))
    corners = [(0.0, 10.0), (-20.0, 10.0), (-20.0, 15.0), (-50.0, 15.0)]
    told = part.make_remaining_piece().outside_profile
    assert [z for z, _ in told] == [pytest.approx(z, abs=0.01) for z, _ in corners]
    assert [r for _, r in told] == [pytest.approx(r) for _, r in corners]


def test_cut_outside_stock_or_in_removed_area_removes_nothing() -> None:
    part = TurnedPart(make_bar_stock(20.0, 0.0, -30.0))
    assert not outside().cut_material(part, (-50.0, 20.0), (-50.0, 5.0))  # behind the stock
    assert not outside().cut_material(part, (5.0, 20.0), (5.0, -5.0))  # before its face
    assert not in_bore().cut_material(part, (20.0, 5.0), (1.0, 5.0))
    outside(BLADE).cut_material(part, (-3.0, 12.0), (-3.0, -1.0))
    assert not outside(BLADE).cut_material(part, (-3.0, 12.0), (-3.0, -1.0))
