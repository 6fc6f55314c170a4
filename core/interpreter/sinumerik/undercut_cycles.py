"""CYCLE94 and CYCLE96: undercuts E and F at a shoulder (DIN 509), and A to D behind a thread (DIN 76).

The sizes are those of the standards by diameter and by lead. The nose runs beside the profile, so that the
undercut has these sizes whatever the nose radius is.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin, tan
from typing import NamedTuple

from core.geometry.chamfer_and_rounding import rounding
from core.geometry.contour_offset import GougeError, Offset
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, left_of, shifted
from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.cycle_parameters import NO_FEED, RETRACT, Cycle, Step
from core.interpreter.sinumerik.thread_cycle import COARSE_LEADS
from core.tool_edges import TIP_DIRECTIONS

TOO_SMALL = 61601
NOSE_TOO_LARGE = 61604
WRONG_EDGE = 61608
WRONG_FORM = 61609
_CLEAR = 2.0  # mm beside the part, where the cycle starts and ends
_SAME = 1e-6  # mm
_BY_POSITION = {1: (-1.0, -1.0), 2: (-1.0, 1.0), 3: (1.0, 1.0), 4: (1.0, -1.0)}
"""By the tip quadrant: +1 outside, -1 inside; +1 where the shoulder lies towards minus Z."""


class Size(NamedTuple):
    """mm: ``depth`` below the surface, ``width`` from the shoulder, ``radius`` of both corners, ``angle`` of
    the way in, degrees; ``face``: how deep it goes into the shoulder, 0 for none.
    """

    depth: float
    width: float
    radius: float
    angle: float
    face: float = 0.0


_DIN_509 = ((10.0, 0.2, 2.0, 0.4, 0.1), (18.0, 0.2, 2.0, 0.6, 0.1), (80.0, 0.3, 2.5, 0.6, 0.2))
_DIN_509_OVER = (0.4, 4.0, 1.0, 0.3)
"""Up to this diameter: depth, width, radius, depth in the face; and over 80."""

_FACE_ANGLE = radians(8.0)

# By the lead: what the diameter of a thread outside lacks, widths of A and B, radius, widths of C and D.
_DIN_76 = {
    0.5: (0.8, 1.75, 1.25, 0.2, 2.7, 2.0), 0.7: (1.1, 2.45, 1.75, 0.4, 3.8, 2.75),
    0.8: (1.3, 2.8, 2.0, 0.4, 4.2, 3.0), 1.0: (1.6, 3.5, 2.5, 0.6, 5.2, 3.7),
    1.25: (2.0, 4.4, 3.2, 0.6, 6.7, 4.9), 1.5: (2.3, 5.2, 3.8, 0.8, 7.8, 5.6),
    1.75: (2.6, 6.1, 4.3, 1.0, 9.1, 6.4), 2.0: (3.0, 7.0, 5.0, 1.0, 10.3, 7.3),
    2.5: (3.6, 8.7, 6.3, 1.2, 13.0, 9.3), 3.0: (4.4, 10.5, 7.5, 1.6, 15.2, 10.7),
    3.5: (5.0, 12.0, 9.0, 1.6, 17.7, 12.7), 4.0: (5.7, 14.0, 10.0, 2.0, 20.0, 14.0),
    4.5: (6.4, 16.0, 11.0, 2.0, 23.0, 16.0), 5.0: (7.0, 17.5, 12.5, 2.5, 26.0, 18.5),
    5.5: (7.7, 19.0, 14.0, 3.2, 28.0, 20.0), 6.0: (8.3, 21.0, 15.0, 3.2, 30.0, 21.0),
}  # fmt: skip
_CORE = 1.0825  # core diameter of a thread inside: nominal less so many leads
_LARGEST_OF_ALL = 68


class Place(NamedTuple):
    """Where it lies: ``radius`` of the surface, Z of the ``shoulder``, and the signs of ``_BY_POSITION``."""

    radius: float
    shoulder: float
    out: float
    side: float

    def point(self, depth: float, way: float) -> Point:
        """X (a radius) and Z of a place so deep below the surface and so far from the shoulder."""
        return self.radius - self.out * depth, self.shoulder + self.side * way


def shoulder_undercut(cycle: Cycle) -> Iterator[Block]:
    """CYCLE94. Raises ProgramError before the first block."""
    form = cycle.text("FORM")
    if form not in {"E", "F"}:
        raise cycle.wrong("FORM", 'is none of "E" and "F"', "Correct it.", WRONG_FORM)
    diameter = cycle.over_zero("SPD", TOO_SMALL)
    if diameter <= 3.0:
        text = f"is {diameter:g}: undercuts begin over 3 mm"
        raise cycle.wrong("SPD", text, "Write the undercut as lines.", TOO_SMALL)
    sizes = next((row[1:] for row in _DIN_509 if diameter <= row[0]), _DIN_509_OVER)
    depth, width, radius, face = sizes
    out, side = position(cycle)
    place = Place(diameter / 2.0, cycle.needed("SPL"), out, side)
    return _cut(cycle, place, Size(depth, width, radius, 15.0, face if form == "F" else 0.0))


def thread_undercut(cycle: Cycle) -> Iterator[Block]:
    """CYCLE96. Raises ProgramError before the first block."""
    form = cycle.text("FORM")
    if form not in {"A", "B", "C", "D"}:
        raise cycle.wrong("FORM", 'is none of "A" to "D"', "Correct it.", WRONG_FORM)
    nominal = cycle.over_zero("DIATH", TOO_SMALL)
    lead = COARSE_LEADS.get(round(nominal), 0.0) if abs(nominal - round(nominal)) < _SAME else 0.0
    if not lead:
        text = f"is {nominal:g}, and no size of the coarse threads M3 to M{_LARGEST_OF_ALL}"
        raise cycle.wrong("DIATH", text, "Write the undercut as lines.", TOO_SMALL)
    lacks, long, short, radius, long_inside, short_inside = _DIN_76[lead]
    out, side = position(cycle)
    inside = form in {"C", "D"}
    if inside is (out > 0.0):
        where, other = ("inside", "outside") if inside else ("outside", "inside")
        text = f"{form} lies {where}, and the tool's edge is one for {other}"
        raise cycle.wrong("FORM", text, "Correct it, or take another tool.", WRONG_EDGE)
    if not inside:
        size = Size(lacks / 2.0, long if form == "A" else short, radius, 30.0)
        return _cut(cycle, Place(nominal / 2.0, cycle.needed("SPL"), out, side), size)
    more = 0.3 if lead < 1.0 else 0.5
    depth = (more + _CORE * lead) / 2.0
    place = Place(nominal / 2.0 + more / 2.0 - depth, cycle.needed("SPL"), out, side)
    return _cut(cycle, place, Size(depth, long_inside if form == "C" else short_inside, radius, 30.0))


def position(cycle: Cycle) -> tuple[float, float]:
    """On which side of the part and of the shoulder: VARI 1 to 4, or 0 by the tool's tip quadrant.

    Raises ProgramError.
    """
    state = cycle.state
    chosen = cycle.whole("VARI", 0, 0, 4)
    if not state.modal.edge:
        text = f"{cycle.line.call} needs a tool with its offset."
        raise cycle.refused(61000, text, "Write T and D before it.")
    quadrant = state.edge.quadrant
    if quadrant not in _BY_POSITION and (not chosen or state.edge.nose_radius):
        text = f"the tip quadrant of the tool is {quadrant}, and an undercut is cut with 1 to 4."
        raise cycle.refused(WRONG_EDGE, text, "Enter the tip quadrant on the page of tool offsets (F8).")
    return _BY_POSITION[chosen or quadrant]


def profile(place: Place, size: Size) -> list[Element]:
    """From beyond the surface down the slope, along the bottom, and up the shoulder to beyond the surface."""
    slope = tan(radians(size.angle))
    begin = place.point(-RETRACT, size.width + RETRACT / slope)
    foot = place.point(size.depth, size.width - size.depth / slope)
    top = -RETRACT
    corner = 0.0
    if size.face:
        rise = size.face - size.radius * (1.0 - cos(_FACE_ANGLE))
        top = size.depth - size.radius * (1.0 + sin(_FACE_ANGLE)) - rise / tan(_FACE_ANGLE)
        corner = -(size.depth - top) * tan(_FACE_ANGLE)
    low = place.point(size.depth, corner)
    return [Line(begin, foot), Line(foot, low), Line(low, place.point(top, 0.0))]


def _cut(cycle: Cycle, place: Place, size: Size) -> Iterator[Block]:
    feed = cycle.state.modal.feed
    if feed is None:
        raise cycle.refused(NO_FEED, "no feedrate is programmed.", "Write F before it.")
    way = _of_tip(cycle, place, _rounded(profile(place, size), size.radius, _nose(cycle, size)))
    clear = place.radius + place.out * _CLEAR
    (x0, z0), (_, z1) = way[0].start, way[-1].end
    steps = [] if place.out * cycle.x >= place.out * clear else [Step(clear, cycle.z)]
    steps += [Step(clear, z0), Step(x0, z0, feed)]
    for each in way:
        centre, clockwise = (each.centre, each.clockwise) if isinstance(each, Arc) else (None, False)
        steps.append(Step(*each.end, feed, centre, clockwise))
    off = z1 + place.side * RETRACT  # not along the shoulder in rapid
    return cycle.blocks([*steps, Step(clear, off), Step(clear, z0)])


def _nose(cycle: Cycle, size: Size) -> float:
    """Nose radius of the tool, which must fit into the corners. Raises ProgramError."""
    nose = cycle.state.edge.nose_radius
    if nose > size.radius + _SAME:
        text = f"the nose radius {nose:g} is larger than the radius {size.radius:g} of this undercut."
        raise cycle.refused(NOSE_TOO_LARGE, text, "Take a tool with a smaller nose.")
    return nose


def _rounded(lines: list[Element], radius: float, nose: float) -> list[Element]:
    """Both corners with their radius; a nose of that radius makes it by itself."""
    if abs(nose - radius) <= _SAME:
        return lines
    slope, first, bottom = rounding(lines[0], lines[1], radius)
    bottom, second, shoulder = rounding(bottom, lines[2], radius)
    return [slope, first, bottom, second, shoulder]


def _of_tip(cycle: Cycle, place: Place, contour: list[Element]) -> list[Element]:
    """The way of the tip while the nose touches the contour. Raises ProgramError."""
    edge = cycle.state.edge
    if not edge.nose_radius:
        return contour
    left = left_of((0.0, -place.side))[0] * place.out
    offset = Offset(edge.nose_radius if left > 0.0 else -edge.nose_radius)
    try:
        centres = [piece.element for each in contour for piece in offset.add(each)]
        centres += [piece.element for piece in offset.close()]
    except GougeError as problem:
        text = f"the nose radius {edge.nose_radius:g} does not fit into this undercut: {problem.why}."
        raise cycle.refused(NOSE_TOO_LARGE, text, "Take a tool with a smaller nose.") from None
    z, x = TIP_DIRECTIONS[edge.quadrant]
    return [shifted(each, x * edge.nose_radius, z * edge.nose_radius) for each in centres]
