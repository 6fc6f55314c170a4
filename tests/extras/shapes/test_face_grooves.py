"""Grooves in the face: lines by hand, and the volume that the proof removes."""

from __future__ import annotations

import math

import pytest

from core.extras.shapes.editor_shape import ShapeInstance, make_shape_instance
from core.extras.shapes.shape_fields import FieldValue, ProgramSettings, ShopData
from core.extras.shapes.shape_pieces import find_active_settings, find_program_shapes, insert_shape
from core.extras.shapes.shape_table import SHAPES_BY_DIALECT
from core.language.diagnostics import Severity
from core.language.source import Dialect
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.hand import bad, proved

BLADE = ToolShape(ToolKind.GROOVING, tip=7, width=2.0, length=12.0)  # measured at the middle of its edge
RADIAL = ToolShape(ToolKind.GROOVING, tip=3, width=2.0, length=12.0)
SHOP = ShopData(tools={1: BLADE, 2: RADIAL})
RING: dict[str, FieldValue] = {
    **{"T": 1.0, "OUTER": 30.0, "INNER": 20.0, "DEEP": 4.0, "WIDE": 2.0, "DWELL": 0.2},
    **{"FEED": 0.05, "RPM": 500.0},
}


def form(
    typed: dict[str, FieldValue], dialect: Dialect = Dialect.OMNITURN
) -> tuple[ShapeInstance, ProgramSettings]:
    settings = ProgramSettings(metric=True, shop=SHOP, dialect=dialect)
    return make_shape_instance(SHAPES_BY_DIALECT[dialect]["V"], {**RING, **typed}, settings), settings


def lines(typed: dict[str, FieldValue], dialect: Dialect = Dialect.OMNITURN) -> list[str]:
    """Return the lines from the approach to the retract."""
    one, settings = form(typed, dialect)
    assert not one.find_errors(settings)
    written = one.make_lines(settings)
    return written[next(n for n, line in enumerate(written) if line.startswith(("G00X", "G0 X"))) :]


def test_plunges_begin_at_the_outer_diameter() -> None:
    """The groove is 5 wide and the blade 2, so 3 are left for two steps of 1.5: radii 15, 13.5 and 12."""
    assert lines({"CORNER": "OUTER"}) == [
        *("G00X30Z25", "Z2.5", "Z.5", "G95F.05Z-4", "G04F.2", "G00Z.5", "X27", "Z.5", "G01Z-4", "G04F.2"),
        *("G00Z.5", "X24", "Z.5", "G01Z-4", "X30", "G00Z.5", "Z25"),
    ]


@pytest.mark.parametrize(("corner", "x"), [("INNER", (26, 23, 20, 26)), ("MIDDLE", (28, 25, 22, 28))])
def test_touch_off_point_moves_x_by_the_blade_width(corner: str, x: tuple[int, ...]) -> None:
    """The inner corner is 2 nearer the axis than the outer one, and the middle 1 nearer."""
    first, *others = x
    expected = [f"G00X{first}Z25", *(f"X{each}" for each in others)]
    assert [line for line in lines({"CORNER": corner}) if "X" in line] == expected


def test_pecks_leave_the_groove() -> None:
    """A groove of the blade width, 5 deep in pecks of 2: -2, -4 and -5, back at 0.5 before the bottom."""
    assert lines({"INNER": 26.0, "DEEP": 5.0, "PECK": 2.0, "CORNER": "OUTER"}) == [
        *("G00X30Z25", "Z2.5", "Z.5", "G95F.05Z-2", "G00Z.5", "Z-1.5", "G01Z-4", "G00Z.5", "Z-3.5", "G01Z-5"),
        *("G04F.2", "G00Z.5", "Z25"),
    ]


def test_sinumerik_has_the_same_positions() -> None:
    words = [
        line.replace("G0 ", "").replace("G1 ", "") for line in lines({"CORNER": "OUTER"}, Dialect.SINUMERIK)
    ]
    assert [word.split()[0] for word in words[1:]] == [
        *(
            "Z2.5",
            "Z0.5",
            "Z-4",
            "G4",
            "Z0.5",
            "X27",
            "Z0.5",
            "Z-4",
            "G4",
            "Z0.5",
            "X24",
            "Z0.5",
            "Z-4",
            "X30",
        ),
        *("Z0.5", "Z25"),
    ]


def test_proof_removes_the_volume_of_the_ring_and_the_form_reads_it_again() -> None:
    """pi (15² - 10²) 4 = 1570.8 mm³."""
    text, row = [""], 0
    steps: list[tuple[str, dict[str, FieldValue]]] = [("N", {"UNIT": "METRIC"}), ("V", RING)]
    for key, words in steps:
        settings = find_active_settings(text, row, SHOP)
        one = make_shape_instance(SHAPES_BY_DIALECT[Dialect.OMNITURN][key], words, settings)
        assert not one.find_errors(settings)
        text, row = insert_shape(text, row, one, settings)
    report, part = proved("\n".join(text) + "\n", {1: BLADE}, stock="bar:40mm:30mm")
    assert not bad(report)
    assert part.removed_volume_mm3 == pytest.approx(math.pi * (15.0**2 - 10.0**2) * 4.0, rel=0.01)
    read = find_program_shapes(text, SHOP)[-1]
    assert (read.edited_line < 0, read.shape_instance.field_values) == (True, one.field_values)


def test_proof_rejects_a_face_blade_that_turns_along_x() -> None:
    """From radius 15 to 11 at a depth of 3 and of 1 mm; a blade of 2 mm allows 0.8 x 2 = 1.6 mm."""
    for deep, codes in ((3, ["blade-turns"]), (1, [])):
        cuts = ["G00X30Z2.5", f"G95F.05Z-{deep}", "X22", "G00Z25"]
        program = ["G90G94F7620G71G72", "T1", "G97M03S500", *cuts, "M30"]
        report, _ = proved("\n".join(program) + "\n", {1: BLADE}, stock="bar:40mm:30mm")
        assert [each.code for each in report.diagnostics if each.severity is Severity.ERROR] == codes


@pytest.mark.parametrize(
    ("typed", "field"),
    [
        ({"INNER": 30.0}, "INNER"),
        ({"INNER": 27.0}, "WIDE"),
        ({"DEEP": 0.0}, "DEEP"),
        ({"PECK": 0.01}, "PECK"),
        ({"T": 2.0}, "T"),
        ({"RPM": 4000.0}, "RPM"),
        ({"FEED": 2.0}, "FEED"),
    ],
)
def test_face_grooves_that_cannot_be_cut_are_rejected(typed: dict[str, FieldValue], field: str) -> None:
    one, settings = form(typed)
    assert [error.field_name for error in one.find_errors(settings)] == [field]
