"""Lines and arcs in X and Z, in mm with X as a radius, and their intersections.

Directions are as seen from above, with Z+ to the right and X+ down. Angles are measured from Z+ toward X+,
which is clockwise. A clockwise arc therefore has a positive sweep. Left and right are relative to the
direction of motion: for a motion toward X+, the left side is Z+, and for a motion toward Z-, it is X+.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from math import acos, atan2, cos, dist, hypot, pi, sin, sqrt

FULL_TURN_RAD = 2 * math.pi

# mm. Ends of an arc that are closer than this are one point and make a full circle. The value is far below
# the control's resolution of 1.27 µm.
SAME_POINT_TOLERANCE_MM = 1e-6
Point = tuple[float, float]
"""Point with X as a radius and Z, in mm."""
BoundingBox = tuple[float, float, float, float]
"""Minimum X, maximum X, minimum Z and maximum Z, in mm."""
# mm. Curves that are closer than this touch. Offsets of tangent elements have this accuracy, and a machine
# cannot show a nanometer.
TOUCH_TOLERANCE_MM = 1e-6
# Sine of the angle (rad) below which two lines count as parallel. Rounding errors would move their
# intersection by a thousand times the distance between them.
PARALLEL_TOLERANCE = 1e-9


def compute_arc_sweep(
    start_x: float, start_z: float, x: float, z: float, center_x: float, center_z: float, is_clockwise: bool
) -> tuple[float, float]:
    """Return the start angle and the signed sweep of an arc in radians, measured from Z+ toward X+.

    Seen from above (X+ down, Z+ right), this direction is clockwise, so G02 has a positive sweep. Equal
    start and end points result in a full circle.
    """
    start = math.atan2(start_x - center_x, start_z - center_z)
    if math.hypot(x - start_x, z - start_z) < SAME_POINT_TOLERANCE_MM:
        return start, FULL_TURN_RAD if is_clockwise else -FULL_TURN_RAD
    turned = (math.atan2(x - center_x, z - center_z) - start) % FULL_TURN_RAD
    return start, turned if is_clockwise else turned - FULL_TURN_RAD


def compute_arc_extent(
    start_x: float, start_z: float, x: float, z: float, center_x: float, center_z: float, is_clockwise: bool
) -> tuple[float, float, float, float]:
    """Return the extent of an arc as (minimum x, maximum x, minimum z, maximum z), in mm."""
    a, b, c, d = start_x - center_x, start_z - center_z, x - center_x, z - center_z
    turned = b * c - a * d
    if (
        a * c > 0.0
        and b * d > 0.0
        and (turned > 0.0 if is_clockwise else turned < 0.0)
        and abs(x - start_x) + abs(z - start_z) > 2.0 * SAME_POINT_TOLERANCE_MM
    ):  # within a quadrant, the ends are the extremes
        return min(start_x, x), max(start_x, x), min(start_z, z), max(start_z, z)
    start, sweep = compute_arc_sweep(start_x, start_z, x, z, center_x, center_z, is_clockwise)
    radius = math.hypot(start_x - center_x, start_z - center_z)
    low, high = sorted((start, start + sweep))
    xs, zs = [start_x, x], [start_z, z]
    quarter = math.pi / 2
    for k in range(math.ceil(low / quarter), math.floor(high / quarter) + 1):
        xs.append(center_x + radius * math.sin(k * quarter))
        zs.append(center_z + radius * math.cos(k * quarter))
    return min(xs), max(xs), min(zs), max(zs)


def find_arc_center(start: Point, end: Point, radius: float, *, is_clockwise: bool) -> Point:
    """Return the center of the arc of at most 180 degrees from ``start`` to ``end``.

    If the chord is longer than the diameter, the result is the midpoint of the chord. Raises ValueError if
    start and end are equal.
    """
    dx, dz = end[0] - start[0], end[1] - start[1]
    chord = hypot(dx, dz)
    if chord == 0.0:
        raise ValueError("an arc given by its radius needs two different ends")
    rise = sqrt(max(radius * radius - chord * chord / 4, 0.0)) / chord
    side = rise if is_clockwise else -rise  # the center of a clockwise arc is to the right of its direction
    return (start[0] + end[0]) / 2 + side * dz, (start[1] + end[1]) / 2 - side * dx


def compute_arc_length(start: Point, end: Point, center: Point, *, is_clockwise: bool) -> float:
    """Return the length of an arc. If its end radii differ slightly, it is calculated as a spiral."""
    first = hypot(start[0] - center[0], start[1] - center[1])
    last = hypot(end[0] - center[0], end[1] - center[1])
    _, sweep = compute_arc_sweep(*start, *end, *center, is_clockwise)
    return (first + last) / 2 * abs(sweep)


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line between two different points."""

    start: Point
    end: Point

    @property
    def length(self) -> float:
        """Return the length of the line, in mm."""
        return dist(self.start, self.end)

    @property
    def start_direction(self) -> Point:
        """Return the direction at the start, as a unit vector."""
        dx, dz = self.end[0] - self.start[0], self.end[1] - self.start[1]
        size = hypot(dx, dz)
        return dx / size, dz / size

    @property
    def end_direction(self) -> Point:
        """Return the direction at the end, as a unit vector."""
        return self.start_direction

    @property
    def bounding_box(self) -> BoundingBox:
        """Return the bounding box of the line."""
        (x0, z0), (x1, z1) = self.start, self.end
        return min(x0, x1), max(x0, x1), min(z0, z1), max(z0, z1)

    def get_point(self, distance: float) -> Point:
        """Return the point at ``distance`` mm from the start; it may be past an end of the line."""
        dx, dz = self.start_direction
        return self.start[0] + dx * distance, self.start[1] + dz * distance

    def get_distance_from_start(self, point: Point) -> float:
        """Return the distance in mm from the start to the projection of ``point`` onto the line.

        The line is extended infinitely. The distance is negative before the start.
        """
        dx, dz = self.start_direction
        return (point[0] - self.start[0]) * dx + (point[1] - self.start[1]) * dz

    def cut_section(self, start: Point, end: Point) -> Line:
        """Return the section of the line between two of its points."""
        return Line(start, end)

    def make_reversed(self) -> Line:
        """Return the same line with start and end exchanged."""
        return Line(self.end, self.start)


@dataclass(frozen=True, slots=True)
class Arc:
    """An arc of a circle.

    If the start and end points are equal, the arc is a full circle. See ``make_arc``.
    """

    start: Point
    end: Point
    center: Point
    clockwise: bool

    @property
    def radius(self) -> float:
        """Return the radius of the arc, in mm."""
        return dist(self.start, self.center)

    @property
    def sweep_rad(self) -> float:
        """Return the signed angle of the arc in radians, positive for a clockwise arc."""
        return compute_arc_sweep(*self.start, *self.end, *self.center, self.clockwise)[1]

    @property
    def length(self) -> float:
        """Return the length of the arc, in mm."""
        return self.radius * abs(self.sweep_rad)

    @property
    def start_direction(self) -> Point:
        """Return the direction at the start, as a unit vector."""
        return self._direction(self.start)

    @property
    def end_direction(self) -> Point:
        """Return the direction at the end, as a unit vector."""
        return self._direction(self.end)

    @property
    def bounding_box(self) -> BoundingBox:
        """Return the bounding box of the arc."""
        return compute_arc_extent(*self.start, *self.end, *self.center, self.clockwise)

    def get_point(self, distance: float) -> Point:
        """Return the point at ``distance`` mm from the start; it may be past an end of the arc."""
        radius = self.radius
        angle = atan2(self.start[0] - self.center[0], self.start[1] - self.center[1])
        angle += distance / radius if self.clockwise else -distance / radius
        return self.center[0] + radius * sin(angle), self.center[1] + radius * cos(angle)

    def get_distance_from_start(self, point: Point) -> float:
        """Return the distance in mm from the start to ``point`` along the circle.

        The distance of a point outside the arc is negative if the point is nearer to the start, and greater
        than the length if it is nearer to the end.
        """
        angle = atan2(point[0] - self.center[0], point[1] - self.center[1])
        first = atan2(self.start[0] - self.center[0], self.start[1] - self.center[1])
        turned = (angle - first if self.clockwise else first - angle) % FULL_TURN_RAD
        off = FULL_TURN_RAD - abs(self.sweep_rad)
        if turned > FULL_TURN_RAD - off / 2:
            turned -= FULL_TURN_RAD
        return turned * self.radius

    def cut_section(self, start: Point, end: Point) -> Arc:
        """Return the section of the arc between two of its points."""
        return Arc(start, end, self.center, self.clockwise)

    def make_reversed(self) -> Arc:
        """Return the same arc with start and end exchanged."""
        return Arc(self.end, self.start, self.center, not self.clockwise)

    def _direction(self, at: Point) -> Point:
        rx, rz = at[0] - self.center[0], at[1] - self.center[1]
        size = hypot(rx, rz)
        return (rz / size, -rx / size) if self.clockwise else (-rz / size, rx / size)


Element = Line | Arc


def make_arc(start: Point, end: Point, center: Point, *, is_clockwise: bool) -> Arc:
    """Return an arc with its center corrected so that the radii at both ends are equal.

    The center is moved to the perpendicular bisector of the chord. Programs round centers to the
    resolution, and the motion planner corrects them in the same manner.
    """
    dx, dz = end[0] - start[0], end[1] - start[1]
    chord = hypot(dx, dz)
    if chord < SAME_POINT_TOLERANCE_MM:
        return Arc(start, end, center, is_clockwise)
    ux, uz = dx / chord, dz / chord
    off = (center[0] - (start[0] + end[0]) / 2) * ux + (center[1] - (start[1] + end[1]) / 2) * uz
    return Arc(start, end, (center[0] - off * ux, center[1] - off * uz), is_clockwise)


def shift_element(element: Element, x: float, z: float) -> Element:
    """Return a line or an arc shifted by ``x`` and ``z`` mm."""
    if not x and not z:
        return element
    start, end = (element.start[0] + x, element.start[1] + z), (element.end[0] + x, element.end[1] + z)
    if isinstance(element, Line):
        return Line(start, end)
    return Arc(start, end, (element.center[0] + x, element.center[1] + z), element.clockwise)


def get_left_normal(direction: Point) -> Point:
    """Return the unit vector to the left of a direction, seen from above."""
    return -direction[1], direction[0]


def find_tangent_point(point: Point, center: Point, radius: float, *, is_clockwise: bool) -> Point:
    """Return the point at which a line from a point outside a circle is tangent to the circle.

    The path follows the line and then the circle, clockwise if ``is_clockwise`` is True.
    """
    half = acos(min(1.0, radius / dist(point, center)))
    # In the direction of the circle, the tangent point is ``half`` after the direction of the point.
    angle = atan2(point[0] - center[0], point[1] - center[1]) + (half if is_clockwise else -half)
    return center[0] + radius * sin(angle), center[1] + radius * cos(angle)


def compute_turn_angle(first: Point, second: Point) -> float:
    """Return the angle in radians from one direction to the next, positive to the left, in (-pi, pi]."""
    cross = first[0] * second[1] - first[1] * second[0]
    dot = first[0] * second[0] + first[1] * second[1]
    angle = atan2(cross, dot)
    return pi if angle == -pi else angle


def find_extended_intersections(first: Element, second: Element) -> list[Point]:
    """Return the intersections of the infinite lines or full circles of two elements.

    There are at most two points; a tangent point counts once. Elements on the same line or circle have no
    intersections.
    """
    if isinstance(first, Line):
        return _lines(first, second) if isinstance(second, Line) else _line_circle(first, second)
    return _line_circle(second, first) if isinstance(second, Line) else _circles(first, second)


def find_intersections(first: Element, second: Element) -> list[Point]:
    """Return the points that both elements share, including their ends.

    For elements on the same line or circle, the list is empty.
    """
    return [
        point
        for point in find_extended_intersections(first, second)
        if contains_point(first, point) and contains_point(second, point)
    ]


def contains_point(element: Element, point: Point) -> bool:
    """Return whether a point is between the ends of an element.

    The point must be on the infinite line or the full circle of the element.
    """
    return (
        -SAME_POINT_TOLERANCE_MM
        <= element.get_distance_from_start(point)
        <= element.length + SAME_POINT_TOLERANCE_MM
    )


def _lines(a: Line, b: Line) -> list[Point]:
    (ax, az), (bx, bz) = a.start_direction, b.start_direction
    cross = ax * bz - az * bx
    if abs(cross) < PARALLEL_TOLERANCE:
        return []
    dx, dz = b.start[0] - a.start[0], b.start[1] - a.start[1]
    return [a.get_point((dx * bz - dz * bx) / cross)]


def _line_circle(line: Line, arc: Arc) -> list[Point]:
    foot = line.get_distance_from_start(arc.center)
    off, radius = dist(line.get_point(foot), arc.center), arc.radius
    if off > radius + TOUCH_TOLERANCE_MM:
        return []
    half = sqrt(max(radius * radius - off * off, 0.0))
    return (
        [line.get_point(foot)] if half == 0.0 else [line.get_point(foot - half), line.get_point(foot + half)]
    )


def _circles(a: Arc, b: Arc) -> list[Point]:
    apart = dist(a.center, b.center)
    ra, rb = a.radius, b.radius
    if (
        apart < TOUCH_TOLERANCE_MM
        or apart > ra + rb + TOUCH_TOLERANCE_MM
        or apart < abs(ra - rb) - TOUCH_TOLERANCE_MM
    ):
        return []
    ux, uz = (b.center[0] - a.center[0]) / apart, (b.center[1] - a.center[1]) / apart
    to_chord = (apart * apart + ra * ra - rb * rb) / (2 * apart)
    half = sqrt(max(ra * ra - to_chord * to_chord, 0.0))
    x, z = a.center[0] + ux * to_chord, a.center[1] + uz * to_chord
    return [(x, z)] if half == 0.0 else [(x - uz * half, z + ux * half), (x + uz * half, z - ux * half)]


def compute_distance_to_point(element: Element, point: Point) -> float:
    """Return the distance from a point to the nearest point of an element, in mm."""
    at = element.get_distance_from_start(point)
    if 0.0 <= at <= element.length:
        if isinstance(element, Arc):
            return abs(dist(point, element.center) - element.radius)
        return dist(point, element.get_point(at))
    return min(dist(point, element.start), dist(point, element.end))


def compute_min_distance(first: Element, second: Element) -> float:
    """Return the minimum distance between two elements in mm, or 0 if they intersect.

    The minimum is at an end of an element or on a common normal, which passes through the centers of arcs.
    """
    if find_intersections(first, second):
        return 0.0
    points_a, points_b = (
        [first.start, first.end, *_facing_points(first, second)],
        [second.start, second.end, *_facing_points(second, first)],
    )
    return min(
        [compute_distance_to_point(second, point) for point in points_a]
        + [compute_distance_to_point(first, point) for point in points_b]
    )


def _facing_points(element: Element, other: Element) -> list[Point]:
    """Return points between an element's ends whose normal passes through the other element's center."""
    if isinstance(other, Line):
        return []
    if isinstance(element, Line):
        foot = element.get_distance_from_start(other.center)
        return [element.get_point(foot)] if 0.0 < foot < element.length else []
    dx, dz = other.center[0] - element.center[0], other.center[1] - element.center[1]
    apart, radius = hypot(dx, dz), element.radius
    if apart < TOUCH_TOLERANCE_MM:
        return []
    rx, rz = dx / apart * radius, dz / apart * radius
    both = (
        (element.center[0] + rx, element.center[1] + rz),
        (element.center[0] - rx, element.center[1] - rz),
    )
    return [point for point in both if 0.0 < element.get_distance_from_start(point) < element.length]
