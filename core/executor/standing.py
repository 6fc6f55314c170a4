"""What the executor knows of job, modal state, alarms and counts."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.executor.interrupted import Interrupted
from core.executor.job import Job, Proof
from core.executor.snapshot import Alarm, Starts, State
from core.interpreter.modal_state import Modal


@dataclass(slots=True)
class Counters:
    """What is counted from the start of the executor; times in seconds, stops not counted."""

    parts: int = 0
    made: int = 0  # of the loaded program, as whoever keeps the count has told and what was made since
    ends: int = 0  # programs that came to their end, counted or not
    lines: int = 0  # of MDI that were begun
    underruns: int = 0
    cycle: float = 0.0
    last_cycle: float = 0.0


@dataclass(slots=True)
class Standing:
    """State, program and alarms of the machine."""

    state: State = State.DISABLED
    job: Job | None = None
    proof: Proof | None = None
    alarms: tuple[Alarm, ...] = ()
    power_off: bool = False  # an alarm has switched the drives off
    start_refused: str = ""
    starts: Starts = Starts.PROGRAM
    prepared: Job | None = None  # the restart or the line of MDI that Cycle Start begins
    prepared_proof: Proof | None = None
    tool_open: bool = False  # MDI has called a tool, and its first move is still to come
    interrupted: Interrupted | None = None  # a program that did not come to its end
    modal: Modal = field(default_factory=Modal)  # in force while no program is under way
