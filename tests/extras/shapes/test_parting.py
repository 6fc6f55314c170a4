"""Parting off with pecks and with a lower feed near the center: lines by hand, and the proved part."""

from __future__ import annotations

import numpy as np
import pytest

from core.extras.shapes.editor_shape import ShapeInstance, make_shape_instance, read_comment
from core.extras.shapes.shape_fields import FieldValue, ProgramSettings, ShopData
from core.extras.shapes.shape_pieces import find_active_settings, insert_shape
from core.extras.shapes.shape_table import SHAPES_BY_DIALECT, SHAPES_BY_KEY
from core.language.source import Dialect
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.hand import bad, proved

BLADE = ToolShape(ToolKind.PARTING, tip=3, width=2.0, length=16.0)
SHOP = ShopData(tools={1: BLADE})
CUT: dict[str, FieldValue] = {
    "T": 1.0,
    "FROM": 20.0,
    "LONG": 15.0,
    "WIDE": 2.0,
    "CORNER": "LEFT",
    "FEED": 0.1,
    "RPM": 600.0,
}


def form(
    typed: dict[str, FieldValue], dialect: Dialect = Dialect.OMNITURN
) -> tuple[ShapeInstance, ProgramSettings]:
    settings = ProgramSettings(metric=True, shop=SHOP, dialect=dialect)
    return make_shape_instance(SHAPES_BY_DIALECT[dialect]["P"], {**CUT, **typed}, settings), settings


def lines(dialect: Dialect = Dialect.OMNITURN, **typed: FieldValue) -> list[str]:
    one, settings = form(typed, dialect)
    assert not one.find_errors(settings)
    return one.make_lines(settings)


def test_pecks_leave_the_cut_and_return_before_its_bottom() -> None:
    """From radius 10 in pecks of 4: 6, 2 and 0, as diameters 12, 4 and 0; back at 0.5 before the bottom."""
    written = lines(PECK=4.0)
    start = written.index("Z-17")
    assert written[start + 1 : -1] == [
        *("G95F.1X12", "G00X21", "X13", "G01X4", "G00X21", "X5", "G01X0", "G00X21"),
    ]


def test_feed_is_lower_from_a_diameter_to_the_center() -> None:
    written = lines(SLOW=6.0, CFEED=0.04)
    start = written.index("Z-17")
    assert written[start + 1 : -1] == ["G95F.1X6", "F.04X0", "G00X21"]


def test_feed_changes_inside_a_peck() -> None:
    """With pecks of 4, the second peck passes the diameter 6. The proposal is half of the feed."""
    written = lines(PECK=4.0, SLOW=6.0)
    start = written.index("Z-17")
    assert written[start + 1 : -1] == [
        *("G95F.1X12", "G00X21", "X13", "G01X6", "F.05X4", "G00X21", "X5", "G01X0", "G00X21"),
    ]


def test_sinumerik_has_the_same_pecks() -> None:
    written = lines(Dialect.SINUMERIK, PECK=4.0, SLOW=6.0)
    start = written.index("Z-17")
    words = [
        line.replace("G95 ", "").replace("G1 ", "").replace("G0 ", "") for line in written[start + 1 : -1]
    ]
    assert [word.split()[0] for word in words] == ["X12", "X21", "X13", "X6", "X4", "X21", "X5", "X0", "X21"]


def test_part_is_cut_off_at_its_length() -> None:
    """The part is 15 mm long: after the cut, the bar ends at Z -17, and no rapid enters the bar."""
    text, row = [""], 0
    steps: list[tuple[str, dict[str, FieldValue]]] = [("N", {"UNIT": "METRIC"})]
    for key, words in [*steps, ("P", {**CUT, "PECK": 3.0, "SLOW": 5.0, "BACK": 0.5})]:
        settings = find_active_settings(text, row, SHOP)
        one = make_shape_instance(SHAPES_BY_KEY[key], words, settings)
        assert not one.find_errors(settings)
        text, row = insert_shape(text, row, one, settings)
    report, part = proved("\n".join(text) + "\n", {1: BLADE}, stock="bar:20mm:40mm")
    assert not bad(report)
    assert part.last_piece is not None
    profile = np.array(part.last_piece.outside_profile)
    assert float(profile[:, 0].min()) == pytest.approx(-15.0, abs=0.01)


def test_older_comment_has_neither_pecks_nor_a_lower_feed() -> None:
    comment = "FRONT SIDE 20 FROM 15 LONG 2MM WIDE LEFT CORNER 0P1 FEED 600 RPM"
    found = read_comment(SHAPES_BY_KEY["P"], comment.split())
    assert found is not None
    one, settings = form(found)
    assert not one.find_errors(settings)
    assert [line for line in one.make_lines(settings) if "X0" in line] == ["G95F.1X0"]


@pytest.mark.parametrize(
    ("typed", "field"),
    [
        ({"PECK": 10.0}, "PECK"),
        ({"PECK": 0.04}, "PECK"),
        ({"PECK": -1.0}, "PECK"),
        ({"SLOW": 20.0}, "SLOW"),
        ({"SLOW": 4.0, "TO": 4.0}, "SLOW"),
        ({"SLOW": 6.0, "CFEED": 0.2}, "CFEED"),
        ({"SLOW": 6.0, "CFEED": 0.0}, "CFEED"),
    ],
)
def test_pecks_and_feeds_that_cannot_be_cut_are_rejected(typed: dict[str, FieldValue], field: str) -> None:
    one, settings = form(typed)
    assert [error.field_name for error in one.find_errors(settings)] == [field]
