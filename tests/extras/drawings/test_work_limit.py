"""Lines beside each other cost work by the square of their number: it is limited, and can be canceled."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from app.desk.background_work import WorkAbandonedError
from app.extras.drawings.drawing_plan import DrawingPlanner, PlanRequest
from core.extras.drawings.contour_tracing import find_element_groups, trace_outer_side
from core.extras.drawings.drawing import (
    Drawing,
    DrawingError,
    DrawnElement,
    check_processor_time,
    limit_processor_time,
)
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_placement import (
    ContourSide,
    DrawingPlacement,
    extract_profile,
    find_contours,
    select_axis,
)
from core.extras.shapes.shape_fields import ProgramSettings
from core.geometry.lines_and_arcs import Line
from tests.coded import raises_code
from tests.extras.drawings.hand import chain, dxf

STEP = ((0, 0), (0, 4), (-10, 4), (-10, 6), (-20, 6), (-20, 0))


def beside_each_other(count: int) -> Drawing:
    lines = (Line((1.0 + 0.1 * k, 0.0), (1.0 + 0.1 * k, -100.0)) for k in range(count))
    return Drawing("part.dxf", tuple(DrawnElement(line) for line in lines), 1.0)


def nothing(_seconds: float) -> None:
    """Nobody watches."""


def test_contour_search_stops_at_the_work_limit() -> None:
    drawing = beside_each_other(50)
    view = DrawingPlacement(select_axis(drawing, ""), 1.0)
    known = find_contours(drawing, view)
    with limit_processor_time(nothing, 0.0), raises_code(DrawingError, "too-slow", "part.dxf"):
        find_contours(drawing, view)
    assert find_contours(drawing, view) == known  # the limit is over
    assert len(known) > 40


def test_profile_extraction_stops_at_the_work_limit(tmp_path: Path) -> None:
    drawing = read_drawing(dxf(tmp_path / "part.dxf", chain(*STEP)))
    view = DrawingPlacement(select_axis(drawing, ""), 1.0)
    net = find_contours(drawing, view)[0]
    with limit_processor_time(nothing, 0.0), raises_code(DrawingError, "too-slow", "part.dxf"):
        extract_profile(drawing, view, net, ContourSide.OUTSIDE)


def test_outdated_plan_is_canceled_during_calculation(tmp_path: Path) -> None:
    path = dxf(tmp_path / "part.dxf", chain(*STEP))

    def overtaken(_seconds: float) -> None:
        raise WorkAbandonedError

    planner = DrawingPlanner(lambda path, _watch: read_drawing(path))
    with pytest.raises(WorkAbandonedError):
        planner.make_plan(PlanRequest(path, {}, (), ProgramSettings(metric=True)), overtaken)
    check_processor_time()  # it watches nothing more


def test_first_crossing_along_the_contour_is_reported() -> None:
    """From r 8 to r 4 and back to r 6 it crosses r 5 at Z -30 + 18 * 3/4 = -16.5, and then at Z -10."""
    points = ((0.0, 0.0), (5.0, 0.0), (5.0, -30.0), (8.0, -30.0), (4.0, -12.0), (6.0, -8.0), (9.0, -40.0))
    elements = [Line(a, b) for a, b in pairwise(points)]
    with raises_code(DrawingError, "crosses-itself", "16.500 mm", "10.000 mm"):
        trace_outer_side(find_element_groups(elements)[0])
