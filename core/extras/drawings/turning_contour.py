"""The contour that a turning tool follows: grooves bridged, overhangs cut short, faces left off.

Worked out for the outside; the wall of a bore is its mirror image, so both are one. Fillets and nicks smaller
than the nose of the tool are passed by, as G41 and G42 are refused where its radius does not fit in. The
contour that a ball of this radius touches from outside is the contour moved off by the radius, what it cannot
reach left out, and moved back.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from core.extras.drawings.contour_walk import split, turned_about
from core.extras.drawings.drawing import DrawingError
from core.extras.drawings.drawing_view import Profile, Side
from core.geometry.contour_offset import GougeError, TrimError, pieces_beside, trimmed_offset
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, intersections
from core.message import Message
from core.part.swept_edge import towards_axis
from core.part.tool_outline import outline
from core.part.tool_shape import ToolShape

_SAME = 1e-4  # mm
_SPARE = math.radians(2.0)  # by which a tool's edge stays off the metal behind it
_LEVEL = math.radians(3.0)  # a tool that can fall by less falls nowhere
_STEEP = math.radians(89.5)
_CHORD = 0.3  # mm: a longer piece of an edge is straight
_MOST = math.radians(179.0)  # of an arc that R can say


@dataclass(frozen=True, slots=True)
class Groove:
    """What a turning tool leaves out: elements from the edge at the face to that at the chuck."""

    elements: tuple[Element, ...]

    @property
    def front(self) -> Point:
        """The edge at the face."""
        return self.elements[0].start

    @property
    def back(self) -> Point:
        """The edge at the chuck."""
        return self.elements[-1].end


@dataclass(frozen=True, slots=True)
class TurningContour:
    """``elements`` for the turning tool, ``grooves`` for a blade; ``left``: spans (z, z, why) of nobody."""

    elements: tuple[Element, ...]
    grooves: tuple[Groove, ...] = ()
    left: tuple[tuple[float, float, str], ...] = ()
    steepest: float = 0.0  # rad: how steeply the turned contour falls towards the chuck


@dataclass(frozen=True, slots=True)
class Reach:
    """What the edges of a tool allow: ``fall`` towards the chuck behind its nose, ``rise`` before it; rad."""

    fall: float = 0.0
    rise: float = math.pi / 2.0


def reach_of(shape: ToolShape | None, side: Side) -> Reach:
    """By the tool's outline; of a tool without a sheet nothing but cylinders, faces and shoulders."""
    cutting = outline(shape).cutting if shape is not None else ()
    if not cutting:
        return Reach()
    edge = towards_axis(cutting[0] * [1.0, -1.0 if side is Side.INSIDE else 1.0])
    points = [(float(z), float(r)) for z, r in zip(edge.z, edge.r, strict=True)]
    tip = int(edge.r.argmin())
    behind, before = _straight(points[tip:]), _straight(points[tip::-1])
    return Reach(behind or 0.0, before or math.pi / 2.0)


def _straight(points: Sequence[Point]) -> float | None:
    """The angle, from the axis, of the first piece of an edge that is no chord of the nose; None: none is."""
    for (z0, r0), (z1, r1) in pairwise(points):
        if math.hypot(z1 - z0, r1 - r0) > _CHORD:
            return math.atan2(abs(r1 - r0), abs(z1 - z0))
    return None


def turning_contour(profile: Profile, reach: Reach) -> TurningContour:
    """What of a profile a tool of this reach turns. Raises DrawingError where nothing is left to turn."""
    inside = profile.side is Side.INSIDE
    elements = list(turned_about(profile.elements)) if inside else list(profile.elements)
    left: list[tuple[float, float, str]] = []
    lit = _seen_from_outside(_monotone(elements), left)
    lit = _without_face(lit)
    if not lit:
        raise DrawingError(
            "This contour consists only of a face, so there is nothing to turn. Choose another contour.",
            "nothing-to-turn",
        )
    kept, grooves = _bridged(lit, reach.fall, left)
    _not_too_steep(kept, reach)
    steepest = max((_fall(each) for each in kept), default=0.0)
    made = TurningContour(tuple(joined(kept)), tuple(grooves), tuple(left), max(0.0, steepest))
    return _turned_back(made) if inside else made


def _turned_back(made: TurningContour) -> TurningContour:
    grooves = tuple(Groove(tuple(turned_about(each.elements))) for each in made.grooves)
    return replace(made, elements=tuple(turned_about(made.elements)), grooves=grooves)


# --- pieces that neither turn back along Z nor along r


def _monotone(elements: Iterable[Element]) -> list[Element]:
    """Arcs cut where they stand upright or lie level."""
    found: list[Element] = []
    for each in elements:
        if isinstance(each, Arc):
            (r, z), radius = each.centre, each.radius
            quarters = [(r + radius, z), (r - radius, z), (r, z + radius), (r, z - radius)]
            found += split(each, [p for p in quarters if 0.0 < each.along(p) < each.length])
        else:
            found.append(each)
    return found


def _seen_from_outside(elements: list[Element], left: list[tuple[float, float, str]]) -> list[Element]:
    """Without what lies under itself, which no tool from outside gets to: a wall stands there instead."""
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
            _cut_behind(found, front)
            at = last + 1
        else:
            at = _go_on_behind(found, elements, last + 1, turn)
    return found


def _cut_behind(found: list[Element], lip: Point) -> None:
    """A wall under a lip, in the place of what lies behind it."""
    while found and found[-1].start[1] < lip[1]:
        found.pop()
    if found and found[-1].end[1] < lip[1]:
        each = found.pop()
        foot = _at_z(each, lip[1])
        found += split(each, [foot])[:1]
        found += _wall(foot, lip)
    elif found:
        found += _wall(found[-1].end, lip)


def _go_on_behind(found: list[Element], elements: Sequence[Element], at: int, edge: Point) -> int:
    """A wall down from an edge to where the contour comes out behind it."""
    while at < len(elements) and elements[at].end[1] >= edge[1] - _SAME:
        at += 1
    if at < len(elements):
        foot = _at_z(elements[at], edge[1])
        found += _wall(edge, foot)
        found += split(elements[at], [foot])[-1:]
        at += 1
    return at


def _wall(a: Point, b: Point) -> list[Element]:
    return [Line(a, (b[0], a[1]))] if abs(a[0] - b[0]) > _SAME else []


def _at_z(each: Element, z: float) -> Point:
    """Where an element has this Z."""
    return _crossing(each, Line((-1e5, z), (1e5, z))) or each.start


def _crossing(each: Element, line: Line) -> Point | None:
    """The first place, along an element, at which it meets a line."""
    return min(intersections(line, each), key=each.along, default=None)


def _without_face(elements: list[Element]) -> list[Element]:
    """Without the face in front, and without a wall down at the end."""
    begin = 0
    while begin < len(elements) and abs(elements[begin].end[1] - elements[0].start[1]) <= _SAME:
        begin += 1
    end = len(elements)
    while end > begin and _fall(elements[end - 1]) >= _STEEP:
        end -= 1
    return elements[begin:end]


# --- grooves and falls


def _fall(each: Element) -> float:
    """How steeply an element without extremes falls on its way to the chuck, rad; rising ones less than 0."""
    ways = (each.start_direction, each.end_direction)
    found = (math.atan2(-way[0], max(-way[1], 0.0)) for way in ways)
    return max(found) if each.end[0] < each.start[0] - _SAME else -max(-f for f in found)


def _rise(each: Element) -> float:
    ways = (each.start_direction, each.end_direction)
    return max(math.atan2(way[0], max(-way[1], 0.0)) for way in ways)


def _not_too_steep(kept: Iterable[Element], reach: Reach) -> None:
    """A tool that enters at less than 90 degrees would lean into a shoulder."""
    if reach.rise >= math.pi / 2.0 - 1e-3:
        return
    for each in kept:
        if each.end[0] > each.start[0] + _SAME and _rise(each) > reach.rise + 1e-3:
            raise DrawingError(
                Message(
                    "The tool edge is at {rise} degrees, but the contour at Z {start} mm is at {item} "
                    "degrees: use a tool that can turn shoulders.",
                    rise=f"{math.degrees(reach.rise):.0f}",
                    start=f"{each.start[1]:.3f}",
                    item=f"{math.degrees(_rise(each)):.0f}",
                ),
                "too-steep",
            )


def _bridged(
    elements: list[Element], fall: float, left: list[tuple[float, float, str]]
) -> tuple[list[Element], list[Groove]]:
    """The contour without what falls more steeply than the tool's edge behind its nose."""
    most = fall - _SPARE if fall > _LEVEL else 0.0
    kept: list[Element] = []
    grooves: list[Groove] = []
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
            cut = split(elements[end], [rest]) if math.dist(rest, elements[end].end) > _SAME else []
            grooves.append(Groove((*inside, cut[0] if cut else elements[end])))
            kept += _level(each.start, rest)
            at = end + 1
            if cut:
                elements[end] = cut[-1]
                at = end
        else:
            already = len(kept)
            at = _gently(elements, at, most, kept)
            if len(kept) > already:
                continue  # what comes now may be a groove of its own
            edge = elements[at].start[1]
            at = _sloped(elements, at, most, kept)
            left.append((kept[-1].end[1], edge, "the contour slopes too steeply for the tool"))
    return kept, grooves


def _level(a: Point, b: Point) -> list[Element]:
    return [Line(a, (a[0], b[1]))] if a[1] - b[1] > _SAME else []


def _recess(elements: Sequence[Element], at: int) -> tuple[int, Point | None]:
    """From a fall on: the element that comes back to the height of its edge, and where; else the end."""
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
    """From a fall on, what the tool still follows: up to where the contour falls more steeply than it can."""
    while _fall(elements[at]) <= most:
        kept.append(elements[at])
        at += 1
    each = elements[at]
    if isinstance(each, Arc) and each.start[1] > each.centre[1] - _SAME and each.start[0] > each.centre[0]:
        r, z = each.centre
        turn = (r + each.radius * math.cos(most), z - each.radius * math.sin(most))
        if _SAME < each.along(turn) < each.length:
            before, elements[at] = split(each, [turn])
            kept.append(before)
    return at


def _sloped(elements: list[Element], at: int, most: float, kept: list[Element]) -> int:
    """From an edge along the slope that the tool can follow to where that meets the contour again."""
    edge = elements[at].start
    far = max(edge[1] - elements[-1].end[1], _SAME)
    drop = far * math.tan(most)
    if drop > edge[0] > 0.0:  # it would cross the axis
        far, drop = far * edge[0] / drop, edge[0]
    slope = Line(edge, (edge[0] - drop, edge[1] - far))
    for number in range(at, len(elements)):
        meet = [p for p in intersections(slope, elements[number]) if math.dist(p, edge) > 10 * _SAME]
        if meet:
            point = min(meet, key=elements[number].along)
            kept.append(Line(edge, point))
            elements[number] = split(elements[number], [point])[-1]
            return number if math.dist(point, elements[number].end) > _SAME else number + 1
    kept.append(slope)
    return len(elements)


# --- tidied


def joined(elements: Iterable[Element]) -> list[Element]:
    """Neighbours on one line or about one centre as one; what is too short for the control is left out."""
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
        same = math.dist(a.centre, b.centre) < _SAME and abs(a.radius - b.radius) < _SAME
        whole = abs(a.sweep) + abs(b.sweep)
        return Arc(a.start, b.end, a.centre, a.clockwise) if same and whole < _MOST else None
    return None


_NOSE_SPARE = 0.02  # mm: a fillet of just the nose radius leaves its centre no way, least in rounded words
_BACK = 0.001  # mm: moved back by less than off, so that a corner outwards keeps a length
_SLIVER = 0.03  # mm
_STRAIGHT = 0.1  # rad: what is left out lies within .0015 mm


def reached_by_nose(elements: Sequence[Element], nose: float, *, inside: bool) -> tuple[Element, ...]:
    """The contour as it is where a nose of this radius (mm) follows it, else with fillets that it fits into.

    Where no unbroken way along it is left the contour stays, and the proof of the program tells the place.
    """
    contour = tuple(turned_about(elements)) if inside else tuple(elements)
    if not nose or _follows(contour, nose):
        return tuple(elements)
    try:
        off = trimmed_offset(contour, nose + _NOSE_SPARE)
        back = trimmed_offset(_reversed(off), nose + _NOSE_SPARE - _BACK)
    except TrimError:
        return tuple(elements)
    reached = list(_without_slivers(_reversed(back)))
    return tuple(turned_about(reached)) if inside else tuple(reached)


def _without_slivers(contour: Sequence[Element]) -> Iterator[Element]:
    """Without arcs so short that rounded words say nothing of them; the next begins where the last ended."""
    for number, each in enumerate(contour):
        short = isinstance(each, Arc) and each.length < _SLIVER and abs(each.sweep) < _STRAIGHT
        if not short or number in {0, len(contour) - 1}:
            yield each


def _reversed(elements: Sequence[Element]) -> list[Element]:
    return [each.reversed() for each in reversed(elements)]


def _follows(contour: Sequence[Element], nose: float) -> bool:
    """Whether nose compensation takes the contour, by the same offset that the control makes."""
    try:
        pieces_beside(contour, nose)
    except GougeError:
        return False
    return True
