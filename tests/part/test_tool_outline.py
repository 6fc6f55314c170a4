"""Outlines of tools against sizes worked out by hand: where the edges are, and what stands behind them."""

from dataclasses import replace
from itertools import pairwise
from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest

from core.part.insert_codes import InsertCodeError
from core.part.tool_outline import ToolOutline, make_nose_circle, make_tool_outline
from core.part.tool_polygons import FloatArray, PartError, calculate_signed_area
from core.part.tool_shape import ROUND_TOOLS, ToolHand, ToolKind, ToolShape
from core.tool_edges import TIP_DIRECTIONS
from tests.coded import raises_code

CNMG = ToolShape(tip=3, insert="CNMG 120408", holder="MCLNR 2020K12")
EVERY = [
    ToolShape(kind, hand, tip, nose, rear=rear, stick_out=60.0)
    for kind in ToolKind
    for hand in ToolHand
    for tip in TIP_DIRECTIONS
    for nose in (0.0, 0.4)
    for rear in (False, True)
    if not (kind in ROUND_TOOLS and 0 not in TIP_DIRECTIONS[tip])
]


def box(points: FloatArray) -> tuple[float, float, float, float]:
    """Least and most z, least and most r."""
    low, high = points.min(axis=0), points.max(axis=0)
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def covers(points: FloatArray, z: float, r: float) -> bool:
    """Whether a convex counter-clockwise polygon holds a point."""
    edge, to = np.roll(points, -1, axis=0) - points, np.array([z, r]) - points
    return bool(np.all(edge[:, 0] * to[:, 1] - edge[:, 1] * to[:, 0] >= -1e-9))


def body_covers(tool: ToolOutline, z: float, r: float) -> bool:
    return any(covers(each, z, r) for each in tool.body_outlines)


def test_every_outline_is_convex_and_counter_clockwise() -> None:
    for shape in EVERY:
        tool = make_tool_outline(shape)
        for points in (*tool.cutting_outlines, *tool.body_outlines):
            edges = np.roll(points, -1, axis=0) - points
            after = np.roll(edges, -1, axis=0)
            assert np.all(edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0] > -1e-9), shape
            assert calculate_signed_area(points) > 0.0, shape


@pytest.mark.parametrize(("tip", "z", "x"), [(3, 1, 1), (4, -1, 1), (2, 1, -1), (1, -1, -1)])
def test_nose_touches_both_lines_of_the_imaginary_tip(tip: int, z: int, x: int) -> None:
    (insert,) = make_tool_outline(replace(CNMG, tip=tip)).cutting_outlines
    mirrored = insert * np.array([z, x])
    assert box(mirrored)[0] == pytest.approx(0.0, abs=1e-9)
    assert box(mirrored)[2] == pytest.approx(0.0, abs=1e-9)
    # The nose centre is at (.8, .8); every chord stays within .0005 mm of the arc.
    nose = mirrored[np.hypot(*(mirrored - 0.8).T) < 0.81]
    assert np.hypot(*(nose - 0.8).T) == pytest.approx(0.8, abs=1e-9)
    angles = np.sort(np.arctan2(*(nose - 0.8).T[::-1]) % (2 * pi))
    assert max(0.8 * (1 - cos((b - a) / 2)) for a, b in pairwise(angles)) <= 0.0005


def test_nose_center_is_control_point_without_quadrant() -> None:
    (insert,) = make_tool_outline(replace(CNMG, tip=0)).cutting_outlines
    assert box(insert)[0] == pytest.approx(-0.8, abs=1e-9)
    assert box(insert)[2] == pytest.approx(-0.8, abs=1e-9)
    (left,) = make_tool_outline(replace(CNMG, tip=0, hand=ToolHand.LEFT)).cutting_outlines
    assert box(left)[1] == pytest.approx(0.8, abs=1e-9), "a left-hand tool cuts away from the chuck"


def test_cnmg_insert_is_drawn_at_95_degrees() -> None:
    """Its main edge rises at 85°, the other one leaves the finished surface at 5°."""
    (insert,) = make_tool_outline(CNMG).cutting_outlines
    edges = np.roll(insert, -1, axis=0) - insert
    long = edges[np.hypot(*edges.T) > 8.0]
    angles = sorted(np.degrees(np.arctan2(long[:, 1], long[:, 0])) % 180)
    assert angles == pytest.approx([5, 5, 85, 85])


@pytest.mark.parametrize(
    ("insert", "hand", "tip", "edges"),
    [
        ("CNMG 120408", ToolHand.RIGHT, 3, (5, 85)),  # MCLN 95°
        ("DNMG 150608", ToolHand.RIGHT, 3, (32, 87)),  # DDJN 93°
        ("VNMG 160404", ToolHand.RIGHT, 3, (52, 87)),  # MVJN 93°
        ("VBMT 160404", ToolHand.NEUTRAL, 8, (72.5, 107.5)),  # SVVB 72.5°
        ("TNMG 160408", ToolHand.RIGHT, 3, (27, 87, 147)),  # MTJN 93°
        ("SNMG 120408", ToolHand.RIGHT, 3, (15, 105)),  # MSRN 75°
        ("SCMT 09T308", ToolHand.NEUTRAL, 8, (45, 135)),  # SSDC 45°
        ("WNMG 080408", ToolHand.RIGHT, 3, (5, 25, 125, 145, 245, 265)),  # MWLN 95°: turns of 20° and 100°
    ],
)
def test_orientation_follows_from_shape_hand_and_tip(
    insert: str, hand: ToolHand, tip: int, edges: tuple[float, ...]
) -> None:
    (points,) = make_tool_outline(ToolShape(tip=tip, hand=hand, insert=insert)).cutting_outlines
    sides = np.roll(points, -1, axis=0) - points
    long = sides[np.hypot(*sides.T) > 3.0]
    angles = sorted({round(float(a), 3) % 180 for a in np.degrees(np.arctan2(long[:, 1], long[:, 0]))})
    assert angles == pytest.approx(sorted(angle % 180 for angle in edges), abs=0.01)


def test_entering_angle_may_be_given() -> None:
    """SNMG at 45°, as SSSN holds it: the same edges as the neutral tool."""
    (given,) = make_tool_outline(ToolShape(tip=3, insert="SNMG 120408", entry=45.0)).cutting_outlines
    (coded,) = make_tool_outline(
        ToolShape(tip=3, insert="SNMG 120408", holder="MSSNR 2020K12")
    ).cutting_outlines
    assert given == pytest.approx(coded)
    assert covers(given, -2.0, 4.0), "the corner at the chuck leads"


def test_area_of_the_insert_is_the_rhombus_less_its_corners() -> None:
    """12.7² / sin 80° less what lies between tangents and arc at each corner: r² (cot(a/2) − (π − a) / 2)."""
    (insert,) = make_tool_outline(CNMG).cutting_outlines
    corners = [0.64 * (1 / tan(a / 2) - (pi - a) / 2) for a in (radians(80), radians(100))]
    assert calculate_signed_area(insert) == pytest.approx(
        12.7**2 / sin(radians(80)) - 2 * sum(corners), abs=0.05
    )


def test_holder_is_drawn_next_to_insert() -> None:
    """MCLNR 2020K12: 25 mm from the tip to the far side of a shank of 20, its head 32 long."""
    tool = make_tool_outline(CNMG)
    assert tool.assumed_fields == ()
    assert box(tool.body_outlines[1])[:2] == pytest.approx((5.0, 25.0))
    assert not body_covers(tool, 0.5, 0.5), "the insert stands out of its seat"
    assert body_covers(tool, 6.0, 6.0)
    assert body_covers(tool, 15.0, 60.0)
    assert not body_covers(tool, 30.0, 60.0)


def test_mirrored_tools_are_mirror_images() -> None:
    front, behind = make_tool_outline(CNMG), make_tool_outline(replace(CNMG, tip=2, rear=True))
    for one, other in zip(
        (*front.cutting_outlines, *front.body_outlines),
        (*behind.cutting_outlines, *behind.body_outlines),
        strict=True,
    ):
        assert box(other) == pytest.approx((*box(one)[:2], -box(one)[3], -box(one)[2]))
    assert body_covers(behind, 15.0, -60.0), "the shank of a tool behind the spindle lies at X−"


def test_unknown_insert_is_replaced_by_assumed_one() -> None:
    tool = make_tool_outline(ToolShape(tip=3, nose_radius=0.4))
    assert tool.assumed_fields == ("insert", "holder")
    assert tool.cutting_outlines[0] == pytest.approx(
        make_tool_outline(ToolShape(tip=3, insert="CNMG 120404")).cutting_outlines[0]
    )


def test_round_insert_is_a_circle_that_touches_both_lines() -> None:
    (insert,) = make_tool_outline(ToolShape(tip=3, insert="RCMT 10T3M0")).cutting_outlines
    assert box(insert) == pytest.approx((0.0, 10.0, 0.0, 10.0))
    assert np.hypot(*(insert - 5.0).T) == pytest.approx(5.0)


def test_boring_bar_extends_along_z_below_its_tip() -> None:
    """A bar of 16 has its tip 11 from its axis (ISO 5609), so it goes into 20: the far side is at −19."""
    shape = ToolShape(ToolKind.BORING, tip=2, diameter=16.0, insert="CCMT 09T304", stick_out=64.0)
    tool = make_tool_outline(shape)
    assert box(tool.cutting_outlines[0])[0] == pytest.approx(0.0, abs=1e-9)
    assert box(tool.cutting_outlines[0])[3] == pytest.approx(0.0, abs=1e-9)
    assert box(tool.body_outlines[1])[1:] == pytest.approx((64.0, -19.0, -3.0))
    assert box(tool.body_outlines[2])[0] == pytest.approx(64.0), "beyond its stick-out stands what holds it"
    coded = replace(shape, diameter=0.0, holder="S16R-SCLCR09")
    assert box(make_tool_outline(coded).body_outlines[1]) == pytest.approx(box(tool.body_outlines[1]))


def test_back_boring_bar_extends_to_the_right() -> None:
    shape = ToolShape(ToolKind.BORING, tip=1, diameter=16.0, insert="CCMT 09T304", stick_out=64.0)
    tool = make_tool_outline(shape)
    assert box(tool.cutting_outlines[0])[1] == pytest.approx(0.0, abs=1e-9)
    assert body_covers(tool, 60.0, -10.0)
    assert not body_covers(tool, -40.0, -10.0)


@pytest.mark.parametrize(("tip", "left", "right"), [(3, 0.0, 3.0), (4, -3.0, 0.0), (8, -1.5, 1.5)])
def test_corner_of_a_groove_tool_follows_from_the_quadrant(tip: int, left: float, right: float) -> None:
    tool = make_tool_outline(ToolShape(ToolKind.GROOVING, tip=tip, width=3.0, nose_radius=0.2, length=15.0))
    assert box(tool.cutting_outlines[0])[:3] == pytest.approx((left, right, 0.0))
    assert not covers(tool.cutting_outlines[0], left, 0.0), "its corners are round"
    assert covers(tool.cutting_outlines[0], left, 0.21)
    assert box(tool.body_outlines[0])[1] - box(tool.body_outlines[0])[0] == pytest.approx(2.4), (
        "the blade is thinner"
    )
    assert box(tool.body_outlines[0])[3] == pytest.approx(15.0)
    assert box(tool.body_outlines[1])[2] == pytest.approx(15.0), "behind the blade stands the shank"


def test_grooving_tool_without_quadrant_is_set_at_nose_center() -> None:
    tool = make_tool_outline(ToolShape(ToolKind.GROOVING, tip=0, width=3.0, nose_radius=0.2))
    assert box(tool.cutting_outlines[0])[:3] == pytest.approx((-0.2, 2.8, -0.2))


def test_grooving_tool_in_bore_and_in_face() -> None:
    bore = make_tool_outline(
        ToolShape(ToolKind.GROOVING, tip=2, width=2.0, diameter=12.0, length=3.0, stick_out=40.0)
    )
    assert box(bore.cutting_outlines[0]) == pytest.approx((0.0, 2.0, -3.0, 0.0))
    assert body_covers(bore, 30.0, -9.0)
    face = make_tool_outline(ToolShape(ToolKind.GROOVING, tip=7, width=3.0, length=12.0))
    assert box(face.cutting_outlines[0]) == pytest.approx((0.0, 4.5, -1.5, 1.5))
    assert body_covers(face, 10.0, 0.0)


def test_parting_blade_has_length_of_its_stick_out() -> None:
    tool = make_tool_outline(ToolShape(ToolKind.PARTING, tip=3, width=2.0, stick_out=20.0))
    assert box(tool.body_outlines[0]) == pytest.approx((0.2, 1.8, 3.0, 20.0))
    assert body_covers(tool, 10.0, 30.0), "its block"
    assert not body_covers(tool, 10.0, 15.0)


def test_thread_tool_is_a_v_with_a_flat_of_an_eighth_of_the_pitch() -> None:
    (edge,) = make_tool_outline(ToolShape(ToolKind.THREADING, tip=8, pitch=2.0, length=2.0)).cutting_outlines
    assert np.sort(edge[edge[:, 1] == 0.0][:, 0]) == pytest.approx([-0.125, 0.125])
    assert box(edge)[1] == pytest.approx(0.125 + 2.0 * tan(radians(30)))
    (left,) = make_tool_outline(ToolShape(ToolKind.THREADING, tip=3, pitch=2.0, length=2.0)).cutting_outlines
    assert np.sort(left[left[:, 1] == 0.0][:, 0]) == pytest.approx([0.0, 0.25])


def test_threading_tool_with_nose_radius_is_shorter_than_sharp_v() -> None:
    """55°: the sharp point lies r (1 / sin 27.5° − 1) below the nose."""
    (edge,) = make_tool_outline(
        ToolShape(ToolKind.THREADING, tip=8, point=55.0, nose_radius=0.2, length=3.0)
    ).cutting_outlines
    below = 0.2 * (1 / sin(radians(27.5)) - 1)
    assert box(edge)[2] == pytest.approx(0.0, abs=1e-9)
    assert box(edge)[3] == pytest.approx(3.0 - below)
    assert box(edge)[1] == pytest.approx(3.0 * tan(radians(27.5)))


def test_drill_has_its_point_on_the_axis() -> None:
    """1/4 in, 118°: the cone is 3.175 / tan 59° = 1.9077 long."""
    tool = make_tool_outline(
        ToolShape(ToolKind.DRILL, diameter=6.35, point=118.0, length=50.0, stick_out=70.0)
    )
    assert tool.is_axially_symmetric
    assert tool.assumed_fields == ()
    assert box(tool.cutting_outlines[0]) == pytest.approx((0.0, 50.0, -3.175, 3.175))
    assert covers(tool.cutting_outlines[0], 3.175 / tan(radians(59)), 3.175)
    assert not covers(tool.cutting_outlines[0], 1.9, 3.175)
    assert box(tool.body_outlines[0]) == pytest.approx((50.0, 70.0, -3.175, 3.175))
    assert box(tool.body_outlines[1])[0] == pytest.approx(70.0)


def test_center_drill_is_pilot_and_cone() -> None:
    """DIN 333 A of 10 mm: pilot 4; the cone of 60° opens 3 mm on a side in 3 / tan 30° = 5.196."""
    pilot, cone = make_tool_outline(ToolShape(ToolKind.CENTER_DRILL, diameter=10.0)).cutting_outlines
    assert box(pilot) == pytest.approx((0.0, 4.8, -2.0, 2.0))
    assert box(cone) == pytest.approx((4.8, 4.8 + 3.0 * sqrt(3.0) + 0.5, -5.0, 5.0))


def test_end_mill_is_along_or_across_spindle() -> None:
    along = make_tool_outline(ToolShape(ToolKind.END_MILL, diameter=6.0, length=20.0))
    assert along.is_axially_symmetric
    assert box(along.cutting_outlines[0]) == pytest.approx((0.0, 20.0, -3.0, 3.0))
    across = make_tool_outline(ToolShape(ToolKind.END_MILL, tip=8, diameter=6.0, length=20.0))
    assert not across.is_axially_symmetric
    assert box(across.cutting_outlines[0]) == pytest.approx((-3.0, 3.0, 0.0, 20.0))
    behind = make_tool_outline(ToolShape(ToolKind.END_MILL, tip=6, diameter=6.0, length=20.0))
    assert box(behind.cutting_outlines[0]) == pytest.approx((-3.0, 3.0, -20.0, 0.0))
    (ball,) = make_tool_outline(
        ToolShape(ToolKind.END_MILL, tip=8, diameter=6.0, length=20.0, nose_radius=3.0)
    ).cutting_outlines
    assert np.hypot(ball[:, 0], ball[:, 1] - 3.0)[ball[:, 1] < 3.0] == pytest.approx(3.0)


def test_tap_and_reamer_have_full_diameter_after_chamfer() -> None:
    tap = make_tool_outline(ToolShape(ToolKind.TAP, diameter=6.0, pitch=1.0, length=18.0)).cutting_outlines[0]
    assert covers(tap, 3.0, 3.0)
    assert not covers(tap, 1.0, 3.0)
    reamer = make_tool_outline(ToolShape(ToolKind.REAMER, diameter=6.0, length=18.0)).cutting_outlines[0]
    assert covers(reamer, 0.5, 3.0)
    assert not covers(reamer, 0.0, 3.0)


def test_form_tool_is_its_profile_in_convex_pieces() -> None:
    profile = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0))
    tool = make_tool_outline(ToolShape(ToolKind.FORM, profile=profile))
    assert sum(calculate_signed_area(piece) for piece in tool.cutting_outlines) == pytest.approx(16.0 - 6.0)
    assert not any(covers(piece, 2.0, 2.0) for piece in tool.cutting_outlines)
    assert make_tool_outline(ToolShape(ToolKind.FORM, profile=profile[::-1])).assumed_fields == ()
    assert make_tool_outline(ToolShape(ToolKind.FORM, nose_radius=1.0)).assumed_fields == ("profile",)


def test_holder_may_be_an_outline() -> None:
    tool = make_tool_outline(replace(CNMG, holder="2,14 18,14 18,60 2,60"))
    assert len(tool.body_outlines) == 1
    assert box(tool.body_outlines[0]) == pytest.approx((2.0, 18.0, 14.0, 60.0))


def test_tool_without_shape_is_drawn_as_nose_circle() -> None:
    tool = make_nose_circle(0.8, 3)
    assert box(tool.cutting_outlines[0]) == pytest.approx((0.0, 1.6, 0.0, 1.6))
    assert tool.body_outlines == ()
    assert tool.assumed_fields == ("kind",)
    assert box(make_nose_circle(0.4, 0).cutting_outlines[0]) == pytest.approx((-0.4, 0.4, -0.4, 0.4))


def test_assumed_dimensions_are_listed() -> None:
    assert make_tool_outline(ToolShape(ToolKind.DRILL)).assumed_fields == ("diameter", "length", "point")
    assert make_tool_outline(ToolShape(ToolKind.GROOVING, tip=3)).assumed_fields == ("width", "length")
    assert make_tool_outline(ToolShape(ToolKind.BORING, tip=2)).assumed_fields == (
        "insert",
        "diameter",
        "stick_out",
    )


def test_invalid_insert_code_is_rejected() -> None:
    with raises_code(InsertCodeError, "unknown-character", "character 3 (X)"):
        make_tool_outline(ToolShape(tip=3, insert="CNXG 120408"))


def test_self_intersecting_outline_is_rejected() -> None:
    with raises_code(PartError, "crosses-itself"):
        make_tool_outline(ToolShape(ToolKind.FORM, profile=((0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 5.0))))


@pytest.mark.parametrize(
    ("insert", "edges"),
    [
        ("CCMT 09T304", (-5, -85)),  # SCLC 95°
        ("TCMT 110204", (-29, -89, -149)),  # STFC 91°
        ("DCMT 070204", (-32, -87)),  # SDUC 93°
    ],
)
def test_boring_inserts_are_oriented_as_in_their_bars(insert: str, edges: tuple[float, ...]) -> None:
    (points,) = make_tool_outline(
        ToolShape(ToolKind.BORING, tip=2, insert=insert, diameter=16.0)
    ).cutting_outlines
    sides = np.roll(points, -1, axis=0) - points
    long = sides[np.hypot(*sides.T) > 3.0]
    angles = sorted({round(float(a), 3) % 180 for a in np.degrees(np.arctan2(long[:, 1], long[:, 0]))})
    assert angles == pytest.approx(sorted(angle % 180 for angle in edges), abs=0.01)
