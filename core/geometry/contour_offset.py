"""Offset of a contour by a distance, and the spans along Z that are free for roughing.

``OffsetBuilder`` rejects a contour that has no room for the distance. ``trim_offset``, for roughing, omits
fillets smaller than the allowance and grooves narrower than twice the allowance.

Points for roughing are (depth, distance along Z) from the start point of the tool. Both values increase
toward the contour. The contour is directed so that the tool is on its left.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from math import dist, pi, sqrt
from typing import NamedTuple

import numpy as np

from core.geometry.lines_and_arcs import (
    SAME_POINT_TOLERANCE_MM,
    Arc,
    BoundingBox,
    Element,
    Line,
    Point,
    compute_distance_to_point,
    compute_min_distance,
    compute_turn_angle,
    contains_point,
    find_intersections,
    get_left_normal,
)

# mm. Offsets whose ends are closer than this are joined at their midpoint. Programs round their numbers to
# 1.27 µm, so tangents are not more exact than that, and no machine can follow such a step.
JOIN_TOLERANCE_MM = 0.001

# mm by which the offset may be closer to the contour than its distance. The value is half a join plus
# rounding, and less than the 2 µm that are visible on a workpiece.
OFFSET_TOLERANCE_MM = 0.0015

# rad. A turn closer than this to 180 degrees is a reversal, where neither side is free.
REVERSAL_TOLERANCE_RAD = 1e-6

# Number of elements before and after that are checked for a second wall. The output is delayed by the same
# number, so that it is not used before it has been checked.
GOUGE_CHECK_ELEMENT_COUNT = 128
# mm by which a path may be closer, because offsets of tangent elements are joined across rounding errors.
_NEARER = 0.0005
# mm between the end of one piece and the start of the next. Short arcs in rounded words are tangent only to
# some hundredths of a degree, which causes a step in the offset.
_JOINT_TOLERANCE_MM = 5 * JOIN_TOLERANCE_MM
# mm of parts that may remain unused after the end of the path.
_MAX_UNUSED_MM = 0.02
ZSpan = tuple[float, float]
"""Start and end of a span along the path, in mm."""
_MIN_SPAN_MM = 0.001  # mm; half of what is visible on a workpiece
_TOUCH = 1e-6  # mm; a line that is deeper than a wall by less is on the wall
_INFINITE_MM = float("inf")


class GougeError(Exception):
    """An error raised if the offset path of a contour would cut into the contour.

    ``element_index`` is the index (from 0) of the element that cannot be offset. ``reason`` is a clause
    about the element.
    """

    def __init__(self, index: int, reason: str) -> None:
        super().__init__(reason)
        self.element_index = index
        self.reason = reason


class OffsetPiece(NamedTuple):
    """A line or arc of an offset contour.

    ``is_corner`` is True for an arc around the corner at the end of the element ``source_index``.
    """

    source_index: int  # index of the element, from 0
    element: Element
    is_corner: bool


def offset_element(element: Element, distance_left: float) -> Element:
    """Return the element offset by ``distance_left`` mm to its left.

    A negative value offsets the element to the right. Arcs remain concentric. Raises GougeError
    (``element_index`` 0) for an arc whose radius would vanish.
    """
    ax, az = get_left_normal(element.start_direction)
    bx, bz = get_left_normal(element.end_direction)
    start = element.start[0] + ax * distance_left, element.start[1] + az * distance_left
    end = element.end[0] + bx * distance_left, element.end[1] + bz * distance_left
    if isinstance(element, Line):
        return Line(start, end)
    grown = element.radius + (distance_left if element.clockwise else -distance_left)
    if grown < SAME_POINT_TOLERANCE_MM:
        raise GougeError(0, "the inside radius of the move is too small for the offset path")
    return Arc(start, end, element.center, element.clockwise)


class OffsetBuilder:
    """Builder of the offset path of a contour whose elements are added one by one.

    The path is ``distance_left`` mm to the left of the contour, or to the right if negative. It starts and
    ends perpendicular to the contour. Each element must have a length and must start at the end of the
    previous element. GougeError is raised if an inside arc is too small, if an element reverses the
    direction of the previous element, if the offset of an element vanishes or would be reversed, or if the
    path is too close to an element by more than 0.0015 mm. A second wall that is more than
    GOUGE_CHECK_ELEMENT_COUNT elements away is not detected.
    """

    def __init__(self, distance_left: float) -> None:
        self._distance = distance_left
        self._count = 0
        # the last contour element and its offset, which has its final start
        self._last: tuple[Element, Element] | None = None
        self._ready: deque[OffsetPiece] = deque()
        self._guard = _GougeGuard(abs(distance_left))

    def add(self, element: Element) -> Iterator[OffsetPiece]:
        """Add the next element, and yield the final pieces. Raises GougeError if the offset would gouge."""
        index = self._count
        self._count += 1
        try:
            moved = offset_element(element, self._distance)
        except GougeError as problem:
            raise GougeError(index, problem.reason) from None
        if self._last is not None:
            moved = self._join_offsets(*self._last, element, moved, index)
        self._guard.add_contour_element(index, element)
        self._last = element, moved
        while len(self._ready) > GOUGE_CHECK_ELEMENT_COUNT:
            yield self._ready.popleft()

    def finish_contour(self) -> Iterator[OffsetPiece]:
        """Yield the remaining pieces after the last element. Raises GougeError if the offset would gouge."""
        if self._last is not None:
            self._keep(self._count - 1, self._last[1], corner=False)
            self._last = None
        while self._ready:
            yield self._ready.popleft()

    def _join_offsets(
        self, before: Element, first_offset: Element, after: Element, second_offset: Element, index: int
    ) -> Element:
        """Join the offsets of two elements; return the second offset with its new start."""
        corner = after.start
        angle = compute_turn_angle(before.end_direction, after.start_direction)
        if abs(angle) > pi - REVERSAL_TOLERANCE_RAD and self._distance:
            raise GougeError(index, "the move reverses the direction of the previous move")
        if dist(first_offset.end, second_offset.start) <= JOIN_TOLERANCE_MM:
            joint = _middle(first_offset.end, second_offset.start)
            joint = first_offset.end if dist(joint, first_offset.end) < SAME_POINT_TOLERANCE_MM else joint
            self._keep(
                index - 1, _cut_offset(first_offset, first_offset.start, joint, index - 1), corner=False
            )
            return second_offset.cut_section(joint, second_offset.end)
        if (angle > 0) != (self._distance > 0):
            self._keep(index - 1, first_offset, corner=False)
            around = Arc(first_offset.end, second_offset.start, corner, clockwise=angle < 0)
            self._keep(index - 1, around, corner=True)
            return second_offset
        joint = _inside_corner(first_offset, second_offset, corner, index)
        self._keep(index - 1, _cut_offset(first_offset, first_offset.start, joint, index - 1), corner=False)
        return _cut_offset(second_offset, joint, second_offset.end, index)

    def _keep(self, index: int, element: Element, *, corner: bool) -> None:
        piece = OffsetPiece(index, element, corner)
        self._guard.check_path_piece(piece)
        self._ready.append(piece)


def offset_known_contour(elements: Iterable[Element], distance_left: float) -> list[OffsetPiece]:
    """Return the complete offset of a known contour. Raises GougeError as ``OffsetBuilder`` does."""
    offset = OffsetBuilder(distance_left)
    found = [piece for element in elements for piece in offset.add(element)]
    return [*found, *offset.finish_contour()]


def _middle(a: Point, b: Point) -> Point:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def _inside_corner(first_offset: Element, second_offset: Element, corner: Point, index: int) -> Point:
    """Return the intersection of two offsets that is nearest to their inside corner."""
    found = find_intersections(first_offset, second_offset)
    if not found:
        shorter = index - 1 if first_offset.length < second_offset.length else index
        raise GougeError(shorter, "the neighboring moves leave no room for the offset path of the move")
    return min(found, key=lambda point: dist(point, corner))


def _cut_offset(element: Element, start: Point, end: Point, index: int) -> Element:
    """Return the section of an offset between two points. Raises GougeError if it vanishes or reverses."""
    whole = start == element.start and end == element.end
    # otherwise an arc could become a full circle
    if (
        not whole
        and element.get_distance_from_start(end) - element.get_distance_from_start(start)
        < 2 * SAME_POINT_TOLERANCE_MM
    ):
        raise GougeError(index, "the neighboring moves leave no room for the offset path of the move")
    return element.cut_section(start, end)


class _GougeGuard:
    """Checker that rejects a piece of the offset that is too close to an element of the contour."""

    def __init__(self, apart: float) -> None:
        self._least = apart - OFFSET_TOLERANCE_MM
        self._contour: deque[tuple[Element, BoundingBox]] = deque(maxlen=GOUGE_CHECK_ELEMENT_COUNT)
        self._path: deque[tuple[Element, BoundingBox]] = deque(maxlen=GOUGE_CHECK_ELEMENT_COUNT)

    def add_contour_element(self, index: int, element: Element) -> None:
        box = element.bounding_box
        if self._too_near(element, box, self._path):
            raise GougeError(index, "the offset path of another move would cut into this move")
        self._contour.append((element, box))

    def check_path_piece(self, piece: OffsetPiece) -> None:
        box = piece.element.bounding_box
        if self._too_near(piece.element, box, self._contour):
            raise GougeError(
                piece.source_index, "the compensated path of the move would gouge another part of the contour"
            )
        self._path.append((piece.element, box))

    def _too_near(
        self, element: Element, box: BoundingBox, others: deque[tuple[Element, BoundingBox]]
    ) -> bool:
        least = self._least
        x0, x1, z0, z1 = box[0] - least, box[1] + least, box[2] - least, box[3] + least
        for other, (low_x, high_x, low_z, high_z) in others:
            if low_x > x1 or high_x < x0 or low_z > z1 or high_z < z0:
                continue  # true for nearly all elements; the exact check takes a hundred times as long
            if compute_min_distance(element, other) < least:
                return True
        return False


# --- trimmed offsets ------------------------------------------------------------------------------------


class TrimError(Exception):
    """An error raised if the offset of a contour is not a continuous path at this distance."""


def make_region_edges(element: Element, distance: float) -> list[Element]:
    """Return curves that include the boundary of the region within ``distance`` mm of an element."""
    return [
        *offset_element_to_left(element, distance),
        *offset_element_to_left(element, -distance),
        *(_ring(p, distance) for p in _ends(element)),
    ]


def trim_offset(elements: Sequence[Element], distance: float) -> list[Element]:
    """Return the path ``distance`` mm, or up to 0.5 µm less, to the left of a contour.

    Each element must start at the end of the previous element. Raises TrimError if the path is not
    continuous.
    """
    if distance <= 0:
        return list(elements)
    contour = ElementIndex(elements)
    edges = ElementIndex([edge for element in elements for edge in make_region_edges(element, distance)])
    kept = [
        part
        for piece in _offset_pieces(elements, distance)
        for part in split_at_edges(piece, edges)
        if _is_far_enough(part, contour, distance - _NEARER)
    ]
    return _follow_path(kept)


class ElementIndex:
    """A spatial index that finds the elements near a position."""

    def __init__(self, elements: Sequence[Element]) -> None:
        self._elements = elements
        self._boxes = np.array([element.bounding_box for element in elements])

    def find_elements_near(self, box: BoundingBox, distance: float) -> list[Element]:
        """Return the elements whose bounding boxes are near ``box``.

        An element is near if the distance is at most ``distance`` mm along both axes.
        """
        x0, x1, z0, z1 = self._boxes.T
        hit = (x0 <= box[1] + distance) & (x1 >= box[0] - distance)
        hit &= (z0 <= box[3] + distance) & (z1 >= box[2] - distance)
        return [self._elements[at] for at in np.flatnonzero(hit).tolist()]


def _offset_pieces(elements: Sequence[Element], distance: float) -> list[Element]:
    """Return the left offset of each element, and an arc around each corner that turns right."""
    pieces = offset_element_to_left(elements[0], distance)
    for before, after in pairwise(elements):
        angle = compute_turn_angle(before.end_direction, after.start_direction)
        if angle < 0:
            pieces += _corner_arc(before, after, distance)
        pieces += offset_element_to_left(after, distance)
    return pieces


def _corner_arc(before: Element, after: Element, distance: float) -> list[Element]:
    """Return the arc around a corner, or an empty list if its ends coincide.

    The arc is made even if the offset of an adjacent fillet has vanished.
    """
    first, last = (
        (after.start[0] + side[0] * distance, after.start[1] + side[1] * distance)
        for side in (get_left_normal(before.end_direction), get_left_normal(after.start_direction))
    )
    return (
        [] if dist(first, last) < SAME_POINT_TOLERANCE_MM else [Arc(first, last, after.start, clockwise=True)]
    )


def offset_element_to_left(element: Element, distance: float) -> list[Element]:
    """Return the element offset to its left, as a list.

    The list is empty for an arc whose radius would vanish.
    """
    try:
        return [offset_element(element, distance)]
    except GougeError:
        return []


def _ends(element: Element) -> tuple[Point, Point]:
    return element.start, element.end


def _ring(centre: Point, radius: float) -> Arc:
    start = centre[0] + radius, centre[1]
    return Arc(start, start, centre, clockwise=True)


def split_at_edges(piece: Element, edges: ElementIndex) -> list[Element]:
    """Return the sections of an offset piece, split where it intersects the edges of the region."""
    length = piece.length
    at = {0.0: piece.start, length: piece.end}
    for edge in edges.find_elements_near(piece.bounding_box, SAME_POINT_TOLERANCE_MM):
        for point in find_intersections(piece, edge):
            along = piece.get_distance_from_start(point)
            if SAME_POINT_TOLERANCE_MM < along < length - SAME_POINT_TOLERANCE_MM:
                at[along] = point
    places = sorted(at)
    return [
        piece.cut_section(at[a], at[b])
        for a, b in pairwise(places)
        if b - a > SAME_POINT_TOLERANCE_MM or len(places) == 2
    ]


def _is_far_enough(part: Element, contour: ElementIndex, min_distance: float) -> bool:
    """Return whether a section of the offset is far enough from every contour element.

    Only its middle is checked, because the whole section is then far enough too.
    """
    x, z = middle = part.get_point(part.length / 2)
    return all(
        compute_distance_to_point(element, middle) >= min_distance
        for element in contour.find_elements_near((x, x, z, z), min_distance)
    )


def _follow_path(parts: list[Element]) -> list[Element]:
    """Return the sections that form a continuous path, beginning with the first section.

    If several sections start at one point, the last one is used, because the offset loops between them.
    Raises TrimError if there are no sections, or if the sections after the end of the path are longer than
    0.02 mm in total.
    """
    if not parts:
        raise TrimError
    starts = np.array([part.start for part in parts])
    path, at = [parts[0]], 0
    while True:
        x, z = path[-1].end
        follows = np.flatnonzero(
            np.hypot(starts[at + 1 :, 0] - x, starts[at + 1 :, 1] - z) <= _JOINT_TOLERANCE_MM
        )
        if not follows.size:
            break
        at += 1 + int(follows[-1])
        path.append(parts[at])
    if sum(part.length for part in parts[at + 1 :]) > _MAX_UNUSED_MM:
        raise TrimError
    return path


class RoughingArea:
    """The area between the start point and the contour, without the allowance on the contour.

    ``path`` is the path along the contour at the distance ``allowance_mm``, from the start to the end of
    the area. Raises TrimError if no such path exists.
    """

    def __init__(self, contour: Sequence[Element], allowance_mm: float) -> None:
        self.contour, self.allowance_mm = contour, allowance_mm
        self.path = trim_offset(contour, allowance_mm)
        self.top_depth = min(element.bounding_box[0] for element in contour) - allowance_mm
        self.max_depth = max(element.bounding_box[1] for element in self.path)
        self._front, self._back = self.path[0].start, self.path[-1].end
        parts = [part for element in contour for part in _split_by_depth(element)]
        self._walls = [
            (
                part.bounding_box[0] - allowance_mm,
                make_region_edges(part, allowance_mm) if allowance_mm > 0 else [part],
            )
            for part in parts
        ]

    @property
    def reverses_in_z(self) -> bool:
        """Return whether the path reverses along Z.

        No span can reach the region after the point of reversal.
        """
        return any(
            element.bounding_box[2] < element.start[1] - _TOUCH
            or element.bounding_box[3] > element.end[1] + _TOUCH
            for element in self.path
        )

    def find_clear_spans(self, depth: float) -> list[ZSpan]:
        """Return the spans along Z in which a tool may move at ``depth``.

        Each span is also free of the contour at all smaller depths, up to depth 0.
        """
        met = [wall for least, wall in self._walls if least <= depth - _TOUCH]
        walls = [reach for wall in met if (reach := _span_at_depth(wall, depth - _TOUCH)) is not None]
        if depth > self._front[0] + _TOUCH:
            walls.append((-_INFINITE_MM, self._front[1]))
        found: list[ZSpan] = []
        at = 0.0
        for start, end in [*sorted(walls), (self._back[1], _INFINITE_MM)]:
            stop = min(start, self._back[1])
            if stop - at > _MIN_SPAN_MM:
                found.append((at, stop))
            at = max(at, end)
        return found


def _split_by_depth(element: Element) -> list[Element]:
    """Split an element into sections along which the depth only increases or only decreases."""
    if isinstance(element, Line):
        return [element]
    (cx, cz), radius = element.center, element.radius
    length = element.length
    turns = {
        at: point
        for point in ((cx - radius, cz), (cx + radius, cz))
        if _TOUCH < (at := element.get_distance_from_start(point)) < length - _TOUCH
    }
    points = [element.start, *(turns[at] for at in sorted(turns)), element.end]
    return [element.cut_section(a, b) for a, b in pairwise(points)]


def _span_at_depth(wall: Sequence[Element], depth: float) -> ZSpan | None:
    """Return the Z range of the part of a wall down to ``depth``, or None if the wall is deeper."""
    places = [place for edge in wall for place in _z_extremes(edge, depth)]
    return (min(places), max(places)) if places else None


def _z_extremes(edge: Element, depth: float) -> list[float]:
    """Return Z positions that include the minimum and maximum Z of an edge's part down to ``depth``."""
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
    (cu, cv), radius = arc.center, arc.radius
    return [point for point in ((cu, cv - radius), (cu, cv + radius)) if contains_point(arc, point)]


def _at_depth(arc: Arc, depth: float) -> list[Point]:
    (cu, cv), radius = arc.center, arc.radius
    square = radius * radius - (depth - cu) ** 2
    if square < 0:
        return []
    half = sqrt(square)
    return [point for point in ((depth, cv - half), (depth, cv + half)) if contains_point(arc, point)]
