"""Contours to test with: by hand, and random ones as a turned part has them."""

from __future__ import annotations

from itertools import pairwise
from math import cos, sin

from hypothesis import strategies as st

from core.geometry.lines_and_arcs import Arc, Element, Line, Point, find_arc_center


def polyline(*points: Point) -> list[Element]:
    """Straight elements through (x, z) points."""
    return [Line(a, b) for a, b in pairwise(points)]


def arc(start: Point, end: Point, radius: float, *, clockwise: bool) -> Arc:
    """The arc of at most half a circle between two points."""
    return Arc(start, end, find_arc_center(start, end, radius, is_clockwise=clockwise), clockwise)


_STEP = st.tuples(
    st.floats(0.2, 12.0),  # length
    st.floats(-2.2, 2.2),  # turn before it
    st.sampled_from(["line", "line", "left", "right"]),
    st.floats(0.52, 6.0),  # radius over half the chord
)


def follow(steps: list[tuple[float, float, str, float]]) -> list[Element]:
    """Elements one after the other, each turned against the one before it."""
    at, heading, found = (20.0, 5.0), -1.5, list[Element]()
    for length, turned, kind, radius in steps:
        heading += turned
        end = at[0] + length * sin(heading), at[1] + length * cos(heading)
        if kind == "line":
            found.append(Line(at, end))
        else:
            found.append(arc(at, end, radius * length, clockwise=kind == "right"))
        at = end
    return found


CONTOURS = st.lists(_STEP, min_size=1, max_size=9).map(follow)


def sampled(element: Element, count: int = 41) -> list[Point]:
    """Points along an element, its ends included."""
    inner = [element.get_point(element.length * k / (count - 1)) for k in range(1, count - 1)]
    return [element.start, *inner, element.end]
