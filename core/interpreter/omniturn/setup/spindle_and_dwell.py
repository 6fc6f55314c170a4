"""Execution of spindle words (M03, M04, M05, S, constant surface speed) and of the dwell G04.

G04 also waits for the C axis.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, sqrt

from core.interpreter.omniturn.codes.code_rules import check_conditions, check_word_number, number
from core.interpreter.omniturn.codes.code_table import G_CODES, LETTER_ENTRIES, M_CODES
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import Dwell, SpindleRun, SpindleStop
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.units import MM_S_PER_FT_MIN, MM_S_PER_M_MIN
from core.message import Message


def execute_spindle_modes(state: State, statement: Statement) -> None:
    """Execute G96, G97, G76 and G77 of a line; with G76 or G77, S is the speed limit."""
    if not statement.modal_codes:
        return
    modal = state.modal
    if 96 in statement.modal_codes and not modal.css:
        state.set_modal(state.modal._replace(css=True))
    elif 97 in statement.modal_codes and modal.css:
        # The spindle continues at its present speed, because a jump to an old S would be unexpected.
        rpm = abs(state.compute_rpm_at(state.x)) if modal.spindle else modal.rpm
        state.set_modal(state.modal._replace(css=False, rpm=rpm))
    if 76 in statement.modal_codes:
        state.set_modal(state.modal._replace(min_css_rpm=_limit(state, statement, 76)))
    if 77 in statement.modal_codes:
        state.set_modal(state.modal._replace(max_css_rpm=_limit(state, statement, 77)))
    modal = state.modal
    if modal.max_css_rpm is not None and modal.min_css_rpm > modal.max_css_rpm:
        message = Message(
            "G76 ({css_min} rpm) is higher than G77 ({css_max} rpm).",
            css_min=f"{modal.min_css_rpm:g}",
            css_max=f"{modal.max_css_rpm:g}",
        )
        state.set_modal(state.modal._replace(min_css_rpm=modal.max_css_rpm))
        raise statement.make_error("S", "speed-limits", message, "Correct G76 or G77.")


def _limit(state: State, statement: Statement, code: int) -> float:
    return number(state, statement, "S", G_CODES[code]) or 0.0


def execute_speed_word(state: State, statement: Statement) -> None:
    """Execute S of a line: a spindle speed in rpm under G97, or a surface speed under G96."""
    word = statement.words.get("S")
    if word is None or word.value is None or statement.is_s_speed_limit:
        return
    modal, speed = state.modal, word.value
    if modal.css:
        unit = MM_S_PER_M_MIN if modal.metric else MM_S_PER_FT_MIN
        check_word_number(state, statement, "S", speed * unit, G_CODES[96])
        state.set_modal(modal._replace(surface_speed=speed * unit))
        return
    if speed >= 0:  # The speed is also set after an error, so that later lines can be checked.
        state.set_modal(modal._replace(rpm=min(speed, state.setup.limits.max_rpm)))
    number(state, statement, "S", LETTER_ENTRIES["S"])


def run_spindle(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the spindle block of a line with M03, M04 or S, unless the spindle remains stopped."""
    direction = {3: 1, 4: -1}.get(statement.m_number or 0, 0)
    if direction:
        check_conditions(state, statement, M_CODES[statement.m_number or 0])
        state.reported.discard("spindle-stopped")
        state.set_modal(state.modal._replace(spindle=direction))
    elif (
        "S" not in statement.words
        or statement.m_number == 5
        or not state.modal.spindle
        or statement.is_s_speed_limit
    ):
        return
    state.reported.discard("spindle-stopped")
    rpm = state.compute_rpm_at(state.x)
    surface = state.modal.active_surface_speed
    yield state.action(statement.line, statement.get_block_text("spindle"), SpindleRun(rpm, surface))


def stop_spindle(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M05, which stops the spindle and unlocks the C axis."""
    state.set_modal(state.modal._replace(spindle=0, c_locked=False, c_rpm=None))
    yield state.action(statement.line, statement.get_block_text("m"), SpindleStop())


_SHORTEST = G_CODES[4].word_rules["F"].minimum  # s
_LONG = 60.0  # s with an active tool; warm-up programs have no tool
_ARRIVAL_TOLERANCE = 1e-9  # s, degrees


def execute_dwell(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of G04. Raises ProgramError if F is missing or out of range."""
    seconds = number(state, statement, "F") or 0.0
    if seconds > _LONG and state.modal.tool:
        state.log.add_warning(
            statement.line,
            statement.words["F"].column,
            "dwell-long",
            "The dwell lasts {seconds} minutes.",
            "Check F; with G04, F is in seconds.",
            seconds=f"{seconds / 60.0:.1f}",
        )
    _shorten_arrival(state, seconds)
    yield state.action(statement.line, statement.get_block_text("move"), Dwell(seconds))


def record_c_rotation_time(state: State, line: int, column: int, turn_deg: float) -> None:
    """Record the time that the C axis needs to rotate by ``turn_deg`` degrees.

    The time is recorded only if the drive of C does not report the position.
    """
    limits = state.setup.limits
    if limits.has_c_feedback or turn_deg <= _ARRIVAL_TOLERANCE:
        return
    speed, accel = (state.modal.c_rpm or limits.max_c_rpm) * 6.0, limits.c_acceleration_deg_s2
    ramps = speed * speed / accel
    seconds = turn_deg / speed + speed / accel if turn_deg >= ramps else 2.0 * sqrt(turn_deg / accel)
    state.turning = (line, column, seconds)


def warn_about_short_dwell(state: State) -> None:
    """Log a warning if a move or the program end occurs before C reaches its position."""
    if state.turning is None:
        return
    (line, column, left), state.turning = state.turning, None
    if left > _ARRIVAL_TOLERANCE:
        needed = max(ceil(left * 100.0 - 1e-6) / 100.0, _SHORTEST)
        text = (
            "The C drive does not signal when C is in position; at this point, C needs another {needed} s to "
            "finish its move."
        )
        hint = "Program a dwell of at least G04F{needed} after this line."
        state.log.add_warning(line, column, "dwell-too-short", text, hint, needed=f"{needed:.2f}")


def _shorten_arrival(state: State, dwell_s: float) -> None:
    """Subtract a dwell from the remaining time that C needs to reach its position."""
    if state.turning is not None:
        line, column, left = state.turning
        state.turning = (line, column, left - dwell_s)
