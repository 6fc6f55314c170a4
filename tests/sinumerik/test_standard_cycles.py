"""CYCLE81 to 97: paths worked out by hand, and every bound refused by the name of its parameter."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import radians, sqrt, tan

import numpy as np
import pytest

from core.geometry.lines_and_arcs import Arc, compute_distance_to_point
from core.interpreter.shared.actions import Dwell
from core.interpreter.shared.contour_stage import make_element
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.source import Dialect, ProgramSource
from tests.sinumerik.lathe import good, refused, run, setup, source

HOLE = "S1000 M3 G94 F120 G17\nG0 X0 Z5\n"
CUT = "S1000 M3 G95 F0.2\nG0 X60 Z5\n"
THREAD = "S500 M3\nG0 X60 Z5\n"


def places(text: str | ProgramSource, around: InterpreterSetup | None = None) -> list[tuple[float, float]]:
    """Ø and Z of the ends of a cycle's moves, behind the two lines before it."""
    return [(round(b.x * 2, 4), round(b.z, 4)) for b in good(text, around) if b.line > 2]


def test_cycle81_drills_in_one_pass() -> None:
    assert places(HOLE + "CYCLE81(4,0,2,-12)") == [(0, 2), (0, -12), (0, 4)]
    assert places(HOLE + "CYCLE81(4,1,2,,12)") == [(0, 3), (0, -11), (0, 4)]  # DPR from the reference plane
    blocks = [b for b in good(HOLE + "CYCLE81(4,0,2,-12)") if b.line > 2]
    assert [b.kind for b in blocks] == [BlockKind.RAPID, BlockKind.FEED, BlockKind.RAPID]
    assert blocks[1].feed == pytest.approx(2.0)  # 120 mm/min


@pytest.mark.parametrize(("dwell", "seconds"), [("0.5", 0.5), ("-10", 0.6)])  # 10 turns at 1000 rpm
def test_cycle82_dwells_at_bottom(dwell: str, seconds: float) -> None:
    actions = [b.action for b in run(HOLE + f"CYCLE82(4,0,2,-12,,{dwell})").blocks if b.action]
    last = actions[-1]
    assert isinstance(last, Dwell)
    assert last.seconds == pytest.approx(seconds)


def test_pecks_get_smaller_and_last_two_are_equal() -> None:
    # 10, then 8, then 6 of 30; 6 are left, and 4 would leave 2: twice 3.
    depths = [z for _, z in places(HOLE + "CYCLE83(4,0,1,-30,,-10,,2,0,0,1,1)") if z < 0]
    assert depths == [-10, -9, -18, -17, -24, -23, -27, -26, -30]
    broken = [z for _, z in places(HOLE + "CYCLE83(4,0,1,-30,,-10,,2,0,0,1,0)") if z < 0]
    assert broken == [-10, -9, -18, -17, -24, -23, -27, -26, -30]  # VARI 0 draws back 1 mm
    first, second = [b.feed for b in good(HOLE + "CYCLE83(4,0,1,-20,,-10,,,0,0,0.5,1)") if b.z in {-10, -20}]
    assert (first, second) == pytest.approx((1.0, 2.0))  # FRF for the first alone


def test_cycle85_feeds_out() -> None:
    blocks = [b for b in good(HOLE + "CYCLE85(4,0,1,-9,,0,60,240)") if b.line > 2]
    assert [(b.z, b.feed) for b in blocks[1:3]] == [(-9, pytest.approx(1.0)), (1, pytest.approx(4.0))]


def test_mcall_drills_at_each_position() -> None:
    ends = places(HOLE + "MCALL CYCLE81(4,0,2,-3)\nX10\nX20\nMCALL\nX30")
    assert ends == [(10, 5), (10, 2), (10, -3), (10, 4), (20, 4), (20, 2), (20, -3), (20, 4), (30, 4)]


KONTUR = ProgramSource(
    "KONTUR.spf", "G1 X20 Z0\nZ-10\nX40 Z-20\nG2 X50 Z-25 CR=5\nG1 X54\nM17", Dialect.SINUMERIK
)


def material_left(blocks: list[Block], x: float, z: float) -> float:
    """Least X (radius) that the cuts reach at this Z, of points on them: not by the cycle's geometry."""
    least = x
    for block in blocks:
        if block.kind is BlockKind.RAPID:
            continue
        element = make_element(block)
        share = np.linspace(0.0, element.length, 400)
        points = np.array([element.get_point(s) for s in share]) if element.length else np.empty((0, 2))
        if isinstance(element, Arc):
            assert (
                abs(
                    np.hypot(points[:, 0] - element.center[0], points[:, 1] - element.center[1])
                    - element.radius
                ).max()
                < 1e-9
            )
        near = points[np.abs(points[:, 1] - z) < 0.06] if len(points) else points
        if len(near):
            least = min(least, near[:, 0].min())
    return least


@pytest.mark.parametrize(
    ("z", "radius"),
    [(-5, 10), (-12, 12), (-15, 15), (-18, 18), (-22, 25 - sqrt(25 - 4)), (-24.5, 25 - sqrt(25 - 20.25))],
)
def test_stock_removal_leaves_allowance_on_contour(z: float, radius: float) -> None:
    """The arc's centre is (25, -20): clockwise with X up from (20, -20) to (25, -25)."""
    blocks = good(source(CUT + 'CYCLE95("KONTUR",2,0,0,,0.3,0.1,0.12,9)', KONTUR))
    assert material_left(blocks, 30, z) == pytest.approx(radius, abs=0.13)  # the slope times .06
    roughed = good(source(CUT + 'CYCLE95("KONTUR",2,,,0.5,0.3,0.1,0.12,1)', KONTUR))
    assert material_left(roughed, 30, z) >= radius + 0.4
    assert min(b.feed for b in blocks if b.kind is not BlockKind.RAPID) == pytest.approx(0.12)


def contour_with(line: str, *moves: str) -> str:
    """A program whose CYCLE95 finishes a contour between two labels, which begins with ``line``."""
    call = 'CYCLE95("LAA:LBB",1,,,0.2,0.1,0.1,0.1,5)\nGOTOF LEE\nLAA:\n'
    return "\n".join((CUT + call + line, *moves, "LBB:", "LEE:", "M30"))


@pytest.mark.parametrize(
    ("head", "line", "moves", "corners"),
    [
        ("R0=33\n", "R[5]=7", ("G1 X=R5 Z2", "X=R0", "X20 Z0"), {7, 33, 20}),
        ("R1=2\n", "R[R1+1]=8", ("G1 X=R3 Z2", "X20 Z0"), {8, 20}),
        ("DEF REAL TAB[3]\n", "TAB[0]=SET(7,30)", ("G1 X=TAB[0] Z2", "X=TAB[1] Z0"), {7, 30}),
        ("DEF REAL TAB[3]\n", "TAB[2]=8", ("G1 X=TAB[2] Z2", "X20 Z0"), {8, 20}),
    ],
)
def test_assignment_in_a_contour_sets_the_indexed_variable(
    head: str, line: str, moves: tuple[str, ...], corners: set[float]
) -> None:
    ends = {round(2 * b.x, 4) for b in good(head + contour_with(line, *moves))}
    assert corners <= ends


def test_assignment_in_a_contour_does_not_change_the_program() -> None:
    head = "DEF REAL TAB[2]\nTAB[1]=9\nR5=4\n"
    text = head + contour_with("R[5]=7 TAB[1]=8", "G1 X=R5 Z2", "X20 Z0").replace("M30", "G0 X=R5 Z=TAB[1]")
    last = good(text)[-1]
    assert (2 * last.x, last.z) == pytest.approx((4.0, 9.0))


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("ABC=7", "12550"),
        ("TAB[0]=7", "12550"),
        ("R[300]=7", "17020"),
        ("R[-1]=7", "17020"),
        ("R[299]=SET(1,2)", "array-values"),
    ],
)
def test_invalid_assignment_in_a_contour_is_rejected(line: str, code: str) -> None:
    assert refused(contour_with(line, "G1 X7 Z2", "X20 Z0")).code == code


def with_nose(radius: float, quadrant: int) -> InterpreterSetup:
    return replace(setup(), tools={1: ToolOffset(quadrant=quadrant, nose_radius=radius)})


@pytest.mark.parametrize("nose", [0.4, 0.8])
@pytest.mark.parametrize("vari", [5, 9])
def test_tapers_and_arcs_have_correct_size_for_any_nose_radius(nose: float, vari: int) -> None:
    """The centre lies the nose radius from the tip in X and Z; a taper of 45 degrees, and an arc."""
    call = f'CYCLE95("KONTUR",2,0.1,0.2,,0.3,0.1,0.12,{vari})'
    text = source(CUT.replace("G95", "T1 D1 G95") + call, KONTUR)
    cuts = [
        make_element(b)
        for b in good(text, with_nose(nose, 3))
        if b.line == 3 and b.kind is not BlockKind.RAPID
    ]
    share = sqrt(0.5)
    for x, z in ((10, -5), (15, -15), (25 - 5 * share, -20 - 5 * share)):
        tip = x - nose, z - nose  # where the tip is when the centre lies on the point
        assert min(compute_distance_to_point(each, tip) for each in cuts) == pytest.approx(nose, abs=2e-3)


def test_nose_compensation_leaves_allowance_too() -> None:
    """0.5 everywhere: the nose's edge stays so far from the taper when it roughs alone."""
    text = source(CUT.replace("G95", "T1 D1 G95") + 'CYCLE95("KONTUR",2,,,0.5,0.3,0.1,0.12,1)', KONTUR)
    cuts = [
        make_element(b)
        for b in good(text, with_nose(0.4, 3))
        if b.line == 3 and b.kind is not BlockKind.RAPID
    ]
    assert min(compute_distance_to_point(each, (15 - 0.4, -15.4)) for each in cuts) == pytest.approx(
        0.9, abs=2e-3
    )


def test_inside_contour_is_compensated_on_the_other_side() -> None:
    inner = ProgramSource("BORE.spf", "G1 X40 Z0\nX30 Z-10\nZ-30\nM17", Dialect.SINUMERIK)
    text = 'S1000 M3 T1 D1 G95 F0.2\nG0 X16 Z5\nCYCLE95("BORE",2,,,,0.3,0.1,0.12,7)'
    cuts = [
        make_element(b)
        for b in good(source(text, inner), with_nose(0.4, 2))
        if b.line == 3 and b.kind is BlockKind.FEED
    ]
    tip = 17.5 + 0.4, -5 - 0.4
    assert min(compute_distance_to_point(each, tip) for each in cuts) == pytest.approx(0.4, abs=2e-3)


def test_facing_contour_is_compensated_for_nose_radius() -> None:
    """A face with a taper of 45 degrees from Ø40 Z-12 to Ø20 Z-2."""
    face = ProgramSource("FACE.spf", "G1 X50 Z-12\nX40\nX20 Z-2\nX0\nM17", Dialect.SINUMERIK)
    text = CUT.replace("G95", "T1 D1 G95") + 'CYCLE95("FACE",2,0.2,,,0.3,0.1,0.12,10)'
    moves = good(source(text, face), with_nose(0.4, 3))
    cuts = [make_element(b) for b in moves if b.line == 3 and b.kind is BlockKind.FEED]
    assert min(compute_distance_to_point(each, (15 - 0.4, -7.4)) for each in cuts) == pytest.approx(
        0.4, abs=2e-3
    )


def test_tip_follows_contour_without_tip_quadrant_with_warning() -> None:
    text = source(CUT.replace("G95", "T1 D1 G95") + 'CYCLE95("KONTUR",2,,,,0.3,0.1,0.12,5)', KONTUR)
    passed = run(text, with_nose(0.4, 0))
    assert [each.code for each in passed.found] == ["comp-no-quadrant"]
    assert min(compute_distance_to_point(make_element(b), (15, -15)) for b in passed.moves) == pytest.approx(
        0.0, abs=1e-6
    )


def test_passes_are_equal_and_no_deeper_than_mid() -> None:
    blocks = good(source(CUT + 'CYCLE95("KONTUR",5,,,,0.3,0.1,0.12,1)', KONTUR))
    levels = sorted(
        {round(b.x, 4) for b in blocks if b.kind is BlockKind.FEED and b.x == b.x0 and b.z < b.z0},
        reverse=True,
    )
    # 54 to 20 are 17 mm of radius: four passes of 4.25
    assert levels == [22.75, 18.5, 14.25, 10.0]


def test_neck_before_shoulder_does_not_reverse_cut_direction() -> None:
    """Deep is the end of the contour that is so, whatever falls between: the passes go from right to left."""
    neck = ProgramSource("NECK.spf", "G1 X20 Z0\nZ-10\nX16 Z-14\nZ-20\nX40\nM17", Dialect.SINUMERIK)
    blocks = good(source(CUT + 'CYCLE95("NECK",2,,,,0.3,0.1,0.12,1)', neck))
    ways = {b.z < b.z0 for b in blocks if b.line == 3 and b.kind is BlockKind.FEED and b.x == b.x0}
    assert ways == {True}


def test_contour_is_read_between_labels_and_for_inside_cut() -> None:
    text = CUT + 'CYCLE95("AA:BB",3,,,,0.3,0.1,0.12,9)\nGOTOF CC\nAA: G1 X20 Z0\nZ-10\nBB: X40\nCC: Z5'
    assert material_left(good(text), 30, -5) == pytest.approx(10, abs=1e-6)
    bore = (
        CUT.replace("X60", "X18")
        + 'CYCLE95("AA:BB",2,,,,0.3,0.1,0.12,11)\nGOTOF CC\nAA: G1 X40 Z0\nZ-10\nBB: X20\nCC: Z5'
    )
    reached = max(b.x for b in good(bore) if b.line == 3)
    assert reached == pytest.approx(20)
    assert max(b.x for b in good(bore) if b.line == 3 and b.z < -10.001) < 10.001 if any(
        b.z < -10.001 for b in good(bore)) else True  # fmt: skip


def test_facing_makes_passes_along_x() -> None:
    text = CUT + 'CYCLE95("AA:BB",1,,,,0.3,0.1,0.12,2)\nGOTOF CC\nAA: G1 X50 Z-4\nX20\nBB: Z0\nCC: Z5'
    cuts = [b for b in good(text) if b.line == 3 and b.kind is BlockKind.FEED and b.z == b.z0 and b.x < b.x0]
    assert sorted({round(b.z, 4) for b in cuts}) == [-4, -3, -2, -1]


def test_tapered_thread_starts_on_its_extended_line() -> None:
    """Ø20 at Z-5, Ø24 at Z-25: R .1 a mm; 5 before it R9.5, 3 behind it R12.3; a depth of 1."""
    (cut,) = [
        b for b in good(THREAD + "CYCLE97(2,,-5,-25,20,24,5,3,1,0,0,,1,0,1,1)") if b.kind is BlockKind.THREAD
    ]
    assert (cut.x0, cut.z0, cut.x, cut.z) == pytest.approx((8.5, 0.0, 11.3, -28.0))


def test_thread_passes_have_equal_chip_area() -> None:
    text = THREAD + "CYCLE97(2,,0,-20,24,24,6,3,1.2,0.1,30,,3,1,3,1)"
    cuts = [b for b in good(text) if b.kind is BlockKind.THREAD]
    depths = [1.1 * sqrt(1 / 3), 1.1 * sqrt(2 / 3), 1.1, 1.2, 1.2]
    assert [b.x for b in cuts] == pytest.approx([12 - d for d in depths])
    assert [b.z0 for b in cuts] == pytest.approx([6 - d * tan(radians(30)) for d in depths])
    assert {b.z for b in cuts} == {-23}
    assert all(b.feed == 2 and b.per_rev for b in cuts)
    clear = [b for b in good(text) if b.kind is BlockKind.RAPID and b.line == 3]
    assert max(b.x for b in clear) == 13  # DM1 and 1 mm


def test_thread_starts_are_offset_by_parts_of_the_lead() -> None:
    cuts = [
        b for b in good(THREAD + "CYCLE97(6,,0,-20,24,24,8,3,1.2,0,0,,1,0,1,3)") if b.kind is BlockKind.THREAD
    ]
    assert [b.z0 for b in cuts] == pytest.approx([8, 10, 12])


def test_tapered_thread_retains_its_taper_over_run_in_and_run_out() -> None:
    (cut,) = [
        b for b in good(THREAD + "CYCLE97(2,,0,-20,20,24,5,5,1,0,0,,1,0,1,1)") if b.kind is BlockKind.THREAD
    ]
    # 2 mm of radius on 20 mm: .5 more before and behind; the depth of 1 below
    assert (cut.x0, cut.x) == pytest.approx((8.5, 11.5))


def test_nominal_size_sets_coarse_lead() -> None:
    (cut,) = [
        b
        for b in good(THREAD + "CYCLE97(,24,0,-20,24,24,8,3,1.2,0,0,,1,0,1,1)")
        if b.kind is BlockKind.THREAD
    ]
    assert cut.feed == 3  # M24


def grooving() -> InterpreterSetup:
    """T3 is 3 mm wide: D1 its corner towards plus Z, D2 that towards the chuck."""
    return replace(setup(), tools={3: ToolOffset(0.0, 0.0), 200_003: ToolOffset(0.0, 3.0)})


def test_groove_has_programmed_width() -> None:
    text = "S900 M3 G95 F0.1 T3 D1\nG0 X44 Z0\nCYCLE93(40,-10,8,5,,,,,,,,,,2,0.5,5)"
    cuts = [b for b in good(text, grooving()) if b.line == 3 and b.kind is BlockKind.FEED]
    # D1 is the right corner: it stands from -10 to -15, where the left one stands at -18.
    assert (max(b.z for b in cuts), min(b.z for b in cuts)) == pytest.approx((-10, -15))
    assert min(b.x for b in cuts) == pytest.approx(15)
    plunges = sorted({round(b.z, 4) for b in cuts if b.x < b.x0})
    assert max(b - a for a, b in pairwise(plunges)) <= 0.95 * 3
    assert any(isinstance(b.action, Dwell) for b in run(text, grooving()).blocks)


def test_dn_selects_second_groove_tool_corner() -> None:
    """D2 is a finishing edge elsewhere, D5 the left corner, 3 mm from D1: the same ways as with D2 there."""
    text = "S900 M3 G95 F0.1 T3 D1\nG0 X44 Z0\nCYCLE93(40,-10,8,5,,,,,,,,,,2,0.5,5,,{})"
    around = grooving()
    other = {3: around.tools[3], 200_003: ToolOffset(0.0, 1.0), 500_003: ToolOffset(0.0, 3.0)}
    by_dn = [(b.x, b.z) for b in good(text.format(5), replace(around, tools=other))]
    assert by_dn == [(b.x, b.z) for b in good(text.format(""), around)]


def test_a_groove_needs_both_corners_of_its_tool() -> None:
    one = replace(setup(), tools={3: ToolOffset()})
    error = refused("S900 M3 G95 F0.1 T3 D1\nG0 X44 Z0\nCYCLE93(40,-10,8,5,,,,,,,,,,2,0.5,5)", one)
    assert (error.code, error.line) == ("61602", 3)
    assert "T3 D2" in error.message
    assert "T3 D2" in error.hint


@pytest.mark.parametrize(
    ("call", "code", "named"),
    [
        ("CYCLE81(4,0,2)", "cycle-parameter", "DP"),
        ("CYCLE81(,0,2,-3)", "cycle-parameter", "RTP"),
        ("CYCLE81(4,0,-2,-3)", "cycle-parameter", "SDIS"),
        ("CYCLE81(4,0,2,3)", "61101", "DP"),
        ("CYCLE81(-4,0,2,-3)", "61101", "DP"),
        ('CYCLE81("A",0,2,-3)', "cycle-parameter", "RTP"),
        ("CYCLE81(1,2,3,4,5,6,7,8,9,10)", "12330", "9 parameters"),
        ("CYCLE83(4,0,1,-30,,-40)", "61107", "FDEP"),
        ("CYCLE83(4,0,1,-30,,-10,,2,0,0,1,5)", "61002", "VARI"),
        ("CYCLE83(4,0,1,-30,,-10,,2,0,0,3,1)", "cycle-parameter", "FRF"),
        ("CYCLE83(4,0,1,-30,,-10,,2,0,0,1,1,1)", "not-in-subset", "_AXN"),
        ('CYCLE95("NOWHERE",2,,,,0.3,0.1,0.1,9)', "subprogram-missing", "NOWHERE"),
        ('CYCLE95("AA:BB",2,,,,0.3,0.1,0.1,9)', "14080", "AA:BB"),
        ('CYCLE95("KONTUR",2,,,,0.3,0.1,0.1)', "61002", "VARI"),
        ('CYCLE95("KONTUR",2,,,,0.3,0.1,0.1,13)', "61002", "VARI"),
        ('CYCLE95("KONTUR",,,,,0.3,0.1,0.1,1)', "61610", "MID"),
        ('CYCLE95("KONTUR",-2,,,,0.3,0.1,0.1,1)', "cycle-parameter", "MID"),
        ('CYCLE95("KONTUR",0.00001,,,,0.3,0.1,0.1,1)', "cycle-parameter", "MID"),
        ("CYCLE95(,2,,,,0.3,0.1,0.1,1)", "61605", "NPP"),
        ("CYCLE97(,7,0,-20,24,24,6,3,1.2,0,0,,3,1,3,1)", "61001", "MPIT"),
        ("CYCLE97(2,,0,0,24,24,6,3,1.2,0,0,,3,1,3,1)", "cycle-parameter", "FPL"),
        ("CYCLE97(2,,0,-20,0,24,6,3,1.2,0,0,,3,1,3,1)", "cycle-parameter", "DM1"),
        ("CYCLE97(2,,0,-20,24,24,6,3,1.2,2,0,,3,1,3,1)", "cycle-parameter", "FAL"),
        ("CYCLE97(2,,0,-20,24,24,6,3,1.2,0,0,,3,1,7,1)", "61002", "VARI"),
        ("CYCLE97(2,,0,-20,24,24,6,3,1.2,0,0,400,3,1,3,1)", "cycle-parameter", "NSP"),
        ("CYCLE93(40,-10,8,5,,10)", "61002", "VARI"),
        ("CYCLE93(40,-10,8,5,,90,,,,,,,,2,0,5)", "cycle-parameter", "ANG1"),
        ("CYCLE93(40,-10,8,5,,,-1,,,,,,,2,0,5)", "cycle-parameter", "ANG2"),
        ("CYCLE93(40,-10,8,5,10,,,,,,,,,2,0,5)", "not-in-subset", "STA1"),
        ("CYCLE93(40,-10,8,5,,,,1,,,,,,2,0,5)", "not-in-subset", "RCO1"),
        ("CYCLE93(40,-10,8,50,,,,,,,,,,2,0,5)", "61603", "DIAG"),
        ("CYCLE93(40,-10,8,5,,,,,,,,,,2,0,6)", "not-in-subset", "VARI"),
        ("CYCLE84(4,0,2,-12,,,5,,1,0,100)", "spindle-position", "C has a separate drive"),
        ('CYCLE952("A")', "not-in-subset", "CYCLE952"),
    ],
)  # fmt: skip
def test_parameter_limits_are_reported_by_parameter_name(call: str, code: str, named: str) -> None:
    before = HOLE if call[5:7] in {"81", "83", "84"} else HOLE.replace("G17", "G18")
    error = refused(source(before + call, KONTUR))
    assert (error.code, error.line) == (code, 3)
    assert named in error.message + error.hint
    assert error.hint


@pytest.mark.parametrize(
    ("before", "call", "code"),
    [
        ("G0 X0 Z5\nS900 M3 G18", "CYCLE81(4,0,2,-3)", "cycle-plane"),
        ("G0 X0 Z5\nS900 M3 G17", "CYCLE81(4,0,2,-3)", "10860"),
        ("G0 X0 Z5\nG17 G95 F0.1", "CYCLE81(4,0,2,-3)", "g95-spindle-stopped"),
        ("G0 X60 Z5\nM5", "CYCLE97(2,,0,-20,24,24,6,3,1.2,0,0,,3,1,3,1)", "g95-spindle-stopped"),
        ("G0 X60 Z5\nG96 S100 M3", "CYCLE97(2,,0,-20,24,24,6,3,1.2,0,0,,3,1,3,1)", "thread-under-css"),
    ],
)
def test_missing_preconditions_of_cycle_are_rejected(before: str, call: str, code: str) -> None:
    error = refused(f"{before}\n{call}")
    assert (error.code, error.line) == (code, 3)


@pytest.mark.parametrize(
    "line", ["CALL NUT", "G33 Z-5 K1", "GOTOF AA", "TRANS X5", "G41 X30", "C30", "G1 X=IC("]
)
def test_blocks_not_allowed_in_contour_are_rejected(line: str) -> None:
    bad = ProgramSource("KONTUR.spf", f"G1 X20 Z0\nZ-10\n{line}\nX40\nM17", Dialect.SINUMERIK)
    passed = run(source(CUT + 'CYCLE95("KONTUR",2,,,,0.3,0.1,0.1,9)', bad))
    (error,) = passed.errors
    assert error.line == 3
    assert "KONTUR.spf line 3" in error.message
