"""Undercuts with CYCLE94, 96 and 940: forms E and F (DIN 509), and thread undercuts A to D (DIN 76).

The sizes follow the standards, by diameter and by lead. The path is compensated for the nose radius, so that
the undercut has these sizes with any nose radius.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin, tan
from typing import NamedTuple

from core.geometry.chamfer_and_rounding import rounding
from core.geometry.contour_offset import GougeError, pieces_beside
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, left_of, shifted
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    MACHINING_TYPE,
    NO_FEED,
    RETRACT,
    Cycle,
    Step,
)
from core.interpreter.sinumerik.cycles.thread_cycle import COARSE_LEADS
from core.tool_edges import TIP_DIRECTIONS

TOO_SMALL = 61601
NOSE_TOO_LARGE = 61604
WRONG_EDGE = 61608
WRONG_FORM = 61609
_CLEAR = 2.0  # mm from the part; start and end of the cycle
_SAME = 1e-6  # mm
_BY_POSITION = {1: (-1.0, -1.0), 2: (-1.0, 1.0), 3: (1.0, 1.0), 4: (1.0, -1.0)}
"""By the tip quadrant: +1 outside, -1 inside; +1 where the shoulder lies towards minus Z."""


class Size(NamedTuple):
    """Dimensions of an undercut in mm and degrees.

    ``depth`` is measured below the surface, ``width`` from the shoulder, and ``radius`` is that of both
    corners. ``angle`` is the entry angle, and ``face`` is the depth in the shoulder (0 for none).
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

# By lead: diameter reduction for external threads, widths of A and B, radius, widths of C and D.
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
_LEADS = (
    0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7, 0.75, 0.8, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0,
    4.5, 5.0, 5.5, 6.0,
)  # fmt: skip
"""Leads of DIN 76 in the order in which _PITI counts them from 0."""

_CORE = 1.0825  # core diameter of an internal thread: nominal diameter minus this number of leads
_LARGEST_OF_ALL = 68


class Place(NamedTuple):
    """Position of an undercut.

    ``radius`` is the radius of the surface, ``shoulder`` is Z of the shoulder, and ``out`` and ``side`` are
    the signs of ``_BY_POSITION``.
    """

    radius: float
    shoulder: float
    out: float
    side: float

    def point(self, depth: float, way: float) -> Point:
        """Return X (radius) and Z of a point at this depth and this distance from the shoulder."""
        return self.radius - self.out * depth, self.shoulder + self.side * way


def shoulder_undercut(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE94. Raises ProgramError before the first block."""
    form = cycle.text("FORM")
    cycle.check(form in {"E", "F"}, "FORM", '{name} must be "E" or "F"', "Correct the value.", WRONG_FORM)
    size = _at_shoulder(cycle, form)
    out, side = position(cycle, cycle.whole("VARI", 0, 0, 4))
    place = Place(cycle.needed("SPD") / 2.0, cycle.needed("SPL"), out, side)
    return cycle.blocks(_cut(cycle, place, size, cycle.known_feed(cycle.state.modal.feed, NO_FEED), _CLEAR))


def _at_shoulder(cycle: Cycle, form: str) -> Size:
    """Return the size of form E or F (DIN 509) by the diameter SPD. Raises ProgramError."""
    diameter = cycle.over_zero("SPD", TOO_SMALL)
    if diameter <= 3.0:
        text = "{name} is {diameter}, but must be greater than 3 mm for an undercut"
        raise cycle.wrong("SPD", text, "Program the undercut block by block.", TOO_SMALL, diameter=diameter)
    sizes = next((row[1:] for row in _DIN_509 if diameter <= row[0]), _DIN_509_OVER)
    depth, width, radius, face = sizes
    return Size(depth, width, radius, 15.0, face if form == "F" else 0.0)


def thread_undercut(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE96. Raises ProgramError before the first block."""
    form = cycle.text("FORM")
    if form not in {"A", "B", "C", "D"}:
        raise cycle.wrong("FORM", '{name} must be "A", "B", "C" or "D"', "Correct the value.", WRONG_FORM)
    nominal = cycle.over_zero("DIATH", TOO_SMALL)
    lead = COARSE_LEADS.get(round(nominal), 0.0) if abs(nominal - round(nominal)) < _SAME else 0.0
    text = "{name} is {nominal}, which is not a coarse thread size from M3 to M{largest_of_all}"
    hint = "Program the undercut block by block."
    cycle.check(lead, "DIATH", text, hint, TOO_SMALL, nominal=nominal, largest_of_all=_LARGEST_OF_ALL)
    lacks, long, short, radius, long_inside, short_inside = _DIN_76[lead]
    out, side = position(cycle, cycle.whole("VARI", 0, 0, 4))
    inside = form in {"C", "D"}
    if inside is (out > 0.0):
        template = (
            "{name} {form} is for inside undercuts, but the cutting edge of the tool is for outside undercuts"
            if inside
            else "{name} {form} is for outside undercuts, but the cutting edge of the tool is for inside "
            "undercuts"
        )
        raise cycle.wrong("FORM", template, "Correct FORM, or use another tool.", WRONG_EDGE, form=form)
    feed = cycle.known_feed(cycle.state.modal.feed, NO_FEED)
    if not inside:
        size = Size(lacks / 2.0, long if form == "A" else short, radius, 30.0)
        place = Place(nominal / 2.0, cycle.needed("SPL"), out, side)
        return cycle.blocks(_cut(cycle, place, size, feed, _CLEAR))
    more = 0.3 if lead < 1.0 else 0.5
    depth = (more + _CORE * lead) / 2.0
    place = Place(nominal / 2.0 + more / 2.0 - depth, cycle.needed("SPL"), out, side)
    size = Size(depth, long_inside if form == "C" else short_inside, radius, 30.0)
    return cycle.blocks(_cut(cycle, place, size, feed, _CLEAR))


_OF_PLACE = {0: 4, 1: 3, 2: 1, 3: 2}
"""Tip quadrants by _LAGE: 0 and 1 outside, 2 and 3 inside; 0 and 2 with the shoulder towards plus Z."""

_NOT_BUILT = "program the undercut block by block"


def undercut(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE940: E and F in one pass, A and B in passes of _MID.

    The first seven parameters and the order of all parameters follow the manufacturer's programming manual.
    Raises ProgramError before the first block.
    """
    form = cycle.text("FORM")
    text = "{name} is {form}, which is not supported"
    hint = (
        'Write form "A", "B", "E" or "F". For forms C and D, use CYCLE96. Program a free form (T) block by '
        "block."
    )
    cycle.check(form in {"A", "B", "E", "F"}, "FORM", text, hint, WRONG_FORM, form=form or "missing")
    for name in ("_EPD", "_EPL", "_R1", "_R2", "_STA", "_VRT"):
        cycle.zero_only(name, _NOT_BUILT)
    out, side = position(cycle, _OF_PLACE[cycle.whole("_LAGE", 0, 0, 3)])
    size = _at_shoulder(cycle, form) if form in {"E", "F"} else _behind_thread(cycle, form)
    place = Place(cycle.over_zero("SPD", TOO_SMALL) / 2.0, cycle.needed("SPL"), out, side)
    clear, feed = cycle.size("_SDIS") or _CLEAR, cycle.known_feed(cycle.feed("_FFP"), NO_FEED)
    if form in {"E", "F"}:
        return cycle.blocks(_cut(cycle, place, size, feed, clear))
    return cycle.blocks(_in_passes(cycle, place, size, feed, clear))


def _behind_thread(cycle: Cycle, form: str) -> Size:
    """Return the size of form A or B (DIN 76) by _PITI, or by the coarse thread of SPD.

    Raises ProgramError if no undercut is defined for the lead.
    """
    if cycle.given("_PITI"):
        lead = _LEADS[cycle.whole("_PITI", 0, 0, len(_LEADS) - 1)]
    else:
        lead = COARSE_LEADS.get(round(cycle.needed("SPD")), 0.0)
    text = "{name} specifies a lead of {lead}, but no undercut is defined for that lead"
    cycle.check(lead in _DIN_76, "_PITI", text, "Program the undercut block by block.", TOO_SMALL, lead=lead)
    lacks, long, short, radius, *_ = _DIN_76[lead]
    return Size(lacks / 2.0, long if form == "A" else short, radius, 30.0)


def _in_passes(cycle: Cycle, place: Place, size: Size, feed: float, clear: float) -> list[Step]:
    """Return the steps of _VARI 1 (roughing), 2 (finishing) or 3 (both).

    Roughing passes have depths of at most _MID and leave the allowances _FALX and _FALZ.
    """
    kind = cycle.whole("_VARI", 3, 1, 13)
    hint = "Enter 1 for roughing, 2 for finishing or 3 for both."
    cycle.check(kind % 10 in {1, 2, 3}, "_VARI", "{name} cannot be {value}", hint, MACHINING_TYPE, value=kind)
    left = cycle.size("_FAL")
    up, off = max(left, cycle.size("_FALX")), max(left, cycle.size("_FALZ"))
    infeed = cycle.size("_MID") or size.depth
    steps: list[Step] = []
    if kind % 10 != _FINISHES:
        text = "{name} would need {count} passes, which is too many"
        count = max(cycle.pass_count(size.depth - up, infeed, "_MID", text), 1)
        for k in range(1, count + 1):
            above = up + (size.depth - up) * (count - k) / count
            moved = place._replace(radius=place.radius + place.out * above, shoulder=place.shoulder
                                   + place.side * off)  # fmt: skip
            steps += _cut(cycle, moved, size, feed, clear)
    return steps if kind % 10 == _ROUGHS else steps + _cut(cycle, place, size, feed, clear)


_ROUGHS, _FINISHES = 1, 2


def position(cycle: Cycle, chosen: int) -> tuple[float, float]:
    """Return the signs of the sides of part and shoulder, by ``chosen`` (1 to 4) or by the tip quadrant (0).

    Raises ProgramError without an active tool or a valid quadrant.
    """
    state = cycle.state
    text = "{call} needs an active tool with an offset."
    cycle.require(state.modal.edge, 61000, text, "Write T and D before this block.")
    quadrant = state.edge.quadrant
    if quadrant not in _BY_POSITION and (not chosen or state.edge.nose_radius):
        text = "the tip quadrant of the tool is {quadrant}, but an undercut needs a quadrant from 1 to 4."
        hint = "Enter the tip quadrant on the TOOL OFFSETS page (F8)."
        raise cycle.refused(WRONG_EDGE, text, hint, quadrant=quadrant)
    return _BY_POSITION[chosen or quadrant]


def profile(place: Place, size: Size) -> list[Element]:
    """Return the profile: down the slope from outside, along the bottom, and up the shoulder to outside."""
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


def _cut(cycle: Cycle, place: Place, size: Size, feed: float, beside: float) -> list[Step]:
    """Return the steps of one pass along the profile.

    ``beside`` is the distance of its start from the surface, in mm.
    """
    way = _of_tip(cycle, place, _rounded(profile(place, size), size.radius, _nose(cycle, size)))
    clear = place.radius + place.out * beside
    (x0, z0), (_, z1) = way[0].start, way[-1].end
    steps = [*cycle.off_part(clear, place.out), Step(clear, z0), Step(x0, z0, feed)]
    for each in way:
        centre, clockwise = (each.centre, each.clockwise) if isinstance(each, Arc) else (None, False)
        steps.append(Step(*each.end, feed, centre, clockwise))
    off = z1 + place.side * RETRACT  # The retract must not move along the shoulder in rapid.
    return [*steps, Step(clear, off), Step(clear, z0)]


def _nose(cycle: Cycle, size: Size) -> float:
    """Return the nose radius of the tool. Raises ProgramError if it does not fit into the corners."""
    nose = cycle.state.edge.nose_radius
    text = "the nose radius {nose} is larger than the radius {radius} of this undercut."
    hint = "Use a tool with a smaller nose radius."
    cycle.require(nose <= size.radius + _SAME, NOSE_TOO_LARGE, text, hint, nose=nose, radius=size.radius)
    return nose


def _rounded(lines: list[Element], radius: float, nose: float) -> list[Element]:
    """Return the profile with rounded corners; a nose with the corner radius rounds them without arcs."""
    if abs(nose - radius) <= _SAME:
        return lines
    slope, first, bottom = rounding(lines[0], lines[1], radius)
    bottom, second, shoulder = rounding(bottom, lines[2], radius)
    return [slope, first, bottom, second, shoulder]


def _of_tip(cycle: Cycle, place: Place, contour: list[Element]) -> list[Element]:
    """Return the path of the tip while the nose touches the contour. Raises ProgramError."""
    edge = cycle.state.edge
    if not edge.nose_radius:
        return contour
    left = left_of((0.0, -place.side))[0] * place.out
    try:
        beside = pieces_beside(contour, edge.nose_radius if left > 0.0 else -edge.nose_radius)
    except GougeError as problem:
        text = "the nose radius {nose_radius} does not fit into this undercut: {why}."
        hint = "Use a tool with a smaller nose radius."
        raise cycle.refused(
            NOSE_TOO_LARGE, text, hint, nose_radius=edge.nose_radius, why=problem.why
        ) from None
    z, x = TIP_DIRECTIONS[edge.quadrant]
    return [shifted(each.element, x * edge.nose_radius, z * edge.nose_radius) for each in beside]
