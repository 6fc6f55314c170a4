"""Grooves whose walls lean, and grooves behind a flange: the proved part has the radii of the drawing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.extras.shapes.editor_shape import make_shape_instance
from core.extras.shapes.shape_fields import FieldValue, ShopData
from core.extras.shapes.shape_pieces import find_active_settings, insert_shape
from core.extras.shapes.shape_table import SHAPES_BY_KEY
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.hand import proved

BLADE = ToolShape(ToolKind.GROOVING, tip=3, width=2.0, length=12.0)
BORE_BLADE = ToolShape(ToolKind.GROOVING, tip=2, width=2.0, length=4.0, diameter=10.0)
METRIC: dict[str, FieldValue] = {"UNIT": "METRIC"}


def made(tool: ToolShape, **typed: FieldValue) -> str:
    """The program of one groove, in mm."""
    shop, text, behind = ShopData(tools={1: tool}), [""], 0
    for key, words in (("N", METRIC), ("G", {"T": 1.0, "WIDE": 2.0, **typed})):
        setting = find_active_settings(text, behind, shop)
        one = make_shape_instance(SHAPES_BY_KEY[key], words, setting)
        assert not one.find_errors(setting)
        text, behind = insert_shape(text, behind, one, setting)
    return "\n".join(text) + "\n"


def radii(text: str, tool: ToolShape, stock: str, at: list[float], *, inside: bool = False) -> list[float]:
    report, part = proved(text, {1: tool}, stock=stock)
    assert not report.errors, [d.text for d in report.diagnostics]
    assert part.last_piece is not None
    points = np.array(part.last_piece.bore_profile if inside else part.last_piece.outside_profile)[::-1]
    return [float(each) for each in np.interp(np.array(at), points[:, 0], points[:, 1])]


@pytest.mark.parametrize(("at_face", "at_chuck"), [(20.0, 20.0), (30.0, 0.0), (0.0, 15.0), (60.0, 45.0)])
def test_groove_walls_lean_by_their_angles(at_face: float, at_chuck: float) -> None:
    """Edges at -10 and -30 on a bar of 40, 4 deep: a wall leaves its edge by depth times its tangent."""
    text = made(BLADE, TOP=40.0, BOTTOM=32.0, AT=10.0, LONG=20.0, FANGLE=at_face, CANGLE=at_chuck)
    a, b = (math.tan(math.radians(angle)) for angle in (at_face, at_chuck))
    at = [-9.8, -10.0 - 1.0 * a - 0.1, -10.0 - 3.0 * a - 0.1, -19.0, -30.0 + 3.0 * b + 0.1, -30.2]
    rise = [0.1 / a if a else 4.0, 0.1 / a if a else 4.0, 0.1 / b if b else 4.0]
    deep = [20.0, 20.0 - min(4.0, 1.0 + rise[0]), 20.0 - min(4.0, 3.0 + rise[1]), 16.0]
    deep += [20.0 - min(4.0, 3.0 + rise[2]), 20.0]
    assert radii(text, BLADE, "bar:40mm:60mm", at) == pytest.approx(deep, abs=0.02)


def test_bore_groove_wall_leans_by_its_angle() -> None:
    """From 20 out to 24 in diameter, the wall at the face by 45 degrees: 1 mm in, 1 mm deeper."""
    text = made(BORE_BLADE, SIDE="BORE", TOP=20.0, BOTTOM=24.0, AT=5.0, LONG=8.0, FANGLE=45.0)
    found = radii(text, BORE_BLADE, "tube:40mm:20mm:40mm", [-4.8, -6.0, -9.0, -12.9, -13.2], inside=True)
    assert found == pytest.approx([10.0, 11.0, 12.0, 12.0, 10.0], abs=0.02)


def test_blade_clears_a_flange_before_and_after_the_groove() -> None:
    """A flange of 40 before a groove of 30 in diameter: no rapid below 41 before it is behind the flange."""
    lines = made(BLADE, TOP=30.0, BOTTOM=26.0, AT=20.0, LONG=4.0, OVER=40.0).splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("G00X"))
    assert lines[first : first + 3] == ["G00X41Z25", "Z-24", "X31"] or lines[first : first + 3] == [
        "G00X41Z25",
        "Z-22",
        "X31",
    ]
    assert lines[-3:] == ["X41", "Z25", "M30"]
