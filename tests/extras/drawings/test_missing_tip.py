"""A nose radius without a tip quadrant: named as the cause, instead of a part that is too small."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from core.extras.drawings.drawing import DrawingError
from core.language.source import Dialect
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.drawings.hand import RIGHT, chain, dxf, profile_of, program, text_of
from tests.texts import text

SHAFT = chain((0.0, 0.0), (0.0, 6.0), (-10.0, 6.0), (-14.0, 9.0), (-20.0, 9.0), (-20.0, 0.0))
NO_TIP = replace(RIGHT, tip=0)


@pytest.mark.parametrize("dialect", [Dialect.OMNITURN, Dialect.SINUMERIK])
@pytest.mark.parametrize("tool", [NO_TIP, ToolShape(ToolKind.TURNING, insert="DNMG150404")])
def test_nose_radius_without_tip_quadrant_is_rejected(
    tool: ToolShape, dialect: Dialect, tmp_path: Path
) -> None:
    chosen = profile_of(dxf(tmp_path / "x.dxf", SHAFT))
    with pytest.raises(DrawingError) as told:
        program(chosen, {1: tool}, dialect=dialect)
    assert told.value.code == "no-tip-quadrant"
    assert text("shapes.no-tip-quadrant", tool=1, radius=0.4) in str(told.value)


@pytest.mark.parametrize("tool", [RIGHT, replace(RIGHT, tip=9), ToolShape(ToolKind.TURNING)])
def test_tip_quadrant_or_zero_nose_radius_is_accepted(tool: ToolShape, tmp_path: Path) -> None:
    assert text_of(program(profile_of(dxf(tmp_path / "x.dxf", SHAFT)), {1: tool}))
