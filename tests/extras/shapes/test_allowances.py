"""Separate finishing allowances in X and Z: shifted contours by hand, and the roughed part."""

from __future__ import annotations

import numpy as np
import pytest

from core.extras.shapes.contour import ContourPoint
from core.extras.shapes.editor_shape import ShapeInstance, make_shape_instance
from core.extras.shapes.shape_fields import FieldValue, ProgramSettings, ShopData
from core.extras.shapes.shape_pieces import find_active_settings, find_program_shapes, insert_shape
from core.extras.shapes.shape_table import SHAPES_BY_DIALECT, SHAPES_BY_KEY
from core.language.source import Dialect
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.hand import bad, proved

TOOL = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.4)
SHOP = ShopData(tools={1: TOOL})
SHAFT = (
    ContourPoint(10.0, 0.0),
    ContourPoint(z=-8.0, radius=1.0),
    ContourPoint(16.0),
    ContourPoint(20.0, -14.0),
)
WORDS: dict[str, FieldValue] = {
    **{"T": 1.0, "FROM": 24.0, "ROUGH": 1.0, "LEAVE": 0.3, "ZLEAVE": 0.1},
    **{"FEED": 0.1, "RFEED": 0.2, "RPM": 900.0},
}


def form(
    typed: dict[str, FieldValue],
    points: tuple[ContourPoint, ...] = SHAFT,
    dialect: Dialect = Dialect.OMNITURN,
) -> tuple[ShapeInstance, ProgramSettings]:
    settings = ProgramSettings(metric=True, shop=SHOP, dialect=dialect)
    table = SHAPES_BY_DIALECT[dialect]
    return make_shape_instance(table["T"], {**WORDS, **typed}, settings, points), settings


def lines(
    typed: dict[str, FieldValue],
    points: tuple[ContourPoint, ...] = SHAFT,
    dialect: Dialect = Dialect.OMNITURN,
) -> list[str]:
    one, settings = form(typed, points, dialect)
    assert not one.find_errors(settings)
    return one.make_lines(settings)


def test_roughing_contour_is_shifted_by_both_allowances() -> None:
    """Diameters grow by twice 0.3, and Z by 0.1. The finishing contour is that of the drawing."""
    written = lines({})
    start = written.index("G75I1U0F.2")
    assert written[start + 1 : start + 6] == ["X10.6Z.1", "Z-7.9R1", "X16.6", "X20.6Z-13.9", "RF"]
    assert [line for line in written[start + 6 :] if "R1" in line] == ["Z-8R1"]


def test_one_allowance_is_left_to_the_cycle() -> None:
    written = lines({"ZLEAVE": 0.0})
    start = written.index("G75I1U.3F.2")
    assert written[start + 1 : start + 4] == ["X10Z0", "Z-8R1", "X16"]


def test_bore_is_roughed_smaller() -> None:
    """In a bore, the diameters shrink by twice 0.3."""
    bore = (ContourPoint(16.0, 0.0), ContourPoint(z=-5.0), ContourPoint(12.0), ContourPoint(z=-9.0))
    written = lines({"SIDE": "BORE", "HOLE": 10.0}, bore)
    start = written.index("G75I1U0F.2")
    assert written[start + 1 : start + 6] == ["X15.4Z.1", "Z-4.9", "X11.4", "Z-8.9", "RF"]


def test_sinumerik_has_both_allowances_in_the_cycle() -> None:
    """CYCLE95 has FALZ, FALX (a radius) and FAL after the depth of cut."""
    cycle = next(line for line in lines({}, dialect=Dialect.SINUMERIK) if line.startswith("CYCLE95"))
    assert '", 1, 0.1, 0.3, , 0.2, 0.2, , 1)' in cycle
    cycle = next(line for line in lines({"ZLEAVE": 0.0}, dialect=Dialect.SINUMERIK) if "CYCLE95" in line)
    assert '", 1, , , 0.3, 0.2, 0.2, , 1)' in cycle


def test_form_reads_the_contour_of_the_drawing_again() -> None:
    """The roughing contour in the program is shifted, but the form shows the points of the drawing."""
    text, row = [""], 0
    steps: list[tuple[str, dict[str, FieldValue], tuple[ContourPoint, ...]]] = [
        ("N", {"UNIT": "METRIC"}, ()),
        ("T", WORDS, SHAFT),
    ]
    for key, words, points in steps:
        settings = find_active_settings(text, row, SHOP)
        one = make_shape_instance(SHAPES_BY_KEY[key], words, settings, points)
        assert not one.find_errors(settings)
        text, row = insert_shape(text, row, one, settings)
    read = find_program_shapes(text, SHOP)[-1]
    assert read.edited_line < 0
    assert read.shape_instance.contour_points == SHAFT
    assert read.shape_instance.field_values["ZLEAVE"] == pytest.approx(0.1)


def test_part_is_finished_and_the_roughed_part_has_the_allowances() -> None:
    """Without the finishing pass, the shaft is 10.6 in diameter and its shoulder at Z -7.9."""
    written = ["G90G94F7620G71G72", *lines({}), "M30"]
    rough = written.index("RF")
    for program, diameter, shoulder in ((written, 10.0, -8.0), ([*written[: rough + 1], "M30"], 10.6, -7.9)):
        report, part = proved("\n".join(program) + "\n", {1: TOOL}, stock="bar:24mm:40mm")
        assert not [text for text in bad(report) if "error" in text]
        assert part.last_piece is not None
        points = np.array(part.last_piece.outside_profile)[::-1]
        at = np.interp(np.array([-3.0, shoulder + 1.5, shoulder - 0.05]), points[:, 0], points[:, 1])
        assert at[:2] == pytest.approx([diameter / 2.0] * 2, abs=0.02)
        assert at[2] > diameter / 2.0 + 1.0


FALLING = (ContourPoint(10.0, 0.0), ContourPoint(z=-4.0), ContourPoint(8.0, -6.0), ContourPoint(16.0))
BULGE = (ContourPoint(10.0, 0.0), ContourPoint(10.0, -6.0, arc=5.0), ContourPoint(16.0))


@pytest.mark.parametrize(
    ("typed", "points"),
    [
        ({}, FALLING),
        ({}, BULGE),
        ({"SIDE": "BORE", "HOLE": 8.0}, SHAFT),
        ({"ZLEAVE": 3.0}, SHAFT),
        ({"ZLEAVE": -0.1}, SHAFT),
    ],
)
def test_allowances_that_roughing_cannot_leave_are_rejected(
    typed: dict[str, FieldValue], points: tuple[ContourPoint, ...]
) -> None:
    one, settings = form(typed, points)
    assert "ZLEAVE" in [error.field_name for error in one.find_errors(settings)]
    one, settings = form({**typed, "ZLEAVE": 0.0}, points)
    assert "ZLEAVE" not in [error.field_name for error in one.find_errors(settings)]
