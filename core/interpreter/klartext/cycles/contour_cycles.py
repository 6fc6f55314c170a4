"""SL cycles for pockets and islands with closed contours (20 to 24) and for open contours (25).

As specified in the manual, the cycles clear every point of the pocket that the tool can reach. They do not
cut outside the pocket or inside an island. The tool path is TurnDesk's own: rings from the inside out, and
a ramp of 3 degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

from core.geometry.clearing_rings import ClearingRing, make_clearing_rings
from core.geometry.contour_offset import GougeError, offset_known_contour
from core.geometry.lines_and_arcs import SAME_POINT_TOLERANCE_MM, Arc, Element, Point, get_left_normal
from core.geometry.pocket_area import (
    AreaChecker,
    ElementLoop,
    PocketAreaError,
    close_loop,
    make_inset_loops,
    move_loop_start_to,
    split_loop,
)
from core.interpreter.klartext.cycles.cycle_moves import CycleTool
from core.interpreter.klartext.cycles.hole_cycles import MIN_LENGTH_MM, compute_z_levels
from core.interpreter.klartext.cycles.sl_contours import MAX_CLOSING_GAP_MM, SlContour, find_area_boundary
from core.interpreter.klartext.klartext_state import State
from core.interpreter.shared.elementary_blocks import Block
from core.language.diagnostics import ProgramError
from core.language.klartext.q_parameters import MAX_FEED_VALUE

_RAMP = math.tan(math.radians(3.0))
_MAX_OVERLAP = 2.0
_MAX_RAMP_ROUNDS = 1000.0  # maximum number of rounds of a ramp along a ring
_CLEARANCE_MM = 2.0  # mm above the surface; cycle 25 has no Q6 and continues at Q11 from there
_MAX_TRIES = 6  # number of times that the arc to a wall is halved until it fits

ContourSequence = Sequence[SlContour]


class ClearingData:
    """The data of cycle 20 (Q1 to Q9), the feeds of the active cycle, and the area to be cleared."""

    def __init__(
        self, tool: CycleTool, area: Sequence[ElementLoop] = (), clearance_mm: float | None = None
    ) -> None:
        self.tool, self.area = tool, area
        depth = tool.read_length_mm(1)
        text = "Depth Q1={depth} mm is positive (upward)."
        tool.check_condition(depth <= 0.0, text, "Enter the depth with a minus sign.", depth=f"{depth:+.10g}")
        self.surface_z_mm = tool.read_length_mm(5, 0.0)
        self.bottom_z_mm = self.surface_z_mm + depth
        self.clearance_z_mm = self.surface_z_mm + (
            tool.read_length_mm(6) if clearance_mm is None else clearance_mm
        )
        self.safe_z_mm = max(tool.read_length_mm(7), self.clearance_z_mm)
        self.side_allowance_mm, self.floor_allowance_mm = (
            tool.read_length_mm(3, 0.0),
            tool.read_length_mm(4, 0.0),
        )
        if tool.radius_mm <= MIN_LENGTH_MM:
            raise tool.make_error(
                "The tool radius is not defined.", "Enter the tool radius R in the tool table."
            )

    @property
    def is_up_cut(self) -> bool:
        """Return whether pockets are milled clockwise: Q9=-1 (up-cut) with M3, or Q9=+1 with M4."""
        return (self.tool.read_choice(9, (-1, 0, 1), 1.0) < 0) != (self.tool.running_rpm < 0.0)

    @property
    def stepover_mm(self) -> float:
        """Return the distance between rings in mm, which is Q2 times the tool radius.

        The distance is at most the tool radius, so that no material remains. Raises ProgramError for an
        invalid Q2.
        """
        overlap = self.tool.read_parameter(2, 1.0)
        text = "With path overlap {named}={overlap}, the cycle cannot clear the area."
        hint = "Enter a value between 0.0001 and 1.9999."
        self.tool.check_condition(
            0.0 < overlap < _MAX_OVERLAP,
            text,
            hint,
            named=self.tool.format_parameter_name(2),
            overlap=overlap,
        )
        return min(overlap, 1.0) * self.tool.radius_mm

    def compute_z_levels(self, bottom_z_mm: float) -> list[float]:
        """Return the Z heights of all infeeds in mm, from the top to the bottom of the pocket."""
        return compute_z_levels(
            self.tool, self.surface_z_mm, bottom_z_mm, lambda: abs(self.tool.read_length_mm(10))
        )

    def plan_level_rings(self, tool_radius_mm: float) -> list[ClearingRing]:
        """Return the rings that clear one level with a tool of this radius in mm."""
        share = self.stepover_mm / self.tool.radius_mm * tool_radius_mm
        here = self.tool.xy_position
        try:
            return make_clearing_rings(
                self.area,
                tool_radius_mm + self.side_allowance_mm,
                share,
                tool_radius_mm,
                is_conventional=self.is_up_cut,
                position=here,
            )
        except PocketAreaError as problem:
            raise self.make_fit_error(problem) from None

    def make_fit_error(self, problem: PocketAreaError | GougeError) -> ProgramError:
        """Return the error for a contour that cannot be milled with this tool radius."""
        text = "The contour cannot be milled with tool radius {radius} mm plus the allowance: {problem}."
        hint, radius = "Use a smaller tool, or correct the contour.", f"{self.tool.radius_mm:.10g}"
        return self.tool.make_error(text, hint, radius=radius, problem=problem)

    def move_to_safe_z(self) -> Iterator[Block]:
        """Yield a rapid up to the clearance height."""
        yield self.tool.move_to_z(max(self.safe_z_mm, self.tool.z_position))

    def retract_tool(self) -> Iterator[Block]:
        """Yield the retract to the clearance height at the feed Q208."""
        tool = self.tool
        asked = tool.read_parameter(208, MAX_FEED_VALUE)
        back = (
            None if asked >= MAX_FEED_VALUE else tool.read_feed(208) if asked else tool.read_cutting_feed(12)
        )
        if back is not None and tool.z_position < self.clearance_z_mm:
            yield tool.move_to_z(self.clearance_z_mm, back)
        yield tool.move_to_z(self.safe_z_mm)


def check_contour_data(tool: CycleTool) -> None:
    """Check the data of cycle 20, which are stored in Q1 to Q9.

    Raises ProgramError if the data are invalid.
    """
    tool.check_condition(
        tool.read_length_mm(1) <= 0.0, "Depth Q1 is positive (upward).", "Enter the depth with a minus sign."
    )
    text = "With the programmed path overlap Q2, the cycle cannot clear the area."
    tool.check_condition(
        0.0 < tool.read_parameter(2, 1.0) < _MAX_OVERLAP, text, "Set Q2 to a value between 0.0001 and 1.9999."
    )


# --- clearing -------------------------------------------------------------------------------------------


def run_pilot_drilling(tool: CycleTool, area: Sequence[ElementLoop]) -> Iterator[Block]:
    """Yield the blocks of cycle 21.

    The cycle drills a hole at each position where cycle 22 plunges with tool Q13.
    """
    clearing = ClearingData(tool, area)
    radius = tool.find_radius_mm(tool.read_whole_number(13))
    if radius is None or radius <= MIN_LENGTH_MM:
        text = "Rough-out tool {plain} (Q13) has no radius in the tool table."
        raise tool.make_error(
            text, "Set Q13 to the number of a measured tool.", plain=tool.read_parameter(13)
        )
    feed, bottom = clearing.tool.read_cutting_feed(11), clearing.bottom_z_mm + clearing.floor_allowance_mm
    yield from clearing.move_to_safe_z()
    for cut in clearing.plan_level_rings(radius):
        if cut.moves_at_depth:
            continue
        yield tool.move_straight(cut.ramp_loop[0].start)
        yield tool.move_to_z(clearing.clearance_z_mm)
        for z in clearing.compute_z_levels(bottom):
            yield tool.move_to_z(z, feed)
            yield tool.move_to_z(clearing.clearance_z_mm)
        yield tool.move_to_z(clearing.safe_z_mm)


def run_roughing(tool: CycleTool, area: Sequence[ElementLoop]) -> Iterator[Block]:
    """Yield the blocks of cycle 22, which clears the area level by level.

    The allowances of cycle 20 remain as stock. Q401 reduces the feed in full-width cuts.
    """
    clearing = ClearingData(tool, area)
    if tool.read_parameter(18, 0.0):
        tool.log_note(
            "the whole pocket is milled again, including the area that the coarse roughing tool "
            "(Q18) has cleared."
        )
    feed = clearing.tool.read_cutting_feed(12)
    slow = feed * min(max(tool.read_parameter(401, 100.0), 1.0), 100.0) / 100.0
    plan = clearing.plan_level_rings(tool.radius_mm)
    yield from clearing.move_to_safe_z()
    top = clearing.surface_z_mm
    for z in clearing.compute_z_levels(clearing.bottom_z_mm + clearing.floor_allowance_mm):
        for cut in plan:
            yield from _move_to_depth(clearing, cut, top, z, slow)
            yield from _along(tool, cut.loop, feed if cut.moves_at_depth else slow)
        top = z
    yield from clearing.retract_tool()


def _move_to_depth(
    clearing: ClearingData, cut: ClearingRing, top: float, z: float, reduced_feed: float
) -> Iterator[Block]:
    """Yield the moves to the start of a ring at the depth ``z``, including a plunge if necessary."""
    tool = clearing.tool
    if not cut.moves_at_depth:
        yield from tool.move_above_position(cut.ramp_loop[0].start, clearing.clearance_z_mm)
        yield from _ramp(clearing, cut, top, z, reduced_feed)
    elif math.dist(tool.xy_position, cut.loop[0].start) > SAME_POINT_TOLERANCE_MM:
        yield tool.move_straight(cut.loop[0].start, None, reduced_feed)


def _ramp(
    clearing: ClearingData, cut: ClearingRing, top: float, z: float, reduced_feed: float
) -> Iterator[Block]:
    """Yield the plunge to the depth ``z``.

    If the plunge angle Q19 is 0, the tool plunges straight down at the feed Q11. Otherwise, it ramps down
    along the ring at the angle Q19.
    """
    tool = clearing.tool
    yield tool.move_to_z(top, clearing.tool.read_cutting_feed(11))
    if not tool.read_parameter(19, 0.0):
        yield tool.move_to_z(z, clearing.tool.read_cutting_feed(11))
    else:
        feed, length, ring = (
            clearing.tool.read_cutting_feed(19),
            (top - z) / _RAMP,
            sum(element.length for element in cut.ramp_loop),
        )
        text = "There is not enough room to plunge along a ramp."
        tool.check_condition(
            length <= _MAX_RAMP_ROUNDS * ring, text, "Use a center-cutting tool and plunge vertically."
        )
        ramp_elements, rest = split_loop(cut.ramp_loop, length)
        done = 0.0
        for element in ramp_elements:
            done += element.length
            yield _element(tool, element, top + (z - top) * min(done / length, 1.0), feed)
        yield from _along(
            tool, split_loop(rest, math.ceil(length / ring - 1e-9) * ring - length)[0], reduced_feed
        )
    if math.dist(tool.xy_position, cut.loop[0].start) > SAME_POINT_TOLERANCE_MM:
        yield tool.move_straight(cut.loop[0].start, None, reduced_feed)


def _along(tool: CycleTool, loop: Sequence[Element], feed: float) -> Iterator[Block]:
    for element in loop:
        yield _element(tool, element, tool.z_position, feed)


def _element(tool: CycleTool, element: Element, z: float, feed: float) -> Block:
    if isinstance(element, Arc):
        return tool.move_on_arc(element, z, feed)
    return tool.move_straight(element.end, z, feed)


def run_floor_finishing(tool: CycleTool, area: Sequence[ElementLoop]) -> Iterator[Block]:
    """Yield the blocks of cycle 23, which finishes the floor and leaves the allowance on the walls."""
    clearing = ClearingData(tool, area)
    feed, plunge = clearing.tool.read_cutting_feed(12), clearing.tool.read_cutting_feed(11)
    plan = clearing.plan_level_rings(tool.radius_mm)
    yield from clearing.move_to_safe_z()
    for cut in plan if clearing.surface_z_mm - clearing.bottom_z_mm > MIN_LENGTH_MM else ():
        start = cut.loop[0].start
        if not cut.moves_at_depth:
            yield from tool.move_above_position(start, clearing.clearance_z_mm)
            yield tool.move_to_z(clearing.bottom_z_mm, plunge)
        elif math.dist(tool.xy_position, start) > SAME_POINT_TOLERANCE_MM:
            yield tool.move_straight(start, None, feed)
        yield from _along(tool, cut.loop, feed)
    yield from clearing.retract_tool()


# --- walls ------------------------------------------------------------------------------------------------


def run_side_finishing(tool: CycleTool, area: Sequence[ElementLoop]) -> Iterator[Block]:
    """Yield the blocks of cycle 24, which finishes the walls to the allowance Q14.

    The tool approaches and departs on quarter circles.
    """
    clearing = ClearingData(tool, area)
    feed, plunge = clearing.tool.read_cutting_feed(12), clearing.tool.read_cutting_feed(11)
    apart = tool.radius_mm + tool.read_length_mm(14, 0.0)
    try:
        loops = make_inset_loops(area, apart)
    except PocketAreaError as problem:
        raise clearing.make_fit_error(problem) from None
    if not loops:
        raise clearing.make_fit_error(PocketAreaError("the tool does not fit anywhere inside the contour"))
    room = AreaChecker(area)
    yield from clearing.move_to_safe_z()
    for loop in loops:
        ring = [element.make_reversed() for element in reversed(loop)] if clearing.is_up_cut else loop
        ring, to_it, off_it = _add_approach_arcs(
            ring, room, apart, tool.radius_mm, is_up_cut=clearing.is_up_cut
        )
        for z in clearing.compute_z_levels(clearing.bottom_z_mm):
            yield from tool.move_above_position(
                to_it.start if to_it else ring[0].start, clearing.clearance_z_mm
            )
            yield tool.move_to_z(z, plunge)
            yield from _along(tool, [each for each in (to_it, *ring, off_it) if each is not None], feed)
        yield tool.move_to_z(clearing.clearance_z_mm)
    yield from clearing.retract_tool()


def _add_approach_arcs(
    ring: ElementLoop, room: AreaChecker, offset_mm: float, radius: float, *, is_up_cut: bool
) -> tuple[ElementLoop, Arc | None, Arc | None]:
    """Return a ring with a suitable start point, and the approach and departure arcs at this point.

    If the arcs fit at no point of the ring, both arcs are None.
    """
    order = sorted(range(len(ring)), key=lambda at: (isinstance(ring[at], Arc), -ring[at].length))
    for size in (radius / 2.0**tries for tries in range(_MAX_TRIES)):
        for at in order:
            begun = move_loop_start_to(ring, at, ring[at].length / 2.0)
            to_it, off_it = _make_quarter_arcs(
                begun[0].start, begun[0].start_direction, size, is_left=not is_up_cut
            )
            if room.contains_element(to_it, offset_mm) and room.contains_element(off_it, offset_mm):
                return begun, to_it, off_it
    return move_loop_start_to(ring, order[0], ring[order[0]].length / 2.0), None, None


def _make_quarter_arcs(
    wall_point: Point, direction: Point, radius_mm: float, *, is_left: bool
) -> tuple[Arc, Arc]:
    """Return the approach and departure quarter circles at a wall point, on the pocket side."""
    x, y = get_left_normal(direction)
    side = (x, y) if is_left else (-x, -y)
    centre = wall_point[0] + side[0] * radius_mm, wall_point[1] + side[1] * radius_mm
    before = centre[0] - direction[0] * radius_mm, centre[1] - direction[1] * radius_mm
    departure_end = centre[0] + direction[0] * radius_mm, centre[1] + direction[1] * radius_mm
    return Arc(before, wall_point, centre, not is_left), Arc(wall_point, departure_end, centre, not is_left)


# --- open contours ----------------------------------------------------------------------------------------


def run_contour_train(tool: CycleTool, contours: ContourSequence) -> Iterator[Block]:
    """Yield the blocks of cycle 25, which mills a contour level by level.

    Q15 is 0 for milling in both directions and -1 for up-cut milling.
    """
    clearing = ClearingData(tool, clearance_mm=_CLEARANCE_MM)
    if len(contours) > 1:
        tool.log_note("Cycle 25 mills only the first contour listed in cycle 14.")
    figure = contours[0]
    tool_path = _offset_path(clearing, figure)
    kind = tool.read_choice(15, (-1, 0, 1), 1.0)
    climbs = (figure.compensation_side == "L") == (tool.running_rpm > 0.0)  # in the programmed direction
    if kind and figure.compensation_side and climbs != (kind > 0):
        tool_path = [element.make_reversed() for element in reversed(tool_path)]
    feed, plunge = clearing.tool.read_cutting_feed(12), clearing.tool.read_cutting_feed(11)
    yield from clearing.move_to_safe_z()
    for index, z in enumerate(clearing.compute_z_levels(clearing.bottom_z_mm)):
        if kind or index == 0:
            yield tool.move_to_z(max(clearing.clearance_z_mm, tool.z_position) if index else tool.z_position)
            yield tool.move_straight(tool_path[0].start)
            yield tool.move_to_z(clearing.clearance_z_mm)
        yield tool.move_to_z(z, plunge)
        yield from _along(tool, tool_path, feed)
        if not kind:
            tool_path = [element.make_reversed() for element in reversed(tool_path)]
    yield tool.move_to_z(clearing.safe_z_mm)


def _offset_path(clearing: ClearingData, contour: SlContour) -> list[Element]:
    """Return the path of the tool center, offset from the contour by the tool radius plus Q3.

    Without RL or RR, the path is the contour itself.
    """
    elements = list(contour.elements)
    text = "Contour {figure} does not contain any elements."
    clearing.tool.check_condition(elements, text, "Add path functions to the contour.", figure=contour.label)
    if not contour.compensation_side:
        return elements
    apart = clearing.tool.radius_mm + clearing.side_allowance_mm
    closed = math.dist(elements[-1].end, elements[0].start) <= MAX_CLOSING_GAP_MM
    if closed:
        elements = close_loop(elements)
    try:
        offset_pieces = offset_known_contour(elements, apart if contour.compensation_side == "L" else -apart)
    except GougeError as problem:
        raise clearing.make_fit_error(problem) from None
    return [piece.element for piece in offset_pieces]


def run_contour_cycle(
    state: State, tool: CycleTool, number: int, contours: ContourSequence, column: int
) -> Iterator[Block]:
    """Yield the blocks of one of the ``CONTOUR_CYCLES`` for the given contours.

    Raises ProgramError for invalid cycle data, and for contours that do not enclose an area or that cannot
    be milled with the tool.
    """
    if number == CONTOUR_TRAIN_CYCLE:
        yield from run_contour_train(tool, contours)
    else:
        yield from _AREA_CYCLES[number](tool, find_area_boundary(state, contours, column))


CONTOUR_TRAIN_CYCLE = 25
_AREA_CYCLES: dict[int, Callable[[CycleTool, Sequence[ElementLoop]], Iterator[Block]]] = {
    21: run_pilot_drilling,
    22: run_roughing,
    23: run_floor_finishing,
    24: run_side_finishing,
}
CONTOUR_CYCLES = frozenset({*_AREA_CYCLES, CONTOUR_TRAIN_CYCLE})
"""Numbers of the contour cycles."""
