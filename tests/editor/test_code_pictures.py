"""Pictures of the code help: for codes that exist, and true to what these codes do."""

from __future__ import annotations

import math

from app.editor.code_pictures import _PICTURES, picture_of
from core.interpreter.omniturn.omniturn_book import book
from core.language.code_book import Entry
from core.tool_edges import TIP_DIRECTIONS


def entries() -> dict[str, Entry]:
    return {each.head: each for _, chapter in book().chapters for each in chapter}


def test_every_picture_belongs_to_a_code() -> None:
    assert set(_PICTURES) <= set(entries()), set(_PICTURES) - set(entries())
    assert picture_of("G90") is None


def test_g02_rounds_a_shoulder_and_g03_fills_its_corner() -> None:
    """Both from (0, 4) to (-4, 8): the middle of the convex arc lies outside of their chord."""
    for head, side in (("G02", 1.0), ("G03", -1.0)):
        drawn = picture_of(head)
        assert drawn is not None
        arc = next(each.points for each in drawn.outlines if each.ink == "cut")
        assert math.dist(arc[0], (0, 4)) < 1e-9
        assert math.dist(arc[-1], (-4, 8)) < 1e-9
        middle = arc[len(arc) // 2]
        assert side * (middle[0] + middle[1] - 4.0) > 0.0


def test_the_quadrants_lie_where_their_tips_are() -> None:
    drawn = picture_of("T")
    assert drawn is not None
    for dim in drawn.dims:
        z, x = TIP_DIRECTIONS[int(dim.word)]
        assert (math.copysign(1, dim.a[0]) if z else 0, math.copysign(1, dim.a[1]) if x else 0) == (z, x)
