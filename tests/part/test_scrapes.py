"""How little metal a rapid may scrape until it is found: .0013 in, on cones of any slope and on shoulders."""

from __future__ import annotations

import math

import pytest

from core.part.cutter import CutSide, Cutter
from core.part.stock import Stock
from core.part.tool_outline import make_tool_outline
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Cut, TurnedPart
from core.proving.checks.part_findings import RAPID_TOLERANCE_MM

NOSE = 0.4
TOOL = ToolShape(ToolKind.TURNING, tip=3, nose_radius=NOSE, insert="VNMG160404")
BOUND = 0.033  # mm; .0013 in


def scraped(slope: float, deep: float) -> Cut:
    """The nose goes along a cone that rises by ``slope`` degrees towards the chuck, ``deep`` mm in it."""
    rise = math.tan(math.radians(slope))
    cone = Stock("", ((-40.0, 5 + 10 * rise), (-20.0, 5 + 10 * rise), (-10.0, 5.0), (0.0, 5.0)))
    across, up = math.sin(math.radians(slope)), math.cos(math.radians(slope))

    def tip(z: float) -> tuple[float, float]:
        off = NOSE - deep
        return z + across * off - NOSE, 5.0 + (-10.0 - z) * rise + up * off - NOSE

    cutter = Cutter(make_tool_outline(TOOL).cutting_outlines, (), CutSide.OUTSIDE)
    return cutter.find_cut(TurnedPart(cone), tip(-13.0), tip(-16.0))


@pytest.mark.parametrize("slope", [0, 5, 15, 30, 45, 60, 75, 85])
def test_a_rapid_along_a_cone_is_found(slope: float) -> None:
    met = scraped(slope, BOUND)
    assert met.depth_mm > RAPID_TOLERANCE_MM
    assert met.width_mm > RAPID_TOLERANCE_MM
    assert not scraped(slope, -0.002)  # beside it


@pytest.mark.parametrize("place", [0.0, 0.001, 0.003, 0.005, 0.007])
def test_rapid_along_shoulder_is_found_at_any_column_position(place: float) -> None:
    wall = -10.0 - place
    step = Stock("", ((-40.0, 10.0), (wall, 10.0), (wall, 5.0), (0.0, 5.0)))
    cutter = Cutter(make_tool_outline(TOOL).cutting_outlines, (), CutSide.OUTSIDE)
    met = cutter.find_cut(TurnedPart(step), (wall - BOUND, 6.0), (wall - BOUND, 9.0))
    assert met.depth_mm > RAPID_TOLERANCE_MM
    assert met.width_mm > RAPID_TOLERANCE_MM
    assert not cutter.find_cut(TurnedPart(step), (wall + 0.005, 6.0), (wall + 0.005, 9.0))
