"""Where two contour elements meet, and how near they come to each other."""

from __future__ import annotations

from math import dist, hypot, sqrt

from core.geometry.lines_and_arcs import SAME_POINT, Arc, Element, Line, Point

# Curves that miss each other by less than this touch: the offsets of tangent elements are that exact, and a
# thousandth of a micrometre is nothing to a machine. mm.
TOUCH = 1e-6

# Sine of the angle under which two lines have no intersection worth the name: it would lie a thousand
# times farther off than the lines are apart by their last binary place. rad.
PARALLEL = 1e-9


def meetings(a: Element, b: Element) -> list[Point]:
    """Where the endless line or whole circle of one meets that of the other; at most two points.

    Touching counts once. Elements on one line or one circle have none.
    """
    if isinstance(a, Line):
        return _lines(a, b) if isinstance(b, Line) else _line_circle(a, b)
    return _line_circle(b, a) if isinstance(b, Line) else _circles(a, b)


def intersections(a: Element, b: Element) -> list[Point]:
    """The points that both elements share, their ends included; none for elements on one line or circle."""
    return [point for point in meetings(a, b) if holds(a, point) and holds(b, point)]


def holds(element: Element, point: Point) -> bool:
    """Whether a point of the endless line or whole circle lies within the element."""
    return -SAME_POINT <= element.along(point) <= element.length + SAME_POINT


def _lines(a: Line, b: Line) -> list[Point]:
    (ax, az), (bx, bz) = a.start_direction, b.start_direction
    cross = ax * bz - az * bx
    if abs(cross) < PARALLEL:
        return []
    dx, dz = b.start[0] - a.start[0], b.start[1] - a.start[1]
    return [a.point((dx * bz - dz * bx) / cross)]


def _line_circle(line: Line, arc: Arc) -> list[Point]:
    foot = line.along(arc.centre)
    off, radius = dist(line.point(foot), arc.centre), arc.radius
    if off > radius + TOUCH:
        return []
    half = sqrt(max(radius * radius - off * off, 0.0))
    return [line.point(foot)] if half == 0.0 else [line.point(foot - half), line.point(foot + half)]


def _circles(a: Arc, b: Arc) -> list[Point]:
    apart = dist(a.centre, b.centre)
    ra, rb = a.radius, b.radius
    if apart < TOUCH or apart > ra + rb + TOUCH or apart < abs(ra - rb) - TOUCH:
        return []
    ux, uz = (b.centre[0] - a.centre[0]) / apart, (b.centre[1] - a.centre[1]) / apart
    to_chord = (apart * apart + ra * ra - rb * rb) / (2 * apart)
    half = sqrt(max(ra * ra - to_chord * to_chord, 0.0))
    x, z = a.centre[0] + ux * to_chord, a.centre[1] + uz * to_chord
    return [(x, z)] if half == 0.0 else [(x - uz * half, z + ux * half), (x + uz * half, z - ux * half)]


def distance(element: Element, point: Point) -> float:
    """How far a point is from the nearest point of an element, mm."""
    at = element.along(point)
    if 0.0 <= at <= element.length:
        if isinstance(element, Arc):
            return abs(dist(point, element.centre) - element.radius)
        return dist(point, element.point(at))
    return min(dist(point, element.start), dist(point, element.end))


def clearance(a: Element, b: Element) -> float:
    """The least distance between two elements, mm: 0 where they cross.

    It is reached at an end of one of them or on a common normal, which runs through the centres of arcs.
    """
    if intersections(a, b):
        return 0.0
    points_a, points_b = [a.start, a.end, *_facing(a, b)], [b.start, b.end, *_facing(b, a)]
    return min([distance(b, point) for point in points_a] + [distance(a, point) for point in points_b])


def _facing(element: Element, other: Element) -> list[Point]:
    """Inner points of an element at which its normal runs through the centre of the other."""
    if isinstance(other, Line):
        return []
    if isinstance(element, Line):
        foot = element.along(other.centre)
        return [element.point(foot)] if 0.0 < foot < element.length else []
    dx, dz = other.centre[0] - element.centre[0], other.centre[1] - element.centre[1]
    apart, radius = hypot(dx, dz), element.radius
    if apart < TOUCH:
        return []
    rx, rz = dx / apart * radius, dz / apart * radius
    both = (
        (element.centre[0] + rx, element.centre[1] + rz),
        (element.centre[0] - rx, element.centre[1] - rz),
    )
    return [point for point in both if 0.0 < element.along(point) < element.length]
