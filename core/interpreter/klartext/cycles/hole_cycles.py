"""Hole cycles (200 to 209, 240, 241): drilling, reaming, boring, tapping, bore milling and centering."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from core.geometry.lines_and_arcs import Arc
from core.interpreter.klartext.cycles.cycle_moves import HOW_ORIENTED, UNORIENTED, CycleTool
from core.interpreter.shared.elementary_blocks import Block

SMALLEST = 1e-6  # mm; a smaller depth counts as 0
_ASIDE = 0.2  # mm; sideways move of a boring bar before the retract
_EDGE = {
    (-1.0, 0.0): "TURN THE CUTTING EDGE TOWARD X+",
    (0.0, -1.0): "TURN THE CUTTING EDGE TOWARD Y+",
    (1.0, 0.0): "TURN THE CUTTING EDGE TOWARD X-",
    (0.0, 1.0): "TURN THE CUTTING EDGE TOWARD Y-",
}
_MOST_PECKS = 10_000


def reaming(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 201: down and up at a feed."""
    surface, clear, bottom = heights(tool)
    feed = tool.feed(206)
    yield tool.to(clear)
    if abs(bottom - surface) < SMALLEST:
        return
    yield tool.to(bottom, feed)
    yield from tool.dwell(tool.plain(211, 0.0))
    yield from out(tool, surface, clear, tool.feed(208) if tool.plain(208, 0.0) else feed)


def boring(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 202: bore, stop at the angle Q336, move off the wall (Q214), retract.

    The spindle turns again after the retract. If the spindle cannot be oriented, it stops at any angle. With
    a move off the wall, the program then stops so that the operator can turn the edge away from the wall.
    """
    surface, clear, bottom = heights(tool)
    rpm, way = tool.rpm, aside(tool, (0, 1, 2, 3, 4))
    x, y = tool.here
    yield tool.to(clear)
    if abs(bottom - surface) < SMALLEST:
        return
    yield tool.to(bottom, tool.feed(206))
    yield from tool.dwell(tool.plain(211, 0.0))
    yield tool.orient(336) if tool.orients else tool.stop(stands=True)
    if way != (0.0, 0.0):
        if not tool.orients:
            tool.warn_unoriented()
            yield tool.halt(_EDGE[way])
        yield tool.across((x + way[0] * _ASIDE, y + way[1] * _ASIDE), None, tool.feed(206))
    yield from out(tool, surface, clear, tool.feed(208) if tool.plain(208, 0.0) else None)
    if way != (0.0, 0.0):
        yield tool.across((x, y))
    yield tool.turn(rpm)


def aside(tool: CycleTool, directions: tuple[int, ...]) -> tuple[float, float]:
    """Return the direction (x, y) of Q214 in which the tool leaves the wall. Raises ProgramError."""
    number = tool.plain(214, 0.0)
    if number not in directions:
        text = "Q214 must be a whole number from {directions} to {directions2}."
        raise tool.refuse(text, "Correct Q214.", directions=directions[0], directions2=directions[-1])
    return {0: (0.0, 0.0), 1: (-1.0, 0.0), 2: (0.0, -1.0), 3: (1.0, 0.0), 4: (0.0, 1.0)}[int(number)]


def back_boring(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 204: boring upward from below the part by Q249.

    The tool passes off-center through the hole with the spindle oriented to Q336. Q252 is the height of the
    edge above the tip, Q250 the thickness of the part, and Q251 the off-center distance.
    """
    text = "Cycle 204 moves through the hole with the spindle oriented, but {unoriented}."
    hint = "Bore from the other side of the part, or {how_oriented}."
    tool.check(tool.orients, text, hint, unoriented=UNORIENTED, how_oriented=HOW_ORIENTED)
    rpm, (along_x, along_y) = tool.rpm, aside(tool, (1, 2, 3, 4))
    surface, depth = tool.length(203, 0.0), tool.length(249)
    text = "Q249 = {depth} mm is negative, so the tool would move away from the part."
    tool.check(depth >= 0.0, text, "Enter the depth without a minus sign.", depth=f"{depth:+.10g}")
    clear, through, slow = surface + tool.length(200), tool.length(250) + tool.length(252), tool.feed(253)
    lowest, end = surface - through - tool.length(200), surface - through + depth
    (x, y), off = tool.here, tool.length(251)
    beside = x + along_x * off, y + along_y * off
    yield tool.to(clear)
    if depth < SMALLEST:
        return
    yield tool.orient(336)
    yield tool.across(beside)
    yield tool.to(lowest, slow)
    yield tool.across((x, y), None, slow)
    yield tool.turn(rpm)
    yield tool.to(end, tool.cut(254))
    yield from tool.dwell(tool.plain(255, 0.0))
    yield tool.to(lowest, slow)
    yield tool.orient(336)
    yield tool.across(beside, None, slow)
    yield from out(tool, surface, clear, slow)
    yield tool.across((x, y))
    yield tool.turn(rpm)


def drilling(tool: CycleTool) -> Iterator[Block]:
    """Return the blocks of cycle 200: like 203, with equal infeeds and a full retract after each."""
    return universal_drilling(tool.seen({q: q for q in (200, 201, 202, 203, 204, 206, 210, 211)}))


def universal_drilling(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 203: pecks with Q213 chip breaks between full retracts.

    Q212 reduces the infeeds, down to Q205.
    """
    surface, clear, bottom = heights(tool)
    feed, whole = tool.feed(206), surface - bottom
    back, breaks = tool.length(256, 0.2), int(tool.plain(213, 0.0))
    yield tool.to(clear)
    if whole < SMALLEST:
        return
    depths = infeeds(tool, whole, tool.length(202), tool.length(212, 0.0), tool.length(205, 0.0))
    for count, depth in enumerate(depths, start=1):
        yield tool.to(surface - depth, feed)
        if depth >= whole - SMALLEST:
            break
        if breaks and count % (breaks + 1):
            yield tool.to(surface - depth + back)
        else:
            yield tool.to(clear)
            yield from tool.dwell(tool.plain(210, 0.0))
            yield tool.to(min(clear, surface - depth + tool.length(200)))
    yield from tool.dwell(tool.plain(211, 0.0))
    yield from out(tool, surface, clear, tool.feed(208) if tool.plain(208, 0.0) else None)


def deep_drilling(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 205: like cycle 203, but with a start point and stop distances.

    The start is at Q379. After a full retract, the rapid stops Q258 to Q259 above the last depth. Q257 is the
    depth between chip breaks.
    """
    surface, clear, bottom = heights(tool)
    feed, begin = tool.feed(206), surface - max(tool.length(379, 0.0), 0.0)
    whole, breaking, back = begin - bottom, tool.length(257, 0.0), tool.length(256, 0.2)
    yield tool.to(clear)
    if whole < SMALLEST:
        return
    if begin < surface:
        yield tool.to(begin + tool.length(200), tool.feed(253))
    near, far = tool.length(258, 0.2), tool.length(259, 0.2)
    broken = 0.0
    for depth in infeeds(tool, whole, tool.length(202), tool.length(212, 0.0), tool.length(205, 0.0)):
        while 0.0 < breaking < depth - broken - SMALLEST:
            broken += breaking
            yield tool.to(begin - broken, feed)
            yield tool.to(begin - broken + back)
        broken = depth
        yield tool.to(begin - depth, feed)
        if depth < whole - SMALLEST:
            yield tool.to(clear)
            yield tool.to(begin - depth + near + (far - near) * depth / whole)
    yield from tool.dwell(tool.plain(211, 0.0))
    yield from out(tool, surface, clear, tool.feed(208) if tool.plain(208, 0.0) else None)


def floating_tapping(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 206: down at Q206, spindle reversal, up."""
    surface, clear, bottom = heights(tool)
    lead = tool.lead_of(tool.cut(206))
    yield from _tapped(tool, surface, clear, bottom, lead, tool.rpm)


def rigid_tapping(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 207: like 206 with a pitch, whose sign sets the direction.

    At the end, the spindle has its previous speed and direction.
    """
    surface, clear, bottom = heights(tool)
    lead, rpm = _thread(tool)
    yield from _tapped(tool, surface, clear, bottom, lead, rpm)


def tapping_with_chip_breaking(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 209: rigid tapping with a spindle reversal after each depth Q257."""
    surface, clear, bottom = heights(tool)
    (lead, rpm), before = _thread(tool), tool.turns
    back, step = tool.length(256, 0.0), tool.length(257, 0.0)
    yield tool.to(clear)
    yield from tool.turning(rpm)
    for depth in infeeds(tool, surface - bottom, step or surface - bottom):
        last = depth >= surface - bottom - SMALLEST
        stays = not last and bool(back)
        yield tool.tap(surface - depth, lead, in_hole=True)
        yield tool.turn(-rpm, in_hole=True)
        yield tool.tap(surface - depth + back if stays else clear, lead, in_hole=stays)
        if not last:
            yield tool.turn(rpm, in_hole=stays)
    yield from tool.turning(before)
    yield from out(tool, surface, clear, None)


def _thread(tool: CycleTool) -> tuple[float, float]:
    """Return the lead in mm/rev and the signed speed into the thread. Raises ProgramError without a pitch."""
    tool.warn_uncoupled()
    pitch = tool.length(239)
    tool.check(pitch != 0.0, "Pitch Q239 must not be 0.", "Enter the thread pitch.")
    return abs(pitch), tool.thread_speed(pitch)


def _tapped(
    tool: CycleTool, surface: float, clear: float, bottom: float, lead: float, rpm: float
) -> Iterator[Block]:
    before = tool.turns
    yield tool.to(clear)
    if abs(bottom - surface) < SMALLEST:
        return
    yield from tool.turning(rpm)
    yield tool.tap(bottom, lead, in_hole=True)
    yield from tool.dwell(tool.plain(211, 0.0), in_hole=True)
    yield tool.turn(-rpm, in_hole=True)
    yield tool.tap(clear, lead)
    yield from tool.turning(before)
    yield from out(tool, surface, clear, None)


def bore_milling(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 208: a helix to the diameter Q335.

    The pitch is Q334. A full circle at the bottom finishes the hole.
    """
    surface, clear, bottom = heights(tool)
    feed = tool.feed(206) or 0.0
    way = tool.length(335) / 2.0 - tool.radius
    x, y = tool.here
    pitch = tool.length(334)
    text = "The tool, infeed or feed rate of cycle 208 is not valid for the hole."
    tool.check(way >= 0.0 and pitch > 0.0 and feed > 0.0, text, "Correct the entries named in the message.")
    yield tool.to(clear)
    if way < SMALLEST:
        yield tool.to(bottom, feed)
        yield from out(tool, surface, clear, None)
        return
    start = x + way, y
    yield tool.across(start, None, feed)
    clockwise = tool.plain(351, 1.0) < 0.0
    circle = Arc(start, start, (x, y), clockwise)
    for turn in range(1, math.ceil((clear - bottom) / pitch - SMALLEST) + 1):
        yield tool.round(circle, max(clear - turn * pitch, bottom), feed)
    yield tool.round(circle, bottom, feed)
    yield tool.across((x, y), None, feed)
    yield from out(tool, surface, clear, None)


def centring(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 240: centering to a depth, or to a diameter by the point angle."""
    if tool.plain(343, 0.0) == 1.0:
        surface = tool.length(203, 0.0)
        clear = surface + tool.length(200)
        half = math.radians(tool.point_angle) / 2.0
        bottom = surface - abs(tool.length(344)) / 2.0 / math.tan(half)
    else:
        surface, clear, bottom = heights(tool)
    yield tool.to(clear)
    yield tool.to(bottom, tool.feed(206))
    yield from tool.dwell(tool.plain(211, 0.0))
    yield from out(tool, surface, clear, None)


def single_lip_drilling(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 241.

    The tool enters at the speed Q427 to the start at Q379, drills at the speed Q428 with coolant, and leaves
    at the speed Q427.
    """
    surface, clear, bottom = heights(tool)
    rpm, sense = tool.rpm, {3: 1.0, 4: -1.0, 5: 0.0}.get(int(tool.plain(426, 3.0)))
    if sense is None:
        raise tool.refuse("Q426 must be 3, 4 or 5.", "Enter the M function for the spindle direction.")
    drilling = tool.plain(428, 0.0) * (sense or 1.0) or rpm
    slow, begin = tool.plain(427, 0.0) * sense, surface - max(tool.length(379, 0.0), 0.0)
    yield tool.to(clear)
    if begin - bottom < SMALLEST:
        return
    yield tool.turn(slow) if slow else tool.stop()
    yield tool.to(min(begin + tool.length(200), clear), tool.feed(253))
    yield tool.turn(drilling)
    yield from tool.coolant(429)
    feed = tool.feed(206)
    if 0.0 < (rest := tool.length(435, 0.0)) < surface - bottom and begin > surface - rest:
        yield tool.to(surface - rest, feed)
        yield from tool.dwell(tool.plain(211, 0.0))
    yield tool.to(bottom, feed)
    yield from tool.dwell(tool.plain(211, 0.0))
    yield from tool.coolant(430)
    yield tool.turn(slow) if slow else tool.stop()
    yield from out(tool, surface, clear, tool.feed(208) if tool.plain(208, 0.0) else None)
    yield tool.turn(rpm)


def heights(tool: CycleTool) -> tuple[float, float, float]:
    """Return surface, set-up clearance and bottom in mm. Raises ProgramError for a positive depth."""
    surface, depth = tool.length(203, 0.0), tool.length(201)
    text = "Depth Q201={depth} mm is positive (upward)."
    tool.check(depth <= 0.0, text, "Enter the depth with a minus sign.", depth=f"{depth:+.10g}")
    return surface, surface + tool.length(200), surface + depth


def infeeds(
    tool: CycleTool, whole: float, step: float, smaller: float = 0.0, least: float = 0.0
) -> Iterator[float]:
    """Yield the depths of the infeeds; the last one is the whole depth."""
    if step <= 0.0 or step >= whole:
        yield whole
        return
    if whole / max(step if not smaller else least or step, SMALLEST) > _MOST_PECKS:
        raise tool.refuse("An infeed of {step} mm would need too many pecks.", "Increase Q202.", step=step)
    done = 0.0
    while whole - done > SMALLEST:
        done = min(done + step, whole)
        yield done if whole - done > SMALLEST else whole
        step = max(step - smaller, least, SMALLEST) if smaller else step


def levels(tool: CycleTool, surface: float, bottom: float, step: Callable[[], float]) -> list[float]:
    """Return the heights of the infeeds from the surface down to the bottom; empty without a depth."""
    whole = surface - bottom
    return [] if whole < SMALLEST else [surface - done for done in infeeds(tool, whole, step())]


def out(tool: CycleTool, surface: float, clear: float, feed: float | None) -> Iterator[Block]:
    """Yield the retract to the set-up clearance, and to the second clearance if it is higher."""
    second = surface + tool.length(204, 0.0)
    if feed is None:
        yield tool.to(max(clear, second))
        return
    yield tool.to(clear, feed)
    if second > clear:
        yield tool.to(second)


HOLES: dict[int, Callable[[CycleTool], Iterator[Block]]] = {
    200: drilling,
    201: reaming,
    202: boring,
    203: universal_drilling,
    204: back_boring,
    205: deep_drilling,
    206: floating_tapping,
    207: rigid_tapping,
    208: bore_milling,
    209: tapping_with_chip_breaking,
    240: centring,
    241: single_lip_drilling,
}
"""Cycles by their number."""
