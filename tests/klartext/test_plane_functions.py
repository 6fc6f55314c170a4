"""PLANE blocks as they are executed: targets, order of events, modality, Q parameters, datum."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.geometry.rotary_axes import Kinematics
from core.geometry.working_plane import ProgramTransform
from core.interpreter.shared.elementary_blocks import BlockKind
from tests.klartext.running import Ran, run
from tests.klartext.table import AC, C, limited

S = math.sqrt(0.5)
P1 = "P1X+0 P1Y+0 P1Z+0 "
CHAMFER_1 = f"PLANE POINTS {P1}P2X+1 P2Y+0 P2Z+0 P3X+0 P3Y+1 P3Z+1"
CHAMFER_2 = f"PLANE POINTS {P1}P2X+0 P2Y+1 P2Z+0 P3X-1 P3Y+0 P3Z+1"


def shown(ran: Ran) -> list[tuple[float, float]]:
    """A and C as displayed, behind each PLANE block."""
    found = []
    for block in ran.planes:
        assert block.swivel is not None
        a, _, c = block.swivel.rotary_angles
        found.append((a or 0.0, c or 0.0))
    return found


def targets(ran: Ran) -> tuple[float, float]:
    return ran.state.q_values[120], ran.state.q_values[122]


def test_plane_axial_blocks_accumulate_to_one_plane() -> None:
    ran = run(
        "PLANE AXIAL A+45 TURN FMAX\nPLANE AXIAL C+90 TURN FMAX\nPLANE AXIAL IC+90 TURN FMAX\n"
        "PLANE AXIAL IC+90 TURN FMAX\nPLANE AXIAL IA-15 TURN FMAX\nPLANE AXIAL A+0 TURN FMAX"
    )
    assert not ran.errors
    wanted = [(45, 0), (45, 90), (45, 180), (45, 270), (30, 270), (0, 270)]
    assert np.allclose(shown(ran), wanted, atol=1e-12)
    fifth = ran.planes[4].swivel
    assert fifth is not None
    assert np.array(fifth.system.frame)[:, 2] == pytest.approx((-0.5, 0.0, 0.866025404), abs=1e-9)
    assert ran.planes[5].swivel is not None
    assert ran.planes[5].swivel.system.is_tilted  # A+0 ends no plane


# 30 about Y, mirrored at X, is -30: the tool leans to -X, A30 with C at 270. All forms tell the same.
LEANS = {
    "SPATIAL": "SPA+0 SPB+30 SPC+0",
    "VECTOR": "BX+0.866025404 BY+0 BZ-0.5 NX+0.5 NY+0 NZ+0.866025404",
    "POINTS": f"{P1}P2X+0.866025404 P2Y+0 P2Z-0.5 P3X+0 P3Y+1 P3Z+0",
    "EULER": "EULPR+90 EULNU+30 EULROT-90",
    "PROJECTED": "PROPR-30 PROMIN+0 ROT+0",
    "RELATIV": "SPB+30",
}
WITH_IT = {"TRANS MIRROR AXIS X": 270.0, "TRANS ROTATION ROT+90": 180.0, "TRANS SCALE SCL0.5": 90.0}


@pytest.mark.parametrize("form", LEANS)
@pytest.mark.parametrize("before", WITH_IT)
def test_plane_follows_mirror_rotation_and_scaling(form: str, before: str) -> None:
    """Turned by 90 the tool leans to +Y, so C is at 180; a factor changes no direction."""
    plane = f"PLANE {form} {LEANS[form]} TURN FMAX SYM+"
    assert np.allclose(shown(run(plane)), [(30.0, 90.0)], atol=1e-6)
    ran = run(f"{before}\n{plane}")
    assert not ran.errors
    assert "plane-figure" in ran.warned
    assert np.allclose(shown(ran), [(30.0, WITH_IT[before])], atol=1e-6)


def test_positions_in_mirrored_plane_are_mirrored() -> None:
    """X10 in the plane is (8.66, 0, -5) without MIRROR, and with it (-8.66, 0, -5)."""
    ran = run("TRANS MIRROR AXIS X\nPLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX SYM+")
    assert ran.planes[0].swivel is not None
    frame = np.array(ran.planes[0].swivel.system.frame)
    assert frame @ ProgramTransform("X").convert_to_plane((10.0, 0.0, 0.0)) == pytest.approx(
        (-8.660254, 0.0, -5.0)
    )


@pytest.mark.parametrize("before", WITH_IT)
def test_plane_axial_ignores_transformations(before: str) -> None:
    ran = run(f"{before}\nPLANE AXIAL A+45 C+90 TURN FMAX")
    assert (shown(ran), ran.warned) == ([(45.0, 90.0)], [])


@pytest.mark.parametrize("behind", ["TRANS MIRROR RESET", "TRANS MIRROR AXIS X\nTRANS MIRROR RESET"])
def test_canceled_transformation_does_not_change_plane(behind: str) -> None:
    ran = run(f"{behind}\nPLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX SYM+")
    assert not ran.errors
    assert "plane-figure" not in ran.warned
    assert np.allclose(shown(ran), [(30.0, 90.0)], atol=1e-9)


def test_plane_axial_leaves_unnamed_axis_in_position() -> None:
    ran = run("PLANE AXIAL A+45 TURN FMAX", start=(0.0, 0.0, 0.0, 0.0, 30.0))
    assert shown(ran) == [(45.0, 30.0)]
    frame = ((0.866025, -0.353553, 0.353553), (0.5, 0.612372, -0.612372), (0.0, 0.707107, 0.707107))
    assert ran.planes[0].swivel is not None
    assert np.allclose(ran.planes[0].swivel.system.frame, frame, atol=1e-6)


def test_plane_axial_stay_moves_nothing_and_increments_from_targets() -> None:
    ran = run("PLANE AXIAL A+45 C+90 STAY\nPLANE AXIAL IC+10 STAY")
    assert targets(ran) == (45.0, 100.0)
    assert shown(ran) == [(0.0, 0.0), (0.0, 0.0)]
    assert [block.travel.length for block in ran.planes if block.travel] == [0.0, 0.0]


def test_modulo_axis_accepts_any_value() -> None:
    ran = run("PLANE AXIAL A+45 C+450 TURN FMAX")
    assert shown(ran) == [(45.0, 90.0)]
    assert ran.axes(ran.planes[0])["C"] == 90.0


def test_axial_a_minus_45_c_180_is_not_chamfer_1_with_sym_minus() -> None:
    axial = run("PLANE AXIAL A-45 C+180 TURN FMAX").planes[0].swivel
    points = run(f"{CHAMFER_1} TURN FMAX SYM-").planes[0].swivel
    assert axial is not None
    assert points is not None
    assert axial.rotary_angles == points.rotary_angles
    assert np.allclose(axial.system.frame, ((-1, 0, 0), (0, -S, -S), (0, -S, S)), atol=1e-12)
    assert np.allclose(points.system.frame, ((1, 0, 0), (0, S, -S), (0, S, S)), atol=1e-12)


def test_plane_axial_ignores_sym_and_table_rot() -> None:
    ran = run("PLANE AXIAL A+45 TURN FMAX SYM- TABLE ROT")
    assert not ran.errors
    assert shown(ran) == [(45.0, 0.0)]


def test_incremental_axial_after_points_starts_from_its_solution() -> None:
    ran = run(f"{CHAMFER_2} TURN FMAX SYM+\nPLANE AXIAL IA+5 TURN FMAX")
    assert np.allclose(shown(ran), [(45.0, 90.0), (50.0, 90.0)], atol=1e-9)


@pytest.mark.parametrize(("side", "a", "c"), [("SYM+", 45.0, 90.0), ("SYM-", -45.0, 270.0)])
def test_plane_relativ_rotates_about_tilted_axes(side: str, a: float, c: float) -> None:
    ran = run(f"{CHAMFER_2} TURN FMAX SYM+\nPLANE RELATIV SPC+20 TURN FMAX {side}")
    assert shown(ran)[1] == pytest.approx((a, c))


def test_plane_relativ_without_plane_rotates_workpiece_system() -> None:
    relativ = run("PLANE RELATIV SPA+45 TURN FMAX").planes[0].swivel
    spatial = run("PLANE SPATIAL SPA+45 SPB+0 SPC+0 TURN FMAX").planes[0].swivel
    assert relativ is not None
    assert spatial is not None
    assert np.allclose(relativ.system.frame, spatial.system.frame, atol=1e-15)


@pytest.mark.parametrize(("turn", "c"), [(0, 0.0), (90, 90.0), (180, 180.0), (270, 270.0)])
def test_plane_spatial_defines_the_four_chamfers(turn: int, c: float) -> None:
    ran = run(f"PLANE SPATIAL SPA+45 SPB+0 SPC+{turn} TURN FMAX SYM+")
    assert shown(ran)[0] == pytest.approx((45.0, c))


def test_published_program_reaches_angles_of_its_comment() -> None:
    """SPA90 SPB0 SPC180 with SEQ- and TABLE ROT was commented "A-90 C0" by whoever wrote it."""
    ran = run("PLANE SPATIAL SPA+90 SPB+0 SPC+180 STAY SEQ- TABLE ROT")
    assert targets(ran) == pytest.approx((-90.0, 0.0))


def test_published_tool_axis_test_gives_its_result() -> None:
    swivel = run("PLANE AXIAL A-90 TURN FMAX").planes[0].swivel
    assert swivel is not None
    frame = np.array(swivel.system.frame)
    assert frame[:, 2] == pytest.approx((0.0, 1.0, 0.0), abs=1e-15)
    assert frame[:, 1] == pytest.approx((0.0, 0.0, -1.0), abs=1e-15)


def test_coord_rot_and_table_rot_where_c_is_free() -> None:
    flat = "PLANE SPATIAL SPA+0 SPB+0 SPC+30"
    assert shown(run(f"{flat} TURN FMAX"))[0] == pytest.approx((0.0, 0.0))
    assert shown(run(f"{flat} TURN FMAX COORD ROT"))[0] == pytest.approx((0.0, 0.0))
    assert shown(run(f"{flat} TURN FMAX TABLE ROT"))[0] == pytest.approx((0.0, 30.0))


# --- the order of events ---------------------------------------------------------------------------------


def test_mb_max_stops_before_limit_and_precedes_swivel() -> None:
    ran = run("L Z+100 R0 FMAX\nPLANE AXIAL A+45 C+90 TURN MB MAX FMAX")
    up, swivel = ran.blocks[-3:-1]
    assert (up.kind, swivel.kind) == (BlockKind.RAPID, BlockKind.PLANE)
    assert ran.axes(up)["Z"] == pytest.approx(-0.001, abs=1e-12)
    assert (ran.axes(up)["A"], ran.axes(up)["C"]) == (0.0, 0.0)
    assert (ran.axes(swivel)["A"], ran.axes(swivel)["C"]) == (45.0, 90.0)
    assert [ran.axes(swivel)[axis] for axis in "XYZ"] == [ran.axes(up)[axis] for axis in "XYZ"]


def test_mb_length_retracts_at_feed_of_block() -> None:
    ran = run("L Z+100 R0 FMAX\nPLANE AXIAL A+45 TURN MB 50 F600")
    up, swivel = ran.blocks[-3:-1]
    assert up.kind is BlockKind.FEED
    assert up.feed == pytest.approx(10.0)  # mm/s
    assert ran.axes(up)["Z"] == pytest.approx(-200.0)
    assert swivel.feed == pytest.approx(10.0)  # degrees/s


def test_mb_at_the_limit_moves_nothing() -> None:
    ran = run("PLANE AXIAL A+45 TURN MB MAX FMAX")  # home is the upper end of Z
    assert [block.kind for block in ran.blocks] == [BlockKind.ACTION, BlockKind.PLANE, BlockKind.ACTION]


def test_turn_path_includes_both_rotary_axes() -> None:
    ran = run("PLANE AXIAL A+30 C+40 TURN F300")
    block = ran.planes[0]
    assert block.travel is not None
    assert block.travel.length == pytest.approx(50.0)  # 3 4 5
    assert block.feed == pytest.approx(5.0)


def test_turn_in_rapid_lasts_as_long_as_slowest_axis() -> None:
    """A at 60, C at 120 degrees/s: 90 degrees of A take 1.5 s, 100 of C less."""
    ran = run("PLANE AXIAL A+90 C+100 TURN FMAX")
    block = ran.planes[0]
    assert block.travel is not None
    assert block.rapid
    assert block.travel.length / block.feed == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("words", "there"),
    [("MOVE FMAX", (230.0, 313.6396, -309.7918)), ("MOVE DIST50 FMAX", (230.0, 278.2843, -295.1472))],
)
def test_move_ends_with_pivot_in_place_on_workpiece(words: str, there: tuple[float, float, float]) -> None:
    ran = run(f"L X+0 Y+0 Z+50 R0 FMAX\nPLANE AXIAL A+45 {words}")
    swivel = ran.planes[0]
    assert [ran.axes(swivel)[axis] for axis in "XYZ"] == pytest.approx(there, abs=6e-5)


@pytest.mark.parametrize(("words", "depth"), [("MOVE FMAX", 0.0), ("MOVE DIST50 FMAX", 50.0)])
def test_move_holds_pivot_during_whole_motion(words: str, depth: float) -> None:
    """Against the chain written out for this machine: a point below the tip, carried back by both tables."""
    ran = run(f"L X+5 Y+8 Z+50 R0 FMAX\nPLANE AXIAL A+45 C+90 {words}")
    travel = ran.planes[0].travel
    assert travel is not None
    assert travel.curved_move is not None
    for x, y, z, a, c in travel.curved_move.compute_machine_positions(np.linspace(0.0, 1.0, 11)).tolist():
        ca, sa = math.cos(math.radians(a)), math.sin(math.radians(a))
        cc, sc = math.cos(math.radians(c)), math.sin(math.radians(c))
        dy, dz = y - 250.0, z - depth + 430.0
        y1, z1 = 250.0 + ca * dy - sa * dz, -430.0 + sa * dy + ca * dz  # Rx(+A) about its line
        dx, dy = x - 300.0, y1 - 252.0
        back = (300.0 + cc * dx - sc * dy, 252.0 + sc * dx + cc * dy, z1)  # Rz(+C) about its line
        assert back == pytest.approx((235.0, 218.0, -300.0 - depth), abs=1e-6)


def test_a_frame_is_in_force_after_stay_too() -> None:
    ran = run("PLANE AXIAL A+45 STAY\nL A+Q120 C+Q122 R0 FMAX\nL X+10 Y+0 Z+0 FMAX")
    last = ran.blocks[-2]
    assert [ran.axes(last)[n] for n in "XYZAC"] == pytest.approx(
        (240.0, 278.2843, -345.1472, 45.0, 0.0), abs=6e-5
    )
    assert not ran.warned


def test_cut_away_from_target_angles_causes_one_warning() -> None:
    ran = run("M3\nPLANE AXIAL A+45 STAY\nL X+10 F100\nL X+20\nL Y+5")
    assert ran.warned == ["table-elsewhere"]
    assert [d.line for d in ran.diagnostics] == [5]


def test_moves_in_plane_follow_remaining_rotation() -> None:
    for side, wanted in (("SYM+", (10.0, 0.0, 5.0)), ("SYM-", (-10.0, 0.0, 5.0))):
        ran = run(f"{CHAMFER_1} TURN FMAX {side}\nL X+0 Y+0 Z+0 FMAX\nL IX+10 IZ+5 FMAX")
        start, end = (ran.axes(block) for block in ran.blocks[-3:-1])
        assert [end[axis] - start[axis] for axis in "XYZ"] == pytest.approx(wanted, abs=1e-9)


def test_plane_reset_turn_uses_short_path_and_stay_leaves_axes() -> None:
    ran = run("PLANE AXIAL A+45 C+270 TURN FMAX\nPLANE RESET TURN FMAX")
    first, second = (ran.axes(block) for block in ran.planes)
    assert (first["A"], first["C"]) == (45.0, -90.0)  # 0 to 270 by the short way
    assert (second["A"], second["C"]) == (0.0, 0.0)
    stay = run("PLANE AXIAL A+45 C+270 TURN FMAX\nPLANE RESET STAY")
    assert shown(stay)[1] == (45.0, 270.0)
    assert stay.planes[1].swivel is not None
    assert not stay.planes[1].swivel.system.is_tilted
    bare = run("PLANE AXIAL A+45 TURN FMAX\nPLANE RESET")
    assert shown(bare)[1] == (45.0, 0.0)


def test_rotation_of_180_degrees_goes_positive() -> None:
    ran = run("PLANE AXIAL C+180 TURN FMAX\nPLANE AXIAL C+0 TURN FMAX")
    assert [ran.axes(block)["C"] for block in ran.planes] == [180.0, 360.0]
    assert shown(ran) == [(0.0, 180.0), (0.0, 0.0)]


def test_plane_reset_without_plane_only_positions() -> None:
    ran = run("PLANE RESET TURN FMAX", start=(0.0, 0.0, 0.0, 10.0, 20.0))
    assert not ran.errors
    assert shown(ran) == [(0.0, 0.0)]


@pytest.mark.parametrize("end", ["M2", "M30", ""])
def test_program_end_cancels_plane_without_motion(end: str) -> None:
    ran = run(f"PLANE AXIAL A+45 TURN FMAX\n{end}")
    assert ran.state.active_plane is None
    assert ran.state.position_by_axis["A"] == 45.0


# --- datum and basic rotation ----------------------------------------------------------------------------


def point(ran: Ran, index: int = -2) -> list[float]:
    return [ran.axes(ran.blocks[index])[axis] for axis in "XYZ"]


def test_datum_before_plane_is_in_workpiece_system() -> None:
    ran = run("TRANS DATUM AXIS Y+10\nPLANE AXIAL A+45 TURN FMAX\nL X+50 Y-7.0710678 Z+0 FMAX")
    assert point(ran) == pytest.approx((280.0, 278.2843, -352.2183), abs=6e-5)


def test_datum_within_plane_is_along_its_axes() -> None:
    ran = run("PLANE AXIAL A+45 TURN FMAX\nTRANS DATUM AXIS Y+10 Z+3\nL X+0 Y+0 Z+0 FMAX")
    assert point(ran) == pytest.approx((230.0, 288.2843, -342.1472), abs=6e-5)


def test_plane_block_does_not_move_datum() -> None:
    """A shift along Y' of chamfer 1 is (0, 10 s, 10 s) of the workpiece, and stays there."""
    ran = run("PLANE AXIAL A+45 TURN FMAX\nTRANS DATUM AXIS Y+10\nPLANE RESET TURN FMAX\nL X+0 Y+0 Z+0 FMAX")
    assert point(ran) == pytest.approx((230.0, 210.0 + 10 * S, -350.0 + 10 * S), abs=1e-9)


def test_datum_set_in_previous_plane_causes_warning() -> None:
    trapped = "PLANE AXIAL A+45 TURN FMAX\nTRANS DATUM AXIS X+90\nPLANE AXIAL C+90 TURN FMAX"
    assert run(trapped).warned == ["datum-in-plane"]
    freed = trapped.replace("\nTRANS", "\nPLANE RESET STAY\nTRANS")
    assert run(freed).warned == []


def test_cycle_7_shifts_axis_by_axis() -> None:
    text = "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+10\nCYCL DEF 7.2 IY+4\nCYCL DEF 7.3 IY+1\n"
    ran = run(text + "L X+0 Y+0 Z+0 FMAX")
    assert point(ran) == pytest.approx((240.0, 215.0, -350.0))
    ran = run(text + "TRANS DATUM RESET\nL X+0 Y+0 Z+0 FMAX")
    assert point(ran) == pytest.approx((230.0, 210.0, -350.0))


def turned_part(angle: float) -> Kinematics:
    return dataclasses.replace(AC, basic_rotation_deg=angle)


def test_plane_points_follows_basic_rotation_and_axial_does_not() -> None:
    points = run(f"{CHAMFER_1} TURN FMAX SYM+", turned_part(10.0))
    axial = run("PLANE AXIAL A+45 TURN FMAX", turned_part(10.0))
    assert shown(points)[0] == pytest.approx((45.0, 10.0))
    assert shown(axial)[0] == pytest.approx((45.0, 0.0))
    assert points.planes[0].swivel is not None
    assert np.allclose(points.planes[0].swivel.system.frame, ((1, 0, 0), (0, S, -S), (0, S, S)), atol=1e-12)


# --- ranges ----------------------------------------------------------------------------------------------


def test_plane_solution_respects_machine_ranges() -> None:
    up, down = limited(-10.0, 110.0), limited(-110.0, 10.0)
    assert shown(run(f"{CHAMFER_1} TURN FMAX SYM+", up)) == [(45.0, 0.0)]
    assert run(f"{CHAMFER_1} TURN FMAX SYM-", up).codes == ["Entered angle not permitted"]
    assert run(f"{CHAMFER_1} TURN FMAX SYM+", down).codes == ["Entered angle not permitted"]
    assert shown(run(f"{CHAMFER_1} TURN FMAX", down))[0] == pytest.approx((-45.0, 180.0))


def test_b_axis_on_b_c_table() -> None:
    b = dataclasses.replace(AC.rotary_axes[1], name="B", direction=(0.0, 1.0, 0.0))
    machine = dataclasses.replace(AC, rotary_axes=(C, b), axis_order=("X", "Y", "Z", "B", "C"))
    ran = run("PLANE AXIAL B+45 C+90 TURN FMAX", machine)
    assert not ran.errors
    swivel = ran.planes[0].swivel
    assert swivel is not None
    assert (swivel.rotary_angles, swivel.system.target_angles) == ((None, 45.0, 90.0), (0.0, 45.0, 90.0))
    assert np.array(swivel.system.frame)[:, 2] == pytest.approx((0.0, S, S), abs=1e-12)


@given(
    st.floats(-119.0, 119.0),
    st.floats(-60.0, 60.0),
    st.floats(-180.0, 180.0),
    st.sampled_from(["", "SYM+", "SYM-"]),
)
def test_z_of_any_plane_is_spindle_direction(a: float, b: float, c: float, side: str) -> None:
    """A move along Z' of any plane that the table can reach moves Z of the machine alone, by as much."""
    plane = f"PLANE SPATIAL SPA{a:+.4f} SPB{b:+.4f} SPC{c:+.4f} TURN FMAX {side}"
    ran = run(f"{plane}\nL X+5 Y-3 Z+40 FMAX\nL IZ+7 FMAX")
    if ran.errors:
        assert ran.codes == ["Entered angle not permitted"]
        return
    before, after = (ran.axes(block) for block in ran.blocks[-3:-1])
    assert [after[axis] - before[axis] for axis in "XYZ"] == pytest.approx([0.0, 0.0, 7.0], abs=1e-9)
    swivel = ran.blocks[-2].swivel
    assert swivel is not None
    assert swivel.end == pytest.approx((5.0, -3.0, 47.0), abs=1e-9)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f"{CHAMFER_1} TURN FMAX", True),
        (f"{CHAMFER_1} STAY\n{CHAMFER_2} STAY", True),
        (f"{CHAMFER_1} TURN FMAX SYM+", False),
        ("PLANE AXIAL A+45 TURN FMAX", False),
        (f"PLANE RESET TURN FMAX\n{CHAMFER_1} TURN FMAX", False),
        (f"L A+0 C+0 FMAX\n{CHAMFER_1} TURN FMAX", False),
        ("PLANE SPATIAL SPA+0 SPB+0 SPC+30 TURN FMAX", False),  # there is one way only
    ],
)
def test_plane_solution_that_depends_on_table_position_is_reported(text: str, told: bool) -> None:
    ran = run(text)
    assert not ran.errors
    assert ("two-ways" in [d.code for d in ran.diagnostics]) is told
