"""Placement of a drawing on the lathe: its axis, its face end and its Z zero."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from core.extras.drawings.contour_tracing import (
    DEFAULT_GAP_MM,
    ElementGroup,
    find_element_groups,
    mirror_elements,
    trace_inner_side,
    trace_outer_side,
)
from core.extras.drawings.drawing import Drawing, DrawingError, DrawnElement
from core.geometry.lines_and_arcs import Arc, Element, Line, Point
from core.message import Message

_SAME = 0.01  # units; center lines nearer than this are treated as one
_SQUARE = 1e-3  # rad
_MEETS = 1e-3  # fraction of the drawing's width within which ends meet


class FaceEnd(StrEnum):
    """End of the drawn axis at which the face of the part is located."""

    RIGHT = "RIGHT"
    LEFT = "LEFT"


class ZeroPosition(StrEnum):
    """Point of the drawn part that is the Z zero."""

    FACE = "FACE"
    BACK = "BACK"
    ORIGIN = "ORIGIN"


class ContourSide(StrEnum):
    """Side of the part, outside or inside, whose contour is extracted."""

    OUTSIDE = "OUTSIDE"
    INSIDE = "BORE"


class DrawingAxis(NamedTuple):
    """Line that may be the spindle axis of a drawing; the drawing need not contain this line.

    It contains a name, a point and a direction. The point and the direction are (y, x).
    """

    name: str
    point: Point
    direction: Point


PROFILE_ENDS = "PROFILE ENDS"
_MOST_END_POINTS = 400  # of a profile whose free ends are searched in less than 0.1 s


@dataclass(frozen=True, slots=True)
class DrawingPlacement:
    """Placement of a drawing on the lathe.

    ``unit`` is the size of a drawing unit in mm. ``shift`` is the Z, in mm, of the point selected by
    ``zero``. Element ends up to ``gap`` mm apart are joined.
    """

    axis: DrawingAxis
    unit: float
    front: FaceEnd = FaceEnd.RIGHT
    zero: ZeroPosition = ZeroPosition.FACE
    shift: float = 0.0
    gap: float = DEFAULT_GAP_MM


# --- Axis


def find_axes(drawing: Drawing, layer: str = "") -> list[DrawingAxis]:
    """Return the lines that could be the spindle axis, with the most likely first.

    They include lines that the file does not contain, such as Y 0 and the middle of the drawing.
    """
    there = _contour_lines(drawing, layer)
    if not there:
        return []
    boxes = [each.element.bounding_box for each in there]
    low, high = min(b[0] for b in boxes), max(b[1] for b in boxes)
    left, right = min(b[2] for b in boxes), max(b[3] for b in boxes)
    found = _centre_lines(drawing)
    near = 1e-3 * max(high - low, right - left, 1e-9)
    flat, lowest = DrawingAxis("Y 0", (0.0, 0.0), (0.0, 1.0)), _lowest(there, low + near, right - left)
    tall = (
        boxes
        if len(there) == len(drawing.elements)
        else [each.element.bounding_box for each in drawing.elements]
    )
    if min(b[0] for b in tall) <= near and max(b[1] for b in tall) >= -near:
        found.append(flat)
    if lowest is not None:
        found.append(DrawingAxis("LOWEST LINE", (lowest, 0.0), (0.0, 1.0)))
    ends = _find_axis_of_ends(there, near)
    if ends is not None and not any(_same(ends, each) for each in (*found, flat)):
        found = [*found, *([] if found else [flat]), ends]
    others = (
        flat,
        DrawingAxis("MIDDLE", ((low + high) / 2.0, 0.0), (0.0, 1.0)),
        DrawingAxis("X 0", (0.0, 0.0), (1.0, 0.0)),
    )
    return found + [each for each in others if each not in found]


def require_clear_axis(drawing: Drawing, layer: str = "") -> None:
    """Raise DrawingError if nothing in the drawing shows which of two axes is the spindle axis.

    This applies to a half profile without a center line whose two ends have the same distance from Y 0. The
    profile may end on the spindle axis, or the spindle axis may be Y 0.
    """
    known = find_axes(drawing, layer)
    if len(known) < 2 or (known[0].name, known[1].name) != ("Y 0", PROFILE_ENDS):
        return
    raise DrawingError(
        Message(
            "{drawing} has no center line, and both ends of the profile are at the same distance from Y 0: "
            "choose the axis {ends} if the profile ends on the spindle axis, or else Y 0.",
            drawing=drawing.name,
            ends=PROFILE_ENDS,
        ),
        "which-axis",
    )


def _find_axis_of_ends(there: Sequence[DrawnElement], near: float) -> DrawingAxis | None:
    """Return the horizontal line through both ends of an open profile, if the profile is on one side of it.

    Return None if the drawing does not have exactly two free ends.
    """
    points = [point for each in there for point in (each.element.start, each.element.end)]
    if len(points) > _MOST_END_POINTS:
        return None
    free = [
        point for n, point in enumerate(points)
        if not any(math.dist(point, other) <= near for k, other in enumerate(points) if k != n)
    ]  # fmt: skip
    if len(free) != 2:
        return None
    (y, x), (other_y, other_x) = free
    boxes = [each.element.bounding_box for each in there]
    is_on_one_side = min(b[0] for b in boxes) >= y - near or max(b[1] for b in boxes) <= y + near
    if abs(y - other_y) > near or abs(x - other_x) <= near or not is_on_one_side:
        return None
    return DrawingAxis(PROFILE_ENDS, (y, 0.0), (0.0, 1.0))


def _contour_lines(drawing: Drawing, layer: str) -> list[DrawnElement]:
    """Return the elements on a layer without the center lines, or all elements if only center lines exist."""
    there = drawing.select_layer(layer)
    return [each for each in there if not each.is_center_line] or list(there)


def _centre_lines(drawing: Drawing) -> list[DrawingAxis]:
    """Return the center lines, identified by line type or layer.

    Horizontal lines come first, then vertical lines; in each group longer lines come first.
    """
    lines = [
        each.element for each in drawing.elements if each.is_center_line and isinstance(each.element, Line)
    ]
    lines.sort(key=lambda line: (abs(line.start_direction[0]) > 0.5, -line.length))
    found: list[DrawingAxis] = []
    for each in lines:
        axis = _axis(Message("CENTRE LINE {found_count}", found_count=len(found) + 1), each)
        if not any(_same(axis, other) for other in found):
            found.append(axis)
    return found[:9]


def _axis(name: str, line: Line) -> DrawingAxis:
    """Return a line as an axis, pointing to the right or upward."""
    dy, dx = line.start_direction
    turn = -1.0 if dx < -_SQUARE or (abs(dx) <= _SQUARE and dy < 0.0) else 1.0
    return DrawingAxis(name, line.start, (turn * dy, turn * dx))


def _same(a: DrawingAxis, b: DrawingAxis) -> bool:
    cross = a.direction[0] * b.direction[1] - a.direction[1] * b.direction[0]
    off = (b.point[0] - a.point[0]) * a.direction[1] - (b.point[1] - a.point[1]) * a.direction[0]
    return abs(cross) < _SQUARE and abs(off) < _SAME


def _lowest(there: Sequence[DrawnElement], low: float, width: float) -> float | None:
    """Return the y of the lowest line if it could be the spindle axis, otherwise None.

    The line must close most of the drawing, and other lines must meet both its ends.
    """
    for each in there:
        e = each.element
        if (
            isinstance(e, Line)
            and max(e.start[0], e.end[0]) <= low
            and abs(e.end[1] - e.start[1]) > width / 2
        ):
            others = [o.element for o in there if o.element is not e]
            if all(_met(end, others, width) for end in (e.start, e.end)):
                return (e.start[0] + e.end[0]) / 2.0
    return None


def _met(end: Point, others: Iterable[Element], wide: float) -> bool:
    return any(math.dist(end, p) <= _MEETS * wide for each in others for p in (each.start, each.end))


def make_axis_from_line(drawing: Drawing, number: int) -> DrawingAxis:
    """Return line ``number`` of the drawing, counted from 1, as the spindle axis.

    Raises DrawingError if the line does not exist or is an arc.
    """
    if not 1 <= number <= len(drawing.elements):
        raise DrawingError(
            Message(
                "{drawing} has {drawn_count} lines, but line {number} does not exist: choose "
                "an existing line.",
                drawing=drawing.name,
                drawn_count=len(drawing.elements),
                number=number,
            ),
            "no-line",
        )
    each = drawing.elements[number - 1].element
    if not isinstance(each, Line):
        raise DrawingError(
            Message(
                "{drawing}: line {number} is an arc. Choose a straight line as the axis.",
                drawing=drawing.name,
                number=number,
            ),
            "axis-is-arc",
        )
    return _axis(Message("LINE {line}", line=number), each)


def select_axis(drawing: Drawing, name: str, layer: str = "") -> DrawingAxis:
    """Return the axis with this name, or the most likely axis if the name is empty.

    Raises DrawingError with the available axes if the name is unknown.
    """
    known = find_axes(drawing, layer)
    if not name and known:
        return known[0]
    if name.startswith("LINE ") and name[5:].isdecimal():
        return make_axis_from_line(drawing, int(name[5:]))
    found = next((axis for axis in known if axis.name == name), None)
    if found is None:
        there = ", ".join(axis.name for axis in known) or "none"
        raise DrawingError(
            Message(
                "{drawing} has no axis {name}: choose {present}, or LINE and a line number.",
                drawing=drawing.name,
                name=name,
                present=there,
            ),
            "no-axis",
        )
    return found


# --- Placement on the lathe


def place_elements(elements: Iterable[Element], placement: DrawingPlacement) -> Iterator[Element]:
    """Yield the elements of the drawing in lathe coordinates (r, z), in mm.

    Z is measured from the drawing origin, projected onto the axis.
    """
    turn = 1.0 if placement.front is FaceEnd.RIGHT else -1.0

    def place_point(p: Point) -> Point:
        (dy, dx), y, x = (
            placement.axis.direction,
            p[0] - placement.axis.point[0],
            p[1] - placement.axis.point[1],
        )
        along = p[0] * dy + p[1] * dx
        return (y * dx - x * dy) * placement.unit, along * turn * placement.unit

    for each in elements:
        if isinstance(each, Arc):
            clockwise = each.clockwise if turn > 0.0 else not each.clockwise
            yield Arc(place_point(each.start), place_point(each.end), place_point(each.center), clockwise)
        else:
            yield Line(place_point(each.start), place_point(each.end))


def find_contours(drawing: Drawing, placement: DrawingPlacement, layer: str = "") -> list[ElementGroup]:
    """Return the groups of connected elements on the side of the axis where the part is drawn.

    Z is measured from the drawing origin, as in ``place_elements``. Raises DrawingError if the work limit
    is exceeded.
    """
    there = _contour_lines(drawing, layer)
    placed = list(place_elements((each.element for each in there), placement))
    try:
        above, below = (
            find_element_groups(placed, placement.gap),
            find_element_groups(
                mirror_elements(each for each in placed if each.bounding_box[0] < 0.0), placement.gap
            ),
        )
    except DrawingError as error:
        raise DrawingError(
            Message("{drawing}: {error}", drawing=drawing.name, error=error), error.code
        ) from None
    on_axis = [bool(found) and _touches(found[0], placement.gap) for found in (above, below)]
    return below if below and (not above or (on_axis[1] and not on_axis[0])) else above


def _touches(net: ElementGroup, gap: float) -> bool:
    return any(net.node_points[n][0] <= gap for pair in net.element_end_nodes for n in pair)


@dataclass(frozen=True, slots=True)
class ContourProfile:
    """One side of the part contour, from the face to the chuck, as (r, z) in mm.

    ``widest_closed_gap_mm`` is the widest gap that was closed. ``front_z_mm`` and ``back_z_mm`` are the
    ends of the part along Z.
    """

    elements: tuple[Element, ...]
    side: ContourSide
    front_z_mm: float
    back_z_mm: float
    widest_closed_gap_mm: float = 0.0


def extract_profile(
    drawing: Drawing,
    placement: DrawingPlacement,
    group: ElementGroup,
    side: ContourSide = ContourSide.OUTSIDE,
) -> ContourProfile:
    """Return one side of a contour, relative to the selected Z zero.

    Raises DrawingError if the contour cannot be traced.
    """
    try:
        walked = (
            trace_inner_side(group, placement.gap)
            if side is ContourSide.INSIDE
            else trace_outer_side(group, placement.gap)
        )
    except DrawingError as error:
        raise DrawingError(
            Message("{drawing}: {error}", drawing=drawing.name, error=error), error.code
        ) from None
    low, high, _ = group.extent_mm
    zero = {ZeroPosition.FACE: high, ZeroPosition.BACK: low, ZeroPosition.ORIGIN: 0.0}[
        placement.zero
    ] - placement.shift
    moved = tuple(_move_element(each, -zero) for each in walked)
    return ContourProfile(moved, side, high - zero, low - zero, group.widest_closed_gap_mm)


def _move_element(element: Element, distance: float) -> Element:
    """Return the element moved along Z by ``distance`` mm."""
    points = [(p[0], p[1] + distance) for p in (element.start, element.end)]
    if isinstance(element, Arc):
        return Arc(points[0], points[1], (element.center[0], element.center[1] + distance), element.clockwise)
    return Line(points[0], points[1])
