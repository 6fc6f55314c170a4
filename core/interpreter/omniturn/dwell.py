"""Where the drive of C does not tell that it has arrived: is there a dwell that gives it the time?"""

from __future__ import annotations

from math import ceil, sqrt

from core.interpreter.omniturn.omniturn_state import State

_SHORTEST_DWELL = 0.1  # s
_DONE = 1e-9  # s, degrees


def mind_arrival(state: State, line: int, column: int, turn: float) -> None:
    """Keep in mind how long C takes, where its drive does not tell of its arrival."""
    limits = state.setup.limits
    if limits.c_feedback or turn <= _DONE:
        return
    speed, accel = (state.modal.c_rpm or limits.c_max_rpm) * 6.0, limits.c_accel
    ramps = speed * speed / accel
    seconds = turn / speed + speed / accel if turn >= ramps else 2.0 * sqrt(turn / accel)
    state.turning = (line, column, seconds)


def warn_of_short_dwell(state: State) -> None:
    """Something moves or ends: what is left of the time that C needed is told."""
    if state.turning is None:
        return
    (line, column, left), state.turning = state.turning, None
    if left > _DONE:
        needed = max(ceil(left * 100.0 - 1e-6) / 100.0, _SHORTEST_DWELL)
        text = f"The drive of C does not tell of its arrival, which takes {needed:.2f} s from here."
        state.log.warn(line, column, "dwell-too-short", text, f"Write G04F{needed:.2f} after it, or longer.")


def note_dwell(state: State, seconds: float) -> None:
    """A dwell gives C time to arrive."""
    if state.turning is not None:
        line, column, left = state.turning
        state.turning = (line, column, left - seconds)
