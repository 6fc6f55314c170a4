"""Spindle words (M03, M04, M05, S, constant surface speed), and G04, which also waits for the C axis."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, sqrt

from core.interpreter.omniturn.codes.code_rules import check_when, checked, number
from core.interpreter.omniturn.codes.code_table import G_CODES, LETTERS, M_CODES
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import Dwell, SpindleRun, SpindleStop
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.units import FEET_PER_MINUTE, METRES_PER_MINUTE
from core.message import Message


def spindle_modes(state: State, statement: Statement) -> None:
    """Execute G96, G97, G76 and G77 of a line; with G76 or G77, S is their limit."""
    if not statement.modal:
        return
    modal = state.modal
    if 96 in statement.modal and not modal.css:
        state.adopt(state.modal._replace(css=True))
    elif 97 in statement.modal and modal.css:
        # The spindle continues at its present speed, because a jump to an old S would be unexpected.
        rpm = abs(state.rpm_at(state.x)) if modal.spindle else modal.rpm
        state.adopt(state.modal._replace(css=False, rpm=rpm))
    if 76 in statement.modal:
        state.adopt(state.modal._replace(css_min=_limit(state, statement, 76)))
    if 77 in statement.modal:
        state.adopt(state.modal._replace(css_max=_limit(state, statement, 77)))
    modal = state.modal
    if modal.css_max is not None and modal.css_min > modal.css_max:
        message = Message(
            "G76 ({css_min} rpm) is higher than G77 ({css_max} rpm).",
            css_min=f"{modal.css_min:g}",
            css_max=f"{modal.css_max:g}",
        )
        state.adopt(state.modal._replace(css_min=modal.css_max))
        raise statement.refuse("S", "speed-limits", message, "Correct G76 or G77.")


def _limit(state: State, statement: Statement, code: int) -> float:
    return number(state, statement, "S", G_CODES[code]) or 0.0


def speed_word(state: State, statement: Statement) -> None:
    """Execute S of a line: rpm under G97, surface speed under G96."""
    word = statement.words.get("S")
    if word is None or word.value is None or statement.s_is_limit:
        return
    modal, speed = state.modal, word.value
    if modal.css:
        unit = METRES_PER_MINUTE if modal.metric else FEET_PER_MINUTE
        checked(state, statement, "S", speed * unit, G_CODES[96])
        state.adopt(modal._replace(surface_speed=speed * unit))
        return
    if speed >= 0:  # The speed is also set after an error, so that later lines can be checked.
        state.adopt(modal._replace(rpm=min(speed, state.setup.limits.max_rpm)))
    number(state, statement, "S", LETTERS["S"])


def run_block(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the spindle block of a line with M03, M04 or S, unless the spindle remains stopped."""
    direction = {3: 1, 4: -1}.get(statement.m or 0, 0)
    if direction:
        check_when(state, statement, M_CODES[statement.m or 0])
        state.reported.discard("spindle-stopped")
        state.adopt(state.modal._replace(spindle=direction))
    elif "S" not in statement.words or statement.m == 5 or not state.modal.spindle or statement.s_is_limit:
        return
    state.reported.discard("spindle-stopped")
    rpm = state.rpm_at(state.x)
    surface = state.modal.css_speed
    yield state.action(statement.line, statement.part("spindle"), SpindleRun(rpm, surface))


def stop_block(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of M05, which stops the spindle and releases C."""
    state.adopt(state.modal._replace(spindle=0, c_locked=False, c_rpm=None))
    yield state.action(statement.line, statement.part("m"), SpindleStop())


_SHORTEST = G_CODES[4].rules["F"].least  # s
_LONG = 60.0  # s with an active tool; warm-up programs have no tool
_DONE = 1e-9  # s, degrees


def dwell(state: State, statement: Statement) -> Iterator[Block]:
    """Yield the block of G04. Raises ProgramError if F is missing or out of range."""
    seconds = number(state, statement, "F") or 0.0
    if seconds > _LONG and state.modal.tool:
        state.log.warn(
            statement.line,
            statement.words["F"].column,
            "dwell-long",
            "The dwell lasts {seconds} minutes.",
            "Check F; with G04, F is in seconds.",
            seconds=f"{seconds / 60.0:.1f}",
        )
    _shorten_arrival(state, seconds)
    yield state.action(statement.line, statement.part("move"), Dwell(seconds))


def expect_arrival(state: State, line: int, column: int, turn: float) -> None:
    """Record the time of a turn of C by ``turn`` degrees, if its drive does not report the position."""
    limits = state.setup.limits
    if limits.c_feedback or turn <= _DONE:
        return
    speed, accel = (state.modal.c_rpm or limits.c_max_rpm) * 6.0, limits.c_accel
    ramps = speed * speed / accel
    seconds = turn / speed + speed / accel if turn >= ramps else 2.0 * sqrt(turn / accel)
    state.turning = (line, column, seconds)


def warn_of_short_dwell(state: State) -> None:
    """Log a warning if a move or the end occurs before C is in position."""
    if state.turning is None:
        return
    (line, column, left), state.turning = state.turning, None
    if left > _DONE:
        needed = max(ceil(left * 100.0 - 1e-6) / 100.0, _SHORTEST)
        text = (
            "The C drive does not signal when C is in position; at this point, C needs another {needed} s to "
            "finish its move."
        )
        hint = "Program a dwell of at least G04F{needed} after this line."
        state.log.warn(line, column, "dwell-too-short", text, hint, needed=f"{needed:.2f}")


def _shorten_arrival(state: State, seconds: float) -> None:
    """Subtract a dwell from the time that C needs to reach its position."""
    if state.turning is not None:
        line, column, left = state.turning
        state.turning = (line, column, left - seconds)
