"""Undercuts with CYCLE94, 96 and 940: forms E and F (DIN 509), and thread undercuts A to D (DIN 76).

The sizes follow the standards and depend on the diameter or on the lead. The path is compensated for the
nose radius, so that the undercut has these sizes with any nose radius.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin, tan
from typing import NamedTuple

from core.geometry.chamfer_and_rounding import make_rounding
from core.geometry.contour_offset import GougeError, offset_known_contour
from core.geometry.lines_and_arcs import Arc, Element, Line, Point, get_left_normal, shift_element
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    DEFAULT_RETRACT_MM,
    NO_FEED,
    WRONG_MACHINING_TYPE,
    CycleCall,
    CycleStep,
)
from core.interpreter.sinumerik.cycles.thread_cycle import COARSE_THREAD_LEADS_MM
from core.tool_edges import TIP_DIRECTIONS

DIAMETER_TOO_SMALL = 61601
NOSE_RADIUS_TOO_LARGE = 61604
WRONG_EDGE_POSITION = 61608
WRONG_UNDERCUT_FORM = 61609
_CLEARANCE_MM = 2.0  # mm from the part; start and end of the cycle
_SAME = 1e-6  # mm
_SIGNS_BY_POSITION = {1: (-1.0, -1.0), 2: (-1.0, 1.0), 3: (1.0, 1.0), 4: (1.0, -1.0)}
"""Signs of X away from the part and of Z away from the shoulder, by position number or tip quadrant."""


class UndercutSize(NamedTuple):
    """The dimensions of an undercut in mm and degrees.

    ``depth`` is measured from the surface, and ``width`` is measured from the shoulder. ``corner_radius``
    is the radius of both corners. ``entry_angle_deg`` is the entry angle. ``face_depth`` is the depth of
    the undercut in the shoulder, or 0 if the shoulder is not undercut.
    """

    depth: float
    width: float
    corner_radius: float
    entry_angle_deg: float
    face_depth: float = 0.0


_DIN_509 = ((10.0, 0.2, 2.0, 0.4, 0.1), (18.0, 0.2, 2.0, 0.6, 0.1), (80.0, 0.3, 2.5, 0.6, 0.2))
_DIN_509_OVER = (0.4, 4.0, 1.0, 0.3)
"""Depth, width, radius and face depth in mm for diameters above 80 mm (DIN 509)."""

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
"""Thread leads in mm from DIN 76, indexed by _PITI from 0."""

_CORE = 1.0825  # core diameter of an internal thread: nominal diameter minus this number of leads
_MAX_NOMINAL_SIZE = 68


class UndercutPosition(NamedTuple):
    """The position of an undercut.

    ``surface_radius`` is the radius of the surface, and ``shoulder_z`` is Z of the shoulder.
    ``outward_sign`` is the sign of X away from the part, and ``side_sign`` is the sign of Z away from the
    shoulder.
    """

    surface_radius: float
    shoulder_z: float
    outward_sign: float
    side_sign: float

    def compute_point(self, depth: float, distance: float) -> Point:
        """Return X (radius) and Z of a point at this depth and this distance from the shoulder."""
        return self.surface_radius - self.outward_sign * depth, self.shoulder_z + self.side_sign * distance


def run_shoulder_undercut(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE94. Raises ProgramError before the first block if a value is invalid."""
    form = cycle.read_string("FORM")
    cycle.check_parameter(
        form in {"E", "F"}, "FORM", '{name} must be "E" or "F"', "Correct the value.", WRONG_UNDERCUT_FORM
    )
    size = _shoulder_size(cycle, form)
    out, side = read_direction_signs(cycle, cycle.read_whole_number("VARI", 0, 0, 4))
    place = UndercutPosition(
        cycle.read_required_length_mm("SPD") / 2.0, cycle.read_required_length_mm("SPL"), out, side
    )
    return cycle.make_blocks(
        _cut(cycle, place, size, cycle.require_feed(cycle.state.modal.feed, NO_FEED), _CLEARANCE_MM)
    )


def _shoulder_size(cycle: CycleCall, form: str) -> UndercutSize:
    """Return the size of form E or F (DIN 509) for the diameter SPD.

    Raises ProgramError for an invalid diameter.
    """
    diameter = cycle.read_positive_length_mm("SPD", DIAMETER_TOO_SMALL)
    if diameter <= 3.0:
        text = "{name} is {diameter}, but must be greater than 3 mm for an undercut"
        raise cycle.make_parameter_error(
            "SPD", text, "Program the undercut block by block.", DIAMETER_TOO_SMALL, diameter=diameter
        )
    sizes = next((row[1:] for row in _DIN_509 if diameter <= row[0]), _DIN_509_OVER)
    depth, width, radius, face = sizes
    return UndercutSize(depth, width, radius, 15.0, face if form == "F" else 0.0)


def run_thread_undercut(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE96. Raises ProgramError before the first block if a value is invalid."""
    form = cycle.read_string("FORM")
    if form not in {"A", "B", "C", "D"}:
        raise cycle.make_parameter_error(
            "FORM", '{name} must be "A", "B", "C" or "D"', "Correct the value.", WRONG_UNDERCUT_FORM
        )
    nominal = cycle.read_positive_length_mm("DIATH", DIAMETER_TOO_SMALL)
    lead = COARSE_THREAD_LEADS_MM.get(round(nominal), 0.0) if abs(nominal - round(nominal)) < _SAME else 0.0
    text = "{name} is {nominal}, which is not a coarse thread size from M3 to M{largest_of_all}"
    hint = "Program the undercut block by block."
    cycle.check_parameter(
        lead, "DIATH", text, hint, DIAMETER_TOO_SMALL, nominal=nominal, largest_of_all=_MAX_NOMINAL_SIZE
    )
    lacks, long, short, radius, long_inside, short_inside = _DIN_76[lead]
    out, side = read_direction_signs(cycle, cycle.read_whole_number("VARI", 0, 0, 4))
    inside = form in {"C", "D"}
    if inside is (out > 0.0):
        template = (
            "{name} {form} is for inside undercuts, but the cutting edge of the tool is for outside undercuts"
            if inside
            else "{name} {form} is for outside undercuts, but the cutting edge of the tool is for inside "
            "undercuts"
        )
        raise cycle.make_parameter_error(
            "FORM", template, "Correct FORM, or use another tool.", WRONG_EDGE_POSITION, form=form
        )
    feed = cycle.require_feed(cycle.state.modal.feed, NO_FEED)
    if not inside:
        size = UndercutSize(lacks / 2.0, long if form == "A" else short, radius, 30.0)
        place = UndercutPosition(nominal / 2.0, cycle.read_required_length_mm("SPL"), out, side)
        return cycle.make_blocks(_cut(cycle, place, size, feed, _CLEARANCE_MM))
    more = 0.3 if lead < 1.0 else 0.5
    depth = (more + _CORE * lead) / 2.0
    place = UndercutPosition(
        nominal / 2.0 + more / 2.0 - depth, cycle.read_required_length_mm("SPL"), out, side
    )
    size = UndercutSize(depth, long_inside if form == "C" else short_inside, radius, 30.0)
    return cycle.make_blocks(_cut(cycle, place, size, feed, _CLEARANCE_MM))


_QUADRANTS_BY_POSITION = {0: 4, 1: 3, 2: 1, 3: 2}
"""Tip quadrants by _LAGE.

Values 0 and 1 are outside, and 2 and 3 are inside. At 0 and 2, the shoulder is toward plus Z.
"""

_UNSUPPORTED_HINT = "program the undercut block by block"


def run_undercut(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE940, which cuts an undercut.

    Forms E and F are cut in one pass. Forms A and B are roughed in passes of at most _MID, finished, or
    both, as _VARI specifies. The first seven parameters and the order of all parameters follow the
    manufacturer's programming manual. Raises ProgramError before the first block if a value is invalid.
    """
    form = cycle.read_string("FORM")
    text = "{name} is {form}, which is not supported"
    hint = (
        'Write form "A", "B", "E" or "F". For forms C and D, use CYCLE96. Program a free form (T) block by '
        "block."
    )
    cycle.check_parameter(
        form in {"A", "B", "E", "F"}, "FORM", text, hint, WRONG_UNDERCUT_FORM, form=form or "missing"
    )
    for name in ("_EPD", "_EPL", "_R1", "_R2", "_STA", "_VRT"):
        cycle.check_unsupported_parameter(name, _UNSUPPORTED_HINT)
    out, side = read_direction_signs(cycle, _QUADRANTS_BY_POSITION[cycle.read_whole_number("_LAGE", 0, 0, 3)])
    size = _shoulder_size(cycle, form) if form in {"E", "F"} else _thread_size(cycle, form)
    place = UndercutPosition(
        cycle.read_positive_length_mm("SPD", DIAMETER_TOO_SMALL) / 2.0,
        cycle.read_required_length_mm("SPL"),
        out,
        side,
    )
    clear, feed = (
        cycle.read_unsigned_length_mm("_SDIS") or _CLEARANCE_MM,
        cycle.require_feed(cycle.read_feed("_FFP"), NO_FEED),
    )
    if form in {"E", "F"}:
        return cycle.make_blocks(_cut(cycle, place, size, feed, clear))
    return cycle.make_blocks(_in_passes(cycle, place, size, feed, clear))


def _thread_size(cycle: CycleCall, form: str) -> UndercutSize:
    """Return the size of form A or B (DIN 76) for _PITI, or for the coarse thread of SPD.

    Raises ProgramError if no undercut is defined for the lead.
    """
    if cycle.has_argument("_PITI"):
        lead = _LEADS[cycle.read_whole_number("_PITI", 0, 0, len(_LEADS) - 1)]
    else:
        lead = COARSE_THREAD_LEADS_MM.get(round(cycle.read_required_length_mm("SPD")), 0.0)
    text = "{name} specifies a lead of {lead}, but no undercut is defined for that lead"
    cycle.check_parameter(
        lead in _DIN_76, "_PITI", text, "Program the undercut block by block.", DIAMETER_TOO_SMALL, lead=lead
    )
    lacks, long, short, radius, *_ = _DIN_76[lead]
    return UndercutSize(lacks / 2.0, long if form == "A" else short, radius, 30.0)


def _in_passes(
    cycle: CycleCall, undercut_position: UndercutPosition, size: UndercutSize, feed: float, clearance: float
) -> list[CycleStep]:
    """Return the steps that rough (_VARI 1), finish (2) or rough and finish (3) an undercut.

    Roughing passes have depths of at most _MID and leave the allowances _FALX and _FALZ.
    """
    kind = cycle.read_whole_number("_VARI", 3, 1, 13)
    hint = "Enter 1 for roughing, 2 for finishing or 3 for both."
    cycle.check_parameter(
        kind % 10 in {1, 2, 3}, "_VARI", "{name} cannot be {value}", hint, WRONG_MACHINING_TYPE, value=kind
    )
    left = cycle.read_unsigned_length_mm("_FAL")
    up, off = (
        max(left, cycle.read_unsigned_length_mm("_FALX")),
        max(left, cycle.read_unsigned_length_mm("_FALZ")),
    )
    infeed = cycle.read_unsigned_length_mm("_MID") or size.depth
    steps: list[CycleStep] = []
    if kind % 10 != _FINISHES:
        text = "{name} would need {count} passes, which is too many"
        count = max(cycle.compute_pass_count(size.depth - up, infeed, "_MID", text), 1)
        for k in range(1, count + 1):
            above = up + (size.depth - up) * (count - k) / count
            moved = undercut_position._replace(
                surface_radius=undercut_position.surface_radius + undercut_position.outward_sign * above,
                shoulder_z=undercut_position.shoulder_z + undercut_position.side_sign * off,
            )
            steps += _cut(cycle, moved, size, feed, clearance)
    return steps if kind % 10 == _ROUGHS else steps + _cut(cycle, undercut_position, size, feed, clearance)


_ROUGHS, _FINISHES = 1, 2


def read_direction_signs(cycle: CycleCall, position_number: int) -> tuple[float, float]:
    """Return the sign of X away from the part, and the sign of Z away from the shoulder.

    A ``position_number`` from 1 to 4 determines the signs. If it is 0, the tip quadrant determines them.

    - Raises ProgramError if no tool with an offset is active.
    - Raises ProgramError if the tip quadrant is not from 1 to 4. The tip quadrant is not needed, however,
      if ``position_number`` determines the signs and the nose radius is 0.
    """
    state = cycle.state
    text = "{call} needs an active tool with an offset."
    cycle.require_condition(state.modal.edge, 61000, text, "Write T and D before this block.")
    quadrant = state.edge.quadrant
    if quadrant not in _SIGNS_BY_POSITION and (not position_number or state.edge.nose_radius):
        text = "the tip quadrant of the tool is {quadrant}, but an undercut needs a quadrant from 1 to 4."
        hint = "Enter the tip quadrant on the TOOL OFFSETS page (F8)."
        raise cycle.make_call_error(WRONG_EDGE_POSITION, text, hint, quadrant=quadrant)
    return _SIGNS_BY_POSITION[position_number or quadrant]


def make_undercut_profile(undercut_position: UndercutPosition, size: UndercutSize) -> list[Element]:
    """Return the profile of an undercut: entry slope, bottom, and shoulder from the bottom outward."""
    slope = tan(radians(size.entry_angle_deg))
    begin = undercut_position.compute_point(-DEFAULT_RETRACT_MM, size.width + DEFAULT_RETRACT_MM / slope)
    foot = undercut_position.compute_point(size.depth, size.width - size.depth / slope)
    top = -DEFAULT_RETRACT_MM
    corner = 0.0
    if size.face_depth:
        rise = size.face_depth - size.corner_radius * (1.0 - cos(_FACE_ANGLE))
        top = size.depth - size.corner_radius * (1.0 + sin(_FACE_ANGLE)) - rise / tan(_FACE_ANGLE)
        corner = -(size.depth - top) * tan(_FACE_ANGLE)
    low = undercut_position.compute_point(size.depth, corner)
    return [Line(begin, foot), Line(foot, low), Line(low, undercut_position.compute_point(top, 0.0))]


def _cut(
    cycle: CycleCall, undercut_position: UndercutPosition, size: UndercutSize, feed: float, clearance: float
) -> list[CycleStep]:
    """Return the steps of one pass along the profile.

    ``clearance`` is the distance of the start point from the surface, in mm.
    """
    tip_path = _tip_path(
        cycle,
        undercut_position,
        _round_corners(
            make_undercut_profile(undercut_position, size), size.corner_radius, _nose(cycle, size)
        ),
    )
    clear = undercut_position.surface_radius + undercut_position.outward_sign * clearance
    (x0, z0), (_, z1) = tip_path[0].start, tip_path[-1].end
    steps = [
        *cycle.make_clearance_steps(clear, undercut_position.outward_sign),
        CycleStep(clear, z0),
        CycleStep(x0, z0, feed),
    ]
    for each in tip_path:
        centre, clockwise = (each.center, each.clockwise) if isinstance(each, Arc) else (None, False)
        steps.append(CycleStep(*each.end, feed, centre, clockwise))
    off = (
        z1 + undercut_position.side_sign * DEFAULT_RETRACT_MM
    )  # The retract must not move along the shoulder in rapid.
    return [*steps, CycleStep(clear, off), CycleStep(clear, z0)]


def _nose(cycle: CycleCall, size: UndercutSize) -> float:
    """Return the nose radius of the tool in mm.

    Raises ProgramError if the nose does not fit into the corners.
    """
    nose = cycle.state.edge.nose_radius
    text = "the nose radius {nose} is larger than the radius {radius} of this undercut."
    hint = "Use a tool with a smaller nose radius."
    cycle.require_condition(
        nose <= size.corner_radius + _SAME,
        NOSE_RADIUS_TOO_LARGE,
        text,
        hint,
        nose=nose,
        radius=size.corner_radius,
    )
    return nose


def _round_corners(lines: list[Element], radius: float, nose: float) -> list[Element]:
    """Return the profile with rounded corners.

    If the nose radius equals the corner radius, the profile needs no arcs.
    """
    if abs(nose - radius) <= _SAME:
        return lines
    slope, first, bottom = make_rounding(lines[0], lines[1], radius)
    bottom, second, shoulder = make_rounding(bottom, lines[2], radius)
    return [slope, first, bottom, second, shoulder]


def _tip_path(cycle: CycleCall, undercut_position: UndercutPosition, contour: list[Element]) -> list[Element]:
    """Return the path of the tip while the nose touches the contour.

    Raises ProgramError if the path is not possible.
    """
    edge = cycle.state.edge
    if not edge.nose_radius:
        return contour
    left = get_left_normal((0.0, -undercut_position.side_sign))[0] * undercut_position.outward_sign
    try:
        offset_pieces = offset_known_contour(contour, edge.nose_radius if left > 0.0 else -edge.nose_radius)
    except GougeError as problem:
        text = "the nose radius {nose_radius} does not fit into this undercut: {why}."
        hint = "Use a tool with a smaller nose radius."
        raise cycle.make_call_error(
            NOSE_RADIUS_TOO_LARGE, text, hint, nose_radius=edge.nose_radius, why=problem.reason
        ) from None
    z, x = TIP_DIRECTIONS[edge.quadrant]
    return [shift_element(each.element, x * edge.nose_radius, z * edge.nose_radius) for each in offset_pieces]
