"""G04, and whether a dwell gives C the time to arrive where its drive does not tell of its arrival."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, sqrt

from core.interpreter.omniturn.codes.code_rules import number
from core.interpreter.omniturn.codes.code_table import G_CODES
from core.interpreter.omniturn.omniturn_state import State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import Dwell
from core.interpreter.shared.elementary_blocks import Block

_SHORTEST = G_CODES[4].rules["F"].least  # s
_LONG = 60.0  # s with a tool in force: warm-up programs have none
_DONE = 1e-9  # s, degrees


def dwell(state: State, statement: Statement) -> Iterator[Block]:
    """The block of G04. Raises ProgramError where F is missing or out of range."""
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
    """Note in the state how long a turn of C by ``turn`` degrees takes, where its drive does not tell."""
    limits = state.setup.limits
    if limits.c_feedback or turn <= _DONE:
        return
    speed, accel = (state.modal.c_rpm or limits.c_max_rpm) * 6.0, limits.c_accel
    ramps = speed * speed / accel
    seconds = turn / speed + speed / accel if turn >= ramps else 2.0 * sqrt(turn / accel)
    state.turning = (line, column, seconds)


def warn_of_short_dwell(state: State) -> None:
    """Something moves or ends: warn where C would still be on its way."""
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
    """A dwell gives C time to arrive."""
    if state.turning is not None:
        line, column, left = state.turning
        state.turning = (line, column, left - seconds)
