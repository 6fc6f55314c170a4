"""The snapshot of the machine, from which all displays are drawn, and the interrupted job.

A table specifies which state may follow which. Any other change is an internal error and becomes an alarm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from datetime import UTC, datetime
from enum import StrEnum
from math import isfinite
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

from core.alarms import Code
from core.interpreter.shared.checkpoint import KeptPass
from core.interpreter.shared.modal_state import Modal
from core.message import Message
from core.ports import FloatArray, Unknown
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from core.interpreter.shared.working_plane import Swivel

CONTROL_LOST = "THE CONTROL LOST POWER OR ITS PROCESS WAS KILLED"
CLOSED = "TURNDESK WAS CLOSED"
GIVEN_UP = "CANCELED BY RESET"
ESTOP = "E-STOP"

_TEXTS = ("program", "job", "text", "why", "at")
_NUMBERS = ("line", "block", "begun", "tool", "part")


@dataclass(frozen=True, slots=True)
class InterruptedJob:
    """The program, line, tool and position at which a job was interrupted.

    ``where`` contains machine positions in the order of ``axes``, in mm with X as a radius, and in degrees.
    ``part`` is the number of the part in progress. ``begun`` is the number of its elementary blocks that had
    started without a gap. ``at`` is the time of day in UTC, in ISO 8601 format.
    """

    program: str  # name of its file
    job: str  # =
    text: str  # digest of the text alone
    line: int
    # elementary block, counted through the whole run, so that it also identifies the pass of a loop
    block: int
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
    """Return the interrupted job as a dictionary for JSON."""
    return asdict(kept) | {"axes": list(kept.axes), "where": list(kept.where)}


def of_plain(value: object) -> InterruptedJob | None:
    """Return the interrupted job read from JSON, or None if the value is missing or invalid."""
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
    """Return the time of day in UTC with a resolution of 1 s, in ISO 8601 format."""
    return datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")


class State(StrEnum):
    """States of the executor. The values are shown to the operator."""

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
    """The action of the next Cycle Start."""

    PROGRAM = "program"
    LINE = "line"
    RESTART = "restart"
    WAY_OUT = "way-out"  # retract from the part after a stop; the interrupted job remains interrupted


LINES = frozenset({Starts.LINE, Starts.WAY_OUT})
"""What is no run of the program."""


@dataclass(frozen=True, slots=True)
class Alarm:
    """An alarm, a hold or a stop, with its text, cause, remedy and program line (0 if unknown).

    ``cause`` is the known cause in this case, or else the most likely one of ``causes``. ``detail`` is for
    the log.
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
    """State of the drive tests. ``barred`` is the reason why this machine cannot run them.

    ``axis`` is the axis under test, empty without a test. ``number`` counts the tests that were started; the
    last one started at ``began`` on the clock of the samples. ``whole`` counts the completed tests. ``rate``
    is the number of samples per second.
    """

    barred: str = ""
    axis: str = ""
    number: int = 0
    began: float = 0.0
    whole: int = 0
    rate: float = 100.0


NO_DRIVE_TEST = DriveTestState()


class TouchPhase(StrEnum):
    """The phases of a touch-off at the tool setter."""

    SEARCH = "search"
    BACK_OFF = "back off"
    SLOW = "slow"
    RETREAT = "retreat"
    RETURN = "return"  # no touch detected: return to the start


@dataclass(frozen=True, slots=True)
class Touched:
    """The result of a touch-off.

    ``place`` is the position of the axis at the touch, in machine mm by its encoder, and ``error`` is its
    uncertainty. ``place`` is None if the touch-off failed for the reason ``why``.
    """

    number: int  # number of touch-offs that have ended
    axis: str
    sign: int
    place: float | None = None
    error: float = 0.0
    why: str = ""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The state of machine and program at one instant.

    Lengths are in mm with X as a radius, in machine coordinates unless noted otherwise.
    """

    t: float = 0.0
    state: State = State.DISABLED
    # text such as AT SPEED, COLLET, TB2-5 or DWELL; for a tap, that the hold waits for its exit
    waiting_for: str = ""
    program: str = ""
    job: str = ""  # digest of the loaded job: program, offsets and switches
    line: int = 0  # source line being executed; 0 without one
    block: int = 0  # elementary block being executed; 0 without one
    block_text: str = ""
    next_text: str = ""
    axes: tuple[str, ...] = ("X", "Z", "C")  # order of the following tuples: linear axes, then rotary axes
    demand: tuple[float, ...] = (0.0, 0.0, 0.0)
    actual: tuple[float, ...] = (0.0, 0.0, 0.0)
    following_error: tuple[float, ...] = (0.0, 0.0, 0.0)
    homed: tuple[bool, ...] = (False, False, False)
    powered: bool = False  # the drives report that they have power
    block_end: tuple[float, ...] = (0.0, 0.0, 0.0)  # end position of the block, for the distance to go
    offset: tuple[float, float] = (0.0, 0.0)  # machine minus program, X and Z
    swivel: Swivel | None = None  # working plane of the last started block on a mill
    modal: Modal = field(default_factory=Modal)
    x_diameter: bool | None = None  # X is displayed as a diameter; None: as in ``modal``
    velocity: float = 0.0  # actual speed along the path, mm/s
    feed: float = 0.0  # programmed feed: mm/s or mm/rev, see ``modal``
    rapid: bool = False
    turns: bool = False  # only rotary axes move, so the feed is in degrees instead of mm
    rpm_command: float = 0.0
    rpm_actual: float = 0.0
    orienting: bool = False  # the spindle drive moves the spindle to an angle
    oriented: float | None = None  # angle in degrees from the index at which the drive holds the spindle
    # signed rpm that the program or MDI commands, before pot, switch and F10 limit
    spindle_asked: float = 0.0
    feed_override: float = 1.0
    spindle_override: float = 1.0
    spindle_auto: bool = True
    # limit of page F10 until the restart of TurnDesk, rpm; 0: the maximum of the machine
    spindle_limit: float = 0.0
    single_block: bool = False
    optional_stop: bool = False
    block_delete: bool = False
    cycle_repeat: bool = False
    no_count: bool = False
    counts: bool = False  # a program is running that will count as a part when it ends
    outputs: frozenset[str] = frozenset()  # names of the outputs that are on
    absent: frozenset[str] = frozenset()  # outputs that this machine does not have
    inputs: frozenset[str] = frozenset()
    comment: str = ""
    message: str = ""  # message of M00 or M01 during the stop
    optionally_stopped: bool = False  # the stop is an M01 instead of an M00
    alarms: tuple[Alarm, ...] = ()  # active alarms, the oldest first
    # why the machine is stopped although no alarm is active: a hold, a stop or the E-stop
    stop: Alarm | None = None
    cycle_elapsed: float = 0.0  # time of this cycle without stops
    last_cycle: float = 0.0
    timed: int = 0  # number of cycles timed by ``last_cycle``; a part finished by a restart is not timed
    parts: int = 0  # completed and counted since the executor was started
    made: int = 0  # finished parts of the loaded program: set with ``PartsMade`` and counted since
    cutting: Mapping[int, float] = field(default_factory=dict)  # s at feed by tool since the start
    next_barred: str = ""  # why no other part starts after the present one
    ends: int = 0  # programs that ran to their end, counted or not
    underruns: int = 0
    hold_later: float = 0.0  # additional delay of a feed hold on a busy computer, s
    max_following_error: float = 0.0
    proof_wanted: bool = False  # the loaded job has no proof
    starts: Starts = Starts.PROGRAM  # the action of the next Cycle Start
    prepared: str = ""  # digest of the line or restart that Cycle Start would run
    interrupted: InterruptedJob | None = None  # a program that did not reach its end
    confirmed: bool = False  # a start at the first line is confirmed
    lines: int = 0  # MDI lines started since the start of the executor
    tool_open: bool = False  # MDI has called a tool that has not moved yet
    kept: KeptPass[Any] | None = None  # state that MDI lines in other languages have left in force
    announced: tuple[str, ...] = ()  # further actions that the next Cycle Start starts
    start_refused: str = ""  # why the last Cycle Start did nothing
    start_code: str = ""  # code of the refusal if the first move caused it
    begun: int = 0  # runs since the start of the executor: programs, repeats, restarts and MDI lines
    wheel: str = ""  # axis that the handwheel moves; empty without one
    wheel_ended: str = ""  # why the control disabled the handwheel
    # No data arrives from these items, so their values here are the last known ones.
    unknown: frozenset[Unknown] = frozenset()
    drive_test: DriveTestState = NO_DRIVE_TEST
    touching: TouchPhase | None = None  # a tool is being touched off at the tool setter
    touched: Touched | None = None  # result of the last touch-off
    spindle_load: float | None = None  # per cent; None if the machine does not measure the load

    def tells_as(self, other: Snapshot) -> bool:
        """Return whether another snapshot is equal except for its time."""
        return self is other or _told(self) == _told(other)

    @property
    def interrupted_line(self) -> int:
        """The line at which the loaded program was interrupted, or 0 if it was not."""
        found = self.interrupted
        return found.line if found is not None and found.program == self.program else 0

    @property
    def reads_diameter(self) -> bool:
        """True if displays show X as a diameter.

        The mode of a program remains after its end, Reset or E-stop.
        """
        return self.modal.diameter if self.x_diameter is None else self.x_diameter

    @property
    def tip(self) -> tuple[float, float]:
        """The actual machine X and Z, at which the pictures of a lathe show the tool."""
        return self.actual[self.axes.index("X")], self.actual[self.axes.index("Z")]


_told = attrgetter(*(each.name for each in fields(Snapshot) if each.name != "t"))


@dataclass(frozen=True, slots=True)
class Event:
    """An event for the event log."""

    t: float
    # state, alarm, disturbed, estop, start, repeat, restart, mdi, end, part, uncounted, stop,
    # interrupted, late, cleared, refused, override, switch, force, load, offsets, test
    kind: str
    text: str
    line: int = 0
    alarm: Alarm | None = None  # catalog entry of an alarm, an E-stop or a stop
    record: str = ""  # file of the scope record before the event, in the folder ``records``
    part: int = 0  # number of the part among those of the program
    load: float | None = None  # mean spindle load at feed for a part, per cent


class Tick(NamedTuple):
    """The data that the executor passes to the recorder in each tick.

    ``samples`` are the driver's samples, or None if the driver has none.
    """

    snapshot: Snapshot
    late: float  # s by which the tick was late
    queue: float  # s of queued motion, nan if the samples contain it
    turns: float  # revolutions of the spindle, nan without an encoder
    samples: FloatArray | None
    rests: bool = False  # the machine is at rest and nothing changes


# --- permitted state changes ----------------------------------------------------------------------------


# E-stop and alarm may follow any state, and no motion may follow them directly.
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

ACTIVE = frozenset({State.RUN, State.WAIT, State.HOLDING})  # the cycle advances automatically
STOPPED = frozenset({State.HOLD, State.BLOCK_END, State.PROGRAM_STOP})  # Cycle Start resumes the cycle
CYCLE = ACTIVE | STOPPED
# manual operation, in which the spindle switch starts the spindle
BY_HAND = frozenset({State.IDLE, State.JOG})


class TransitionError(Exception):
    """Raised when the executor requests a state change that the table does not permit."""


def demand_allowed(old: State, new: State) -> None:
    """Raise TransitionError unless ``new`` may follow ``old``."""
    if new not in TRANSITIONS[old]:
        raise TransitionError(
            Message("the machine state cannot change from {old} to {new}", old=old.value, new=new.value)
        )
