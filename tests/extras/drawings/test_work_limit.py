"""Lines beside each other cost work by the square of their number: it is limited, and can be canceled."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from app.desk.latest import AbandonedError
from app.extras.drawings.drawing_plan import Asked, Planner
from core.extras.drawings.contour_walk import check_work, limited_work, nets, outer_side
from core.extras.drawings.drawing import Drawing, DrawingError, Drawn
from core.extras.drawings.drawing_file import read_drawing
from core.extras.drawings.drawing_view import Side, View, axis_named, contours, profile
from core.extras.shapes.shape_setting import Setting
from core.geometry.lines_and_arcs import Line
from tests.coded import raises_code
from tests.extras.drawings.hand import chain, dxf

STEP = ((0, 0), (0, 4), (-10, 4), (-10, 6), (-20, 6), (-20, 0))


def beside_each_other(count: int) -> Drawing:
    lines = (Line((1.0 + 0.1 * k, 0.0), (1.0 + 0.1 * k, -100.0)) for k in range(count))
    return Drawing("part.dxf", tuple(Drawn(line) for line in lines), 1.0)


def nothing(_seconds: float) -> None:
    """Nobody watches."""


def test_contours_end_at_the_limit() -> None:
    drawing = beside_each_other(50)
    view = View(axis_named(drawing, ""), 1.0)
    known = contours(drawing, view)
    with limited_work(nothing, 0.0), raises_code(DrawingError, "too-slow", "part.dxf"):
        contours(drawing, view)
    assert contours(drawing, view) == known  # the limit is over
    assert len(known) > 40


def test_a_profile_ends_at_the_limit(tmp_path: Path) -> None:
    drawing = read_drawing(dxf(tmp_path / "part.dxf", chain(*STEP)))
    view = View(axis_named(drawing, ""), 1.0)
    net = contours(drawing, view)[0]
    with limited_work(nothing, 0.0), raises_code(DrawingError, "too-slow", "part.dxf"):
        profile(drawing, view, net, Side.OUTSIDE)


def test_a_plan_is_given_up_while_it_is_worked_out(tmp_path: Path) -> None:
    path = dxf(tmp_path / "part.dxf", chain(*STEP))

    def overtaken(_seconds: float) -> None:
        raise AbandonedError

    planner = Planner(lambda path, _watch: read_drawing(path))
    with pytest.raises(AbandonedError):
        planner.plan(Asked(path, {}, (), Setting(metric=True)), overtaken)
    check_work()  # it watches nothing more


def test_of_two_crossings_the_first_along_the_contour_is_named() -> None:
    """From r 8 to r 4 and back to r 6 it crosses r 5 at Z -30 + 18 * 3/4 = -16.5, and then at Z -10."""
    points = ((0.0, 0.0), (5.0, 0.0), (5.0, -30.0), (8.0, -30.0), (4.0, -12.0), (6.0, -8.0), (9.0, -40.0))
    elements = [Line(a, b) for a, b in pairwise(points)]
    with raises_code(DrawingError, "crosses-itself", "16.500 mm", "10.000 mm"):
        outer_side(nets(elements)[0])
