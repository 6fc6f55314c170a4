"""Extraction of a contour from a drawing: elements are connected, and one side is traced.

All points are (r, z) in mm, measured from the spindle axis and from the Z zero of the lathe.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from core.extras.drawings.drawing import DrawingError, check_processor_time
from core.geometry.lines_and_arcs import Arc, BoundingBox, Element, Line, Point, find_intersections, make_arc
from core.message import Message

DEFAULT_GAP_MM = 0.02
"""Default distance in mm within which two ends are joined."""
_AXIS = 1e-6  # mm
_CELLS, _IN_A_CELL = 64, 8  # number of cells along Z for the search of ends; elements in one cell
_SQUARE = 0.02  # cosine
_NO_BORE = "the contour has no bore at its face. Choose the outside, or another contour."
# mm along an element at which its direction is measured, which distinguishes tangent arcs of different radius
_AHEAD = 0.05


def _above_axis(drawn: Iterable[tuple[Element, BoundingBox]], gap: float) -> Iterator[Element]:
    """Yield the parts of elements at r > 0. Elements that cross the axis are cut there.

    Lines on the axis are omitted.
    """
    for each, box in drawn:
        if isinstance(each, Line) and abs(each.start[0]) <= gap and abs(each.end[0]) <= gap:
            continue
        low, high, z0, z1 = box
        if high <= 0.0:
            continue
        if low > 0.0 and max(high - low, z1 - z0) > _AXIS:
            yield each
            continue
        for part in _cut_at_axis(each, box):
            if part.get_point(part.length / 2.0)[0] > 0.0 and part.length > _AXIS:
                yield part


def _cut_at_axis(each: Element, box: BoundingBox) -> list[Element]:
    low, high, z0, z1 = box
    if low >= -_AXIS or high <= _AXIS:
        return [each]
    axis = Line((0.0, z0 - 1.0), (0.0, z1 + 1.0))
    return split_element(each, [(0.0, p[1]) for p in find_intersections(axis, each)])


def _crossings(drawn: Iterable[tuple[Element, BoundingBox]]) -> Iterator[float]:
    """Yield the Z positions at which elements cross the axis.

    Faces that cross the axis at a right angle are omitted.
    """
    for each, box in drawn:
        for part in _cut_at_axis(each, box)[:-1]:
            if abs(part.end_direction[1]) > _SQUARE:
                yield part.end[1]


def split_element(element: Element, points: Iterable[Point]) -> list[Element]:
    """Return the sections of an element between the given points on the element."""
    within = (p for p in points if _AXIS < element.get_distance_from_start(p) < element.length - _AXIS)
    places = [element.start, *sorted(within, key=element.get_distance_from_start), element.end]
    return [element.cut_section(a, b) for a, b in pairwise(places)]


@dataclass(slots=True)
class _Nodes:
    """Points at which ends of drawing elements meet. Ends within the gap distance share one node."""

    gap_mm: float
    points: list[Point] = field(default_factory=list)
    _cells: dict[tuple[int, int], list[int]] = field(default_factory=dict)
    _known: dict[Point, int] = field(default_factory=dict)  # found since the last new node

    def find_node(self, point: Point) -> int:
        """Return the number of the node at a point, or of a new node if no node is within the gap."""
        if (known := self._known.get(point)) is None:
            known = self._known[point] = self._found(point)
        return known

    def _found(self, point: Point) -> int:
        size = self.gap_mm or 1e-6
        i, k = math.floor(point[0] / size), math.floor(point[1] / size)
        near = [n for a in (i - 1, i, i + 1) for b in (k - 1, k, k + 1) for n in self._cells.get((a, b), ())]
        best = min(near, key=lambda n: math.dist(self.points[n], point), default=None)
        if best is not None and math.dist(self.points[best], point) <= size:
            return best
        self._known.clear()  # the new node may be nearer to known points
        self.points.append(point)
        self._cells.setdefault((i, k), []).append(len(self.points) - 1)
        return len(self.points) - 1


@dataclass(frozen=True, slots=True)
class ElementGroup:
    """A group of connected drawing elements.

    ``element_end_nodes`` contains the two node numbers of each element, and ``node_points`` the positions
    of the nodes.
    """

    elements: tuple[Element, ...]
    element_end_nodes: tuple[tuple[int, int], ...]
    node_points: tuple[Point, ...]
    widest_closed_gap_mm: float = 0.0  # mm, the widest gap that was closed
    # Z positions at which an element crosses the axis at an angle other than 90 degrees
    axis_crossings_z: tuple[float, ...] = ()

    @property
    def extent_mm(self) -> tuple[float, float, float]:
        """Return the smallest Z, the largest Z and the largest r of the group, in mm."""
        boxes = [each.bounding_box for each in self.elements]
        return min(b[2] for b in boxes), max(b[3] for b in boxes), max(b[1] for b in boxes)


def find_element_groups(elements: Iterable[Element], gap: float = DEFAULT_GAP_MM) -> list[ElementGroup]:
    """Return the groups of connected elements.

    Groups that touch the axis are first, followed by the others in order of size. Duplicate lines count
    once.
    """
    drawn = [(each, each.bounding_box) for each in elements]
    parts = _split_at_touching_ends(list(_above_axis(drawn, gap)), gap)
    nodes, found, widest = _Nodes(gap), dict[tuple[int, int, int, int], tuple[Element, float]](), 0.0
    for each in parts:
        a, b = nodes.find_node(each.start), nodes.find_node(each.end)
        if a == b:
            continue
        middle = each.get_point(each.length / 2.0)
        key = (min(a, b), max(a, b), round(middle[0] / (2 * gap)), round(middle[1] / (2 * gap)))
        moved = max(math.dist(each.start, nodes.points[a]), math.dist(each.end, nodes.points[b]))
        found.setdefault(key, (_moved(each, nodes.points[a], nodes.points[b]), moved))
        widest = max(widest, moved)
    owner = _hanging(len(nodes.points), [(a, b) for a, b, _, _ in found])
    groups: dict[int, list[tuple[Element, float]]] = {}
    for (a, _b, _, _), part in found.items():
        groups.setdefault(owner[a], []).append(part)
    through = tuple(_crossings(drawn))
    made = [replace(_net(group, nodes), axis_crossings_z=through) for group in groups.values()]
    return sorted(made, key=lambda net: (not _on_axis(net, gap), -len(net.elements)))


def _net(group: list[tuple[Element, float]], nodes: _Nodes) -> ElementGroup:
    elements = tuple(each for each, _ in group)
    ends = tuple((nodes.find_node(each.start), nodes.find_node(each.end)) for each in elements)
    return ElementGroup(elements, ends, tuple(nodes.points), max(moved for _, moved in group))


def _on_axis(net: ElementGroup, gap: float) -> bool:
    return any(net.node_points[n][0] <= gap for pair in net.element_end_nodes for n in pair)


def _moved(element: Element, a: Point, b: Point) -> Element:
    """Return the element with its ends moved to ``a`` and ``b``, the positions of its nodes."""
    if isinstance(element, Line):
        return Line(a, b)
    return make_arc(a, b, element.center, is_clockwise=element.clockwise)


def _hanging(count: int, pairs: Sequence[tuple[int, int]]) -> list[int]:
    """Return for each node the number of the node that represents its group of connected nodes."""
    owner = list(range(count))

    def find_root(n: int) -> int:
        while owner[n] != n:
            owner[n] = owner[owner[n]]
            n = owner[n]
        return n

    for a, b in pairs:
        owner[find_root(a)] = find_root(b)
    return [find_root(n) for n in range(count)]


def _split_at_touching_ends(elements: list[Element], gap: float) -> list[Element]:
    """Split elements where the end of another element touches them, for example at a shoulder."""
    if not elements:
        return []
    boxes = [each.bounding_box for each in elements]
    low, high = min(b[2] for b in boxes), max(b[3] for b in boxes)
    size = max((high - low) / max(_CELLS, len(elements) // _IN_A_CELL), gap)
    cells: dict[int, list[Point]] = {}
    for each in elements:
        for end in (each.start, each.end):
            cells.setdefault(math.floor((end[1] - low) / size), []).append(end)
    found: list[Element] = []
    for each, box in zip(elements, boxes, strict=True):
        check_processor_time()
        if each.length <= 2.0 * gap:  # every point is within the gap of one of its ends
            found.append(each)
            continue
        # faster than calculating the distance from an arc, and larger than the rounding error
        reach = gap + _AXIS
        r0, r1, z0, z1 = box[0] - reach, box[1] + reach, box[2] - reach, box[3] + reach
        cell = range(math.floor((z0 - low) / size), math.floor((z1 - low) / size) + 1)
        near = (p for k in cell for p in cells.get(k, ()) if r0 <= p[0] <= r1 and z0 <= p[1] <= z1)
        touched = [q for p in near if (q := _touch(each, p, gap)) is not None]
        found += split_element(each, touched) if touched else [each]
    return found


def _touch(element: Element, point: Point, gap: float) -> Point | None:
    """Return where a point touches an element, or None if it touches only an end or nothing."""
    along = element.get_distance_from_start(point)
    if not gap < along < element.length - gap:
        return None
    at = element.get_point(along)
    return at if math.dist(at, point) <= gap else None


# --- Tracing one side


def trace_outer_side(group: ElementGroup, gap: float = DEFAULT_GAP_MM) -> list[Element]:
    """Return the elements of the outside, from the frontmost point to the end at the chuck.

    Raises DrawingError if the contour crosses itself or the axis, or if no element ends at its front.
    """
    walked = _walk(group, _foremost(group, gap), math.radians(270.0), 1.0, gap)
    return _checked(group, walked, gap)


def trace_inner_side(group: ElementGroup, gap: float = DEFAULT_GAP_MM) -> list[Element]:
    """Return the elements of a bore, from its mouth along its wall to its end.

    Raises DrawingError if the contour has no bore, or if it crosses itself or the axis.
    """
    inside = [
        n for n in _at_front(group, gap) if group.node_points[n][0] > gap and _leads_to_chuck(group, n, gap)
    ]
    if not inside:
        raise DrawingError(_NO_BORE, "no-bore")
    start = min(inside, key=lambda n: group.node_points[n][0])
    # the edge of the mouth, visible beyond the section plane, is not part of the wall
    front = _at_front(group, gap)
    mouth = {number for number, (a, b) in enumerate(group.element_end_nodes) if a in front and b in front}
    walked = _walk(group, start, math.radians(90.0), -1.0, gap, mouth)
    outer = _walk(group, _foremost(group, gap), math.radians(270.0), 1.0, gap)
    if walked and any(walked[0] == each for each in outer):
        raise DrawingError(_NO_BORE, "no-bore")
    return _checked(group, walked, gap)


def _foremost(group: ElementGroup, gap: float) -> int:
    """Return the node number of the frontmost element end that is nearest to the axis.

    Raises DrawingError if the foremost point is in the middle of an arc.
    """
    front = _at_front(group, gap)
    if not front:
        raise DrawingError(
            "the foremost point of the contour is in the middle of an arc. End the arc at this point.",
            "front-in-arc",
        )
    return min(front, key=lambda n: group.node_points[n][0])


def _at_front(net: ElementGroup, gap: float) -> set[int]:
    front = net.extent_mm[1] - gap
    return {n for pair in net.element_end_nodes for n in pair if net.node_points[n][1] >= front}


def _leads_to_chuck(group: ElementGroup, node: int, gap: float) -> bool:
    """Return whether an element leads from a node toward the chuck."""
    out = (
        _from(each, ends, node)
        for each, ends in zip(group.elements, group.element_end_nodes, strict=True)
        if node in ends
    )
    return any(each.end[1] < each.start[1] - gap for each in out)


def _from(each: Element, ends: tuple[int, int], node: int) -> Element:
    return each if ends[0] == node else each.make_reversed()


def _angle(element: Element) -> float:
    """Return the angle of an element's direction at its start, from Z+ toward r+."""
    ahead = element.get_point(min(_AHEAD, element.length / 2.0))
    return math.atan2(ahead[0] - element.start[0], ahead[1] - element.start[1])


def _walk(
    group: ElementGroup, start: int, back: float, hand: float, gap: float, without: Iterable[int] = ()
) -> list[Element]:
    """Return the elements along one side of the contour, starting at the node ``start``.

    At each node, the trace continues with the first element next to the empty side. At a dead end, the
    trace goes back.
    """
    at_node: dict[int, list[int]] = {}
    for number, ends in enumerate(group.element_end_nodes):
        for n in ends:
            at_node.setdefault(n, []).append(number)
    low = group.extent_mm[0]
    shut = set(without)
    path_steps: list[tuple[int, int]] = []  # elements, with the node to which each leads
    best: list[tuple[int, int]] = []
    node, seen = start, {start}
    while True:
        check_processor_time()
        step = _next(group, at_node[node], node, shut, path_steps, back, hand)
        if step is not None:
            shut.add(step)
            each = _from(group.elements[step], group.element_end_nodes[step], node)
            ends = group.element_end_nodes[step]
            node = ends[1] if ends[0] == node else ends[0]
            path_steps.append((step, node))
            back = _angle(each.make_reversed())
            place = group.node_points[node]
            if node in seen or place[0] <= gap or place[1] <= low + gap:
                return _elements(group, start, path_steps)
            seen.add(node)
            continue
        best = max(best, path_steps, key=lambda w: -group.node_points[w[-1][1]][1] if w else -math.inf)
        if not path_steps:
            return _elements(group, start, best)
        path_steps.pop()
        node = path_steps[-1][1] if path_steps else start


def _next(
    group: ElementGroup,
    there: Sequence[int],
    node: int,
    shut: set[int],
    path_steps: Sequence[tuple[int, int]],
    back: float,
    hand: float,
) -> int | None:
    """Return the number of the next element at a node, or None if no element continues there.

    This is the first element found when rotating in the direction ``hand`` from the incoming direction.
    """
    if path_steps:
        last = path_steps[-1][0]
        back = _angle(_from(group.elements[last], group.element_end_nodes[last], node))
    free = [n for n in there if n not in shut]

    def calculate_turn_angle(n: int) -> float:
        found = (hand * (_angle(_from(group.elements[n], group.element_end_nodes[n], node)) - back)) % (
            2.0 * math.pi
        )
        return found if found > 1e-6 else 2.0 * math.pi

    return min(free, key=calculate_turn_angle, default=None)


def _elements(net: ElementGroup, start: int, path_steps: Iterable[tuple[int, int]]) -> list[Element]:
    found, node = [], start
    for number, to in path_steps:
        found.append(_from(net.elements[number], net.element_end_nodes[number], node))
        node = to
    return found


def _checked(net: ElementGroup, walked: list[Element], gap: float) -> list[Element]:
    if not walked:
        raise DrawingError("this side has no contour. Choose another contour.", "no-contour")
    _no_crossing(walked)
    for end in (walked[0].start, walked[-1].end):
        if end[0] <= gap and any(abs(z - end[1]) <= gap for z in net.axis_crossings_z):
            distance_mm = net.extent_mm[1] - end[1]
            raise DrawingError(
                Message(
                    "the contour crosses the axis {distance} mm from the face. Choose another axis.",
                    distance=f"{distance_mm:.3f}",
                ),
                "crosses-axis",
            )
    return walked


def _no_crossing(walked: Sequence[Element]) -> None:
    found = ((pair, point) for pair in _overlapping(walked) for point in _crossing(walked, *pair))
    first = min(found, key=lambda crossing: crossing[0], default=None)
    if first is not None:
        _, point = first
        distance_mm = walked[0].start[1] - point[1]
        raise DrawingError(
            Message(
                "the contour crosses itself {distance} mm from the face at a diameter of "
                "{diameter} mm. Correct the contour at this point.",
                distance=f"{distance_mm:.3f}",
                diameter=f"{2 * point[0]:.3f}",
            ),
            "crosses-itself",
        )


def _overlapping(walked: Sequence[Element]) -> Iterator[tuple[int, int]]:
    """Yield each pair of element numbers with overlapping bounding boxes, the smaller number first.

    The elements are compared in a sweep along Z.
    """
    boxes = [each.bounding_box for each in walked]
    order = sorted(range(len(walked)), key=lambda n: boxes[n][2])
    lows = [boxes[n][2] for n in order]
    for at, i in enumerate(order):
        check_processor_time()
        inner, outer, _, high = boxes[i]
        for k in order[at + 1 : bisect_right(lows, high)]:
            if inner <= boxes[k][1] and boxes[k][0] <= outer:
                yield min(i, k), max(i, k)


def _crossing(walked: Sequence[Element], i: int, k: int) -> Iterator[Point]:
    """Yield the points at which two elements cross, except at their ends."""
    shared = (walked[i].start, walked[i].end, walked[k].start, walked[k].end)
    for point in find_intersections(walked[i], walked[k]):
        if min(math.dist(point, end) for end in shared) > 1e-3:
            yield point


def mirror_elements(elements: Iterable[Element]) -> Iterator[Element]:
    """Yield the elements mirrored about the spindle axis."""
    for each in elements:
        if isinstance(each, Arc):
            a, b, c = ((-p[0], p[1]) for p in (each.start, each.end, each.center))
            yield Arc(a, b, c, not each.clockwise)
        else:
            yield Line((-each.start[0], each.start[1]), (-each.end[0], each.end[1]))
