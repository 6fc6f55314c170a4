"""Which state may follow which. What is not in the table is a mistake of the control and becomes an alarm."""

from __future__ import annotations

from core.executor.snapshot import State

# Only E-stop and alarm may come from anywhere; nothing leads from them back into motion.
_ALWAYS = {State.ESTOP, State.FAULT}
_UNDER_WAY = {State.RUN, State.WAIT, State.HOLDING, State.HOLD, State.BLOCK_END, State.PROGRAM_STOP}

TRANSITIONS: dict[State, frozenset[State]] = {
    State.ESTOP: frozenset({State.DISABLED}),
    State.DISABLED: frozenset({State.IDLE, *_ALWAYS}),
    State.IDLE: frozenset({State.RUN, State.JOG, State.HOME, State.DISABLED, *_ALWAYS}),
    State.RUN: frozenset({*_UNDER_WAY, State.IDLE, *_ALWAYS} - {State.RUN}),
    State.WAIT: frozenset({*_UNDER_WAY, State.IDLE, *_ALWAYS} - {State.WAIT}),
    State.HOLDING: frozenset({State.HOLD, State.BLOCK_END, State.IDLE, *_ALWAYS}),
    State.HOLD: frozenset({State.RUN, State.WAIT, State.IDLE, *_ALWAYS}),
    State.BLOCK_END: frozenset({State.RUN, State.WAIT, State.HOLD, State.IDLE, *_ALWAYS}),
    State.PROGRAM_STOP: frozenset({State.RUN, State.WAIT, State.BLOCK_END, State.IDLE, *_ALWAYS}),
    State.JOG: frozenset({State.IDLE, *_ALWAYS}),
    State.HOME: frozenset({State.IDLE, *_ALWAYS}),
    State.FAULT: frozenset({State.ESTOP, State.DISABLED, State.IDLE}),
}

ACTIVE = frozenset({State.RUN, State.WAIT, State.HOLDING})  # the cycle goes on by itself
STOPPED = frozenset({State.HOLD, State.BLOCK_END, State.PROGRAM_STOP})  # Cycle Start goes on
CYCLE = ACTIVE | STOPPED
BY_HAND = frozenset({State.IDLE, State.JOG})  # the machine is worked by hand: its spindle switch is one


class TransitionError(Exception):
    """The executor asked for a change of state that the table does not hold."""


def demand_allowed(old: State, new: State) -> None:
    """Raises TransitionError unless ``new`` may follow ``old``."""
    if new not in TRANSITIONS[old]:
        raise TransitionError(f"state {old.value} cannot become {new.value}")
