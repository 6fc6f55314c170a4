"""The commands on tilted programs: prove, expand, trace, run; the shipped machine is that of the tables."""

from __future__ import annotations

import csv
import dataclasses
import re
from pathlib import Path

import pytest

from app.cli.main import main
from app.compose.machine.kinematics_chain import build_kinematics
from app.compose.machine.machine_files import load_shipped_machine, parse_machine
from core.table_schema import MachineFileError
from resources import read_machine_file
from tests.cli.conftest import Turndesk, home, offsets, turndesk
from tests.klartext.chamfers import AXIAL, POINTS
from tests.klartext.running import TOOL, whole
from tests.klartext.table import AC

pytestmark = pytest.mark.long

__all__ = ["home", "offsets", "turndesk"]
MILL = ("--machine", "ac-table-mill")


@pytest.fixture
def written(tmp_path: Path) -> Path:
    path = tmp_path / "fourside.h"
    path.write_text(AXIAL)
    return path


def test_shipped_mill_matches_kinematics_of_test_tables() -> None:
    made = build_kinematics(load_shipped_machine("ac-table-mill"))
    assert made is not None
    assert made.axis_order == AC.axis_order
    assert made.origin == AC.origin
    assert made.basic_rotation_deg == 0.0
    for here, there in zip(made.rotary_axes, AC.rotary_axes, strict=True):
        assert dataclasses.replace(here, vmax=there.vmax) == there
        assert here.vmax == pytest.approx(there.vmax)


def test_prove_reports_limits_and_final_position(turndesk: Turndesk, written: Path, offsets: Path) -> None:
    told = turndesk("prove", written, *MILL, "--offsets", offsets, "--json")
    assert told.status == 0
    (report,) = told.lines
    assert (report["dialect"], report["units"], report["diagnostics"]) == ("klartext", "mm", [])
    assert report["cutting_length"] == pytest.approx(4 * (130.0 + 3.0))
    assert report["limits"]["a"] == [0.0, 45.0]
    assert report["limits"]["x"] == pytest.approx([215.0, 385.0])  # chamfers 1 and 3: 230 - 15, 270 + 115
    assert report["final"]["c"] == 0.0


def test_prove_names_the_message_of_the_control(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = tmp_path / "bad.h"
    path.write_text(whole(TOOL + "PLANE AXIAL B+10 TURN FMAX"))
    told = turndesk("prove", path, *MILL, "--offsets", offsets, "--json")
    assert told.status == 1
    (found,) = told.lines[0]["diagnostics"]
    assert (found["code"], found["line"], found["column"]) == ("Wrong axis programmed", 3, 13)


def test_expand_as_json_lists_blocks(turndesk: Turndesk, written: Path, offsets: Path) -> None:
    told = turndesk("expand", written, *MILL, "--offsets", offsets, "--json")
    assert told.status == 0
    planes = [block for block in told.lines if block["kind"] == "plane"]
    assert len(planes) == 9
    second = planes[2]
    assert second["frame"] == [
        pytest.approx([0.0, -0.70710678, 0.70710678]),
        [1.0, 0.0, 0.0],
        pytest.approx([0.0, 0.70710678, 0.70710678]),
    ]
    assert (second["q120"], second["q121"], second["q122"]) == (45.0, 0.0, 90.0)
    assert (second["a"], second["b"], second["c"]) == (45.0, None, 90.0)
    cut = next(block for block in told.lines if block["kind"] == "feed" and block["feed"] == 600.0)
    assert (cut["x"], cut["y"], cut["z"]) == pytest.approx((115.0, -7.071, 0.0))
    assert (cut["mx"], cut["my"], cut["mz"]) == pytest.approx((345.0, 278.2843, -352.2183), abs=6e-5)
    assert (cut["feed_mode"], cut["units"]) == ("mm/min", "mm")
    assert 0.0 < cut["t0"] < cut["t1"]
    assert "frame" not in cut


def test_expand_as_text_lists_positions_and_feeds(turndesk: Turndesk, written: Path, offsets: Path) -> None:
    told = turndesk("expand", written, *MILL, "--offsets", offsets)
    row = next(line for line in told.out.splitlines() if "L X+115 F600" in line)
    for shown in ("115.0000", "-7.0710", "45.000", "600.0/m"):
        assert shown in row


def test_trace_has_a_column_for_every_axis(turndesk: Turndesk, written: Path, tmp_path: Path) -> None:
    out = tmp_path / "t.csv"
    told = turndesk("trace", written, *MILL, "--dt", "0.01", "--out", out)
    assert told.status == 0
    with out.open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["t", "x", "y", "z", "a", "c", "spindle_deg", "line"]
    lowest = min(rows, key=lambda row: float(row["z"]))
    assert float(lowest["z"]) == pytest.approx(-360.7035, abs=6e-5)  # mm, not inches
    assert float(rows[-1]["c"]) == pytest.approx(360.0)


@pytest.mark.parametrize("text", [AXIAL, POINTS])
def test_run_completes_klartext_program(turndesk: Turndesk, tmp_path: Path, offsets: Path, text: str) -> None:
    path = tmp_path / "part.h"
    path.write_text(text)
    told = turndesk("run", path, *MILL, "--headless", "--offsets", offsets, "--json")
    assert told.status == 0, told.err
    end = told.lines[-1]
    assert (end["state"], end["alarms"], end["underruns"]) == ("complete", [], 0)
    assert (end["final"]["a"], end["final"]["c"]) == (0.0, 0.0)
    assert end["final"]["mz"] == pytest.approx(-0.001)


EVERY_WAY = """TOOL CALL 1 Z S3000 F600
L X+20 Y+10 Z+80 R0 FMAX M13
PLANE AXIAL A+30 C+60 MOVE DIST20 MB 10 F3600
L Z+20 FMAX
L IX+10 IY+5 IZ-1 F800
PLANE SPATIAL SPA+20 SPB+10 SPC+0 STAY SEQ+
L A+Q120 C+Q122 FMAX
L X+20 Y+10 Z+30 FMAX M140 MB 5
PLANE RELATIV SPC+15 TURN MB MAX FMAX
L Z-150 FMAX M91
PLANE RESET MOVE FMAX
LBL 4
L IX+1 F100 M9
CALL LBL 4 REP 2
"""


@pytest.mark.parametrize("unit", ["MM", "INCH"])
def test_run_completes_every_positioning_option(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, unit: str
) -> None:
    path = tmp_path / "ways.h"
    text = EVERY_WAY
    if unit == "INCH":
        text = re.sub(r"\b(I?[XYZ][+-])(\d+)", lambda m: f"{m[1]}{int(m[2]) / 25.4:.4f}", text)
    path.write_text(whole(text, unit))
    told = turndesk("run", path, *MILL, "--headless", "--offsets", offsets, "--json")
    assert told.status == 0, told.err
    end = told.lines[-1]
    assert (end["state"], end["alarms"], end["underruns"]) == ("complete", [], 0)
    assert (end["final"]["a"], end["final"]["c"]) == pytest.approx((0.0, 0.0), abs=1e-6)


def test_run_stops_for_tool_without_offset(turndesk: Turndesk, written: Path, tmp_path: Path) -> None:
    nothing = tmp_path / "none.toml"
    nothing.write_text("")
    told = turndesk("run", written, *MILL, "--headless", "--offsets", nothing)
    assert told.status == 1
    assert "T1" in told.err


def test_lathe_rejects_klartext_and_mill_rejects_omniturn(turndesk: Turndesk, written: Path) -> None:
    told = turndesk("prove", written, "--machine", "gt75")
    assert told.status == 1
    assert "ac-table-mill" in told.out
    other = written.with_suffix(".nc")
    other.write_text("G90G94F300\nM30\n")
    assert turndesk("prove", other, *MILL).status == 1


def test_a_block_past_a_software_limit_is_refused(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    path = tmp_path / "far.h"
    path.write_text(whole(TOOL + "L X+480 FMAX\nL X+0 A+130 FMAX"))
    told = turndesk("prove", path, *MILL, "--offsets", offsets, "--json")
    found = told.lines[0]["diagnostics"]
    assert [(d["code"], d["line"]) for d in found] == [("soft-limit", 3), ("soft-limit", 4)]
    assert "A would move to 130.000 degrees" in found[1]["message"]


@pytest.mark.parametrize(
    ("old", "new", "named"),
    [
        ('side = "table"\norder = 1', 'side = "floor"\norder = 1', "kinematics.C.side"),
        ("order = 2", "order = 1", "kinematics.C.order"),
        ('direction = "X"', 'direction = "Z"', "kinematics.A.direction"),
        ("point = [0.0, 250.0, -430.0]", "point = [250.0, -430.0]", "kinematics.A.point"),
        ("point = [0.0, 250.0, -430.0]", "", "kinematics.A.point"),
        ("[kinematics.A]", "[kinematics.B]", "kinematics.B"),
        ("origin =", "zero =", "kinematics.zero"),
        ("modulo = true", "modulo = 1", "kinematics.C.modulo"),
        (
            "[axis.C]                        # endless",
            "[axis.C]\ntravel = [-10.0, 10.0]",
            "kinematics.C.modulo",
        ),
        ('side = "table"\norder = 1', 'side = "head"\norder = 1', "kinematics.A.order"),
    ],
)
def test_invalid_axis_chain_in_machine_file_is_rejected(old: str, new: str, named: str) -> None:
    text = read_machine_file("ac-table-mill.toml")
    assert old in text
    with pytest.raises(MachineFileError) as caught:
        parse_machine(text.replace(old, new, 1), "mill")
    assert named in str(caught.value)


def test_mill_without_kinematics_rejects_klartext(turndesk: Turndesk, written: Path, tmp_path: Path) -> None:
    text = read_machine_file("ac-table-mill.toml")
    start, end = text.index("[kinematics]"), text.index("[spindle]")
    path = tmp_path / "bare.toml"
    path.write_text(text[:start] + text[end:])
    told = turndesk("prove", written, "--machine", path)
    assert told.status == 1
    assert "[kinematics]" in told.out


def test_machine_check_names_the_mill(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["machine", "check", "resources/machines/ac-table-mill.toml"]) == 0
    assert "A-C table" in capsys.readouterr().out
