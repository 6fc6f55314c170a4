"""CYCLE92: the part is parted off, slower near the axis.

What its parameters mean is told by the maker's operating manuals, their names and order by public lists of
them; what the digits of ``_DMODE`` and ``_AMODE`` mean is told nowhere, so that only depths as diameters are
taken. The edge in force goes down at SPL.
"""

from __future__ import annotations

from collections.abc import Iterator

from core.interpreter.actions import SpindleRun
from core.interpreter.elementary_blocks import Block
from core.interpreter.modal_state import Modal
from core.interpreter.sinumerik.cycle_parameters import NO_DIRECTION, NO_FEED, RETRACT, Cycle, Step
from core.interpreter.units import FEET_PER_MINUTE, METRES_PER_MINUTE

WRONG_DEPTH = 61604
_SPEED = "{name} is {value}, which is not a valid speed for this spindle"
_DIRECTION = {3: 1, 4: -1}  # of _SDAC


def part_off(cycle: Cycle) -> Iterator[Block]:
    """Down to _DIAG1 at _FF1, from there to _DIAG2 at _FF2 and _SS2 rpm. Raises ProgramError before a block.

    A speed _SV1 is one of the surface beside its limit _SV2, counted as G96 counts S, else rpm; behind the
    cycle the speed of before is in force again, or the last one where the spindle stood without a speed.
    """
    cycle.zero_only("_RC", "cut the chamfer or the radius with G1 before the cycle")
    cycle.zero_only("_VARI", "the tool only retracts, because this machine has no parts catcher")
    text = "{name} specifies depths measured from SPD, which is not supported"
    hint = "Enter _DIAG1 and _DIAG2 as diameters, and omit _AMODE."
    cycle.check(not cycle.whole("_AMODE", 0, 0, 10**8) % 100, "_AMODE", text, hint, "not-in-subset")
    slow, last = _depths(cycle)
    first, second = _feeds(cycle)
    before = cycle.state.modal
    fast = _speed(cycle, before)
    rpm = cycle.number("_SS2")
    cycle.check(0.0 <= rpm <= cycle.state.setup.limits.max_rpm, "_SS2", _SPEED, value=rpm)
    place, surface = cycle.needed("SPL"), cycle.needed("SPD") / 2.0
    clear = surface + (cycle.size("_SDIS") or RETRACT)
    down = [*cycle.off_part(clear), Step(max(clear, cycle.x), place), Step(clear, place)]
    through = [Step(last, place, second), Step(clear, place)]
    return _blocks(cycle, (fast, before, rpm), [*down, Step(slow, place, first)], through)


def _depths(cycle: Cycle) -> tuple[float, float]:
    """Radii at which the tool slows down and stands still. Raises ProgramError."""
    surface, last = cycle.over_zero("SPD"), cycle.needed("_DIAG2")
    slow = cycle.length("_DIAG1", last) if cycle.given("_DIAG1") else last
    if not last <= slow <= surface:
        text = "{name} is {slow} but must be between SPD {surface} and _DIAG2 {last}"
        hint = "Enter diameters, with SPD as the largest."
        raise cycle.wrong("_DIAG1", text, hint, WRONG_DEPTH, slow=slow, surface=surface, last=last)
    return slow / 2.0, last / 2.0


def _feeds(cycle: Cycle) -> tuple[float, float]:
    first = cycle.known_feed(cycle.feed("_FF1"), NO_FEED, "Write _FF1.")
    second = cycle.feed("_FF2") if cycle.number("_FF2") else first
    return first, second or first


def _speed(cycle: Cycle, before: Modal) -> Modal:
    """What is in force down to _DIAG1. Raises ProgramError where the spindle would stand."""
    value, most = cycle.number("_SV1"), cycle.number("_SV2")
    direction = cycle.whole("_SDAC", 0, 0, 4)
    if direction and direction not in _DIRECTION:
        text = "{name} cannot be {value}"
        raise cycle.wrong("_SDAC", text, "Enter 3 for M3 or 4 for M4.", NO_DIRECTION, value=direction)
    modal = before._replace(spindle=_DIRECTION.get(direction, before.spindle))
    highest = cycle.state.setup.limits.max_rpm
    fine = value >= 0.0 and most >= 0.0 and (value <= highest or most)
    cycle.check(fine, "_SV1", _SPEED, value=value)
    if value and most:
        unit = METRES_PER_MINUTE if before.metric else FEET_PER_MINUTE
        modal = modal._replace(css=True, surface_speed=value * unit, css_max=most)
    elif value:
        modal = modal._replace(css=False, rpm=value)
    if not modal.spindle or not (modal.surface_speed if modal.css else modal.rpm):
        text = "the spindle is stopped, and neither _SV1 with _SDAC nor S with M3 starts it."
        raise cycle.refused(NO_DIRECTION, text, "Write S and M3 before this block.")
    return modal


def _blocks(
    cycle: Cycle, speeds: tuple[Modal, Modal, float], down: list[Step], through: list[Step]
) -> Iterator[Block]:
    """Both halves, each at its speed. The first asks for all that can be refused."""
    fast, before, rpm = speeds
    state = cycle.state
    slow = fast._replace(css=False, rpm=rpm) if rpm else fast
    if fast != before:
        state.adopt(fast)
        yield _turning(cycle)
    yield from cycle.blocks(down)
    cycle.x, cycle.z = down[-1].x, down[-1].z
    if slow != fast:
        state.adopt(slow)
        yield _turning(cycle)
    yield from cycle.blocks(through)
    if slow != before:
        state.adopt(state.modal._replace(css=before.css, surface_speed=before.surface_speed, rpm=before.rpm,
                                         css_max=before.css_max))  # fmt: skip
        if state.rpm:
            yield _turning(cycle)
        else:
            state.adopt(slow)  # it goes on turning, and what is in force says so


def _turning(cycle: Cycle) -> Block:
    """The spindle at the speed that is in force now."""
    state = cycle.state
    text = f"G96 S{(state.css or 0.0) / METRES_PER_MINUTE:g}" if state.css else f"S{abs(state.rpm):g}"
    return state.action(cycle.line.number, text, SpindleRun(state.rpm, state.css))
