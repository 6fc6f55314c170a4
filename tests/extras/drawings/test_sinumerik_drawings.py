"""Drawings as SINUMERIK programs: CYCLE95 between labels, G41 and G42 by the cutting edge, grooves."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from app.cli.main import main
from app.extras.drawings.profile_trial import TrialResult, TrialStock, run_profile_trial
from core.extras.drawings.drawing_placement import ContourProfile, ContourSide
from core.extras.drawings.profile_description import convert_to_json, describe_program
from core.extras.drawings.profile_program import ProfileProgram
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from core.extras.shapes.shape_pieces import find_program_shapes
from core.language.source import Dialect
from core.tool_edges import TIP_DIRECTIONS
from tests.coded import recorded_refusals
from tests.extras.drawings.hand import TOOLS, chain, dxf, profile_of, program, text_of
from tests.sinumerik.lathe import LINEAR
from tests.texts import text as wording

OURS = Dialect.SINUMERIK
SHAFT = (
    (0, 0),
    (0, 5),
    (-1, 6),
    (-9, 6),
    (-9, 4),
    (-11, 4),
    (-11, 6),
    (-16, 6),
    (-18, 10, 0.2),
    (-26, 10),
    (-26, 0),
)


def of(
    chosen: ContourProfile, bar: float, hole: float = 0.0, **typed: Any
) -> tuple[ProfileProgram, TrialResult]:
    """The program, and its proof on the shipped lathe."""
    made = program(chosen, dialect=OURS, **typed)
    stock = TrialStock(bar, typed.get("STOCK", 0.5), hole)
    return made, run_profile_trial(
        text_of(made), chosen, stock, made.nose_offset, LINEAR, TOOLS, dialect=OURS
    )


def test_a_shaft_is_faced_roughed_finished_and_grooved(tmp_path: Path) -> None:
    """The part is the drawing within .02 mm; each piece opens in its form."""
    chosen = profile_of(dxf(tmp_path / "shaft.dxf", chain(*SHAFT)))
    made, trial = of(chosen, 21.0)
    assert not trial.errors
    assert trial.comparison is not None
    assert trial.comparison.worst_deviation_mm < 0.02, trial.comparison.deviations
    text = text_of(made).splitlines()
    assert text[0].startswith("G54 G18 G90 G95 G710 DIAMON ; HEAD ")
    assert {"G42", "CONTOUR_1:", "CONTOUR_1_END:"} <= set(text)
    found = find_program_shapes(text, ShopData(tools=TOOLS), ProgramSettings(dialect=OURS))
    assert [(each.shape_instance.shape.name, each.edited_line) for each in found] == [
        ("HEAD", -1), ("FACE", -1), ("TURN", -1), ("GROOVE", -1)
    ]  # fmt: skip


def test_a_bore_is_cut_left_of_its_contour(tmp_path: Path) -> None:
    ring = [(0, 13), (0, 20), (-40, 20), (-40, 8), (-15, 8), (-15, 12), (-1, 12), (0, 13)]
    chosen = profile_of(dxf(tmp_path / "ring.dxf", chain(*ring)), side=ContourSide.INSIDE, axis="Y 0")
    made, trial = of(chosen, 45.0, 14.0, HOLE=14.0, STOCK=0.0)
    assert "G41" in made.lines
    assert not trial.errors
    assert trial.comparison is not None
    assert trial.comparison.worst_deviation_mm < 0.02, trial.comparison.deviations


def test_required_cutting_edge_data_is_reported(tmp_path: Path) -> None:
    """The nose of DNMG150404 is .4 mm; a tip at the right front is quadrant 3. D is the edge, not T."""
    chosen = profile_of(dxf(tmp_path / "shaft.dxf", chain(*SHAFT)))
    made = program(chosen, dialect=OURS)
    assert TIP_DIRECTIONS[3] == (-1, -1)
    words = wording("shapes.edge-must-have", edge="T1 D1", radius=".4", unit="mm", quadrant=3)
    assert words in list(describe_program(made, None, chosen, is_metric=True))
    told = convert_to_json(made, None, chosen)
    assert (told["secondary_offset"], told["cutting_edge"]) == (
        None, {"tool": 1, "edge": 1, "r": 0.4, "quadrant": 3}
    )  # fmt: skip


def test_proof_reports_stock_left_without_a_nose_radius(tmp_path: Path) -> None:
    """A cone of 45 degrees cut by the bare tip stands off it by R (2 - sqrt 2) along the radius: .234."""
    chosen = profile_of(dxf(tmp_path / "cone.dxf", chain((0, 0), (0, 5), (-8, 13), (-20, 13), (-20, 0))))
    made, trial = of(chosen, 27.0, COMP=0.0)
    assert made.nose_offset is None
    assert trial.comparison is not None
    (stays,) = [each.max_deviation_mm for each in trial.comparison.deviations if each.front_z_mm > -8.0]
    assert stays == pytest.approx(0.4 * (2.0 - math.sqrt(2.0)), abs=0.02)


def test_falling_contour_leaves_the_usual_finishing_allowance(tmp_path: Path) -> None:
    """CYCLE95 reckons with the nose, so no more has to stay than on a cylinder."""
    drop = 5.0 * math.tan(math.radians(20.0))
    points = ((0, 0), (0, 10), (-8, 10), (-13, 10 - drop), (-30, 10 - drop), (-30, 0))
    made, trial = of(profile_of(dxf(tmp_path / "fall.dxf", chain(*points))), 21.0)
    assert any(", , , 0.25, " in line for line in made.lines if line.startswith("CYCLE95"))
    assert not trial.errors
    assert trial.comparison is not None
    assert trial.comparison.worst_deviation_mm < 0.02


def test_command_writes_the_language_of_the_file_extension(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drawing, out = dxf(tmp_path / "shaft.dxf", chain(*SHAFT)), tmp_path / "shaft.mpf"
    machine = Path(__file__).parents[3] / "resources" / "machines" / "sinumerik-linear.toml"
    assert main(["profile", str(drawing), "--out", str(out), "--machine", str(machine), "--bar", "22"]) == 0
    assert out.read_text(encoding="ascii").startswith("G54 G18 G90 G95 G710 DIAMON ; HEAD ")
    assert main(["profile", str(drawing), "--machine", str(machine), "--bar", "22"]) == 0
    assert capsys.readouterr().out.startswith("G54 G18 G90 G95 G710 DIAMON ; HEAD ")


def test_the_command_refuses_klartext(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    refusals = recorded_refusals(monkeypatch)
    drawing = dxf(tmp_path / "shaft.dxf", chain(*SHAFT))
    assert main(["profile", str(drawing), "--out", str(tmp_path / "shaft.h")]) != 0
    assert [each.code for each in refusals] == ["wrong-language"]
    assert not (tmp_path / "shaft.h").exists()
