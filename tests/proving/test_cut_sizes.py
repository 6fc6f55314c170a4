"""Sizes of a cut against insert, bar, chuck and piece, each with a near twin; values worked out by hand."""

from __future__ import annotations

import pytest

from core.part.stock import Clamping, make_bar_stock, make_tube_stock
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.checks.cut_checks import find_max_depth
from tests.proving.test_edge_checks import part_of
from tests.proving.test_part_proof import WAYS, text
from tests.proving.test_sound_programs import part_of as assumed_part_of

CNMG = ToolShape(ToolKind.TURNING, tip=3, insert="CNMG432", nose_radius=0.8)
BORER = ToolShape(ToolKind.BORING, tip=2, nose_radius=0.2, diameter=6.0, stick_out=40.0)
BLADE = ToolShape(ToolKind.PARTING, tip=3, width=2.0, stick_out=30.0)
GROOVER = ToolShape(ToolKind.GROOVING, tip=3, width=2.0, stick_out=30.0)
PASS = "T1\nX[.6]Z[.05]\nX[{r}]\nG95F[.006]Z[-.5]\nX[.6]\nG94F[300]Z[1]"


@pytest.mark.parametrize(
    ("insert", "usual"),
    [
        # edge: 12.7 / sin 80° = 12.896 mm, less the nose of .794 mm (1/32 in): 12.102 mm
        ("CNMG432", 6.051),
        # 16.5 mm (9.525 x √3 = 16.498), less .397: 16.101
        ("TNMG331", 4.830),
        # 9.525 / sin 35° = 16.606, less .397: 16.209
        ("VNMG331", 3.242),
        ("", 6.048),  # as CNMG 120408, with a nose of .8
    ],
)
def test_max_depth_follows_cutting_edge(insert: str, usual: float) -> None:
    shape = ToolShape(ToolKind.TURNING, insert=insert)
    assert find_max_depth(shape) == pytest.approx(usual, abs=2e-3)


@pytest.mark.parametrize(
    ("r", "expected"),
    [
        (".25", [("depth-of-cut", 6)]),
        (".27", []),
        (".15", [("depth-breaks-tool", 6)]),
        (".19", [("depth-of-cut", 6)]),
    ],
    # .25 in = 6.35 mm over 6.05; .23 in = 5.84 mm; .35 in = 8.89 mm over 8.07 (2/3 of 12.1); .31 in = 7.87 mm
)
@pytest.mark.parametrize(("metric", "diameter"), WAYS)
def test_depth_of_cut_of_cnmg432_is_checked(
    r: str, expected: list[tuple[str, int]], metric: bool, diameter: bool
) -> None:
    program = text(PASS.format(r=r), metric=metric, diameter=diameter)
    part = part_of(program, make_bar_stock(25.4, 0.0, -60.0), {1: CNMG})
    assert [(each.check_name, each.line) for each in part.findings] == expected


def test_assumed_tool_is_checked_as_cnmg432_and_named() -> None:
    (found,) = part_of(text(PASS.format(r=".25")), make_bar_stock(25.4, 0.0, -60.0), {}).findings
    assert (found.check_name, found.severity, found.assumptions) == ("depth-of-cut", "warning", ("T1",))
    assert part_of(text(PASS.format(r=".27")), make_bar_stock(25.4, 0.0, -60.0), {}).findings == ()


def test_depth_of_cut_is_not_checked_with_assumed_stock() -> None:
    """.4 in of radius in one pass of a casting that nobody has described."""
    program = "G90G94F300G72\nM03S800\nT1\nX1.2Z.05\nX.2\nG95F.004Z-.5\nG94F300X1.1\nZ1\nM30\n"
    assert assumed_part_of(program).findings == ()


@pytest.mark.parametrize(("r", "expected"), [(".52", [("depth-breaks-tool", 6)]), (".5", [])])
def test_a_boring_bar_cuts_half_its_diameter_at_most(r: str, expected: list[tuple[str, int]]) -> None:
    """A bore of r 10 mm and a bar of 6 mm: .52 in are 3.21 mm deep, .5 in 2.7 mm."""
    program = text(f"T1\nX[.35]Z[.1]\nX[{r}]\nG95F[.003]Z[-.4]\nX[.35]\nG94F[300]Z[1]")
    part = part_of(program, make_tube_stock(38.1, 20.0, 0.0, -60.0), {1: BORER})
    assert [(each.check_name, each.line) for each in part.findings] == expected


GROOVE = "T1\nX[.6]Z[-.5]\nG95F[.002]X[.4]\nX[.6]\nX[{r}]\nZ[-.3]\nX[.6]\nG94F[300]Z[1]"


@pytest.mark.parametrize(
    ("tool", "r", "expected"),
    [
        (BLADE, ".485", [("blade-turns", 8)]), (BLADE, ".492", []),  # .015 in and .008 in; .25 mm are .0098
        (GROOVER, ".43", [("blade-turns", 8)]), (GROOVER, ".44", []),  # .07 and .06 in; .8 x 2 mm are .063
    ],
)  # fmt: skip
def test_side_cut_with_blade_is_checked(tool: ToolShape, r: str, expected: list[tuple[str, int]]) -> None:
    part = part_of(text(GROOVE.format(r=r)), make_bar_stock(25.4, 0.0, -60.0), {1: tool})
    assert [(each.check_name, each.line) for each in part.findings] == expected


@pytest.mark.parametrize("tool", [BLADE, GROOVER])
def test_blade_may_finish_wall_of_its_groove(tool: ToolShape) -> None:
    """From a plunge of 2 mm to .05 in: .05 in of a wall .1 in high are left, less than the blade is wide."""
    wall = "T1\nX[.6]Z[-.5]\nG95F[.002]X[.4]\nZ[-.45]\nX[.6]\nG94F[300]Z[1]"
    assert part_of(text(wall), make_bar_stock(25.4, 0.0, -60.0), {1: tool}).findings == ()


def test_depth_of_pass_into_shoulder_is_its_average() -> None:
    """.02 in deep over .5 in, and .3 in of a shoulder for the last .01 in: .026 in on the average."""
    steps = "T1\nX[.6]Z[.05]\nX[.35]\nG95F[.006]Z[-.49]\nX[.6]\nG94F[300]Z[.05]\nX[.2]\n"
    steps += "G95F[.006]Z[-.49]\nX[.6]\nG94F[300]Z[.05]\nX[.18]\nG95F[.004]Z[-.5]\nX[.6]\nG94F[300]Z[1]"
    assert part_of(text(steps), make_bar_stock(25.4, 0.0, -60.0), {1: CNMG}).findings == ()


def test_a_blade_may_chamfer() -> None:
    chamfer = "T1\nX[.6]Z[-.5]\nG95F[.002]X[.4]\nX[.55]\nZ[-.4]\nX[.5]\nX[.46]Z[-.44]\nX[.6]\nG94F[300]Z[1]"
    part = part_of(text(chamfer), make_bar_stock(25.4, 0.0, -60.0), {1: BLADE})
    assert part.findings == ()


@pytest.mark.parametrize(
    ("z", "expected"),
    [
        ("-1.57", {"near-chuck"}),
        ("-1.56", set()),
        ("-1.58", {"into-chuck"}),
        ("-1.5745", {"into-chuck"}),
        ("-1.5725", {"near-chuck"}),
    ],
    # the chuck's face is 40 mm or 1.5748 in behind Z0: .005 in, .015 in, .0003 in and .0023 in before it
)
def test_blade_next_to_chuck_is_checked(z: str, expected: set[str]) -> None:
    program = text(f"T1\nX[1.5]Z[.1]\nZ[{z}]\nX[.6]\nG95F[.002]X[.4]\nX[.6]\nG94F[300]X[1.5]\nZ[1]")
    held = Clamping(100.0, 40.0, 0.0, 60.0)
    part = part_of(program, make_bar_stock(25.4, 0.0, -80.0), {1: BLADE}, held)
    assert {each.check_name for each in part.findings} == expected


def test_cross_hole_through_both_walls_has_no_finding() -> None:
    """A live drill across a tube, from X.5 to X-.5: nothing is found."""
    live = ToolShape(ToolKind.DRILL, tip=8, diameter=3.0, point=118.0, length=40.0)
    program = "G90G94F300G73\nT1\nX.7Z.1\nM19\nG04F1\nM15\nZ-.4\nF3X-.45\nF300X.7\nZ1\nM16\nM05\nM30\n"
    part = part_of(program, make_tube_stock(19.05, 12.7, 0.0, -60.0), {1: live})
    assert [each.check_name for each in part.findings] == []
    assert part.removed_volume_mm3 > 0.0
