"""Drilling cycles CYCLE81 to 83 and 85 to 89 along Z under G17, and the hole patterns HOLES1 and HOLES2.

CYCLE86, CYCLE87 and CYCLE88 are boring cycles that orient or stop the spindle at the bottom.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin
from typing import NamedTuple

from core.interpreter.shared.actions import ProgramStop, SpindleLock, SpindleOrient, SpindleRun, SpindleStop
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    MOST_PASSES,
    NO_DIRECTION,
    Cycle,
    Step,
    acting,
    dwell,
)
from core.interpreter.sinumerik.setup.spindle_and_dwell import (
    demand_position,
    oriented_by_drive,
    shortest_turn,
)
from core.interpreter.sinumerik.sinumerik_state import State
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import Line
from core.message import Message

REFERENCE_PLANE = 61101
FIRST_DEPTH = 61107
_SAME = 1e-6  # mm


class Hole(NamedTuple):
    """Z positions of one hole: retract plane, reference plane, safety clearance and bottom.

    ``down`` is the drilling direction, -1 or +1. ``x`` is the present X position of the tool.
    """

    x: float
    retract: float
    reference: float
    clear: float
    bottom: float
    down: float

    def to(self, z: float, feed: float | None = None) -> Step:
        """Return a step to ``z``, in rapid without a feed."""
        return Step(self.x, z, feed)


def hole_of(cycle: Cycle) -> Hole:
    """Return the hole of a call. Raises ProgramError with the name of an invalid parameter."""
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
    return Hole(cycle.x, retract, reference, reference - down * cycle.size("SDIS"), bottom, down)


def seconds(cycle: Cycle, name: str) -> float:
    """Return a dwell in seconds; a negative value is in spindle revolutions."""
    value = cycle.number(name)
    if value >= 0.0:
        return value
    rpm = abs(cycle.state.rpm)
    text = "{name} is in revolutions, but the spindle is stopped"
    cycle.check(rpm, name, text, "Enter the dwell in seconds.")
    return -value / rpm * 60.0


def _feed(cycle: Cycle) -> float:
    return cycle.known_feed(cycle.state.modal.feed)


def drill(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE81 and CYCLE82: feed to the depth, dwell, rapid out."""
    hole, feed = hole_of(cycle), _feed(cycle)
    dwells = dwell(seconds(cycle, "DTB"))
    return cycle.blocks([hole.to(hole.clear), hole.to(hole.bottom, feed), *dwells, hole.to(hole.retract)])


def bore(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE85 and CYCLE89: feed to the depth, dwell, feed out."""
    hole = hole_of(cycle)
    into, out = cycle.known_feed(cycle.feed("FFR")), cycle.known_feed(cycle.feed("RFF"))
    steps = [hole.to(hole.clear), hole.to(hole.bottom, into), *dwell(seconds(cycle, "DTB"))]
    return cycle.blocks([*steps, hole.to(hole.clear, out), hole.to(hole.retract)])


def peck(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE83: pecks that decrease by DAM.

    After each peck, the drill retracts fully (VARI 1) or by a short distance (VARI 0).
    """
    hole, feed = hole_of(cycle), _feed(cycle)
    factor = cycle.number("FRF", 1.0) or 1.0
    if not 0.001 <= factor <= 1.0:
        raise cycle.wrong("FRF", "{name} must be a factor from 0.001 to 1")
    clears = cycle.machining("VARI", range(2)) == 1
    at_start, at_bottom = seconds(cycle, "DTS"), seconds(cycle, "DTB")
    back, ahead = cycle.size("_VRT") or 1.0, cycle.size("_DIS1")
    steps, reached, first = [hole.to(hole.clear)], hole.reference, True
    for depth in depths(cycle, hole):
        if clears and not first:
            short = reached - hole.down * (ahead or min(back, abs(depth - reached)))
            steps.append(hole.to(short))
        steps += [hole.to(depth, feed * (factor if first else 1.0)), *dwell(at_bottom)]
        first, reached = False, depth
        if abs(depth - hole.bottom) < _SAME:
            break
        if clears:
            steps += [hole.to(hole.clear), *dwell(at_start)]
        else:
            steps.append(hole.to(depth - hole.down * back, feed))
    return cycle.blocks([*steps, hole.to(hole.retract)])


def depths(cycle: Cycle, hole: Hole) -> list[float]:
    """Return Z of each peck: the first at FDEP or FDPR, each following peck reduced by DAM.

    A negative DAM is a factor. The last two pecks are equal.
    """
    whole = abs(hole.bottom - hole.reference)
    first = abs(cycle.length("FDEP") - hole.reference) if cycle.given("FDEP") else cycle.size("FDPR")
    if cycle.given("FDEP") and (cycle.length("FDEP") - hole.reference) * hole.down < -_SAME:
        text = "{name} is before RFP in the drilling direction"
        raise cycle.wrong("FDEP", text, "Correct the value.", FIRST_DEPTH)
    name = "FDEP" if cycle.given("FDEP") else "FDPR"
    deeper = "{name} is deeper than the hole"
    cycle.check(first <= whole + _SAME, name, deeper, "Correct the value.", FIRST_DEPTH)
    step, less, smallest = first or whole, cycle.number("DAM"), cycle.size("_MDEP")
    text = "{name} must be an amount, or a factor greater than -1 and not greater than 0"
    cycle.check(less > -1.0, "DAM", text)
    found, reached, halved = [step], step, False
    while reached < whole - _SAME:
        shorter = step * -less if less < 0.0 else step - less
        step = max(shorter, smallest or max(0.0, less)) if not halved else whole - reached
        if step < 1e-3 or len(found) > MOST_PASSES:
            raise cycle.wrong("DAM", "{name} makes the pecks too small", "Enter _MDEP, or reduce DAM.")
        left = whole - reached
        if step < left - _SAME and left < 2.0 * step and not halved:
            step, halved = left / 2.0, True
        reached = min(reached + step, whole)
        found.append(reached)
    return [hole.reference + hole.down * depth for depth in found]


def _turning(cycle: Cycle) -> list[Step]:
    """Return a spindle start in the direction SDIR, if necessary. Raises ProgramError without a speed."""
    direction = cycle.number("SDIR")
    if direction not in {3.0, 4.0}:
        raise cycle.wrong("SDIR", "{name} must be 3 or 4", "Enter the spindle direction.", NO_DIRECTION)
    modal, sign = cycle.state.modal, 1 if direction == 3.0 else -1
    hint = "Write G97 with S before this block."
    cycle.require(modal.rpm and not modal.css, "speed-missing", "{call} needs S in rpm.", hint)
    return [] if modal.spindle == sign else [acting(SpindleRun(sign * modal.rpm), sign)]


def lift_off(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE86.

    At the bottom, the spindle is oriented to POSS, and the edge is lifted by RPA and RPAP. The retract is a
    rapid.
    """
    hole, state = hole_of(cycle), cycle.state
    demand_position(state, lambda text, hint: cycle.refused("spindle-position", text, hint))
    cycle.zero_only("RPO", "this lathe has no Y axis")
    angle = cycle.angle("POSS", "{name} must be an angle from 0 to less than 360 degrees")
    aside, up = cycle.length("RPA"), cycle.length("RPAP")
    text = "{name} would move the tool deeper into the hole"
    cycle.check(up * hole.down <= 0.0, "RPAP", text, "Correct the sign of RPAP.")
    steps = [*_bored(cycle, hole), *_held_at(cycle, hole, angle)]
    lifted = hole._replace(x=cycle.x + aside)
    steps += [lifted.to(hole.bottom + up), lifted.to(hole.retract), hole.to(hole.retract)]
    return cycle.blocks(steps)


def _bored(cycle: Cycle, hole: Hole) -> list[Step]:
    """Return the steps to the bottom with the spindle turning by SDIR, and the dwell there."""
    steps = [hole.to(hole.clear), *_turning(cycle), hole.to(hole.bottom, _feed(cycle))]
    return [*steps, *dwell(seconds(cycle, "DTB"))]


def _held_at(cycle: Cycle, hole: Hole, angle: float) -> list[Step]:
    """Return the steps that bring the spindle to an angle, by its drive or as the C axis."""
    if oriented_by_drive(cycle.state):
        return [acting(SpindleOrient(angle), 0)]
    return locked(cycle, hole.to(hole.bottom), angle)


def locked(cycle: Cycle, at: Step, angle: float) -> list[Step]:
    """Return the steps that lock the spindle as C at the present position and turn it to an angle."""
    turn, speed = shortest_turn(cycle.state, angle), cycle.state.setup.limits.speeds[2]
    turned = [at._replace(feed=speed, turn=turn)] if turn else []
    return [acting(SpindleLock(orient=False), 0), *turned]


def stop(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE87 and CYCLE88: stop the spindle at the bottom, M0, rapid out."""
    hole = hole_of(cycle)
    rest = [acting(SpindleStop(stands=True), 0), acting(ProgramStop(optional=False))]
    return cycle.blocks([*_bored(cycle, hole), *rest, hole.to(hole.retract)])


PATTERNS = frozenset({"HOLES1", "HOLES2"})
_MOST = 1000


def no_cycle(line: Line) -> ProgramError:
    """Return the error for a hole pattern without a drilling cycle."""
    text = Message("{call} uses the cycle called with MCALL, but no MCALL is active.", call=line.call)
    hint = "Write MCALL CYCLE81( ) or another cycle before this block."
    return line.refuse(line.call_column, "pattern-cycle", text, hint)


def places(state: State, line: Line) -> Iterator[Block]:
    """Yield a rapid to each hole of a pattern in X and Y of the face. Raises ProgramError."""
    cycle = Cycle(state, line)
    plane = state.transformation
    if plane is None or not plane.along_z:
        text = Message("{call} uses positions in X and Y, but this lathe has no Y axis.", call=line.call)
        raise cycle.refused(
            "not-in-subset", text, "Write TRANSMIT before this block, or program the positions after MCALL."
        )
    number = cycle.whole("NUM", 0, 0, _MOST)
    if not number:
        raise cycle.wrong(
            "NUM", "{name} is the number of holes and must be greater than 0", "Correct the value."
        )
    found = _row(cycle, number) if line.call == "HOLES1" else _circle(cycle, number)
    for k, (x, y) in enumerate(found, 1):
        yield plane.over(cycle.statement, x, y, f"{line.call} {k}/{number}")


def _row(cycle: Cycle, number: int) -> list[tuple[float, float]]:
    """Return the holes of HOLES1: along the angle STA1 from SPCA, SPCO, the first at FDIS, spaced by DBH."""
    x, y, angle = cycle.length("SPCA"), cycle.length("SPCO"), radians(cycle.number("STA1"))
    first, apart = cycle.length("FDIS"), cycle.size("DBH")
    if number > 1 and not apart:
        raise cycle.wrong(
            "DBH",
            "{name} is the distance between the holes and must be greater than 0",
            "Correct the value.",
        )
    ways = [first + apart * k for k in range(number)]
    return [(x + way * cos(angle), y + way * sin(angle)) for way in ways]


def _circle(cycle: Cycle, number: int) -> list[tuple[float, float]]:
    """Return the holes of HOLES2: on radius RAD about CPA, CPO from the angle STA1, spaced by INDA.

    Without INDA, the holes are spaced equally on the full circle.
    """
    x, y, radius = cycle.length("CPA"), cycle.length("CPO"), cycle.over_zero("RAD")
    first, apart = cycle.number("STA1"), cycle.number("INDA") or 360.0 / number
    angles = [radians(first + apart * k) for k in range(number)]
    return [(x + radius * cos(angle), y + radius * sin(angle)) for angle in angles]
