"""Drilling cycles CYCLE81 to 83 and 85 to 89 along Z under G17, and the hole patterns HOLES1 and HOLES2.

CYCLE86, CYCLE87 and CYCLE88 are boring cycles that orient or stop the spindle at the bottom of the hole.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin
from typing import NamedTuple

from core.interpreter.shared.actions import (
    ProgramStop,
    SpindleLock,
    SpindlePositioning,
    SpindleRun,
    SpindleStop,
)
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    MAX_PASS_COUNT,
    NO_SPINDLE_DIRECTION,
    CycleCall,
    CycleStep,
    make_action_step,
    make_dwell_steps,
)
from core.interpreter.sinumerik.setup.spindle_and_dwell import (
    check_spindle_positioning,
    compute_shortest_c_travel,
    is_oriented_by_drive,
)
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_words import LexedBlock
from core.message import Message

WRONG_REFERENCE_PLANE = 61101
WRONG_FIRST_DEPTH = 61107
_SAME = 1e-6  # mm


class HolePositions(NamedTuple):
    """The Z positions of one hole, including the retract plane, the reference plane and the bottom.

    ``drilling_sign`` is the sign of the drilling direction along Z. ``x`` is the current X position of the
    tool.
    """

    x: float
    retract_z: float
    reference_z: float
    clearance_z: float
    bottom_z: float
    drilling_sign: float

    def make_step(self, z: float, feed: float | None = None) -> CycleStep:
        """Return a step to ``z``, which is a rapid if ``feed`` is None."""
        return CycleStep(self.x, z, feed)


def read_hole_positions(cycle: CycleCall) -> HolePositions:
    """Return the hole of a cycle call.

    Raises ProgramError if G17 is not active or if a parameter is invalid. The error names the parameter.
    """
    if cycle.state.plane != 17:
        text = "{call} drills perpendicular to plane G{plane}; drilling along Z needs G17."
        hint = "Write G17 before this block and G18 after it."
        raise cycle.make_call_error("cycle-plane", text, hint, plane=cycle.state.plane)
    text = "{name} selects an axis other than Z, which is not supported"
    cycle.check_parameter(
        cycle.read_number("_AXN", 3.0) in {0.0, 3.0}, "_AXN", text, "Omit _AXN.", "not-in-subset"
    )
    retract, reference = cycle.read_required_length_mm("RTP"), cycle.read_required_length_mm("RFP")
    if cycle.has_argument("DP") == cycle.has_argument("DPR"):
        text = "{name} is missing"
        cycle.check_parameter(
            cycle.has_argument("DP"), "DP", text, "Enter DP, or DPR measured from the reference plane."
        )
        bottom = cycle.read_length_mm("DP")
        if cycle.read_length_mm("DPR") and abs(abs(bottom - reference) - cycle.read_length_mm("DPR")) > _SAME:
            cycle.log_warning("cycle-depth-both", "DP and DPR differ, so DP is used.", "Omit DP or DPR.")
    else:
        bottom = cycle.read_length_mm("DP")
        if cycle.has_argument("DPR"):
            bottom = reference - cycle.read_unsigned_length_mm("DPR") * (
                1.0 if retract >= reference else -1.0
            )
    down = 1.0 if bottom > reference else -1.0
    if abs(bottom - reference) < _SAME or (retract - reference) * down > _SAME:
        name = "DP" if cycle.has_argument("DP") else "DPR"
        text = "{name} is not beyond RFP as seen from RTP (RTP {retract}, RFP {reference}, depth {bottom})"
        hint = (
            "Correct RTP, RFP and the depth so that they follow in this order along the drilling direction."
        )
        raise cycle.make_parameter_error(
            name, text, hint, WRONG_REFERENCE_PLANE, retract=retract, reference=reference, bottom=bottom
        )
    return HolePositions(
        cycle.x, retract, reference, reference - down * cycle.read_unsigned_length_mm("SDIS"), bottom, down
    )


def read_dwell_s(cycle: CycleCall, name: str) -> float:
    """Return a dwell in seconds.

    A negative parameter value specifies spindle revolutions, which are converted to seconds.
    """
    value = cycle.read_number(name)
    if value >= 0.0:
        return value
    rpm = abs(cycle.state.rpm)
    text = "{name} is in revolutions, but the spindle is stopped"
    cycle.check_parameter(rpm, name, text, "Enter the dwell in seconds.")
    return -value / rpm * 60.0


def _feed(cycle: CycleCall) -> float:
    return cycle.require_feed(cycle.state.modal.feed)


def run_drilling(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE81 or CYCLE82.

    The tool feeds to the depth, dwells there for DTB if it is programmed, and retracts at rapid.
    """
    hole, feed = read_hole_positions(cycle), _feed(cycle)
    dwells = make_dwell_steps(read_dwell_s(cycle, "DTB"))
    return cycle.make_blocks(
        [
            hole.make_step(hole.clearance_z),
            hole.make_step(hole.bottom_z, feed),
            *dwells,
            hole.make_step(hole.retract_z),
        ]
    )


def run_boring(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE85 and CYCLE89.

    The tool feeds to the depth, dwells, and retracts at a feed.
    """
    hole = read_hole_positions(cycle)
    into, out = cycle.require_feed(cycle.read_feed("FFR")), cycle.require_feed(cycle.read_feed("RFF"))
    steps = [
        hole.make_step(hole.clearance_z),
        hole.make_step(hole.bottom_z, into),
        *make_dwell_steps(read_dwell_s(cycle, "DTB")),
    ]
    return cycle.make_blocks([*steps, hole.make_step(hole.clearance_z, out), hole.make_step(hole.retract_z)])


def run_peck_drilling(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE83. DAM reduces the depth of successive pecks.

    After each peck, the drill retracts fully (VARI 1) or by a short distance (VARI 0).
    """
    hole, feed = read_hole_positions(cycle), _feed(cycle)
    factor = cycle.read_number("FRF", 1.0) or 1.0
    if not 0.001 <= factor <= 1.0:
        raise cycle.make_parameter_error("FRF", "{name} must be a factor from 0.001 to 1")
    clears = cycle.read_machining_type("VARI", range(2)) == 1
    at_start, at_bottom = read_dwell_s(cycle, "DTS"), read_dwell_s(cycle, "DTB")
    back, ahead = cycle.read_unsigned_length_mm("_VRT") or 1.0, cycle.read_unsigned_length_mm("_DIS1")
    steps, reached, first = [hole.make_step(hole.clearance_z)], hole.reference_z, True
    for depth in compute_peck_z_positions(cycle, hole):
        if clears and not first:
            short = reached - hole.drilling_sign * (ahead or min(back, abs(depth - reached)))
            steps.append(hole.make_step(short))
        steps += [hole.make_step(depth, feed * (factor if first else 1.0)), *make_dwell_steps(at_bottom)]
        first, reached = False, depth
        if abs(depth - hole.bottom_z) < _SAME:
            break
        if clears:
            steps += [hole.make_step(hole.clearance_z), *make_dwell_steps(at_start)]
        else:
            steps.append(hole.make_step(depth - hole.drilling_sign * back, feed))
    return cycle.make_blocks([*steps, hole.make_step(hole.retract_z)])


def compute_peck_z_positions(cycle: CycleCall, hole: HolePositions) -> list[float]:
    """Return the Z position of each peck in mm.

    The first peck ends at FDEP or FDPR, and DAM reduces each following peck. A negative DAM is a factor.
    The last two pecks are equal.
    """
    whole = abs(hole.bottom_z - hole.reference_z)
    first = (
        abs(cycle.read_length_mm("FDEP") - hole.reference_z)
        if cycle.has_argument("FDEP")
        else cycle.read_unsigned_length_mm("FDPR")
    )
    if (
        cycle.has_argument("FDEP")
        and (cycle.read_length_mm("FDEP") - hole.reference_z) * hole.drilling_sign < -_SAME
    ):
        text = "{name} is before RFP in the drilling direction"
        raise cycle.make_parameter_error("FDEP", text, "Correct the value.", WRONG_FIRST_DEPTH)
    name = "FDEP" if cycle.has_argument("FDEP") else "FDPR"
    deeper = "{name} is deeper than the hole"
    cycle.check_parameter(first <= whole + _SAME, name, deeper, "Correct the value.", WRONG_FIRST_DEPTH)
    step, less, smallest = first or whole, cycle.read_number("DAM"), cycle.read_unsigned_length_mm("_MDEP")
    text = "{name} must be an amount, or a factor greater than -1 and not greater than 0"
    cycle.check_parameter(less > -1.0, "DAM", text)
    found, reached, halved = [step], step, False
    while reached < whole - _SAME:
        shorter = step * -less if less < 0.0 else step - less
        step = max(shorter, smallest or max(0.0, less)) if not halved else whole - reached
        if step < 1e-3 or len(found) > MAX_PASS_COUNT:
            raise cycle.make_parameter_error(
                "DAM", "{name} makes the pecks too small", "Enter _MDEP, or reduce DAM."
            )
        left = whole - reached
        if step < left - _SAME and left < 2.0 * step and not halved:
            step, halved = left / 2.0, True
        reached = min(reached + step, whole)
        found.append(reached)
    return [hole.reference_z + hole.drilling_sign * depth for depth in found]


def _turning(cycle: CycleCall) -> list[CycleStep]:
    """Return the step that starts the spindle in the direction SDIR, or no step if it already turns.

    Raises ProgramError if SDIR is not 3 or 4, if no speed is programmed, or if G96 is active.
    """
    direction = cycle.read_number("SDIR")
    if direction not in {3.0, 4.0}:
        raise cycle.make_parameter_error(
            "SDIR", "{name} must be 3 or 4", "Enter the spindle direction.", NO_SPINDLE_DIRECTION
        )
    modal, sign = cycle.state.modal, 1 if direction == 3.0 else -1
    hint = "Write G97 with S before this block."
    cycle.require_condition(modal.rpm and not modal.css, "speed-missing", "{call} needs S in rpm.", hint)
    return [] if modal.spindle == sign else [make_action_step(SpindleRun(sign * modal.rpm), sign)]


def run_boring_with_liftoff(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE86, boring with oriented spindle.

    At the bottom, the spindle is oriented to POSS, and the cutting edge is lifted off the wall by RPA and
    RPAP. The tool retracts at rapid.
    """
    hole, state = read_hole_positions(cycle), cycle.state
    check_spindle_positioning(state, lambda text, hint: cycle.make_call_error("spindle-position", text, hint))
    cycle.check_unsupported_parameter("RPO", "this lathe has no Y axis")
    angle = cycle.read_angle_deg("POSS", "{name} must be an angle from 0 to less than 360 degrees")
    aside, up = cycle.read_length_mm("RPA"), cycle.read_length_mm("RPAP")
    text = "{name} would move the tool deeper into the hole"
    cycle.check_parameter(up * hole.drilling_sign <= 0.0, "RPAP", text, "Correct the sign of RPAP.")
    steps = [*_steps_to_bottom(cycle, hole), *_steps_to_spindle_angle(cycle, hole, angle)]
    lifted = hole._replace(x=cycle.x + aside)
    steps += [
        lifted.make_step(hole.bottom_z + up),
        lifted.make_step(hole.retract_z),
        hole.make_step(hole.retract_z),
    ]
    return cycle.make_blocks(steps)


def _steps_to_bottom(cycle: CycleCall, hole: HolePositions) -> list[CycleStep]:
    """Return the steps from the clearance position to the bottom, including the dwell there.

    Before the feed to the bottom, the spindle is started in the direction SDIR, unless it already runs in
    this direction.
    """
    steps = [hole.make_step(hole.clearance_z), *_turning(cycle), hole.make_step(hole.bottom_z, _feed(cycle))]
    return [*steps, *make_dwell_steps(read_dwell_s(cycle, "DTB"))]


def _steps_to_spindle_angle(cycle: CycleCall, hole: HolePositions, angle: float) -> list[CycleStep]:
    """Return the steps that orient the spindle to an angle, by its drive or as the C axis."""
    if is_oriented_by_drive(cycle.state):
        return [make_action_step(SpindlePositioning(angle), 0)]
    return make_spindle_lock_steps(cycle, hole.make_step(hole.bottom_z), angle)


def make_spindle_lock_steps(cycle: CycleCall, position: CycleStep, angle: float) -> list[CycleStep]:
    """Return the steps that lock the spindle as the C axis and rotate it to an angle.

    The spindle is locked at the current position. The angle is in degrees.
    """
    turn, speed = compute_shortest_c_travel(cycle.state, angle), cycle.state.setup.limits.max_axis_speeds[2]
    turned = [position._replace(feed=speed, c_travel_deg=turn)] if turn else []
    return [make_action_step(SpindleLock(orient=False), 0), *turned]


def stop(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE87 or CYCLE88, drilling with a stop at the bottom.

    At the bottom, the spindle stops and the program stops with M0. The tool then retracts at rapid.
    """
    hole = read_hole_positions(cycle)
    rest = [
        make_action_step(SpindleStop(waits_for_standstill=True), 0),
        make_action_step(ProgramStop(optional=False)),
    ]
    return cycle.make_blocks([*_steps_to_bottom(cycle, hole), *rest, hole.make_step(hole.retract_z)])


HOLE_PATTERNS = frozenset({"HOLES1", "HOLES2"})
_MAX_HOLES = 1000


def make_missing_cycle_error(line: LexedBlock) -> ProgramError:
    """Return the error for a hole pattern if no drilling cycle is active."""
    text = Message("{call} uses the cycle called with MCALL, but no MCALL is active.", call=line.called_name)
    hint = "Write MCALL CYCLE81( ) or another cycle before this block."
    return line.make_error(line.call_column, "pattern-cycle", text, hint)


def generate_pattern_moves(state: SinumerikState, line: LexedBlock) -> Iterator[Block]:
    """Yield a rapid to each hole of a pattern in X and Y of the face.

    Raises ProgramError if TRANSMIT is not active, or for invalid parameters.
    """
    cycle = CycleCall(state, line)
    plane = state.transformation
    if plane is None or not plane.is_depth_along_z:
        text = Message(
            "{call} uses positions in X and Y, but this lathe has no Y axis.", call=line.called_name
        )
        raise cycle.make_call_error(
            "not-in-subset", text, "Write TRANSMIT before this block, or program the positions after MCALL."
        )
    number = cycle.read_whole_number("NUM", 0, 0, _MAX_HOLES)
    if not number:
        raise cycle.make_parameter_error(
            "NUM", "{name} is the number of holes and must be greater than 0", "Correct the value."
        )
    found = _row(cycle, number) if line.called_name == "HOLES1" else _circle(cycle, number)
    for k, (x, y) in enumerate(found, 1):
        yield plane.make_rapid_to_hole(cycle.statement, x, y, f"{line.called_name} {k}/{number}")


def _row(cycle: CycleCall, number: int) -> list[tuple[float, float]]:
    """Return the hole positions of HOLES1, a row of holes.

    The row passes through (SPCA, SPCO) at the angle STA1. The first hole is at the distance FDIS from this
    point, and the spacing is DBH.
    """
    x, y, angle = (
        cycle.read_length_mm("SPCA"),
        cycle.read_length_mm("SPCO"),
        radians(cycle.read_number("STA1")),
    )
    first, apart = cycle.read_length_mm("FDIS"), cycle.read_unsigned_length_mm("DBH")
    if number > 1 and not apart:
        raise cycle.make_parameter_error(
            "DBH",
            "{name} is the distance between the holes and must be greater than 0",
            "Correct the value.",
        )
    distances_mm = [first + apart * k for k in range(number)]
    return [(x + distance_mm * cos(angle), y + distance_mm * sin(angle)) for distance_mm in distances_mm]


def _circle(cycle: CycleCall, number: int) -> list[tuple[float, float]]:
    """Return the hole positions of HOLES2.

    The holes are on a circle with the radius RAD about (CPA, CPO), starting at the angle STA1 with the
    spacing INDA. Without INDA, the holes are spaced equally on the full circle.
    """
    x, y, radius = (
        cycle.read_length_mm("CPA"),
        cycle.read_length_mm("CPO"),
        cycle.read_positive_length_mm("RAD"),
    )
    first, apart = cycle.read_number("STA1"), cycle.read_number("INDA") or 360.0 / number
    angles = [radians(first + apart * k) for k in range(number)]
    return [(x + radius * cos(angle), y + radius * sin(angle)) for angle in angles]
