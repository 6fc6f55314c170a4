"""Offset of a contour by a distance, and the spans in which roughing may move next to a contour.

``Offset`` rejects a contour into which the distance does not fit. ``trimmed_offset``, for roughing, leaves
out fillets smaller than the allowance and grooves narrower than twice the allowance.

Points of roughing are (depth, distance along Z) as seen from the start point of the tool. The depth grows
along X toward the contour, and the second value along Z toward it. The contour runs with the tool on its
left.
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

# mm. Offsets whose ends are closer than this are joined at their midpoint. Programs round their numbers to
# 1.27 µm, so tangents are not more exact than that, and no machine can follow such a step.
JOINED = 0.001

# mm by which the offset may be closer to the contour than its distance. The value is half a join plus
# rounding, and less than the 2 µm that are visible on a workpiece.
NEARER = 0.0015

# rad. A turn closer than this to 180 degrees is a reversal, where neither side is free.
STRAIGHT_BACK = 1e-6

# Number of elements before and after that are checked for a second wall. The output is delayed by the same
# number, so that it is not used before it has been checked.
WINDOW = 128
# mm by which a path may be closer, because offsets of tangent elements are joined across rounding errors.
_NEARER = 0.0005
# mm between the end of one piece and the start of the next. Short arcs in rounded words are tangent only to
# some hundredths of a degree, which causes a step in the offset.
_FOLLOWS = 5 * JOINED
# mm of parts that may remain unused after the end of the path.
_LOST = 0.02
Span = tuple[float, float]
"""From where to where along the way, mm."""
_SHORTEST = 0.001  # mm; half of what is visible on a workpiece
_TOUCH = 1e-6  # mm; a line that is deeper than a wall by less is on the wall
_ENDLESS = float("inf")


class GougeError(Exception):
    """Raised when the offset of a contour cuts into the contour.

    ``index`` is the number of the element that cannot be offset, from 0. ``why`` is a clause about the
    element.
    """

    def __init__(self, index: int, why: str) -> None:
        super().__init__(why)
        self.index = index
        self.why = why


class Piece(NamedTuple):
    """A piece of an offset contour.

    ``corner`` is True for an arc around the corner at the end of the element ``source``.
    """

    source: int  # index of the element, from 0
    element: Element
    corner: bool


def offset_element(element: Element, distance_left: float) -> Element:
    """Return the element offset by ``distance_left`` mm to its left; negative values offset to the right.

    Arcs remain concentric. Raises GougeError (index 0) for an arc whose radius would vanish.
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
    """The offset of a contour whose elements are added one by one.

    The path is ``distance_left`` mm to the left of the contour, or to the right if negative. It starts and
    ends square to the contour. Each element must have a length and start at the end of the previous one.
    GougeError is raised if an inside arc is too small, if an element vanishes or would be reversed, or if the
    path is closer to any element than the distance. A second wall more than WINDOW elements away is not
    detected.
    """

    def __init__(self, distance_left: float) -> None:
        self._distance = distance_left
        self._count = 0
        # the last contour element and its offset, which has its final start
        self._last: tuple[Element, Element] | None = None
        self._ready: deque[Piece] = deque()
        self._guard = _Guard(abs(distance_left))

    def add(self, element: Element) -> Iterator[Piece]:
        """Add the next element and yield the pieces that are final. Raises GougeError."""
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
        """Yield the remaining pieces after the last element. Raises GougeError."""
        if self._last is not None:
            self._keep(self._count - 1, self._last[1], corner=False)
            self._last = None
        while self._ready:
            yield self._ready.popleft()

    def _join(self, before: Element, ended: Element, after: Element, begun: Element, index: int) -> Element:
        """Join the offsets of two elements; return the second one with its new start."""
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
    """Return the complete offset of a known contour. Raises GougeError like ``Offset``."""
    offset = Offset(distance_left)
    found = [piece for element in elements for piece in offset.add(element)]
    return [*found, *offset.close()]


def _middle(a: Point, b: Point) -> Point:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def _inside(ended: Element, begun: Element, corner: Point, index: int) -> Point:
    """Return the intersection of two offsets at an inside corner that is closer to the corner."""
    found = intersections(ended, begun)
    if not found:
        shorter = index - 1 if ended.length < begun.length else index
        raise GougeError(shorter, "the neighboring moves leave no room for the offset path of the move")
    return min(found, key=lambda point: dist(point, corner))


def _cut(element: Element, start: Point, end: Point, index: int) -> Element:
    """Return the part of an offset between two points. Raises GougeError if it vanishes or reverses."""
    whole = start == element.start and end == element.end
    # otherwise an arc could become a full circle
    if not whole and element.along(end) - element.along(start) < 2 * SAME_POINT:
        raise GougeError(index, "the neighboring moves leave no room for the offset path of the move")
    return element.part(start, end)


class _Guard:
    """Checks that no piece of the offset is closer to an element of the contour than permitted."""

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
                continue  # true for nearly all elements; the exact check takes a hundred times as long
            if clearance(element, other) < least:
                return True
        return False


# --- trimmed offsets ------------------------------------------------------------------------------------


class TrimError(Exception):
    """Raised when the offset of a contour is not a continuous path at this distance."""


def around(element: Element, apart: float) -> list[Element]:
    """Return curves that contain the edge of the region within ``apart`` mm of an element."""
    return [*moved(element, apart), *moved(element, -apart), *(_ring(p, apart) for p in _ends(element))]


def trimmed_offset(elements: Sequence[Element], apart: float) -> list[Element]:
    """Return the path ``apart`` mm to the left of a contour, closer to it by at most 0.5 µm.

    Each element must start at the end of the previous one. Raises TrimError if the path is not continuous.
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
    """Elements that can be searched by position."""

    def __init__(self, elements: Sequence[Element]) -> None:
        self._elements = elements
        self._boxes = np.array([element.box for element in elements])

    def near(self, box: Box, within: float) -> list[Element]:
        """Return the elements whose bounding boxes are at most ``within`` mm from ``box`` along both axes."""
        x0, x1, z0, z1 = self._boxes.T
        hit = (x0 <= box[1] + within) & (x1 >= box[0] - within)
        hit &= (z0 <= box[3] + within) & (z1 >= box[2] - within)
        return [self._elements[at] for at in np.flatnonzero(hit).tolist()]


def _pieces(elements: Sequence[Element], apart: float) -> list[Element]:
    """Return the left offset of each element, and an arc around each corner that turns right."""
    pieces = moved(elements[0], apart)
    for before, after in pairwise(elements):
        angle = turn(before.end_direction, after.start_direction)
        if angle < 0:
            pieces += _corner(before, after, apart)
        pieces += moved(after, apart)
    return pieces


def _corner(before: Element, after: Element, apart: float) -> list[Element]:
    """Return the arc around a corner, even next to a fillet whose own offset has vanished."""
    first, last = (
        (after.start[0] + side[0] * apart, after.start[1] + side[1] * apart)
        for side in (left_of(before.end_direction), left_of(after.start_direction))
    )
    return [] if dist(first, last) < SAME_POINT else [Arc(first, last, after.start, clockwise=True)]


def moved(element: Element, apart: float) -> list[Element]:
    """Return the element offset to its left, or an empty list for an arc whose radius would vanish."""
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
    """Return the parts of a piece between its intersections with the edges."""
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
    """Return whether the middle of a part, and so the whole part, is far enough from every element."""
    x, z = middle = part.point(part.length / 2)
    return all(distance(element, middle) >= least for element in contour.near((x, x, z, z), least))


def _chained(parts: list[Element]) -> list[Element]:
    """Return the parts that form a continuous path from the first one.

    If several parts start at one point, the last one is used, because the offset loops between them. Raises
    TrimError if a part of relevant length is not reached.
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
    """The area between the start point and the contour, without the allowance on the contour.

    ``path`` is the path along the contour at the distance ``left`` (mm), from the start to the end of the
    area. Raises TrimError if no such path exists.
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
        """True if the path reverses along Z. No span can reach the region after such an edge."""
        return any(
            element.box[2] < element.start[1] - _TOUCH or element.box[3] > element.end[1] + _TOUCH
            for element in self.path
        )

    def spans(self, depth: float) -> list[Span]:
        """Return the spans along Z in which a tool may move at ``depth``.

        Above each span, up to depth 0, there is also no contour.
        """
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
    """Return the parts of an element along which the depth only increases or only decreases."""
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
    """Return the span along Z of the part of a wall that is not deeper than ``depth``, or None."""
    places = [place for edge in wall for place in _places(edge, depth)]
    return (min(places), max(places)) if places else None


def _places(edge: Element, depth: float) -> list[float]:
    """Return positions along Z that include both extremes of the part of an edge down to ``depth``."""
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
