"""``turndesk profile``: each choice about a drawing acts; what stays of it is told."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from app.extras.drawings import profile_command
from tests.cli.conftest import Turndesk
from tests.cli.json_output import declared_alone, whole
from tests.extras.drawings.hand import chain, dxf
from tests.texts import shows
from tests.texts import text as wording

SHEET = """
[tool.1]
kind = "turning"
insert = "DNMG150404"
nose_radius = .0157
tip = 3
[tool.5]
kind = "grooving"
width = .0787
length = .3
tip = 3
[tool.6]
kind = "boring"
insert = "CCMT060204"
nose_radius = .0157
tip = 2
diameter = .3
"""


@pytest.fixture
def part(tmp_path: Path) -> Path:
    """A shoulder of 8 and 12 mm with a groove; a second contour, a ring, on its own layer."""

    def draw(space: Any) -> None:
        chain((0, 0), (0, 4), (-5, 4), (-5, 3), (-8, 3), (-8, 4), (-10, 4), (-10, 6), (-20, 6), (-20, 0))(
            space
        )
        ring = [(0, 10), (0, 15), (-6, 15), (-6, 10)]
        space.add_lwpolyline(ring, close=True, dxfattribs={"layer": "RING"})

    return dxf(tmp_path / "part.dxf", draw)


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    path = tmp_path / "tools.toml"
    path.write_text(SHEET)
    return path


def told(turndesk: Turndesk, *words: object) -> dict[str, Any]:
    done = turndesk("profile", *words, "--json")
    assert done.status == 0, done.err
    found: dict[str, Any] = json.loads(done.out)
    return found


def test_list_option_shows_contours_and_axes(turndesk: Turndesk, part: Path) -> None:
    told_ = turndesk("profile", part, "--list").out
    assert "unit 1 mm" in told_
    assert "layers: 0, RING" in told_
    assert "contour 1, axis Y 0: length 20 mm, diameter 12 mm, made up of 9 lines" in told_
    assert "contour 2, axis Y 0: length 6 mm, diameter 30 mm, made up of 4 lines" in told_
    listed = told(turndesk, part, "--list")
    assert [each["diameter_mm"] for each in listed["contours"]] == [12.0, 30.0]
    assert listed["axes"] == ["Y 0", "MIDDLE", "X 0"]


def test_program_goes_to_stdout_and_notes_to_stderr(turndesk: Turndesk, part: Path, sheet: Path) -> None:
    done = turndesk("profile", part, "--tools", sheet, "--metric", "--face", 1)
    assert done.status == 0, done.err
    assert done.out.startswith("G90G94F7620G71G72(HEAD METRIC")
    assert "(FACE" in done.out
    assert "(GROOVE FRONT SIDE 8 TOP 6 BOTTOM 5 AT" in done.out
    nose = {"number": 1, "x": "-.7976", "z": "-.3988", "radius": ".3988", "unit": "mm"}
    assert wording("shapes.secondary-must-have", **nose) in done.err
    assert wording("shapes.stock-in-corner", size=".248", unit="mm", z="-9.975") in done.err
    assert shows(done.err, "shapes.matches-elsewhere", unit="mm")


def test_program_is_written_to_a_file_and_reported_as_json(
    turndesk: Turndesk, part: Path, sheet: Path, tmp_path: Path
) -> None:
    out = tmp_path / "part.nc"
    found = told(turndesk, part, "--tools", sheet, "--out", out, "--bar", 0.5, "--material", "BRASS")
    assert out.read_text() == found["program"]
    assert "BRASS MATERIAL 0P5 BAR" in found["program"]
    assert found["secondary_offset"]["z"] == pytest.approx(-0.0157 * 25.4)
    assert not found["left"]
    (corner,) = found["deviations"]
    assert 0.0 < corner["most_mm"] < 0.4
    assert found["worst_mm"] < 0.02


def test_tool_depth_and_compensation_options_are_applied(turndesk: Turndesk, part: Path, sheet: Path) -> None:
    made = told(turndesk, part, "--tools", sheet, "--tool", 1, "--rough", 0.03, "--comp", 7)["program"]
    assert "I.03" in made
    assert "D7" in made
    assert "G41" not in told(turndesk, part, "--tools", sheet, "--comp", 0)["program"]
    assert "G75" not in told(turndesk, part, "--tools", sheet, "--rough", 0)["program"]
    found = told(turndesk, part, "--tools", sheet, "--groove-tool", 1)
    assert found["left"][0]["why"] == wording("shapes.no-groove-width", tool=1)


def test_layer_contour_and_bore_options_are_applied(turndesk: Turndesk, part: Path, sheet: Path) -> None:
    by_layer = told(turndesk, part, "--tools", sheet, "--layer", "RING")["program"]
    assert by_layer == told(turndesk, part, "--tools", sheet, "--contour", 2)["program"]
    found = told(turndesk, part, "--tools", sheet, "--contour", 2, "--side", "bore", "--hole", 0.5)
    assert found["side"] == "BORE"
    assert "X.7874Z0" in found["program"]  # 20 mm


def test_front_zero_and_shift_options_are_applied(turndesk: Turndesk, part: Path, sheet: Path) -> None:
    """From the left the shaft of 12 is in front, and the drawing's origin lies 20 mm behind its face."""
    made = told(turndesk, part, "--tools", sheet, "--metric", "--front", "left", "--zero", "origin")[
        "program"
    ]
    assert "X12Z20" in made
    made = told(turndesk, part, "--tools", sheet, "--metric", "--zero", "back", "--shift", -20)["program"]
    assert "X8Z" in made


def test_axis_and_gap_options_are_applied(turndesk: Turndesk, tmp_path: Path, sheet: Path) -> None:
    path = dxf(tmp_path / "up.dxf", chain((0, 0), (-4, 0), (-4, -10), (0, -10)))
    made = told(turndesk, path, "--tools", sheet, "--metric", "--axis", "X 0")["program"]
    assert "X8Z" in made

    def loose(space: Any) -> None:
        space.add_line((0, 4), (-10, 4))
        space.add_line((-10.1, 4), (-20, 5))

    path = dxf(tmp_path / "loose.dxf", loose)
    assert len(told(turndesk, path, "--axis", "Y 0", "--list")["contours"]) == 2
    assert len(told(turndesk, path, "--axis", "Y 0", "--gap", 0.2, "--list")["contours"]) == 1
    assert turndesk("profile", path, "--gap", 5).code == "gap"


def test_drawing_without_a_unit_needs_the_unit_option(
    turndesk: Turndesk, tmp_path: Path, sheet: Path
) -> None:
    path = dxf(tmp_path / "none.dxf", chain((0, 0), (0, 0.25), (-1, 0.25), (-1, 0)), unit=0)
    assert turndesk("profile", path).code == "no-unit"
    assert "X.5Z0" in told(turndesk, path, "--tools", sheet, "--unit", "inch")["program"]


def test_a_metric_machine_makes_a_metric_program(turndesk: Turndesk, part: Path, tmp_path: Path) -> None:
    text = files("resources").joinpath("machines/gt75.toml").read_text()
    metric = tmp_path / "metric.toml"
    metric.write_text(
        text.replace('units = "inch"', 'units = "mm"').replace("travel = [-4.0, 4.0]", "travel = [-100, 100]")
    )
    done = turndesk("profile", part, "--machine", metric)
    assert "G71" in done.out, done.err


@pytest.mark.parametrize(
    ("words", "code", "value"),
    [
        (["--layer", "NONE"], "no-layer", "NONE"),
        (["--contour", "3"], "which-contour", "--contour 1 to 2"),
        (["--axis", "Q"], "no-axis", "Q"),
        (["--side", "bore"], "no-hole", "--hole"),
        (["--bar", "0.3", "--contour", "1"], "refused-shape", "0.3"),
        (["--out", "/nowhere/x.nc"], "no-folder", "/nowhere/x.nc"),
    ],
)
def test_invalid_option_is_rejected_in_one_line(
    turndesk: Turndesk, part: Path, words: list[str], code: str, value: str
) -> None:
    done = turndesk("profile", part, *words)
    assert (done.status, done.code) == (2, code)
    assert value in done.err
    assert done.err.count("\n") == 1


def test_existing_program_is_never_overwritten(turndesk: Turndesk, part: Path, tmp_path: Path) -> None:
    out = tmp_path / "mine.nc"
    out.write_text("M30\n")
    done = turndesk("profile", part, "--out", out)
    assert (done.status, done.code) == (2, "file-exists")
    assert out.read_text() == "M30\n"


def test_missing_or_unsupported_drawing_is_rejected(turndesk: Turndesk, tmp_path: Path) -> None:
    assert turndesk("profile", tmp_path / "none.dxf").code == "unreadable"
    assert turndesk("profile", tmp_path / "none.step").code == "not-a-drawing"


@pytest.mark.long
def test_the_json_has_the_declared_keys(turndesk: Turndesk, tmp_path: Path) -> None:
    sheet = tmp_path / "tools.toml"
    sheet.write_text(SHEET)

    def draw(space: Any) -> None:
        chain((0, 0), (0, 4), (-5, 4), (-5, 3), (-8, 3), (-8, 4), (-10, 4), (-10, 6), (-20, 6), (-20, 0))(
            space
        )
        space.add_text("X")

    path = dxf(tmp_path / "part.dxf", draw)
    words = ("profile", path, "--tools", sheet, "--json")
    values = [
        whole(turndesk(*words)),
        whole(turndesk(*words, "--groove-tool", 1)),
        whole(turndesk(*words, "--out", tmp_path / "part.mpf")),
    ]
    declared_alone(values, profile_command.PROFILE_OUTPUT.keys)
    declared_alone(
        [whole(turndesk("profile", path, "--list", "--json"))], profile_command.PROFILE_LIST_OUTPUT.keys
    )
