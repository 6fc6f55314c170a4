"""Hole cycles (200 to 209, 240, 241) for drilling, reaming, boring, tapping, bore milling and centering."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from core.geometry.lines_and_arcs import Arc
from core.interpreter.klartext.cycles.cycle_moves import CANNOT_ORIENT_HINT, CANNOT_ORIENT_TEXT, CycleTool
from core.interpreter.shared.elementary_blocks import Block

MIN_LENGTH_MM = 1e-6  # mm; a smaller depth counts as 0
_LATERAL_MOVE_MM = 0.2  # mm; sideways move of a boring bar before the retract
_EDGE = {
    (-1.0, 0.0): "TURN THE CUTTING EDGE TOWARD X+",
    (0.0, -1.0): "TURN THE CUTTING EDGE TOWARD Y+",
    (1.0, 0.0): "TURN THE CUTTING EDGE TOWARD X-",
    (0.0, 1.0): "TURN THE CUTTING EDGE TOWARD Y-",
}
_MAX_PECKS = 10_000


def run_reaming(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 201 (reaming), which enters and leaves the hole at a feed."""
    surface, clear, bottom = read_cycle_heights(tool)
    feed = tool.read_feed(206)
    yield tool.move_to_z(clear)
    if abs(bottom - surface) < MIN_LENGTH_MM:
        return
    yield tool.move_to_z(bottom, feed)
    yield from tool.make_dwell_blocks(tool.read_parameter(211, 0.0))
    yield from retract_from_hole(
        tool, surface, clear, tool.read_feed(208) if tool.read_parameter(208, 0.0) else feed
    )


def run_boring(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 202 (boring).

    The tool bores, the spindle stops at the angle Q336, and the tool moves off the wall (Q214) and
    retracts. The spindle then restarts. If the spindle cannot be oriented, it stops at any angle. If the
    tool must also move off the wall, the program then stops so that the operator can rotate the cutting
    edge away from it.
    """
    surface, clear, bottom = read_cycle_heights(tool)
    rpm, off_wall_direction = tool.running_rpm, read_lateral_direction(tool, (0, 1, 2, 3, 4))
    x, y = tool.xy_position
    yield tool.move_to_z(clear)
    if abs(bottom - surface) < MIN_LENGTH_MM:
        return
    yield tool.move_to_z(bottom, tool.read_feed(206))
    yield from tool.make_dwell_blocks(tool.read_parameter(211, 0.0))
    yield (
        tool.orient_spindle(336) if tool.can_orient_spindle else tool.stop_spindle(waits_for_standstill=True)
    )
    if off_wall_direction != (0.0, 0.0):
        if not tool.can_orient_spindle:
            tool.warn_about_unknown_orientation()
            yield tool.stop_program(_EDGE[off_wall_direction])
        yield tool.move_straight(
            (x + off_wall_direction[0] * _LATERAL_MOVE_MM, y + off_wall_direction[1] * _LATERAL_MOVE_MM),
            None,
            tool.read_feed(206),
        )
    yield from retract_from_hole(
        tool, surface, clear, tool.read_feed(208) if tool.read_parameter(208, 0.0) else None
    )
    if off_wall_direction != (0.0, 0.0):
        yield tool.move_straight((x, y))
    yield tool.run_spindle(rpm)


def read_lateral_direction(tool: CycleTool, directions: tuple[int, ...]) -> tuple[float, float]:
    """Return the direction (x, y) in which the tool moves off the wall, as specified by Q214.

    Raises ProgramError for an invalid Q214.
    """
    number = tool.read_parameter(214, 0.0)
    if number not in directions:
        text = "Q214 must be a whole number from {directions} to {directions2}."
        raise tool.make_error(text, "Correct Q214.", directions=directions[0], directions2=directions[-1])
    return {0: (0.0, 0.0), 1: (-1.0, 0.0), 2: (0.0, -1.0), 3: (1.0, 0.0), 4: (0.0, 1.0)}[int(number)]


def run_back_boring(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 204, which bores upward from below the part by the depth Q249.

    The tool passes through the hole off-center by Q251, with the spindle oriented to Q336. Q252 is the
    height of the cutting edge above the tip. Q250 is the thickness of the part.
    """
    text = "Cycle 204 moves through the hole with the spindle oriented, but {unoriented}."
    hint = "Bore from the other side of the part, or {how_oriented}."
    tool.check_condition(
        tool.can_orient_spindle, text, hint, unoriented=CANNOT_ORIENT_TEXT, how_oriented=CANNOT_ORIENT_HINT
    )
    rpm, (along_x, along_y) = tool.running_rpm, read_lateral_direction(tool, (1, 2, 3, 4))
    surface, depth = tool.read_length_mm(203, 0.0), tool.read_length_mm(249)
    text = "Q249 = {depth} mm is negative, so the tool would move away from the part."
    tool.check_condition(depth >= 0.0, text, "Enter the depth without a minus sign.", depth=f"{depth:+.10g}")
    clear, through, slow = (
        surface + tool.read_length_mm(200),
        tool.read_length_mm(250) + tool.read_length_mm(252),
        tool.read_feed(253),
    )
    lowest, end = surface - through - tool.read_length_mm(200), surface - through + depth
    (x, y), off = tool.xy_position, tool.read_length_mm(251)
    offset_position = x + along_x * off, y + along_y * off
    yield tool.move_to_z(clear)
    if depth < MIN_LENGTH_MM:
        return
    yield tool.orient_spindle(336)
    yield tool.move_straight(offset_position)
    yield tool.move_to_z(lowest, slow)
    yield tool.move_straight((x, y), None, slow)
    yield tool.run_spindle(rpm)
    yield tool.move_to_z(end, tool.read_cutting_feed(254))
    yield from tool.make_dwell_blocks(tool.read_parameter(255, 0.0))
    yield tool.move_to_z(lowest, slow)
    yield tool.orient_spindle(336)
    yield tool.move_straight(offset_position, None, slow)
    yield from retract_from_hole(tool, surface, clear, slow)
    yield tool.move_straight((x, y))
    yield tool.run_spindle(rpm)


def drilling(tool: CycleTool) -> Iterator[Block]:
    """Return the blocks of cycle 200.

    The cycle is like cycle 203, but with equal infeeds and a full retract after each infeed.
    """
    return run_universal_drilling(
        tool.copy_with_parameters({q: q for q in (200, 201, 202, 203, 204, 206, 210, 211)})
    )


def run_universal_drilling(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 203, which breaks chips Q213 times before each full retract.

    Q212 reduces each infeed, down to a minimum of Q205.
    """
    surface, clear, bottom = read_cycle_heights(tool)
    feed, whole = tool.read_feed(206), surface - bottom
    back, breaks = tool.read_length_mm(256, 0.2), tool.read_whole_number(213, 0.0)
    yield tool.move_to_z(clear)
    if whole < MIN_LENGTH_MM:
        return
    depths = compute_infeed_depths(
        tool, whole, tool.read_length_mm(202), tool.read_length_mm(212, 0.0), tool.read_length_mm(205, 0.0)
    )
    for count, depth in enumerate(depths, start=1):
        yield tool.move_to_z(surface - depth, feed)
        if depth >= whole - MIN_LENGTH_MM:
            break
        if breaks and count % (breaks + 1):
            yield tool.move_to_z(surface - depth + back)
        else:
            yield tool.move_to_z(clear)
            yield from tool.make_dwell_blocks(tool.read_parameter(210, 0.0))
            yield tool.move_to_z(min(clear, surface - depth + tool.read_length_mm(200)))
    yield from tool.make_dwell_blocks(tool.read_parameter(211, 0.0))
    yield from retract_from_hole(
        tool, surface, clear, tool.read_feed(208) if tool.read_parameter(208, 0.0) else None
    )


def run_deep_drilling(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 205, which is cycle 203 with additional parameters for deep holes.

    Drilling starts at the depth Q379. After a full retract, the rapid back down stops above the last depth,
    at a distance from Q258 to Q259. Q257 is the depth between chip breaks.
    """
    surface, clear, bottom = read_cycle_heights(tool)
    feed, begin = tool.read_feed(206), surface - max(tool.read_length_mm(379, 0.0), 0.0)
    whole, breaking, back = begin - bottom, tool.read_length_mm(257, 0.0), tool.read_length_mm(256, 0.2)
    yield tool.move_to_z(clear)
    if whole < MIN_LENGTH_MM:
        return
    if begin < surface:
        yield tool.move_to_z(begin + tool.read_length_mm(200), tool.read_feed(253))
    near, far = tool.read_length_mm(258, 0.2), tool.read_length_mm(259, 0.2)
    broken = 0.0
    for depth in compute_infeed_depths(
        tool, whole, tool.read_length_mm(202), tool.read_length_mm(212, 0.0), tool.read_length_mm(205, 0.0)
    ):
        while 0.0 < breaking < depth - broken - MIN_LENGTH_MM:
            broken += breaking
            yield tool.move_to_z(begin - broken, feed)
            yield tool.move_to_z(begin - broken + back)
        broken = depth
        yield tool.move_to_z(begin - depth, feed)
        if depth < whole - MIN_LENGTH_MM:
            yield tool.move_to_z(clear)
            yield tool.move_to_z(begin - depth + near + (far - near) * depth / whole)
    yield from tool.make_dwell_blocks(tool.read_parameter(211, 0.0))
    yield from retract_from_hole(
        tool, surface, clear, tool.read_feed(208) if tool.read_parameter(208, 0.0) else None
    )


def run_floating_tapping(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 206, which taps at the feed Q206, reverses the spindle and retracts."""
    surface, clear, bottom = read_cycle_heights(tool)
    lead = tool.convert_feed_to_lead(tool.read_cutting_feed(206))
    yield from _tapped(tool, surface, clear, bottom, lead, tool.running_rpm)


def run_rigid_tapping(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 207, which is like cycle 206 but has a pitch instead of a feed.

    The sign of the pitch determines the direction. At the end, the spindle resumes its previous speed and
    direction.
    """
    surface, clear, bottom = read_cycle_heights(tool)
    lead, rpm = _thread(tool)
    yield from _tapped(tool, surface, clear, bottom, lead, rpm)


def run_chip_breaking_tapping(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 209, which is rigid tapping with a spindle reversal after each depth Q257."""
    surface, clear, bottom = read_cycle_heights(tool)
    (lead, rpm), before = _thread(tool), tool.signed_rpm
    back, step = tool.read_length_mm(256, 0.0), tool.read_length_mm(257, 0.0)
    yield tool.move_to_z(clear)
    yield from tool.set_spindle_speed(rpm)
    for depth in compute_infeed_depths(tool, surface - bottom, step or surface - bottom):
        last = depth >= surface - bottom - MIN_LENGTH_MM
        stays = not last and bool(back)
        yield tool.make_tapping_block(surface - depth, lead, is_in_hole=True)
        yield tool.run_spindle(-rpm, is_in_hole=True)
        yield tool.make_tapping_block(surface - depth + back if stays else clear, lead, is_in_hole=stays)
        if not last:
            yield tool.run_spindle(rpm, is_in_hole=stays)
    yield from tool.set_spindle_speed(before)
    yield from retract_from_hole(tool, surface, clear, None)


def _thread(tool: CycleTool) -> tuple[float, float]:
    """Return the lead in mm/rev and the signed spindle speed in rpm for a tapping cycle.

    A warning is logged because Z is not synchronized with the spindle angle. Raises ProgramError if the
    pitch Q239 is missing or 0, or if S is not programmed.
    """
    tool.warn_about_unsynchronized_z()
    pitch = tool.read_length_mm(239)
    tool.check_condition(pitch != 0.0, "Pitch Q239 must not be 0.", "Enter the thread pitch.")
    return abs(pitch), tool.compute_thread_rpm(pitch)


def _tapped(
    tool: CycleTool, surface: float, clear: float, bottom: float, lead: float, rpm: float
) -> Iterator[Block]:
    before = tool.signed_rpm
    yield tool.move_to_z(clear)
    if abs(bottom - surface) < MIN_LENGTH_MM:
        return
    yield from tool.set_spindle_speed(rpm)
    yield tool.make_tapping_block(bottom, lead, is_in_hole=True)
    yield from tool.make_dwell_blocks(tool.read_parameter(211, 0.0), is_in_hole=True)
    yield tool.run_spindle(-rpm, is_in_hole=True)
    yield tool.make_tapping_block(clear, lead)
    yield from tool.set_spindle_speed(before)
    yield from retract_from_hole(tool, surface, clear, None)


def run_bore_milling(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 208, which mills a hole with the diameter Q335 on a helix.

    The pitch of the helix is Q334. A full circle at the bottom finishes the hole.
    """
    surface, clear, bottom = read_cycle_heights(tool)
    feed = tool.read_feed(206) or 0.0
    helix_radius_mm = tool.read_length_mm(335) / 2.0 - tool.radius_mm
    x, y = tool.xy_position
    pitch = tool.read_length_mm(334)
    text = "The tool, infeed or feed rate of cycle 208 is not valid for the hole."
    tool.check_condition(
        helix_radius_mm >= 0.0 and pitch > 0.0 and feed > 0.0,
        text,
        "Correct the entries named in the message.",
    )
    yield tool.move_to_z(clear)
    if helix_radius_mm < MIN_LENGTH_MM:
        yield tool.move_to_z(bottom, feed)
        yield from retract_from_hole(tool, surface, clear, None)
        return
    start = x + helix_radius_mm, y
    yield tool.move_straight(start, None, feed)
    clockwise = tool.read_choice(351, (-1, 0, 1), 1.0) < 0
    circle = Arc(start, start, (x, y), clockwise)
    for turn in range(1, math.ceil((clear - bottom) / pitch - MIN_LENGTH_MM) + 1):
        yield tool.move_on_arc(circle, max(clear - turn * pitch, bottom), feed)
    yield tool.move_on_arc(circle, bottom, feed)
    yield tool.move_straight((x, y), None, feed)
    yield from retract_from_hole(tool, surface, clear, None)


def run_centering(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 240 (centering) to a depth or to a diameter.

    For a diameter, the depth is calculated from the point angle of the tool.
    """
    if tool.read_choice(343, (0, 1), 0.0):
        surface = tool.read_length_mm(203, 0.0)
        clear = surface + tool.read_length_mm(200)
        half = math.radians(tool.point_angle_deg) / 2.0
        bottom = surface - abs(tool.read_length_mm(344)) / 2.0 / math.tan(half)
    else:
        surface, clear, bottom = read_cycle_heights(tool)
    yield tool.move_to_z(clear)
    yield tool.move_to_z(bottom, tool.read_feed(206))
    yield from tool.make_dwell_blocks(tool.read_parameter(211, 0.0))
    yield from retract_from_hole(tool, surface, clear, None)


def run_single_lip_drilling(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 241 (single-lip deep-hole drilling).

    The tool enters at the spindle speed Q427 to the start depth Q379 and drills at the speed Q428 with
    coolant. It leaves the hole at the speed Q427.
    """
    surface, clear, bottom = read_cycle_heights(tool)
    rpm, sense = tool.running_rpm, {3: 1.0, 4: -1.0, 5: 0.0}.get(tool.read_whole_number(426, 3.0))
    if sense is None:
        raise tool.make_error("Q426 must be 3, 4 or 5.", "Enter the M function for the spindle direction.")
    drilling = tool.read_parameter(428, 0.0) * (sense or 1.0) or rpm
    slow, begin = tool.read_parameter(427, 0.0) * sense, surface - max(tool.read_length_mm(379, 0.0), 0.0)
    yield tool.move_to_z(clear)
    if begin - bottom < MIN_LENGTH_MM:
        return
    yield tool.run_spindle(slow) if slow else tool.stop_spindle()
    yield tool.move_to_z(min(begin + tool.read_length_mm(200), clear), tool.read_feed(253))
    yield tool.run_spindle(drilling)
    yield from tool.switch_coolant(429)
    feed = tool.read_feed(206)
    if 0.0 < (rest := tool.read_length_mm(435, 0.0)) < surface - bottom and begin > surface - rest:
        yield tool.move_to_z(surface - rest, feed)
        yield from tool.make_dwell_blocks(tool.read_parameter(211, 0.0))
    yield tool.move_to_z(bottom, feed)
    yield from tool.make_dwell_blocks(tool.read_parameter(211, 0.0))
    yield from tool.switch_coolant(430)
    yield tool.run_spindle(slow) if slow else tool.stop_spindle()
    yield from retract_from_hole(
        tool, surface, clear, tool.read_feed(208) if tool.read_parameter(208, 0.0) else None
    )
    yield tool.run_spindle(rpm)


def read_cycle_heights(tool: CycleTool) -> tuple[float, float, float]:
    """Return the heights of the surface, the set-up clearance and the bottom in mm.

    Raises ProgramError for a positive depth Q201, or if Q200 or Q201 is missing.
    """
    surface, depth = tool.read_length_mm(203, 0.0), tool.read_length_mm(201)
    text = "Depth Q201={depth} mm is positive (upward)."
    tool.check_condition(depth <= 0.0, text, "Enter the depth with a minus sign.", depth=f"{depth:+.10g}")
    return surface, surface + tool.read_length_mm(200), surface + depth


def compute_infeed_depths(
    tool: CycleTool,
    total_depth_mm: float,
    infeed_mm: float,
    decrement_mm: float = 0.0,
    min_infeed_mm: float = 0.0,
) -> Iterator[float]:
    """Yield the depth after each infeed, ending with the total depth."""
    if infeed_mm <= 0.0 or infeed_mm >= total_depth_mm:
        yield total_depth_mm
        return
    if (
        total_depth_mm / max(infeed_mm if not decrement_mm else min_infeed_mm or infeed_mm, MIN_LENGTH_MM)
        > _MAX_PECKS
    ):
        raise tool.make_error(
            "An infeed of {step} mm would need too many pecks.", "Increase Q202.", step=infeed_mm
        )
    done = 0.0
    while total_depth_mm - done > MIN_LENGTH_MM:
        done = min(done + infeed_mm, total_depth_mm)
        yield done if total_depth_mm - done > MIN_LENGTH_MM else total_depth_mm
        infeed_mm = max(infeed_mm - decrement_mm, min_infeed_mm, MIN_LENGTH_MM) if decrement_mm else infeed_mm


def compute_z_levels(
    tool: CycleTool, surface_z_mm: float, bottom_z_mm: float, read_infeed_mm: Callable[[], float]
) -> list[float]:
    """Return the Z height after each infeed, from the surface to the bottom.

    The list is empty if the depth is 0.
    """
    whole = surface_z_mm - bottom_z_mm
    return (
        []
        if whole < MIN_LENGTH_MM
        else [surface_z_mm - done for done in compute_infeed_depths(tool, whole, read_infeed_mm())]
    )


def retract_from_hole(
    tool: CycleTool, surface: float, clearance_z_mm: float, feed: float | None
) -> Iterator[Block]:
    """Yield the retract to the set-up clearance, or to the second set-up clearance if it is higher."""
    second = surface + tool.read_length_mm(204, 0.0)
    if feed is None:
        yield tool.move_to_z(max(clearance_z_mm, second))
        return
    yield tool.move_to_z(clearance_z_mm, feed)
    if second > clearance_z_mm:
        yield tool.move_to_z(second)


HOLE_CYCLES: dict[int, Callable[[CycleTool], Iterator[Block]]] = {
    200: drilling,
    201: run_reaming,
    202: run_boring,
    203: run_universal_drilling,
    204: run_back_boring,
    205: run_deep_drilling,
    206: run_floating_tapping,
    207: run_rigid_tapping,
    208: run_bore_milling,
    209: run_chip_breaking_tapping,
    240: run_centering,
    241: run_single_lip_drilling,
}
"""Functions that run the hole cycles, by cycle number."""
