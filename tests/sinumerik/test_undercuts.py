"""CYCLE94 and CYCLE96: the part's profile is that of the standards, whatever the nose; by closed formulas."""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians, sin, tan

import pytest

from core.geometry.lines_and_arcs import Point, compute_distance_to_point
from core.interpreter.shared.contour_stage import make_element
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.tool_edges import TIP_DIRECTIONS
from tests.sinumerik.lathe import good, refused, run, setup

OUTSIDE = "S900 M3 G95 F0.1\nT1 D1\nG0 X100 Z50\n"
INSIDE = "S900 M3 G95 F0.1\nT1 D1\nG0 X6 Z50\n"
SLOPE_15, SLOPE_30 = tan(radians(15.0)), tan(radians(30.0))


def with_tool(quadrant: int, nose: float = 0.0) -> InterpreterSetup:
    return replace(setup(), tools={1: ToolOffset(quadrant=quadrant, nose_radius=nose)})


def cuts(text: str, around: InterpreterSetup) -> list[Block]:
    """What the cycle cuts, behind the three lines before it and its way to the first point."""
    return [b for b in good(text, around) if b.line > 3 and b.kind is not BlockKind.RAPID][1:]


@pytest.mark.parametrize(
    ("diameter", "depth", "width", "radius"),
    [(8, 0.2, 2.0, 0.4), (15, 0.2, 2.0, 0.6), (40, 0.3, 2.5, 0.6), (80, 0.3, 2.5, 0.6), (100, 0.4, 4.0, 1.0)],
)
def test_form_e_undercut_size_follows_from_diameter(
    diameter: float, depth: float, width: float, radius: float
) -> None:
    """The slope meets the surface ``width`` before the shoulder; the bottom lies ``depth`` below it."""
    blocks = cuts(OUTSIDE + f'CYCLE94({diameter},-30,"E")', with_tool(3))
    r = diameter / 2
    slope, first, bottom, second, shoulder = blocks
    assert [b.kind for b in blocks] == [
        BlockKind.FEED,
        BlockKind.ARC,
        BlockKind.FEED,
        BlockKind.ARC,
        BlockKind.FEED,
    ]
    assert (slope.x0, slope.z0) == pytest.approx((r + 1, -30 + width + 1 / SLOPE_15))
    share = (slope.x0 - r) / (slope.x0 - slope.x)
    assert slope.z0 + share * (slope.z - slope.z0) == pytest.approx(-30 + width)
    back = radius * tan(radians(7.5))  # what a turn of 15 degrees takes of both lines
    assert (first.x, first.z) == pytest.approx((r - depth, -30 + width - depth / SLOPE_15 - back))
    assert (bottom.x, bottom.z) == pytest.approx((r - depth, -30 + radius))
    assert (second.x, second.z, second.cx, second.cz) == pytest.approx(
        (r - depth + radius, -30, r - depth + radius, -30 + radius)
    )
    assert (shoulder.x, shoulder.z) == pytest.approx((r + 1, -30))


def test_form_f_undercut_extends_into_the_face() -> None:
    """The fillet is deepest in the face by 0.2 and ends 8 degrees further on; from there 8 degrees out."""
    blocks = cuts(OUTSIDE + 'CYCLE94(40,-30,"F")', with_tool(3))
    fillet, face = blocks[3:]
    assert fillet.cz - 0.6 == pytest.approx(-30.2)
    a = radians(8.0)
    assert (fillet.x, fillet.z) == pytest.approx((20.3 + 0.6 * sin(a), -29.6 - 0.6 * cos(a)))
    assert face.z == pytest.approx(-30.0)
    assert (face.z - fillet.z) / (face.x - fillet.x) == pytest.approx(tan(a))


@pytest.mark.parametrize("nose", [0.0, 0.2, 0.4, 0.6])
@pytest.mark.parametrize("form", ["E", "F"])
def test_undercut_profile_does_not_depend_on_nose_radius(nose: float, form: str) -> None:
    around = with_tool(3, nose)
    blocks = cuts(OUTSIDE + f'CYCLE94(40,-30,"{form}")', around)
    foot = 20.0, -27.5
    bottom = 19.7, -29.0
    deepest = (20.3, -30.0) if form == "E" else (20.3, -30.2)
    for point in (foot, bottom, deepest):
        assert _nearest_nose(blocks, around, point) == pytest.approx(0.0, abs=2e-3)


def _nearest_nose(blocks: list[Block], around: InterpreterSetup, point: Point) -> float:
    """How near the nose comes to a point of the profile: the centre is the tip moved by the nose radius."""
    edge = around.tools[1]
    z, x = TIP_DIRECTIONS[edge.quadrant]
    tip = point[0] + x * edge.nose_radius, point[1] + z * edge.nose_radius
    return min(compute_distance_to_point(make_element(b), tip) for b in blocks) - edge.nose_radius


@pytest.mark.parametrize(("form", "width"), [("A", 5.2), ("B", 3.8)])
def test_outside_thread_undercut_has_standard_dimensions(form: str, width: float) -> None:
    """M10 has a lead of 1.5: 2.3 off its diameter, radius 0.8, 30 degrees."""
    slope, _, bottom, fillet, _ = cuts(OUTSIDE + f'CYCLE96(10,-20,"{form}")', with_tool(3))
    assert (slope.x0, slope.z0) == pytest.approx((6.0, -20 + width + 1 / SLOPE_30))
    assert (bottom.x, bottom.z) == pytest.approx((5.0 - 1.15, -19.2))
    assert fillet.cx == pytest.approx(5.0 - 1.15 + 0.8)


def test_inside_thread_undercut_has_standard_dimensions() -> None:
    """M20 x 2.5 inside: to 20.5, from its core of 20 - 1.0825 x 2.5, 13 wide, with an edge for inside."""
    slope, _, bottom, _, shoulder = cuts(INSIDE + 'CYCLE96(20,-30,"C")', with_tool(2))
    core = (20 - 1.0825 * 2.5) / 2
    assert (slope.x0, slope.z0) == pytest.approx((core - 1, -17 + 1 / SLOPE_30))
    assert bottom.x == pytest.approx(10.25)
    assert (shoulder.x, shoulder.z) == pytest.approx((core - 1, -30))


@pytest.mark.parametrize(("quadrant", "out", "side"), [(1, -1, -1), (2, -1, 1), (3, 1, 1), (4, 1, -1)])
def test_tip_quadrant_sets_position_of_undercut(quadrant: int, out: int, side: int) -> None:
    before = OUTSIDE if out > 0 else INSIDE
    blocks = cuts(before + 'CYCLE94(40,-30,"E")', with_tool(quadrant))
    assert blocks[2].x == pytest.approx(20 - out * 0.3)
    assert blocks[2].z == pytest.approx(-30 + side * 0.6)


def test_vari_sets_position_of_undercut() -> None:
    blocks = cuts(INSIDE + 'CYCLE94(40,-30,"E",2)', with_tool(3))
    assert blocks[2].x == pytest.approx(20.3)


def test_tool_approaches_and_retracts_clear_of_the_part() -> None:
    """First out to 2 mm beside the surface, then along; never along the shoulder in rapid."""
    text = "S900 M3 G95 F0.1\nT1 D1\nG0 X42 Z-40\n" + 'CYCLE94(40,-30,"E")'
    ways = [(b.x, b.z) for b in good(text, with_tool(3)) if b.line > 3 and b.kind is BlockKind.RAPID]
    begin = -30 + 2.5 + 1 / SLOPE_15
    assert ways == [pytest.approx(each) for each in [(22, -40), (22, begin), (22, -29), (22, begin)]]


@pytest.mark.parametrize(
    ("call", "tool", "code"),
    [
        ('CYCLE94(3,-30,"E")', ToolOffset(quadrant=3), "61601"),
        ("CYCLE94(40,-30)", ToolOffset(quadrant=3), "61609"),
        ('CYCLE94(40,-30,"G")', ToolOffset(quadrant=3), "61609"),
        ('CYCLE94(40,,"E")', ToolOffset(quadrant=3), "cycle-parameter"),
        ('CYCLE94(40,-30,"E")', ToolOffset(quadrant=0), "61608"),
        ('CYCLE94(40,-30,"E")', ToolOffset(quadrant=8), "61608"),
        ('CYCLE94(40,-30,"E",3)', ToolOffset(quadrant=9, nose_radius=0.4), "61608"),
        ('CYCLE94(40,-30,"E")', ToolOffset(quadrant=3, nose_radius=0.8), "61604"),
        ('CYCLE94(40,-30,"E",5)', ToolOffset(quadrant=3), "cycle-parameter"),
        ('CYCLE96(7,-30,"A")', ToolOffset(quadrant=3), "61601"),
        ('CYCLE96(10.5,-30,"A")', ToolOffset(quadrant=3), "61601"),
        ('CYCLE96(10,-30,"E")', ToolOffset(quadrant=3), "61609"),
        ('CYCLE96(10,-30,"C")', ToolOffset(quadrant=3), "61608"),
        ('CYCLE96(10,-30,"A")', ToolOffset(quadrant=2), "61608"),
    ],
)
def test_invalid_undercut_calls_are_rejected(call: str, tool: ToolOffset, code: str) -> None:
    assert refused(OUTSIDE + call, replace(setup(), tools={1: tool})).code == code


def test_undercut_requires_a_tool_and_a_feed() -> None:
    without = run("S900 M3 G95\nT1 D1\n" + 'CYCLE94(40,-30,"E")', with_tool(3))
    assert [each.code for each in without.errors] == ["61003"]
    without = run("S900 M3 G95 F0.1\nT1 D0\n" + 'CYCLE94(40,-30,"E")', with_tool(3))
    assert [each.code for each in without.errors] == ["61000"]


@pytest.mark.parametrize(("place", "quadrant", "out", "side"), [(0, 4, 1, -1), (1, 3, 1, 1), (3, 2, -1, 1)])
def test_cycle940_parameter_sets_position_of_undercut(place: int, quadrant: int, out: int, side: int) -> None:
    before = OUTSIDE if out > 0 else INSIDE
    blocks = cuts(before + f'CYCLE940(40,-30,"E",{place},2,0.2)', with_tool(quadrant))
    assert blocks[2].x == pytest.approx(20 - out * 0.3)
    assert blocks[2].z == pytest.approx(-30 + side * 0.6)
    assert {b.feed for b in blocks} == {0.2}


def test_cycle940_cuts_thread_undercut_in_passes() -> None:
    """A lead of 2 (_PITI 15): 1.5 deep, 7 wide. 0.1 left of 1.5 in passes of 0.5: 0.467 each, then all."""
    call = 'CYCLE940(30,-20,"A",1,2,0.1,3,,,,,,,0.5,0.1,,,15)'
    floors = [b.x for b in good(OUTSIDE + call, with_tool(3)) if b.kind is BlockKind.FEED and b.x == b.x0]
    assert [15 - x for x in floors] == pytest.approx([1.4 / 3, 2.8 / 3, 1.4, 1.5])


@pytest.mark.parametrize(
    ("call", "code"),
    [
        ('CYCLE940(40,-30,"C",2,2,0.1)', "61609"),
        ('CYCLE940(40,-30,"E",4,2,0.1)', "cycle-parameter"),
        ('CYCLE940(40,-30,"E",1,2,0.1,,,,1,0.4)', "not-in-subset"),
        ('CYCLE940(40,-30,"A",1,2,0.1,3,,,,,,,,,,,0)', "61601"),
        ('CYCLE940(30,-30,"A",1,2,0.1,4)', "61002"),
    ],
)
def test_cycle940_rejects_undocumented_parameters(call: str, code: str) -> None:
    assert refused(OUTSIDE + call, with_tool(3)).code == code
