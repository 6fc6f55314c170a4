"""Round tools off the axis, holes that are missing, ends of the stock, holders behind a part-off."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from core.part.stock import Stock, make_bar_stock, make_tube_stock
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from tests.proving.test_edge_checks import part_of
from tests.proving.test_part_proof import text

INCH = 25.4
ROD, PIPE = make_bar_stock(25.4, 0.0, -76.2), make_tube_stock(25.4, 12.0, 0.0, -76.2)
TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.8, insert="CNMG120408")
LEFT = ToolShape(ToolKind.TURNING, ToolHand.LEFT, tip=4, nose_radius=0.8, insert="CNMG120408")
REAR = ToolShape(ToolKind.TURNING, tip=2, nose_radius=0.8, insert="CNMG120408", rear=True)
BLADE = ToolShape(ToolKind.PARTING, tip=3, width=2.0, length=7.6)
LONG_BLADE = ToolShape(ToolKind.PARTING, tip=3, width=2.0, length=15.0)
FLAT = ToolShape(ToolKind.DRILL, diameter=6.35, point=180.0, length=40.0)
POINTED = ToolShape(ToolKind.DRILL, diameter=6.35, point=118.0, length=90.0)
TAP = ToolShape(ToolKind.TAP, diameter=6.35, pitch=1.27, length=25.0)
BORER = ToolShape(ToolKind.BORING, tip=2, nose_radius=0.4, insert="DCMT070204", diameter=5.0, stick_out=40.0)
SHAPES = {1: TURNING, 2: FLAT, 3: BLADE, 4: LEFT, 5: REAR, 6: TAP, 7: POINTED, 8: BORER, 9: LONG_BLADE}


def found(program: str, stock: Stock = ROD, shapes: dict[int, ToolShape] = SHAPES) -> list[tuple[str, str]]:
    """Return the check and the severity of each finding."""
    return [(each.check_name, str(each.severity)) for each in part_of(program, stock, shapes).findings]


def codes(program: str, stock: Stock = ROD) -> set[str]:
    return {check for check, _ in found(program, stock)}


HOLE = "T{t}\nX[0]Z[.1]\nG95F[.004]Z[{z}]\nG94F[300]Z[1]"


def test_flat_drill_removes_cylinder() -> None:
    """.9 in deep: pi/4 x .25² x .9 = .04418 in³."""
    part = part_of(text(HOLE.format(t=2, z="-.9")), ROD, SHAPES)
    assert part.removed_volume_mm3 / INCH**3 == pytest.approx(math.pi / 4 * 0.25**2 * 0.9, rel=2e-3)


def test_a_pointed_drill_leaves_a_cone_at_the_bottom() -> None:
    """The cone of 118° is .125 / tan 59° = .0751 in high, and lacks two thirds of its cylinder."""
    part = part_of(text(HOLE.format(t=7, z="-.9")), ROD, SHAPES)
    solid = math.pi / 4 * 0.25**2 * (0.9 - 2 / 3 * 0.125 / math.tan(math.radians(59)))
    assert part.removed_volume_mm3 / INCH**3 == pytest.approx(solid, rel=2e-3)


def test_drill_outside_bar_removes_nothing() -> None:
    assert (
        codes(text("T2\nX[1.5]Z[1]\nZ[-.5]\nZ[1]\n" + HOLE.format(t=2, z="-.3").removeprefix("T2\n")))
        == set()
    )


@pytest.mark.parametrize(
    ("x", "expected"), [("0", False), (".003", False), (".005", True), (".02", True), ("-.02", True)]
)
def test_a_drill_off_the_axis_is_an_error(x: str, expected: bool) -> None:
    program = text(HOLE.format(t=2, z="-.3").replace("X[0]", f"X[{x}]"))
    assert (("drill-off-axis", "error") in found(program)) is expected


TAPPED = "T7\nX[0]Z[.1]\nG95F[.004]Z[{hole}]\nG94F[300]Z[1]\n"
TAPPED += "T6\nX[0]Z[.1]\nM03S500\nG95F[.05]Z[{z}]\nM04\nZ[.1]\nM05"
SMALL = {**SHAPES, 7: ToolShape(ToolKind.DRILL, diameter=5.1, point=118.0, length=40.0)}


@pytest.mark.parametrize(
    ("hole", "z", "expected"),
    [("-.7", "-.4", False), ("-.01", "-.4", True), ("-.7", "-.9", True)],  # good, no hole, past its bottom
)
def test_a_tap_needs_a_hole_that_is_deep_enough(hole: str, z: str, expected: bool) -> None:
    program = text(TAPPED.format(hole=hole, z=z))
    assert (("tap-no-hole", "error") in found(program, ROD, SMALL)) is expected


BORED = "T{t}\nX[.24]Z[.1]\nG95F[.004]Z[-.5]\nX[.2]\nG94F[300]Z[1]"


def test_boring_into_solid_material_is_an_error_with_any_bar() -> None:
    solid = text(BORED.format(t=8))
    assert ("no-bore", "error") in found(solid, ROD)
    assert ("no-bore", "error") in found(solid.replace("T8\n", "T8(BORING BAR)\n"), ROD, {})
    assert "no-bore" not in codes(solid, PIPE)
    assert "no-bore" not in codes(text(HOLE.format(t=7, z="-.8") + "\n" + BORED.format(t=8)))


TURNED = "T{t}\nX[.6]Z[.05]\nX[.45]\nG95F[.004]Z[{z}]\nX[.6]\nG94F[300]Z[1]"


@pytest.mark.parametrize(("t", "z", "expected"), [(1, "-2.9", False), (1, "-3.05", False), (1, "-5.5", True)])
def test_a_feed_beyond_the_end_of_the_stock_is_an_error(t: int, z: str, expected: bool) -> None:
    stock = Stock("bar:1:3", ROD.outside_profile)
    assert (("past-stock", "error") in found(text(TURNED.format(t=t, z=z)), stock)) is expected


def test_a_drill_may_come_out_of_the_end_of_the_stock() -> None:
    stock = Stock("bar:1:3", ROD.outside_profile)
    assert "past-stock" not in codes(text(HOLE.format(t=7, z="-3.2")), stock)
    assert "past-stock" in codes(text(HOLE.format(t=7, z="-3.5")), stock)


@pytest.mark.parametrize(
    ("t", "code", "expected"),
    [(1, "M03", False), (1, "M04", True), (4, "M04", True), (4, "M03", False)],
)
def test_upright_front_tool_needs_correct_spindle_direction(t: int, code: str, expected: bool) -> None:
    program = text("M05\n" + code + "S900\n" + TURNED.format(t=t, z="-.3"))
    assert (("wrong-spindle-direction", "error") in found(program)) is expected


PARTED = "T{t}\nX[.6]Z[-.8]\nG95F[.002]X[{x}]\nG94F[300]X[.6]"


@pytest.mark.parametrize("x", ["0", "-.01", ".02"])
def test_holder_of_short_parting_blade_is_reported(x: str) -> None:
    assert ("feed-into-holder", "error") in found(text(PARTED.format(t=3, x=x)))


def test_long_enough_parting_blade_has_no_finding() -> None:
    assert codes(text(PARTED.format(t=9, x="-.01"))) == set()


SWAPPED = "T{t}\nX[.3]Z[.2]\nM03S600\nX[.212]\nG33X[.237]Z[-.5]I[.012]K[.05]P\nX[.3]"
SOUND = "T{t}\nX[.3]Z[.2]\nM03S600\nX[.237]\nG33X[.212]Z[-.5]I[.012]K[.05]P\nX[.3]"


def test_thread_return_through_part_is_an_error_and_pullout_is_not() -> None:
    """With start and end swapped each pass retracts towards the axis, and returns through the part."""
    stock = make_bar_stock(12.55, 0.0, -60.0)
    v = {1: ToolShape(ToolKind.THREADING, tip=8, point=60.0)}
    assert ("through-part", "error") in found(text(SWAPPED.format(t=1)), stock, v)
    assert found(text(SOUND.format(t=1)), stock, v) == []
    assert found(text(SOUND.format(t=1).replace("]P", "]")), stock, v) == []


LOOP = "T1\nX[.6]Z[.1]\nX[.3]\nG95F[.004]Z[-.3]\nG03X[.45]Z[-.45]I[.3]K[-.45]\nX[.6]\nG94F[300]Z[1]"


def test_an_arc_is_examined_piece_by_piece() -> None:
    """The arc begins square to the axis, into .15 in of material; the back of a CNMG clears 5°."""
    hollow = "T1\nX.6Z.1\nX.45\nG95F.004Z-.3\n{g}X.45Z-.6R.15\nX.6\nG94F300Z1"
    found = [codes(f"G90G94F300G73\nM03S1500\n{hollow.format(g=g)}\nM30\n") for g in ("G02", "G03")]
    assert {"wrong-side"} in found


@pytest.mark.parametrize(("insert", "expected"), [("CNMG120408", True), ("RCMT0803M0", False)])
def test_pointed_insert_cannot_cut_arc_loop(insert: str, expected: bool) -> None:
    """From square to the axis at Z-.3 around to parallel to it: 270°; the same arc the short way is 90°."""
    program = "G90G94F300G73\nM03S1500\n" + LOOP.replace("[", "").replace("]", "") + "\nM30\n"
    shapes = {1: replace(TURNING, insert=insert, nose_radius=4.0 if insert[0] == "R" else 0.8)}
    assert (("arc-loop", "error") in found(program, ROD, shapes)) is expected
    assert ("arc-loop", "error") not in found(program.replace("G03", "G02"), ROD, shapes)


def test_finding_based_on_assumption_is_a_warning() -> None:
    """A tip that is in the stated stock is an error whatever the tool."""
    slip = text(TURNED.format(t=1, z="-.5").replace("G95F[.004]Z", "G00Z"))
    assert ("rapid-into-stock", "error") in found(slip, ROD, {})
    hit = "T1\nX[.6]Z[.05]\nX[.505]\nG00Z[-.5]\nX[.6]\nZ[1]"
    assert all(severity != "error" for _, severity in found(text(hit), ROD, {}))


def test_two_tools_with_one_offset_cause_one_note() -> None:
    part = part_of(text(TURNED.format(t=1, z="-.5")), ROD, {1: TURNING, 4: LEFT})
    assert {each.check_name for each in part.findings} == set()
    gang = {1: (0.0, -25.4), 4: (0.0, -25.4)}
    both = part_of(text(TURNED.format(t=1, z="-.5")), ROD, {1: TURNING, 4: LEFT}, gang=gang)
    assert [(each.check_name, str(each.severity)) for each in both.findings] == [
        ("tools-in-one-place", "note")
    ]


EDGE = "T1\nX[.6]Z[0]\nG95F[.004]X[-.02]\nG94F[300]Z[.05]\nX[{x}]\nG95F[.004]Z[{z}]\n{arc}\nZ[-.5]\nX[.6]"


@pytest.mark.parametrize(
    ("x", "z", "arc", "expected"),
    [
        (".4", "0", "G03X.44Z-.04R.04", True),  # hollow: along Z at the face, and then away from the axis
        (".4", "0", "G02X.44Z-.04R.04", False),  # the edge is rounded
        (".4", "-.2", "G03X.44Z-.24R.04", False),  # the fillet of a shoulder
        (".3", "0", "G03X.45Z-.15R.15", False),  # too large for the rounding of an edge
    ],
)  # fmt: skip
def test_hollow_at_edge_of_face_causes_warning(x: str, z: str, arc: str, expected: bool) -> None:
    program = text(EDGE.format(x=x, z=z, arc=arc))
    assert (("hollow-at-edge", "warning") in found(program)) is expected
