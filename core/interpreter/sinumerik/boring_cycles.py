"""CYCLE86, CYCLE87 and CYCLE88: boring that ends with the spindle held, or stopped for the operator."""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.actions import ProgramStop, SpindleLock, SpindleOrient, SpindleRun, SpindleStop
from core.interpreter.elementary_blocks import Block
from core.interpreter.sinumerik.cycle_parameters import Cycle, Step, dwell
from core.interpreter.sinumerik.drilling_cycles import Hole, approach, hole_of, needed_feed, seconds
from core.interpreter.sinumerik.spindle_and_dwell import demand_position, oriented_by_drive, shortest_turn

NO_DIRECTION = 61102


def _turning(cycle: Cycle) -> list[Step]:
    """The spindle in the direction SDIR. Raises ProgramError."""
    direction = cycle.number("SDIR")
    if direction not in {3.0, 4.0}:
        raise cycle.wrong("SDIR", "{name} must be 3 or 4", "Enter the spindle direction.", NO_DIRECTION)
    modal, sign = cycle.state.modal, 1 if direction == 3.0 else -1
    if not modal.rpm or modal.css:
        hint = "Write G97 with S before this block."
        raise cycle.refused("speed-missing", "{call} needs S in rpm.", hint)
    if modal.spindle == sign:
        return []
    return [Step(0.0, 0.0, action=SpindleRun(sign * modal.rpm), spindle=sign)]


def lift_off(cycle: Cycle) -> Iterator[Block]:
    """CYCLE86: at the bottom the spindle is held at POSS, the edge lifted by RPA and RPAP, and rapid out."""
    hole, state = hole_of(cycle), cycle.state
    demand_position(state, lambda text, hint: cycle.refused("spindle-position", text, hint))
    cycle.zero_only("RPO", "this lathe has no Y axis")
    angle = cycle.number("POSS")
    text = "{name} must be an angle from 0 to less than 360 degrees"
    cycle.check(0.0 <= angle < 360.0, "POSS", text, "Correct the value.")
    aside, up = cycle.length("RPA"), cycle.length("RPAP")
    text = "{name} would move the tool deeper into the hole"
    cycle.check(up * hole.down <= 0.0, "RPAP", text, "Correct the sign of RPAP.")
    x = cycle.x
    steps = [
        *approach(cycle, hole), *_turning(cycle), Step(x, hole.bottom, needed_feed(cycle)),
        *dwell(seconds(cycle, "DTB")), *_held_at(cycle, hole, angle),
    ]  # fmt: skip
    steps += [Step(x + aside, hole.bottom + up), Step(x + aside, hole.retract), Step(x, hole.retract)]
    return cycle.blocks(steps)


def _held_at(cycle: Cycle, hole: Hole, angle: float) -> list[Step]:
    """The spindle at an angle: by its drive, or held as C and turned there."""
    state = cycle.state
    if oriented_by_drive(state):
        return [Step(0.0, 0.0, action=SpindleOrient(angle), spindle=0)]
    steps = [Step(0.0, 0.0, action=SpindleLock(orient=False), spindle=0)]
    if turn := shortest_turn(state, angle):
        steps.append(Step(cycle.x, hole.bottom, state.setup.limits.speeds[2], turn=turn))
    return steps


def stop(cycle: Cycle) -> Iterator[Block]:
    """CYCLE87, CYCLE88: at the bottom the spindle comes to rest, M0 waits for the operator, and rapid out."""
    hole = hole_of(cycle)
    steps = [
        *approach(cycle, hole), *_turning(cycle), Step(cycle.x, hole.bottom, needed_feed(cycle)),
        *dwell(seconds(cycle, "DTB")), Step(0.0, 0.0, action=SpindleStop(stands=True), spindle=0),
        Step(0.0, 0.0, action=ProgramStop(optional=False)), Step(cycle.x, hole.retract),
    ]  # fmt: skip
    return cycle.blocks(steps)
