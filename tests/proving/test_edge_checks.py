"""Edges and spindle: each check by a program that triggers it and a near twin, in four ways of writing."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.part.stock import Clamping, Stock, make_bar_stock, make_tube_stock
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.proof_report import PartReport
from tests.proving.test_part_proof import WAYS, text
from tests.texts import text as text_of

# 55° in a holder of 93°: the back of the insert rises at 180 - 93 - 55 = 32°.
RIGHT = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.4, insert="DCMT11T304")
LEFT = ToolShape(ToolKind.TURNING, ToolHand.LEFT, tip=4, nose_radius=0.4, insert="DCMT11T304")
BORER = ToolShape(ToolKind.BORING, tip=2, nose_radius=0.4, insert="DCMT070204", diameter=8.0, stick_out=40.0)
BLADE = ToolShape(ToolKind.PARTING, tip=3, width=2.0, stick_out=30.0)
DRILL = ToolShape(ToolKind.DRILL, diameter=6.0, point=118.0, length=60.0)
LEFT_DRILL = ToolShape(ToolKind.DRILL, ToolHand.LEFT, diameter=6.0, point=118.0, length=60.0)
REAR_TOOL = ToolShape(ToolKind.GROOVING, tip=2, width=2.0, stick_out=30.0, rear=True)
V = ToolShape(ToolKind.THREADING, tip=8, point=60.0)
MILL = ToolShape(ToolKind.END_MILL, tip=7, diameter=6.35)
SHAPES = {9: MILL, 7: REAR_TOOL, 8: V, 1: RIGHT, 2: BLADE, 3: DRILL, 4: BORER, 5: LEFT, 6: LEFT_DRILL}
ROD = make_bar_stock(25.4, 0.0, -60.0)
PIPE = make_tube_stock(38.1, 20.0, 0.0, -60.0)


def part_of(
    program: str,
    stock: Stock = ROD,
    shapes: dict[int, ToolShape] = SHAPES,
    clamping: Clamping | None = None,
    gang: dict[int, tuple[float, float]] | None = None,
) -> PartReport:
    machine = load_machine(None)
    tools = {n: ToolOffset(-12.7, -50.8) for n in range(1, 12)}
    setup = create_power_up_setup(machine, tool_offsets=tools, secondary_offsets={})
    setting = PartSettings(stock, shapes, clamping=clamping, gang=gang or {})
    _, part = prove_program_and_part(ProgramSource("P", program), setup, machine, setting)
    assert part is not None
    return part


def found(program: str, stock: Stock = ROD) -> list[tuple[str, int]]:
    return [(each.check_name, each.line) for each in part_of(program, stock).findings]


SLOPE = "T1\nX[.6]Z[-.3]\nG95F[.004]X[.5]\nX[.4]Z[{z}]\nZ[-.7]\nX[.6]\nG94F[300]Z[1]"
BACK = "T{t}\nX[.6]Z[-.6]\nG95F[.004]X[.4]Z[-.9]\nZ[-.5]\nX[.6]\nG94F[300]Z[1]"
ONCE = "T1\nX[.6]Z[.05]\nX[.4]\nG95F[.004]Z[-.3]\nX[.6]\nG94F[300]Z[.05]\n"
BACKWARDS = ONCE + "X[.35]\nG95F[.004]Z[{z}]\nX[.6]"
BOTH = ONCE + "X[.35]\nM05\n{m}S900\nG95F[.004]Z[-.3]\nX[.6]"
HOLE = "M05\n{m}S900\nT{t}\nX[0]Z[.1]\nG95F[{f}]Z[-.3]\nG94F[300]Z[.1]"

REAR = "M05\nM04S900\nT7\nX[-.6]Z[-.4]\nG95F[.004]X[-.4]\nX[{x}]"
SHAFT = "T1\nX[.6]Z[.05]\nX[.4]\nG95F[.004]Z[{z}]\nX[.6]\nG94F[300]Z[.1]\n"
SHAFT += "T2\nZ[-.9]X[.6]\nG95F[.002]X[{r}]\nG94F[300]X[.6]"
GROOVE = "T2\nX[.6]Z[{z}]\nG95F[.004]X[.4]\nG94F[300]X[.6]"
THREAD = "M05\nM03S600\nT8\nX[.24]Z[.2]\nG34Z[{z}]I[.01]K[.05]\nX[.4]"
FACE_MILL = "T9\nX[-.3]Z[.1]\nM05\nM19S60\nG04F3\nM27\nG94F[20]\nZ[{z}]\n"
FACE_MILL += "(~PLXC)\n(X[.2]Y0)\n(X[-.2]Y0)\n(END)\nM28\nM05"
LONG = make_bar_stock(25.4, 0.0, -80.0)
PASS = "T1\nX[.6]Z[.05]\nX[{r}]\nG95F[{f}]Z[-.5]\nX[.6]\nG94F[300]Z[1]"
BLADE_TURNS = "T2\nX[.6]Z[-.3]\nG95F[.002]X[{r}]\nZ[-.5]\nX[.6]"
FACE = "T1\nX[.6]Z[.1]\nZ[{z}]\nG95F[.004]X[-.02]\nG94F[300]Z[1]"
BORE = "T4\nX[.38]Z[.1]\nX[{r}]\nG95F[.004]Z[-.4]\nX[.38]\nG94F[300]Z[1]"
FILLET = "T1\nX[.6]Z[.05]\nX[.4]\nG95F[.004]Z[-.6]\nG03X[.425]Z[-.625]R[.025]\nX[.6]\nG94F[300]Z[1]\n"
TWICE = "T3\nX[0]Z[.1]\nG95F[.004]Z[-.3]\nG94F[300]Z[.1]\nG95F[.004]\nZ[{z}]\nG94F[300]Z[1]"

CASES = {
    # .1 in deep on .1 of Z is 45°, on .25 it is 22°
    "wrong-side": (SLOPE.format(z="-.4"), SLOPE.format(z="-.55"), ROD, 6),
    # turned towards the face with the back of a right-hand insert
    "wrong-side, backwards": (
        BACK.format(t=1),
        BACK.format(t=5),
        ROD,
        6,
    ),
    "wrong-spindle-direction of one edge": (
        BOTH.format(m="M04"),
        BOTH.format(m="M03"),
        ROD,
        12,
    ),
    "wrong-spindle-direction of a left-hand drill": (
        HOLE.format(m="M03", t=6, f=".004"),
        HOLE.format(m="M04", t=6, f=".004"),
        ROD,
        7,
    ),
    # 6 mm: .04 of it is .0094 in
    "chip-load of a drill": (
        HOLE.format(m="M03", t=3, f=".01"),
        HOLE.format(m="M03", t=3, f=".009"),
        ROD,
        7,
    ),
    # 2 mm wide: .12 of it is .0094 in
    "chip-load of a blade": (
        "T2\nX[.6]Z[-.5]\nG95F[.01]X[.4]\nX[.6]",
        "T2\nX[.6]Z[-.5]\nG95F[.009]X[.4]\nX[.6]",
        ROD,
        5,
    ),
    # 1500 rpm: 20 in/min are .0133 in a turn, .8 of the nose is .0126
    "chip-load by time": (
        "T1\nX[.6]Z[.05]\nX[.4]\nF[20]Z[-.5]\nX[.6]",
        "T1\nX[.6]Z[.05]\nX[.4]\nF[18]Z[-.5]\nX[.6]",
        ROD,
        6,
    ),
    # twice a nose of 0.4 mm is .0315 in a revolution
    "feed-breaks-tool": (PASS.format(r=".4", f=".032"), PASS.format(r=".4", f=".012"), ROD, 6),
    # DCMT11T304: edge 11.6 mm, less the nose .4; .3 of it is 3.37 mm or .1325 in, .5 is .221 in
    "depth-of-cut": (PASS.format(r=".36", f=".004"), PASS.format(r=".38", f=".004"), ROD, 6),
    # .23 in are 5.84 mm, over half of 11.2 mm
    "depth-breaks-tool": (PASS.format(r=".27", f=".004"), PASS.format(r=".38", f=".004"), ROD, 6),
    # a face .14 in deep, and one of .09
    # 300 ft/min on the axis is any speed; G77 limits it
    "drill-without-limit": (
        "G96S300\n" + HOLE.format(m="M03", t=3, f=".004").replace("S900", ""),
        "G96S300\nG77S2000\n" + HOLE.format(m="M03", t=3, f=".004").replace("S900", ""),
        ROD,
        8,
    ),
    "depth-of-cut of a face": (FACE.format(z="-.14"), FACE.format(z="-.09"), ROD, 6),
    # DCMT070204: .3 of 7.75 - .4 is 2.2 mm; from r 10 to .49 in are 2.45 mm, to .47 in 1.94 mm
    "depth-of-cut in a bore": (BORE.format(r=".49"), BORE.format(r=".47"), PIPE, 6),
    # a parting blade takes .01 in along Z, a chamfer at 45 degrees is none of it
    "blade-turns": (
        BLADE_TURNS.format(r=".48"),
        BLADE_TURNS.format(r=".492"),
        ROD,
        6,
    ),
    "rubs-surface": (
        PASS.format(r=".4", f=".004").replace("X[.6]\nG94F[300]Z[1]", "G94F[300]Z[.1]\nX[.6]"),
        PASS.format(r=".4", f=".004"),
        ROD,
        7,
    ),
    # the arc begins .02 in past the part-off, or .2 before it
    "contour-past-part-off": (
        FILLET + "T2\nZ[-.58]X[.6]\nG95F[.002]X[-.01]\nG94F[300]X[.6]",
        FILLET + "T2\nZ[-.8]X[.6]\nG95F[.002]X[-.01]\nG94F[300]X[.6]",
        LONG,
        7,
    ),
    "over-axis along Z": (PASS.format(r="-.03", f=".004"), PASS.format(r=".38", f=".004"), ROD, 6),
    "unmade-cut of a drill": (
        TWICE.format(z="-.29"),
        TWICE.format(z="-.4"),
        ROD,
        8,
    ),
    # lost minus behind a turned diameter: X.55 for X-.55
    "over-axis": (REAR.format(x=".55"), REAR.format(x="-.55"), ROD, 8),
    # parted off at .9, turned to 3 for .3
    "past-part-off": (SHAFT.format(z="-2.2", r="-.01"), SHAFT.format(z="-.92", r="-.01"), LONG, 6),
    "part-off-left": (SHAFT.format(z="-.92", r=".01"), SHAFT.format(z="-.92", r="-.01"), LONG, 11),
    # what goes in between two rapids and meets nothing
    "unmade-cut, a groove before the face": (GROOVE.format(z=".5"), GROOVE.format(z="-.5"), ROD, 5),
    "unmade-cut, a rapid in and out": (
        "T1\nX[.6]Z[.05]\nX[.51]\nZ[-.5]\nX[.6]\nZ[.05]\nX[.4]\nG95F[.004]Z[-.3]\nX[.6]",
        "T1\nX[.6]Z[.05]\nX[.51]\nZ[-.5]\nM00\nX[.6]\nZ[.05]\nX[.4]\nG95F[.004]Z[-.3]\nX[.6]",
        ROD,
        6,
    ),
    "unmade-cut, a thread": (
        THREAD.format(z=".5"),
        THREAD.format(z="-.5"),
        make_bar_stock(12.7, 0.0, -60.0),
        7,
    ),
    # the face itself is where a tool is set to, and may be gone along
    "unmade-cut of a live tool": (FACE_MILL.format(z=".005"), FACE_MILL.format(z="0"), ROD, 10),
    "unmade-cut, out of the part": (BACKWARDS.format(z=".4"), BACKWARDS.format(z="-.3"), ROD, 10),
    "unmade-cut, never fed": (
        "T2\nX[.6]Z[.05]\nX[.51]Z[-.2]\nX[.6]",
        "T2\nX[.6]Z[.05]\nX[.51]Z[-.2]\nG95F[.004]X[.45]\nX[.6]",
        ROD,
        5,
    ),
    # .4 in at 8 in/min is 3 s each, and 20 s are the seventh of them
    "cuts-air in many moves": (
        "T1\nX[.6]Z[.05]\nX[.4]\nG95F[.004]Z[-.3]\nX[.6]\nG94F[300]Z[1]\nF[8]\n" + "X[.2]\nX[.6]\n" * 4,
        "T1\nX[.6]Z[.05]\nX[.4]\nG95F[.004]Z[-.3]\nX[.6]\nG94F[300]Z[1]\nF[8]\n" + "X[.2]\nX[.6]\n" * 3,
        ROD,
        16,
    ),
}


@pytest.mark.parametrize(("metric", "diameter"), WAYS)
@pytest.mark.parametrize("name", CASES)
def test_check_finds_its_error_and_accepts_valid_program(name: str, metric: bool, diameter: bool) -> None:
    wrong, sound, stock, line = CASES[name]
    check = name.split(maxsplit=1)[0].rstrip(",")
    assert (check, line) in found(text(wrong, metric=metric, diameter=diameter), stock)
    assert found(text(sound, metric=metric, diameter=diameter), stock) == []


def test_bore_entry_steeper_than_insert_back_is_reported() -> None:
    recess = "T4\nX[.38]Z[.1]\nZ[-.3]\nG95F[.002]X[.394]\nX[.45]Z[{z}]\nZ[-.8]\nX[.38]\nG94F[300]Z[1]"
    assert ("wrong-side", 7) in found(text(recess.format(z="-.356")), PIPE)
    assert found(text(recess.format(z="-.5")), PIPE) == []


def test_face_and_insert_back_without_contact_are_not_reported() -> None:
    faced = "T1\nX[.6]Z[.1]\nZ[-.04]\nG95F[.004]X[-.02]\nG94F[300]Z[1]"
    assert found(text(faced)) == []


@pytest.mark.parametrize(("metric", "diameter"), WAYS)
def test_long_thin_bar_above_critical_speed_is_reported(metric: bool, diameter: bool) -> None:
    """f = 1.8751²/2π · 3500 m/s · (r/2) / L²: 6 mm thick, 200 mm long, that is 73.3 a second, 4397 rpm."""
    rod, long = make_bar_stock(6.0, 0.0, -220.0), Clamping(100.0, 200.0, 10.0, 60.0)
    turned = "M05\nM03S{s}\nT1\nX[.2]Z[.1]\nX[.1]\nG95F[.004]Z[-.2]\nX[.2]\nG94F[300]Z[1]"
    wrong = text(turned.format(s=2250), metric=metric, diameter=diameter)
    fast = part_of(wrong, rod, clamping=long)
    assert [each.check_name for each in fast.findings] == ["stock-whips"] * len(fast.findings)
    assert fast.findings
    sound = text(turned.format(s=2150), metric=metric, diameter=diameter)
    assert part_of(sound, rod, clamping=long).findings == ()


def test_unchecked_data_is_listed() -> None:
    turned = "T1\nX[.6]Z[.05]\nX[.4]\nG95F[.004]Z[-.3]\nX[.6]\nG94F[300]Z[1]\n"
    plain = turned + "T3\nX[0]Z[.1]\nG95F[.004]Z[-.3]\nG94F[300]Z[1]"
    said = part_of(text(plain), shapes={3: ToolShape(ToolKind.DRILL, diameter=6.0)}).unchecked_data
    assert said[0] == text_of("findings.shape-unknown", tools="T1")
    assert said[1] == text_of("findings.depth-unknown", tools="T3")
    assert len(said) == 4  # chuck, and its speed
    held = Clamping(100.0, 40.0, 10.0, 60.0, 5000.0)
    assert part_of(text(plain), clamping=held).unchecked_data == ()
