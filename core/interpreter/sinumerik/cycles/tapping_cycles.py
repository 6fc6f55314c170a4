"""Tapping with CYCLE84, CYCLE840, G331 and G332: rigid with the C axis, or with a compensating chuck.

In rigid tapping, C turns in proportion to the travel along Z, one revolution per lead. With a compensating
chuck, Z moves at a feed per revolution, and the spindle reverses at the bottom.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign

from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.interpreter.sinumerik.cycles.cycle_parameters import NO_DIRECTION, Cycle, Step, acting, dwell
from core.interpreter.sinumerik.cycles.drilling_cycles import Hole, hole_of, locked, seconds
from core.interpreter.sinumerik.cycles.thread_cycle import WRONG_LEAD, check_lead, coarse_lead
from core.interpreter.sinumerik.motion.linear_moves import block_of, travel_of
from core.interpreter.sinumerik.setup.spindle_and_dwell import demand_spindle_as_c
from core.interpreter.sinumerik.sinumerik_state import Motion, State
from core.interpreter.sinumerik.sinumerik_statement import Statement

_SAME = 1e-6  # mm
_INCH = 25.4


def lead_of_tap(cycle: Cycle) -> float:
    """Return the lead (PIT or MPIT) in mm/rev, negative for a left-hand thread; 0 if neither is given."""
    unit = cycle.whole("_PITA", 0, 0, 4)
    text = "{name} is 4, which specifies the lead as a module"
    cycle.check(unit != 4, "_PITA", text, "Enter PIT in mm.", WRONG_LEAD)
    pit, size = cycle.number("PIT"), cycle.number("MPIT")
    if pit:
        in_inches = unit == 3 or (unit == 0 and not cycle.state.modal.metric)
        return _INCH / pit if unit == 2 else pit * (_INCH if in_inches else 1.0)
    if not size:
        return 0.0
    lead = coarse_lead(size)
    check_lead(cycle, lead, "MPIT")
    return copysign(lead, size)


# --- rigid


def rigid(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE84: orient the spindle to POSS, tap in at SST and out at SST1.

    Raises ProgramError for invalid parameters.
    """
    hole, state = hole_of(cycle), cycle.state
    demand_spindle_as_c(state, lambda text, hint: cycle.refused("spindle-position", text, hint))
    lead = lead_of_tap(cycle)
    check_lead(cycle, lead, "PIT")
    into = _speed(cycle, "SST", state.modal.rpm)
    out = _speed(cycle, "SST1", into)
    rest = cycle.whole("SDAC", 5, 3, 5)
    text = "{name} starts the spindle, but no S is programmed"
    cycle.check(rest == 5 or state.modal.rpm, "SDAC", text, "Write S before this block.")
    wanted = cycle.angle("POSS", "{name} must be an angle from 0 to less than 360 degrees")
    steps = [hole.to(hole.clear), *locked(cycle, hole.to(hole.clear), wanted)]
    steps += [*_ways(cycle, hole, lead, (into, out)), hole.to(hole.retract), *_after(cycle, rest)]
    return cycle.blocks(steps)


def _after(cycle: Cycle, rest: int) -> list[Step]:
    """Return the spindle start after the cycle: 3 and 4 as M3 and M4, nothing for 5."""
    sign = 1 if rest == 3 else -1
    return [] if rest == 5 else [acting(SpindleRun(sign * cycle.state.modal.rpm), sign)]


def _speed(cycle: Cycle, name: str, default: float) -> float:
    """Return a tapping speed in rpm, limited to the maximum speed of C, with a warning."""
    value = cycle.number(name, default) or default
    most = cycle.state.setup.limits.c_max_rpm
    text = "{name} does not define a speed"
    cycle.check(value > 0.0, name, text, "Enter a speed, or program S before the cycle.")
    if value > most:
        text = (
            "{call}: {name} is {value} rpm, but tapping with the C axis is limited to the C-axis maximum of "
            "{maximum} rpm."
        )
        hint = "Lower the speed."
        cycle.warn("tap-speed", text, hint, name=name, value=value, maximum=most)
    return min(value, most)


def _ways(cycle: Cycle, hole: Hole, lead: float, speeds: tuple[float, float]) -> list[Step]:
    """Return the tapping steps in one pass or in steps of _DAM.

    After each step, the tap retracts by _VRT (_VARI 1) or out of the hole (_VARI 2).
    """
    kind, each = cycle.whole("_VARI", 0, 0, 2), cycle.size("_DAM")
    whole = abs(hole.bottom - hole.clear)
    text = "{name} would need {count} steps, which is too many"
    count = max(cycle.pass_count(whole, each, "_DAM", text), 1) if kind and each else 1
    back, at, steps = cycle.size("_VRT") or 1.0, hole.clear, list[Step]()

    def turned(to: float, rpm: float) -> Step:
        # A move into the hole turns a right-hand tap in the direction of M3.
        turn = (to - at) * hole.down / lead * 360.0
        return Step(cycle.x, to, abs(lead) * rpm / 60.0, turn=turn)

    for k in range(1, count + 1):
        depth = hole.bottom if k == count else hole.clear + hole.down * k * each
        steps.append(turned(depth, speeds[0]))
        at = depth
        if k < count:
            away = hole.clear if kind == 2 else depth - hole.down * min(back, each)
            steps.append(turned(away, speeds[1]))
            at = away
    steps += dwell(seconds(cycle, "DTB"))
    steps.append(turned(hole.clear, speeds[1]))
    return steps


# --- with a compensating chuck


def compensating(cycle: Cycle) -> Iterator[Block]:
    """Return the blocks of CYCLE840: feed in by the lead, reverse, feed out, then SDAC.

    Raises ProgramError for invalid parameters.
    """
    hole, state = hole_of(cycle), cycle.state
    modal, sign = state.modal, state.modal.spindle
    text = "{call} needs the spindle to turn at a speed in rpm."
    hint = "Write G97 with S and M3 or M4 before this block."
    cycle.require(sign and modal.rpm and not modal.css, NO_DIRECTION, text, hint)
    by_feed = _by_feed(cycle)
    back, rest = cycle.whole("SDR", 0, 0, 5), cycle.whole("SDAC", 3 if sign > 0 else 4, 3, 5)
    if back not in {0, 3, 4} or (back and (back == 3) is (sign > 0)):
        text = "{name} does not reverse the spindle for the tap"
        raise cycle.wrong("SDR", text, "Enter 0, or the reverse direction: 4 after M3, or 3 after M4.")
    lead = abs(lead_of_tap(cycle))
    hint = "Enter PIT or MPIT, or ENC 1 to use the active feed rate."
    cycle.check(lead or by_feed, "PIT", "{name} does not define a lead", hint, WRONG_LEAD)
    feed = cycle.known_feed(modal.feed) if by_feed else lead if modal.per_rev else lead * modal.rpm / 60.0
    into, out = (hole.to(z, feed)._replace(tap=True) for z in (hole.bottom, hole.clear))
    deep = [into, *dwell(seconds(cycle, "DTB")), acting(SpindleRun(-sign * modal.rpm), -sign)]
    steps = [hole.to(hole.clear), *(step._replace(in_hole=True) for step in deep), out, hole.to(hole.retract)]
    return cycle.blocks([*steps, *_after(cycle, rest)])


def _by_feed(cycle: Cycle) -> bool:
    """Return whether ENC uses the active feed (1) instead of the lead (0, 11, 20). Raises ProgramError."""
    value = cycle.whole("ENC", 0, 0, 20)
    text = "{name} is {value} but must be 0, 1, 11 or 20"
    cycle.check(value in {0, 1, 11, 20}, "ENC", text, "Correct the value.", value=value)
    return value == 1


# --- G331 and G332


def tap(state: State, statement: Statement) -> Block:
    """Return the block of G331 (into the hole) or G332 (out), with C locked, lead K and speed S.

    Raises ProgramError for invalid words.
    """
    word = statement.g.get("motion")
    code = f"G{int(state.motion)}"
    demand_spindle_as_c(state, lambda text, hint: statement.refuse(word, "spindle-position", text, hint))
    if not state.modal.c_locked:
        text = "{code} turns the spindle as the C axis, but the spindle is not locked as C."
        raise statement.refuse(word, "spindle-position", text, "Write SPOS=0 before this block.", code=code)
    for name in ("X", "C", "I", "CR", "AR"):
        if other := statement.words.get(name):
            text = "{other}: {code} can tap only along Z."
            hint = "Remove this text from the program."
            raise statement.refuse(other, "word-unused", text, hint, other=other.text, code=code)
    lead = statement.words.get("K")
    pitch = state.length(statement, lead) if lead is not None else state.tap_lead
    text = "{code} needs the lead K."
    statement.check(pitch, lead or word, "thread-lead-missing", text, "Write K.", code=code)
    state.tap_lead = pitch
    travel = travel_of(state, statement)
    way = travel.z - travel.z0
    text = "{code} does not move along Z."
    statement.check(abs(way) >= _SAME, word, "thread-length", text, "Enter Z of the end point.", code=code)
    rpm = state.modal.rpm
    text = "No spindle speed is programmed for {code}."
    statement.check(rpm, word, "speed-missing", text, "Write S in the block.", code=code)
    rpm = min(rpm, state.setup.limits.c_max_rpm)
    # With G331, a positive lead turns in the direction of M3. With G332, the direction is reversed.
    sense = 1.0 if state.motion is Motion.TAP else -1.0
    turn = sense * abs(way) / pitch * 360.0
    made = block_of(state, statement, travel._replace(c=travel.c0 + turn), Kind.FEED, abs(pitch) * rpm / 60.0)
    made.per_rev = False
    return made
