"""Snapshot of the machine, from which all displays are drawn, and the interrupted job.

A table specifies the permitted transitions between machine states. Any other transition is an internal
error and becomes an alarm.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from datetime import UTC, datetime
from enum import StrEnum
from math import isfinite
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

from core.alarms import AlarmCode
from core.interpreter.shared.checkpoint import SavedPass
from core.interpreter.shared.modal_state import ModalState
from core.message import Message
from core.ports import FloatArray, UnknownPart
from core.tool_edges import format_edge_name

if TYPE_CHECKING:
    from core.interpreter.shared.working_plane import PlanePosition

POWER_LOST_REASON = "THE CONTROL LOST POWER OR ITS PROCESS WAS KILLED"
CLOSED_REASON = "TURNDESK WAS CLOSED"
RESET_REASON = "CANCELED BY RESET"
ESTOP_REASON = "E-STOP"

_TEXTS = ("program", "job", "text", "why", "at")
_NUMBERS = ("line", "block", "begun", "tool", "part")


@dataclass(frozen=True, slots=True)
class InterruptedJob:
    """The program, line, tool and position at which a job was interrupted.

    - ``where``: machine positions in the order of ``axes``, in mm (X as a radius) or in degrees
    - ``part``: number of the part in progress
    - ``begun``: number of elementary blocks of this part that had started, with none skipped
    - ``at``: time of day in UTC, in ISO 8601 format
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
        """Return a short text with the program, line, tool, part and cause, for the log and for messages."""
        return Message(
            "{program}, line {line}, {tool}, part {part}: {why}",
            program=self.program,
            line=self.line,
            tool=format_edge_name(self.tool),
            part=self.part,
            why=self.why,
        )


def convert_interrupted_job_to_json(interrupted_job: InterruptedJob) -> dict[str, object]:
    """Return the interrupted job as a dictionary for JSON."""
    return asdict(interrupted_job) | {
        "axes": list(interrupted_job.axes),
        "where": list(interrupted_job.where),
    }


def parse_interrupted_job(value: object) -> InterruptedJob | None:
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


def make_utc_timestamp() -> str:
    """Return the current time in UTC in ISO 8601 format, with a resolution of 1 s."""
    return datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")


class MachineState(StrEnum):
    """States of the machine. The values are the texts shown to the operator."""

    ESTOP = "E-STOP"
    DISABLED = "DRIVES OFF"
    IDLE = "READY"
    RUN = "RUNNING"
    STOPPING = "STOPPING"
    HOLD = "FEED HOLD"
    SINGLE_BLOCK_STOP = "SINGLE BLOCK"
    PROGRAM_STOP = "PROGRAM STOP"
    WAIT = "WAITING"
    JOG = "JOG"
    HOMING = "HOMING"
    FAULT = "ALARM"


class StartAction(StrEnum):
    """The action that the next Cycle Start performs."""

    PROGRAM = "program"
    MDI_LINE = "line"
    RESTART = "restart"
    RETRACT = "way-out"  # retract from the part after a stop; the interrupted job remains interrupted


MDI_ACTIONS = frozenset({StartAction.MDI_LINE, StartAction.RETRACT})
"""Actions of Cycle Start that do not run the program."""


@dataclass(frozen=True, slots=True)
class Alarm:
    """An alarm, a hold or a stop, with its text, cause, remedy and program line (0 if unknown).

    ``cause`` is the actual cause if it is known, otherwise the most likely one of ``causes``. ``detail`` is
    for the log.
    """

    number: int
    code: AlarmCode
    text: str
    cause: str
    remedy: str
    line: int = 0
    time: float = 0.0
    causes: tuple[str, ...] = ()
    detail: str = ""


class DriveTestState(NamedTuple):
    """State of the drive tests.

    - ``barred``: reason why this machine cannot run drive tests, or empty
    - ``tested_axis``: axis under test, or empty if no test runs
    - ``number`` and ``completed_test_count``: number of tests started and completed
    - ``start_time_s``: start of the last test on the clock of the samples
    - ``sample_rate_hz``: number of samples per second
    """

    barred: str = ""
    tested_axis: str = ""
    number: int = 0
    start_time_s: float = 0.0
    completed_test_count: int = 0
    sample_rate_hz: float = 100.0


NO_DRIVE_TEST = DriveTestState()


class TouchPhase(StrEnum):
    """Phase of a touch-off at the tool setter."""

    SEARCH = "search"
    BACK_OFF = "back off"
    SLOW_TOUCH = "slow"
    RETREAT = "retreat"
    RETURN = "return"  # no touch detected: return to the start


@dataclass(frozen=True, slots=True)
class TouchResult:
    """The result of a touch-off.

    ``touch_position_mm`` is the encoder position of the axis at the touch, in machine coordinates. It is
    None if the touch-off failed, and ``why`` is then the reason. ``uncertainty_mm`` is the uncertainty of
    this position.
    """

    number: int  # number of touch-offs that have ended
    axis: str
    sign: int
    touch_position_mm: float | None = None
    uncertainty_mm: float = 0.0
    why: str = ""


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The state of machine and program at one instant.

    Lengths are in mm with X as a radius, in machine coordinates unless noted otherwise.
    """

    t: float = 0.0
    state: MachineState = MachineState.DISABLED
    # text such as AT SPEED, COLLET, TB2-5 or DWELL; for a tap, that the hold waits for its exit
    waiting_for: str = ""
    program: str = ""
    job: str = ""  # digest of the loaded job: program, offsets and switches
    line: int = 0  # source line being executed; 0 without one
    block: int = 0  # elementary block being executed; 0 without one
    block_text: str = ""
    next_block_text: str = ""
    axes: tuple[str, ...] = ("X", "Z", "C")  # order of the following tuples: linear axes, then rotary axes
    demand: tuple[float, ...] = (0.0, 0.0, 0.0)
    actual: tuple[float, ...] = (0.0, 0.0, 0.0)
    following_error: tuple[float, ...] = (0.0, 0.0, 0.0)
    homed: tuple[bool, ...] = (False, False, False)
    powered: bool = False  # the drives report that they have power
    block_end: tuple[float, ...] = (0.0, 0.0, 0.0)  # end position of the block, for the distance to go
    offset: tuple[float, float] = (0.0, 0.0)  # machine minus program, X and Z
    swivel: PlanePosition | None = None  # working plane of the last started block on a mill
    modal: ModalState = field(default_factory=ModalState)
    x_diameter: bool | None = None  # X is displayed as a diameter; None: as in ``modal``
    velocity: float = 0.0  # actual speed along the path, mm/s
    feed: float = 0.0  # programmed feed: mm/s or mm/rev, see ``modal``
    rapid: bool = False
    turns: bool = False  # only rotary axes move, so the feed is in degrees instead of mm
    rpm_command: float = 0.0
    rpm_actual: float = 0.0
    is_orienting: bool = False  # the spindle drive moves the spindle to an angle
    oriented: float | None = None  # angle in degrees from the index at which the drive holds the spindle
    # signed rpm that the program or MDI commands, before pot, switch and F10 limit
    requested_rpm: float = 0.0
    feed_override: float = 1.0
    spindle_override: float = 1.0
    spindle_auto: bool = True
    # limit of page F10 until the restart of TurnDesk, rpm; 0: the maximum of the machine
    spindle_limit_rpm: float = 0.0
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
    is_optional_stop: bool = False  # the stop is an M01 instead of an M00
    alarms: tuple[Alarm, ...] = ()  # active alarms, the oldest first
    # why the machine is stopped although no alarm is active: a hold, a stop or the E-stop
    stop: Alarm | None = None
    cycle_elapsed: float = 0.0  # time of this cycle without stops
    last_cycle: float = 0.0
    timed_cycle_count: int = (
        0  # number of cycles timed by ``last_cycle``; a part finished by a restart is not timed
    )
    parts: int = 0  # completed and counted since the executor was started
    made: int = 0  # finished parts of the loaded program: set with ``PartsMade`` and counted since
    cutting: Mapping[int, float] = field(default_factory=dict)  # s at feed by tool since the start
    next_barred: str = ""  # why no other part starts after the present one
    ends: int = 0  # programs that ran to their end, counted or not
    underruns: int = 0
    hold_delay_s: float = 0.0  # additional delay of a feed hold on a busy computer, s
    max_following_error: float = 0.0
    needs_proof: bool = False  # the loaded job has no proof
    starts: StartAction = StartAction.PROGRAM  # the action of the next Cycle Start
    prepared_job_digest: str = ""  # digest of the line or restart that Cycle Start would run
    interrupted: InterruptedJob | None = None  # a program that did not reach its end
    confirmed: bool = False  # a start at the first line is confirmed
    lines: int = 0  # MDI lines started since the start of the executor
    is_tool_move_pending: bool = False  # MDI has called a tool that has not moved yet
    kept: SavedPass[Any] | None = None  # state that MDI lines in other languages have left in force
    announced: tuple[str, ...] = ()  # further actions that the next Cycle Start starts
    start_refusal_reason: str = ""  # why the last Cycle Start did nothing
    start_code: str = ""  # code of the refusal if the first move caused it
    begun: int = 0  # runs since the start of the executor: programs, repeats, restarts and MDI lines
    wheel: str = ""  # axis that the handwheel moves; empty without one
    wheel_ended: str = ""  # why the control disabled the handwheel
    # No data arrives from these items, so their values here are the last known ones.
    unknown: frozenset[UnknownPart] = frozenset()
    drive_test: DriveTestState = NO_DRIVE_TEST
    touch_phase: TouchPhase | None = None  # a tool is being touched off at the tool setter
    touched: TouchResult | None = None  # result of the last touch-off
    spindle_load: float | None = None  # per cent; None if the machine does not measure the load

    def equals_except_time(self, other: Snapshot) -> bool:
        """Return whether another snapshot is equal except for its time."""
        return self is other or _values_without_time(self) == _values_without_time(other)

    @property
    def interrupted_line(self) -> int:
        """Return the line at which the loaded program was interrupted, or 0 if it was not interrupted."""
        found = self.interrupted
        return found.line if found is not None and found.program == self.program else 0

    @property
    def shows_diameter(self) -> bool:
        """Return whether displays show X as a diameter.

        The mode that a program selects remains active after its end, a Reset or an E-stop.
        """
        return self.modal.diameter if self.x_diameter is None else self.x_diameter

    @property
    def tip(self) -> tuple[float, float]:
        """Return the actual X and Z in machine coordinates, at which lathe views draw the tool tip."""
        return self.actual[self.axes.index("X")], self.actual[self.axes.index("Z")]


_values_without_time = attrgetter(*(each.name for each in fields(Snapshot) if each.name != "t"))


@dataclass(frozen=True, slots=True)
class LogEvent:
    """An event for the event log, with its time, kind, text and program line."""

    time_s: float
    # state, alarm, disturbed, estop, start, repeat, restart, mdi, end, part, uncounted, stop,
    # interrupted, late, cleared, refused, override, switch, force, load, offsets, test, rights, notice
    kind: str
    text: str
    line_number: int = 0
    alarm: Alarm | None = None  # catalog entry of an alarm, an E-stop or a stop
    record_name: str = ""  # file of the scope record before the event, in the folder ``records``
    part_number: int = 0  # number of the part among those of the program
    mean_load_percent: float | None = None  # mean spindle load at feed for a part, per cent


class TickData(NamedTuple):
    """The data that the executor passes to the recorder in each tick.

    ``samples`` are the driver's samples, or None if the driver has none.
    """

    snapshot: Snapshot
    delay_s: float  # s by which the tick was late
    queued_motion_s: float  # s of queued motion, nan if the samples contain it
    spindle_revolutions: float  # revolutions of the spindle, nan without an encoder
    samples: FloatArray | None
    is_at_rest: bool = False  # the machine is at rest and nothing changes


# --- permitted state changes ----------------------------------------------------------------------------


# E-stop and alarm may follow any state, and no motion may follow them directly.
_ALWAYS_ALLOWED = {MachineState.ESTOP, MachineState.FAULT}
_RUNNING_STATES = {
    MachineState.RUN,
    MachineState.WAIT,
    MachineState.STOPPING,
    MachineState.HOLD,
    MachineState.SINGLE_BLOCK_STOP,
    MachineState.PROGRAM_STOP,
}

STATE_TRANSITIONS: dict[MachineState, frozenset[MachineState]] = {
    MachineState.ESTOP: frozenset({MachineState.DISABLED}),
    MachineState.DISABLED: frozenset({MachineState.IDLE, *_ALWAYS_ALLOWED}),
    MachineState.IDLE: frozenset(
        {MachineState.RUN, MachineState.JOG, MachineState.HOMING, MachineState.DISABLED, *_ALWAYS_ALLOWED}
    ),
    MachineState.RUN: frozenset({*_RUNNING_STATES, MachineState.IDLE, *_ALWAYS_ALLOWED} - {MachineState.RUN}),
    MachineState.WAIT: frozenset(
        {*_RUNNING_STATES, MachineState.IDLE, *_ALWAYS_ALLOWED} - {MachineState.WAIT}
    ),
    MachineState.STOPPING: frozenset(
        {MachineState.HOLD, MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE, *_ALWAYS_ALLOWED}
    ),
    MachineState.HOLD: frozenset({MachineState.RUN, MachineState.WAIT, MachineState.IDLE, *_ALWAYS_ALLOWED}),
    MachineState.SINGLE_BLOCK_STOP: frozenset(
        {MachineState.RUN, MachineState.WAIT, MachineState.HOLD, MachineState.IDLE, *_ALWAYS_ALLOWED}
    ),
    MachineState.PROGRAM_STOP: frozenset(
        {
            MachineState.RUN,
            MachineState.WAIT,
            MachineState.SINGLE_BLOCK_STOP,
            MachineState.IDLE,
            *_ALWAYS_ALLOWED,
        }
    ),
    MachineState.JOG: frozenset({MachineState.IDLE, *_ALWAYS_ALLOWED}),
    MachineState.HOMING: frozenset({MachineState.IDLE, *_ALWAYS_ALLOWED}),
    MachineState.FAULT: frozenset({MachineState.ESTOP, MachineState.DISABLED, MachineState.IDLE}),
}

ACTIVE_STATES = frozenset(
    {MachineState.RUN, MachineState.WAIT, MachineState.STOPPING}
)  # the cycle advances automatically
STOPPED_STATES = frozenset(
    {MachineState.HOLD, MachineState.SINGLE_BLOCK_STOP, MachineState.PROGRAM_STOP}
)  # Cycle Start resumes the cycle
CYCLE_STATES = ACTIVE_STATES | STOPPED_STATES
# manual operation, in which the spindle switch starts the spindle
MANUAL_STATES = frozenset({MachineState.IDLE, MachineState.JOG})


class TransitionError(Exception):
    """An error raised if the executor requests a state change that the transition table forbids."""


def require_transition(old_state: MachineState, new_state: MachineState) -> None:
    """Raise TransitionError unless ``new_state`` may follow ``old_state``."""
    if new_state not in STATE_TRANSITIONS[old_state]:
        raise TransitionError(
            Message(
                "the machine state cannot change from {old} to {new}",
                old=old_state.value,
                new=new_state.value,
            )
        )
