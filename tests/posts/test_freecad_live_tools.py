"""Live tools in the FreeCAD post: planes XC and ZC, holes at C angles, and rejected commands.

The part turns with C, counterclockwise as seen from the front. A point at the polar angle a is therefore
under a tool on the negative X side if C is -a.
"""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path

import pytest

from resources.posts import omniturn_post
from tests.cli.conftest import Turndesk
from tests.posts.test_freecad_post import Command, operation

FACE = "--face 5 --live 15,16 --no-comments"
SIDE = "--side 7=30 --change-z 10 --live 15,16 --no-comments"
START = ["M05", "M19S60", "G04F1.5"]  # one revolution at 60 rpm takes 1 s


def live_tool(number: int) -> object:
    return operation(("M6", {"T": number}), ("M3", {"S": 3000.0}), label="TC")


def body(number: int, options: str, *commands: Command) -> list[str]:
    """Return the lines between the start of the live tool and its stop."""
    text = omniturn_post.post([live_tool(number), operation(*commands, label="Mill")], options)
    lines = text.splitlines()
    assert lines[1:6] == [*START, f"T{number}", "M15"]
    assert lines[-3:] == ["M16", "M05", "M30"]
    return lines[6:-3]


def test_face_is_milled_in_the_plane_xc() -> None:
    """From X 6 Y 8 (10 mm from the axis, so X-20 as a diameter) to X 6 Y -8, both ways around the axis.

    4 mm/s are 240 mm/min; rapids in the plane are 1270 mm/min, which are 50 in/min.
    """
    lines = body(
        *(5, FACE, ("G0", {"Z": 5.0}), ("G0", {"X": 6.0, "Y": 8.0}), ("G0", {"Z": 1.0})),
        *(("G1", {"Z": -1.0, "F": 1.0}), ("G1", {"Y": -8.0, "F": 4.0})),
        *(("G3", {"X": 6.0, "Y": 8.0, "I": -6.0, "J": 8.0, "F": 4.0}), ("G0", {"Z": 5.0})),
    )
    assert lines == [
        *("G00X-20Z5", "G94F1270", "(~PLXC)", "(G03X6Y8I0J0F1270)", "(X6Y8Z5F1270)", "(X6Y8Z1F1270)"),
        *("(X6Y8Z-1F60)", "(X6Y-8Z-1F240)", "(G03X6Y8I0J0F240)", "(X6Y8Z5F1270)", "(END)"),
    ]


def test_arc_of_more_than_half_a_turn_is_divided_on_the_face() -> None:
    """A full circle of 3 mm around X 9 Y 0; its middle is at X 12 Y 0."""
    lines = body(
        *(5, FACE, ("G0", {"X": 6.0, "Y": 0.0, "Z": 5.0}), ("G1", {"Z": -1.0, "F": 1.0})),
        ("G2", {"X": 6.0, "Y": 0.0, "I": 3.0, "J": 0.0}),
    )
    assert lines[2:6] == ["(~PLXC)", "(X6Y0Z5F1270)", "(X6Y0Z-1F60)", "(G02X12Y0I9J0F60)"]
    assert lines[6:] == ["(G02X6Y0I9J0F60)", "(X6Y0Z5F1270)", "(END)"]


def test_arc_that_rounds_to_its_start_is_not_a_full_circle() -> None:
    """Y .00004 mm is 0 with four decimals, and G03X5Y0 from X5 Y0 would be a full circle."""
    arc: Command = ("G3", {"X": 5.0, "Y": 0.00004, "I": -5.0, "J": 0.0, "F": 2.0})
    lines = body(
        5,
        "--face 5 --live 15,16 --no-comments",
        *(("G0", {"X": 5.0, "Y": 0.0, "Z": 2.0}), ("G1", {"Z": -1.0, "F": 2.0}), arc),
    )
    assert "(X5Y0Z-1F120)" in lines
    assert not any("G03" in line for line in lines)


def test_next_operation_begins_at_c0() -> None:
    """The plane starts at the C of its first line, so C turns back to 0 before the second operation."""
    cut: tuple[Command, ...] = (
        ("G0", {"X": 6.0, "Y": 0.0, "Z": 5.0}),
        ("G1", {"Z": -1.0, "F": 1.0}),
        ("G1", {"Y": 6.0}),
    )
    text = omniturn_post.post([live_tool(5), operation(*cut), operation(*cut)], FACE)
    second = text.splitlines()[text.splitlines().index("(END)") + 1 :]
    assert second[:5] == ["G00X-12Z5", "M19S60", "G04F1.5", "G94F1270", "(~PLXC)"]


def test_holes_on_the_face_are_at_c_angles() -> None:
    """X 0 Y 6 is at 90°, so C is -90; X 0 Y -6 at -90°. The short way from -90 is to -270, not to 90.

    A quarter of a revolution at 60 rpm takes 0.25 s, and half a revolution 0.5 s; 0.5 s are added, and the
    sum is rounded up to 0.1 s.
    """
    depth = {"Z": -8.0, "R": 1.0, "F": 1.0}
    lines = body(
        *(5, FACE, ("G0", {"Z": 5.0}), ("G81", {"X": 0.0, "Y": 6.0, **depth})),
        ("G83", {"X": -6.0, "Y": 0.0, "Q": 3.0, **depth}),
        ("G82", {"X": 0.0, "Y": -6.0, "P": 0.2, **depth}),
    )
    assert lines == [
        *("G00X-12Z5", "CA-90S60", "G04F.8", "G00Z1", "G94F60G81Z-8", "G00Z5"),
        *("CA-180S60", "G04F.8", "G00Z1", "G94F60G83Z-8K3", "G00Z5"),
        *("CA-270S60", "G04F.8", "G00Z1", "G94F60Z-8", "G04F.2", "G00Z1", "Z5"),
    ]


def test_side_is_milled_in_the_plane_zc() -> None:
    """X 4 of the unrolled side is at the lathe's Z -4; Z -1.5 is at the diameter 30 - 3 = 27."""
    lines = body(
        *(7, SIDE, ("G0", {"Z": 3.0}), ("G0", {"X": 4.0, "Y": 2.0}), ("G1", {"Z": -1.5, "F": 1.0})),
        *(("G1", {"X": 10.0, "F": 4.0}), ("G3", {"X": 10.0, "Y": 8.0, "I": 0.0, "J": 3.0})),
    )
    assert lines == [
        *("G00X-36Z10", "Z0", "G94F1270", "(~PLZC)", "(D30)", "(X4Y2Z36F1270)", "(X4Y2Z27F60)"),
        *("(X10Y2Z27F240)", "(G03X10Y8I10J5F240)", "(X10Y8Z36F1270)", "(END)"),
        "G00X-36Z10",
    ]


def test_radial_holes_have_pecks() -> None:
    """Y 7.854 is a quarter of the circumference pi 10. R is at X -6, the bottom at X -2 (diameters twice)."""
    options = "--side 7=10 --change-z 10 --live 15,16 --no-comments"
    values = {"X": 6.0, "Z": -3.0, "R": 1.0, "F": 1.0}
    lines = body(
        *(7, options, ("G0", {"Z": 2.0}), ("G83", {"Y": 0.0, "Q": 3.0, **values})),
        ("G81", {"Y": 2.5 * math.pi, **values}),
    )
    assert lines == [
        *("G00X-14Z10", "Z-6", "X-12", "G94F60X-6", "G00X-12", "X-7", "G94F60X-4", "G00X-12", "X-14"),
        *("CA-90S60", "G04F.8", "G00X-12", "G94F60X-4", "G00X-12", "X-14"),
        "Z10",
    ]


def test_live_tool_stops_before_a_turning_tool() -> None:
    turn = operation(("M6", {"T": 1}), ("M3", {"S": 900.0}), ("G0", {"X": 5.0, "Z": 5.0}))
    hole = operation(("G0", {"Z": 5.0}), ("G81", {"X": 6.0, "Y": 0.0, "Z": -1.0, "R": 1.0, "F": 1.0}))
    lines = omniturn_post.post([live_tool(5), hole, turn], FACE).splitlines()
    assert lines[-7:] == ["M16", "M05", "T1", "G97M03S900", "G00X10Z5", "M05", "M30"]


def find_part_point(move: dict[str, float]) -> tuple[float, float, float]:
    """Return X, Y and Z in mm on the part that is under a tool on the negative X side."""
    angle, radius = math.radians(-move["c"]), -move["x"] * 25.4
    return radius * math.cos(angle), radius * math.sin(angle), move["z"] * 25.4


def test_machine_positions_are_the_positions_of_the_face_path(turndesk: Turndesk, tmp_path: Path) -> None:
    """Compare the ends of all cuts with the path, from X, Z and C of the proved program."""
    cuts = [(8.0, -6.0, -1.0), (8.0, 6.0, -1.0), (-8.0, 6.0, -1.0), (-8.0, -6.0, -1.0), (8.0, -6.0, -1.0)]
    commands: list[Command] = [("G0", {"Z": 5.0}), ("G0", {"X": 8.0, "Y": -6.0}), ("G0", {"Z": 1.0})]
    commands += [("G1", {"X": x, "Y": y, "Z": z, "F": 2.0}) for x, y, z in cuts]
    commands += [("G0", {"Z": 5.0}), ("G81", {"X": -3.0, "Y": 4.0, "Z": -6.0, "R": 1.0, "F": 1.0})]
    for options in ("", "--inches"):
        path = tmp_path / "face.nc"
        omniturn_post.export([live_tool(5), operation(*commands)], str(path), f"{FACE} {options}")
        proof = turndesk("prove", path)
        assert (proof.status, "error" in proof.out) == (0, False), proof.out + proof.err
        assert "dwell-too-short" not in proof.out
        moves = [json.loads(line) for line in turndesk("expand", path, "--json").out.splitlines()]
        low = [
            find_part_point(move) for move in moves if move.get("z", 1.0) < -0.01 and move["kind"] != "dwell"
        ]
        expected = [*cuts, (-3.0, 4.0, -6.0)]
        for point, goal in zip(low, expected, strict=True):
            assert point == pytest.approx(goal, abs=0.003)


def test_machine_positions_are_the_positions_of_the_side_path(turndesk: Turndesk, tmp_path: Path) -> None:
    """A square of 5 mm at a diameter of 30 mm: 5 mm around are 360 * 5 / (30 pi) degrees."""
    corners = [(4.0, 2.0), (9.0, 2.0), (9.0, 7.0), (4.0, 7.0), (4.0, 2.0)]
    commands: list[Command] = [("G0", {"Z": 3.0}), ("G0", {"X": 4.0, "Y": 2.0})]
    commands += [("G1", {"X": x, "Y": y, "Z": -2.0, "F": 2.0}) for x, y in corners]
    path = tmp_path / "side.nc"
    omniturn_post.export([live_tool(7), operation(*commands)], str(path), SIDE)
    proof = turndesk("prove", path)
    assert (proof.status, "error" in proof.out) == (0, False), proof.out + proof.err
    moves = [json.loads(line) for line in turndesk("expand", path, "--json").out.splitlines()]
    low = [move for move in moves if -move.get("x", 0.0) * 25.4 == pytest.approx(13.0, abs=1e-3)]
    for move, (x, y) in zip(low, corners, strict=True):
        assert move["z"] * 25.4 == pytest.approx(-x, abs=1e-3)
        assert move["c"] == pytest.approx(-360.0 * y / (30.0 * math.pi), abs=0.01)


def test_program_of_freecad_mills_its_hexagon(turndesk: Turndesk) -> None:
    """The file was posted by FreeCAD 0.20.2 from a hexagon with its corners 12 mm from the axis.

    The center of the cutter of 5 mm is 2.5 mm from the hexagon, and the holes are at a radius of 7 mm.
    """
    path = Path(__file__).with_name("face-hexagon.nc")
    proof = turndesk("prove", path)
    assert (proof.status, "error" in proof.out) == (0, False), proof.out + proof.err
    moves = [json.loads(line) for line in turndesk("expand", path, "--json").out.splitlines()]
    low = [each for each in moves if each.get("z", 1.0) * 25.4 < -1.9 and each["kind"] != "dwell"]
    milled = [find_part_point(each)[:2] for each in low if each["kind"].startswith("plane")]
    drilled = [find_part_point(each)[:2] for each in low if not each["kind"].startswith("plane")]
    corners = [(12.0 * math.cos(math.pi * n / 3.0), 12.0 * math.sin(math.pi * n / 3.0)) for n in range(7)]
    assert len(milled) == 28
    for point in milled:
        away = min(find_distance(point, *edge) for edge in pairwise(corners))
        assert away == pytest.approx(2.5, abs=0.001)
    assert {round(math.hypot(*point), 3) for point in drilled} == {7.0}
    angles = {round(math.degrees(math.atan2(y, x)) % 360.0) for x, y in drilled}
    assert angles == {45, 135, 225, 315}


def find_distance(point: tuple[float, float], start: tuple[float, float], end: tuple[float, float]) -> float:
    """Return the distance of a point from the line between two points."""
    (px, py), (ax, ay), (bx, by) = point, start, end
    share = ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
    share = min(max(share, 0.0), 1.0)
    return math.hypot(px - ax - share * (bx - ax), py - ay - share * (by - ay))


def test_helix_becomes_lines_on_its_cylinder() -> None:
    """One turn of 3 mm around X 9 Y 0, from Z 0 to Z -2."""
    lines = body(
        *(5, FACE, ("G0", {"X": 6.0, "Y": 0.0, "Z": 5.0}), ("G1", {"Z": 0.0, "F": 1.0})),
        ("G3", {"X": 6.0, "Y": 0.0, "Z": -2.0, "I": 3.0, "J": 0.0}),
    )
    found = [line for line in lines if line.startswith("(X")][2:-1]
    points = [tuple(float(part) for part in line[2:-4].replace("Y", "Z").split("Z")) for line in found]
    assert points[-1] == (6.0, 0.0, -2.0)
    assert all(math.hypot(x - 9.0, y) == pytest.approx(3.0, abs=1e-4) for x, y, _ in points)
    for (x0, y0, z0), (x1, y1, z1) in pairwise(points):
        assert z1 < z0
        assert 3.0 - math.hypot((x0 + x1) / 2.0 - 9.0, (y0 + y1) / 2.0) < 0.0021


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (("G1", {"Z": -1.0, "F": 1.0}), "position before"),
        (("G84", {"X": 6.0, "Y": 0.0, "Z": -1.0, "R": 1.0}), "cannot tap"),
        (("G76", {"Z": -1.0, "P": 1.0}), "cannot tap"),
        (("M4", {"S": 100.0}), "no reverse"),
        (("M3", {"S": 0.0}), "needs a speed"),
        (("M3", {"S": 2000.0}), "set by hand"),
        (("G81", {"X": 6.0, "Y": 0.0, "Z": -1.0}), "no Z or no R"),
        (("G81", {"X": 6.0, "Y": 0.0, "Z": 2.0, "R": 1.0}), "not below R"),
        (("G81", {"X": 6.0, "Z": -2.0, "R": 1.0}), "position of the hole"),
        (("G83", {"X": 6.0, "Y": 0.0, "Z": -1.0, "R": 1.0, "F": 1.0}), "peck depth"),
        (("G0", {"A": 90.0}), "A is not 0"),
    ],
)
def test_commands_that_a_live_tool_cannot_execute_are_rejected(command: Command, reason: str) -> None:
    with pytest.raises(omniturn_post.PostError, match=reason) as raised:
        body(5, FACE, command)
    assert str(raised.value).startswith(f"Mill, {command[0]}: ")


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (("G1", {"Z": -1.0}), "feed is 0"),
        (("G2", {"X": 7.0, "Y": 1.0, "I": 5.0, "J": 0.0, "F": 1.0}), "not on its circle"),
        (("G2", {"X": 7.0, "Y": 1.0, "I": 1.0, "K": 1.0, "F": 1.0}), "not in the XY plane"),
    ],
)
def test_cuts_of_a_live_tool_that_cannot_be_written_are_rejected(command: Command, reason: str) -> None:
    with pytest.raises(omniturn_post.PostError, match=reason):
        body(5, FACE, ("G0", {"X": 6.0, "Y": 0.0, "Z": 5.0}), command)


def test_cut_after_a_stop_in_the_cut_is_rejected() -> None:
    """M00 leaves the plane, so the depth of the path is lost until the next rapid in Z."""
    cut: tuple[Command, ...] = (("G0", {"X": 6.0, "Y": 0.0, "Z": 5.0}), ("G1", {"Z": -1.0, "F": 1.0}))
    with pytest.raises(omniturn_post.PostError, match="position before"):
        body(5, FACE, *cut, ("M0", {}), ("G1", {"Y": 3.0}))
    lines = body(5, FACE, *cut, ("M0", {}), ("G0", {"Z": 1.0}), ("G1", {"Z": -1.0, "F": 1.0}))
    assert lines[6:8] == ["(END)", "M00"]


def test_live_tool_that_is_stopped_is_rejected() -> None:
    tool = operation(("M6", {"T": 5}))
    cut = operation(("G0", {"X": 6.0, "Y": 0.0, "Z": 5.0}), ("G1", {"Z": -1.0, "F": 1.0}))
    with pytest.raises(omniturn_post.PostError, match="live tool is stopped"):
        omniturn_post.post([tool, cut], FACE)


def test_radial_hole_past_the_axis_is_rejected() -> None:
    with pytest.raises(omniturn_post.PostError, match="deeper than the spindle axis"):
        body(7, SIDE, ("G0", {"Z": 3.0}), ("G81", {"X": 6.0, "Y": 0.0, "Z": -16.0, "R": 1.0, "F": 1.0}))


def test_job_with_paths_only_on_the_side_needs_the_z_of_the_tool_change() -> None:
    with pytest.raises(omniturn_post.PostError, match="--change-z"):
        body(7, "--side 7=30 --live 15,16", ("G0", {"Z": 3.0}))


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ("--face 5", "--live"),
        ("--face 33 --live 15,16", "T33"),
        ("--face 5 --side 5=30 --live 15,16", "not on both"),
        ("--side 7=0 --live 15,16", "greater than 0"),
        ("--side 7 --live 15,16", "invalid option"),
        ("--face 5 --live 15,15", "invalid option"),
        ("--face 5 --live 15", "invalid option"),
        ("--face 5 --live 3,5", "invalid option"),
        ("--face 5 --live 15,12", "invalid option"),
        ("--face 5 --live 15,16 --c-rpm nan", "invalid option"),
        ("--face 5 --live 15,16 --c-rpm 0", "--c-rpm"),
    ],
)
def test_invalid_options_of_live_tools_are_rejected(options: str, name: str) -> None:
    with pytest.raises(omniturn_post.PostError, match=name):
        omniturn_post.post([live_tool(5)], options)
