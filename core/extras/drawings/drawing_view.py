"""Placement of a drawing on the lathe: axis, face end and Z zero."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple

from core.extras.drawings.contour_walk import GAP, Net, inner_side, nets, outer_side, turned_about
from core.extras.drawings.drawing import Drawing, DrawingError, Drawn
from core.geometry.lines_and_arcs import Arc, Element, Line, Point
from core.message import Message

_SAME = 0.01  # units; center lines nearer than this are treated as one
_SQUARE = 1e-3  # rad
_MEETS = 1e-3  # fraction of the drawing's width within which ends meet


class Front(StrEnum):
    """End of the drawn axis at which the face is."""

    RIGHT = "RIGHT"
    LEFT = "LEFT"


class Zero(StrEnum):
    """Position of Z zero."""

    FACE = "FACE"
    BACK = "BACK"
    ORIGIN = "ORIGIN"


class Side(StrEnum):
    """Side of the material that is the contour."""

    OUTSIDE = "OUTSIDE"
    INSIDE = "BORE"


class Axis(NamedTuple):
    """An axis in the drawing: its name, one point and the direction, as (y, x)."""

    name: str
    at: Point
    way: Point


@dataclass(frozen=True, slots=True)
class View:
    """Placement of a drawing on the lathe.

    ``unit`` is mm per drawing unit, ``shift`` the Z of the point named by ``zero`` in mm, and ``gap`` the
    widest gap between ends that are joined, in mm.
    """

    axis: Axis
    unit: float
    front: Front = Front.RIGHT
    zero: Zero = Zero.FACE
    shift: float = 0.0
    gap: float = GAP


# --- Axis


def axes(drawing: Drawing, layer: str = "") -> list[Axis]:
    """Return the lines that may be the axis, the most likely first."""
    there = _contour_lines(drawing, layer)
    if not there:
        return []
    boxes = [each.element.box for each in there]
    low, high = min(b[0] for b in boxes), max(b[1] for b in boxes)
    left, right = min(b[2] for b in boxes), max(b[3] for b in boxes)
    found = _centre_lines(drawing)
    near = 1e-3 * max(high - low, right - left, 1e-9)
    flat, lowest = Axis("Y 0", (0.0, 0.0), (0.0, 1.0)), _lowest(there, low + near, right - left)
    tall = boxes if len(there) == len(drawing.drawn) else [each.element.box for each in drawing.drawn]
    if min(b[0] for b in tall) <= near and max(b[1] for b in tall) >= -near:
        found.append(flat)
    if lowest is not None:
        found.append(Axis("LOWEST LINE", (lowest, 0.0), (0.0, 1.0)))
    others = (
        flat,
        Axis("MIDDLE", ((low + high) / 2.0, 0.0), (0.0, 1.0)),
        Axis("X 0", (0.0, 0.0), (1.0, 0.0)),
    )
    return found + [each for each in others if each not in found]


def _contour_lines(drawing: Drawing, layer: str) -> list[Drawn]:
    """Return the elements on a layer without the center lines; all of them if there are no others."""
    there = drawing.on(layer)
    return [each for each in there if not each.centre] or list(there)


def _centre_lines(drawing: Drawing) -> list[Axis]:
    """Return the center lines by line type or layer, the longest first and horizontal before vertical."""
    lines = [each.element for each in drawing.drawn if each.centre and isinstance(each.element, Line)]
    lines.sort(key=lambda line: (abs(line.start_direction[0]) > 0.5, -line.length))
    found: list[Axis] = []
    for each in lines:
        axis = _axis(Message("CENTRE LINE {found_count}", found_count=len(found) + 1), each)
        if not any(_same(axis, other) for other in found):
            found.append(axis)
    return found[:9]


def _axis(name: str, line: Line) -> Axis:
    """Return a line as an axis, pointing to the right or upward."""
    dy, dx = line.start_direction
    turn = -1.0 if dx < -_SQUARE or (abs(dx) <= _SQUARE and dy < 0.0) else 1.0
    return Axis(name, line.start, (turn * dy, turn * dx))


def _same(a: Axis, b: Axis) -> bool:
    cross = a.way[0] * b.way[1] - a.way[1] * b.way[0]
    off = (b.at[0] - a.at[0]) * a.way[1] - (b.at[1] - a.at[1]) * a.way[0]
    return abs(cross) < _SQUARE and abs(off) < _SAME


def _lowest(there: Sequence[Drawn], low: float, wide: float) -> float | None:
    """Return y of the lowest line if it closes most of the drawing and other lines meet both its ends."""
    for each in there:
        e = each.element
        if isinstance(e, Line) and max(e.start[0], e.end[0]) <= low and abs(e.end[1] - e.start[1]) > wide / 2:
            others = [o.element for o in there if o.element is not e]
            if all(_met(end, others, wide) for end in (e.start, e.end)):
                return (e.start[0] + e.end[0]) / 2.0
    return None


def _met(end: Point, others: Iterable[Element], wide: float) -> bool:
    return any(math.dist(end, p) <= _MEETS * wide for each in others for p in (each.start, each.end))


def line_axis(drawing: Drawing, number: int) -> Axis:
    """Return the line with this number, counted from 1, as an axis. Raises DrawingError."""
    if not 1 <= number <= len(drawing.drawn):
        raise DrawingError(
            Message(
                "{drawing} has {drawn_count} lines, but line {number} does not exist: choose "
                "an existing line.",
                drawing=drawing.name,
                drawn_count=len(drawing.drawn),
                number=number,
            ),
            "no-line",
        )
    each = drawing.drawn[number - 1].element
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


def axis_named(drawing: Drawing, name: str, layer: str = "") -> Axis:
    """Return the axis of this name, or the most likely axis if the name is empty.

    Raises DrawingError with the available axes if the name is unknown.
    """
    known = axes(drawing, layer)
    if not name and known:
        return known[0]
    if name.startswith("LINE ") and name[5:].isdigit():
        return line_axis(drawing, int(name[5:]))
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


def on_lathe(elements: Iterable[Element], view: View) -> Iterator[Element]:
    """Yield the elements of the drawing as (r, z) in mm.

    Z is measured from the drawing origin, projected onto the axis.
    """
    turn = 1.0 if view.front is Front.RIGHT else -1.0

    def placed(p: Point) -> Point:
        (dy, dx), y, x = view.axis.way, p[0] - view.axis.at[0], p[1] - view.axis.at[1]
        along = p[0] * dy + p[1] * dx
        return (y * dx - x * dy) * view.unit, along * turn * view.unit

    for each in elements:
        if isinstance(each, Arc):
            clockwise = each.clockwise if turn > 0.0 else not each.clockwise
            yield Arc(placed(each.start), placed(each.end), placed(each.centre), clockwise)
        else:
            yield Line(placed(each.start), placed(each.end))


def contours(drawing: Drawing, view: View, layer: str = "") -> list[Net]:
    """Return the groups of connected elements on the side of the axis where the part is drawn.

    Z is as in ``on_lathe``. Raises DrawingError if the work limit is exceeded.
    """
    there = _contour_lines(drawing, layer)
    placed = list(on_lathe((each.element for each in there), view))
    try:
        above, below = (
            nets(placed, view.gap),
            nets(turned_about(each for each in placed if each.box[0] < 0.0), view.gap),
        )
    except DrawingError as error:
        raise DrawingError(
            Message("{drawing}: {error}", drawing=drawing.name, error=error), error.code
        ) from None
    on_axis = [bool(found) and _touches(found[0], view.gap) for found in (above, below)]
    return below if below and (not above or (on_axis[1] and not on_axis[0])) else above


def _touches(net: Net, gap: float) -> bool:
    return any(net.nodes[n][0] <= gap for pair in net.ends for n in pair)


@dataclass(frozen=True, slots=True)
class Profile:
    """One side of the contour from the face to the chuck, as (r, z) in mm.

    ``closed`` is the widest gap that was closed. ``front`` and ``back`` are the ends of the part along Z.
    """

    elements: tuple[Element, ...]
    side: Side
    front: float
    back: float
    closed: float = 0.0


def profile(drawing: Drawing, view: View, net: Net, side: Side = Side.OUTSIDE) -> Profile:
    """Return the chosen side of a contour with Z zero as in the view. Raises DrawingError."""
    try:
        walked = inner_side(net, view.gap) if side is Side.INSIDE else outer_side(net, view.gap)
    except DrawingError as error:
        raise DrawingError(
            Message("{drawing}: {error}", drawing=drawing.name, error=error), error.code
        ) from None
    low, high, _ = net.reach
    zero = {Zero.FACE: high, Zero.BACK: low, Zero.ORIGIN: 0.0}[view.zero] - view.shift
    moved = tuple(_along(each, -zero) for each in walked)
    return Profile(moved, side, high - zero, low - zero, net.closed)


def _along(each: Element, far: float) -> Element:
    """Return the element moved along Z by ``far`` mm."""
    points = [(p[0], p[1] + far) for p in (each.start, each.end)]
    if isinstance(each, Arc):
        return Arc(points[0], points[1], (each.centre[0], each.centre[1] + far), each.clockwise)
    return Line(points[0], points[1])
