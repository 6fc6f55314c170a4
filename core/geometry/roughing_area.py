"""Roughing: which spans of a line parallel to Z a tool may run beside a contour.

All points here are (depth, way) as seen from the tool's start point: the depth grows along X towards the
contour, the way along Z towards it; the contour runs so that the tool is on its left.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import sqrt

from core.geometry.contour_offset import around, trimmed_offset
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, holds

Span = tuple[float, float]
"""From where to where along the way, mm."""

_SHORTEST = 0.001  # mm; half the width of what a workpiece can show
_TOUCH = 1e-6  # mm; a line so little deeper than a wall lies on it
_ENDLESS = float("inf")


class Area:
    """What lies between the start point and the contour, less what is to be left on the contour.

    ``path`` is the way along the contour at the distance ``left`` (mm); it begins and ends the area.
    Raises TrimError where there is no such path.
    """

    def __init__(self, contour: Sequence[Element], left: float) -> None:
        self.contour, self.left = contour, left
        self.path = trimmed_offset(contour, left)
        self.top = min(element.box[0] for element in contour) - left
        self.deepest = max(element.box[1] for element in self.path)
        self._front, self._back = self.path[0].start, self.path[-1].end
        parts = [part for element in contour for part in _rising(element)]
        self._walls = [(part.box[0] - left, around(part, left) if left > 0 else [part]) for part in parts]

    @property
    def turns_back(self) -> bool:
        """Whether the path runs back along Z: behind such an edge no span reaches."""
        return any(
            element.box[2] < element.start[1] - _TOUCH or element.box[3] > element.end[1] + _TOUCH
            for element in self.path
        )

    def spans(self, depth: float) -> list[Span]:
        """Where a tool at ``depth`` may run: above it, to depth 0, there is no contour either."""
        met = [wall for least, wall in self._walls if least <= depth - _TOUCH]
        walls = [reach for wall in met if (reach := _reach(wall, depth - _TOUCH)) is not None]
        if depth > self._front[0] + _TOUCH:
            walls.append((-_ENDLESS, self._front[1]))
        found: list[Span] = []
        at = 0.0
        for start, end in [*sorted(walls), (self._back[1], _ENDLESS)]:
            stop = min(start, self._back[1])
            if stop - at > _SHORTEST:
                found.append((at, stop))
            at = max(at, end)
        return found


def _rising(element: Element) -> list[Element]:
    """An element in parts along which the depth only grows or only falls."""
    if isinstance(element, Line):
        return [element]
    (cx, cz), radius = element.centre, element.radius
    length = element.length
    turns = {
        at: point
        for point in ((cx - radius, cz), (cx + radius, cz))
        if _TOUCH < (at := element.along(point)) < length - _TOUCH
    }
    points = [element.start, *(turns[at] for at in sorted(turns)), element.end]
    return [element.part(a, b) for a, b in pairwise(points)]


def _reach(wall: Sequence[Element], depth: float) -> Span | None:
    """From where to where the part of a wall that is not as deep as ``depth`` reaches."""
    places = [place for edge in wall for place in _places(edge, depth)]
    return (min(places), max(places)) if places else None


def _places(edge: Element, depth: float) -> list[float]:
    """Ways among which are the least and the greatest of the part of an edge down to ``depth``."""
    if isinstance(edge, Line):
        return _places_of_line(edge, depth)
    candidates = [edge.start, edge.end, *_inner_extremes(edge)]
    places = [point[1] for point in candidates if point[0] <= depth]
    return places + [point[1] for point in _at_depth(edge, depth)]


def _places_of_line(edge: Line, depth: float) -> list[float]:
    (u0, v0), (u1, v1) = edge.start, edge.end
    places = [point[1] for point in (edge.start, edge.end) if point[0] <= depth]
    if (u0 <= depth) != (u1 <= depth):
        places.append(v0 + (v1 - v0) * (depth - u0) / (u1 - u0))
    return places


def _inner_extremes(arc: Arc) -> list[Point]:
    (cu, cv), radius = arc.centre, arc.radius
    return [point for point in ((cu, cv - radius), (cu, cv + radius)) if holds(arc, point)]


def _at_depth(arc: Arc, depth: float) -> list[Point]:
    (cu, cv), radius = arc.centre, arc.radius
    square = radius * radius - (depth - cu) ** 2
    if square < 0:
        return []
    half = sqrt(square)
    return [point for point in ((depth, cv - half), (depth, cv + half)) if holds(arc, point)]
