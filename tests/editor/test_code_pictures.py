"""Pictures of the code help: for codes that exist, and true to what these codes do."""

from __future__ import annotations

import math

import pytest

from app.editor.code_help_view import _CODE_SKETCHES, make_code_sketch
from core.interpreter.dialects import get_code_book
from core.language.source import Dialect
from core.tool_edges import TIP_DIRECTIONS

OURS, THEIRS = Dialect.OMNITURN, Dialect.SINUMERIK


@pytest.mark.parametrize("dialect", list(Dialect))
def test_every_picture_belongs_to_a_code(dialect: Dialect) -> None:
    heads = {each.head for each in get_code_book(dialect).entries}
    assert set(_CODE_SKETCHES.get(dialect, {})) <= heads
    assert make_code_sketch("G90", dialect) is None


def test_sinumerik_g75_has_no_roughing_cycle_sketch() -> None:
    assert make_code_sketch("G75", OURS) is not None
    assert make_code_sketch("G75", THEIRS) is None
    assert make_code_sketch("CYCLE95", THEIRS) is not None


@pytest.mark.parametrize(
    ("head", "dialect", "side"),
    [("G02", OURS, 1.0), ("G03", OURS, -1.0), ("G3", THEIRS, 1.0), ("G2", THEIRS, -1.0)],
)
def test_arc_sketch_is_convex_or_concave_by_code(head: str, dialect: Dialect, side: float) -> None:
    """All from (0, 4) to (-4, 8): the middle of the convex arc lies outside of their chord."""
    drawn = make_code_sketch(head, dialect)
    assert drawn is not None
    arc = next(each.points for each in drawn.outlines if each.role == "cut")
    assert math.dist(arc[0], (0, 4)) < 1e-9
    assert math.dist(arc[-1], (-4, 8)) < 1e-9
    middle = arc[len(arc) // 2]
    assert side * (middle[0] + middle[1] - 4.0) > 0.0


@pytest.mark.parametrize(
    ("head", "dialect", "above"),
    [("G41", OURS, True), ("G42", OURS, False), ("G42", THEIRS, True), ("G41", THEIRS, False)],
)
def test_nose_compensation_sketch_is_on_the_side_of_the_code(
    head: str, dialect: Dialect, above: bool
) -> None:
    """Towards the chuck along a shaft: G41 there where X is seen downwards, G42 where it is seen upwards."""
    drawn = make_code_sketch(head, dialect)
    assert drawn is not None
    path = next(each.points for each in drawn.outlines if each.role == "cut")
    assert (path[0][1] > 5.0) is above


def test_tip_quadrants_are_drawn_in_their_directions() -> None:
    drawn = make_code_sketch("T")
    assert drawn is not None
    for dim in drawn.dimensions:
        z, x = TIP_DIRECTIONS[int(dim.field_label)]
        assert (math.copysign(1, dim.start[0]) if z else 0, math.copysign(1, dim.start[1]) if x else 0) == (
            z,
            x,
        )
