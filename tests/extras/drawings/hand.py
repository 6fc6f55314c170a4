"""Drawings made by hand, and the part that comes of their program, by the proof."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np

from app.extras.drawings.drawing_plan import DrawingPlan, DrawingPlanner, PlanRequest
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_placement import (
    ContourProfile,
    ContourSide,
    DrawingPlacement,
    extract_profile,
    find_contours,
    select_axis,
)
from core.extras.drawings.profile_description import propose_program_fields
from core.extras.drawings.profile_program import ProfileProgram, make_profile_program
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from core.interpreter.shared.job_setup import SecondaryOffset
from core.language.source import Dialect
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.hand import proved

RIGHT = ToolShape(ToolKind.TURNING, tip=3, insert="DNMG150404", nose_radius=0.4)
SLIM = ToolShape(ToolKind.TURNING, tip=3, insert="VNMG160402", nose_radius=0.2)
BLADE = ToolShape(ToolKind.GROOVING, tip=3, width=2.0, length=8.0)
BAR = ToolShape(ToolKind.BORING, tip=2, insert="CCMT060204", nose_radius=0.4, diameter=8.0, stick_out=60.0)
TOOLS = {1: RIGHT, 5: BLADE, 6: BAR}

Draw = Callable[[Any], object]


def dxf(path: Path, draw: Draw, unit: int = 4) -> Path:
    """A DXF file; ``draw`` gets its model space. ``unit`` as $INSUNITS: 0 none, 1 inch, 4 mm."""
    document = ezdxf.filemanagement.new("R2010")
    document.units = unit
    draw(document.modelspace())
    document.saveas(path)
    return path


def chain(*points: tuple[float, ...]) -> Draw:
    """A polyline of (x, y) or (x, y, bulge)."""
    return lambda space: space.add_lwpolyline([(*p, 0.0)[:3] for p in points], format="xyb")


def profile_of(
    path: Path, *, side: ContourSide = ContourSide.OUTSIDE, axis: str = "", **view: Any
) -> ContourProfile:
    """The first contour of a drawing."""
    drawing = read_drawing(path)
    how = DrawingPlacement(select_axis(drawing, axis), drawing.unit_mm or 1.0, **view)
    return extract_profile(drawing, how, find_contours(drawing, how)[0], side)


def program(
    chosen: ContourProfile,
    tools: dict[int, ToolShape] | None = None,
    *,
    metric: bool = True,
    dialect: Dialect = Dialect.OMNITURN,
    **typed: Any,
) -> ProfileProgram:
    """The program of a profile; what is not typed is as it is proposed."""
    shapes = TOOLS if tools is None else tools
    fields = propose_program_fields(chosen, typed, shapes, is_metric=metric, dialect=dialect)
    setting = ProgramSettings(metric=metric, shop=ShopData(tools=shapes), dialect=dialect)
    return make_profile_program(chosen, fields, [], setting)


def text_of(made: ProfileProgram) -> str:
    """The whole program."""
    assert not made.errors, made.errors
    return "\n".join([*made.lines, "M30"]) + "\n"


def radii(
    made: ProfileProgram, stock: str, at: Iterable[float], tools: dict[int, ToolShape] | None = None,
    *, inside: bool = False,
) -> np.ndarray:  # fmt: skip
    """Radii of the proved part at these Z, mm; the proof has nothing to say against the program."""
    n = made.nose_offset
    offsets = {n.offset_number: SecondaryOffset(n.x, n.z, n.nose_radius)} if n else {}
    report, part = proved(text_of(made), TOOLS if tools is None else tools, offsets, stock)
    assert not report.errors, [d.text for d in report.diagnostics]
    assert part.last_piece is not None
    points = np.array(part.last_piece.bore_profile if inside else part.last_piece.outside_profile)[::-1]
    found: np.ndarray = np.interp(np.array(list(at)), points[:, 0], points[:, 1])
    return found


def planned(asked: PlanRequest) -> DrawingPlan:
    """Return the plan of a form, of a drawing that is read here."""
    return DrawingPlanner(lambda path, _watch: read_drawing(path)).make_plan(asked, lambda _seconds: None)
