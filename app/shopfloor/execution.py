"""Execution and controller mode in the words of MTConnect, from successive snapshots."""

from __future__ import annotations

from dataclasses import dataclass

from core.executor.snapshot import Snapshot, Starts, State

AUTOMATIC, MANUAL, MDI, SINGLE = "AUTOMATIC", "MANUAL", "MANUAL_DATA_INPUT", "SEMI_AUTOMATIC"
READY, ACTIVE, WAIT, STOPPED = "READY", "ACTIVE", "WAIT", "STOPPED"
FEED_HOLD, INTERRUPTED = "FEED_HOLD", "INTERRUPTED"
PROGRAM_STOPPED, OPTIONAL_STOP, COMPLETED = "PROGRAM_STOPPED", "OPTIONAL_STOP", "PROGRAM_COMPLETED"

_COLLET = "COLLET"  # a wait for a device that handles the material, as the inputs of bar feed and loader are
# An operator keeps it from going on, and has to do something before it does.
_KEPT = {
    "FEED OVERRIDE AT 0": FEED_HOLD,
    "SPINDLE SWITCH OFF": INTERRUPTED,
    "GUARD OPEN": INTERRUPTED,
    "SPINDLE OVERRIDE AT 0": INTERRUPTED,
    "SPINDLE STOPPED": INTERRUPTED,
}
_BY_STATE = {
    State.ESTOP: STOPPED,
    State.FAULT: STOPPED,
    State.DISABLED: STOPPED,  # it is not ready: nothing can be started
    State.RUN: ACTIVE,
    State.HOLDING: FEED_HOLD,
    State.BLOCK_END: INTERRUPTED,
    State.JOG: READY,
    State.HOME: READY,
}


@dataclass(slots=True)
class Execution:
    """Remembers whether the last thing that happened was the end of a program.

    ``inputs`` are the names and terminals for which a program can wait; whatever else a cycle waits for (a
    dwell, the spindle, a proof) is its own work.
    """

    inputs: frozenset[str] = frozenset()
    _ends: int | None = None
    _program: str = ""
    _lines: int = 0
    _completed: bool = False

    def look(self, snapshot: Snapshot) -> str:
        """The execution state; call it with every snapshot that is told of."""
        ended = self._ends is not None and snapshot.ends > self._ends
        elsewhere = (snapshot.program, snapshot.lines) != (self._program, self._lines)
        if ended:
            self._completed = True
        elif snapshot.state is not State.IDLE or elsewhere:
            self._completed = False
        self._ends, self._program, self._lines = snapshot.ends, snapshot.program, snapshot.lines
        return self._of(snapshot)

    def _of(self, snapshot: Snapshot) -> str:
        match snapshot.state:
            case State.WAIT:
                return self._waiting(snapshot.waiting_for)
            case State.HOLD:
                return INTERRUPTED if snapshot.waiting_for else FEED_HOLD
            case State.PROGRAM_STOP:
                return OPTIONAL_STOP if snapshot.optionally_stopped else PROGRAM_STOPPED
            case State.IDLE:
                if self._completed:
                    return COMPLETED
                return STOPPED if snapshot.interrupted_line else READY
            case state:
                return _BY_STATE[state]

    def _waiting(self, what: str) -> str:
        if what == _COLLET or what in self.inputs:
            return WAIT
        return _KEPT.get(what, ACTIVE)


def mode_of(snapshot: Snapshot) -> str:
    """What Cycle Start begins, and how; this control has no mode switch."""
    if snapshot.state in {State.JOG, State.HOME}:
        return MANUAL
    if snapshot.starts is Starts.LINE:
        return MDI
    return SINGLE if snapshot.single_block else AUTOMATIC
