"""The line along which a tool can follow a contour at a distance, with all that it cannot reach left out.

``offset.py`` refuses a contour that the distance does not fit into; roughing does not: a fillet smaller than
what is left on the part, or a groove narrower than twice that, is passed by.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import dist

import numpy as np

from core.geometry.arcs import Point
from core.geometry.contour import Arc, Box, Element, turn
from core.geometry.extent import SAME_POINT
from core.geometry.meet import distance, intersections
from core.geometry.offset import JOINED, GougeError, offset_element

# Offsets of tangent elements are joined over a rounding of the program; a path may be nearer by so much. mm.
_NEARER = 0.0005

# Pieces of the path follow each other where the end of one is this near to the start of the next. mm.
_FOLLOWS = 2 * JOINED

# What may be left over behind the end of the path: parts that are too near by less than _NEARER. mm.
_LOST = 0.02


class TrimError(Exception):
    """There is no unbroken way along the contour at this distance."""


def around(element: Element, apart: float) -> list[Element]:
    """Curves that hold the edge of all that lies within ``apart`` of an element; they lie in it or on it."""
    return [*_moved(element, apart), *_moved(element, -apart), *(_ring(p, apart) for p in _ends(element))]


def trimmed_offset(elements: Sequence[Element], apart: float) -> list[Element]:
    """The path ``apart`` mm to the left of a contour, nowhere nearer to it than that by over 0.5 µm.

    Each element must start where the one before it ends. Raises TrimError where the path falls apart.
    """
    if apart <= 0:
        return list(elements)
    contour = _Boxed(elements)
    edges = _Boxed([edge for element in elements for edge in around(element, apart)])
    kept = [
        part
        for piece in _pieces(elements, apart)
        for part in _split(piece, edges)
        if _far(part, contour, apart - _NEARER)
    ]
    return _chained(kept)


class _Boxed:
    """Elements that are found by where they are."""

    def __init__(self, elements: Sequence[Element]) -> None:
        self._elements = elements
        self._boxes = np.array([element.box for element in elements])

    def near(self, box: Box, within: float) -> list[Element]:
        """The elements whose boxes are no farther than ``within`` from another along either axis."""
        x0, x1, z0, z1 = self._boxes.T
        hit = (x0 <= box[1] + within) & (x1 >= box[0] - within)
        hit &= (z0 <= box[3] + within) & (z1 >= box[2] - within)
        return [self._elements[at] for at in np.flatnonzero(hit).tolist()]


def _pieces(elements: Sequence[Element], apart: float) -> list[Element]:
    """The left offset of each element, and an arc about each corner that lies inwards of the path."""
    pieces = _moved(elements[0], apart)
    for before, after in pairwise(elements):
        angle = turn(before.end_direction, after.start_direction)
        if angle < 0:
            pieces += _corner(before, after, apart)
        pieces += _moved(after, apart)
    return pieces


def _corner(before: Element, after: Element, apart: float) -> list[Element]:
    first, last = _moved(before, apart), _moved(after, apart)
    if not first or not last or dist(first[0].end, last[0].start) < SAME_POINT:
        return []
    return [Arc(first[0].end, last[0].start, after.start, clockwise=True)]


def _moved(element: Element, apart: float) -> list[Element]:
    try:
        return [offset_element(element, apart)]
    except GougeError:
        return []


def _ends(element: Element) -> tuple[Point, Point]:
    return element.start, element.end


def _ring(centre: Point, radius: float) -> Arc:
    start = centre[0] + radius, centre[1]
    return Arc(start, start, centre, clockwise=True)


def _split(piece: Element, edges: _Boxed) -> list[Element]:
    """The parts of a piece between the points where it meets any edge."""
    length = piece.length
    at = {0.0: piece.start, length: piece.end}
    for edge in edges.near(piece.box, SAME_POINT):
        for point in intersections(piece, edge):
            along = piece.along(point)
            if SAME_POINT < along < length - SAME_POINT:
                at[along] = point
    places = sorted(at)
    return [piece.part(at[a], at[b]) for a, b in pairwise(places) if b - a > SAME_POINT or len(places) == 2]


def _far(part: Element, contour: _Boxed, least: float) -> bool:
    """Whether the middle of a part, and with it all of it, is far enough from every element."""
    x, z = middle = part.point(part.length / 2)
    return all(distance(element, middle) >= least for element in contour.near((x, x, z, z), least))


def _chained(parts: list[Element]) -> list[Element]:
    """The parts that follow one another from the first one; what no way leads to is left out.

    Of several that begin in one point the last goes on: between them the offset went round where it may not.
    """
    if not parts:
        raise TrimError
    starts = np.array([part.start for part in parts])
    path, at = [parts[0]], 0
    while True:
        x, z = path[-1].end
        follows = np.flatnonzero(np.hypot(starts[at + 1 :, 0] - x, starts[at + 1 :, 1] - z) <= _FOLLOWS)
        if not follows.size:
            break
        at += 1 + int(follows[-1])
        path.append(parts[at])
    if sum(part.length for part in parts[at + 1 :]) > _LOST:
        raise TrimError
    return path
