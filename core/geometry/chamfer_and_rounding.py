"""Chamfers and roundings of the corner between two elements of a contour.

Between two lines, the corner is a chamfer or a tangent fillet. The leg of a chamfer is straight, even along
an arc, where it is a chord (as in Beckhoff's G301). A rounding may be between lines and arcs.
"""

from __future__ import annotations

from math import asin, cos, dist, pi, sin, tan

from core.geometry.contour_offset import GougeError, offset_element
from core.geometry.lines_and_arcs import SAME_POINT, Arc, Element, Line, left_of, meetings, turn
from core.message import CodedError, Message

# Lines that turn by less than this angle (rad) have the same or the opposite direction. The corner point
# would be inaccurate by more than any machine can move.
STRAIGHT = 1e-6


class CornerError(CodedError):
    """Raised when the corner between two moves is not possible. ``str()`` gives the reason as a clause."""


class NoCornerError(CornerError):
    """Raised when the two moves have the same direction."""


class CornerTooLargeError(CornerError):
    """Raised when the corner needs more of a move than its length.

    ``needed`` is the required length in mm. ``first`` is True if the first of the two moves is too short.
    """

    def __init__(self, needed: float, *, first: bool) -> None:
        super().__init__(
            "the current line is too short" if first else "the next line is too short", "line-too-short"
        )
        self.needed = needed
        self.first = first


def chamfer(before: Element, after: Element, leg: float) -> tuple[Element, Line, Element]:
    """Return both elements shortened by ``leg`` mm at their corner, with the chamfer between them.

    Raises NoCornerError, CornerTooLargeError, or CornerError if the second element reverses the direction of
    the first or the chamfer would cross one of them.
    """
    angle = _turned(before, after)
    first, last = _shortened(before, after, leg)
    between = Line(first.end, last.start)
    out = first.end_direction if first.length > SAME_POINT else before.start_direction
    into = last.start_direction if last.length > SAME_POINT else after.end_direction
    cut = between.start_direction
    if turn(out, cut) * angle <= 0.0 or turn(cut, into) * angle <= 0.0:
        raise CornerError("the chamfer would cross one of the two moves", "crosses")
    return first, between, last


def _turned(before: Element, after: Element) -> float:
    """Return the angle in radians by which the direction changes between the elements."""
    for element in (before, after):
        if element.length < SAME_POINT:
            raise CornerTooLargeError(0.0, first=element is before)
    angle = turn(before.end_direction, after.start_direction)
    if abs(angle) < STRAIGHT:
        raise NoCornerError("the two moves have the same direction", "no-corner")
    if abs(angle) > pi - STRAIGHT:
        lines = isinstance(before, Line) and isinstance(after, Line)
        raise CornerError(
            "the next line goes straight back along the previous line"
            if lines
            else ("the next move reverses the direction of the previous move"),
            "straight-back",
        )
    return angle


def _shortened(before: Element, after: Element, leg: float) -> tuple[Element, Element]:
    """Return both elements, each shortened by a chord of ``leg`` mm at their corner."""
    end, start = before.length - _taken(before, leg, first=True), _taken(after, leg, first=False)
    return before.part(before.start, before.point(max(end, 0.0))), after.part(after.point(start), after.end)


def _taken(element: Element, leg: float, *, first: bool) -> float:
    """Return the length in mm that the leg removes from an element."""
    if isinstance(element, Arc) and leg > 2.0 * element.radius:
        raise CornerTooLargeError(leg, first=first)
    way = _way(element, leg)
    # A part of an arc must remain, because an arc with equal ends would be a full circle.
    if way > element.length - _left(element):
        raise CornerTooLargeError(way, first=first)
    return min(way, element.length)


def _way(element: Element, leg: float) -> float:
    if isinstance(element, Line):
        return leg
    return 2.0 * element.radius * asin(min(1.0, leg / (2.0 * element.radius)))


def _left(element: Element) -> float:
    """Return the length in mm that must remain of an element.

    An arc with equal ends would be a full circle.
    """
    return SAME_POINT if isinstance(element, Arc) else -SAME_POINT


def rounding(before: Element, after: Element, radius: float) -> tuple[Element, Arc, Element]:
    """Return both elements shortened to the tangent points of an arc of ``radius`` mm, with the arc.

    Between two lines, each line is shortened by radius·tan(turn/2). Otherwise the center of the arc is the
    intersection of both elements offset by ``radius``. Raises the errors of ``chamfer``, and CornerError if
    no arc is tangent to both within their length.
    """
    if isinstance(before, Line) and isinstance(after, Line):
        return _fillet(before, after, radius)
    angle = turn(before.end_direction, after.start_direction)
    if abs(angle) < STRAIGHT:
        raise NoCornerError("the two moves have the same direction", "no-corner")
    side = radius if angle > 0 else -radius
    try:
        aside = offset_element(before, side), offset_element(after, side)
    except GougeError as problem:
        raise CornerError(
            Message("the arc does not fit one of the two moves: {problem}", problem=problem), "no-arc"
        ) from None
    touched = [(before.along(centre), after.along(centre), centre) for centre in meetings(*aside)]
    fitting = [
        (before.length - end + start, end, start, centre)
        for end, start, centre in touched
        if _left(before) <= end <= before.length + SAME_POINT
        and -SAME_POINT <= start <= after.length - _left(after)
    ]
    if not fitting:
        raise CornerError(
            "no arc of this radius is tangent to both moves within their length", "no-touching-arc"
        )
    _, end, start, centre = min(fitting)
    first = before.part(before.start, before.point(end))
    last = after.part(after.point(start), after.end)
    return first, Arc(first.end, last.start, centre, clockwise=angle < 0), last


def _fillet(before: Line, after: Line, radius: float) -> tuple[Element, Arc, Element]:
    angle = _turned(before, after)
    first, last = _shortened(before, after, radius * tan(abs(angle) / 2))
    side = radius if angle > 0 else -radius
    left = left_of(before.end_direction)
    centre = first.end[0] + left[0] * side, first.end[1] + left[1] * side
    return first, Arc(first.end, last.start, centre, clockwise=angle < 0), last


# --- chamfers given by their own length --------------------------------------------------------------------


_STEPS = 256  # steps of the search for the first leg that is long enough
_HALVINGS = 60


def leg_of(before: Element, after: Element, length: float) -> float:
    """Return the leg of a chamfer that is itself ``length`` mm long. Raises the errors of ``chamfer``."""
    if isinstance(before, Line) and isinstance(after, Line):
        # The chamfer and its two legs are an isosceles triangle.
        return length / (2.0 * max(abs(cos(turn(before.end_direction, after.start_direction) / 2)), 1e-9))
    _turned(before, after)
    most = min(_longest(before), _longest(after))
    for step in range(1, _STEPS + 1):
        if _width(before, after, most * step / _STEPS) >= length:
            return _found(before, after, length, most * (step - 1) / _STEPS, most * step / _STEPS)
    raise CornerError("the two moves are too short for a chamfer of this length", "too-short")


def _found(before: Element, after: Element, length: float, short: float, long: float) -> float:
    for _ in range(_HALVINGS):
        middle = (short + long) / 2
        short, long = (middle, long) if _width(before, after, middle) < length else (short, middle)
    return long


def _width(before: Element, after: Element, leg: float) -> float:
    """Return the length of the chamfer with this leg."""
    one = before.point(before.length - _way(before, leg))
    return dist(one, after.point(_way(after, leg)))


def _longest(element: Element) -> float:
    """Return the longest leg that ends on the element."""
    if isinstance(element, Line):
        return element.length
    return 2.0 * element.radius * sin(min(abs(element.sweep), pi) / 2.0)
