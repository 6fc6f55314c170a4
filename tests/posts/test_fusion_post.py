"""The post-processor of Fusion in a replacement of its engine: lines by hand, and rejected operations."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from resources import get_posts_folder
from tests.cli.conftest import Turndesk

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None, reason="node is not installed")
ENGINE = Path(__file__).with_name("fusion_engine.js")
Call = list[object]
RPM = {"number": 1, "spindleRPM": 1200}
START: Call = ["onRapid", 1.0, 0, 0.1]


def section(*calls: Call, **values: object) -> dict[str, object]:
    return {"tool": RPM, "start": [1.0, 0.1], "calls": list(calls), **values}


def run_post(folder: Path, *sections: object, **job: object) -> subprocess.CompletedProcess[str]:
    path = folder / "job.json"
    path.write_text(json.dumps({"unit": "IN", "sections": sections, **job}))
    words = [str(NODE), str(ENGINE), str(get_posts_folder() / "omniturn.cps"), str(path)]
    return subprocess.run(words, capture_output=True, text=True, check=False, timeout=60)


def body(folder: Path, *calls: Call, **values: object) -> list[str]:
    """Return the lines between the approach and the end of the program."""
    done = run_post(folder, section(START, *calls, **values))
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()[4:-2]


def test_program_in_inches(tmp_path: Path) -> None:
    calls: list[Call] = [START, ["onLinear", 1.0, 0, -0.5, 0.005], ["onLinear", 1.1, 0, -0.5, 0.005]]
    parameters = {"operation-comment": "Face (1)"}
    tool = {**RPM, "description": "CNMG432", "coolant": "COOLANT_FLOOD"}
    done = run_post(tmp_path, section(*calls, parameters=parameters, tool=tool), comment="pin")
    assert done.stdout.splitlines() == [
        *("G90G94F300G70G72(pin)", "T1(CNMG432)", "G97M03S1200(Face  1)", "M08", "G00X2Z.1", "G95F.005Z-.5"),
        *("X2.2", "G00Z.1", "M09", "M05", "M30"),
    ]


def test_millimeters_and_properties(tmp_path: Path) -> None:
    cut: list[Call] = [["onRapid", 10, 0, 2], ["onLinear", 10, 0, -5, 120]]
    properties = {"rapidRate": 5000, "changeZ": 50, "writeComments": False}
    done = run_post(
        tmp_path, section(*cut, feedMode="FEED_PER_MINUTE"), unit="MM", properties=properties, comment="pin"
    )
    assert done.stdout.splitlines() == [
        *("G90G94F5000G71G72", "T1", "G97M03S1200", "G00X20Z2", "G94F120Z-5", "G00Z50", "M05", "M30")
    ]


@pytest.mark.parametrize("clockwise", [True, False])
def test_direction_of_an_arc_follows_from_its_points(tmp_path: Path, clockwise: bool) -> None:
    """From X .5 Z 0 to X .6 Z -.1: convex around X .5 Z -.1, concave around X .6 Z 0."""
    begin: Call = ["onLinear", 0.5, 0, 0, 0.005]
    convex: Call = ["onCircular", clockwise, 0.5, 0, -0.1, 0.6, 0, -0.1, 0.005]
    concave: Call = ["onCircular", clockwise, 0.6, 0, 0, 0.6, 0, -0.1, 0.005]
    assert body(tmp_path, begin, convex)[1] == "G02X1.2Z-.1I0K-.1"
    assert body(tmp_path, begin, concave)[1] == "G03X1.2Z-.1I.1K0"


def test_surface_speed_in_both_units(tmp_path: Path) -> None:
    """4800 in/min are 400 ft/min, and 120000 mm/min are 120 m/min. T needs G97."""
    for unit, speed, shown in (("IN", 4800, "400"), ("MM", 120_000, "120")):
        tool = {"number": 1, "surfaceSpeed": speed, "maximumSpindleSpeed": 2500}
        done = run_post(
            tmp_path, section(START, tool=tool), section(START, tool={**RPM, "number": 2}), unit=unit
        )
        lines = done.stdout.splitlines()
        assert lines[2:4] == ["G77S2500", f"G96M03S{shown}"]
        assert lines[5:7] == ["G97M05", "T2"]


CYCLE = {"clearance": 0.2, "retract": 0.1, "bottom": -0.5, "feedrate": 0.004}


@pytest.mark.parametrize(
    ("kind", "values", "lines"),
    [
        ("drilling", {}, ["G95F.004G81Z-.5"]),
        ("deep-drilling", {"incrementalDepth": 0.15}, ["G95F.004G83Z-.5K.15"]),
        ("chip-breaking", {"incrementalDepth": 0.15}, ["G95F.004G83Z-.5K.15"]),
        ("counter-boring", {"dwell": 0.5}, ["G95F.004Z-.5", "G04F.5"]),
    ],
)
def test_drilling_cycles(tmp_path: Path, kind: str, values: dict[str, float], lines: list[str]) -> None:
    cycle: Call = ["cycle", kind, {**CYCLE, **values}]
    drilled = body(tmp_path, cycle, ["onCyclePoint", 0, 0, -0.5], ["onCycleEnd"])
    assert drilled == ["Z.2", "X0", "Z.1", *lines, "G00Z.2"]


def test_tool_below_the_clearance_plane_moves_first_in_z(tmp_path: Path) -> None:
    """After a cut to Z -.4 at X 1, the diagonal to X 0 Z .2 would cross the part."""
    cut: Call = ["onLinear", 1.0, 0, -0.4, 0.005]
    drilled = body(tmp_path, cut, ["cycle", "drilling", CYCLE], ["onCyclePoint", 0, 0, -0.5], ["onCycleEnd"])
    assert drilled == ["G95F.005Z-.4", "G00Z.2", "X0", "Z.1", "G95F.004G81Z-.5", "G00Z.2"]


def test_tool_above_the_clearance_plane_moves_directly_to_the_hole(tmp_path: Path) -> None:
    """Each point of the diagonal from X 1 Z .3 to X 0 Z .2 is above the clearance plane."""
    drilled = body(
        tmp_path,
        ["onRapid", 1.0, 0, 0.3],
        ["cycle", "drilling", CYCLE],
        ["onCyclePoint", 0, 0, -0.5],
        ["onCycleEnd"],
    )
    assert drilled[:3] == ["Z.3", "X0Z.2", "Z.1"]


def test_thread_passes_return_to_the_start_point(tmp_path: Path) -> None:
    """A second pass with a taper of .01 in per side ends at X .48, so it begins at X .47."""
    passes: list[Call] = [
        ["cycle", "thread-turning", {"pitch": 0.05, "incrementalX": 0, "incrementalZ": -0.6}],
        ["onCyclePoint", 0.49, 0, -0.5],
        ["cycle", "thread-turning", {"pitch": 0.05, "incrementalX": 0.01, "incrementalZ": -0.59}],
        ["onCyclePoint", 0.48, 0, -0.5],
    ]
    assert body(tmp_path, *passes) == [
        *("G33X.98Z-.5I.0001K.05O", "Z.09", "G33X.94Z-.5I.0001A.02K.05O", "Z.1"),
    ]


def test_programs_are_proved(turndesk: Turndesk, tmp_path: Path) -> None:
    turn = section(
        START,
        ["onRapid", 0.5, 0, 0.1],
        ["onLinear", 0.5, 0, 0, 0.005],
        ["onCircular", False, 0.5, 0, -0.1, 0.6, 0, -0.1, 0.005],
        ["onLinear", 0.6, 0, -0.4, 0.005],
        ["onRapid", 1.0, 0, -0.4],
        tool={"number": 1, "surfaceSpeed": 2400, "maximumSpindleSpeed": 2500},
    )
    cycle = {**CYCLE, "incrementalDepth": 0.15}
    drill = section(
        START, ["cycle", "deep-drilling", cycle], ["onCyclePoint", 0, 0, -0.5], tool={**RPM, "number": 2}
    )
    thread = section(
        ["onRapid", 0.7, 0, 0.3],
        ["cycle", "thread-turning", {"pitch": 0.05}],
        *(["onCyclePoint", x, 0, -0.3] for x in (0.59, 0.58, 0.575)),
        tool={"number": 3, "spindleRPM": 500},
    )
    path = tmp_path / "part.nc"
    path.write_text(run_post(tmp_path, turn, drill, thread).stdout)
    proof = turndesk("prove", path)
    assert (proof.status, "error" in proof.out) == (0, False), proof.out + proof.err


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"calls": [["onLinear", 1, 0, 0, 0.005]]}, "position before"),
        ({"calls": [START, ["onLinear", 1, 0, 0, 0]]}, "feed is 0"),
        ({"calls": [["onRapid", 1, 0.5, 0]]}, "Y is not 0"),
        ({"calls": [["onRapid5D", 1, 0, 0, 1, 0, 0]]}, "rotary"),
        ({"calls": [START, ["onCircular", True, 1, 0, 0, 1, 0, 0, 1]], "plane": "PLANE_XY"}, "XZ plane"),
        ({"calls": [["radiusCompensation", "RADIUS_COMPENSATION_LEFT"]]}, "In computer"),
        ({"calls": [START, ["cycle", "boring", CYCLE], ["onCyclePoint", 0, 0, -0.5]]}, "cycle boring"),
        ({"calls": [START, ["cycle", "tapping", CYCLE], ["onCyclePoint", 0, 0, -0.5]]}, "pitch of the tap"),
        ({"calls": [START, ["cycle", "drilling", CYCLE], ["onCyclePoint", 1, 0, -0.5]]}, "spindle axis"),
        ({"calls": [START, ["cycle", "deep-drilling", CYCLE], ["onCyclePoint", 0, 0, -0.5]]}, "peck depth"),
        ({"calls": [["cycle", "thread-turning", {}], ["onCyclePoint", 1, 0, 0]]}, "position before"),
        ({"calls": [START, ["cycle", "thread-turning", {}], ["onCyclePoint", 1, 0, 0]]}, "pitch"),
        ({"calls": [["onCommand", "COMMAND_TOOL_MEASURE"]]}, "COMMAND_TOOL_MEASURE"),
        ({"calls": [["onPassThrough", "G28"]]}, "G28"),
        ({"tool": {"number": 33, "spindleRPM": 100}}, "T33"),
        ({"tool": {"number": 1, "spindleRPM": 0}}, "speed is 0"),
        ({"type": "TYPE_MILLING"}, "start and stop the live tools"),
        ({"type": "TYPE_MILLING", "workPlane": [[0, 1, 0], [0, 0, 1], [0.6, 0, 0.8]]}, "tilted"),
        ({"multiAxis": True}, "tilted"),
        ({"workOffset": 2}, "position of work offset 2"),
    ],
)
def test_operations_without_an_equivalent_are_rejected(
    tmp_path: Path, values: dict[str, object], reason: str
) -> None:
    done = run_post(tmp_path, {**section(), **values})
    assert (done.returncode, done.stdout) == (1, "")
    assert reason in done.stderr


def test_thread_at_surface_speed_is_rejected(tmp_path: Path) -> None:
    calls: list[Call] = [START, ["cycle", "thread-turning", {"pitch": 0.05}], ["onCyclePoint", 0.9, 0, -0.3]]
    done = run_post(tmp_path, section(*calls, tool={"number": 1, "surfaceSpeed": 4800}))
    assert "constant spindle speed" in done.stderr
