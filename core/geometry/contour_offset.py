"""A contour moved to one side by a distance, and the spans that roughing may run beside one.

``Offset`` refuses a contour that the distance does not fit into; ``trimmed_offset``, for roughing,
does not: a fillet smaller than what is left on the part, or a groove narrower than twice that, is passed by.

Points of roughing are (depth, way) as seen from the tool's start point: the depth grows along X towards the
contour, the way along Z towards it; the contour runs so that the tool is on its left.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from math import dist, pi, sqrt
from typing import NamedTuple

import numpy as np

from core.geometry.lines_and_arcs import (
    SAME_POINT,
    Arc,
    Box,
    Element,
    Line,
    Point,
    clearance,
    distance,
    holds,
    intersections,
    left_of,
    turn,
)

# Elements whose offsets end nearer than this go on in one point half way. Programs round their numbers to
# 1.27 µm, so what was meant as tangent is tangent no better, and no machine can take the step. mm.
JOINED = 0.001

# The offset may be this much nearer to the contour than its distance: half a join and rounding, and less
# than the 2 µm that a workpiece can show. mm.
NEARER = 0.0015

# Turns nearer than this to half a circle run straight back on themselves: no side is the free one. rad.
STRAIGHT_BACK = 1e-6

# So many elements back and forth are looked at for a second wall that the offset runs into. The offset
# is held back by as many, so that it is not used before it has been looked at.
WINDOW = 128
# Offsets of tangent elements are joined over a rounding of the program; a path may be nearer by so much. mm.
_NEARER = 0.0005
# Pieces of the path follow each other where the end of one is this near to the start of the next: short arcs
# in rounded words are tangent to some hundredths of a degree, and the path beside them steps by that. mm.
_FOLLOWS = 5 * JOINED
# What may be left over behind the end of the path: parts that are too near by less than _NEARER. mm.
_LOST = 0.02
Span = tuple[float, float]
"""From where to where along the way, mm."""
_SHORTEST = 0.001  # mm; half the width of what a workpiece can show
_TOUCH = 1e-6  # mm; a line so little deeper than a wall lies on it
_ENDLESS = float("inf")


class GougeError(Exception):
    """The offset of a contour cuts into it. ``index`` is the element that cannot be followed, from 0.

    ``why`` is a clause about it, in which the distance is "that".
    """

    def __init__(self, index: int, why: str) -> None:
        super().__init__(why)
        self.index = index
        self.why = why


class Piece(NamedTuple):
    """A piece of an offset. ``corner``: an arc about the corner at the end of the element ``source``."""

    source: int  # index of the element, from 0
    element: Element
    corner: bool


def offset_element(element: Element, distance_left: float) -> Element:
    """The element moved to its left by ``distance_left`` mm, negative to the right; arcs stay concentric.

    Raises GougeError (index 0) for an arc that has no radius left.
    """
    ax, az = left_of(element.start_direction)
    bx, bz = left_of(element.end_direction)
    start = element.start[0] + ax * distance_left, element.start[1] + az * distance_left
    end = element.end[0] + bx * distance_left, element.end[1] + bz * distance_left
    if isinstance(element, Line):
        return Line(start, end)
    grown = element.radius + (distance_left if element.clockwise else -distance_left)
    if grown < SAME_POINT:
        raise GougeError(0, "the inside radius of the move is too small for the offset path")
    return Arc(start, end, element.centre, element.clockwise)


class Offset:
    """The path ``distance_left`` mm to the left of a contour (negative: right) that comes in by elements.

    It starts and ends square to the contour. Each element must start where the one before it ends, and have a
    length. GougeError is raised where an inside arc is too small, an element vanishes or would be run
    backwards, or a path comes nearer to any element than the distance (a second wall farther than WINDOW
    elements away is not seen).
    """

    def __init__(self, distance_left: float) -> None:
        self._distance = distance_left
        self._count = 0
        self._last: tuple[Element, Element] | None = None  # contour and offset, its start where it will be
        self._ready: deque[Piece] = deque()
        self._guard = _Guard(abs(distance_left))

    def add(self, element: Element) -> Iterator[Piece]:
        """Takes the next element; yields the pieces that are sure by now. Raises GougeError."""
        index = self._count
        self._count += 1
        try:
            moved = offset_element(element, self._distance)
        except GougeError as problem:
            raise GougeError(index, problem.why) from None
        if self._last is not None:
            moved = self._join(*self._last, element, moved, index)
        self._guard.contour(index, element)
        self._last = element, moved
        while len(self._ready) > WINDOW:
            yield self._ready.popleft()

    def close(self) -> Iterator[Piece]:
        """The rest of the pieces: no element comes any more. Raises GougeError."""
        if self._last is not None:
            self._keep(self._count - 1, self._last[1], corner=False)
            self._last = None
        while self._ready:
            yield self._ready.popleft()

    def _join(self, before: Element, ended: Element, after: Element, begun: Element, index: int) -> Element:
        """Ends the offset of one element at that of the next, which is returned with its new start."""
        corner = after.start
        angle = turn(before.end_direction, after.start_direction)
        if abs(angle) > pi - STRAIGHT_BACK and self._distance:
            raise GougeError(index, "the move reverses the direction of the previous move")
        if dist(ended.end, begun.start) <= JOINED:
            joint = _middle(ended.end, begun.start)
            joint = ended.end if dist(joint, ended.end) < SAME_POINT else joint
            self._keep(index - 1, _cut(ended, ended.start, joint, index - 1), corner=False)
            return begun.part(joint, begun.end)
        if (angle > 0) != (self._distance > 0):
            self._keep(index - 1, ended, corner=False)
            around = Arc(ended.end, begun.start, corner, clockwise=angle < 0)
            self._keep(index - 1, around, corner=True)
            return begun
        joint = _inside(ended, begun, corner, index)
        self._keep(index - 1, _cut(ended, ended.start, joint, index - 1), corner=False)
        return _cut(begun, joint, begun.end, index)

    def _keep(self, index: int, element: Element, *, corner: bool) -> None:
        piece = Piece(index, element, corner)
        self._guard.path(piece)
        self._ready.append(piece)


def pieces_beside(elements: Iterable[Element], distance_left: float) -> list[Piece]:
    """The whole path beside a contour that is known. Raises GougeError as ``Offset`` does."""
    offset = Offset(distance_left)
    found = [piece for element in elements for piece in offset.add(element)]
    return [*found, *offset.close()]


def _middle(a: Point, b: Point) -> Point:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def _inside(ended: Element, begun: Element, corner: Point, index: int) -> Point:
    """Where two offsets meet at an inside corner: of two points the one nearer to the corner."""
    found = intersections(ended, begun)
    if not found:
        shorter = index - 1 if ended.length < begun.length else index
        raise GougeError(shorter, "the neighboring moves leave no room for the offset path of the move")
    return min(found, key=lambda point: dist(point, corner))


def _cut(element: Element, start: Point, end: Point, index: int) -> Element:
    """The part of an offset between two points. Raises GougeError where it vanishes or runs backwards."""
    whole = start == element.start and end == element.end
    if not whole and element.along(end) - element.along(start) < 2 * SAME_POINT:  # else an arc could close
        raise GougeError(index, "the neighboring moves leave no room for the offset path of the move")
    return element.part(start, end)


class _Guard:
    """Watches that no piece of the offset comes nearer to any element of the contour than it should."""

    def __init__(self, apart: float) -> None:
        self._least = apart - NEARER
        self._contour: deque[tuple[Element, Box]] = deque(maxlen=WINDOW)
        self._path: deque[tuple[Element, Box]] = deque(maxlen=WINDOW)

    def contour(self, index: int, element: Element) -> None:
        box = element.box
        if self._too_near(element, box, self._path):
            raise GougeError(index, "the offset path of another move would cut into this move")
        self._contour.append((element, box))

    def path(self, piece: Piece) -> None:
        box = piece.element.box
        if self._too_near(piece.element, box, self._contour):
            raise GougeError(
                piece.source, "the compensated path of the move would gouge another part of the contour"
            )
        self._path.append((piece.element, box))

    def _too_near(self, element: Element, box: Box, others: deque[tuple[Element, Box]]) -> bool:
        least = self._least
        x0, x1, z0, z1 = box[0] - least, box[1] + least, box[2] - least, box[3] + least
        for other, (low_x, high_x, low_z, high_z) in others:
            if low_x > x1 or high_x < x0 or low_z > z1 or high_z < z0:
                continue  # nearly all; the rest takes a hundred times as long to tell
            if clearance(element, other) < least:
                return True
        return False


# --- the offset with what is not reached left out -------------------------------------------------------


class TrimError(Exception):
    """There is no unbroken way along the contour at this distance."""


def around(element: Element, apart: float) -> list[Element]:
    """Curves that hold the edge of all that lies within ``apart`` of an element; they lie in it or on it."""
    return [*moved(element, apart), *moved(element, -apart), *(_ring(p, apart) for p in _ends(element))]


def trimmed_offset(elements: Sequence[Element], apart: float) -> list[Element]:
    """The path ``apart`` mm to the left of a contour, nowhere nearer to it than that by over 0.5 µm.

    Each element must start where the one before it ends. Raises TrimError where the path falls apart.
    """
    if apart <= 0:
        return list(elements)
    contour = Boxed(elements)
    edges = Boxed([edge for element in elements for edge in around(element, apart)])
    kept = [
        part
        for piece in _pieces(elements, apart)
        for part in split_at(piece, edges)
        if _far(part, contour, apart - _NEARER)
    ]
    return _chained(kept)


class Boxed:
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
    pieces = moved(elements[0], apart)
    for before, after in pairwise(elements):
        angle = turn(before.end_direction, after.start_direction)
        if angle < 0:
            pieces += _corner(before, after, apart)
        pieces += moved(after, apart)
    return pieces


def _corner(before: Element, after: Element, apart: float) -> list[Element]:
    """Also beside a fillet that is smaller than the distance, which has no path of its own."""
    first, last = (
        (after.start[0] + side[0] * apart, after.start[1] + side[1] * apart)
        for side in (left_of(before.end_direction), left_of(after.start_direction))
    )
    return [] if dist(first, last) < SAME_POINT else [Arc(first, last, after.start, clockwise=True)]


def moved(element: Element, apart: float) -> list[Element]:
    """The element that much to its left; none where an arc has no radius left."""
    try:
        return [offset_element(element, apart)]
    except GougeError:
        return []


def _ends(element: Element) -> tuple[Point, Point]:
    return element.start, element.end


def _ring(centre: Point, radius: float) -> Arc:
    start = centre[0] + radius, centre[1]
    return Arc(start, start, centre, clockwise=True)


def split_at(piece: Element, edges: Boxed) -> list[Element]:
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


def _far(part: Element, contour: Boxed, least: float) -> bool:
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
