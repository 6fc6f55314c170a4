"""The one picture of the machine that all displays are drawn from, with the interrupted job.

Its state is one of a table that says which may follow which; what is not in the table is a mistake of the
control and becomes an alarm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from datetime import UTC, datetime
from enum import StrEnum
from math import isfinite
from operator import attrgetter
from typing import Any, NamedTuple

from core.alarms import Code
from core.interpreter.shared.checkpoint import KeptPass
from core.interpreter.shared.modal_state import Modal
from core.interpreter.shared.working_plane import Swivel
from core.message import Message
from core.ports import FloatArray, Unknown
from core.tool_edges import edge_name

CONTROL_LOST = "THE CONTROL LOST POWER OR ITS PROCESS WAS KILLED"
CLOSED = "TURNDESK WAS CLOSED"
GIVEN_UP = "CANCELED BY RESET"
ESTOP = "E-STOP"

_TEXTS = ("program", "job", "text", "why", "at")
_NUMBERS = ("line", "block", "begun", "tool", "part")


@dataclass(frozen=True, slots=True)
class InterruptedJob:
    """Which job, at which line, with which tool, and where that stands.

    ``where`` is machine positions in the order of ``axes``: mm with X a radius, and degrees. ``part`` is the
    number of the part that was being made, ``begun`` how many elementary blocks of it were begun without a
    gap. ``at`` is the time of day, UTC, ISO 8601.
    """

    program: str  # name of its file
    job: str  # digest of the loaded job: text, offsets, switches
    text: str  # digest of the text alone
    line: int
    block: int  # elementary block, counted through the whole run: the pass of a loop follows from it
    begun: int
    tool: int
    part: int
    axes: tuple[str, ...]
    where: tuple[float, ...]
    why: str
    at: str

    @property
    def words(self) -> str:
        """Program, line, tool, part and cause in a few words, for the log and for sentences."""
        return Message(
            "{program}, line {line}, {tool}, part {part}: {why}",
            program=self.program,
            line=self.line,
            tool=edge_name(self.tool),
            part=self.part,
            why=self.why,
        )


def plain(kept: InterruptedJob) -> dict[str, object]:
    """The interrupted job as JSON can hold it."""
    return asdict(kept) | {"axes": list(kept.axes), "where": list(kept.where)}


def of_plain(value: object) -> InterruptedJob | None:
    """The interrupted job that was stored; None where there is none, or none that can be understood."""
    if not isinstance(value, Mapping):
        return None
    try:
        where = tuple(float(x) for x in value["where"])
        axes = tuple(str(name) for name in value["axes"])
        texts = {name: str(value[name]) for name in _TEXTS}
        numbers = {name: int(value[name]) for name in _NUMBERS}
    except (KeyError, TypeError, ValueError, OverflowError):
        return None
    known = bool(texts["program"]) and len(where) == len(axes) and all(isfinite(x) for x in where)
    return InterruptedJob(**texts, **numbers, axes=axes, where=where) if known else None  # type: ignore[arg-type]


def utc_now() -> str:
    """The time of day, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")


class State(StrEnum):
    """States of the executor; the words are what the operator reads."""

    ESTOP = "E-STOP"
    DISABLED = "DRIVES OFF"
    IDLE = "READY"
    RUN = "RUNNING"
    HOLDING = "STOPPING"
    HOLD = "FEED HOLD"
    BLOCK_END = "SINGLE BLOCK"
    PROGRAM_STOP = "PROGRAM STOP"
    WAIT = "WAITING"
    JOG = "JOG"
    HOME = "HOMING"
    FAULT = "ALARM"


class Starts(StrEnum):
    """What Cycle Start begins."""

    PROGRAM = "program"
    LINE = "line"
    RESTART = "restart"
    WAY_OUT = "way-out"  # of the part, after a stop; what was interrupted stays so


LINES = frozenset({Starts.LINE, Starts.WAY_OUT})
"""What is no run of the program."""


@dataclass(frozen=True, slots=True)
class Alarm:
    """An alarm, a hold or a stop: text, cause, what to do, and the line that was running (0: none).

    ``cause`` is what exactly happened here where that is known, else the likeliest of ``causes``; ``detail``
    is for the log.
    """

    number: int
    code: Code
    text: str
    cause: str
    remedy: str
    line: int = 0
    time: float = 0.0
    causes: tuple[str, ...] = ()
    detail: str = ""


class DriveTestState(NamedTuple):
    """How it stands with drive tests. ``barred``: why this machine has none.

    ``axis`` is under test, empty for none; ``number`` counts those that were begun, the last one at ``began``
    of the samples' clock; ``whole`` counts those that came to their end. ``rate`` is the samples a second.
    """

    barred: str = ""
    axis: str = ""
    number: int = 0
    began: float = 0.0
    whole: int = 0
    rate: float = 100.0


NO_DRIVE_TEST = DriveTestState()


class TouchPhase(StrEnum):
    """What a touch-off at the tool setter does."""

    SEARCH = "search"
    BACK_OFF = "back off"
    SLOW = "slow"
    RETREAT = "retreat"
    RETURN = "return"  # nothing was touched: back to where it began


@dataclass(frozen=True, slots=True)
class Touched:
    """How a touch-off has ended. ``place`` is where the axis was when it touched, machine mm by its encoder,
    and ``error`` by how much that may be off; None: ``why`` there is none.
    """

    number: int  # of the touch-offs that have ended
    axis: str
    sign: int
    place: float | None = None
    error: float = 0.0
    why: str = ""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Machine and program at one instant. Lengths mm, X a radius, machine frame unless said otherwise."""

    t: float = 0.0
    state: State = State.DISABLED
    waiting_for: str = ""  # in words: AT SPEED, COLLET, TB2-5, DWELL; of a hold, until the tap is out
    program: str = ""
    job: str = ""  # digest of the loaded job: program, offsets and switches
    line: int = 0  # source line being executed, 0 none
    block: int = 0  # elementary block being executed, 0 none
    block_text: str = ""
    next_text: str = ""
    axes: tuple[str, ...] = ("X", "Z", "C")  # the order of what follows: slides, then rotary axes
    demand: tuple[float, ...] = (0.0, 0.0, 0.0)
    actual: tuple[float, ...] = (0.0, 0.0, 0.0)
    following_error: tuple[float, ...] = (0.0, 0.0, 0.0)
    homed: tuple[bool, ...] = (False, False, False)
    powered: bool = False  # the drives have power, as they tell it themselves
    block_end: tuple[float, ...] = (0.0, 0.0, 0.0)  # for distance to go
    offset: tuple[float, float] = (0.0, 0.0)  # machine minus program, X and Z
    swivel: Swivel | None = None  # of a mill: the working plane of the last block that was begun
    modal: Modal = field(default_factory=Modal)
    x_diameter: bool | None = None  # X is read as a diameter; None: as ``modal`` counts
    velocity: float = 0.0  # along the path, mm/s, actual
    feed: float = 0.0  # programmed: mm/s or mm/rev by modal
    rapid: bool = False
    turns: bool = False  # the feed is that of rotary axes alone: degrees instead of mm
    rpm_command: float = 0.0
    rpm_actual: float = 0.0
    orienting: bool = False  # the spindle's drive turns it to an angle
    oriented: float | None = None  # degrees from its index at which the drive holds it
    spindle_asked: float = 0.0  # signed rpm that program or MDI want, before pot, switch and limit of F10
    feed_override: float = 1.0
    spindle_override: float = 1.0
    spindle_auto: bool = True
    spindle_limit: float = 0.0  # F10, until restart, rpm; 0: the machine's own maximum
    single_block: bool = False
    optional_stop: bool = False
    block_delete: bool = False
    cycle_repeat: bool = False
    no_count: bool = False
    counts: bool = False  # a program is under way that will have made a part when it ends
    outputs: frozenset[str] = frozenset()  # names that are on
    absent: frozenset[str] = frozenset()  # and of those that this machine has not
    inputs: frozenset[str] = frozenset()
    comment: str = ""
    message: str = ""  # of M00/M01 while the stop lasts
    optionally_stopped: bool = False  # at an M01 and not an M00
    alarms: tuple[Alarm, ...] = ()  # that stand, the first one first
    stop: Alarm | None = None  # why the machine stands, where no alarm says it: a hold, a stop, E-stop
    cycle_elapsed: float = 0.0  # of this cycle, stops not counted
    last_cycle: float = 0.0
    timed: int = 0  # cycles that ``last_cycle`` has told so: a part that a restart has finished has none
    parts: int = 0  # completed and counted since the executor was started
    made: int = 0  # of the loaded program, as it was told with ``PartsMade`` and counted since
    cutting: Mapping[int, float] = field(default_factory=dict)  # s at feed by tool since the start
    next_barred: str = ""  # why no other part begins after the one under way
    ends: int = 0  # programs that came to their end, counted or not
    underruns: int = 0
    hold_later: float = 0.0  # s by which a hold reacts later, since the computer is busy
    max_following_error: float = 0.0
    proof_wanted: bool = False  # a job is loaded that no proof covers
    starts: Starts = Starts.PROGRAM  # what Cycle Start begins
    prepared: str = ""  # digest of the line or restart that Cycle Start would begin
    interrupted: InterruptedJob | None = None  # a program that did not come to its end
    confirmed: bool = False  # that a start at the first line is meant all the same
    lines: int = 0  # of MDI that were begun since the executor was started
    tool_open: bool = False  # MDI has called a tool, and its first move is still to come
    kept: KeptPass[Any] | None = None  # what lines of MDI in other languages have left in force
    announced: tuple[str, ...] = ()  # what the next Cycle Start will start, besides going on
    start_refused: str = ""  # why the last Cycle Start did nothing
    start_code: str = ""  # code of that refusal, where the first move was its reason
    begun: int = 0  # runs since the executor was started: programs, repeats, restarts and lines of MDI
    wheel: str = ""  # axis that the handwheel moves, empty for none
    wheel_ended: str = ""  # why the control has taken the handwheel away
    # Nothing is heard of these: what is said of them in here is the last that was known, not what is so.
    unknown: frozenset[Unknown] = frozenset()
    drive_test: DriveTestState = NO_DRIVE_TEST
    touching: TouchPhase | None = None  # a tool is being touched off at the tool setter
    touched: Touched | None = None  # how the last such touch-off has ended
    spindle_load: float | None = None  # per cent, where the machine has such an input

    def tells_as(self, other: Snapshot) -> bool:
        """Whether another one tells the same, but for its time."""
        return self is other or _told(self) == _told(other)

    @property
    def interrupted_line(self) -> int:
        """The line at which the loaded program was interrupted, 0: it was not."""
        found = self.interrupted
        return found.line if found is not None and found.program == self.program else 0

    @property
    def reads_diameter(self) -> bool:
        """Whether displays show X as a diameter; a program's mode remains after its end, reset or E-stop."""
        return self.modal.diameter if self.x_diameter is None else self.x_diameter

    @property
    def tip(self) -> tuple[float, float]:
        """Actual machine X and Z: where the pictures of a lathe show the tool."""
        return self.actual[self.axes.index("X")], self.actual[self.axes.index("Z")]


_told = attrgetter(*(each.name for each in fields(Snapshot) if each.name != "t"))


@dataclass(frozen=True, slots=True)
class Event:
    """Something worth remembering: goes to the log by a queue."""

    t: float
    # state, alarm, disturbed, estop, start, repeat, restart, mdi, end, part, uncounted, stop,
    # interrupted, late, cleared, refused, override, switch, force, load, offsets, test
    kind: str
    text: str
    line: int = 0
    alarm: Alarm | None = None  # of an alarm, an E-stop and a stop: what the catalogue says of it
    record: str = ""  # file of the scope's record of the seconds before it, in the folder records
    part: int = 0  # of a part: its number among those of the program
    load: float | None = None  # of a part: mean load of the spindle at feed, per cent


class Tick(NamedTuple):
    """What the executor hands to the recorder at each of its ticks.

    ``samples`` are the driver's own, None where it has none.
    """

    snapshot: Snapshot
    late: float  # s by which the tick came later than planned
    queue: float  # s of motion queued, nan where the samples say it
    turns: float  # of the spindle, nan where it has no encoder
    samples: FloatArray | None
    rests: bool = False  # nothing has happened for a while


# --- which state may follow which -----------------------------------------------------------------------


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
        raise TransitionError(
            Message("the machine state cannot change from {old} to {new}", old=old.value, new=new.value)
        )
