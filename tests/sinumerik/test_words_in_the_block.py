"""Arcs by a point, tangents, polar places, angles, frames, feeds, stops, M functions: all by hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, hypot, radians, sin, sqrt

import pytest

from app.compose.machine.machine_files import load_machine
from core.interpreter.shared.actions import Dwell, OutputSwitch, SpindleLock
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.diagnostics import Severity
from tests.sinumerik.lathe import good, refused, run, setup

GT75 = load_machine()
"""Its spindle is C."""


def ends(blocks: Sequence[Block]) -> list[tuple[float, float]]:
    return [(round(block.mx, 6), round(block.mz, 6)) for block in blocks]


# --- arcs


@pytest.mark.parametrize(
    "text",
    [
        "G1 X20 Z0 F200\nCIP X40 Z-10 I1=34.1421356 K1=-2.9289322",
        "DIAMOF G1 X10 Z0 F200\nCIP X20 Z-10 I1=17.0710678 K1=-2.9289322",
        "G1 X20 Z0 F200\nG91 CIP X20 Z-10 I1=14.1421356 K1=-2.9289322",
    ],
)
def test_cip_passes_through_its_intermediate_point(text: str) -> None:
    """A quarter of radius 10 about X20 Z-10; half way it is 10 sin 45 and 10 cos 45 from there."""
    arc = good(text)[1]
    assert (arc.cx, arc.cz) == pytest.approx((10.0, -10.0), abs=1e-6)
    by_centre = good("G1 X20 Z0 F200\nG3 X40 Z-10 I0 K-10")[1]
    assert arc.clockwise == by_centre.clockwise


def test_ct_continues_tangentially_from_a_line() -> None:
    """Along Z- and then 5 out and 5 on: a quarter about X30 Z-10, with its radius of 5."""
    arc = good("G1 X20 Z0 F200\nZ-10\nCT X30 Z-15")[2]
    assert (arc.cx, arc.cz) == pytest.approx((15.0, -10.0))
    assert arc.length == pytest.approx(5.0 * 3.141592653589793 / 2)


def test_ct_continues_tangentially_from_an_arc() -> None:
    """A quarter from Z- to X+, then on to X+: the tangent at its end is square to the axis."""
    arc = good("G1 X20 Z0 F200\nZ-10\nCT X30 Z-15\nCT X40 Z-20")[3]
    assert (arc.cx, arc.cz) == pytest.approx((15.0, -20.0))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("N30 CIP X40 Z-10", "arc-centre-missing"),
        ("N30 CIP X40 Z-10 I1=30 K1=-5", "arc-radius"),
        ("N30 CIP X40 Z-10 CR=20", "word-unused"),
        ("N30 CT X20 Z-20", "arc-radius"),
        ("N30 CT X40 Z-20 CR=3", "word-unused"),
        ("N30 G2 X40 Z-20 CR=30 I1=3", "word-unused"),
        ("G17\nN30 CIP X40 Z-10 I1=30 K1=-4", "arc-plane"),
    ],
)
def test_invalid_cip_and_ct_arcs_are_rejected(text: str, code: str) -> None:
    assert refused(f"G1 X20 Z5 F200\nZ0\n{text}").code == code


def test_ct_requires_a_preceding_path() -> None:
    assert refused("N30 CT X40 Z-20 F100").code == "arc-centre-missing"


# --- places


def test_polar_positions_are_relative_to_the_pole() -> None:
    moves = good("G111 X20 Z-30\nG0 RP=10 AP=90\nG1 AP=IC(-60) F100\nRP=4")
    a, b = radians(30.0), 4.0
    expected = [(20.0, -30.0), (10.0 + 10.0 * sin(a), -30.0 + 10.0 * cos(a))]
    expected.append((10.0 + b * sin(a), -30.0 + b * cos(a)))
    assert ends(moves) == [pytest.approx(each, abs=1e-6) for each in expected]


def test_pole_is_relative_to_current_position_or_last_pole() -> None:
    assert ends(good("G0 X30 Z10\nG110 X10 Z-4\nG112 X2 Z1\nG0 RP=0 AP=0"))[1] == (21.0, 7.0)


def test_arc_ends_at_a_polar_position() -> None:
    arc = good("G111 X0 Z0\nG1 RP=10 AP=0 F100\nG3 AP=90 CR=10")[1]
    assert (arc.mx, arc.mz) == pytest.approx((10.0, 0.0), abs=1e-9)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("N30 G0 RP=10", "polar-half"),
        ("N30 G0 RP=10 AP=3 X4", "polar-both"),
        ("N30 G0 RP=-1 AP=3", "not-positive"),
        ("N30 G111 X=IC(3)", "offset-form"),
        ("N30 G111 C3", "own-block"),
        ("N30 G1 ANG=30 F100", "not-in-subset"),
        ("N30 G1 ANG=30 X4 Z5 F100", "angle-both"),
        ("N30 G1 ANG=90 Z5 F100", "angle-none"),
        ("N30 G1 ANG=0 X30 F100", "angle-none"),
        ("N30 G2 ANG=40 X30 CR=10 F100", "word-unused"),
    ],
)
def test_invalid_polar_positions_are_rejected(text: str, code: str) -> None:
    assert refused(text).code == code


def test_line_is_defined_by_its_angle() -> None:
    """150 degrees from Z towards X, 10 out: 10 / tan 30° back."""
    assert ends(good("G0 X20 Z0\nG1 X40 ANG=150 F100"))[1] == pytest.approx(
        (20.0, -10.0 * sqrt(3.0)), abs=1e-6
    )
    assert ends(good("G0 X20 Z0\nG1 Z-10 ANG=135 F100"))[1] == pytest.approx((20.0, -10.0), abs=1e-6)


def test_diam90_interprets_distances_as_radii() -> None:
    assert ends(good("DIAM90 G0 X20 Z0\nG91 X4\nG90 X=IC(-2)")) == [(10.0, 0.0), (14.0, 0.0), (12.0, 0.0)]
    assert ends(good("DIAMON G0 X20 Z0\nG91 X4")) == [(10.0, 0.0), (12.0, 0.0)]


def test_g74_homes_the_named_axes() -> None:
    assert ends(good("G0 X20 Z5\nG74 Z1=0\nG0 X30\nG74 X1=0 Z1=0"))[1::2] == [(10.0, 0.0), (0.0, 0.0)]


@pytest.mark.parametrize("text", ["G74", "G74 X1=5", "G74 X1=0 C0", "G74 X1=0 F100"])
def test_invalid_g74_blocks_are_rejected(text: str) -> None:
    assert refused(f"G0 X20 Z5\nN30 {text}").code in {"own-block", "word-unused"}


# --- fixed points: X299 (radius) and Z799 of the machine, no offset counts


def test_g75_moves_named_axes_to_fixed_point() -> None:
    moves = good("TRANS X3 Z-20\nG0 X20 Z5\nG75 Z1=0\nG1 X30 F200\nG75 X0 Z0")
    ends_of_machine = [(block.mx, block.mz) for block in moves]
    assert ends_of_machine == [(13.0, -15.0), (13.0, 799.0), (18.0, 799.0), (299.0, 799.0)]
    assert [block.kind for block in moves] == [
        BlockKind.RAPID,
        BlockKind.RAPID,
        BlockKind.FEED,
        BlockKind.RAPID,
    ]


def test_g75_leaves_g1_in_force_and_accepts_g0_in_its_block() -> None:
    assert [block.kind for block in good("G1 X20 Z5 F200\nG75 X0\nX20")] == [
        BlockKind.FEED,
        BlockKind.RAPID,
        BlockKind.FEED,
    ]
    assert (good("G0 G75 X0 Z0")[-1].mx, good("R1=1\nG75 X1=0 FP=R1")[-1].mx) == (299.0, 299.0)


def test_fp_selects_the_fixed_point() -> None:
    around = setup()
    points = {"X": (299.0, 40.0), "Z": (799.0, 70.0)}
    around = replace(around, limits=replace(around.limits, fixed_points=points))
    last = good("G0 X20 Z5\nG75 X0 Z0 FP=2", around)[-1]
    assert (last.mx, last.mz) == (40.0, 70.0)
    assert refused("N30 G75 X0 FP=3", around).message.endswith(
        "defines 2 fixed points for X, but number 3 is programmed."
    )


def test_g75_without_fixed_points_is_rejected_with_the_missing_key() -> None:
    around = setup()
    around = replace(around, limits=replace(around.limits, fixed_points={}))
    error = refused("N30 G75 X1=0", around)
    assert error.code == "fixed-point"
    assert "fixed_points under [axis.X]" in error.hint


def test_axis_value_in_g75_is_reported_and_ignored() -> None:
    ran = run("G0 X20 Z5\nG75 X150")
    assert [found.code for found in ran.found] == ["fixed-point-value"]
    assert ran.errors == []
    assert ran.moves[-1].mx == 299.0


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G75", "own-block"),
        ("G75 FP=1", "own-block"),
        ("G75 X0 F100", "own-block"),
        ("G75 X0 C0", "own-block"),
        ("G75 X0 M8", "own-block"),
        ("G75 X0 R1=3", "own-block"),
        ("G75 X0 G90", "own-block"),
        ("G75 X0 FP=5", "12080"),
        ("R1=5\nG75 X0 FP=R1", "out-of-range"),
        ("R1=1.5\nG75 X0 FP=R1", "fixed-point"),
        ("G75 X0 FP=2", "fixed-point"),
        ("G0 X0 FP=1", "word-unused"),
        ("G74 X0 FP=1", "own-block"),
        ("G75 G74 X0", "12060"),
        ("T1 D1\nG42 G1 X20 Z0 F200\nZ-5\nG75 X0", "comp-with"),
        ("T1 D1\nG42 G1 X20 Z0 F200\nZ-5\nG74 X0", "comp-with"),
    ],
)
def test_invalid_g75_blocks_are_rejected(text: str, code: str) -> None:
    around = replace(setup(), tools={1: ToolOffset(nose_radius=0.4, quadrant=3)})
    assert refused(f"G0 X20 Z5\n{text}", around).code == code


# --- frames


def test_mirror_scale_and_rot_transform_positions() -> None:
    assert ends(good("TRANS Z-50\nAMIRROR Z0\nG0 X20 Z5")) == [(10.0, -55.0)]
    assert ends(good("SCALE X2 Z3\nG0 X20 Z5")) == [(20.0, 15.0)]
    a = radians(30.0)
    turned = (10.0 * cos(a) + 5.0 * sin(a), -10.0 * sin(a) + 5.0 * cos(a))
    assert ends(good("ROT RPL=30\nG0 X20 Z5")) == [pytest.approx(turned, abs=1e-6)]
    assert ends(good("ROT RPL=30\nAROT RPL=-30\nG0 X20 Z5")) == [(10.0, 5.0)]
    assert ends(good("SCALE Z3\nTRANS Z1\nG0 X20 Z5")) == [(10.0, 6.0)]


def test_arc_follows_mirrored_and_scaled_frame() -> None:
    """Twice as large and the other way round; its centre goes along."""
    arc = good("SCALE X2 Z2\nAMIRROR Z0\nG1 X20 Z0 F100\nG3 X30 Z-5 CR=5")[1]
    plain = good("G1 X20 Z0 F100\nG3 X30 Z-5 CR=5")[1]
    assert (arc.mx, arc.mz) == pytest.approx((30.0, 10.0))
    assert (arc.cx, arc.cz) == pytest.approx((2.0 * plain.cx, -2.0 * plain.cz))
    assert arc.clockwise is not plain.clockwise
    by_centre = good("SCALE X2 Z2\nAMIRROR Z0\nG1 X20 Z0 F100\nG3 X30 Z-5 I0 K-5")[1]
    assert (by_centre.cx, by_centre.cz) == pytest.approx((arc.cx, arc.cz))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("N30 ROT X30", "offset-form"),
        ("N30 TRANS X3 RPL=3", "word-unused"),
        ("N30 SCALE X0", "offset-form"),
        ("N30 SCALE X-1", "offset-form"),
        ("N30 MIRROR Z0 G1", "own-block"),
        ("SCALE X2\nG1 X20 Z0 F100\nN30 G3 X30 Z-5 CR=5", "arc-scaled"),
        ("N30 TRANS X1 ROT RPL=3", "12060"),
    ],
)
def test_invalid_frames_are_rejected(text: str, code: str) -> None:
    assert refused(text).code == code


def test_working_area_limits_moves() -> None:
    assert good("G25 X-10 Z-100\nG26 X200 Z50\nG0 X100 Z20")
    assert refused("G25 Z-100\nN30 G0 X20 Z-101").code == "working-area"
    assert refused("G26 X100\nN30 G0 X101").code == "working-area"
    assert good("G26 X100\nWALIMOF G0 X101")


# --- feeds, stops, corners


def test_block_feed_and_override_scale_the_feed() -> None:
    feeds = [block.feed * 60.0 for block in good("G1 X20 F200\nZ-5 FB=50\nX30\nOVR=50 Z-10\nOVR=100 X40")]
    assert feeds == pytest.approx([200.0, 50.0, 200.0, 100.0, 200.0])


def test_g700_interprets_f_in_inches() -> None:
    block = good("G700 G1 X2 F10")[0]
    assert (block.mx, block.feed * 60.0) == pytest.approx((25.4, 254.0))
    assert good("G70 G1 X2 F10")[0].feed * 60.0 == pytest.approx(10.0)


def test_rndm_rounds_every_corner_until_it_is_canceled() -> None:
    kinds = [b.kind for b in good("G0 X20 Z5\nRNDM=2 G1 Z-10 F200\nX40\nZ-20\nRNDM=0 X60\nZ-30\nG0 X80")]
    assert kinds.count(BlockKind.ARC) == 3


def test_rndm_rounds_no_corner_before_a_rapid() -> None:
    assert [b.kind for b in good("G1 RNDM=2 Z-10 F200\nG0 X90")] == [BlockKind.FEED, BlockKind.RAPID]


def test_frc_is_the_feed_of_one_corner_only() -> None:
    feeds = [round(b.feed * 60.0, 6) for b in good("G1 X20 Z0 F200\nX40 CHF=2 FRC=80\nZ-10\nX60 CHF=2\nZ-20")]
    assert feeds == [200.0, 200.0, 80.0, 200.0, 200.0, 200.0, 200.0]
    feeds = [round(b.feed * 60.0, 6) for b in good("FRCM=60 G1 X20 Z0 F200\nX40 RND=2\nZ-10")]
    assert feeds == [200.0, 200.0, 60.0, 200.0]


def test_exact_stop_adds_a_dwell() -> None:
    stops = [
        isinstance(b.action, Dwell) for b in run("G1 X20 F200\nG9 Z-5\nX30\nG60 Z-9\nX40\nG64 Z-12").blocks
    ]
    assert stops == [False, False, True, False, False, True, False, True, False]


def test_word_without_effect_is_reported_only_once() -> None:
    found = run("SOFT\nG641 ADIS=0.3 G0 X10\nSOFT G0 X20\nM41\nM41").found
    assert [(each.code, each.severity, each.line) for each in found] == [
        ("no-effect", Severity.NOTE, 1),
        ("no-effect", Severity.NOTE, 2),
        ("no-effect", Severity.NOTE, 4),
    ]


# --- the spindle


def rpm(text: str) -> float:
    return run(text + "\nG0 X30").blocks[-1].rpm


def test_spindle_speed_limits_apply() -> None:
    assert rpm("G26 S1000\nS2000 M3") == pytest.approx(1000.0)
    assert rpm("G25 S300\nS200 M4") == pytest.approx(-300.0)
    assert rpm("G0 X5\nG26 S900\nG96 S150 LIMS=2000 M3\nG0 X5") == pytest.approx(900.0)
    assert refused("G26 S500\nN30 G25 S600").code == "speed-limits"


@pytest.mark.parametrize("text", ["M1=3 S1=800", "S=800 M3", "SETMS(1)\nS800 M3", "SETMS\nS800 M3"])
def test_single_spindle_can_be_addressed_by_its_number(text: str) -> None:
    assert rpm(text) == pytest.approx(800.0)


@pytest.mark.parametrize("text", ["M2=3", "S2=100", "SETMS(2)", "SPOS[2]=90", "LIMS[3]=100"])
def test_other_spindle_numbers_are_rejected(text: str) -> None:
    error = refused(f"N30 {text}")
    assert error.code == "one-spindle"
    assert "one spindle" in error.message


def of_gt75() -> InterpreterSetup:
    return replace(setup(GT75), start=(10.0, 50.0, 0.0))


@pytest.mark.parametrize(
    ("text", "turn"),
    [
        ("SPOS=90", 90.0), ("SPOS=270", -90.0), ("SPOS=ACP(270)", 270.0), ("SPOS[1]=ACN(90)", -270.0),
        ("M19", 0.0), ("SPOSA=DC(10)", 10.0), ("SPOS=IC(720)", 720.0),
    ],
)  # fmt: skip
def test_the_spindle_stops_at_an_angle(text: str, turn: float) -> None:
    blocks = run(f"S500 M3\n{text}", of_gt75()).blocks
    assert isinstance(blocks[1].action, SpindleLock)
    assert sum(block.c - block.c0 for block in blocks) == pytest.approx(turn)
    assert not blocks[-1].modal.spindle


def test_m70_switches_to_axis_mode_and_m3_back_to_spindle_mode() -> None:
    blocks = run("M70\nG0 C90\nS500 M3\nG0 X30", of_gt75()).blocks
    assert isinstance(blocks[0].action, SpindleLock)
    assert blocks[-1].rpm == pytest.approx(500.0)
    assert not blocks[-1].modal.c_locked


# --- M functions of the machine file


def with_outputs() -> InterpreterSetup:
    limits = replace(setup().limits, m_code_outputs={25: ("steady", True), 26: ("steady", False)})
    return replace(setup(), limits=replace(limits, disabled_m_codes=frozenset({27})))


def test_m_functions_from_machine_file_switch_outputs() -> None:
    blocks = run("M25 G0 X30\nG0 X40 M26", with_outputs()).blocks
    assert [each.action or each.kind for each in blocks] == [
        OutputSwitch("steady", True), BlockKind.RAPID, BlockKind.RAPID, OutputSwitch("steady", False),
    ]  # fmt: skip


def test_other_m_functions_are_refused_with_the_remedy() -> None:
    assert refused("N30 M27", with_outputs()).code == "m-disabled"
    error = refused("N30 M99", with_outputs())
    assert error.code == "m-unknown"
    assert "M17" in error.hint


# --- threads


def test_block_after_g33_uses_the_same_lead() -> None:
    thread, out = [
        block
        for block in good("S400 M3\nG0 X18 Z8\nG33 Z-20 K2\nX24 Z-22\nG0 X30")
        if block.kind is BlockKind.THREAD
    ]
    assert (thread.feed, thread.per_rev, out.feed) == (2.0, True, 2.0)


def test_lead_along_x_of_steep_thread_is_converted() -> None:
    """2 mm a revolution along X over 10, of 5 along Z: 1 mm along Z."""
    thread = good("S400 M3\nG0 X18 Z8\nG33 X38 Z3 I2\nG0 X60")[1]
    assert thread.feed == pytest.approx(1.0)
    assert hypot(thread.x - thread.x0, thread.z - thread.z0) == pytest.approx(sqrt(125.0))


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G33 X10 K1", "thread-length"),
        ("G33 Z-5 I1", "thread-lead-missing"),
        ("G33 Z-5 X30 I1 K1", "thread-lead-both"),
        ("G33 Z-5 K0", "not-positive"),
        ("G33 Z-5 K1 C90", "thread-length"),
        ("G33 Z-5 K60", "feed-over-speed"),
        ("G33 Z-5 K1 CR=3", "word-unused"),
        ("G96 S100\nN30 G33 Z-5 K1", "thread-under-css"),
        ("G33 Z-5 K1\nN30 Z-3 K1", "thread-chain"),
        ("G33 Z-5 K1\nX30 Z-6\nN30 Z-9", "thread-chain"),
        ("G34 Z-5 K1", "thread-lead-missing"),
        ("G35 Z-20 K1 F0.1", "thread-lead-missing"),  # 1²/0.2 = 5 mm far
        ("G33 Z-5 K1\nN30 Z-9 SF=90", "word-unused"),
    ],
)
def test_invalid_threads_are_rejected(text: str, code: str) -> None:
    assert refused(f"S400 M3\nG0 X18 Z8\n{text}").code == code
