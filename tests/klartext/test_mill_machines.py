"""Machines of other kinds from their files to the end of a run: heads, B-C tables, a single rotary axis."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from app.compose.machine.kinematics_chain import build_kinematics
from app.compose.machine.machine_files import parse_machine
from resources import read_machine_file
from tests.cli.conftest import Turndesk, home, offsets, turndesk
from tests.klartext.running import whole

__all__ = ["home", "offsets", "turndesk"]
FILE = read_machine_file("ac-table-mill.toml")
HEAD = """TOOL CALL 1 Z S3000 F500
L X+50 Y+50 Z+60 R0 FMAX M3
"""
# Chamfer of the right side of a block of 100, told without naming an axis.
POINTS = """TRANS DATUM AXIS X+90
PLANE POINTS P1X+0 P1Y+0 P1Z+0 P2X+0 P2Y+1 P2Z+0 P3X-1 P3Y+0 P3Z+1 TURN MB MAX FMAX
L X+20 Y-7 Z+2 R0 FMAX
L Z+0 F300
L X+80 F1000
PLANE RESET TURN MB MAX FMAX
"""


def as_head(text: str, name: str) -> str:
    """One of the table's axes moved into the head, 150 mm above the nose."""
    start = text.index(f"[kinematics.{name}]")
    end = text.index("\n[", start)
    table = re.sub(r"point = .*", "point = [0.0, 0.0, 150.0]", text[start:end].replace('"table"', '"head"'))
    return text[:start] + table + text[end:]


def as_b(text: str) -> str:
    """B about Y where A about X was."""
    text = text.replace("[axis.A]", "[axis.B]").replace("[kinematics.A]", "[kinematics.B]")
    return text.replace('direction = "X"', 'direction = "Y"').replace(
        "point = [0.0, 250.0, -430.0]", "point = [250.0, 0.0, -430.0]"
    )


def without(text: str, name: str) -> str:
    """A machine without this axis."""
    for table in (f"[axis.{name}]", f"[kinematics.{name}]"):
        start = text.index(table)
        text = text[:start] + text[text.index("\n[", start) + 1 :]
    return text


MACHINES = {
    "A head over C table": as_head(FILE, "A"),
    "fork head": as_head(as_head(FILE, "A"), "C"),
    "B-C table": as_b(FILE),
    "B head over C table": as_head(as_b(FILE), "B"),
}


def file_of(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "machine.toml"
    path.write_text(text.replace("travel = [-600.0, 0.0]", "travel = [-900.0, 0.0]"))
    return path


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.long
def test_a_chamfer_is_cut_on_any_machine(
    turndesk: Turndesk, tmp_path: Path, offsets: Path, name: str
) -> None:
    machine, part = file_of(tmp_path, MACHINES[name]), tmp_path / "part.h"
    part.write_text(whole(HEAD + POINTS))
    told = turndesk("run", part, "--machine", machine, "--headless", "--offsets", offsets, "--json")
    assert told.status == 0, told.err
    assert told.lines[-1]["state"] == "complete"
    blocks = turndesk("expand", part, "--machine", machine, "--offsets", offsets, "--json").lines
    cut = next(block for block in blocks if block["kind"] == "feed" and block["feed"] == 1000.0)
    assert (cut["x"], cut["y"], cut["z"]) == pytest.approx((80.0, -7.0, 0.0), abs=1e-6)
    plane = next(block for block in blocks if block["kind"] == "plane")
    assert [row[2] for row in plane["frame"]] == pytest.approx([0.70710678, 0.0, 0.70710678])


def test_single_tilting_axis_cuts_planes_across_it(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> None:
    machine, part = file_of(tmp_path, without(FILE, "C")), tmp_path / "part.h"
    part.write_text(whole(HEAD + "PLANE AXIAL A+45 TURN MB MAX FMAX\nL X+0 Y+0 Z+2 FMAX\nL Z+0 F200"))
    told = turndesk("run", part, "--machine", machine, "--headless", "--offsets", offsets, "--json")
    assert told.status == 0, told.err
    assert "c" not in told.lines[-1]["final"]
    part.write_text(whole(HEAD + POINTS))
    told = turndesk("prove", part, "--machine", machine, "--offsets", offsets, "--json")
    assert told.lines[0]["diagnostics"][0]["code"] == "Entered angle not permitted"
    part.write_text(whole(HEAD + "PLANE AXIAL C+10 TURN FMAX"))
    told = turndesk("prove", part, "--machine", machine, "--offsets", offsets, "--json")
    assert told.lines[0]["diagnostics"][0]["code"] == "Wrong axis programmed"


def test_mill_without_rotary_axes_runs_programs_without_tilt(
    turndesk: Turndesk, tmp_path: Path, offsets: Path
) -> None:
    machine, part = file_of(tmp_path, without(without(FILE, "A"), "C")), tmp_path / "part.h"
    part.write_text(whole(HEAD + "L X+10 Y+20 F500\nPLANE RESET STAY"))
    told = turndesk("run", part, "--machine", machine, "--headless", "--offsets", offsets, "--json")
    assert told.status == 0, told.err
    part.write_text(whole(HEAD + "PLANE SPATIAL SPA+45 SPB+0 SPC+0 TURN FMAX"))
    told = turndesk("prove", part, "--machine", machine, "--offsets", offsets, "--json")
    assert told.lines[0]["diagnostics"][0]["code"] == "Entered angle not permitted"


@pytest.mark.parametrize("name", MACHINES)
def test_kinematic_chain_matches_machine_file(name: str) -> None:
    made = build_kinematics(parse_machine(MACHINES[name], "m"))
    assert made is not None
    assert [axis.is_table for axis in made.rotary_axes] == sorted(
        (axis.is_table for axis in made.rotary_axes), reverse=True
    )
    assert made.rotary_axes[0].name == "C"
