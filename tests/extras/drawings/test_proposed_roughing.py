"""The depth of cut that is proposed for a drawing is the one that its program has."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.extras.drawings.drawing_plan import PlanRequest
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.drawings.hand import chain, dxf, planned

CNMG = ToolShape(ToolKind.TURNING, tip=3, insert="CNMG120408")


def test_drawing_form_shows_the_roughing_depth_of_its_program(tmp_path: Path) -> None:
    """A shaft of 12 mm and 18 mm out of steel, a bar of 19 mm: 1.016 mm by material, rounded down to 1.0."""
    points = (0.0, 0.0), (0.0, 6.0), (-10.0, 6.0), (-14.0, 9.0), (-20.0, 9.0), (-20.0, 0.0)
    path = dxf(tmp_path / "x.dxf", chain(*points))
    now = ProgramSettings(metric=True, material="STEEL", bar=1.0, shop=ShopData(tools={1: CNMG}))
    plan = planned(PlanRequest(path, {}, (), now))
    assert plan.proposed_values["ROUGH"] == pytest.approx(1.0)
    assert plan.program is not None
    assert any(line.startswith("G75I1U") for line in plan.program.lines)
    plan = planned(PlanRequest(path, {"ROUGH": 7.0}, (), now))
    assert "ROUGH" in plan.field_errors  # CNMG 12 takes 6.448 mm
