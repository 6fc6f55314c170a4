"""Drawings saved in the wrong unit: one error with the size and the unit in which the contour would fit."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.extras.drawings.drawing_plan import PlanRequest
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from tests.extras.drawings.hand import chain, dxf, planned

INCH, FOOT, MM, METRE = 1, 2, 4, 6  # $INSUNITS
TRAVEL = (150.0, 200.0)  # mm, X as a radius and Z


def shaft(path: Path, unit: int, long: float, radius: float) -> Path:
    points = (0.0, 0.0), (0.0, radius), (-long, radius), (-long, 0.0)
    return dxf(path, chain(*points), unit)


def trouble(path: Path, travel: tuple[float, float] = TRAVEL, **typed: str) -> str:
    """What the form of the screen reports at the field of the unit; other faults are not expected."""
    setting = ProgramSettings(metric=True, shop=ShopData(travel_mm=travel))
    plan = planned(PlanRequest(path, typed, (), setting))
    assert set(plan.field_errors) <= {"DUNIT"}
    return plan.field_errors.get("DUNIT", "")


@pytest.mark.parametrize(
    ("unit", "long", "radius", "size", "remedy"),
    [
        (INCH, 40.0, 10.0, "40 in long", "choose MM"),
        (INCH, 5.0, 10.0, "20 in across", "choose MM"),  # radius 254 mm
        (METRE, 40.0, 10.0, "4e+04 mm long", "choose MM"),
        (METRE, 3.0, 1.0, "3000 mm long", "choose INCH"),  # 76.2 mm
        (FOOT, 4.0, 1.0, "1219 mm long", "choose INCH"),  # 101.6 mm
    ],
)
def test_implausibly_large_unit_is_rejected(
    unit: int, long: float, radius: float, size: str, remedy: str, tmp_path: Path
) -> None:
    said = trouble(shaft(tmp_path / "x.dxf", unit, long, radius))
    assert size in said
    assert remedy in said


@pytest.mark.parametrize(
    ("unit", "long", "radius", "size"),
    [
        (MM, 2.5, 0.375, "0.75 mm across"),  # 3/4 in across and 2-1/2 in long
        (MM, 0.5, 0.9, "1.8 mm across"),
    ],
)
def test_unusually_small_drawing_is_asked_about(
    unit: int, long: float, radius: float, size: str, tmp_path: Path
) -> None:
    path = shaft(tmp_path / "x.dxf", unit, long, radius)
    said = trouble(path)
    assert size in said
    assert "choose MM or INCH" in said
    assert not trouble(path, DUNIT="MM")
    assert not trouble(path, DUNIT="INCH")


@pytest.mark.parametrize(
    ("unit", "long", "radius"),
    [
        (MM, 6.0, 0.9),  # long enough
        (MM, 5.0, 1.0),  # thick enough
        (INCH, 0.1, 0.03),  # small, but the unit is already inches
        (INCH, 5.0, 1.0),  # 127 mm, fits
        (MM, 400.0, 10.0),  # too long, and no smaller unit
        (INCH, 400.0, 10.0),  # 400 mm would not fit either
    ],
)
def test_plausible_unit_is_not_reported(unit: int, long: float, radius: float, tmp_path: Path) -> None:
    assert not trouble(shaft(tmp_path / "x.dxf", unit, long, radius))


def test_explicit_unit_is_used_without_a_travel_check(tmp_path: Path) -> None:
    path = shaft(tmp_path / "x.dxf", INCH, 40.0, 10.0)
    assert not trouble(path, DUNIT="INCH")
    assert not trouble(path, (0.0, 0.0))
