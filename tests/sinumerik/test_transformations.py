"""TRANSMIT, TRACYL, HOLES and the live tool: ways of the slides against polar coordinates, and refusals."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, degrees, hypot, pi, radians, sin

import numpy as np
import pytest

from app.compose.machine.machine_files import load_shipped_machine
from core.interpreter.shared.actions import OutputSwitch, SpindleLock
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset, ZeroOffset
from core.interpreter.sinumerik.sinumerik_interpreter import Interpreter
from core.language.diagnostics import Severity
from core.part.ray_cuts import make_plane_path
from core.proving.prove_program import prove
from tests.sinumerik.lathe import Passed, refused, run, setup, source

LIVE = load_shipped_machine("sinumerik-live")
FACE = "T1 D1\nG0 DIAMOF G17 X40 Z2\nSPOS=0\nTRANSMIT\nG94 F600\n"
SIDE = "T1 D1\nG0 DIAMOF G19 X40 Z0\nSPOS=0\nTRACYL(80)\nG94 F600\n"


def around(radius: float = 0.0, zero: dict[int, ZeroOffset] | None = None) -> InterpreterSetup:
    tools = {1: ToolOffset(nose_radius=radius), 2: ToolOffset(x=5.0, z=3.0)}
    return replace(setup(LIVE, start=(40.0, 50.0, 0.0), zero=zero), tools=tools)


def ways(text: str, radius: float = 0.0) -> list[Block]:
    """The blocks of the plane of a program without errors."""
    passed = run(text, around(radius))
    assert passed.errors == []
    return [block for block in passed.blocks if block.plane is not None]


def slides(block: Block, count: int = 9) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    assert block.plane is not None
    return block.plane.compute_machine_positions(np.linspace(0.0, 1.0, count))


def error(text: str, radius: float = 0.0) -> tuple[str, str]:
    (found,) = run(text, around(radius)).errors
    return found.code, f"{found.message} {found.hint}"


def test_off_center_line_is_converted_to_polar_coordinates() -> None:
    (_, line) = ways(FACE + "G1 X20 Y-15\nY15")
    for (x, z, c), y in zip(slides(line), np.linspace(-15.0, 15.0, 9), strict=True):
        assert (x, z) == pytest.approx((hypot(20.0, y), 2.0))
        # The part turns from X towards Y with C+, so that the tool goes to -C on it.
        assert c == pytest.approx(-degrees(atan2(y, 20.0)))
    assert line.feed == pytest.approx(10.0)


def test_rejected_frame_does_not_change_later_diameters() -> None:
    """TRANS uses radii only in its own block. The lines after its error are still checked with DIAMON."""
    text = FACE.replace("DIAMOF", "DIAMON") + "TRANS X=DC(5)\nG1 X40 Y0"
    program = Interpreter(source(text), around())
    list(program.generate_blocks())
    assert [each.code for each in program.diagnostics if each.severity is Severity.ERROR] == ["16800"]
    assert program.modal_state.diameter


def test_off_center_circle_is_converted_to_polar_coordinates() -> None:
    (_, circle) = ways(FACE + "G1 X30 Y0\nG3 X30 Y0 I-10 J0")
    for (x, _, c), angle in zip(slides(circle), np.linspace(0.0, 2.0 * pi, 9), strict=True):
        px, py = 20.0 + 10.0 * cos(angle), 10.0 * sin(angle)
        assert x == pytest.approx(hypot(px, py))
        assert c == pytest.approx(-degrees(atan2(py, px)), abs=1e-6)
    assert circle.kind is BlockKind.PLANE_ARC


def test_transmit_and_c_positions_meet_on_the_part() -> None:
    """A hole by C-60 and a line that ends at 60 degrees of TRANSMIT meet on the part."""
    (line,) = ways(FACE + f"G1 X={20 * cos(radians(60))!r} Y={20 * sin(radians(60))!r}")
    (x, y, _) = make_plane_path(line.plane)[-1] if line.plane else (0.0, 0.0, 0.0)
    # The part's X points to the negative side of the lathe: a tool on the positive side stands at 180.
    angle = radians(180.0 - -60.0)
    assert (x, y) == pytest.approx((20.0 * cos(angle), 20.0 * sin(angle)))


def test_compensation_follows_a_square() -> None:
    blocks = ways(FACE + "G42 G1 X15 Y0\nY15\nX-15\nY-15\nX15\nY0\nG40 X40", radius=4.0)
    ends = [block.plane.end[:2] for block in blocks if block.plane and block.kind is BlockKind.PLANE_LINE]
    # 19 mm from the axis all round; the first and the last lead to it and off it.
    assert ends == [pytest.approx(each) for each in
                    [(19, 0), (19, 15), (-15, 19), (-19, -15), (15, -19), (19, 0), (40, 0)]]  # fmt: skip
    arcs = [block.plane for block in blocks if block.plane and block.kind is BlockKind.PLANE_ARC]
    assert [each.radius for each in arcs] == pytest.approx([4.0] * 4)
    beside = ways(FACE + "OFFN=0.5\nG42 G1 X15 Y0\nY15\nG40 X40", radius=4.0)
    assert beside[0].plane
    assert beside[0].plane.end[:2] == pytest.approx((19.5, 0.0))


def test_path_through_center_rotates_c_there() -> None:
    passed = run(FACE + "G1 X20 Y0\nX-20", around())
    turned = [block for block in passed.blocks if block.kind is BlockKind.ROTATE]
    assert [(b.x, abs(b.c - b.c0)) for b in turned] == [(0.0, pytest.approx(180.0))]
    assert [each.code for each in passed.found] == ["plane-centre"]
    assert min(float(slides(b)[:, 0].min()) for b in passed.blocks if b.plane) >= 0.0


def test_frames_apply_in_the_plane_and_end_with_trafoof() -> None:
    (line,) = ways(FACE + "TRANS X5 Z-1\nAROT RPL=90\nG1 X10 Y2 Z0")
    assert line.plane
    assert line.plane.end == pytest.approx((3.0, 10.0, -1.0))
    passed = run(FACE + "TRANS X5\nG1 X10\nTRAFOOF\nG1 X10", around())
    assert passed.moves[-1].x == pytest.approx(10.0)  # the shift ends with the transformation


def test_chamfers_roundings_and_tool_change_work_in_plane() -> None:
    blocks = ways(FACE + "G1 X20 Y0\nY20 RND=5\nX-20")
    assert [b.kind for b in blocks] == [
        BlockKind.PLANE_LINE,
        BlockKind.PLANE_LINE,
        BlockKind.PLANE_ARC,
        BlockKind.PLANE_LINE,
    ]
    assert blocks[2].plane
    assert blocks[2].plane.radius == pytest.approx(5.0)
    other = ways(FACE + "G1 X20 Y0\nT2 D1\nX20 Y10")
    # Its tip stands on part zero 5 mm and 3 mm further: the slides are where they were, the tip at X15 Z-1.
    assert other[-1].plane
    assert other[-1].plane.start == pytest.approx((15.0, 0.0, -1.0))
    assert (other[-1].mx, other[-1].mz) == pytest.approx((hypot(20.0, 10.0) + 5.0, 2.0))


def test_unrolled_side_is_converted_to_c_and_z() -> None:
    line, arc = ways(SIDE + "G1 X38 Y10 Z-20\nG3 Y20 Z-30 CR=10")
    for (x, z, c), share in zip(slides(line, 3), (0.0, 0.5, 1.0), strict=True):
        # 10 mm round a part of 80 mm are 10 · 360 / (80 pi) degrees.
        assert (x, z) == pytest.approx((40.0 - 2.0 * share, -20.0 * share))
        assert c == pytest.approx(-share * 10.0 * 360.0 / (80.0 * pi))
    middle = slides(arc, 3)[1]
    y = middle[2] * -80.0 * pi / 360.0
    # Counter-clockwise, Y to the right and Z up: about Y20 Z-20.
    assert (y, middle[1]) == pytest.approx((20 - 10 * cos(pi / 4), -20 - 10 * sin(pi / 4)))


def test_hole_patterns_are_drilled_in_circle_and_row() -> None:
    text = FACE + "MCALL CYCLE81(5,0,2,-3)\n{}\nMCALL\nTRAFOOF"
    blocks = ways(text.format("HOLES2(0,0,15,30,0,3)"))
    bottoms = [b.plane.end for b in blocks if b.plane and b.plane.end[2] == pytest.approx(-3.0)]
    expected = [(15 * cos(radians(a)), 15 * sin(radians(a)), -3.0) for a in (30, 150, 270)]
    assert bottoms == [pytest.approx(each) for each in expected]
    blocks = ways(text.format("HOLES1(10,0,90,-5,10,2)"))
    bottoms = [b.plane.end for b in blocks if b.plane and b.plane.end[2] == pytest.approx(-3.0)]
    assert bottoms == [pytest.approx((10, -5, -3)), pytest.approx((10, 5, -3))]
    assert [b.rapid for b in blocks if b.plane and b.plane.end[2] == pytest.approx(-3.0)] == [False, False]


def test_the_live_tool_is_spindle_2() -> None:
    passed = run("SETMS(2)\nS500 M3\nG95 F0.1\nG17 DIAMOF\nTRANSMIT\nG1 X20\nM5\nSETMS(1)", around())
    assert passed.errors == []
    switched = [b.action for b in passed.blocks if isinstance(b.action, OutputSwitch)]
    assert switched == [OutputSwitch("live", True), OutputSwitch("live", False)]
    (line,) = [b for b in passed.blocks if b.plane]
    assert (line.feed, line.per_rev) == (pytest.approx(0.1 * 500 / 60), False)
    assert any(isinstance(b.action, SpindleLock) for b in passed.blocks)  # TRANSMIT holds the spindle as C
    assert run("S2=800 M2=3\nM2=5", around()).errors == []


@pytest.mark.parametrize(
    ("text", "code", "part"),
    [
        ("S400 M3\nTRANSMIT", "transformation", "M5"),
        ("TRANSMIT(2)", "14401", "data set"),
        ("TRACYL", "14401", "TRACYL(40)"),
        ("TRACYL(0)", "14401", "TRACYL(40)"),
        ("TRANSMIT X3", "own-block", "separate block"),
        (FACE + "G0 C90", "transformation", "TRAFOOF"),
        (FACE + "G18 G2 X20 Y0 CR=40", "arc-plane", "G17"),
        (FACE + "G18 G41 X20", "comp-plane", "G17"),
        (FACE + "G42 G1 X15 Y0\nY15\nTRAFOOF", "14400", "G40"),
        (FACE + "G1 K3 X3", "word-unused", "K3"),
        (FACE + "G33 Z-3 K1", "transformation", "TRAFOOF"),
        (FACE + "SUPA G0 X3", "transformation", "TRAFOOF"),
        (FACE + "CYCLE97(1,,0,-9,20,20,2,1,.6,0,0,,2,0,1)", "transformation", "TRAFOOF"),
        (FACE + "G1 X20\nG3 X0 Y0 CR=2", "arc-radius", "CR"),
        ("G0 Y3", "not-in-subset", "no Y axis"),
        ("G1 X3 F1 OFFN=1", "word-unused", "TRANSMIT"),
        (SIDE + "OFFN=2", "not-in-subset", "groove"),
        ("HOLES1(0,0,0,0,5,3)", "pattern-cycle", "MCALL"),
        ("S2=100 M2=4", "live-direction", "only one direction"),
        ("M2=3", "speed-missing", "S2="),
        ("SPOS[3]=0", "one-spindle", "spindle 1"),
    ],
)
def test_invalid_transformations_are_rejected(text: str, code: str, part: str) -> None:
    found, said = error(text)
    assert found == code
    assert part in said


def test_transformation_is_rejected_without_c_or_live_tool() -> None:
    still = replace(around(), limits=replace(around().limits, is_c_enabled=False))
    assert refused("TRANSMIT", still).code == "14401"
    assert refused(
        "S2=100 M2=3", replace(around(), limits=replace(around().limits, live_tool_output=""))
    ).code == ("one-spindle")
    shifted = around(zero={54: ZeroOffset(x=2.0)})
    assert "X0" in run("G54\nTRANSMIT", shifted).errors[0].message


def test_transmit_program_is_proved_as_milling() -> None:
    text = (
        "T1 D1\nG0 DIAMOF G17 X40 Z2\nSPOS=0\nS2=2000 M2=3\nTRANSMIT\nG1 X25 Y-12 Z-2 F300\nX10\nG0 Z5\n"
        "TRAFOOF\nM2=5\nM30"
    )
    report = prove(source(text), around(2.0), LIVE)
    assert [each for each in report.diagnostics if each.severity is Severity.ERROR] == []
    stopped = prove(source(text.replace("S2=2000 M2=3\n", "").replace("M2=5\n", "")), around(2.0), LIVE)
    assert "TRANSMIT" not in str(stopped.diagnostics)
    passed: Passed = run(text, around(2.0))
    assert passed.blocks[-1].modal.mill is None
