"""Chamfers beside arcs: a straight cut between two points at one distance from the corner.

The distance is straight, so on an arc a chord; between two lines that is the usual chamfer. Controls that say
how it is measured beside an arc (G301 of Beckhoff's) measure it so.
"""

from __future__ import annotations

from math import asin, cos, dist, pi, sin

from core.geometry.contour import Arc, Element, Line, turn
from core.geometry.corner import STRAIGHT, CornerError, CornerTooLargeError, NoCornerError, chamfer
from core.geometry.extent import SAME_POINT

_STEPS = 256  # in which the first leg is looked for that is long enough
_HALVINGS = 60


def bevel(before: Element, after: Element, leg: float) -> tuple[Element, Line, Element]:
    """Both elements ended ``leg`` mm from the point where they meet, with a line between: in order.

    Raises NoCornerError, CornerTooLargeError, or CornerError where they run back on themselves or the line
    would cross one of them.
    """
    if isinstance(before, Line) and isinstance(after, Line):
        return chamfer(before, after, leg)
    angle = _turned(before, after)
    end, start = before.length - _taken(before, leg, first=True), _taken(after, leg, first=False)
    first = before.part(before.start, before.point(max(end, 0.0)))
    last = after.part(after.point(start), after.end)
    between = Line(first.end, last.start)
    out = first.end_direction if end > SAME_POINT else before.start_direction
    into = last.start_direction if after.length - start > SAME_POINT else after.end_direction
    cut = between.start_direction
    if turn(out, cut) * angle <= 0.0 or turn(cut, into) * angle <= 0.0:
        raise CornerError("the chamfer would cross one of them")
    return first, between, last


def leg_of(before: Element, after: Element, length: float) -> float:
    """The leg of a chamfer that is itself ``length`` mm long. Raises as ``bevel``."""
    if isinstance(before, Line) and isinstance(after, Line):
        # The chamfer and its two legs are a triangle of two equal sides.
        return length / (2.0 * max(abs(cos(turn(before.end_direction, after.start_direction) / 2)), 1e-9))
    _turned(before, after)
    most = min(_longest(before), _longest(after))
    for step in range(1, _STEPS + 1):
        if _width(before, after, most * step / _STEPS) >= length:
            return _found(before, after, length, most * (step - 1) / _STEPS, most * step / _STEPS)
    raise CornerError("they are too short for a chamfer of that length")


def _found(before: Element, after: Element, length: float, short: float, long: float) -> float:
    for _ in range(_HALVINGS):
        middle = (short + long) / 2
        short, long = (middle, long) if _width(before, after, middle) < length else (short, middle)
    return long


def _width(before: Element, after: Element, leg: float) -> float:
    """How long the chamfer of this leg is."""
    one = before.point(before.length - _way(before, leg))
    return dist(one, after.point(_way(after, leg)))


def _turned(before: Element, after: Element) -> float:
    for element in (before, after):
        if element.length < SAME_POINT:
            raise CornerTooLargeError(0.0, first=element is before)
    angle = turn(before.end_direction, after.start_direction)
    if abs(angle) < STRAIGHT:
        raise NoCornerError("they go on in one direction")
    if abs(angle) > pi - STRAIGHT:
        raise CornerError("the next one runs straight back")
    return angle


def _taken(element: Element, leg: float, *, first: bool) -> float:
    """mm along the element that the leg takes of it."""
    if isinstance(element, Arc) and leg > 2.0 * element.radius:
        raise CornerTooLargeError(leg, first=first)
    way = _way(element, leg)
    # Of an arc something must be left: ends in one point would be a full circle.
    most = element.length + (SAME_POINT if isinstance(element, Line) else -SAME_POINT)
    if way > most:
        raise CornerTooLargeError(way, first=first)
    return min(way, element.length)


def _way(element: Element, leg: float) -> float:
    if isinstance(element, Line):
        return leg
    return 2.0 * element.radius * asin(min(1.0, leg / (2.0 * element.radius)))


def _longest(element: Element) -> float:
    """The longest leg that ends on the element."""
    if isinstance(element, Line):
        return element.length
    return 2.0 * element.radius * sin(min(abs(element.sweep), pi) / 2.0)
