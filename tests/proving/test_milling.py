"""Live tools and turning tools on one part: what is turned off after milling leaves the field of rays too."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.part.cutter import CutSide, Cutter
from core.part.stock import make_bar_stock, make_tube_stock
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import TurnedPart
from core.proving.milling import MillingState, MillMove

DRILL = ToolShape(ToolKind.END_MILL, tip=8, diameter=4.0)
BLOCK = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 30.0], [0.0, 30.0]])


def cross_hole(milling: MillingState, z: float) -> float:
    """A hole of 4 mm square to the axis, through one wall to the axis; mm³."""
    path = np.array([[20.0, z, 0.0], [0.0, z, 0.0]])
    return milling.cut_material(MillMove(1, 1, path, False, False), DRILL).volume_mm3


def test_turning_after_milling_leaves_milled_hole_volume() -> None:
    part = TurnedPart(make_bar_stock(30.0, 0.0, -40.0))
    milling = MillingState(part)
    hole = cross_hole(milling, -30.0)
    assert hole == pytest.approx(math.pi * 4.0 * 15.0, rel=0.02)  # but for the round of the bar
    Cutter([BLOCK], [], CutSide.OUTSIDE).cut_material(part, (2.0, 10.0), (-15.0, 10.0))
    assert milling.remaining_volume_mm3 == pytest.approx(part.volume_mm3 - hole, rel=1e-3)


def test_a_face_groove_after_milling_leaves_its_core_and_its_ring() -> None:
    part = TurnedPart(make_bar_stock(30.0, 0.0, -40.0))
    milling = MillingState(part)
    hole = cross_hole(milling, -30.0)
    tool = Cutter([np.array([[0.0, 0.0], [0.0, 3.0], [20.0, 3.0], [20.0, 0.0]])], [], CutSide.FACE)
    tool.cut_material(part, (1.0, 7.0), (-6.0, 7.0))
    assert part.volume_mm3 == pytest.approx(math.pi * (225.0 * 40.0 - 51.0 * 6.0), rel=1e-3)
    assert milling.remaining_volume_mm3 == pytest.approx(part.volume_mm3 - hole, rel=1e-3)
    assert milling.updated_field.volume_mm3 == pytest.approx(milling.remaining_volume_mm3)


def test_boring_after_milling_can_remove_whole_part() -> None:
    part = TurnedPart(make_tube_stock(30.0, 10.0, 0.0, -40.0))
    milling = MillingState(part)
    cross_hole(milling, -30.0)
    borer = np.array([[0.0, 0.0], [0.0, -6.0], [30.0, -6.0], [30.0, 0.0]])
    Cutter([borer], [], CutSide.BORE).cut_material(part, (2.0, 8.0), (-20.0, 8.0))
    assert milling.remaining_volume_mm3 < part.volume_mm3
    Cutter([BLOCK], [], CutSide.OUTSIDE).cut_material(part, (-39.99, 20.0), (-39.99, 0.0))
    Cutter([BLOCK], [], CutSide.OUTSIDE).cut_material(part, (2.0, 0.0), (-41.0, 0.0))
    assert milling.remaining_volume_mm3 == pytest.approx(0.0, abs=1.0)
