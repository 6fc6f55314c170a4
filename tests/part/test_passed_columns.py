"""Moves that stay outside of the columns that they pass cost no sweep, and meet what they would meet."""

from __future__ import annotations

import numpy as np
import pytest

from core.part import cutter as module
from core.part import swept_edge
from core.part.cutter import CutSide, Cutter
from core.part.stock import make_bar_stock
from core.part.swept_edge import Point
from core.part.turned_part import TurnedPart

EDGE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 4.0], [0.0, 4.0]])
HOLDER = EDGE + np.array([3.0, 1.0])


def part() -> TurnedPart:
    """A bar of radius 10, 40 long, turned to radius 5 from Z-20 on."""
    made = TurnedPart(make_bar_stock(20.0, 0.0, -40.0))
    turned = made.columns.find_column(-20.0)
    made.outer_radii[:, turned:] = 5.0
    return made


def counted(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    count, sweep = [0], swept_edge.sweep_edge

    def counting(*args: object) -> object:
        count[0] += 1
        return sweep(*args)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "sweep_edge", counting)
    return count


def test_max_radius_is_that_of_columns_in_range() -> None:
    assert part().find_max_radius(-15.0, -1.0) == 5.0
    assert part().find_max_radius(-30.0, -1.0) == 10.0
    assert part().find_max_radius(1.0, 5.0) == 0.0


@pytest.mark.parametrize("end", [(-15.0, 5.5), (-19.0, 5.1)])
def test_holder_clear_of_smaller_diameter_is_not_checked_in_detail(
    end: Point, monkeypatch: pytest.MonkeyPatch
) -> None:
    count = counted(monkeypatch)
    assert not Cutter([EDGE], [HOLDER], CutSide.OUTSIDE).cut_with_body(part(), (5.0, 5.5), end)
    assert count[0] == 0


@pytest.mark.parametrize(("end", "depth"), [((-15.0, 3.0), 1.0), ((-30.0, 5.5), 3.5)])
def test_a_holder_in_the_part_is_found(end: Point, depth: float) -> None:
    met = Cutter([EDGE], [HOLDER], CutSide.OUTSIDE).cut_with_body(part(), (5.0, end[1]), end)
    assert met.depth_mm == pytest.approx(depth, abs=1e-9)


def test_edge_of_rear_tool_is_found() -> None:
    rear = Cutter([EDGE * [1.0, -1.0]], (), CutSide.OUTSIDE, is_rear=True)
    assert rear.find_cut(part(), (-10.0, -4.0), (-12.0, -4.0)).depth_mm == pytest.approx(1.0)
    assert not rear.find_cut(part(), (-10.0, -5.5), (-12.0, -5.5))


def test_tool_without_edges_removes_nothing() -> None:
    assert not Cutter((), [HOLDER], CutSide.OUTSIDE).find_cut(part(), (-10.0, 1.0), (-12.0, 1.0))
