"""Tapping with CYCLE84, CYCLE840, G331 and G332, either rigid with the C axis or with a compensating chuck.

In rigid tapping, C rotates in proportion to the travel along Z, one revolution per lead. With a
compensating chuck, Z moves at a feed per revolution, and the spindle reverses at the bottom.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign

from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.sinumerik.cycles.cycle_parameters import (
    NO_SPINDLE_DIRECTION,
    CycleCall,
    CycleStep,
    make_action_step,
    make_dwell_steps,
)
from core.interpreter.sinumerik.cycles.drilling_cycles import (
    HolePositions,
    make_spindle_lock_steps,
    read_dwell_s,
    read_hole_positions,
)
from core.interpreter.sinumerik.cycles.thread_cycle import (
    WRONG_THREAD_LEAD,
    check_lead_nonzero,
    get_coarse_thread_lead,
)
from core.interpreter.sinumerik.motion.linear_moves import compute_axis_travel, make_travel_block
from core.interpreter.sinumerik.setup.spindle_and_dwell import check_spindle_c_axis
from core.interpreter.sinumerik.sinumerik_state import MotionKind, SinumerikState
from core.interpreter.sinumerik.sinumerik_statement import Statement

_SAME = 1e-6  # mm
_INCH = 25.4


def read_tap_lead(cycle: CycleCall) -> float:
    """Return the lead (PIT or MPIT) in mm/rev, or 0 if both parameters are omitted.

    The lead of a left-hand thread is negative.
    """
    unit = cycle.read_whole_number("_PITA", 0, 0, 4)
    text = "{name} is 4, which specifies the lead as a module"
    cycle.check_parameter(unit != 4, "_PITA", text, "Enter PIT in mm.", WRONG_THREAD_LEAD)
    pit, size = cycle.read_number("PIT"), cycle.read_number("MPIT")
    if pit:
        in_inches = unit == 3 or (unit == 0 and not cycle.state.modal.metric)
        return _INCH / pit if unit == 2 else pit * (_INCH if in_inches else 1.0)
    if not size:
        return 0.0
    lead = get_coarse_thread_lead(size)
    check_lead_nonzero(cycle, lead, "MPIT")
    return copysign(lead, size)


# --- rigid


def run_rigid_tapping(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE84.

    The spindle is oriented to POSS, and the tool then taps in at the speed SST and out at the speed SST1.
    Raises ProgramError for invalid parameters.
    """
    hole, state = read_hole_positions(cycle), cycle.state
    check_spindle_c_axis(state, lambda text, hint: cycle.make_call_error("spindle-position", text, hint))
    lead = read_tap_lead(cycle)
    check_lead_nonzero(cycle, lead, "PIT")
    into = _speed(cycle, "SST", state.modal.rpm)
    out = _speed(cycle, "SST1", into)
    rest = cycle.read_whole_number("SDAC", 5, 3, 5)
    text = "{name} starts the spindle, but no S is programmed"
    cycle.check_parameter(rest == 5 or state.modal.rpm, "SDAC", text, "Write S before this block.")
    wanted = cycle.read_angle_deg("POSS", "{name} must be an angle from 0 to less than 360 degrees")
    steps = [
        hole.make_step(hole.clearance_z),
        *make_spindle_lock_steps(cycle, hole.make_step(hole.clearance_z), wanted),
    ]
    steps += [
        *_tapping_steps(cycle, hole, lead, (into, out)),
        hole.make_step(hole.retract_z),
        *_final_spindle_steps(cycle, rest),
    ]
    return cycle.make_blocks(steps)


def _final_spindle_steps(cycle: CycleCall, direction: int) -> list[CycleStep]:
    """Return the steps that start the spindle after the cycle.

    The direction is 3 as for M3, 4 as for M4, or 5 for a stopped spindle, for which the list is empty.
    """
    sign = 1 if direction == 3 else -1
    return [] if direction == 5 else [make_action_step(SpindleRun(sign * cycle.state.modal.rpm), sign)]


def _speed(cycle: CycleCall, name: str, default: float) -> float:
    """Return a tapping speed in rpm, limited to the maximum speed of C.

    A warning is logged if the speed is limited.
    """
    value = cycle.read_number(name, default) or default
    most = cycle.state.setup.limits.max_c_rpm
    text = "{name} does not define a speed"
    cycle.check_parameter(value > 0.0, name, text, "Enter a speed, or program S before the cycle.")
    if value > most:
        text = (
            "{call}: {name} is {value} rpm, but tapping with the C axis is limited to the C-axis maximum of "
            "{maximum} rpm."
        )
        hint = "Lower the speed."
        cycle.log_warning("tap-speed", text, hint, name=name, value=value, maximum=most)
    return min(value, most)


def _tapping_steps(
    cycle: CycleCall, hole: HolePositions, lead: float, speeds: tuple[float, float]
) -> list[CycleStep]:
    """Return the tapping steps, in one pass or in steps of _DAM.

    After each step, the tap retracts by _VRT (_VARI 1) or out of the hole (_VARI 2).
    """
    kind, each = cycle.read_whole_number("_VARI", 0, 0, 2), cycle.read_unsigned_length_mm("_DAM")
    whole = abs(hole.bottom_z - hole.clearance_z)
    text = "{name} would need {count} steps, which is too many"
    count = max(cycle.compute_pass_count(whole, each, "_DAM", text), 1) if kind and each else 1
    back, at, steps = cycle.read_unsigned_length_mm("_VRT") or 1.0, hole.clearance_z, list[CycleStep]()

    def make_tapping_step(to: float, rpm: float) -> CycleStep:
        # A move into the hole turns a right-hand tap in the direction of M3.
        turn = (to - at) * hole.drilling_sign / lead * 360.0
        return CycleStep(cycle.x, to, abs(lead) * rpm / 60.0, c_travel_deg=turn)

    for k in range(1, count + 1):
        depth = hole.bottom_z if k == count else hole.clearance_z + hole.drilling_sign * k * each
        steps.append(make_tapping_step(depth, speeds[0]))
        at = depth
        if k < count:
            away = hole.clearance_z if kind == 2 else depth - hole.drilling_sign * min(back, each)
            steps.append(make_tapping_step(away, speeds[1]))
            at = away
    steps += make_dwell_steps(read_dwell_s(cycle, "DTB"))
    steps.append(make_tapping_step(hole.clearance_z, speeds[1]))
    return steps


# --- with a compensating chuck


def run_compensating_tapping(cycle: CycleCall) -> Iterator[Block]:
    """Return the blocks of CYCLE840.

    The tool feeds in by the lead, the spindle reverses, the tool feeds out, and the spindle continues in
    the direction SDAC. Raises ProgramError for invalid parameters.
    """
    hole, state = read_hole_positions(cycle), cycle.state
    modal, sign = state.modal, state.modal.spindle
    text = "{call} needs the spindle to turn at a speed in rpm."
    hint = "Write G97 with S and M3 or M4 before this block."
    cycle.require_condition(sign and modal.rpm and not modal.css, NO_SPINDLE_DIRECTION, text, hint)
    by_feed = _uses_active_feed(cycle)
    back, rest = (
        cycle.read_whole_number("SDR", 0, 0, 5),
        cycle.read_whole_number("SDAC", 3 if sign > 0 else 4, 3, 5),
    )
    if back not in {0, 3, 4} or (back and (back == 3) is (sign > 0)):
        text = "{name} does not reverse the spindle for the tap"
        raise cycle.make_parameter_error(
            "SDR", text, "Enter 0, or the reverse direction: 4 after M3, or 3 after M4."
        )
    lead = abs(read_tap_lead(cycle))
    hint = "Enter PIT or MPIT, or ENC 1 to use the active feed rate."
    cycle.check_parameter(lead or by_feed, "PIT", "{name} does not define a lead", hint, WRONG_THREAD_LEAD)
    feed = cycle.require_feed(modal.feed) if by_feed else lead if modal.per_rev else lead * modal.rpm / 60.0
    into, out = (hole.make_step(z, feed)._replace(is_tapping=True) for z in (hole.bottom_z, hole.clearance_z))
    deep = [
        into,
        *make_dwell_steps(read_dwell_s(cycle, "DTB")),
        make_action_step(SpindleRun(-sign * modal.rpm), -sign),
    ]
    steps = [
        hole.make_step(hole.clearance_z),
        *(step._replace(ends_in_hole=True) for step in deep),
        out,
        hole.make_step(hole.retract_z),
    ]
    return cycle.make_blocks([*steps, *_final_spindle_steps(cycle, rest)])


def _uses_active_feed(cycle: CycleCall) -> bool:
    """Return whether ENC selects the active feed (1) instead of the lead (0, 11, 20).

    Raises ProgramError for any other value.
    """
    value = cycle.read_whole_number("ENC", 0, 0, 20)
    text = "{name} is {value} but must be 0, 1, 11 or 20"
    cycle.check_parameter(value in {0, 1, 11, 20}, "ENC", text, "Correct the value.", value=value)
    return value == 1


# --- G331 and G332


def make_tapping_block(state: SinumerikState, statement: Statement) -> Block:
    """Return the block of G331 (into the hole) or G332 (out of the hole).

    C is locked, K is the lead, and S is the speed. Raises ProgramError for invalid words.
    """
    word = statement.g_words.get("motion")
    code = f"G{int(state.motion)}"
    check_spindle_c_axis(state, lambda text, hint: statement.make_error(word, "spindle-position", text, hint))
    if not state.modal.c_locked:
        text = "{code} turns the spindle as the C axis, but the spindle is not locked as C."
        raise statement.make_error(
            word, "spindle-position", text, "Write SPOS=0 before this block.", code=code
        )
    for name in ("X", "C", "I", "CR", "AR"):
        if other := statement.words.get(name):
            text = "{other}: {code} can tap only along Z."
            hint = "Remove this text from the program."
            raise statement.make_error(other, "word-unused", text, hint, other=other.text, code=code)
    lead = statement.words.get("K")
    pitch = state.length(statement, lead) if lead is not None else state.tap_lead_mm
    text = "{code} needs the lead K."
    statement.require_condition(pitch, lead or word, "thread-lead-missing", text, "Write K.", code=code)
    state.tap_lead_mm = pitch
    travel = compute_axis_travel(state, statement)
    stroke = travel.z - travel.z0
    text = "{code} does not move along Z."
    statement.require_condition(
        abs(stroke) >= _SAME, word, "thread-length", text, "Enter Z of the end point.", code=code
    )
    rpm = state.modal.rpm
    text = "No spindle speed is programmed for {code}."
    statement.require_condition(rpm, word, "speed-missing", text, "Write S in the block.", code=code)
    rpm = min(rpm, state.setup.limits.max_c_rpm)
    # With G331, a positive lead turns in the direction of M3. With G332, the direction is reversed.
    sense = 1.0 if state.motion is MotionKind.TAP else -1.0
    turn = sense * abs(stroke) / pitch * 360.0
    made = make_travel_block(
        state, statement, travel._replace(c=travel.c0 + turn), BlockKind.FEED, abs(pitch) * rpm / 60.0
    )
    made.per_rev = False
    return made
