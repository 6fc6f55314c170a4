"""Live tools, taps, work shifts and loops of the Fusion post, in a replacement of its engine."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from tests.cli.conftest import Turndesk
from tests.posts.test_freecad_live_tools import find_part_point
from tests.posts.test_fusion_post import CYCLE, RPM, START, Call, pytestmark, run_post, section

__all__ = ["pytestmark"]

LIVE = {"liveStart": 15, "liveStop": 16}
MILL = {"number": 5, "spindleRPM": 3000, "live": True}
BEGIN = ["M05", "M19S60", "G04F1.5", "T5", "M15(LIVE TOOL 3000 RPM)"]  # a revolution at 60 rpm takes 1 s


def milling(*calls: Call, **values: object) -> dict[str, object]:
    made = {"type": "TYPE_MILLING", "feedMode": "FEED_PER_MINUTE", "tool": MILL, "start": [1.0, 0.2]}
    return section(*calls, **{**made, **values})


def body(folder: Path, job: dict[str, object]) -> list[str]:
    """Return the lines between the start of the live tool and its stop."""
    done = run_post(folder, job, properties=LIVE)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert (lines[1:6], lines[-3:]) == (BEGIN, ["M16", "M05", "M30"])
    return lines[6:-3]


def test_face_is_milled_in_the_plane_xc(tmp_path: Path) -> None:
    """X .3 Y .4 is .5 in from the axis, which is X-1 as a diameter. Rapids are 50 in/min in the plane."""
    lines = body(
        tmp_path,
        milling(
            ["onRapid", 0.3, 0.4, 0.1],
            ["onLinear", 0.3, 0.4, -0.05, 5],
            ["onLinear", 0.3, -0.4, -0.05, 10],
            ["onCircular", False, 0, 0, -0.05, 0.5, 0, -0.05, 10],
            ["onRapid", 0.5, 0, 0.2],
            plane="PLANE_XY",
        ),
    )
    assert lines == [
        *("G00X-1Z.2", "G94F50", "(~PLXC)", "(G03X.3Y.4I0J0F50)", "(X.3Y.4Z.2F50)", "(X.3Y.4Z.1F50)"),
        *("(X.3Y.4Z-.05F5)", "(X.3Y-.4Z-.05F10)", "(G03X.5Y0I0J0F10)", "(X.5Y0Z.2F50)", "(END)"),
    ]


def test_arc_that_rounds_to_its_start_is_not_a_full_circle(tmp_path: Path) -> None:
    """Y .00002 is 0 at the resolution of .00005 in."""
    lines = body(
        tmp_path,
        milling(
            *(["onRapid", 0.5, 0, 0.2], ["onLinear", 0.5, 0, -0.1, 5]),
            ["onCircular", False, 0, 0, -0.1, 0.5, 0.00002, -0.1, 10],
            plane="PLANE_XY",
        ),
    )
    assert lines[-3:] == ["(X.5Y0Z-.1F5)", "(X.5Y0Z.2F50)", "(END)"]


def test_work_plane_that_is_turned_around_the_axis_is_turned_back(tmp_path: Path) -> None:
    """X of the plane points along Y of the part, so X .5 of the plane is Y .5 of the part."""
    plane = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
    calls: list[Call] = [["onRapid", 0.5, 0, 0.2], ["onLinear", 0.5, 0.1, -0.1, 5]]
    lines = body(tmp_path, milling(*calls, workPlane=plane))
    assert lines[2:6] == ["(~PLXC)", "(G03X0Y.5I0J0F50)", "(X0Y.5Z.2F50)", "(X-.1Y.5Z-.1F5)"]


def test_holes_on_the_face_are_at_c_angles(tmp_path: Path) -> None:
    """Y .3 is at C-90. From Z .1, pecks of .4 end at Z -.3 and -.5; the rapid stops .02 before the bottom."""
    cycle: Call = ["cycle", "deep-drilling", {**CYCLE, "incrementalDepth": 0.4, "feedrate": 4}]
    hole = milling(
        ["onRapid", 0, 0.3, 0.2], cycle, ["onCyclePoint", 0, 0.3, -0.5], ["onCyclePoint", -0.3, 0, -0.5]
    )
    pecks = ["G00Z.1", "G94F4Z-.3", "G00Z.1", "Z-.28", "G94F4Z-.5", "G00Z.1", "Z.2"]
    assert body(tmp_path, hole) == [
        *("G00X-.6Z.2", "CA-90S60", "G04F.8", *pecks, "CA-180S60", "G04F.8", *pecks),
    ]


def test_radial_hole_is_drilled_along_x(tmp_path: Path) -> None:
    """The tool points to -Y at Z -.4. Heights are radii: clear at .6, retract at .5, bottom at .2."""
    plane = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    cycle: Call = ["cycle", "drilling", {"clearance": 0.6, "retract": 0.5, "bottom": 0.2, "feedrate": 4}]
    hole = milling(
        ["onRapid", -0.4, 0, 0.6],
        cycle,
        ["onCyclePoint", -0.4, 0, 0.2],
        workPlane=plane,
        start=[-0.4, 0.6],
        top=0.2,
    )
    done = run_post(tmp_path, {**hole, "calls": hole["calls"][1:]}, properties=LIVE)  # type: ignore[index]
    assert done.stdout.splitlines()[6:-3] == [
        *("G00X-1.2Z.2", "Z-.4", "CA-90S60", "G04F.8", "G00X-1", "G94F4X-.4", "G00X-1", "X-1.2", "Z.2"),
    ]


def wrapped(x: float, angle: float, radius: float, feed: float | None = None) -> Call:
    """Return a multi-axis move to a point at an angle in degrees, with the tool pointing at the axis."""
    a, b = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    end: Call = [radius * a, radius * b, x, a, b, 0]
    return ["onRapid5D", *end] if feed is None else ["onLinear5D", *end, feed]


def test_wrapped_path_is_milled_in_the_plane_zc(tmp_path: Path) -> None:
    """Clear at radius .6, so D is 1.2 and 90° are .3 pi = .94248 in. X of the plane is -Z."""
    job = milling(
        wrapped(-0.4, 0, 0.6),
        wrapped(-0.4, 0, 0.45, 5),
        wrapped(-0.4, 90, 0.45, 10),
        wrapped(-0.5, 190, 0.45, 10),
        multiAxis=True,
        start=[0.6, -0.4],
        top=0.2,
    )
    assert body(tmp_path, job) == [
        *("G00X-1.2Z.2", "Z0", "G94F50", "(~PLZC)", "(D1.2)", "(X.4Y0Z1.2F50)", "(X.4Y0Z.9F5)"),
        *("(X.4Y.9425Z.9F10)", "(X.5Y1.9897Z.9F10)", "(X.5Y1.9897Z1.2F50)", "(END)", "G00X-1.2Z.2"),
    ]


def test_drill_on_the_axis_is_turned_by_the_spindle(tmp_path: Path) -> None:
    """Fusion treats each drilling operation as milling, even if its only hole is on the spindle axis."""
    calls: list[Call] = [["onRapid", 0, 0, 0.2], ["cycle", "drilling", CYCLE], ["onCyclePoint", 0, 0, -0.5]]
    values = {"parameters": {"operation-strategy": "drill"}, "tool": RPM, "start": [0.0, 0.2]}
    done = run_post(tmp_path, milling(*calls, **{**values, "feedMode": "FEED_PER_REVOLUTION"}))
    assert done.stdout.splitlines()[1:-2] == [
        *("T1", "G97M03S1200", "G00X0Z.2", "Z.1", "G95F.004G81Z-.5", "G00Z.2"),
    ]


TAP = {"number": 4, "spindleRPM": 400, "threadPitch": 0.05}


@pytest.mark.parametrize(
    ("kind", "tool", "codes"),
    [
        ("tapping", {"type": "TOOL_TAP_RIGHT_HAND"}, ("M03", "M04")),
        ("right-tapping", {}, ("M03", "M04")),
        ("tapping", {"type": "TOOL_TAP_LEFT_HAND", "clockwise": False}, ("M04", "M03")),
        ("left-tapping", {"clockwise": False}, ("M04", "M03")),
    ],
)
def test_tap_feeds_reverses_and_feeds_out(
    tmp_path: Path, kind: str, tool: dict[str, object], codes: tuple[str, str]
) -> None:
    calls: list[Call] = [["onRapid", 0, 0, 0.2], ["cycle", kind, CYCLE], ["onCyclePoint", 0, 0, -0.5]]
    lines = run_post(tmp_path, section(*calls, tool={**TAP, **tool})).stdout.splitlines()
    forward, reverse = codes
    assert lines[2:-2] == [
        *(f"G97{forward}S400", "G00X0Z.2", "Z.1", "G95F.05Z-.5", reverse, "G04F.5", "G95F.05Z.1"),
        *(f"G97{forward}S400", "G00Z.2"),
    ]


@pytest.mark.parametrize(
    ("tool", "reason"),
    [
        ({"threadPitch": 0}, "pitch of the tap"),
        ({"threadPitch": 0.25}, "pitch of the tap"),
        ({"type": "TOOL_TAP_LEFT_HAND"}, "direction of its thread"),
        ({"clockwise": False}, "direction of its thread"),
    ],
)
def test_taps_that_cannot_be_written_are_rejected(
    tmp_path: Path, tool: dict[str, object], reason: str
) -> None:
    calls: list[Call] = [["onRapid", 0, 0, 0.2], ["cycle", "tapping", CYCLE], ["onCyclePoint", 0, 0, -0.5]]
    assert reason in run_post(tmp_path, section(*calls, tool={**TAP, **tool})).stderr


CUT: list[Call] = [START, ["onLinear", 1.0, 0, -0.5, 0.005]]


def test_work_offset_becomes_a_work_shift_before_t(tmp_path: Path) -> None:
    """Offset 3 is at Z -1.6, so the Z of the tool change .1 is 1.7 there."""
    job = [section(*CUT, workOffset=1), section(*CUT, workOffset=3), section(*CUT, workOffset=1)]
    lines = run_post(tmp_path, *job, properties={"workShiftZ": -0.8}).stdout.splitlines()
    assert lines[5:] == [
        *("G00Z.1", "G97M05", "G10X0Z-1.6", "T1", "G97M03S1200", "G00X2Z1.7", "Z.1", "G95F.005Z-.5"),
        *("G00Z1.7", "G97M05", "G10X0Z1.6", "T1", "G97M03S1200", "G00X2Z.1", "G95F.005Z-.5"),
        *("G00Z.1", "M05", "M30"),
    ]


def test_first_rapid_behind_the_face_moves_x_in_front_of_the_part(tmp_path: Path) -> None:
    """The highest Z of the section is .1; a line from an unknown X to Z-.4 could cross the part."""
    calls: list[Call] = [["onRapid", 1.2, 0, -0.4], ["onLinear", 1.0, 0, -0.4, 0.005]]
    lines = run_post(tmp_path, section(*calls)).stdout.splitlines()
    assert lines[3:6] == ["G00X2.4Z.1", "Z-.4", "G95F.005X2"]


def test_loops_for_several_parts(tmp_path: Path) -> None:
    loop = {"parts": 4, "partLength": 0.6}
    lines = run_post(tmp_path, section(*CUT), properties=loop).stdout.splitlines()
    assert lines[1:7] == ["LS4", "P1", "G10X0Z-.6", "LF", "M30", "}1"]
    assert lines[-2:] == ["M05", "M99"]
    fed = {**loop, "barStop": 9, "facingStock": 0.02, "barFeed": 30}
    lines = run_post(tmp_path, section(*CUT), properties=fed).stdout.splitlines()
    assert lines[1:13] == [
        *(
            "LS4",
            "M05",
            "T9",
            "G00X0Z.1",
            "G00Z-.58",
            "M13",
            "G94F30Z.02",
            "M12",
            "G00Z.1",
            "P1",
            "LF",
            "M30",
        ),
    ]


def test_machine_positions_are_the_positions_of_the_path(turndesk: Turndesk, tmp_path: Path) -> None:
    """Compare X, Z and C of the proved program with the face path and with the wrapped path."""
    square = [(0.4, 0.3), (-0.4, 0.3), (-0.4, -0.3), (0.4, -0.3)]
    face = milling(
        ["onRapid", 0.4, -0.3, 0.2], *(["onLinear", x, y, -0.05, 10] for x, y in square), plane="PLANE_XY"
    )
    angles = [0.0, 120.0, 240.0, 400.0]
    side = milling(
        wrapped(-0.5, 0, 0.7),
        *(wrapped(-0.5, angle, 0.45, 10) for angle in angles),
        tool={**MILL, "number": 7},
        multiAxis=True,
        start=[0.7, -0.5],
        top=0.2,
    )
    path = tmp_path / "part.nc"
    path.write_text(run_post(tmp_path, section(*CUT), face, side, section(*CUT), properties=LIVE).stdout)
    proof = turndesk("prove", path)
    assert (proof.status, "error" in proof.out, "dwell-too-short" in proof.out) == (0, False, False)
    moves = [json.loads(line) for line in turndesk("expand", path, "--json").out.splitlines()]
    low = [each for each in moves if each.get("kind") == "plane-line" and each["z"] == pytest.approx(-0.05)]
    for move, (x, y) in zip(low, square, strict=True):
        assert find_part_point(move)[:2] == pytest.approx((25.4 * x, 25.4 * y), abs=0.003)
    around = [each for each in moves if each.get("x") == pytest.approx(-0.45) and each["z"] < -0.4]
    assert [each["c"] for each in around] == pytest.approx([-angle for angle in angles], abs=0.02)
    assert {round(each["z"], 4) for each in around} == {-0.5}


DRILL: Call = ["cycle", "drilling", {**CYCLE, "feedrate": 4}]


@pytest.mark.parametrize(
    ("calls", "values", "reason"),
    [
        ([["onLinear", 0.3, 0, 0, 5]], {}, "position before this cut"),
        ([["onRapid", 0.3, 0, 0.2], ["onLinear", 0.3, 0, 0, 0]], {}, "feed is 0"),
        ([["cycle", "tapping", CYCLE], ["onCyclePoint", 0.3, 0, -0.5]], {}, "cannot tap"),
        ([["cycle", "boring", CYCLE], ["onCyclePoint", 0.3, 0, -0.5]], {}, "cycle boring"),
        ([["cycle", "deep-drilling", CYCLE], ["onCyclePoint", 0.3, 0, -0.5]], {}, "peck depth"),
        ([["onRapid", 0.3, 0, 0.2]], {"workPlane": [[0, 0, 1], [1, 0, 0], [0, 1, 0]]}, "wraps the path"),
        (
            [DRILL, ["onCyclePoint", 0, 0.1, -0.5]],
            {"workPlane": [[0, 0, 1], [1, 0, 0], [0, 1, 0]]},
            "point at",
        ),
        ([DRILL, ["onCyclePoint", 0, 0, -0.5]], {"workPlane": [[0, 0, 1], [1, 0, 0], [0, 1, 0]]}, "deeper"),
        ([["onRapid5D", 0.5, 0.1, 0, 1, 0, 0]], {"multiAxis": True}, "does not point"),
        ([["onRapid5D", 0.5, 0, 0, 0.8, 0, 0.6]], {"multiAxis": True}, "does not point"),
        ([["onSpindleSpeed", 500]], {}, "must not change"),
        ([], {"tool": {**MILL, "clockwise": False}}, "clockwise"),
        ([], {"tool": {**MILL, "spindleRPM": 0}}, "needs a speed"),
    ],
)
def test_live_operations_that_cannot_be_written_are_rejected(
    tmp_path: Path, calls: list[Call], values: dict[str, object], reason: str
) -> None:
    done = run_post(tmp_path, milling(*calls, **values), properties=LIVE)
    assert (done.returncode, done.stdout) == (1, "")
    assert reason in done.stderr


@pytest.mark.parametrize(
    ("properties", "reason"),
    [
        ({"parts": 3}, "length from part to part"),
        ({"parts": 2.5, "partLength": 1}, "whole number"),
        ({"parts": 3, "partLength": 0.1, "facingStock": 0.1}, "facing stock"),
        ({"parts": 3, "partLength": 0.5, "barStop": 33}, "T33"),
        ({"parts": 3, "partLength": 0.5, "barStop": 9, "facingStock": 0.3}, "in front of the facing stock"),
        ({"parts": 3, "partLength": 0.5, "barStop": 9, "barFeed": -20}, "Feed of the bar"),
        ({"cSpeed": -60}, "Speed of C"),
        ({"changeZ": -1}, "Z of the tool change"),
        ({"rapidRate": 1e9}, "Rapid rate"),
        ({"liveStart": 3, "liveStop": 5}, "two whole numbers"),
        ({"liveStart": 15, "liveStop": 15}, "two whole numbers"),
    ],
)
def test_properties_that_cannot_be_used_are_rejected(
    tmp_path: Path, properties: dict[str, object], reason: str
) -> None:
    assert reason in run_post(tmp_path, section(*CUT), properties=properties).stderr
