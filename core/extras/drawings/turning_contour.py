"""Contour that the nose of a turning tool can follow, without grooves and faces.

The calculation is for an outside contour. The wall of a bore is mirrored about the axis before and after
the calculation.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from core.extras.drawings.contour_tracing import mirror_elements, split_element
from core.extras.drawings.drawing import DrawingError
from core.extras.drawings.drawing_placement import ContourProfile, ContourSide
from core.geometry.contour_offset import GougeError, TrimError, offset_known_contour, trim_offset
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, find_intersections
from core.message import Message
from core.part.swept_edge import find_axis_facing_edge
from core.part.tool_outline import make_tool_outline
from core.part.tool_shape import ToolShape

_SAME = 1e-4  # mm
_SPARE = math.radians(2.0)  # clearance between the trailing edge of a tool and the part
_LEVEL = math.radians(3.0)  # a tool that can fall by less is not used for falling contours
_STEEP = math.radians(89.5)
_CHORD = 0.3  # mm; a longer piece of an edge is straight
_MOST = math.radians(179.0)  # largest angle of an arc that R can specify


@dataclass(frozen=True, slots=True)
class OmittedGroove:
    """A groove in the contour that a turning tool omits.

    ``elements`` are in order from the edge at the face to the edge at the chuck.
    """

    elements: tuple[Element, ...]

    @property
    def front_edge(self) -> Point:
        """Return the groove edge at the face as (r, z)."""
        return self.elements[0].start

    @property
    def back_edge(self) -> Point:
        """Return the groove edge at the chuck as (r, z)."""
        return self.elements[-1].end


@dataclass(frozen=True, slots=True)
class TurningContour:
    """Contour for a turning tool, with the grooves for a blade and the ranges that no tool can reach.

    ``unreachable_ranges`` contains (z, z, reason) for each range that neither the tool nor the blade can
    reach.
    """

    elements: tuple[Element, ...]
    grooves: tuple[OmittedGroove, ...] = ()
    unreachable_ranges: tuple[tuple[float, float, str], ...] = ()
    steepest_angle_rad: float = 0.0  # rad, steepest fall of the turned contour toward the chuck


@dataclass(frozen=True, slots=True)
class ToolAngleLimits:
    """Slope angles of a contour that the edges of a tool can follow, in radians.

    ``max_falling_angle_rad`` applies where the radius decreases toward the chuck, and
    ``max_rising_angle_rad`` where it increases.
    """

    max_falling_angle_rad: float = 0.0
    max_rising_angle_rad: float = math.pi / 2.0


def calculate_tool_angle_limits(shape: ToolShape | None, side: ContourSide) -> ToolAngleLimits:
    """Return the slope angles that the edges of a tool can follow, calculated from its outline.

    A tool without tool data can turn only cylinders, faces and shoulders.
    """
    cutting = make_tool_outline(shape).cutting_outlines if shape is not None else ()
    if not cutting:
        return ToolAngleLimits()
    edge = find_axis_facing_edge(cutting[0] * [1.0, -1.0 if side is ContourSide.INSIDE else 1.0])
    points = [(float(z), float(r)) for z, r in zip(edge.z, edge.r, strict=True)]
    tip = int(edge.r.argmin())
    back_angle, before = _straight(points[tip:]), _straight(points[tip::-1])
    return ToolAngleLimits(back_angle or 0.0, before or math.pi / 2.0)


def _straight(points: Sequence[Point]) -> float | None:
    """Return the angle between the axis and the first straight piece of a tool edge after the nose.

    The result is None if the edge has no straight piece.
    """
    for (z0, r0), (z1, r1) in pairwise(points):
        if math.hypot(z1 - z0, r1 - r0) > _CHORD:
            return math.atan2(abs(r1 - r0), abs(z1 - z0))
    return None


def make_turning_contour(profile: ContourProfile, reach: ToolAngleLimits) -> TurningContour:
    """Return the part of a profile that a tool with the given reach can turn.

    Raises DrawingError if nothing remains to be turned, or if the tool's leading edge would cut into a
    shoulder.
    """
    inside = profile.side is ContourSide.INSIDE
    elements = list(mirror_elements(profile.elements)) if inside else list(profile.elements)
    left: list[tuple[float, float, str]] = []
    lit = _remove_undercuts(_monotone(elements), left)
    lit = _without_face(lit)
    if not lit:
        raise DrawingError(
            "This contour consists only of a face, so there is nothing to turn. Choose another contour.",
            "nothing-to-turn",
        )
    kept, grooves = _bridged(lit, reach.max_falling_angle_rad, left)
    _not_too_steep(kept, reach)
    steepest = max((_fall(each) for each in kept), default=0.0)
    made = TurningContour(tuple(join_elements(kept)), tuple(grooves), tuple(left), max(0.0, steepest))
    return _turned_back(made) if inside else made


def _turned_back(made: TurningContour) -> TurningContour:
    grooves = tuple(OmittedGroove(tuple(mirror_elements(each.elements))) for each in made.grooves)
    return replace(made, elements=tuple(mirror_elements(made.elements)), grooves=grooves)


# --- Pieces that are monotone in Z and in r


def _monotone(elements: Iterable[Element]) -> list[Element]:
    """Return the elements, with arcs split so that Z and r are monotonic in each part."""
    found: list[Element] = []
    for each in elements:
        if isinstance(each, Arc):
            (r, z), radius = each.center, each.radius
            quarters = [(r + radius, z), (r - radius, z), (r, z + radius), (r, z - radius)]
            found += split_element(
                each, [p for p in quarters if 0.0 < each.get_distance_from_start(p) < each.length]
            )
        else:
            found.append(each)
    return found


def _remove_undercuts(elements: list[Element], left: list[tuple[float, float, str]]) -> list[Element]:
    """Return the contour with each undercut replaced by a wall.

    No tool can reach an undercut from outside.
    """
    found: list[Element] = []
    at = 0
    while at < len(elements):
        each = elements[at]
        if each.end[1] <= each.start[1] + _SAME:
            found.append(each)
            at += 1
            continue
        turn, last = each.start, at
        while last + 1 < len(elements) and elements[last + 1].end[1] >= elements[last + 1].start[1] - _SAME:
            last += 1
        front = elements[last].end
        left.append((turn[1], front[1], "the contour is undercut"))
        if front[0] > turn[0]:
            _replace_under_lip(found, front)
            at = last + 1
        else:
            at = _add_wall_under_edge(found, elements, last + 1, turn)
    return found


def _replace_under_lip(contour: list[Element], lip: Point) -> None:
    """Replace the contour elements under an overhanging lip with a wall."""
    while contour and contour[-1].start[1] < lip[1]:
        contour.pop()
    if contour and contour[-1].end[1] < lip[1]:
        each = contour.pop()
        foot = _find_point_at_z(each, lip[1])
        contour += split_element(each, [foot])[:1]
        contour += _wall(foot, lip)
    elif contour:
        contour += _wall(contour[-1].end, lip)


def _add_wall_under_edge(contour: list[Element], elements: Sequence[Element], at: int, edge: Point) -> int:
    """Add a wall from an edge toward the axis, to the point where it meets the contour again.

    Return the number of the next element after the wall.
    """
    while at < len(elements) and elements[at].end[1] >= edge[1] - _SAME:
        at += 1
    if at < len(elements):
        foot = _find_point_at_z(elements[at], edge[1])
        contour += _wall(edge, foot)
        contour += split_element(elements[at], [foot])[-1:]
        at += 1
    return at


def _wall(a: Point, b: Point) -> list[Element]:
    return [Line(a, (b[0], a[1]))] if abs(a[0] - b[0]) > _SAME else []


def _find_point_at_z(element: Element, z: float) -> Point:
    """Return the point of an element at the given Z."""
    return _crossing(element, Line((-1e5, z), (1e5, z))) or element.start


def _crossing(element: Element, line: Line) -> Point | None:
    """Return the first point of an element at which it meets a line, or None if they do not meet."""
    return min(find_intersections(line, element), key=element.get_distance_from_start, default=None)


def _without_face(elements: list[Element]) -> list[Element]:
    """Return the contour without the face at its front and without the wall at its end."""
    begin = 0
    while begin < len(elements) and abs(elements[begin].end[1] - elements[0].start[1]) <= _SAME:
        begin += 1
    end = len(elements)
    while end > begin and _fall(elements[end - 1]) >= _STEEP:
        end -= 1
    return elements[begin:end]


# --- Grooves and falls


def _fall(element: Element) -> float:
    """Return the largest slope angle at which an element falls toward the axis and chuck, in radians.

    The angle is negative if the radius of the element increases toward the chuck.
    """
    ways = (element.start_direction, element.end_direction)
    found = (math.atan2(-direction[0], max(-direction[1], 0.0)) for direction in ways)
    return max(found) if element.end[0] < element.start[0] - _SAME else -max(-f for f in found)


def _rise(each: Element) -> float:
    ways = (each.start_direction, each.end_direction)
    return max(math.atan2(direction[0], max(-direction[1], 0.0)) for direction in ways)


def _not_too_steep(kept: Iterable[Element], reach: ToolAngleLimits) -> None:
    """Raise DrawingError if the tool's leading edge would cut into a shoulder."""
    if reach.max_rising_angle_rad >= math.pi / 2.0 - 1e-3:
        return
    for each in kept:
        if each.end[0] > each.start[0] + _SAME and _rise(each) > reach.max_rising_angle_rad + 1e-3:
            raise DrawingError(
                Message(
                    "The tool edge is at {rise} degrees, but the contour at Z {start} mm is at {item} "
                    "degrees: use a tool that can turn shoulders.",
                    rise=f"{math.degrees(reach.max_rising_angle_rad):.0f}",
                    start=f"{each.start[1]:.3f}",
                    item=f"{math.degrees(_rise(each)):.0f}",
                ),
                "too-steep",
            )


def _bridged(
    elements: list[Element], fall: float, left: list[tuple[float, float, str]]
) -> tuple[list[Element], list[OmittedGroove]]:
    """Return the contour without the ranges that are too steep, and these ranges as grooves.

    A range is too steep if its slope angle toward the axis exceeds ``fall``, the limit of the tool edge.
    """
    most = fall - _SPARE if fall > _LEVEL else 0.0
    kept: list[Element] = []
    grooves: list[OmittedGroove] = []
    at = 0
    while at < len(elements):
        each = elements[at]
        if _fall(each) <= 1e-6:
            kept.append(each)
            at += 1
            continue
        end, rest = _recess(elements, at)
        inside = elements[at:end]
        steep = max(_fall(e) for e in inside)
        if steep <= most:
            kept += inside
            at = end
        elif rest is not None:
            cut = split_element(elements[end], [rest]) if math.dist(rest, elements[end].end) > _SAME else []
            grooves.append(OmittedGroove((*inside, cut[0] if cut else elements[end])))
            kept += _level(each.start, rest)
            at = end + 1
            if cut:
                elements[end] = cut[-1]
                at = end
        else:
            already = len(kept)
            at = _gently(elements, at, most, kept)
            if len(kept) > already:
                continue  # the following elements may be a separate groove
            edge = elements[at].start[1]
            at = _sloped(elements, at, most, kept)
            left.append((kept[-1].end[1], edge, "the contour slopes too steeply for the tool"))
    return kept, grooves


def _level(a: Point, b: Point) -> list[Element]:
    return [Line(a, (a[0], b[1]))] if a[1] - b[1] > _SAME else []


def _recess(elements: Sequence[Element], at: int) -> tuple[int, Point | None]:
    """Return the element and point at which the contour, after a recess, is back at its edge radius.

    If the contour does not return to this radius, the result is the number of elements and None.
    """
    edge = elements[at].start
    for number in range(at, len(elements)):
        each = elements[number]
        if each.end[0] >= edge[0] - _SAME and number > at:
            if each.end[0] <= edge[0] + _SAME:
                return number, each.end
            level = Line((edge[0], each.start[1] + 1.0), (edge[0], each.end[1] - 1.0))
            return number, _crossing(each, level) or each.end
    return len(elements), None


def _gently(elements: list[Element], at: int, most: float, kept: list[Element]) -> int:
    """Add the elements whose slope toward the axis is within the limit of the tool.

    Return the number of the next element.
    """
    while _fall(elements[at]) <= most:
        kept.append(elements[at])
        at += 1
    each = elements[at]
    if isinstance(each, Arc) and each.start[1] > each.center[1] - _SAME and each.start[0] > each.center[0]:
        r, z = each.center
        turn = (r + each.radius * math.cos(most), z - each.radius * math.sin(most))
        if _SAME < each.get_distance_from_start(turn) < each.length:
            before, elements[at] = split_element(each, [turn])
            kept.append(before)
    return at


def _sloped(elements: list[Element], at: int, most: float, kept: list[Element]) -> int:
    """Add a line at the steepest slope that the tool permits, from an edge to the contour.

    Return the number of the next element.
    """
    edge = elements[at].start
    far = max(edge[1] - elements[-1].end[1], _SAME)
    drop = far * math.tan(most)
    if drop > edge[0] > 0.0:  # the slope would cross the axis
        far, drop = far * edge[0] / drop, edge[0]
    slope = Line(edge, (edge[0] - drop, edge[1] - far))
    for number in range(at, len(elements)):
        meet = [p for p in find_intersections(slope, elements[number]) if math.dist(p, edge) > 10 * _SAME]
        if meet:
            point = min(meet, key=elements[number].get_distance_from_start)
            kept.append(Line(edge, point))
            elements[number] = split_element(elements[number], [point])[-1]
            return number if math.dist(point, elements[number].end) > _SAME else number + 1
    kept.append(slope)
    return len(elements)


# --- Clean-up


def join_elements(elements: Iterable[Element]) -> list[Element]:
    """Return the elements with collinear lines and concentric arcs joined.

    Very short elements are removed.
    """
    found: list[Element] = []
    for each in elements:
        one = _one(found[-1], each) if found else None
        if one is not None:
            found[-1] = one
        elif each.length > _SAME:
            found.append(each)
    return found


def _one(a: Element, b: Element) -> Element | None:
    if math.dist(a.end, b.start) > 10 * _SAME:
        return None
    if isinstance(a, Line) and isinstance(b, Line):
        (ar, az), (br, bz) = a.start_direction, b.start_direction
        return Line(a.start, b.end) if abs(ar * bz - az * br) < 1e-7 and ar * br + az * bz > 0 else None
    if isinstance(a, Arc) and isinstance(b, Arc) and a.clockwise == b.clockwise:
        same = math.dist(a.center, b.center) < _SAME and abs(a.radius - b.radius) < _SAME
        whole = abs(a.sweep_rad) + abs(b.sweep_rad)
        return Arc(a.start, b.end, a.center, a.clockwise) if same and whole < _MOST else None
    return None


_NOSE_SPARE = 0.02  # mm; in a fillet of exactly the nose radius, the nose center could not move
_BACK = 0.001  # mm; the return offset is smaller, so that an outer corner retains some length
_SLIVER = 0.03  # mm
_STRAIGHT = 0.1  # rad; the error of omitting such an arc is at most 0.0015 mm


def add_nose_fillets(
    elements: Sequence[Element], nose_radius: float, *, is_inside: bool
) -> tuple[Element, ...]:
    """Return the contour with fillets in corners that a nose of this radius in mm cannot enter.

    If no continuous path remains, the contour is returned unchanged; the proof of the program then reports
    the location.
    """
    contour = tuple(mirror_elements(elements)) if is_inside else tuple(elements)
    if not nose_radius or _follows(contour, nose_radius):
        return tuple(elements)
    try:
        off = trim_offset(contour, nose_radius + _NOSE_SPARE)
        back = trim_offset(_reversed(off), nose_radius + _NOSE_SPARE - _BACK)
    except TrimError:
        return tuple(elements)
    reached = list(_without_slivers(_reversed(back)))
    return tuple(mirror_elements(reached)) if is_inside else tuple(reached)


def _without_slivers(contour: Sequence[Element]) -> Iterator[Element]:
    """Yield the contour without arcs that are too short to be programmed with rounded coordinates."""
    for number, each in enumerate(contour):
        short = isinstance(each, Arc) and each.length < _SLIVER and abs(each.sweep_rad) < _STRAIGHT
        if not short or number in {0, len(contour) - 1}:
            yield each


def _reversed(elements: Sequence[Element]) -> list[Element]:
    return [each.make_reversed() for each in reversed(elements)]


def _follows(contour: Sequence[Element], nose_radius: float) -> bool:
    """Return whether the nose compensation of the control can follow the contour."""
    try:
        offset_known_contour(contour, nose_radius)
    except GougeError:
        return False
    return True
