"""Areas of pockets with islands, and their insets.

A boundary is a list of closed loops, and each loop is a list of consecutive elements. The area is to the
left of each loop, so a loop is counterclockwise around a pocket and clockwise around an island. Coordinates
are X and Y in mm.

The offset is exact, because lines remain lines and arcs remain arcs. A point belongs to the inset area if
no point of the boundary is closer than the distance. Every section of an offset element that is closer to
any other element is therefore omitted (``offset_element_to_left``, ``split_at_edges``). This also applies if
the area is divided into several parts or an island merges with a wall.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import ceil, dist, pi

import numpy as np
import numpy.typing as npt

from core.geometry.contour_offset import ElementIndex, offset_element_to_left, split_at_edges
from core.geometry.lines_and_arcs import (
    SAME_POINT_TOLERANCE_MM,
    Arc,
    Element,
    Line,
    Point,
    compute_distance_to_point,
    compute_min_distance,
    compute_turn_angle,
    get_left_normal,
    make_arc,
)

ElementLoop = list[Element]
ContainsPoint = Callable[[Point], bool]

_OFFSET_TOLERANCE_MM = (
    0.0005  # mm by which an offset may be closer to its boundary, because programs round their corners
)
_JOIN_TOLERANCE_MM = (
    0.005  # mm between the end of one part and the start of the next, because tangents are rounded too
)
_MIN_PART_MM = 0.002  # mm; shorter parts of an offset are overlaps of two rounded tangents
_MAX_TAIL_MM = 0.5  # mm; a longer dead end is an error
_SIDE_OFFSET_MM = 1e-5  # mm from a part, on either side, at which the area is tested
_HALF_TURN = pi - 1e-9


class PocketAreaError(Exception):
    """An error raised if contours enclose no area or cannot be offset. The message is a clause."""


def close_loop(elements: Sequence[Element]) -> ElementLoop:
    """Return the elements as a closed loop, with a line from the end to the start if they differ."""
    loop = list(elements)
    if loop and dist(loop[-1].end, loop[0].start) > SAME_POINT_TOLERANCE_MM:
        loop.append(Line(loop[-1].end, loop[0].start))
    return loop


# --- inside or outside ----------------------------------------------------------------------------------


class WindingCalculator:
    """Calculator of the winding number of a loop around points that are not on the loop.

    Counterclockwise is positive.
    """

    def __init__(self, loop: Sequence[Element]) -> None:
        halves = [part for element in loop for part in _split_large_arcs(element)]
        self._start = np.array([part.start for part in halves])
        self._end = np.array([part.end for part in halves])
        self._centre = np.array([part.center if isinstance(part, Arc) else (0.0, 0.0) for part in halves])
        self._radius = np.array([part.radius if isinstance(part, Arc) else -1.0 for part in halves])
        self._sense = np.array([(-1.0 if part.clockwise else 1.0) if isinstance(part, Arc) else 0.0
                                for part in halves])  # fmt: skip

    def compute_winding_number(self, point: Point) -> int:
        """Return the winding number of the loop around ``point``.

        The method adds the angles of the chords as seen from the point. It adds a full revolution for each
        arc if the point is between the arc and its chord.
        """
        a, b = self._start - point, self._end - point
        cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        angle = np.arctan2(cross, (a * b).sum(axis=1))
        off = np.hypot(*(self._centre - point).T)
        # The point is inside the circle of an arc of up to 180 degrees, on the arc's side of its chord.
        beyond = (off < self._radius) & (cross * self._sense < 0.0)
        return round(float(angle.sum() + 2.0 * pi * (self._sense * beyond).sum()) / (2.0 * pi))


def _split_large_arcs(element: Element) -> Iterator[Element]:
    """Yield the element, but divide an arc of more than half a circle into shorter arcs."""
    if isinstance(element, Line) or abs(element.sweep_rad) <= _HALF_TURN:
        yield element
        return
    count = ceil(abs(element.sweep_rad) / (pi / 2.0))
    points = [element.start, *(element.get_point(element.length * at / count) for at in range(1, count))]
    for start, end in pairwise((*points, element.end)):
        yield element.cut_section(start, end)


def compute_signed_area(loop: Sequence[Element]) -> float:
    """Return the area within a closed loop in mm², which is negative for a clockwise loop."""
    total = 0.0
    for element in loop:
        (x0, y0), (x1, y1) = element.start, element.end
        total += x0 * y1 - x1 * y0
        if isinstance(element, Arc):
            sweep = -element.sweep_rad  # counterclockwise is positive
            chord = (x0 - element.center[0], y0 - element.center[1])
            last = (x1 - element.center[0], y1 - element.center[1])
            total += element.radius**2 * sweep - (chord[0] * last[1] - chord[1] * last[0])
    return total / 2.0


def is_counterclockwise(loop: Sequence[Element]) -> bool:
    """Return whether the loop is counterclockwise. The result is also True if the loop encloses no area."""
    return compute_signed_area(loop) > -_JOIN_TOLERANCE_MM * sum(element.length for element in loop)


# --- boundary and offset ----------------------------------------------------------------------------------


def find_boundary(curves: Sequence[ElementLoop], contains_point: ContainsPoint) -> list[ElementLoop]:
    """Return the sections of the given curves that form the boundary of an area.

    ``contains_point`` defines the area. Raises PocketAreaError if the boundary is not closed.
    """
    elements = [part for loop in curves for element in loop for part in _split_large_arcs(element)]
    if not elements:
        return []
    every = ElementIndex(elements)
    parts = [part for element in elements for part in _divide_at_crossings(element, every)]
    kept = [side for part in parts if (side := _orient_boundary(part, contains_point)) is not None]
    return _chain_loops(_remove_duplicates(kept))


def _divide_at_crossings(element: Element, every: ElementIndex) -> list[Element]:
    """Return the sections of an element, divided where other elements cross it or end on it."""
    parts = split_at_edges(element, every)
    ends = {
        end
        for other in every.find_elements_near(element.bounding_box, SAME_POINT_TOLERANCE_MM)
        for end in (other.start, other.end)
    }
    for end in ends:
        parts = [piece for part in parts for piece in _cut(part, end)]
    return parts


def _cut(part: Element, at: Point) -> list[Element]:
    if (
        compute_distance_to_point(part, at) > SAME_POINT_TOLERANCE_MM
        or min(dist(at, part.start), dist(at, part.end)) <= 2 * SAME_POINT_TOLERANCE_MM
    ):
        return [part]
    return [part.cut_section(part.start, at), part.cut_section(at, part.end)]


def _orient_boundary(part: Element, contains_point: ContainsPoint) -> Element | None:
    """Return a section directed with the area on its left, or None if it is not on the boundary.

    A section is not on the boundary if the area is on both sides of it or on neither side.
    """
    x, y = part.get_point(part.length / 2.0)
    dx, dy = get_left_normal(_direction_halfway(part))
    left = contains_point((x + dx * _SIDE_OFFSET_MM, y + dy * _SIDE_OFFSET_MM))
    right = contains_point((x - dx * _SIDE_OFFSET_MM, y - dy * _SIDE_OFFSET_MM))
    if left == right:
        return None
    return part if left else part.make_reversed()


def _direction_halfway(part: Element) -> Point:
    middle = part.get_point(part.length / 2.0)
    return part.cut_section(middle, part.end).start_direction


def make_inset_loops(loops: Sequence[ElementLoop], distance: float) -> list[ElementLoop]:
    """Return the boundary of the points inside the loops, at least ``distance`` mm from the loops.

    Raises PocketAreaError if the boundary is not closed.
    """
    if distance <= 0.0 or not loops:
        return [list(loop) for loop in loops]
    contour = ElementIndex([element for loop in loops for element in loop])
    pieces = [piece for loop in loops for piece in _offset_inward(loop, distance)]
    if not pieces:
        return []
    every = ElementIndex(pieces)
    parts = [part for piece in pieces for part in split_at_edges(piece, every)]
    within = [WindingCalculator(loop) for loop in loops]
    long = (part for part in parts if part.length > _MIN_PART_MM)
    kept = [part for part in long if _apart(part, contour, distance - _OFFSET_TOLERANCE_MM, within)]
    return _chain_loops(_remove_duplicates(kept))


def _offset_inward(loop: ElementLoop, distance: float) -> Iterator[Element]:
    """Yield each element offset to its left, and an arc around each corner that turns right."""
    for before, after in zip(loop, [*loop[1:], loop[0]], strict=True):
        first, last = offset_element_to_left(before, distance), offset_element_to_left(after, distance)
        for each in first:
            yield from _split_large_arcs(each)
        if compute_turn_angle(before.end_direction, after.start_direction) < 0.0 and first and last:
            start, end = first[0].end, last[0].start
            if dist(start, end) > SAME_POINT_TOLERANCE_MM:
                yield from _split_large_arcs(Arc(start, end, after.start, clockwise=True))


def _apart(part: Element, contour: ElementIndex, least: float, within: Sequence[WindingCalculator]) -> bool:
    x, y = middle = part.get_point(part.length / 2.0)
    if any(
        compute_distance_to_point(element, middle) < least
        for element in contour.find_elements_near((x, x, y, y), least)
    ):
        return False
    return sum(each.compute_winding_number(middle) for each in within) > 0


def _remove_duplicates(parts: Sequence[Element]) -> list[Element]:
    """Return the parts without duplicates.

    Parts are duplicates if they coincide and have the same direction.
    """
    found: dict[tuple[int, ...], Element] = {}
    for part in parts:
        if part.length < SAME_POINT_TOLERANCE_MM:
            continue
        places = (*part.start, *part.end, *part.get_point(part.length / 2.0))
        key = tuple(round(value / (4 * SAME_POINT_TOLERANCE_MM)) for value in places)
        found.setdefault(key, part)
    return list(found.values())


def _chain_loops(parts: Sequence[Element]) -> list[ElementLoop]:
    """Connect the sections into closed loops, and return the loops.

    The loops are sorted by the length of their longest section, in descending order. Raises PocketAreaError
    if a loop is not closed.
    """
    parts = _remove_tails(parts)
    starts = np.array([part.start for part in parts]).reshape(-1, 2)
    free = np.ones(len(parts), dtype=bool)
    order = sorted(range(len(parts)), key=lambda each: -parts[each].length)
    loops = (_collect_loop(parts, starts, free, at) for at in order if free[at])
    return [loop for loop in loops if loop]


def _remove_tails(parts: Sequence[Element]) -> list[Element]:
    """Return the parts without the short dead ends that result from crossings at a small angle."""
    left = list(parts)
    while left:
        starts, ends = np.array([part.start for part in left]), np.array([part.end for part in left])
        away = np.hypot(*(ends[:, None, :] - starts[None, :, :]).transpose(2, 0, 1))
        dead = (away.min(axis=1) > _JOIN_TOLERANCE_MM) | (away.min(axis=0) > _JOIN_TOLERANCE_MM)
        kept = [part for part, ends_here in zip(left, dead, strict=True)
                if not ends_here or part.length > _MAX_TAIL_MM]  # fmt: skip
        if len(kept) == len(left):
            break
        left = kept
    return left


def _collect_loop(parts: Sequence[Element], starts: npt.NDArray[np.float64], free: npt.NDArray[np.bool_],
          first: int) -> ElementLoop:  # fmt: skip
    """Return the closed loop that starts with the section ``first``, and mark its sections as used.

    If the loop is too short, the result is an empty list.
    """
    loop: ElementLoop = [parts[first]]
    free[first] = False
    while dist(loop[-1].end, loop[0].start) > SAME_POINT_TOLERANCE_MM:
        away = np.hypot(*(starts - loop[-1].end).T)
        away[~free] = np.inf
        home = dist(loop[-1].end, loop[0].start)
        nearest = float(away.min()) if away.size else np.inf
        if min(home, nearest) > _JOIN_TOLERANCE_MM:
            if sum(part.length for part in loop) <= 2 * _JOIN_TOLERANCE_MM:
                return []
            raise PocketAreaError("the offset contour is not closed")
        if home <= nearest:
            break
        after = max(np.flatnonzero(away <= nearest + SAME_POINT_TOLERANCE_MM).tolist(),
                    key=lambda at: _turn_between(loop[-1], parts[at]))  # fmt: skip
        free[after] = False
        loop.append(parts[after])
    return _close_gaps(loop)


def _turn_between(before: Element, after: Element) -> float:
    """Return the angle by which the direction changes from one element to the next.

    The caller selects the sharpest left turn, so that loops that touch at a point remain separate.
    """
    angle = compute_turn_angle(before.end_direction, after.start_direction)
    return angle if angle < _HALF_TURN else -pi  # a reversal comes last


def _close_gaps(loop: ElementLoop) -> ElementLoop:
    """Return the loop without small gaps: each element starts exactly where the previous one ends."""
    made: ElementLoop = []
    here = loop[-1].end
    for element in loop:
        if element.start == here:
            made.append(element)
        elif isinstance(element, Arc):
            made.append(make_arc(here, element.end, element.center, is_clockwise=element.clockwise))
        elif dist(here, element.end) > SAME_POINT_TOLERANCE_MM:
            made.append(Line(here, element.end))
        else:
            continue
        here = element.end
    return made


# --- moves within an area ---------------------------------------------------------------------------------


class AreaChecker:
    """Checker that determines whether moves remain inside an area."""

    def __init__(self, loops: Sequence[ElementLoop]) -> None:
        self._contour = ElementIndex([element for loop in loops for element in loop])
        self._windings = [WindingCalculator(loop) for loop in loops]

    def contains_element(self, element: Element, distance: float) -> bool:
        """Return whether the whole element is inside the area.

        The distance from the boundary must be at least ``distance`` mm.
        """
        near = self._contour.find_elements_near(element.bounding_box, distance)
        if any(compute_min_distance(other, element) < distance - 2 * _OFFSET_TOLERANCE_MM for other in near):
            return False
        return (
            sum(
                each.compute_winding_number(element.get_point(element.length / 2.0))
                for each in self._windings
            )
            > 0
        )


def move_loop_start_near(loop: ElementLoop, point: Point) -> ElementLoop:
    """Return the same closed loop, but starting near a point.

    The new start is the end or the middle of an element, whichever is nearest to the point.
    """
    best, cut = min(
        (dist(place, point), (index, half))
        for index, element in enumerate(loop)
        for half, place in ((False, element.start), (True, element.get_point(element.length / 2.0)))
    )
    del best
    index, half = cut
    return move_loop_start_to(loop, index, loop[index].length / 2.0 if half else 0.0)


def move_loop_start_to(loop: ElementLoop, index: int, distance: float) -> ElementLoop:
    """Return the same closed loop, but starting ``distance`` mm after the start of one element."""
    element = loop[index]
    turned = [*loop[index + 1 :], *loop[:index]]
    if distance <= SAME_POINT_TOLERANCE_MM or distance >= element.length - SAME_POINT_TOLERANCE_MM:
        return [element, *turned] if distance <= SAME_POINT_TOLERANCE_MM else [*turned, element]
    middle = element.get_point(distance)
    return [
        element.cut_section(middle, element.end),
        *turned,
        element.cut_section(element.start, middle),
    ]


def split_loop(loop: ElementLoop, length: float) -> tuple[list[Element], ElementLoop]:
    """Return the first ``length`` mm of a closed loop, and the loop starting at the split point.

    If ``length`` is greater than the length of the loop, the loop is repeated.
    """
    first_elements: list[Element] = []
    left, at = length, 0
    while left > SAME_POINT_TOLERANCE_MM:
        element = loop[at % len(loop)]
        if element.length > left + SAME_POINT_TOLERANCE_MM:
            first_elements.append(element.cut_section(element.start, element.get_point(left)))
            return first_elements, move_loop_start_to(loop, at % len(loop), left)
        first_elements.append(element)
        left -= element.length
        at += 1
    return first_elements, move_loop_start_to(loop, at % len(loop), 0.0)
