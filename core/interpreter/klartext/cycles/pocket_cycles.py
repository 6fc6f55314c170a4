"""Milling cycles for pockets, slots and studs (210 to 215 and 251 to 257), executed level by level.

Pockets are cleared from the inside out, and studs are cleared from the blank inward. Walls and floor are
finished last. TurnDesk calculates its own tool path, but the remaining material agrees with the parameters.
Ramps have an angle of 3 degrees because the tool table has no plunge angle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from core.geometry.lines_and_arcs import Arc, Point
from core.geometry.pocket_area import ElementLoop
from core.interpreter.klartext.cycles.contour_cycles import (
    run_floor_finishing,
    run_roughing,
    run_side_finishing,
)
from core.interpreter.klartext.cycles.cycle_moves import (
    CycleParameters,
    CycleTool,
    Placement,
    RoundedRectangle,
)
from core.interpreter.klartext.cycles.hole_cycles import (
    MIN_LENGTH_MM,
    compute_infeed_depths,
    compute_z_levels,
    read_cycle_heights,
    retract_from_hole,
)
from core.interpreter.shared.elementary_blocks import Block
from core.language.klartext.q_parameters import MAX_FEED_VALUE

_RAMP = math.tan(math.radians(3.0))
_MAX_OVERLAP = 1.9999
_BOTH, _ROUGH, _FINISH = _SCOPES = 0, 1, 2
_PLUNGES = 0, 1, 2  # straight down, on a helix, in a zigzag
_MAX_SLOTS = 1_000
_CENTRE, _LEFT_END, _MIDDLE, _RIGHT_END = range(4)


class _MillingParameters:
    """The parameters of a pocket, slot or stud cycle."""

    def __init__(self, tool: CycleTool) -> None:
        self.tool = tool
        self.surface_z_mm, self.clearance_z_mm, self.bottom_z_mm = read_cycle_heights(tool)
        self.safe_z_mm = self.surface_z_mm + max(tool.read_length_mm(204, 0.0), tool.read_length_mm(200))
        self.feed, self.plunge_feed = tool.read_cutting_feed(207), tool.read_cutting_feed(206)
        self.side_allowance_mm, self.floor_allowance_mm = (
            tool.read_length_mm(368, 0.0),
            tool.read_length_mm(369, 0.0),
        )
        self.scope = tool.read_choice(215, _SCOPES, _ROUGH)
        overlap = tool.read_parameter(370, 1.0)
        if not 0.0 < overlap <= _MAX_OVERLAP or tool.radius_mm <= MIN_LENGTH_MM:
            text = (
                "With path overlap Q370={overlap} and tool radius {radius} mm, the cycle cannot clear the "
                "area."
            )
            hint = "Set Q370 between 0.1 and 1.9999, and enter the tool radius."
            raise tool.make_error(text, hint, overlap=overlap, radius=tool.radius_mm)
        self.stepover_mm = overlap * tool.radius_mm
        self.is_up_cut = (tool.read_choice(351, (-1, 0, 1), 1.0) < 0) != (tool.running_rpm < 0.0)

    def compute_z_levels(self) -> list[float]:
        """Return the Z heights of the clearing levels in mm, ending with the deepest."""
        floor = self.bottom_z_mm + (self.floor_allowance_mm if self.scope != _FINISH else 0.0)
        return compute_z_levels(self.tool, self.surface_z_mm, floor, lambda: self.tool.read_length_mm(202))

    @property
    def has_finishing(self) -> bool:
        """Return whether the cycle finishes the walls and the floor."""
        return self.scope == _FINISH or (
            self.scope == _BOTH and max(self.side_allowance_mm, self.floor_allowance_mm) > MIN_LENGTH_MM
        )

    @property
    def finishing_feed(self) -> float:
        """Return the feed of the finishing passes as programmed."""
        return self.tool.read_cutting_feed(385) if self.tool.read_parameter(385, 0.0) else self.feed

    def compute_wall_z_levels(self) -> list[float]:
        """Return the Z heights of the wall finishing passes in mm, in steps of Q338.

        If Q338 is 0, there is one pass at the bottom.
        """
        step = self.tool.read_length_mm(338, 0.0)
        return [
            self.surface_z_mm - done
            for done in compute_infeed_depths(self.tool, self.surface_z_mm - self.bottom_z_mm, step)
        ]


# --- pockets and slots: from the inside out


def mill_rectangular_pocket(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 251, which mills a rectangular pocket.

    The side lengths are Q218 and Q219, and the corner radius is Q220. Q224 is the rotation, and Q367 is the
    position of the pocket relative to the tool.
    """
    a, b = tool.read_length_mm(218) / 2.0, tool.read_length_mm(219) / 2.0
    corner = {0: (0.0, 0.0), 1: (a, b), 2: (-a, b), 3: (-a, -b), 4: (a, -b)}
    seat = Placement(tool.xy_position, tool.read_parameter(224, 0.0)).translate(*_placed(tool, corner))
    yield from _pocket(tool, seat, RoundedRectangle(a, b, tool.read_length_mm(220, 0.0)))


def mill_circular_pocket(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 252, which mills a pocket with the diameter Q223 around the tool position."""
    radius = tool.read_length_mm(223) / 2.0
    yield from _pocket(tool, Placement(tool.xy_position), RoundedRectangle(radius, radius, radius))


def mill_slot(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 253, which mills a slot.

    The length is Q218, and the width is Q219. Q374 is the rotation, and Q367 is the position of the slot
    relative to the tool.
    """
    a, b = tool.read_length_mm(218) / 2.0, tool.read_length_mm(219) / 2.0
    tool.check_condition(
        a >= b - MIN_LENGTH_MM, "The slot is wider than it is long.", "Correct Q218 and Q219."
    )
    ends = {0: (0.0, 0.0), 1: (a, 0.0), 2: (a - b, 0.0), 3: (b - a, 0.0), 4: (-a, 0.0)}
    seat = Placement(tool.xy_position, tool.read_parameter(374, 0.0)).translate(*_placed(tool, ends))
    yield from _pocket(tool, seat, RoundedRectangle(a, b, b))


def _placed(tool: CycleTool, places: dict[int, tuple[float, float]]) -> tuple[float, float]:
    found = places.get(tool.read_whole_number(367, 0.0))
    if found is None:
        raise tool.make_error("Q367 must be 0, 1, 2, 3 or 4.", "Correct Q367.")
    return found


def _pocket(tool: CycleTool, seat: Placement, wall: RoundedRectangle) -> Iterator[Block]:
    if wall.half_side_v_mm > wall.half_side_u_mm:  # the long side first, because the tool plunges along it
        seat, wall = (
            Placement(seat.center, seat.angle_deg + 90.0),
            RoundedRectangle(wall.half_side_v_mm, wall.half_side_u_mm, wall.corner_radius_mm),
        )
    milling = _MillingParameters(tool)
    last = wall.make_enlarged_rectangle(-tool.radius_mm)
    rough = last.make_enlarged_rectangle(-milling.side_allowance_mm) if milling.scope != _FINISH else last
    if min(rough.half_side_v_mm, last.half_side_v_mm) < -MIN_LENGTH_MM:
        raise tool.make_error("The tool is wider than the pocket or slot.", "Use a smaller tool.")
    rough, last = (
        RoundedRectangle(max(each.half_side_u_mm, 0.0), max(each.half_side_v_mm, 0.0), each.corner_radius_mm)
        for each in (rough, last)
    )
    yield tool.move_to_z(max(milling.clearance_z_mm, min(tool.z_position, milling.safe_z_mm)))
    if milling.surface_z_mm - milling.bottom_z_mm < MIN_LENGTH_MM:
        return
    if milling.scope != _FINISH:
        above = milling.surface_z_mm
        for z in milling.compute_z_levels():
            yield from _plunge(milling, seat, rough, above, z)
            yield from _clear_level(milling, seat, rough, milling.feed)
            above = z
    if milling.has_finishing:
        yield from _finish_walls(milling, seat, last)
    yield tool.move_to_z(milling.clearance_z_mm)
    yield tool.move_straight(seat.center)
    yield from retract_from_hole(tool, milling.surface_z_mm, milling.clearance_z_mm, None)


def _plunge(
    milling: _MillingParameters, placement: Placement, ring: RoundedRectangle, above: float, z: float
) -> Iterator[Block]:
    """Yield the plunge from ``above`` to ``z`` at the start of the center line.

    The tool plunges straight down, on a helix or in a zigzag.
    """
    tool, half = milling.tool, ring.half_side_u_mm - ring.half_side_v_mm
    start, end = placement.convert_to_program_point(-half, 0.0), placement.convert_to_program_point(half, 0.0)
    yield tool.move_to_z(min(milling.clearance_z_mm, above + tool.read_length_mm(200)))
    yield tool.move_straight(start)
    if not tool.read_choice(366, _PLUNGES, 1.0):
        yield tool.move_to_z(z, milling.plunge_feed)
    elif half > tool.radius_mm:
        yield tool.move_to_z(above, milling.plunge_feed)
        passes = 2 * math.ceil((above - z) / (4.0 * half * _RAMP) - MIN_LENGTH_MM)
        for count in range(1, passes + 1):
            yield tool.move_straight(
                (start, end)[count % 2], above + (z - above) * count / passes, milling.plunge_feed
            )
    else:
        yield from _helix(
            milling, placement.translate(-half, 0.0), min(tool.radius_mm, ring.half_side_v_mm), above, z
        )


def _helix(
    milling: _MillingParameters, seat: Placement, radius: float, above: float, z: float
) -> Iterator[Block]:
    tool = milling.tool
    text = "There is not enough room to plunge along a ramp."
    tool.check_condition(radius >= MIN_LENGTH_MM * 1000.0, text, "Set Q366=+0 for a center-cutting tool.")
    begin = seat.convert_to_program_point(radius, 0.0)
    yield tool.move_straight(begin)
    yield tool.move_to_z(above, milling.plunge_feed)
    turns = math.ceil((above - z) / (2.0 * math.pi * radius * _RAMP) - MIN_LENGTH_MM)
    circle = Arc(begin, begin, seat.center, milling.is_up_cut)
    for count in range(1, turns + 1):
        yield tool.move_on_arc(circle, above + (z - above) * count / turns, milling.plunge_feed)
    yield tool.move_on_arc(circle, z, milling.plunge_feed)
    yield tool.move_straight(seat.center, None, milling.feed)


def _clear_level(
    milling: _MillingParameters, placement: Placement, ring: RoundedRectangle, feed: float
) -> Iterator[Block]:
    """Yield the clearing moves of the current level, from the center line to the ring."""
    tool = milling.tool
    if ring.half_side_u_mm - ring.half_side_v_mm > MIN_LENGTH_MM:
        yield tool.move_straight(
            placement.convert_to_program_point(ring.half_side_u_mm - ring.half_side_v_mm, 0.0), None, feed
        )
    count = (
        math.ceil(ring.half_side_v_mm / milling.stepover_mm - MIN_LENGTH_MM)
        if ring.half_side_v_mm > MIN_LENGTH_MM
        else 0
    )
    for at in range(1, count + 1):
        each = ring.make_enlarged_rectangle(-ring.half_side_v_mm * (1.0 - at / count))
        yield tool.move_straight(placement.convert_to_program_point(each.half_side_u_mm, 0.0), None, feed)
        yield from each.generate_outline_moves(tool, placement, feed, is_clockwise=milling.is_up_cut)


def _finish_walls(
    milling: _MillingParameters, placement: Placement, ring: RoundedRectangle
) -> Iterator[Block]:
    """Yield the finishing moves of the floor and the walls.

    The approach to each wall and the departure from it are quarter circles.
    """
    tool, feed = milling.tool, milling.finishing_feed
    half = placement.convert_to_program_point(ring.half_side_v_mm - ring.half_side_u_mm, 0.0)
    if milling.floor_allowance_mm > MIN_LENGTH_MM:
        yield tool.move_to_z(milling.clearance_z_mm)
        yield tool.move_straight(half)
        yield tool.move_to_z(milling.bottom_z_mm, milling.plunge_feed)
        yield from _clear_level(milling, placement, ring, feed)
    if milling.side_allowance_mm <= MIN_LENGTH_MM and milling.scope != _FINISH:
        return
    quarter, side = min(tool.radius_mm / 2.0, ring.half_side_v_mm), -1.0 if milling.is_up_cut else 1.0
    for z in milling.compute_wall_z_levels():
        yield tool.move_to_z(min(milling.clearance_z_mm, tool.z_position + tool.read_length_mm(200)))
        yield tool.move_straight(
            placement.convert_to_program_point(ring.half_side_u_mm - quarter, -side * quarter)
        )
        yield tool.move_to_z(z, milling.plunge_feed)
        yield from _mill_ring(milling, placement, ring, quarter, feed)


def _mill_ring(
    milling: _MillingParameters, placement: Placement, ring: RoundedRectangle, quarter: float, feed: float
) -> Iterator[Block]:
    """Yield the approach to a closed path, one round along the path, and the departure.

    A positive ``quarter`` approaches from the inside, and a negative ``quarter`` approaches from the
    outside.
    """
    tool, clockwise = milling.tool, milling.is_up_cut
    if quarter < 0.0:
        clockwise = not clockwise
    side = -1.0 if clockwise else 1.0
    on, size = placement.convert_to_program_point(ring.half_side_u_mm, 0.0), abs(quarter)
    about = placement.convert_to_program_point(ring.half_side_u_mm - quarter, 0.0)
    turns = clockwise if quarter > 0.0 else not clockwise
    if size > MIN_LENGTH_MM:
        begin = placement.convert_to_program_point(ring.half_side_u_mm - quarter, -side * size)
        yield tool.move_on_arc(Arc(begin, on, about, turns), tool.z_position, feed)
    yield from ring.generate_outline_moves(tool, placement, feed, is_clockwise=clockwise)
    if size > MIN_LENGTH_MM:
        end = placement.convert_to_program_point(ring.half_side_u_mm - quarter, side * size)
        yield tool.move_on_arc(Arc(on, end, about, turns), tool.z_position, feed)


# --- studs: from the blank inwards


def mill_rectangular_stud(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 256, which mills a rectangular stud.

    The sides are Q218 and Q219, and the sides of the blank are Q424 and Q425. Q220 is the corner radius,
    and Q224 is the rotation.
    """
    a, b = tool.read_length_mm(218) / 2.0, tool.read_length_mm(219) / 2.0
    corner = {0: (0.0, 0.0), 1: (a, b), 2: (-a, b), 3: (-a, -b), 4: (a, -b)}
    seat = Placement(tool.xy_position, tool.read_parameter(224, 0.0)).translate(*_placed(tool, corner))
    more = max(tool.read_length_mm(424) / 2.0 - a, tool.read_length_mm(425) / 2.0 - b)
    yield from _stud(tool, seat, RoundedRectangle(a, b, tool.read_length_mm(220, 0.0)), more)


def mill_circular_stud(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 257, which mills a circular stud.

    The diameter is Q223, the diameter of the blank is Q222, and the start angle is Q376.
    """
    radius = tool.read_length_mm(223) / 2.0
    seat = Placement(tool.xy_position, max(tool.read_parameter(376, 0.0), 0.0))
    yield from _stud(
        tool, seat, RoundedRectangle(radius, radius, radius), tool.read_length_mm(222) / 2.0 - radius
    )


def _stud(
    tool: CycleTool, placement: Placement, wall: RoundedRectangle, oversize_mm: float
) -> Iterator[Block]:
    """Yield the closed paths around a stud on each level, from the blank inward.

    ``oversize_mm`` is the oversize of the blank in mm.
    """
    milling = _MillingParameters(tool)
    tool.check_condition(
        oversize_mm >= MIN_LENGTH_MM,
        "The blank is not larger than the stud.",
        "Correct the blank dimensions.",
    )
    last = wall.make_enlarged_rectangle(tool.radius_mm)
    rough = last.make_enlarged_rectangle(milling.side_allowance_mm if milling.scope != _FINISH else 0.0)
    outside = last.half_side_u_mm + oversize_mm + tool.radius_mm + tool.read_length_mm(200)
    yield tool.move_to_z(max(milling.safe_z_mm, tool.z_position))
    if milling.surface_z_mm - milling.bottom_z_mm < MIN_LENGTH_MM:
        return
    rounds = math.ceil(oversize_mm / milling.stepover_mm - MIN_LENGTH_MM)
    for z in milling.compute_z_levels() if milling.scope != _FINISH else ():
        for at in range(1, rounds + 1):
            each = rough.make_enlarged_rectangle(oversize_mm * (1.0 - at / rounds))
            yield from _approach_level(milling, placement, outside, z, at == 1)
            yield from _around(milling, placement, each, milling.feed)
    if milling.has_finishing:
        for z in milling.compute_wall_z_levels():
            yield from _approach_level(milling, placement, outside, z, True)
            yield from _around(milling, placement, last, milling.finishing_feed)
    yield tool.move_to_z(milling.clearance_z_mm)
    yield from retract_from_hole(tool, milling.surface_z_mm, milling.clearance_z_mm, None)


def _approach_level(
    milling: _MillingParameters, placement: Placement, outside: float, z: float, down: bool
) -> Iterator[Block]:
    """Yield a rapid to a point next to the blank, and the move down to the current level."""
    tool = milling.tool
    if not down:
        return
    yield from tool.move_above_position(
        placement.convert_to_program_point(outside, 0.0), milling.clearance_z_mm
    )
    yield tool.move_to_z(z, milling.plunge_feed)


def _around(
    milling: _MillingParameters, seat: Placement, ring: RoundedRectangle, feed: float
) -> Iterator[Block]:
    tool = milling.tool
    side = 1.0 if milling.is_up_cut else -1.0  # the direction is opposite to that of a pocket
    yield tool.move_straight(
        seat.convert_to_program_point(ring.half_side_u_mm + tool.radius_mm, -side * tool.radius_mm),
        None,
        feed,
    )
    yield from _mill_ring(milling, seat, ring, -tool.radius_mm, feed)


# --- circular slots: areas with a separate boundary, cleared by the rings of the SL cycles


def mill_circular_slot(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 254, which mills circular slots.

    A slot has the width Q219 on a circle with the diameter Q375. It starts at the angle Q376 and spans Q248
    degrees. Q377 is the number of slots, and Q378 is the angle between them.
    """
    surface, clear, _ = read_cycle_heights(tool)
    safe = max(surface + tool.read_length_mm(204, 0.0), clear) / tool.mm_per_unit
    centre, begin, sweep = _slot_place(tool)
    count, step = tool.read_whole_number(377, 1.0), tool.read_parameter(378, 0.0)
    text = "Q377={count} is not a valid number of slots."
    tool.check_condition(1 <= count <= _MAX_SLOTS, text, "Enter a valid number.", count=count)
    scope = tool.read_choice(215, _SCOPES, _BOTH)
    side, floor = tool.read_length_mm(368, 0.0), tool.read_length_mm(369, 0.0)
    for at in range(count):
        area = [make_slot_outline(tool, centre, begin + at * step, sweep)]
        asked = tool.copy_with_parameters(
            {**_CONTOUR_PARAMETERS, 7: safe, 19: 206 if tool.read_choice(366, _PLUNGES, 1.0) else 0.0}
        )
        if scope != _FINISH:
            yield from run_roughing(asked, area)
        if scope == _FINISH or (scope == _BOTH and max(side, floor) > MIN_LENGTH_MM):
            last = tool.copy_with_parameters(
                {**_CONTOUR_PARAMETERS, 3: 0.0, 4: 0.0, 7: safe, **_finishing(tool)}
            )
            if floor > MIN_LENGTH_MM:
                yield from run_floor_finishing(last, area)
            yield from run_side_finishing(last, area)


def make_slot_outline(tool: CycleTool, center: Point, start_deg: float, sweep_deg: float) -> ElementLoop:
    """Return the counterclockwise outline of one slot. Raises ProgramError if the dimensions are invalid."""
    radius, half = tool.read_length_mm(375) / 2.0, tool.read_length_mm(219) / 2.0
    if not MIN_LENGTH_MM < half < radius or not 0.0 < abs(sweep_deg) <= 360.0:
        text = (
            "A slot {half} mm wide over {sweep} degrees on a circle {radius} mm in diameter is not possible."
        )
        raise tool.make_error(
            text, "Correct Q219, Q248 and Q375.", half=2 * half, sweep=sweep_deg, radius=2 * radius
        )
    if radius * math.radians(360.0 - abs(sweep_deg)) < 2.0 * half:
        raise tool.make_error("The ends of the slot overlap.", "Reduce Q248.")
    first, last = sorted((start_deg, start_deg + sweep_deg))

    def compute_polar_point(angle: float, away: float) -> Point:
        turned = math.radians(angle)
        return center[0] + away * math.cos(turned), center[1] + away * math.sin(turned)

    wide, near = radius + half, radius - half
    return [
        Arc(compute_polar_point(first, wide), compute_polar_point(last, wide), center, False),
        Arc(
            compute_polar_point(last, wide),
            compute_polar_point(last, near),
            compute_polar_point(last, radius),
            False,
        ),
        Arc(compute_polar_point(last, near), compute_polar_point(first, near), center, True),
        Arc(
            compute_polar_point(first, near),
            compute_polar_point(first, wide),
            compute_polar_point(first, radius),
            False,
        ),
    ]


def _slot_place(tool: CycleTool) -> tuple[Point, float, float]:
    """Return the center, start angle and sweep of a circular slot.

    Q367 determines whether they come from the parameters or from the tool position.
    """
    begin, sweep, radius = tool.read_parameter(376), tool.read_parameter(248), tool.read_length_mm(375) / 2.0
    place = tool.read_whole_number(367, 0.0)
    share = {_LEFT_END: 0.0, _MIDDLE: 0.5, _RIGHT_END: 1.0}.get(place)
    if share is None:
        tool.check_condition(place == _CENTRE, "Q367 must be 0, 1, 2 or 3.", "Correct Q367.")
        return (tool.read_length_mm(216), tool.read_length_mm(217)), begin, sweep
    turned = math.radians(begin)  # Q376 is the angle of the tool position
    x, y = tool.xy_position
    return (x - radius * math.cos(turned), y - radius * math.sin(turned)), begin - share * sweep, sweep


# The parameters of a slot by the numbers of the SL cycles. Other parameters of these cycles have fixed
# values.
_CONTOUR_PARAMETERS: CycleParameters = {
    1: 201, 2: 370, 3: 368, 4: 369, 5: 203, 6: 200, 9: 351, 10: 202, 11: 206, 12: 207, 14: 0.0,
    18: 0.0, 208: MAX_FEED_VALUE, 401: 100.0,
}  # fmt: skip


def _finishing(tool: CycleTool) -> CycleParameters:
    """Return the finishing parameters, with the feed Q385 and infeeds of Q338.

    If Q338 is 0, finishing takes a single infeed.
    """
    feed: CycleParameters = {12: 385} if tool.read_parameter(385, 0.0) else {}
    return {**feed, 10: 338 if tool.read_parameter(338, 0.0) else -1e9}
