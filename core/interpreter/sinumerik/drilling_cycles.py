"""CYCLE81, 82, 83, 85 and 89: a hole along Z under G17, in one go or in pecks, with dwells and feeds."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.cycle_parameters import MOST_PASSES, Cycle, Step, dwell

REFERENCE_PLANE = 61101
FIRST_DEPTH = 61107
_SAME = 1e-6  # mm


class Hole(NamedTuple):
    """Z of retraction plane, reference plane, safety distance before it, bottom; ``down`` is -1 or +1."""

    retract: float
    reference: float
    clear: float
    bottom: float
    down: float


def hole_of(cycle: Cycle) -> Hole:
    """The hole that a call asks for. Raises ProgramError by the parameter's name."""
    if cycle.state.plane != 17:
        text = "{call} drills perpendicular to plane G{plane}; drilling along Z needs G17."
        hint = "Write G17 before this block and G18 after it."
        raise cycle.refused("cycle-plane", text, hint, plane=cycle.state.plane)
    text = "{name} selects an axis other than Z, which is not supported"
    cycle.check(cycle.number("_AXN", 3.0) in {0.0, 3.0}, "_AXN", text, "Omit _AXN.", "not-in-subset")
    retract, reference = cycle.needed("RTP"), cycle.needed("RFP")
    if cycle.given("DP") == cycle.given("DPR"):
        text = "{name} is missing"
        cycle.check(cycle.given("DP"), "DP", text, "Enter DP, or DPR measured from the reference plane.")
        bottom = cycle.length("DP")
        if cycle.length("DPR") and abs(abs(bottom - reference) - cycle.length("DPR")) > _SAME:
            cycle.warn("cycle-depth-both", "DP and DPR differ, so DP is used.", "Omit DP or DPR.")
    else:
        bottom = cycle.length("DP")
        if cycle.given("DPR"):
            bottom = reference - cycle.size("DPR") * (1.0 if retract >= reference else -1.0)
    down = 1.0 if bottom > reference else -1.0
    if abs(bottom - reference) < _SAME or (retract - reference) * down > _SAME:
        name = "DP" if cycle.given("DP") else "DPR"
        text = "{name} is not beyond RFP as seen from RTP (RTP {retract}, RFP {reference}, depth {bottom})"
        hint = (
            "Correct RTP, RFP and the depth so that they follow in this order along the drilling direction."
        )
        raise cycle.wrong(
            name, text, hint, REFERENCE_PLANE, retract=retract, reference=reference, bottom=bottom
        )
    return Hole(retract, reference, reference - down * cycle.size("SDIS"), bottom, down)


def seconds(cycle: Cycle, name: str) -> float:
    """A dwell: seconds, or under 0 revolutions of the spindle."""
    value = cycle.number(name)
    if value >= 0.0:
        return value
    rpm = abs(cycle.state.rpm)
    text = "{name} is in revolutions, but the spindle is stopped"
    cycle.check(rpm, name, text, "Enter the dwell in seconds.")
    return -value / rpm * 60.0


def needed_feed(cycle: Cycle, name: str = "") -> float:
    feed = cycle.feed(name) if name else cycle.state.modal.feed
    if feed is None:
        raise cycle.refused(10860, "no feedrate is programmed.", "Program F before this block.")
    return feed


def approach(cycle: Cycle, hole: Hole) -> list[Step]:
    return [Step(cycle.x, hole.clear)]


def drill(cycle: Cycle) -> Iterator[Block]:
    """CYCLE81, CYCLE82: feed to the depth, dwell, rapid out."""
    hole, feed = hole_of(cycle), needed_feed(cycle)
    bottom = Step(cycle.x, hole.bottom, feed)
    steps = [*approach(cycle, hole), bottom, *dwell(seconds(cycle, "DTB")), Step(cycle.x, hole.retract)]
    return cycle.blocks(steps)


def bore(cycle: Cycle) -> Iterator[Block]:
    """CYCLE85, CYCLE89: out at a feed, too."""
    hole = hole_of(cycle)
    into, out = needed_feed(cycle, "FFR"), needed_feed(cycle, "RFF")
    steps = [
        *approach(cycle, hole), Step(cycle.x, hole.bottom, into), *dwell(seconds(cycle, "DTB")),
        Step(cycle.x, hole.clear, out), Step(cycle.x, hole.retract),
    ]  # fmt: skip
    return cycle.blocks(steps)


def peck(cycle: Cycle) -> Iterator[Block]:
    """CYCLE83: pecks that grow smaller by DAM, with a way out (VARI 1) or a short one back (VARI 0)."""
    hole, feed = hole_of(cycle), needed_feed(cycle)
    factor = cycle.number("FRF", 1.0) or 1.0
    if not 0.001 <= factor <= 1.0:
        raise cycle.wrong("FRF", "{name} must be a factor from 0.001 to 1", "Correct the value.")
    clears = cycle.machining("VARI", range(2)) == 1
    at_start, at_bottom = seconds(cycle, "DTS"), seconds(cycle, "DTB")
    back = cycle.size("_VRT") or 1.0
    ahead = cycle.size("_DIS1")
    steps, reached, first = approach(cycle, hole), hole.reference, True
    for depth in depths(cycle, hole):
        if clears and not first:
            short = reached - hole.down * (ahead or min(back, abs(depth - reached)))
            steps += [Step(cycle.x, short)]
        steps += [Step(cycle.x, depth, feed * (factor if first else 1.0)), *dwell(at_bottom)]
        first, reached = False, depth
        if abs(depth - hole.bottom) < _SAME:
            break
        if clears:
            steps += [Step(cycle.x, hole.clear), *dwell(at_start)]
        else:
            steps += [Step(cycle.x, depth - hole.down * back, feed)]
    return cycle.blocks([*steps, Step(cycle.x, hole.retract)])


def depths(cycle: Cycle, hole: Hole) -> list[float]:
    """Z of each peck: FDEP or FDPR first, each then less by DAM (under 0: times), the last two alike."""
    whole = abs(hole.bottom - hole.reference)
    first = abs(cycle.length("FDEP") - hole.reference) if cycle.given("FDEP") else cycle.size("FDPR")
    if cycle.given("FDEP") and (cycle.length("FDEP") - hole.reference) * hole.down < -_SAME:
        text = "{name} is before RFP in the drilling direction"
        raise cycle.wrong("FDEP", text, "Correct the value.", FIRST_DEPTH)
    if first > whole + _SAME:
        name = "FDEP" if cycle.given("FDEP") else "FDPR"
        raise cycle.wrong(name, "{name} is deeper than the hole", "Correct the value.", FIRST_DEPTH)
    step, less, least = first or whole, cycle.number("DAM"), cycle.size("_MDEP")
    text = "{name} must be an amount, or a factor greater than -1 and not greater than 0"
    cycle.check(less > -1.0, "DAM", text, "Correct the value.")
    smallest = max(least, 0.0)
    found, reached, halved = [step], step, False
    while reached < whole - _SAME:
        shorter = step * -less if less < 0.0 else step - less
        floor = smallest or (max(0.0, less))
        step = max(shorter, floor) if not halved else whole - reached
        if step < 1e-3 or len(found) > MOST_PASSES:
            raise cycle.wrong("DAM", "{name} makes the pecks too small", "Enter _MDEP, or reduce DAM.")
        left = whole - reached
        if step < left - _SAME and left < 2.0 * step and not halved:
            step, halved = left / 2.0, True
        reached = min(reached + step, whole)
        found.append(reached)
    return [hole.reference + hole.down * depth for depth in found]
