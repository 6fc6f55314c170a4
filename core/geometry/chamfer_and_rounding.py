"""Chamfers and roundings of the corner between two elements of a contour.

Between two lines, the corner is a chamfer or a tangent fillet. The leg of a chamfer is the straight
distance from the corner; along an arc it is a chord (as in Beckhoff's G301). A rounding may be between
lines and arcs.
"""

from __future__ import annotations

from math import asin, cos, dist, pi, sin, tan

from core.geometry.contour_offset import GougeError, offset_element
from core.geometry.lines_and_arcs import (
    SAME_POINT_TOLERANCE_MM,
    Arc,
    Element,
    Line,
    compute_turn_angle,
    find_extended_intersections,
    get_left_normal,
)
from core.message import CodedError, Message

# Lines that turn by less than this angle (rad) have the same or the opposite direction. The corner point
# would be inaccurate by more than any machine can move.
STRAIGHT_TOLERANCE_RAD = 1e-6


class CornerError(CodedError):
    """An error raised if a chamfer or rounding between two moves is impossible.

    ``str()`` returns the reason as a clause.
    """


class SameDirectionError(CornerError):
    """An error raised if two moves have the same direction and therefore form no corner."""


class CornerTooLargeError(CornerError):
    """An error raised if a chamfer or rounding is too large for one of the two moves.

    ``needed_length`` is the length in mm that the move would need. ``is_first_move`` is True if the first
    of the two moves is too short.
    """

    def __init__(self, needed_length: float, *, is_first_move: bool) -> None:
        super().__init__(
            "the current line is too short" if is_first_move else "the next line is too short",
            "line-too-short",
        )
        self.needed_length = needed_length
        self.is_first_move = is_first_move


def chamfer(first_element: Element, second_element: Element, leg: float) -> tuple[Element, Line, Element]:
    """Return both elements shortened by ``leg`` mm at their corner, with the chamfer between them.

    Raises SameDirectionError, CornerTooLargeError or CornerError. CornerError is raised if the second element
    reverses the direction of the first, or if the chamfer would cross an element.
    """
    angle = _turn_between(first_element, second_element)
    first, last = _shorten(first_element, second_element, leg)
    between = Line(first.end, last.start)
    out = first.end_direction if first.length > SAME_POINT_TOLERANCE_MM else first_element.start_direction
    into = last.start_direction if last.length > SAME_POINT_TOLERANCE_MM else second_element.end_direction
    cut = between.start_direction
    if compute_turn_angle(out, cut) * angle <= 0.0 or compute_turn_angle(cut, into) * angle <= 0.0:
        raise CornerError("the chamfer would cross one of the two moves", "crosses")
    return first, between, last


def _turn_between(before: Element, after: Element) -> float:
    """Return the angle in radians by which the direction changes from one element to the next."""
    for element in (before, after):
        if element.length < SAME_POINT_TOLERANCE_MM:
            raise CornerTooLargeError(0.0, is_first_move=element is before)
    angle = compute_turn_angle(before.end_direction, after.start_direction)
    if abs(angle) < STRAIGHT_TOLERANCE_RAD:
        raise SameDirectionError("the two moves have the same direction", "no-corner")
    if abs(angle) > pi - STRAIGHT_TOLERANCE_RAD:
        lines = isinstance(before, Line) and isinstance(after, Line)
        raise CornerError(
            "the next line goes straight back along the previous line"
            if lines
            else ("the next move reverses the direction of the previous move"),
            "straight-back",
        )
    return angle


def _shorten(before: Element, after: Element, leg: float) -> tuple[Element, Element]:
    """Return both elements, each shortened by a chord of ``leg`` mm at their corner."""
    end, start = (
        before.length - _removed_length(before, leg, is_first=True),
        _removed_length(after, leg, is_first=False),
    )
    return before.cut_section(before.start, before.get_point(max(end, 0.0))), after.cut_section(
        after.get_point(start), after.end
    )


def _removed_length(element: Element, leg: float, *, is_first: bool) -> float:
    """Return the length in mm by which a chamfer leg shortens an element."""
    if isinstance(element, Arc) and leg > 2.0 * element.radius:
        raise CornerTooLargeError(leg, is_first_move=is_first)
    removed_length_mm = _way(element, leg)
    # A part of an arc must remain, because an arc with equal ends would be a full circle.
    if removed_length_mm > element.length - _required_length(element):
        raise CornerTooLargeError(removed_length_mm, is_first_move=is_first)
    return min(removed_length_mm, element.length)


def _way(element: Element, leg: float) -> float:
    if isinstance(element, Line):
        return leg
    return 2.0 * element.radius * asin(min(1.0, leg / (2.0 * element.radius)))


def _required_length(element: Element) -> float:
    """Return the minimum length in mm that an element must have left after a chamfer.

    An arc must have a section left, because an arc with equal ends would be a full circle.
    """
    return SAME_POINT_TOLERANCE_MM if isinstance(element, Arc) else -SAME_POINT_TOLERANCE_MM


def make_rounding(
    first_element: Element, second_element: Element, radius: float
) -> tuple[Element, Arc, Element]:
    """Return both elements shortened to the tangent points of an arc, with the arc between them.

    The radius of the arc is ``radius`` mm.
    - Between two lines, each line is shortened by radius·tan(turn/2). Raises CornerTooLargeError if a line
      is too short, and CornerError if the second line reverses the direction of the first.
    - With an arc, the center is the intersection of both elements, each offset by ``radius``. Raises
      CornerError if no arc is tangent to both elements within their lengths.

    Raises SameDirectionError if the elements have the same direction.
    """
    if isinstance(first_element, Line) and isinstance(second_element, Line):
        return _fillet(first_element, second_element, radius)
    angle = compute_turn_angle(first_element.end_direction, second_element.start_direction)
    if abs(angle) < STRAIGHT_TOLERANCE_RAD:
        raise SameDirectionError("the two moves have the same direction", "no-corner")
    side = radius if angle > 0 else -radius
    try:
        aside = offset_element(first_element, side), offset_element(second_element, side)
    except GougeError as problem:
        raise CornerError(
            Message("the arc does not fit one of the two moves: {problem}", problem=problem), "no-arc"
        ) from None
    touched = [
        (
            first_element.get_distance_from_start(centre),
            second_element.get_distance_from_start(centre),
            centre,
        )
        for centre in find_extended_intersections(*aside)
    ]
    fitting = [
        (first_element.length - end + start, end, start, centre)
        for end, start, centre in touched
        if _required_length(first_element) <= end <= first_element.length + SAME_POINT_TOLERANCE_MM
        and -SAME_POINT_TOLERANCE_MM <= start <= second_element.length - _required_length(second_element)
    ]
    if not fitting:
        raise CornerError(
            "no arc of this radius is tangent to both moves within their length", "no-touching-arc"
        )
    _, end, start, centre = min(fitting)
    first = first_element.cut_section(first_element.start, first_element.get_point(end))
    last = second_element.cut_section(second_element.get_point(start), second_element.end)
    return first, Arc(first.end, last.start, centre, clockwise=angle < 0), last


def _fillet(before: Line, after: Line, radius: float) -> tuple[Element, Arc, Element]:
    angle = _turn_between(before, after)
    first, last = _shorten(before, after, radius * tan(abs(angle) / 2))
    side = radius if angle > 0 else -radius
    left = get_left_normal(before.end_direction)
    centre = first.end[0] + left[0] * side, first.end[1] + left[1] * side
    return first, Arc(first.end, last.start, centre, clockwise=angle < 0), last


# --- chamfers given by their own length --------------------------------------------------------------------


_STEPS = 256  # steps of the search for the first leg that is long enough
_HALVINGS = 60


def find_chamfer_leg(first_element: Element, second_element: Element, length: float) -> float:
    """Return the leg of a chamfer that is ``length`` mm long.

    Between two lines, no error is raised, because ``chamfer`` checks the leg. If an element is an arc, the
    errors are:
    - SameDirectionError if the elements have the same direction.
    - CornerTooLargeError if an element has no length.
    - CornerError if the second element reverses the direction, or an element is too short.
    """
    if isinstance(first_element, Line) and isinstance(second_element, Line):
        # The chamfer and its two legs are an isosceles triangle.
        return length / (
            2.0
            * max(
                abs(cos(compute_turn_angle(first_element.end_direction, second_element.start_direction) / 2)),
                1e-9,
            )
        )
    _turn_between(first_element, second_element)
    most = min(_max_leg(first_element), _max_leg(second_element))
    for step in range(1, _STEPS + 1):
        if _chamfer_length(first_element, second_element, most * step / _STEPS) >= length:
            return _found(
                first_element, second_element, length, most * (step - 1) / _STEPS, most * step / _STEPS
            )
    raise CornerError("the two moves are too short for a chamfer of this length", "too-short")


def _found(before: Element, after: Element, length: float, short: float, long: float) -> float:
    for _ in range(_HALVINGS):
        middle = (short + long) / 2
        short, long = (middle, long) if _chamfer_length(before, after, middle) < length else (short, middle)
    return long


def _chamfer_length(before: Element, after: Element, leg: float) -> float:
    """Return the length of the chamfer with this leg."""
    one = before.get_point(before.length - _way(before, leg))
    return dist(one, after.get_point(_way(after, leg)))


def _max_leg(element: Element) -> float:
    """Return the longest chamfer leg that ends on the element."""
    if isinstance(element, Line):
        return element.length
    return 2.0 * element.radius * sin(min(abs(element.sweep_rad), pi) / 2.0)
